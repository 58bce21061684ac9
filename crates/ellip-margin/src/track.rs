//! The margin along a trajectory.

use convex_support::{Ellipsoid, Vector};

use crate::margin::{answer, solve};
use crate::pair::Pair;
use crate::{Margin, MarginOptions};

/// The margin of one pair along a trajectory, each step started from the last.
///
/// Newton's method for the secular equation converges from any start, so that a step may be of any size. After a turn
/// of 90 degrees, a jump, or even for another pair of bodies, the answer is that of
/// [`free_margin`](crate::free_margin); it only takes a few more iterations.
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MarginTracker {
    options: MarginOptions,
    /// ν at the last step with x₁ outside E₂, and its backward differences: ∇ν, ∇²ν, …; 0 where unknown.
    past: [f64; DEPTH],
    steps: u64,
    iterations: u64,
}

/// ν and its differences up to the fourth.
const DEPTH: usize = 5;

impl MarginTracker {
    /// A new tracker, without a step.
    #[must_use]
    pub const fn new(options: MarginOptions) -> Self {
        Self { options, past: [0.0; DEPTH], steps: 0, iterations: 0 }
    }

    /// The margin of `e1` about `e2`, which may have moved in any way since the last call.
    pub fn step<V: Vector>(&mut self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Margin<V> {
        if V::DIM == 2 { self.step_in::<V, 2>(e1, e2) } else { self.step_in::<V, 3>(e1, e2) }
    }

    fn step_in<V: Vector, const N: usize>(&mut self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Margin<V> {
        let pair = Pair::<N>::new(e1, e2);
        let solution = solve(&pair, self.forecast(), self.options, |_, _| {});
        self.note(solution.nu, solution.iterations);
        answer(&pair, solution)
    }

    /// Stores a step.
    #[inline]
    fn note(&mut self, nu: f64, iterations: usize) {
        // A step with x₁ in E₂ says nothing about the next one outside.
        if nu > 0.0 && nu.is_finite() {
            let mut difference = nu;
            for past in &mut self.past {
                let before = core::mem::replace(past, difference);
                difference -= before;
            }
        }
        self.steps += 1;
        self.iterations += iterations as u64;
    }

    /// The prediction of the next ν by the polynomial through the last k + 1 values, ν + ∇ν + … + ∇ᵏν, whose error at
    /// the last step was ∇ᵏ⁺¹ν: the k with the least error is taken. If even that was more than a 256th of ν there is
    /// no path to follow, and the bound that a cold start begins with is the better guess: 0.
    fn forecast(&self) -> f64 {
        let (mut sum, mut best, mut least) = (0.0, 0.0, f64::INFINITY);
        for k in 0..DEPTH - 1 {
            sum += self.past[k];
            let error = self.past[k + 1].abs();
            if error < least {
                (best, least) = (sum, error);
            }
        }
        if 256.0 * least < best { best } else { 0.0 }
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
