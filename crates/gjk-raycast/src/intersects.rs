//! Whether two shapes meet: the first plane between them, or the first point in common, ends the search.

use convex_support::{Core, CoreKind, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float;

use crate::body::{PointPair, TracedSupport as _};
use crate::boxes::{BoxesMeet, boxes};
use crate::distance::distance;
use crate::gjk::{End, Frame, Gjk, GjkOptions, first_direction, gjk, rounding};
use crate::observer::Observer;
use crate::options::{MAX_ITERATIONS, options};
use crate::pair::{Both, Pair, Shape, Shapes};
use crate::unit::is_moderate;
use crate::{DistanceOptions, Iterate, Status, SubAlgorithm};

/// Whether two shapes have a point in common. Touching counts as meeting.
///
/// This is the incremental separating axis variant of GJK. It ends at the first plane that separates the shapes. If it
/// begins with the axis of a similar query, the first plane is usually one. For two boxes it tests the normals of their
/// faces and the cross products of their edges instead, and searches only if the boxes are within rounding of contact.
///
/// ```
/// use convex_support::{Cuboid, Posed, glam::DVec2};
/// use gjk_raycast::{IntersectOptions, intersects};
///
/// let box_at = |x| Posed::translated(Cuboid::new(DVec2::ONE)?, DVec2::new(x, 0.5));
/// let (fixed, moving) = (box_at(0.0)?, box_at(2.5)?);
/// let first = intersects(&fixed, &moving, IntersectOptions::default());
/// assert!(!first.overlap);
///
/// let axis = first.axis.ok_or("apart, so there is an axis")?;
/// let next = intersects(&fixed, &box_at(2.4)?, IntersectOptions::default().with_axis(axis));
/// assert_eq!((next.overlap, next.iterations), (false, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(alias("overlap", "sat", "separating_axis", "clash", "collide", "intersection_test"))]
#[inline(always)]
pub fn intersects<A, B>(a: &A, b: &B, options: IntersectOptions<A::Vector>) -> Intersection<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::none())
}

/// [`intersects`] with an observer that sees every iterate.
#[inline(always)]
pub fn intersects_with<A, B>(
    a: &A,
    b: &B,
    options: IntersectOptions<A::Vector>,
    mut observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Intersection<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::new(&mut observer))
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
}

impl<V: Vector> Default for IntersectOptions<V> {
    fn default() -> Self {
        Self::new()
    }
}

options! {
    @setters IntersectOptions: with_max_iterations(max_iterations: usize), with_axis(axis: V => axis = Some(axis)),
    with_sub_algorithm(sub_algorithm: SubAlgorithm)
}

/// The answer of [`intersects`](crate::intersects).
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Intersection<V: Vector> {
    /// Whether the shapes have a point in common. This is certain if `status` is [`Status::Converged`], and otherwise a
    /// guess; [`decided`](Self::decided) tells the two apart. It agrees with that of
    /// [`distance`](crate::Distance::overlap): shapes that touch, to rounding, have a point in common.
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

#[inline(always)]
fn watched<A: SupportMap + ?Sized, B: SupportMap<Vector = A::Vector> + ?Sized>(
    a: &A,
    b: &B,
    options: IntersectOptions<A::Vector>,
    observer: &mut Observer<'_, A::Vector>,
) -> Intersection<A::Vector> {
    let shapes = Both::<_, _>::new(a, b);
    let cores = shapes.cores();
    let mut pair = Pair::new(&shapes, cores.each_ref());
    let offset = pair.core_a.origin - pair.core_b.origin;
    // The first axis is tried in the world's unit, before anything else is set up; the sum of the coordinates bounds
    // the length of the offset without a root.
    let size = pair.extent() + pair.radius() + offset.abs().dot(Vector::ONE);
    let closest = if options.axis.is_none() { pair.closest_points(offset, size) } else { None };
    let shortest = closest.map(|points| pair.vector_between(points, offset));
    // Points no farther apart than the radii, by more than they may be wrong by, meet; others are looked at more
    // closely.
    if shortest.is_some_and(|v| v.length() + (rounding(size) + pair.error()) <= pair.radius()) {
        return Intersection { overlap: true, axis: None, status: Status::Converged, iterations: 0 };
    }
    let first = first_direction(options.axis.or(shortest), offset);
    let mut known = None;
    if is_moderate(size) && options.max_iterations > 0 {
        let point = pair.support(-first).0;
        let w = point + offset;
        let (reach, length) = (first.dot(w), first.length());
        if reach.is_finite() && reach > (pair.radius() + rounding(size) + pair.error()) * length {
            let lower = reach / length;
            let upper = Float::infinity();
            observer.show(|| Iterate { iteration: 0, simplex: &[], v: first, w, scale: Scalar::ONE, lower, upper });
            return Intersection {
                overlap: false,
                axis: Some(first / length),
                status: Status::Converged,
                iterations: 1,
            };
        }
        known = Some(point);
    }
    let first = FirstSupport { offset, direction: first, point: known };
    // In variables of their own, so that the first axis has them in registers.
    let [core_a, core_b] = cores;
    by_search(&shapes, [&core_a, &core_b], &options, &first, observer)
}

compiled_once! {
    /// [`intersects_with`] if the first direction does not separate the shapes.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        cores: [&Core<V>; 2],
        options: &IntersectOptions<V>,
        first: &FirstSupport<V>,
        observer: &mut Observer<'_, V>,
    ) -> Intersection<V> {
        let pair = &mut Pair::new(shapes, cores);
        let size = pair.size(first.offset);
        let frame = Frame::new(pair, first.offset, size);
        if let Some(point) = first.point
            && frame.radius <= Scalar::ZERO
            && cores.iter().all(|core| matches!(core.kind, CoreKind::Polytope))
            && let Some(parts) = pair.parallelotopes()
            && let Some(boxes) = boxes(&parts, &frame)
        {
            let (zero, upper) = (Scalar::ZERO, Float::infinity());
            let (v, w) = (first.direction, point + first.offset);
            observer.show(|| Iterate { iteration: 0, simplex: &[], v, w, scale: Scalar::ONE, lower: zero, upper });
            let (overlap, axis) = match boxes {
                BoxesMeet::Meet => (true, None),
                BoxesMeet::Apart(axis) => (false, Some(axis)),
            };
            return Intersection { overlap, axis, status: Status::Converged, iterations: 1 };
        }
        let mut state = Gjk::new(first.direction);
        let meet = state.begin_at_closest(pair, &frame, size);
        // A search that begins elsewhere has another first direction.
        let known =
            if meet.is_none() { first.point.map(|point| (point * frame.per_unit, PointPair::ZERO)) } else { None };
        let max_iterations = options.max_iterations;
        let options = GjkOptions {
            limit: frame.radius,
            closest_points: false,
            sub_algorithm: options.sub_algorithm,
            ..GjkOptions::new(state.normal, max_iterations)
        };
        let end = if meet == Some(true) { End::Overlap } else { gjk(&mut state, pair, frame, options, known, observer) };
        let (apart, near) = (state.lower > frame.radius + frame.error, state.is_near_contact(&frame));
        let (overlap, axis) = match end {
            End::Separated if apart => (false, state.axis.unit()),
            End::Overlap if !near => (true, None),
            _ => {
                let left = max_iterations.saturating_sub(state.iterations);
                let closely = closely(shapes.each(), left);
                return Intersection { iterations: state.iterations + closely.iterations, ..closely };
            }
        };
        Intersection { overlap, axis, status: Status::Converged, iterations: state.iterations }
    }
}

/// The result for the first direction.
struct FirstSupport<V> {
    /// The difference of the origins.
    offset: V,
    direction: V,
    /// The support point, relative to the origins, if the world's unit can represent the sizes.
    point: Option<V>,
}

/// The answer of [`distance`](crate::distance), which measures bodies near contact again, and for curved bodies goes
/// on by their curvature if support points alone make no progress.
#[cold]
#[inline(never)]
fn closely<V: Vector>([a, b]: [Shape<'_, V>; 2], max_iterations: usize) -> Intersection<V> {
    let there = distance(a, b, DistanceOptions::new().with_max_iterations(max_iterations));
    Intersection {
        overlap: there.overlap,
        axis: there.normal.filter(|_| !there.overlap),
        // How far apart they are may be known less well.
        status: if there.lower > Scalar::ZERO { Status::Converged } else { there.status },
        iterations: there.iterations,
    }
}
