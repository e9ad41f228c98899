//! Places of its ground on which a layer lies, and its density there: the `where` of a `[[scratches]]`.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use hairline_laying::{
    Edges, Facet, Ground, MeshPoint, RemovedParts, ball, barycentric, facet_normal,
};
use hairline_scene::{PictureLie, Segment, three_sides};

use crate::description;
use crate::error::Error;
use crate::grey_map::GreyMap;

/// A `where` with the files and surfaces that were read for it.
pub(crate) struct PlaceInputs<'a> {
    pub described: &'a description::LayerPlaces,
    pub mask: Option<Arc<GreyMap>>,
    pub density: Option<Arc<GreyMap>>,
    /// The whole object's surface, for edges: the border of a part is no edge.
    pub whole: Option<Arc<Ground>>,
}

/// Default reach of edges, over the object's diagonal.
const DEFAULT_EDGE_WIDTH: f64 = 0.02;
/// Edges reach this share of the diagonal at least: less would be more pieces than there is memory for.
const LEAST_EDGE_WIDTH: f64 = 1e-3;
/// Looks at a mask along one segment, at most.
const MOST_LOOKS: f64 = 4096.0;
/// Halvings of the way between two looks: to a millionth of a texel.
const HALVINGS: u32 = 20;

/// Places of a ground.
pub(super) struct GroundPlaces<'a> {
    ground: &'a Ground,
    mask: Option<Arc<GreyMap>>,
    density: Option<Arc<GreyMap>>,
    lie: PictureLie,
    edges: Option<Edges>,
    edges_share: f64,
    center_m: DVec3,
    radii_m: Option<[f64; 2]>,
}

/// Look-ups of a picture for a place, with the weight of each; by texture coordinates only the first.
#[derive(Clone, Copy)]
struct LookUp {
    uvs: [DVec2; 3],
    shares: [f64; 3],
}

impl<'a> GroundPlaces<'a> {
    /// Makes the places of a layer; `None` if it lies everywhere. `key` is the path of the layer.
    ///
    /// # Errors
    /// Pictures on an object without texture coordinates, edges that are too narrow for it.
    pub(super) fn new(
        means: &PlaceInputs,
        ground: &'a Ground,
        key: &str,
    ) -> Result<Option<Self>, Error> {
        let described = means.described;
        if described.is_everywhere() {
            return Ok(None);
        }
        let lie = PictureLie::new(described.tile_m, &ground.world_from_object);
        let of_picture = [("mask", &described.mask), ("density", &described.density)];
        let named = of_picture.iter().find(|(_, file)| file.is_some());
        if let (PictureLie::ByUv, Some((name, _))) = (lie, named)
            && !ground.mesh.has_uvs()
        {
            return Err(Error::new(
                format!("{key}.where.{name}"),
                "found a picture for a surface without texture coordinates",
                "add `tile_m`, how wide it is, to lay it on from three sides",
            ));
        }
        Ok(Some(Self {
            ground,
            mask: means.mask.clone(),
            density: means.density.clone(),
            lie,
            edges: edges(means, key)?,
            edges_share: described.edges,
            center_m: ground.point_in_world_m(described.center_m.unwrap_or([0.0; 3])),
            radii_m: described.radius_m,
        }))
    }

    /// Whether each scratch is as likely as the others.
    pub(super) fn is_even(&self) -> bool {
        self.density.is_none() && self.edges.is_none()
    }

    /// Whether scratches end where it ends.
    pub(super) fn has_ends(&self) -> bool {
        self.mask.is_some() || self.radii_m.is_some()
    }

    /// The probability that a scratch whose middle is there is laid.
    pub(super) fn chance(&self, middle: MeshPoint) -> f64 {
        let of_picture = self.density.as_ref().map_or(1.0, |map| {
            self.look_up(middle.triangle, middle.point_m).value(map)
        });
        let of_edges = self.edges.as_ref().map_or(1.0, |edges| {
            let normal = Facet::new(&self.ground.mesh, middle.triangle).normal;
            1.0 - self.edges_share + self.edges_share * edges.prominence(middle.point_m, normal)
        });
        of_picture * of_edges
    }

    /// Adds the parts of a segment, from 0 to 1, that lie outside of the layer's places.
    pub(super) fn elsewhere(&self, segment: &Segment, parts: &mut RemovedParts) {
        let [start, end] = [segment.start_m, segment.end_m].map(|p| p.as_dvec3());
        if let Some([least_m, most_m]) = self.radii_m {
            let (offset, span) = (start - self.center_m, end - start);
            let within = |radius_m| ball(offset, span, radius_m).unwrap_or([1.0; 2]);
            let [from, to] = within(most_m);
            let outside = [[0.0, from], [to, 1.0]];
            let all = outside.into_iter().chain([within(least_m)]);
            let clamped = all.map(|[from, to]| [from.max(0.0), to.min(1.0)]);
            parts.extend(clamped.filter(|[from, to]| from < to));
        }
        if let Some(mask) = &self.mask {
            let ends = [start, end].map(|point_m| self.look_up(segment.triangle, point_m));
            dark(mask, ends, parts);
        }
    }

    fn look_up(&self, triangle: u32, point_m: DVec3) -> LookUp {
        let mesh = &self.ground.mesh;
        let corners_m = mesh.corners_m(triangle as usize);
        let own_normal = facet_normal(corners_m);
        let weights = barycentric(corners_m, own_normal, point_m);
        let corners = mesh.triangles[triangle as usize].map(|corner| corner as usize);
        match self.lie {
            PictureLie::ByUv => {
                let uv = |i: usize| mesh.uvs[corners[i]].as_dvec2() * weights[i];
                LookUp {
                    uvs: [uv(0) + uv(1) + uv(2), DVec2::ZERO, DVec2::ZERO],
                    shares: [1.0, 0.0, 0.0],
                }
            }
            PictureLie::FromThreeSides { tiles_from_world } => {
                let normal = |i: usize| mesh.normals[corners[i]].as_dvec3() * weights[i];
                let normal = (normal(0) + normal(1) + normal(2)).normalize_or(own_normal);
                let (uvs, shares) = three_sides(&tiles_from_world, point_m, normal);
                LookUp { uvs, shares }
            }
        }
    }
}

impl LookUp {
    fn value(&self, map: &GreyMap) -> f64 {
        let seen = (0..3).filter(|&i| self.shares[i] > 0.0);
        seen.map(|i| self.shares[i] * map.value(self.uvs[i])).sum()
    }

    fn lerp(&self, other: &Self, t: f64) -> Self {
        Self {
            uvs: std::array::from_fn(|i| self.uvs[i].lerp(other.uvs[i], t)),
            shares: std::array::from_fn(|i| {
                self.shares[i] + (other.shares[i] - self.shares[i]) * t
            }),
        }
    }
}

/// Edges that scratches are to keep to, if any.
fn edges(means: &PlaceInputs, key: &str) -> Result<Option<Edges>, Error> {
    let Some(whole) = &means.whole else {
        return Ok(None);
    };
    let width_m = means.described.edge_width_m;
    let width_m = width_m.unwrap_or(DEFAULT_EDGE_WIDTH * whole.diagonal_m);
    let least_m = LEAST_EDGE_WIDTH * whole.diagonal_m;
    match width_m >= least_m {
        true => Ok(Some(Edges::new(&whole.mesh, width_m))),
        false => Err(Error::new(
            format!("{key}.where.edge_width_m"),
            format!("found {width_m}"),
            format!("must be at least {least_m:.2e} on an object of this size"),
        )),
    }
}

/// Adds the parts of a way from one look-up to another where a mask is darker than half of white.
fn dark(mask: &GreyMap, [start, end]: [LookUp; 2], parts: &mut RemovedParts) {
    let above = |t: f64| start.lerp(&end, t).value(mask) - 0.5;
    let texels = |i: usize| ((end.uvs[i] - start.uvs[i]) * mask.size()).length();
    let seen = (0..3).filter(|&i| start.shares[i] + end.shares[i] > 0.0);
    let looks = seen.map(texels).fold(1.0, f64::max).ceil().min(MOST_LOOKS);
    let (mut from, mut before) = (0.0, above(0.0));
    let mut dark_from = (before < 0.0).then_some(0.0);
    for look in 1..=looks as u32 {
        let to = f64::from(look) / looks;
        let here = above(to);
        if (here < 0.0) != (before < 0.0) {
            let [mut a, mut b] = [from, to];
            for _ in 0..HALVINGS {
                let middle = 0.5 * (a + b);
                match (above(middle) < 0.0) == (before < 0.0) {
                    true => a = middle,
                    false => b = middle,
                }
            }
            match dark_from.take() {
                Some(dark_from) => parts.push([dark_from, b]),
                None => dark_from = Some(b),
            }
        }
        (from, before) = (to, here);
    }
    parts.extend(dark_from.map(|dark_from| [dark_from, 1.0]));
}
