//! Scratches from CSV files.

use crate::common::{object, scene_with, temporary_dir};
use hairline_document::Error;
use hairline_scene::Object;

const HEADER: &str = "x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm\n";
const PLANE: &str = "{ plane = { size_m = [0.2, 0.2] } }";
const SPHERE: &str = "{ sphere = { radius_m = 0.05 } }";

fn load(shape: &str, more: &str, csv: &[u8]) -> Result<Object, Error> {
    let dir = temporary_dir();
    std::fs::write(dir.path().join("s.csv"), csv).unwrap();
    let text = scene_with(&format!(
        "{}{more}\n[[scratches]]\nobject = \"it\"\npattern = \"file\"\nfile = \"s.csv\"",
        object(shape)
    ));
    hairline_document::from_toml(&text, "plate.toml", dir.path())
        .map(|mut scene| scene.objects.remove(0))
}

/// As spreadsheets and tables of Python may write them.
#[test]
fn cells_may_stand_in_quotes() {
    let row = "-0.05,-0.05,0,0.05,0.05,0,1.5,200\n";
    let quoted = |line: &str| format!("\"{}\"\n", line.trim().replace(',', "\",\""));
    let csv = format!("{}{}", quoted(HEADER), quoted(row));
    let [quoted, plain] = [csv, format!("{HEADER}{row}")].map(|csv| {
        let object = load(PLANE, "", csv.as_bytes()).unwrap();
        object.segments.to_vec()
    });
    assert!(!plain.is_empty() && quoted == plain);
}

#[test]
fn rows_become_scratches_in_the_objects_own_frame() {
    // Along the diagonal, which is an edge; across it; from corner to corner through everything; and one on top of a corner.
    let csv = format!(
        "{HEADER}-0.05,-0.05,0,0.05,0.05,0,1.5,200\n0.05,-0.05,0,-0.05,0.05,0,2.5,300\n-0.1,-0.1,0,0.1,0.1,0,1,1\n\n -0.1, 0.1, 0, 0.1, 0.1, 0, 100, 2000\r\n"
    );
    let object = load(
        PLANE,
        "scale = 2.0\ntranslation_m = [0, 0, 1]",
        csv.as_bytes(),
    )
    .unwrap();
    let scratches: Vec<_> = object
        .scratches
        .iter()
        .map(|scratch| {
            let segments =
                &object.segments[scratch.segments.start as usize..scratch.segments.end as usize];
            let length: f32 = segments.iter().map(|s| s.start_m.distance(s.end_m)).sum();
            (
                scratch.profile.width_um,
                scratch.profile.depth_nm,
                length,
                segments.to_vec(),
            )
        })
        .collect();
    let diagonal = 0.2 * std::f32::consts::SQRT_2;
    let expected = [
        (1.5, 200.0, diagonal),
        (2.5, 300.0, diagonal),
        (1.0, 1.0, 2.0 * diagonal),
        (100.0, 2000.0, 0.4),
    ];
    for (scratch, (width, depth, length)) in scratches.iter().zip(expected) {
        assert_eq!((scratch.0, scratch.1), (width, depth));
        // Corners are kept off by a millionth of an edge.
        assert!((scratch.2 - length).abs() < 2e-6, "{} {length}", scratch.2);
    }
    assert_eq!(scratches.len(), 4);
    assert!(scratches[1].3.len() == 2, "it crosses the diagonal");
    assert!(
        scratches[1].3[0]
            .start_m
            .abs_diff_eq(glam::vec3(0.1, -0.1, 1.0), 1e-6)
    );
}

#[test]
fn on_a_curved_surface_they_follow_it() {
    let csv = format!("{HEADER}0.05,0,0,0,0.05,0,1,200\n0.03,0.03,0.03,0.05,0,0,1,200\n");
    let object = load(SPHERE, "", csv.as_bytes());
    // The second one's start is 2 mm off the sphere, in a box of 173 mm.
    let error = object.unwrap_err().to_string();
    assert!(
        error.contains("s.csv:3: x0_m: found a point 1.9"),
        "{error}"
    );

    let object = load(
        SPHERE,
        "",
        csv.lines()
            .take(2)
            .collect::<Vec<_>>()
            .join("\n")
            .as_bytes(),
    )
    .unwrap();
    let length: f32 = object
        .segments
        .iter()
        .map(|s| s.start_m.distance(s.end_m))
        .sum();
    let quarter = 0.05 * std::f32::consts::FRAC_PI_2;
    assert!((length / quarter - 1.0).abs() < 1e-3, "{length}");
    assert!(
        object
            .segments
            .last()
            .unwrap()
            .end_m
            .abs_diff_eq(glam::vec3(0.0, 0.05, 0.0), 1e-6)
    );
}

#[test]
fn mistakes_name_their_line_and_column() {
    let cases: [(&[u8], &str); 10] = [
        (
            b"",
            ":1: found an empty file; must be the header `x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm`",
        ),
        (
            b"x0_m,y0_m\n",
            ":1: found `x0_m,y0_m`; must be the header `x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm`",
        ),
        (
            b"H0,0,0,0.1,0,0,1",
            ":2: found 7 cells; must be 8, as in the header",
        ),
        (
            b"H0,0,0,0.1,0,0,1,2\n0,0,0,0.1,0,0,1,2,3",
            ":3: found 9 cells; must be 8, as in the header",
        ),
        (
            b"H0,0,0,0.1,0,zero,1,2",
            ":2: z1_m: found \"zero\"; must be a number",
        ),
        (
            b"H0,0,0,nan,0,0,1,2",
            ":2: x1_m: found \"nan\"; must be a number",
        ),
        (
            b"H0,0,0,0.1,0,0,0,2",
            ":2: width_um: found 0; must be from 0.05 to 100",
        ),
        (
            b"H0,0,0,0.1,0,0,1,-2",
            ":2: depth_nm: found -2; must be from 0 to 2000",
        ),
        (
            b"H0,0,0,0.1,0,0,1,2\n0,0,0.1,0,0,0.1,1,2",
            ":3: found both ends at one point; must be two points",
        ),
        (
            b"\xff\xfe\x00",
            ": found bytes that are no UTF-8; must be a text with the header `x0_m,y0_m,z0_m,x1_m,y1_m,z1_m,width_um,depth_nm`",
        ),
    ];
    for (csv, expected) in cases {
        let csv = match csv.split_first() {
            Some((b'H', rest)) => [HEADER.as_bytes(), rest].concat(),
            _ => csv.to_vec(),
        };
        let message = load(PLANE, "", &csv).unwrap_err().to_string();
        assert!(message.ends_with(&format!("s.csv{expected}")), "{message}");
    }
}

/// What was laid on an object, bent scratches and rings among it, is laid again from its list in the object's own frame.
#[test]
fn a_written_list_reads_back_as_the_same_scratches() {
    const PLACED: &str =
        "scale = 1.5\nrotation_deg = [20, 40, 60]\ntranslation_m = [0.1, 0, 0.3]\n";
    let circular = "[[scratches]]\nobject = \"it\"\npattern = \"circular\"\ncount = 60\n\
        length_m = { mean = 0.1, spread = 0.6 }\nwidth_um = { mean = 3.0, spread = 0.4 }";
    let text = scene_with(&format!("{}{PLACED}{circular}", object(SPHERE)));
    let description = hairline_document::Description::from_toml(&text, "s.toml".as_ref()).unwrap();
    let laid = hairline_document::build(&description, "").unwrap();
    let laid = &laid.objects[0];
    let own_from_world = description.objects[0].world_from_object().inverse();
    let mut csv = Vec::new();
    hairline_document::write_scratches(laid, laid.scratches.iter(), &own_from_world, &mut csv)
        .unwrap();
    let again = load(SPHERE, PLACED, &csv).unwrap();
    assert_eq!(again.scratches.len(), laid.scratches.len());
    assert!(
        laid.scratches.iter().any(|it| it.closed) && laid.scratches.iter().any(|it| !it.closed)
    );
    for (a, b) in laid.scratches.iter().zip(again.scratches.iter()) {
        assert_eq!((&a.profile, a.closed), (&b.profile, b.closed));
        let [long, other] = [laid.length_m(a), again.length_m(b)];
        assert!((long - other).abs() < 1e-6 + 1e-4 * long, "{long} {other}");
        let [first, last] = [laid.pieces(a), again.pieces(b)].map(|it| it[it.len() / 2]);
        assert!(
            first.start_m.distance(last.start_m) < 2e-3,
            "{first:?} {last:?}"
        );
    }
}

#[test]
fn pieces_of_one_scratch_follow_one_another() {
    let header = HEADER.replace("depth_nm", "depth_nm,scratch");
    let cases = [
        (
            "0,0,0,0.05,0,0,1,2,3\n0.05,0,0,0.05,0.02,0,1,2,3\n0,0,0,0.01,0,0,1,2,4\n",
            Ok(vec![2, 1]),
        ),
        (
            "0,0,0,0.05,0,0,1,2,3\n0.06,0,0,0.05,0.02,0,1,2,3\n",
            Err(
                ":3: x0_m: found a start off the row before, of the same scratch 3; must be its end 0.05, 0, 0",
            ),
        ),
        (
            "0,0,0,0.05,0,0,1,2,3\n0.05,0,0,0.05,0.02,0,9,2,3\n",
            Err(
                ":3: found other sizes than in the row before, of the same scratch 3; must be the same",
            ),
        ),
        (
            "0,0,0,0.05,0,0,1,2,1.5\n",
            Err(":2: scratch: found \"1.5\"; must be a whole number"),
        ),
        (
            "0,0,0,0.05,0,0,1,2\n",
            Err(":2: found 8 cells; must be 9, as in the header"),
        ),
    ];
    for (rows, expected) in cases {
        let found = load(PLANE, "", format!("{header}{rows}").as_bytes());
        match (found, expected) {
            (Ok(object), Ok(bends)) => {
                let own = |it: &hairline_scene::Scratch| (object.pieces(it).len() - 1) / 2 + 1;
                let counts: Vec<usize> = object.scratches.iter().map(own).collect();
                assert_eq!(counts.len(), bends.len(), "{rows}");
                // They are joined: each piece begins where the one before ends.
                let first = object.pieces(&object.scratches[0]);
                assert!(
                    first.len() >= 2 && first.array_windows().all(|[a, b]| a.end_m == b.start_m)
                );
            }
            (Err(error), Err(right)) => {
                let message = error.to_string();
                assert!(message.ends_with(&format!("s.csv{right}")), "{message}");
            }
            (found, expected) => panic!("{rows}: {:?} {expected:?}", found.is_ok()),
        }
    }
}

/// The way on a sphere is the great circle; beyond an edge of 90 degrees there is none.
#[test]
fn a_ruler_goes_along_the_surface() {
    let measured = |shape: &str, from: [f64; 3], to: [f64; 3]| {
        let mesh = load(shape, "", HEADER.as_bytes()).unwrap().mesh;
        let [from, to] = [from, to].map(glam::DVec3::from);
        let middle = |t: usize| mesh.corners_m(t).iter().sum::<glam::DVec3>() / 3.0;
        let off = |t: &usize| middle(*t).distance_squared(from);
        let triangle = (0..mesh.triangles.len())
            .min_by(|a, b| off(a).total_cmp(&off(b)))
            .unwrap();
        let from = middle(triangle);
        let path_m = hairline_laying::Ruler::new(mesh.clone()).path_m(triangle, from, to)?;
        let length_m: f64 = path_m.array_windows().map(|[a, b]| a.distance(*b)).sum();
        let straight_m = from.distance(to);
        Some((length_m, straight_m))
    };
    let (length_m, straight_m) = measured(SPHERE, [0.05, 0.0, 0.0], [0.0, 0.05, 0.0]).unwrap();
    let arc_m = 2.0 * 0.05 * (straight_m / 0.1).asin();
    assert!(
        (length_m / arc_m - 1.0).abs() < 2e-3 && length_m > 1.05 * straight_m,
        "{length_m} {arc_m}"
    );
    let (length_m, straight_m) = measured(PLANE, [-0.05, 0.02, 0.0], [0.03, 0.08, 0.0]).unwrap();
    assert!((length_m - straight_m).abs() < 1e-9);
    assert_eq!(
        measured(
            "{ box = { size_m = [0.1, 0.1, 0.1] } }",
            [0.0, 0.0, 0.05],
            [0.05, 0.0, 0.0]
        ),
        None
    );
}

#[test]
fn a_file_cut_off_anywhere_never_panics() {
    let csv = format!(
        "\u{feff}{HEADER}-0.05,-0.05,0,0.05,0.05,0,1.5,200\n0,0,0,1e308,-1e308,1e-308,2.5,300\n"
    );
    for end in 0..csv.len() {
        let _ = load(PLANE, "scale = [3.0, 1.0, 2.0]", &csv.as_bytes()[..end]);
    }
    assert!(load(PLANE, "", csv.as_bytes()).is_err());
}
