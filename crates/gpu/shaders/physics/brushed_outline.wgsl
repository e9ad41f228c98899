// Light of a polygon or a tube of radiance 1 that the lobe of elliptic facets reflects. Needs brushed_lobe, outline_light. Twin:
// BrushedLobe::polygon of optics.
// Needs: brushed_lobe, outline_light.

// `view` is that of outline_view() with the tangent (1, 0).
fn brushed_outline(axial: BrushedLobe, fresnel: FresnelRgb, curves: texture_2d<f32>, vertices: texture_2d<u32>, view: OutlineView) -> vec3f {
    var sum = vec3f(0.0);
    if view.facing == 0.0 {
        return sum;
    }
    var outline = brushed_outline_axis();
    var area = vec3f(0.0);
    var highest_z = 0.0;
    let first_m = outline_corner_m(vertices, view, 0u);
    var a = brushed_from_local(axial, first_m);
    for (var i = 0u; i < view.light.vertex_count; i += 1u) {
        let b = brushed_from_local(axial, outline_corner_m(vertices, view, i + 1u));
        area += cross(a, b);
        highest_z = max(highest_z, b.z);
        brushed_add_to_axis(&outline, axial, brushed_edge(a, b, false));
        brushed_add_to_axis(&outline, axial, brushed_edge(a, b, true));
        a = b;
    }
    let orientation = select(1.0, -1.0, dot(area, brushed_from_local(axial, first_m)) < 0.0);
    let lobe = brushed_sliced(axial, outline);
    let first = brushed_from_local(lobe, first_m);
    var range = vec2f(1.0, -1.0);
    a = first;
    for (var i = 0u; i < 2u * view.light.vertex_count; i += 1u) {
        let b = brushed_from_local(lobe, outline_corner_m(vertices, view, i / 2u + 1u));
        range = brushed_range(lobe, range, brushed_edge(a, b, (i & 1u) == 1u));
        if (i & 1u) == 1u {
            a = b;
        }
    }
    let visible = brushed_visible(lobe, range);
    if highest_z <= 0.0 || visible.y <= visible.x {
        return sum;
    }
    for (var n = 0u; n < BRUSHED_NODES; n += 1u) {
        let node = brushed_node(n, visible);
        let slice = brushed_slice(lobe, node.x);
        if !slice.is_seen {
            continue;
        }
        // The edges once for each kind of facets: most lobes have one.
        for (var k = 0u; k < brushed_parts(lobe); k += 1u) {
            let part = brushed_part(lobe, slice, k);
            var moments = brushed_none();
            a = first;
            for (var i = 0u; i < 2u * view.light.vertex_count; i += 1u) {
                let b = brushed_from_local(lobe, outline_corner_m(vertices, view, i / 2u + 1u));
                let edge = brushed_edge(a, b, (i & 1u) == 1u);
                brushed_add_crossings(&moments, part, brushed_crossings(lobe, slice.slope, edge), orientation);
                if (i & 1u) == 1u {
                    a = b;
                }
            }
            sum += node.y * brushed_reflected(lobe, slice, k, moments, fresnel, curves);
        }
    }
    return max(sum, vec3f(0.0));
}
