//! One scratch: footprint, table, mask.

use super::twin::{Sequence, Tolerance, Twin};
use hairline_gpu::call::{Table, Texels};
use hairline_gpu::shaders;
use hairline_optics::footprint::{Footprint, ScratchShare, SeenPart, scratch_share};
use hairline_optics::mask::ScratchSums;
use hairline_optics::metal::Metal;
use hairline_optics::scratch::{band_std, oblique_depth_nm};
use hairline_optics::section::cover_of_part;
use hairline_optics::table::{COLUMNS, ROWS, ScratchTable};
use std::sync::LazyLock;

static GOLD: LazyLock<ScratchTable> =
    LazyLock::new(|| ScratchTable::new(|nm| Metal::Gold.reflectance(1.0, nm)));

#[test]
fn footprint_shares() {
    let mut random = Sequence(1);
    let mut rows = vec![
        // Zero width; no footprint at all; a segment of no length; far away; astronomically far away.
        [0.0, 3.0, -50.0, 50.0, 16.0, 9.0, 9.0, 0.0],
        [2.0, 3.0, -50.0, 50.0, 16.0, 0.0, 0.0, 0.0],
        [2.0, 3.0, 10.0, 10.0, 16.0, 9.0, 9.0, 0.0],
        [2.0, 900.0, -50.0, 50.0, 16.0, 9.0, 9.0, 0.0],
        [2.0, 1e9, -1e9, 1e9, 16.0, 9.0, 9.0, 0.0],
    ];
    for _ in 0..2000 {
        let spread = 10f32.powf(random.uniform(-1.0, 4.0));
        let (a, b) = (
            spread * spread,
            (spread * random.uniform(0.5, 20.0)).powi(2),
        );
        let c = random.uniform(-0.99, 0.99) * (a * b).sqrt();
        let center = random.uniform(-2.0, 2.0) * b.sqrt();
        let half = 10f32.powf(random.uniform(0.0, 4.0));
        rows.push([
            random.uniform(0.1, 20.0),
            random.uniform(-2.0, 2.0) * a.sqrt(),
            center - half,
            center + half,
            random.uniform(14.0, 16.5),
            a,
            b,
            c,
        ]);
    }
    Twin {
        name: "scratch_share",
        modules: &[&shaders::SCRATCH],
        snippet:
            "let s = scratch_share(x[0], x[1], x[2], x[3], x[4], Footprint(x[5], x[6], x[7]), 20.0);
            y[0] = s.segment; y[1] = s.line;",
        tables: &[],
        expected: &|[w, p, s, e, blur, a, b, c]: [f64; 8]| {
            let footprint = Footprint {
                across_um2: a,
                along_um2: b,
                cross_um2: c,
            };
            let share = scratch_share(w, p, s, e, blur, footprint, 20.0);
            [share.segment, share.line]
        },
        // A share is at most W/(sqrt(pi) sigma) = 0.5 here; 2e-6 of that is below what a display shows. Slanted footprints
        // cancel b - c^2/a in single precision, hence the relative part.
        tolerance: Tolerance {
            absolute: 1e-6,
            relative: 1e-3,
        },
    }
    .check(&rows, 0);
}

/// Parts of scratches under a footprint: those beyond its reach, those shorter than it, those that cover it.
#[test]
fn seen_parts() {
    let mut random = Sequence(3);
    let mut rows = vec![
        [-40.0, 40.0],
        [-0.1, 0.1],
        [3.0, 3.4],
        [-3.4, 40.0],
        [0.0, 0.0],
    ];
    for _ in 0..2000 {
        let low = random.uniform(-3.4, 3.4);
        rows.push([low, low + 10f32.powf(random.uniform(-3.0, 1.0))]);
    }
    // What is not seen has no part.
    rows.retain(|[low, high]| *high >= -3.4 && *low <= 3.4);
    Twin {
        name: "seen_part",
        modules: &[&shaders::SCRATCH],
        snippet: "let within = 0.5 * gaussian_erf_difference(x[0] / 1.41421356, x[1] / 1.41421356);
            let part = seen_part(x[0], x[1], within); y[0] = part.x; y[1] = part.y;",
        tables: &[],
        expected: &|ends: [f64; 2]| {
            let part = SeenPart::new(ends);
            [part.mean, part.std]
        },
        tolerance: Tolerance {
            absolute: 0.02,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}

/// Classes of the widths of wide grooves travel in the signs of three numbers.
#[test]
fn covers_of_parts() {
    let rows: Vec<[f32; 1]> = (0..6).map(|class| [class as f32]).collect();
    Twin {
        name: "profile_cover",
        modules: &[&shaders::SCRATCH],
        snippet: "let width_class = u32(x[0]);
            let halves = pack2x16float(vec2f(3.0, 150.0)) | ((width_class & 1u) << 15u) | ((width_class & 2u) << 30u);
            let profile = profile_unpacked(halves, (width_class & 4u) << 29u).profile;
            y[0] = profile_cover(profile); y[1] = profile.width_um; y[2] = profile.depth_nm;",
        tables: &[],
        expected: &|[class]: [f64; 1]| [cover_of_part(class as u8), 3.0, 150.0],
        tolerance: Tolerance {
            absolute: 0.0,
            relative: 1e-6,
        },
    }
    .check(&rows, 0);
}

#[test]
fn band_widths() {
    Twin {
        name: "band_std",
        modules: &[&shaders::SCRATCH],
        snippet: "y[0] = band_std(x[0], x[1]);",
        tables: &[],
        expected: &|[sigma, nm]: [f64; 2]| [band_std(sigma, nm)],
        tolerance: Tolerance {
            absolute: 0.0,
            relative: 1e-6,
        },
    }
    .check(&[[20.0, 555.0], [5.0, 400.0], [100.0, 780.0]], 0);
}

#[test]
fn oblique_depths() {
    Twin {
        name: "oblique_depth_nm",
        modules: &[&shaders::SCRATCH],
        snippet: "y[0] = oblique_depth_nm(x[0], x[1], x[2]);",
        tables: &[],
        expected: &|[d, cos_i, cos_o]: [f64; 3]| [oblique_depth_nm(d, cos_i, cos_o)],
        tolerance: Tolerance {
            absolute: 0.0,
            relative: 1e-6,
        },
    }
    .check(
        &[[200.0, 1.0, 1.0], [150.0, 0.3, 0.8], [900.0, 0.0, 0.01]],
        0,
    );
}

#[test]
fn table_look_ups() {
    let tables = [Table {
        size: [COLUMNS as u32, ROWS as u32],
        layers: Some(1),
        texels: Texels::Integers(&GOLD.texels),
    }];
    let mut random = Sequence(2);
    let mut rows = vec![
        [0.0, 100.0],
        [-0.0, 0.0],
        [1e30, 100.0],
        [-1e30, 5000.0],
        [3e-12, 2000.0],
        [2.0, -1.0],
    ];
    for _ in 0..4000 {
        rows.push([
            random.uniform(-1.0, 1.0) * 10f32.powf(random.uniform(-3.0, 2.0)),
            random.uniform(0.0, 2000.0),
        ]);
    }
    Twin {
        name: "scratch_table",
        modules: &[&shaders::SCRATCH_TABLE],
        snippet: "let t = scratch_table(table_0, 0u, x[0], x[1]); y[0] = t.x; y[1] = t.y; y[2] = t.z;",
        tables: &tables,
        expected: &|[u, d]: [f64; 2]| GOLD.scratch_table(u, d),
        // T reaches 1. The column's position is rounded at 512, 6e-5 of a column, and rows at 1.2e-4 of one; T changes by
        // at most 0.1 a row.
        tolerance: Tolerance { absolute: 2e-5, relative: 1e-5 },
    }
    .check(&rows, 0);
    Twin {
        name: "scratch_table_total",
        modules: &[&shaders::SCRATCH_TABLE],
        snippet: "let t = scratch_table_total(table_0, 0u, x[1]); y[0] = t.x; y[1] = t.y; y[2] = t.z;",
        tables: &tables,
        expected: &|[_, d]: [f64; 2]| GOLD.scratch_table_total(d),
        tolerance: Tolerance { absolute: 4e-5, relative: 1e-5 },
    }
    .check(&rows, 0);
}

#[test]
fn masks() {
    let mut random = Sequence(3);
    let mut rows = vec![
        [0.0, 4.0, 0.0, 4.0, 1.0],
        [0.5, 4.0, 0.5, 4.0, 1.0],
        [1e4, 2.0, 1e4, 2.0, 0.5],
    ];
    for _ in 0..500 {
        rows.push([
            random.uniform(0.0, 1.0),
            random.uniform(0.0, 4.0),
            random.uniform(0.0, 1.0),
            random.uniform(0.0, 4.0),
            random.uniform(0.5, 1.0),
        ]);
    }
    Twin {
        name: "mask_resolve",
        modules: &[&shaders::MASK],
        snippet: "var sums: ScratchSums;
            mask_add(&sums, ScratchShare(x[0], 0.3, 1.0), vec3f(x[1]), vec3f(7.0 * x[1]));
            mask_add(&sums, ScratchShare(x[2], 0.1, 2.0), vec3f(x[3]), vec3f(3.0 * x[3]));
            let m = mask_resolve(sums, x[4]);
            y[0] = m.scratches.y; y[1] = m.taken.z;",
        tables: &[],
        expected: &|[r0, e0, r1, e1, c]: [f64; 5]| {
            let mut sums = ScratchSums::default();
            sums.add(
                ScratchShare {
                    segment: r0,
                    line: 0.3,
                    cover: 1.0,
                },
                [e0; 3],
                [7.0 * e0; 3],
            );
            sums.add(
                ScratchShare {
                    segment: r1,
                    line: 0.1,
                    cover: 2.0,
                },
                [e1; 3],
                [3.0 * e1; 3],
            );
            let masked = sums.mask_resolve(c);
            [masked.scratches[1], masked.taken[2]]
        },
        tolerance: Tolerance {
            absolute: 1e-6,
            relative: 1e-5,
        },
    }
    .check(&rows, 0);
}
