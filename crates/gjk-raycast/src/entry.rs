//! Where a line enters a simplex swept by a ball.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::closest::foot;
use crate::simplex::MAX_POINTS;

/// A line `foot + μ·direction`, with `direction` of unit length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line<V: Vector> {
    pub(crate) foot: V,
    pub(crate) direction: V,
}

impl<V: Vector> Line<V> {
    pub(crate) fn at(&self, mu: V::Scalar) -> V {
        self.foot + self.direction * mu
    }
}

/// The first point of a line in a simplex swept by a ball.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry<V: Vector> {
    /// Where on the line.
    pub(crate) mu: V::Scalar,
    /// The unit outward normal of the swept simplex there.
    pub(crate) n: V,
    /// The barycentric coordinates of the core's point below it.
    pub(crate) weights: [V::Scalar; MAX_POINTS],
}

/// The entry of the line into the hull of the points, swept by `radius`, through a face that has the last point for a
/// corner. `None` where there is none.
///
/// The boundary of the swept simplex is made of spheres about corners, cylinders about edges, and planes along the
/// facets, each at distance `radius`. Where the line enters one of them, and the core's point below lies within the
/// face, that is a point of the swept simplex; and the first such point is the entry.
pub(crate) fn entry<V: Vector>(points: &[V], line: Line<V>, radius: V::Scalar) -> Option<Entry<V>> {
    let last = points.len().checked_sub(1)?;
    let mut best: Option<Entry<V>> = None;
    for face in 1_u8 << last..1 << points.len() {
        let mut corners = [V::ZERO; MAX_POINTS];
        let mut count = 0;
        for (i, &point) in points.iter().enumerate() {
            if face >> i & 1 == 1 {
                corners[count] = point;
                count += 1;
            }
        }
        if count > V::DIM {
            continue;
        }
        let Some((mu, n, coordinates)) = face_entry(&corners[..count], line, radius) else { continue };
        if best.is_none_or(|b| mu < b.mu) {
            let mut weights = [V::Scalar::ZERO; MAX_POINTS];
            let mut next = 0;
            for (i, weight) in weights.iter_mut().enumerate().take(points.len()) {
                if face >> i & 1 == 1 {
                    *weight = coordinates[next];
                    next += 1;
                }
            }
            best = Some(Entry { mu, n, weights });
        }
    }
    best
}

/// Where the line comes within `radius` of the affine hull of the points, if the closest point is within the face.
fn face_entry<V: Vector>(
    points: &[V],
    line: Line<V>,
    radius: V::Scalar,
) -> Option<(V::Scalar, V, [V::Scalar; MAX_POINTS])> {
    let zero = V::Scalar::ZERO;
    let (&y, others) = points.split_last()?;
    let n = others.len();
    // Components across the face, by Gram–Schmidt: of the direction, and of the line's foot seen from y.
    let mut f = [V::ZERO; 2];
    for i in 0..n {
        let mut fi = others[i] - y;
        for _ in 0..2 {
            for fj in &f[..i] {
                fi -= *fj * (fi.dot(*fj) / fj.length_squared());
            }
        }
        f[i] = fi;
    }
    let across = |mut d: V| {
        for _ in 0..2 {
            for fi in &f[..n] {
                d -= *fi * (d.dot(*fi) / fi.length_squared());
            }
        }
        d
    };
    let d = across(line.direction);
    let squared = d.length_squared();
    let (mu, normal) = if points.len() == V::DIM {
        // A facet: its plane, moved out by the radius, on the side the line comes from.
        let normal = -(d.unit()?);
        let slope = normal.dot(line.direction);
        (((y - line.foot).dot(normal) + radius) / slope, normal)
    } else {
        if radius == zero {
            return None;
        }
        // The line is nearest to the face's affine hull at μ₀, at a distance h; it enters where the half chord begins.
        let m = across(line.foot - y);
        let nearest = -m.dot(d) / squared;
        let across_nearest = across(m + d * nearest);
        let rest = radius * radius - across_nearest.length_squared();
        if !(rest >= zero) {
            return None;
        }
        let half = (rest / squared).sqrt();
        (nearest - half, (across_nearest - d * half).unit()?)
    };
    if !mu.is_finite() {
        return None;
    }
    // The core's point below the entry, from which the barycentric coordinates are read.
    let below = line.at(mu) - normal * radius;
    let mut seen = [V::ZERO; MAX_POINTS];
    for (s, p) in seen.iter_mut().zip(points) {
        *s = *p - below;
    }
    let (_, weights) = foot(&seen[..points.len()])?;
    Some((mu, normal, weights))
}
