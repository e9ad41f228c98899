//! The full-wave field against a Fourier transform of a rasterised surface, and its properties for any input.

mod energy;
mod far_field;
mod fast;
mod fringes;
mod height_field;
mod limits;

use glam::DVec2;
use hairline_optics::coherent::GroovePiece;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

/// A straight groove on the surface, from one end of its middle line to the other, in micrometres.
#[derive(Clone, Copy, Debug)]
struct Groove {
    from: DVec2,
    to: DVec2,
    width_um: f64,
    depth_nm: f64,
}

impl Groove {
    /// The groove in coordinates relative to `point`.
    fn seen_from(&self, point: DVec2) -> GroovePiece {
        let tangent = (self.to - self.from).normalize();
        GroovePiece {
            tangent,
            offset_um: (self.from - point).dot(tangent.perp()),
            start_um: (self.from - point).dot(tangent),
            end_um: (self.to - point).dot(tangent),
            width_um: self.width_um,
            depth_nm: self.depth_nm,
        }
    }
}

fn pieces(grooves: &[Groove]) -> Vec<GroovePiece> {
    grooves.iter().map(|g| g.seen_from(DVec2::ZERO)).collect()
}

/// Grooves with middles, directions and lengths at random: middles in a square, widths of 0.6 to 2 um, depths of 50 to
/// 300 nm.
fn random_grooves(
    count: usize,
    half_side_um: f64,
    lengths_um: std::ops::Range<f64>,
    seed: u64,
) -> Vec<Groove> {
    let mut random = Pcg64::seed_from_u64(seed);
    (0..count)
        .map(|_| {
            let middle = half_side_um
                * DVec2::new(
                    random.random_range(-1.0..1.0),
                    random.random_range(-1.0..1.0),
                );
            let half = 0.5
                * random.random_range(lengths_um.clone())
                * DVec2::from_angle(random.random_range(0.0..PI));
            Groove {
                from: middle - half,
                to: middle + half,
                width_um: random.random_range(0.6..2.0),
                depth_nm: random.random_range(50.0..300.0),
            }
        })
        .collect()
}
