// A footprint on the grids of many scratches: which grids it reads, and which vertices with what weight. Twin:
// reference/src/bundles.rs, which gives the reasons.

const BUNDLE_LEAST_CELLS: f32 = 0.9;
const BUNDLE_REACH: f32 = 3.0;
const BUNDLE_HAND_OVER: f32 = 0.35;
const BUNDLE_LEAN_MIN: f32 = 0.4;
const BUNDLE_TALLY_OCTAVE: f32 = -3.0;

// Which grids stand for the scratches under a pixel.
struct BundleChoice {
    level: u32,
    share: f32,                 // of this level; the rest is the finer one's, or, at the finest, that of single scratches
    any: bool,                  // else no grid does
    may_tally: bool,            // whether the footprint is large enough for single scratches to be many
}

fn bundle_choice(pixel: GatherPixel, grids: BundleGrids) -> BundleChoice {
    let c = pixel.covariance_um2;
    let least = 0.5 * (c.x + c.z) - length(vec2f(0.5 * (c.x - c.z), c.y));
    let std_um = sqrt(max(least, 0.0) + pixel.window_um2);
    let may_tally = METHOD_GATHER == GATHER_TALLY;
    let cells_um = BUNDLE_LEAST_CELLS * 1e6 * vec2f(grids.cell_m, grids.dense_cell_m);
    let octaves = log2(std_um / cells_um);
    let octave = octaves.x;
    if grids.populations == 0u || !(octave > 0.0) {
        return BundleChoice(0u, 0.0, false, may_tally && grids.populations > 0u && octaves.y > BUNDLE_TALLY_OCTAVE);
    }
    let level = min(u32(min(octave, 31.0)), grids.levels - 1u);
    let over = min((octave - f32(level)) / BUNDLE_HAND_OVER, 1.0);
    let share = over * over * (3.0 - 2.0 * over);
    return BundleChoice(level, share, true, may_tally && level == 0u && share < 1.0);
}

// The weight of single scratches.
fn bundle_single_share(choice: BundleChoice) -> f32 {
    return select(1.0, select(0.0, 1.0 - choice.share, choice.level == 0u), choice.any);
}

// The same for a point of an object, where the method has grids at all.
fn bundle_single_share_at(point: SurfacePoint, object: u32) -> f32 {
    if METHOD_GATHER != GATHER_EXACT {
        return bundle_single_share(bundle_choice(gather_pixel(point), bundle_grids(object)));
    }
    return 1.0;
}

// A footprint on one side's grid of one cell size.
struct BundleFootprint {
    side: u32,
    center: vec2f,              // cells
    height: f32,                // cells
    rise: vec2f,                // of the tangent plane, cells a cell
    form: vec3f,                // of the Gaussian over cells: xx, xy, yy of the matrix in its exponent
    per_blur: vec3f,            // the same over micrometres in the surface's frame
    density: f32,               // its peak, 1/um^2
    first_row: f32,
    rows: u32,
    width: u32,                 // vertices of a row, at most
}

// Rows are none where the side has nothing to say of the point.
fn bundle_footprint(point: SurfacePoint, pixel: GatherPixel, side: u32, level: BundleLevel) -> BundleFootprint {
    var footprint: BundleFootprint;
    footprint.side = side;
    if bundle_lean(side, point.normal) < BUNDLE_LEAN_MIN {
        return footprint;
    }
    let normal = bundle_turned(side, point.normal);
    let x = bundle_turned(side, point.axis_x);
    let y = bundle_turned(side, point.axis_y);
    let cell_um = 1e6 * level.cell_m;
    let rise = -normal.xy / normal.z;
    // One cell along each of the grid's axes, on the tangent plane.
    let step_u = cell_um * vec2f(x.x + rise.x * x.z, y.x + rise.x * y.z);
    let step_v = cell_um * vec2f(x.y + rise.y * x.z, y.y + rise.y * y.z);
    // The tents' own variance is part of what the footprint blurs by.
    let tents = vec3f(
        dot(vec2f(step_u.x, step_v.x), vec2f(step_u.x, step_v.x)),
        dot(vec2f(step_u.x, step_v.x), vec2f(step_u.y, step_v.y)),
        dot(vec2f(step_u.y, step_v.y), vec2f(step_u.y, step_v.y)),
    ) / 6.0;
    let blur = pixel.covariance_um2 + vec3f(pixel.window_um2, 0.0, pixel.window_um2) - tents;
    let determinant = blur.x * blur.z - blur.y * blur.y;
    if !(determinant > 0.0) || !(blur.x > 0.0) {
        return footprint;
    }
    let per_blur = vec3f(blur.z, -blur.y, blur.x) / determinant;
    let form = vec3f(
        bundle_form(per_blur, step_u, step_u),
        bundle_form(per_blur, step_u, step_v),
        bundle_form(per_blur, step_v, step_v),
    );
    let form_determinant = form.x * form.z - form.y * form.y;
    if !(form.x > 0.0) || !(form_determinant > 0.0) {
        return footprint;
    }
    let position = bundle_turned(side, point.position_m) / level.cell_m + bundle_turned(side, level.rest);
    let half_rows = BUNDLE_REACH * sqrt(form.x / form_determinant);
    footprint.center = position.xy;
    footprint.height = position.z;
    footprint.rise = rise;
    footprint.form = form;
    footprint.per_blur = per_blur;
    // What lies beyond the reach is made up for: exp(-reach^2 / 2).
    footprint.density = 1.0 / (6.28318531 * sqrt(determinant) * (1.0 - 0.011108997));
    footprint.first_row = ceil(position.y - half_rows);
    footprint.rows = u32(clamp(floor(position.y + half_rows) - footprint.first_row + 1.0, 0.0, 65535.0));
    footprint.width = u32(min(2.0 * BUNDLE_REACH * inverseSqrt(form.x), 65535.0)) + 1u;
    return footprint;
}

fn bundle_form(per_blur: vec3f, a: vec2f, b: vec2f) -> f32 {
    return per_blur.x * a.x * b.x + per_blur.y * (a.x * b.y + a.y * b.x) + per_blur.z * a.y * b.y;
}

// Heights at which a place of the grid may have a vertex.
struct BundlePlace {
    at: vec2i,
    low: i32,
    count: i32,                 // none where the place is out of reach
}

// Place `i` of the footprint's rows times width.
fn bundle_place(footprint: BundleFootprint, i: u32) -> BundlePlace {
    let row = footprint.first_row + f32(i / footprint.width);
    let dy = row - footprint.center.y;
    let m = footprint.form;
    let determinant = m.x * m.z - m.y * m.y;
    let half_width = sqrt(max(BUNDLE_REACH * BUNDLE_REACH * m.x - determinant * dy * dy, 0.0)) / m.x;
    let middle = footprint.center.x - m.y * dy / m.x;
    let column = ceil(middle - half_width) + f32(i % footprint.width);
    let dx = column - footprint.center.x;
    let height = footprint.height + dot(footprint.rise, vec2f(dx, dy));
    let margin = 0.5 + abs(footprint.rise.x) + abs(footprint.rise.y);
    let low = i32(floor((height - margin) / BUNDLE_HEIGHT_CELLS + 0.5));
    let high = i32(floor((height + margin) / BUNDLE_HEIGHT_CELLS + 0.5));
    return BundlePlace(vec2i(vec2f(column, row)), low, select(0, high - low + 1, column <= floor(middle + half_width)));
}

// The share of the pixel that a vertex's scratches have; 0 for those on another side of the surface.
fn bundle_share(point: SurfacePoint, footprint: BundleFootprint, vertex: u32) -> f32 {
    let place_weight = bitcast<vec4f>(bundle_texel(vertex));
    let normal = bitcast<vec4f>(bundle_texel(vertex + 1u)).xyz;
    // As single scratches are, seen along the normal: a curved surface leaves its tangent plane.
    let away = surface_from_world(point, place_weight.xyz - point.position_m).xy * 1e6;
    let share = place_weight.w * footprint.density * exp(-0.5 * min(bundle_form(footprint.per_blur, away, away), 160.0));
    return select(0.0, share, dot(normal, point.normal) >= FACING_MIN_COS);
}
