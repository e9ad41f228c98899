//! Pass: from segments to the picture: how many tiles the line of each comes near to.
//!
//! Inputs: frame, objects, segments. Output: where the entries of each segment begin, and how many there are. One invocation a segment.

use crate::compute_pass::{ComputePass, Recording, Use, in_a_row};
use crate::device::Gpu;
use crate::pipelines::Orders;
use crate::scan::ScanPasses;
use crate::shaders;
use crate::strip::{Lists, whole};

/// Twin: project.wgsl, bin.wgsl.
pub(crate) const WORKGROUP: u32 = 256;

pub(crate) struct ProjectPass(ComputePass);

impl ProjectPass {
    pub(crate) fn new(orders: &mut Orders) -> Self {
        let module = (&shaders::PROJECT, "project");
        Self(ComputePass::order(
            orders,
            "project",
            module,
            &[Use::Writes],
            &[],
        ))
    }

    pub(crate) fn record(
        &self,
        gpu: &Gpu,
        recording: &mut Recording,
        scans: &ScanPasses,
        lists: &Lists,
        segments: u32,
    ) {
        let workgroups = in_a_row((segments + 1).div_ceil(WORKGROUP));
        self.0
            .run(gpu, recording, &[whole(&lists.entry_starts)], workgroups);
        scans.record(recording.encoder, &lists.entry_scan, recording.timing);
    }
}
