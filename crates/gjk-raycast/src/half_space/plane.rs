//! The heights of points over a plane, each accurate to one rounding of itself.

use convex_support::numerics::bound::{least, raised, roundings};
use convex_support::numerics::twofold::{two_product, two_sum};
use convex_support::{Core, Hint, Rounding, Scalar, SupportMap, Vector};
use num_traits::Float;

use crate::contact::Level;
use crate::unit::{power_of_two_near, reciprocal_of_power};
use crate::{Distance, SignedDistance, Status};

/// The plane of a half-space. Its normal and offset are those given, in units of a power of two near the normal's
/// length, and so exact.
#[derive(Clone, Debug)]
pub(crate) struct Plane<V: Vector> {
    normal: V,
    offset: V::Scalar,
    length: V::Scalar,
    pub(crate) unit: V,
}

/// A shape's point nearest to a half-space, or deepest in it.
pub(crate) struct Lowest<V: Vector> {
    pub(crate) height: Level<V::Scalar>,
    pub(crate) point: V,
}

impl<V: Vector> Lowest<V> {
    /// The signed distance of the shape from the half-space with this unit normal.
    pub(super) fn signed_distance(self, unit: V) -> SignedDistance<V> {
        let Self { height, point } = self;
        let is_known = height.value.is_finite() && height.error.is_finite();
        let infinity = V::Scalar::infinity();
        SignedDistance {
            signed_distance: height.value,
            lower: if is_known { height.least() } else { -infinity },
            upper: if is_known { height.most() } else { infinity },
            normal: unit,
            point_a: point,
            point_b: point - unit * height.value,
            overlap: height.value <= Scalar::ZERO,
            status: if is_known { Status::Converged } else { Status::Stalled },
            iterations: 1,
            unexpanded: 0,
        }
    }

    /// The distance of the shape, which is 0 if it overlaps the half-space.
    pub(crate) fn distance(self, unit: V) -> Distance<V> {
        let zero = V::Scalar::ZERO;
        let SignedDistance { signed_distance, lower, upper, normal, point_a, point_b, status, iterations, .. } =
            self.signed_distance(unit);
        let overlap = !(signed_distance > zero);
        Distance {
            distance: signed_distance.max(zero),
            lower: lower.max(zero),
            upper: upper.max(zero),
            overlap,
            point_a,
            point_b: if overlap { point_a } else { point_b },
            normal: (!overlap).then_some(normal),
            status,
            iterations,
        }
    }
}

impl<V: Vector> Plane<V> {
    /// The plane of the points x with n·x equal to the offset; `length` is that of the normal n.
    pub(super) fn new(normal: V, offset: V::Scalar, length: V::Scalar) -> Self {
        let per_unit = reciprocal_of_power(power_of_two_near(length));
        let (normal, length) = (normal * per_unit, length * per_unit);
        Self { normal, offset: offset * per_unit, length, unit: normal / length }
    }

    /// The height of the lowest point of a shape swept by a further ball.
    pub(super) fn lowest<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A, swept: V::Scalar) -> Lowest<V> {
        let Core { origin, radius, .. } = shape.core();
        let radius = radius + swept;
        let point = shape.core_support(-self.normal, &mut Hint::new());
        let height = self.height([origin, point], self.error_along(&shape.rounding()), radius);
        Lowest { height, point: origin + point - self.unit * radius }
    }

    /// The height of the sum of some vectors, less a radius; the sum has an `error` along the normal.
    pub(crate) fn height<const N: usize>(
        &self,
        terms: [V; N],
        error: V::Scalar,
        radius: V::Scalar,
    ) -> Level<V::Scalar> {
        let Level { value, error: rounded } = self.level(terms, self.offset);
        // The rounding of the radius, of its sum and of the difference.
        Level { value: value - radius, error: raised(rounded + error + roundings(4.0, radius)) }
    }

    /// The sinking speed of a point whose velocity is the sum of some vectors.
    pub(crate) fn sinking<const N: usize>(&self, velocities: [V; N]) -> Level<V::Scalar> {
        let Level { value, error } = self.level(velocities, V::Scalar::ZERO);
        Level { value: -value, error }
    }

    /// The error of support points along the normal.
    pub(crate) fn error_along(&self, rounding: &Rounding<V>) -> V::Scalar {
        Float::min(self.normal.abs().dot(rounding.error) / self.length, rounding.error_length)
    }

    /// An upper bound of a length along the unit normal, from one along the [normal](Self::normal).
    pub(crate) fn per_length(&self, along: V::Scalar) -> V::Scalar {
        along / self.length
    }

    /// The normal, whose length is between one and two.
    pub(crate) fn normal(&self) -> V {
        self.normal
    }

    /// `(n·Σ terms − subtracted)/|n|`, by one sum of products in twice the precision. If nothing is rounded the error
    /// is zero, so that a motion along the plane is recognized.
    ///
    /// With the parts `lᵢ` lost in `k` products and sums, the sum is wrong by no more than `(k + 1)·ε·Σ |lᵢ|` and its
    /// own rounding. The length and the quotient lose another eight halves of ε.
    fn level<const N: usize>(&self, terms: [V; N], subtracted: V::Scalar) -> Level<V::Scalar> {
        let zero = V::Scalar::ZERO;
        let (mut sum, mut lost, mut magnitude, mut tiny) = (-subtracted, zero, zero, zero);
        let subnormal = V::Scalar::min_positive_value() / V::Scalar::EPSILON;
        for i in 0..V::DIM {
            for term in terms {
                let (n, x) = (self.normal.get(i), term.get(i));
                let [product, lost_in_product] = two_product(n, x);
                let [next, lost_in_sum] = two_sum(sum, product);
                sum = next;
                lost += lost_in_product + lost_in_sum;
                magnitude += lost_in_product.abs() + lost_in_sum.abs();
                // The lost part is itself subnormal.
                if product.abs() < subnormal && n != zero && x != zero {
                    tiny += least();
                }
            }
        }
        let value = (sum + lost) / self.length;
        let of_losses = magnitude * (V::Scalar::EPSILON * V::Scalar::from_f64((2 * N * V::DIM + 1) as f64));
        let error = raised(of_losses + roundings(9.0, value.abs())) + tiny;
        Level { value, error }
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DVec3, Vec3};

    use super::Plane;

    /// The offset and the products cancel to a millionth; the rest is accurate to one rounding of itself.
    #[test]
    fn a_height_is_wrong_by_no_more_than_its_error() {
        let normal = Vec3::new(0.6, -0.48, 0.64);
        for i in 0..1000_u16 {
            let point = Vec3::new(1e3 + f32::from(i), 0.1 * f32::from(i), -7.0);
            let offset = normal.dot(point) * (1.0 + 1e-6);
            let plane = Plane { normal, offset, length: normal.length(), unit: normal.normalize() };
            let height = plane.height([point, Vec3::new(1e-3, 0.0, 2e-3)], 0.0, 0.25);
            let exact = normal.as_dvec3();
            let sum = exact.dot(point.as_dvec3() + Vec3::new(1e-3, 0.0, 2e-3).as_dvec3()) - f64::from(offset);
            let known = sum / DVec3::length(exact) - 0.25;
            assert!((f64::from(height.value) - known).abs() <= f64::from(height.error), "{i}: {known} {height:?}");
            assert!(f64::from(height.error) <= 16.0 * f64::from(f32::EPSILON), "{i}: {height:?}");
        }
    }
}
