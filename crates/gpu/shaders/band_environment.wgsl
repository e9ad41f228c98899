// An environment along the band of a scratch, cut into cells. Twin: optics/src/band_environment.rs, which gives the reasons.

const ENVIRONMENT_CELLS: u32 = 24u;
const ENVIRONMENT_CELL_ALPHA: f32 = 0.1;

struct EnvironmentCell {
    q_low: f32,
    q_high: f32,
    direction: vec3f,
    angle_rad: f32,
}

// The bound between cells i - 1 and i, in u.
fn environment_cell_bound_um(i: u32) -> f32 {
    let outward = f32(i) - f32(ENVIRONMENT_CELLS / 2u);
    let far = abs(outward) / 9.0;
    let far2 = far * far;
    return 0.07 * outward * (1.0 + far2 * far2 * far2 * far);
}

// The point of the arc at q, across and up.
fn environment_arc_point(line: BandLine, q: f32) -> vec2f {
    return vec2f(q - line.offset, band_cos_at(line, q));
}

fn environment_cell(i: u32, line: BandLine, width_um: f32) -> EnvironmentCell {
    let width = max(width_um, 1e-3);
    let end = band_q_end(line);
    let start = band_q_start(line);
    var q_low = end;
    var q_high = start;
    if i > 0u {
        q_low = clamp(environment_cell_bound_um(i) / width, end, start);
    }
    if i < ENVIRONMENT_CELLS - 1u {
        q_high = clamp(environment_cell_bound_um(i + 1u) / width, end, start);
    }
    let low = environment_arc_point(line, q_low);
    let high = environment_arc_point(line, q_high);
    let sum = low + high;
    let length_sum = length(sum);
    let middle = line.radius * select(vec2f(0.0, 1.0), sum / max(length_sum, 1e-30), length_sum > 0.0);
    let half_chord = 0.5 * length(high - low);
    let half_angle = asin(min(half_chord / max(line.radius, 1e-9), 1.0));
    return EnvironmentCell(q_low, q_high, vec3f(line.along, middle), 2.0 * line.radius * half_angle);
}

// The perceptual roughness of the mirror lobe that stands for the cell.
fn environment_cell_roughness(cell: EnvironmentCell) -> f32 {
    return min(sqrt(ENVIRONMENT_CELL_ALPHA * cell.angle_rad), 1.0);
}
