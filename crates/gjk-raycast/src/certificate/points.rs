//! Points of a core whose weighted mean is a given point, each identified by the direction along which it is farthest.
//!
//! The given point is on the core, with a known normal. The normal itself does not identify a point if all of a face is
//! farthest along it. So the search takes directions that are turned from it a little, towards each corner of the face.
//! How far they have to be turned depends on the surface, and is found by trial.

use alloc::vec::Vec;

use convex_support::glam::DVec3;
use convex_support::numerics::elementary::sin_cos;
use convex_support::{Scalar, Vector};

use crate::simplex::{MAX_POINTS, nearest_face};
use crate::unit::power_of_two_near;

/// A point of a core, given by the direction in which it is farthest, and its weight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct WeightedSupport<V> {
    /// The point is the farthest of the core along this direction, which may have any length. The direction has few
    /// decimals, and is not along the normal of a face, so that it identifies one corner in any precision.
    pub direction: V,
    /// Its weight, in double precision, as it is computed from the numbers of the shape.
    pub weight: f64,
}

/// The vector in double precision, in space.
pub(super) fn wide<V: Vector>(v: V) -> DVec3 {
    DVec3::new(v.get(0).as_f64(), v.get(1).as_f64(), if V::DIM == 3 { v.get(2).as_f64() } else { 0.0 })
}

/// The support map of a core, relative to the given point.
pub(super) type Support<'s, V> = dyn FnMut(V) -> DVec3 + 's;

/// The given point, which is zero here.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    pub(super) radius: f64,
    /// A bound on all lengths.
    pub(super) size: f64,
    /// The outward normal there, of any length; `None` if the point is inside the core.
    pub(super) normal: Option<DVec3>,
    /// The direction of the ray through it.
    pub(super) along: Option<DVec3>,
}

/// A support point, and the direction it was found along.
#[derive(Clone, Copy)]
struct FoundPoint<V> {
    direction: V,
    point: DVec3,
}

/// The angles by which directions are turned away from a normal, from large to small. A flat face shows one corner at a
/// time only if the angle is larger than rounding. On a curved surface the points found leave it by half the square of
/// the angle. A polytope of many nearly parallel faces shows only the face of the normal if the angle is smaller than
/// those between its faces.
fn turns<S: Scalar>() -> impl Iterator<Item = f64> {
    let mut turn = 8.0;
    core::iter::from_fn(move || {
        turn /= 64.0;
        (turn > 32.0 * S::EPSILON.as_f64()).then_some(turn)
    })
}

/// Points of the core whose weighted mean is as near to zero as it can be.
pub(super) fn points<V: Vector>(support: &mut Support<'_, V>, seen: &Seen) -> Vec<WeightedSupport<V>> {
    // In a unit of the size, so that squares are in range.
    let scale = power_of_two_near(seen.size);
    let seen = Seen { radius: seen.radius / scale, size: seen.size / scale, ..*seen };
    let rounding = V::Scalar::EPSILON.as_f64() * seen.size;
    let normal = seen.normal.and_then(DVec3::try_normalize);
    let mut best = Best { length: f64::INFINITY, left: f64::INFINITY, simplex: WeightedPoints::default() };
    for turn in turns::<V::Scalar>() {
        // Where a surface is curved, the mean of the directions found is a better normal than rounding may have left.
        let better = best.simplex.mean_direction().and_then(DVec3::try_normalize);
        for (is_again, around) in [(false, normal), (true, better)] {
            let mut search =
                PointSearch::<V> { support, scale, turn, decimals: decimals(turn), simplex: WeightedPoints::default() };
            let left = match (is_again, around, normal) {
                (_, Some(around), Some(normal)) => search.around(around, normal, &seen),
                (false, None, None) => search.within(seen.radius),
                _ => continue,
            };
            let simplex = search.simplex;
            let length = simplex.mean().length();
            // A smaller angle has to gain more than rounding, since larger ones identify points more reliably.
            if left <= 0.0 || length < best.length - rounding || best.simplex.found.is_empty() {
                best = Best { length, left, simplex };
            }
        }
        if best.left <= rounding {
            break;
        }
    }
    let is_outside = best.left > 0.0 && normal.is_none() && seen.along.is_some();
    if let Some(outward) = best.simplex.mean_direction().filter(|_| is_outside) {
        // The ray begins on the boundary, to rounding, and not inside; the mean of the directions found is about the
        // normal there.
        let (radius, size) = (seen.radius * scale, seen.size * scale);
        return points(support, &Seen { radius, size, normal: Some(outward), ..seen });
    }
    best.simplex.weighted().collect()
}

/// The best points so far, the distance of their mean from zero, and how much of it a better choice could gain.
struct Best<V> {
    length: f64,
    left: f64,
    simplex: WeightedPoints<V>,
}

/// The power of ten that leaves two decimals of a turn.
fn decimals(turn: f64) -> f64 {
    let mut decimals = 100.0;
    while decimals * turn < 50.0 && decimals < 1e15 {
        decimals *= 10.0;
    }
    decimals
}

struct WeightedPoints<V> {
    found: Vec<FoundPoint<V>>,
    weights: [f64; MAX_POINTS],
}

impl<V> Default for WeightedPoints<V> {
    fn default() -> Self {
        Self { found: Vec::new(), weights: [0.0; MAX_POINTS] }
    }
}

impl<V: Vector> WeightedPoints<V> {
    fn mean(&self) -> DVec3 {
        self.found.iter().zip(self.weights).map(|(f, weight)| f.point * weight).sum()
    }

    fn mean_direction(&self) -> Option<DVec3> {
        let sum = |sum: Option<DVec3>, (f, weight): (&FoundPoint<V>, f64)| {
            Some(sum.unwrap_or(DVec3::ZERO) + wide(f.direction) * weight)
        };
        self.found.iter().zip(self.weights).fold(None, sum)
    }

    fn weighted(self) -> impl Iterator<Item = WeightedSupport<V>> {
        self.found.into_iter().zip(self.weights).map(|(f, weight)| WeightedSupport { direction: f.direction, weight })
    }

    /// Keeps the face closest to zero, with its weights, after the projection `seen` into so many dimensions. Returns
    /// the projected vector to its closest point.
    fn reduce(&mut self, dimension: usize, seen: impl Fn(DVec3) -> DVec3) -> Option<DVec3> {
        let points: Vec<DVec3> = self.found.iter().map(|f| seen(f.point)).collect();
        let closest = nearest_face(&points, dimension)?;
        let mut index = 0;
        self.found.retain(|_| {
            index += 1;
            closest.face.has(index - 1)
        });
        self.weights = closest.weights;
        self.weights[self.found.len()..].fill(0.0);
        Some(closest.v)
    }
}

/// How much care is taken of the direction of a support point.
#[derive(Clone, Copy, PartialEq)]
enum Care {
    Little,
    Much,
    MuchBackwards,
}

impl Care {
    /// The care to take after a step that came nearer, or did not; `None` if there is no greater care.
    fn after(self, is_nearer: bool) -> Option<Self> {
        match self {
            _ if is_nearer => Some(Self::Little),
            Self::Little => Some(Self::Much),
            Self::Much => Some(Self::MuchBackwards),
            Self::MuchBackwards => None,
        }
    }
}

/// A search along directions that are turned by a small angle and have few decimals.
struct PointSearch<'a, 's, V> {
    support: &'a mut Support<'s, V>,
    scale: f64,
    turn: f64,
    decimals: f64,
    simplex: WeightedPoints<V>,
}

/// No search takes more steps: those of a polytope end by themselves, and a curved core is near enough by then.
const MOST_STEPS: usize = 64;

impl<V: Vector> PointSearch<'_, '_, V> {
    /// The support point along a direction. With little care the direction is turned a little further, so that it is
    /// not by accident the normal of a face, and rounded to few decimals, none of them zero. With much care, for thin
    /// bodies, it is hardly turned, one way or the other.
    fn look(&mut self, direction: DVec3, care: Care) -> FoundPoint<V> {
        let aside = if V::DIM == 3 { DVec3::new(0.62, -0.37, 0.69) } else { DVec3::new(0.62, -0.78, 0.0) };
        let turned = |by: f64| direction + aside * (self.turn * by);
        let hardly = (256.0 * V::Scalar::EPSILON.as_f64() / self.turn).max(1.5e-8);
        let wanted = match care {
            Care::Little => {
                let scaled = turned(1.0 / 16.0) * self.decimals;
                let nearest = scaled.round();
                let least = DVec3::splat(0.5).copysign(scaled);
                DVec3::select(nearest.cmpeq(DVec3::ZERO), least, nearest) / self.decimals
            }
            Care::Much => turned(hardly),
            Care::MuchBackwards => turned(-hardly),
        };
        let direction = V::from_fn(|i| V::Scalar::from_f64(wanted[i]));
        FoundPoint { direction, point: (self.support)(direction) / self.scale }
    }

    /// Searches for points around zero along directions near the unit vector `around`. It runs GJK on the projection of
    /// the core along the ray, or along the normal if there is no ray or a radius has to be bridged. Returns how far
    /// the mean of the points found is from zero in this projection, and behind the plane of the normal.
    fn around(&mut self, around: DVec3, normal: DVec3, seen: &Seen) -> f64 {
        let ray = seen.along.filter(|_| seen.radius == 0.0).and_then(DVec3::try_normalize);
        let axis = ray.unwrap_or(normal);
        // In the plane there is one direction across, in space a circle of them.
        let across = |v: DVec3| v - axis * axis.dot(v);
        let [u, w] = if V::DIM == 3 {
            let (u, w) = axis.any_orthonormal_pair();
            [u, w]
        } else {
            [DVec3::new(-axis.y, axis.x, 0.0), DVec3::ZERO]
        };
        let count = V::DIM;
        for k in 0..count {
            // Turned by an arbitrary angle, so that no direction is special by accident.
            let angle = 0.7 + core::f64::consts::TAU * k as f64 / count as f64;
            let (sine, cosine) = if V::DIM == 3 { sin_cos(angle) } else { (0.0, 1.0 - 2.0 * k as f64) };
            let found = self.look(around + (u * cosine + w * sine) * self.turn, Care::Little);
            self.simplex.found.push(found);
        }
        let mut left = f64::INFINITY;
        let mut care = Care::Little;
        for _ in 0..MOST_STEPS {
            let Some(v) = self.simplex.reduce(V::DIM - 1, across) else { return f64::INFINITY };
            let next = care.after(v.length() < left);
            left = left.min(v.length());
            let (Some(next), Some(toward)) = (next, (-v).try_normalize()) else { break };
            if self.simplex.found.len() == V::DIM {
                break;
            }
            care = next;
            let found = self.look(around + toward * self.turn, care);
            self.simplex.found.push(found);
        }
        if ray.is_some() {
            self.widen(normal, [u, w]);
        }
        let support = (self.support)(V::from_fn(|i| V::Scalar::from_f64(normal[i]))) / self.scale;
        left + normal.dot(support - self.simplex.mean()).max(0.0)
    }

    /// Adds points on the sides of a corner or an edge that the ray runs through, since the ray is certainly in the
    /// body only inside the simplex with these points. They have no weight.
    fn widen(&mut self, normal: DVec3, [u, w]: [DVec3; 2]) {
        let sides = match *self.simplex.found.as_slice() {
            [a, b] if V::DIM == 3 => {
                let edge = b.point - a.point;
                let edge = u * u.dot(edge) + w * w.dot(edge);
                let Some(side) = (w * u.dot(edge) - u * w.dot(edge)).try_normalize() else { return };
                alloc::vec![side, -side]
            }
            [_] if V::DIM == 3 => alloc::vec![u, w * 0.866 - u * 0.5, -w * 0.866 - u * 0.5],
            [_] => alloc::vec![u, -u],
            _ => return,
        };
        for side in sides {
            // Nearly across the normal, to find points far to the side of the corner.
            let found = self.look(normal + side * 4.0, Care::Little);
            self.simplex.found.push(found);
        }
    }

    /// Looks by GJK for a simplex that contains zero, or comes within the radius of it. Returns zero if there is one,
    /// and otherwise the distance of its mean from zero.
    fn within(&mut self, radius: f64) -> f64 {
        let (mut toward, mut care) = (DVec3::X, Care::Little);
        let mut least = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let found = self.look(toward, care);
            self.simplex.found.push(found);
            let Some(v) = self.simplex.reduce(V::DIM, |point| point) else { return f64::INFINITY };
            let length = v.length();
            if self.simplex.found.len() > V::DIM || length < 0.5 * radius {
                return 0.0;
            }
            let next = care.after(length < least);
            least = least.min(length);
            let (Some(next), Some(nearer)) = (next, (-v).try_normalize()) else { break };
            (toward, care) = (nearer, next);
        }
        least
    }
}
