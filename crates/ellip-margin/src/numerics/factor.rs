//! The factorisation of small symmetric positive definite matrices.

use super::Vec;

/// L·diag(D)·Lᵀ of a symmetric positive definite matrix, given by its lower triangle.
pub(crate) struct Factor<const N: usize> {
    l: [Vec<N>; N],
    /// 1/D.
    inverse: Vec<N>,
}

impl<const N: usize> Factor<N> {
    pub(crate) fn new(mut a: [Vec<N>; N]) -> Self {
        let mut inverse = [0.0; N];
        for j in 0..N {
            inverse[j] = 1.0 / a[j][j];
            for i in j + 1..N {
                let factor = a[i][j] * inverse[j];
                for k in j + 1..=i {
                    a[i][k] -= factor * a[k][j];
                }
            }
            for row in a.iter_mut().skip(j + 1) {
                row[j] *= inverse[j];
            }
        }
        Self { l: a, inverse }
    }

    pub(crate) fn solve(&self, mut b: Vec<N>) -> Vec<N> {
        for j in 0..N {
            for i in j + 1..N {
                b[i] -= self.l[i][j] * b[j];
            }
        }
        for j in (0..N).rev() {
            b[j] *= self.inverse[j];
            for i in j + 1..N {
                b[j] -= self.l[i][j] * b[i];
            }
        }
        b
    }
}
