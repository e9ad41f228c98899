// Every struct that the host fills or reads. Rust for them is made of this file: build/layout.rs.
// Positions are in metres and relative to the origin that src/vertices.rs chooses, so that f32 keeps micrometres.

/// The view, and what else is the same for every pixel of one step of one strip.
struct Frame {
    camera_m: vec3f,            // the pinhole
    forward: vec3f,             // unit direction of the view
    near_m: f32,                // distance of the near plane along it
    per_px_x: vec3f,            // change of the ray's direction by one pixel to the right, at unit depth
    px_per_slope: f32,          // pixels that a unit of slope spans
    per_px_y: vec3f,            // and by one pixel down
    footprint_std_px: f32,      // standard deviation of the Gaussian that shading filters with
    size_px: vec2u,             // of the picture
    rows: vec2u,                // first row of the strip and the one after its last
    jitter_px: vec2f,           // where the sample lies from the pixel's centre, y down
    light_count: u32,
    environment_flags: u32,     // ENVIRONMENT_PRESENT, ENVIRONMENT_VISIBLE
    environment_from_world: mat3x3f,
    environment_texel_radiance: f32,    // radiance of a texel of value 1
    step: u32,                  // 0: every pixel through its centre; later ones: samples of pixels on edges and creases
    sample: u32,                // of those of the step, which one is looked at
    samples: u32,               // and how many there are
    film_row: u32,              // the picture's row that the film begins with
    segment_count: u32,
    list_std_px: f32,           // the largest footprint_std_px of all steps: tile lists serve them all
    list_jitter_px: f32,        // how far samples lie from the pixel's centre
    halo_rows: u32,             // of the strip's arrays, above it and below
    is_edge_everywhere: u32,    // 1: samples see so far that each pixel has all of them
    object_count: u32,
    middle_px: vec2f,           // where in the picture the ray along `forward` is
    coverage_round: u32,        // of all samples of a pixel, which one is looked at; COVERAGE_ANY: it stands for all
    sample_order: vec2u,        // the samples of the step from the one that is nearest to the pixel's middle, 4 bits each
    entry_count: u32,           // this and what follows: what `Sizes` begins with, copied on the device
    group_count: u32,
}

/// What is counted on the device, and the dispatches that follow from it; all zeros once something had no room. See sizes.wgsl.
struct Sizes {
    entry_count: u32,           // of all tile lists of the strip
    group_count: u32,           // of 64 samples that are shaded together
    blocks: vec3u,              // workgroups for entries that are sorted
    groups: vec3u,              // a workgroup for each group
    chunks: vec3u,              // and for each chunk of a list
    capacity: vec3u,            // room for so many entries, groups and chunks; the host's
    needed: vec3u,              // the most of each since the host asked
}

/// Which number is counted: the place in `capacity` and `needed`.
const COUNTED_ENTRIES: u32 = 0u;
const COUNTED_GROUPS: u32 = 1u;
const COUNTED_CHUNKS: u32 = 2u;

/// The sample sees any surface that covers something.
const COVERAGE_ANY: u32 = 0xffffffffu;

const ENVIRONMENT_PRESENT: u32 = 1u;
const ENVIRONMENT_VISIBLE: u32 = 2u;

/// A corner of a triangle. Corners are not shared: triangle i has 3 i, 3 i + 1 and 3 i + 2.
struct Vertex {
    position_m: vec3f,
    material: u32,              // index; VERTEX_BITANGENT_FLIPPED is its highest bit
    normal: vec3f,
    u: f32,
    tangent: vec3f,
    v: f32,
    other_uv: vec2f,            // a second set of texture coordinates
    color: vec2u,               // factor on base colour and alpha, 16 bits each; see vertex_color()
}

const VERTEX_BITANGENT_FLIPPED: u32 = 0x80000000u;

/// The scratches of an object: a range of segments, and of the nodes over them; and a range of gratings.
struct Object {
    first_segment: u32,
    end_segment: u32,
    first_node: u32,
    end_node: u32,
    depth_coherence: f32,
    coherence_um: f32,          // the largest of its materials
    first_grating: u32,
    end_grating: u32,
}

/// Grooves side by side on one material of an object. See gratings.wgsl.
struct Grating {
    axis: vec3f,                // unit: along the grooves, or the axis that they lie about
    kind: u32,                  // GROOVES_ALONG and so on
    center_m: vec3f,            // on the axis; of grooves along a direction, what the radii are counted from
    curvature_per_m: f32,       // of spun grooves
    radii_m: vec2f,             // the least and the greatest distance from the axis or the middle
    coverage: f32,
    angle_std_rad: f32,         // of a groove to the field
    material: u32,
    table: u32,                 // layer of the scratch tables
    seed: u32,                  // by which grooves are off their places
    pitch_um: f32,
    width_um: f32,
    jitter_pitches: f32,        // standard deviation of how far a groove is off its place
    densest: f32,               // no factor for single grooves is greater: they take no more than there is
    maps: u32,                  // GROOVES_BY_U and so on
    tiles_x: vec4f,             // of a mask from three sides: from a place to the object's frame in widths of the picture, row by row
    tiles_y: vec4f,
    tiles_z: vec4f,
    mask: vec2u,                // a texture, see scene_texture(): its red is a factor on the coverage; zero: none
    directions: vec2u,          // a texture that turns grooves by texture coordinates
    along_row: vec3f,           // unit: along rows of spots, across the axis
    spacing_m: f32,             // from spot to spot; 0: all grooves lie about one axis
}

/// What a surface is made of.
struct Material {
    base_color: vec3f,
    metallic: f32,
    emission: vec3f,
    roughness: f32,
    coherence_um: f32,
    dielectric_f0: f32,
    normal_scale: f32,
    table: u32,                 // layer of the scratch tables
    curve: u32,                 // of fresnel_curves
    is_unlit: u32,              // 1: it sends its base colour and reflects nothing
    base_color_texture: vec2u,  // packed, see scene_texture(); zero: none
    metallic_roughness_texture: vec2u,
    normal_texture: vec2u,
    emission_texture: vec2u,
    alpha: f32,                 // factor on that of the texture and of the vertices
    threshold: f32,             // of the alpha at which the surface is there; negative: it is there everywhere; ALPHA_IS_SHARE
    occlusion_texture: vec2u,
    occlusion_strength: f32,
    coat: u32,                  // share of the surface and roughness of a clear layer over it, in 16 bits each
    coat_texture: vec2u,        // red: factor on the share
    coat_roughness_texture: vec2u, // green: factor on the roughness
    anisotropy: f32,
    anisotropy_direction_rad: f32, // from the tangent
    anisotropy_texture: vec2u,  // red and green: a direction that the former turns; blue: factor on the strength
    specular_color: vec3f,      // factor on dielectric_f0
    specular: f32,              // factor on what a dielectric reflects
    specular_texture: vec2u,    // alpha: factor on the latter
    specular_color_texture: vec2u, // factor on the former
    coat_normal_texture: vec2u,
    coat_normal_scale: f32,
}

/// Spheres come first, then polygons of at most four vertices, then others, then tubes, then rectangles with pictures; behind them, in the
/// same order, lights for scratches alone.
struct Light {
    radiance: vec3f,
    kind: u32,                  // LIGHT_SPHERE, LIGHT_POLYGON or LIGHT_TUBE
    center_m: vec3f,            // of the sphere, or of one around the light
    radius_m: f32,
    normal: vec3f,              // of a polygon, on the side that sees its vertices counter-clockwise
    two_sided: u32,
    first_vertex: u32,          // of those of all lights; of a tube its ends lie there
    vertex_count: u32,
    cone: vec2f,                // cosine at the rim, below all without a cone; 1 over the cosines of the fall-off
    cone_axis: vec3f,
    extras: u32,                // LIGHT_DOORS, LIGHT_PICTURE: what lies behind its vertices, in this order
}

const LIGHT_SPHERE: u32 = 0u;
const LIGHT_POLYGON: u32 = 1u;
const LIGHT_TUBE: u32 = 2u;

/// Barn doors: the direction across, tangents, and 1 over those of the fall-off.
const LIGHT_DOORS: u32 = 1u;
/// A picture: a texture as scene_texture() takes it.
const LIGHT_PICTURE: u32 = 2u;

/// Nodes in depth-first order: a BVH traversal goes on with the next one, or with `skip`. Twin: crates/index.
struct ScratchNode {
    min_m: vec3f,
    skip: u32,
    max_m: vec3f,
    leaf: u32,                  // 0, or the count of segments in the upper 4 bits and the first one in the lower 28
}

/// Packed; segment_from() unpacks.
struct ScratchSegment {
    start_m: vec3f,             // with end_m: the last two bits of each coordinate are of the turn
    width_depth: u32,           // half floats: um, nm
    end_m: vec3f,
    more: u32,                  // normal, table and blur: profile_unpacked()
}

/// The surface point that a pixel sees, as its scratches need it. The surface frame has z along the shading normal and the viewer
/// in the x-z plane.
struct PixelPoint {
    position_m: vec3f,
    object: u32,                // + 1; 0: nothing to shade
    normal: vec3f,              // shading normal on the viewer's side; without an object the unit direction of the ray
    depth_m: f32,               // along the view axis
    axis_x: vec3f,
    coherence_um: f32,
    footprint_um: vec4f,        // one standard deviation of the pixel's filter to the right (xy) and down (zw), in the surface frame
    turns: vec4f,               // how the smooth normal turns over each of them, in the surface frame
    cos_o: f32,                 // of the viewer to the normal
    distance_m: f32,            // to the viewer
    table_and_place: u32,       // layer of the scratch tables in 16 bits; the pixel's place in its tile, in 6; who has its scratches, in 6; pixel_parts_along(); PIXEL_PARTIAL
    leaves: f32,                // how far the surface may be off the plane of shading for each length along it
}

/// Bit of table_and_place: the surface may cover only a part of what lies behind it.
const PIXEL_PARTIAL: u32 = 0x80000000u;

/// Material of a sample's surface, as the base needs it.
struct PixelPaint {
    f0_bits: vec3u,             // F0 and the metal's share: see pixel_f0_pack()
    lobe: u32,                  // roughness and spread of slopes, in 16 bits each; with anisotropy see pixel_lobe_pack()
    diffuse: vec2u,             // 16 bits each; the last are spare
    coat: u32,                  // see coat_pack(); with normals of coats the lower bits of its spread of slopes beside it
    triangle: u32,
    emission: vec3u,            // bits of floats; with normals of coats see pixel_emission_pack()
    curve_bits: u32,            // the curve of fresnel_curves, and more: see pixel_curve_pack()
}

/// Radiance of the base to the viewer, before scratches take their part.
struct BaseLight {
    specular: vec3f,            // reflected at the surface: scratches take from it
    emission_red: f32,
    body: vec3f,                // from under the surface
    emission_green: f32,
    fresnel: vec3f,             // reflectance of the surface towards the viewer
    emission_blue: f32,
}

fn base_emission(light: BaseLight) -> vec3f {
    return vec3f(light.emission_red, light.emission_green, light.emission_blue);
}

/// Sums over the segments of one chunk of a tile's list, for one pixel. Twin: ScratchSums of mask.wgsl.
struct ChunkSum {
    radiance: vec3f,
    share: f32,
    energy: vec3f,
    share_by_line: f32,
}

/// The lights of one dispatch of shade_scratches.
struct LightRange {
    first: u32,
    end: u32,
    adds: u32,                  // 0: the first dispatch, which writes the sums of the mask as well
}

/// One round of rays to one source, of all samples of a strip.
struct ShadowRound {
    source: u32,                // index into the lights; their number for the environment, one more for what scratches send
    round: u32,
    rounds: u32,                // of this picture
    extent_m: f32,              // how far the scene reaches from the origin: what rounding goes by
    first_round: u32,           // rays of earlier pictures, to be averaged with this one
    all_rounds: u32,            // of this one and all that it will be averaged with
    ends_round: u32,            // 1: no further ray of the round goes this way
    first_pick: u32,            // the round of the first scratch that is picked of each sample
    picks: u32,                 // and how many are picked at once
    seed: u32,                  // other random numbers for each
    depth: u32,                 // how many objects light goes by between the samples and the camera
    way: u32,                   // how light leaves the sample; of bounces, the one that the camera sees
}

/// The ways by which light leaves a sample. Twin: src/variant.rs.
const SHADOW_BY_BASE: u32 = 0u;
const SHADOW_BY_SCRATCHES: u32 = 1u;
const SHADOW_BY_GRATINGS: u32 = 2u;

/// A ray from a sample to a source, and the light that it stands for.
struct ShadowRay {
    direction: vec3f,           // unit, world space
    distance_m: f32,            // to the source; 0: there is no ray
    specular: vec3f,            // reflected at the surface, or sent by scratches
    offset_x: f32,              // where it starts, from what the sample shows: standard deviations of the pixel's filter to the right
    body: vec3f,                // from under the surface
    offset_y: f32,              // and down
}

/// Light that rays found in a layer of a sample: sums over rounds; then light, by shadow_traced.wgsl.
struct TracedRays {
    weight: vec3f,              // of rays to sources; its mean is the closed form
    round_weight: f32,          // luminances of the round in hand
    seen: vec3f,                // the part of it whose rays see their source
    round_seen: f32,
    bounced: vec3f,             // light of other objects
    round_bounced: f32,
    around: vec3f,              // what is sent of light of radiance 1 from all around
    open: vec3f,                // the closed form; before that, of scratches, what their rays to objects bring of even light
    share_moments: vec3f,       // sums of x x, x y, y y: luminances of a round's weight and of what of it is seen
    bounced_moments: vec3f,     // sums of 1, y, y y: y is the luminance of what a round brings; then x is that of `around`
}

/// See image/src/traced.rs, which documents it. Sums over the samples of a pixel.
struct TracedLight {
    open: array<f32, 3>,
    around: array<f32, 3>,
    weight: array<f32, 3>,
    seen: array<f32, 3>,
    bounced: array<f32, 3>,
    share_moments: array<f32, 3>,
    bounced_moments: array<f32, 3>,
}

struct TracedPixel {
    rest: array<f32, 3>,
    roughness: f32,
    object: u32,
    diffuse: TracedLight,
    specular: TracedLight,
    scratches: TracedLight,
}

/// A ray from a sample to what may send it light; then what it has met.
struct BounceRay {
    direction: vec3f,           // unit, world space
    distance_m: f32,            // how far it goes; 0: there is no ray, or it met nothing
    throughput: vec3f,          // what of light along the ray reaches the sample that the camera sees
    solid_angle_sr: f32,        // that it stands for
    specular: vec3f,            // what that sample sends of it by its surface, or by its scratches
    triangle: u32,              // that it met
    body: vec3f,                // by its body; or what its scratches send of light of radiance 1 from all around
    object: u32,
    place: vec2f,               // where it starts: standard deviations of the pixel's filter; then where it ends, barycentric
}

/// Sums over the samples of a pixel: who reads them divides by their count.
struct FilmPixel {
    base: vec3f,
    depth_m: f32,
    scratches: vec3f,
    coverage: f32,
    density: vec3f,
    samples: u32,               // samples that are complete
    normal: vec3f,
    edge: u32,                  // 0; of a pixel with an edge or a crease its number among those of its tile, from 1
}

struct Film {
    gave_up: atomic<u32>,       // invocations whose loops the device cut short: the host discards the picture
    short: u32,                 // 0; or the step + 1 from which on there was no room, where all later ones count as 1: these have added nothing
    pixels: array<FilmPixel>,
}

/// Digit of a tile's number that a pass of the radix sort looks at.
struct SortSettings {
    shift: u32,
}

/// A scan of prefix sums.
struct ScanSettings {
    count: u32,
}

/// Settings of a dispatch of the filter.
struct FilterSettings {
    size_px: vec2u,             // of the picture
    first_row: u32,             // of the band
    rows: u32,
    step: u32,                  // pixels between those that are averaged
    rounds: u32,                // that found what there is
    layer: u32,                 // FILTER_DIFFUSE and so on
    noise_std: f32,             // this and what follows: the numbers of image/src/filter.rs
    off_plane: f32,
    normal_power: f32,
    rough_normals: f32,
    outline_px: i32,
    mirror_step_px: f32,
    rough_step_px: f32,
    variance_px: i32,
    outlier_std: f32,
    least_around: f32,
    least_alike: f32,
}

/// Settings for showing a film.
struct DisplaySettings {
    size_px: vec2u,
    tone_map: u32,
    gain: f32,                  // 2^exposure_ev
}
