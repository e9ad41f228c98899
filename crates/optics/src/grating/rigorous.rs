//! A row of grooves too fine for the scalar theory: its orders by their rigorous efficiencies.

use super::Grating;
use crate::cover::Cover;
use crate::rigorous::{Efficiencies, Medium};
use crate::spectrum::Observer;

/// A row of grooves with its rigorous efficiencies, in a material.
#[derive(Clone, Copy, Debug)]
pub struct RigorousGrating<'a> {
    /// The grooves.
    pub row: Grating,
    /// Their efficiencies, without what displaces them or spreads their depths.
    pub efficiencies: &'a Efficiencies,
    /// What the channels are.
    pub observer: &'a Observer,
    /// Material whose efficiencies they are.
    pub medium: &'a Medium,
    /// Whether the grooves are in a material of another colour, which its shading brings.
    pub is_colored: bool,
    /// A plate over the grooves, of the index that the efficiencies have above them.
    pub cover: Option<Cover>,
}

impl RigorousGrating<'_> {
    fn index_above(&self) -> f64 {
        self.cover.map_or(1.0, |cover| cover.ior)
    }

    pub(super) fn flat(&self, cos_o: f64, nm: f64) -> f64 {
        self.medium.reflectance(self.index_above(), cos_o, nm)
    }

    /// The part of the light in the mirror's direction of a flat surface that its outer face does not send.
    pub fn by_grooves(&self, cos_o: f64) -> [f64; 3] {
        match (self.cover, self.medium) {
            (Some(cover), Medium::Metal(metal)) => {
                let all = cover.reflectance_seen_by(self.observer, metal, cos_o);
                cover.part_below(all, cos_o)
            }
            _ => [1.0; 3],
        }
    }

    /// Light from one angle that gets through a cover, over light from the viewer's.
    pub fn passed(&self, cos_i: f64, cos_o: f64) -> [f64; 3] {
        self.cover.map_or([1.0; 3], |cover| {
            let (to, from) = (cover.passed(cos_o), cover.passed(cos_i));
            std::array::from_fn(|c| if to[c] > 0.0 { from[c] / to[c] } else { 0.0 })
        })
    }

    /// The light that an order sends to a viewer, over that of a flat surface of the same material. Spread depths weaken the orders as in (43).
    pub fn energy(&self, order: i32, nm: f64, [across, along]: [f64; 2], depth_share: f64) -> f64 {
        let cos_o = (1.0 - across * across - along * along).max(0.0).sqrt();
        let flat = self.flat(cos_o, nm);
        let sent = self.efficiencies.efficiency(order, nm, -across, along) / flat;
        // Waves are shorter in a cover.
        let spread = self
            .row
            .kept_by_spread(self.index_above() * depth_share, nm);
        let fill = self.row.fill();
        let lost = 1.0 - spread;
        if order == 0 {
            let floor = 1.0 - fill;
            return spread * sent + lost * (floor * floor - fill * fill * spread);
        }
        spread * self.row.order_kept(order) * sent + lost * lost * self.row.order_weight(order)
    }

    /// As [`Grating::density`], to a viewer; what a cover takes of it is left out.
    pub fn density(
        &self,
        q: f64,
        viewer: [f64; 2],
        depth_share: f64,
        nm: f64,
        band_std: f64,
    ) -> f64 {
        let orders = self.row.orders_about(q, nm, band_std);
        let peaks = orders.map(|(order, peak)| self.energy(order, nm, viewer, depth_share) * peak);
        peaks.sum::<f64>() + self.rest_density(q, viewer, depth_share, nm)
    }

    /// The light that grooves send each for itself, as [`Self::density`].
    pub(crate) fn rest_density(&self, q: f64, viewer: [f64; 2], depth_share: f64, nm: f64) -> f64 {
        match self.row.rest_density(q, depth_share, nm) {
            0.0 => 0.0,
            rest => self.rest_scale(nm, viewer) * rest,
        }
    }

    /// Ratio of the light of rigorous orders to that of scalar ones: what displaced grooves take of them, they send elsewhere.
    pub(super) fn rest_scale(&self, nm: f64, [across, along]: [f64; 2]) -> f64 {
        let cos_o = cos_of([across, along]);
        let flat = self.flat(cos_o, nm);
        let most = (2.0 / self.row.order_q(1, nm)) as i32;
        let (mut rigorous, mut scalar) = (0.0, 0.0);
        for order in (-most..=most).filter(|order| *order != 0) {
            let cos_i = cos_of([self.row.order_q(order, nm) - across, along]);
            if cos_i > 0.0 {
                rigorous += self.efficiencies.efficiency(order, nm, -across, along) / flat;
                let bare = Grating {
                    jitter_um: 0.0,
                    depth_spread: 0.0,
                    ..self.row
                };
                scalar += bare.order_energy(order, 0.5 * (cos_i + cos_o), nm);
            }
        }
        if scalar > 0.0 {
            (rigorous / scalar).min(4.0)
        } else {
            0.0
        }
    }
}

/// Cosine to the normal of a direction by its components across and along the grooves.
pub(super) fn cos_of([across, along]: [f64; 2]) -> f64 {
    let left = 1.0 - along * along;
    (left - across * across).max(0.0).sqrt()
}
