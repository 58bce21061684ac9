//! The closest features of answers.

use convex_support::{Core, Point, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use super::ClosestFeatures;
use super::closest_features::{ClosestPoints, rounding};
use crate::motion::Moved;
use crate::pair::Shape;
use crate::{
    Distance, GrowthDistance, Impact, Ray, RayHit, RigidMotion, SignedDistance, SignedDistanceOptions, Trajectory,
    signed_distance,
};

/// How far overlapping bodies are pushed into one another to test for another direction out, as a part of their size,
/// in units of the square root of ε. If bodies are farther apart than this at a hit, the cast had a target distance.
const PUSH: f64 = 64.0;

/// How much a push may gain: at most this multiple of its square, in units of the size, and at most this part of the
/// size, which leaves room for single precision.
const GAIN: [f64; 2] = [256.0, 1e-4];

/// If the cosine of the angle between two normals is at least this, they are the same direction out.
const SAME_NORMAL: f64 = 1.0 - 1e-6;

fn little<S: Scalar>(size: S) -> S {
    size * S::EPSILON.sqrt() * S::from_f64(PUSH)
}

impl<V: Vector> Distance<V> {
    /// The closest features, given the shapes of the query; `None` if they overlap.
    #[must_use]
    pub fn closest_features(
        &self,
        a: &dyn SupportMap<Vector = V>,
        b: &dyn SupportMap<Vector = V>,
    ) -> Option<ClosestFeatures<V>> {
        let error = self.upper - self.lower;
        let (points, signed_distance) = ([self.point_a, self.point_b], self.distance);
        let closest = ClosestPoints { normal: self.normal?, points, signed_distance, error, is_near: false };
        // NaN is not above it.
        let is_at_floor = !(self.lower > Scalar::ZERO);
        Some(ClosestFeatures { is_at_floor, ..features_at(a, b, closest) })
    }

    /// The answer with the normal and the points of its [features](Self::closest_features), which are accurate to
    /// rounding.
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        let [point_a, point_b] = features.points;
        Self { normal: Some(features.normal), point_a, point_b, ..self }
    }
}

impl<V: Vector> SignedDistance<V> {
    /// The closest or deepest features, given the shapes of the query.
    ///
    /// If the cores of the shapes overlap, another [`signed_distance`] tells whether there is another way out that is
    /// as short: it is that of `a` pushed on by a millionth of the size, against the normal, which makes any other way
    /// the shorter one.
    pub fn closest_features(
        &self,
        a: &dyn SupportMap<Vector = V>,
        b: &dyn SupportMap<Vector = V>,
    ) -> ClosestFeatures<V> {
        let &Self { normal, signed_distance, point_a, point_b, lower, upper, .. } = self;
        let closest =
            ClosestPoints { normal, points: [point_a, point_b], signed_distance, error: upper - lower, is_near: false };
        let mut features = features_at(a, b, closest);
        let cores = [a.core(), b.core()];
        // By the lower bound, because cores that touch may seem to be a rounding apart.
        if lower + cores[0].radius + cores[1].radius <= Scalar::ZERO {
            features.is_tied = is_tied(self, cores, a, b);
        }
        features
    }

    /// The answer with the normal and the points of its [features](Self::closest_features), which are accurate to
    /// rounding.
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        let [point_a, point_b] = features.points;
        Self { normal: features.normal, point_a, point_b, ..self }
    }
}

compiled_once! {
    /// The features of two bodies at the normal and the points of an answer.
    fn features_at<V>(a: Shape<'_, V>, b: Shape<'_, V>, closest: ClosestPoints<V>) -> ClosestFeatures<V> {
        ClosestFeatures::new([a, b], closest)
    }
}

compiled_once! {
    /// Whether another normal is as good. If `a` is moved by `−η·n`, the signed distance along any normal `m` falls by
    /// `η·n·m`. So if another normal was as good to within `η·(1 − n·m)`, it is now the best, is found, and can be
    /// measured. Any normal that its bracket does not exclude may be a tie. If the bodies are curved, the other normal
    /// turns a little as they are pushed, which gains `η²` over twice the stiffness.
    fn is_tied<V>(answer: &SignedDistance<V>, cores: [Core<V>; 2], a: Shape<'_, V>, b: Shape<'_, V>) -> bool {
        let [core_a, core_b] = cores;
        let size = core_a.size() + core_b.size();
        let push = little(size);
        let pushed = Core { origin: core_a.origin - answer.normal * push, ..core_a };
        let moved = Moved::new(a, pushed, None, Scalar::ZERO);
        let least = V::Scalar::EPSILON * V::Scalar::from_f64(8.0);
        let other = signed_distance(&moved, b, SignedDistanceOptions::default().with_tolerance(least));
        let cosine = other.normal.dot(answer.normal);
        let along_other = other.upper + push * cosine;
        let [times, part] = GAIN.map(V::Scalar::from_f64);
        let gained = (push * (push / size) * times).min(size * part);
        let tolerance = V::Scalar::EPSILON * V::Scalar::from_f64(256.0) * size + gained;
        let is_other = cosine < V::Scalar::from_f64(SAME_NORMAL);
        is_other && along_other > answer.lower - tolerance
    }
}

impl<V: Vector> Impact<V> {
    /// The features that touch, given the bodies and motions of the cast; the motions of a
    /// [`linear_cast`](crate::linear_cast) are its [translations](crate::Motion::translations). `None` if they overlap
    /// at the start.
    #[must_use]
    pub fn closest_features(
        &self,
        a: &dyn SupportMap<Vector = V>,
        motion_a: &dyn Trajectory<Vector = V>,
        b: &dyn SupportMap<Vector = V>,
        motion_b: &dyn Trajectory<Vector = V>,
    ) -> Option<ClosestFeatures<V>> {
        touching(self.normal?, self.point, self.time, (a, motion_a), (b, motion_b))
    }

    /// The hit with the normal and the point of its [features](Self::closest_features), which are accurate to rounding,
    /// and so its [gradient](Self::gradient).
    #[must_use]
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        Self { normal: Some(features.normal), point: features.points[1], ..self }
    }

    /// The one-sided derivative of the time of contact by a motion of the start poses: how much later the bodies touch,
    /// per unit of time of that motion. It is exact also where parallel faces or edges touch. `None` if there is no
    /// [`gradient`](Self::gradient), or the normal is [not the only one](ClosestFeatures::is_normal_unique).
    #[must_use]
    pub fn rate(
        &self,
        (a, motion_a, change_a): (&dyn SupportMap<Vector = V>, &dyn Trajectory<Vector = V>, RigidMotion<V>),
        (b, motion_b, change_b): (&dyn SupportMap<Vector = V>, &dyn Trajectory<Vector = V>, RigidMotion<V>),
    ) -> Option<V::Scalar> {
        let features = self.closest_features(a, motion_a, b, motion_b)?;
        features.delay(self.time, [motion_a, motion_b], [change_a, change_b])
    }
}

impl<V: Vector> RayHit<V> {
    /// The feature of the target that the ray hits, with the ray's point as the other; `None` if the source is in the
    /// target.
    #[must_use]
    pub fn closest_features(&self, target: &dyn SupportMap<Vector = V>, ray: Ray<V>) -> Option<ClosestFeatures<V>> {
        let tip = Point::new(ray.source).ok()?;
        let motion = RigidMotion::translation(ray.direction);
        touching(self.normal?, self.point, self.lambda, (&tip, &motion), (target, &RigidMotion::default()))
    }

    /// The hit with the normal of its [feature](Self::closest_features), which is accurate to rounding, and so its
    /// [gradient](Self::gradient).
    #[must_use]
    pub fn refined(self, features: &ClosestFeatures<V>) -> Self {
        Self { normal: Some(features.normal), ..self }
    }
}

impl<V: Vector> GrowthDistance<V> {
    /// The features in which the shapes touch when both are grown by the scale, given the shapes and the centres of the
    /// query; `None` if there is no normal.
    ///
    /// They are those of the shapes as they are, with `b` moved along the way between the centres until they touch: the
    /// scale times as large, both lie as the grown shapes do. Their [smoothness](ClosestFeatures::smoothness) is that
    /// of the scale, and [`refined`](Self::refined) by them the answer has an accurate [gradient](Self::gradient).
    #[must_use]
    pub fn closest_features(
        &self,
        a: &dyn SupportMap<Vector = V>,
        b: &dyn SupportMap<Vector = V>,
        [center_a, center_b]: [V; 2],
    ) -> Option<ClosestFeatures<V>> {
        let one = V::Scalar::ONE;
        let moved = RigidMotion::translation((center_b - center_a) * (one / self.scale - one));
        let point = center_a + (self.point - center_a) / self.scale;
        let features = touching(self.normal?, point, one, (a, &RigidMotion::default()), (b, &moved))?;
        Some(ClosestFeatures { is_at_floor: false, ..features })
    }

    /// The answer with the normal and the point of its [features](Self::closest_features), which are accurate to
    /// rounding, given the centre of `a`.
    pub fn refined(self, features: &ClosestFeatures<V>, center_a: V) -> Self {
        let point = center_a + (features.points[1] - center_a) * self.scale;
        Self { normal: Some(features.normal), point, ..self }
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
        let closing = normal.dot(b.1.velocity(time, point) - a.1.velocity(time, point));
        let (a, b) = (at_time(a, time), at_time(b, time));
        let zero = V::Scalar::ZERO;
        // They are apart by the target distance of the cast, which the hit does not store, or touch.
        let size = a.core().size() + b.core().size();
        let gap = normal.dot(a.support(-normal) - b.support(normal));
        // A gap that was not asked for is the error of the time or of the normal.
        let [apart, error] = if gap > little(size) { [gap, zero] } else { [zero, gap.abs()] };
        let points = [point + normal * apart, point];
        let closest = ClosestPoints { normal, points, signed_distance: apart, error, is_near: true };
        // The bodies have come nearer by their distance at the start.
        let is_at_floor = !(closing * time > size * rounding());
        Some(ClosestFeatures { is_at_floor, ..ClosestFeatures::new([&a, &b], closest) })
    }
}

/// A body moved to a time of its motion.
fn at_time<'s, V: Vector>(
    (shape, motion): (Shape<'s, V>, &dyn Trajectory<Vector = V>),
    time: V::Scalar,
) -> Moved<'s, V> {
    let displacement = motion.displacement(time);
    let core = shape.core();
    let core = Core { origin: displacement.of(core.origin), ..core };
    Moved::new(shape, core, Some(displacement.rotation()), Scalar::ZERO)
}
