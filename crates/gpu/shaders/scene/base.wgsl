// The base under lights and environment: a GGX lobe over a diffuse body. Twin: cpu/src/shade_base.rs.
// Needs: scene, lights, picture_light, filtered_lobe, environment_lobe, brushed_outline, coat, metal_mix.

// Needs, beside its modules: lights, lobe_shapes, lobe_albedo, fresnel_curves, and the environment.

struct BaseRadiance {
    specular: vec3f,            // reflected at the surface; scratches take from it
    diffuse: vec3f,             // from the body under it
}

// Light that falls on a lobe, as its vector irradiance in the cosine's space, and on the body, as a form factor.
struct LightOnBase {
    vector: vec3f,
    form_factor: f32,
}

fn base_sphere(point: SurfacePoint, lobe: LtcLobe, light: Light) -> LightOnBase {
    let center = surface_from_world(point, light.center_m - point.position_m);
    if center.z <= -light.radius_m {
        return LightOnBase(vec3f(0.0), 0.0);
    }
    let cap = sphere_cap(center, light.radius_m);
    let sin2 = cap_sin_sq(cap);
    return LightOnBase(ltc_sphere_vector(lobe, cap.axis, sin2), base_lambert_sphere(cap.axis, sin2));
}

fn base_lambert_sphere(axis: vec3f, sin2: f32) -> f32 {
    var form_factor = 0.0;
    if HAS_BODIES {
        form_factor = lambert_sphere(axis, sin2);
    }
    return form_factor;
}

fn base_polygon(point: SurfacePoint, lobe: LtcLobe, light: Light) -> LightOnBase {
    let outline = surface_outline(point, light);
    if outline.facing == 0.0 {
        return LightOnBase(vec3f(0.0), 0.0);
    }
    var specular = ltc_begin();
    var diffuse = lambert_begin();
    var a = outline_corner_m(lights, outline, 0u);
    var highest_z = a.z;
    for (var i = 0u; i < light.vertex_count; i += 1u) {
        let b = outline_corner_m(lights, outline, i + 1u);
        ltc_edge(&specular, lobe, a, b);
        if HAS_BODIES {
            lambert_edge(&diffuse, a, b);
        }
        highest_z = max(highest_z, b.z);
        a = b;
    }
    if highest_z <= 0.0 {
        return LightOnBase(vec3f(0.0), 0.0);
    }
    return LightOnBase(irradiance_end(specular), lambert_end(diffuse));
}

// Light of a light with a picture on a lobe and the body.
struct PictureOnBase {
    seen: LightOnBase,
    mean: BaseRadiance,         // what the lobe reflects of the picture and what falls on the body, over what it would be of an even one
}

// Part by part. Twins: on_lobe and on_body of cpu/src/picture.rs.
fn base_picture(point: SurfacePoint, lobe: LtcLobe, reflecting: LobeFresnel, light: Light) -> PictureOnBase {
    var on: PictureOnBase;
    if surface_outline(point, light).facing == 0.0 {
        return on;
    }
    let picture = light_picture(light);
    let axes = mat3x3f(point.axis_x, point.axis_y, point.normal);
    let plane = light_picture_plane(light, point.position_m, axes);
    var on_lobes = vec3f(0.0);
    for (var i = 0u; i < PICTURE_PARTS * PICTURE_PARTS; i += 1u) {
        let part = picture_part(plane, i);
        // For the lobe in the cosine's space, then for the body: the code stands in it once, as passes with it are long.
        for (var k = 0u; k < select(1u, 2u, HAS_BODIES); k += 1u) {
            var as_seen = part;
            if k == 0u {
                as_seen = PicturePlane(
                    ltc_to_cosine(lobe, lobe_rotate(lobe.x_axis, part.corner)),
                    ltc_to_cosine(lobe, lobe_rotate(lobe.x_axis, part.right)),
                    ltc_to_cosine(lobe, lobe_rotate(lobe.x_axis, part.up)),
                );
            }
            let vector = picture_irradiance(as_seen, light.vertex_count);
            if vector.z <= 0.0 {
                continue;
            }
            let radiance = picture_part_at(picture, picture_look(as_seen, vector), i);
            if k == 0u {
                let reflected = ltc_small_light(lobe, reflecting, fresnel_curves, vector);
                on_lobes += reflected;
                on.seen.vector += vector;
                on.mean.specular += (radiance - on.mean.specular) * (reflected / max(on_lobes, vec3f(1e-30)));
            } else {
                let form_factor = vector.z / GGX_PI;
                on.seen.form_factor += form_factor;
                on.mean.diffuse += (radiance - on.mean.diffuse) * (form_factor / on.seen.form_factor);
            }
        }
    }
    return on;
}

// The vector irradiance of a parallelogram.
fn picture_irradiance(plane: PicturePlane, corners: u32) -> vec3f {
    var state = irradiance_begin();
    var a = plane.corner;
    // The loop is not unrolled: it runs over a light's corners.
    for (var i = 0u; i < corners; i += 1u) {
        let along = select(plane.right, plane.up, (i & 1u) != 0u);
        let b = plane.corner + select(vec3f(0.0), plane.right, i < 2u) + select(vec3f(0.0), plane.up, i == 1u || i == 2u);
        irradiance_edge(&state, a, b, select(along, -along, i > 1u));
        a = b;
    }
    return irradiance_end(state);
}

// From the point's frame to that of the environment's maps.
fn base_map_from_surface(point: SurfacePoint) -> mat3x3f {
    return frame.environment_from_world * mat3x3f(point.axis_x, point.axis_y, point.normal);
}

// Light from all around that the lobe reflects, single scattering, and that falls on the body.
fn base_environment(point: SurfacePoint, lobe: LtcLobe, reflecting: LobeFresnel) -> BaseRadiance {
    let reflected = environment_reflected(lobe, reflecting, lobe_shapes, environment_levels, base_map_from_surface(point));
    return BaseRadiance(frame.environment_texel_radiance * reflected, scene_irradiance(point.normal) / 3.14159265);
}

// A lobe of a point.
struct Layer {
    is_brushed: bool,           // its facets lean further one way: `sharp` has its albedo alone
    sharp: LtcLobe,
    reflecting: LobeFresnel,
    albedo: vec3f,              // of light from all around
}

fn layer_of(point: SurfacePoint, fresnel: FresnelRgb, roughness: f32) -> Layer {
    let sharp = ltc_lobe(point.wo, roughness, lobe_shapes, lobe_albedo);
    let reflecting = lobe_fresnel(fresnel, point.wo, roughness, fresnel_curves);
    var layer = Layer(false, sharp, reflecting, vec3f(0.0));
    layer.albedo = layer_of_single(point, layer, reflecting.albedo);
    return layer;
}

fn base_layer(point: SurfacePoint) -> Layer {
    return layer_brushed(point, layer_of(point, FresnelRgb(point.f0, point.f90, point.curve), point.roughness));
}

fn base_facets(point: SurfacePoint) -> FacetAxes {
    let alpha = ggx_alpha(point.roughness);
    return FacetAxes(point.long_axis, vec2f(max(point.long_alpha, alpha), alpha));
}

// As it is for a light at 1 / `per_m` metres.
fn base_brushed_lobe(point: SurfacePoint, per_m: f32) -> BrushedLobe {
    return brushed_lobe(point.wo, base_facets(point), surface_slope_spread(point, per_m));
}

// The same of a round lobe.
fn layer_filtered(point: SurfacePoint, layer: Layer, per_m: f32) -> FilteredLobe {
    return filtered_lobe(layer.sharp.alpha, surface_slope_spread(point, per_m), point.wo.z);
}

// The layer with the albedos of facets that lean further one way, where they do.
fn layer_brushed(point: SurfacePoint, round: Layer) -> Layer {
    var layer = round;
    if HAS_ANISOTROPY && point.long_alpha > 0.0 {
        let fresnel = round.reflecting.fresnel;
        let albedo = brushed_albedo(base_brushed_lobe(point, 0.0), fresnel, fresnel_curves);
        layer.is_brushed = true;
        layer.sharp.albedo = albedo.w;
        layer.reflecting.albedo = albedo.xyz;
        layer.albedo = layer_of_single(point, layer, albedo.xyz);
    }
    return layer;
}

fn coat_layer(point: SurfacePoint) -> Layer {
    return layer_of(surface_of_coat(point), coat_fresnel(), surface_coat(point.coat).y);
}

fn layer_mix(point: SurfacePoint, layer: Layer) -> MetalMix {
    let fresnel = layer.reflecting.fresnel;
    return metal_mix(point.metallic, fresnel.at_normal, fresnel.at_grazing, point.diffuse, layer.reflecting.albedo, layer.sharp.albedo);
}

// Adds multiple scattering to the light of single scattering.
fn layer_of_single(point: SurfacePoint, layer: Layer, single: vec3f) -> vec3f {
    // The fit may make the second part a little larger than the first.
    return ggx_area_reflectance(max(single, vec3f(0.0)), layer_mix(point, layer).scattered_at_normal, layer.sharp.albedo);
}

// Light that the body sends, over the light that falls on the base: it gets what the lobe over it does not reflect.
fn base_body(point: SurfacePoint, layer: Layer) -> vec3f {
    return point.diffuse * layer_mix(point, layer).body_share;
}

// The base under a layer that covers a share of it, has an albedo, and reflects so much by itself.
fn base_coated(share: f32, albedo: vec3f, base: BaseRadiance, by_coat: vec3f) -> BaseRadiance {
    let passed = share * max(1.0 - albedo, vec3f(0.0));
    let bare = 1.0 - share;
    return BaseRadiance(base.specular * bare + share * by_coat, base.diffuse * (passed + bare) + base.specular * passed);
}

// Radiance of the base towards the viewer, before scratches take theirs.
fn base_radiance(point: SurfacePoint) -> BaseRadiance {
    return base_radiance_of(point, vec2u(0u, frame.light_count), true);
}

// Radiance of the base by some of the lights, from the first to the one before the end, and from all around or not.
fn base_radiance_of(point: SurfacePoint, of_lights: vec2u, surrounded: bool) -> BaseRadiance {
    if !HAS_COATS {
        let layer = base_layer(point);
        let lit = layer_lit(point, layer, of_lights, surrounded);
        return BaseRadiance(layer_of_single(point, layer, lit.specular), lit.diffuse * base_body(point, layer));
    }
    let coat = surface_coat(point.coat);
    var base: BaseRadiance;
    // The code of a layer stands in it once: passes with it are long.
    for (var i = 0u; i < select(1u, 2u, coat.x > 0.0); i += 1u) {
        var fresnel = FresnelRgb(point.f0, point.f90, point.curve);
        var roughness = point.roughness;
        var seen = surface_under_coat(point);
        if i > 0u {
            fresnel = coat_fresnel();
            roughness = coat.y;
            seen = surface_of_coat(point);
        }
        var layer = layer_of(seen, fresnel, roughness);
        if i == 0u {
            layer = layer_brushed(seen, layer);
        }
        let lit = layer_lit(seen, layer, of_lights, surrounded);
        let single = layer_of_single(seen, layer, lit.specular);
        if i > 0u {
            base = base_coated(coat.x, layer.albedo, base, single);
        } else {
            base = BaseRadiance(single, lit.diffuse * base_body(point, layer));
        }
    }
    return base;
}

// Light from all around that a round lobe reflects, single scattering, and that falls on a body under it.
fn layer_surrounded(point: SurfacePoint, layer: Layer) -> BaseRadiance {
    var sum: BaseRadiance;
    if HAS_ENVIRONMENT {
        let filtered = filtered_lobe_around(layer.sharp.alpha, surface_slope_spread(point, 0.0), point.wo.z);
        for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
            let part = filtered_lobe_part(layer.sharp, filtered, p);
            if part.core == 0.0 {
                break;
            }
            let light = base_environment(point, part.lobe, layer.reflecting);
            sum.specular += part.core * (light.specular * point.open);
            // The body's light is the same by every part.
            sum.diffuse = light.diffuse * point.open;
        }
    }
    return sum;
}

// Light that a lobe reflects, single scattering, and that falls on a body under it.
fn layer_lit(point: SurfacePoint, layer: Layer, of_lights: vec2u, surrounded: bool) -> BaseRadiance {
    if HAS_ANISOTROPY && layer.is_brushed {
        return brushed_lit(point, layer, of_lights, surrounded);
    }
    var sum: BaseRadiance;
    if surrounded {
        sum = layer_surrounded(point, layer);
    }
    for (var l = of_lights.x; l < of_lights.y; l += 1u) {
        let source = light_at(l);
        let radiance = light_radiance(source, point.position_m);
        let filtered = layer_filtered(point, layer, light_per_m(source, point.position_m));
        var far = FilteredLobeFar(0.0, 1.0);
        for (var p = 0u; p < FILTERED_LOBE_PARTS; p += 1u) {
            let part = filtered_lobe_part(layer.sharp, filtered, p);
            if p > 0u && filtered_lobe_weight(part, far) == 0.0 {
                continue;
            }
            var seen: LightOnBase;
            var on_lobe = radiance;
            var on_body = radiance;
            if HAS_SPHERES && source.kind == LIGHT_SPHERE {
                seen = base_sphere(point, part.lobe, source);
            } else if light_has_picture(source) {
                let picture = base_picture(point, part.lobe, layer.reflecting, source);
                seen = picture.seen;
                on_lobe *= picture.mean.specular;
                on_body *= picture.mean.diffuse;
            } else if HAS_POLYGONS {
                seen = base_polygon(point, part.lobe, source);
            }
            if p == 0u {
                far = filtered_lobe_far(filtered, seen.vector);
            }
            let weight = filtered_lobe_weight(part, far);
            if weight != 0.0 {
                sum.specular += weight * on_lobe * ltc_reflected(part.lobe, layer.reflecting, fresnel_curves, seen.vector);
            }
            sum.diffuse += select(vec3f(0.0), on_body * seen.form_factor, p == 0u);
        }
    }
    return sum;
}

// layer_lit() for facets that lean further one way, slice by slice.
fn brushed_lit(point: SurfacePoint, layer: Layer, of_lights: vec2u, surrounded: bool) -> BaseRadiance {
    let fresnel = layer.reflecting.fresnel;
    var sum: BaseRadiance;
    if surrounded && HAS_ENVIRONMENT {
        let lobe = base_brushed_lobe(point, 0.0);
        let mean = brushed_around(lobe, fresnel, fresnel_curves, environment_levels, base_map_from_surface(point));
        sum.specular = layer.reflecting.albedo * mean * (frame.environment_texel_radiance * point.open);
        sum.diffuse = scene_irradiance(point.normal) / 3.14159265 * point.open;
    }
    for (var l = of_lights.x; l < of_lights.y; l += 1u) {
        let source = light_at(l);
        let radiance = light_radiance(source, point.position_m);
        let lobe = base_brushed_lobe(point, light_per_m(source, point.position_m));
        // Chord for the body's light, and for the weights of a picture's parts.
        let chord = brushed_chord(lobe, ltc_lobe(point.wo, brushed_chord_roughness(lobe), lobe_shapes, lobe_albedo));
        var seen: LightOnBase;
        var on_lobe = radiance;
        var on_body = radiance;
        if HAS_SPHERES && source.kind == LIGHT_SPHERE {
            seen = base_sphere(point, chord, source);
            on_lobe *= brushed_light_sphere(point, lobe, fresnel, source);
        } else {
            if light_has_picture(source) {
                let picture = base_picture(point, chord, layer.reflecting, source);
                seen = picture.seen;
                on_lobe *= picture.mean.specular;
                on_body *= picture.mean.diffuse;
            } else if HAS_POLYGONS && HAS_BODIES {
                seen = base_polygon(point, chord, source);
            }
            if HAS_POLYGONS {
                on_lobe *= brushed_outline(lobe, fresnel, fresnel_curves, lights, surface_outline(point, source));
            }
        }
        sum.specular += on_lobe;
        sum.diffuse += on_body * seen.form_factor;
    }
    return sum;
}

fn brushed_light_sphere(point: SurfacePoint, lobe: BrushedLobe, fresnel: FresnelRgb, light: Light) -> vec3f {
    let center = surface_from_world(point, light.center_m - point.position_m);
    if center.z <= -light.radius_m {
        return vec3f(0.0);
    }
    let cap = sphere_cap(center, light.radius_m);
    let sin2 = cap_sin_sq(cap);
    return brushed_sphere(lobe, cap.axis, sin2, fresnel, fresnel_curves);
}
