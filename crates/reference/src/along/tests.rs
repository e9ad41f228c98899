use crate::closed_form::{Prepared, RenderOptions, rows_together};
use hairline_image::Image;
use hairline_optics::method::{Gather, LightAt, Method, PixelFilter};
use hairline_scene::Scene;

fn scene(size_px: [u32; 2], objects: &str, scratches: &str, lights: &str) -> Scene {
    let text = format!(
        "[camera]\nposition_m = [0.0, -0.27, 0.22]\ntarget_m = [0.0, 0.0, 0.0]\nup = [0.0, 0.0, 1.0]\nfov_y_deg = 4.0\n\
         [render]\nsize_px = [{}, {}]\n\
         [[material]]\nname = \"m\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n{objects}{scratches}{lights}",
        size_px[0], size_px[1]
    );
    Scene::from_toml(&text, "test", ".").unwrap_or_else(|error| panic!("{error}"))
}

const DISK: &str =
    "[[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = { disk = { radius_m = 0.04 } }\n";
const BALL: &str =
    "[[object]]\nname = \"o\"\nmaterial = \"m\"\nshape = { sphere = { radius_m = 0.03 } }\n";
const LAMP: &str =
    "[[light]]\nkind = \"sphere\"\ncenter_m = [0.0, 0.3, 0.25]\nradius_m = 0.02\nradiance = 40.0\n";
const PANEL: &str = "[[light]]\nkind = \"polygon\"\nvertices_m = [[-0.3, 0.3, 0.1], [0.3, 0.3, 0.1], [0.3, 0.3, 0.13], [-0.3, 0.3, 0.13]]\n\
                     radiance = 20.0\ntwo_sided = true\n";

fn scratches(count: u32, length_m: f64) -> String {
    format!(
        "[[scratches]]\nobject = \"o\"\npattern = \"random\"\ncount = {count}\nseed = 3\nlength_m = {{ mean = {length_m}, spread = 0.4 }}\n\
         width_um = {{ mean = 3.0, spread = 0.2 }}\ndepth_nm = {{ mean = 200.0, spread = 0.2 }}\n\
         curvature_per_m = {{ mean = 0.0, spread = 10.0 }}\n"
    )
}

fn picture(prepared: &Prepared, method: Method) -> Image {
    prepared.render(&RenderOptions { samples: 1, method }, &|_| {})
}

fn along(method: Method) -> Method {
    Method {
        light_at: LightAt::Scratches,
        ..method
    }
}

fn at_pixels(method: Method) -> Method {
    Method {
        light_at: LightAt::Pixels,
        ..method
    }
}

/// Root mean square of the difference over that of the reference, and the difference of the sums over the sum.
fn errors(image: &Image, reference: &Image) -> [f64; 2] {
    let (mut off, mut all, mut sums) = (0.0, 0.0, [0.0; 2]);
    for (a, b) in image
        .scratches
        .iter()
        .flatten()
        .zip(reference.scratches.iter().flatten())
    {
        let (a, b) = (f64::from(*a), f64::from(*b));
        off += (a - b) * (a - b);
        all += b * b;
        sums[0] += a - b;
        sums[1] += b;
    }
    assert!(all > 0.0);
    [(off / all).sqrt(), sums[0] / sums[1]]
}

/// Stations are as dense as their differences ask for: what is left is a fraction of a percent of the scratch layer on flat surfaces.
/// Without stations between the ends of a piece it is several times that.
#[test]
fn light_along_scratches_is_that_at_pixels() {
    let of = |scratches: &str, lights: &str| scene([96, 64], DISK, scratches, lights);
    for (what, scene, method) in [
        ("lamp", of(&scratches(4000, 0.01), LAMP), Method::default()),
        (
            "panel",
            of(&scratches(2000, 0.01), PANEL),
            Method::default(),
        ),
        (
            "short",
            of(&scratches(20_000, 0.0008), LAMP),
            Method::default(),
        ),
        (
            "points",
            of(&scratches(4000, 0.01), LAMP),
            Method {
                footprint: PixelFilter::Off,
                ..Method::default()
            },
        ),
    ] {
        let prepared = Prepared::new(&scene);
        let image = picture(&prepared, along(method));
        let reference = picture(&prepared, at_pixels(method));
        let [rms, total] = errors(&image, &reference);
        // A pixel that is a point blurs nothing, and its place on the scratch is its own.
        let room = if method.footprint == PixelFilter::Off {
            0.025
        } else {
            0.01
        };
        assert!(rms < room, "{what}: {rms}");
        assert!(total.abs() < 0.003, "{what}: {total}");
        // The base pays for the same shares: single precision, and a plane for the surface under a pixel. Where a point is at the edge
        // of a scratch's reach (0.2 % of its middle) it may or may not be seen.
        let room = if method.footprint == PixelFilter::Off {
            2e-2
        } else {
            4e-3
        };
        let pairs = image.density.iter().flatten();
        for (a, b) in pairs.zip(reference.density.iter().flatten()) {
            assert!((a - b).abs() < room * b.abs().max(0.05), "{what}: {a} {b}");
        }
    }
}

/// Where normals turn under the pixels, both ways differ in where they take the normal: at the pixel or at the scratch. Monte Carlo on
/// this ball is 16 % from the one and 13 % from the other.
#[test]
fn on_a_ball_it_is_near() {
    let mut scene = scene([96, 64], BALL, &scratches(8000, 0.006), LAMP);
    // The middle of a picture as large as usual, where a pixel turns the normal by half a degree.
    scene.camera.fov_y_rad *= 0.75;
    let prepared = Prepared::new(&scene);
    let image = picture(&prepared, along(Method::default()));
    let [rms, total] = errors(&image, &picture(&prepared, at_pixels(Method::default())));
    assert!(rms < 0.2, "{rms}");
    assert!(total.abs() < 0.03, "{total}");
}

/// A sheet has scratches on its far side, another object stands before it, and the picture ends within tiles.
#[test]
fn only_what_is_seen_is_added() {
    let text = format!(
        "{DISK}[[object]]\nname = \"rod\"\nmaterial = \"m\"\nshape = {{ plane = {{ size_m = [0.01, 0.03] }} }}\n\
         translation_m = [0.005, 0.0, 0.02]\n"
    );
    let both = scratches(3000, 0.01) + &scratches(1000, 0.004).replace("\"o\"", "\"rod\"");
    let scene = scene([75, 53], &text, &both, LAMP);
    let prepared = Prepared::new(&scene);
    let image = picture(&prepared, along(Method::default()));
    let reference = picture(&prepared, at_pixels(Method::default()));
    let [rms, total] = errors(&image, &reference);
    assert!(rms < 0.015, "{rms}");
    assert!(total.abs() < 0.003, "{total}");
    assert_eq!(image.depth_m, reference.depth_m);
    for (a, b) in image
        .density
        .iter()
        .flatten()
        .zip(reference.density.iter().flatten())
    {
        assert!((a - b).abs() < 5e-3 * b.abs().max(0.05), "{a} {b}");
    }
}

/// What grids have is not drawn, and the rest is.
#[test]
fn it_goes_with_grids() {
    let mut scene = scene([64, 48], DISK, &scratches(60_000, 0.004), LAMP);
    scene.camera.position_m *= 4.0;
    let prepared = Prepared::new(&scene);
    let method = Method {
        gather: Gather::Clusters,
        ..Method::default()
    };
    let image = picture(&prepared, along(method));
    let [rms, total] = errors(&image, &picture(&prepared, at_pixels(method)));
    assert!(rms < 0.005, "{rms}");
    assert!(total.abs() < 0.002, "{total}");
}

/// Parts that begin and end with tiles are the picture's.
#[test]
fn rows_of_tiles_are_the_pictures() {
    let scene = scene([70, 100], DISK, &scratches(1000, 0.01), LAMP);
    let prepared = Prepared::new(&scene);
    let method = along(Method::default());
    let whole = picture(&prepared, method);
    let together = rows_together(method);
    assert!(together > 1);
    for first in (0..100).step_by(together as usize) {
        let rows = first..(first + together).min(100);
        let pixels = 70 * rows.start as usize..70 * rows.end as usize;
        let options = RenderOptions { samples: 1, method };
        let part = prepared.render_rows(&options, rows, &|_| {});
        assert_eq!(part.scratches, whole.scratches[pixels.clone()]);
        assert_eq!(part.base, whole.base[pixels]);
    }
}

/// The comparison sees a light that moved by a thousandth of its distance.
#[test]
fn the_comparison_can_fail() {
    let of = |lamp: &str| scene([96, 64], DISK, &scratches(4000, 0.01), lamp);
    let moved = of(&LAMP.replace("[0.0, 0.3", "[0.0008, 0.3"));
    let still = of(LAMP);
    let image = picture(&Prepared::new(&moved), along(Method::default()));
    let reference = picture(&Prepared::new(&still), at_pixels(Method::default()));
    assert!(errors(&image, &reference)[0] > 0.02);
}
