// An environment along the band of a scratch, cut into cells. Twin: optics/src/band_environment.rs.

const ENVIRONMENT_CELLS: u32 = 10u;

struct EnvironmentCell {
    q_low: f32,
    q_high: f32,
    direction: vec3f,
    angle_rad: f32,
}

// The bound between cells i - 1 and i, in u.
fn environment_cell_bound_um(i: u32) -> f32 {
    let outward = abs(i32(i) - 5);
    let bound = select(select(select(select(1.5, 0.7, outward == 3), 0.35, outward == 2), 0.15, outward == 1), 0.0, outward == 0);
    return select(bound, -bound, i < 5u);
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
    let across = 0.5 * (q_low + q_high) - line.offset;
    let up = sqrt(max(line.radius * line.radius - across * across, 0.0));
    let angle_rad = (q_high - q_low) / max(max(up, 0.5 * (q_high - q_low)), 1e-6);
    return EnvironmentCell(q_low, q_high, vec3f(line.along, across, up), angle_rad);
}

// The perceptual roughness of the mirror lobe that is about as wide as the cell.
fn environment_cell_roughness(cell: EnvironmentCell) -> f32 {
    return min(sqrt(0.25 * cell.angle_rad), 1.0);
}
