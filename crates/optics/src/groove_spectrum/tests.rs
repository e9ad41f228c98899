use super::*;
use crate::coherent::{GroovePiece, base_amplitude, groove_overlap, scratch_amplitude};
use crate::section::CLASSES;
use crate::spectrum;
use crate::table::ScratchTable;
use glam::DVec2;
use num_complex::Complex64;

const SECTIONS: [Section; 4] = [
    Section::Rectangle,
    Section::V,
    Section::Round,
    Section::Shoulders,
];

fn relative_rms(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    let (mut error2, mut value2) = (0.0, 0.0);
    for (value, right) in pairs {
        error2 += (value - right).powi(2);
        value2 += right * right;
    }
    (error2 / value2).sqrt()
}

/// Strips of a groove as the full wave sees them.
fn strips(section: &Section, width_um: f64, depth_nm: f64, offset_um: f64) -> Vec<GroovePiece> {
    let strips = section.strips(64);
    let strip_um = width_um / strips.len() as f64;
    let piece = |(x, share): &(f64, f64)| GroovePiece {
        tangent: DVec2::X,
        offset_um: offset_um + 0.5 * width_um * x,
        start_um: f64::NEG_INFINITY,
        end_um: f64::INFINITY,
        width_um: strip_um,
        depth_nm: depth_nm * share,
    };
    strips.iter().map(piece).collect()
}

/// |S'|² over q, averaged over all places of the groove in the window, in units of the width over the wavelength.
fn full_wave(
    section: &Section,
    width_um: f64,
    depth_nm: f64,
    q: f64,
    sigma_um: f64,
    apart: bool,
) -> f64 {
    let nm = 550.0;
    let step_um = 0.25 * sigma_um;
    let reach = ((0.5 * width_um + 5.0 * sigma_um) / step_um).ceil() as i64;
    let xi = DVec2::new(0.0, q);
    let base = base_amplitude(xi, sigma_um, nm);
    let sum: f64 = (-reach..=reach)
        .map(|i| {
            let pieces = strips(section, width_um, depth_nm, step_um * i as f64);
            let s = scratch_amplitude(&pieces, xi, 2.0, sigma_um, nm);
            let taken: Complex64 = pieces
                .iter()
                .map(|p| p.phase_step(2.0, nm) * groove_overlap(p, sigma_um))
                .sum();
            let kept = if apart { taken * base } else { Complex64::ZERO };
            step_um * (s - kept).norm_sqr()
        })
        .sum();
    // Along the groove both have the window's whole integral: sqrt(2 pi) sigma.
    let along = (2.0 * PI).sqrt() * sigma_um;
    let wavelength_um = nm * 1e-3;
    sum * wavelength_um.powi(2) / (along * along * PI.sqrt() * sigma_um * width_um * width_um)
}

/// The density per u/lambda is that of the full wave, for each section, under a window sixteen times as wide as the groove.
#[test]
fn narrow_grooves_send_what_the_full_wave_does() {
    for section in &SECTIONS {
        let grid = GrooveSpectrum::new(&GrooveShape {
            section: section.clone(),
            width_class: 0,
        });
        for depth_nm in [60.0, 200.0, 700.0] {
            let width_um = 2.0;
            let pairs = (0..12).map(|i| {
                let q = 0.02 + 0.08 * f64::from(i);
                let value = grid.at_depth(depth_nm / 550.0).look_up(width_um * q / 0.55)[0];
                (
                    value,
                    full_wave(section, width_um, depth_nm, q, 32.0, false),
                )
            });
            let error = relative_rms(pairs);
            println!(
                "{section:?}, {depth_nm} nm: {:.3} % of the full wave",
                100.0 * error
            );
            assert!(error < 5e-3, "{section:?} {depth_nm}: {error}");
        }
    }
}

/// The classes' own ratios of width to window, against the full wave in all places.
#[test]
fn wide_grooves_send_what_the_full_wave_does() {
    for section in &SECTIONS {
        for (class, (_, windows)) in (1..).zip(CLASSES) {
            let shape = GrooveShape {
                section: section.clone(),
                width_class: class,
            };
            let grid = GrooveSpectrum::new(&shape);
            let sigma_um = 12.0;
            let (width_um, depth_nm) = (windows * sigma_um, 180.0);
            let pairs = (0..15).map(|i| {
                let q = 0.001 + 0.0028 * f64::from(i);
                let value = grid.at_depth(depth_nm / 550.0).look_up(width_um * q / 0.55)[0];
                (
                    value,
                    full_wave(section, width_um, depth_nm, q, sigma_um, true),
                )
            });
            let error = relative_rms(pairs);
            println!(
                "{section:?}, {windows} windows wide: {:.3} % of the full wave",
                100.0 * error
            );
            assert!(error < 1e-2, "{section:?} {windows}: {error}");
        }
    }
}

#[test]
fn a_rectangle_is_a_slit() {
    let grid = GrooveSpectrum::new(&GrooveShape::default());
    let row = grid.at_depth(0.3);
    let energy = 4.0 * (2.0 * PI * 0.3f64).sin().powi(2);
    let pairs = (0..900).map(|i| {
        let u = 0.0211 * f64::from(i);
        (row.look_up(u)[0], energy * sinc(PI * u).powi(2))
    });
    assert!(relative_rms(pairs) < 1e-3);
    let all = [0.4, 3.0, 50.0, 200.0].map(|u| {
        let exact = energy * crate::diffraction::sinc_squared_integral(u, 1.0);
        (row.look_up(u)[1], exact)
    });
    assert!(relative_rms(all) < 1e-3);
}

/// What a wide groove scatters is what the mirror's direction is short of: the mean of 2 Re t - |t|².
#[test]
fn wide_grooves_keep_the_energy() {
    for section in &SECTIONS {
        for (class, (_, windows)) in (1..).zip(CLASSES) {
            let grid = GrooveSpectrum::new(&GrooveShape {
                section: section.clone(),
                width_class: class,
            });
            let row = grid.at_depth(180.0 / 550.0);
            let sigma_um = 12.0;
            let width_um = windows * sigma_um;
            let step_um = 0.05 * sigma_um;
            let reach = ((0.5 * width_um + 5.0 * sigma_um) / step_um).ceil() as i64;
            let lost: f64 = (-reach..=reach)
                .map(|i| {
                    let pieces = strips(section, width_um, 180.0, step_um * i as f64);
                    let taken: Complex64 = pieces
                        .iter()
                        .map(|p| p.phase_step(2.0, 550.0) * groove_overlap(p, sigma_um))
                        .sum();
                    step_um * (2.0 * taken.re - taken.norm_sqr())
                })
                .sum();
            let sent = 2.0 * row.limit;
            assert!(
                (sent / (lost / width_um) - 1.0).abs() < 2e-3,
                "{section:?} {windows}: {sent} {lost}"
            );
            // All of it lies within the grid's columns and their tail.
            assert!((row.look_up(1e9)[1] / row.limit - 1.0).abs() < 1e-6);
            assert!(row.look_up(END)[1] <= row.limit * (1.0 + 1e-3));
        }
    }
}

/// The table of a section is the integral of its density, wavelength by wavelength.
#[test]
fn the_table_of_a_section_is_its_integral() {
    for section in &SECTIONS[1..] {
        let shape = GrooveShape {
            section: section.clone(),
            width_class: 0,
        };
        let table = ScratchTable::of_shape(&shape, |_| 1.0);
        let grid = GrooveSpectrum::new(&shape);
        let pairs = (0..200).flat_map(|i| {
            let u = 8.0 * (0.618_033_988_749_895 * f64::from(i)).fract();
            let depth = 1000.0 * (0.414_213_562_373_095 * f64::from(i)).fract();
            let [a, b] = [u, u + 0.05].map(|u| table.scratch_table(u, depth));
            let mut right = [0.0; 3];
            for sample in spectrum::samples() {
                let row = grid.at_depth(depth / sample.wavelength_nm);
                let [low, high] =
                    [u, u + 0.05].map(|u| row.look_up(u * 1e3 / sample.wavelength_nm)[1]);
                right = std::array::from_fn(|c| right[c] + sample.weight[c] * (high - low));
            }
            std::array::from_fn::<_, 3, _>(|c| (b[c] - a[c], right[c]))
        });
        let error = relative_rms(pairs);
        println!("{section:?}: table {:.3} % off", 100.0 * error);
        assert!(error < 1e-2, "{section:?}: {error}");
    }
}
