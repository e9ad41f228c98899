// A direction from which a rectangle with a picture reaches the viewer by way of a scratch, drawn as drawn_light.wgsl does. Twin: draw_light of
// cpu/src/shade_scratches/scratch_light.rs.
// Needs: drawn_light, scratch_picture.

// Part `i` of the chords of a line: its lower end, its middle and its upper end.
fn drawn_picture_part(seen: SeenScratch, chords: PictureChords, i: u32) -> vec3f {
    let count = picture_cells(seen);
    let ends = select(chords.first, chords.second, i >= count);
    let share = (f32(i % count) + vec3f(0.0, 0.5, 1.0)) / f32(count);
    let width_um = weighed_um(seen);
    return vec3f(
        picture_place(share.x, ends.x, ends.y, width_um),
        picture_place(share.y, ends.x, ends.y, width_um),
        picture_place(share.z, ends.x, ends.y, width_um),
    );
}

fn draw_picture(point: LitPoint, seen: SeenScratch, light: PictureLight, u: vec3f) -> DrawnFrom {
    let quad = light.quad;
    var taken: DrawnFrom;
    let facing = polygon_facing(quad.normal, quad.a_m, quad.two_sided);
    if facing == 0.0 {
        return taken;
    }
    let band = scratch_band(point, seen, sphere_cap(quad.center_m, quad.radius_m).axis, max(length(quad.center_m), quad.radius_m));
    let wo = band_from_surface(seen.tangent, point.wo) + vec3f(band.shift, 0.0, 0.0);
    let away = band_from_surface(seen.tangent, -facing * quad.normal);
    let outline = picture_outline(seen, quad);
    let extent = four_edges_extent(outline, away);
    let lines = band_lines(wo.x, wo.x + extent.x, wo.x + extent.y, band.stds);
    var offer = drawn_offers(u.y);
    for (var l = 0u; l < lines.count; l += 1u) {
        let line = drawn_line(lines, wo, l, u.x);
        let roots = four_edges_roots(outline, line, away);
        let cos_i = drawn_cos(seen, line, roots.range);
        let chords = picture_chords(roots, line);
        for (var i = 0u; i < chords.count * picture_cells(seen); i += 1u) {
            let ends = drawn_picture_part(seen, chords, i);
            // A line of its own is drawn across the band.
            let here = picture_piece(seen, light, line, ends.x, ends.y, ends.z, vec2f(0.0));
            let part_cos = picture_cos(seen, line, ends.y, cos_i);
            let sent = here * scratch_chord(scratch_tables, point, seen, ends.z, ends.x, part_cos);
            if drawn_offer(&offer, sent) {
                taken = DrawnFrom(line, DrawnPart(ends.x, ends.z, u.z * rgb_luminance(sent)), part_cos, true, here, vec3f(0.0));
            }
        }
    }
    taken.total = offer.total;
    return taken;
}
