//! What a scene without scratches pays for them. Pipelines are compiled for what a scene has, so that without any there is no code for
//! them; with a single one there is, and that it takes nothing from the picture leaves its code's cost alone.

use hairline_gpu::Error;
use hairline_optics::method::Method;
use hairline_scene::Scene;
use std::sync::Arc;

use super::Thoroughness;
use super::by_lookup::ByLookup;
use super::figures::{Off, Outcome, Spread};
use super::stage::Stage;
use super::timing::{Turn, in_turns};
use super::worker::{Ready, Worker};
use crate::failure::Failure;
use crate::progress::Progress;

/// Of the one scratch: it lies in one leaf, under few pixels.
const LENGTH_M: f64 = 1e-4;

/// The disk at 1x under a sphere: without scratches, without them once more for what two times of the same are apart, and with one.
pub fn measure(
    worker: &mut Worker,
    base: Stage,
    ours: &Method,
    thoroughness: &Thoroughness,
    progress: &Progress,
) -> Result<Off, Failure> {
    progress.restart("without scratches");
    let (none, one) = scenes(base)?;
    let scenes = [&none, &none, &one];
    let prepared = scenes.map(|scene| ByLookup::new(scene, [ours.lookup]));
    let mut ready: Vec<Result<Ready, Error>> = Vec::new();
    for (scene, prepared) in scenes.iter().zip(&prepared) {
        ready.push(worker.ready(scene, prepared, ours));
    }
    let turns: Vec<Turn> = scenes
        .into_iter()
        .zip(&prepared)
        .zip(&ready)
        .map(|((scene, prepared), ready)| Turn {
            scene,
            prepared,
            ready,
        })
        .collect();
    let measured = in_turns(worker, &turns, &thoroughness.effort)?;
    progress.set(1.0);
    let over_none = |i: usize| over(&measured[i].ms, &measured[0].ms);
    let outcome = |i: usize| -> Outcome { measured[i].outcome.clone() };
    Ok(Off {
        none: outcome(0),
        again: outcome(1),
        one: outcome(2),
        again_over_none: over_none(1),
        one_over_none: over_none(2),
    })
}

/// Without scratches, and with one of no depth: its two edges and its floor are in one plane, and it changes no light.
fn scenes(base: Stage) -> Result<(Scene, Scene), Failure> {
    let of = |scratches| {
        let stage = Stage {
            scratches,
            length_m: LENGTH_M,
            ..base
        };
        stage.build()
    };
    let (none, mut one) = (of(0)?, of(1)?);
    for object in &mut one.objects {
        for scratch in Arc::make_mut(&mut object.scratches).iter_mut() {
            scratch.depth_nm = 0.0;
        }
    }
    Ok((none, one))
}

/// Turn by turn, so that what slows the machine for a while slows both.
fn over(times: &[f64], others: &[f64]) -> Option<Spread> {
    let ratios: Vec<f64> = times.iter().zip(others).map(|(t, o)| t / o).collect();
    (!ratios.is_empty() && times.len() == others.len()).then(|| Spread::of(&ratios))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hairline_reference::closed_form::{self, RenderOptions};

    fn picture(scene: &Scene) -> hairline_image::Image {
        let options = RenderOptions {
            samples: 1,
            method: Method::default(),
        };
        closed_form::render(scene, &options, &|_| {})
    }

    #[test]
    fn the_one_scratch_is_there_and_cannot_be_seen() {
        let base = Stage {
            // So near that the pixels are as large as the scratch.
            size_px: [640, 360],
            ..Stage::default()
        };
        let (none, mut one) = scenes(base).unwrap_or_else(|error| panic!("{error}"));
        let count = |scene: &Scene| {
            scene
                .objects
                .iter()
                .map(|o| o.segments.len())
                .sum::<usize>()
        };
        assert_eq!(count(&none), 0);
        assert!(count(&one) > 0);
        let expected = picture(&none);
        assert!(picture(&one).beauty() == expected.beauty());
        // With a depth and wide it could.
        for scratch in Arc::make_mut(&mut one.objects[0].scratches).iter_mut() {
            scratch.depth_nm = 220.0;
            scratch.width_um = 15.0;
        }
        assert!(picture(&one).beauty() != expected.beauty());
    }

    #[test]
    fn ratios_are_of_turns() {
        let ratio = over(&[2.0, 20.0, 200.0], &[1.0, 10.0, 100.0]).expect("a ratio");
        assert_eq!((ratio.median, ratio.quartiles), (2.0, [2.0; 2]));
        assert!(over(&[], &[]).is_none() && over(&[1.0], &[]).is_none());
    }
}
