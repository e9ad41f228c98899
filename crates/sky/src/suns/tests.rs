use super::*;

const SIZE_PX: [u32; 2] = [1024, 512];
const TEXEL_RAD: f64 = TAU / 1024.0;

fn map_of(size_px: [u32; 2], radiance: impl Fn(DVec3) -> f64) -> Picture {
    let mut map = Picture::new(size_px);
    for i in 0..map.rgb.len() {
        let value = radiance(direction(&map, i)) as f32;
        map.rgb[i] = [value, 0.5 * value, 0.25 * value];
    }
    map
}

/// A sky with a gradient.
fn sky(d: DVec3) -> f64 {
    0.3 + 0.2 * d.y
}

fn with_disc(toward: DVec3, radius_rad: f64, radiance: f64) -> Picture {
    map_of(SIZE_PX, |d| {
        let is_in_it = d.angle_between(toward) < radius_rad;
        sky(d) + if is_in_it { radiance } else { 0.0 }
    })
}

/// Flux of the sun in red.
fn flux(sun: &Sun) -> f64 {
    sun.radiance[0] * TAU * (1.0 - sun.radius_rad.cos())
}

/// A disc is found with its place, size and radiance, also at the poles and across the seam; the rest of the map is what was
/// around it.
#[test]
fn a_disc_is_found_as_it_is() {
    for toward in [
        DVec3::new(0.3, 0.5, -0.8),
        DVec3::Y,
        DVec3::NEG_Y,
        // The map's left and right edges meet here.
        DVec3::new(0.001, 0.2, 1.0),
    ] {
        for (radius_rad, radiance) in [(0.055, 800.0), (0.02, 3e4), (2.0 * TEXEL_RAD, 1e6)] {
            let toward = toward.normalize();
            let whole = with_disc(toward, radius_rad, radiance);
            let mut map = whole.clone();
            let parted = part(&mut map);
            let [sun] = parted.suns[..] else {
                panic!("{:?}", parted.suns)
            };
            // Texels are in the disc or not: half of one at the rim.
            let room = 0.6 * TEXEL_RAD;
            assert!(sun.direction.angle_between(toward) < room);
            assert!((sun.radius_rad - radius_rad).abs() < room, "{sun:?}");
            for (channel, share) in sun.radiance.into_iter().zip([1.0, 0.5, 0.25]) {
                assert!((channel / (share * radiance) - 1.0).abs() < 1e-4, "{sun:?}");
            }
            for i in 0..map.rgb.len() {
                let sky = sky(direction(&map, i));
                assert!((radiance_of(&map, i) - sky).abs() < 0.02);
            }
            parted.put_back(&mut map);
            assert!(map.rgb == whole.rgb);
        }
    }
}

fn radiance_of(map: &Picture, i: usize) -> f64 {
    f64::from(map.rgb[i][0])
}

/// Large or weak lamps stay in the map, and so do those no brighter than the rest.
#[test]
fn lamps_that_are_large_or_weak_are_no_suns() {
    let toward = DVec3::new(0.3, 0.5, -0.8).normalize();
    for (radius_rad, radiance) in [(0.08, 1e4), (0.6, 1e3), (0.02, 10.0), (0.004, 500.0)] {
        let mut map = with_disc(toward, radius_rad, radiance);
        let whole = map.rgb.clone();
        assert_eq!(part(&mut map).suns, [], "{radius_rad} {radiance}");
        assert!(map.rgb == whole);
    }
    let one = Picture {
        size_px: [2, 1],
        rgb: vec![[1e6; 3], [0.0; 3]],
    };
    for mut map in [map_of([64, 32], |_| 0.0), map_of([64, 32], |_| 1.0), one] {
        assert_eq!(part(&mut map).suns, []);
    }
}

/// Two at once, the brighter one first. What a camera smears around one is the sun's too where it is bright, and the map's beyond.
#[test]
fn two_suns_and_the_glare_of_one() {
    let toward = [DVec3::new(0.3, 0.5, -0.8), DVec3::new(-0.6, 0.2, 0.1)].map(DVec3::normalize);
    let mut map = map_of(SIZE_PX, |d| {
        let [a, b] = toward.map(|toward| d.angle_between(toward));
        let glare = if a < 0.08 {
            4e3 * (0.02 / a).min(1.0).powi(2)
        } else {
            0.0
        };
        let first = if a < 0.02 { 1e5 } else { glare };
        sky(d) + first + if b < 0.03 { 2e4 } else { 0.0 }
    });
    let all = Brightness::measure(&map).total;
    let suns = part(&mut map).suns;
    assert_eq!(suns.len(), 2, "{suns:?}");
    for (sun, (toward, radius_rad)) in suns.iter().zip([(toward[0], 0.02), (toward[1], 0.03)]) {
        assert!(sun.direction.angle_between(toward) < TEXEL_RAD, "{sun:?}");
        assert!((sun.radius_rad / radius_rad - 1.0).abs() < 0.1, "{sun:?}");
    }
    // Nothing is lost.
    let left = Brightness::measure(&map).total + 1.75 * suns.iter().map(flux).sum::<f64>();
    assert!((left / all - 1.0).abs() < 1e-6, "{left} {all}");
}

/// A lamp in a reflector, which is too large for a sun: the lamp is one, the reflector stays.
#[test]
fn a_lamp_in_a_reflector() {
    let toward = DVec3::new(-0.74, 0.66, 0.11).normalize();
    let mut map = map_of(SIZE_PX, |d| {
        let angle_rad = d.angle_between(toward);
        let lamp = if angle_rad < 0.045 { 2800.0 } else { 0.0 };
        let reflector = if angle_rad < 0.115 {
            70.0 + 900.0 * angle_rad
        } else {
            0.0
        };
        sky(d) + lamp + reflector
    });
    let whole = map.rgb.clone();
    let suns = part(&mut map).suns;
    assert_eq!(suns.len(), 1, "{suns:?}");
    assert!(suns[0].direction.angle_between(toward) < TEXEL_RAD);
    assert!((suns[0].radius_rad / 0.045 - 1.0).abs() < 0.03, "{suns:?}");
    assert!(
        (suns[0].radiance[0] / 2800.0 - 1.0).abs() < 0.03,
        "{suns:?}"
    );
    let is_left = |i: usize| map.rgb[i] == whole[i];
    let brightest = (0..whole.len())
        .filter(|&i| is_left(i))
        .map(|i| whole[i][0])
        .fold(0.0, f32::max);
    assert!(brightest > 150.0, "the reflector stays: {brightest}");
}

/// A window is no disc, and stays in the map; a square is nearly one.
#[test]
fn windows_are_no_suns() {
    for (sides, count) in [([0.03, 0.03], 1), ([0.06, 0.03], 0), ([0.1, 0.01], 0)] {
        let mut map = map_of(SIZE_PX, |d| {
            let is_window = d.z < 0.0 && d.x.abs() < 0.5 * sides[0] && d.y.abs() < 0.5 * sides[1];
            0.3 + if is_window { 1e4 } else { 0.0 }
        });
        assert_eq!(part(&mut map).suns.len(), count, "{sides:?}");
    }
}

/// Equal suns are ordered by their place, however many threads search.
#[test]
fn equals_are_told_apart_by_their_place() {
    let toward = [DVec3::X, DVec3::NEG_X, DVec3::Y];
    let map = map_of(SIZE_PX, |d| {
        let nearest = toward
            .map(|t| d.angle_between(t))
            .into_iter()
            .fold(9.0, f64::min);
        if nearest < 0.02 { 1e4 } else { 0.5 }
    });
    let suns = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| part(&mut map.clone()).suns)
    };
    assert_eq!(suns(1).len(), 3);
    for threads in [2, 3] {
        assert_eq!(suns(threads), suns(1));
    }
}
