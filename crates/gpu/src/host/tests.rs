//! Precision lost by packing a scratch's segment.

use crate::call::Call;
use crate::{headless, shaders};
use glam::Vec3;
use hairline_index::packed_profile::{half_bits, octahedral};
use half::f16;

/// The normals as shaders see them.
fn unpacked(normals: &[Vec3]) -> Option<Vec<Vec3>> {
    let gpu = headless::test_gpu()?;
    let call = Call {
        modules: &[&shaders::SEGMENTS],
        // Bits as two numbers, since a row's numbers are floats.
        snippet: "let n = profile_unpacked(0u, u32(x[0])).normal; y[0] = n.x; y[1] = n.y; y[2] = n.z;",
        tables: &[],
    };
    let rows: Vec<[f32; 1]> = normals.iter().map(|n| [octahedral(*n) as f32]).collect();
    let results: Vec<[f32; 3]> = gpu.block_on(call.run(gpu, &rows)).unwrap();
    Some(results.into_iter().map(Vec3::from).collect())
}

#[test]
fn normals_keep_their_direction_within_a_degree() {
    let mut normals = vec![
        Vec3::X,
        Vec3::Y,
        Vec3::Z,
        -Vec3::X,
        -Vec3::Y,
        -Vec3::Z,
        Vec3::new(0.6, 0.8, 0.0),
        Vec3::new(-0.6, 0.0, -0.8),
        Vec3::new(0.0, -1e-6, -1.0),
        Vec3::new(1.0, 1e-6, -1e-6),
        Vec3::new(-1.0, -0.0, -0.0),
    ];
    let exact = 6;
    // Evenly over the sphere.
    normals.extend((0..20_000).map(|i| {
        let z = 1.0 - (i as f32 + 0.5) / 10_000.0;
        let (sin, cos) = (2.399_963 * i as f32 % std::f32::consts::TAU).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vec3::new(r * cos, r * sin, z)
    }));
    let Some(found) = unpacked(&normals) else {
        return;
    };
    let angle = |(a, b): (&Vec3, &Vec3)| a.angle_between(*b).to_degrees();
    let angles: Vec<f32> = normals.iter().zip(&found).map(angle).collect();
    let worst = angles.iter().copied().fold(0.0, f32::max);
    let mean = angles.iter().sum::<f32>() / angles.len() as f32;
    println!("mean {mean:.3}, worst {worst:.3} degrees");
    // Bytes in steps of 1/127: half a step each way is 0.45 degrees near the faces' middles, twice that near the folds. No
    // normal comes to lie on the other side of its sheet.
    assert!(mean < 0.4 && worst < 1.0, "{mean} {worst}");
    // Sheets along the axes are not turned at all, but by the rounding of acos.
    assert!(
        angles[..exact].iter().all(|a| *a < 0.05),
        "{:?}",
        &angles[..exact]
    );
}

/// A half float's eleven digits, over all that a scene may ask for.
#[test]
fn lengths_keep_five_parts_in_ten_thousand() {
    let mut value = 1e-3f32;
    while value < 6e4 {
        let bits = half_bits(value);
        let found = f16::from_bits(bits as u16).to_f32();
        assert!((found / value - 1.0).abs() < 5e-4, "{value}: {found}");
        value *= 1.007;
    }
    assert_eq!(half_bits(0.0), 0);
}
