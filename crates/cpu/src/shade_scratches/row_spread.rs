//! Spread of the grooves of a grating under a pixel.

use hairline_index::IndexedProfile;
use hairline_optics::band::BandMotion;
use hairline_optics::grating::{GRATING_DEPTH_NM, GRATING_WIDTH_UM};

/// A grating's table is looked up as that of such a scratch.
pub(crate) const ROW_PROFILE: IndexedProfile =
    IndexedProfile::rectangle(GRATING_WIDTH_UM as f32, GRATING_DEPTH_NM as f32);

/// Spread of the grooves of a grating under a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowSpread {
    /// Index of the grating's table in the scene.
    pub table: usize,
    /// Angles by which the grooves turn to the left over one standard deviation of the pixel's filter to the right and down.
    pub turns_rad: [f64; 2],
    /// Standard deviation of their angles at any place.
    pub angle_std_rad: f64,
}

impl RowSpread {
    /// Computes the movement of the band over the pixel. `moves` are how xi_t does by what turns and shifts but the tangent, for a step to the
    /// right and down.
    pub fn motion(&self, moves: [f64; 2], xi_n: f64) -> BandMotion {
        let [right, down] = [0, 1].map(|j| moves[j] + self.turns_rad[j] * xi_n);
        let within = self.angle_std_rad * xi_n;
        BandMotion {
            shift: 0.0,
            variance: right * right + down * down + within * within,
        }
    }
}
