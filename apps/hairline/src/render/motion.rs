//! The way of the camera through a sequence, and of the time.

use anyhow::anyhow;
use glam::DVec3;
use hairline_document::navigate::{self, Turns};
use hairline_document::schema::Bounds;
use hairline_document::{Description, description};

use crate::cli::SequenceFlags;
use crate::scene_file::set_time;
use hairline_render::failure::Failure;

/// Positions of the camera and times of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Number of pictures.
    pub frames: u32,
    /// Turned about the target over the whole sequence.
    turn_deg: f64,
    turns: Turns,
    /// Divisor of the distance to the target, in the first frame and in the last.
    zoom: [f64; 2],
    /// Seconds of the models' animations, in the first frame and in the last; none where all frames have one time.
    times_s: Option<[f64; 2]>,
}

impl Motion {
    /// Motion by the flags; none for a single picture.
    ///
    /// # Errors
    /// [`Failure::Input`] where they contradict one another.
    pub fn of(flags: &SequenceFlags, times_s: Option<[f64; 2]>) -> Result<Option<Self>, Failure> {
        let times_s = times_s.filter(|[from, to]| from != to);
        let refuse = |what: &str| Err(Failure::Input(anyhow!("{what}")));
        let Some(frames) = flags.frames else {
            let lonely = [
                ("--turntable", flags.turntable.is_some()),
                ("--zoom", flags.zoom.is_some()),
                ("--animation", flags.animation.is_some()),
                ("--fps", flags.fps.is_some()),
                ("--stability", flags.stability),
                ("--time A:B", times_s.is_some()),
            ];
            return match lonely.into_iter().find(|(_, given)| *given) {
                Some((flag, _)) => refuse(&format!(
                    "{flag} is for a sequence: say of how many pictures by --frames N"
                )),
                None => Ok(None),
            };
        };
        if flags.turntable.is_none() && flags.zoom.is_none() && times_s.is_none() {
            return refuse(
                "--frames needs what changes: --turntable DEG, --zoom A:B, --time A:B, or several of them",
            );
        }
        if flags.stability && times_s.is_some() {
            return refuse(
                "--stability knows where surfaces were by the cameras alone: not with --time A:B, which moves them",
            );
        }
        if flags.stability && frames < 2 {
            return refuse(
                "--stability compares frames with one another: it needs --frames 2 or more",
            );
        }
        Ok(Some(Self {
            frames,
            turn_deg: flags.turntable.unwrap_or(0.0),
            turns: flags.turns.into(),
            zoom: flags.zoom.unwrap_or([1.0, 1.0]),
            times_s,
        }))
    }

    /// Refuses a motion outside of the ranges of scenes.
    ///
    /// # Errors
    /// [`Failure::Input`].
    pub fn check(&self, camera: &description::Camera) -> Result<(), Failure> {
        let distance_m = DVec3::from(camera.position_m).distance(camera.target_m.into());
        for factor in self.zoom {
            let there_m = distance_m / factor;
            let sizes_m = Bounds::Size.ends();
            if !sizes_m.contains(&there_m) {
                let (least, most) = sizes_m.into_inner();
                return Err(Failure::Input(anyhow!(
                    "--zoom: at {factor} the camera would be {there_m:.3e} m from its target; {least} m to {most} m are possible"
                )));
            }
        }
        Ok(())
    }

    /// Position of the camera in a frame, counted from 0. The step after the last frame would complete the turn; the last
    /// frame is the end of the zoom.
    pub fn position_m(&self, camera: &description::Camera, frame: u32) -> DVec3 {
        let mut camera = camera.clone();
        if self.turn_deg != 0.0 && self.turns != Turns::Lights {
            navigate::turn(&mut camera, self.turned_rad(frame));
        }
        let come = self.come(frame);
        let [from, to] = self.zoom;
        let factor = from * (to / from).powf(come);
        let target = DVec3::from(camera.target_m);
        target + (DVec3::from(camera.position_m) - target) / factor
    }

    /// Whether the camera alone moves.
    pub fn is_of_camera(&self) -> bool {
        self.times_s.is_none() && self.turns == Turns::Camera
    }

    /// Moves what does in a scene of the first frame.
    pub fn move_scene(&self, scene: &mut Description, frame: u32) {
        if let Some(time_s) = self.time_s(frame) {
            set_time(scene, time_s);
        }
        if self.turns != Turns::Camera {
            navigate::turn_table(scene, self.turns, self.turned_rad(frame));
        }
    }

    fn turned_rad(&self, frame: u32) -> f64 {
        (f64::from(frame) / f64::from(self.frames) * self.turn_deg).to_radians()
    }

    /// The time of a frame, seconds; none where it is that of the scene.
    fn time_s(&self, frame: u32) -> Option<f64> {
        let [from_s, to_s] = self.times_s?;
        Some(from_s + self.come(frame) * (to_s - from_s))
    }

    /// Progress from 0 in the first frame to 1 in the last.
    fn come(&self, frame: u32) -> f64 {
        f64::from(frame) / f64::from(self.frames.max(2) - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> description::Camera {
        description::Camera {
            position_m: [0.1, -0.3, 0.2],
            target_m: [0.1, 0.0, 0.0],
            up: [0.0, 0.0, 1.0],
            fov_y_deg: 30.0,
            ..Default::default()
        }
    }

    fn motion(frames: u32, turn_deg: f64, zoom: [f64; 2]) -> Motion {
        Motion {
            frames,
            turn_deg,
            turns: Turns::Camera,
            zoom,
            times_s: None,
        }
    }

    #[test]
    fn times_go_by_equal_steps_from_end_to_end() {
        let mut moving = motion(5, 0.0, [1.0, 1.0]);
        assert_eq!(moving.time_s(3), None);
        moving.times_s = Some([1.0, 3.0]);
        let times: Vec<_> = (0..5).filter_map(|i| moving.time_s(i)).collect();
        assert_eq!(times, [1.0, 1.5, 2.0, 2.5, 3.0]);
    }

    #[test]
    fn a_turntable_of_the_object_takes_the_lights_along() {
        let mut scene = Description {
            camera: camera(),
            ..hairline_fixtures::scenes::lit_plate().description()
        };
        let before = scene.clone();
        let mut moving = motion(4, 360.0, [1.0, 1.0]);
        assert!(moving.is_of_camera());
        moving.move_scene(&mut scene, 1);
        assert_eq!(scene, before);
        moving.turns = Turns::Object;
        assert!(!moving.is_of_camera());
        moving.move_scene(&mut scene, 1);
        assert_ne!(scene.lights, before.lights);
        assert_eq!(scene.objects, before.objects);
        let place = moving.position_m(&camera(), 1);
        assert!((place - DVec3::from(scene.camera.position_m)).length() < 1e-12);
    }

    #[test]
    fn a_turntable_keeps_height_and_distance_and_shows_no_place_twice() {
        let full = motion(4, 360.0, [1.0, 1.0]);
        let places: Vec<DVec3> = (0..4).map(|i| full.position_m(&camera(), i)).collect();
        assert_eq!(places[0], DVec3::from(camera().position_m));
        let quarter = DVec3::new(0.4, 0.0, 0.2);
        assert!((places[1] - quarter).length() < 1e-12, "{}", places[1]);
        assert!((places[2] - DVec3::new(0.1, 0.3, 0.2)).length() < 1e-12);
        assert!(places[3].distance(places[0]) > 0.4);
    }

    #[test]
    fn a_zoom_goes_by_equal_factors_from_end_to_end() {
        let near = motion(4, 0.0, [0.5, 4.0]);
        let target = DVec3::from(camera().target_m);
        let whole_m = DVec3::from(camera().position_m).distance(target);
        for (frame, factor) in [(0, 0.5), (1, 1.0), (2, 2.0), (3, 4.0)] {
            let distance_m = near.position_m(&camera(), frame).distance(target);
            assert!((distance_m * factor / whole_m - 1.0).abs() < 1e-12);
        }
        let single = motion(1, 0.0, [0.5, 4.0]).position_m(&camera(), 0);
        assert!((single.distance(target) * 0.5 / whole_m - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_zoom_into_the_target_or_out_of_the_world_is_refused() {
        assert!(motion(2, 0.0, [1.0, 1e3]).check(&camera()).is_ok());
        for zoom in [[1.0, 1e6], [1e-6, 1.0]] {
            let error = motion(2, 0.0, zoom).check(&camera()).unwrap_err();
            assert!(error.to_string().contains("from its target"), "{error}");
        }
    }
}
