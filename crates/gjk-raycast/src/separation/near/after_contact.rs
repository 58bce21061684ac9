//! Bodies that have moved on from [near contact](super): whether they are apart now, or how much room zero has in their
//! difference. A cast that starts within rounding of contact asks where it certainly enters.

use core::convert::Infallible;

use convex_support::numerics::bound::{raised, roundings, roundings_of};
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::octahedron::Octahedron;
use super::uncertainty::Uncertainty;
use super::{begin, go_on};
use crate::body::PointPair;
use crate::gjk::Frame;
use crate::pair::{AnyPair, Both, Pair, Shape, Shapes as _};
use crate::symmetric::axes_across;

/// What bounds the vector from a point of the difference to zero, where zero is near the point: the vector is
/// `c − a·n`, with `a` from 0 to `along`, and with `c` no longer than `across`.
pub(crate) struct FromContact<V: Vector> {
    /// The unit vector into the difference.
    pub(crate) n: V,
    pub(crate) along: V::Scalar,
    pub(crate) across: V::Scalar,
    /// A bound on the length of the whole vector.
    pub(crate) length: V::Scalar,
}

impl<V: Vector> FromContact<V> {
    /// A bound on the component of the vector along a unit vector `u`.
    fn reach(&self, u: V) -> V::Scalar {
        let part = self.along * (-self.n.dot(u)).max(V::Scalar::ZERO) + roundings(16.0, self.along) + self.across;
        part.min(self.length)
    }
}

/// The result about two bodies, one of which has moved on from near contact; lengths in the world's unit.
pub(crate) struct After<V: Vector> {
    /// A lower bound on their distance along an axis, a unit vector from the second body to the first.
    pub(crate) lower: V::Scalar,
    pub(crate) axis: V,
    /// The factor up to which multiples of the vector from contact certainly end in the difference; not positive where
    /// zero may be outside.
    pub(crate) times: V::Scalar,
    pub(crate) iterations: usize,
}

/// Measures bodies after contact, whose places are known to `astray`, by a plane between them or by the
/// [`Octahedron`] of the points at a distance `aside` from zero, along the normal at contact and across it.
#[cold]
#[inline(never)]
pub(crate) fn look_after<V: Vector>(
    [a, b]: [Shape<'_, V>; 2],
    from: &FromContact<V>,
    [aside, astray]: [V::Scalar; 2],
    max_iterations: usize,
) -> After<V> {
    let shapes = Both::<_, _>::new(a, b);
    let cores = shapes.cores();
    let mut pair: AnyPair<'_, V> = Pair::new(&shapes, cores.each_ref());
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset) + aside;
    let frame = Frame::new(&mut pair, offset, size);
    let mut state = begin(&pair, &frame, size, max_iterations);
    state.ensure_measured();
    // If the closest points are known at once, there is no plane yet.
    if state.length > frame.radius && !state.lower.is_finite() {
        let _ = go_on(&mut state, &mut pair, &frame, max_iterations);
    }
    let mut iterations = state.iterations;
    let lower = (state.lower - frame.radius - frame.error) * frame.scale - astray;
    let mut times = V::Scalar::ZERO;
    if lower <= V::Scalar::ZERO {
        let [u, w] = axes_across(from.n);
        let aside = aside * frame.per_unit;
        let octahedron = Octahedron::around_zero([from.n, u, w], aside, frame.radius, |place| {
            let seen = Frame { offset: frame.offset - place, ..frame };
            let mut found = begin(&pair, &seen, size, max_iterations.saturating_sub(iterations));
            found.ensure_measured();
            iterations += found.iterations;
            let PointPair { a, b } = found.simplex.weighted_witness();
            Ok::<_, Infallible>((!found.simplex.points().is_empty()).then_some(a - b + frame.offset))
        });
        if let Ok(Some(octahedron)) = octahedron
            && frame.error.is_finite()
        {
            // In units of `ε/2`, weighted sums lose 5, the weights' own sum 4, the difference and its sum with the
            // offset one each; the offset loses 2, and the step to the surface 4.
            let known = Uncertainty::new(&pair, frame.per_unit);
            let rounded =
                roundings_of(12.0, known.extent) + roundings_of(4.0, frame.offset.abs() + V::splat(frame.radius));
            let (known, astray) = (known.with(rounded), astray * frame.per_unit);
            let error = |u: V| raised(known.along(u)).min(frame.error + frame.noise) + astray;
            times = octahedron.room(error, |u| from.reach(u)) * frame.scale;
        }
    }
    After { lower, axis: state.axis.unit().unwrap_or(from.n), times, iterations }
}
