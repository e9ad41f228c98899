//! The penumbra behind an edge, against integrals over the directions in which a light is seen.

use super::shadowed::closed;
use super::shadowed_on_gpu::on_gpu;
use glam::{DVec2, DVec3};
use hairline_fixtures::SceneFile;
use hairline_image::Image;
use hairline_optics::gaussian::gaussian;
use hairline_scene::Scene;

const MIDDLE_M: DVec3 = DVec3::new(0.0, 0.10, 0.13);
const SIZE_PX: [u32; 2] = [24, 4];

/// A lamp: its keys in a scene file, and whether a line that leaves a point meets it.
struct Lamp {
    keys: &'static str,
    meets: fn(DVec3, DVec3) -> bool,
    /// Place of the edge of the board above the plate.
    edge_m: f64,
    /// The lamp is seen within this slope from its middle.
    reach: f64,
}

const LAMPS: [Lamp; 4] = [
    Lamp {
        keys: "kind = \"rectangle\"\ncenter_m = [0.0, 0.10, 0.13]\ntarget_m = [0.0, 0.0, 0.0]\nwidth_m = 0.03\nheight_m = 0.02",
        meets: |from, along| {
            let facing = MIDDLE_M.normalize();
            let at = on_plane(from, along, facing);
            // The height runs as near to y as the plane lets it.
            at.x.abs() < 0.015 && at.dot(DVec3::X.cross(facing)).abs() < 0.01
        },
        edge_m: 0.03,
        reach: 0.14,
    },
    Lamp {
        keys: "kind = \"disk\"\ncenter_m = [0.0, 0.10, 0.13]\ntarget_m = [0.0, 0.0, 0.0]\nradius_m = 0.015",
        meets: |from, along| on_plane(from, along, MIDDLE_M.normalize()).length() < 0.015,
        edge_m: 0.03,
        reach: 0.14,
    },
    // A board right before a lamp that is as small as a pixel.
    Lamp {
        keys: "kind = \"disk\"\ncenter_m = [0.0, 0.10, 0.13]\ntarget_m = [0.0, 0.0, 0.0]\nradius_m = 0.0005",
        meets: |from, along| on_plane(from, along, MIDDLE_M.normalize()).length() < 0.0005,
        edge_m: 0.117,
        reach: 0.004,
    },
    Lamp {
        keys: "kind = \"tube\"\nends_m = [[-0.015, 0.11, 0.14], [0.015, 0.09, 0.12]]\nradius_m = 0.006",
        meets: |from, along| {
            let [first, last] = [
                DVec3::new(-0.015, 0.11, 0.14),
                DVec3::new(0.015, 0.09, 0.12),
            ];
            let (span, first) = (last - first, first - from);
            // The point of the lamp's line that is nearest to the ray.
            let beside = |v: DVec3| v - along * v.dot(along);
            let share = -beside(first).dot(span) / beside(span).dot(span);
            beside(first + span * share.clamp(0.0, 1.0)).length() < 0.006
        },
        edge_m: 0.03,
        reach: 0.14,
    },
];

/// Vector from the lamp's middle to the point where a line meets its plane.
fn on_plane(from: DVec3, along: DVec3, facing: DVec3) -> DVec3 {
    let offset = MIDDLE_M - from;
    along * (offset.dot(facing) / along.dot(facing)) - offset
}

/// Irradiance at a point under a lamp, by steps of its width: all of it, and the part that passes the edge at x = 0 of a board.
fn irradiance(lamp: &Lamp, from: DVec3, steps: i32) -> [f64; 2] {
    let towards = (MIDDLE_M - from).normalize();
    // Askew, so that no line of the grid runs along an edge.
    let (x, y) = towards.any_orthonormal_pair();
    let (right, up) = (0.8 * x + 0.6 * y, 0.8 * y - 0.6 * x);
    let (mut all, mut seen) = (0.0, 0.0);
    let at = |i: i32| lamp.reach * ((f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0);
    for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
        let offset = towards + at(i) * right + at(j) * up;
        let along = offset.normalize();
        if (lamp.meets)(from, along) {
            // The solid angle of a square of the plane one unit away, and the cosine on the plate.
            let weight = along.z * offset.length().powi(-3);
            all += weight;
            if from.x + along.x / along.z * lamp.edge_m < 0.0 {
                seen += weight;
            }
        }
    }
    [all, seen]
}

fn scene_file(lamp: &Lamp) -> SceneFile {
    SceneFile::seen_from([0.0, -0.1928, 0.2298])
        .fov_y_deg(0.3056)
        .size_px(SIZE_PX)
        .part("[[material]]\nname = \"matt\"\nkind = \"dielectric\"\nior = 1.0")
        .object("plate", "matt", "plane = { size_m = [0.05, 0.05] }")
        .part(&format!("[[light]]\n{}", lamp.keys))
}

/// Pictures without the board and with it, by each renderer that is asked for and there is, with a bound on the error.
fn pictures(open: &Scene, scene: &Scene, on_both: bool) -> Vec<(&'static str, f64, [Image; 2])> {
    let by_cpu = [closed(open, 1, false), closed(scene, 1024, true)];
    let by_gpu = on_both.then(|| Some([on_gpu(open, 1, None)?, on_gpu(scene, 384, Some(0))?]));
    let by_gpu = by_gpu.flatten().map(|images| ("GPU", 1.4e-2, images));
    [("CPU", 5e-3, by_cpu)].into_iter().chain(by_gpu).collect()
}

#[test]
fn penumbras_are_those_of_what_is_seen_of_a_lamp() {
    check(48, false);
}

#[test]
#[ignore = "long: cargo long"]
fn so_they_are_on_the_gpu() {
    check(144, true);
}

/// Checks each lamp, on the GPU too if asked for, against integrals by so many steps of a lamp's width.
fn check(steps: i32, on_gpu: bool) {
    for lamp in LAMPS {
        let file = scene_file(&lamp);
        let open = file.scene();
        let scene = file
            .object("board", "matt", "plane = { size_m = [0.06, 0.21] }")
            .with_lines(&format!("translation_m = [0.03, 0.095, {}]", lamp.edge_m))
            .scene();
        let camera = scene.camera.frame(SIZE_PX);
        let std_px = scene.render.footprint_std_px(1);
        // Even steps of probability of the pixel's filter.
        let places = [-2.5, -1.5, -0.5, 0.5, 1.5, 2.5].map(|i| gaussian().quantile(0.5 + i / 6.0));
        let exact: Vec<f64> = (0..SIZE_PX[0])
            .map(|x| {
                let (mut all, mut seen) = (0.0, 0.0);
                for (y, right, down) in (0..SIZE_PX[1])
                    .flat_map(|y| places.map(|right| (y, right)))
                    .flat_map(|(y, right)| places.map(|down| (y, right, down)))
                {
                    let middle = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                    let ray = camera.camera_ray(middle + std_px * DVec2::new(right, down));
                    let from = camera.position_m - ray * (camera.position_m.z / ray.z);
                    let [a, s] = irradiance(&lamp, from.with_z(0.0), steps);
                    all += a;
                    seen += s;
                }
                seen / all
            })
            .collect();
        let is_penumbra = |share: &&f64| (0.05..0.95).contains(*share);
        let penumbra = exact.iter().filter(is_penumbra).count();
        assert!(penumbra > 8, "{penumbra}: {}", lamp.keys);
        for (by, bound, [open, image]) in pictures(&open, &scene, on_gpu) {
            let column = |image: &Image, x: usize| -> f64 {
                let rows = 0..SIZE_PX[1];
                rows.map(|y| f64::from(image.base[image.index(x as u32, y)][1]))
                    .sum()
            };
            let found = |x| column(&image, x) / column(&open, x);
            let errors = exact.iter().enumerate().map(|(x, exact)| found(x) - exact);
            let count = exact.len() as f64;
            let rms = (errors.clone().map(|e| e * e).sum::<f64>() / count).sqrt();
            let mean = errors.sum::<f64>() / count;
            println!("{by}: rms {rms:.5}, mean {mean:+.5}: {}", lamp.keys);
            assert!(
                rms < bound && mean.abs() < 0.4 * bound,
                "{by}: {rms} {mean}: {}",
                lamp.keys
            );
        }
    }
}
