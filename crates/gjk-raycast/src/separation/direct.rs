//! The plain case: shapes whose closest points are known in closed form.

use convex_support::{Core, Scalar, Vector};
use num_traits::Float as _;

use super::cores::{error_of_points, slack};
use super::near_contact::NEAR;
use crate::SignedDistance;
use crate::body::{Pair, Shapes, TracedSupport as _};
use crate::gjk::rounding;
use crate::observer::Observer;
use crate::{Iterate, Status};

/// The signed distance of shapes whose cores are apart by more than a few errors, and whose closest points are known
/// in closed form, such as a ball and a box, whether they overlap or not. There is nothing to search, and everything
/// is computed in the world's unit. Near contact they are measured again.
///
/// The plane of the support point across the vector between those points is as far as they are, to rounding;
/// otherwise the search takes over.
#[inline(always)]
pub(crate) fn direct<T: Shapes + ?Sized>(
    shapes: &T,
    cores: [Core<T::Vector>; 2],
    max_iterations: usize,
    observer: &mut Observer<'_, T::Vector>,
) -> Option<SignedDistance<T::Vector>> {
    let mut pair = Pair::new(shapes, cores.each_ref());
    let offset = pair.core_a.origin - pair.core_b.origin;
    let size = pair.size(offset);
    let points = pair.closest_points(offset, size)?;
    let v = pair.vector_between(points, offset);
    let (length, radius, error) = (v.length(), pair.radius(), error_of_points(&pair, size));
    // The gap below which the distance is measured again; it allows for more rounding.
    let near = (rounding(size) + pair.error()) * Scalar::from_f64(NEAR);
    // NaN is left to the search.
    if !(length.min((length - radius).abs()) > near) || max_iterations == 0 {
        return None;
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
