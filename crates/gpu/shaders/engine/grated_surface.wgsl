// A surface with rows of grooves as an engine shades it: a grating, whose light lies about its orders.
//
// Needs: grating, groove_field, scratched_surface.
// Frame: as of scratched_surface. Tables are a texture of their own: each
// layer that of one grating, over its depth, or INCIDENCE_ROWS high of a fine one.
//
//   let point = grated_point(view, grooves, 1.0);                             // once
//   light += radiance * grated_sphere(tables, point, center, r);              // for each light
//   colour = (1.0 - masked.taken) * (specular * (1.0 - grated_taken(tables, point)) + light * fresnel) + ...

// A grating in the frame of its object.
struct Grooves {
    field: GrooveField,             // axis in the object's frame, lengths in metres
    center: vec3f,                  // in the object's frame and unit
    coherence_um: f32,
    table: u32,                     // its layer
    is_fine: bool,                  // whether that is one by incidence
    depth_nm: f32,                  // of the last row of one that is not, as scratches count rows
    bends: mat2x3f,                 // of grooves along a direction: how it changes over a pixel to the right and down; 0 of one direction everywhere
}

struct GratedPoint {
    lit: LitPoint,
    seen: SeenScratch,              // all of its grooves
}

fn grooves_seen(view: SurfaceView, grooves: Grooves) -> GroovePlace {
    var field = grooves.field;
    let axis = view.surface_from_object * field.axis;
    let shorter = inverseSqrt(max(dot(axis, axis), 1e-30));
    field.axis = shorter * axis;
    let bends = SCRATCHED_FILTER_STD * shorter * (view.surface_from_object * grooves.bends);
    let arm_m = view.surface_from_object * (view.position - grooves.center);
    let right_m = vec3f(SCRATCHED_FILTER_STD * view.footprint_x_m.xy, 0.0);
    let down_m = vec3f(SCRATCHED_FILTER_STD * view.footprint_y_m.xy, 0.0);
    return groove_field_place(field, mat3x3f(field.axis, bends[0], bends[1]), arm_m, arm_m, vec3f(0.0, 0.0, 1.0), right_m, down_m);
}

// Gratings lie side by side: `covered` is the sum of the shares of all that a point sees, beyond 1 each gets its part.
fn grated_point(view: SurfaceView, grooves: Grooves, covered: f32) -> GratedPoint {
    let place = grooves_seen(view, grooves);
    let length_sq = dot(place.tangent.xy, place.tangent.xy);
    let tangent = select(vec2f(1.0, 0.0), place.tangent.xy * inverseSqrt(max(length_sq, 1e-30)), length_sq > 0.0);
    var seen = row_seen(tangent, place.share / max(covered, 1.0), place.turns_rad, place.angle_std_rad, grooves.is_fine);
    seen.profile.depth_nm = grooves.depth_nm;
    return GratedPoint(surface_lit_point(view, grooves.coherence_um, grooves.table), seen);
}

// The share of light in the mirror's direction that the grooves take of the base.
fn grated_taken(tables: texture_2d_array<u32>, point: GratedPoint) -> vec3f {
    if point.seen.share.segment <= 0.0 {
        return vec3f(0.0);
    }
    return point.seen.share.segment * row_taken(tables, point.lit, point.seen);
}

// Light that the grooves send of a sphere of radiance 1; before Fresnel.
fn grated_sphere(tables: texture_2d_array<u32>, point: GratedPoint, center_m: vec3f, radius_m: f32) -> vec3f {
    if point.seen.share.segment <= 0.0 || !scratch_meets(point.lit, point.seen, center_m, radius_m) {
        return vec3f(0.0);
    }
    return point.seen.share.segment * scratch_sphere(tables, point.lit, point.seen, center_m, radius_m);
}

// Light of a flat light of radiance 1 with three or four corners.
fn grated_quad(tables: texture_2d_array<u32>, point: GratedPoint, light: QuadLight) -> vec3f {
    if point.seen.share.segment <= 0.0 || !scratch_meets(point.lit, point.seen, light.center_m, light.radius_m) {
        return vec3f(0.0);
    }
    return point.seen.share.segment * scratch_quad(tables, point.lit, point.seen, light);
}

// Light of a polygon of any number of corners or a tube; arguments as of scratched_outline().
fn grated_outline(
    tables: texture_2d_array<u32>,
    point: GratedPoint,
    vertices: texture_2d<u32>,
    light: OutlineLight,
    around: vec4f,
    point_m: vec3f,
    surface: mat3x3f,
) -> vec3f {
    let center_m = (around.xyz - point_m) * surface;
    if point.seen.share.segment <= 0.0 || !scratch_meets(point.lit, point.seen, center_m, around.w) {
        return vec3f(0.0);
    }
    let view = outline_view(vertices, light, point_m, surface, point.seen.tangent);
    return point.seen.share.segment * scratch_outline(tables, vertices, point.lit, point.seen, view, center_m, around.w);
}

// Light of an environment; arguments as of scratched_environment().
fn grated_environment(tables: texture_2d_array<u32>, point: GratedPoint, levels: texture_2d<f32>, map_from_surface: mat3x3f) -> vec3f {
    if point.seen.share.segment <= 0.0 {
        return vec3f(0.0);
    }
    return point.seen.share.segment * row_environment(tables, point.lit, point.seen, levels, map_from_surface);
}

// One of the ROW_CELLS cells of its band, for an engine that looks its environment up by itself: `response` has the share.
fn grated_cell(tables: texture_2d_array<u32>, point: GratedPoint, i: u32) -> ScratchedCell {
    let cell = row_cell(i, band_line_at(band_from_surface(point.seen.tangent, point.lit.wo), 0.0));
    let sent = scratch_chord(tables, point.lit, point.seen, cell.q_high, cell.q_low, cell.direction.z);
    return ScratchedCell(surface_from_band(point.seen.tangent, cell.direction), environment_cell_roughness(cell), point.seen.share.segment * sent);
}
