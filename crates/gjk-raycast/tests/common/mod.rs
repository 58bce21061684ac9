//! What the regression tests share: numbers and vectors of either precision.

pub(crate) mod behind_pointers;
pub(crate) mod space;
pub(crate) mod strategies;

use behind_pointers::{distance, intersects, linear_cast, ray_cast};
use convex_support::glam::DVec3;
use convex_support::{Core, Cuboid, Hint, Posed, Rotation, Rounding, Scalar, ScalarOf, SupportMap, Vector};
use gjk_raycast::{
    Distance, DistanceOptions, IntersectOptions, Intersection, LinearCast, LinearCastOptions, Motion, Ray, RayCast,
    RayCastOptions,
};

/// The nearest number of the precision of `V`.
pub(crate) fn s<V: Vector>(x: f64) -> V::Scalar {
    V::Scalar::from_f64(x)
}

/// The nearest vector.
pub(crate) fn v<V: Vector>(coordinates: [f64; 3]) -> V {
    V::from_fn(|i| s::<V>(coordinates[i]))
}

/// How many times the precision's rounding error, relative to one.
pub(crate) fn ulps<V: Vector>(count: f64) -> f64 {
    count * V::Scalar::EPSILON.as_f64()
}

pub(crate) fn cuboid<V: Vector>(half_extents: [f64; 3]) -> Cuboid<V> {
    Cuboid::new(v(half_extents)).expect("positive half extents")
}

pub(crate) fn at<S: SupportMap>(shape: S, translation: [f64; 3]) -> Posed<S> {
    Posed::translated(shape, v(translation)).expect("finite translation")
}

pub(crate) fn turned<S>(shape: S, rotation: <S::Vector as Vector>::Rotation, translation: [f64; 3]) -> Posed<S>
where
    S: SupportMap,
{
    Posed::new(shape, rotation, v(translation)).expect("a rotation and a finite translation")
}

pub(crate) fn cast<S: SupportMap>(target: &S, source: [f64; 3], direction: [f64; 3]) -> RayCast<S::Vector> {
    let ray = Ray { source: v(source), direction: v(direction) };
    ray_cast(target, ray, RayCastOptions::default()).expect("a finite ray with a direction")
}

/// λ of a hit.
pub(crate) fn lambda<S: SupportMap>(target: &S, source: [f64; 3], direction: [f64; 3]) -> Option<f64> {
    cast(target, source, direction).outcome.hit().map(|hit| hit.lambda.as_f64())
}

pub(crate) fn sweep<A, B>(a: &A, b: &B, velocity_a: [f64; 3]) -> LinearCast<A::Vector>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    let motion = Motion { velocity_a: v(velocity_a), velocity_b: A::Vector::ZERO };
    linear_cast(a, b, motion, LinearCastOptions::default()).expect("finite velocities")
}

/// The time of impact.
pub(crate) fn time<A, B>(a: &A, b: &B, velocity_a: [f64; 3]) -> Option<f64>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    sweep(a, b, velocity_a).outcome.hit().map(|hit| hit.time.as_f64())
}

pub(crate) fn apart<A, B>(a: &A, b: &B) -> Distance<A::Vector>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    distance(a, b, DistanceOptions::default())
}

pub(crate) fn meets<A, B>(a: &A, b: &B) -> Intersection<A::Vector>
where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    intersects(a, b, IntersectOptions::default())
}

/// The angle between two unit vectors, nearly.
pub(crate) fn off<V: Vector>(found: Option<V>, expected: [f64; 3]) -> f64 {
    found.map_or(f64::INFINITY, |n| (n - v::<V>(expected)).norm().as_f64())
}

/// A few dozen directions all around, the same each time.
pub(crate) fn directions(count: u32) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (2.399_963 * f64::from(i)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * cos, r * sin, z]
    })
}

/// The rotation of a quaternion with components `x`, `y`, `z`, `w`.
pub(crate) fn quaternion<V: Vector>(q: [f64; 4]) -> V::Rotation {
    V::Rotation::from_xyzw(q.map(V::Scalar::from_f64))
}

/// Numbers from a seed (Marsaglia's xorshift).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn number(&mut self, from: f64, to: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        from + (to - from) * (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A vector with coordinates up to `reach`.
    pub(crate) fn vector<V: Vector>(&mut self, reach: f64) -> V {
        V::from_fn(|_| s::<V>(self.number(-reach, reach)))
    }

    /// A unit vector.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let v: DVec3 = self.vector(1.0);
            if (0.01..1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }
}

/// A shape that says of itself what it must, and of its closest points, its crossings and its other shortcuts nothing.
pub(crate) struct Plain<S>(pub(crate) S);

impl<S: SupportMap> SupportMap for Plain<S> {
    type Vector = S::Vector;

    fn support(&self, direction: S::Vector) -> S::Vector {
        self.0.support(direction)
    }

    fn core(&self) -> Core<S::Vector> {
        self.0.core()
    }

    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.0.core_support(direction, hint)
    }

    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        self.0.core_support_hessian(direction, changes)
    }

    fn rounding(&self) -> Rounding<S::Vector> {
        self.0.rounding()
    }
}
