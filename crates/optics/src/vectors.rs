//! Vector instructions of the processor that runs the program, which the compiler cannot assume.

/// Runs `work`, compiled for each kind of vectors with all that is inlined into it; which one runs is chosen here. Works of some
/// microseconds are worth it.
#[cfg(not(target_arch = "wasm32"))]
#[inline(always)]
pub fn with_widest<T>(work: impl FnOnce() -> T) -> T {
    pulp::Arch::new().dispatch(work)
}

/// Runs `work`. WebAssembly has the vectors that the program is compiled for, and no others. One function compiled for relaxed ones is
/// enough for link-time optimisation to use them in all functions: browsers without them refuse the program, and LLVM 22 computes
/// `f32x4_pmax` by `f32x4.relaxed_max`, which is not the same for NaN (<https://github.com/llvm/llvm-project/pull/177814>): letters lose parts.
#[cfg(target_arch = "wasm32")]
#[inline(always)]
pub fn with_widest<T>(work: impl FnOnce() -> T) -> T {
    work()
}
