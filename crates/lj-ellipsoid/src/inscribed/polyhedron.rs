//! The half-spaces as given, checked and scaled.

use crate::error::InscribedError;
use crate::numerics::linalg::power_of_two_inverse;

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
            // A power of two moves no bit: what holds for these rows holds for the given ones.
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

    pub(crate) fn rows(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.normals.chunks_exact(self.n).zip(self.offsets.iter().copied())
    }
}
