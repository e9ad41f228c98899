//! A picture that was stopped and goes on is the picture that was not stopped, bit for bit.

use super::pictures::{LINEAR, sampled};
use super::scenes::{View, plate, scratch, sphere};
use conformance::furnace;
use hairline_image::{Display, Image, Notes, Output, exr_file};
use hairline_reference::{BATCH_SAMPLES, Integrator, Model, Settings};
use hairline_scene::{Base, Scene};
use std::ops::ControlFlow;

const VIEW: View = View {
    angle_rad: 0.6,
    pixel_um: 20.0,
    size_px: 6,
};
const BATCHES: u32 = 4;

fn scene() -> Scene {
    let mut scene = plate(Base::Mirror, VIEW);
    scene.lights = vec![sphere(VIEW, 0.1, 0.1, 0.1)];
    scene.environment = furnace();
    scratch(&mut scene, VIEW, 2);
    scene
}

const SETTINGS: [Settings; 2] = [
    Settings { seed: 3, ..LINEAR },
    Settings {
        model: Model::Full,
        bounces: 1,
        shadows: true,
        ..LINEAR
    },
];

fn go_on(integrator: &Integrator, image: &mut Image, until: f64) -> ControlFlow<()> {
    integrator.run(image, BATCHES * BATCH_SAMPLES, &|done| {
        if done >= until {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    })
}

#[test]
fn stopped_in_the_middle() {
    let scene = scene();
    for settings in SETTINGS {
        let whole = sampled(&scene, settings, BATCHES);
        let integrator = Integrator::new(&scene, settings);
        let mut image = integrator.start();
        for until in [0.05, 0.3, 0.55] {
            assert!(go_on(&integrator, &mut image, until).is_break());
            let samples = &image.noise.as_ref().unwrap().samples;
            assert!(
                samples.iter().any(|n| *n < BATCHES * BATCH_SAMPLES),
                "stopped too late"
            );
            assert!(image != whole);
        }
        assert!(go_on(&integrator, &mut image, 2.0).is_continue());
        assert!(image == whole, "{settings:?}");
        // Another seed is another picture: the comparison can fail.
        let other = Settings {
            seed: settings.seed + 1,
            ..settings
        };
        assert!(sampled(&scene, other, BATCHES) != whole);
    }
}

#[test]
fn through_a_file() {
    let scene = scene();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("stopped.exr");
    for settings in SETTINGS {
        let mut image = {
            let integrator = Integrator::new(&scene, settings);
            let mut image = integrator.start();
            assert!(go_on(&integrator, &mut image, 0.4).is_break());
            image
        };
        let output = Output::check(&path).unwrap();
        output
            .write_image_with_notes(&image, &Display::default(), &Notes::new())
            .unwrap();
        let read = exr_file::read_image(&path).unwrap();
        assert!(read == image, "a file holds all of a picture");
        image = read;
        let integrator = Integrator::new(&scene, settings);
        assert!(go_on(&integrator, &mut image, 2.0).is_continue());
        assert!(image == sampled(&scene, settings, BATCHES), "{settings:?}");
    }
}

#[test]
fn by_any_number_of_threads() {
    let scene = scene();
    for settings in SETTINGS {
        let by = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| sampled(&scene, settings, 2))
        };
        assert!(by(1) == by(4), "{settings:?}");
    }
}
