//! The distance of two shapes (the paper's Algorithm 2).

use convex_support::{Core, CoreKind, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::body::{Both, Pair, PointPair, Shapes, TracedSupport as _};
use crate::compiled_once::compiled_once;
use crate::contact::signed_distance_of_any;
use crate::gjk::{
    End, Frame, Gjk, GjkOptions, NEAR, comes_first, first_direction, gjk, is_near_contact, near_contact, rounding,
};
use crate::observer::Observer;
use crate::shape::Shape;
use crate::{Distance, DistanceOptions, Iterate, SignedDistanceOptions, Status, SubAlgorithm};

/// The distance of two shapes, and where they are closest.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, distance};
///
/// let table = Cuboid::new(DVec3::new(2.0, 0.1, 1.0))?;
/// let ball = Posed::translated(Ball::new(0.25)?, DVec3::new(0.5, 1.0, 0.0))?;
/// let answer = distance(&ball, &table, DistanceOptions::default());
/// assert!((answer.distance - 0.65).abs() < 1e-15);
/// assert!(answer.lower <= answer.distance && answer.distance <= answer.upper);
/// assert_eq!(answer.normal, Some(DVec3::Y)); // from the table to the ball
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// Two points of the shapes bound the distance from above, and a slab between the shapes bounds it from below. The
/// iteration ends when these bounds meet. Where the shapes overlap, the distance is 0 and the depth is not known:
/// [`signed_distance`](crate::signed_distance) finds it.
///
#[doc = include_str!("../doc/bracket.svg")]
#[inline]
pub fn distance<A, B>(a: &A, b: &B, options: DistanceOptions<A::Vector>) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::none())
}

/// [`distance`], showing an observer every iterate.
#[inline]
pub fn distance_with<A, B>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    mut observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    watched(a, b, options, &mut Observer::new(&mut observer))
}

#[inline(always)]
fn watched<A, B>(
    a: &A,
    b: &B,
    options: DistanceOptions<A::Vector>,
    observer: &mut Observer<'_, A::Vector>,
) -> Distance<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let shapes = Both::<_, _>::new(a, b);
    let cores = shapes.cores();
    if let Some(answer) = direct(&shapes, cores, options.max_iterations, observer) {
        return answer;
    }
    // In order, so that the search can be gone on with if the bodies nearly touch.
    let is_swapped = comes_first(&cores[1], &cores[0]);
    let cores = if is_swapped { [cores[1], cores[0]] } else { cores };
    by_search(&shapes.swapped(is_swapped), cores, is_swapped, options, observer)
}

compiled_once! {
    /// The distance by a search, of shapes that are swapped or not.
    fn by_search<V>(
        shapes: &dyn Shapes<Vector = V>,
        cores: [Core<V>; 2],
        is_swapped: bool,
        options: DistanceOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> Distance<V> {
        if !is_swapped {
            return searched_in_order(shapes, cores, options, observer);
        }
        let options = DistanceOptions { axis: options.axis.map(|axis| -axis), ..options };
        let is_watched = !observer.is_none();
        let mut reversed = |iterate: Iterate<'_, V>| iterate.reversed(|iterate| observer.show(|| iterate));
        let mut observer = if is_watched { Observer::new(&mut reversed) } else { Observer::none() };
        searched_in_order(shapes, cores, options, &mut observer).reversed()
    }
}

/// The plain case: bodies that are apart by more than a few errors, of which the closest points are known in closed
/// form. There is nothing to search, and all is done in the world's unit. Nearer to contact they are looked at closely
/// without a search before it.
///
/// The plane of the support point across the vector between those points is as far as they are, to rounding, or it is
/// left to the search.
#[inline(always)]
fn direct<T: Shapes>(
    shapes: &T,
    cores: [Core<T::Vector>; 2],
    max_iterations: usize,
    observer: &mut Observer<'_, T::Vector>,
) -> Option<Distance<T::Vector>> {
    let number = <T::Vector as Vector>::Scalar::from_f64;
    let mut pair = Pair::of_cores(shapes, cores);
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset);
    let points = pair.closest_points(offset, size)?;
    let v = pair.vector_between(points, offset);
    let (length, radius, noise) = (v.length(), pair.radius(), rounding(size));
    let error = noise + pair.error();
    let near = error * number(NEAR);
    if (length - radius).abs() < near {
        return nearly_touching(shapes, [pair.core_a, pair.core_b], max_iterations);
    }
    // NaN is left to the search, and so is what is deep.
    if !(length - radius >= near) || max_iterations == 0 {
        return None;
    }
    let (w, lower) = if matches!((pair.core_a.kind, pair.core_b.kind), (CoreKind::Point(_), CoreKind::Point(_))) {
        // There are no other points.
        (v, length)
    } else {
        let w = pair.support(-v).0 + offset;
        (w, (v.dot(w) / length).min(length))
    };
    if !(length - lower <= noise) {
        return None;
    }
    let (scale, upper) = (number(1.0), length);
    let simplex = [v];
    observer.show(|| Iterate { iteration: 0, simplex: &simplex, v, w, scale, lower, upper });
    let n = v / length;
    Some(Distance {
        distance: length - radius,
        lower: lower - error - radius,
        upper: length + error - radius,
        overlap: false,
        point_a: pair.core_a.origin + points.a - n * pair.core_a.radius,
        point_b: pair.core_b.origin + points.b + n * pair.core_b.radius,
        normal: Some(n),
        status: Status::Converged,
        iterations: 1,
    })
}

fn searched_in_order<V: Vector>(
    shapes: &dyn Shapes<Vector = V>,
    cores: [Core<V>; 2],
    options: DistanceOptions<V>,
    observer: &mut Observer<'_, V>,
) -> Distance<V> {
    let mut pair = Pair::of_cores(shapes, cores);
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset);
    let frame = Frame::new(&mut pair, offset, size);
    let mut state = Gjk::new(first_direction(options.axis, frame.offset));
    let start = state.begin_at_closest(&pair, &frame, size);
    let search = GjkOptions {
        limit: options.limit * frame.per_unit + frame.radius,
        tolerance: options.tolerance,
        sub_algorithm: options.sub_algorithm,
        ..GjkOptions::new(state.normal, options.max_iterations)
    };
    let end =
        if start == Some(true) { End::Overlap } else { gjk(&mut state, &mut pair, frame, search, None, observer) };
    if is_near_contact(&mut state, &frame) {
        // Whether it is the search that any query would have made.
        let is_plain = start.is_none()
            && options.axis.is_none()
            && options.sub_algorithm == SubAlgorithm::Regions
            && !(options.tolerance > Scalar::ZERO)
            && !(state.lower > search.limit + frame.error);
        let (begun, before) = if is_plain { (Some(&state), 0) } else { (None, state.iterations) };
        if let Some(answer) = touching(shapes, cores, begun, options.max_iterations) {
            return Distance { iterations: before + answer.iterations, ..answer };
        }
    }
    state.ensure_measured();
    let answer = apart(cores, &frame, &state, state.simplex.weighted_witness(), end);
    if end == End::Stalled { closely(shapes.each(), answer, options.max_iterations) } else { answer }
}

/// The answer that a search leaves in doubt, with what the signed distance knows: the planes of facets of the
/// difference too, and how deep bodies are in one another.
#[cold]
#[inline(never)]
fn closely<V: Vector>([a, b]: [Shape<'_, V>; 2], answer: Distance<V>, max_iterations: usize) -> Distance<V> {
    // In order, so that the answer is that of the pair in the other order.
    if comes_first(&b.core(), &a.core()) {
        return closely([b, a], answer.reversed(), max_iterations).reversed();
    }
    let zero = V::Scalar::ZERO;
    let left = max_iterations.saturating_sub(answer.iterations);
    let there = signed_distance_of_any(a, b, SignedDistanceOptions::new().with_max_iterations(left));
    let (lower, upper) = (answer.lower.max(there.lower), answer.upper.min(there.upper.max(zero)));
    let iterations = answer.iterations + there.iterations;
    // What is no number, or contradicts itself, is of a support map that is none.
    if !(lower <= upper) || !there.signed_distance.is_finite() {
        let status = if there.status == Status::IterationLimit { there.status } else { answer.status };
        return Distance { status, iterations, ..answer };
    }
    let overlap = !(lower > zero) && (there.overlap || there.status == Status::Converged);
    let is_nearer = there.upper < answer.upper && there.upper >= zero;
    let (point_a, point_b) = if is_nearer { (there.point_a, there.point_b) } else { (answer.point_a, answer.point_b) };
    Distance {
        distance: there.signed_distance.max(lower).min(upper),
        lower,
        upper,
        overlap,
        point_a,
        point_b,
        normal: Some(there.normal).filter(|_| there.upper >= zero),
        status: there.status,
        iterations,
    }
}

/// The answer of a search that ends apart from contact: the bodies are apart, or deep in one another.
#[inline(always)]
fn apart<V: Vector>(
    cores: [Core<V>; 2],
    frame: &Frame<V>,
    state: &Gjk<V>,
    core_points: PointPair<V>,
    end: End,
) -> Distance<V> {
    let zero = V::Scalar::ZERO;
    let &Frame { scale, radius, error, .. } = frame;
    let &Gjk { normal, length, lower, axis, .. } = state;
    let overlap = end == End::Overlap;
    // Nearer to contact another look is taken, but for a simplex that has zero inside for certain.
    let is_certain = overlap && state.simplex.points().len() > V::DIM;
    let n = if length > zero && !overlap && (radius > zero || lower <= zero) { normal.unit() } else { None };
    let along = if overlap { None } else { Some(n.unwrap_or(Vector::ZERO)) };
    let [point_a, point_b] = surface_points(cores, frame, core_points, along);
    let gap = |l: V::Scalar| ((l - radius) * scale).max(zero);
    // The shortest vector is measured across the affine hull of its points, and they are what proves it.
    let squared = (core_points.a - core_points.b + frame.offset).length_squared();
    let found = if squared <= length * length { length } else { squared.sqrt() };
    let answer = Distance {
        distance: if overlap { zero } else { gap(length) },
        lower: if overlap { zero } else { gap((lower - error).min(length)) },
        upper: match overlap {
            true if is_certain => zero,
            true => gap(found + error).min(error * scale),
            false => gap(found + error),
        },
        overlap,
        point_a,
        point_b,
        normal: if overlap || length <= zero {
            None
        } else if lower > zero {
            axis.unit()
        } else {
            n
        },
        status: end.status(),
        iterations: state.iterations,
    };
    // The support points of a shape that is none may contradict one another, or be no numbers: then nothing is known.
    if answer.lower <= answer.upper {
        answer
    } else {
        Distance { lower: zero, upper: V::Scalar::infinity(), status: Status::Stalled, ..answer }
    }
}

compiled_once! {
    /// The answer of bodies near contact.
    fn nearly_touching<V>(
        shapes: &dyn Shapes<Vector = V>,
        cores: [Core<V>; 2],
        max_iterations: usize,
    ) -> Option<Distance<V>> {
        touching(shapes, cores, None, max_iterations)
    }
}

/// The answer of bodies near contact, perhaps after a search that can be gone on with.
#[cold]
#[inline(never)]
fn touching<V: Vector>(
    shapes: &dyn Shapes<Vector = V>,
    cores: [Core<V>; 2],
    begun: Option<&Gjk<V>>,
    max_iterations: usize,
) -> Option<Distance<V>> {
    let near = near_contact(shapes, cores, begun, max_iterations)?;
    let (zero, scale, is_settled) = (V::Scalar::ZERO, near.frame.scale, near.is_settled(max_iterations));
    let overlap = near.overlap();
    // What is in one another by more than an error has a point in common that is nearer to both cores. Of others the
    // points of the surfaces are between those of the cores, which the plane may lean to by the root of the rounding.
    let between = near.points.a - near.points.b + near.frame.offset;
    let along = if overlap == Some(true) { None } else { Some(between.unit().unwrap_or(near.normal)) };
    let [point_a, point_b] = surface_points(cores, &near.frame, near.points, along);
    let upper = near.upper.max(zero) * scale;
    let answer = Distance {
        distance: (near.gap.max(zero) * scale).min(upper),
        lower: near.lower.max(zero) * scale,
        upper,
        overlap: overlap == Some(true),
        point_a,
        point_b,
        // Of a point found deep inside, no plane is one of contact.
        normal: Some(near.normal).filter(|_| near.gap >= -near.upper),
        status: if is_settled { Status::Converged } else { Status::Stalled },
        iterations: near.iterations,
    };
    Some(if is_settled { answer } else { closely(shapes.each(), answer, max_iterations) })
}

/// The points of both bodies beside points of their cores, in the world: along the unit vector from `b` to `a`, or
/// where none is given between the points of the cores, which are no farther apart than both radii: there a point in
/// both bodies.
#[inline(always)]
fn surface_points<V: Vector>(
    [core_a, core_b]: [Core<V>; 2],
    &Frame { scale, per_unit, offset, radius, .. }: &Frame<V>,
    PointPair { a, b }: PointPair<V>,
    along: Option<V>,
) -> [V; 2] {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    let (from_a, from_b) = match along {
        Some(n) => (n * core_a.radius, n * core_b.radius),
        // Without radii the cores themselves meet.
        None if radius <= zero => (V::ZERO, V::ZERO),
        None => {
            let v = (a - b + offset) * scale;
            let share = |core: Core<V>| v * (core.radius * per_unit / radius).min(one);
            (share(core_a), share(core_b))
        }
    };
    [core_a.origin + a * scale - from_a, core_b.origin + b * scale + from_b]
}
