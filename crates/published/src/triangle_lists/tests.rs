use super::*;
use hairline_fixtures::SceneFile;
use hairline_index::scratch_index::FACING_MIN_COS;
use hairline_optics::footprint::{Footprint, scratch_share};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::collections::HashSet;

/// Triangles from far larger than the window to as small as its reach, flat, round, and with creases of 40 to 90 degrees.
const SHAPES: [(&str, u32, f64); 5] = [
    ("disk = { radius_m = 0.02 }", 400, 0.01),
    ("plane = { size_m = [0.004, 0.003] }", 200, 0.001),
    ("sphere = { radius_m = 0.003 }", 150, 0.002),
    (
        "lathe = { profile_m = [[0.0, 0.001], [0.005, 0.001], [0.006, 0.005], [0.0065, 0.005], [0.0055, 0.0]] }",
        200,
        0.002,
    ),
    // An object as wide as the reach, so that all its sides are near one another.
    (
        "lathe = { profile_m = [[0.0, 0.0002], [0.0001, 0.0002], [0.00015, 0.0001], [0.0001, 0.0], [0.0, 0.0]], segments = 12, smooth = false }",
        20,
        0.0003,
    ),
];

fn scene(shapes: &[(&str, u32, f64)]) -> Scene {
    let mut file = SceneFile::seen_from([0.0, -0.3, 0.3])
        .mirror("m0")
        .mirror("m1")
        .with_lines("coherence_um = 35.0");
    for (i, (shape, count, length_m)) in shapes.iter().enumerate() {
        let (object, material) = (format!("o{i}"), format!("m{}", i % 2));
        let more = format!(
            "seed = {i}\nlength_m = {length_m}\nwidth_um = 2.0\ndepth_nm = 200.0\n\
             curvature_per_m = {{ mean = 0.0, spread = 40.0 }}"
        );
        file = file
            .object(&object, &material, shape)
            .random(&object, *count)
            .with_lines(&more);
    }
    file.scene()
}

/// Share of a segment that a point sees without a footprint, as renderers compute it, over that of an endless scratch
/// through the point. None beyond the reach across.
fn seen(
    position_m: DVec3,
    normal: DVec3,
    coherence_um: f64,
    segment: &IndexedSegment,
) -> Option<f64> {
    if segment.normal.as_dvec3().dot(normal) < FACING_MIN_COS as f64 {
        return None;
    }
    let (x, y) = normal.any_orthonormal_pair();
    let flat = |v: Vec3| {
        let v = (v.as_dvec3() - position_m) * 1e6;
        DVec2::new(v.dot(x), v.dot(y))
    };
    let (start, end) = (flat(segment.start_m), flat(segment.end_m));
    let tangent = (end - start).try_normalize()?;
    let offset_um = tangent.perp_dot(start);
    if offset_um.abs() > REACH_STD as f64 * 0.5f64.sqrt() * coherence_um {
        return None;
    }
    let none = Footprint {
        across_um2: 0.0,
        along_um2: 0.0,
        cross_um2: 0.0,
    };
    let share = |offset_um, start_um, end_um| {
        let blur_um = segment.blur_um as f64;
        scratch_share(
            2.0,
            offset_um,
            start_um,
            end_um,
            blur_um,
            none,
            coherence_um,
        )
        .segment
    };
    let endless = share(0.0, f64::NEG_INFINITY, f64::INFINITY);
    Some(share(offset_um, tangent.dot(start), tangent.dot(end)) / endless)
}

/// Segments that the walk finds at random points of random triangles and the list misses: the greatest share of any, and
/// the number of those above the tail that counts as nothing.
fn missed(scene: &Scene, index: &ScratchIndex, lists: &TriangleLists) -> (f64, usize) {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let (mut greatest, mut count): (f64, usize) = (0.0, 0);
    let mut first = 0;
    for (o, object) in scene.objects.iter().enumerate() {
        let mesh = &object.mesh;
        for _ in 0..20_000 {
            let triangle = random.random_range(0..mesh.triangles.len());
            let listed: HashSet<u32> = lists.of(first + triangle).iter().copied().collect();
            // Corners and edges too.
            let (mut u, mut v): (f64, f64) =
                (random.random_range(0.0..1.0), random.random_range(0.0..1.0));
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            match random.random_range(0..4) {
                0 => (u, v) = (u.round(), (1.0 - u.round()) * v.round()),
                1 => v = 0.0,
                _ => {}
            }
            let at = |values: &[Vec3]| {
                let [a, b, c] = mesh.triangles[triangle].map(|i| values[i as usize].as_dvec3());
                a * (1.0 - u - v) + b * u + c * v
            };
            let (position_m, normal) = (at(&mesh.positions_m), at(&mesh.normals).normalize());
            let coherence_um =
                scene.materials[mesh.triangle_materials[triangle] as usize].coherence_um;
            let reach =
                Vec3::splat((REACH_STD as f64 * (0.7f64).sqrt() * coherence_um * 1e-6) as f32);
            let center = position_m.as_vec3();
            index
                .tree
                .walk(o, center - reach, center + reach, |segments| {
                    for i in segments {
                        let segment = &index.tree.segments[i];
                        let (low, high) = (
                            segment.start_m.min(segment.end_m),
                            segment.start_m.max(segment.end_m),
                        );
                        // A leaf's box may hold a segment that is out of reach by itself.
                        let near =
                            low.cmple(center + reach).all() && high.cmpge(center - reach).all();
                        if near && !listed.contains(&(i as u32)) {
                            let share =
                                seen(position_m, normal, coherence_um, segment).unwrap_or(0.0);
                            greatest = greatest.max(share);
                            count += usize::from(share > TAIL);
                        }
                    }
                });
        }
        first += mesh.triangles.len();
    }
    (greatest, count)
}

/// Tail of a normal distribution beyond [`REACH_STD`]: the largest share of a segment along its line that a list may miss.
const TAIL: f64 = 2.4e-4;

#[test]
fn no_point_misses_a_segment() {
    let scene = scene(&SHAPES);
    let index = ScratchIndex::laid(&scene);
    let lists = TriangleLists::build(&scene, &index);
    let (greatest, count) = missed(&scene, &index, &lists);
    println!("greatest share out of a list: {greatest:.1e}");
    assert!(count == 0, "{count} missed, {greatest}");

    let triangles = lists.starts.len() - 1;
    println!(
        "{triangles} triangles, {} segments, {:.1} entries a triangle",
        index.tree.segments.len(),
        lists.segments.len() as f64 / triangles as f64
    );

    // The test can fail.
    let halved = TriangleLists::within(0.5 * REACH_STD as f64, &scene, &index);
    let (greatest, count) = missed(&scene, &index, &halved);
    println!("half the reach: {count} missed, {greatest:.2} of a scratch the most");
    assert!(count > 100 && greatest > 0.05, "{count} {greatest}");
}

/// Entries are near their triangle, by the one bound that needs no thought; far triangles have none; each list is in order.
#[test]
fn lists_hold_what_is_near() {
    let scene = scene(&[
        ("sphere = { radius_m = 0.02 }", 5, 0.002),
        ("disk = { radius_m = 0.05 }", 0, 0.01),
    ]);
    let index = ScratchIndex::laid(&scene);
    let lists = TriangleLists::build(&scene, &index);
    let mut empty = 0;
    let sphere = &scene.objects[0].mesh;
    for (t, triangle) in sphere.triangles.iter().enumerate() {
        let corners = triangle.map(|i| sphere.positions_m[i as usize]);
        let center = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = corners
            .map(|c| c.distance(center))
            .into_iter()
            .fold(0.0, f32::max);
        let list = lists.of(t);
        empty += usize::from(list.is_empty());
        assert!(list.is_sorted_by(|a, b| a < b));
        for i in list {
            let segment = &index.tree.segments[*i as usize];
            let along = segment.end_m - segment.start_m;
            let share =
                ((center - segment.start_m).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            let distance = center.distance(segment.start_m + share * along);
            // 20 um: 3.5 sqrt(0.7) sigma in each of three directions.
            assert!(distance < radius + 102e-6, "{distance} {radius}");
        }
    }
    assert!(empty > sphere.triangles.len() / 2);
    for t in sphere.triangles.len()..lists.starts.len() - 1 {
        assert!(lists.of(t).is_empty());
    }
}

/// Whatever the number of threads.
#[test]
fn lists_are_the_same_again() {
    let scene = scene(&SHAPES[..3]);
    let index = ScratchIndex::laid(&scene);
    let one = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let alone = one.install(|| TriangleLists::build(&scene, &index));
    assert_eq!(alone, TriangleLists::build(&scene, &index));
}
