//! Four numbers side by side: one vector instruction for the arithmetic of a node.

use core::fmt::Debug;
use core::ops::{Add, Mul, Sub};

/// Four numbers of a [`Scalar`](crate::Scalar), as glam's vectors of four coordinates: their operations are vector
/// instructions where the processor has them.
pub trait Lanes<S>:
    Copy + Debug + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Send + Sync + 'static
{
    /// The same number four times.
    fn splat(value: S) -> Self;
    /// The numbers one by one.
    fn to_array(self) -> [S; 4];
    /// One of the numbers.
    fn get(self, lane: usize) -> S;
    /// Replaces one of the numbers.
    fn set(&mut self, lane: usize, value: S);
    /// The lesser of each two; that of `rhs` where one of them is NaN.
    #[must_use]
    fn min(self, rhs: Self) -> Self;
    /// The greater of each two; that of `rhs` where one of them is NaN.
    #[must_use]
    fn max(self, rhs: Self) -> Self;
    /// The square roots.
    #[must_use]
    fn sqrt(self) -> Self;
    /// `then` where `self ≤ rhs`, and `otherwise` where not.
    #[must_use]
    fn if_at_most(self, rhs: Self, then: Self, otherwise: Self) -> Self;
    /// A bit for each number that is at most `limit`, the lowest for the first.
    fn at_most(self, limit: S) -> u32;
}

/// Forwards to one of glam's types.
macro_rules! glam_lanes {
    ($V:ident, $S:ident, $select:expr) => {
        impl Lanes<$S> for glam::$V {
            #[inline]
            fn splat(value: $S) -> Self {
                Self::splat(value)
            }
            #[inline]
            fn to_array(self) -> [$S; 4] {
                Self::to_array(&self)
            }
            #[inline]
            fn get(self, lane: usize) -> $S {
                self[lane]
            }
            #[inline]
            fn set(&mut self, lane: usize, value: $S) {
                self[lane] = value;
            }
            #[inline]
            fn min(self, rhs: Self) -> Self {
                Self::min(self, rhs)
            }
            #[inline]
            fn max(self, rhs: Self) -> Self {
                Self::max(self, rhs)
            }
            #[inline]
            fn sqrt(self) -> Self {
                Self::sqrt(self)
            }
            #[inline]
            fn if_at_most(self, rhs: Self, then: Self, otherwise: Self) -> Self {
                ($select)(self, rhs, then, otherwise)
            }
            #[inline]
            fn at_most(self, limit: $S) -> u32 {
                self.cmple(Self::splat(limit)).bitmask()
            }
        }
    };
}

glam_lanes!(Vec4, f32, |a: glam::Vec4, b: glam::Vec4, then, otherwise| glam::Vec4::select(a.cmple(b), then, otherwise));
// By coordinates, since glam's own choice in double precision is a branch for each, and none of them is foreseeable.
glam_lanes!(DVec4, f64, |a: glam::DVec4, b: glam::DVec4, then: glam::DVec4, otherwise: glam::DVec4| {
    let choose = |a: f64, b: f64, then: f64, otherwise: f64| if a <= b { then } else { otherwise };
    glam::DVec4::new(
        choose(a.x, b.x, then.x, otherwise.x),
        choose(a.y, b.y, then.y, otherwise.y),
        choose(a.z, b.z, then.z, otherwise.z),
        choose(a.w, b.w, then.w, otherwise.w),
    )
});
