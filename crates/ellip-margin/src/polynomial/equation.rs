//! F(ν) = D(ν)² − N(ν) in one number, and the steps towards its root.
//!
//! Far from the root it is approached by Newton's method for 1/φ = D/√N = 1 (Hebden), which is all but linear. Near it,
//! F is inverted as a series: with u = −F₀/F₁, A = F₂/F₁, B = F₃/F₁ of its Taylor coefficients
//!
//! > δ = u − Au² + (2A² − B)u³ + O(u⁴),
//!
//! which takes one division and no root, and squares the error twice over.

use convex_support::numerics::elementary::sqrt;

/// N(ν) = D(ν)², by its coefficients from the constant one up.
#[derive(Clone, Copy, Debug)]
pub(super) struct Equation<const N: usize> {
    pub(super) n: [f64; 5],
    pub(super) d: [f64; 4],
}

impl<const N: usize> Equation<N> {
    #[inline(always)]
    pub(super) fn determinant(&self, nu: f64) -> f64 {
        let d = &self.d;
        if N == 2 { d[0] + nu * (d[1] + nu) } else { (d[0] + nu * d[1]) + nu * nu * (d[2] + nu) }
    }

    /// The Taylor coefficients of N and D about ν, up to the third.
    #[inline(always)]
    pub(super) fn at(&self, nu: f64) -> Taylor {
        let Self { n, d } = self;
        let square = nu * nu;
        if N == 2 {
            Taylor {
                n: [(n[0] + nu * n[1]) + square * n[2], n[1] + 2.0 * nu * n[2], n[2], 0.0],
                d: [(d[0] + nu * d[1]) + square, d[1] + 2.0 * nu, 1.0, 0.0],
            }
        } else {
            let n4 = nu * n[4];
            Taylor {
                n: [
                    (n[0] + nu * n[1]) + square * (n[2] + nu * (n[3] + n4)),
                    (n[1] + 2.0 * nu * n[2]) + square * (3.0 * n[3] + 4.0 * n4),
                    n[2] + nu * (3.0 * n[3] + 6.0 * n4),
                    n[3] + 4.0 * n4,
                ],
                d: [
                    (d[0] + nu * d[1]) + square * (d[2] + nu),
                    d[1] + nu * (2.0 * d[2] + 3.0 * nu),
                    d[2] + 3.0 * nu,
                    1.0,
                ],
            }
        }
    }
}

/// N and D about some ν.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taylor {
    pub(super) n: [f64; 4],
    pub(super) d: [f64; 4],
}

impl Taylor {
    /// F₀ to F₃.
    #[inline(always)]
    fn difference(&self) -> [f64; 4] {
        let Self { n, d } = self;
        [
            d[0] * d[0] - n[0],
            2.0 * d[0] * d[1] - n[1],
            (d[1] * d[1] + 2.0 * d[0] * d[2]) - n[2],
            2.0 * (d[1] * d[2] + d[0] * d[3]) - n[3],
        ]
    }

    /// Whether the series converges fast, and to the root on the rising branch of F: |Au| < 1/32 and |u| < ν/16.
    #[inline(always)]
    pub(super) fn is_near(&self, nu: f64) -> bool {
        let [f0, f1, f2, _] = self.difference();
        (32.0 * (f0 * f2).abs() < f1 * f1) & (16.0 * f0.abs() < nu * f1)
    }

    /// δ, and an estimate of its error.
    #[inline(always)]
    pub(super) fn series(&self) -> (f64, f64) {
        let [f0, f1, f2, f3] = self.difference();
        let inverse = 1.0 / f1;
        let (u, a, b) = (-f0 * inverse, f2 * inverse, f3 * inverse);
        let (first, second) = (a * u, b * (u * u));
        let ratio = first.abs() + second.abs();
        (u * ((1.0 - first) + (2.0 * (first * first) - second)), 5.0 * (ratio * ratio * ratio) * u.abs())
    }

    /// Newton's step (1 − h)/h′ for h = 1/φ, where h′ = (D′ − DN′/2N)/√N.
    #[inline(always)]
    pub(super) fn hebden(&self) -> f64 {
        let ([n0, n1, ..], [d0, d1, ..]) = (self.n, self.d);
        (sqrt(n0) - d0) * (2.0 * n0 / (2.0 * n0 * d1 - d0 * n1))
    }

    /// φ.
    #[inline(always)]
    pub(super) fn phi(&self) -> f64 {
        sqrt(self.n[0]) / self.d[0]
    }
}
