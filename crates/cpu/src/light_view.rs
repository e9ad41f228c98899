//! The lights as seen from a point, in the frame of its surface.

use crate::picture::{PictureView, picture_mean};
use crate::surface::SurfacePoint;
use glam::{DVec2, DVec3};
use hairline_optics::band::{
    Cap, Outline, OutlineEdge, TUBE_CORNERS, band_moves, polygon_facing, sphere_cap, tube_outline,
};
use hairline_scene::{Light, LightShape, Scene, Texture};
use std::f64::consts::PI;
use std::ops::Range;

/// One light from a point.
#[derive(Clone, Debug)]
pub enum LightView {
    /// A sphere, as the cap of directions that it covers.
    Sphere {
        /// Directions to it.
        cap: Cap,
        /// Radiance towards the point.
        radiance: DVec3,
    },
    /// A polygon, or the outline of a tube; `vertices` index [`LightViews::vertices`], and the directions and edges there.
    Polygon {
        /// Index into the scene's lights.
        light: usize,
        /// Places of its vertices.
        vertices: Range<usize>,
        /// Normal of its plane, away from the point.
        away: DVec3,
        /// Sense in which it is seen: [`polygon_facing`].
        facing: f64,
        /// Whether one of the corners lies below the horizon.
        sets: bool,
        /// Holds the whole polygon.
        bound: Cap,
        /// Radiance towards the point.
        radiance: DVec3,
    },
}

impl LightView {
    pub(crate) fn radiance(&self) -> DVec3 {
        match self {
            Self::Sphere { radiance, .. } | Self::Polygon { radiance, .. } => *radiance,
        }
    }

    /// Direction inside the light that lies as far above the horizon as possible.
    pub(crate) fn highest(&self, views: &LightViews) -> DVec3 {
        match self {
            Self::Sphere { cap, .. } if cap.cos_radius <= 0.0 => DVec3::Z,
            Self::Sphere { cap, .. } => {
                let up = (DVec3::Z - cap.axis.z * cap.axis).normalize_or_zero();
                (cap.axis + 0.9 * cap.sin_radius / cap.cos_radius * up).normalize()
            }
            Self::Polygon {
                vertices, bound, ..
            } => {
                let corners = views.directions[vertices.clone()].iter();
                let highest = corners.copied().max_by(|a, b| a.z.total_cmp(&b.z));
                highest.map_or(bound.axis, |corner| {
                    (0.9 * corner + 0.1 * bound.axis).normalize()
                })
            }
        }
    }

    /// About how large it looks, steradians: of a polygon as if it were small.
    pub(crate) fn solid_angle_sr(&self, views: &LightViews) -> f64 {
        match self {
            Self::Sphere { cap, .. } => 2.0 * PI * (1.0 - cap.cos_radius),
            Self::Polygon { vertices, .. } => {
                let corners = &views.vertices[vertices.clone()];
                let next = corners.iter().cycle().skip(1);
                let area: DVec3 = corners.iter().zip(next).map(|(a, b)| a.cross(*b)).sum();
                let middle = corners.iter().sum::<DVec3>() / corners.len().max(1) as f64;
                let distance = middle.length().max(1e-6);
                (0.5 * area.dot(middle).abs() / distance.powi(3)).min(2.0 * PI)
            }
        }
    }

    /// A cap of directions that holds it.
    pub(crate) fn bound(&self) -> &Cap {
        match self {
            Self::Sphere { cap, .. } => cap,
            Self::Polygon { bound, .. } => bound,
        }
    }
}

/// All lights of a scene from a point: first those that shine on everything, then those that shine on scratches alone. One for each thread,
/// filled anew for every point without allocating.
pub struct LightViews<'a> {
    lights: Vec<&'a Light>,
    textures: &'a [Texture],
    /// Lights that the point sees.
    pub views: Vec<LightView>,
    /// Index in `views` of each light of the scene; `u32::MAX` if it is left out.
    places: Vec<u32>,
    /// Index among the scene's lights of each of `views`.
    in_scene: Vec<usize>,
    /// Distance from the point to the middle of each light, held at its radius or above.
    pub(crate) distances_m: Vec<f64>,
    /// Movement of xi towards each light over one standard deviation of the pixel's filter, to the right and down: `band_moves`. For scratches, see
    /// [`LightViews::ready_for_scratches`].
    pub(crate) moves: Vec<[DVec2; 2]>,
    /// Polygon vertices relative to the point, metres.
    pub vertices: Vec<DVec3>,
    /// Unit directions to them.
    pub(crate) directions: Vec<DVec3>,
    /// Edges from one direction to the next, for scratches.
    pub(crate) edges: Vec<OutlineEdge>,
    /// Views in the frame of the surface under the coat: made with the first point that has one, and valid where the last point has one.
    under_coat: Option<Box<Self>>,
    has_own_under_coat: bool,
}

impl<'a> LightViews<'a> {
    /// Room for the lights of a scene.
    pub fn new(scene: &'a Scene) -> Self {
        Self::from_lights(scene.all_lights().collect(), &scene.textures)
    }

    fn from_lights(lights: Vec<&'a Light>, textures: &'a [Texture]) -> Self {
        Self {
            lights,
            textures,
            views: Vec::new(),
            places: Vec::new(),
            in_scene: Vec::new(),
            distances_m: Vec::new(),
            moves: Vec::new(),
            vertices: Vec::new(),
            directions: Vec::new(),
            edges: Vec::new(),
            under_coat: None,
            has_own_under_coat: false,
        }
    }

    /// Looks at the lights from a point. Lights wholly under its horizon or turned away are left out.
    pub fn look_from(&mut self, point: &SurfacePoint) {
        self.views.clear();
        self.places.clear();
        self.in_scene.clear();
        self.distances_m.clear();
        self.moves.clear();
        self.vertices.clear();
        self.directions.clear();
        self.edges.clear();
        let under_coat = point.under_coat();
        self.has_own_under_coat = under_coat.is_some();
        if let Some(under_coat) = under_coat {
            let new = || Self::from_lights(self.lights.clone(), self.textures).into();
            self.under_coat
                .get_or_insert_with(new)
                .look_from(&under_coat);
        }
        for index in 0..self.lights.len() {
            self.places.push(u32::MAX);
            self.look_at(point, index);
        }
    }

    /// Looks at a light.
    fn look_at(&mut self, point: &SurfacePoint, index: usize) {
        let light = self.lights[index];
        let radiance = sent(light, point.position_m);
        if light.cone.is_some() && radiance == DVec3::ZERO {
            return;
        }
        let first = self.vertices.len();
        match &light.shape {
            LightShape::Sphere { center_m, radius_m } => {
                let center = point.surface_from_world(*center_m - point.position_m);
                if center.z > -radius_m {
                    let cap = sphere_cap(center, *radius_m);
                    self.distances_m.push(center.length().max(*radius_m));
                    self.places[index] = self.views.len() as u32;
                    self.views.push(LightView::Sphere { cap, radiance });
                    self.in_scene.push(index);
                }
            }
            LightShape::Polygon {
                vertices_m,
                two_sided,
            } => {
                self.vertices.extend(
                    vertices_m
                        .iter()
                        .map(|v| point.surface_from_world(*v - point.position_m)),
                );
                let own = self.vertices[first..].iter();
                let facing = polygon_facing(own.copied(), *two_sided);
                self.add_outline(point, index, first, facing);
            }
            LightShape::Tube { ends_m, radius_m } => {
                let [a, b] = ends_m.map(|end| point.surface_from_world(end - point.position_m));
                if let Some(outline) = tube_outline(a, b, *radius_m) {
                    let corners = (0..TUBE_CORNERS).map(|i| outline.tube_corner(i));
                    self.vertices.extend(corners);
                    self.add_outline(point, index, first, (outline.away, 1.0));
                }
            }
        }
    }

    /// Adds a light whose outline has the vertices from `first` on, unless no part of it is above the horizon.
    fn add_outline(
        &mut self,
        point: &SurfacePoint,
        index: usize,
        first: usize,
        (away, facing): (DVec3, f64),
    ) {
        if facing == 0.0 || self.vertices[first..].iter().all(|v| v.z <= 0.0) {
            self.vertices.truncate(first);
            return;
        }
        let light = self.lights[index];
        let place = self.views.len() as u32;
        self.directions
            .extend(self.vertices[first..].iter().map(|v| v.normalize_or_zero()));
        let vertices = first..self.vertices.len();
        let sets = self.vertices[first..].iter().any(|v| v.z < 0.0);
        let (center_m, radius_m) = light.bounding_sphere();
        let center = point.surface_from_world(center_m - point.position_m);
        let bound = sphere_cap(center, radius_m);
        self.distances_m.push(center.length().max(radius_m));
        self.views.push(LightView::Polygon {
            light: index,
            vertices,
            away,
            facing,
            sets,
            bound,
            radiance: sent(light, point.position_m),
        });
        self.places[index] = place;
        self.in_scene.push(index);
    }

    /// Lights of the scene.
    pub(crate) fn light_count(&self) -> usize {
        self.lights.len()
    }

    /// The place in `views` of a light of the scene; none if it is left out.
    #[inline]
    pub(crate) fn view_of(&self, light: u32) -> Option<usize> {
        let place = self.places[light as usize];
        (place != u32::MAX).then_some(place as usize)
    }

    /// The scene's light of a place in `views`; none beyond the last.
    pub(crate) fn light_of(&self, view: usize) -> Option<usize> {
        self.in_scene.get(view).copied()
    }

    /// The picture on one of `views`, if it has one.
    pub(crate) fn picture(&self, view: &LightView) -> Option<PictureView<'a>> {
        let LightView::Polygon {
            light, vertices, ..
        } = view
        else {
            return None;
        };
        let texture = &self.textures[self.lights[*light].picture?];
        Some(PictureView::new(texture, &self.vertices[vertices.clone()]))
    }

    /// The mean of the picture on one of `views`; 1 without one.
    pub fn picture_mean(&self, view: &LightView) -> DVec3 {
        match view {
            LightView::Polygon { light, .. } => match self.lights[*light].picture {
                Some(texture) => picture_mean(&self.textures[texture]),
                None => DVec3::ONE,
            },
            LightView::Sphere { .. } => DVec3::ONE,
        }
    }

    /// Views in the frame of the surface under the coat.
    pub(crate) fn under_coat(&self) -> &Self {
        let own = self.under_coat.as_deref();
        own.filter(|_| self.has_own_under_coat).unwrap_or(self)
    }

    /// Lights of the scene that the coat or the surface under it sees.
    pub(crate) fn on_base(&self) -> impl Iterator<Item = u32> {
        let under_coat = self.under_coat();
        (0..self.lights.len() as u32).filter(move |light| {
            [self, under_coat]
                .iter()
                .any(|it| it.light(*light).is_some())
        })
    }

    /// View of a light of the scene; none if it is left out.
    pub(crate) fn light(&self, light: u32) -> Option<&LightView> {
        self.view_of(light).map(|place| &self.views[place])
    }

    /// Computes the values that all scratches at the point share; only once there are any.
    pub(crate) fn ready_for_scratches(&mut self, point: &SurfacePoint) {
        let axes_m = point
            .footprint_axes_m
            .map(|step| point.surface_from_world(step));
        let per_o = 1.0 / point.distance_m;
        for (view, distance_m) in self.views.iter().zip(&self.distances_m) {
            let cap = view.bound();
            self.moves.push(std::array::from_fn(|j| {
                let turn = point.normal_turns[j].truncate();
                band_moves(turn, axes_m[j], point.wo, per_o, cap.axis, 1.0 / distance_m)
            }));
            if let LightView::Polygon { vertices, .. } = view {
                let directions = &self.directions[vertices.clone()];
                self.edges.extend(OutlineEdge::of_outline(directions));
            }
        }
    }

    /// A polygon made ready for many scratches.
    pub(crate) fn outline(
        &self,
        vertices: &Range<usize>,
        away: DVec3,
        facing: f64,
        sets: bool,
    ) -> Outline<'_> {
        Outline {
            edges: &self.edges[vertices.clone()],
            away,
            facing,
            sets,
        }
    }
}

/// The radiance towards a point: the cone's share is that of the light's middle.
fn sent(light: &Light, to_m: DVec3) -> DVec3 {
    let away = (to_m - light.bounding_sphere().0).normalize_or_zero();
    DVec3::from(light.radiance) * light.cone.map_or(1.0, |cone| cone.share(away))
}
