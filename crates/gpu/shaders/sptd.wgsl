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

// The hemisphere below the horizon: its image is the smaller one.
fn sptd_nadir() -> SphericalCap {
    return SphericalCap(vec3f(0.0, 0.0, -1.0), 0.0, 1.0);
}

fn sptd_horizon_share(lobe: SptdLobe) -> f32 {
    return max(0.5 * (1.0 + sptd_transform_cap(lobe, sptd_nadir()).cosine), 1e-6);
}

fn sptd_cap_solid_angle(cap: SphericalCap) -> f32 {
    if (cap.cosine > 0.0) {
        return 2.0 * GGX_PI * cap.sine * cap.sine / (1.0 + cap.cosine);
    }
    return 2.0 * GGX_PI * (1.0 - cap.cosine);
}

fn sptd_complement(cap: SphericalCap) -> SphericalCap {
    return SphericalCap(-cap.axis, -cap.cosine, cap.sine);
}

fn sptd_cap_intersection(a: SphericalCap, b: SphericalCap) -> f32 {
    // Of each cap the side that is at most a hemisphere.
    let flip_a = a.cosine < 0.0;
    let flip_b = b.cosine < 0.0;
    var small_a = a;
    var small_b = b;
    if (flip_a) {
        small_a = sptd_complement(a);
    }
    if (flip_b) {
        small_b = sptd_complement(b);
    }
    let lens = sptd_lens(small_a, small_b);
    if (flip_a && flip_b) {
        return max(4.0 * GGX_PI - sptd_cap_solid_angle(small_a) - sptd_cap_solid_angle(small_b) + lens, 0.0);
    }
    if (flip_b) {
        return max(sptd_cap_solid_angle(a) - lens, 0.0);
    }
    if (flip_a) {
        return max(sptd_cap_solid_angle(b) - lens, 0.0);
    }
    return lens;
}

// Of caps that are at most hemispheres: two sectors less the kite between centres and corners.
fn sptd_lens(a: SphericalCap, b: SphericalCap) -> f32 {
    let area_a = sptd_cap_solid_angle(a);
    let area_b = sptd_cap_solid_angle(b);
    let radius_a = irradiance_angle(a.sine, a.cosine);
    let radius_b = irradiance_angle(b.sine, b.cosine);
    let distance = irradiance_angle(length(cross(a.axis, b.axis)), dot(a.axis, b.axis));
    if (distance >= radius_a + radius_b) {
        return 0.0;
    }
    if (distance <= abs(radius_a - radius_b)) {
        return min(area_a, area_b);
    }
    let s = 0.5 * (radius_a + radius_b + distance);
    let rest_a = s - radius_a;
    let rest_b = s - radius_b;
    let rest_d = s - distance;
    let angle_a = 2.0 * irradiance_angle(
        sqrt(max(sin(rest_a) * sin(rest_d), 0.0)),
        sqrt(max(sin(s) * sin(rest_b), 0.0)),
    );
    let angle_b = 2.0 * irradiance_angle(
        sqrt(max(sin(rest_b) * sin(rest_d), 0.0)),
        sqrt(max(sin(s) * sin(rest_a), 0.0)),
    );
    let product = tan(0.5 * s) * tan(0.5 * rest_a) * tan(0.5 * rest_b) * tan(0.5 * rest_d);
    let triangle = 4.0 * irradiance_angle(sqrt(max(product, 0.0)), 1.0);
    return clamp((angle_a * area_a + angle_b * area_b) / GGX_PI - 2.0 * triangle, 0.0, min(area_a, area_b));
}

fn sptd_sphere(lobe: SptdLobe, axis: vec3f, sin2: f32) -> f32 {
    if (sin2 >= 1.0) {
        return lobe.albedo;
    }
    if (sin2 <= 0.0) {
        return 0.0;
    }
    let light = SphericalCap(lobe_rotate(lobe.x_axis, axis), sqrt(1.0 - sin2), sqrt(sin2));
    let image = sptd_transform_cap(lobe, light);
    let hidden = sptd_cap_intersection(image, sptd_transform_cap(lobe, sptd_nadir()));
    let lit = max(sptd_cap_solid_angle(image) - hidden, 0.0);
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
