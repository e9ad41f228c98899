// A scratched surface as an engine shades it: all scratches under a pixel at once, found in a tree.
//
// Needs: outline_light, scratch_tree.
// Frame: the surface's, z along the shading normal, towards the viewer; any x. Positions
// of lights are relative to the point, in metres.
//
//   let view = SurfaceView(...);                                            // from the engine
//   let point = scratched_point(view, tree, table);
//   let sums = scratched_sums(tables, tree, point);                         // once
//   light += radiance * scratched_sphere(tables, tree, point, center, r);   // for each light
//   let masked = mask_resolve(scratched_with(sums, light), scratch_tree_depth_coherence(tree));
//   colour = diffuse + specular * (1.0 - masked.taken) + masked.scratches * fresnel;

// The point under a pixel, as an engine describes it.
struct SurfaceView {
    position: vec3f,                // in the object's frame
    surface_from_object: mat3x3f,   // turns and scales: from the object's frame and unit to the surface's and metres
    to_viewer_m: vec3f,             // the way to the viewer in the surface's frame
    footprint_x_m: vec3f,           // how the point moves by one pixel to the right, see footprint_axis() of camera.wgsl
    footprint_y_m: vec3f,           // and down; in the surface's frame
    turn_x: vec3f,                  // how the smooth normal turns over each of them; 0 on a plane
    turn_y: vec3f,
}

// Standard deviation of the filter of a pixel, in pixels.
const SCRATCHED_FILTER_STD: f32 = 0.5;
// Largest distance of the surface from the plane of shading, over the length along it.
const SCRATCHED_BENDS: f32 = 0.125;

struct ScratchedPoint {
    lit: LitPoint,
    position: vec3f,
    surface_from_object: mat3x3f,
    reach: vec3f,                   // half the sides of a box that holds what the footprint may see, in the object's frame
}

// The point as one scratch or groove sees it. `table` is the layer of its spectrum.
fn surface_lit_point(view: SurfaceView, coherence_um: f32, table: u32) -> LitPoint {
    let distance_m = max(length(view.to_viewer_m), 1e-9);
    return LitPoint(
        view.to_viewer_m / distance_m,
        distance_m,
        1e6 * SCRATCHED_FILTER_STD * view.footprint_x_m.xy,
        1e6 * SCRATCHED_FILTER_STD * view.footprint_y_m.xy,
        SCRATCHED_FILTER_STD * view.turn_x.xy,
        SCRATCHED_FILTER_STD * view.turn_y.xy,
        coherence_um,
        table,
    );
}

fn scratched_point(view: SurfaceView, tree: texture_2d<u32>, table: u32) -> ScratchedPoint {
    let x = view.footprint_x_m.xy * SCRATCHED_FILTER_STD;
    let y = view.footprint_y_m.xy * SCRATCHED_FILTER_STD;
    let coherence_um = scratch_tree_coherence_um(tree);
    let lit = surface_lit_point(view, coherence_um, table);
    // Footprint, coherence window and what ends are smoothed by; off the plane as far as the surface may bend.
    let back = transpose(view.surface_from_object);
    let units_per_m = 1.0 / max(dot(back[2], back[2]), 1e-20);
    let to_x = (back * vec3f(x, 0.0)) * units_per_m;
    let to_y = (back * vec3f(y, 0.0)) * units_per_m;
    let sigma = 1e-6 * coherence_um * sqrt(units_per_m);
    let variance = to_x * to_x + to_y * to_y + 0.7 * sigma * sigma;
    let aside = SCRATCHED_BENDS * sqrt(variance.x + variance.y + variance.z);
    let normal = back[2] * sqrt(units_per_m);
    return ScratchedPoint(lit, view.position, view.surface_from_object, SCRATCH_REACH_STD * (sqrt(variance) + abs(normal) * aside));
}

// The way through the tree to the scratches that a point may see.
fn scratched_walk(tree: texture_2d<u32>, point: ScratchedPoint) -> ScratchWalk {
    return scratch_walk(tree, point.position, point.reach);
}

// A piece as the point sees it; without a share where it is out of reach, far off the plane of shading or on the other side of a sheet.
fn scratched_seen(tree: texture_2d<u32>, point: ScratchedPoint, walk: ScratchWalk, piece: u32) -> SeenScratch {
    let scratch = scratch_tree_piece(tree, walk, piece);
    let a = 1e6 * (point.surface_from_object * (scratch.start - point.position));
    let b = 1e6 * (point.surface_from_object * (scratch.end - point.position));
    var seen = scratch_seen(point.lit, a.xy, b.xy, scratch.profile, scratch.blur_um);
    let along = b.xy - a.xy;
    let off_um = mix(a.z, b.z, clamp(-dot(a.xy, along) / max(dot(along, along), 1e-30), 0.0, 1.0));
    let x = point.lit.footprint_x_um;
    let y = point.lit.footprint_y_um;
    let sigma = point.lit.coherence_um;
    let most_um = SCRATCH_REACH_STD * (0.8367 * sigma + SCRATCHED_BENDS * sqrt(dot(x, x) + dot(y, y) + 2.1 * sigma * sigma));
    let normal = point.surface_from_object * scratch.normal;
    let facing = normal.z >= SCRATCH_TREE_FACING * length(normal);
    seen.share.segment *= select(0.0, walk.weight, facing && abs(off_um) <= most_um);
    return seen;
}

// Energy that the scratches take of the base; their light is left to the functions below.
fn scratched_sums(tables: texture_2d_array<u32>, tree: texture_2d<u32>, point: ScratchedPoint) -> ScratchSums {
    var sums = ScratchSums(0.0, 0.0, vec3f(0.0), vec3f(0.0));
    var walk = scratched_walk(tree, point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, point, walk, i);
        if seen.share.segment > 0.0 {
            mask_add(&sums, seen.share, scratch_energy(tables, point.lit, seen), vec3f(0.0));
        }
    }
    return sums;
}

// Returns the sums with the light that the functions below computed.
fn scratched_with(sums: ScratchSums, radiance: vec3f) -> ScratchSums {
    return ScratchSums(sums.share, sums.share_by_line, radiance, sums.energy);
}

// Light that the scratches send of a sphere of radiance 1; before the mask and Fresnel.
fn scratched_sphere(tables: texture_2d_array<u32>, tree: texture_2d<u32>, point: ScratchedPoint, center_m: vec3f, radius_m: f32) -> vec3f {
    var sum = vec3f(0.0);
    var walk = scratched_walk(tree, point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, point, walk, i);
        if seen.share.segment > 0.0 && scratch_meets(point.lit, seen, center_m, radius_m) {
            sum += seen.share.segment * scratch_sphere(tables, point.lit, seen, center_m, radius_m);
        }
    }
    return sum;
}

// Light that the scratches send of a flat light of radiance 1 with three or four corners.
fn scratched_quad(tables: texture_2d_array<u32>, tree: texture_2d<u32>, point: ScratchedPoint, light: QuadLight) -> vec3f {
    var sum = vec3f(0.0);
    var walk = scratched_walk(tree, point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, point, walk, i);
        if seen.share.segment > 0.0 && scratch_meets(point.lit, seen, light.center_m, light.radius_m) {
            sum += seen.share.segment * scratch_quad(tables, point.lit, seen, light);
        }
    }
    return sum;
}

// Light that the scratches send of a polygon of any number of corners or a tube, of radiance 1. `point_m` and the axes of the surface are given in the
// frame of the light's vertices, and so is the sphere that holds it: its middle and, in w, its radius.
fn scratched_outline(
    tables: texture_2d_array<u32>,
    tree: texture_2d<u32>,
    point: ScratchedPoint,
    vertices: texture_2d<u32>,
    light: OutlineLight,
    around: vec4f,
    point_m: vec3f,
    surface: mat3x3f,
) -> vec3f {
    let center_m = (around.xyz - point_m) * surface;
    var sum = vec3f(0.0);
    var walk = scratched_walk(tree, point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, point, walk, i);
        if seen.share.segment > 0.0 && scratch_meets(point.lit, seen, center_m, around.w) {
            let view = outline_view(vertices, light, point_m, surface, seen.tangent);
            sum += seen.share.segment * scratch_outline(tables, vertices, point.lit, seen, view, center_m, around.w);
        }
    }
    return sum;
}

// One of the ENVIRONMENT_CELLS cells of a scratch's band, for an engine that looks its environment up by itself.
struct ScratchedCell {
    direction: vec3f,               // of the look-up, in the surface's frame
    roughness: f32,                 // perceptual, of the mirror lobe that stands for the cell
    response: vec3f,                // times the share and what is seen there it is what the scratch sends; 0 for a cell that is empty
}

fn scratched_cell(tables: texture_2d_array<u32>, table: u32, wo: vec3f, tangent: vec2f, profile: Profile, i: u32) -> ScratchedCell {
    let cell = environment_cell(i, band_line_at(band_from_surface(tangent, wo), 0.0), profile.width_um);
    let depth_nm = oblique_depth_nm(profile.depth_nm, cell.direction.z, wo.z);
    let layer = profile_table(table, profile);
    let low = scratch_table(tables, layer, profile.width_um * cell.q_low, depth_nm);
    let high = scratch_table(tables, layer, profile.width_um * max(cell.q_high, cell.q_low), depth_nm);
    return ScratchedCell(surface_from_band(tangent, cell.direction), environment_cell_roughness(cell), high - low);
}

// Light that the scratches send of an environment of prefiltered levels, see environment.wgsl. `map_from_surface` turns directions into
// the map's frame.
fn scratched_environment(
    tables: texture_2d_array<u32>,
    tree: texture_2d<u32>,
    point: ScratchedPoint,
    levels: texture_2d<f32>,
    map_from_surface: mat3x3f,
) -> vec3f {
    var sum = vec3f(0.0);
    var walk = scratched_walk(tree, point);
    for (var i = scratch_walk_next(tree, &walk); i != SCRATCH_TREE_END; i = scratch_walk_next(tree, &walk)) {
        let seen = scratched_seen(tree, point, walk, i);
        if seen.share.segment > 0.0 {
            sum += seen.share.segment * scratch_environment(tables, point.lit, seen, levels, map_from_surface);
        }
    }
    return sum;
}
