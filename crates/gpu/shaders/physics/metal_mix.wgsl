// A surface that is a metal in part, and a dielectric over a body in the other: glTF's mix of two materials. Twin: optics::metal_mix, which has the reasons.
// Needs: ggx.

struct MetalMix {
    scattered_at_normal: vec3f, // by which multiple scattering adds to the lobe of the mix
    body_share: vec3f,          // of the light that the dielectric lets through to the body
}

// `metallic` is the metal's share, `f0` and `f90` the mixed reflectances, `diffuse` the body's albedo times the dielectric's share. `albedo` is
// that of the lobe by single scattering, and `e0` the one with F = 1.
fn metal_mix(metallic: f32, f0: vec3f, f90: f32, diffuse: vec3f, albedo: vec3f, e0: f32) -> MetalMix {
    let plastic = 1.0 - metallic;
    if metallic <= 0.0 || plastic <= 0.0 {
        return MetalMix(f0, max(1.0 - ggx_area_reflectance(albedo, f0, e0), vec3f(0.0)));
    }
    let low = min(f0.x, min(f0.y, f0.z));
    let t = clamp((min(albedo.x, min(albedo.y, albedo.z)) - e0 * low) / max(f90 - low, 1e-3), 0.0, e0);
    let metal_f0 = min(diffuse / plastic, vec3f(1.0));
    let plastic_f0 = clamp((f0 - metallic * metal_f0) / plastic, vec3f(0.0), vec3f(1.0));
    let of_metal = metallic * (t + (e0 - t) * metal_f0);
    let of_plastic = t * clamp((f90 - metallic) / plastic, 0.0, 1.0) + (e0 - t) * plastic_f0;
    let scattered = of_metal * metal_f0 + plastic * of_plastic * plastic_f0;
    return MetalMix(
        scattered / max(of_metal + plastic * of_plastic, vec3f(1e-9)),
        max(1.0 - ggx_area_reflectance(of_plastic, plastic_f0, e0), vec3f(0.0)),
    );
}
