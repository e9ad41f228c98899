// Light of the grooves of a grating: as of a scratch, with a table of their own. Twins: cpu/src/shade_scratches/row_spread.rs,
// cpu/src/shade_scratches/scratch_light.rs; equations: docs/model.md, section 12.
// Needs: scratch_light.

// A grating's table is looked up as that of a scratch of this width and this depth. Twin: optics/src/grating/table.rs.
const GRATING_WIDTH_UM: f32 = 2.0;
const GRATING_DEPTH_NM: f32 = SCRATCH_TABLE_DEPTH_MAX_NM;

// Grooves that lie everywhere under a pixel and cover a share of it; fine ones have a table by incidence.
fn row_seen(tangent: vec2f, share: f32, turns_rad: vec2f, angle_std_rad: f32, by_incidence: bool) -> SeenScratch {
    let profile = Profile(GRATING_WIDTH_UM, GRATING_DEPTH_NM, 0u);
    return SeenScratch(ScratchShare(share, 0.0, 1.0), tangent, 0.0, vec2f(0.0), 1.0, profile, true, by_incidence, turns_rad, angle_std_rad, -1.0);
}

// Light of an environment, as scratch_environment().
fn row_environment(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch, levels: texture_2d<f32>, map_from_surface: mat3x3f) -> vec3f {
    let line = band_line_at(band_from_surface(seen.tangent, point.wo), 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ROW_CELLS; i += 1u) {
        let cell = row_cell(i, line);
        let response = scratch_chord(tables, point, seen, cell.q_high, cell.q_low, cell.direction.z);
        let direction = map_from_surface * surface_from_band(seen.tangent, cell.direction);
        sum += response * environment_prefiltered(levels, direction, environment_cell_roughness(cell));
    }
    return sum;
}

// The energy that the base loses: that of light of radiance 1 from all around; of a fine grating what its table says.
fn row_taken(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch) -> vec3f {
    if seen.by_incidence {
        return incidence_table_taken(tables, point.table, band_from_surface(seen.tangent, point.wo));
    }
    return row_all_around(tables, point, seen);
}

// Light of radiance 1 from all around.
fn row_all_around(tables: texture_2d_array<u32>, point: LitPoint, seen: SeenScratch) -> vec3f {
    let line = band_line_at(band_from_surface(seen.tangent, point.wo), 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < ROW_CELLS; i += 1u) {
        let cell = row_cell(i, line);
        sum += scratch_chord(tables, point, seen, cell.q_high, cell.q_low, cell.direction.z);
    }
    return sum;
}
