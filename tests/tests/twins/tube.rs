//! The outline of a tube.

use super::twin::{Sequence, Tolerance, Twin};
use glam::DVec3;
use hairline_gpu::shaders;
use hairline_optics::band::{TUBE_CORNERS, tube_outline};

#[test]
fn outlines() {
    let mut random = Sequence(9);
    let mut rows = Vec::new();
    while rows.len() < 4000 {
        let a = DVec3::from(random.direction(-1.0).map(f64::from))
            * f64::from(random.uniform(0.3, 2.0));
        let along = DVec3::from(random.direction(-1.0).map(f64::from));
        // A third along the way to the point: seen from beyond an end.
        let along = if rows.len() % 3 == 0 {
            (a + 0.1 * along).normalize()
        } else {
            along
        };
        let b = a + along * f64::from(random.uniform(0.05, 2.0));
        let radius = random.uniform(0.01, 0.25);
        let height = a.cross(along).length();
        // Single precision may decide otherwise where the far end is barely visible or hidden, and from
        // inside.
        let is_plain = height > 2e-3 && (height / f64::from(radius) - 1.0).abs() > 0.02;
        if is_plain && tube_outline(a, b, 1.05 * f64::from(radius)).is_some() {
            let corner = (random.next() * TUBE_CORNERS as f32).floor();
            rows.push([
                a.x as f32, a.y as f32, a.z as f32, b.x as f32, b.y as f32, b.z as f32, radius,
                corner,
            ]);
        }
    }
    Twin {
        name: "tube_outline and tube_corner",
        modules: &[&shaders::TUBE],
        snippet:
            "let outline = tube_outline(vec3f(x[0], x[1], x[2]), vec3f(x[3], x[4], x[5]), x[6]);
            let corner = normalize(tube_corner(outline, u32(x[7])));
            y[0] = corner.x; y[1] = corner.y; y[2] = corner.z;
            let away = normalize(outline.away);
            y[3] = away.x; y[4] = away.y; y[5] = away.z;
            y[6] = f32(outline.seen); y[7] = f32(TUBE_CORNERS);",
        tables: &[],
        expected: &|[ax, ay, az, bx, by, bz, radius, corner]: [f64; 8]| {
            let outline =
                tube_outline(DVec3::new(ax, ay, az), DVec3::new(bx, by, bz), radius).unwrap();
            let corner = outline.tube_corner(corner as usize).normalize();
            let away = outline.away.normalize();
            [
                corner.x,
                corner.y,
                corner.z,
                away.x,
                away.y,
                away.z,
                1.0,
                TUBE_CORNERS as f64,
            ]
        },
        tolerance: Tolerance {
            absolute: 2e-4,
            relative: 0.0,
        },
    }
    .check(&rows, 0);
}
