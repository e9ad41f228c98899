//! Two parallel grooves are two slits.

use glam::DVec2;
use hairline_optics::coherent::{GroovePiece, coherent_response};

const WAVELENGTH_NM: f64 = 550.0;
const COHERENCE_UM: f64 = 20.0;

fn groove(offset_um: f64) -> GroovePiece {
    GroovePiece {
        tangent: DVec2::X,
        offset_um,
        start_um: f64::NEG_INFINITY,
        end_um: f64::INFINITY,
        width_um: 0.2,
        depth_nm: 120.0,
    }
}

/// Computes the light that the grooves scatter from the angle `incident_rad` to a viewer at `viewer_rad`, both in the
/// plane across them.
fn scattered(grooves: &[GroovePiece], incident_rad: f64, viewer_rad: f64) -> f64 {
    let xi = DVec2::new(0.0, incident_rad.sin() + viewer_rad.sin());
    let cos_sum = incident_rad.cos() + viewer_rad.cos();
    coherent_response(grooves, xi, cos_sum, COHERENCE_UM, WAVELENGTH_NM, false).scratches
}

/// Finds the maximum of `f` between two places by golden section.
fn maximum(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    while high - low > 1e-9 {
        let (a, b) = (high - golden * (high - low), low + golden * (high - low));
        if f(a) > f(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}

/// Angles of the extrema of `f` over the hemisphere.
fn maxima(f: impl Fn(f64) -> f64) -> Vec<f64> {
    let angle = |i: i32| (i as f64 / 4000.0).asin();
    (-3799..3800)
        .filter(|&i| f(angle(i)) >= f(angle(i - 1)) && f(angle(i)) > f(angle(i + 1)))
        .map(|i| maximum(&f, angle(i - 1), angle(i + 1)))
        .collect()
}

/// Bright where a (sin theta_i + sin theta_o) = m lambda, dark halfway.
#[test]
fn fringes_lie_at_the_angles_of_two_slits() {
    for apart_um in [4.0, 10.0, 25.0] {
        let pair = [groove(-0.5 * apart_um), groove(0.5 * apart_um)];
        let spacing = WAVELENGTH_NM * 1e-3 / apart_um;
        for viewer_rad in [0.0, 0.6] {
            let f = |angle: f64| scattered(&pair, angle, viewer_rad);
            let check = |angles: &[f64], shift: f64| {
                let mut worst = 0.0_f64;
                let mut orders = Vec::new();
                for angle in angles {
                    let order = (angle.sin() + f64::sin(viewer_rad)) / spacing - shift;
                    worst = worst.max((order - order.round()).abs());
                    orders.push(order.round() as i64);
                }
                assert!(orders.windows(2).all(|o| o[1] == o[0] + 1), "{orders:?}");
                (orders.len(), worst)
            };
            let (bright, off_bright) = check(&maxima(f), 0.0);
            let (dark, off_dark) = check(&maxima(|angle| -f(angle)), 0.5);
            println!(
                "{apart_um} um apart, seen at {viewer_rad} rad: {bright} bright fringes within {off_bright:.1e} of \
                 their spacing, {dark} dark ones within {off_dark:.1e}"
            );
            // No fringe is missing: the hemisphere, cut at 0.95, spans 1.9/spacing.
            assert!((bright as f64 - 1.9 / spacing).abs() <= 1.0, "{bright}");
            // sinc^2 and |D|^2 fall towards grazing angles, which pulls the maxima inwards by spacing/(2 pi^2) of their
            // logarithm's slope, 5 at most here. The zeros stay, but for the window's fall across a groove, which moves
            // it by p W^2/(12 sigma^2) = 1e-4 um at p = 12.5 um.
            assert!(
                off_bright < 0.3 * spacing && off_dark < 1e-3,
                "{off_bright} {off_dark}"
            );
        }
    }
}

/// At a point whose window sees one groove less, the fringes do not reach zero: contrast 2ab/(a^2 + b^2) of amplitudes a,
/// b.
#[test]
fn contrast_is_that_of_the_amplitudes() {
    let apart_um = 10.0;
    for shift_um in [0.0, 5.0, 20.0] {
        let pair = [
            groove(shift_um - 0.5 * apart_um),
            groove(shift_um + 0.5 * apart_um),
        ];
        // One fringe near the mirror direction, where a groove alone is even.
        let values: Vec<f64> = (0..1000)
            .map(|i| scattered(&pair, (0.055 * (0.5 + i as f64 / 1000.0)).asin(), 0.0))
            .collect();
        let (low, high) = values
            .iter()
            .fold((f64::INFINITY, 0.0_f64), |(l, h), &v| (l.min(v), h.max(v)));
        let contrast = (high - low) / (high + low);
        let ratio = (2.0 * apart_um * shift_um / (2.0 * COHERENCE_UM * COHERENCE_UM)).exp();
        let expected = 2.0 * ratio / (1.0 + ratio * ratio);
        println!(
            "window {shift_um} um beside the middle: contrast {contrast:.4}, expected {expected:.4}"
        );
        assert!((contrast - expected).abs() < 2e-3, "{contrast} {expected}");
    }
}

/// The comparison sees a pair whose distance is 2 % off.
#[test]
fn a_wrong_distance_is_seen() {
    let pair = [groove(-5.1), groove(5.1)];
    let spacing = WAVELENGTH_NM * 1e-3 / 10.0;
    let off = maxima(|angle| scattered(&pair, angle, 0.0))
        .iter()
        .map(|angle| (angle.sin() / spacing - (angle.sin() / spacing).round()).abs())
        .fold(0.0, f64::max);
    assert!(off > 0.2, "{off}");
}
