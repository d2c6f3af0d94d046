//! Plain loops compiled for the machine's wide vectors: the only file that imports `pulp`.

/// Runs `task` compiled for AVX2 where the processor has it.
///
/// Rust neither reorders nor fuses floating-point operations, so the result has the same bits on
/// every processor; only products of matrices may round differently elsewhere.
#[inline(always)]
pub fn wide<R>(task: impl FnOnce() -> R) -> R {
    pulp::Arch::new().dispatch(task)
}
