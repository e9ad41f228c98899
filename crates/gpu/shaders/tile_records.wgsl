// Pass: the records of the scratches of each tile that has a list of them and sees a plane. Each invocation works out the records of
// some scratches, then the light at all their stations: loops of their own, so that lanes which run in step do the same work. Where
// a scratch's light changes faster than stations could tell, the record says that pixels look at it for themselves.

@group(3) @binding(0) var tile_entries: texture_2d<u32>;
@group(3) @binding(1) var tile_records_out: texture_storage_2d<rgba32uint, write>;

// Invocations that share a tile: so many as a processor runs in step.
override RECORD_LANES: u32 = 32u;
// Entries of a list that an invocation works on at once.
const RECORDS: u32 = 8u;

// What may change from one station to the next: of an edge of the light beside the band, in the band's standard deviations; of the
// band's place in the light, in half the light's extent; of q, in wavelengths over the width; of directions to the environment, rad.
const STEP_EDGE: f32 = 0.7;
const STEP_LIGHT: f32 = 0.5;
const STEP_LOBE: f32 = 0.06;
const STEP_ENVIRONMENT: f32 = 0.02;
// How far the band and q may move for pixels to both sides of a scratch, which all take what its middle sends: in standard
// deviations, and in wavelengths over the width; for a distance of BESIDE_STD of the window's.
const BESIDE_EDGE: f32 = 0.1;
const BESIDE_LOBE: f32 = 0.0015;
const BESIDE_STD: f32 = 1.5;
// Pixels see more of a scratch than lies between them: so many standard deviations of their filter.
const PART_STD: f32 = 2.5;
// Where less than this share of a step is gone along the whole part, one station does.
const STEPS_NONE: f32 = 0.05;
// More than there may be stations.
const STEPS_MANY: f32 = 100.0;

// Stations at which light is to be found.
struct RecordStations {
    count: u32,
    // The entry, its segment, and the share of that before the station.
    entries: array<u32, RECORDS * RECORD_STATIONS>,
    segments: array<u32, RECORDS * RECORD_STATIONS>,
    shares: array<f32, RECORDS * RECORD_STATIONS>,
}

@compute @workgroup_size(RECORD_LANES)
fn tile_records(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) lane: u32) {
    let tile = queue_tile(QUEUE_LISTED, workgroup.x);
    let list = tile * frame.tile_entries;
    let head = textureLoad(tile_entries, row_texel(list), 0);
    let count = head.x;
    let plane = plane_from_texels(
        textureLoad(tile_entries, row_texel(list + 1u), 0),
        textureLoad(tile_entries, row_texel(list + 2u), 0),
        textureLoad(tile_entries, row_texel(list + 3u), 0),
    );
    let tiles = tile_counts();
    let own = RECORD_HEAD * tiles.x * tiles.y + head.y / TILE_BLOCK * RECORD_BLOCK_TEXELS;
    let room = textureDimensions(tile_records_out);
    let has_room = own + count / TILE_BLOCK * RECORD_BLOCK_TEXELS <= room.x * room.y;
    if lane == 0u {
        let said = vec4u(select(RECORDS_NONE, count, has_room), own, 0u, 0u);
        textureStore(tile_records_out, row_texel(RECORD_HEAD * tile), said);
        for (var i = 0u; i < PLANE_TEXELS; i += 1u) {
            textureStore(tile_records_out, row_texel(RECORD_HEAD * tile + 1u + i), plane_texel(plane, i));
        }
        if !has_room {
            queue_move(workgroup.x);
        }
    }
    if !has_room {
        return;
    }
    let middle_px = tile_middle_px(tile_corner(tile));
    for (var first = lane; first < count; first += RECORDS * RECORD_LANES) {
        gather_rounds += 1u;
        var stations: RecordStations;
        for (var i = 0u; i < RECORDS; i += 1u) {
            gather_rounds += 1u;
            let at = first + i * RECORD_LANES;
            if at < count {
                let entry = textureLoad(tile_entries, row_texel(list + tile_head() + at), 0);
                textureStore(tile_records_out, row_texel(own + record_list_texel(at)), entry);
                if plane.holds != 0u && entry.x != TILE_NO_SEGMENT {
                    records_keep(at, entry.x, own + record_texel(at), plane, middle_px, &stations);
                }
            }
        }
        for (var i = 0u; i < stations.count; i += 1u) {
            gather_rounds += 1u;
            let entry = stations.entries[i];
            let texel = own + record_texel(entry & 0xffffu) + 3u + (entry >> 16u);
            let radiance = records_find_light(stations.segments[i], stations.shares[i], plane);
            textureStore(tile_records_out, row_texel(texel), vec4u(bitcast<vec3u>(radiance), 0u));
        }
    }
}

// The surface at a point of the plane, as a pixel with its middle there sees it.
fn records_point(plane: TilePlane, position_m: vec3f) -> SurfacePoint {
    let to_camera = frame.camera_m - position_m;
    let distance_m = length(to_camera);
    let to_viewer = to_camera / distance_m;
    let normal = surface_face_viewer(cross(plane.axis_x, plane.axis_y), to_viewer);
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

// The part of a segment that lies in the tile: shares of its length.
fn records_part(seen: SegmentSeen, depths_m: vec2f) -> vec2f {
    let along = seen.end_px - seen.start_px;
    let per_along = 1.0 / select(along, vec2f(1e-6), abs(along) < vec2f(1e-6));
    let half = 0.5 * f32(TILE_PX) + PART_STD * frame.footprint_std_px * gather_filtered();
    let a = (-half - seen.start_px) * per_along;
    let b = (half - seen.start_px) * per_along;
    let enters = clamp(max(min(a.x, b.x), min(a.y, b.y)), 0.0, 1.0);
    let leaves = clamp(min(max(a.x, b.x), max(a.y, b.y)), 0.0, 1.0);
    // A line that passes by is near to the tile about where it is between being in its rows and in its columns.
    let part = select(vec2f(0.5 * (enters + leaves)), vec2f(enters, leaves), enters < leaves);
    // Shares of the picture's line are not those of the segment, whose one end is further away.
    let shares = part * depths_m.x / mix(vec2f(depths_m.y), vec2f(depths_m.x), part);
    return select(vec2f(0.0, 1.0), shares, seen.has_line);
}

fn records_tangent(point: SurfacePoint, along_m: vec3f) -> vec2f {
    return surface_normalize_or(vec3f(surface_from_world(point, along_m).xy, 0.0), vec3f(1.0, 0.0, 0.0)).xy;
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
    // Of an edge or a corner to the band.
    var nearest = min(abs(extent.x), abs(extent.y));
    if HAS_POLYGONS && seen.kind == LIGHT_POLYGON {
        let corners = wo.x + vec4f(
            dot(seen.corners.a.xy, lit.tangent),
            dot(seen.corners.b.xy, lit.tangent),
            dot(seen.corners.c.xy, lit.tangent),
            dot(seen.corners.d.xy, lit.tangent),
        );
        let apart = min(abs(corners.xy), abs(corners.zw));
        nearest = select(0.0, min(apart.x, apart.y), seen.is_small);
    }
    let across = vec2f(-lit.tangent.y, lit.tangent.x);
    let footprint = gather_footprint(view, lit.tangent);
    let beside_m = 1e-6 * BESIDE_STD * view.window_um2 * inverseSqrt(footprint.across_um2 + view.window_um2);
    let beside = band_moves(vec2f(0.0), vec3f(across * beside_m, 0.0), point.wo, 1.0 / point.distance_m, seen.cap.axis, per_i);
    if abs(dot(beside, across)) * lit.width_um > BESIDE_LOBE * 0.555 {
        return STEPS_MANY;
    }
    let differs = abs(dot(beside, lit.tangent)) > BESIDE_EDGE * band.stds.w;
    let steps = select(2.0 * moves_along / (STEP_EDGE * band.stds.w), STEPS_MANY, differs);
    let by_edge = select(0.0, steps, nearest < moves_along + BAND_REACH_STD * band.stds.w);
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


// Works out the record of a segment, but for its light, and asks for that.
fn records_keep(
    entry: u32,
    index: u32,
    texel: u32,
    plane: TilePlane,
    middle_px: vec2f,
    wanted: ptr<function, RecordStations>,
) {
    let segment = segment_at(index);
    let along_m = segment.end_m - segment.start_m;
    let depths_m = max(
        vec2f(dot(segment.start_m - frame.camera_m, frame.forward), dot(segment.end_m - frame.camera_m, frame.forward)),
        vec2f(frame.near_m),
    );
    let part = records_part(segment_seen(segment.start_m, segment.end_m, middle_px), depths_m);
    let point = records_point(plane, segment.start_m + along_m * (0.5 * (part.x + part.y)));
    let view = gather_pixel(point);
    let tangent = records_tangent(point, along_m);

    // On the plane.
    let start_um = plane_from_world(plane, segment.start_m);
    let end_um = plane_from_world(plane, segment.end_m);
    let chord_um = end_um - start_um;
    let length_um = length(chord_um);
    let t = chord_um / max(length_um, 1e-9);
    let n = vec2f(-t.y, t.x);
    let footprint = gather_footprint(view, tangent);
    let variance = footprint.across_um2 + view.window_um2;
    let slant = footprint.cross_um2 / variance;
    let along_variance = footprint.along_um2 - footprint.cross_um2 * slant + segment.blur_um * segment.blur_um;
    let per_z = 1.0 / max(sqrt(2.0 * max(along_variance, 0.0)), 1e-6);
    let per_across = inverseSqrt(2.0 * variance);
    let offset_um = dot(n, 0.5 * (start_um + end_um));
    let first_um = part.x * length_um;
    let shows = length_um > 0.0 && dot(segment.normal, point.normal) >= FACING_MIN_COS;

    let half_m = surface_from_world(point, along_m * (0.5 * (part.y - part.x)));
    let lit = gather_lit(segment.width_depth, tangent, 0.0);
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
        stations = select(1u, 1u + u32(ceil(min(steps, STEPS_MANY))), steps > STEPS_NONE);
    }
    if stations > RECORD_STATIONS {
        textureStore(tile_records_out, row_texel(texel), vec4u(0u, 0u, 0u, bitcast<u32>(RECORD_LEFT)));
        return;
    }
    if stations == 0u {
        textureStore(tile_records_out, row_texel(texel + 3u), vec4u(0u));
    }
    let last = f32(max(stations, 1u) - 1u);
    // W / sqrt(2 pi V), by halves.
    let on_line = 0.5 * segment.width_um * per_across * 0.56418958;
    let depth_nm = oblique_depth_nm(segment.depth_nm, point.wo.z, point.wo.z);
    let record = Record(
        vec4f(vec3f(offset_um, -n) * per_across, select(0.0, on_line, shows)),
        // How far along the scratch lies what a pixel sees of it: a slanted footprint moves it.
        vec4f(vec3f(slant * offset_um - dot(t, start_um) - first_um, t - slant * n) * per_z, -first_um * per_z),
        (length_um - first_um) * per_z,
        last / max((part.y - part.x) * length_um * per_z, 1e-6),
        last,
        scratch_table_total(scratch_tables, point.table, depth_nm),
    );
    textureStore(tile_records_out, row_texel(texel), bitcast<vec4u>(record.across));
    textureStore(tile_records_out, row_texel(texel + 1u), bitcast<vec4u>(record.along));
    textureStore(tile_records_out, row_texel(texel + 2u), record_rest(record));
    for (var i = 0u; i < stations; i += 1u) {
        let at = (*wanted).count;
        (*wanted).entries[at] = entry | (i << 16u);
        (*wanted).segments[at] = index;
        (*wanted).shares[at] = mix(part.x, part.y, select(f32(i) / max(last, 1.0), 0.5, stations == 1u));
        (*wanted).count = at + 1u;
    }
}

// Finds what of a segment's light reaches the viewer from a place on it.
fn records_find_light(index: u32, share: f32, plane: TilePlane) -> vec3f {
    let segment = segment_at(index);
    let along_m = segment.end_m - segment.start_m;
    let point = records_point(plane, segment.start_m + along_m * share);
    let lit = gather_lit(segment.width_depth, records_tangent(point, along_m), 0.0);
    return records_light(point, gather_pixel(point), lit);
}
