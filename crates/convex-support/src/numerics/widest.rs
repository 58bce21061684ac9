//! Loops over lanes in the widest vector instructions of the processor.

/// A loop over lanes in plain arithmetic, which the compiler turns into vector instructions.
pub trait Loop {
    /// Runs it. All of it must be inlined, this with `#[inline(always)]` too, or it is compiled for the target alone.
    fn run(self);
}

/// Runs a loop in the widest vector instructions of this processor, which are found at run time. None of them fuses or
/// reorders unless told to, so that the answers are the same.
#[cfg(feature = "simd")]
#[inline]
pub fn widest(lanes: impl Loop) {
    struct Run<L>(L);
    impl<L: Loop> pulp::NullaryFnOnce for Run<L> {
        type Output = ();

        #[inline(always)]
        fn call(self) {
            self.0.run();
        }
    }
    pulp::Arch::new().dispatch(Run(lanes));
}

/// Runs a loop in the vector instructions of the target.
#[cfg(not(feature = "simd"))]
#[inline]
pub fn widest(lanes: impl Loop) {
    lanes.run();
}
