// Bindings of the scene. Twin: src/bindings.rs. Group 3 is each pass's own.
// Needs: layout.

@group(0) @binding(0) var<uniform> frame: Frame;

@group(1) @binding(0) var<storage, read> vertices: array<Vertex>;
@group(1) @binding(1) var<storage, read> objects: array<Object>;
// Arrays of Material, Light (and behind them vertices of polygons) and ScratchSegment; rows.wgsl reads them.
@group(1) @binding(2) var materials: texture_2d<u32>;
@group(1) @binding(3) var lights: texture_2d<u32>;
@group(1) @binding(4) var scratch_segments: texture_2d<u32>;

@group(2) @binding(0) var scratch_tables: texture_2d_array<u32>;
@group(2) @binding(1) var lobe_albedo: texture_2d<f32>;
// The transformed cosine, and the look-ups of environments under it.
@group(2) @binding(2) var lobe_shapes: texture_2d<f32>;
@group(2) @binding(3) var environment_background: texture_2d<f32>;
@group(2) @binding(4) var environment_levels: texture_2d<f32>;
@group(2) @binding(5) var textures: texture_2d_array<f32>;
// Curves of reflectance over the angle; fresnel.wgsl says how they lie.
@group(2) @binding(6) var fresnel_curves: texture_2d<f32>;
