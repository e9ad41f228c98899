//! Centres of swirls, scattered through space: one at a random place in each cell of a lattice as wide as a swirl's radius. A
//! scratch finds those around it without a list of all, however large the surface.

use glam::DVec3;

use crate::facet::Facet;
use crate::random::Stream;

/// Number that is added to a stream's index for the lattice: scratches have lower indices.
const LATTICE_STREAMS: u64 = 1 << 63;

/// The centres of a layer.
pub struct Lattice {
    /// Seed of the layer.
    pub seed: u64,
    /// Number that distinguishes layers of one seed.
    pub number: u64,
    /// Width of a cell.
    pub cell_m: f64,
    /// A corner of a cell.
    pub origin_m: DVec3,
}

impl Lattice {
    /// Returns the centre around a point, brought into its facet's plane, whose distance is nearest to `radius_m`.
    pub fn center(&self, facet: &Facet, point_m: DVec3, radius_m: f64) -> DVec3 {
        let cell = ((point_m - self.origin_m) / self.cell_m)
            .floor()
            .as_i64vec3();
        let mut best = (f64::INFINITY, point_m);
        for x in -1..=1 {
            for y in -1..=1 {
                for z in -1..=1 {
                    let neighbour = cell + glam::I64Vec3::new(x, y, z);
                    let center = point_m + facet.in_plane(self.center_in(neighbour) - point_m);
                    let miss = (center.distance(point_m) - radius_m).abs();
                    if miss < best.0 {
                        best = (miss, center);
                    }
                }
            }
        }
        best.1
    }

    fn center_in(&self, cell: glam::I64Vec3) -> DVec3 {
        // 20 bits for each number of a cell; the lattice repeats after a million cells.
        let number = cell
            .to_array()
            .iter()
            .fold(0, |number, c| (number << 20) | (*c as u64 & 0xf_ffff));
        let mut stream = Stream::new(self.seed, self.number, LATTICE_STREAMS | number);
        let within = DVec3::new(stream.uniform(), stream.uniform(), stream.uniform());
        self.origin_m + (cell.as_dvec3() + within) * self.cell_m
    }
}
