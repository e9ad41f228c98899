// What the pixels of a tile see, and how far around it scratches touch them.

@group(3) @binding(0) var tile_visibility: texture_2d<u32>;

// How far a line reaches is known to rounding; where shading bends the surface, it is wrong by up to some of this for each part.
const TILE_MARGIN: f32 = 1.02;
const TILE_MARGIN_BENT: f32 = 2.6;
const TILE_MARGIN_PX: f32 = 0.02;
// Ends are followed further than lines: around a short stroke little else is to be seen than how it fades.
const TILE_REACH_ENDS: f32 = 1.3;
// Where shading bends the surface by more than this the footprint in the picture is not what the line tells.
const TILE_BENT: f32 = 0.05;

// Only of tiles that see no more triangles than this it is asked whether these lie in one plane.
const TILE_TRIANGLES: u32 = 8u;

// What the pixels of a tile see of one object.
struct TileSight {
    object: u32,                // + 1; 0 if they see none
    one_object: bool,
    lower_m: vec3f,             // a box that every footprint lies in
    upper_m: vec3f,
    reach2_px: vec2f,           // the squares of how far a pixel that sees a scratch may be from its line, and beyond its ends
    plane: TilePlane,           // whether it holds is asked only where light is looked for along scratches
    material: u32,              // + 1, of its first pixel
    one_material: bool,         // asked likewise
}

// The triangles that a tile's pixels see, if they are few.
struct TileTriangles {
    object: u32,                // + 1, of the last of them; 0 if they see none
    one_object: bool,
    count: u32,
    triangles: array<vec4u, 2>, // in the order in which they are found, + 1
    are_few: bool,              // else they are not all told
    first_pixel: u32,           // that sees an object
}

fn tile_triangle(seen: TileTriangles, i: u32) -> u32 {
    return seen.triangles[i / 4u][i % 4u] - 1u;
}

fn tile_holds(in_film: vec2u) -> bool {
    return in_film.x < frame.size_px.x && in_film.y + frame.rows.x < frame.rows.y;
}

fn tile_triangles(corner: vec2u) -> TileTriangles {
    var seen: TileTriangles;
    seen.one_object = true;
    seen.are_few = true;
    for (var i = 0u; i < TILE_PX * TILE_PX; i += 1u) {
        gather_rounds += 1u;
        let in_film = corner + vec2u(i % TILE_PX, i / TILE_PX);
        let ids = textureLoad(tile_visibility, in_film, 0).xy;
        if !tile_holds(in_film) || ids.x == 0u {
            continue;
        }
        seen.first_pixel = select(seen.first_pixel, i, seen.object == 0u);
        seen.one_object = seen.one_object && (seen.object == 0u || seen.object == ids.y + 1u);
        seen.object = ids.y + 1u;
        // All places at once: software drivers reach for each lane's place of an array by itself.
        let is_known = any(seen.triangles[0] == vec4u(ids.x)) || any(seen.triangles[1] == vec4u(ids.x));
        let place = select(seen.count, TILE_TRIANGLES, is_known);
        seen.triangles[0] = select(seen.triangles[0], vec4u(ids.x), vec4u(0u, 1u, 2u, 3u) == vec4u(place));
        seen.triangles[1] = select(seen.triangles[1], vec4u(ids.x), vec4u(4u, 5u, 6u, 7u) == vec4u(place));
        seen.are_few = seen.are_few && (is_known || place < TILE_TRIANGLES);
        seen.count += u32(place < TILE_TRIANGLES);
    }
    return seen;
}

fn tile_sight_none(triangles: TileTriangles) -> TileSight {
    var sight: TileSight;
    sight.object = triangles.object;
    sight.one_object = triangles.one_object;
    sight.one_material = true;
    sight.lower_m = vec3f(1e30);
    sight.upper_m = vec3f(-1e30);
    return sight;
}

// Where all triangles lie in one plane, a pixel and the tile's corners tell what all pixels see. If not, pixels are looked at one by one.
fn tile_sight(corner: vec2u, tile: u32) -> TileSight {
    let triangles = tile_triangles(corner);
    let middle = tile_middle_px(corner);
    var tallied = vec2u(0u);
    if METHOD_GATHER != GATHER_EXACT {
        tallied = queue_tallied(tile);
    }
    var by_corners = METHOD_GATHER == GATHER_EXACT && triangles.are_few;
    var rounds = select(TILE_PX * TILE_PX, 1u, by_corners);
    var sight = tile_sight_none(triangles);
    var is_first = true;
    for (var i = 0u; i < rounds; i += 1u) {
        gather_rounds += 1u;
        let place = select(i, triangles.first_pixel, by_corners);
        let in_film = corner + vec2u(place % TILE_PX, place / TILE_PX);
        let seen = select(vec2u(0u), textureLoad(tile_visibility, in_film, 0).xy, tile_holds(in_film));
        if seen.x == 0u {
            continue;
        }
        let ray = tile_ray(middle + tile_at_px(in_film));
        var depth_m: f32;
        let point = hit_surface_point(seen.x - 1u, ray, &depth_m);
        if is_first {
            sight.plane = plane_of(point);
        }
        if METHOD_LIGHT_AT == LIGHT_AT_SCRATCHES {
            let material = tile_material(seen.x - 1u) + 1u;
            sight.material = select(sight.material, material, is_first);
            sight.one_material = sight.one_material && material == sight.material;
        }
        is_first = false;
        if by_corners {
            by_corners = tile_is_flat(triangles, sight.plane);
            for (var c = 0u; c < 4u; c += 1u) {
                gather_rounds += 1u;
                let in_tile = (TILE_PX - 1u) * vec2u(c & 1u, c >> 1u);
                by_corners = by_corners && tile_sight_add_corner(&sight, point, tile_ray(middle + tile_at_px(corner + in_tile)));
            }
            if !by_corners {
                rounds = TILE_PX * TILE_PX;
                sight = tile_sight_none(triangles);
                is_first = true;
                i = 0xffffffffu;
            }
            continue;
        }
        if METHOD_LIGHT_AT == LIGHT_AT_SCRATCHES {
            sight.plane.holds = sight.plane.holds && plane_holds(sight.plane, point);
        }
        // What grids stand for needs no list, nor what is added up.
        let is_tallied = ((select(tallied.x, tallied.y, i >= 32u) >> (i % 32u)) & 1u) == 1u;
        if METHOD_GATHER != GATHER_EXACT && (is_tallied || bundle_single_share_at(point, seen.y) == 0.0) {
            continue;
        }
        tile_sight_add(&sight, point, ray);
    }
    return sight;
}

fn tile_sight_add(sight: ptr<function, TileSight>, point: SurfacePoint, ray: vec3f) {
    let reach = gather_reach_m(point);
    (*sight).lower_m = min((*sight).lower_m, point.position_m - reach);
    (*sight).upper_m = max((*sight).upper_m, point.position_m + reach);
    (*sight).reach2_px = max((*sight).reach2_px, tile_reach2_px(point, ray));
}

// What a corner's ray sees of the plane about a point. False if it is not seen as the point is.
fn tile_sight_add_corner(sight: ptr<function, TileSight>, about: SurfacePoint, ray: vec3f) -> bool {
    let to_camera = frame.camera_m - about.position_m;
    let depth_m = -dot(about.facet, to_camera) / dot(about.facet, ray);
    var point = about;
    point.position_m = frame.camera_m + ray * depth_m;
    point.footprint_x_m = footprint_axis(ray, depth_m, about.normal, frame.per_px_x) * frame.footprint_std_px;
    point.footprint_y_m = footprint_axis(ray, depth_m, about.normal, frame.per_px_y) * frame.footprint_std_px;
    tile_sight_add(sight, point, ray);
    let least = MIN_VIEW_COS * length(ray);
    return depth_m > 0.0 && -dot(about.normal, ray) > least && -dot(about.facet, ray) > least;
}

// Whether all triangles lie in a plane that the first of them shows, and are of its material; with a normal map none is a plane.
fn tile_is_flat(seen: TileTriangles, plane: TilePlane) -> bool {
    let material = tile_material(tile_triangle(seen, 0u));
    var is_flat = !hit_has_texture(material_at(material).normal_texture);
    for (var t = 0u; t < seen.count; t += 1u) {
        gather_rounds += 1u;
        let triangle = tile_triangle(seen, t);
        is_flat = is_flat && tile_material(triangle) == material && plane_holds_triangle(plane, triangle);
    }
    return is_flat;
}

fn tile_material(triangle: u32) -> u32 {
    return vertices[3u * triangle].material & ~VERTEX_BITANGENT_FLIPPED;
}

// The squares of the distances in pixels beyond which a scratch does not touch a pixel: from its line, and along it from its ends.
fn tile_reach2_px(point: SurfacePoint, ray: vec3f) -> vec2f {
    let bent = abs(dot(ray, point.normal) / dot(ray, point.facet) - 1.0);
    // The side of a pixel on the surface where it is narrowest: the least singular value of its two steps.
    let step = max(frame.footprint_std_px, 1e-9);
    let x = point.footprint_x_m / step;
    let y = point.footprint_y_m / step;
    let mean = 0.5 * (dot(x, x) + dot(y, y));
    let product = dot(x, x) * dot(y, y) - dot(x, y) * dot(x, y);
    let narrowest2 = product / max(mean + sqrt(max(mean * mean - product, 0.0)), 1e-37);
    if !(narrowest2 > 0.0) {
        return vec2f(1e30);
    }
    let sigma_m = point.coherence_um * 1e-6;
    let filter_px = frame.footprint_std_px * gather_filtered();
    // The window's variance, and that of the blur at an end.
    let variance = filter_px * filter_px + vec2f(0.5, 0.7) * (sigma_m * sigma_m / narrowest2);
    let reach = (TILE_MARGIN + TILE_MARGIN_BENT * bent) * vec2f(REACH_STD, TILE_REACH_ENDS * REACH_STD) * sqrt(variance) + TILE_MARGIN_PX;
    return select(vec2f(1e30), reach * reach, bent < TILE_BENT);
}
