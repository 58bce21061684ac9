//! What queries answer.

use convex_support::{Scalar, Vector};

use crate::simplex::MAX_POINTS;

/// How an iterative method ended. The bounds of the answer hold in every case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Status {
    /// The bracket is as narrow as was asked for, or as rounding lets it be.
    Converged,
    /// The allowed iterations were used up first.
    IterationLimit,
    /// No further progress was possible in floating point before the bracket was that narrow; or a support map
    /// returned numbers that are not finite.
    Stalled,
}

/// The answer of [`distance`](crate::distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distance<V: Vector> {
    /// The distance of the two sets; 0 where they overlap, or what is measured where they touch to less than its own error.
    pub distance: V::Scalar,
    /// The distance is certainly not less: a plane separates the shapes by this much.
    pub lower: V::Scalar,
    /// The distance is certainly not more: two points of the shapes are this far apart.
    pub upper: V::Scalar,
    /// Whether the shapes have a point in common. Shapes that no plane is known to separate, and whose points are no farther apart than
    /// they are known to, touch, and count as overlapping.
    pub overlap: bool,
    /// The point of `a` closest to `b`; where they overlap, a point in or near both.
    pub point_a: V,
    /// The point of `b` closest to `a`.
    pub point_b: V,
    /// The unit vector from `point_b` to `point_a`, also where they touch; `None` where the shapes overlap by more than rounding.
    pub normal: Option<V>,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
}

impl<V: Vector> Distance<V> {
    /// The same of the shapes in the other order.
    #[inline(always)]
    pub(crate) fn reversed(self) -> Self {
        Self { point_a: self.point_b, point_b: self.point_a, normal: self.normal.map(|n| -n), ..self }
    }
}

/// The answer of [`intersects`](crate::intersects).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Intersection<V: Vector> {
    /// Whether the shapes have a point in common, if `status` is [`Status::Converged`]; else only the better guess.
    /// It agrees with [`Distance::overlap`].
    pub overlap: bool,
    /// A unit vector along which a plane separates the shapes, pointing from `b` to `a`; `None` where they overlap.
    ///
    /// Its components are rounded: where the gap itself is at the level of rounding, a few ε of the extent of both shapes,
    /// planes across it may overlap by an ulp of that extent.
    pub axis: Option<V>,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
}

impl<V: Vector> Intersection<V> {
    /// `Some(overlap)` where that is certain, `None` where the iteration ended undecided.
    #[must_use]
    pub fn decided(&self) -> Option<bool> {
        (self.status == Status::Converged).then_some(self.overlap)
    }
}

/// How a cast came out.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome<H, V> {
    /// It hits.
    Hit(H),
    /// It misses.
    Miss(Miss<V>),
    /// The iteration ended, for the reason given by the status, before either was certain.
    Undecided,
}

impl<H, V> Outcome<H, V> {
    /// The hit, if it is one.
    #[must_use]
    pub fn hit(self) -> Option<H> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss(_) | Self::Undecided => None,
        }
    }

    /// Whether it is a certain miss.
    #[must_use]
    pub const fn is_miss(&self) -> bool {
        matches!(self, Self::Miss(_))
    }
}

/// Why a cast misses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Miss<V> {
    /// A unit vector along which a plane separates the shape from the whole ray (up to its end, if it has one),
    /// pointing from the shape to the ray; a good [first axis](crate::RayCastOptions::axis) for a similar query.
    ///
    /// Its components are rounded, so that at a distance `L` along the ray the plane is off by `L` times half an ulp: a
    /// point of the ray that is a million sizes away may be behind it in `f32`.
    pub axis: V,
}

/// The answer of [`ray_cast`](crate::ray_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct RayCast<V: Vector> {
    /// Hit, miss, or undecided.
    pub outcome: Outcome<RayHit<V>, V>,
    /// No point of the ray before this parameter is in the target. Infinite of a miss, but where rounding decides whether the ray ends before
    /// it would hit.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// The point of the ray at this parameter is in the target; infinite where no such point is known, as of a hit that is a graze or a
    /// contact at the source within rounding, and may be a miss.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed.
    pub iterations: usize,
}

/// Where a ray enters a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RayHit<V: Vector> {
    /// The hit parameter, in units of the ray's direction; 0 where the source is in the target.
    pub lambda: V::Scalar,
    /// The hit spot, in the frame of the ray and the target: the source plus λ times the direction.
    pub point: V,
    /// The unit outward normal at the hit spot; any of them at an edge or a vertex; `None` where the source is in the
    /// target.
    pub normal: Option<V>,
}

/// The answer of [`ray_exit`](crate::ray_exit).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct RayExit<V: Vector> {
    /// Where the ray leaves, with the outward normal there; a miss where no point of the ray is in the target; or undecided.
    pub outcome: Outcome<RayHit<V>, V>,
    /// The point of the ray at this parameter is in the target; minus infinity where no such point is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub lower: V::Scalar,
    /// No point of the ray after this parameter is in the target; minus infinity of a miss.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub upper: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed.
    pub iterations: usize,
}

/// The answer of [`linear_cast`](crate::linear_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct LinearCast<V: Vector> {
    /// Hit, miss, or undecided. The axis of a miss points from `b` to `a`.
    pub outcome: Outcome<LinearHit<V>, V>,
    /// The shapes have no point in common before this time. Infinite of a miss, but where rounding decides whether the motion ends before
    /// they would meet; and of one that [leaves a contact](crate::StartInContact::IfDeeper) that it started in, which does not count.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// The shapes have a point in common at this time; infinite where no such time is known, as of a hit that is a graze or a contact at
    /// the start within rounding, and may be a miss.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed of each shape; where they overlap at the start, those of
    /// [`distance`](crate::distance) and [`signed_distance`](crate::signed_distance) as well.
    pub iterations: usize,
}

/// The first contact of two moving shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinearHit<V: Vector> {
    /// The time of first contact; 0 where the shapes overlap at the start.
    pub time: V::Scalar,
    /// A point of contact, in the world, at that time: a point of `b`, if a [target
    /// distance](crate::LinearCastOptions::target_distance) was asked for. Where the shapes overlap at the start, a point in or near
    /// both, as of [`distance`](crate::distance).
    pub point: V,
    /// The unit normal of contact, out of `b` towards `a`. Where the shapes overlap at the start by more than rounding, `None`; or the
    /// shortest way out, if it was asked whether the motion [goes deeper](crate::StartInContact::IfDeeper).
    pub normal: Option<V>,
}

/// What an observer is shown in every iteration.
///
/// Points and vectors are those of the configuration space obstacle as seen from the query point: the points of
/// `A − B` for [`distance`](crate::distance) and [`intersects`](crate::intersects), and the points `x − p` of
/// `{x} − C` with the current point `x` of the ray for casts. So it is always zero that is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Iterate<'a, V: Vector> {
    /// Counts from 0: the first iterate has an empty simplex and the first direction for its `v`; or, where a shape says its
    /// [closest point](convex_support::SupportMap::core_closest_point), that point for its simplex.
    pub iteration: usize,
    /// The vertices of the simplex that `v` lies in (the paper's `W`, `S_k` in the book); none at first. Relative to
    /// the query point, in units of `scale`.
    pub simplex: &'a [V],
    /// The point of the simplex closest to zero (`V_k`), in units of `scale`; the first direction at first.
    pub v: V,
    /// The support point found along `v` (`W_k`), in units of `scale`; in space at times along a direction that has been
    /// turned from it, by curvature or towards the best plane known.
    pub w: V,
    /// What the vectors above are to be multiplied by: a power of two.
    pub scale: V::Scalar,
    /// The lower bound: of the distance of the cores, or of the hit parameter λ.
    pub lower: V::Scalar,
    /// The upper bound of the same.
    pub upper: V::Scalar,
}

impl<V: Vector> Iterate<'_, V> {
    /// Shows the same of the bodies in the other order.
    #[inline(always)]
    pub(crate) fn reversed(&self, observer: impl FnOnce(Iterate<'_, V>)) {
        let mut simplex = [V::ZERO; MAX_POINTS];
        for (reversed, &point) in simplex.iter_mut().zip(self.simplex) {
            *reversed = -point;
        }
        observer(Iterate { simplex: &simplex[..self.simplex.len()], v: -self.v, w: -self.w, ..*self });
    }

    /// The width of the bracket.
    #[must_use]
    pub fn gap(&self) -> V::Scalar {
        let gap = self.upper - self.lower;
        if gap > V::Scalar::ZERO { gap } else { V::Scalar::ZERO }
    }
}
