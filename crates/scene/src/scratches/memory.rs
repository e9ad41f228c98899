//! What scratches take of the memory, here and in what renderers make of them; an estimate on the safe side.

use hairline_optics::method::Gather;

use super::MOST_SEGMENTS;
use crate::error::Error;
use crate::scene::{Scratch, Segment};

/// What renderers keep for a segment besides the scene: its effective form and its share of a tree, in main memory and once
/// more on the GPU.
const RENDERED_BYTES: u64 = 160;
/// Grids of many scratches (docs/model.md, section 7) keep at most so much for each segment.
pub const GRID_SEGMENT_BYTES: u64 = 256;
/// While they are made, and packed for a GPU, there are so many times as much: measured 1.3 times on the CPU
/// (docs/many-scratches.md), and the copy for a GPU is no larger than one texture.
const GRIDS_IN_MAKING: f64 = 1.8;

/// What a segment takes by the way it is gathered.
pub(crate) fn segment_bytes(gather: Gather) -> f64 {
    let single = (size_of::<Segment>() as u64 + RENDERED_BYTES) as f64;
    single + grid_bytes(gather)
}

/// What it takes of that beside what it takes for itself.
fn grid_bytes(gather: Gather) -> f64 {
    match gather {
        Gather::Exact => 0.0,
        Gather::Clusters | Gather::Tally => GRIDS_IN_MAKING * GRID_SEGMENT_BYTES as f64,
    }
}

/// A layer that is to be laid.
pub(super) struct Demand {
    /// Scratches.
    pub count: u64,
    /// Segments of one, in the mean.
    pub segments_each: f64,
    /// How they are gathered.
    pub gather: Gather,
}

impl Demand {
    fn each_bytes(&self, gather: Gather) -> f64 {
        size_of::<Scratch>() as f64 + self.segments_each * segment_bytes(gather)
    }

    fn fits(&self, gather: Gather, free_bytes: f64) -> bool {
        let segments = self.segments_each * self.count as f64;
        self.each_bytes(gather) * self.count as f64 <= free_bytes && segments < MOST_SEGMENTS as f64
    }

    /// What it takes, in bytes.
    ///
    /// # Errors
    /// At `key`: more than `free_bytes`, or more segments than renderers can number.
    pub fn check(&self, free_bytes: f64, key: impl Fn() -> String) -> Result<f64, Error> {
        let each_bytes = self.each_bytes(self.gather);
        let bytes = each_bytes * self.count as f64;
        if self.fits(self.gather, free_bytes) {
            return Ok(bytes);
        }
        let segments = self.segments_each * self.count as f64;
        let fitting = (free_bytes / each_bytes).min(MOST_SEGMENTS as f64 / self.segments_each);
        let (with_grids, or_exact) = match self.gather {
            Gather::Exact => ("", ""),
            Gather::Clusters | Gather::Tally if self.fits(Gather::Exact, free_bytes) => (
                WITH_GRIDS,
                ", or for gather = \"exact\", with which they fit",
            ),
            Gather::Clusters | Gather::Tally => (WITH_GRIDS, ""),
        };
        Err(Error::new(
            key(),
            format!(
                "found {} scratches, which would take about {} of memory in {segments:.1e} segments{with_grids}",
                self.count,
                gibibytes(bytes)
            ),
            format!(
                "there are {} for them; ask for at most about {fitting:.1e}, or for shorter ones{or_exact}",
                gibibytes(free_bytes)
            ),
        ))
    }
}

const WITH_GRIDS: &str = ", grids of many scratches included";

/// Refuses grids of scratches that are laid already and have had none so far.
///
/// # Errors
/// They do not fit into `free_bytes`.
pub(crate) fn check_grids(gather: Gather, segments: usize, free_bytes: f64) -> Result<(), Error> {
    let bytes = segments as f64 * grid_bytes(gather);
    if bytes <= free_bytes {
        return Ok(());
    }
    Err(Error::new(
        "render.gather",
        format!(
            "found \"{}\", which would take about {} of memory for grids of {:.1e} segments",
            if gather == Gather::Tally {
                "tally"
            } else {
                "clusters"
            },
            gibibytes(bytes),
            segments as f64
        ),
        format!(
            "there are {} for them; ask for fewer or shorter scratches, or for \"exact\"",
            gibibytes(free_bytes)
        ),
    ))
}

fn gibibytes(bytes: f64) -> String {
    format!("{:.2} GiB", bytes / (1u64 << 30) as f64)
}
