// The spectrum of a scratch as a table over u = W q and depth. Twin: optics/src/table.rs.
// A layer of the texture holds one material's table: column pairs (T, slope by the column), rows over depth.

const SCRATCH_TABLE_COLUMNS: i32 = 512;
const SCRATCH_TABLE_ROWS: i32 = 512;
const SCRATCH_TABLE_DEPTH_MAX_NM: f32 = 2000.0;
const SCRATCH_TABLE_U_HALF_UM: f32 = 2.0;

// Value and slope at the left, value and slope at the right, weighted.
fn scratch_table_row(table: texture_2d_array<f32>, layer: u32, at: vec2i, basis: vec4f) -> vec3f {
    return basis.x * textureLoad(table, at, layer, 0).xyz
        + basis.y * textureLoad(table, at + vec2i(1, 0), layer, 0).xyz
        + basis.z * textureLoad(table, at + vec2i(2, 0), layer, 0).xyz
        + basis.w * textureLoad(table, at + vec2i(3, 0), layer, 0).xyz;
}

// T(u, d): cubic in u, linear in depth, odd in u.
fn scratch_table(table: texture_2d_array<f32>, layer: u32, u_um: f32, depth_nm: f32) -> vec3f {
    let u = min(abs(u_um), 1e18);
    let x = u / (u + SCRATCH_TABLE_U_HALF_UM) * f32(SCRATCH_TABLE_COLUMNS - 1);
    let column = min(i32(x), SCRATCH_TABLE_COLUMNS - 2);
    let f = x - f32(column);
    let y = clamp(depth_nm, 0.0, SCRATCH_TABLE_DEPTH_MAX_NM) * (f32(SCRATCH_TABLE_ROWS - 1) / SCRATCH_TABLE_DEPTH_MAX_NM);
    let row = min(i32(y), SCRATCH_TABLE_ROWS - 2);
    let g = y - f32(row);
    // Hermite basis.
    let f2 = f * f;
    let f3 = f2 * f;
    let basis = vec4f(2.0 * f3 - 3.0 * f2 + 1.0, f3 - 2.0 * f2 + f, 3.0 * f2 - 2.0 * f3, f3 - f2);
    let near = scratch_table_row(table, layer, vec2i(2 * column, row), basis);
    let far = scratch_table_row(table, layer, vec2i(2 * column, row + 1), basis);
    let sum = near + (far - near) * g;
    return select(sum, -sum, u_um < 0.0);
}

// T(infinity, d) - T(-infinity, d): the mean of |D|^2 in each channel.
fn scratch_table_total(table: texture_2d_array<f32>, layer: u32, depth_nm: f32) -> vec3f {
    let y = clamp(depth_nm, 0.0, SCRATCH_TABLE_DEPTH_MAX_NM) * (f32(SCRATCH_TABLE_ROWS - 1) / SCRATCH_TABLE_DEPTH_MAX_NM);
    let row = min(i32(y), SCRATCH_TABLE_ROWS - 2);
    let last = 2 * (SCRATCH_TABLE_COLUMNS - 1);
    let near = textureLoad(table, vec2i(last, row), layer, 0).xyz;
    let far = textureLoad(table, vec2i(last, row + 1), layer, 0).xyz;
    return 2.0 * (near + (far - near) * (y - f32(row)));
}
