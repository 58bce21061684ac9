//! The way from half-spaces to coordinates in which their intersection is round.

use crate::error::InscribedError;
use crate::inscribed::analytic_center::center;
use crate::inscribed::boundedness::positively_spans;
use crate::inscribed::chebyshev::{Depth, depth};
use crate::inscribed::coordinates::{Coordinates, Rows};
use crate::inscribed::polyhedron::Polyhedron;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, dot};

/// How often coordinates are stretched before a body is called empty. Every time a thin one becomes a million times thicker
/// in them, so that this covers the range of `f64`.
const MOST_STRETCHES: usize = 120;

/// Coordinates about the analytic centre of the intersection in which it contains the unit ball and lies in a ball of
/// radius m, and the half-spaces in them.
///
/// In coordinates in which the normals have Σaᵢaᵢᵀ = I (their condition is then gone) they are seen to span the space
/// positively. A linear program then finds an interior point. Where it finds the body thin, that is, cannot tell its thickness
/// from rounding, the coordinates are stretched to make *relaxed* half-spaces round, pᵢ·z ≤ sᵢ + τ with τ a little more than
/// that thickness, and the program is solved again.
///
/// # Errors
/// [`InscribedError::Unbounded`], [`InscribedError::EmptyInterior`].
pub(crate) fn round_coordinates<D: Dimension>(
    dim: D,
    polyhedron: &Polyhedron,
) -> Result<(Coordinates, Rows), InscribedError> {
    let n = polyhedron.n;
    let mut coordinates = Coordinates::identity(n);
    coordinates.stretch(dim, &orthonormal_columns(n, polyhedron.normals.clone())?);
    let mut rows = coordinates.rows(dim, polyhedron);
    // The first coordinates know nothing of the size of the body.
    let mut reach = f64::INFINITY;
    let mut shortest = f64::INFINITY;
    for stretches in 0..MOST_STRETCHES {
        let unit = unit_rows(dim, &rows, reach);
        if stretches == 0 && !positively_spans(n, &unit.p) {
            return Err(InscribedError::Unbounded);
        }
        let (inside, relaxation) = match depth(&unit) {
            Depth::Inside(z) => (z, 0.0),
            Depth::Thin { at, relaxation } => (at, relaxation),
            Depth::Empty => return Err(InscribedError::EmptyInterior),
        };
        let centered = center(dim, &unit, inside, relaxation).ok_or(InscribedError::EmptyInterior)?;
        coordinates.shift(&centered.z);
        coordinates.stretch(dim, &centered.round);
        rows = coordinates.rows(dim, polyhedron);
        if relaxation == 0.0 && centered.near {
            // The centre was rounded to doubles.
            let interior = rows.s.iter().all(|s| *s > 0.0);
            return if interior { Ok((coordinates, rows)) } else { Err(InscribedError::EmptyInterior) };
        }
        // Axes that no longer shrink are at the rounding of their own directions.
        if relaxation > 0.0 && !(coordinates.lengths[n - 1] < 0.5 * shortest && resolved(&coordinates)) {
            return Err(InscribedError::EmptyInterior);
        }
        if reach < f64::INFINITY {
            shortest = coordinates.lengths[n - 1];
        }
        reach = polyhedron.len() as f64;
    }
    Err(InscribedError::EmptyInterior)
}

/// Whether the shortest axis is longer than what the origin loses along it by being rounded to doubles.
fn resolved(coordinates: &Coordinates) -> bool {
    let n = coordinates.lengths.len();
    let (shortest, axis) = (coordinates.lengths[n - 1], &coordinates.axes[(n - 1) * n..]);
    let spacing: f64 = axis.iter().zip(&coordinates.origin).map(|(r, o)| (r * o).abs()).sum();
    shortest.is_normal() && shortest > 0.25 * UNIT_ROUNDOFF * spacing
}

/// The half-spaces with normals of unit length, so that all are measured alike, and none further from the origin than twice
/// `reach`, the radius of a ball around it that holds the body.
fn unit_rows<D: Dimension>(dim: D, rows: &Rows, reach: f64) -> Rows {
    let mut unit = rows.clone();
    for (p, s) in unit.p.chunks_exact_mut(dim.get()).zip(&mut unit.s) {
        let length = dot(p, p).sqrt();
        p.iter_mut().for_each(|x| *x /= length);
        *s = (*s / length).min(2.0 * reach);
    }
    unit
}

/// The map M, stored by rows, that makes the columns of A·M orthonormal, A the rows `a` of n numbers.
fn orthonormal_columns(n: usize, mut a: Vec<f64>) -> Result<Vec<f64>, InscribedError> {
    let a = &mut a[..];
    let mut map: Vec<f64> = (0..n * n).map(|at| if at % (n + 1) == 0 { 1.0 } else { 0.0 }).collect();
    let map = &mut map[..];
    // Columns of wildly different size come from coordinates in different units: no sign of dependence.
    for k in 0..n {
        let size = a.chunks_exact(n).map(|row| row[k].abs()).fold(0.0, f64::max);
        if size == 0.0 {
            return Err(InscribedError::Unbounded);
        }
        a.chunks_exact_mut(n).for_each(|row| row[k] /= size);
        map[k * n + k] /= size;
    }
    let column = |a: &[f64], j: usize, k: usize| a.chunks_exact(n).map(|row| row[j] * row[k]).sum::<f64>();
    let original: Vec<f64> = (0..n).map(|k| column(a, k, k).sqrt()).collect();
    let mut done: Vec<usize> = Vec::with_capacity(n);
    for _ in 0..n {
        let lengths: Vec<f64> = (0..n).map(|k| column(a, k, k).sqrt()).collect();
        let pivot = (0..n)
            .filter(|k| !done.contains(k))
            .max_by(|&i, &j| lengths[i].total_cmp(&lengths[j]))
            .ok_or(InscribedError::Unbounded)?;
        // What rounding leaves of a column dependent on the others.
        if !(lengths[pivot] > 32.0 * f64::EPSILON * original[pivot]) {
            return Err(InscribedError::Unbounded);
        }
        for pass in 0..2 {
            let subtract = |a: &mut [f64], map: &mut [f64], from: usize, factor: f64, of: usize| {
                a.chunks_exact_mut(n).chain(map.chunks_exact_mut(n)).for_each(|row| row[from] -= factor * row[of]);
            };
            // A second time against rounding.
            for &k in &done {
                let along = column(a, pivot, k);
                subtract(a, map, pivot, along, k);
            }
            let length = column(a, pivot, pivot).sqrt();
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
    Ok(map.to_vec())
}
