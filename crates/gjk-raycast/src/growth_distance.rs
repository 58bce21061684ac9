//! How much two shapes have to grow until they touch.
//!
//! Let `A` grow about its centre `a`, and `B` about `b`, by one scale `s`. A point in common,
//! `a + s(x − a) = b + s(y − b)` with `x` in `A` and `y` in `B`, is the same as `b − a` in `s·C`, where
//! `C = (A − a) − (B − b)` contains zero. So the least `s` is `1/λ` where the ray from zero along `b − a` leaves `C`:
//! the line is cast back, as for a [`ray_exit`](crate::ray_exit()), and the bracket is that of this cast. Each shape is
//! taken relative to its centre, so that the bracket is as narrow far from the world's origin as at it.

use core::error::Error;
use core::fmt::{self, Display, Formatter};

use convex_support::numerics::bound::roundings;
use convex_support::numerics::twofold::lost_in_sum;
use convex_support::{Core, Hint, Point, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use crate::cast::{CastRay, ObstacleCast, Part};
use crate::distance::distance_of_any;
use crate::linear_cast::{contact_slack, hit_on_the_way};
use crate::motion::Moved;
use crate::options::{MAX_ITERATIONS, options};
use crate::pair::{Both, Pair, Shape, Shapes as _, WithoutLines};
use crate::ray_exit::cast_back;
use crate::simplex::{MAX_POINTS, project};
use crate::unit::{power_of_two_near, reciprocal_of_power};
use crate::{DistanceOptions, Impact, IntersectOptions, Ray, RayCastOptions, Status, WarmStart, intersects};

/// The growth distance of two shapes: the least scale by which both, each about its own centre, have a point in common.
///
/// It is less than 1 if the shapes overlap, 1 if they touch, and greater than 1 if they are apart. Unlike the signed
/// distance it has no kink where the shapes begin to overlap, and between curved shapes it is smooth until the centres
/// coincide. A controller that keeps it above 1 keeps the shapes apart.
///
/// ```
/// use convex_support::{Ball, Posed, glam::DVec3};
/// use gjk_raycast::{GrowthOptions, growth_distance};
///
/// let (at_a, at_b) = (DVec3::ZERO, DVec3::new(0.0, 6.0, 0.0));
/// let (a, b) = (Ball::new(1.0)?, Posed::translated(Ball::new(2.0)?, at_b)?);
/// let answer = growth_distance(&a, at_a, &b, at_b, GrowthOptions::default())?;
/// assert_eq!((answer.scale, answer.point), (2.0, DVec3::new(0.0, 2.0, 0.0)));
/// assert_eq!(answer.normal, Some(DVec3::NEG_Y)); // out of b
/// assert!(answer.lower <= 2.0 && 2.0 <= answer.upper);
///
/// // Carried away from b, with its centre, a gains 1/3 for each unit of length: s = 6/(1 + 2).
/// let gradient = answer.gradient([at_a, at_b]).ok_or("the centres differ")?;
/// assert!((gradient.a.translation - DVec3::NEG_Y / 3.0).length() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// - The centres are in the world, and each is in its shape; on the boundary, to rounding, is inside.
/// - If the centres coincide the scale is 0, with no normal.
/// - If no scale is known to be enough, since the shapes do not reach along the line of the centres, as two points or
///   two faces back to back, then the upper bound is infinite, and the status is not [`Status::Converged`].
///
/// # Errors
/// [`GrowthError`] if a centre is not finite, or outside of its shape.
#[inline]
pub fn growth_distance<A, B>(
    a: &A,
    center_a: A::Vector,
    b: &B,
    center_b: A::Vector,
    options: GrowthOptions<A::Vector>,
) -> Result<GrowthDistance<A::Vector>, GrowthError>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    by_search([&WithoutLines(a), &WithoutLines(b)], [center_a, center_b], &options)
}

/// Options of [`growth_distance`](crate::growth_distance()).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct GrowthOptions<V: Vector> {
    /// How far from contact the answer may stay uncertain, relative to the sizes of the shapes before they grow. A
    /// bracket at the level of rounding always ends the iteration. A negative value and NaN are taken for zero.
    /// Default: 0.
    pub tolerance: V::Scalar,
    /// The iterations after which to give up. The two questions whether the centres are inside may take as many each.
    /// Default: 200.
    pub max_iterations: usize,
    /// The warm start from the last frame's answer, which predicts the normal. Default: none.
    pub warm_start: Option<WarmStart<V>>,
}

impl<V: Vector> Default for GrowthOptions<V> {
    fn default() -> Self {
        Self { tolerance: Scalar::ZERO, max_iterations: MAX_ITERATIONS, warm_start: None }
    }
}

options! {
    GrowthOptions: with_tolerance(tolerance: V::Scalar), with_max_iterations(max_iterations: usize),
    with_warm_start(warm_start: Option<WarmStart<V>>)
}

/// The answer of [`growth_distance`](crate::growth_distance()).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct GrowthDistance<V: Vector> {
    /// The least scale by which both shapes have a point in common; infinite if none is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub scale: V::Scalar,
    /// Grown by less than this, they have no point in common.
    pub lower: V::Scalar,
    /// Grown by this, or more, they have one. Infinite if no such scale is known.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// A point that both have in common, grown by the scale; the centre of `a` if the scale is 0 or infinite.
    pub point: V,
    /// The unit normal there, out of `b` towards `a`; at an edge or a corner of both, one of the normals. `None` if the
    /// scale is 0, or no scale is known.
    pub normal: Option<V>,
    /// How the iteration ended.
    pub status: Status,
    /// The number of support points computed of each shape, besides those that tell whether the centres are inside.
    pub iterations: usize,
}

impl<V: Vector> GrowthDistance<V> {
    /// The warm start for the [question of the next frame](GrowthOptions::warm_start), from this answer and its own
    /// warm start.
    #[must_use]
    pub fn warm_start(&self, before: Option<WarmStart<V>>) -> Option<WarmStart<V>> {
        self.normal.map(|normal| WarmStart::after(before, normal)).or(before)
    }

    /// Of nothing known but this lower bound.
    fn unknown(lower: V::Scalar, point: V, status: Status, iterations: usize) -> Self {
        let infinity = V::Scalar::infinity();
        Self { scale: infinity, lower, upper: infinity, point, normal: None, status, iterations }
    }
}

/// Why two centres were refused.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub enum GrowthError {
    /// A coordinate is NaN or infinite.
    NonFinite {
        /// The name of the centre, `"center_a"` or `"center_b"`.
        parameter: &'static str,
        /// Which coordinate, counted from 0.
        index: usize,
    },
    /// A centre is outside of its shape, by more than a few roundings of the numbers that the shape is made of.
    CenterOutside {
        /// The name of the centre, `"center_a"` or `"center_b"`.
        parameter: &'static str,
        /// How far outside it is at least.
        distance: f64,
    },
}

impl Display for GrowthError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::NonFinite { parameter, index } => write!(f, "{parameter} is NaN or infinite at index {index}"),
            Self::CenterOutside { parameter, distance } => {
                write!(f, "{parameter} is outside of its shape, by at least {distance:e}: it has to be a point of it")
            }
        }
    }
}

impl Error for GrowthError {}

const CENTERS: [&str; 2] = ["center_a", "center_b"];

compiled_once! {
    /// The growth distance of shapes behind pointers.
    fn by_search<V>(
        shapes: [Shape<'_, V>; 2],
        centers: [V; 2],
        options: &GrowthOptions<V>,
    ) -> Result<GrowthDistance<V>, GrowthError> {
        for ((shape, center), parameter) in shapes.into_iter().zip(centers).zip(CENTERS) {
            check_center(shape, center, parameter, options.max_iterations)?;
        }
        let (zero, [center_a, center_b]) = (V::Scalar::ZERO, centers);
        if center_a == center_b {
            let (scale, point, status) = (zero, center_a, Status::Converged);
            return Ok(GrowthDistance { scale, lower: zero, upper: zero, point, normal: None, status, iterations: 0 });
        }
        let way = center_b - center_a;
        if !way.is_finite() {
            return Ok(GrowthDistance::unknown(zero, center_a, Status::Stalled, 0));
        }
        // In units of its length, so that no parameter is out of range.
        let unit = power_of_two_near(way.abs().max_element());
        let direction = way * reciprocal_of_power(unit);
        let lost = lost_in_sum(center_b, -center_a);
        let direction_error = if lost == V::ZERO { zero } else { lost.norm() / way.norm() };
        let [a, b] = [0, 1].map(|i| {
            let core = shapes[i].core();
            let origin = core.origin - centers[i];
            let lost = lost_in_sum(core.origin, -centers[i]).norm();
            Moved::new(shapes[i], Core { origin, ..core }, None, lost)
        });
        let shapes = Both::<_, _>::new(&a, &b);
        let cores = shapes.cores();
        let mut body = Pair::new(&shapes, cores.each_ref());
        let ray = Ray { source: cores[1].origin, direction };
        let &GrowthOptions { tolerance, max_iterations, warm_start, .. } = options;
        // Seen from b, a is at the outside of the difference: its normals point out of a.
        let warm_start = warm_start.map(WarmStart::reversed);
        let wanted = RayCastOptions { tolerance, max_iterations, warm_start, ..RayCastOptions::default() };
        let cast = cast_back(&mut body, CastRay { ray, direction_error, part: Part::Whole }, &wanted);
        Ok(answer(cast, &cores, direction, unit, center_a))
    }
}

/// Refuses a centre that is outside of its shape by more than rounding.
fn check_center<V: Vector>(
    shape: Shape<'_, V>,
    center: V,
    parameter: &'static str,
    max_iterations: usize,
) -> Result<(), GrowthError> {
    let Ok(point) = Point::new(center) else {
        let index = (0..V::DIM).find(|&i| !center.get(i).is_finite()).unwrap_or_default();
        return Err(GrowthError::NonFinite { parameter, index });
    };
    let core = shape.core();
    let slack = contact_slack(core.extent + core.radius, core.origin.norm() + center.norm(), core.error);
    if is_plainly_inside(shape, &core, center - core.origin, slack)
        || intersects(shape, &point, IntersectOptions::new().with_max_iterations(max_iterations)).overlap
    {
        return Ok(());
    }
    let distance = distance_of_any(shape, &point, DistanceOptions::new().with_max_iterations(max_iterations)).lower;
    if distance > slack { Err(GrowthError::CenterOutside { parameter, distance: distance.as_f64() }) } else { Ok(()) }
}

/// Whether a point, relative to the origin of the core, is seen at once to be in the shape: by the closest point of the
/// core, or as a mean of support points around it, to rounding. GJK would take longest for the middle of a shape, where
/// most centres are.
fn is_plainly_inside<V: Vector>(shape: Shape<'_, V>, core: &Core<V>, at: V, slack: V::Scalar) -> bool {
    if let Some(closest) = shape.core_closest_point(at) {
        return (closest - at).norm() <= core.radius + slack;
    }
    // Directions whose sum is zero: the support points of an ellipsoid along them are around its centre.
    let mut points = [V::ZERO; MAX_POINTS];
    let points = &mut points[..=V::DIM];
    for (i, point) in points.iter_mut().enumerate() {
        let ahead = V::Scalar::from_f64(V::DIM as f64);
        let direction = V::from_fn(|k| if k == i { ahead } else { -V::Scalar::ONE });
        *point = shape.core_support(direction, &mut Hint::new()) - at;
    }
    let weights = project(points, |point| -point).coordinates;
    let mean = points.iter().zip(weights).fold(V::ZERO, |sum, (point, weight)| sum + *point * weight);
    // NaN is not inside.
    weights.iter().all(|weight| *weight >= V::Scalar::ZERO) && mean.norm() <= slack
}

/// The answer of a cast along the way between the centres, in these units of λ.
fn answer<V: Vector>(
    cast: ObstacleCast<V>,
    cores: &[Core<V>; 2],
    direction: V,
    unit: V::Scalar,
    center: V,
) -> GrowthDistance<V> {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
    let ObstacleCast { lower: soonest, upper: latest, scale: length, status, iterations, .. } = cast;
    // Where the line certainly passes by, the centres are at the boundary of their difference, to rounding.
    let latest = if cast.outcome.is_miss() { infinity } else { latest };
    let scale_at = |lambda: V::Scalar| if lambda > zero { unit / lambda } else { infinity };
    let (least, most) = (scale_at(latest), scale_at(soonest));
    let lower = if least < infinity { (least - roundings(2.0, least)).max(zero) } else { zero };
    let upper = most + roundings(2.0, most);
    let stalled = if status == Status::Converged { Status::Stalled } else { status };
    let Some(hit) = cast.outcome.hit().filter(|hit| scale_at(hit.lambda) < infinity) else {
        return GrowthDistance::unknown(lower, center, stalled, iterations);
    };
    let scale = scale_at(hit.lambda);
    let Impact { point, normal, .. } = hit_on_the_way(&hit, length, cores, direction);
    let status = if upper < infinity { status } else { stalled };
    let scale = scale.max(lower).min(upper);
    GrowthDistance { scale, lower, upper, point: center + point * scale, normal, status, iterations }
}
