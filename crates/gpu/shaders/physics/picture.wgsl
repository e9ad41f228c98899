// Look-ups of a picture on a flat light: their place and their blur. Twin: optics/src/picture.rs, which names the source.

// A parallelogram that a picture lies on, relative to a point.
struct PicturePlane {
    corner: vec3f,              // where the picture's left and lower edges meet
    right: vec3f,               // along its lower edge
    up: vec3f,                  // along its left edge
}

// A look-up in a picture.
struct PictureLook {
    uv: vec2f,                  // from its left upper corner, each from 0 to 1
    spread: f32,                // of the blur over the root of the picture's area
}

const PICTURE_COSINE_STD: f32 = 0.42;
const PICTURE_LEAST_COS: f32 = 0.05;
// Along each side, for lobes and bodies.
const PICTURE_PARTS: u32 = 4u;
const PICTURE_PART_WIDEST: f32 = 16.0;
const PICTURE_CELLS: u32 = 12u;
const PICTURE_ROW_CELLS: u32 = 48u;
const PICTURE_CELL_SCALE_UM: f32 = 0.3;
const PICTURE_CELL_STD: f32 = 0.145;

// Part `i`, row by row from below.
fn picture_part(plane: PicturePlane, i: u32) -> PicturePlane {
    let share = 1.0 / f32(PICTURE_PARTS);
    let right = plane.right * share;
    let up = plane.up * share;
    return PicturePlane(plane.corner + right * f32(i % PICTURE_PARTS) + up * f32(i / PICTURE_PARTS), right, up);
}

// Left upper corner of part `i` in the picture.
fn picture_part_uv(i: u32) -> vec2f {
    return vec2f(f32(i % PICTURE_PARTS), f32(PICTURE_PARTS - 1u - i / PICTURE_PARTS)) / f32(PICTURE_PARTS);
}

// Position at which a direction meets the picture; beside the picture, that on its nearest edge.
fn picture_uv(plane: PicturePlane, toward: vec3f) -> vec2f {
    let normal = cross(plane.right, plane.up);
    let per_area2 = 1.0 / max(dot(normal, normal), 1e-30);
    let along = dot(toward, normal);
    let least = 1e-6 * length(toward) * inverseSqrt(per_area2);
    let held = select(-max(-along, least), max(along, least), along >= 0.0);
    let place = toward * (dot(plane.corner, normal) / held) - plane.corner;
    let right = dot(cross(place, plane.up), normal) * per_area2;
    let up = dot(cross(plane.right, place), normal) * per_area2;
    return clamp(vec2f(right, 1.0 - up), vec2f(0.0), vec2f(1.0));
}

// Look-up for the mean of the picture under a cosine about the normal, given the picture's vector irradiance.
fn picture_look(plane: PicturePlane, vector: vec3f) -> PictureLook {
    let normal = cross(plane.right, plane.up);
    let area = max(length(normal), 1e-30);
    let length2 = dot(vector, vector);
    let toward = select(vec3f(0.0, 0.0, 1.0), vector * inverseSqrt(max(length2, 1e-37)), length2 > 1e-37);
    let cos = max(abs(dot(toward, normal)) / area, PICTURE_LEAST_COS);
    let distance = abs(dot(plane.corner, normal)) / area / cos;
    return PictureLook(picture_uv(plane, toward), PICTURE_COSINE_STD * distance * inverseSqrt(cos * area));
}

// The look-up of a part of a chord, by the directions of its ends and its middle. `across_std` is the standard deviation of the band about the chord.
fn picture_on_chord(plane: PicturePlane, low: vec3f, middle: vec3f, high: vec3f, across_std: f32) -> PictureLook {
    let along = picture_uv(plane, low) - picture_uv(plane, high);
    let share = across_std / max(distance(low, high), 1e-6);
    return PictureLook(picture_uv(plane, middle), max(PICTURE_CELL_STD, share) * length(along));
}

// The blur of a part over the root of the picture's area, given that of its look-up over the part's own.
fn picture_part_spread(spread: f32) -> f32 {
    return spread * inverseSqrt(1.0 + PICTURE_PART_WIDEST * spread * spread) / f32(PICTURE_PARTS);
}

// The level of a picture's mip chain for a blur.
fn picture_lod(spread: f32, size_px: vec2f) -> f32 {
    return log2(max(2.0 * spread * sqrt(size_px.x * size_px.y), 1.0));
}

// A place at a share of the way.
fn picture_place(share: f32, low: f32, high: f32, width_um: f32) -> f32 {
    let scale = PICTURE_CELL_SCALE_UM / max(width_um, 1e-3);
    let begin = low / (abs(low) + scale);
    let x = begin + (high / (abs(high) + scale) - begin) * share;
    let q = clamp(scale * x / max(1.0 - abs(x), 1e-6), min(low, high), high);
    return select(select(q, low, share <= 0.0), high, share >= 1.0);
}
