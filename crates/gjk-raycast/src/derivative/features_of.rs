//! The features that answers are about.

use convex_support::{Core, Matrix, Point, Scalar, SupportMap, Vector, compiled_once};

use num_traits::Float as _;

use super::ClosestFeatures;
use super::closest_features::{ClosestPoints, rounding};
use crate::motion::Moved;
use crate::shape::Shape;
use crate::{
    Distance, Impact, Ray, RayHit, RigidMotion, SignedDistance, SignedDistanceOptions, Trajectory, signed_distance,
};

/// How far overlapping bodies are pushed into one another to see whether there is another way out, as a part of their
/// size, in units of the square root of ε. If bodies are farther apart than this at a hit, the cast had a target
/// distance.
const LITTLE: f64 = 64.0;

/// How much a push may gain: at most so many times its square, in units of the size, and at most this part of the size,
/// which leaves room for single precision.
const GAIN: [f64; 2] = [256.0, 1e-4];

/// If the cosine of the angle between two normals is at least this, they are of the same way out.
const SAME_NORMAL: f64 = 1.0 - 1e-6;

fn little<S: Scalar>(size: S) -> S {
    size * S::EPSILON.sqrt() * S::from_f64(LITTLE)
}

impl<V: Vector> Distance<V> {
    /// The features that are closest, of the shapes that were asked about; `None` where they overlap.
    #[must_use]
    pub fn closest_features<A, B>(&self, a: &A, b: &B) -> Option<ClosestFeatures<V>>
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        let error = self.upper - self.lower;
        let (points, signed_distance) = ([self.point_a, self.point_b], self.distance);
        let closest = ClosestPoints { normal: self.normal?, points, signed_distance, error, is_near: false };
        // NaN is not above it.
        let is_at_floor = !(self.lower > Scalar::ZERO);
        Some(ClosestFeatures { is_at_floor, ..ClosestFeatures::new(a, b, closest) })
    }
}

impl<V: Vector> Distance<V> {
    /// The answer with the normal and the points of its [features](Self::closest_features), which are known to
    /// rounding.
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        let [point_a, point_b] = features.points;
        Self { normal: Some(features.normal), point_a, point_b, ..self }
    }
}

impl<V: Vector> SignedDistance<V> {
    /// The features that are closest, or deepest in one another, of the shapes that were asked about.
    ///
    /// Where the cores of the shapes overlap, another [`signed_distance`] tells whether there is another way out that
    /// is as short: it is that of `a` pushed on by a millionth of the size, against the normal, which makes any other
    /// way the shorter one.
    pub fn closest_features<A, B>(&self, a: &A, b: &B) -> ClosestFeatures<V>
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        let &Self { normal, signed_distance, point_a, point_b, lower, upper, .. } = self;
        let closest =
            ClosestPoints { normal, points: [point_a, point_b], signed_distance, error: upper - lower, is_near: false };
        let mut features = ClosestFeatures::new(a, b, closest);
        let (core_a, core_b) = (a.core(), b.core());
        // By the lower bound, since cores that touch may seem a rounding apart.
        if lower + core_a.radius + core_b.radius <= Scalar::ZERO {
            features.is_tied = self.is_tied(a, core_a, b, core_b);
        }
        features
    }

    /// The answer with the normal and the points of its [features](Self::closest_features), which are known to
    /// rounding.
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        let [point_a, point_b] = features.points;
        Self { normal: features.normal, point_a, point_b, ..self }
    }

    /// Whether another normal is as good. If `a` is moved by `−η·n`, the signed distance along any normal `m` falls by
    /// `η·n·m`. So if another normal was as good to within `η·(1 − n·m)`, it is now the best, is found, and can be
    /// measured. Whatever its bracket leaves open may be a tie. If the bodies are curved, the other normal turns a
    /// little as they are pushed, which gains `η²` over twice the stiffness.
    fn is_tied<A, B>(&self, a: &A, core_a: Core<V>, b: &B, core_b: Core<V>) -> bool
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        let size = core_a.extent + core_a.radius + core_b.extent + core_b.radius;
        let push = little(size);
        let pushed = Core { origin: core_a.origin - self.normal * push, ..core_a };
        let moved = Moved::new(&a, pushed, None, Scalar::ZERO);
        let least = V::Scalar::EPSILON * V::Scalar::from_f64(8.0);
        let other = signed_distance(&moved, b, SignedDistanceOptions::default().with_tolerance(least));
        let cosine = other.normal.dot(self.normal);
        let along_other = other.upper + push * cosine;
        let [times, part] = GAIN.map(V::Scalar::from_f64);
        let gained = (push * (push / size) * times).min(size * part);
        let tolerance = V::Scalar::EPSILON * V::Scalar::from_f64(256.0) * size + gained;
        let is_other = cosine < V::Scalar::from_f64(SAME_NORMAL);
        is_other && along_other > self.lower - tolerance
    }
}

impl<V: Vector> Impact<V> {
    /// The features that touch, of the bodies that were cast with the given motions, those of a
    /// [`linear_cast`](crate::linear_cast) being its [translations](crate::Motion::translations); `None` where they
    /// overlap at the start.
    #[must_use]
    pub fn closest_features<A, MA, B, MB>(
        &self,
        a: &A,
        motion_a: &MA,
        b: &B,
        motion_b: &MB,
    ) -> Option<ClosestFeatures<V>>
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
        MA: Trajectory<Vector = V> + ?Sized,
        MB: Trajectory<Vector = V> + ?Sized,
    {
        touching(self.normal?, self.point, self.time, (&a, &motion_a), (&b, &motion_b))
    }

    /// The hit with the normal and the point of its [features](Self::closest_features), which are known to rounding,
    /// and so its [gradient](Self::gradient).
    #[must_use]
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        Self { normal: Some(features.normal), point: features.points[1], ..self }
    }

    /// How much later the bodies touch as their start poses begin to move, per unit of time of that motion: the
    /// one-sided derivative of the time of contact. It is exact also where parallel faces or edges touch. `None` where
    /// there is no [`gradient`](Self::gradient), or the normal is [not the only
    /// one](ClosestFeatures::is_normal_unique).
    #[must_use]
    pub fn rate<A, MA, B, MB>(
        &self,
        (a, motion_a, change_a): (&A, &MA, RigidMotion<V>),
        (b, motion_b, change_b): (&B, &MB, RigidMotion<V>),
    ) -> Option<V::Scalar>
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
        MA: Trajectory<Vector = V> + ?Sized,
        MB: Trajectory<Vector = V> + ?Sized,
    {
        let features = self.closest_features(a, motion_a, b, motion_b)?;
        delay(&features, self.time, (motion_a, change_a), (motion_b, change_b))
    }
}

impl<V: Vector> RayHit<V> {
    /// The feature of the target that the ray hits, and its point for the other; `None` where the source is in the
    /// target.
    #[must_use]
    pub fn closest_features<S>(&self, target: &S, ray: Ray<V>) -> Option<ClosestFeatures<V>>
    where
        S: SupportMap<Vector = V> + ?Sized,
    {
        let tip = Point::new(ray.source).ok()?;
        let motion = RigidMotion::translation(ray.direction);
        touching(self.normal?, self.point, self.lambda, (&tip, &motion), (&target, &RigidMotion::default()))
    }

    /// The hit with the normal of its [feature](Self::closest_features), which is known to rounding, and so its
    /// [gradient](Self::gradient).
    #[must_use]
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        Self { normal: Some(features.normal), ..self }
    }
}

compiled_once! {
    /// The features of two bodies that touch at a time.
    fn touching<V>(
        normal: V,
        point: V,
        time: V::Scalar,
        a: (Shape<'_, V>, &dyn Trajectory<Vector = V>),
        b: (Shape<'_, V>, &dyn Trajectory<Vector = V>),
    ) -> Option<ClosestFeatures<V>> {
        features_at(normal, point, time, a, b)
    }
}

fn features_at<V: Vector>(
    normal: V,
    point: V,
    time: V::Scalar,
    (a, motion_a): (Shape<'_, V>, &dyn Trajectory<Vector = V>),
    (b, motion_b): (Shape<'_, V>, &dyn Trajectory<Vector = V>),
) -> Option<ClosestFeatures<V>> {
    let closing = normal.dot(motion_b.velocity(time, point) - motion_a.velocity(time, point));
    let (a, b) = (at_time(a, motion_a, time), at_time(b, motion_b, time));
    let zero = V::Scalar::ZERO;
    // They are as far apart as the target distance of the cast, which the hit does not know, or not at all.
    let (core_a, core_b) = (a.core(), b.core());
    let size = core_a.extent + core_a.radius + core_b.extent + core_b.radius;
    let gap = normal.dot(a.support(-normal) - b.support(normal));
    // What is not on purpose is what the time or the normal are wrong by.
    let [apart, error] = if gap > little(size) { [gap, zero] } else { [zero, gap.abs()] };
    let points = [point + normal * apart, point];
    let closest = ClosestPoints { normal, points, signed_distance: apart, error, is_near: true };
    // At the start they were as far from contact as they have come nearer since.
    let is_at_floor = !(closing * time > size * rounding());
    Some(ClosestFeatures { is_at_floor, ..ClosestFeatures::new(&a, &b, closest) })
}

/// A body where it is at a time.
fn at_time<'s, V: Vector>(shape: Shape<'s, V>, motion: &dyn Trajectory<Vector = V>, time: V::Scalar) -> Moved<'s, V> {
    let displacement = motion.displacement(time);
    let core = shape.core();
    let core = Core { origin: displacement.of(core.origin), ..core };
    Moved::new(shape, core, Some(displacement.rotation()), Scalar::ZERO)
}

/// How much later two bodies touch whose start poses change. The change of a start pose is turned by the motion until
/// the contact.
fn delay<V, MA, MB>(
    features: &ClosestFeatures<V>,
    time: V::Scalar,
    (motion_a, change_a): (&MA, RigidMotion<V>),
    (motion_b, change_b): (&MB, RigidMotion<V>),
) -> Option<V::Scalar>
where
    V: Vector,
    MA: Trajectory<Vector = V> + ?Sized,
    MB: Trajectory<Vector = V> + ?Sized,
{
    let (carry_a, carry_b) = (carried(motion_a, time, change_a), carried(motion_b, time, change_b));
    features.delay(|p| carry_a(p) - carry_b(p), |p| motion_a.velocity(time, p) - motion_b.velocity(time, p))
}

/// The displacement, at a time, of the point that is at `p` then, as the start pose changes.
fn carried<V, M>(motion: &M, time: V::Scalar, change: RigidMotion<V>) -> impl Fn(V) -> V
where
    V: Vector,
    M: Trajectory<Vector = V> + ?Sized,
{
    let displacement = motion.displacement(time);
    move |p| {
        let rotation = displacement.rotation();
        let start = displacement.pivot + rotation.transpose_mul(p - displacement.pivot - displacement.shift);
        rotation * change.velocity(V::Scalar::ZERO, start)
    }
}
