// Pass: the records of parts of scratches that tiles have asked for. Each invocation works out the records of some parts, then the
// light at all their stations: loops of their own, so that lanes which run in step do the same work. Where a scratch's light changes
// faster than stations could tell, the record says that pixels look at it for themselves.

@group(3) @binding(1) var scratch_records_out: texture_storage_2d<rgba32uint, write>;

// What may change from one station to the next: of an edge of the light that runs along the band, in the band's standard deviations, and of
// a light that is not much wider than the band, which is a peak; of the band's place in the light, in half the light's extent; of q,
// in wavelengths over the width; of directions to the environment, rad. Between two a straight line is off by an eighth of the step's
// square times the curvature: by 3 hundredths of the light at an edge, and of a peak's.
const STEP_EDGE: f32 = 1.0;
const STEP_NARROW: f32 = 0.5;
const NARROW_STD: f32 = 4.0;
const STEP_LIGHT: f32 = 0.35;
const STEP_CHORD: f32 = 0.1;
const STEP_LOBE: f32 = 0.12;
const STEP_ENVIRONMENT: f32 = 0.02;
// How far the band and q may move for pixels to both sides of a scratch, which all take what its middle sends: in standard
// deviations, and in wavelengths over the width; for a distance of BESIDE_STD of the window's.
const BESIDE_EDGE: f32 = 0.1;
const BESIDE_LOBE: f32 = 0.0015;
const BESIDE_STD: f32 = 1.5;
// Where less than this share of a step is gone along the whole part, one station does.
const STEPS_NONE: f32 = 0.05;
// Steps that all stations together stand for: each then spans half more than it should, so that a light's edge is off by 7 hundredths.
// Tiles of which a single pixel finds a part that does not serve it are shaded by pixels, and few should be.
const STEPS_MOST: f32 = 10.5;
const STEPS_MANY: f32 = 100.0;
// Pixels of tiles that the next part serves see some of this one.
const RECORD_BEYOND_PX: f32 = 6.0;
// By how much the surface's depth may change over a part and the pixels about it: so much shares are wrong there.
const RECORD_DEEPER: f32 = 0.06;

// Stations at which light is to be found: those of a part follow one another.
struct RecordStations {
    count: u32,
    // The part, how many stations follow, and the share of the part's piece before the station.
    parts: array<u32, RECORDS * RECORD_STATIONS>,
    left: array<u32, RECORDS * RECORD_STATIONS>,
    shares: array<f32, RECORDS * RECORD_STATIONS>,
}

@compute @workgroup_size(RECORD_LANES)
fn scratch_records(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) lane: u32) {
    let count = record_count();
    let first = RECORDS * RECORD_LANES * workgroup.x + lane;
    var stations: RecordStations;
    for (var i = 0u; i < RECORDS; i += 1u) {
        gather_rounds += 1u;
        let at = first + i * RECORD_LANES;
        let of_piece = record_part(min(at, max(count, 1u) - 1u));
        if at < count && of_piece.tile != 0u {
            records_keep(at, of_piece, &stations);
        }
    }
    var before = vec3f(0.0);
    var number = 0u;
    var in_time = true;
    for (var i = 0u; i < stations.count; i += 1u) {
        gather_rounds += 1u;
        let at = stations.parts[i];
        let of_piece = record_part(at);
        let plane = record_plane(of_piece.tile - 1u);
        // All stations of a part are lit, or none: then its key is no plane's.
        let ahead = (stations.left[i] + 1u) * frame.light_count;
        in_time = select(in_time, gather_rounds + ahead < GATHER_MAX_ROUNDS, number == 0u);
        var after = vec3f(0.0);
        if in_time {
            after = records_find_light(of_piece, plane, stations.shares[i]);
        }
        let is_alone = number == 0u && stations.left[i] == 0u;
        if number > 0u || is_alone {
            let texel = record_at(at) + RECORD_HEAD_TEXELS + max(number, 1u) - 1u;
            let key = select(0u, plane_key(plane.normal), in_time);
            let sent = record_station_texel(select(before, after, is_alone), after, key);
            textureStore(scratch_records_out, row_texel(texel), sent);
        }
        before = after;
        number = select(number + 1u, 0u, stations.left[i] == 0u);
    }
}

// The surface at a point of the plane, as a pixel with its middle there sees it.
fn records_point(plane: RecordPlane, position_m: vec3f) -> SurfacePoint {
    let to_camera = frame.camera_m - position_m;
    let distance_m = length(to_camera);
    let to_viewer = to_camera / distance_m;
    let normal = surface_face_viewer(plane.normal, to_viewer);
    let cos_view = dot(normal, to_viewer);
    let depth_m = max(-dot(to_camera, frame.forward), frame.near_m);
    let ray = -to_camera / depth_m;
    var point: SurfacePoint;
    point.position_m = position_m;
    point.normal = normal;
    point.axis_x = surface_normalize_or(to_viewer - normal * cos_view, surface_any_across(normal));
    point.axis_y = cross(normal, point.axis_x);
    point.wo = vec3f(sqrt(max(1.0 - cos_view * cos_view, 0.0)), 0.0, cos_view);
    point.distance_m = distance_m;
    point.footprint_x_m = footprint_axis(ray, depth_m, normal, frame.per_px_x) * frame.footprint_std_px;
    point.footprint_y_m = footprint_axis(ray, depth_m, normal, frame.per_px_y) * frame.footprint_std_px;
    point.coherence_um = plane.coherence_um;
    point.table = plane.table;
    return point;
}

// Shares of a piece's line in the picture as shares of the piece, whose one end is further away.
fn records_shares(in_picture: vec2f, depths_m: vec2f) -> vec2f {
    return in_picture * depths_m.x / mix(vec2f(depths_m.y), vec2f(depths_m.x), in_picture);
}

fn records_tangent(point: SurfacePoint, along_m: vec3f) -> vec2f {
    return surface_normalize_or(vec3f(surface_from_world(point, along_m).xy, 0.0), vec3f(1.0, 0.0, 0.0)).xy;
}

// A step of the band in which the chord of an outline changes little: its length is a straight line between corners, so that it
// changes fast by an edge that runs along the band. `narrow` is the least step, `near` how far from the band a corner counts.
fn records_outline_step(wo_t: f32, corners: Corners, tangent: vec2f, narrow: f32, near: f32) -> f32 {
    let c = corners;
    return min(
        min(records_edge_step(wo_t, c.a, c.b, tangent, narrow, near), records_edge_step(wo_t, c.b, c.c, tangent, narrow, near)),
        min(records_edge_step(wo_t, c.c, c.d, tangent, narrow, near), records_edge_step(wo_t, c.d, c.next, tangent, narrow, near)),
    );
}

// An edge has a corner where it meets the horizon, too; a triangle's last edge has no length.
fn records_edge_step(wo_t: f32, a: vec3f, b: vec3f, tangent: vec2f, narrow: f32, near: f32) -> f32 {
    let corner = surface_normalize_or(a * abs(b.z) + b * abs(a.z), a);
    let at = dot(select(a, corner, a.z < 0.0).xy, tangent);
    let to = dot(select(b, corner, b.z < 0.0).xy, tangent);
    let is_near = min(abs(wo_t + at), abs(wo_t + to)) < near;
    let counts = is_near && max(a.z, b.z) > 0.0 && distance(a, b) > 1e-6;
    return select(1e9, max(narrow, STEP_CHORD * abs(to - at)), counts);
}

// How many steps a light changes by along a part of a segment: none if it does not reach it at all. `half_m` is half the part, from
// its middle, in the surface's frame.
fn records_steps(point: SurfacePoint, view: GatherPixel, lit: LitSegment, half_m: vec3f, index: u32) -> f32 {
    let seen = gather_light_seen(point, view, index);
    let around = light_around(index);
    let per_i = 1.0 / max(length(around.xyz - point.position_m), around.w);
    let moves = band_moves(vec2f(0.0), half_m, point.wo, 1.0 / point.distance_m, seen.cap.axis, per_i);
    let moves_along = abs(dot(moves, lit.tangent));
    let moves_across = abs(lit.tangent.x * moves.y - lit.tangent.y * moves.x);
    let band = gather_band(view, seen, lit.tangent, 0.0);
    let wo = band_from_surface(lit.tangent, point.wo);
    let extent = sphere_band_extent(wo, cap_turned(lit.tangent, seen.cap));
    if !seen.shines || !band_reaches(extent.x - moves_along, extent.y + moves_along, band.stds) {
        return 0.0;
    }
    let across = vec2f(-lit.tangent.y, lit.tangent.x);
    let footprint = gather_footprint(view, lit.tangent);
    let beside_m = 1e-6 * BESIDE_STD * view.window_um2 * inverseSqrt(footprint.across_um2 + view.window_um2);
    let beside = band_moves(vec2f(0.0), vec3f(across * beside_m, 0.0), point.wo, 1.0 / point.distance_m, seen.cap.axis, per_i);
    if abs(dot(beside, across)) * lit.width_um > BESIDE_LOBE * 0.555 {
        return STEPS_MANY;
    }
    let differs = abs(dot(beside, lit.tangent)) > BESIDE_EDGE * band.stds.w;
    let is_narrow = extent.y - extent.x < NARROW_STD * band.stds.w;
    let narrow = select(STEP_EDGE, STEP_NARROW, is_narrow) * band.stds.w;
    let near = moves_along + BAND_REACH_STD * band.stds.w;
    var step = select(1e9, narrow, min(abs(extent.x), abs(extent.y)) < near);
    if HAS_POLYGONS && seen.kind == LIGHT_POLYGON {
        step = select(narrow, records_outline_step(wo.x, seen.corners, lit.tangent, narrow, near), seen.is_small);
    }
    let by_edge = select(2.0 * moves_along / step, STEPS_MANY, differs && step < 1e9);
    let by_light = 4.0 * moves_along / (STEP_LIGHT * max(extent.y - extent.x, 1e-9));
    let by_lobe = 2.0 * moves_across * lit.width_um / (STEP_LOBE * 0.555);
    return max(max(max(by_edge, min(by_light, STEPS_MANY)), by_lobe), 1e-9);
}

// What of a segment's light reaches the viewer, per unit of its share.
fn records_light(point: SurfacePoint, view: GatherPixel, lit: LitSegment) -> vec3f {
    var radiance = vec3f(0.0);
    if HAS_SPHERES || HAS_POLYGONS {
        for (var l = 0u; l < frame.light_count; l += 1u) {
            gather_rounds += 1u;
            let seen = gather_light_seen(point, view, l);
            // Where lights are few, most of them reach what any of them reaches.
            let reaches = seen.shines && (!HAS_MANY_LIGHTS || gather_reaches(point, view, seen, lit.tangent, lit.offset_um));
            if HAS_SPHERES && reaches && seen.kind == LIGHT_SPHERE {
                radiance += seen.radiance * gather_sphere(point, view, lit, seen);
            }
            if HAS_POLYGONS && reaches && seen.kind == LIGHT_POLYGON && seen.is_small {
                radiance += seen.radiance * gather_polygon(point, view, lit, seen);
            }
            if HAS_LARGE_POLYGONS && reaches && seen.kind == LIGHT_POLYGON && !seen.is_small {
                radiance += seen.radiance * gather_large_polygon(point, view, lit, seen);
            }
        }
    }
    if HAS_ENVIRONMENT {
        radiance += gather_environment(point, lit);
    }
    return radiance;
}

// Works out the record of a part but for its light, and asks for that.
fn records_keep(at: u32, of_piece: ScratchPart, wanted: ptr<function, RecordStations>) {
    let segment = segment_at(of_piece.segment);
    let plane = record_plane(of_piece.tile - 1u);
    let along_m = segment.end_m - segment.start_m;
    let depths_m = vec2f(
        dot(segment.start_m - frame.camera_m, frame.forward),
        dot(segment.end_m - frame.camera_m, frame.forward),
    );
    let seen = segment_seen(segment.start_m, segment.end_m, vec2f(0.0));
    let line_px = seen.end_px - seen.start_px;
    let length_px = length(line_px);
    // The part that has stations, and its middle: shares of the line in the picture.
    let beyond = RECORD_BEYOND_PX / length_px;
    let range = vec2f(vec2u(of_piece.part, of_piece.part + 1u)) / f32(of_piece.parts);
    let part = clamp(range + vec2f(-beyond, beyond), vec2f(0.0), vec2f(1.0));
    let middle = 0.5 * (part.x + part.y);
    let shares = records_shares(part, depths_m);
    let start_m = segment.start_m + along_m * shares.x;
    let end_m = segment.start_m + along_m * shares.y;
    let point = records_point(plane, segment.start_m + along_m * records_shares(vec2f(middle), depths_m).x);
    let view = gather_pixel(point);
    let tangent = records_tangent(point, along_m);

    let footprint = gather_footprint(view, tangent);
    let variance = footprint.across_um2 + view.window_um2;
    let slant = footprint.cross_um2 / variance;
    let along_variance = footprint.along_um2 - footprint.cross_um2 * slant + segment.blur_um * segment.blur_um;
    let per_z = 1.0 / max(sqrt(2.0 * max(along_variance, 0.0)), 1e-6);
    let per_across = inverseSqrt(2.0 * variance);
    let shows = length_px > 0.0 && dot(segment.normal, point.normal) >= FACING_MIN_COS;

    let lit = gather_lit(segment.width_depth, tangent, 0.0);
    let half_m = surface_from_world(point, 0.5 * (end_m - start_m));
    var steps = 0.0;
    if HAS_SPHERES || HAS_POLYGONS {
        for (var l = 0u; l < frame.light_count; l += 1u) {
            gather_rounds += 1u;
            steps = max(steps, records_steps(point, view, lit, half_m, l));
        }
    }
    if HAS_ENVIRONMENT {
        steps = max(steps, max(2.0 * length(half_m) / (point.distance_m * STEP_ENVIRONMENT), 1e-9));
    }
    var stations = 0u;
    if shows && steps > 0.0 {
        stations = select(1u, min(1u + u32(ceil(min(steps, STEPS_MANY))), RECORD_STATIONS), steps > STEPS_NONE);
    }

    // A pixel to the right and down, on the plane.
    let to_camera = frame.camera_m - point.position_m;
    let depth_m = max(-dot(to_camera, frame.forward), frame.near_m);
    let ray = -to_camera / depth_m;
    let x_m = footprint_axis(ray, depth_m, point.normal, frame.per_px_x);
    let y_m = footprint_axis(ray, depth_m, point.normal, frame.per_px_y);
    let x_um = 1e6 * surface_from_world(point, x_m).xy;
    let y_um = 1e6 * surface_from_world(point, y_m).xy;
    let n = vec2f(-tangent.y, tangent.x);
    // How far along the scratch lies what a pixel sees of it: a slanted footprint moves it.
    let t = tangent - slant * n;
    // The line in the picture is where the distance across is nothing, to the last digit.
    let across_um = dot(vec2f(dot(n, x_um), dot(n, y_um)), seen.normal);
    let along_um = vec2f(dot(t, x_um), dot(t, y_um));
    let um_per_px = dot(along_um, line_px) / length_px;
    let last = f32(max(stations, 1u) - 1u);
    let stations_per_px = last / max((part.y - part.x) * length_px, 1e-6);
    // One station: places count in pixels.
    let per_px = select(stations_per_px, 1.0, last == 0.0);
    let per_um = per_px / um_per_px;
    let deeper = length(vec2f(dot(x_m, frame.forward), dot(y_m, frame.forward))) / depth_m;
    let apart_px = 0.5 * (part.y - part.x) * length_px + f32(TILE_PX);
    let serves = steps <= STEPS_MOST && deeper * apart_px <= RECORD_DEEPER && um_per_px > 0.0;
    // W / sqrt(2 pi V), by halves.
    let half_line = 0.5 * segment.width_um * per_across * 0.56418958;
    let depth_nm = oblique_depth_nm(segment.depth_nm, point.wo.z, point.wo.z);
    let record = Record(
        seen.start_px + middle * line_px,
        last,
        select(-1.0, select(0.0, half_line, shows), serves),
        seen.normal * across_um * per_across / record_scale(depth_m),
        along_um * per_um,
        0.5 * last + (vec2f(0.0, 1.0) - middle) * length_px * per_px,
        per_z / per_um,
        scratch_table_total(scratch_tables, point.table, depth_nm),
    );
    for (var i = 0u; i < RECORD_HEAD_TEXELS; i += 1u) {
        textureStore(scratch_records_out, row_texel(record_at(at) + i), record_texel(record, i));
    }
    if !serves || stations == 0u {
        let nothing = record_station_texel(vec3f(0.0), vec3f(0.0), plane_key(plane.normal));
        textureStore(scratch_records_out, row_texel(record_at(at) + RECORD_HEAD_TEXELS), nothing);
        return;
    }
    for (var i = 0u; i < stations; i += 1u) {
        let place = (*wanted).count;
        let in_picture = mix(part.x, part.y, select(f32(i) / max(last, 1.0), 0.5, stations == 1u));
        (*wanted).parts[place] = at;
        (*wanted).left[place] = stations - 1u - i;
        (*wanted).shares[place] = records_shares(vec2f(in_picture), depths_m).x;
        (*wanted).count = place + 1u;
    }
}

// Finds what of a scratch's light reaches the viewer from a place on a piece.
fn records_find_light(of_piece: ScratchPart, plane: RecordPlane, share: f32) -> vec3f {
    let segment = segment_at(of_piece.segment);
    let along_m = segment.end_m - segment.start_m;
    let point = records_point(plane, segment.start_m + along_m * share);
    let lit = gather_lit(segment.width_depth, records_tangent(point, along_m), 0.0);
    return records_light(point, gather_pixel(point), lit);
}
