//! Normals of a mesh that has none: smooth, but for edges.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::translated::Part;

/// Triangles that meet at a smaller angle than 30 degrees are of one smooth surface.
const CREASE_COS: f64 = 0.866_025_403_784_438_6;

/// A place as a key. Both zeros are one.
fn key(position: [f32; 3]) -> [u32; 3] {
    position.map(|x| (x + 0.0).to_bits())
}

/// Gives each corner of a triangle the mean normal of the triangles around its place that bend little from it, weighted by their angles there, after
/// Thürmer and Wüthrich, *Computing vertex normals from polygonal facets*, 1998. A vertex with several normals becomes several.
/// Triangles without an area have no normal, and go.
pub(super) fn add_normals(part: &mut Part) {
    let place = |v: u32| Vec3::from(part.positions[v as usize]).as_dvec3();
    let normal = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(place);
        (b - a).cross(c - a).normalize_or_zero()
    };
    part.triangles
        .retain(|corners| normal(corners) != DVec3::ZERO);
    let faces: Vec<DVec3> = part.triangles.iter().map(normal).collect();
    // Seams of texture coordinates hold one place twice.
    let mut around: HashMap<[u32; 3], Vec<(u32, f64)>> = HashMap::new();
    for (triangle, corners) in (0u32..).zip(&part.triangles) {
        for i in 0..3 {
            let [here, next, last] = [0, 1, 2].map(|k| place(corners[(i + k) % 3]));
            let angle = (next - here)
                .normalize_or_zero()
                .angle_between((last - here).normalize_or_zero());
            let angle = if angle.is_finite() { angle } else { 0.0 };
            let key = key(part.positions[corners[i] as usize]);
            around.entry(key).or_default().push((triangle, angle));
        }
    }
    let mut known: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
    let mut split = Part::default();
    for (triangle, corners) in part.triangles.iter().enumerate() {
        let face = faces[triangle];
        split.triangles.push(corners.map(|v| {
            let position = part.positions[v as usize];
            let near = around[&key(position)].iter();
            let smooth = near.filter(|(other, _)| faces[*other as usize].dot(face) >= CREASE_COS);
            let sum: DVec3 = smooth
                .map(|(other, angle)| faces[*other as usize] * *angle)
                .sum();
            let normal = sum.normalize_or(face).as_vec3().to_array();
            *known
                .entry((v, normal.map(f32::to_bits)))
                .or_insert_with(|| {
                    split.positions.push(position);
                    split.normals.push(normal);
                    split.uvs.extend(part.uvs.get(v as usize));
                    split.colors.extend(part.colors.get(v as usize));
                    split.positions.len() as u32 - 1
                })
        }));
    }
    *part = Part {
        name: std::mem::take(&mut part.name),
        material: part.material,
        ..split
    };
}
