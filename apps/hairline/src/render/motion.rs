//! The motion of a sequence by the flags.

use anyhow::anyhow;
use glam::DVec3;
use hairline_document::description;
use hairline_document::schema::Bounds;
use hairline_render::Motion;
use hairline_render::failure::Failure;

use crate::cli::SequenceFlags;

/// Motion by the flags; none for a single picture.
///
/// # Errors
/// [`Failure::Input`] where they contradict one another.
pub fn from_flags(
    flags: &SequenceFlags,
    times_s: Option<[f64; 2]>,
) -> Result<Option<Motion>, Failure> {
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
        return refuse("--stability compares frames with one another: it needs --frames 2 or more");
    }
    Ok(Some(Motion {
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
pub fn check(motion: &Motion, camera: &description::Camera) -> Result<(), Failure> {
    let distance_m = DVec3::from(camera.position_m).distance(camera.target_m.into());
    for factor in motion.zoom {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_zoom_into_the_target_or_out_of_the_world_is_refused() {
        let camera = description::Camera {
            position_m: [0.1, -0.3, 0.2],
            target_m: [0.1, 0.0, 0.0],
            ..Default::default()
        };
        let zoomed = |zoom| {
            let flags = SequenceFlags {
                frames: Some(2),
                zoom: Some(zoom),
                ..SequenceFlags::default()
            };
            from_flags(&flags, None).unwrap().unwrap()
        };
        assert!(check(&zoomed([1.0, 1e3]), &camera).is_ok());
        for zoom in [[1.0, 1e6], [1e-6, 1.0]] {
            let error = check(&zoomed(zoom), &camera).unwrap_err();
            assert!(error.to_string().contains("from its target"), "{error}");
        }
    }
}
