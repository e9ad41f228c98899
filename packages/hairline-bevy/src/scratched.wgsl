// Bevy's standard material with Hairline's base and scratches: lights of Bevy in closed form, with Bevy's shadows and environments.

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
    pbr_fragment::pbr_input_from_standard_material,
    pbr_functions::{alpha_discard, calculate_F0, calculate_F0_dielectric, main_pass_post_lighting_processing},
    pbr_types::{PbrInput, STANDARD_MATERIAL_FLAGS_UNLIT_BIT},
    shadows::{fetch_directional_shadow, fetch_point_shadow, fetch_spot_shadow},
}
#ifdef ENVIRONMENT_MAP
#import bevy_pbr::environment_map::{compute_radiances, environment_map_light}
#endif
#import hairline::{
    ENVIRONMENT_CELLS, FresnelRgb, LitBase, PixelFrame, QuadLight, SCRATCH_TREE_END, ScratchedPoint, fresnel_eval, lit_base_body, lit_base_quad,
    lit_base_reflected, lit_base_sphere, mask_resolve, pixel_base, pixel_frame, quad_light, scratch_tree_depth_coherence, scratch_walk_next,
    scratched_cell, scratched_point, scratched_quad, scratched_seen, scratched_sphere, scratched_sums, scratched_walk, scratched_with,
}

struct Settings {
    curve: u32,                     // of reflectance over the angle, in `curves`
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

// Surface that is lit, and the light that has been summed.
struct Lit {
    here: PixelFrame,
    base: LitBase,
    point: ScratchedPoint,
    specular: vec3f,
    diffuse: vec3f,
    scratches: vec3f,
}

// Converts a point from world space into the surface's frame, relative to the point.
fn to_surface(lit: ptr<function, Lit>, world: vec3f) -> vec3f {
    let at_view = (view.view_from_world * vec4f(world, 1.0)).xyz;
    return (*lit).here.surface_from_view * (at_view - (*lit).here.position_view);
}

fn add_sphere(lit: ptr<function, Lit>, radiance: vec3f, world: vec3f, radius: f32) {
    let center = to_surface(lit, world);
    let base = lit_base_sphere((*lit).base, curves, center, radius);
    (*lit).specular += radiance * base.specular;
    (*lit).diffuse += radiance * base.form_factor;
    (*lit).scratches += radiance * scratched_sphere(tables, tree, (*lit).point, center, radius);
}

fn add_rectangle(lit: ptr<function, Lit>, radiance: vec3f, light: QuadLight) {
    let base = lit_base_quad((*lit).base, curves, light);
    (*lit).specular += radiance * base.specular;
    (*lit).diffuse += radiance * base.form_factor;
    (*lit).scratches += radiance * scratched_quad(tables, tree, (*lit).point, light);
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
        let turn = (*lit).here.surface_from_view * mat3x3f(view.view_from_world[0].xyz, view.view_from_world[1].xyz, view.view_from_world[2].xyz);
        // The light shines to its own -z.
        let half_width = turn * ((*light).right * (0.5 * (*light).width));
        let half_height = turn * ((*light).up * (0.5 * (*light).height));
        add_rectangle(lit, falloff * (*light).color.rgb, quad_light(to_surface(lit, (*light).position), half_height, half_width, false));
    }
}

#ifdef ENVIRONMENT_MAP
// Adds the light of the environment that the scratches mirror, by look-ups along the band of each.
fn add_environment(lit: ptr<function, Lit>, in: PbrInput, cluster: u32) {
    let world_from_surface = mat3x3f(view.world_from_view[0].xyz, view.world_from_view[1].xyz, view.world_from_view[2].xyz)
        * transpose((*lit).here.surface_from_view);
    var ranges = unpack_clusterable_object_index_ranges(cluster);
    let wo = (*lit).point.lit.wo;
    var walk = scratched_walk(tree, (*lit).point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, (*lit).point, walk, i);
        if seen.share.segment <= 0.0 {
            continue;
        }
        for (var j = 0u; j < ENVIRONMENT_CELLS; j += 1u) {
            let cell = scratched_cell(tables, 0u, wo, seen.tangent, seen.profile, j);
            let direction = world_from_surface * cell.direction;
            // Direction of a mirror: Bevy would bend that of a rough surface.
            let input = LayerLightingInput(direction, direction, 1.0, cell.roughness, 0.0);
            let found = compute_radiances(input, &ranges, in.world_position.xyz, true);
            (*lit).scratches += seen.share.segment * cell.response * found.radiance;
        }
    }
}
#endif

// The environment on the base and ambient light, as Bevy computes them: what comes of the body, and what is reflected.
struct Indirect {
    diffuse: vec3f,
    specular: vec3f,
}

fn indirect_light(in: PbrInput, diffuse_color: vec3f, at_normal: vec3f, cluster: u32) -> Indirect {
    let cosine = max(dot(in.N, in.V), 1e-4);
    let roughness = in.material.perceptual_roughness;
    var sum = Indirect(vec3f(0.0), vec3f(0.0));
#ifdef ENVIRONMENT_MAP
    var input: LightingInput;
    input.layers[LAYER_BASE] = LayerLightingInput(in.N, reflect(-in.V, in.N), cosine, roughness, perceptualRoughnessToRoughness(roughness));
    input.P = in.world_position.xyz;
    input.V = in.V;
    input.diffuse_color = diffuse_color;
    input.metallic = in.material.metallic;
    input.F0_dielectric = calculate_F0_dielectric(in.material.reflectance);
    input.F0_metallic = in.material.base_color.rgb;
    input.F_ab = F_AB(roughness, cosine);
    var ranges = unpack_clusterable_object_index_ranges(cluster);
    let environment = environment_map_light(&input, &ranges, false);
    sum.diffuse += environment.diffuse * in.diffuse_occlusion;
    sum.specular += environment.specular * in.specular_occlusion;
#endif
    let of_body = ambient_light(in.world_position, in.N, in.V, cosine, diffuse_color, vec3f(0.0), roughness, in.diffuse_occlusion);
    let of_both = ambient_light(in.world_position, in.N, in.V, cosine, diffuse_color, at_normal, roughness, in.diffuse_occlusion);
    return Indirect(sum.diffuse + of_body, sum.specular + of_both - of_body);
}

fn scratched_color(in: PbrInput, here: PixelFrame, view_z: f32) -> vec3f {
    let material = in.material;
    let at_normal = calculate_F0(material.base_color.rgb, material.metallic, material.reflectance);
    let diffuse_color = material.base_color.rgb * (1.0 - material.metallic);
    let fresnel = FresnelRgb(at_normal, 1.0, settings.curve);
    var lit: Lit;
    lit.here = here;
    lit.base = pixel_base(here, material.perceptual_roughness, fresnel, shapes, albedo, curves);
    lit.point = scratched_point(here.view, tree, 0u);
    let cluster = view_fragment_cluster_index(in.frag_coord.xy, view_z, in.is_orthographic);
    add_lights(&lit, in, view_z, cluster);
#ifdef ENVIRONMENT_MAP
    add_environment(&lit, in, cluster);
#endif
    let sums = scratched_sums(tables, tree, lit.point);
    let masked = mask_resolve(scratched_with(sums, lit.scratches), scratch_tree_depth_coherence(tree));
    let indirect = indirect_light(in, diffuse_color, at_normal, cluster);
    let reflected = lit_base_reflected(lit.base, lit.specular) + indirect.specular;
    let body = diffuse_color * lit_base_body(lit.base) * lit.diffuse + indirect.diffuse;
    let scratches = masked.scratches * fresnel_eval(curves, fresnel, lit.point.lit.wo.z);
    let emitted = material.emissive.rgb * mix(1.0, view.exposure, material.emissive.a);
    return view.exposure * (body + reflected * (1.0 - masked.taken) + scratches) + emitted;
}

// The frame of the pixel. Its derivatives need all pixels of a quad.
fn frame_of(in: PbrInput, instance: u32) -> PixelFrame {
    let view_from_world = mat3x3f(view.view_from_world[0].xyz, view.view_from_world[1].xyz, view.view_from_world[2].xyz);
    let world_from_local = get_world_from_local(instance);
    let turn = mat3x3f(world_from_local[0].xyz, world_from_local[1].xyz, world_from_local[2].xyz);
    let position = transpose(turn) * (in.world_position.xyz - world_from_local[3].xyz) / max(dot(turn[0], turn[0]), 1e-20);
    let at_view = (view.view_from_world * in.world_position).xyz;
    let smooth_normal = view_from_world * normalize(in.world_normal);
    let scale = vec2f(view.clip_from_view[0].x, view.clip_from_view[1].y);
    let ndc = (in.frag_coord.xy - view.viewport.xy) / view.viewport.zw * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return pixel_frame(
        position,
        view_from_world * turn,
        at_view,
        view_from_world * in.N,
        vec3f(2.0 / (view.viewport.zw * scale), select(0.0, 1.0, in.is_orthographic)),
        (ndc + view.clip_from_view[2].xy) / scale,
        dpdx(at_view),
        dpdy(at_view),
        dpdx(smooth_normal),
        dpdy(smooth_normal),
    );
}

@fragment
fn fragment(in: VertexOutput, @builtin(front_facing) is_front: bool) -> FragmentOutput {
    var input = pbr_input_from_standard_material(in, is_front);
    let here = frame_of(input, in.instance_index);
    input.material.base_color = alpha_discard(input.material, input.material.base_color);
    var color = input.material.base_color;
    if (input.material.flags & STANDARD_MATERIAL_FLAGS_UNLIT_BIT) == 0u {
        let view_z = (view.view_from_world * input.world_position).z;
        color = vec4f(scratched_color(input, here, view_z), color.a);
    }
    return FragmentOutput(main_pass_post_lighting_processing(input, color));
}
