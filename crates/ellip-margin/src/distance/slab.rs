//! The slab between two bodies across a direction, and how it is widened.
//!
//! f is concave: on the unit sphere its gradient is the part of p₂ − p₁ across n, its Hessian −(f·I + H), with
//! H = Σ(Sₖ/hₖ − Sₖnnᵀ Sₖ/hₖ³) ⪰ 0 and Hn = 0, so that Newton's step is to
//!
//! > n⁺ ∝ (f·I + H)⁻¹(p₂ − p₁),
//!
//! always an ascent direction while f > 0. Across a thin body hₖ has almost a kink, which Newton's step leaps over;
//! there the step of iterated reweighting is taken,
//!
//! > n⁺ ∝ (f·I + S₁/h₁ + S₂/h₂)⁻¹r,
//!
//! which never descends, whatever the shape: since h(n′) ≤ (n′ᵀSn′/h + h)/2 with equality at n, it maximises a function
//! that lies below n′·r − h₁(n′) − h₂(n′) − f‖n′‖²/2 and meets it at n. With the tangent θ of the angle between n and
//! p₂ − p₁ the bracket's relative width is θ²/2: it closes with twice the digits of n.

use convex_support::numerics::elementary::{hypot, sqrt};
use convex_support::{Scalar, Vector};

use super::bracket::DistanceBracket;
use crate::numerics::{DoubleDouble, Factor, Vec, add, combine, dot, size, store, sub, unit};
use crate::pair::Pair;
use crate::secular::Solution;
use crate::{MarginOptions, Status};

/// Whether bodies whose margin is not positive certainly have a common point: an iteration that was cut short finds
/// less than the margin. Then E₂'s point along y has to lie in E₁.
fn is_proved<const N: usize>(pair: &Pair<N>, solution: &Solution<N>, options: MarginOptions) -> bool {
    if solution.status == Status::Converged && options.tolerance() <= MarginOptions::new().tolerance() {
        return true;
    }
    let p = sub(pair.out_of_ball(unit(solution.y)), pair.r());
    let w: Vec<N> = core::array::from_fn(|i| dot(pair.axes1[i], p) / pair.a1[i]);
    let is_inside = solution.nu == 0.0 && solution.status == Status::Converged;
    is_inside || dot(w, w) <= 1.0
}

/// A direction with the support values and points of the two bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slab<const N: usize> {
    /// The unit direction from E₁ to E₂.
    pub(super) n: Vec<N>,
    /// uₖ = diag(aₖ)Rₖᵀn, whose lengths are the support values hₖ.
    u: [Vec<N>; 2],
    pub(super) h: [f64; 2],
    /// pₖ − xₖ = ±Rₖ·diag(aₖ)uₖ/hₖ.
    offset: [Vec<N>; 2],
    /// p₂ − p₁.
    across: Vec<N>,
    /// f(n) = n·(p₂ − p₁).
    pub(super) width: f64,
}

impl<const N: usize> Slab<N> {
    /// The slab across the margin's normal, or across the line of centres if the margin has none; `None` if the bodies
    /// overlap.
    pub(super) fn of_margin(pair: &Pair<N>, solution: &Solution<N>, options: MarginOptions) -> Option<Self> {
        if solution.margin <= 0.0 && is_proved(pair, solution, options) {
            return None;
        }
        Self::across(pair, solution.y).or_else(|| {
            let line = pair.r().map(|x| -x);
            Some(Self::new(pair, if size(line) > 0.0 { unit(line) } else { pair.axes1[0] }))
        })
    }

    /// The slab whose normal is that of E₂ at its point y of the ball; `None` if that is NaN.
    pub(super) fn across(pair: &Pair<N>, y: Vec<N>) -> Option<Self> {
        // −z = −Q(x* − x₂) points from E₁ to E₂.
        let n = unit(combine(pair.axes2, core::array::from_fn(|j| -y[j] / pair.a2[j])));
        n.iter().all(|x| x.is_finite()).then(|| Self::new(pair, n))
    }

    pub(super) fn new(pair: &Pair<N>, n: Vec<N>) -> Self {
        let side = |axes: &[Vec<N>; N], a: &Vec<N>, sign: f64| {
            let u: Vec<N> = core::array::from_fn(|k| a[k] * dot(axes[k], n));
            let h = sqrt(dot(u, u));
            // If a body is so small against the other that its square underflows, it counts as a point.
            let inverse = if h > 0.0 { sign / h } else { 0.0 };
            (u, h, combine(*axes, core::array::from_fn(|k| a[k] * (u[k] * inverse))))
        };
        let (u1, h1, offset1) = side(&pair.axes1, &pair.a1, 1.0);
        let (u2, h2, offset2) = side(&pair.axes2, &pair.a2, -1.0);
        let r = pair.r();
        let across: Vec<N> = core::array::from_fn(|i| (offset2[i] - r[i]) - offset1[i]);
        Self { n, u: [u1, u2], h: [h1, h2], offset: [offset1, offset2], across, width: dot(n, across) }
    }

    /// ‖p₂ − p₁‖.
    pub(super) fn length(&self) -> f64 {
        sqrt(dot(self.across, self.across))
    }

    /// θ²: the squared tangent of the angle between n and p₂ − p₁; infinite if it is not below a right angle.
    pub(super) fn tangent_squared(&self) -> f64 {
        if self.width > 0.0 {
            let t: Vec<N> = core::array::from_fn(|i| (self.across[i] - self.width * self.n[i]) / self.width);
            dot(t, t)
        } else {
            f64::INFINITY
        }
    }

    /// A wider slab; `None` if none is found.
    pub(super) fn ascend(&self, pair: &Pair<N>) -> Option<Self> {
        // Newton's step, if it gains a quarter of its prediction, or brings p₂ − p₁ nearer to n although the gain is
        // too small to show in the width.
        let tangent = sub(self.across, self.n.map(|x| x * self.width));
        let step = Factor::new(self.curvature(pair, true)).solve(tangent);
        let next = Self::new(pair, unit(add(self.n, step)));
        let gain = 0.125 * dot(step, tangent);
        let hidden = gain <= self.rounding(pair) && next.tangent_squared() <= 0.25 * self.tangent_squared();
        if next.width >= self.width + gain || hidden {
            return Some(next);
        }
        let reweighted = Self::new(pair, unit(Factor::new(self.curvature(pair, false)).solve(pair.r().map(|x| -x))));
        let best = if reweighted.width > next.width { reweighted } else { next };
        (best.width > self.width).then_some(best)
    }

    /// The lower triangle of f·I + Σ Sₖ/hₖ, or with `projected` of f·I + Σ (Sₖ/hₖ − Sₖnnᵀ Sₖ/hₖ³).
    fn curvature(&self, pair: &Pair<N>, projected: bool) -> [Vec<N>; N] {
        let floor = f64::EPSILON * (self.h[0] + self.h[1]);
        let mut matrix = [[0.0; N]; N];
        for (i, row) in matrix.iter_mut().enumerate() {
            row[i] = self.width.max(floor);
        }
        for (body, (axes, a)) in [(&pair.axes1, &pair.a1), (&pair.axes2, &pair.a2)].into_iter().enumerate() {
            // R·diag(a)·E·diag(a)·Rᵀ/h with E = I or E = I − ûûᵀ, û = u/h, 1 − ûₖ² as the sum of the other squares.
            let h = self.h[body];
            let e: Vec<N> = core::array::from_fn(|k| self.u[body][k] / h);
            let inner: [Vec<N>; N] = core::array::from_fn(|k| {
                core::array::from_fn(|l| {
                    let entry = match (projected, k == l) {
                        (true, true) => (0..N).filter(|&j| j != k).map(|j| e[j] * e[j]).sum(),
                        (true, false) => -e[k] * e[l],
                        (false, same) => f64::from(u8::from(same)),
                    };
                    a[k] * entry * (a[l] / h)
                })
            });
            let half: [Vec<N>; N] = core::array::from_fn(|k| combine(*axes, inner[k])); // row k of inner·Rᵀ
            for i in 0..N {
                for j in 0..=i {
                    matrix[i][j] += (0..N).map(|k| axes[k][i] * half[k][j]).sum::<f64>();
                }
            }
        }
        matrix
    }

    /// A bound on the rounding of `width`: the products with the axes have errors of ε times the bodies' extents.
    fn rounding(&self, pair: &Pair<N>) -> f64 {
        let r = pair.r();
        let extent = pair.a1.iter().chain(&pair.a2).fold(sqrt(dot(r, r)), |m, a| m.max(*a));
        16.0 * f64::EPSILON * extent
    }

    /// Whether rounding leaves more than twelve digits of `width`.
    pub(super) fn is_wide(&self, pair: &Pair<N>) -> bool {
        self.rounding(pair) <= 2.5e-13 * self.width
    }

    /// f(n) with the rounding errors kept if they would show.
    pub(super) fn exact_width(&self, pair: &Pair<N>) -> f64 {
        if self.is_wide(pair) { self.width } else { self.compensated_width(pair) }
    }

    /// (n·r − ‖diag(a₁)R₁ᵀn‖ − ‖diag(a₂)R₂ᵀn‖)/‖n‖ in double-double.
    #[cold]
    fn compensated_width(&self, pair: &Pair<N>) -> f64 {
        let n = self.n;
        let product = |x: Vec<N>| (0..N).fold(DoubleDouble::ZERO, |sum, i| sum + DoubleDouble::product(x[i], n[i]));
        let support = |axes: &[Vec<N>; N], a: &Vec<N>| {
            (0..N)
                .fold(DoubleDouble::ZERO, |sum, k| {
                    let u = product(axes[k]) * a[k];
                    sum + u * u
                })
                .sqrt()
        };
        let along = (0..N).fold(DoubleDouble::ZERO, |sum, i| sum + DoubleDouble::sum(pair.x2[i], -pair.x1[i]) * n[i]);
        let width = along - support(&pair.axes1, &pair.a1) - support(&pair.axes2, &pair.a2);
        (width / product(n).sqrt().value().into()).value()
    }

    /// The bracket, given the [`exact_width`](Self::exact_width) and the unit of length of `pair`.
    pub(super) fn bracket<V: Vector>(&self, pair: &Pair<N>, width: f64, unit: f64) -> DistanceBracket<V> {
        let slack = if self.is_wide(pair) { self.rounding(pair) } else { 8.0 * f64::EPSILON * width.abs() };
        // The lengths along and across n, so that the width's digits are not lost.
        let t = sub(self.across, self.n.map(|x| x * self.width));
        let upper = hypot(width, sqrt(dot(t, t)));
        // Rounding to an `f32` must not close the bracket either.
        let coarse = V::Scalar::EPSILON;
        DistanceBracket {
            lower: (V::Scalar::from_f64((width - slack).max(0.0) * unit)) * (V::Scalar::ONE - coarse),
            upper: V::Scalar::from_f64((upper + slack) * unit) * (V::Scalar::ONE + coarse),
            point1: store(add(pair.x1, self.offset[0]).map(|x| x * unit)),
            point2: store(add(pair.x2, self.offset[1]).map(|x| x * unit)),
            normal: store(self.n),
        }
    }
}
