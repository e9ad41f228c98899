// An environment along the band of a scratch, cut into cells. Twin: optics/src/band_environment.rs, which gives the reasons.
// Needs: band.

const ENVIRONMENT_CELLS: u32 = 10u;
const ENVIRONMENT_CELL_SCALE_UM: f32 = 0.3;
const ENVIRONMENT_CELL_ALPHA: f32 = 0.08;

struct EnvironmentCell {
    q_low: f32,
    q_high: f32,
    // Direction for the cell; its z is the cosine for the groove's depth.
    direction: vec3f,
    // Angle along the band, as the length of its chord.
    angle_rad: f32,
}

// The point of the arc at q, across and up.
fn environment_arc_point(line: BandLine, q: f32) -> vec2f {
    return vec2f(q - line.offset, band_cos_at(line, q));
}

fn environment_cell(i: u32, line: BandLine, width_um: f32) -> EnvironmentCell {
    let scale = ENVIRONMENT_CELL_SCALE_UM / max(width_um, 1e-3);
    let end = band_q_end(line);
    let start = band_q_start(line);
    // x at the cell's lower end, its middle and its upper end, then q.
    let low = end / (abs(end) + scale);
    let step = (start / (abs(start) + scale) - low) / f32(ENVIRONMENT_CELLS);
    let x = low + step * (f32(i) + vec3f(0.0, 0.5, 1.0));
    var q = clamp(scale * x / max(1.0 - abs(x), vec3f(1e-6)), vec3f(end), vec3f(start));
    // Rounding must not leave out a part of the arc.
    q.x = select(q.x, end, i == 0u);
    q.z = select(q.z, start, i == ENVIRONMENT_CELLS - 1u);
    let middle = environment_arc_point(line, q.y);
    let chord = distance(environment_arc_point(line, q.x), environment_arc_point(line, q.z));
    return EnvironmentCell(q.x, q.z, vec3f(line.along, middle), chord);
}

// Cells of the band of a grating, whose orders spread the colours over all of it: even in the angle.
const ROW_CELLS: u32 = 48u;

fn row_cell(i: u32, line: BandLine) -> EnvironmentCell {
    // Half a cell.
    let step = 0.5 * 3.14159265 / f32(ROW_CELLS);
    let angles = step * (2.0 * f32(i) + vec3f(0.0, 1.0, 2.0));
    let across = -line.radius * cos(angles);
    // The ends of the arc are the roots of lights that cover it.
    let low = select(across.x, -line.radius, i == 0u);
    let high = select(across.z, line.radius, i == ROW_CELLS - 1u);
    return EnvironmentCell(
        line.offset + low,
        line.offset + high,
        vec3f(line.along, across.y, line.radius * sin(angles.y)),
        2.0 * line.radius * sin(step),
    );
}

// The perceptual roughness of the mirror lobe that stands for the cell.
fn environment_cell_roughness(cell: EnvironmentCell) -> f32 {
    return sqrt(ENVIRONMENT_CELL_ALPHA * cell.angle_rad);
}
