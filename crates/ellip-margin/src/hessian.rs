//! The second derivative of the margin in the centre.
//!
//! In the coordinates of E₁'s ball, g = diag(a₁)⁻¹R₁ᵀ(x₁ − x₂) and m + 1 = ‖By − g‖². Differentiating (C + ν)y = Bᵀg and
//! ‖y‖ = 1 gives dy = KBᵀdg with K = T − Tyyᵀ T/(yᵀTy), T = (C + ν)⁻¹, and the Hessian 2(I − BKBᵀ). In the singular basis
//! B = UΣVᵀ, x̂ = Vᵀy, this is a sum of positive terms:
//!
//! > 2U[diag(ν/(σᵢ² + ν)) + ttᵀ/Σ(x̂ᵢ²/(σᵢ² + ν))]Uᵀ, tᵢ = σᵢx̂ᵢ/(σᵢ² + ν).

use convex_support::{Ellipsoid, Matrix, Scalar, Vector};

use crate::Margin;
use crate::pair::{Pair, combine, dot, load};
use crate::svd::{Svd, svd};

impl<V: Vector> Margin<V> {
    /// ∂²m/∂x₁² = ∂²m/∂x₂², symmetric and positive semidefinite: m is convex in the centres.
    ///
    /// It is zero where x₁ lies in E₂, and jumps at the boundary of E₂, where m has no second derivative. `e1` and `e2`
    /// must be the ellipsoids of this margin.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::{DMat3, DVec3}};
    /// use ellip_margin::{MarginOptions, free_margin};
    ///
    /// // m = (d/2 − ½)² − 1 for balls of radius 2 and 1 at a distance of d: m″ = ½ along, m′/d = (d − 1)/2d across.
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(5.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let hessian = free_margin(&link, &obstacle, MarginOptions::default()).hessian(&link, &obstacle);
    /// assert!(hessian.abs_diff_eq(DMat3::from_diagonal(DVec3::new(0.5, 0.4, 0.4)), 1e-15));
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn hessian(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> V::Matrix {
        if V::DIM == 2 { self.hessian_in::<2>(e1, e2) } else { self.hessian_in::<3>(e1, e2) }
    }

    fn hessian_in<const N: usize>(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> V::Matrix {
        let nu = self.nu.as_f64();
        if nu <= 0.0 {
            return V::Matrix::from_cols_fn(|_| V::ZERO);
        }
        let pair = Pair::<N>::new(e1, e2);
        let Svd { sigma, u, v } = svd(pair.b());
        let y: [f64; N] = load(self.ball_point);
        let mut sum = 0.0;
        let mut diagonal = [0.0; N];
        let mut t = [0.0; N];
        for i in 0..N {
            let x = dot(v[i], y);
            let shifted = sigma[i] * sigma[i] + nu;
            sum += x * x / shifted;
            diagonal[i] = nu / shifted;
            t[i] = sigma[i] * x / shifted;
        }
        // The columns of R₁·diag(a₁)⁻¹U: dg = (…)ᵀdx₁.
        let columns: [[f64; N]; N] =
            core::array::from_fn(|k| combine(pair.axes1, core::array::from_fn(|i| u[k][i] / pair.a1[i])));
        let t = combine(columns, t);
        let entry = |i: usize, j: usize| {
            let round: f64 = (0..N).map(|k| diagonal[k] * (columns[k][i] * columns[k][j])).sum();
            2.0 * (round + t[i] * t[j] / sum)
        };
        V::Matrix::from_cols_fn(|j| V::from_fn(|i| V::Scalar::from_f64(entry(i, j))))
    }
}
