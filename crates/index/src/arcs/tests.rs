use super::*;
use crate::IndexedProfile;

const HALF_DEGREE: f32 = 0.008_726_646;
const DEVIATION_M: f32 = 1e-5;

/// Chords of half a degree along a curve in a plane that turns to the left by `turn(i)` half degrees a chord.
fn chords(count: usize, length_m: f32, turn: impl Fn(usize) -> f32) -> Vec<IndexedSegment> {
    let (mut at, mut angle) = (Vec3::ZERO, 0.0f32);
    let chord = |i: usize| {
        let start_m = at;
        at += length_m * Vec3::new(angle.cos(), angle.sin(), 0.0);
        angle += HALF_DEGREE * turn(i);
        IndexedSegment {
            start_m,
            end_m: at,
            normal: Vec3::Z,
            turn_rad: 0.0,
            profile: IndexedProfile::rectangle(2.0, 200.0),
            blur_um: 16.0,
        }
    };
    (0..count).map(chord).collect()
}

fn joined(laid: &[IndexedSegment], deviation_m: f32) -> Vec<IndexedSegment> {
    let mut pieces = laid.to_vec();
    join(&mut pieces, 0, deviation_m);
    pieces
}

/// Angle about z from one vector to another.
fn angle(from: Vec3, to: Vec3) -> f32 {
    from.cross(to).z.atan2(from.dot(to))
}

/// Of a circle of 5 mm arcs of some 13 chords serve, whose tangents are the circle's wherever one looks.
#[test]
fn chords_of_a_circle_become_arcs() {
    let laid = chords(240, 5e-3 * HALF_DEGREE, |_| 1.0);
    let arcs = joined(&laid, DEVIATION_M);
    assert!((10..30).contains(&arcs.len()), "{}", arcs.len());
    assert_eq!(arcs[0].start_m, laid[0].start_m);
    assert!(arcs.windows(2).all(|pair| pair[0].end_m == pair[1].start_m));
    for chord in &laid {
        let middle = 0.5 * (chord.start_m + chord.end_m);
        let is_under = |arc: &&IndexedSegment| {
            let along = arc.end_m - arc.start_m;
            (0.0..along.length_squared()).contains(&(middle - arc.start_m).dot(along))
        };
        let arc = arcs.iter().find(is_under).unwrap();
        let along = arc.end_m - arc.start_m;
        let place = (middle - arc.start_m).dot(along) / along.length_squared() - 0.5;
        let beside = (middle - arc.start_m).cross(along).length() / along.length();
        let off = angle(along, chord.end_m - chord.start_m) - place * arc.turn_rad;
        assert!(off.abs() < 1e-3 && beside < DEVIATION_M, "{off} {beside}");
    }
}

/// A straight scratch over the edges of a bent sheet is one piece, as long as the sheet bends by less than the deviation.
#[test]
fn straight_pieces_over_bent_triangles_become_one() {
    let mut at = Vec3::ZERO;
    let pieces: Vec<IndexedSegment> = (0..6)
        .map(|i| {
            let lean = 0.02 * i as f32;
            let start_m = at;
            at += 1e-4 * Vec3::new(lean.cos(), 0.0, lean.sin());
            IndexedSegment {
                start_m,
                end_m: at,
                normal: Vec3::new(-lean.sin(), 0.0, lean.cos()),
                turn_rad: 0.0,
                profile: IndexedProfile::rectangle(2.0, 200.0),
                blur_um: 16.0,
            }
        })
        .collect();
    let arcs = joined(&pieces, DEVIATION_M);
    assert_eq!(arcs.len(), 1);
    assert!(arcs[0].turn_rad.abs() < 1e-4);
    assert!(joined(&pieces, 1e-6).len() > 1);
}

/// What is laid stays, without a view; so do pieces that are far from an arc, and those that do not touch.
#[test]
fn what_is_no_arc_stays() {
    let circle = chords(40, 4e-5, |_| 1.0);
    assert_eq!(joined(&circle, 0.0), circle);
    // To and fro by five degrees: nowhere off by a micrometre, and no arc.
    let zigzag = chords(40, 1e-5, |i| if i % 2 == 0 { 10.0 } else { -10.0 });
    assert!(joined(&zigzag, DEVIATION_M).len() >= 20);
    let mut apart = chords(2, 1e-4, |_| 0.0);
    apart[1].start_m.x += 1e-5;
    assert_eq!(joined(&apart, DEVIATION_M), apart);
    let flawed = IndexedSegment {
        end_m: Vec3::NAN,
        ..circle[0]
    };
    assert_eq!(joined(&[flawed, circle[1]], DEVIATION_M).len(), 2);
}
