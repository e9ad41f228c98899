// Light that one scratch sends to the viewer of a rectangle with a picture: each chord in parts. Twin:
// cpu/src/shade_scratches/scratch_light.rs.
// Needs: picture_light, scratch_light.

// A rectangle with a picture as a scratch sees it.
struct PictureLight {
    quad: QuadLight,
    plane: PicturePlane,        // in the surface's frame
    picture: vec2u,
}

// Parts of a chord.
fn picture_cells(seen: SeenScratch) -> u32 {
    return select(PICTURE_CELLS, PICTURE_ROW_CELLS, seen.is_row);
}

// The cosine for the groove's depth in a part, given that for all of the chord.
fn picture_cos(seen: SeenScratch, line: BandLine, middle: f32, cos_i: f32) -> f32 {
    return select(cos_i, band_cos_at(line, middle), seen.is_row);
}

// The light of a part of a chord, which stands for a band by its variance at q = 0 and for each q squared.
fn picture_piece(seen: SeenScratch, light: PictureLight, line: BandLine, low: f32, middle: f32, high: f32, across_variance: vec2f) -> vec3f {
    let look = picture_on_chord(
        light.plane,
        picture_direction(seen, line, low),
        picture_direction(seen, line, middle),
        picture_direction(seen, line, high),
        sqrt(max(across_variance.x + across_variance.y * middle * middle, 0.0)),
    );
    return picture_at(light.picture, look);
}

// The direction of a line at q, in the surface's frame.
fn picture_direction(seen: SeenScratch, line: BandLine, q: f32) -> vec3f {
    return surface_from_band(seen.tangent, vec3f(line.along, q - line.offset, band_cos_at(line, q)));
}

// Light of a chord from q to q.
fn picture_chord(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, light: PictureLight, line: BandLine, ends: vec2f, cos_i: f32, across_variance: vec2f) -> vec3f {
    var sum = vec3f(0.0);
    var low = ends.x;
    let count = picture_cells(seen);
    for (var i = 0u; i < count; i += 1u) {
        let middle = picture_place((f32(i) + 0.5) / f32(count), ends.x, ends.y, weighed_um(seen));
        let high = picture_place(f32(i + 1u) / f32(count), ends.x, ends.y, weighed_um(seen));
        let sent = scratch_chord(tables, point, seen, high, low, picture_cos(seen, line, middle, cos_i));
        sum += sent * picture_piece(seen, light, line, low, middle, high, across_variance);
        low = high;
    }
    return sum;
}

// The chords of a rectangle on a line: one, or two where it holds the direction straight down.
struct PictureChords {
    first: vec2f,
    second: vec2f,
    count: u32,
}

fn picture_chords(corners: FourRoots, line: BandLine) -> PictureChords {
    var roots = corners;
    let arc = vec2f(band_q_end(line), band_q_start(line));
    if roots.count == 0u {
        return PictureChords(arc, arc, u32(roots.wraps));
    }
    let ends = next_roots(&roots);
    let chord = vec2f(min(ends.x, ends.y), max(ends.x, ends.y));
    if roots.wraps {
        return PictureChords(vec2f(arc.x, chord.x), vec2f(chord.y, arc.y), 2u);
    }
    return PictureChords(chord, chord, 1u);
}

// Light of a rectangle of radiance 1 with a picture. It is cheaper to ask scratch_meets() first.
fn scratch_picture(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, light: PictureLight) -> vec3f {
    let quad = light.quad;
    let facing = polygon_facing(quad.normal, quad.a_m, quad.two_sided);
    if facing == 0.0 {
        return vec3f(0.0);
    }
    let band = scratch_band(point, seen, sphere_cap(quad.center_m, quad.radius_m).axis, max(length(quad.center_m), quad.radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let away = band_from_surface(seen.tangent, -facing * quad.normal);
    let outline = picture_outline(seen, quad);
    let extent = four_edges_extent(outline, away);
    let lines = seen_lines(seen, wo.x, wo.x + extent, band.stds);
    // Several lines see the picture where they lie, and so does one of them.
    var across_variance = vec2f(0.0);
    if lines.count == 1u && seen.node < 0.0 {
        let axis = sphere_cap(quad.center_m, quad.radius_m).axis;
        let q = band_from_surface(seen.tangent, point.wo + axis).y;
        let per_q2 = seen.angle_std_rad * seen.angle_std_rad;
        across_variance = vec2f(band.stds.w * band.stds.w - per_q2 * q * q, per_q2);
    }
    var sum = vec3f(0.0);
    var weights = vec3f(0.0);
    for (var l = 0u; l < lines.count; l += 1u) {
        let weight_and_xi = band_line(lines, l);
        let line = band_line_at(wo, weight_and_xi.w);
        let roots = four_edges_roots(outline, line, away);
        let cos_i = chord_cos(line, roots.range.x, roots.range.y, weighed_um(seen));
        let chords = picture_chords(roots, line);
        var integral = vec3f(0.0);
        for (var i = 0u; i < chords.count; i += 1u) {
            let ends = select(chords.first, chords.second, i == 1u);
            integral += picture_chord(tables, point, seen, light, line, ends, cos_i, across_variance);
        }
        sum += weight_and_xi.xyz * integral;
        weights += weight_and_xi.xyz;
    }
    return band_integral(lines, sum, weights);
}

fn picture_outline(seen: SeenScratch, quad: QuadLight) -> FourEdges {
    return FourEdges(
        band_from_surface(seen.tangent, surface_direction(quad.a_m)),
        band_from_surface(seen.tangent, surface_direction(quad.b_m)),
        band_from_surface(seen.tangent, surface_direction(quad.c_m)),
        band_from_surface(seen.tangent, surface_direction(quad.d_m)),
        quad.corner_count,
    );
}
