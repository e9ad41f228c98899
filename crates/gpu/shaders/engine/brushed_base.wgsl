// The base of brushed metal as an engine shades it: facets that lean further one way than across it, in the place of lit_base().
//
// Needs: brushed_outline, lit_base.
// Frame and textures: those of lit_base. Sums over lights end in lit_base_reflected() and lit_base_body() of `lit`.

struct BrushedBase {
    lit: LitBase,                   // with the albedo of the brushed lobe
    wo: vec3f,
    axes: FacetAxes,
}

// `along` is the unit vector across the brushing, in the plane of the surface; `anisotropy` that of KHR_materials_anisotropy.
fn brushed_base(
    wo: vec3f,
    roughness: f32,
    along: vec2f,
    anisotropy: f32,
    fresnel: FresnelRgb,
    slopes: PixelSlopes,
    shapes: texture_2d<f32>,
    albedo: texture_2d<f32>,
    curves: texture_2d<f32>,
) -> BrushedBase {
    let alpha = ggx_alpha(roughness);
    let axes = FacetAxes(along, vec2f(max(anisotropic_alpha(alpha, anisotropy), alpha), alpha));
    let around = brushed_albedo(brushed_lobe(wo, axes, pixel_slopes_towards(slopes, 0.0)), fresnel, curves);
    var lit = lit_base(wo, roughness, fresnel, slopes, shapes, albedo, curves);
    lit.sharp.albedo = around.w;
    lit.reflecting.albedo = around.xyz;
    return BrushedBase(lit_base_mixed(lit, 0.0, vec3f(0.0)), wo, axes);
}

// The lobe for a light at 1 / `per_m` metres.
fn brushed_base_lobe(base: BrushedBase, per_m: f32) -> BrushedLobe {
    return brushed_lobe(base.wo, base.axes, pixel_slopes_towards(base.lit.slopes, per_m));
}

fn brushed_base_sphere(base: BrushedBase, curves: texture_2d<f32>, center_m: vec3f, radius_m: f32) -> BaseLit {
    if center_m.z <= -radius_m {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let cap = sphere_cap(center_m, radius_m);
    let sin_sq = cap_sin_sq(cap);
    let lobe = brushed_base_lobe(base, light_per_distance(center_m, radius_m));
    let specular = brushed_sphere(lobe, cap.axis, sin_sq, base.lit.reflecting.fresnel, curves);
    return BaseLit(specular, lambert_sphere(cap.axis, sin_sq));
}

// A flat light with three or four corners.
fn brushed_base_quad(base: BrushedBase, curves: texture_2d<f32>, light: QuadLight) -> BaseLit {
    let highest_m = max(max(light.a_m.z, light.b_m.z), max(light.c_m.z, light.d_m.z));
    if polygon_facing(light.normal, light.a_m, light.two_sided) == 0.0 || highest_m <= 0.0 {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let axial = brushed_base_lobe(base, light_per_distance(light.center_m, light.radius_m));
    var body = lambert_begin();
    var outline = brushed_outline_axis();
    var area = vec3f(0.0);
    var corners = mat4x3f(light.a_m, light.b_m, light.c_m, light.d_m);
    for (var i = 0u; i < light.corner_count; i += 1u) {
        let to = select(corners[1], light.a_m, i + 1u == light.corner_count);
        lambert_edge(&body, corners[0], to);
        let a = brushed_from_local(axial, corners[0]);
        let b = brushed_from_local(axial, to);
        area += cross(a, b);
        brushed_add_to_axis(&outline, axial, brushed_edge(a, b, false));
        brushed_add_to_axis(&outline, axial, brushed_edge(a, b, true));
        corners = mat4x3f(corners[1], corners[2], corners[3], corners[0]);
    }
    let lobe = brushed_sliced(axial, outline);
    let first = brushed_from_local(axial, light.a_m);
    var range = vec2f(1.0, -1.0);
    corners = mat4x3f(light.a_m, light.b_m, light.c_m, light.d_m);
    for (var i = 0u; i < light.corner_count; i += 1u) {
        let a = brushed_from_local(lobe, corners[0]);
        let b = brushed_from_local(lobe, select(corners[1], light.a_m, i + 1u == light.corner_count));
        range = brushed_range(lobe, range, brushed_edge(a, b, false));
        range = brushed_range(lobe, range, brushed_edge(a, b, true));
        corners = mat4x3f(corners[1], corners[2], corners[3], corners[0]);
    }
    let form_factor = lambert_end(body);
    let visible = brushed_visible(lobe, range);
    var sum = vec3f(0.0);
    let orientation = select(1.0, -1.0, dot(area, first) < 0.0);
    for (var n = 0u; n < select(0u, BRUSHED_NODES, visible.y > visible.x); n += 1u) {
        let node = brushed_node(n, visible);
        let slice = brushed_slice(lobe, node.x);
        if !slice.is_seen {
            continue;
        }
        for (var k = 0u; k < brushed_parts(lobe); k += 1u) {
            let part = brushed_part(lobe, slice, k);
            var moments = brushed_none();
            corners = mat4x3f(light.a_m, light.b_m, light.c_m, light.d_m);
            for (var i = 0u; i < light.corner_count; i += 1u) {
                let a = brushed_from_local(lobe, corners[0]);
                let b = brushed_from_local(lobe, select(corners[1], light.a_m, i + 1u == light.corner_count));
                for (var h = 0u; h < 2u; h += 1u) {
                    let edge = brushed_edge(a, b, h == 1u);
                    brushed_add_crossings(&moments, part, brushed_crossings(lobe, slice.slope, edge), orientation);
                }
                corners = mat4x3f(corners[1], corners[2], corners[3], corners[0]);
            }
            sum += node.y * brushed_reflected(lobe, slice, k, moments, base.lit.reflecting.fresnel, curves);
        }
    }
    return BaseLit(max(sum, vec3f(0.0)), form_factor);
}

// A polygon of any number of corners or a tube at 1 / `per_m` metres, as outline_view() sees it with the tangent (1, 0).
fn brushed_base_outline(base: BrushedBase, curves: texture_2d<f32>, vertices: texture_2d<u32>, view: OutlineView, per_m: f32) -> BaseLit {
    if view.facing == 0.0 {
        return BaseLit(vec3f(0.0), 0.0);
    }
    let specular = brushed_outline(brushed_base_lobe(base, per_m), base.lit.reflecting.fresnel, curves, vertices, view);
    return BaseLit(specular, lambert_outline(vertices, view));
}

// An environment; arguments as of lit_base_environment().
fn brushed_base_environment(base: BrushedBase, curves: texture_2d<f32>, levels: texture_2d<f32>, map_from_surface: mat3x3f) -> vec3f {
    let mean = brushed_around(brushed_base_lobe(base, 0.0), base.lit.reflecting.fresnel, curves, levels, map_from_surface);
    return base.lit.reflecting.albedo * mean;
}
