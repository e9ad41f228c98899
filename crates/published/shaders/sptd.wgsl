// The GGX lobe over a sphere by a pivot transform, as published (ltc_sphere is the default).
// Needs ggx, irradiance, lobe_table, ltc. Twin: src/sptd.rs, which explains the method and names the paper.
// Needs: ltc.

struct SptdLobe {
    axis: vec3f,
    rest: f32,
    pivot: vec3f,
    gap: f32,
    x_axis: vec2f,
    albedo: f32,
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
    let lean = lobe_sin_cos(alpha * shape.y * frame.sin_cos.x);
    let width = alpha * shape.x;
    let rest = 2.0 * width / (1.0 + width);
    let x = frame.sin_cos.x * lean.y - frame.sin_cos.y * lean.x;
    let z = frame.sin_cos.y * lean.y + frame.sin_cos.x * lean.x;
    return SptdLobe(
        vec3f(-x, 0.0, z),
        rest,
        (1.0 - rest) * vec3f(-x, 0.0, z),
        rest * (2.0 - rest),
        frame.x_axis,
        lobe_albedo_lookup(albedo_table, roughness, cos_o),
    );
}

// In what is small near a mirror: the cap's versine and its distance from the peak.
fn sptd_transform_cap(lobe: SptdLobe, cap: SphericalCap) -> SphericalCap {
    var versine = 1.0 - cap.cosine;
    if (cap.cosine > 0.0) {
        versine = cap.sine * cap.sine / (1.0 + cap.cosine);
    }
    let r = 1.0 - lobe.rest;
    let off_peak = cap.axis - lobe.axis;
    let shift = r * dot(off_peak, off_peak);
    let along = lobe.rest * lobe.rest + r * (2.0 * versine - shift);
    let height = lobe.rest * lobe.rest - versine * (2.0 - lobe.gap) + shift;
    let axis = off_peak * lobe.gap + lobe.axis * along;
    let scale = 1.0 / max(length(axis), 1e-30);
    return SphericalCap(
        axis * scale,
        clamp(height * scale, -1.0, 1.0),
        min(cap.sine * lobe.gap * scale, 1.0),
    );
}

// The hemisphere below the horizon: its image is the smaller one.
fn sptd_nadir() -> SphericalCap {
    return SphericalCap(vec3f(0.0, 0.0, -1.0), 0.0, 1.0);
}

fn sptd_horizon_share(lobe: SptdLobe) -> f32 {
    return max(0.5 * (1.0 + sptd_transform_cap(lobe, sptd_nadir()).cosine), 1e-6);
}

fn sptd_cap_area(cap: SphericalCap) -> f32 {
    if (cap.cosine > 0.0) {
        return 2.0 * GGX_PI * cap.sine * cap.sine / (1.0 + cap.cosine);
    }
    return 2.0 * GGX_PI * (1.0 - cap.cosine);
}

fn sptd_complement(cap: SphericalCap) -> SphericalCap {
    return SphericalCap(-cap.axis, -cap.cosine, cap.sine);
}

// The solid angle.
fn sptd_cap_intersection(a: SphericalCap, b: SphericalCap) -> f32 {
    // Replaces each cap by its complement if it is larger than a hemisphere.
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
        return max(sptd_cap_area(a) - max(sptd_cap_area(small_b) - lens, 0.0), 0.0);
    }
    if (flip_b) {
        return max(sptd_cap_area(a) - lens, 0.0);
    }
    if (flip_a) {
        return max(sptd_cap_area(b) - lens, 0.0);
    }
    return lens;
}

// Intersection of caps that are at most hemispheres: two sectors less the kite between centres and corners.
fn sptd_lens(a: SphericalCap, b: SphericalCap) -> f32 {
    let area_a = sptd_cap_area(a);
    let area_b = sptd_cap_area(b);
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
        sqrt(max(sptd_sine(rest_a) * sptd_sine(rest_d), 0.0)),
        sqrt(max(sptd_sine(s) * sptd_sine(rest_b), 0.0)),
    );
    let angle_b = 2.0 * irradiance_angle(
        sqrt(max(sptd_sine(rest_b) * sptd_sine(rest_d), 0.0)),
        sqrt(max(sptd_sine(s) * sptd_sine(rest_a), 0.0)),
    );
    let product = sptd_tangent(0.5 * s) * sptd_tangent(0.5 * rest_a) * sptd_tangent(0.5 * rest_b) * sptd_tangent(0.5 * rest_d);
    let triangle = 4.0 * irradiance_angle(sqrt(max(product, 0.0)), 1.0);
    let sectors = (angle_a * area_a + angle_b * area_b) / GGX_PI;
    return clamp(sectors - 2.0 * triangle, 0.0, min(area_a, area_b));
}

// Of small angles a device's sine has few digits: Taylor's series there, within 1e-7 of itself.
fn sptd_sine(angle: f32) -> f32 {
    let square = angle * angle;
    return select(sin(angle), angle * (1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0))), square < 0.25);
}

fn sptd_tangent(angle: f32) -> f32 {
    return sptd_sine(angle) / cos(angle);
}

fn sptd_sphere_published(lobe: SptdLobe, axis: vec3f, sin2: f32) -> f32 {
    if (sin2 >= 1.0) {
        return lobe.albedo;
    }
    let lit = sptd_visible(lobe, axis, sin2);
    return lobe.albedo * min(lit / (4.0 * GGX_PI * sptd_horizon_share(lobe)), 1.0);
}

// The solid angle of the image of what is above the horizon.
fn sptd_visible(lobe: SptdLobe, axis: vec3f, sin2: f32) -> f32 {
    let square = max(sin2, 0.0);
    let light = SphericalCap(lobe_rotate(lobe.x_axis, axis), sqrt(1.0 - square), sqrt(square));
    let image = sptd_transform_cap(lobe, light);
    let hidden = sptd_cap_intersection(image, sptd_transform_cap(lobe, sptd_nadir()));
    return max(sptd_cap_area(image) - hidden, 0.0);
}
