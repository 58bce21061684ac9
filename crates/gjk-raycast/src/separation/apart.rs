//! The first means of the search, and its answer for two bodies that are plainly apart.
//!
//! Most bodies that are asked about are apart by more than a few errors. Then nothing of the other means is needed: the
//! closest points are known in closed form, or GJK finds them, and one pass over them makes the answer. Bodies that
//! overlap or nearly touch, and numbers out of range, are left to [`separation`](super::separation()), which goes on
//! from what the search has found.

use convex_support::numerics::bound::least;
use convex_support::{Core, Scalar, Vector};
use num_traits::Float as _;

use super::SignedDistance;
use super::near::SUM;
use crate::body::{PointPair, TracedSupport as _};
use crate::gjk::{End, Frame, Gjk, GjkOptions, NEAR, gjk, rounding, slack};
use crate::observer::Observer;
use crate::pair::{AnyPair, Pair, Shapes};
use crate::unit::lost_to_underflow;
use crate::{Iterate, Status};

/// The signed distance of shapes whose cores are apart by more than a few errors, and whose closest points are known
/// in closed form, such as a ball and a box, whether they overlap or not. There is nothing to search, and everything
/// is computed in the world's unit. Near contact they are measured again, in single precision at once.
///
/// The plane of the support point across the vector between those points is as far as they are, to rounding;
/// otherwise the search takes over.
#[inline(always)]
pub(crate) fn direct<T: Shapes + ?Sized>(
    shapes: &T,
    cores: [Core<T::Vector>; 2],
    max_iterations: usize,
    observer: &mut Observer<'_, T::Vector>,
    in_double: impl FnOnce([&Core<T::Vector>; 2], &PointPair<T::Vector>) -> Option<SignedDistance<T::Vector>>,
) -> Option<SignedDistance<T::Vector>> {
    let mut pair = Pair::new(shapes, cores.each_ref());
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset);
    let points = pair.closest_points(offset, size)?;
    let v = pair.vector_between(points, offset);
    let (length, radius, error) = (v.length(), pair.radius(), error_of_points(&pair, size));
    // The gap below which the distance is measured again; it allows for more rounding.
    let near = (rounding(size) + pair.error()) * Scalar::from_f64(NEAR);
    if max_iterations == 0 {
        return None;
    }
    // NaN is left to the search.
    if !(length.min((length - radius).abs()) > near) {
        if size_of::<<T::Vector as Vector>::Scalar>() >= size_of::<f64>() {
            return None;
        }
        // In variables of their own, so that the closed form has them in registers.
        let [core_a, core_b] = cores;
        let known = in_double([&core_a, &core_b], &PointPair { ..points })?;
        let [lower, upper] = [known.lower, known.upper].map(|bound| bound + radius);
        let (scale, simplex, w) = (Scalar::ONE, [v], v);
        observer.show(|| Iterate { iteration: 0, simplex: &simplex, v, w, scale, lower, upper });
        return Some(known);
    }
    let w = pair.support(-v).0 + offset;
    let lower = (v.dot(w) / length).min(length);
    if !(length - lower <= rounding(size)) {
        return None;
    }
    let (scale, upper) = (Scalar::ONE, length);
    let simplex = [v];
    observer.show(|| Iterate { iteration: 0, simplex: &simplex, v, w, scale, lower, upper });
    let normal = v / length;
    let signed_distance = length - radius;
    // What a vector is wrong by across adds no more to its length than that squared, by twice the length.
    let (lower, upper) = (lower - error - radius, length + error + error * (error / length) - radius);
    Some(SignedDistance {
        signed_distance,
        lower: lower - slack(lower, radius),
        upper: upper + slack(upper, radius),
        normal,
        point_a: pair.core_a.origin + points.a - normal * pair.core_a.radius,
        point_b: pair.core_b.origin + points.b + normal * pair.core_b.radius,
        overlap: signed_distance <= Scalar::ZERO,
        status: Status::Converged,
        iterations: 1,
        unexpanded: 0,
    })
}

/// The bracket on a distance that answers a question: one of this width and a part of its lower bound, or any beyond
/// the limit.
#[derive(Clone, Copy)]
pub(crate) struct Enough<S> {
    pub(crate) width: S,
    pub(crate) tolerance: S,
    pub(crate) limit: S,
}

impl<S: Scalar> Enough<S> {
    #[inline(always)]
    pub(crate) fn is(&self, lower: S, upper: S) -> bool {
        upper - lower <= self.width + self.tolerance.max(S::ZERO) * lower || lower > self.limit
    }
}

/// Two bodies before a search: the difference of their cores, and the unit of its lengths.
pub(crate) struct FirstSearch<'a, V: Vector> {
    pub(crate) pair: AnyPair<'a, V>,
    pub(crate) frame: Frame<V>,
    /// The sizes of both cores, their radii and their offset, in the world's unit.
    pub(super) size: V::Scalar,
}

impl<'a, V: Vector> FirstSearch<'a, V> {
    #[inline(always)]
    pub(crate) fn new(shapes: &'a (dyn Shapes<Vector = V> + 'a), cores: [&'a Core<V>; 2]) -> Self {
        let mut pair = Pair::new(shapes, cores);
        let offset = pair.core_a.origin - pair.core_b.origin;
        let size = pair.size(offset);
        let frame = Frame::new(&mut pair, offset, size);
        Self { pair, frame, size }
    }

    /// GJK from a first direction, until the distance of the cores is known as well as the options ask for, or is
    /// certainly beyond their limit, which is that of the bodies, or no more than `touching`. `None` if the closest
    /// points are known in closed form: where [`direct`] has not answered by those, the bodies are not plainly apart.
    #[inline(always)]
    pub(crate) fn run(
        &mut self,
        state: &mut Gjk<V>,
        touching: V::Scalar,
        options: GjkOptions<V>,
        observer: &mut Observer<'_, V>,
    ) -> Option<End> {
        let Frame { offset, scale, .. } = self.frame;
        if self.pair.closest_points_for_search(offset * scale, self.size).is_some() {
            return None;
        }
        let options = GjkOptions { limit: self.frame.between_cores(options.limit), ..options };
        let frame = Frame { radius: touching, ..self.frame };
        Some(measured(state, &mut self.pair, frame, options, observer))
    }

    /// A bound on the [error of points](error_of_points) of the difference, in the unit.
    #[inline(always)]
    pub(super) fn error(&self) -> V::Scalar {
        error_of_points(&self.pair, self.size) * self.frame.per_unit + lost_to_underflow(self.frame.scale)
    }

    /// The signed distance of bodies between whose cores GJK has found a plane, if they are apart by more than a few
    /// errors and the bracket is narrow enough; all is computed as [`separation`](super::separation()) would.
    #[inline(always)]
    pub(crate) fn apart(&self, state: &Gjk<V>, end: End, enough: Enough<V::Scalar>) -> Option<SignedDistance<V>> {
        if end != End::Separated {
            return None;
        }
        let (pair, Frame { scale, error, radius, .. }) = (&self.pair, self.frame);
        // NaN is not apart.
        if !(state.length - radius > error * Scalar::from_f64(NEAR)) {
            return None;
        }
        let (normal, axis) = (state.normal.unit()?, state.axis.unit()?);
        let (mut point, mut points, mut sum) = (V::ZERO, PointPair::ZERO, V::Scalar::ZERO);
        for (corner, weight, witness) in state.simplex.corners() {
            (point, points, sum) = (point + corner * weight, points.plus(witness, weight), sum + weight);
        }
        let error = self.error();
        let reached = (point / sum).norm() + error;
        let radius = pair.radius();
        let (lower, upper) = ((state.lower - error) * scale - radius, reached * scale - radius);
        // A product with the unit may be subnormal.
        let lower = lower - (slack(lower, radius) + least());
        let upper = upper + (slack(upper, radius) + least());
        // NaN bounds nothing.
        if !(lower > Scalar::ZERO && lower <= upper && upper.is_finite() && enough.is(lower, upper)) {
            return None;
        }
        let signed_distance = state.length * scale - radius;
        Some(SignedDistance {
            signed_distance: signed_distance.max(lower).min(upper),
            lower,
            upper,
            normal: axis,
            point_a: pair.core_a.origin + points.a * scale - normal * pair.core_a.radius,
            point_b: pair.core_b.origin + points.b * scale + normal * pair.core_b.radius,
            overlap: false,
            status: Status::Converged,
            iterations: state.iterations,
            unexpanded: 0,
        })
    }
}

/// GJK, after which the shortest vector is measured, unless zero is within a simplex of full dimension: then there is
/// no such vector.
#[inline(always)]
pub(super) fn measured<V: Vector>(
    state: &mut Gjk<V>,
    pair: &mut AnyPair<'_, V>,
    frame: Frame<V>,
    options: GjkOptions<V>,
    observer: &mut Observer<'_, V>,
) -> End {
    let end = gjk(state, pair, frame, options, None, observer);
    if end != End::Overlap || state.simplex.points().len() <= V::DIM {
        state.ensure_measured();
    }
    end
}

/// A bound on the error of points of the difference of two cores of the given size, as a length, in the world's unit:
/// no less than any [`Uncertainty`](super::Uncertainty), since no sum of products of coordinates is more than the
/// product of the lengths, and the offset of the origins loses half an ε of its own.
#[inline(always)]
pub(super) fn error_of_points<T: Shapes<Vector = V> + ?Sized, V: Vector>(
    pair: &Pair<'_, T>,
    size: V::Scalar,
) -> V::Scalar {
    pair.error() + (size - pair.radius()) * (V::Scalar::EPSILON * Scalar::from_f64(SUM))
}

#[cfg(test)]
mod tests {
    use convex_support::glam::DVec3;
    use convex_support::{Cuboid, InvalidShape, Posed, Rounded, SupportMap};

    use super::*;
    use crate::SignedDistanceOptions;
    use crate::pair::Both;
    use crate::separation::{Begun, Cores, OfOverlap, Wanted, separation};

    /// The answer of the first means, and whether that of all means is the same to the last bit.
    fn apart(a: &impl SupportMap<Vector = DVec3>, b: &impl SupportMap<Vector = DVec3>) -> Option<bool> {
        let shapes = Both::<_, _>::new(a, b);
        let cores = shapes.cores();
        let mut search = FirstSearch::new(&shapes, cores.each_ref());
        let mut state = Gjk::new(search.frame.offset);
        let (touching, options) = (search.frame.radius, GjkOptions::new(state.normal, 200));
        let end = search.run(&mut state, touching, options, &mut Observer::none());
        let any = Enough { width: f64::INFINITY, tolerance: 0.0, limit: f64::INFINITY };
        let known = search.apart(&state, end?, any)?;
        let wanted = Wanted::new(OfOverlap::Known, SignedDistanceOptions::default(), None);
        let mut cores = Cores::new(FirstSearch::new(&shapes, cores.each_ref()));
        let found = separation::<_, false>(&mut cores, &wanted, Begun::Nothing, &mut Observer::none());
        let all = found.distance(&cores, &wanted);
        let numbers = (known.signed_distance, known.lower, known.upper, known.iterations);
        let is_same = numbers == (all.distance, all.lower, all.upper, all.iterations)
            && [Some(known.normal), Some(known.point_a), Some(known.point_b)]
                == [all.normal, Some(all.point_a), Some(all.point_b)]
            && (known.status, known.overlap) == (all.status, all.overlap);
        Some(is_same)
    }

    #[test]
    fn bodies_that_are_plainly_apart_have_the_answer_of_all_means() -> Result<(), InvalidShape> {
        for scale in [1e-100, 1e-3, 1.0, 1e6, 1e100] {
            let cube = Cuboid::new(DVec3::splat(scale))?;
            let round = Rounded::new(cube, scale * 0.25)?;
            for gap in [1e-12, 1e-6, 0.1, 3.0] {
                let over = |aside| Posed::translated(cube, DVec3::new(aside, 2.0 + gap, 0.3) * scale);
                for aside in [0.2, 2.5, -3.0] {
                    assert_eq!(apart(&over(aside)?, &cube), Some(true), "{scale:e} {gap:e} {aside}");
                    let round_over = Posed::translated(round, DVec3::new(aside, 2.5 + gap, 0.3) * scale)?;
                    assert_eq!(apart(&round_over, &round), Some(true), "{scale:e} {gap:e} {aside}");
                }
            }
            // Within rounding of contact, and in overlap, the other means decide.
            for y in [2.0, 1.9] {
                let near = Posed::translated(cube, DVec3::new(0.2, y, 0.3) * scale)?;
                assert_eq!(apart(&near, &cube), None, "{scale:e} {y}");
            }
        }
        Ok(())
    }
}
