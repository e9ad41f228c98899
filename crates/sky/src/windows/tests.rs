use super::*;
use hairline_scene::environment::Outline;
use std::f64::consts::TAU;

const SIZE_PX: [u32; 2] = [512, 256];

/// A dim room, brighter above, and brighter within some outlines: each with soft edges of a texel, as a camera sees them.
fn room(windows: &[(Outline, f64)]) -> Picture {
    let covers: Vec<_> = windows
        .iter()
        .map(|(outline, radiance)| (outline.measure(TAU / f64::from(SIZE_PX[0])), radiance))
        .collect();
    let mut map = Picture::new(SIZE_PX);
    for i in 0..map.rgb.len() {
        let toward = direction(&map, i);
        let lit: f64 = covers.iter().map(|(cover, l)| **l * cover(toward)).sum();
        let room = 0.3 + 0.1 * toward.y;
        map.rgb[i] = [1.0, 0.9, 0.7].map(|c| (c * lit + room) as f32);
    }
    map
}

fn quad(corners: [[f64; 3]; 4]) -> Outline {
    Outline::Quad {
        corners: corners.map(|corner| DVec3::from(corner).normalize()),
    }
}

fn light(map: &Picture) -> DVec3 {
    let [width, height] = map.size_px;
    let sr = |i: usize| row_solid_angle(i as u32 / width, height) / f64::from(width);
    (0..map.rgb.len()).map(|i| radiance(map, i) * sr(i)).sum()
}

/// A window beside the seam, a slanting soft box above and a round lamp: their outlines and their light are found, and nothing of
/// them is left.
#[test]
fn windows_are_found_as_they_are() {
    let window = quad([
        [-0.2, -0.1, 1.0],
        [0.25, -0.1, 1.0],
        [0.25, 0.3, 1.0],
        [-0.2, 0.3, 1.0],
    ]);
    let soft_box = quad([
        [0.55, 1.1, -0.3],
        [0.6, 1.2, 0.25],
        [1.0, 1.1, 0.2],
        [1.0, 1.0, -0.3],
    ]);
    let lamp = Outline::Disc {
        direction: DVec3::new(-0.8, 0.2, -0.5).normalize(),
        radius_rad: 0.12,
    };
    let there = [(window, 9.0), (soft_box, 20.0), (lamp, 30.0)];
    let map = room(&there);
    let (windows, rest) = part(&map).unwrap();
    assert_eq!(windows.len(), 3, "{windows:?}");
    for (outline, radiance) in &there {
        let near = |w: &&Window| w.outline.middle().angle_between(outline.middle()) < 5e-3;
        let found = windows.iter().find(near).unwrap();
        let solid_angle_sr = outline.solid_angle_sr();
        let ratio = found.outline.solid_angle_sr() / solid_angle_sr;
        assert!((ratio - 1.0).abs() < 0.02, "{found:?}: {ratio}");
        assert!(
            (found.radiance[0] / radiance - 1.0).abs() < 0.03,
            "{found:?}"
        );
        assert!((found.radiance[2] / (0.7 * radiance) - 1.0).abs() < 0.03);
        let is_disc = |outline: &Outline| matches!(outline, Outline::Disc { .. });
        assert_eq!(is_disc(&found.outline), is_disc(outline));
    }
    let sent = |w: &Window| DVec3::from(w.radiance) * w.outline.solid_angle_sr();
    let both = light(&rest) + windows.iter().map(sent).sum::<DVec3>();
    let all = light(&map);
    // A finer map between the texels of a coarse one.
    assert!(
        (both / all - 1.0).abs().max_element() < 2e-3,
        "{both} {all}"
    );
    let brightest = rest.rgb.iter().flatten().fold(0.0_f32, |a, &b| a.max(b));
    // The map's edges are soft: half of what a window is brighter by is left on one side of each, and lacks on the other.
    assert!(brightest < 18.0, "{brightest}");
    let room = light(&room(&[]));
    assert!((light(&rest) / room - 1.0).abs().max_element() < 0.05);
}

/// Corners lie on the sphere's inside, as the scene sees it, so the light shines towards the scene.
#[test]
fn a_window_shines_inwards() {
    let window = quad([
        [-0.2, -0.1, 1.0],
        [0.25, -0.1, 1.0],
        [0.25, 0.3, 1.0],
        [-0.2, 0.3, 1.0],
    ]);
    let light = window.light(100.0, [1.0; 3]);
    let hairline_scene::LightShape::Polygon { vertices_m, .. } = &light.shape else {
        panic!("{light:?}")
    };
    let normal = hairline_scene::vector_area_m2(vertices_m).normalize();
    assert!(normal.dot(window.middle()) < -0.999);
    assert!(
        vertices_m
            .iter()
            .all(|v| (v.dot(normal) + 100.0).abs() < 1e-6)
    );
}

/// A sky without an edge, a glow, and a patch hardly brighter than the rest have no window.
#[test]
fn a_smooth_sky_has_no_window() {
    assert!(part(&room(&[])).is_none());
    let glow = DVec3::new(0.3, 0.2, -0.9).normalize();
    let mut map = room(&[]);
    for i in 0..map.rgb.len() {
        let away_rad = direction(&map, i).angle_between(glow);
        let bright = 6.0 * (-(away_rad / 0.4).powi(2)).exp();
        map.rgb[i] = map.rgb[i].map(|c| c + bright as f32);
    }
    let found = part(&map);
    assert!(found.is_none(), "{:?}", found.map(|(windows, _)| windows));
    for value in [0.0, 2.0] {
        let map = Picture {
            size_px: [2, 1],
            rgb: vec![[value; 3]; 2],
        };
        assert!(part(&map).is_none());
    }
}
