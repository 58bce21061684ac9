//! The options of queries.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::cast::Quicker;
use crate::extra::Extra;
use crate::linear_cast::AtStart;
use crate::motion::FullMotion;
use crate::separation::Closer;
use crate::{SubAlgorithm, WarmStart};

/// Iterations after which a query gives up. Polytopes and smooth shapes need a dozen. The cap only bounds the time
/// spent on a support map that breaks its laws.
const MAX_ITERATIONS: usize = 200;

/// Support points after which a signed distance gives up. Polytopes need some dozens, smooth shapes about a hundred.
/// The cap bounds the time for ties, such as an ellipsoid of revolution within another about the same axis.
const MAX_DEPTH_ITERATIONS: usize = 500;

/// Times to examine in a motion cast, after which to give up. A contact takes about ten, and each turn near another
/// body about as many; bodies that spin for long very near one another take the most.
const MAX_LOOKS: usize = 10_000;

/// The methods `with_…` of options. Each sets the field of its argument's name, unless another field is given.
macro_rules! setters {
    ($($with:ident($argument:ident: $Type:ty $(=> $field:ident = $value:expr)?)),*) => {
        $(setters! { @ $with($argument: $Type) $($field = $value;)? $argument = $argument; })*
    };
    (@ $with:ident($argument:ident: $Type:ty) $field:ident = $value:expr; $($rest:tt)*) => {
        #[doc = concat!(
            "With [`", stringify!($field), "`](Self::", stringify!($field), ") set to `", stringify!($value), "`."
        )]
        #[must_use]
        pub const fn $with(mut self, $argument: $Type) -> Self {
            self.$field = $value;
            self
        }
    };
}

/// Implements `Default` by `new`.
macro_rules! new_by_default {
    ($($Options:ident),*) => {$(
        impl<V: Vector> Default for $Options<V> {
            fn default() -> Self {
                Self::new()
            }
        }
    )*};
}

new_by_default!(DistanceOptions, SignedDistanceOptions, IntersectOptions);
new_by_default!(RayCastOptions, LinearCastOptions, MotionCastOptions);

/// Options of [`distance`](crate::distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct DistanceOptions<V: Vector> {
    /// The width of the bracket at which to stop, relative to the distance. A bracket at the level of rounding,
    /// relative to the size of the shapes and their distance, always ends the iteration. A negative value and NaN are
    /// taken for zero. Default: 0.
    pub tolerance: V::Scalar,
    /// Stop as soon as the distance is certain to exceed this limit; the bracket may then still be wide. NaN is no
    /// limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub limit: V::Scalar,
    /// The iterations after which to give up. Default: 200.
    pub max_iterations: usize,
    /// A first guess of the direction from `b` to `a`, such as the normal of the last answer. Default: none.
    pub axis: Option<V>,
    /// How the closest point of a simplex is found. Default: [`SubAlgorithm::Regions`].
    pub sub_algorithm: SubAlgorithm,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) extra: Extra<Closer<V>>,
}

impl<V: Vector> DistanceOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        Self { extra: Closer::named(), ..Self::lean() }
    }

    /// The default options, with no machine code besides GJK: a program in which all options are lean has a third
    /// of the code for distances.
    ///
    /// The second measurement near contact is left out: of bodies that are apart, or overlap, by no more than a few
    /// roundings of their sizes. There the bracket is as wide as the errors of the largest number in the query, and if
    /// GJK alone does not decide whether they are apart, the status is [`Status::Stalled`](crate::Status::Stalled). All
    /// other answers are the same to the last bit.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            tolerance: V::Scalar::ZERO,
            limit: V::Scalar::infinity(),
            max_iterations: MAX_ITERATIONS,
            axis: None,
            sub_algorithm: SubAlgorithm::Regions,
            extra: Extra::NONE,
        }
    }

    setters! {
        with_limit(limit: V::Scalar), with_tolerance(tolerance: V::Scalar), with_max_iterations(max_iterations: usize),
        with_axis(axis: V => axis = Some(axis)), with_sub_algorithm(sub_algorithm: SubAlgorithm)
    }
}

/// Options of [`signed_distance`](crate::signed_distance).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct SignedDistanceOptions<V: Vector> {
    /// The width of the bracket at which to stop in overlap, relative to the sizes of the shapes and their distance. It
    /// concerns curved shapes; for polytopes the facet that decides is found exactly. Default: 1e-9 in `f64`, 8ε in
    /// `f32`.
    pub tolerance: V::Scalar,
    /// Stop as soon as the shapes are certain to be farther apart than this. NaN is no limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub limit: V::Scalar,
    /// Stop as soon as the depth is certain to exceed this. NaN is no limit. Default: infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub depth_limit: V::Scalar,
    /// The support points of each shape after which to give up. If the depth is not known exactly by then, the closest
    /// points of both shapes may take a sixteenth more. Default: 500.
    pub max_iterations: usize,
    /// A first guess of the direction from `b` to `a`, such as the normal of the last answer. Default: none.
    pub axis: Option<V>,
}

impl<V: Vector> SignedDistanceOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        let least = V::Scalar::from_f64(8.0) * V::Scalar::EPSILON;
        Self {
            tolerance: V::Scalar::from_f64(1e-9).max(least),
            limit: V::Scalar::infinity(),
            depth_limit: V::Scalar::infinity(),
            max_iterations: MAX_DEPTH_ITERATIONS,
            axis: None,
        }
    }

    setters! {
        with_tolerance(tolerance: V::Scalar), with_limit(limit: V::Scalar), with_depth_limit(depth_limit: V::Scalar),
        with_max_iterations(max_iterations: usize), with_axis(axis: V => axis = Some(axis))
    }
}

/// Options of [`intersects`](crate::intersects).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct IntersectOptions<V: Vector> {
    /// The iterations after which to give up. Default: 200.
    pub max_iterations: usize,
    /// A first guess of a separating axis, pointing from `b` to `a`, such as the [`axis`](crate::Intersection::axis)
    /// of the last answer. Default: none.
    pub axis: Option<V>,
    /// How the closest point of a simplex is found. Default: [`SubAlgorithm::Regions`].
    pub sub_algorithm: SubAlgorithm,
}

impl<V: Vector> IntersectOptions<V> {
    /// The default options.
    #[must_use]
    pub const fn new() -> Self {
        Self { max_iterations: MAX_ITERATIONS, axis: None, sub_algorithm: SubAlgorithm::Regions }
    }

    setters! {
        with_max_iterations(max_iterations: usize), with_axis(axis: V => axis = Some(axis)),
        with_sub_algorithm(sub_algorithm: SubAlgorithm)
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

/// What a cast answers if the bodies touch at the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum StartInContact {
    /// A hit at time 0, whatever the motion.
    #[default]
    Report,
    /// A hit is the first time from which the bodies get deeper into one another than they began, or at which they
    /// touch again after they were apart. Sliding, rolling or turning at the same depth is no hit, and neither is
    /// moving apart. Bodies that move straight get deeper at once, a hit at time 0, or never: a miss.
    ///
    /// Deeper means deeper by more than a slack. The slack is the sum of 16ε of the bodies' sizes and a few times the
    /// rounding of their places and of their support points. Either answer about bodies that move straight is proved;
    /// if their depth at the start is not known to the slack, it may be undecided. For bodies that turn, the
    /// uncertainty of that depth adds to the slack. While they stay as deep as they began, to this slack, the time when
    /// they begin to sink cannot be known. So the lower bound of their hit is 0, and if they may have sunk from the
    /// start on, its time is 0 too.
    ///
    /// The answer is undecided if bodies come up from an overlap until they only touch, to rounding, and go down again.
    /// It is also undecided if a body rolls on its own edge or its own round face, unless it is a ball: its support
    /// points tell nothing of the points between them.
    IfDeeper,
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
    pub(crate) extra: Extra<Quicker<V>>,
}

impl<V: Vector> RayCastOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        Self { extra: Quicker::named(), ..Self::lean() }
    }

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
            extra: Extra::NONE,
        }
    }

    /// Whether the ray has no points: it ends before it begins, or begins at infinity.
    pub(crate) fn is_empty(&self) -> bool {
        let begin = self.min_lambda.max(V::Scalar::ZERO);
        !(begin <= self.max_lambda && begin < V::Scalar::infinity())
    }

    setters! {
        with_min_lambda(min_lambda: V::Scalar), with_max_lambda(max_lambda: V::Scalar),
        with_tolerance(tolerance: V::Scalar), with_max_iterations(max_iterations: usize),
        with_warm_start(warm_start: Option<WarmStart<V>>),
        with_axis(axis: V => warm_start = Some(WarmStart::new(axis))), with_sub_algorithm(sub_algorithm: SubAlgorithm),
        with_method(method: CastMethod)
    }
}

/// Options of [`linear_cast`](crate::linear_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct LinearCastOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. If the motion ends at the first contact, to rounding, neither a
    /// hit nor a miss is certain. If it is negative, the motion has no time, and the answer is a miss. Default:
    /// infinity.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// The distance at which the shapes count as touching: the cast stops that far from contact. A negative value is
    /// taken for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// What to answer if the shapes touch at the start. To step a world from contact to contact, take
    /// [`StartInContact::IfDeeper`]. Default: [`StartInContact::Report`].
    pub start_in_contact: StartInContact,
    /// How far from contact, relative to the sizes of the shapes, the answer may stay uncertain. A bracket at the level
    /// of rounding always ends the iteration. A negative value and NaN are taken for zero. Default: 0.
    pub tolerance: V::Scalar,
    /// The iterations after which to give up, those of repeated searches included. Only the depths that
    /// [`StartInContact::IfDeeper`] looks at may take as many each. Default: 200.
    pub max_iterations: usize,
    /// The warm start from the last frame's answer, which predicts the direction from `b` to `a` at contact. Default:
    /// none.
    pub warm_start: Option<WarmStart<V>>,
    /// How the closest point of a simplex is found. Default: [`SubAlgorithm::Regions`].
    pub sub_algorithm: SubAlgorithm,
    /// How planes are found. Default: [`CastMethod::Portal`].
    pub method: CastMethod,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) extra: Extra<AtStart<V>>,
}

impl<V: Vector> LinearCastOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        Self { extra: AtStart::named(), ..Self::lean() }
    }

    /// The default options, with no machine code besides Algorithm 3 and the closed forms for points and balls: a
    /// program in which all options are lean has three tenths of the code for linear casts.
    ///
    /// The faster search of [`CastMethod::Portal`] is left out, as in [`RayCastOptions::lean`], and so are all
    /// measurements at the start besides the cast itself. If shapes touch or overlap there, the hit has a point of
    /// both, but no normal. It is certain only if the search happens to end with points of both around the start. With
    /// [`StartInContact::IfDeeper`] shapes that may be in contact at the start are
    /// [undecided](crate::Outcome::Undecided).
    #[must_use]
    pub fn lean() -> Self {
        Self {
            max_time: V::Scalar::infinity(),
            target_distance: V::Scalar::ZERO,
            start_in_contact: StartInContact::Report,
            tolerance: V::Scalar::ZERO,
            max_iterations: MAX_ITERATIONS,
            warm_start: None,
            sub_algorithm: SubAlgorithm::Regions,
            method: CastMethod::Portal,
            extra: Extra::NONE,
        }
    }

    setters! {
        with_max_time(max_time: V::Scalar), with_target_distance(target_distance: V::Scalar),
        with_start_in_contact(start_in_contact: StartInContact), with_tolerance(tolerance: V::Scalar),
        with_max_iterations(max_iterations: usize), with_warm_start(warm_start: Option<WarmStart<V>>),
        with_axis(axis: V => warm_start = Some(WarmStart::new(axis))), with_sub_algorithm(sub_algorithm: SubAlgorithm),
        with_method(method: CastMethod)
    }
}

/// Options of [`motion_cast`](crate::motion_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MotionCastOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. A negative value is taken for zero. Default: infinity. Set an
    /// end if a body spins: no finite search can prove that a spinning body never touches another one, and the answer
    /// is undecided after [`max_iterations`](Self::max_iterations).
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// How far from contact, relative to the sizes of the shapes, the answer may stay uncertain. A bracket at the level
    /// of rounding always ends the search. Default: 0.
    pub tolerance: V::Scalar,
    /// The distance at which bodies count as touching: the cast stops that far from contact. A negative value is taken
    /// for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// What to answer if the bodies touch at the start. Default: [`StartInContact::Report`].
    pub start_in_contact: StartInContact,
    /// A first guess of the direction from `b` to `a` at the start, such as the axis of the last miss. Default: none.
    pub axis: Option<V>,
    /// The number of times to examine, after which to give up; each takes a few support points, which
    /// [`MotionCast::iterations`](crate::MotionCast::iterations) counts. Default: 10 000.
    pub max_iterations: usize,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) extra: Extra<FullMotion<V>>,
}

impl<V: Vector> MotionCastOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        Self { extra: FullMotion::named(), ..Self::lean() }
    }

    /// The default options, with no machine code besides GJK, closed forms, and the closest points of the last time: a
    /// program in which all options are lean has under two fifths of the code for motion casts.
    ///
    /// The search then does without the shortest way out of an overlap, the facets of two boxes, the proof that bodies
    /// without an inside have passed through one another, and the linear cast, so that motions that do not turn are
    /// searched like those that do. It takes more support points, the bracket may be wider, and a contact that is not
    /// certain, or a graze, may be undecided where the default options decide. With [`StartInContact::IfDeeper`], a
    /// start that may be in contact may be undecided too.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            max_time: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            target_distance: V::Scalar::ZERO,
            start_in_contact: StartInContact::Report,
            axis: None,
            max_iterations: MAX_LOOKS,
            extra: Extra::NONE,
        }
    }

    setters! {
        with_max_time(max_time: V::Scalar), with_tolerance(tolerance: V::Scalar),
        with_target_distance(target_distance: V::Scalar), with_start_in_contact(start_in_contact: StartInContact),
        with_axis(axis: V => axis = Some(axis)), with_max_iterations(max_iterations: usize)
    }

    /// The options of the linear cast for a motion that does not turn, without the machine code they name.
    pub(crate) fn straight(&self) -> LinearCastOptions<V> {
        let &Self { max_time, tolerance, target_distance, start_in_contact, axis, max_iterations, .. } = self;
        let warm_start = axis.map(WarmStart::new);
        LinearCastOptions {
            max_time,
            tolerance,
            target_distance,
            start_in_contact,
            warm_start,
            max_iterations,
            ..LinearCastOptions::lean()
        }
    }
}
