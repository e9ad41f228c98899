//! One quantity at a time, for both methods with anti-aliasing, and for scratches without it as well.

use hairline_gpu::Error;
use hairline_optics::method::{Gather, LightAt, Method, PixelFilter};

use super::Thoroughness;
use super::by_lookup::ByLookup;
use super::figures::{Curve, Outcome, Point, Way, Whose};
use super::stage::{Lamps, Stage, TALK_SCRATCHES};
use super::timing::by_turns;
use super::worker::{Ready, Worker};
use crate::failure::Failure;
use crate::progress::Progress;

/// One of the functions below.
pub type Measure =
    fn(&mut Worker, Stage, &Method, &Thoroughness, &Progress) -> Result<Curve, Failure>;

/// A tenth of the table's: a hundred thousand of them lie as densely as the table's ten thousand, and a million still fit in
/// one array of any adapter.
const SHORT_M: f64 = 0.00236;

/// From a thousand scratches to a million, under a sphere.
pub fn scratches(
    worker: &mut Worker,
    base: Stage,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Curve, Failure> {
    let counts: &[u32] = if thoroughness.quick {
        &[1_000, 10_000, 100_000]
    } else {
        &[1_000, 10_000, 100_000, 1_000_000]
    };
    let stages = counts.iter().map(|&scratches| {
        let stage = Stage {
            scratches,
            length_m: SHORT_M,
            ..base
        };
        (f64::from(scratches), stage)
    });
    let mut ways = ways(ours).to_vec();
    ways.insert(2, grids(ours));
    curve(
        "scratches",
        stages.collect(),
        &ways,
        worker,
        thoroughness,
        progress,
    )
}

/// A million scratches, or as many as the base has if it is not the talk's number, from far away to single ones.
pub fn zoom(
    worker: &mut Worker,
    base: Stage,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Curve, Failure> {
    let zooms: &[f64] = if thoroughness.quick {
        &[0.1, 1.0, 8.0]
    } else {
        &[0.1, 0.2, 0.35, 0.6, 1.0, 2.0, 4.0, 8.0]
    };
    let scratches = match base.scratches {
        TALK_SCRATCHES if thoroughness.quick => 100_000,
        TALK_SCRATCHES => 1_000_000,
        wanted => wanted,
    };
    let worn = Stage {
        scratches,
        length_m: SHORT_M,
        ..base
    };
    let one_by_one = Way {
        whose: Whose::Ours,
        method: Method {
            gather: Gather::Exact,
            ..*ours
        },
    };
    let ways = [at_pixels(ours), one_by_one, grids(ours)];
    progress.restart("zoom");
    // The disk is laid and sorted once; before it the camera moves.
    let scene = worn.build()?;
    let prepared = ByLookup::new(&scene, ways.iter().map(|way| way.method.lookup));
    let ready = ways.map(|way| worker.ready(&scene, &prepared, &way.method));
    let mut points = Vec::new();
    for (i, &zoom) in zooms.iter().enumerate() {
        let scene = Stage { zoom, ..worn }.of(&scene)?;
        let prepared = prepared.with_scene(&scene);
        let outcomes = by_turns(worker, &scene, &prepared, &ready, &thoroughness.effort)?;
        points.extend(points_at(zoom, &ways, outcomes));
        progress.set((i + 1) as f64 / zooms.len() as f64);
    }
    Ok(Curve {
        along: "zoom",
        points,
    })
}

/// From one light to 64, half of them spheres and half triangles.
pub fn lights(
    worker: &mut Worker,
    base: Stage,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Curve, Failure> {
    let counts: &[u32] = if thoroughness.quick {
        &[2, 16]
    } else {
        &[1, 2, 4, 8, 16, 32, 64]
    };
    let stages = counts.iter().map(|&count| {
        let stage = Stage {
            lamps: Lamps::Many(count),
            ..base
        };
        (f64::from(count), stage)
    });
    curve(
        "lights",
        stages.collect(),
        &ways(ours)[..2],
        worker,
        thoroughness,
        progress,
    )
}

/// From half the size to twice it, at the same field of view, under a sphere.
pub fn resolution(
    worker: &mut Worker,
    base: Stage,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Curve, Failure> {
    // Halves of the size: 640 x 360 to 2560 x 1440 about the talk's.
    let halves: &[u32] = if thoroughness.quick {
        &[1, 2]
    } else {
        &[1, 2, 3, 4]
    };
    let stages = halves.iter().map(|halves| {
        let size_px = base.size_px.map(|px| (px * halves / 2).max(1));
        let stage = Stage { size_px, ..base };
        (f64::from(size_px[0]) * f64::from(size_px[1]), stage)
    });
    curve(
        "resolution",
        stages.collect(),
        &ways(ours)[..2],
        worker,
        thoroughness,
        progress,
    )
}

/// Each scratch's light worked out at each pixel.
fn at_pixels(ours: &Method) -> Way {
    Way {
        whose: Whose::AtPixels,
        method: Method {
            gather: Gather::Exact,
            light_at: LightAt::Pixels,
            ..*ours
        },
    }
}

/// Grids for what many scratches add up to.
fn grids(ours: &Method) -> Way {
    Way {
        whose: Whose::Grids,
        method: Method {
            gather: Gather::Clusters,
            ..*ours
        },
    }
}

/// With anti-aliasing, then without it.
fn ways(ours: &Method) -> [Way; 4] {
    let of = |whose, method: Method| Way { whose, method };
    let point = |method: Method| Method {
        footprint: PixelFilter::Off,
        ..method
    };
    [
        of(Whose::Published, Method::PUBLISHED),
        of(Whose::Ours, *ours),
        of(Whose::Published, point(Method::PUBLISHED)),
        of(Whose::Ours, point(*ours)),
    ]
}

/// What came of each way at one place of a curve.
fn points_at(x: f64, ways: &[Way], outcomes: Vec<Outcome>) -> impl Iterator<Item = Point> {
    ways.iter().zip(outcomes).map(move |(way, outcome)| Point {
        x,
        method: way.whose,
        antialiasing: way.antialiasing(),
        outcome,
    })
}

fn curve(
    along: &'static str,
    stages: Vec<(f64, Stage)>,
    ways: &[Way],
    worker: &mut Worker,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Curve, Failure> {
    progress.restart(along);
    let mut points = Vec::new();
    let count = stages.len();
    for (i, (x, stage)) in stages.into_iter().enumerate() {
        let scene = stage.build()?;
        let prepared = ByLookup::new(&scene, ways.iter().map(|way| way.method.lookup));
        let ready: Vec<Result<Ready, Error>> = ways
            .iter()
            .map(|way| worker.ready(&scene, &prepared, &way.method))
            .collect();
        let outcomes = by_turns(worker, &scene, &prepared, &ready, &thoroughness.effort)?;
        points.extend(points_at(x, ways, outcomes));
        progress.set((i + 1) as f64 / count as f64);
    }
    Ok(Curve { along, points })
}
