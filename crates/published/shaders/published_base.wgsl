// The base under lights and environment, spheres by the pivot transform of 2017. Twin: src/cpu.rs; base.wgsl
// explains what is the same there.
// Needs: base, sptd, published_lights.

// The lobe's integrals and the diffuse form factor of a light.
fn published_base_sphere(point: SurfacePoint, lobe: LtcLobe, reflecting: LobeFresnel, pivot: SptdLobe, light: Light) -> vec4f {
    if dot(light.center_m - point.position_m, point.normal) <= -light.radius_m {
        return vec4f(0.0);
    }
    let cap = light_cap(point, light);
    let sin2 = cap_sin_sq(cap);
    // The published fit knows F = 1 alone; Fresnel is that of the whole lobe.
    let specular = reflecting.albedo * (sptd_sphere_published(pivot, cap.axis, sin2) / max(lobe.albedo, 1e-30));
    return vec4f(specular, base_lambert_sphere(cap.axis, sin2));
}

// Radiance of the base towards the viewer, before scratches take theirs.
fn published_base(point: SurfacePoint) -> BaseRadiance {
    let under_coat = surface_under_coat(point);
    let layer = base_layer(under_coat);
    var base = published_layer(under_coat, layer);
    base = BaseRadiance(layer_of_single(under_coat, layer, base.specular), base.diffuse * base_body(under_coat, layer));
    let share = surface_coat(point.coat).x;
    if HAS_COATS && share > 0.0 {
        let coat = coat_layer(point);
        base = base_coated(share, coat.albedo, base, layer_of_single(surface_of_coat(point), coat, published_layer(point, coat).specular));
    }
    return base;
}

fn published_layer(point: SurfacePoint, layer: Layer) -> BaseRadiance {
    // The pivot transform knows round lobes alone.
    if HAS_ANISOTROPY && layer.is_brushed {
        return brushed_lit(point, layer, vec2u(0u, frame.light_count), true);
    }
    var sum = layer_surrounded(point, layer);
    for (var l = 0u; l < frame.light_count; l += 1u) {
        let source = light_at(l);
        let radiance = published_light_radiance(source, point.position_m);
        let filtered = layer_filtered(point, layer, light_per_m(source, point.position_m));
        var far = FilteredLobeFar(0.0, 1.0);
        for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
            let part = filtered_lobe_part(layer.sharp, filtered, p);
            if p > 0u && filtered_lobe_weight(part, far) == 0.0 {
                continue;
            }
            var share: vec4f;
            var vector: vec3f;
            if HAS_SPHERES && source.kind == LIGHT_SPHERE {
                // The pivot transform knows round lobes alone.
                let alphas = part.lobe.alphas;
                let pivot = sptd_lobe(point.wo, min(sqrt(sqrt(alphas.x * alphas.y)), 1.0), lobe_sptd, lobe_albedo);
                share = published_base_sphere(point, part.lobe, layer.reflecting, pivot, source);
                vector = base_sphere(point, part.lobe, source).vector;
            }
            if HAS_POLYGONS && source.kind != LIGHT_SPHERE {
                let seen = base_polygon(point, part.lobe, source);
                vector = seen.vector;
                share = vec4f(ltc_reflected(part.lobe, layer.reflecting, fresnel_curves, seen.vector), seen.form_factor);
            }
            if p == 0u {
                far = filtered_lobe_far(filtered, vector);
            }
            sum.specular += filtered_lobe_weight(part, far) * radiance * share.xyz;
            sum.diffuse += select(vec3f(0.0), radiance * share.w, p == 0u);
        }
    }
    return sum;
}
