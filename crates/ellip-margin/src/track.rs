//! The margin along a trajectory.

use convex_support::{Ellipsoid, Scalar, Vector};
use num_traits::Float as _;

use crate::margin::margin_from;
use crate::{Margin, MarginOptions};

/// The margin of one pair along a trajectory, each step started from the last.
///
/// Newton's method for the secular equation converges from any start, so that there is no limit to the step: a turn of
/// 90 degrees, a teleport, another pair of bodies altogether give what [`free_margin`](crate::free_margin) gives, in
/// a few more iterations.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec2};
/// use ellip_margin::{MarginOptions, MarginTracker};
///
/// let obstacle = Ellipsoid::new(DVec2::new(3.0, 0.0), DVec2::new(1.0, 0.5), 0.2)?;
/// let mut track = MarginTracker::new(MarginOptions::default());
/// for step in 0..90 {
///     let link = Ellipsoid::new(DVec2::ZERO, DVec2::new(1.5, 0.3), f64::from(step).to_radians())?;
///     assert!(track.step(&link, &obstacle).margin > 0.0);
/// }
/// assert_eq!(track.steps(), 90);
/// assert!(track.iterations() <= 3 * 90);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MarginTracker {
    options: MarginOptions,
    /// ν at the last two steps with x₁ outside E₂, the last first; 0 where unknown.
    last: [f64; 2],
    steps: u64,
    iterations: u64,
}

impl MarginTracker {
    /// A tracker that has seen nothing yet.
    #[must_use]
    pub const fn new(options: MarginOptions) -> Self {
        Self { options, last: [0.0; 2], steps: 0, iterations: 0 }
    }

    /// The margin of `e1` about `e2`, wherever they have moved since the last call.
    pub fn step<V: Vector>(&mut self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Margin<V> {
        // On a smooth path the next ν lies on the line through the last two; a line that leads below half of the last is
        // a jump, not a path.
        let [last, before] = self.last;
        let line = 2.0 * last - before;
        let start = if before > 0.0 && line > 0.5 * last { line } else { last };
        let margin = margin_from(e1, e2, start, self.options, |_, _| {});
        // A step with x₁ in E₂ says nothing about the next one outside.
        if margin.nu > V::Scalar::ZERO && margin.nu.is_finite() {
            self.last = [margin.nu.as_f64(), last];
        }
        self.steps += 1;
        self.iterations += u64::from(margin.iterations);
        margin
    }

    /// The number of steps so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.steps
    }

    /// The number of iterations in all steps so far.
    #[must_use]
    pub const fn iterations(&self) -> u64 {
        self.iterations
    }
}

impl Default for MarginTracker {
    fn default() -> Self {
        Self::new(MarginOptions::default())
    }
}
