//! One floor where grooves cross: the deeper groove's. The part of the shallower one that lies in it is found once for a
//! point, and taken off again for each direction and wavelength.
//!
//! Most of these parts are small parallelograms, which have a closed form of their own. The rest, where a groove ends
//! within another, runs nearly along it or meets two at once, is cut into thin slices along the shallower groove.

use super::{CoherentResponse, GroovePiece, groove_amplitude, groove_overlap, phase_step};
use super::{base_amplitude, window, window_fourier};
use glam::DVec2;
use num_complex::Complex64;
use std::f64::consts::{PI, SQRT_2};

/// Beyond this many sigma the window is 4e-6 of its middle: what crosses there needs no correction.
const REACH: f64 = 5.0;
/// Slices: four Gauss nodes for each so many micrometres of width, which integrates the phase of light at 380 nm from
/// |xi| = 1 to 0.1 %.
const PANEL_UM: f64 = 0.35;
const NODES: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
    (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
];
/// Parts shorter than this many sigma take the window's logarithm as linear along them: off by 0.2 % at most.
const SHORT: f64 = 0.2;

/// A part of a floor that is another groove's floor.
#[derive(Clone, Copy, Debug)]
enum Hidden {
    Patch(Patch),
    Slice(Slice),
}

/// A parallelogram small against the window, or a line.
#[derive(Clone, Copy, Debug)]
struct Patch {
    middle: DVec2,
    edges: [Edge; 2],
    /// The share of the window's integral that it has, but for the window's slope.
    size: f64,
}

/// Half an edge of a patch, and how the window falls along it: x is half the change of its logarithm.
#[derive(Clone, Copy, Debug)]
struct Edge {
    half: DVec2,
    x: f64,
    sinh: f64,
    cosh: f64,
}

/// A line along n's value `across_um` with the width of its quadrature weight.
#[derive(Clone, Copy, Debug)]
struct Slice {
    tangent: DVec2,
    across_um: f64,
    start_um: f64,
    end_um: f64,
    /// The share of the window's integral, across, that the slice stands for: its Gaussian times its width.
    weight: f64,
}

/// The grooves in a window with one floor everywhere. [`super::coherent_response`] is the same for grooves that do not
/// cross, and else counts the area of crossings twice, which adds about the square of the share that they cover to the
/// energy.
#[derive(Clone, Debug)]
pub struct GrooveField {
    pieces: Vec<GroovePiece>,
    hidden: Vec<(usize, Vec<Hidden>)>,
    coherence_um: f64,
}

impl GrooveField {
    /// Finds what crosses: the square of the number of pieces in cheap tests, so leave out what the window does not
    /// reach.
    pub fn new(pieces: Vec<GroovePiece>, coherence_um: f64) -> Self {
        let hidden = (0..pieces.len())
            .map(|index| (index, hidden_parts(&pieces, index, coherence_um)))
            .filter(|(_, parts)| !parts.is_empty())
            .collect();
        Self {
            pieces,
            hidden,
            coherence_um,
        }
    }

    /// The grooves that it was made of.
    pub fn pieces(&self) -> &[GroovePiece] {
        &self.pieces
    }

    /// S in um, as [`super::scratch_amplitude`], less what is hidden: (34).
    pub fn amplitude(&self, xi: DVec2, cos_sum: f64, wavelength_nm: f64) -> Complex64 {
        let wavelength_um = wavelength_nm * 1e-3;
        let k = 2.0 * PI / wavelength_um;
        let all: Complex64 = self
            .pieces
            .iter()
            .map(|piece| {
                let amplitude = groove_amplitude(piece, xi, self.coherence_um, wavelength_nm);
                phase_step(piece.depth_nm, cos_sum, wavelength_nm) * amplitude
            })
            .sum();
        let hidden: Complex64 = self
            .hidden
            .iter()
            .map(|(index, parts)| {
                let sum: Complex64 = parts
                    .iter()
                    .map(|part| part.fourier(k * xi, self.coherence_um))
                    .sum();
                phase_step(self.pieces[*index].depth_nm, cos_sum, wavelength_nm) * sum
            })
            .sum();
        all - 2.0 * PI * self.coherence_um * self.coherence_um / wavelength_um * hidden
    }

    /// f of (1) in its three parts, as [`super::coherent_response`].
    pub fn response(
        &self,
        xi: DVec2,
        cos_sum: f64,
        wavelength_nm: f64,
        with_base: bool,
    ) -> CoherentResponse {
        let base = if with_base {
            base_amplitude(xi, self.coherence_um, wavelength_nm)
        } else {
            0.0
        };
        let scratches = self.amplitude(xi, cos_sum, wavelength_nm);
        CoherentResponse::of(base, scratches, self.coherence_um)
    }

    /// [`Self::response`] at many wavelengths, into as many places of `out`.
    pub fn responses(
        &self,
        xi: DVec2,
        cos_sum: f64,
        wavelengths_nm: &[f64],
        with_base: bool,
        out: &mut [CoherentResponse],
    ) {
        for (out, &nm) in out.iter_mut().zip(wavelengths_nm) {
            *out = self.response(xi, cos_sum, nm, with_base);
        }
    }

    /// The mean of the reflection coefficient, weighted by the window's energy: 1 - sum of D times share, (33).
    pub fn mean_reflection(&self, cos_sum: f64, wavelength_nm: f64) -> Complex64 {
        let mut shares: Vec<f64> = self
            .pieces
            .iter()
            .map(|piece| groove_overlap(piece, self.coherence_um))
            .collect();
        for (index, parts) in &self.hidden {
            shares[*index] -= parts
                .iter()
                .map(|part| part.energy_share(self.coherence_um))
                .sum::<f64>();
        }
        let taken = self
            .pieces
            .iter()
            .zip(&shares)
            .map(|(piece, share)| phase_step(piece.depth_nm, cos_sum, wavelength_nm) * *share);
        1.0 - taken.sum::<Complex64>()
    }
}

impl Hidden {
    /// The window's Fourier integral over the part, relative to the window's whole integral; `k_xi` in 1/um.
    fn fourier(&self, k_xi: DVec2, coherence_um: f64) -> Complex64 {
        match self {
            Self::Patch(patch) => {
                Complex64::from_polar(patch.size, -k_xi.dot(patch.middle))
                    * patch.edges[0].shape(k_xi)
                    * patch.edges[1].shape(k_xi)
            }
            Self::Slice(slice) => {
                let along = k_xi.dot(slice.tangent);
                let across = k_xi.dot(slice.tangent.perp());
                Complex64::from_polar(slice.weight, -across * slice.across_um)
                    * window_fourier(slice.start_um, slice.end_um, coherence_um, along)
            }
        }
    }

    /// The window where the part is nearest to its middle, or in the middle of a small one.
    fn window(&self, coherence_um: f64) -> f64 {
        let at = match self {
            Self::Patch(patch) => patch.middle,
            Self::Slice(s) => DVec2::new(0.0_f64.clamp(s.start_um, s.end_um), s.across_um),
        };
        (-0.5 * at.length_squared() / (coherence_um * coherence_um)).exp()
    }

    /// The share of the window's energy that the part covers.
    fn energy_share(&self, coherence_um: f64) -> f64 {
        match self {
            Self::Patch(patch) => {
                // The window's square has half its integral and twice its slope.
                let square = (-0.5 * patch.middle.length_squared() / coherence_um.powi(2)).exp();
                let slope = |edge: &Edge| {
                    if edge.x == 0.0 {
                        1.0
                    } else {
                        edge.sinh * edge.cosh / edge.x
                    }
                };
                2.0 * patch.size * square * slope(&patch.edges[0]) * slope(&patch.edges[1])
            }
            Self::Slice(slice) => {
                let x = slice.across_um / coherence_um;
                let across = SQRT_2 * slice.weight * (-0.5 * x * x).exp();
                across * window::energy_share(slice.start_um, slice.end_um, coherence_um)
            }
        }
    }
}

impl Patch {
    fn new(middle: DVec2, edges: [DVec2; 2], area_um2: f64, coherence_um: f64) -> Self {
        let variance = coherence_um * coherence_um;
        let edges = edges.map(|edge| {
            let half = 0.5 * edge;
            let x = half.dot(middle) / variance;
            Edge {
                half,
                x,
                sinh: x.sinh(),
                cosh: x.cosh(),
            }
        });
        let gauss = (-0.5 * middle.length_squared() / variance).exp();
        Self {
            middle,
            edges,
            size: area_um2 * gauss / (2.0 * PI * variance),
        }
    }
}

impl Edge {
    /// sinh(z)/z for z = x + i y, y half the change of phase along the edge: the mean along it.
    fn shape(&self, k_xi: DVec2) -> Complex64 {
        let y = k_xi.dot(self.half);
        let z = Complex64::new(self.x, y);
        if z.norm_sqr() < 1e-6 {
            return 1.0 + z * z / 6.0;
        }
        let (sin, cos) = y.sin_cos();
        Complex64::new(self.sinh * cos, self.cosh * sin) / z
    }
}

/// The parts of one piece that lie in deeper ones; of equal ones the later counts as hidden.
fn hidden_parts(pieces: &[GroovePiece], index: usize, coherence_um: f64) -> Vec<Hidden> {
    let piece = &pieces[index];
    let reach = REACH * coherence_um;
    let mut deeper: Vec<&GroovePiece> = pieces
        .iter()
        .enumerate()
        .filter(|(other, p)| {
            (p.depth_nm, index) > (piece.depth_nm, *other)
                && may_meet(piece, p, reach)
                && !are_joined(piece, p)
        })
        .map(|(_, p)| p)
        .collect();
    let mut parts = Vec::new();
    let hulls: Vec<(f64, f64)> = deeper.iter().map(|other| hull(piece, other)).collect();
    let alone = |at: usize| {
        let overlaps = |hull: &(f64, f64)| hull.0 < hulls[at].1 && hull.1 > hulls[at].0;
        hulls.iter().filter(|hull| overlaps(hull)).count() <= 1
    };
    let mut at = 0;
    deeper.retain(|other| {
        at += 1;
        let patch = if alone(at - 1) {
            crossing_patch(piece, other, coherence_um)
        } else {
            None
        };
        parts.extend(patch.map(Hidden::Patch));
        patch.is_none()
    });
    hide_slices(piece, &deeper, coherence_um, &mut parts);
    let least = (-0.5 * REACH * REACH).exp();
    parts.retain(|part| part.window(coherence_um) > least);
    parts
}

/// Between which places along `piece` the endless groove along `other` could meet it.
fn hull(piece: &GroovePiece, other: &GroovePiece) -> (f64, f64) {
    let (normal, tangent) = (piece.tangent.perp(), piece.tangent);
    let sin = tangent.dot(other.tangent.perp());
    if sin.abs() < 1e-3 {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let cos = normal.dot(other.tangent.perp());
    let middle = (other.offset_um - piece.offset_um * cos) / sin;
    let half = 0.5 * (other.width_um + piece.width_um * cos.abs()) / sin.abs();
    (middle - half, middle + half)
}

/// The parallelogram in which two grooves cross, if both go on beyond it and it is small.
fn crossing_patch(piece: &GroovePiece, other: &GroovePiece, coherence_um: f64) -> Option<Patch> {
    let sin = piece.tangent.perp_dot(other.tangent).abs();
    let (along, beside) = (other.width_um / sin, piece.width_um / sin);
    if !(along.max(beside) < SHORT * coherence_um) {
        return None;
    }
    let inside = |a: &GroovePiece, b: &GroovePiece| {
        let hull = hull(a, b);
        a.start_um <= hull.0 && hull.1 <= a.end_um
    };
    if !inside(piece, other) || !inside(other, piece) {
        return None;
    }
    let (start, end) = hull(piece, other);
    let middle = 0.5 * (start + end) * piece.tangent + piece.offset_um * piece.tangent.perp();
    let edges = [along * piece.tangent, beside * other.tangent];
    Some(Patch::new(
        middle,
        edges,
        along * piece.width_um,
        coherence_um,
    ))
}

/// What the deeper grooves hide of a piece, slice by slice.
fn hide_slices(
    piece: &GroovePiece,
    deeper: &[&GroovePiece],
    coherence_um: f64,
    parts: &mut Vec<Hidden>,
) {
    let reach = REACH * coherence_um;
    let (near, far) = (
        (piece.offset_um - 0.5 * piece.width_um).max(-reach),
        (piece.offset_um + 0.5 * piece.width_um).min(reach),
    );
    if deeper.is_empty() || !(near < far) {
        return;
    }
    // What is hidden of a line changes its slope where the line passes a corner, and jumps there if the grooves are
    // parallel: panels end at corners.
    let mut cuts = vec![near, far];
    for other in deeper {
        let places = corners(other, 2.0 * reach).map(|corner| corner.dot(piece.tangent.perp()));
        cuts.extend(places.into_iter().filter(|&v| near < v && v < far));
    }
    cuts.sort_by(f64::total_cmp);
    let longest_um = PANEL_UM.min(0.5 * coherence_um);
    for panel in cuts.windows(2) {
        let count = ((panel[1] - panel[0]) / longest_um)
            .ceil()
            .clamp(1.0, 1000.0);
        let half = 0.5 * (panel[1] - panel[0]) / count;
        for part in 0..count as usize {
            for (x, node_weight) in NODES {
                let across_um = panel[0] + half * ((2 * part + 1) as f64 + x);
                let thickness_um = half * node_weight;
                for ends in hidden_intervals(piece, deeper, across_um, reach) {
                    parts.push(slice(
                        piece.tangent,
                        across_um,
                        thickness_um,
                        ends,
                        coherence_um,
                    ));
                }
            }
        }
    }
}

fn slice(
    tangent: DVec2,
    across_um: f64,
    thickness_um: f64,
    (start_um, end_um): (f64, f64),
    coherence_um: f64,
) -> Hidden {
    let length = end_um - start_um;
    if length < SHORT * coherence_um {
        let middle = 0.5 * (start_um + end_um) * tangent + across_um * tangent.perp();
        let edges = [length * tangent, DVec2::ZERO];
        return Hidden::Patch(Patch::new(
            middle,
            edges,
            length * thickness_um,
            coherence_um,
        ));
    }
    let x = across_um / coherence_um;
    Hidden::Slice(Slice {
        tangent,
        across_um,
        start_um,
        end_um,
        weight: thickness_um * (-0.5 * x * x).exp() / ((2.0 * PI).sqrt() * coherence_um),
    })
}

/// Two pieces of one groove that bends overlap on the inner side of the bend and gape as much on the outer: nothing of
/// them is hidden.
fn are_joined(a: &GroovePiece, b: &GroovePiece) -> bool {
    let ends = |g: &GroovePiece| {
        [g.start_um, g.end_um].map(|s| s * g.tangent + g.offset_um * g.tangent.perp())
    };
    let meets = |p: DVec2| {
        ends(b)
            .into_iter()
            .any(|q| p.distance(q) < 0.1 * a.width_um)
    };
    a.width_um == b.width_um
        && a.depth_nm == b.depth_nm
        && ends(a).into_iter().filter(|&p| meets(p)).count() == 1
}

/// False where two middle lines stay apart within reach: most pairs.
fn may_meet(a: &GroovePiece, b: &GroovePiece, reach: f64) -> bool {
    // a's middle line within the window, as places along b's normal.
    let normal = b.tangent.perp();
    let start = a.offset_um * a.tangent.perp().dot(normal);
    let slope = a.tangent.dot(normal);
    let margin = 0.5 * (a.width_um + b.width_um);
    let (low, high) = (a.start_um.max(-reach), a.end_um.min(reach));
    let (p, q) = (start + slope * low, start + slope * high);
    low < high && p.min(q) < b.offset_um + margin && p.max(q) > b.offset_um - margin
}

fn corners(piece: &GroovePiece, reach: f64) -> [DVec2; 4] {
    let (low, high) = (
        piece.start_um.clamp(-reach, reach),
        piece.end_um.clamp(-reach, reach),
    );
    let half = 0.5 * piece.width_um;
    [(low, -half), (low, half), (high, -half), (high, half)].map(|(along, beside)| {
        along * piece.tangent + (piece.offset_um + beside) * piece.tangent.perp()
    })
}

/// What deeper grooves hide of a line along `piece`: intervals along t, in order and apart.
fn hidden_intervals(
    piece: &GroovePiece,
    deeper: &[&GroovePiece],
    across_um: f64,
    reach: f64,
) -> Vec<(f64, f64)> {
    let mut found: Vec<(f64, f64)> = deeper
        .iter()
        .filter_map(|other| {
            let origin = across_um * piece.tangent.perp();
            let normal = other.tangent.perp();
            let half = 0.5 * other.width_um;
            let mut range = (piece.start_um.max(-reach), piece.end_um.min(reach));
            for (axis, low, high) in [
                (normal, other.offset_um - half, other.offset_um + half),
                (other.tangent, other.start_um, other.end_um),
            ] {
                let (start, slope) = (origin.dot(axis), piece.tangent.dot(axis));
                if slope.abs() < 1e-12 {
                    if start < low || start > high {
                        return None;
                    }
                    continue;
                }
                let (a, b) = ((low - start) / slope, (high - start) / slope);
                range = (range.0.max(a.min(b)), range.1.min(a.max(b)));
            }
            (range.0 < range.1).then_some(range)
        })
        .collect();
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut apart: Vec<(f64, f64)> = Vec::new();
    for range in found {
        match apart.last_mut() {
            Some(last) if range.0 <= last.1 => last.1 = last.1.max(range.1),
            _ => apart.push(range),
        }
    }
    apart
}
