//! One scratch: a rectangular groove of width W and depth d under a Gaussian coherence window
//! (docs/model.md, section 2; Werner, Velinov, Jakob, Hullin, *Scratch Iridescence*, 2017).

use crate::footprint::ScratchShare;
use spec_math::cephes64::erf;
use std::f64::consts::PI;

/// Depth of the deepest groove. Tables end there and hold deeper ones; their colours have washed out to straw long before.
pub const DEPTH_MAX_NM: f64 = 2000.0;

/// |D|^2 = 4 sin^2(2 pi d / lambda): the energy of the phase step at the groove's floor. `depth_nm` is the groove's depth for
/// light along the normal, else [`oblique_depth_nm`].
pub fn phase_step_energy(depth_nm: f64, wavelength_nm: f64) -> f64 {
    let s = (2.0 * PI * depth_nm / wavelength_nm).sin();
    4.0 * s * s
}

/// The depth whose phase step along the normal, 2 k d, equals k d (cos_i + cos_o): the path down into a groove and up again is
/// shorter the lower light and viewer stand.
pub fn oblique_depth_nm(depth_nm: f64, cos_i: f64, cos_o: f64) -> f64 {
    0.5 * depth_nm * (cos_i + cos_o)
}

/// |eta_s|^2 in um^2: how strongly the window at a point sees the groove. `offset_um` is the distance p_n of the point
/// from the groove's line, `start_um` and `end_um` the groove's ends measured along it from the point.
pub fn window_overlap_um2(offset_um: f64, start_um: f64, end_um: f64, coherence_um: f64) -> f64 {
    let s = coherence_um;
    let root2_s = std::f64::consts::SQRT_2 * s;
    let e = 0.5 * (erf(end_um / root2_s) - erf(start_um / root2_s));
    2.0 * PI * s * s * (-offset_um * offset_um / (s * s)).exp() * e * e
}

/// rho: the share of the coherence window's energy that the groove covers, W |eta_s|^2 / (2 pi^1.5 sigma^3).
/// A groove radiates |D|^2 rho of the energy that falls on it, and the specular peak loses as much.
pub fn window_share(width_um: f64, overlap_um2: f64, coherence_um: f64) -> f64 {
    width_um * overlap_um2 / (2.0 * PI.powf(1.5) * coherence_um.powi(3))
}

/// (6) with (4) at a point, for a piece of a scratch that reaches from `piece_um[0]` to `piece_um[1]` along its line, and whose whole reaches
/// from `whole_um[0]` to `whole_um[1]`.
///
/// E of the whole scratch is the sum over its pieces, and E^2 the sum of products: a piece's part is its own E times the
/// whole one's. So the shares of the pieces of one scratch add up to the scratch's, and no joint shows.
pub fn piece_share(
    width_um: f64,
    offset_um: f64,
    piece_um: [f64; 2],
    whole_um: [f64; 2],
    coherence_um: f64,
) -> ScratchShare {
    let e = |[from_um, to_um]: [f64; 2]| {
        let unit = 1.0 / (std::f64::consts::SQRT_2 * coherence_um);
        0.5 * (erf(to_um * unit) - erf(from_um * unit))
    };
    let p = offset_um / coherence_um;
    let line = width_um / (PI.sqrt() * coherence_um) * (-p * p).exp();
    ScratchShare {
        segment: line * e(piece_um) * e(whole_um),
        line,
        cover: 1.0,
    }
}

/// Standard deviation, in direction cosines along the scratch, of the band that it lights: 1/(sqrt(2) k sigma).
pub fn band_std(coherence_um: f64, wavelength_nm: f64) -> f64 {
    wavelength_nm * 1e-3 / (2.0 * std::f64::consts::SQRT_2 * PI * coherence_um)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diffraction::sinc;

    /// Energy of one scratch, by quadrature of |S|^2/(pi sigma^2) over direction cosines with section 2's separable S.
    #[test]
    fn one_scratch_radiates_its_share() {
        let (sigma, wavelength_um) = (20.0, 0.55);
        for (width, depth_nm, offset) in [(1.5, 150.0, 0.0), (3.0, 80.0, 12.0), (6.0, 400.0, 30.0)]
        {
            let k = 2.0 * PI / wavelength_um;
            let energy_d = phase_step_energy(depth_nm, 550.0);
            let overlap = window_overlap_um2(offset, f64::NEG_INFINITY, f64::INFINITY, sigma);
            // Trapezoid over xi_t (a Gaussian) and over xi_n (sinc^2, far out: its tail beyond Q holds 1/(pi^2 W Q/lambda)).
            let (ht, hn, range_n) = (2e-4, 1e-3, 400.0);
            let along: f64 = (-200..=200)
                .map(|i| (-(k * sigma * ht * i as f64).powi(2)).exp() * ht)
                .sum();
            let count = (range_n / hn) as i64;
            let across: f64 = (-count..=count)
                .map(|i| sinc(k * width * hn * i as f64 / 2.0).powi(2) * hn)
                .sum();
            let radiated = energy_d * (width / wavelength_um).powi(2) * overlap * along * across
                / (PI * sigma * sigma);
            let expected = energy_d * width / (PI.sqrt() * sigma)
                * (-(offset * offset) / (sigma * sigma)).exp();
            // The cut tail holds lambda/(pi^2 W Q) of the energy: 1e-4 at most.
            assert!(
                (radiated / expected - 1.0).abs() < 2e-4,
                "{radiated} {expected}"
            );
            let share = window_share(width, overlap, sigma);
            assert!((energy_d * share / expected - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_pieces_of_a_scratch_share_what_the_whole_has() {
        let (sigma, whole) = (20.0, [-31.0, 17.0]);
        let cuts = [-31.0, -12.0, -3.0, 8.0, 17.0];
        let sum: f64 = cuts
            .windows(2)
            .map(|c| piece_share(2.0, 9.0, [c[0], c[1]], whole, sigma).segment)
            .sum();
        let overlap = window_overlap_um2(9.0, whole[0], whole[1], sigma);
        let right = window_share(2.0, overlap, sigma);
        assert!((sum / right - 1.0).abs() < 1e-12, "{sum} {right}");
    }

    #[test]
    fn a_groove_of_no_depth_or_half_a_wave_is_dark() {
        assert_eq!(phase_step_energy(0.0, 500.0), 0.0);
        assert!(phase_step_energy(250.0, 500.0) < 1e-20);
        assert!((phase_step_energy(125.0, 500.0) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn two_halves_meet_in_the_middle_as_amplitudes() {
        let half = window_overlap_um2(3.0, 0.0, f64::INFINITY, 20.0);
        let whole = window_overlap_um2(3.0, f64::NEG_INFINITY, f64::INFINITY, 20.0);
        assert!((4.0 * half / whole - 1.0).abs() < 1e-12);
    }
}
