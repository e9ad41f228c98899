// Rec.709 luminance. Twin: cpu/src/sampling.rs.

fn rgb_luminance(rgb: vec3f) -> f32 {
    return dot(rgb, vec3f(0.2126, 0.7152, 0.0722));
}
