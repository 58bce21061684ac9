//! The outlines of features in the plane of contact, and the part of a shape that each corner is on.

use core::cmp::Ordering;

use convex_support::numerics::twofold::dot_minus;
use convex_support::{Feature, Rim, Scalar, Vector};
use smallvec::SmallVec;

use crate::symmetric::{Across, cross, dot, scaled, way};

/// The corners that two features of 16 points may have in common. There is room for them without an allocation.
pub(crate) const ROOM: usize = 32;

/// The part of one shape that a point of contact is on: a corner of its feature, an edge, or the face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactPart {
    Vertex(u32),
    Edge(u32, u32),
    Face,
}

impl ContactPart {
    /// A number that is the same as long as the part is. The upper two bits give the kind.
    pub(crate) fn code(self) -> u32 {
        const PAYLOAD: u32 = u32::MAX >> 2;
        match self {
            Self::Vertex(id) => id & PAYLOAD,
            Self::Edge(a, b) => {
                // Multiplied by an odd number, so that edges of a few hundred vertices have different numbers.
                let ends = a.min(b).wrapping_mul(0x9e37_79b1).wrapping_add(a.max(b).wrapping_mul(0x0001_0001));
                ends & PAYLOAD | 1 << 30
            }
            Self::Face => 2 << 30,
        }
    }
}

/// A plane of contact: its unit normal, unit vectors across it, and a point of it. In 2D it is a line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactPlane<V: Vector> {
    pub(crate) normal: V,
    pub(crate) across: [V; 2],
    pub(crate) origin: V,
}

impl<V: Vector> ContactPlane<V> {
    /// The point at a place in the plane and a height above it.
    pub(crate) fn point(&self, (x, y): Across<V::Scalar>, height: V::Scalar) -> V {
        self.origin + self.across[0] * x + self.across[1] * y + self.normal * height
    }

    /// A point relative to the origin, as a corner.
    pub(crate) fn corner(&self, point: V, id: u32) -> Corner<V::Scalar> {
        let [e, f] = self.across;
        Corner { at: (e.dot(point), f.dot(point)), height: self.normal.dot(point), id }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Corner<S> {
    pub(crate) at: Across<S>,
    pub(crate) height: S,
    pub(crate) id: u32,
}

/// A convex polygon in the plane of contact, counterclockwise, a segment or a point, and the height of the feature
/// above it.
#[derive(Clone, Debug)]
pub(crate) struct Outline<S: Scalar> {
    pub(crate) corners: SmallVec<[Corner<S>; ROOM]>,
    /// The ellipse that the corners are on, where the feature is a disc.
    pub(crate) rim: Option<Ellipse<S>>,
    /// Whether the corners or the rim are all of the feature.
    pub(crate) is_complete: bool,
}

/// An ellipse in the plane: its centre and two conjugate radii.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ellipse<S> {
    pub(crate) center: Across<S>,
    pub(crate) radii: [Across<S>; 2],
}

impl<S: Scalar> Outline<S> {
    pub(crate) fn empty() -> Self {
        Self { corners: SmallVec::new(), rim: None, is_complete: true }
    }

    /// Becomes the outline of a feature. It is large, and better filled in place than moved.
    pub(crate) fn draw<V: Vector<Scalar = S>>(&mut self, feature: &Feature<V>, origin: V, plane: &ContactPlane<V>) {
        let from = origin - plane.origin;
        let [e, f] = plane.across;
        let seen = |(&point, &id): (&V, &u32)| plane.corner(from + point, id);
        self.corners.clear();
        (self.rim, self.is_complete) = (None, feature.is_complete());
        // A curved feature, or a vertex, needs no wrapping and no copy.
        if let ([point], [id]) = (feature.points(), feature.ids()) {
            self.corners.push(seen((point, id)));
            return;
        }
        let mut points: SmallVec<[_; 16]> = feature.points().iter().zip(feature.ids()).map(seen).collect();
        let across = |v: V| (e.dot(v), f.dot(v));
        let ellipse = |rim: Rim<V>| Ellipse {
            center: across(from + rim.center),
            radii: rim.ends.map(|end| across(end - rim.center)),
        };
        self.rim = feature.rim().map(ellipse);
        wrap(&mut points, S::ZERO, &mut self.corners);
    }

    /// The plane of the feature over the plane of contact, through the three corners that span most.
    pub(crate) fn tangent(&self) -> Tangent<S> {
        let corners = &self.corners;
        let spanned = |i: &usize| cross(way(corners[0].at, corners[*i].at), way(corners[0].at, corners[i + 1].at));
        let by_area = |i: &usize, k: &usize| spanned(i).partial_cmp(&spanned(k)).unwrap_or(Ordering::Equal);
        match (1..corners.len() - 1).max_by(by_area) {
            Some(i) => Tangent::through(&[corners[0], corners[i], corners[i + 1]]),
            None => Tangent::through(corners),
        }
    }
}

/// A plane over the plane of contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tangent<S> {
    pub(super) at: Across<S>,
    pub(super) level: S,
    /// How fast it rises.
    pub(crate) gradient: Across<S>,
}

impl<S: Scalar> Tangent<S> {
    /// Through three corners; through two, level across the line between them.
    pub(super) fn through(corners: &[Corner<S>]) -> Self {
        let first = corners[0];
        let edge = |i: usize| {
            let corner: Corner<S> = corners[i];
            (way(first.at, corner.at), corner.height - first.height)
        };
        let (p, rise) = edge(1);
        let gradient = if corners.len() == 2 {
            scaled(p, rise / dot(p, p))
        } else {
            let (q, other) = edge(2);
            let area = spanned(p, q);
            (spanned((rise, p.1), (other, q.1)) / area, spanned((p.0, rise), (q.0, other)) / area)
        };
        Self { at: first.at, level: first.height, gradient }
    }

    pub(super) fn level(&self, at: Across<S>) -> S {
        self.level + dot(self.gradient, way(self.at, at))
    }
}

/// The area between two vectors, in twice the precision if the products cancel. The points around a place on a curved
/// surface end as thin triangles, two corners near one another and the third far away. Rounded products of such an area
/// keep only the digits above the rounding of the long sides.
pub(super) fn spanned<S: Scalar>(a: Across<S>, b: Across<S>) -> S {
    let (p, q) = (a.0 * b.1, a.1 * b.0);
    let cancels = (p - q).abs() * S::from_f64(16.0) < p.abs() + q.abs();
    if cancels { dot_minus([(a.0, b.1), (-a.1, b.0)], S::ZERO) } else { p - q }
}

/// How long a vector is, to a factor of √2.
pub(super) fn spread<S: Scalar>((x, y): Across<S>) -> S {
    x.abs() + y.abs()
}

/// The convex hull of points in the plane, counterclockwise from the one that is least in `x`. Points within rounding
/// of an edge are not corners: points no wider than that make a segment, and no longer than that a single point.
/// Coordinates are off by the `noise`, which may exceed the whole hull: a needle far away.
///
/// After Andrew: the points are taken in their order along a long way through the hull, and those that turn inwards are
/// dropped, on the way there and on the way back.
pub(super) fn wrap<S: Scalar>(points: &mut [Corner<S>], noise: S, corners: &mut SmallVec<[Corner<S>; ROOM]>) {
    let edge = |a: &Corner<S>, b: &Corner<S>| way(a.at, b.at);
    let Some(&first) = points.first() else { return };
    let longer = |way: Across<S>, e: Across<S>| if dot(e, e) > dot(way, way) { e } else { way };
    let way = points.iter().map(|p| edge(&first, p)).fold((S::ZERO, S::ZERO), longer);
    let reach = spread(way);
    let noise = noise.max(reach * (S::EPSILON * S::from_f64(64.0)));
    if !(reach > noise) {
        corners.push(first);
        return;
    }
    let along = |p: &Corner<S>| dot(way, p.at);
    points.sort_unstable_by(|a, b| along(a).partial_cmp(&along(b)).unwrap_or(Ordering::Equal));
    let is_corner = |before: &Corner<S>, corner: &Corner<S>, next: &Corner<S>| {
        let base = edge(before, next);
        cross(edge(before, corner), base) > spread(base) * noise
    };
    let last = points.len() - 1;
    for is_back in [false, true] {
        let begin = corners.len();
        for i in 0..=last {
            let next = points[if is_back { last - i } else { i }];
            while let [.., before, corner] = &corners[begin..] {
                if is_corner(before, corner, &next) {
                    break;
                }
                corners.pop();
            }
            // The last point of one way begins the other.
            if i < last {
                corners.push(next);
            }
        }
    }
    if let [start, second, .., before] = &corners[..]
        && corners.len() > 2
        && !is_corner(before, start, second)
    {
        corners.remove(0);
    }
    let is_before = |a: &Corner<S>, b: &Corner<S>| a.at.0 < b.at.0 || (a.at.0 == b.at.0 && a.at.1 < b.at.1);
    let least = (1..corners.len()).fold(0, |least, i| if is_before(&corners[i], &corners[least]) { i } else { least });
    corners.rotate_left(least);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corners(points: &[Across<f64>], noise: f64) -> alloc::vec::Vec<Across<f64>> {
        let mut seen: SmallVec<[Corner<f64>; 16]> =
            points.iter().map(|&at| Corner { at, height: 0.0, id: 0 }).collect();
        let mut found = SmallVec::new();
        wrap(&mut seen, noise, &mut found);
        found.iter().map(|corner| corner.at).collect()
    }

    #[test]
    fn a_hull_goes_counterclockwise_and_has_no_points_of_its_edges() {
        let points = [(1.0, 1.0), (0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.25, 0.5), (0.0, 1.0), (1.0, 0.5), (0.0, 0.0)];
        assert_eq!(corners(&points, 0.0), [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
    }

    /// Points no wider than the noise make a segment, and no longer than it a point.
    #[test]
    fn what_is_narrower_than_the_noise_spans_nothing() {
        let points = [(0.0, 0.0), (1.0, 1e-9), (2.0, -1e-9), (3.0, 0.0)];
        assert_eq!(corners(&points, 1e-8), [(0.0, 0.0), (3.0, 0.0)]);
        assert_eq!(corners(&points, 4.0).len(), 1);
        assert_eq!(corners(&points, 0.0).len(), 4);
    }
}
