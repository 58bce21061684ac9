//! How far a point is from a body at most.
//!
//! Points of the body are found by its support map, and a convex combination of at most four of them that is near. The
//! search is in doubles, and proves nothing: what it finds is measured in intervals.

use crate::body::{Body, Set};
use crate::interval::{Interval, Vector};

/// After so many support points the best found so far counts.
const STEPS: usize = 200;

type Coordinates = [f64; 3];

/// By how much normals are turned, to find points of a curved surface around one.
const TURNS: [f64; 4] = [1e-8, 1e-6, 1e-4, 1e-2];

/// A point of the set from where the search looks, and the same in doubles.
#[derive(Clone)]
struct Found {
    point: Vector,
    place: Coordinates,
    weight: f64,
}

impl Body {
    /// A bound from above on the distance of a point from the body, the search for which ends where it is `enough`;
    /// `toward` is a direction in which the point may be seen from the body, such as an outward normal there.
    pub(crate) fn distance_from(&self, at: &Vector, toward: Option<&Vector>, enough: &Interval) -> Interval {
        let reach = (&self.radius + enough).to_f64();
        let mean = nearest(&self.core, at, toward, reach);
        (&mean.length() - &self.radius).max(&Interval::zero()).greatest()
    }
}

/// A point of the set near to `at`, relative to it: the nearest, or one within `enough`.
fn nearest(set: &Set, at: &Vector, toward: Option<&Vector>, enough: f64) -> Vector {
    let find = |direction: Coordinates| {
        let point = set.support(&Vector(direction.map(Interval::from))).0.minus(at);
        let place = point.0.each_ref().map(Interval::middle);
        Found { point, place, weight: 0.0 }
    };
    let toward = toward.map(|toward| toward.0.each_ref().map(Interval::middle));
    // The points, the nearest of their combinations to `at`, which is zero here, and the square of its length.
    let mut best = (vec![find(toward.unwrap_or([1.0, 0.0, 0.0]))], [0.0; 3], f64::INFINITY);
    (best.1, best.2) = (best.0[0].place, dot(best.0[0].place, best.0[0].place));
    best.0[0].weight = 1.0;
    let is_enough = |squared: f64| squared.sqrt() <= 0.5 * enough;
    // Of a curved surface, points around the normal.
    for turn in TURNS {
        let Some(normal) = toward.filter(|_| !is_enough(best.2)) else { break };
        let points = around(normal, turn).into_iter().chain([normal]).map(find).collect();
        best = better(best, points);
    }
    for _ in 0..STEPS {
        if is_enough(best.2) {
            break;
        }
        let before = best.2;
        let mut points: Vec<Found> = best.0.clone();
        points.push(find(best.1.map(|x| -x)));
        best = better(best, points);
        // Rounding alone decides where a step gains no more than this.
        if best.2 >= before * (1.0 - 1e-12) {
            break;
        }
    }
    let simplex = best.0;
    let weights = simplex.iter().map(|found| Interval::from(found.weight));
    let total = weights.clone().fold(Interval::zero(), |sum, weight| &sum + &weight);
    let sum = simplex.iter().zip(weights).fold(Vector::zero(), |sum, (found, w)| sum.plus(&found.point.times(&w)));
    Vector(sum.0.map(|x| x.over(&total)))
}

/// What is nearer: the best so far, or the nearest combination of some points.
fn better(best: (Vec<Found>, Coordinates, f64), mut points: Vec<Found>) -> (Vec<Found>, Coordinates, f64) {
    match combination(&points) {
        Some((place, weights)) if dot(place, place) < best.2 => {
            for (found, weight) in points.iter_mut().zip(weights) {
                found.weight = weight;
            }
            points.retain(|found| found.weight > 0.0);
            (points, place, dot(place, place))
        }
        _ => best,
    }
}

/// Three directions that are turned away from a normal by an angle; in the plane two of them are the same way.
fn around(normal: Coordinates, turn: f64) -> [Coordinates; 3] {
    let least = (0..3).min_by(|&i, &j| normal[i].abs().total_cmp(&normal[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[if normal[2] == 0.0 { 2 } else { least }] = 1.0;
    let across = cross(normal, axis);
    let other = cross(normal, across);
    [(1.0, 0.0), (-0.5, 0.875), (-0.5, -0.875)]
        .map(|(x, y): (f64, f64)| std::array::from_fn(|i| normal[i] + turn * (x * across[i] + y * other[i])))
}

fn cross([a, b, c]: Coordinates, [x, y, z]: Coordinates) -> Coordinates {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// The shortest convex combination of up to five points, of at most four of them, and the weights.
fn combination(simplex: &[Found]) -> Option<(Coordinates, [f64; 5])> {
    let mut best: Option<(f64, Coordinates, [f64; 5])> = None;
    for chosen in 1..1_usize << simplex.len() {
        let indices: Vec<usize> = (0..simplex.len()).filter(|i| chosen >> i & 1 == 1).collect();
        let Some((weights, rest)) = affine(&indices.iter().map(|&i| simplex[i].place).collect::<Vec<_>>()) else {
            continue;
        };
        if weights.iter().any(|weight| weight.is_nan() || *weight < 0.0) {
            continue;
        }
        let squared = dot(rest, rest);
        if best.is_none_or(|(least, ..)| squared < least) {
            let mut all = [0.0; 5];
            for (&i, weight) in indices.iter().zip(weights) {
                all[i] = weight;
            }
            best = Some((squared, rest, all));
        }
    }
    best.map(|(_, rest, weights)| (rest, weights))
}

/// The point nearest to zero in the affine hull of up to four points, and their weights, by orthogonal edges; none
/// where the points are more than the dimension of their hull.
fn affine(points: &[Coordinates]) -> Option<(Vec<f64>, Coordinates)> {
    let (first, others) = points.split_first()?;
    if others.len() > 3 {
        return None;
    }
    let difference = |a: Coordinates, b: Coordinates| -> Coordinates { std::array::from_fn(|i| a[i] - b[i]) };
    // Edge j is `basis[j] + Σ factors[j][i]·basis[i]` over the `i` before `j`.
    let (mut basis, mut factors) = (Vec::<Coordinates>::new(), Vec::<Vec<f64>>::new());
    for point in others {
        let edge = difference(*point, *first);
        let (mut rest, mut of_edge) = (edge, vec![0.0; basis.len()]);
        // Twice, for the digits that are lost where edges are nearly parallel.
        for _ in 0..2 {
            for (across, factor) in basis.iter().zip(&mut of_edge) {
                let part = dot(rest, *across) / dot(*across, *across);
                rest = std::array::from_fn(|i| rest[i] - part * across[i]);
                *factor += part;
            }
        }
        if dot(rest, rest) <= 1e-30 * dot(edge, edge) {
            return None;
        }
        basis.push(rest);
        factors.push(of_edge);
    }
    // Twice, so that what is left is across the edges to its own last digit, however small it is.
    let (mut rest, mut along) = (*first, vec![0.0; basis.len()]);
    for _ in 0..2 {
        for (across, along) in basis.iter().zip(&mut along) {
            let part = -dot(rest, *across) / dot(*across, *across);
            rest = std::array::from_fn(|i| rest[i] + part * across[i]);
            *along += part;
        }
    }
    for j in (0..along.len()).rev() {
        for i in 0..j {
            along[i] -= factors[j][i] * along[j];
        }
    }
    let mut weights = vec![1.0 - along.iter().sum::<f64>()];
    weights.extend(along);
    Some((weights, rest))
}

fn dot(a: Coordinates, b: Coordinates) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}
