//! One pair of a scratch and a source that stands for all that a point sees: where a ray met the point, one more ray will tell of its light anyway.
//! The pair is drawn by a cheap bound, and only its light is computed.

use super::lanes::Group;
use super::picks::Picks;
use super::point::{Frame, ScratchPoint};
use super::scratch_light::{ScratchLight, scratch_energy};
use super::segment_view::SegmentView;
use crate::gather::gather;
use crate::prepared::Prepared;
use crate::sampling::luminance;
use glam::DVec3;
use hairline_optics::band::OutlineRoots;
use hairline_optics::mask::ScratchSums;
use std::f64::consts::PI;

/// Adds up the energy that the scratches at a point take of the base, and picks one pair. `picks` were cleared for one round.
pub(crate) fn pick_one_pair(
    prepared: &Prepared,
    at: &ScratchPoint,
    sums: &mut ScratchSums,
    picks: &mut Picks,
) {
    let ScratchPoint {
        point,
        object,
        views,
        ..
    } = *at;
    let frame = Frame::new(point);
    let group = Group::new(std::slice::from_ref(at), std::slice::from_ref(&frame));
    let environment = prepared.scene.environment.as_ref();
    let around = environment.map(|it| luminance(it.irradiance(point.normal)) / PI);
    let (segments, _) = prepared.segments();
    let mut seen = SegmentView::default();
    gather(&prepared.scratches.tree, object, point, |index| {
        let segment = &segments[index];
        if !group.see(segment, object, &mut seen) {
            return;
        }
        let Some(share) = seen.share(0, segment.profile) else {
            return;
        };
        let table = prepared.scratch_table(point.table, segment.profile);
        let energy = DVec3::from(scratch_energy(segment.profile, table, point.wo.z));
        sums.add(share, energy.to_array(), [0.0; 3]);
        let course = seen.course(0, &frame, segment.turn_rad);
        let pick = || seen.pick(0, &frame, segment, course, share.segment);
        picks.add_energy(share.segment * energy, pick);
        let light = ScratchLight::new(point.wo, course, table, segment.profile);
        let sent = share.segment * luminance(energy);
        for view in 0..views.views.len() {
            let bound = light.likely(&frame.stds, seen.place(0, &frame), views, view);
            if bound > 0.0 {
                picks.add_light(view, DVec3::splat(sent * bound), pick);
            }
        }
        if let Some(around) = around {
            picks.add_light(views.views.len(), DVec3::splat(sent * around), pick);
        }
    });
    picks.light_one(|pick| {
        let table = prepared.scratch_table(point.table, pick.profile);
        let light = ScratchLight::new(point.wo, pick.course, table, pick.profile);
        let sent = match environment {
            Some(environment) if pick.source == views.views.len() => {
                light.environment(point, environment)
            }
            _ => {
                let mut roots = [OutlineRoots::default(), OutlineRoots::default()];
                let sent = light.light(&frame.stds, pick.place, views, pick.source, &mut roots);
                sent.unwrap_or(DVec3::ZERO)
            }
        };
        pick.share * sent
    });
}
