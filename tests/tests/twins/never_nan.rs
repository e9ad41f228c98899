//! A million random configurations, many of them degenerate on purpose: every result is a number.

use super::twin::Sequence;
use glam::{DVec2, DVec3};
use hairline_gpu::call::{Call, Table, Texels};
use hairline_gpu::{headless, shaders};
use hairline_optics::band::*;
use hairline_optics::footprint::{Footprint, scratch_share};
use hairline_optics::mask::ScratchSums;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};

/// Unit directions, a cap's sine, xi_t, width, depth, offset, ends, blur, footprint, depth coherence.
const INPUTS: usize = 24;

fn rows(count: usize) -> Vec<[f32; INPUTS]> {
    let mut random = Sequence(9);
    let awkward = [0.0, -0.0, 1.0, -1.0, 1e-30, 1e-7, 1e9, -1e9];
    (0..count)
        .map(|_| {
            let wo = random.direction(0.0);
            let mut row: [f32; INPUTS] = std::array::from_fn(|_| {
                if random.next() < 0.15 {
                    awkward[(random.next() * 8.0) as usize]
                } else {
                    random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-6.0, 4.0))
                }
            });
            row[..3].copy_from_slice(&wo);
            // Directions stay directions; lengths and variances are not negative, ends are in order.
            for at in [3, 6, 9] {
                let direction = random.direction(-1.0);
                row[at..at + 3].copy_from_slice(&direction);
            }
            row[12] = row[12].abs().min(1.0);
            row[13] = row[13].clamp(-0.1, 0.1);
            for at in [14, 15, 19, 20, 21] {
                row[at] = row[at].abs();
            }
            row[22] = random.uniform(-1.0, 1.0) * (row[20] * row[21]).sqrt();
            (row[17], row[18]) = (row[17].min(row[18]), row[17].max(row[18]));
            row[23] = random.uniform(0.5, 1.0);
            row
        })
        .collect()
}

#[test]
fn in_the_shader() {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let table = ScratchTable::new(|_| 1.0);
    let tables = [Table {
        size: [COLUMNS as u32, ROWS as u32],
        layers: Some(1),
        texels: Texels::Integers(&table.texels),
    }];
    let call = Call {
        modules: &[&shaders::BAND_ENVIRONMENT, &shaders::FOUR_EDGES, &shaders::MASK, &shaders::SCRATCH_TABLE],
        snippet: "let wo = vec3f(x[0], x[1], x[2]);
            let a = vec3f(x[3], x[4], x[5]);
            let b = vec3f(x[6], x[7], x[8]);
            let cap = Cap(a, x[12], sqrt(1.0 - x[12] * x[12]));
            let line = band_line_at(wo, x[13]);
            let chord = sphere_chord(line, cap);
            let roots = band_edge_crossings(band_edge(a, b), line);
            let extent = band_edge_extent(band_edge(a, b)) + sphere_band_extent(wo, cap);
            let moves = vec2f(band_moves(vec2f(x[16]), a, wo, x[14], b, x[15]).x, band_moves(vec2f(x[17]), b, wo, x[14], a, x[15]).y);
            let moved = moved_band(band_stds(20.0), moves, vec2f(x[14], x[16]), x[17], x[14] * x[14] + x[16] * x[16] + 200.0);
            let lines = band_lines(wo.x + moved.shift, extent.x, extent.y, moved.stds);
            let node = band_line(lines, 0u);
            let band = band_integral(lines, node.xyz, node.xyz);
            let cell = environment_cell(u32(abs(x[9]) * 23.0), line, x[14]);
            let t = scratch_table(table_0, 0u, x[14] * chord.enter, x[15]) + scratch_table(table_0, 0u, x[14] * chord.leave, x[15])
                + scratch_table(table_0, 0u, x[14] * roots.rising, x[15]) + scratch_table(table_0, 0u, x[14] * roots.falling, x[15]);
            let share = scratch_share(x[14], x[16], x[17], x[18], x[19], Footprint(x[20], x[21], x[22]), 20.0);
            var sums: ScratchSums;
            mask_add(&sums, share, scratch_table_total(table_0, 0u, x[15]), t);
            let masked = mask_resolve(sums, x[23]);
            // Repeated directions, opposite ones, and one that a point in a vertex has: none.
            let c = select(a, vec3f(0.0), x[23] < 0.6);
            let edges = FourEdges(a, b, select(c, -b, x[23] > 0.9), c, 4u);
            var four = four_edges_roots(edges, line, b);
            let outline = four_edges_extent(edges, a);
            y[3] = outline.x + outline.y + four.range.x + four.range.y + four.rising.x + four.rising.y + four.rising.z + four.rising.w
                + four.falling.x + four.falling.y + four.falling.z + four.falling.w;
            for (var i = 0u; i < four.count; i += 1u) {
                let ends = next_roots(&four);
                y[3] += ends.x + ends.y;
            }
            y[0] = masked.scratches.x + masked.taken.y;
            y[1] = select(0.0, node.x + node.z + node.w + band.x + band.z, lines.count > 0u) + f32(line_winding(line, a, b));
            let range = chord_range(chord, line);
            y[2] = chord_cos(line, range.x, range.y, x[14]) + chord_cos(line, x[16], x[17], x[14]) + cell.q_low + cell.q_high + cell.direction.y + cell.direction.z + environment_cell_roughness(cell);",
        tables: &tables,
    };
    let rows = rows(1_000_000);
    let results: Vec<[f32; 4]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    for (row, result) in rows.iter().zip(&results) {
        assert!(result.iter().all(|v| v.is_finite()), "{row:?}: {result:?}");
    }
}

#[test]
fn in_the_optics() {
    let table = ScratchTable::new(|_| 1.0);
    for row in rows(1_000_000) {
        let x = row.map(f64::from);
        let v = |at: usize| DVec3::new(x[at], x[at + 1], x[at + 2]);
        let cap = Cap {
            axis: v(3),
            sin_radius: x[12],
            cos_radius: (1.0 - x[12] * x[12]).sqrt(),
        };
        let line = BandLine::new(v(0), x[13]);
        let antiderivative = |q: f64| table.scratch_table(x[14] * q, x[15]);
        let directions = [v(3), v(6), v(9)];
        let (away, facing) = polygon_facing(directions.iter().copied(), true);
        let view = PolygonView {
            directions: &directions,
            away,
            facing,
        };
        let frame = BandFrame { tangent: DVec2::X };
        let footprint = Footprint {
            across_um2: x[20],
            along_um2: x[21],
            cross_um2: x[22],
        };
        let share = scratch_share(x[14], x[16], x[17], x[18], x[19], footprint, 20.0);
        let mut sums = ScratchSums::default();
        sums.add(
            share,
            table.scratch_table_total(x[15]),
            sphere_chord(line, cap).integral(line, antiderivative),
        );
        sums.add(
            share,
            table.scratch_table_total(x[15]),
            view.integral(frame, line, antiderivative),
        );
        let (low, high) = sphere_chord(line, cap).range(line);
        let cos_i = chord_cos(line, low, high, x[14]);
        assert!((0.0..=1.0).contains(&cos_i), "{row:?}: {cos_i}");
        let masked = sums.mask_resolve(x[23]);
        let all = masked
            .scratches
            .iter()
            .chain(&masked.taken)
            .all(|v| v.is_finite());
        assert!(all, "{row:?}: {masked:?}");
    }
}
