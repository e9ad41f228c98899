//! Scenes that exceed any fixed length of a list or side of a picture: right by the CPU's picture, or refused
//! in words.

use hairline_fixtures::{BALL, SceneFile};
use std::sync::Arc;

use conformance::two_renderers::{compare_pixels, on_the_cpu};
use conformance::{Sequence, lay, square};
use glam::{DVec3, Vec3};
use hairline_gpu::{Error, RenderOptions, headless};
use hairline_scene::{Base, Light, Scene};

/// Number of samples on edges.
const SAMPLES: u32 = 4;

/// A disk of steel under a sphere, seen from `distance_m`.
fn disk(size_px: [u32; 2], distance_m: f64, count: u32) -> Scene {
    let radius = "disk = { radius_m = 0.05 }";
    SceneFile::seen_from([0.0, -0.5 * distance_m, 0.866 * distance_m])
        .fov_y_deg(20.0)
        .size_px(size_px)
        .metal("steel", "iron")
        .with_lines("roughness = 0.1")
        .object("disk", "steel", radius)
        .random("disk", count)
        .with_lines("length_m = 0.00236\nwidth_um = 3.0\ndepth_nm = 220.0")
        .sphere([0.0, 0.2, 0.34641], 0.04, 40.0)
        .scene()
}

/// Fails where the GPU's picture is neither the CPU's nor refused.
fn check(name: &str, scene: &Scene) {
    let Some(gpu) = headless::test_gpu() else {
        return;
    };
    let options = RenderOptions {
        samples: SAMPLES,
        ..Default::default()
    };
    let method = Default::default();
    match headless::render(gpu, scene, &method, &options, &|_| {}) {
        Ok(image) => {
            let cpu = on_the_cpu(scene, SAMPLES);
            compare_pixels(name, &image, &cpu, None).unwrap_or_else(|error| panic!("{error}"));
        }
        Err(error @ (Error::TooLarge { .. } | Error::OutOfMemory { .. })) => {
            println!("{name}: {error}");
        }
        Err(error) => panic!("{name}: {error}"),
    }
}

/// The picture is one tile, and shows seven tenths of the disk.
#[test]
fn seventy_thousand_segments_in_a_tile() {
    check("70,000 segments", &disk([8, 8], 0.2, 100_000));
}

#[test]
fn pictures_of_any_side() {
    check("1 x 1", &disk([1, 1], 0.2, 2000));
    check("16384 x 8", &disk([16384, 8], 0.2, 2000));
}

#[test]
fn five_hundred_lights() {
    let mut scene = disk([12, 8], 0.2, 2000);
    scene.lights.clear();
    let mut random = Sequence(5);
    for i in 0..500 {
        let place = DVec3::from(random.direction(0.1).map(f64::from));
        let right = place.any_orthonormal_vector();
        let (right, up) = (0.02 * right, 0.02 * place.cross(right));
        let radiance = [random.uniform(1.0, 20.0).into(); 3];
        scene.lights.push(match i % 2 {
            0 => Light::sphere(place, 0.02, radiance),
            _ => Light::polygon(
                vec![
                    place - right - up,
                    place + right - up,
                    place + right + up,
                    place - right + up,
                ],
                radiance,
                true,
            ),
        });
    }
    check("500 lights", &scene);
}

/// The ends of a segment lie beyond the picture, one of them behind the camera.
#[test]
fn a_segment_across_the_picture() {
    let mut scene = square(Base::Mirror, 0.01, 1);
    scene.render.size_px = [64, 40];
    lay(
        &mut scene,
        Vec3::new(-1.8e-3, 0.1e-3, 0.0),
        Vec3::new(1.8e-3, -0.1e-3, 0.0),
        3.0,
        200.0,
        1,
    );
    lay(
        &mut scene,
        Vec3::new(0.0, -1.8e-3, 0.0),
        Vec3::new(0.1e-3, 1.8e-3, 0.0),
        3.0,
        200.0,
        1,
    );
    scene.camera.position_m = DVec3::new(0.0, -0.6e-3, 0.5e-3);
    scene
        .lights
        .push(Light::sphere(DVec3::new(0.0, 0.2, 0.15), 0.15, [10.0; 3]));
    check("across the picture", &scene);
}

#[test]
fn a_camera_inside_the_object() {
    let scene = SceneFile::seen_from([0.0, 0.0, 0.01])
        .looking_at([0.03, 0.01, 0.0])
        .fov_y_deg(60.0)
        .size_px([64, 40])
        .metal("steel", "iron")
        .with_lines("roughness = 0.3")
        .object("ball", "steel", BALL)
        .random("ball", 2000)
        .with_lines("length_m = 0.005\nwidth_um = 3.0\ndepth_nm = 220.0")
        .sphere([-0.02, 0.0, 0.02], 0.005, 40.0)
        .scene();
    check("from inside", &scene);
    // The same with the surface turned to the camera.
    let mut inward = scene;
    let object = &mut inward.objects[0];
    let mesh = Arc::make_mut(&mut object.mesh);
    mesh.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    mesh.normals.iter_mut().for_each(|n| *n = -*n);
    let segments = Arc::make_mut(&mut object.segments);
    segments.iter_mut().for_each(|s| s.normal = -s.normal);
    check("from inside, turned", &inward);
}
