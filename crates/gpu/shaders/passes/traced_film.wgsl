// Pass: adds the light that rays found for the samples of a pixel to the film. One invocation a pixel, after resolve.wgsl. Twin:
// cpu/src/resolve.rs.
// Needs: traced_light, scene, pixel_point, film.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read> traced: array<TracedRays>;
@group(3) @binding(3) var<storage, read> group_starts: array<u32>;
@group(3) @binding(4) var<storage, read_write> film: Film;
@group(3) @binding(5) var<storage, read_write> film_traced: array<TracedPixel>;

// Adds a layer of a sample.
fn added(sum: TracedLight, ray: TracedRays) -> TracedLight {
    return TracedLight(
        traced_plus(sum.open, ray.open),
        traced_plus(sum.around, ray.around),
        traced_plus(sum.weight, ray.weight),
        traced_plus(sum.seen, ray.seen),
        traced_plus(sum.bounced, ray.bounced),
        traced_plus(sum.share_moments, ray.share_moments),
        traced_plus(sum.bounced_moments, ray.bounced_moments),
    );
}

// Adds a layer of the samples of a pixel.
fn over_samples(before: TracedLight, first: u32, count: u32, layer: u32) -> TracedLight {
    var sum = before;
    for (var i = first; i < first + count; i += 1u) {
        if points[i].object != 0u {
            sum = added(sum, traced[traced_at(i, layer)]);
        }
    }
    return sum;
}

@compute @workgroup_size(8, 8)
fn traced_film(@builtin(global_invocation_id) id: vec3u) {
    let pixel = id.xy + vec2u(0u, frame.rows.x);
    if film.short != 0u || pixel.x >= frame.size_px.x || pixel.y >= frame.rows.y {
        return;
    }
    let at = film_index(pixel);
    var first = strip_index(pixel);
    var count = 1u;
    if frame.step > 0u {
        let edge = film.pixels[at].edge;
        if edge == 0u {
            return;
        }
        first = GROUP * group_starts[pixel_tile(pixel).x] + (edge - 1u) * frame.samples;
        count = frame.samples;
    }
    if frame.step < 2u {
        var nothing: TracedPixel;
        film_traced[at] = nothing;
    }
    var rest = traced_rgb(film_traced[at].rest);
    var roughness = film_traced[at].roughness;
    var object = select(points[first].object, film_traced[at].object, frame.step >= 2u);
    for (var i = first; i < first + count; i += 1u) {
        if points[i].object != object {
            object = TRACED_SEVERAL_OBJECTS;
        }
        if points[i].object == 0u {
            rest += scene_background(points[i].normal);
        } else {
            rest += pixel_emission(paints[i]);
            roughness += pixel_lobe(paints[i]).x;
        }
    }
    film_traced[at].rest = array(rest.x, rest.y, rest.z);
    film_traced[at].roughness = roughness;
    film_traced[at].object = object;
    let diffuse = over_samples(film_traced[at].diffuse, first, count, TRACED_BODY);
    film_traced[at].diffuse = diffuse;
    let base = traced_light(diffuse);
    let specular = over_samples(film_traced[at].specular, first, count, TRACED_SPECULAR);
    film_traced[at].specular = specular;
    film.pixels[at].base = rest + (base + traced_light(specular));
    // Gratings send with scratches.
    var scratches = film_traced[at].scratches;
    for (var layer = TRACED_SCRATCHES; layer < traced_layers(); layer += 1u) {
        scratches = over_samples(scratches, first, count, layer);
    }
    film_traced[at].scratches = scratches;
    film.pixels[at].scratches = traced_light(scratches);
}
