//! The answers of queries.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::WarmStart;
use crate::simplex::MAX_POINTS;

/// How an iterative method ended. The bounds of the answer hold in every case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Status {
    /// The bracket is as narrow as was asked for, or as narrow as rounding allows. A hit also has an upper bound.
    Converged,
    /// The iterations were used up before the bracket was that narrow.
    IterationLimit,
    /// No further progress was possible in floating point before the bracket was that narrow, for example if a hit may
    /// be a miss, or is certain only some way behind where it is found; or a support map returned numbers that are not
    /// finite.
    Stalled,
}

impl Status {
    /// The status of an outcome: a search that converged to a hit without an upper bound has stalled.
    pub(crate) fn of<H, V>(self, outcome: &Outcome<H, V>, is_bounded: bool) -> Self {
        if !outcome.is_certain(is_bounded) && self == Self::Converged { Self::Stalled } else { self }
    }
}

/// The answer of [`distance`](crate::distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Distance<V: Vector> {
    /// The distance of the two shapes; 0 where they overlap. If they touch, so that the measured distance is smaller
    /// than its own error, it is the measured distance.
    pub distance: V::Scalar,
    /// The distance is certainly not less: a plane separates the shapes by this much.
    pub lower: V::Scalar,
    /// The distance is certainly not more: two points of the shapes are this far apart.
    pub upper: V::Scalar,
    /// Whether the shapes have a point in common. Shapes touch, and count as overlapping, if no plane certainly
    /// separates them and their closest points are no farther apart than the error of these points.
    pub overlap: bool,
    /// The point of `a` closest to `b`, in the world; where the shapes overlap, a point in both, but for rounding.
    pub point_a: V,
    /// The point of `b` closest to `a`, in the world; where the shapes overlap, a point in both, but for rounding.
    pub point_b: V,
    /// The unit vector from `b` to `a`, across which a plane separates the shapes by [`lower`](Self::lower). It is also
    /// given where the shapes touch, if a plane across it separates them but for the width of a converged bracket; and
    /// is `None` otherwise.
    ///
    /// It is the normal of the plane, and not the direction of `point_a − point_b`, which has fewer digits near
    /// contact. `point_a − point_b` is the distance times the normal, to within √(2·`upper`·(`upper` − `lower`))
    /// plus 64ε of the sizes of both shapes and their offset.
    pub normal: Option<V>,
    /// How the iteration ended. The bracket of a converged answer is no wider than 24ε of both extents, both radii and
    /// the offset of the origins, plus three times the [errors](convex_support::Core::error) of both shapes, and the
    /// [tolerance](crate::DistanceOptions::tolerance) times `lower`; unless `lower` is beyond the
    /// [limit](crate::DistanceOptions::limit).
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
}

impl<V: Vector> Distance<V> {
    /// The answer for the shapes in the other order: from `b` to `a`.
    #[inline(always)]
    pub fn reversed(self) -> Self {
        Self { point_a: self.point_b, point_b: self.point_a, normal: self.normal.map(|n| -n), ..self }
    }
}

/// The answer of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SignedDistance<V: Vector> {
    /// The distance where the shapes are apart. Where they overlap, minus the penetration depth, which is the length of
    /// the shortest translation of `a` after which they have no interior point in common.
    pub signed_distance: V::Scalar,
    /// The signed distance is certainly not less: this is proved by planes across [`normal`](Self::normal). Minus
    /// infinity where a support map returned numbers that are not finite.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub lower: V::Scalar,
    /// The signed distance is certainly not more: two points of the shapes are this far apart, or, in overlap, the
    /// difference `A − B` contains the ball of radius `−upper` about zero. Infinity if a support map returned numbers
    /// that are not finite.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// The unit vector from `b` to `a`. If `a` is moved along it by the depth, the shapes no longer overlap. Where
    /// several ways out are equally short, it is the direction of one of them.
    pub normal: V,
    /// The point of `a` closest to `b`, or deepest in it. It is in `a` but for rounding, 8ε of the sizes of both shapes
    /// and their offset plus the error of its core, however the search ended. Uncertainty of the way out is in the
    /// bounds.
    pub point_a: V,
    /// The point of `b` such that `point_a − point_b` is the signed distance times the normal, with the same accuracy.
    /// The normal is that of a plane, across which points of curved shapes may be off by √(2·s·(`upper` − `lower`)),
    /// with `s` the sum of both sizes and the offset.
    pub point_b: V,
    /// Whether the shapes have a point in common, touching included: whether `signed_distance` is not positive. It is
    /// certain where `lower` and `upper` have the same sign.
    pub overlap: bool,
    /// How the search ended. The bounds hold in every case.
    ///
    /// [`Converged`](Status::Converged) promises that `upper − lower` is at most `6e`, with `e` = 8ε`s` plus the
    /// [errors](convex_support::Core::error) of both cores, and `s` the sum of both sizes and the offset. Where curved
    /// shapes may overlap, so that `lower` is not positive, it is at most `6e` plus the
    /// [tolerance](crate::SignedDistanceOptions::tolerance) times `s`. Or the signed distance is certainly beyond a
    /// limit of the options.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
    /// The number of facets of the last polytope that did not have to be expanded, since no way out through them is
    /// shorter. 0 if no polytope was needed.
    pub unexpanded: usize,
}

impl<V: Vector> SignedDistance<V> {
    /// The answer for the shapes in the other order: from `b` to `a`.
    pub fn reversed(self) -> Self {
        Self { normal: -self.normal, point_a: self.point_b, point_b: self.point_a, ..self }
    }
}

/// The answer of [`intersects`](crate::intersects).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Intersection<V: Vector> {
    /// Whether the shapes have a point in common. This is certain if `status` is [`Status::Converged`], and otherwise a
    /// guess; [`decided`](Self::decided) tells the two apart. It agrees with [`Distance::overlap`]: shapes that touch,
    /// to rounding, have a point in common.
    pub overlap: bool,
    /// A unit vector along which a plane separates the shapes, pointing from `b` to `a`; `None` where they overlap.
    ///
    /// Its components are rounded. So if the gap is as small as rounding, a few ε of the extent of both shapes, the
    /// width of the slab across the rounded axis may be negative, by an ulp of that extent.
    pub axis: Option<V>,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed of each shape.
    pub iterations: usize,
}

impl<V: Vector> Intersection<V> {
    /// `Some(overlap)` if it is certain, `None` if the iteration ended undecided.
    #[must_use]
    pub fn decided(&self) -> Option<bool> {
        (self.status == Status::Converged).then_some(self.overlap)
    }
}

/// How a cast ended: with a hit, with a miss, or with neither.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Outcome<H, V> {
    /// A hit. It is certain if the upper bound of the answer is finite; otherwise the status is not
    /// [`Status::Converged`].
    Hit(H),
    /// A miss, which is certain: a plane proves it.
    Miss(Miss<V>),
    /// The iteration ended, for the reason given by the status, before a hit or a miss was certain. Nothing is hit
    /// before the lower bound of the answer. So if a program has to choose, it is safe to take the lower bound for the
    /// hit.
    Undecided,
}

impl<H, V> Outcome<H, V> {
    /// The hit, if there is one.
    #[must_use]
    pub fn hit(self) -> Option<H> {
        match self {
            Self::Hit(hit) => Some(hit),
            Self::Miss(_) | Self::Undecided => None,
        }
    }

    pub(crate) fn map<G>(self, of: impl FnOnce(H) -> G) -> Outcome<G, V> {
        match self {
            Self::Hit(hit) => Outcome::Hit(of(hit)),
            Self::Miss(miss) => Outcome::Miss(miss),
            Self::Undecided => Outcome::Undecided,
        }
    }

    /// Whether this is a hit.
    #[must_use]
    pub const fn is_hit(&self) -> bool {
        matches!(self, Self::Hit(_))
    }

    /// Whether this is certain: every miss is, and a hit with an upper bound.
    pub(crate) const fn is_certain(&self, is_bounded: bool) -> bool {
        match self {
            Self::Hit(_) => is_bounded,
            Self::Miss(_) => true,
            Self::Undecided => false,
        }
    }

    /// Ends a cast of which no plane proves that it ends before the hit, and returns the upper bound that is left. Where
    /// the hit may be after the end, by rounding, it has none, so that neither a hit nor a miss is certain; and where
    /// the `time` of the hit is after the end, or no number, it is no hit.
    pub(crate) fn until<S: Scalar>(&mut self, end: S, upper: S, time: impl FnOnce(&H) -> S) -> S {
        if let Self::Hit(hit) = self {
            let time = time(hit);
            if !(time <= end && time.is_finite()) {
                *self = Self::Undecided;
            }
        }
        if upper <= end { upper } else { S::infinity() }
    }

    /// Whether neither a hit nor a miss is certain.
    #[must_use]
    pub const fn is_undecided(&self) -> bool {
        matches!(self, Self::Undecided)
    }

    /// Whether this is a certain miss.
    #[must_use]
    pub const fn is_miss(&self) -> bool {
        matches!(self, Self::Miss(_))
    }
}

impl<H, V: Vector> Outcome<H, V> {
    /// The warm start for the next frame, from this outcome and the warm start of this frame.
    fn warm_start(&self, before: Option<WarmStart<V>>, normal: impl FnOnce(&H) -> Option<V>) -> Option<WarmStart<V>> {
        match self {
            Self::Hit(hit) => normal(hit).map(|normal| WarmStart::after(before, normal)).or(before),
            Self::Miss(miss) => Some(WarmStart::new(miss.axis)),
            Self::Undecided => before,
        }
    }
}

/// Why a cast misses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Miss<V> {
    /// A unit vector along which a plane separates the shape from the whole ray (up to its end, if it has one),
    /// pointing from the shape to the ray; a good [first axis](crate::WarmStart::new) for a similar query.
    ///
    /// Its components are rounded, so that at a distance `L` along the ray the plane is off by `L` times half an ulp.
    /// In `f32`, a point of the ray at a distance of a million sizes from the shape may be on the wrong side of the
    /// plane.
    pub axis: V,
}

/// The answer of [`ray_cast`](crate::ray_cast), [`linear_cast`](crate::linear_cast) or
/// [`motion_cast`](crate::motion_cast). Its *time* is the parameter of the ray or of the motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "H: serde::Serialize, V: crate::data::VectorData")))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "H: serde::Deserialize<'de>, V: crate::data::VectorData")))]
pub struct Cast<H, V: Vector> {
    /// Hit, miss, or undecided. The axis of a miss of two bodies points from `b` to `a`. For a motion that turns it is
    /// the normal of the last separating plane.
    pub outcome: Outcome<H, V>,
    /// The bodies, or the ray and its target, have no point in common before this time. For a miss it is infinite, or
    /// the end of a motion that turns. If bodies may [begin in contact](crate::StartInContact::IfDeeper), no hit in that
    /// sense happens before.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// They have had a point in common by this time, which is not after the end of the cast. If they graze one another
    /// within rounding, or have no inside, they may have parted again. It is infinite if no such time is known: for
    /// a miss, and for a hit that may be a miss, since the bodies graze each other, touch at the start, or first touch
    /// at the end, within rounding. Bodies that may [begin in contact](crate::StartInContact::IfDeeper) get deeper from
    /// then on at the latest, or have touched again.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// How the search ended.
    pub status: Status,
    /// The number of support points computed of each shape. If bodies that move straight overlap at the start, those of
    /// [`distance`](crate::distance) and [`signed_distance`](crate::signed_distance) are included.
    pub iterations: usize,
}

impl<H, V: Vector> Cast<H, V> {
    /// With no upper bound.
    pub(crate) fn without_upper(outcome: Outcome<H, V>, lower: V::Scalar, status: Status, iterations: usize) -> Self {
        Self { outcome, lower, upper: V::Scalar::infinity(), status, iterations }
    }

    /// Whether the outcome is certain: a hit is if the upper bound is finite, and a miss always.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.outcome.is_certain(self.upper < V::Scalar::infinity())
    }
}

impl<V: Vector> RayCast<V> {
    /// Of a ray without points, which any plane separates from the shape.
    pub(crate) fn missed(axis: V) -> Self {
        let axis = axis.unit().unwrap_or_else(|| V::axis(0));
        Self::without_upper(Outcome::Miss(Miss { axis }), V::Scalar::infinity(), Status::Converged, 0)
    }

    /// The warm start for the [cast of the next frame](crate::RayCastOptions::warm_start), from this answer and its own
    /// warm start.
    #[must_use]
    pub fn warm_start(&self, before: Option<WarmStart<V>>) -> Option<WarmStart<V>> {
        self.outcome.warm_start(before, |hit| hit.normal)
    }
}

impl<V: Vector> LinearCast<V> {
    /// The warm start for the [cast of the next frame](crate::LinearCastOptions::warm_start), from this answer and its
    /// own warm start.
    #[must_use]
    pub fn warm_start(&self, before: Option<WarmStart<V>>) -> Option<WarmStart<V>> {
        self.outcome.warm_start(before, |hit| hit.normal)
    }
}

/// The answer of [`ray_cast`](crate::ray_cast).
pub type RayCast<V> = Cast<RayHit<V>, V>;

/// The answer of [`linear_cast`](crate::linear_cast).
pub type LinearCast<V> = Cast<Impact<V>, V>;

/// The answer of [`motion_cast`](crate::motion_cast).
pub type MotionCast<V> = Cast<Impact<V>, V>;

/// Where a ray enters a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RayHit<V: Vector> {
    /// The hit parameter, in units of the ray's direction; 0 if the source is in the target.
    pub lambda: V::Scalar,
    /// The point that is hit, in the frame of the ray and the target: the source plus λ times the direction.
    pub point: V,
    /// The unit outward normal there; at an edge or a vertex, one of the normals. `None` if the ray begins in the
    /// target.
    pub normal: Option<V>,
}

/// The answer of [`ray_exit`](crate::ray_exit).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct RayExit<V: Vector> {
    /// Where the ray leaves, with the outward normal there; a miss if no point of the ray is in the target; or
    /// undecided.
    pub outcome: Outcome<RayHit<V>, V>,
    /// A point of the ray at this parameter, or after it, is in the target; minus infinity if no such point is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub lower: V::Scalar,
    /// No point of the ray after this parameter is in the target; minus infinity for a miss.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_minus_infinity"))]
    pub upper: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed.
    pub iterations: usize,
}

impl<V: Vector> RayExit<V> {
    /// Whether the outcome is certain: a hit is if the lower bound is finite, and a miss always.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.outcome.is_certain(self.lower > -V::Scalar::infinity())
    }
}

/// The first contact of two moving bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Impact<V: Vector> {
    /// The time of first contact; 0 if the bodies touch or overlap at the start, unless only a motion that [goes
    /// deeper](crate::StartInContact::IfDeeper) counts.
    pub time: V::Scalar,
    /// A point of contact, in the world, at that time. With a [target
    /// distance](crate::LinearCastOptions::target_distance) it is a point of `b`. If the bodies overlap at the start,
    /// it is a point in both but for rounding, as in [`distance`](crate::distance).
    pub point: V,
    /// The unit normal of contact, out of `b` towards `a`. If the bodies overlap at the start by more than rounding, it
    /// is `None`; with [`StartInContact::IfDeeper`](crate::StartInContact::IfDeeper), it is the shortest way out.
    pub normal: Option<V>,
}

/// The state of an iteration that an observer sees.
///
/// Its points and vectors are those of the configuration space obstacle, relative to the query point: the points of
/// `A − B` for [`distance`](crate::distance) and [`intersects`](crate::intersects), and for casts the points `x − p`
/// of `{x} − C`, with the current point `x` of the ray. So in every case the iteration searches for zero.
#[derive(Clone, Copy, Debug)]
pub struct Iterate<'a, V: Vector> {
    /// The number of the iterate, from 0. The first has an empty simplex and the first direction for its `v`. If a
    /// shape knows its [closest point](convex_support::SupportMap::core_closest_point), the first simplex is that
    /// point.
    pub iteration: usize,
    /// The vertices of the simplex that `v` lies in (the paper's `W`, `S_k` in the book), relative to the query point,
    /// in units of `scale`; empty at first.
    pub simplex: &'a [V],
    /// The point of the simplex closest to zero (`V_k`), in units of `scale`; in the first iterate, the first
    /// direction.
    pub v: V,
    /// The support point found along `v` (`W_k`), in units of `scale`. In 3D the direction may have been turned from
    /// `v`, by curvature or towards the best plane known.
    pub w: V,
    /// The factor, a power of two, that turns the vectors above into lengths of the world.
    pub scale: V::Scalar,
    /// The lower bound: of the distance of the cores, or of the hit parameter λ.
    pub lower: V::Scalar,
    /// The upper bound of the same value.
    pub upper: V::Scalar,
}

impl<V: Vector> Iterate<'_, V> {
    /// Shows the iterate for the bodies in the other order.
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

/// The state of a motion cast that an observer sees at every time examined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionIterate<V: Vector> {
    /// Counts from 0.
    pub iteration: usize,
    /// The time examined.
    pub time: V::Scalar,
    /// The certain distance of a separating plane between the bodies then; not positive if none is known.
    pub gap: V::Scalar,
    /// The unit normal of that plane, from `b` to `a`.
    pub normal: V,
    /// The bodies have no point in common up to this time.
    pub lower: V::Scalar,
    /// The bodies have a point in common at this time; infinite if none is known.
    pub upper: V::Scalar,
}
