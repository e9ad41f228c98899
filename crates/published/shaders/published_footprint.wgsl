// The method of 2018, kept to be compared with: a blend of the pixel's two limits, and the density that masks the base.
// Twin: src/footprint.rs, which explains it.
// Needs: gaussian.

// Step on the surface from one pixel to the next, right and down; x along the scratch, y across it.
struct PixelFootprint {
    right_um: vec2f,
    down_um: vec2f,
}

struct PublishedShare {
    share: f32,
    density: f32,
}

const PIXEL_SLOPE_MIN_UM: f32 = 1e-9;
const PIXEL_AREA_MIN_UM2: f32 = 1e-6;

fn pixel_area_um2(pixel: PixelFootprint) -> f32 {
    return abs(pixel.right_um.x * pixel.down_um.y - pixel.right_um.y * pixel.down_um.x);
}

// The part of a segment within the strip along one of the pixel's sides, from low to high.
fn contained_in_strip(range: vec2f, offset_um: f32, side: vec2f, half_area: f32) -> vec2f {
    let slope = select(-side.y, PIXEL_SLOPE_MIN_UM, abs(side.y) < PIXEL_SLOPE_MIN_UM);
    let at_zero = side.x * offset_um;
    let one = (-half_area - at_zero) / slope;
    let other = (half_area - at_zero) / slope;
    return vec2f(max(range.x, min(one, other)), min(range.y, max(one, other)));
}

// The length of a segment within the pixel.
fn contained_length_um(offset_um: f32, start_um: f32, end_um: f32, pixel: PixelFootprint) -> f32 {
    let half_area = 0.5 * pixel_area_um2(pixel);
    var range = contained_in_strip(vec2f(start_um, end_um), offset_um, pixel.right_um, half_area);
    range = contained_in_strip(range, offset_um, pixel.down_um, half_area);
    return max(range.y - range.x, 0.0);
}

// The talk's blend for one segment.
fn published_share(
    width_um: f32,
    offset_um: f32,
    start_um: f32,
    end_um: f32,
    blur_um: f32,
    pixel: PixelFootprint,
    coherence_um: f32,
) -> PublishedShare {
    let area = pixel_area_um2(pixel);
    let twice_coherence_area = 6.28318531 * coherence_um * coherence_um;
    let length = contained_length_um(offset_um, start_um, end_um, pixel);
    let z = max(1.41421356 * blur_um, 1e-6);
    let p = offset_um / coherence_um;
    let at_the_point = exp(-min(p * p, 80.0)) / (1.77245385 * coherence_um) * 0.5
        * gaussian_erf_difference(start_um / z, end_um / z);
    let blend = min(area / twice_coherence_area, 1.0);
    return PublishedShare(
        width_um * (length / max(area, twice_coherence_area) + (1.0 - blend) * at_the_point),
        2.0 * width_um * length / max(area, PIXEL_AREA_MIN_UM2),
    );
}
