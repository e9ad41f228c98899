//! Light off the whole field in the coherence window, |B - S|^2 with every phase (docs/model.md, (1) and section 9).
//!
//! Directions are drawn by a mixture: the base's peak, each groove's band, and whatever else is lit, so that no direction that
//! the field sends light to is left out, and the estimate divides by the mixture's density.

use super::gratings::RowView;
use super::grooves::GrooveView;
use super::interval::{CutCauchy, CutNormal};
use super::separable::direction_from_cosines;
use super::wavelengths::{SpectralFresnel, Spectrum, WAVELENGTHS, WIDEST_NM, Wavelengths};
use glam::{DVec2, DVec3};
use hairline_cpu::surface::SurfacePoint;
use hairline_optics::band::BandFrame;
use hairline_optics::coherent::{GrooveField, base_amplitude, groove_overlap};
use hairline_optics::grating::RigorousGrating;
use hairline_optics::scratch::band_std;
use num_complex::Complex64;
use std::f64::consts::PI;

/// The field at a point.
pub(super) struct Field<'a> {
    pub point: &'a SurfacePoint<'a>,
    pub grooves: &'a [GrooveView],
    field: GrooveField,
    /// Whether the base is one mirror: else its phases are random, and it does not interfere.
    pub smooth: bool,
    wavelengths: &'a Wavelengths,
    fresnel: &'a SpectralFresnel<'a>,
    /// 1 - <r>: the part of the base's peak that grooves take from its amplitude, at each wavelength.
    taken: Spectrum<Complex64>,
    /// The fine grating that the grooves are those of.
    rigorous: Option<RigorousField<'a>>,
}

/// Factors that give the field of rectangular grooves, which keeps all phases, the energy of rigorous orders. Directions between two orders have
/// those of the nearer one. Scratches that lie on such a grating take part in them.
struct RigorousField<'a> {
    of: RigorousGrating<'a>,
    frame: BandFrame,
    /// `wo` in the frame of the grooves.
    wo: DVec3,
    /// The part of the light that no outer face of a plate sends.
    by_grooves: f64,
    /// Factor of order 0, for each wavelength.
    mirror: Spectrum<Complex64>,
}

/// Largest factor on the energy of an order. Rectangular grooves send none to some orders, in which walls send a little.
const MOST_FACTOR: f64 = 100.0;

impl<'a> RigorousField<'a> {
    /// Puts the rigorous part of the base's peak into `taken`.
    fn new(
        row: &RowView<'a>,
        wavelengths: &Wavelengths,
        taken: &mut Spectrum<Complex64>,
    ) -> Option<Self> {
        let of = row.rigorous?;
        let viewer = [row.wo.y, row.wo.x];
        // One channel stands for all: plates have little colour.
        let by_grooves = of.by_grooves(row.wo.z)[1];
        let mut mirror = [Complex64::ONE; WAVELENGTHS];
        for (j, mirror) in mirror.iter_mut().enumerate() {
            let sent = of.energy(0, wavelengths.nm[j], viewer, row.wo.z);
            let kept = (1.0 - by_grooves * (1.0 - sent)).max(0.0).sqrt();
            let before = taken[j];
            taken[j] = 1.0 - Complex64::from_polar(kept, (1.0 - before).arg());
            if before.norm_sqr() > 1e-12 {
                *mirror = taken[j] / before;
            }
        }
        Some(Self {
            of,
            frame: row.frame,
            wo: row.wo,
            by_grooves,
            mirror,
        })
    }

    fn factor(&self, wi: DVec3, j: usize, nm: f64) -> Complex64 {
        let wi = self.frame.band_from_surface(wi);
        let row = &self.of.row;
        let order = ((wi.y + self.wo.y) / row.order_q(1, nm)).round() as i32;
        if order == 0 {
            return self.mirror[j];
        }
        let depth_share = 0.5 * (wi.z + self.wo.z);
        let rigorous = (self.of).energy(order, nm, [self.wo.y, self.wo.x], depth_share);
        let rigorous = self.by_grooves * self.of.passed(wi.z, self.wo.z)[1] * rigorous;
        // Efficiencies are over the reflectance at the viewer's angle; the field's weight has both.
        let above = self.of.cover.map_or(1.0, |cover| cover.ior);
        let [to, from] = [self.wo.z, wi.z].map(|cos| self.of.medium.reflectance(above, cos, nm));
        let scalar = row.order_energy(order, depth_share, nm) * (from / to).sqrt();
        (rigorous.max(0.0) / scalar.max(1e-9))
            .min(MOST_FACTOR)
            .sqrt()
            .into()
    }
}

/// The BRDF times the light's cosine, per d xi, by layer. With r what the base's amplitude keeps and S' = S - (1 - r) B, which
/// is S without what it has of the base's own peak, B - S = r B - S'; and r B and S' share no energy over all directions.
pub(super) struct FieldResponse {
    /// |r B|^2 - 2 Re(r B S'*); zero for a rough base, whose lobe stands for it.
    pub base: DVec3,
    /// |S'|^2.
    pub scratches: DVec3,
}

impl FieldResponse {
    /// Adds light that comes from a direction of some density, by the response to it.
    pub(super) fn add(&mut self, light: DVec3, response: &Self, pdf: f64) {
        self.base += light * response.base / pdf;
        self.scratches += light * response.scratches / pdf;
    }
}

impl<'a> Field<'a> {
    pub(crate) fn new(
        point: &'a SurfacePoint<'a>,
        grooves: &'a [GrooveView],
        row: Option<&RowView<'a>>,
        smooth: bool,
        wavelengths: &'a Wavelengths,
        fresnel: &'a SpectralFresnel<'a>,
    ) -> Self {
        let mut taken = taken_amplitude(point, grooves, wavelengths);
        Self {
            rigorous: row.and_then(|row| RigorousField::new(row, wavelengths, &mut taken)),
            point,
            grooves,
            field: GrooveField::new(
                grooves.iter().flat_map(GrooveView::strips).collect(),
                point.coherence_um,
            ),
            smooth,
            wavelengths,
            fresnel,
            taken,
        }
    }

    /// Share of the energy of the base's reflection that the grooves take: 1 - |r|^2.
    pub(crate) fn taken(&self) -> DVec3 {
        let shape = self.fresnel.shape(self.wavelengths);
        (0..WAVELENGTHS)
            .map(|j| shape[j] * (1.0 - (1.0 - self.taken[j]).norm_sqr()))
            .sum()
    }

    /// Whether there is anything to evaluate.
    pub(crate) fn is_empty(&self) -> bool {
        !self.smooth && self.grooves.is_empty()
    }

    /// Evaluates the response in a direction of the surface's frame.
    pub(crate) fn eval(&self, wi: DVec3) -> FieldResponse {
        let wo = self.point.wo;
        let xi = wi.truncate() + wo.truncate();
        let weights = self.fresnel.coherent(self.wavelengths, wi.z);
        let mut sum = FieldResponse {
            base: DVec3::ZERO,
            scratches: DVec3::ZERO,
        };
        let mut amplitudes = [Complex64::ZERO; WAVELENGTHS];
        let nm = &self.wavelengths.nm;
        self.field.amplitudes(xi, wi.z + wo.z, nm, &mut amplitudes);
        if let Some(rigorous) = &self.rigorous {
            for (j, amplitude) in amplitudes.iter_mut().enumerate() {
                *amplitude *= rigorous.factor(wi, j, nm[j]);
            }
        }
        let sigma_um = self.point.coherence_um;
        let per_area = 1.0 / (PI * sigma_um * sigma_um);
        for j in 0..WAVELENGTHS {
            let base = base_amplitude(xi, sigma_um, nm[j]);
            let scratches = amplitudes[j] - self.taken[j] * base;
            sum.scratches += weights[j] * (per_area * scratches.norm_sqr());
            if self.smooth {
                let kept = (1.0 - self.taken[j]) * base;
                let cross = (kept * scratches.conj()).re;
                sum.base += weights[j] * (per_area * (kept.norm_sqr() - 2.0 * cross));
            }
        }
        sum
    }

    /// Distribution of directions whose components along axes of the surface's frame lie within the ranges of `extent`.
    pub(crate) fn directions(&self, extent: impl Fn(DVec2) -> (f64, f64)) -> FieldDirections {
        let wo = self.point.wo;
        let std = band_std(self.point.coherence_um, WIDEST_NM);
        let mut components = Vec::with_capacity(self.grooves.len() + 1);
        if self.smooth {
            let (x, y) = (extent(DVec2::X), extent(DVec2::Y));
            let x = CutNormal::new(std, wo.x + x.0, wo.x + x.1);
            let y = CutNormal::new(std, wo.y + y.0, wo.y + y.1);
            if let (Some(x), Some(y)) = (x, y) {
                components.push((PEAK_WEIGHT, Component::Peak { x, y }));
            }
        }
        let all: f64 = self.grooves.iter().map(|g| g.share.segment).sum();
        for groove in self.grooves {
            let share = groove.share.segment / all.max(1e-30);
            if share > NEGLIGIBLE_SHARE
                && let Some(band) = Band::new(groove, (std, self.point.coherence_um), &extent)
            {
                components.push((share, Component::Band(band)));
            }
        }
        let total: f64 = components.iter().map(|c| c.0).sum();
        let drawn = if components.is_empty() {
            0.0
        } else {
            1.0 - ELSEWHERE
        };
        for component in &mut components {
            component.0 *= drawn / total;
        }
        FieldDirections {
            wo: wo.truncate(),
            components,
            elsewhere: 1.0 - drawn,
        }
    }
}

/// The sum of D times the share of each groove, in the mirror's direction. Grooves that cross share floor: at random places each leaves its share
/// of what the others leave. Those of a grating do not cross.
fn taken_amplitude(
    point: &SurfacePoint,
    grooves: &[GrooveView],
    wavelengths: &Wavelengths,
) -> Spectrum<Complex64> {
    let (mut all, mut free) = (0.0, 1.0);
    for groove in grooves.iter().filter(|g| !g.is_in_row) {
        let share = groove_overlap(&groove.piece, point.coherence_um);
        all += share;
        free *= 1.0 - share;
    }
    let apart = if all > 0.0 { (1.0 - free) / all } else { 1.0 };
    let mut taken = [Complex64::ZERO; WAVELENGTHS];
    for groove in grooves {
        let apart = if groove.is_in_row { 1.0 } else { apart };
        for strip in groove.strips() {
            let share = apart * groove_overlap(&strip, point.coherence_um);
            for (taken, nm) in taken.iter_mut().zip(wavelengths.nm) {
                *taken += share * strip.phase_step(2.0 * point.wo.z, nm);
            }
        }
    }
    taken
}

/// The peak's weight in the mixture, where all grooves together have 1.
const PEAK_WEIGHT: f64 = 1.0;
/// Grooves with less than this part of all share get no directions of their own.
const NEGLIGIBLE_SHARE: f64 = 1e-3;
/// The part of the directions that the caller draws in its own way, over all that is lit. The ends of grooves scatter off
/// their bands too.
const ELSEWHERE: f64 = 0.15;
/// The part of a band's directions that are spread as the light of an end is, by 1/xi_t^2.
const BAND_TAIL: f64 = 0.25;

/// A mixture of directions; densities are per d xi.
pub(super) struct FieldDirections {
    wo: DVec2,
    components: Vec<(f64, Component)>,
    /// The probability that the caller is to draw.
    pub elsewhere: f64,
}

enum Component {
    Peak { x: CutNormal, y: CutNormal },
    Band(Band),
}

struct Band {
    frame: BandFrame,
    core: Option<CutNormal>,
    tail: CutCauchy,
    across: CutCauchy,
}

impl Band {
    fn new(
        groove: &GrooveView,
        (std, sigma_um): (f64, f64),
        extent: impl Fn(DVec2) -> (f64, f64),
    ) -> Option<Self> {
        let tangent = groove.frame.tangent;
        let (along, across) = (extent(tangent), extent(tangent.perp()));
        let (low, high) = (groove.wo.x + along.0, groove.wo.x + along.1);
        let scale = groove.drawn_um(sigma_um) / groove.lit_um;
        Some(Self {
            frame: groove.frame,
            core: CutNormal::new(std, low, high),
            tail: CutCauchy::new(2.0 * std, low, high)?,
            across: CutCauchy::new(scale, groove.wo.y + across.0, groove.wo.y + across.1)?,
        })
    }

    fn tail_part(&self) -> f64 {
        if self.core.is_some() { BAND_TAIL } else { 1.0 }
    }

    fn sample(&self, pick: f64, u: f64, v: f64) -> DVec2 {
        let along = match &self.core {
            Some(core) if pick >= BAND_TAIL => core.sample(u),
            _ => self.tail.sample(u),
        };
        let xi = DVec3::new(along, self.across.sample(v), 0.0);
        self.frame.surface_from_band(xi).truncate()
    }

    fn pdf(&self, xi: DVec2) -> f64 {
        let xi = self.frame.band_from_surface(xi.extend(0.0));
        let tail = self.tail_part();
        let core = self.core.as_ref().map_or(0.0, |core| core.pdf(xi.x));
        (tail * self.tail.pdf(xi.x) + (1.0 - tail) * core) * self.across.pdf(xi.y)
    }
}

/// Result of [`FieldDirections::sample`].
pub(super) enum DrawnDirection {
    /// A direction of the surface's frame; None if it lies below the horizon.
    Direction(Option<DVec3>),
    /// The caller is to draw; the number is left over from the choice, even in [0, 1).
    Elsewhere(f64),
}

impl FieldDirections {
    pub(crate) fn sample(&self, pick: f64, u: f64, v: f64) -> DrawnDirection {
        let mut left = pick;
        for (weight, component) in &self.components {
            if left < *weight {
                let pick = left / weight;
                let xi = match component {
                    Component::Peak { x, y } => DVec2::new(x.sample(u), y.sample(v)),
                    Component::Band(band) => band.sample(pick, u, v),
                };
                let wi = xi - self.wo;
                return DrawnDirection::Direction(direction_from_cosines(wi.x, wi.y));
            }
            left -= weight;
        }
        if self.elsewhere > 0.0 {
            DrawnDirection::Elsewhere((left / self.elsewhere).clamp(0.0, 1.0))
        } else {
            DrawnDirection::Direction(None)
        }
    }

    /// Density of a direction, where the caller's own has the density `elsewhere_pdf`, both per d xi.
    pub(crate) fn pdf(&self, wi: DVec3, elsewhere_pdf: f64) -> f64 {
        let xi = wi.truncate() + self.wo;
        let own: f64 = self
            .components
            .iter()
            .map(|(weight, component)| {
                weight
                    * match component {
                        Component::Peak { x, y } => x.pdf(xi.x) * y.pdf(xi.y),
                        Component::Band(band) => band.pdf(xi),
                    }
            })
            .sum();
        own + self.elsewhere * elsewhere_pdf
    }
}
