// egui's triangles, and nothing to choose: a software driver computes both sides of every `if`, for every pixel.

// What a position in points is to be multiplied by to be one of the device.
@group(0) @binding(0) var<uniform> per_point: vec2<f32>;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var filtering: sampler;

struct Corner {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
    @location(1) color: vec4<f32>,
}

@vertex
fn corner(@location(0) point: vec2<f32>, @location(1) uv: vec2<f32>, @location(2) color: vec4<f32>) -> Corner {
    return Corner(vec4(point * per_point + vec2(-1.0, 1.0), 0.0, 1.0), uv, color);
}

// Colours are encoded for the display and multiplied by their alpha, those of images too.
@fragment
fn pixel(in: Corner) -> @location(0) vec4<f32> {
    return in.color * textureSample(image, filtering, in.uv);
}
