//! From half-spaces to coordinates in which their intersection is round.

use crate::error::InscribedError;
use crate::inscribed::analytic_center::center;
use crate::inscribed::boundedness::{Opening, opening};
use crate::inscribed::chebyshev::{Depth, depth};
use crate::inscribed::coordinates::{Coordinates, Rows};
use crate::inscribed::polyhedron::Polyhedron;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, dot};
use crate::numerics::twofold;

/// How often coordinates are stretched before a body counts as empty. Each time a thin one becomes a million times
/// thicker in them, so that this covers the range of `f64`.
const MOST_STRETCHES: usize = 120;

/// How often the columns of the normals are made orthonormal: each time the remainder of a column is recomputed.
const MOST_CONDITIONINGS: usize = 4;

/// The rounding of a column that depends on the others, relative to it.
const DEPENDENT: f64 = 32.0 * f64::EPSILON;

/// Coordinates about the analytic centre of the intersection in which it contains the unit ball and lies in a ball of
/// radius m, and the half-spaces in them.
///
/// In coordinates in which the normals have Σaᵢaᵢᵀ = I (their condition is then gone) they are proved to span the space
/// positively. A linear program then finds an interior point. If it cannot tell the thickness of the body from
/// rounding, the coordinates are stretched to make *relaxed* half-spaces round, pᵢ·z ≤ sᵢ + τ with τ a little more than
/// that thickness, and the program is solved again. If that ends without a point inside, the origin is one if all
/// slacks there, which are exact to a rounding, are positive.
///
/// # Errors
/// [`InscribedError::Unbounded`], [`InscribedError::NearlyUnbounded`], [`InscribedError::EmptyInterior`],
/// [`InscribedError::NearlyEmpty`].
pub(crate) fn round_coordinates<D: Dimension>(
    dim: D,
    polyhedron: &Polyhedron,
) -> Result<(Coordinates, Rows), InscribedError> {
    let n = polyhedron.n;
    let (mut coordinates, mut rows) = conditioned(dim, polyhedron)?;
    // The first coordinates are independent of the size of the body.
    let mut reach = f64::INFINITY;
    let mut shortest = f64::INFINITY;
    let mut stuck = false;
    for stretches in 0..MOST_STRETCHES {
        let unit = unit_rows(dim, &rows, reach);
        if stretches == 0 {
            match opening(dim, &unit, &|z| is_open(polyhedron, &coordinates, z)) {
                Opening::None => {}
                Opening::Proved => return Err(InscribedError::Unbounded),
                Opening::Nearly { ratio } => return Err(InscribedError::NearlyUnbounded { ratio }),
            }
        }
        let (inside, relaxation) = match depth(&unit) {
            Depth::Inside(z) => (z, 0.0),
            Depth::Thin { .. } | Depth::Empty if stuck && is_interior(&rows) => (vec![0.0; n], 0.0),
            Depth::Thin { at, relaxation } if !stuck => (at, relaxation),
            Depth::Empty if is_interior(&rows) => (vec![0.0; n], 0.0),
            Depth::Empty => return Err(InscribedError::EmptyInterior),
            Depth::Thin { .. } => break,
        };
        let Some(centered) = center(dim, &unit, inside, relaxation) else { break };
        let before = coordinates.origin.clone();
        coordinates.shift(&centered.z);
        coordinates.stretch(dim, &centered.round);
        rows = coordinates.rows(dim, polyhedron);
        if relaxation == 0.0 && centered.near {
            // The centre was rounded to doubles.
            if !is_interior(&rows) {
                coordinates.settle(dim, polyhedron, &before);
                rows = coordinates.rows(dim, polyhedron);
            }
            if is_interior(&rows) {
                return Ok((coordinates, rows));
            }
            break;
        }
        // Axes that no longer shrink are at the rounding of their own directions.
        if relaxation > 0.0 && !(coordinates.lengths[n - 1] < 0.5 * shortest && resolved(&coordinates)) {
            stuck = true;
            coordinates.settle(dim, polyhedron, &before);
            rows = coordinates.rows(dim, polyhedron);
        }
        if reach < f64::INFINITY {
            shortest = coordinates.lengths[n - 1];
        }
        reach = polyhedron.len() as f64;
    }
    Err(polyhedron.without_interior(coordinates.aspect()))
}

/// Whether the origin is inside all half-spaces.
fn is_interior(rows: &Rows) -> bool {
    rows.s.iter().all(|s| *s > 0.0)
}

/// Coordinates in which the columns of the normals are nearly orthonormal, and the half-spaces in them.
///
/// If columns depend on one another to rounding, only rounding remains of one, in a direction that is right to a
/// rounding. The normals are then taken in coordinates stretched along it, in which their products with it are exact,
/// and once more made orthonormal.
fn conditioned<D: Dimension>(dim: D, polyhedron: &Polyhedron) -> Result<(Coordinates, Rows), InscribedError> {
    let n = polyhedron.n;
    let mut coordinates = Coordinates::identity(n);
    // Fewer half-spaces leave a direction open.
    if polyhedron.len() <= n {
        return Err(InscribedError::Unbounded);
    }
    // Only rounding remains of a column along this coordinate: the half-spaces are open along it, or nearly so.
    let nearly = |coordinates: &Coordinates, along: usize, ratio: f64| {
        let axis: Vec<f64> = (0..n).map(|k| if k == along { 1.0 } else { 0.0 }).collect();
        let proved = is_open(polyhedron, coordinates, &axis);
        if proved { InscribedError::Unbounded } else { InscribedError::NearlyUnbounded { ratio } }
    };
    let mut normals = polyhedron.normals.clone();
    let mut ratio = 0.0;
    for _ in 0..MOST_CONDITIONINGS {
        let map;
        (map, ratio) = orthonormal_columns(n, normals).map_err(|zero| nearly(&coordinates, zero, 0.0))?;
        coordinates.stretch(dim, &map);
        let rows = coordinates.rows(dim, polyhedron);
        if ratio > DEPENDENT {
            return Ok((coordinates, rows));
        }
        normals = rows.p;
    }
    // The longest axis is the first.
    Err(nearly(&coordinates, 0, ratio))
}

/// Whether the half-spaces are open along M·z, or a direction of integers next to it, exactly.
fn is_open(polyhedron: &Polyhedron, coordinates: &Coordinates, z: &[f64]) -> bool {
    let direction = coordinates.image(z);
    let largest = direction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let is_out =
        |d: &[f64]| polyhedron.rows().all(|(a, _)| twofold::is_at_most_zero(a.iter().copied().zip(d.iter().copied())));
    let whole =
        |parts: u32| -> Vec<f64> { direction.iter().map(|x| (x / largest * f64::from(parts)).round()).collect() };
    largest.is_normal() && (is_out(&direction) || (1..=MOST_PARTS).any(|parts| is_out(&whole(parts))))
}

/// The largest number in a direction of integers that is tried.
const MOST_PARTS: u32 = 64;

/// Whether the shortest axis is longer than the rounding of the origin to doubles along it.
fn resolved(coordinates: &Coordinates) -> bool {
    let n = coordinates.lengths.len();
    let (shortest, axis) = (coordinates.lengths[n - 1], &coordinates.axes[(n - 1) * n..]);
    let spacing: f64 = axis.iter().zip(&coordinates.origin).map(|(r, o)| (r * o).abs()).sum();
    shortest.is_normal() && shortest > 0.25 * UNIT_ROUNDOFF * spacing
}

/// The half-spaces with normals of unit length, so that all are measured alike, and none farther from the origin than
/// twice `reach`, the radius of a ball around it that contains the body.
fn unit_rows<D: Dimension>(dim: D, rows: &Rows, reach: f64) -> Rows {
    let mut unit = rows.clone();
    for (p, s) in unit.p.chunks_exact_mut(dim.get()).zip(&mut unit.s) {
        let length = dot(p, p).sqrt();
        p.iter_mut().for_each(|x| *x /= length);
        *s = (*s / length).min(2.0 * reach);
    }
    unit
}

/// The map M, stored by rows, that makes the columns of A·M orthonormal, A the rows `a` of n numbers, and the least
/// share of a column that remained beside the others; or the index of a column that is zero.
fn orthonormal_columns(n: usize, mut a: Vec<f64>) -> Result<(Vec<f64>, f64), usize> {
    let a = &mut a[..];
    let mut map: Vec<f64> = (0..n * n).map(|at| if at % (n + 1) == 0 { 1.0 } else { 0.0 }).collect();
    let map = &mut map[..];
    // Columns of very different size come from coordinates in different units, not from dependence.
    for k in 0..n {
        let size = a.chunks_exact(n).map(|row| row[k].abs()).fold(0.0, f64::max);
        if size == 0.0 {
            return Err(k);
        }
        a.chunks_exact_mut(n).for_each(|row| row[k] /= size);
        map[k * n + k] /= size;
    }
    let column = |a: &[f64], j: usize, k: usize| a.chunks_exact(n).map(|row| row[j] * row[k]).sum::<f64>();
    let original: Vec<f64> = (0..n).map(|k| column(a, k, k).sqrt()).collect();
    let mut done: Vec<usize> = Vec::with_capacity(n);
    let mut least = f64::INFINITY;
    for _ in 0..n {
        let lengths: Vec<f64> = (0..n).map(|k| column(a, k, k).sqrt()).collect();
        let left = (0..n).filter(|k| !done.contains(k));
        let pivot =
            left.fold(usize::MAX, |best, k| if best == usize::MAX || lengths[k] > lengths[best] { k } else { best });
        least = least.min(lengths[pivot] / original[pivot]);
        for pass in 0..2 {
            let subtract = |a: &mut [f64], map: &mut [f64], from: usize, factor: f64, of: usize| {
                a.chunks_exact_mut(n).chain(map.chunks_exact_mut(n)).for_each(|row| row[from] -= factor * row[of]);
            };
            // A second time against rounding.
            for &k in &done {
                let along = column(a, pivot, k);
                subtract(a, map, pivot, along, k);
            }
            let length = column(a, pivot, pivot).sqrt().max(f64::EPSILON * f64::EPSILON * original[pivot]);
            a.chunks_exact_mut(n).chain(map.chunks_exact_mut(n)).for_each(|row| row[pivot] /= length);
            if pass == 1 {
                for k in (0..n).filter(|k| !done.contains(k) && *k != pivot) {
                    let along = column(a, k, pivot);
                    subtract(a, map, k, along, pivot);
                }
            }
        }
        done.push(pivot);
    }
    Ok((map.to_vec(), least))
}
