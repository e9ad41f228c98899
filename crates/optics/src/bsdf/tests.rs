use super::*;
use crate::cover::Cover;
use crate::fresnel;
use crate::grating::Grating;
use crate::metal::Metal;
use crate::rigorous::{Efficiencies, FineGrooves, Medium};
use crate::section::Section;
use crate::spectrum;
use glam::DVec3;
use std::f64::consts::PI;
use std::sync::LazyLock;
use std::sync::OnceLock;

/// A compact disc's plate.
const PLATE: Cover = Cover {
    ior: 1.58,
    thickness_mm: 1.2,
    color: [0.8; 3],
};

/// A fine row in gold.
const FINE: Grating = Grating {
    pitch_um: 0.5,
    width_um: 0.2,
    depth_nm: 80.0,
    depth_spread: 0.0,
    jitter_um: 0.0,
};

/// Rigorous efficiencies of [`FINE`], computed once.
fn fine(cover: Option<Cover>) -> FineGrating {
    static MADE: [OnceLock<Arc<Efficiencies>>; 2] = [const { OnceLock::new() }; 2];
    let medium = Medium::Metal(Metal::Gold.into());
    let make = || {
        let grooves = FineGrooves {
            pitch_um: FINE.pitch_um,
            width_um: FINE.width_um,
            depth_nm: FINE.depth_nm,
            above: cover.map_or(1.0, |it| it.ior),
            medium: medium.clone(),
        };
        Efficiencies::new(&grooves, &|| false).unwrap().into()
    };
    let efficiencies = MADE[usize::from(cover.is_some())].get_or_init(make);
    FineGrating {
        efficiencies: efficiencies.clone(),
        medium,
        cover,
    }
}

/// Gold under a layer, with a fine row on a share of it.
fn gold_with_a_row(overlay: Overlay, share: f64, roughness: f64) -> ScratchedBsdf {
    let cover = match overlay {
        Overlay::Cover(cover) => Some(cover),
        _ => None,
    };
    let conductor = Conductor::new(Metal::Gold, overlay, roughness);
    let row = GratingLobe::new(
        &conductor,
        FINE,
        Some(fine(cover)),
        share,
        directions(0.9, 0.02),
        20.0,
    );
    ScratchedBsdf {
        gratings: vec![row],
        ..bare(conductor, roughness)
    }
}

fn bare(conductor: Conductor, roughness: f64) -> ScratchedBsdf {
    ScratchedBsdf {
        conductor: conductor.into(),
        roughness,
        coherence_um: 20.0,
        layers: vec![],
        points: vec![],
        gratings: vec![],
        depth_coherence: 0.7,
    }
}

/// A material without its scratches and gratings.
fn bare_of(material: &ScratchedBsdf) -> ScratchedBsdf {
    ScratchedBsdf {
        layers: vec![],
        points: vec![],
        gratings: vec![],
        ..material.clone()
    }
}

/// Each part alone, and all together; then all in a coat and under a plate, and fine rows. Their tables take a second.
fn materials() -> Vec<(&'static str, ScratchedBsdf)> {
    static MATERIALS: LazyLock<Vec<(&str, ScratchedBsdf)>> = LazyLock::new(make_materials);
    MATERIALS.clone()
}

fn make_materials() -> Vec<(&'static str, ScratchedBsdf)> {
    let of = |overlay| Conductor::new(Metal::StainlessSteel, overlay, 0.3);
    let coat = |weight| Overlay::Coat(CoatLobe::new(weight, 0.2));
    let steel = of(Overlay::Bare);
    let bare = bare(steel.clone(), 0.3);
    let layers = |layer| ScratchedBsdf {
        layers: vec![layer],
        ..bare.clone()
    };
    let round = LayerLobe::new(
        &steel,
        0.03,
        vec![groove(1.0, 2.0, 200.0)],
        Profile::new(&Section::Round),
        directions(0.3, f64::INFINITY),
        20.0,
    );
    let point = |profile| PointScratch {
        tangent: DVec2::from_angle(1.1),
        width_um: 2.0,
        depth_nm: 150.0,
        profile,
        share: ScratchShare {
            segment: 0.03,
            line: 0.05,
            cover: 1.0,
        },
    };
    let points = |profile| ScratchedBsdf {
        points: vec![point(profile)],
        ..bare.clone()
    };
    let with_v = ScratchedBsdf {
        points: vec![point(Profile::new(&Section::V))],
        ..layers(round)
    };
    let gratings = ScratchedBsdf {
        gratings: vec![grating(&steel, ROW, 0.6)],
        ..bare.clone()
    };
    let uneven = Grating {
        jitter_um: 0.2,
        depth_spread: 0.2,
        ..ROW
    };
    let together = |conductor: Conductor| ScratchedBsdf {
        layers: vec![layer(&conductor, 0.02, 0.5)],
        points: vec![point(Profile::default())],
        gratings: vec![grating(&conductor, uneven, 0.4)],
        ..self::bare(conductor, 0.3)
    };
    let covered = gold_with_a_row(Overlay::Cover(PLATE), 0.4, 0.3);
    vec![
        ("all ways", layers(layer(&steel, 0.03, f64::INFINITY))),
        ("spread", layers(layer(&steel, 0.03, 0.2))),
        ("parallel", layers(layer(&steel, 0.03, 0.0))),
        ("point", points(Profile::default())),
        ("round ones and a V", with_v),
        ("grating", gratings),
        ("all", together(steel)),
        ("all in a coat", together(of(coat(1.0)))),
        ("all in half a coat", together(of(coat(0.5)))),
        ("all under a plate", together(of(Overlay::Cover(PLATE)))),
        ("fine row", gold_with_a_row(Overlay::Bare, 0.4, 0.3)),
        ("fine row under a plate", covered),
        ("bare", bare),
    ]
}

const ROW: Grating = Grating {
    pitch_um: 1.6,
    width_um: 0.6,
    depth_nm: 110.0,
    depth_spread: 0.0,
    jitter_um: 0.0,
};

fn groove(part: f64, width_um: f64, depth_nm: f64) -> Groove {
    Groove {
        part,
        width_um,
        depth_nm,
    }
}

fn directions(mean_rad: f64, std_rad: f64) -> GrooveDirections {
    GrooveDirections { mean_rad, std_rad }
}

fn layer(conductor: &Conductor, share: f64, spread_rad: f64) -> LayerLobe {
    let grooves = vec![groove(0.5, 1.5, 120.0), groove(0.5, 2.5, 200.0)];
    let profile = Profile::default();
    LayerLobe::new(
        conductor,
        share,
        grooves,
        profile,
        directions(0.3, spread_rad),
        20.0,
    )
}

fn grating(conductor: &Conductor, row: Grating, share: f64) -> GratingLobe {
    GratingLobe::new(conductor, row, None, share, directions(0.9, 0.02), 20.0)
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
                let draws = 10_000;
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
                let steps = 200;
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
    // Fine rows absorb more.
    let keeping = |it: &(&str, ScratchedBsdf)| !it.0.starts_with("fine");
    for (name, material) in materials().iter().filter(|it| keeping(it)) {
        let bare = bare_of(material);
        for wo in &views()[..2] {
            for mode in [SpectralMode::Rgb, SpectralMode::Wavelength(550.0)] {
                let ratio = albedo(material, *wo, mode) / albedo(&bare, *wo, mode);
                assert!(
                    (ratio - 1.0).abs().max_element() < 0.02,
                    "{name} {wo} {mode:?}: {ratio}"
                );
            }
        }
    }
}

/// Light that comes back of radiance 1 from all around.
fn albedo(material: &ScratchedBsdf, wo: DVec3, mode: SpectralMode) -> DVec3 {
    let draws = 10_000;
    let each = (0..draws).map(|i| {
        let (pick, u) = cube(i);
        let drawn = material.sample(wo, pick, u, mode);
        drawn.map_or(DVec3::ZERO, |(_, pdf, value)| {
            (value.base + value.scratches) / pdf
        })
    });
    each.sum::<DVec3>() / f64::from(draws)
}

/// Of a smooth surface all is known: a coat's face reflects F and lets 1 - F through to the metal's R, a plate has its own reflectance.
#[test]
fn layers_over_a_metal_share_its_light() {
    let nm = 600.0;
    let mode = SpectralMode::Wavelength(nm);
    for wo in views() {
        let r = Metal::Gold.reflectance(wo.z, nm);
        let found = |overlay| {
            albedo(
                &bare(Conductor::new(Metal::Gold, overlay, 0.0), 0.0),
                wo,
                mode,
            )
            .x
        };
        for weight in [0.0, 0.4, 1.0] {
            let coat = weight * fresnel::dielectric(wo.z, 1.5);
            let found = found(Overlay::Coat(CoatLobe::new(weight, 0.0)));
            let right = coat + (1.0 - coat) * r;
            assert!((found / right - 1.0).abs() < 0.01, "{wo} {found} {right}");
        }
        let (n, k) = Metal::Gold.n_k(nm);
        let right = PLATE.reflectance([n, k], wo.z);
        let found = found(Overlay::Cover(PLATE));
        assert!((found / right - 1.0).abs() < 0.01, "{wo} {found} {right}");
        assert!(right < 0.8 * r, "the plate is seen");
    }
}

/// The light of a fine row on a share of the surface is what its efficiencies send to all orders, and the metal's where there are no grooves.
#[test]
fn fine_rows_send_their_efficiencies() {
    let (nm, share) = (550.0, 0.4);
    let material = gold_with_a_row(Overlay::Bare, share, 0.0);
    let along = DVec2::from_angle(0.9);
    for wo in views() {
        let viewer = DVec2::new(wo.truncate().dot(along), along.perp_dot(wo.truncate()));
        let rows: f64 = (-2..=2)
            .filter(|order| {
                let across = FINE.order_q(*order, nm) - viewer.y;
                across * across + viewer.x * viewer.x < 1.0
            })
            .map(|order| {
                let efficiencies = &fine(None).efficiencies;
                efficiencies.efficiency(order, nm, -viewer.y, viewer.x)
            })
            .sum();
        let flat = Metal::Gold.reflectance(wo.z, nm);
        let right = share * rows + (1.0 - share) * flat;
        let found = albedo(&material, wo, SpectralMode::Wavelength(nm)).x;
        assert!((found / right - 1.0).abs() < 0.02, "{wo}: {found} {right}");
        assert!((flat / right - 1.0).abs() > 0.04, "{wo}: grooves absorb");
    }
}

/// Of colours as of one wavelength after the other.
#[test]
fn colours_are_sums_over_wavelengths() {
    for (name, material) in materials() {
        let wo = views()[1];
        let (mut error, mut size) = (DVec3::ZERO, DVec3::ZERO);
        for i in 0..120 {
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
    let (_, mut material) = materials().swap_remove(1);
    material.layers[0] = {
        let (grooves, profile) = (vec![groove(1.0, 2.0, 150.0)], Profile::default());
        LayerLobe::new(
            &material.conductor,
            1e-6,
            grooves,
            profile,
            directions(0.3, 0.2),
            20.0,
        )
    };
    let mode = SpectralMode::Wavelength(550.0);
    let [_, a, b] = views();
    let one_way =
        material.eval(a, b, mode).scratches.x / a.z / material.conductor.reflectance(b.z, mode).x;
    let other =
        material.eval(b, a, mode).scratches.x / b.z / material.conductor.reflectance(a.z, mode).x;
    assert!((one_way / other - 1.0).abs() < 1e-5, "{one_way} {other}");
}
