//! A look at two bodies nearly in contact, by what was closest at the last look.
//!
//! Near contact the same corners are mostly closest as a moment ago. Then a plane across them is known, and one support point proves that
//! it separates the bodies. Where they overlap, the closest points of their cores prove that if they are nearer than the radii; and
//! of cores that overlap themselves, a simplex of the corners and the point of the difference farthest from them has zero inside.

use convex_support::{Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float as _;

use super::corners::Face;
use super::instant::Instant;
use super::moving_pair::MovingPair;
use super::trajectory::Trajectory;
use crate::body::{Body as _, Pair, PointPair, TracedSupport as _};
use crate::gjk::rounding;
use crate::simplex::{MAX_POINTS, cross};
use crate::unit::is_moderate;

/// In how many ε of the smaller body its distance from the other is to be known for all errors to be those of lengths. Of bodies of very
/// different sizes, or that are far from what they turn about, coordinates may be known better.
const ALIKE: f64 = 256.0;

/// What corners may be off a plane by, in errors.
const IN_PLANE: f64 = 2.0;

/// The direction of closest points that are apart by this part of the size of both bodies is known to rounding.
const LONG: f64 = 1.0 / 16.0;

/// Points of the cores that are closest to one another, with the vector between them, and the unit vector across the plane between them.
struct Closest<V: Vector> {
    points: PointPair<V>,
    v: V,
    unit: V,
}

impl<A, MA, B, MB> MovingPair<'_, A, MA, B, MB>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
    MA: Trajectory<Vector = A::Vector>,
    MB: Trajectory<Vector = A::Vector>,
{
    /// The bodies at a time as well as it can be known, if what was closest at the last look is so still, and proves that they are apart
    /// or overlap.
    pub(super) fn near_look(&self, time: ScalarOf<A>, axis: A::Vector) -> Option<Instant<A::Vector>> {
        let placed = self.placed(time);
        let mut pair = Pair::new(&placed.a, &placed.b);
        let (size, radius) = (pair.size(placed.offset), pair.radius());
        let error = rounding(size) + pair.error();
        let [a, b] = [&self.a.core, &self.b.core].map(|core| core.extent + core.radius);
        let smaller = if a < b { a } else { b };
        if !(is_moderate(size) && error <= smaller * ScalarOf::<A>::EPSILON * Scalar::from_f64(ALIKE)) {
            return None;
        }
        let (closest, face) = match pair.closest_points(placed.offset, size) {
            Some(points) => (Closest::new(points, points.a - points.b + placed.offset, size)?, None),
            None => {
                let face = self.closest.get().closest_face(&placed)?;
                let closest = Closest::new(face.closest_points(), face.v, size);
                let closest = closest.or_else(|| Closest::in_plane(&face, axis))?;
                (closest, Some(face))
            }
        };
        let Closest { points, v, unit } = closest;
        // They have passed through one another.
        if unit.dot(axis) < Scalar::ZERO {
            return None;
        }
        self.count(1);
        let lower = unit.dot(pair.support(-unit).0 + placed.offset);
        // NaN is neither.
        if !(unit.dot(v) - lower <= error * Scalar::from_f64(IN_PLANE)) {
            return None;
        }
        let distance = lower - radius;
        let mut upper = v.length() - radius + error;
        if !(distance > error || upper < Scalar::ZERO) {
            self.count(1);
            let farthest = pair.support(unit).0 + placed.offset;
            upper = error - room_around_zero(&face?, farthest);
            if !(radius == Scalar::ZERO && upper < Scalar::ZERO) {
                return None;
            }
        }
        let point_a = placed.place + placed.offset + points.a - unit * self.a.core.radius;
        let point = placed.place + points.b + unit * self.b.core.radius;
        let closing = self.closing(time, unit, [point_a, point]);
        Some(Instant { time, normal: unit, gap: distance - error, distance, upper, error, closing, point, is_close: true })
    }
}

impl<V: Vector> Closest<V> {
    /// Points that are apart by `v`, for bodies of the given size; `None` where that is too short to have a direction.
    #[inline(always)]
    fn new(points: PointPair<V>, v: V, size: V::Scalar) -> Option<Self> {
        let length = v.length();
        (length > size * Scalar::from_f64(LONG)).then(|| Self { points, v, unit: v / length })
    }

    /// The closest points of a face that spans a plane.
    fn in_plane(face: &Face<V>, axis: V) -> Option<Self> {
        let (corners, len) = face.points();
        let (normal, _) = if len == V::DIM { normal(&corners) } else { return None };
        let unit = normal.unit()?;
        let unit = if unit.dot(axis) < V::Scalar::ZERO { -unit } else { unit };
        Some(Self { points: face.closest_points(), v: face.v, unit })
    }
}

/// The radius of a ball about zero that is within the simplex of a face's corners and one more point; not positive where there is none.
///
/// If all points are wrong by less, zero is still inside: else they would lie beyond a plane through zero, and before they were wrong
/// all of their simplex less than that before it.
fn room_around_zero<V: Vector>(face: &Face<V>, point: V) -> V::Scalar {
    let (zero, (mut points, len)) = (V::Scalar::ZERO, face.points());
    if len != V::DIM {
        return zero;
    }
    points[len] = point;
    let mut room = V::Scalar::infinity();
    for (i, &opposite) in points.iter().enumerate().take(len + 1) {
        let mut others = points;
        others.swap(i, len);
        let (normal, wrong) = normal(&others);
        let (level, side) = (normal.dot(others[0]), normal.dot(opposite - others[0]));
        let height = if side > zero { -level } else { level } - wrong * others[0].length();
        // Zero is no farther from the face than the corner opposite, of which this tells on which side it is.
        let most = side.abs() - wrong * (opposite - others[0]).length();
        let height = (if height < most { height } else { most }) / normal.length();
        if height.is_nan() {
            return zero;
        }
        room = if height < room { height } else { room };
    }
    room
}

/// A vector across the first points, as many as there are dimensions, and what that is wrong by, its product with another included relative to
/// the other's length.
///
/// In space, with `u = ε/2`, both edges are wrong by `u`, and a coordinate of their product is a difference of products: `4u·√3` of the
/// product of the lengths. The scalar product loses `3u`.
fn normal<V: Vector>(points: &[V; MAX_POINTS]) -> (V, V::Scalar) {
    let edge = points[1] - points[0];
    if V::DIM == 2 {
        let across = V::from_fn(|i| if i == 0 { edge.get(1) } else { -edge.get(0) });
        return (across, V::Scalar::EPSILON * V::Scalar::from_f64(2.0) * edge.length());
    }
    let other = points[2] - points[0];
    let lengths = edge.length() * other.length();
    (cross(edge, other), V::Scalar::EPSILON * V::Scalar::from_f64(5.5) * lengths)
}
