// The spectrum of a scratch as a table over u = W q and depth. Twin: optics/src/table.rs.
// A layer of the texture holds one material's table: T in three channels and, packed, its slopes by the column; rows over depth. Rows below the
// deepest groove may be missing: nothing reads them.

const SCRATCH_TABLE_COLUMNS: i32 = 1024;
const SCRATCH_TABLE_ROWS: i32 = 512;
const SCRATCH_TABLE_DEPTH_MAX_NM: f32 = 2000.0;
const SCRATCH_TABLE_U_HALF_UM: f32 = 2.0;
const SCRATCH_TABLE_EXPONENT_BIAS: f32 = 36.0;

// T a share `f` of a column beside the nearest one.
fn scratch_table_near(texel: vec4u, f: f32) -> vec3f {
    let word = bitcast<i32>(texel.w);
    let mantissas = vec3f(vec3i(extractBits(word, 0u, 9u), extractBits(word, 9u, 9u), extractBits(word, 18u, 9u)));
    return bitcast<vec3f>(texel.xyz) + mantissas * (f * exp2(f32(texel.w >> 27u) - SCRATCH_TABLE_EXPONENT_BIAS));
}

// Place of a depth among the rows.
fn scratch_table_depth(depth_nm: f32) -> f32 {
    return clamp(depth_nm, 0.0, SCRATCH_TABLE_DEPTH_MAX_NM) * (f32(SCRATCH_TABLE_ROWS - 1) / SCRATCH_TABLE_DEPTH_MAX_NM);
}

// T(u, d), odd in u: by value and slope of the nearest column, linear in depth.
fn scratch_table(table: texture_2d_array<u32>, layer: u32, u_um: f32, depth_nm: f32) -> vec3f {
    return scratch_table_row(table, layer, u_um, scratch_table_depth(depth_nm), SCRATCH_TABLE_ROWS);
}

// T(u) at a row or between two, of so many.
fn scratch_table_row(table: texture_2d_array<u32>, layer: u32, u_um: f32, y: f32, rows: i32) -> vec3f {
    let u = min(abs(u_um), 1e18);
    let x = u / (u + SCRATCH_TABLE_U_HALF_UM) * f32(SCRATCH_TABLE_COLUMNS - 1);
    let column = min(i32(x + 0.5), SCRATCH_TABLE_COLUMNS - 1);
    let row = min(i32(y), rows - 2);
    let beside = x - f32(column);
    let near = scratch_table_near(textureLoad(table, vec2i(column, row), layer, 0), beside);
    let far = scratch_table_near(textureLoad(table, vec2i(column, row + 1), layer, 0), beside);
    let sum = near + (far - near) * (y - f32(row));
    return select(sum, -sum, u_um < 0.0);
}

// T(infinity, d) - T(-infinity, d): the mean of |D|^2 in each channel.
fn scratch_table_total(table: texture_2d_array<u32>, layer: u32, depth_nm: f32) -> vec3f {
    let y = scratch_table_depth(depth_nm);
    let row = min(i32(y), SCRATCH_TABLE_ROWS - 2);
    let near = bitcast<vec3f>(textureLoad(table, vec2i(SCRATCH_TABLE_COLUMNS - 1, row), layer, 0).xyz);
    let far = bitcast<vec3f>(textureLoad(table, vec2i(SCRATCH_TABLE_COLUMNS - 1, row + 1), layer, 0).xyz);
    return 2.0 * (near + (far - near) * (y - f32(row)));
}

// Derivative of T by |u|, up to a factor: the colours of the light from a direction.
fn scratch_table_slope(table: texture_2d_array<u32>, layer: u32, u_um: f32, depth_nm: f32) -> vec3f {
    return scratch_table_row_slope(table, layer, u_um, scratch_table_depth(depth_nm), SCRATCH_TABLE_ROWS);
}

fn scratch_table_row_slope(table: texture_2d_array<u32>, layer: u32, u_um: f32, y: f32, rows: i32) -> vec3f {
    let u = min(abs(u_um), 1e18);
    let column = min(i32(u / (u + SCRATCH_TABLE_U_HALF_UM) * f32(SCRATCH_TABLE_COLUMNS - 1) + 0.5), SCRATCH_TABLE_COLUMNS - 1);
    let row = min(i32(y), rows - 2);
    let near = scratch_table_near(vec4u(0u, 0u, 0u, textureLoad(table, vec2i(column, row), layer, 0).w), 1.0);
    let far = scratch_table_near(vec4u(0u, 0u, 0u, textureLoad(table, vec2i(column, row + 1), layer, 0).w), 1.0);
    return near + (far - near) * (y - f32(row));
}
