//! What changes through a sequence: the camera, what a turntable turns, and the time.

use glam::DVec3;
use hairline_document::description::Surface;
use hairline_document::navigate::{self, Turns};
use hairline_document::{Description, description};

/// Positions of the camera and times of the frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Number of pictures.
    pub frames: u32,
    /// Angle of the turntable over the whole sequence.
    pub turn_deg: f64,
    /// What the turntable turns.
    pub turns: Turns,
    /// Divisor of the distance to the target, in the first frame and in the last.
    pub zoom: [f64; 2],
    /// Seconds of the models' animations, in the first frame and in the last; none where all frames have one time.
    pub times_s: Option<[f64; 2]>,
}

impl Motion {
    /// The camera of a frame, counted from 0, before the zoom. The step after the last frame would complete the turn.
    pub fn turned(&self, camera: &description::Camera, frame: u32) -> description::Camera {
        let mut camera = camera.clone();
        if self.turn_deg != 0.0 && self.turns != Turns::Lights {
            navigate::turn(&mut camera, self.turned_rad(frame));
        }
        camera
    }

    /// Position of the camera in a frame, counted from 0. The last frame is the end of the zoom.
    pub fn position_m(&self, camera: &description::Camera, frame: u32) -> DVec3 {
        let camera = self.turned(camera, frame);
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

/// Sets the time of the models' animations.
pub fn set_time(description: &mut Description, time_s: f64) {
    for object in &mut description.objects {
        if let Surface::Mesh(_) = object.surface {
            object.time_s = Some(time_s);
        }
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
}
