//! Lights as outlines in the picture, and which one a click means.

use egui::{Color32, Painter, Pos2, Vec2};
use glam::DVec3;
use hairline_document::Description;
use hairline_document::description::{Light, LightKind};
use hairline_document::place_light;
use hairline_optics::band::{TUBE_CORNERS, TubeOutline, tube_outline};

use super::cone::LightCone;
use super::handles::distance_to_segment;
use crate::viewport::ink;
use crate::viewport::lens::Lens;

/// A click within this of an outline or a middle means the light, points.
const REACH: f32 = 8.0;
/// A lamp is never seen smaller than this.
const SMALLEST: f32 = 6.0;
/// Distance from the camera's target to the sign of a sun whose direction is across the view, points.
const SUN_REACH: f32 = 120.0;
/// Length of the tick on the side on which a polygon shines.
const TICK: f32 = 18.0;

/// Share of the ink of a light that is neither selected nor under the pointer: its outline may lie across the object.
const FAINT: f32 = 0.3;

/// The outlines of all lights but hidden ones. `chosen` are at hand, selected or under the pointer, and the others faint.
pub(in crate::viewport) fn show(
    painter: &Painter,
    lens: &Lens,
    description: &Description,
    chosen: [Option<usize>; 2],
) {
    for (i, light) in description.lights.iter().enumerate() {
        if light.hidden {
            continue;
        }
        let (width, color) = match chosen.contains(&Some(i)) {
            true => (1.75, Color32::from_rgba_unmultiplied(255, 224, 160, 230)),
            false => {
                let color = Color32::from_rgba_unmultiplied(255, 236, 200, 190);
                (1.0, color.gamma_multiply(FAINT))
            }
        };
        for piece in outline(light, lens, description) {
            ink::segment(painter, piece, width, color);
        }
        let cone = LightCone::from_light(light).map(|spot| spot.outline(lens));
        for piece in cone.into_iter().flatten() {
            ink::segment(painter, piece, 0.7 * width, color.gamma_multiply(0.7));
        }
        if let Some(middle) = middle(light, lens, description) {
            ink::dot(painter, middle, 1.75, color);
            if let Some(tip) = tick(light, lens) {
                ink::segment(painter, [middle, tip], width, color);
            }
        }
    }
}

/// The light whose outline or middle is nearest to a click, within reach.
pub(in crate::viewport) fn light_at(
    description: &Description,
    lens: &Lens,
    pos: Pos2,
) -> Option<usize> {
    let lights = description.lights.iter().enumerate();
    let distances = lights.filter(|(_, light)| !light.hidden).map(|(i, light)| {
        let to_outline = outline(light, lens, description)
            .into_iter()
            .map(|piece| distance_to_segment(piece, pos));
        let to_middle = middle(light, lens, description).map(|middle| middle.distance(pos));
        (to_outline.chain(to_middle).fold(f32::INFINITY, f32::min), i)
    });
    let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest
        .filter(|(distance, _)| *distance <= REACH)
        .map(|(_, i)| i)
}

/// Position of a light's middle on the screen; of a sun the middle of the sign that stands for it. None
/// behind the eye.
pub(in crate::viewport) fn middle(
    light: &Light,
    lens: &Lens,
    description: &Description,
) -> Option<Pos2> {
    match light.kind.sunbeam() {
        Some(sunbeam) => {
            let target_m = DVec3::from(description.camera.target_m);
            let reach_m = lens.m_per_point(target_m) * f64::from(SUN_REACH);
            lens.project(target_m - sunbeam * reach_m)
        }
        None => lens.project(place_light::center(light)),
    }
}

/// A circle with rays, and an arrow from there to the camera's target in the direction of the light.
fn sun_sign(middle: Pos2, target: Pos2) -> Vec<[Pos2; 2]> {
    let around = |i: u8, radius: f32| {
        middle + Vec2::angled(f32::from(i) / 16.0 * std::f32::consts::TAU) * radius
    };
    let circle = (0..16).map(|i| [around(i, SMALLEST), around(i + 1, SMALLEST)]);
    let rays = (0..16).step_by(2);
    let rays = rays.map(|i| [around(i, 1.5 * SMALLEST), around(i, 2.2 * SMALLEST)]);
    let arm = target - middle;
    // Seen from its end an arrow tells nothing.
    let arrow = (arm.length() > 6.0 * SMALLEST).then(|| {
        let along = arm.normalized();
        let tip = target - along * SMALLEST;
        let barb = |side: f32| tip - along * 9.0 + along.rot90() * (5.0 * side);
        [
            [middle + along * (2.8 * SMALLEST), tip],
            [barb(1.0), tip],
            [barb(-1.0), tip],
        ]
    });
    circle
        .chain(rays)
        .chain(arrow.into_iter().flatten())
        .collect()
}

/// Part of the outline before the eye, in pieces.
fn outline(light: &Light, lens: &Lens, description: &Description) -> Vec<[Pos2; 2]> {
    let points_m = match &light.kind {
        LightKind::Sun { .. } => {
            let target = lens.project(description.camera.target_m.into());
            return match (middle(light, lens, description), target) {
                (Some(middle), Some(target)) => sun_sign(middle, target),
                _ => Vec::new(),
            };
        }
        LightKind::Sphere { center_m, radius_m } => {
            let smallest_m = lens.m_per_point(DVec3::from(*center_m)) * f64::from(SMALLEST);
            circle(lens, (*center_m).into(), radius_m.max(smallest_m))
        }
        LightKind::Tube { ends_m, radius_m } => {
            let [a, b] = ends_m.map(|end| DVec3::from(end) - lens.eye_m());
            let outline = tube_outline(a, b, *radius_m);
            let corner = |outline: TubeOutline, i| lens.eye_m() + outline.tube_corner(i);
            (0..TUBE_CORNERS)
                .filter_map(|i| Some(corner(outline?, i)))
                .collect()
        }
        kind => kind.corners_m(),
    };
    let next = points_m.iter().cycle().skip(1);
    let edges = points_m.iter().zip(next);
    edges.filter_map(|(a, b)| lens.segment(*a, *b)).collect()
}

/// Edge of a sphere as the eye sees it; empty from within.
fn circle(lens: &Lens, center_m: DVec3, radius_m: f64) -> Vec<DVec3> {
    let to_eye = lens.eye_m() - center_m;
    let sin = radius_m / to_eye.length();
    if !(sin < 1.0) {
        return Vec::new();
    }
    // The rays that touch a sphere do so before its middle.
    let middle_m = center_m + to_eye * (sin * sin);
    let edge_m = radius_m * (1.0 - sin * sin).sqrt();
    let (across, along) = to_eye.normalize().any_orthonormal_pair();
    let at = |i: u32| {
        let (sin, cos) = (f64::from(i) / 48.0 * std::f64::consts::TAU).sin_cos();
        middle_m + (across * cos + along * sin) * edge_m
    };
    (0..48).map(at).collect()
}

/// The end of a polygon's tick, as long as the polygon faces the side; none for a sphere.
fn tick(light: &Light, lens: &Lens) -> Option<Pos2> {
    let center_m = place_light::center(light);
    let length_m = lens.m_per_point(center_m) * f64::from(TICK);
    lens.project(center_m + light.kind.axis()? * length_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewport::Area;
    use egui::{Context, RawInput, Rect, Shape, pos2};
    use hairline_fixtures::scenes::bare_plate;

    /// The strongest ink of the outlines.
    fn strongest(chosen: [Option<usize>; 2]) -> u8 {
        let lit = bare_plate().sphere([0.06, 0.10, 0.25], 0.02, 40.0);
        let description = lit.description();
        let output = Context::default().run_ui(RawInput::default(), |ui| {
            let rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(400.0, 300.0));
            let area = Area::new(rect, [400, 300], 1.0);
            let lens = Lens::new(&description.camera, &area);
            show(ui.painter(), &lens, &description, chosen);
        });
        let inks = output.shapes.iter().map(|clipped| match &clipped.shape {
            Shape::LineSegment { stroke, .. } => stroke.color.a(),
            Shape::Circle(circle) => circle.fill.a(),
            _ => 0,
        });
        inks.max().unwrap_or(0)
    }

    #[test]
    fn lights_are_faint_until_they_are_at_hand() {
        let [faint, selected, pointed] =
            [[None, None], [Some(0), None], [None, Some(0)]].map(strongest);
        assert!(0 < faint && faint < 90, "{faint}");
        assert!(selected > 200 && pointed > 200, "{selected} {pointed}");
    }
}
