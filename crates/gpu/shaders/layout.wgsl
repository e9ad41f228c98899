// Every struct that the host fills. `layout.rs` holds the twins; a test compares names and offsets.
// Positions are relative to the scene's origin (the middle of its bounds), metres.

// One picture sample: the view, and what is the same for every pixel.
struct Frame {
    camera: vec3f,            // the pinhole
    near: f32,                // distance of the near plane along `forward`, metres
    right: vec3f,             // unit
    tan_half_fov_x: f32,
    up: vec3f,                // unit
    tan_half_fov_y: f32,
    forward: vec3f,           // unit
    footprint_std_px: f32,    // standard deviation of the Gaussian that shading filters with
    size_px: vec2u,
    rows: vec2u,              // first row of the film and the one after its last
    jitter_px: vec2f,         // where in the pixel this sample lies, from its centre, y down
    sample_weight: f32,       // the weights of a pixel's samples sum to one
    light_count: u32,
    environment_intensity: f32,   // 0: there is none
    environment_rotation: f32,    // radians about the up axis
    environment_levels: f32,      // mip levels; roughness picks one
    environment_visible: f32,     // 1: seen behind the objects
    environment_sh: array<vec4f, 9>,   // irradiance, spherical harmonics of order 2
}
