// Pass: adds the light that rays found for the samples of a pixel to the film. One invocation a pixel, after resolve.wgsl. Twin:
// cpu/src/resolve.rs.
// Needs: found_light, scene, pixel_point, film.

@group(3) @binding(0) var<storage, read> points: array<PixelPoint>;
@group(3) @binding(1) var<storage, read> paints: array<PixelPaint>;
@group(3) @binding(2) var<storage, read> found: array<FoundRays>;
@group(3) @binding(3) var<storage, read> group_starts: array<u32>;
@group(3) @binding(4) var<storage, read_write> film: Film;
@group(3) @binding(5) var<storage, read_write> film_found: array<FoundPixel>;

// Adds a layer of a sample.
fn added(sum: FoundLight, ray: FoundRays) -> FoundLight {
    return FoundLight(
        found_plus(sum.open, ray.open),
        found_plus(sum.around, ray.around),
        found_plus(sum.weight, ray.weight),
        found_plus(sum.seen, ray.seen),
        found_plus(sum.bounced, ray.bounced),
        found_plus(sum.share_moments, ray.share_moments),
        found_plus(sum.bounced_moments, ray.bounced_moments),
    );
}

// Adds a layer of the samples of a pixel.
fn over_samples(before: FoundLight, first: u32, count: u32, layer: u32) -> FoundLight {
    var sum = before;
    for (var i = first; i < first + count; i += 1u) {
        if points[i].object != 0u {
            sum = added(sum, found[found_at(i, layer)]);
        }
    }
    return sum;
}

@compute @workgroup_size(8, 8)
fn found_film(@builtin(global_invocation_id) id: vec3u) {
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
        var nothing: FoundPixel;
        film_found[at] = nothing;
    }
    var rest = found_rgb(film_found[at].rest);
    var roughness = film_found[at].roughness;
    var object = select(points[first].object, film_found[at].object, frame.step >= 2u);
    for (var i = first; i < first + count; i += 1u) {
        if points[i].object != object {
            object = FOUND_SEVERAL_OBJECTS;
        }
        if points[i].object == 0u {
            rest += scene_background(points[i].normal);
        } else {
            rest += pixel_emission(paints[i]);
            roughness += pixel_lobe(paints[i]).x;
        }
    }
    film_found[at].rest = array(rest.x, rest.y, rest.z);
    film_found[at].roughness = roughness;
    film_found[at].object = object;
    let diffuse = over_samples(film_found[at].diffuse, first, count, FOUND_BODY);
    film_found[at].diffuse = diffuse;
    let base = found_light(diffuse);
    let specular = over_samples(film_found[at].specular, first, count, FOUND_SPECULAR);
    film_found[at].specular = specular;
    film.pixels[at].base = rest + (base + found_light(specular));
    // Gratings send with scratches.
    var scratches = film_found[at].scratches;
    for (var layer = FOUND_SCRATCHES; layer < found_layers(); layer += 1u) {
        scratches = over_samples(scratches, first, count, layer);
    }
    film_found[at].scratches = scratches;
    film.pixels[at].scratches = found_light(scratches);
}
