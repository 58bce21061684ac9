//! Two ellipsoids as the kernels see them: plain arrays of `f64`, relative to one another.
//!
//! | paper | here |
//! |---|---|
//! | E(x₁; P), E(x₂; Q) | P = R₁·diag(a₁)⁻²·R₁ᵀ, Q = R₂·diag(a₂)⁻²·R₂ᵀ, neither of them formed |
//! | x̄ = Q^½(x − x₂) | `y` = diag(a₂)⁻¹R₂ᵀ(x − x₂): the same ball, turned by R₂ᵀ |
//! | c = Q^½(x₁ − x₂) | `c` = diag(a₂)⁻¹R₂ᵀr, r = x₁ − x₂ |
//! | C = Q^(-½)·P·Q^(-½) | BᵀB, with B = diag(a₁)⁻¹R₁ᵀR₂·diag(a₂) |
//! | b = Cc | Bᵀg, with g = Bc = diag(a₁)⁻¹R₁ᵀr |
//!
//! Everything is computed in `f64`, for bodies in `f32` too: the processor is as fast, no square leaves the range, and
//! an `f32` answer then is the true one rounded, whatever the aspect.

use convex_support::{Ellipsoid, Vector};

use crate::numerics::{DoubleDouble, Vec, combine, dot, load, load_columns, power_of_two_near, size, sub};

/// Two ellipsoids; `axes[k]` is the direction of semi-axis `k`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair<const N: usize> {
    pub(crate) x1: Vec<N>,
    pub(crate) x2: Vec<N>,
    pub(crate) axes1: [Vec<N>; N],
    pub(crate) axes2: [Vec<N>; N],
    pub(crate) a1: Vec<N>,
    pub(crate) a2: Vec<N>,
}

impl<const N: usize> Pair<N> {
    /// # Panics
    /// In debug builds, if `N` is not the dimension of `V`.
    #[inline]
    pub(crate) fn new<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Self {
        debug_assert_eq!(N, V::DIM, "the kernel of one dimension was given bodies of another");
        Self {
            x1: load(e1.center()),
            x2: load(e2.center()),
            axes1: load_columns(e1.axes()),
            axes2: load_columns(e2.axes()),
            a1: load(e1.semi_axes()),
            a2: load(e2.semi_axes()),
        }
    }

    /// The same pair with a power of two for unit of length, near the greatest length in it; and that unit.
    ///
    /// No bit is lost, and squares of lengths are far from the ends of the range.
    #[inline]
    pub(crate) fn in_own_unit(&self) -> (Self, f64) {
        let unit = power_of_two_near(self.a1.iter().chain(&self.a2).fold(size(self.r()), |m, a| m.max(*a)));
        let inverse = 1.0 / unit;
        let scaled = |x: Vec<N>| x.map(|x| x * inverse);
        let (x1, x2, a1, a2) = (scaled(self.x1), scaled(self.x2), scaled(self.a1), scaled(self.a2));
        (Self { x1, x2, a1, a2, ..*self }, unit)
    }

    /// E₂ and E₁.
    pub(crate) fn swapped(&self) -> Self {
        Self { x1: self.x2, x2: self.x1, axes1: self.axes2, axes2: self.axes1, a1: self.a2, a2: self.a1 }
    }

    /// r = x₁ − x₂.
    #[inline]
    pub(crate) fn r(&self) -> Vec<N> {
        sub(self.x1, self.x2)
    }

    /// c and g: the centre of E₁ seen from E₂ as the unit ball, and from E₁ as the unit ball.
    #[inline]
    pub(crate) fn c_and_g(&self) -> (Vec<N>, Vec<N>) {
        let r = self.r();
        (
            core::array::from_fn(|j| dot(self.axes2[j], r) / self.a2[j]),
            core::array::from_fn(|i| dot(self.axes1[i], r) / self.a1[i]),
        )
    }

    /// B, row by row.
    pub(crate) fn b(&self) -> [Vec<N>; N] {
        core::array::from_fn(|i| {
            core::array::from_fn(|j| dot(self.axes1[i], self.axes2[j]) * (self.a2[j] / self.a1[i]))
        })
    }

    /// x − x₂ = R₂·diag(a₂)·y.
    #[inline]
    pub(crate) fn out_of_ball(&self, y: Vec<N>) -> Vec<N> {
        combine(self.axes2, core::array::from_fn(|j| self.a2[j] * y[j]))
    }

    /// ‖c‖² − 1 with the rounding errors kept, for x₁ near the boundary of E₂, where it decides.
    pub(crate) fn compensated_excess(&self) -> f64 {
        let r: [DoubleDouble; N] = core::array::from_fn(|i| DoubleDouble::sum(self.x1[i], -self.x2[i]));
        let mut excess = DoubleDouble::from(-1.0);
        for j in 0..N {
            let mut e = DoubleDouble::ZERO;
            for i in 0..N {
                e = e + r[i] * self.axes2[j][i];
            }
            let c = e / self.a2[j].into();
            excess = excess + c * c;
        }
        excess.value()
    }

    /// ‖By − g‖² + ν(‖y‖² − 1) − 1 with the rounding errors kept.
    ///
    /// This Lagrangian of the margin's problem is stationary at the solution in `y` and in ν, so that their rounding
    /// errors enter squared: it is the margin of the bodies as stored, to some ten digits more than `y` and ν have.
    ///
    /// Seldom needed: the pair is taken by value, so that the caller's can stay in registers.
    #[cold]
    #[inline(never)]
    pub(crate) fn compensated_margin(self, y: Vec<N>, nu: f64) -> f64 {
        self.compensated_lagrangian(y, nu).0
    }

    /// The same, and w = By − g, of which what `y` was rounded by is a part.
    #[inline]
    pub(crate) fn compensated_lagrangian(self, y: Vec<N>, nu: f64) -> (f64, Vec<N>) {
        // p = x − x₁ = R₂·diag(a₂)·y − r
        let mut p: [DoubleDouble; N] = core::array::from_fn(|i| DoubleDouble::sum(self.x2[i], -self.x1[i]));
        let mut sphere = DoubleDouble::from(-1.0);
        for j in 0..N {
            let along = DoubleDouble::product(self.a2[j], y[j]);
            for (i, p) in p.iter_mut().enumerate() {
                *p = *p + along * self.axes2[j][i];
            }
            sphere = sphere + DoubleDouble::product(y[j], y[j]);
        }
        let mut margin = DoubleDouble::from(-1.0) + sphere * nu;
        let mut rounded_w = [0.0; N];
        for i in 0..N {
            let mut e = DoubleDouble::ZERO;
            for k in 0..N {
                e = e + p[k] * self.axes1[i][k];
            }
            let w = e / self.a1[i].into();
            margin = margin + w * w;
            rounded_w[i] = w.value();
        }
        (margin.value(), rounded_w)
    }
}
