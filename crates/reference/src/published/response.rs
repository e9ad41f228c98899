//! How a scratch answers light on a line of its band: by the table or wavelength by wavelength.

use hairline_optics::published::segments::BandSegments;
use hairline_optics::published::sine_integral::SineIntegral;
use hairline_optics::published::spectrum::PublishedSpectrum;
use hairline_optics::table::ScratchTable;

/// The spectrum of a material's scratches.
#[derive(Clone, Copy)]
pub(super) enum Response<'a> {
    Table(&'a ScratchTable),
    Wavelengths(&'a PublishedSpectrum, SineIntegral),
}

impl Response<'_> {
    /// Radiance over segments of a line, per unit of the scratch's share under a light of radiance 1, Fresnel left out.
    pub fn over(self, segments: &BandSegments, width_um: f64, depth_nm: f64) -> [f64; 3] {
        match self {
            Self::Table(table) => {
                let mut sum = [0.0; 3];
                for &[low, high] in &segments.ends[..segments.count] {
                    let at = |q: f64| table.scratch_table(width_um * q, depth_nm);
                    let (low, high) = (at(low), at(high));
                    (0..3).for_each(|c| sum[c] += high[c] - low[c]);
                }
                sum
            }
            Self::Wavelengths(spectrum, si) => spectrum.radiance(segments, width_um, depth_nm, si),
        }
    }

    /// The same from q = 0 on, for roots that know nothing of one another.
    pub fn up_to(self, q: f64, width_um: f64, depth_nm: f64) -> [f64; 3] {
        let mut segments = BandSegments::default();
        segments.push_segment(0.0, q);
        match self {
            Self::Table(table) => table.scratch_table(width_um * q, depth_nm),
            Self::Wavelengths(spectrum, si) => spectrum.radiance(&segments, width_um, depth_nm, si),
        }
    }

    /// The mean of |D|^2 in each channel.
    pub fn total(self, depth_nm: f64) -> [f64; 3] {
        match self {
            Self::Table(table) => table.scratch_table_total(depth_nm),
            Self::Wavelengths(spectrum, _) => spectrum.total(depth_nm),
        }
    }
}
