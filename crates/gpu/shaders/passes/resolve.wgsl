// Pass: base and scratches of a pixel, weakened by one another, on the film. One invocation a pixel. The first step takes every pixel, and
// marks those that have an edge or a crease; the second one replaces these by their samples, and later ones add more. Twin: cpu/src/resolve.rs.
// Needs: scene, sums, pixel_point.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> base_light: array<BaseLight>;
@group(3) @binding(2) var<storage, read> group_starts: array<u32>;
// 3 and 4: sums.wgsl.
@group(3) @binding(5) var<storage, read_write> film: Film;

// The reciprocal of depth is linear over the picture of a plane, so its second difference tells a crease or a step. In units of a
// pixel's width on the surface: a fold of about 10 degrees. Twin: cpu/src/silhouettes.rs.
const CREASE_PX: f32 = 0.2;

// The object that a pixel sees, and the reciprocal of its depth; zeros for the background. Beyond the picture its border repeats.
struct Neighbour {
    object: u32,
    per_depth: f32,
    is_partial: bool,
}

fn neighbour(pixel: vec2u, step: vec2i) -> Neighbour {
    let at = clamp(vec2i(pixel) + step, vec2i(0), vec2i(frame.size_px) - 1);
    let point = strip_index(vec2u(at));
    let object = points[point].object;
    return Neighbour(object, select(0.0, 1.0 / points[point].depth_m, object != 0u), object != 0u && (points[point].table_and_place & PIXEL_PARTIAL) != 0u);
}

// Whether one sample through the centre is not enough. Samples of a wide filter see more than the pixels beside theirs.
fn pixel_is_edge(pixel: vec2u) -> bool {
    var is_edge = frame.is_edge_everywhere != 0u;
    let more = i32(frame.halo_rows) - 1;
    for (var y = -more; y <= more && !is_edge; y += 1) {
        for (var x = -more; x <= more; x += 1) {
            let at = vec2i(pixel) + vec2i(x, y);
            if all(at >= vec2i(0)) && all(at < vec2i(frame.size_px)) {
                is_edge = is_edge || pixel_is_uneven(vec2u(at));
            }
        }
    }
    return is_edge;
}

// Whether a pixel's centre and those around it do not lie on one smooth surface.
fn pixel_is_uneven(pixel: vec2u) -> bool {
    let middle = neighbour(pixel, vec2i(0));
    let bend_max = CREASE_PX * middle.per_depth / frame.px_per_slope;
    var is_edge = middle.is_partial;
    for (var i = 0; i < 4; i += 1) {
        // To the right, down, and along both diagonals.
        let step = vec2i(i32(i != 1), i32(i != 0) * select(1, -1, i == 3));
        let before = neighbour(pixel, -step);
        let after = neighbour(pixel, step);
        // Beyond the picture's border there is nothing to tell a bend by.
        let ends = array(vec2i(pixel) - step, vec2i(pixel) + step);
        let is_between = all(min(ends[0], ends[1]) >= vec2i(0)) && all(max(ends[0], ends[1]) < vec2i(frame.size_px));
        let bend = select(0.0, abs(before.per_depth + after.per_depth - 2.0 * middle.per_depth), is_between);
        is_edge = is_edge || before.is_partial || after.is_partial || before.object != middle.object || after.object != middle.object || bend > bend_max;
    }
    return is_edge;
}

// Light and guides that lane `lane` of a group adds to its pixel.
fn sample_value(group: u32, lane: u32, at: u32) -> FilmPixel {
    let point = points[at];
    var value: FilmPixel;
    if point.object == 0u {
        value.base = scene_background(point.normal);
        return value;
    }
    var by = at;
    var scratches = Masked(vec3f(0.0), vec3f(0.0));
    if HAS_SCRATCHES {
        // Another sample of the pixel may have its scratches.
        by = pixel_scratched(point, at);
        let sums = sample_sums_of(by, at, group, lane);
        if sums.cut > 0u {
            atomicAdd(&film.gave_up, sums.cut);
        }
        scratches = masked(sums.all, objects[point.object - 1u].depth_coherence);
    }
    // A groove interrupts the reflecting surface; what shines from under it passes.
    let light = base_light[at];
    let gratings = under_scratches(grating_sums(group, lane), scratches.taken);
    value.base = base_emission(light) + (light.body + light.specular * (1.0 - gratings.taken));
    value.scratches = scratches.scratches * base_light[by].fresnel + gratings.scratches;
    value.density = gratings.taken;
    value.normal = point.normal;
    value.depth_m = point.depth_m;
    value.coverage = 1.0;
    return value;
}

fn film_sum(a: FilmPixel, b: FilmPixel) -> FilmPixel {
    var sum = a;
    sum.base += b.base;
    sum.scratches += b.scratches;
    sum.density += b.density;
    sum.normal += b.normal;
    sum.depth_m += b.depth_m;
    sum.coverage += b.coverage;
    sum.samples += b.samples;
    return sum;
}

@compute @workgroup_size(8, 8)
fn resolve(@builtin(global_invocation_id) id: vec3u) {
    let pixel = id.xy + vec2u(0u, frame.rows.x);
    if film.short != 0u || pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    let at = film_index(pixel);
    let tile = pixel_tile(pixel);
    if frame.step == 0u {
        var value = sample_value(tile.x, tile.y, strip_index(pixel));
        value.samples = 1u;
        value.edge = u32(pixel_is_edge(pixel));
        film.pixels[at] = value;
        return;
    }
    let edge = film.pixels[at].edge;
    if edge == 0u {
        return;
    }
    var sum: FilmPixel;
    if frame.step > 1u {
        sum = film.pixels[at];
    }
    for (var i = 0u; i < frame.samples; i += 1u) {
        let sample = (edge - 1u) * frame.samples + i;
        let group = group_starts[tile.x] + sample / GROUP;
        let lane = sample % GROUP;
        sum = film_sum(sum, sample_value(group, lane, GROUP * group + lane));
    }
    sum.samples += frame.samples;
    sum.edge = edge;
    film.pixels[at] = sum;
}
