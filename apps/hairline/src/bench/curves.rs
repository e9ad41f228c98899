//! One quantity at a time: the published method with anti-aliasing and ours.

use hairline_cpu::closed_form::Prepared;
use hairline_gpu::Error;

use super::figures::{Curve, Point};
use super::methods::BenchMethod;
use super::stage::{Lamps, Stage, TALK_SCRATCHES};
use super::thoroughness::Thoroughness;
use super::timing::by_turns;
use super::worker::{Ready, Worker, counted};
use crate::progress::Progress;
use hairline_render::failure::Failure;

/// Function that makes a curve: its name, its methods, and the scene at each place. One of the functions below.
pub type Stages = fn(Stage, bool) -> Plan;

/// Measurements along a curve.
pub struct Plan {
    along: &'static str,
    methods: &'static [BenchMethod],
    stages: Vec<(f64, Stage)>,
}

/// A tenth of the table's: a hundred thousand of them lie as densely as the table's ten thousand, and a million still fit in
/// one array of any adapter.
const SHORT_M: f64 = 0.00236;

const BOTH: &[BenchMethod] = &[BenchMethod::Filtered, BenchMethod::Ours];

/// Curve from a thousand scratches to a million, under a sphere.
pub fn scratches(base: Stage, quick: bool) -> Plan {
    let counts: &[u32] = if quick {
        &[1_000, 10_000, 100_000]
    } else {
        &[1_000, 10_000, 100_000, 1_000_000]
    };
    let stage = |&scratches: &u32| {
        let stage = Stage {
            scratches,
            length_m: SHORT_M,
            ..base
        };
        (f64::from(scratches), stage)
    };
    Plan {
        along: "scratches",
        methods: BOTH,
        stages: counts.iter().map(stage).collect(),
    }
}

/// A million scratches, or as many as the base has if it is not the talk's number, from far away to single ones. By our method alone: the
/// published one takes minutes there.
pub fn zoom(base: Stage, quick: bool) -> Plan {
    let zooms: &[f64] = if quick {
        &[0.1, 1.0, 8.0]
    } else {
        &[0.1, 0.2, 0.35, 0.6, 1.0, 2.0, 4.0, 8.0]
    };
    let scratches = match base.scratches {
        TALK_SCRATCHES if quick => 100_000,
        TALK_SCRATCHES => 1_000_000,
        wanted => wanted,
    };
    let stage = |&zoom: &f64| {
        let stage = Stage {
            zoom,
            scratches,
            length_m: SHORT_M,
            ..base
        };
        (zoom, stage)
    };
    Plan {
        along: "zoom",
        methods: &[BenchMethod::Ours],
        stages: zooms.iter().map(stage).collect(),
    }
}

/// Curve from one light to 64, half of them spheres and half triangles.
pub fn lights(base: Stage, quick: bool) -> Plan {
    let counts: &[u32] = if quick {
        &[2, 16]
    } else {
        &[1, 2, 4, 8, 16, 32, 64]
    };
    let stage = |&count: &u32| {
        let stage = Stage {
            lamps: Lamps::Many(count),
            ..base
        };
        (f64::from(count), stage)
    };
    Plan {
        along: "lights",
        methods: BOTH,
        stages: counts.iter().map(stage).collect(),
    }
}

/// Curve from half the size to twice it, at the same field of view, under a sphere.
pub fn pixels(base: Stage, quick: bool) -> Plan {
    // Halves of the size: 640 x 360 to 2560 x 1440 about the talk's.
    let halves: &[u32] = if quick { &[1, 2] } else { &[1, 2, 3, 4] };
    let stage = |&halves: &u32| {
        let size_px = base.size_px.map(|px| (px * halves / 2).max(1));
        let stage = Stage { size_px, ..base };
        (f64::from(size_px[0]) * f64::from(size_px[1]), stage)
    };
    Plan {
        along: "pixels",
        methods: BOTH,
        stages: halves.iter().map(stage).collect(),
    }
}

/// Measures at each place of a curve.
pub fn measure(
    worker: &mut Worker,
    plan: Plan,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Curve, Failure> {
    let Plan {
        along,
        methods,
        stages,
    } = plan;
    progress.restart(along);
    let count = stages.len();
    let mut points = Vec::new();
    for (i, (x, stage)) in stages.into_iter().enumerate() {
        let scene = stage.build()?;
        let prepared = Prepared::new(&scene);
        let ready: Vec<Result<Ready, Error>> = methods
            .iter()
            .map(|method| worker.ready(&scene, &prepared, &method.method()))
            .collect();
        let outcomes = by_turns(worker, &scene, &prepared, &ready, &thoroughness.effort)?;
        points.extend(methods.iter().zip(outcomes).map(|(method, outcome)| Point {
            x,
            way: *method,
            outcome,
            counts: counted(&scene, &prepared, *method),
        }));
        progress.set((i + 1) as f64 / count as f64);
    }
    Ok(Curve { along, points })
}
