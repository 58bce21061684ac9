//! Rays: the question of a ray cast, its options and its answer.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::options::{MAX_ITERATIONS, MayBeLean as _, Rare, options};
use crate::outcome::{check_finite, check_numbers};
use crate::{Cast, Miss, Outcome, RayCastError, Status, SubAlgorithm, WarmStart};

/// The ray of the points `source + λ·direction`, λ ≥ 0. The direction need not be of unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ray<V> {
    /// Its start.
    pub source: V,
    /// Its direction, which is the unit of λ.
    pub direction: V,
}

impl<V: Vector> Ray<V> {
    /// The point at parameter `lambda`.
    #[must_use]
    pub fn at(&self, lambda: V::Scalar) -> V {
        self.source + self.direction * lambda
    }

    /// The same ray, assembled from its coordinates.
    ///
    /// If some call takes a ray as a whole, in a rare case or behind `dyn`, the ray is kept in memory as it came,
    /// written in pieces of two numbers from its beginning. A direction read from there lies across two of them, and a
    /// processor waits until both are written, longer than a closed form takes. From coordinates, the compiler writes
    /// to memory what each call needs.
    #[inline(always)]
    pub(crate) fn by_coordinates(self) -> Self {
        let copied = |v: V| V::from_fn(|i| v.get(i));
        Self { source: copied(self.source), direction: copied(self.direction) }
    }

    /// The error of a ray that cannot be cast, with these options.
    pub(crate) fn check(&self, options: &RayCastOptions<V>) -> Result<(), RayCastError> {
        // Zero times what is not finite is NaN; a sum that overflows is looked at coordinate by coordinate.
        if (self.source + self.direction).dot(V::ZERO) != V::Scalar::ZERO {
            check_finite("source", self.source)?;
            check_finite("direction", self.direction)?;
        }
        if self.direction == V::ZERO {
            return Err(RayCastError::ZeroDirection);
        }
        check_numbers([("min_lambda", options.min_lambda), ("max_lambda", options.max_lambda)])
    }
}

/// How a cast finds the planes that bound its hit. Every method computes the bounds in the same way, so that the
/// choice changes only the time that a cast takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum CastMethod {
    /// The fastest. It begins with the [certain crossing](convex_support::SupportMap::certain_crossing) of the shape by
    /// the line, if the shape has one. Then, in 3D, a triangle of support points that the ray pierces (a portal) is
    /// moved towards the surface, by the simplex method of linear programming. If this leaves the answer in doubt, and
    /// in 2D, it is the same as [`Gjk`](Self::Gjk).
    #[default]
    Portal,
    /// The paper's Algorithm 3: each plane is across the vector from the ray's point to the simplex of support points.
    Gjk,
}

/// Options of [`ray_cast`](crate::ray_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct RayCastOptions<V: Vector> {
    /// The beginning of the ray, in units of its direction; it belongs to the ray. Points of the target before it do
    /// not count, so that a ray can start on a surface and leave it. A negative value is taken for zero. Default: 0.
    pub min_lambda: V::Scalar,
    /// The end of the ray, in units of its direction; the end belongs to the ray. If the ray ends where it enters the
    /// target, to rounding, neither a hit nor a miss is certain. If the end is before the beginning, or the
    /// beginning is infinite, the ray has no points, and the answer is a miss. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_lambda: V::Scalar,
    /// How far along the ray the hit may stay uncertain, relative to the size of the target. A bracket at the level of
    /// rounding always ends the iteration. A negative value and NaN are taken for zero. Default: 0.
    pub tolerance: V::Scalar,
    /// The iterations after which to give up, those of repeated searches included. Default: 200.
    pub max_iterations: usize,
    /// The warm start from the last frame's answer, which predicts the outward normal or a separating axis. Default:
    /// none.
    pub warm_start: Option<WarmStart<V>>,
    /// How the closest point of a simplex is found. Default: [`SubAlgorithm::Regions`].
    pub sub_algorithm: SubAlgorithm,
    /// How planes are found. Default: [`CastMethod::Portal`].
    pub method: CastMethod,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) rare: Rare<Self>,
}

impl<V: Vector> Default for RayCastOptions<V> {
    fn default() -> Self {
        Self { rare: Self::rare(), ..Self::lean() }
    }
}

impl<V: Vector> RayCastOptions<V> {
    /// The default options, with no machine code besides the closed forms of the shape and Algorithm 3: a program in
    /// which all options are lean has two fifths of the code for rays.
    ///
    /// The faster search of [`CastMethod::Portal`] is left out. It is then the same as [`Gjk`](CastMethod::Gjk) where
    /// no closed form is certain: a search takes two to five times as long, and its bracket may be wider. The second
    /// measurement of a source within rounding of the target is left out too: there the answer may be a hit that is not
    /// [certain](crate::RayCast::is_certain), or undecided, where the default options decide.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            min_lambda: V::Scalar::ZERO,
            max_lambda: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            max_iterations: MAX_ITERATIONS,
            warm_start: None,
            sub_algorithm: SubAlgorithm::Regions,
            method: CastMethod::Portal,
            rare: Rare(None),
        }
    }

    /// Whether the ray has no points: it ends before it begins, or begins at infinity.
    pub(crate) fn is_empty(&self) -> bool {
        let begin = self.min_lambda.max(V::Scalar::ZERO);
        !(begin <= self.max_lambda && begin < V::Scalar::infinity())
    }
}

options! {
    RayCastOptions: with_min_lambda(min_lambda: V::Scalar), with_max_lambda(max_lambda: V::Scalar),
    with_tolerance(tolerance: V::Scalar), with_max_iterations(max_iterations: usize),
    with_warm_start(warm_start: Option<WarmStart<V>>), with_axis(axis: V => warm_start = Some(WarmStart::new(axis))),
    with_sub_algorithm(sub_algorithm: SubAlgorithm), with_method(method: CastMethod)
}

/// The answer of [`ray_cast`](crate::ray_cast).
pub type RayCast<V> = Cast<RayHit<V>, V>;

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
