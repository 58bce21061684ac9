//! Where a line is in a triangle, flat or swept by a ball: in a prism over it, or in the tubes around its edges.

use num_traits::Float as _;

use super::{CertainCrossing, Crossed, Crossing, NearLine, Spine, comfortable, rebased};
use crate::closest_point::closest_of_triangle;
use crate::shapes::planar_triangle::PlanarTriangle;
use crate::{Scalar, Vector};

/// The prism over the triangle, as thick as the ball, and the three edges swept by the ball: their union is convex, so
/// the line is inside from the first entry to the last exit. In 2D the triangle itself replaces the prism.
///
/// Without a ball, in 3D a line crosses the triangle at a point, where `entry` and `exit` agree. A triangle without
/// area, a segment, has no side for a line to cross: a miss.
pub(crate) fn triangle<V: Vector>(corners: [V; 3], radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
    let (direction, _, unit) = comfortable(direction);
    let mut union = if V::DIM == 2 {
        crossing_in_the_plane(corners, source, direction)
    } else {
        prism_crossing(corners, radius, V::Scalar::ZERO, source, direction)
    };
    if radius > V::Scalar::ZERO {
        let [a, b, c] = corners;
        for side in [[a, b], [b, c], [c, a]] {
            union = match (union, Spine::between(side).crossing(radius, source, direction).ok()) {
                (Some(p), Some(q)) => {
                    let first = if q.entry < p.entry { q } else { p };
                    Some(Crossing { exit: p.exit.max(q.exit), ..first })
                }
                (p, q) => p.or(q),
            };
        }
    }
    union.ok_or(V::ZERO)?.shifted(V::Scalar::ZERO, unit, || V::ZERO)
}

/// The crossing of a triangle in 2D: through the edges whose ends are on different sides of the line. A line also
/// meets a sliver across it, however thin.
fn crossing_in_the_plane<V: Vector>([a, b, c]: [V; 3], source: V, direction: V) -> Option<Crossing<V>> {
    let zero = V::Scalar::ZERO;
    let left = |v: V| V::from_fn(|i| if i == 0 { -v.get(1) } else { v.get(0) });
    let (base, source) = rebased(source - a, direction, direction.length_squared().recip());
    // For each corner, how far it is to the left of the line, and how far along it.
    let corners = [V::ZERO, b - a, c - a].map(|p| {
        let p = p - source;
        (left(direction).dot(p), direction.dot(p) / direction.length_squared(), p)
    });
    let mut crossing = Crossing { entry: V::Scalar::infinity(), exit: -V::Scalar::infinity(), normal: V::ZERO };
    for (i, j, k) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
        let ((side_i, along_i, p_i), (side_j, along_j, p_j)) = (corners[i], corners[j]);
        if side_i.max(side_j) < zero || side_i.min(side_j) > zero {
            continue;
        }
        let t = if side_i == side_j { zero } else { side_i / (side_i - side_j) };
        let at = along_i + (along_j - along_i) * t;
        if at <= crossing.entry {
            let n = left(p_j - p_i);
            let outward = if n.dot(corners[k].2 - p_i) > zero { -n } else { n };
            if at < crossing.entry || outward.dot(direction) < zero {
                crossing.normal = outward;
            }
            crossing.entry = at;
        }
        crossing.exit = crossing.exit.max(at);
    }
    crossing.normal = if crossing.normal.dot(direction) < zero { crossing.normal } else { -direction }.unit()?;
    crossing.shifted(base, V::Scalar::ONE, || V::ZERO).ok()
}

/// The crossing of the points within a distance `radius` of the triangle in 3D, across its plane; or of the
/// triangle itself, where the line crosses it even if its corners are moved by up to an `error`.
///
/// Projected along the line, no point of a side moves by more than the error `e`, so that the line still crosses
/// the triangle if its projection is more than `e` inside of all sides. With the cosine `s` at which it crosses the
/// plane, that holds if it crosses more than `e/s` inside of them. A point of the moved triangle is no farther than
/// `e` from the plane, which the line leaves behind by as much after `e/s`.
fn prism_crossing<V: Vector>(
    triangle: [V; 3],
    radius: V::Scalar,
    error: V::Scalar,
    source: V,
    direction: V,
) -> Option<Crossing<V>> {
    let PlanarTriangle { corners: [a, b, _], axes: [u, v], length, along, height } = PlanarTriangle::new(triangle)?;
    let (base, from_a) = rebased(source - a, direction, direction.length_squared().recip());
    let zero = V::Scalar::ZERO;
    let mut clip = Clip::default();
    // The normal is the part off the plane of the axis that is least within it.
    let off_plane = |x: V| x - u * u.dot(x) - v * v.dot(x);
    let lengths = V::from_fn(|i| off_plane(V::axis(i)).length_squared());
    let steepest = (1..V::DIM).fold(0, |best, i| if lengths.get(i) > lengths.get(best) { i } else { best });
    let normal = off_plane(off_plane(V::axis(steepest))).unit()?;
    clip.cut(normal, from_a, radius, direction);
    clip.cut(-normal, from_a, radius, direction);
    // How much later the line has certainly crossed the triangle, and how far inside of the edges that is.
    let late = if error > zero { error / normal.dot(direction).abs() } else { zero };
    let inside = -late * direction.length();
    // Outward of each edge, within the plane.
    clip.cut(-v, from_a, inside, direction);
    clip.cut((u * height + v * (length - along)).unit()?, from_a - (b - a), inside, direction);
    clip.cut((v * along - u * height).unit()?, from_a, inside, direction);
    // The sides of a sliver are parallel to rounding and do not bound its length; its longest edge does, being
    // normal to a supporting line at both of its ends.
    clip.cut(-u, from_a, inside, direction);
    clip.cut(u, from_a, length + inside, direction);
    clip.crossing?.shifted(base + late, V::Scalar::ONE, || V::ZERO).ok()
}

impl<V: Vector> NearLine<V> {
    /// A triangle about zero, in 3D.
    ///
    /// The line has not met it before the plane across its normal through the first corner, by two errors: a product
    /// with a point loses [less than one](Self::passes), also for the sides. It misses if it is beyond the plane along
    /// itself through a side.
    #[inline(never)]
    pub(crate) fn triangle(&self, corners: [V; 3]) -> Option<CertainCrossing<V>> {
        let Self { source, direction, error, .. } = *self;
        let error = error + error;
        if let Some(Crossing { entry: latest, normal, .. }) =
            prism_crossing(corners, V::Scalar::ZERO, error, source, direction)
        {
            let falls = normal.dot(direction);
            let earliest = (reach(corners, normal) + error - normal.dot(source)) / falls;
            let entry = latest + error / falls;
            return (earliest <= entry).then(|| self.enters([earliest, entry, latest], normal));
        }
        let PlanarTriangle { corners: [a, b, c], axes: [u, v], .. } = PlanarTriangle::new(corners)?;
        let across = |e: V| u * v.dot(e) - v * u.dot(e);
        [b - a, c - b, a - c].into_iter().find_map(|side| {
            // Out of the triangle within its plane, and so much across the plane that it is across the line.
            let out = across(side);
            let off = direction - u * u.dot(direction) - v * v.dot(direction);
            let axis = out - off * (out.dot(direction) / off.dot(direction));
            self.passes(axis, reach(corners, axis), V::Scalar::ZERO)
        })
    }

    /// A triangle about zero, swept by a ball.
    pub(crate) fn rounded_triangle(&self, corners: [V; 3], radius: V::Scalar) -> Option<CertainCrossing<V>> {
        let crossed = triangle(corners, radius, self.source, self.direction);
        // Rounding may exceed a small radius, so that the normal is not of unit length.
        let crossed = crossed.map(|at| Crossing { normal: at.normal.unit().unwrap_or(at.normal), ..at });
        let closest = |x| closest_of_triangle(corners, x);
        self.swept(radius, closest, |n| reach(corners, n), crossed, self.longest_slack())
    }
}

/// The support value of the corners along a vector: the largest product; that of the support point may be an ulp less.
fn reach<V: Vector>(corners: [V; 3], n: V) -> V::Scalar {
    corners.into_iter().map(|p| n.dot(p)).fold(-V::Scalar::infinity(), V::Scalar::max)
}

/// The part of a line within half-spaces.
struct Clip<V: Vector> {
    crossing: Option<Crossing<V>>,
}

impl<V: Vector> Default for Clip<V> {
    /// The whole line.
    fn default() -> Self {
        let infinity = V::Scalar::infinity();
        Self { crossing: Some(Crossing { entry: -infinity, exit: infinity, normal: V::ZERO }) }
    }
}

impl<V: Vector> Clip<V> {
    /// Keeps the part where `normal·x ≤ offset`.
    #[inline]
    fn cut(&mut self, normal: V, source: V, offset: V::Scalar, direction: V) {
        let Some(crossing) = &mut self.crossing else { return };
        let (room, speed) = (offset - normal.dot(source), normal.dot(direction));
        if speed < V::Scalar::ZERO {
            let enters = room / speed;
            if enters > crossing.entry {
                (crossing.entry, crossing.normal) = (enters, normal);
            }
        } else if speed > V::Scalar::ZERO {
            crossing.exit = crossing.exit.min(room / speed);
        } else if room < V::Scalar::ZERO || room.is_nan() {
            self.crossing = None;
        }
    }
}
