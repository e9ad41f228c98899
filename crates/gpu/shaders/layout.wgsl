// Every struct that the host fills. Twin: src/layout.rs; a test holds names, offsets and sizes equal.
// Positions are in metres and relative to the origin that src/vertices.rs chooses, for the sake of their last digits.

// The view, and what else is the same for every pixel of one sample.
struct Frame {
    camera_m: vec3f,            // the pinhole
    forward: vec3f,             // unit direction of the view
    near_m: f32,                // distance of the near plane along it
    per_px_x: vec3f,            // change of the ray's direction by one pixel to the right, at unit depth
    px_per_slope: f32,          // pixels that a unit of slope spans
    per_px_y: vec3f,            // and by one pixel down
    footprint_std_px: f32,      // standard deviation of the Gaussian that shading filters with
    size_px: vec2u,             // of the picture
    rows: vec2u,                // first row of the film and the one after its last
    jitter_px: vec2f,           // where the sample lies from the pixel's centre, y down
    light_count: u32,
    environment_flags: u32,     // ENVIRONMENT_PRESENT, ENVIRONMENT_VISIBLE
    environment_from_world: mat3x3f,
    environment_sh: array<vec4f, 9>,    // irradiance; xyz are the channels
    environment_texel_radiance: f32,    // radiance of a texel (or coefficient) of value 1
    sample: u32,                // counted from 0
    tile_chunks: u32,           // of the lists of all tiles
    record_segments: u32,       // straight pieces of scratches that may have records
}

const ENVIRONMENT_PRESENT: u32 = 1u;
const ENVIRONMENT_VISIBLE: u32 = 2u;

// A corner of a triangle. Corners are not shared: triangle i has 3 i, 3 i + 1 and 3 i + 2.
struct Vertex {
    position_m: vec3f,
    material: u32,              // index; VERTEX_BITANGENT_FLIPPED is its highest bit
    normal: vec3f,
    u: f32,
    tangent: vec3f,
    v: f32,
}

const VERTEX_BITANGENT_FLIPPED: u32 = 0x80000000u;

// The scratches of an object: a range of nodes.
struct Object {
    first_node: u32,
    end_node: u32,
    depth_coherence: f32,
}

struct Material {
    base_color: vec3f,
    metallic: f32,
    fresnel_a: vec3f,
    roughness: f32,
    emission: vec3f,
    coherence_um: f32,
    dielectric_f0: f32,
    normal_scale: f32,
    table: u32,                 // layer of the scratch tables
    base_color_texture: vec2u,  // packed, see scene_texture(); zero: none
    metallic_roughness_texture: vec2u,
    normal_texture: vec2u,
    emission_texture: vec2u,
}

struct Light {
    radiance: vec3f,
    kind: u32,                  // LIGHT_SPHERE or LIGHT_POLYGON
    center_m: vec3f,            // of the sphere, or of one around the polygon
    radius_m: f32,
    normal: vec3f,              // of a polygon, on the side that sees its vertices counter-clockwise
    two_sided: u32,
    first_vertex: u32,          // of those of all lights
    vertex_count: u32,
    area_m2: f32,               // of a polygon
}

const LIGHT_SPHERE: u32 = 0u;
const LIGHT_POLYGON: u32 = 1u;

// Nodes in depth-first order: a walk goes on with the next one, or with `skip`. Twin: crates/index.
struct ScratchNode {
    min_m: vec3f,
    skip: u32,
    max_m: vec3f,
    leaf: u32,                  // 0, or the count of segments in the upper 4 bits and the first one in the lower 28
}

// Packed; segment_at() unpacks.
struct ScratchSegment {
    start_m: vec3f,
    width_depth: u32,           // half floats: um, nm
    end_m: vec3f,
    normal_blur: u32,           // two bytes of an octahedral map, a half float in um
}

// Sums over the samples of a pixel: who reads them divides by their count.
struct FilmPixel {
    base: vec3f,
    depth_m: f32,
    scratches: vec3f,
    coverage: f32,
    density: vec3f,
    samples: u32,               // samples that are complete
    normal: vec3f,
    walk_at: u32,               // 0: not begun; else the node to go on with + 1
}

// The walk over the scratches of the sample in hand, where a dispatch may leave it unfinished for the next one.
struct FilmWalk {
    radiance: vec3f,
    share: f32,
    energy: vec3f,
    share_by_line: f32,
}

// What the shading pass adds to.
struct Film {
    gave_up: atomic<u32>,       // pixels whose loops were cut short: the host discards the picture
    unfinished: atomic<u32>,    // pixels whose walk goes on in the next dispatch
    pixels: array<FilmPixel>,
}

// Which tiles are shaded how: three counts for each queue of tile_queues.wgsl, then the queues.
struct TileQueues {
    counts: array<atomic<u32>, 18>,
    tiles: array<atomic<u32>>,
}

// How a film is shown.
struct DisplaySettings {
    size_px: vec2u,
    tone_map: u32,
    gain: f32,                  // 2^exposure_ev
}
