//! Tests of the origin's place.

use super::*;

fn mesh(min_m: Vec3, max_m: Vec3) -> PlacedMesh {
    PlacedMesh {
        mesh: Arc::default(),
        min_m,
        max_m,
        triangles: 0..1,
    }
}

#[test]
fn the_origin_is_near_the_middle_and_stays_where_small_things_move() {
    let pan = |x: f32| mesh(Vec3::new(x - 0.1, -0.1, 0.0), Vec3::new(x + 0.1, 0.1, 0.02));
    for (scale, offset) in [(1.0, 0.0), (1e-3, 0.7), (2000.0, -5.0)] {
        let at = |x: f32, z: f32| (Vec3::new(x, -1.0, z) * scale) + offset;
        let table = mesh(at(-1.0, -0.003), at(1.0, -0.003));
        let origin_m = origin(&[pan(0.0), table.clone()]);
        let union = (
            table.min_m.min(pan(0.0).min_m),
            table.max_m.max(pan(0.0).max_m),
        );
        let (min, max) = (union.0.as_dvec3(), union.1.as_dvec3());
        let extent = (max - min).max_element();
        assert!((origin_m - min.midpoint(max)).abs().max_element() <= extent / 8.0);
    }
    // Over a table, within its bounds and a little above.
    let table = mesh(Vec3::new(-1.0, -1.0, -0.003), Vec3::new(1.0, 1.0, -0.003));
    let origins = [-0.8, -0.3, 0.0, 0.2, 0.85].map(|x| origin(&[pan(x), table.clone()]));
    assert!(origins.iter().all(|o| *o == origins[0]), "{origins:?}");
}

#[test]
fn scenes_of_nothing_have_an_origin() {
    assert_eq!(origin(&[]), DVec3::ZERO);
    let empty = mesh(Vec3::INFINITY, Vec3::NEG_INFINITY);
    assert_eq!(origin(std::slice::from_ref(&empty)), DVec3::ZERO);
    let point = mesh(Vec3::ONE, Vec3::ONE);
    assert_eq!(origin(&[empty, point]), DVec3::ONE);
}
