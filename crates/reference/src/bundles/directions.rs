//! How much scratch lies in which direction, and the light of that.

use super::Many;
use crate::light_view::LightView;
use crate::scratches::{Pixel, Work};
use crate::segment_view::{Groove, SegmentView};
use glam::{DVec2, DVec3};
use hairline_index::bundles::{BUNDLE_BINS, Bundle, CLASSES_MAX, Side};
use hairline_optics::mask::ScratchSums;
use hairline_optics::scratch::oblique_depth_nm;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Directions are at most this share of the angle apart over which a light shines alike.
const TURN_SHARE: f64 = 1.0;
/// Most bins between one direction and the next.
const STRIDE_MAX: usize = 8;
/// Bins between directions that light an environment.
const ENVIRONMENT_STRIDE: usize = 4;
/// Variance by which a band is smeared over the step between two directions, as a share of the step's square: a tent has 1/6, of which
/// the splat to directions has taken its part.
const SMEAR: f64 = 0.1;
/// By how much scratches of a direction differ from their class, at most.
const MOVED_MAX: f32 = 1.0;
/// The angle from one bin to the next.
const BIN_RAD: f64 = PI / BUNDLE_BINS as f64;

/// Directions of a half circle from the reference on.
static CIRCLE: LazyLock<[DVec2; BUNDLE_BINS]> =
    LazyLock::new(|| std::array::from_fn(|at| DVec2::from_angle(BIN_RAD * at as f64)));

/// Sums over a class's scratches, by the angle from the side's reference.
#[derive(Clone)]
pub(super) struct ClassSums {
    shares: [f32; BUNDLE_BINS],
    /// Shares times those by which a scratch is wider than its class.
    wider: [f32; BUNDLE_BINS],
    /// And deeper.
    deeper: [f32; BUNDLE_BINS],
    share: f32,
}

impl ClassSums {
    const NONE: Self = Self {
        shares: [0.0; BUNDLE_BINS],
        wider: [0.0; BUNDLE_BINS],
        deeper: [0.0; BUNDLE_BINS],
        share: 0.0,
    };

    /// Adds a vertex of a grid.
    pub fn add_bundle(&mut self, share: f32, bundle: &Bundle) {
        self.share += share;
        let scale = share * bundle.bin_scale / 255.0;
        for (sum, bin) in self.shares.iter_mut().zip(&bundle.bins) {
            *sum += scale * f32::from(*bin);
        }
        let [wider, deeper] = bundle.moved_scales.map(|scale| share * scale / 127.0);
        for (sum, bin) in self.wider.iter_mut().zip(&bundle.wider) {
            *sum += wider * f32::from(*bin);
        }
        for (sum, bin) in self.deeper.iter_mut().zip(&bundle.deeper) {
            *sum += deeper * f32::from(*bin);
        }
    }

    /// Adds a scratch between two bins.
    pub fn add_scratch(&mut self, bin: f32, share: f32, [wider, deeper]: [f32; 2]) {
        self.share += share;
        let (low, high_share) = (bin as usize % BUNDLE_BINS, bin.fract());
        for (bin, share) in [
            (low, share * (1.0 - high_share)),
            ((low + 1) % BUNDLE_BINS, share * high_share),
        ] {
            self.shares[bin] += share;
            self.wider[bin] += share * wider;
            self.deeper[bin] += share * deeper;
        }
    }

    /// The share about a direction where only those `stride` bins apart are told from one another, and by which shares what
    /// lies there is wider and deeper than its class.
    fn about(&self, at: usize, stride: usize) -> (f32, [f32; 2]) {
        let sum = |bins: &[f32; BUNDLE_BINS]| {
            let mut sum = bins[at];
            for away in 1..stride {
                let tent = (stride - away) as f32 / stride as f32;
                sum += tent * bins[(at + away) % BUNDLE_BINS];
                sum += tent * bins[(at + BUNDLE_BINS - away) % BUNDLE_BINS];
            }
            sum
        };
        let share = sum(&self.shares);
        if !(share > 0.0) {
            return (0.0, [0.0; 2]);
        }
        // Rounding of small ones may leave more than there is.
        let moved = [&self.wider, &self.deeper].map(|bins| sum(bins) / share);
        (share, moved.map(|m| m.clamp(-MOVED_MAX, MOVED_MAX)))
    }
}

/// How much scratch lies under a footprint in which direction, class by class.
pub(super) struct Directions {
    side: Side,
    pub classes: [ClassSums; CLASSES_MAX],
}

impl Directions {
    pub fn new(side: Side) -> Self {
        Self {
            side,
            classes: [ClassSums::NONE; CLASSES_MAX],
        }
    }

    pub fn is_any(&self) -> bool {
        self.classes.iter().any(|class| class.share > 0.0)
    }

    /// The reference and what lies across it, in the frame of the point's surface.
    pub fn axes(pixel: &Pixel, side: Side) -> [DVec2; 2] {
        let point = pixel.point;
        let reference = side.reference(point.normal.as_vec3()).as_dvec3();
        let across = point.normal.cross(reference);
        [reference, across].map(|v| DVec2::new(v.dot(point.axis_x), v.dot(point.axis_y)))
    }

    /// The light of all directions, Fresnel left out.
    pub fn radiance(&self, many: &Many, work: &mut Work) -> DVec3 {
        let pixel = many.pixel;
        let [reference, across] = Self::axes(pixel, self.side);
        let classes = &many.grids.classes;
        let of_point = |class| many.bundles.table(many.object, class, pixel.point.table);
        // Classes that there are not have no share.
        let of: [_; CLASSES_MAX] = std::array::from_fn(|i| i.min(classes.len() - 1));
        let tables = of.map(of_point);
        let view = |at: usize, stride: usize| {
            let grooves: [_; CLASSES_MAX] = std::array::from_fn(|i| {
                let (share, moved) = self.classes[i].about(at, stride);
                Groove {
                    table: tables[i],
                    width_um: classes[of[i]].width_um.into(),
                    depth_nm: classes[of[i]].depth_nm.into(),
                    moved: moved.map(f64::from),
                    share: share.into(),
                }
            });
            grooves.iter().any(|groove| groove.share > 0.0).then(|| {
                let tangent = (reference * CIRCLE[at].x + across * CIRCLE[at].y).normalize();
                let turn = BIN_RAD * stride as f64;
                SegmentView::of_many(pixel, tangent, grooves, SMEAR * turn * turn)
            })
        };
        let mut radiance = DVec3::ZERO;
        for light in 0..many.views.views.len() {
            let stride = stride(many, light);
            for at in (0..BUNDLE_BINS).step_by(stride) {
                if let Some(view) = view(at, stride) {
                    radiance += view.light(pixel, many.views, light, work);
                }
            }
        }
        if let Some(environment) = &many.prepared.scene.environment {
            for at in (0..BUNDLE_BINS).step_by(ENVIRONMENT_STRIDE) {
                if let Some(view) = view(at, ENVIRONMENT_STRIDE) {
                    radiance += view.environment(pixel, environment);
                }
            }
        }
        radiance
    }

    /// Adds shares and energies.
    pub fn add_mask(&self, many: &Many, sums: &mut ScratchSums) {
        let pixel = many.pixel;
        let [reference, across] = Self::axes(pixel, self.side);
        for (i, class) in many.grids.classes.iter().enumerate() {
            let of_class = &self.classes[i];
            let class_share = f64::from(of_class.share);
            if !(class_share > 0.0) {
                continue;
            }
            let mut deeper = 0.0;
            for at in (0..BUNDLE_BINS).step_by(STRIDE_MAX) {
                let (share, moved) = of_class.about(at, STRIDE_MAX);
                let (share, moved) = (f64::from(share), moved.map(f64::from));
                let tangent = (reference * CIRCLE[at].x + across * CIRCLE[at].y).normalize();
                let width_um = (1.0 + moved[0]) * f64::from(class.width_um);
                // The mean of a Gaussian over itself is 1/sqrt2 of its peak.
                let line = width_um / (4.0 * PI * pixel.variance_across_um2(tangent)).sqrt();
                sums.share_by_line += share * line;
                deeper += share * moved[1];
            }
            sums.share += class_share;
            let depth_nm = (1.0 + deeper / class_share) * f64::from(class.depth_nm);
            let cos_o = pixel.point.wo.z;
            let table = many.bundles.table(many.object, i, pixel.point.table);
            let energy = table.scratch_table_total(oblique_depth_nm(depth_nm, cos_o, cos_o));
            (0..3).for_each(|c| sums.energy[c] += class_share * energy[c]);
        }
    }
}

/// Into which steps of directions a light is resolved.
fn stride(many: &Many, light: usize) -> usize {
    let (pixel, views) = (many.pixel, many.views);
    let view = &views.views[light];
    let (LightView::Sphere { cap, .. } | LightView::Polygon { bound: cap, .. }) = view;
    let sum = (pixel.point.wo + cap.cos_radius * cap.axis).truncate();
    let [x, y] = views.moves[light].map(|m| m.length_squared());
    let std = (pixel.frame.stds.mean * pixel.frame.stds.mean + x + y).sqrt();
    let half = match view {
        LightView::Sphere { cap, .. } => cap.sin_radius,
        LightView::Polygon { away, .. } => {
            // Half the width of a long one.
            let distance = views.distances_m[light];
            let solid_angle = 0.5 * away.length() / (distance * distance);
            (solid_angle / (4.0 * cap.sin_radius.max(1e-6))).min(cap.sin_radius)
        }
    };
    // So far a scratch may turn and still see the light about alike.
    let turn = (half + std) / sum.length().max(0.1);
    let mut stride = 1;
    while stride < STRIDE_MAX && 2.0 * stride as f64 * BIN_RAD < TURN_SHARE * turn {
        stride *= 2;
    }
    stride
}
