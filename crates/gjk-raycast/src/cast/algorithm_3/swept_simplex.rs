//! Where a line enters a simplex swept by a ball.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::cast::line::Line;
use crate::simplex::{AffineHull, Face, MAX_POINTS, faces, project_rarely};

/// The first point of a line in a simplex swept by a ball.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry<V: Vector> {
    pub(super) mu: V::Scalar,
    /// The unit outward normal of the swept simplex there.
    pub(super) n: V,
    pub(super) face: Face,
    /// The barycentric coordinates of the core's point below it, one for each corner of the face.
    pub(super) weights: [V::Scalar; MAX_POINTS],
}

/// The entry of the line into the hull of the points, swept by `radius`, through a face that has the last point for a
/// corner. `None` if there is none. A line that passes by within `noise` counts as meeting the simplex.
///
/// The boundary of the swept simplex is made of spheres about corners, cylinders about edges, and planes along the
/// facets, each at distance `radius`. Where the line enters one of them, and the core's point below lies within the
/// face, that is a point of the swept simplex; and the first such point is the entry. Without a radius only the
/// facets count, and if there are none, faces within `noise`.
pub(super) fn entry<V: Vector>(points: &[V], line: Line<V>, radius: V::Scalar, noise: V::Scalar) -> Option<Entry<V>> {
    let newest = points.len().checked_sub(1)?;
    let mut best: Option<Entry<V>> = None;
    for face in faces(points.len(), V::DIM).filter(|face| face.has(newest)) {
        let is_facet = face.len() == V::DIM;
        let mut corners = [V::ZERO; MAX_POINTS];
        let corners = face.of(points, &mut corners);
        // Of which there are two kinds, one in each dimension, so that no program has both.
        let len = if is_facet { V::DIM } else { corners.len() };
        let found = match (is_facet, len) {
            (true, 2) => enter_facet::<V, 1>(corners, line, radius, noise),
            (true, _) => enter_facet::<V, 2>(corners, line, radius, noise),
            (false, 1) => enter_edge(&AffineHull::<V, 0>::new(corners), line, radius, noise),
            (false, _) => enter_edge(&AffineHull::<V, 1>::new(corners), line, radius, noise),
        };
        let Some((mu, n, weights)) = found else { continue };
        let better = |b: Entry<V>| mu < b.mu || (is_facet && radius <= noise && b.face.len() < V::DIM);
        let worse = |b: Entry<V>| !is_facet && radius <= noise && b.face.len() == V::DIM;
        if best.is_none_or(|b| better(b) && !worse(b)) {
            best = Some(Entry { mu, n, face, weights });
        }
    }
    best
}

type FoundEntry<V> = Option<(<V as Vector>::Scalar, V, [<V as Vector>::Scalar; MAX_POINTS])>;

/// The line crosses the plane at distance `radius` from a facet, on the side it comes from.
///
/// The point of the facet below the crossing is found in the projection along the line, where the line is a point and
/// the facet a triangle: the barycentric coordinates are the same there, and the angle at which the line meets the
/// facet does not matter.
fn enter_facet<V: Vector, const EDGES: usize>(
    corners: &[V],
    line: Line<V>,
    radius: V::Scalar,
    noise: V::Scalar,
) -> FoundEntry<V> {
    let d = AffineHull::<V, EDGES>::new(corners).project(|_| line.direction).across;
    let slope = -d.length();
    // For a facet along the line d is nothing but rounding.
    if !(slope < V::Scalar::from_f64(-8.0) * V::Scalar::EPSILON) {
        return None;
    }
    let n = d / slope;
    let mut seen = [V::ZERO; MAX_POINTS];
    for (s, &corner) in seen.iter_mut().zip(corners) {
        *s = line.across(corner - line.foot);
    }
    let below = -line.across(n) * radius;
    // A facet whose projection is as narrow as rounding has only edges: neither its crossing nor its slope is known.
    let flat = AffineHull::<V, EDGES>::new(&seen);
    if !(flat.width() > noise) {
        return None;
    }
    let coordinates = flat.project(|corner| below - corner).coordinates;
    // Weights that are negative by rounding are zero: then the line passes a point of the facet itself, and not of its
    // plane, which rounding may have turned along the line. It passes within the noise, or elsewhere. The other weights
    // are computed again along their edge: in a sliver, the rounding of a weight moves the point by much more than
    // rounding.
    let (mut rest, mut places, mut len) = ([V::ZERO; MAX_POINTS], [0; MAX_POINTS], 0);
    for (i, &across) in seen[..corners.len()].iter().enumerate() {
        if coordinates[i] >= V::Scalar::ZERO {
            (rest[len], places[len]) = (across, i);
            len += 1;
        }
    }
    let mut weights = coordinates;
    if len < corners.len() {
        if len == 0 {
            return None;
        }
        let along = project_rarely(&rest[..len], &|corner| below - corner).coordinates;
        weights = [V::Scalar::ZERO; MAX_POINTS];
        for (&place, &weight) in places[..len].iter().zip(&along) {
            weights[place] = weight;
        }
    }
    let mut weights = weights.map(|b| b.max(V::Scalar::ZERO));
    let sum = weights.iter().fold(V::Scalar::ZERO, |sum, &b| sum + b);
    let (mut mu, mut passed) = (radius * slope, V::ZERO);
    for ((&corner, &across), weight) in corners.iter().zip(&seen).zip(&mut weights) {
        *weight /= sum;
        mu += corner.dot(line.direction) * *weight;
        passed += across * *weight;
    }
    ((passed - below).length() <= noise).then_some((mu, n, weights))
}

/// The line comes within `radius` of a corner, or in 3D of an edge.
///
/// In the projection along the flat, the line passes a point at the vector `m`, with velocity `d`. It is nearest at
/// `μ₀ = −m·d/d·d`, and at distance `radius` half a chord earlier.
fn enter_edge<V: Vector, const EDGES: usize>(
    flat: &AffineHull<V, EDGES>,
    line: Line<V>,
    radius: V::Scalar,
    noise: V::Scalar,
) -> FoundEntry<V> {
    // Beyond the end of an edge is the sphere about its corner, which is no other place if its radius is rounding.
    let (radius, slack) = if radius > noise { (radius, V::Scalar::ZERO) } else { (noise, noise) };
    let d = flat.project(|_| line.direction).across;
    let m = flat.project(|corner| line.foot - corner).across;
    let squared = d.length_squared();
    let nearest = -m.dot(d) / squared;
    let passing = flat.project(|_| m + d * nearest).across;
    let rest = radius * radius - passing.length_squared();
    if !(rest >= V::Scalar::ZERO) {
        return None;
    }
    let half = (rest / squared).sqrt();
    let (mu, n) = (nearest - half, (passing - d * half).unit()?);
    let below = flat.project(|corner| line.at(mu) - n * radius - corner);
    let length = flat.width();
    let within = below.coordinates.iter().all(|&b| b * length >= -slack);
    let weights = below.coordinates.map(|b| b.max(V::Scalar::ZERO).min(V::Scalar::ONE));
    (mu.is_finite() && within).then_some((mu, n, weights))
}
