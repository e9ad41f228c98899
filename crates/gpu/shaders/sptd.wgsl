// The GGX lobe over a sphere by a pivot transform: the published method, kept to be compared with (ltc_sphere is the default).
// Needs ggx, irradiance, lobe_table, ltc. Twin: optics::sptd, where the paper is named.

struct SptdLobe {
    x_axis: vec2f,
    gap: f32,
    albedo: f32,
    pivot: vec3f,
}

struct SphericalCap {
    axis: vec3f,
    cosine: f32,
    sine: f32,
}

fn sptd_lobe(wo: vec3f, roughness: f32, sptd_table: texture_2d<f32>, albedo_table: texture_2d<f32>) -> SptdLobe {
    let cos_o = max(wo.z, LOBE_MIN_COS);
    let shape = lobe_table_lookup(sptd_table, roughness, cos_o);
    let frame = lobe_viewer_frame(wo);
    let alpha = ggx_alpha(roughness);
    let lean = alpha * shape.y * frame.sin_cos.x;
    let width = alpha * shape.x;
    let r = (1.0 - width) / (1.0 + width);
    let x = frame.sin_cos.x * cos(lean) - frame.sin_cos.y * sin(lean);
    let z = frame.sin_cos.y * cos(lean) + frame.sin_cos.x * sin(lean);
    return SptdLobe(
        frame.x_axis,
        4.0 * width / ((1.0 + width) * (1.0 + width)),
        lobe_albedo_lookup(albedo_table, roughness, cos_o).x,
        r * vec3f(-x, 0.0, z),
    );
}

fn sptd_transform_cap(lobe: SptdLobe, cap: SphericalCap) -> SphericalCap {
    let push = 2.0 * (dot(cap.axis, lobe.pivot) - cap.cosine) / lobe.gap;
    let axis = cap.axis + push * lobe.pivot;
    let scale = 1.0 / max(length(axis), 1e-30);
    return SphericalCap(
        axis * scale,
        clamp(-(cap.cosine + push) * scale, -1.0, 1.0),
        min(cap.sine * scale, 1.0),
    );
}

fn sptd_horizon() -> SphericalCap {
    return SphericalCap(vec3f(0.0, 0.0, 1.0), 0.0, 1.0);
}

fn sptd_horizon_share(lobe: SptdLobe) -> f32 {
    return max(0.5 * (1.0 - sptd_transform_cap(lobe, sptd_horizon()).cosine), 1e-6);
}

fn sptd_cap_solid_angle(cap: SphericalCap) -> f32 {
    if (cap.cosine > 0.0) {
        return 2.0 * GGX_PI * cap.sine * cap.sine / (1.0 + cap.cosine);
    }
    return 2.0 * GGX_PI * (1.0 - cap.cosine);
}

fn sptd_cap_intersection(a: SphericalCap, b: SphericalCap) -> f32 {
    let cos_d = clamp(dot(a.axis, b.axis), -1.0, 1.0);
    let sin_d = length(cross(a.axis, b.axis));
    let both = a.sine * b.sine;
    let corner = cos_d - a.cosine * b.cosine;
    let area_a = sptd_cap_solid_angle(a);
    let area_b = sptd_cap_solid_angle(b);
    if (corner >= both) {
        return min(area_a, area_b);
    }
    if (corner <= -both) {
        return max(area_a + area_b - 4.0 * GGX_PI, 0.0);
    }
    let half_a = sptd_angle(b.cosine - cos_d * a.cosine, sin_d * a.sine);
    let half_b = sptd_angle(a.cosine - cos_d * b.cosine, sin_d * b.sine);
    return max(2.0 * (GGX_PI - sptd_angle(corner, both) - a.cosine * half_a - b.cosine * half_b), 0.0);
}

// acos(cosine / limit)
fn sptd_angle(cosine: f32, limit: f32) -> f32 {
    return irradiance_angle(sqrt(max((limit - cosine) * (limit + cosine), 0.0)), cosine);
}

fn sptd_sphere(lobe: SptdLobe, axis: vec3f, sin2: f32) -> f32 {
    if (sin2 >= 1.0) {
        return lobe.albedo;
    }
    if (sin2 <= 0.0) {
        return 0.0;
    }
    let light = SphericalCap(lobe_rotate(lobe.x_axis, axis), sqrt(1.0 - sin2), sqrt(sin2));
    let lit = sptd_cap_intersection(
        sptd_transform_cap(lobe, light),
        sptd_transform_cap(lobe, sptd_horizon()),
    );
    return lobe.albedo * min(lit / (4.0 * GGX_PI * sptd_horizon_share(lobe)), 1.0);
}

fn sptd_sphere_light(
    wo: vec3f,
    roughness: f32,
    axis: vec3f,
    sin2: f32,
    sptd_table: texture_2d<f32>,
    albedo_table: texture_2d<f32>,
) -> f32 {
    return sptd_sphere(sptd_lobe(wo, roughness, sptd_table, albedo_table), axis, sin2);
}
