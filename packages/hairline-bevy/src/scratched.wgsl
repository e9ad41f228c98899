// Bevy's standard material with Hairline's base, coat, scratches and gratings: lights of Bevy in closed form, with Bevy's shadows and environments.

#import bevy_pbr::{
    ambient::ambient_light,
    clustered_forward::{get_clusterable_object_id, unpack_clusterable_object_index_ranges, view_fragment_cluster_index},
    forward_io::{FragmentOutput, VertexOutput},
    lighting::{F_AB, LAYER_BASE, LayerLightingInput, LightingInput, getRangeFalloff, perceptualRoughnessToRoughness},
    mesh_functions::get_world_from_local,
    mesh_types::MESH_FLAGS_SHADOW_RECEIVER_BIT,
    mesh_view_bindings::{clustered_lights, lights, view},
    mesh_view_types::{
        DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT, POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT, POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE,
    },
    pbr_bindings,
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, calculate_F0, calculate_F0_dielectric, main_pass_post_lighting_processing},
    pbr_types::{PbrInput, STANDARD_MATERIAL_FLAGS_UNLIT_BIT},
    shadows::{fetch_directional_shadow, fetch_point_shadow, fetch_spot_shadow},
}
#ifdef ENVIRONMENT_MAP
#import bevy_pbr::environment_map::{compute_radiances, environment_map_light}
#ifdef STANDARD_MATERIAL_ANISOTROPY
#import bevy_pbr::pbr_functions::bend_normal_for_anisotropy
#endif
#endif
#import hairline::{
    BaseLit, BrushedBase, ENVIRONMENT_CELLS, FresnelRgb, GratedPoint, GrooveField, Grooves, LitBase, PixelFrame, QuadLight, ROW_CELLS, SCRATCH_TREE_END,
    SCRATCHED_FILTER_STD, ScratchedCell, ScratchedPoint, brushed_base, brushed_base_quad, brushed_base_sphere, fresnel_eval, grated_cell, grated_point,
    grated_quad, grated_sphere, grated_taken, grooves_seen, lit_base, lit_base_body, lit_base_mixed, lit_base_quad, lit_base_reflected, lit_base_sphere, mask_resolve,
    pixel_frame, pixel_slopes, quad_light, scratch_tree_depth_coherence, scratch_walk_next, scratched_cell, scratched_point, scratched_quad,
    scratched_seen, scratched_sphere, scratched_sums, scratched_walk, scratched_with,
}

struct Settings {
    metres_from_mesh: mat4x4f,      // from the mesh's own frame to that of scratches and gratings
    gratings: array<mat4x4f, 4>,    // as grooves() reads them
    grating_count: u32,
    curve: u32,                     // of reflectance over the angle, in `curves`
    coat_curve: u32,
    light_radius_m: f32,            // of point and spot lights without one
}

@group(#{MATERIAL_BIND_GROUP}) @binding(100) var tree: texture_2d<u32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(101) var tables: texture_2d_array<u32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(102) var shapes: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(103) var albedo: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(104) var curves: texture_2d<f32>;
@group(#{MATERIAL_BIND_GROUP}) @binding(105) var<uniform> settings: Settings;

const PI: f32 = 3.14159265;
// Distance of a directional light.
const FAR_M: f32 = 1000.0;
// Angular radius of a directional light without a size: the sun's.
const SUN_RAD: f32 = 0.00465;
// Reflectance of every clear coat at normal incidence.
const COAT_F0: f32 = 0.04;

// A material's base: round, or brushed.
struct Base {
#ifdef STANDARD_MATERIAL_ANISOTROPY
    brushed: BrushedBase,
#else
    round: LitBase,
#endif
}

// Surface that is lit, and the light that has been summed.
struct Lit {
    here: PixelFrame,               // of the base
    top: PixelFrame,                // of the coat, or of the base without one: scratches and gratings lie there
    base: Base,
    point: ScratchedPoint,
    covered: f32,                   // share of the pixel that gratings would cover
    specular: vec3f,
    diffuse: vec3f,
    scratches: vec3f,
    gratings: vec3f,
#ifdef STANDARD_MATERIAL_CLEARCOAT
    coat: LitBase,
    coat_specular: vec3f,
#endif
}

fn view_from_world() -> mat3x3f {
    return mat3x3f(view.view_from_world[0].xyz, view.view_from_world[1].xyz, view.view_from_world[2].xyz);
}

// Converts a point from world space into the surface's frame, relative to the point.
fn to_surface(here: PixelFrame, world: vec3f) -> vec3f {
    return here.surface_from_view * ((view.view_from_world * vec4f(world, 1.0)).xyz - here.position_view);
}

fn round_base(base: Base) -> LitBase {
#ifdef STANDARD_MATERIAL_ANISOTROPY
    return base.brushed.lit;
#else
    return base.round;
#endif
}

fn base_sphere(base: Base, center: vec3f, radius: f32) -> BaseLit {
#ifdef STANDARD_MATERIAL_ANISOTROPY
    return brushed_base_sphere(base.brushed, curves, center, radius);
#else
    return lit_base_sphere(base.round, curves, center, radius);
#endif
}

fn base_quad(base: Base, light: QuadLight) -> BaseLit {
#ifdef STANDARD_MATERIAL_ANISOTROPY
    return brushed_base_quad(base.brushed, curves, light);
#else
    return lit_base_quad(base.round, curves, light);
#endif
}

#ifdef GRATED
fn grooves(i: u32) -> Grooves {
    let field = settings.gratings[i];
    let rows = GrooveField(field[0].xyz, u32(field[0].w), field[2].xy, field[1].w, field[2].z, field[2].w);
    return Grooves(rows, field[1].xyz, field[3].x, u32(field[3].z), field[3].y > 0.0, field[3].w, mat2x3f());
}

fn grating(lit: ptr<function, Lit>, i: u32) -> GratedPoint {
    return grated_point((*lit).top.view, grooves(i), (*lit).covered);
}
#endif

fn add_sphere(lit: ptr<function, Lit>, radiance: vec3f, world: vec3f, radius: f32) {
    let base = base_sphere((*lit).base, to_surface((*lit).here, world), radius);
    (*lit).specular += radiance * base.specular;
    (*lit).diffuse += radiance * base.form_factor;
    let center = to_surface((*lit).top, world);
#ifdef STANDARD_MATERIAL_CLEARCOAT
    (*lit).coat_specular += radiance * lit_base_sphere((*lit).coat, curves, center, radius).specular;
#endif
    (*lit).scratches += radiance * scratched_sphere(tables, tree, (*lit).point, center, radius);
#ifdef GRATED
    for (var i = 0u; i < settings.grating_count; i += 1u) {
        (*lit).gratings += radiance * grated_sphere(tables, grating(lit, i), center, radius);
    }
#endif
}

// A rectangle as a surface sees it, by half its sides in world space. The light shines to its own -z.
fn rectangle(here: PixelFrame, middle: vec3f, half_right: vec3f, half_up: vec3f) -> QuadLight {
    let turn = here.surface_from_view * view_from_world();
    return quad_light(to_surface(here, middle), turn * half_up, turn * half_right, false);
}

fn add_rectangle(lit: ptr<function, Lit>, radiance: vec3f, middle: vec3f, half_right: vec3f, half_up: vec3f) {
    let base = base_quad((*lit).base, rectangle((*lit).here, middle, half_right, half_up));
    (*lit).specular += radiance * base.specular;
    (*lit).diffuse += radiance * base.form_factor;
    let light = rectangle((*lit).top, middle, half_right, half_up);
#ifdef STANDARD_MATERIAL_CLEARCOAT
    (*lit).coat_specular += radiance * lit_base_quad((*lit).coat, curves, light).specular;
#endif
    (*lit).scratches += radiance * scratched_quad(tables, tree, (*lit).point, light);
#ifdef GRATED
    for (var i = 0u; i < settings.grating_count; i += 1u) {
        (*lit).gratings += radiance * grated_quad(tables, grating(lit, i), light);
    }
#endif
}

// Point and spot lights give candela; a sphere of radiance L has pi r^2 L.
fn add_clustered(lit: ptr<function, Lit>, in: PbrInput, id: u32, is_spot: bool) {
    let light = &clustered_lights.data[id];
    let away = (*light).position_radius.xyz - in.world_position.xyz;
    let radius = select(settings.light_radius_m, (*light).position_radius.w, (*light).position_radius.w > 0.0);
    var power = getRangeFalloff(dot(away, away), (*light).color_inverse_square_range.w) / (PI * radius * radius);
    let has_shadow = (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u && ((*light).flags & POINT_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u;
    if is_spot {
        let custom = (*light).light_custom_data;
        var axis = vec3f(custom.x, sqrt(max(0.0, 1.0 - custom.x * custom.x - custom.y * custom.y)), custom.y);
        if ((*light).flags & POINT_LIGHT_FLAGS_SPOT_LIGHT_Y_NEGATIVE) != 0u {
            axis.y = -axis.y;
        }
        let inside = saturate(dot(-axis, normalize(away)) * custom.z + custom.w);
        power *= inside * inside;
        if has_shadow {
            power *= fetch_spot_shadow(id, in.world_position, in.world_normal, (*light).shadow_map_near_z, in.frag_coord.xy);
        }
    } else if has_shadow {
        power *= fetch_point_shadow(id, in.world_position, in.world_normal, in.frag_coord.xy);
    }
    if power > 0.0 {
        add_sphere(lit, power * (*light).color_inverse_square_range.rgb, (*light).position_radius.xyz, radius);
    }
}

fn add_lights(lit: ptr<function, Lit>, in: PbrInput, view_z: f32, cluster: u32) {
    let ranges = unpack_clusterable_object_index_ranges(cluster);
    for (var i = ranges.first_point_light_index_offset; i < ranges.first_spot_light_index_offset; i += 1u) {
        add_clustered(lit, in, get_clusterable_object_id(i), false);
    }
    for (var i = ranges.first_spot_light_index_offset; i < ranges.first_reflection_probe_index_offset; i += 1u) {
        add_clustered(lit, in, get_clusterable_object_id(i), true);
    }
    for (var i = 0u; i < lights.n_directional_lights; i += 1u) {
        let light = &lights.directional_lights[i];
        var shadow = 1.0;
        if (in.flags & MESH_FLAGS_SHADOW_RECEIVER_BIT) != 0u && ((*light).flags & DIRECTIONAL_LIGHT_FLAGS_SHADOWS_ENABLED_BIT) != 0u {
            shadow = fetch_directional_shadow(i, in.world_position, in.world_normal, view_z, in.frag_coord.xy);
        }
        if shadow > 0.0 {
            let half_angle = 0.5 * (*light).sun_disk_angular_size;
            let sine = sin(select(SUN_RAD, half_angle, half_angle > 0.0));
            let radiance = shadow * (*light).color.rgb / (PI * sine * sine);
            add_sphere(lit, radiance, in.world_position.xyz + FAR_M * (*light).direction_to_light, FAR_M * sine);
        }
    }
    for (var i = 0u; i < lights.n_rect_lights; i += 1u) {
        let light = &lights.rect_lights[i];
        let away = (*light).position - in.world_position.xyz;
        let falloff = getRangeFalloff(dot(away, away), 1.0 / max((*light).range * (*light).range, 1e-4));
        let half_right = (*light).right * (0.5 * (*light).width);
        let half_up = (*light).up * (0.5 * (*light).height);
        add_rectangle(lit, falloff * (*light).color.rgb, (*light).position, half_right, half_up);
    }
}

#ifdef ENVIRONMENT_MAP
// What a cell of a band mirrors.
fn cell_light(in: PbrInput, cluster: u32, world_from_surface: mat3x3f, cell: ScratchedCell) -> vec3f {
    var ranges = unpack_clusterable_object_index_ranges(cluster);
    let direction = world_from_surface * cell.direction;
    // Direction of a mirror: Bevy would bend that of a rough surface.
    let input = LayerLightingInput(direction, direction, 1.0, cell.roughness, 0.0);
    return cell.response * compute_radiances(input, &ranges, in.world_position.xyz, true).radiance;
}

// Adds the light of the environment that scratches and gratings mirror, by look-ups along the band of each.
fn add_environment(lit: ptr<function, Lit>, in: PbrInput, cluster: u32) {
    let world_from_surface = mat3x3f(view.world_from_view[0].xyz, view.world_from_view[1].xyz, view.world_from_view[2].xyz)
        * transpose((*lit).top.surface_from_view);
    let wo = (*lit).point.lit.wo;
    var walk = scratched_walk(tree, (*lit).point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, (*lit).point, walk, i);
        if seen.share.segment <= 0.0 {
            continue;
        }
        for (var j = 0u; j < ENVIRONMENT_CELLS; j += 1u) {
            let cell = scratched_cell(tables, 0u, wo, seen.tangent, seen.profile, j);
            (*lit).scratches += seen.share.segment * cell_light(in, cluster, world_from_surface, cell);
        }
    }
#ifdef GRATED
    for (var i = 0u; i < settings.grating_count; i += 1u) {
        let point = grating(lit, i);
        for (var j = 0u; j < select(0u, ROW_CELLS, point.seen.share.segment > 0.0); j += 1u) {
            (*lit).gratings += cell_light(in, cluster, world_from_surface, grated_cell(tables, point, j));
        }
    }
#endif
}
#endif

// The environment and ambient light, as Bevy computes them: what comes of the body, what the base reflects, and what the coat does.
struct Indirect {
    diffuse: vec3f,
    specular: vec3f,
    coat: vec3f,
}

fn mirror_layer(in: PbrInput, normal: vec3f, roughness: f32) -> LayerLightingInput {
    let cosine = max(dot(normal, in.V), 1e-4);
    return LayerLightingInput(normal, reflect(-in.V, normal), cosine, roughness, perceptualRoughnessToRoughness(roughness));
}

fn indirect_light(lit: ptr<function, Lit>, in: PbrInput, brushing: vec4f, diffuse_color: vec3f, at_normal: vec3f, cluster: u32) -> Indirect {
    let cosine = max(dot(in.N, in.V), 1e-4);
    let roughness = in.material.perceptual_roughness;
    var sum = Indirect(vec3f(0.0), vec3f(0.0), vec3f(0.0));
#ifdef ENVIRONMENT_MAP
    var input: LightingInput;
    input.layers[LAYER_BASE] = mirror_layer(in, in.N, roughness);
    input.P = in.world_position.xyz;
    input.V = in.V;
    input.diffuse_color = diffuse_color;
    input.metallic = in.material.metallic;
    input.F0_dielectric = calculate_F0_dielectric(in.material.reflectance);
    input.F0_metallic = in.material.base_color.rgb;
    input.F_ab = F_AB(roughness, cosine);
    var ranges = unpack_clusterable_object_index_ranges(cluster);
#ifdef STANDARD_MATERIAL_ANISOTROPY
    input.anisotropy = brushing.w;
    input.Ta = brushing.xyz;
    input.Ba = normalize(cross(in.world_normal, brushing.xyz));
    bend_normal_for_anisotropy(&input);
#endif
#ifdef STANDARD_MATERIAL_CLEARCOAT
    // Without Bevy's coat, which has no scratches.
    let layer = mirror_layer(in, top_normal(in), in.material.clearcoat_perceptual_roughness);
    input.layers[1] = layer;
    input.clearcoat_strength = 0.0;
    let coat = (*lit).coat;
    let mirrored = compute_radiances(layer, &ranges, in.world_position.xyz, true).radiance;
    sum.coat = mirrored * lit_base_reflected(coat, coat.reflecting.albedo) * in.specular_occlusion;
#endif
    let environment = environment_map_light(&input, &ranges, false);
    sum.diffuse += environment.diffuse * in.diffuse_occlusion;
    sum.specular += environment.specular * in.specular_occlusion;
#endif
    let of_body = ambient_light(in.world_position, in.N, in.V, cosine, diffuse_color, vec3f(0.0), roughness, in.diffuse_occlusion);
    let of_both = ambient_light(in.world_position, in.N, in.V, cosine, diffuse_color, at_normal, roughness, in.diffuse_occlusion);
    return Indirect(sum.diffuse + of_body, sum.specular + of_both - of_body, sum.coat);
}

// A pixel before it is lit: frames and slopes need derivatives, of all pixels of a quad.
struct Place {
    here: PixelFrame,
    top: PixelFrame,
    variance: f32,                  // of the slopes of a normal map
    brushing: vec4f,                // direction across it in world space; anisotropy
}

fn scratched_color(in: PbrInput, place: Place, view_z: f32) -> vec3f {
    let material = in.material;
    let at_normal = calculate_F0(material.base_color.rgb, material.metallic, material.reflectance);
    let diffuse_color = material.base_color.rgb * (1.0 - material.metallic);
    let fresnel = FresnelRgb(at_normal, 1.0, settings.curve);
    let wo = normalize(place.here.view.to_viewer_m);
    let slopes = pixel_slopes(place.here, place.variance);
    var lit: Lit;
    lit.here = place.here;
    lit.top = place.top;
#ifdef STANDARD_MATERIAL_ANISOTROPY
    let across = (place.here.surface_from_view * (view_from_world() * place.brushing.xyz)).xy;
    let length_sq = dot(across, across);
    let along = select(vec2f(1.0, 0.0), across * inverseSqrt(max(length_sq, 1e-30)), length_sq > 1e-12);
    lit.base.brushed = brushed_base(wo, material.perceptual_roughness, along, place.brushing.w, fresnel, slopes, shapes, albedo, curves);
    lit.base.brushed.lit = lit_base_mixed(lit.base.brushed.lit, material.metallic, diffuse_color);
#else
    let unmixed = lit_base(wo, material.perceptual_roughness, fresnel, slopes, shapes, albedo, curves);
    lit.base.round = lit_base_mixed(unmixed, material.metallic, diffuse_color);
#endif
#ifdef STANDARD_MATERIAL_CLEARCOAT
    let coat_fresnel = FresnelRgb(vec3f(COAT_F0), 1.0, settings.coat_curve);
    let coat_slopes = pixel_slopes(place.top, 0.0);
    let coat_wo = normalize(place.top.view.to_viewer_m);
    lit.coat = lit_base(coat_wo, material.clearcoat_perceptual_roughness, coat_fresnel, coat_slopes, shapes, albedo, curves);
#endif
    lit.point = scratched_point(place.top.view, tree, 0u);
#ifdef GRATED
    // One alone covers no more than it does.
    for (var i = 0u; i < select(0u, settings.grating_count, settings.grating_count > 1u); i += 1u) {
        lit.covered += grooves_seen(place.top.view, grooves(i)).share;
    }
#endif
    let cluster = view_fragment_cluster_index(in.frag_coord.xy, view_z, in.is_orthographic);
    add_lights(&lit, in, view_z, cluster);
#ifdef ENVIRONMENT_MAP
    add_environment(&lit, in, cluster);
#endif
    let indirect = indirect_light(&lit, in, place.brushing, diffuse_color, at_normal, cluster);
    let base = round_base(lit.base);
    var reflected = lit_base_reflected(base, lit.specular) + indirect.specular;
    var body = diffuse_color * lit_base_body(base) * lit.diffuse + indirect.diffuse;
    var reflectance = fresnel_eval(curves, fresnel, lit.point.lit.wo.z);
    var through = vec3f(0.0);
#ifdef STANDARD_MATERIAL_CLEARCOAT
    // What shines through the coat is no more reflected at the surface, and scratches take nothing of it.
    let bare = 1.0 - material.clearcoat;
    let passed = material.clearcoat * lit_base_body(lit.coat);
    through = reflected * passed;
    body *= passed + bare;
    reflected = reflected * bare + material.clearcoat * (lit_base_reflected(lit.coat, lit.coat_specular) + indirect.coat);
    reflectance = mix(reflectance, fresnel_eval(curves, coat_fresnel, lit.point.lit.wo.z), material.clearcoat);
#endif
    // Scratches lie over gratings.
    let sums = scratched_sums(tables, tree, lit.point);
    let masked = mask_resolve(scratched_with(sums, lit.scratches), scratch_tree_depth_coherence(tree));
    var left = vec3f(1.0);
#ifdef GRATED
    for (var i = 0u; i < settings.grating_count; i += 1u) {
        left -= grated_taken(tables, grating(&lit, i));
    }
#endif
    let beside = 1.0 - masked.taken;
    let sent = (lit.gratings * beside + masked.scratches) * reflectance;
    let emitted = material.emissive.rgb * mix(1.0, view.exposure, material.emissive.a);
    return view.exposure * (body + reflected * left * beside + sent + through) + emitted;
}

fn top_normal(in: PbrInput) -> vec3f {
#ifdef STANDARD_MATERIAL_CLEARCOAT
#ifdef STANDARD_MATERIAL_CLEARCOAT_NORMAL_MAP
    return in.clearcoat_N;
#else
    return normalize(in.world_normal);
#endif
#else
    return in.N;
#endif
}

fn frame_of(in: PbrInput, instance: u32, normal: vec3f) -> PixelFrame {
    let world_from_mesh = get_world_from_local(instance);
    let turn = mat3x3f(world_from_mesh[0].xyz, world_from_mesh[1].xyz, world_from_mesh[2].xyz);
    let in_mesh = transpose(turn) * (in.world_position.xyz - world_from_mesh[3].xyz) / max(dot(turn[0], turn[0]), 1e-20);
    let to_metres = settings.metres_from_mesh;
    // The inverse of a rotation with one scale is the transpose over the square of the scale.
    let scaled = mat3x3f(to_metres[0].xyz, to_metres[1].xyz, to_metres[2].xyz);
    let from_metres = transpose(scaled) * (1.0 / max(dot(scaled[0], scaled[0]), 1e-20));
    let at_view = (view.view_from_world * in.world_position).xyz;
    let smooth_normal = view_from_world() * normalize(in.world_normal);
    let scale = vec2f(view.clip_from_view[0].x, view.clip_from_view[1].y);
    let ndc = (in.frag_coord.xy - view.viewport.xy) / view.viewport.zw * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return pixel_frame(
        (to_metres * vec4f(in_mesh, 1.0)).xyz,
        view_from_world() * turn * from_metres,
        at_view,
        view_from_world() * normal,
        vec3f(2.0 / (view.viewport.zw * scale), select(0.0, 1.0, in.is_orthographic)),
        (ndc + view.clip_from_view[2].xy) / scale,
        dpdx(at_view),
        dpdy(at_view),
        dpdx(smooth_normal),
        dpdy(smooth_normal),
    );
}

// Variance of the slopes that a normal map gives a pixel, beside those of the smooth normals.
fn slope_variance(in: PbrInput) -> f32 {
#ifdef STANDARD_MATERIAL_NORMAL_MAP
    let bent = in.N - normalize(in.world_normal);
    let x = dpdx(bent);
    let y = dpdy(bent);
    return 0.5 * SCRATCHED_FILTER_STD * SCRATCHED_FILTER_STD * (dot(x, x) + dot(y, y));
#else
    return 0.0;
#endif
}

// The direction in world space in which facets lean further, and the anisotropy; by texture coordinates where the mesh has no tangents.
fn brushing_of(vertex: VertexOutput, in: PbrInput) -> vec4f {
    var found = vec4f(0.0);
#ifdef STANDARD_MATERIAL_ANISOTROPY
    let n = normalize(in.world_normal);
    var tangent = vec3f(1.0, 0.0, 0.0);
    var bitangent = cross(n, tangent);
#ifdef VERTEX_TANGENTS
    tangent = vertex.world_tangent.xyz;
    bitangent = vertex.world_tangent.w * cross(n, tangent);
#else ifdef VERTEX_UVS_A
    let px = dpdx(in.world_position.xyz);
    let py = dpdy(in.world_position.xyz);
    let ux = dpdx(vertex.uv);
    let uy = dpdy(vertex.uv);
    let side = sign(ux.x * uy.y - uy.x * ux.y);
    let by_u = side * (px * uy.y - py * ux.y);
    let by_v = side * (py * ux.x - px * uy.x);
    tangent = normalize(by_u - n * dot(n, by_u));
    // The bitangent is where v falls.
    bitangent = cross(n, tangent);
    bitangent *= select(1.0, -1.0, dot(bitangent, by_v) > 0.0);
#endif
    let rotation = pbr_bindings::material.anisotropy_rotation;
    found = vec4f(normalize(tangent * rotation.x + bitangent * rotation.y), pbr_bindings::material.anisotropy_strength);
#ifdef PBR_ANISOTROPY_TEXTURE_SUPPORTED
#ifdef VERTEX_TANGENTS
    found = vec4f(in.anisotropy_T, in.anisotropy_strength);
#endif
#endif
#endif
    return found;
}

@fragment
fn fragment(vertex: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var input = pbr_input_from_standard_material(vertex, is_front);
    let here = frame_of(input, vertex.instance_index, input.N);
    let top = frame_of(input, vertex.instance_index, top_normal(input));
    let place = Place(here, top, slope_variance(input), brushing_of(vertex, input));
    input.material.base_color = alpha_discard(input.material, input.material.base_color);
    var color = input.material.base_color;
    if (input.material.flags & STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u {
        let view_z = (view.view_from_world * input.world_position).z;
        color = vec4f(scratched_color(input, place, view_z), color.a);
    }
    return FragmentOutput(main_pass_post_lighting_processing(input, color));
}
