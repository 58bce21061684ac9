//! The half-spaces as given, checked and scaled.

use crate::ellipsoid::{reach_at_most, support_value};
use crate::error::InscribedError;
use crate::inscribed::body::Body;
use crate::numerics::dimension::Dimension;
use crate::numerics::linalg::{UNIT_ROUNDOFF, power_of_two_inverse};
use crate::numerics::twofold;
use crate::shape::Shape;

/// Half-spaces aᵢ·x ≤ bᵢ, the largest coordinate of every aᵢ between one and two; rows of `n` numbers.
#[derive(Clone, Debug)]
pub(crate) struct Polyhedron {
    pub(crate) n: usize,
    pub(crate) normals: Vec<f64>,
    pub(crate) offsets: Vec<f64>,
}

impl Polyhedron {
    /// Checks half-spaces and scales them.
    pub(crate) fn new<'a>(
        n: usize,
        halfspaces: impl ExactSizeIterator<Item = (&'a [f64], f64)>,
    ) -> Result<Self, InscribedError> {
        if halfspaces.len() == 0 || n == 0 {
            return Err(InscribedError::Empty);
        }
        let mut normals = Vec::with_capacity(halfspaces.len() * n);
        let mut offsets = Vec::with_capacity(halfspaces.len());
        for (index, (normal, offset)) in halfspaces.enumerate() {
            for (coordinate, &value) in normal.iter().chain([&offset]).enumerate() {
                if !value.is_finite() {
                    return Err(InscribedError::NonFinite { index, coordinate, value });
                }
            }
            let size = normal.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            if size == 0.0 {
                return Err(InscribedError::ZeroNormal { index });
            }
            // A power of two changes no mantissa: statements about these rows hold for the given ones.
            let unit = power_of_two_inverse(size);
            normals.extend(normal.iter().map(|x| x * unit));
            offsets.push(offset * unit);
        }
        if offsets.iter().any(|b: &f64| !b.is_finite()) {
            return Err(InscribedError::OutOfRange);
        }
        Ok(Self { n, normals, offsets })
    }

    pub(crate) fn len(&self) -> usize {
        self.offsets.len()
    }

    /// The reason why there is no ellipsoid, if the search for an interior ended at this ratio of the shortest to the
    /// longest axis: empty or flat if two half-spaces prove it by themselves, otherwise too thin.
    pub(crate) fn without_interior(&self, ratio: f64) -> InscribedError {
        let pairs = (0..self.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        if pairs.take(MOST_PAIRS).any(|(i, j)| self.exclude_one_another(i, j)) {
            return InscribedError::EmptyInterior;
        }
        InscribedError::NearlyEmpty { ratio }
    }

    /// Whether half-spaces i and j have opposite normals and no interior in common, exactly.
    fn exclude_one_another(&self, i: usize, j: usize) -> bool {
        let n = self.n;
        let (a, b) = (&self.normals[i * n..(i + 1) * n], &self.normals[j * n..(j + 1) * n]);
        let largest = (1..n).fold(0, |best, k| if a[k].abs() > a[best].abs() { k } else { best });
        let (size, other) = (a[largest].abs(), b[largest].abs());
        // a·|b_k| + b·|a_k| = 0 for the largest coordinate k of a.
        let is_opposite =
            |k: usize, sign: f64| twofold::is_at_most_zero([(sign * a[k], other), (sign * b[k], size)].into_iter());
        other > 0.0
            && (0..n).all(|k| is_opposite(k, 1.0) && is_opposite(k, -1.0))
            && twofold::is_at_most_zero([(self.offsets[i], other), (self.offsets[j], size)].into_iter())
    }

    pub(crate) fn rows(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.normals.chunks_exact(self.n).zip(self.offsets.iter().copied())
    }
}

impl<D: Dimension> Body<D> for Polyhedron {
    /// The largest scale that is proved to keep the ellipsoid in all half-spaces: a·c + |diag(axes)·R·a| ≤ b exactly
    /// for the doubles, by bounds on the rounding of both sides.
    ///
    /// By its own rounding, [`support_value`] may then still exceed b by a rounding: the ellipsoid shrinks once more,
    /// twice as far each time.
    fn touch(&self, shape: &mut Shape<D>) -> Option<()> {
        let most = |(a, b): (&[f64], f64)| {
            let to_center = a.iter().copied().zip(shape.center.as_ref().iter().map(|c| -c));
            let (room, error) = twofold::dot_with_error([(b, 1.0)].into_iter().chain(to_center));
            let reach = reach_at_most(shape.axes.as_ref(), shape.semi_axes.as_ref(), a);
            // The scale itself, and one at which the rounding of the support value is negligible.
            [(room - error) / reach, (room - error - 16.0 * UNIT_ROUNDOFF * b.abs()) / reach * (1.0 - 1e-12)]
        };
        let scales: Vec<[f64; 2]> = self.rows().map(most).collect();
        // The difference, the quotient and the products with it are rounded.
        let mut scale = scales.iter().fold(f64::INFINITY, |m, s| m.min(s[0])) * (1.0 - 8.0 * UNIT_ROUNDOFF);
        let near: Vec<_> = self.rows().zip(&scales).filter(|(_, s)| !(s[1] > scale)).map(|(row, _)| row).collect();
        let mut shrinkage = UNIT_ROUNDOFF;
        for _ in 0..MOST_SHRINKS {
            if !(scale > 0.0 && scale.is_finite()) {
                return None;
            }
            shape.semi_axes.as_mut().iter_mut().for_each(|a| *a *= scale);
            let (center, axes, semi_axes) = (shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
            if near.iter().all(|&(a, b)| support_value(center, axes, semi_axes, a) <= b) {
                return Some(());
            }
            scale = 1.0 - shrinkage;
            shrinkage *= 2.0;
        }
        None
    }

    fn beyond(&self, _: usize, _: f64) -> f64 {
        0.0
    }
}

/// Pairs of half-spaces tested before a body counts as empty.
const MOST_PAIRS: usize = 1 << 22;

/// Doubling shrinkages: the last is the whole size.
const MOST_SHRINKS: usize = 54;
