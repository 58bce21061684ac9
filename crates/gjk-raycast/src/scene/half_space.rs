//! Half-spaces: floors and walls without an end.

use convex_support::{Core, InvalidShape, Rounding, Scalar, SupportMap, Vector};
use num_traits::Float;

use crate::{
    Distance, LinearCast, LinearCastOptions, LinearHit, Miss, Motion, Outcome, Ray, RayCast, RayCastError,
    RayCastOptions, RayHit, StartInContact, Status,
};

/// The points x with n·x ≤ offset: everything on one side of a plane.
///
/// It is no [`SupportMap`], since it has no farthest point along most directions; but along −n, a shape's nearest point to
/// it is its support point, so that casts and distances are closed forms of one support point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<V: Vector> {
    normal: V,
    offset: V::Scalar,
    /// The length of the normal.
    pub(super) length: V::Scalar,
}

impl<V: Vector> HalfSpace<V> {
    /// The half-space of the points x with `normal·x ≤ offset`. The normal points out of it and need not be of unit length.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a number is not finite, [`InvalidShape::NotPositive`] if the normal is zero or so
    /// long or short that its length is not a number of full precision.
    pub fn new(normal: V, offset: V::Scalar) -> Result<Self, InvalidShape> {
        if let Some(index) = (0..V::DIM).find(|&i| !normal.get(i).is_finite()) {
            return Err(InvalidShape::NonFinite { parameter: "normal", index });
        }
        if !offset.is_finite() {
            return Err(InvalidShape::NonFinite { parameter: "offset", index: 0 });
        }
        let length = normal.norm();
        if !(length >= V::Scalar::min_positive_value() / V::Scalar::EPSILON && length.is_finite()) {
            return Err(InvalidShape::NotPositive { parameter: "normal", index: 0, value: length.as_f64() });
        }
        Ok(Self { normal, offset, length })
    }

    /// The normal as it was given.
    #[must_use]
    pub fn normal(&self) -> V {
        self.normal
    }

    /// The offset as it was given.
    #[must_use]
    pub fn offset(&self) -> V::Scalar {
        self.offset
    }

    /// How far a point is above the plane, in lengths of the normal, and what rounding may have moved that by if the
    /// point's coordinates are off by `error`.
    ///
    /// A dot product of two or three terms and a difference are off by 4 ε of the sum of all magnitudes at most.
    fn height(&self, point: V, error: V) -> [V::Scalar; 2] {
        let magnitude = self.normal.abs().dot(point.abs()) + self.offset.abs();
        let rounding = V::Scalar::from_f64(4.0) * V::Scalar::EPSILON * magnitude + self.normal.abs().dot(error);
        [self.normal.dot(point) - self.offset, rounding]
    }

    /// The point of a shape nearest to the half-space, or deepest in it, and by how much its coordinates may be off: by
    /// what the core's are, and by the sums and the products that add the origin and the radius.
    fn nearest_of<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A) -> (V, V) {
        let (Core { origin, radius, .. }, Rounding { extent, error, .. }) = (shape.core(), shape.rounding());
        let magnitude = origin.abs() + extent + V::splat(radius);
        (shape.support(-self.normal), error + magnitude * (V::Scalar::from_f64(4.0) * V::Scalar::EPSILON))
    }

    /// The ray's first point in the half-space: where n·(s + λd) = offset, λ = (n·s − offset)/(−n·d).
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero or a coordinate is not finite.
    pub fn ray_cast(&self, ray: Ray<V>, options: RayCastOptions<V>) -> Result<RayCast<V>, RayCastError> {
        ray.check()?;
        let normal = self.normal / self.length;
        if options.min_lambda > V::Scalar::ZERO {
            return Ok(self.ray_cast_from(ray, options));
        }
        let (lambda, bracket) = self.crossing(ray, V::ZERO, options.max_lambda);
        let outcome = match lambda {
            Outcome::Hit(lambda) if lambda > V::Scalar::ZERO => {
                Outcome::Hit(RayHit { lambda, point: ray.at(lambda), normal: Some(normal) })
            }
            Outcome::Hit(lambda) => Outcome::Hit(RayHit { lambda, point: ray.source, normal: None }),
            Outcome::Miss(miss) => Outcome::Miss(miss),
            Outcome::Undecided => Outcome::Undecided,
        };
        let Bracket { lower, upper, status } = bracket;
        Ok(RayCast { outcome, lower, upper, status, iterations: 0 })
    }

    /// The same of a ray that begins at `min_lambda`: the half-space is entered there, or at once if it is entered before, unless it
    /// has been left again.
    fn ray_cast_from(&self, ray: Ray<V>, options: RayCastOptions<V>) -> RayCast<V> {
        let begin = options.min_lambda;
        let (lambda, Bracket { lower, upper, status }) = self.crossing(ray, V::ZERO, options.max_lambda);
        let normal = self.normal / self.length;
        let [height, rounding] = self.height(ray.at(begin), ray.direction.abs() * (begin * V::Scalar::EPSILON));
        let infinity = V::Scalar::infinity();
        let mut answer = RayCast { outcome: Outcome::Undecided, lower, upper, status, iterations: 0 };
        match lambda {
            Outcome::Miss(miss) => answer.outcome = Outcome::Miss(miss),
            Outcome::Undecided => answer.lower = lower.max(begin),
            Outcome::Hit(lambda) if lambda >= begin => {
                answer.outcome = Outcome::Hit(RayHit { lambda, point: ray.at(lambda), normal: Some(normal) });
                answer.lower = lower.max(begin);
            }
            Outcome::Hit(_) if height > rounding || begin > options.max_lambda => {
                answer.outcome = Outcome::Miss(Miss { axis: normal });
                (answer.lower, answer.upper) = (infinity, infinity);
            }
            Outcome::Hit(_) => {
                answer.outcome = Outcome::Hit(RayHit { lambda: begin, point: ray.at(begin), normal: None });
                (answer.lower, answer.upper) = (begin, begin);
            }
        }
        answer
    }

    /// When a moving shape, `a`, first touches the half-space, `b`: the ray of its nearest point.
    ///
    /// # Errors
    /// [`RayCastError::NonFinite`] if a velocity is not finite, or the target distance is NaN.
    pub fn linear_cast<A: SupportMap<Vector = V> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<V>,
        options: LinearCastOptions<V>,
    ) -> Result<LinearCast<V>, RayCastError> {
        motion.check()?;
        let target = options.target_distance;
        if target.is_nan() {
            return Err(RayCastError::NonFinite { parameter: "target_distance", index: 0 });
        }
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let unit = self.normal / self.length;
        let (nearest, mut error) = self.nearest_of(shape);
        let mut source = nearest;
        if target > zero {
            source -= unit * target;
            // The unit normal is rounded, the product, and the sum.
            error += (nearest.abs() + V::splat(target)) * (V::Scalar::from_f64(4.0) * V::Scalar::EPSILON);
        }
        let ray = Ray { source, direction: motion.velocity_a - motion.velocity_b };
        let [height, rounding] = self.height(source, error);
        if options.start_in_contact == StartInContact::IfDeeper && height <= rounding {
            let (speed, doubt) = self.speed(ray.direction);
            if speed <= doubt {
                let outcome = Outcome::Miss(Miss { axis: unit });
                let (lower, upper, status) = (infinity, infinity, Status::Converged);
                return Ok(LinearCast { outcome, lower, upper, status, iterations: 1 });
            }
        }
        let (time, Bracket { lower, upper, status }) = self.crossing(ray, error, options.max_time);
        let has_normal = height >= -rounding || options.start_in_contact == StartInContact::IfDeeper;
        let outcome = match time {
            Outcome::Hit(time) => Outcome::Hit(LinearHit {
                time,
                // Of a target distance, the point of the half-space below.
                point: source + motion.velocity_a * time,
                normal: (time > zero || has_normal).then_some(unit),
            }),
            Outcome::Miss(miss) => Outcome::Miss(miss),
            Outcome::Undecided => Outcome::Undecided,
        };
        Ok(LinearCast { outcome, lower, upper, status, iterations: 1 })
    }

    /// The distance from a shape, `a`, to the half-space, `b`.
    pub fn distance_from<A: SupportMap<Vector = V> + ?Sized>(&self, shape: &A) -> Distance<V> {
        let (zero, two) = (V::Scalar::ZERO, V::Scalar::from_f64(2.0));
        let (point_a, error) = self.nearest_of(shape);
        let [height, rounding] = self.height(point_a, error);
        // The length and the quotient are rounded as well.
        let [less, more] = [-two, two].map(|ulps| V::Scalar::ONE + ulps * V::Scalar::EPSILON);
        let overlap = !(height > zero);
        let normal = self.normal / self.length;
        let distance = Float::max(height / self.length, zero);
        Distance {
            distance,
            lower: Float::max((height - rounding) / self.length * less, zero),
            upper: Float::max((height + rounding) / self.length * more, zero),
            overlap,
            point_a,
            point_b: if overlap { point_a } else { point_a - normal * distance },
            normal: (!overlap).then_some(normal),
            status: Status::Converged,
            iterations: 1,
        }
    }

    /// The distance from the half-space, `a`, to a shape, `b`.
    pub(super) fn distance_to<B: SupportMap<Vector = V> + ?Sized>(&self, shape: &B) -> Distance<V> {
        self.distance_from(shape).reversed()
    }

    /// How fast a direction leads down, and what rounding may have made of that.
    fn speed(&self, direction: V) -> (V::Scalar, V::Scalar) {
        let doubt = V::Scalar::from_f64(4.0) * V::Scalar::EPSILON * self.normal.abs().dot(direction.abs());
        (-self.normal.dot(direction), doubt)
    }

    /// Where the ray crosses the plane inwards, of a source whose coordinates are off by `error`.
    fn crossing(&self, ray: Ray<V>, error: V, end: V::Scalar) -> (Outcome<V::Scalar, V>, Bracket<V::Scalar>) {
        let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
        let [height, rounding] = self.height(ray.source, error);
        let closed = |lower, upper| Bracket { lower, upper, status: Status::Converged };
        if height <= zero && end >= zero {
            return (Outcome::Hit(zero), closed(zero, zero));
        }
        let (speed, doubt) = self.speed(ray.direction);
        let miss = (Outcome::Miss(Miss { axis: self.normal / self.length }), closed(infinity, infinity));
        if speed <= zero {
            return miss;
        }
        let [less, more] = [-2.0, 2.0].map(|ulps| V::Scalar::ONE + V::Scalar::from_f64(ulps) * V::Scalar::EPSILON);
        let lower = Float::max((height - rounding) / (speed + doubt) * less, zero);
        if speed <= doubt {
            return (Outcome::Undecided, Bracket { lower, upper: infinity, status: Status::Stalled });
        }
        let lambda = height / speed;
        if !(lambda <= end) {
            return miss;
        }
        (Outcome::Hit(lambda), closed(lower, (height + rounding) / (speed - doubt) * more))
    }
}

/// What is certain of a crossing.
struct Bracket<S> {
    lower: S,
    upper: S,
    status: Status,
}
