//! Scratches lie on their surface, follow their pattern, and are the same everywhere.

use crate::common::{self, object, scene_with};
use glam::DVec3;
use hairline_scene::{Object, Scratch, Segment};

const PATTERNS: [&str; 9] = [
    "pattern = \"random\"",
    "pattern = \"random\"\ncurvature_per_m = { mean = 0.0, spread = 40.0 }",
    "pattern = \"parallel\"\ndirection = [1.0, 0.5, 0.2]\njitter_deg = 3.0",
    "pattern = \"circular\"",
    "pattern = \"circular\"\njitter_deg = 5.0\ncenter_m = [0.01, 0.0, 0.0]\naxis = [0.1, 0.0, 1.0]",
    "pattern = \"radial\"",
    "pattern = \"radial\"\njitter_deg = 5.0",
    "pattern = \"spun\"\ncurvature_per_m = { mean = 15.0, spread = 2.0 }",
    "pattern = \"swirl\"",
];
const DISK: &str = "{ disk = { radius_m = 0.08 } }";
const SPHERE: &str = "{ sphere = { radius_m = 0.05 } }";
/// An open cup with a sharp rim and corners.
const CUP: &str = "{ lathe = { profile_m = [[0.0, 0.01], [0.05, 0.01], [0.06, 0.05], [0.065, 0.05], [0.055, 0.0]] } }";

/// A ring of round section: no boundary, no crease, and an axis that does not meet it.
fn ring() -> String {
    let points: Vec<_> = (0..=24)
        .map(|i| {
            // Clockwise, so that the outside is on the left; the last point is the first.
            let (sin, cos) = (-f64::from(i % 24) * std::f64::consts::TAU / 24.0).sin_cos();
            format!("[{}, {}]", 0.05 + 0.015 * cos, 0.015 * sin)
        })
        .collect();
    format!("{{ lathe = {{ profile_m = [{}] }} }}", points.join(", "))
}

/// The only object of a scene with a shape and layers of scratches.
fn laid(shape: &str, more: &str, layers: &[String]) -> Object {
    let layers: String = layers
        .iter()
        .map(|layer| format!("[[scratches]]\nobject = \"it\"\n{layer}\n"))
        .collect();
    let text = scene_with(&format!("{}{more}\n{layers}", object(shape)));
    let mut scene =
        hairline_document::from_toml(&text, "test.toml", ".").unwrap_or_else(|e| panic!("{e}"));
    scene.objects.remove(0)
}

fn layer(pattern: &str, count: u32, length_m: f64) -> String {
    format!("{pattern}\ncount = {count}\nlength_m = {length_m}\n")
}

fn segments<'o>(object: &'o Object, scratch: &Scratch) -> &'o [Segment] {
    &object.segments[scratch.segments.start as usize..scratch.segments.end as usize]
}

fn length_m(segment: &Segment) -> f64 {
    segment
        .start_m
        .as_dvec3()
        .distance(segment.end_m.as_dvec3())
}

fn corners(object: &Object, triangle: u32) -> [DVec3; 3] {
    let mesh = &object.mesh;
    mesh.triangles[triangle as usize].map(|v| mesh.positions_m[v as usize].as_dvec3())
}

/// Distance of a point from a triangle, in its plane or off it.
fn off_triangle_m([a, b, c]: [DVec3; 3], point: DVec3) -> f64 {
    let normal = (b - a).cross(c - a).normalize();
    let off_edge =
        |from: DVec3, to: DVec3| (point - from).dot((to - from).normalize().cross(normal));
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .map(|(from, to)| off_edge(from, to))
        .fold((point - a).dot(normal).abs(), f64::max)
}

/// Checks the properties of every scratch on every surface.
fn check_invariants(object: &Object, what: &str) {
    let mut next = 0;
    for scratch in object.scratches.iter() {
        assert_eq!(
            scratch.segments.start, next,
            "{what}: ranges follow each other"
        );
        assert!(
            !scratch.segments.is_empty(),
            "{what}: no scratch without a segment"
        );
        next = scratch.segments.end;
        assert!((0.05..=100.0).contains(&scratch.profile.width_um), "{what}");
        assert!((0.0..=2000.0).contains(&scratch.profile.depth_nm), "{what}");
        let segments = segments(object, scratch);
        for segment in segments {
            // Pieces below half a micrometre are left to their neighbours; all coordinates are below 0.16.
            let corners = corners(object, segment.triangle);
            for end in [segment.start_m, segment.end_m] {
                let off_m = off_triangle_m(corners, end.as_dvec3());
                assert!(off_m < 0.6e-6, "{what}: {off_m} m off its triangle");
            }
            assert!(length_m(segment) > 0.4e-6, "{what}: {}", length_m(segment));
            assert!((segment.normal.length() - 1.0).abs() < 1e-5, "{what}");
        }
        for pair in segments.windows(2) {
            assert_eq!(pair[0].end_m, pair[1].start_m, "{what}: joined");
        }
        if scratch.closed {
            assert!(segments.len() >= 3, "{what}");
            assert_eq!(
                segments[segments.len() - 1].end_m,
                segments[0].start_m,
                "{what}"
            );
        }
    }
    assert_eq!(
        next as usize,
        object.segments.len(),
        "{what}: every segment has its scratch"
    );
}

#[test]
fn scratches_lie_on_their_triangles_and_hang_together() {
    let mirrored = "scale = [-1.0, 1.5, 1.0]\nrotation_deg = [30.0, 40.0, 50.0]";
    for shape in [
        DISK,
        SPHERE,
        &ring(),
        CUP,
        "{ plane = { size_m = [0.1, 0.2] } }",
    ] {
        for more in ["", mirrored] {
            for pattern in PATTERNS {
                let what = format!("{shape} {more} {pattern}");
                let object = laid(shape, more, &[layer(pattern, 200, 0.05)]);
                assert!(
                    object.scratches.len() > 150,
                    "{what}: {}",
                    object.scratches.len()
                );
                check_invariants(&object, &what);
            }
        }
    }
}

#[test]
fn a_scratch_is_as_long_as_asked_where_nothing_ends_it() {
    for pattern in [0, 1, 3, 8] {
        // Short enough that no ring closes.
        let object = laid(&ring(), "", &[layer(PATTERNS[pattern], 300, 0.03)]);
        assert_eq!(object.scratches.len(), 300);
        for scratch in object.scratches.iter() {
            let total: f64 = segments(&object, scratch).iter().map(length_m).sum();
            // A chord of half a degree lacks 3e-6 of its arc, one of five degrees 3e-4; ends may lose half a micrometre.
            assert!(
                (total / 0.03 - 1.0).abs() < 4e-4,
                "{}: {total}",
                PATTERNS[pattern]
            );
        }
    }
}

#[test]
fn lengths_are_log_normal() {
    let layer =
        "pattern = \"random\"\ncount = 4000\nlength_m = { mean = 0.01, spread = 0.5 }".to_owned();
    let object = laid(&ring(), "", &[layer]);
    let lengths: Vec<f64> = object
        .scratches
        .iter()
        .map(|scratch| segments(&object, scratch).iter().map(length_m).sum())
        .collect();
    let n = lengths.len() as f64;
    let mean = lengths.iter().sum::<f64>() / n;
    // The standard error of the mean is 0.01 x 0.533 / sqrt(4000) = 8.4e-5.
    assert!((mean - 0.01).abs() < 3.4e-4, "{mean}");
    let log_mean = lengths.iter().map(|l| l.ln()).sum::<f64>() / n;
    let spread = lengths
        .iter()
        .map(|l| (l.ln() - log_mean).powi(2))
        .sum::<f64>()
        / n;
    assert!((spread.sqrt() - 0.5).abs() < 0.025, "{}", spread.sqrt());
}

#[test]
fn circular_scratches_stay_on_their_circles_and_close() {
    for shape in [DISK, CUP, &ring(), SPHERE] {
        // Ten times around at least, if they did not close.
        let object = laid(shape, "", &[layer("pattern = \"circular\"", 200, 5.0)]);
        check_invariants(&object, shape);
        let mut closed = 0;
        for scratch in object.scratches.iter() {
            let place = |p: glam::Vec3| (p.truncate().as_dvec2().length(), f64::from(p.z));
            let segments = segments(&object, scratch);
            let (mut r, mut z) = (Vec::new(), Vec::new());
            for segment in segments {
                let (radius, height) = place(segment.start_m);
                r.push(radius);
                z.push(height);
            }
            let range = |values: &[f64]| {
                let least = values.iter().copied().fold(f64::INFINITY, f64::min);
                values.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least
            };
            let radius = r[0];
            // Only circles of the disk that its 256 edges cut are open.
            if shape == DISK && !scratch.closed {
                assert!(radius > 0.0799, "{radius}");
                continue;
            }
            assert!(scratch.closed, "{shape}: a ring of {radius} m is open");
            closed += 1;
            // The facets of a 256-gon lie up to 1 - cos(pi / 256) = 7.5e-5 of the radius within its circle; drift would be
            // seen beyond that. On cones the circle in a facet also bows by as much.
            assert!(range(&r) < 8e-5 * radius, "{shape}: {}", range(&r));
            assert!(range(&z) < 8e-5 * radius, "{shape}: {}", range(&z));
            let total: f64 = segments.iter().map(length_m).sum();
            let circumference = std::f64::consts::TAU * radius;
            assert!(
                (total / circumference - 1.0).abs() < 4e-4,
                "{shape}: {total}"
            );
        }
        assert!(closed > 190, "{shape}");
    }
}

#[test]
fn parallel_scratches_keep_their_direction() {
    let object = laid(
        "{ plane = { size_m = [0.1, 0.2] } }",
        "rotation_deg = [0.0, 0.0, 90.0]",
        &[
            "pattern = \"parallel\"\ncount = 2000\ndirection = [1, 0, 0]\njitter_deg = 3.0"
                .to_owned(),
        ],
    );
    // The object's x is the world's y.
    let angles: Vec<f64> = object
        .segments
        .iter()
        .map(|s| {
            let chord = (s.end_m - s.start_m).as_dvec3();
            (-chord.x / chord.y).atan().to_degrees()
        })
        .collect();
    let variance = angles.iter().map(|a| a * a).sum::<f64>() / angles.len() as f64;
    // The standard error of a standard deviation over 2000 draws is 1.6 %.
    assert!((variance.sqrt() - 3.0).abs() < 0.2, "{}", variance.sqrt());
}

#[test]
fn radial_scratches_point_at_the_axis_and_end_there() {
    let object = laid(DISK, "", &[layer("pattern = \"radial\"", 500, 0.2)]);
    for scratch in object.scratches.iter() {
        let segments = segments(&object, scratch);
        for s in segments {
            let (start, end) = (s.start_m.as_dvec3(), s.end_m.as_dvec3());
            // Coordinates are rounded to 4e-9 m; the shorter the piece, the less it knows of its direction.
            let miss = start.cross(end).length() / start.distance(end);
            assert!(
                miss < 1e-8 * (1.0 + start.length() / start.distance(end)),
                "{miss}"
            );
            // One side of the axis only.
            assert!(start.dot(end) > -1e-12);
        }
        // Longer than the radius: from the axis to the rim, whose edges are 6e-6 within the circle.
        let total: f64 = segments.iter().map(length_m).sum();
        assert!((total - 0.08).abs() < 7e-6, "{total}");
    }
}

#[test]
fn spun_scratches_are_arcs_through_the_axis() {
    let pattern = "pattern = \"spun\"\ncurvature_per_m = 15.0";
    let object = laid(DISK, "", &[layer(pattern, 300, 0.03)]);
    let radius = 1.0 / 15.0;
    for s in object.segments.iter() {
        let (start, end) = (s.start_m.as_dvec3(), s.end_m.as_dvec3());
        let direction = (end - start).normalize();
        let left = DVec3::Z.cross(direction);
        // Short pieces know their direction to 1e-8 / length only; so do those near the axis, where the field turns fast.
        if start.distance(end) < 1e-5 || start.length() < 1e-3 {
            continue;
        }
        // Forwards and backwards pieces have been put in one order, so the arc bends to the left of all.
        let middle = (start + end) / 2.0 + left * radius;
        assert!(
            (middle.length() - radius).abs() < 2e-3 * radius,
            "{start} {end}"
        );
    }
}

#[test]
fn swirls_bend_around_centres_at_the_distance_asked_for() {
    let pattern = "pattern = \"swirl\"\ncurvature_per_m = { mean = 40.0, spread = 5.0 }";
    let object = laid(
        "{ plane = { size_m = [1.0, 1.0] } }",
        "",
        &[layer(pattern, 500, 0.02)],
    );
    let mut radii = Vec::new();
    for scratch in object.scratches.iter() {
        let segments = segments(&object, scratch);
        let direction = |s: &Segment| (s.end_m - s.start_m).as_dvec3().normalize();
        let (first, last) = (direction(&segments[0]), direction(segments.last().unwrap()));
        let between: f64 =
            segments.iter().map(length_m).sum::<f64>() * (1.0 - 1.0 / segments.len() as f64);
        radii.push(between / first.angle_between(last));
    }
    radii.sort_by(f64::total_cmp);
    let median = radii[radii.len() / 2];
    assert!((0.8..1.25).contains(&(median * 40.0)), "{median}");
}

/// A straight scratch on a sphere is a great circle, facets or not.
#[test]
fn straight_scratches_follow_geodesics() {
    let object = laid(SPHERE, "", &[layer("pattern = \"random\"", 300, 0.1)]);
    for scratch in object.scratches.iter() {
        let segments = segments(&object, scratch);
        // Facets of 1.4 degrees bend the surface at edges only; over 2 rad that adds up to a small part of one.
        let normal = segments[0]
            .start_m
            .as_dvec3()
            .cross(segments[segments.len() / 2].end_m.as_dvec3())
            .normalize();
        for s in segments {
            let off = s.end_m.as_dvec3().dot(normal).abs() / 0.05;
            assert!(off < 5e-3, "{off}");
        }
    }
}

#[test]
fn walks_end_at_sharp_creases() {
    let object = laid(CUP, "", &[layer("pattern = \"random\"", 500, 0.1)]);
    for scratch in object.scratches.iter() {
        let normal = |s: &Segment| {
            let [a, b, c] = corners(&object, s.triangle);
            (b - a).cross(c - a).normalize()
        };
        for pair in segments(&object, scratch).windows(2) {
            assert!(normal(&pair[0]).dot(normal(&pair[1])) >= 0.5);
        }
    }
}

#[test]
fn seeds_are_even_over_the_area() {
    let short = "pattern = \"random\"\ncount = 40000\nlength_m = 1e-4".to_owned();
    let chi2 = |cells: &[u32]| {
        let expected = cells.iter().sum::<u32>() as f64 / cells.len() as f64;
        cells
            .iter()
            .map(|&n| (f64::from(n) - expected).powi(2) / expected)
            .sum::<f64>()
    };
    let middles = |object: &Object| -> Vec<DVec3> {
        object
            .scratches
            .iter()
            .map(|scratch| {
                let segments = segments(object, scratch);
                (segments[0].start_m.as_dvec3() + segments[segments.len() - 1].end_m.as_dvec3())
                    / 2.0
            })
            .collect()
    };
    // 256 cells: chi-square of 255 degrees of freedom exceeds 340 once in 3000 times.
    let plane = laid(
        "{ plane = { size_m = [1.0, 2.0] } }",
        "",
        std::slice::from_ref(&short),
    );
    let mut cells = [0; 256];
    for p in middles(&plane) {
        cells[((p.x + 0.5) * 16.0) as usize * 16 + ((p.y + 1.0) * 8.0) as usize] += 1;
    }
    assert!(chi2(&cells) < 340.0, "{}", chi2(&cells));
    // Archimedes: slices of equal height have equal area, and sectors too.
    let sphere = laid("{ sphere = { radius_m = 1.0 } }", "", &[short]);
    let mut cells = [0; 256];
    for p in middles(&sphere) {
        let slice = (((p.z + 1.0) * 8.0) as usize).min(15);
        let sector = ((p.y.atan2(p.x) / std::f64::consts::TAU + 0.5) * 16.0) as usize;
        cells[slice * 16 + sector.min(15)] += 1;
    }
    assert!(chi2(&cells) < 340.0, "{}", chi2(&cells));
}

#[test]
fn density_times_area_is_the_count() {
    let layer = "pattern = \"random\"\ndensity_per_m2 = 1e5\nlength_m = 1e-3".to_owned();
    let object = laid(
        "{ plane = { size_m = [0.1, 0.2] } }",
        "scale = 2.0",
        &[layer],
    );
    assert_eq!(object.scratches.len(), 8000);
}

fn all_patterns() -> Vec<String> {
    PATTERNS
        .iter()
        .map(|pattern| layer(pattern, 100, 0.02))
        .collect()
}

#[test]
fn a_higher_count_keeps_the_first_scratches() {
    let few = laid(SPHERE, "", &[layer(PATTERNS[0], 300, 0.02)]);
    let many = laid(SPHERE, "", &[layer(PATTERNS[0], 1000, 0.02)]);
    assert_eq!(few.scratches[..], many.scratches[..few.scratches.len()]);
    assert_eq!(few.segments[..], many.segments[..few.segments.len()]);
}

#[test]
fn seeds_and_layers_differ() {
    let layer = |seed: u32| format!("{}\nseed = {seed}", layer(PATTERNS[0], 50, 0.02));
    let object = laid(DISK, "", &[layer(1), layer(2), layer(1)]);
    let first: Vec<_> = object
        .scratches
        .chunk_by(|a, b| a.layer == b.layer)
        .map(|scratches| object.segments[scratches[0].segments.start as usize].start_m)
        .collect();
    assert_eq!(first.len(), 3);
    assert!(first[0] != first[1] && first[1] != first[2] && first[0] != first[2]);
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| laid(CUP, "", &all_patterns()))
    };
    let (one, three) = (with(1), with(3));
    assert_eq!(one.scratches, three.scratches);
    assert_eq!(one.segments, three.segments);
}

/// Pins the result on every platform. If a change of the laying was meant, write the new number down.
#[test]
fn the_same_seed_gives_the_same_scratches_everywhere() {
    // FNV-1a over all numbers.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |bits: u32| {
        for byte in bits.to_le_bytes() {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for shape in [DISK, SPHERE, CUP] {
        let object = laid(shape, "rotation_deg = [10.0, 20.0, 30.0]", &all_patterns());
        for scratch in object.scratches.iter() {
            add(scratch.profile.width_um.to_bits());
            add(scratch.profile.depth_nm.to_bits());
            add(scratch.segments.end);
        }
        for segment in object.segments.iter() {
            let points = [segment.start_m, segment.end_m, segment.normal];
            points
                .iter()
                .flat_map(|p| p.to_array())
                .for_each(|x| add(x.to_bits()));
            add(segment.triangle);
        }
    }
    assert_eq!(hash, 0x9f77_921c_1d35_011c, "{hash:#x}");
}

/// A model of three squares side by side: the first two of one material, the last two below one node.
fn three_squares() -> Vec<u8> {
    let mut glb = common::Glb::default();
    let square = |x: f32| {
        [
            [x, 0.0, 0.0],
            [x + 1.0, 0.0, 0.0],
            [x + 1.0, 1.0, 0.0],
            [x, 1.0, 0.0],
        ]
    };
    let indices = glb.indices(&[0, 1, 2, 0, 2, 3]);
    let meshes: Vec<_> = [(0.0, 0), (1.0, 0), (2.0, 1)]
        .into_iter()
        .map(|(x, material)| {
            let positions = glb.floats(&square(x));
            format!(
                r#"{{"primitives":[{{"attributes":{{"POSITION":{positions}}},"indices":{indices},"material":{material}}}]}}"#
            )
        })
        .collect();
    glb.more = r#","materials":[{"name":"gold"},{"name":"black"}]"#.to_owned();
    let nodes = r#"{"name":"all","mesh":0,"children":[1]},{"name":"strap","children":[2,3]},{"mesh":1},{"name":"clasp","mesh":2}"#;
    glb.bytes(&meshes.join(","), nodes)
}

#[test]
fn scratches_lie_on_a_material_or_below_a_node() {
    let dir = common::temporary_dir();
    std::fs::write(dir.path().join("a.glb"), three_squares()).unwrap();
    let load = |keys: &str| {
        let text = common::scene_with(&format!(
            "[[object]]\nname = \"it\"\nmesh = \"a.glb\"\nup = \"z\"\n[[scratches]]\nobject = \"it\"\npattern = \"random\"\ndensity_per_m2 = 100.0\nlength_m = 0.5\n{keys}"
        ));
        hairline_document::from_toml(&text, "test.toml", dir.path())
    };
    for (keys, from, to) in [
        ("", 0.0, 3.0),
        ("material = \"gold\"", 0.0, 2.0),
        ("material = \"black\"", 2.0, 3.0),
        ("node = \"strap\"", 1.0, 3.0),
        ("node = \"clasp\"", 2.0, 3.0),
        ("node = \"all\"", 0.0, 3.0),
        ("node = \"strap\"\nmaterial = \"gold\"", 1.0, 2.0),
    ] {
        let scene = load(keys).unwrap();
        let object = &scene.objects[0];
        // The number is that of the area but for seeds at its border, all scratches lie within it, each on the triangle
        // that it names.
        let many = (100.0 * (to - from)) as usize;
        assert!(
            (many - 2..=many).contains(&object.scratches.len()),
            "{keys}"
        );
        for segment in object.segments.iter() {
            let corners = object.mesh.triangles[segment.triangle as usize]
                .map(|v| object.mesh.positions_m[v as usize]);
            for point in [segment.start_m, segment.end_m] {
                assert!(
                    (from - 1e-5..=to + 1e-5).contains(&point.x),
                    "{keys}: {point}"
                );
                let xs = corners.map(|corner| corner.x);
                let (least, most) = (xs[0].min(xs[1]).min(xs[2]), xs[0].max(xs[1]).max(xs[2]));
                assert!(
                    (least - 1e-5..=most + 1e-5).contains(&point.x),
                    "{keys}: {point}"
                );
            }
        }
    }
    for (keys, expected) in [
        (
            "material = \"golt\"",
            "scratches[0].material: found no material called \"golt\" in the object; did you mean \"gold\"?",
        ),
        (
            "node = \"xyzzy\"",
            "found no node called \"xyzzy\" in the object; it has \"all\", \"clasp\", \"strap\"",
        ),
        (
            "node = \"clasp\"\nmaterial = \"gold\"",
            "found nothing that is of this material below this node",
        ),
    ] {
        let error = load(keys).unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
    let shape = format!(
        "{}[[scratches]]\nobject = \"it\"\nmaterial = \"steel\"\npattern = \"random\"\ncount = 5\n",
        common::object("{ disk = { radius_m = 1 } }")
    );
    let error =
        hairline_document::from_toml(&common::scene_with(&shape), "test.toml", "").unwrap_err();
    assert_eq!(
        error.right(),
        "the object has no material of a file; leave it out"
    );
}
