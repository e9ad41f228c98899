use super::*;
use crate::grating::Grating;
use crate::metal::Metal;
use crate::section::Section;
use crate::spectrum;
use glam::DVec3;
use std::f64::consts::PI;

/// Each part alone, and all together.
fn materials() -> Vec<(&'static str, ScratchedBsdf)> {
    let conductor = std::sync::Arc::new(Conductor::of_metal(Metal::StainlessSteel, 0.3));
    let groove = |part, width_um, depth_nm| Groove {
        part,
        width_um,
        depth_nm,
    };
    let layer = |share, spread| {
        let grooves = vec![groove(0.5, 1.5, 120.0), groove(0.5, 2.5, 200.0)];
        LayerLobe::new(
            &conductor,
            share,
            grooves,
            Profile::default(),
            0.3,
            spread,
            20.0,
        )
    };
    let row = Grating {
        pitch_um: 1.6,
        width_um: 0.6,
        depth_nm: 110.0,
        depth_spread: 0.0,
        jitter_um: 0.0,
    };
    let grating = |row, share| GratingLobe::new(&conductor, row, share, 0.9, 0.02, 20.0);
    let point = PointScratch {
        tangent: glam::DVec2::from_angle(1.1),
        width_um: 2.0,
        depth_nm: 150.0,
        profile: Profile::default(),
        share: ScratchShare {
            segment: 0.03,
            line: 0.05,
            cover: 1.0,
        },
    };
    let bare = ScratchedBsdf {
        conductor: conductor.clone(),
        roughness: 0.3,
        coherence_um: 20.0,
        layers: vec![],
        points: vec![],
        gratings: vec![],
        depth_coherence: 0.7,
    };
    let uneven = Grating {
        jitter_um: 0.2,
        depth_spread: 0.2,
        ..row
    };
    vec![
        ("bare", bare.clone()),
        (
            "all ways",
            ScratchedBsdf {
                layers: vec![layer(0.03, f64::INFINITY)],
                ..bare.clone()
            },
        ),
        (
            "spread",
            ScratchedBsdf {
                layers: vec![layer(0.03, 0.2)],
                ..bare.clone()
            },
        ),
        (
            "parallel",
            ScratchedBsdf {
                layers: vec![layer(0.03, 0.0)],
                ..bare.clone()
            },
        ),
        (
            "point",
            ScratchedBsdf {
                points: vec![point.clone()],
                ..bare.clone()
            },
        ),
        (
            "round ones and a V",
            ScratchedBsdf {
                layers: vec![LayerLobe::new(
                    &conductor,
                    0.03,
                    vec![groove(1.0, 2.0, 200.0)],
                    Profile::new(&Section::Round),
                    0.3,
                    f64::INFINITY,
                    20.0,
                )],
                points: vec![PointScratch {
                    profile: Profile::new(&Section::V),
                    ..point.clone()
                }],
                ..bare.clone()
            },
        ),
        (
            "grating",
            ScratchedBsdf {
                gratings: vec![grating(row, 0.6)],
                ..bare.clone()
            },
        ),
        (
            "all",
            ScratchedBsdf {
                layers: vec![layer(0.02, 0.5)],
                points: vec![point],
                gratings: vec![grating(uneven, 0.4)],
                ..bare
            },
        ),
    ]
}

fn views() -> [DVec3; 3] {
    [(0.0, 0.0), (0.7, 1.0), (1.2, -2.0)].map(|(theta, phi): (f64, f64)| {
        DVec3::new(
            theta.sin() * phi.cos(),
            theta.sin() * phi.sin(),
            theta.cos(),
        )
    })
}

/// A sequence of low discrepancy in the cube.
fn cube(i: u32) -> (f64, DVec2) {
    let at = |alpha: f64| (0.5 + alpha * f64::from(i)).fract();
    (
        at(0.819_172_513_396_164_4),
        DVec2::new(at(0.671_043_606_703_789_2), at(0.549_700_477_901_970_3)),
    )
}

/// The mean of 1/pdf over a set of drawn directions is the set's solid angle, if the density is that of the draws.
#[test]
fn densities_are_those_of_the_draws() {
    for (name, material) in materials() {
        for wo in &views()[1..] {
            let wo = *wo;
            for mode in [SpectralMode::Rgb, SpectralMode::Wavelength(550.0)] {
                let draws = 100_000;
                let mut found = 0.0;
                for i in 0..draws {
                    let (pick, u) = cube(i);
                    if let Some((wi, pdf, _)) = material.sample(wo, pick, u, mode) {
                        let own = material.pdf(wi, wo, mode);
                        assert!((own / pdf - 1.0).abs() < 1e-12);
                        // A cap of directions about the viewer's mirror direction, weighted by how near.
                        let mirror = DVec3::new(-wo.x, -wo.y, wo.z);
                        let inside = wi.dot(mirror) > 0.9;
                        found += if inside && wi.z > 0.3 {
                            ggx_pdf(wi, wo, 0.3) / pdf
                        } else {
                            0.0
                        };
                    }
                }
                let found = found / f64::from(draws);
                let steps = 500;
                let mut right = 0.0;
                for i in 0..steps {
                    for j in 0..2 * steps {
                        let z = (f64::from(i) + 0.5) / f64::from(steps);
                        let phi = PI * (f64::from(j) + 0.5) / f64::from(steps);
                        let wi = (DVec2::from_angle(phi) * (1.0 - z * z).sqrt()).extend(z);
                        let mirror = DVec3::new(-wo.x, -wo.y, wo.z);
                        if wi.dot(mirror) > 0.9 && z > 0.3 {
                            right += ggx_pdf(wi, wo, 0.3);
                        }
                    }
                }
                right *= PI / f64::from(steps * steps);
                assert!(
                    (found / right - 1.0).abs() < 0.03,
                    "{name} {wo} {mode:?}: {found} {right}"
                );
            }
        }
    }
}

/// Light of radiance 1 from all around comes back as of the bare metal: what scratches send is what the base loses.
#[test]
fn scratches_keep_the_energy_of_the_metal() {
    let all = materials();
    let albedo = |material: &ScratchedBsdf, wo: DVec3, mode| {
        let draws = 60_000;
        let each = (0..draws).map(|i| {
            let (pick, u) = cube(i);
            let drawn = material.sample(wo, pick, u, mode);
            drawn.map_or(DVec3::ZERO, |(_, pdf, value)| {
                (value.base + value.scratches) / pdf
            })
        });
        each.sum::<DVec3>() / f64::from(draws)
    };
    for wo in &views()[..2] {
        for mode in [SpectralMode::Rgb, SpectralMode::Wavelength(550.0)] {
            let bare = albedo(&all[0].1, *wo, mode);
            for (name, material) in &all[1..] {
                let ratio = albedo(material, *wo, mode) / bare;
                assert!(
                    (ratio - 1.0).abs().max_element() < 0.02,
                    "{name} {wo} {mode:?}: {ratio}"
                );
            }
        }
    }
}

/// Of colours as of one wavelength after the other.
#[test]
fn colours_are_sums_over_wavelengths() {
    for (name, material) in materials() {
        let wo = views()[1];
        let (mut error, mut size) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..2000 {
            let (pick, u) = cube(i);
            let Some((wi, ..)) = material.sample(wo, pick, u, SpectralMode::Rgb) else {
                continue;
            };
            let total = |mode| {
                let it = material.eval(wi, wo, mode);
                it.base + it.scratches
            };
            // Every nm, since orders of gratings are narrower than 5 nm.
            let sum: DVec3 = (380..780)
                .map(|nm| {
                    let nm = f64::from(nm) + 0.5;
                    DVec3::from(spectrum::weight_per_nm(nm)) * total(SpectralMode::Wavelength(nm))
                })
                .sum();
            let size_of = sum.length().max(1e-9);
            error += (total(SpectralMode::Rgb) - sum).powf(2.0) / size_of;
            size += sum * sum / size_of;
        }
        let rms = (error / size).map(f64::sqrt);
        assert!(rms.max_element() < 0.05, "{name}: {rms}");
    }
}

/// A scratch lights both ways alike; Fresnel's factor and the mask are the viewer's.
#[test]
fn scratches_are_reciprocal_but_for_fresnel_and_the_mask() {
    let (_, mut material) = materials().swap_remove(2);
    material.layers[0] = {
        let grooves = vec![Groove {
            part: 1.0,
            width_um: 2.0,
            depth_nm: 150.0,
        }];
        let profile = Profile::default();
        LayerLobe::new(&material.conductor, 1e-6, grooves, profile, 0.3, 0.2, 20.0)
    };
    let mode = SpectralMode::Wavelength(550.0);
    let [_, a, b] = views();
    let one_way =
        material.eval(a, b, mode).scratches.x / a.z / material.conductor.reflectance(b.z, mode).x;
    let other =
        material.eval(b, a, mode).scratches.x / b.z / material.conductor.reflectance(a.z, mode).x;
    assert!((one_way / other - 1.0).abs() < 1e-5, "{one_way} {other}");
}
