// The light of a fine grating as a table over q and the direction to the viewer. Twin: optics/src/grating/incidence.rs.
// A layer of the scratch tables holds it. Its rows are of components of that direction across the grooves, for each of some angles along them; its
// last column has half of what is missing in the mirror's direction.
// Needs: scratch_table.

const INCIDENCES_ACROSS: f32 = 64.0;
const INCIDENCES_ALONG: f32 = 8.0;
const INCIDENCE_ROWS: i32 = 512;

// Rows of a table about a direction.
struct IncidenceRows {
    near: f32,                  // place at the nearest angles along the grooves
    far: f32,
    share: f32,                 // weight of the second one
}

// `wo` is the unit direction to the viewer in the frame of the grooves, x along them; light lies on the side of q.
fn incidence_rows(wo: vec3f, q: f32) -> IncidenceRows {
    let along = min(abs(wo.x), 1.0);
    let across = clamp(select(wo.y, -wo.y, q < 0.0) * inverseSqrt(max(1.0 - along * along, 1e-18)), -1.0, 1.0);
    // Below the last one: the row after it is another angle's.
    let column = min(0.5 * (across + 1.0), 0.9999999) * (INCIDENCES_ACROSS - 1.0);
    let row = asin(along) * (INCIDENCES_ALONG - 1.0) / 1.57079633;
    let first = min(floor(row), INCIDENCES_ALONG - 2.0);
    return IncidenceRows(first * INCIDENCES_ACROSS + column, (first + 1.0) * INCIDENCES_ACROSS + column, row - first);
}

// T(q) of a viewer's direction, odd for both directions of the grooves together. `u_um` is q times the width that gratings are looked up by.
fn incidence_table(tables: texture_2d_array<u32>, layer: u32, u_um: f32, wo: vec3f) -> vec3f {
    let rows = incidence_rows(wo, u_um);
    let near = scratch_table_row(tables, layer, u_um, rows.near, INCIDENCE_ROWS);
    return near + rows.share * (scratch_table_row(tables, layer, u_um, rows.far, INCIDENCE_ROWS) - near);
}

// Derivative of that by |u|, up to a factor.
fn incidence_table_slope(tables: texture_2d_array<u32>, layer: u32, u_um: f32, wo: vec3f) -> vec3f {
    let rows = incidence_rows(wo, u_um);
    let near = scratch_table_row_slope(tables, layer, u_um, rows.near, INCIDENCE_ROWS);
    return near + rows.share * (scratch_table_row_slope(tables, layer, u_um, rows.far, INCIDENCE_ROWS) - near);
}

// The energy that is missing in the mirror's direction.
fn incidence_table_taken(tables: texture_2d_array<u32>, layer: u32, wo: vec3f) -> vec3f {
    let infinite = 1e18;
    return incidence_table(tables, layer, infinite, wo) - incidence_table(tables, layer, -infinite, wo);
}
