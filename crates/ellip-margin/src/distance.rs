//! The Euclidean distance of two ellipsoids, from the margin and certified.
//!
//! For a direction n from E₁ to E₂, with r = x₂ − x₁ and Sₖ = Rₖ·diag(aₖ)²·Rₖᵀ, the support points
//!
//! > p₁ = x₁ + S₁n/h₁, p₂ = x₂ − S₂n/h₂, hₖ = √(nᵀSₖn)
//!
//! are points of the bodies, and the slab between their tangent planes has the width f(n) = n·r − h₁ − h₂ = n·(p₂ − p₁)
//! for a unit n. Hence, for *any* n,
//!
//! > f(n) ≤ distance ≤ ‖p₂ − p₁‖,
//!
//! with equality where p₂ − p₁ is along n. The margin's normal at x* gives a first bracket: f is `r(r − 1)/‖Pw‖` there, and
//! p₂ = x*. To close it, maximise f, which is concave: on the unit sphere its gradient is the part of p₂ − p₁ across n,
//! its Hessian −(f·I + H), with H = Σ(Sₖ/hₖ − Sₖnnᵀ Sₖ/hₖ³) ⪰ 0 and Hn = 0, so that Newton's step is to
//!
//! > n⁺ ∝ (f·I + H)⁻¹(p₂ − p₁),
//!
//! always an ascent direction while f > 0. Across a thin body hₖ has almost a kink, which Newton's step leaps over; there
//! the step of iterated reweighting is taken,
//!
//! > n⁺ ∝ (f·I + S₁/h₁ + S₂/h₂)⁻¹r,
//!
//! which never descends, whatever the shape: since h(n′) ≤ (n′ᵀSn′/h + h)/2 with equality at n, it maximises a function
//! that lies below n′·r − h₁(n′) − h₂(n′) − f‖n′‖²/2 and meets it at n. With the tangent θ of the angle between n and p₂ − p₁
//! the bracket's relative width is θ²/2: it closes with twice the digits of n.

use convex_support::{Ellipsoid, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::double_double::DoubleDouble;
use crate::margin::solve;
use crate::multipliers;
use crate::pair::{Pair, Vec, add, combine, dot, store, sub};
use crate::polynomial;
use crate::secular::Solution;
use crate::{MarginOptions, Status};

/// Two points and a slab that hold the Euclidean distance between them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct DistanceBracket<V: Vector> {
    /// The distance is at least this: the width of the slab between the bodies across `normal`. 0 where they overlap.
    pub lower: V::Scalar,
    /// The distance is at most this, that from `point1` to `point2`. 0 where they overlap.
    pub upper: V::Scalar,
    /// A point of E₁ (to rounding); where they overlap, a point of both.
    pub point1: V,
    /// A point of E₂ (to rounding); where they overlap, a point of both.
    pub point2: V,
    /// The unit normal of the slab, from E₁ to E₂; zero where they overlap.
    pub normal: V,
}

/// The Euclidean distance of two ellipsoids; see [`distance`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct Distance<V: Vector> {
    /// The distance; 0 where they overlap.
    pub distance: V::Scalar,
    /// What is certain about it, with the closest points.
    pub bracket: DistanceBracket<V>,
    /// How the iteration ended. Whatever this says, the bracket holds.
    pub status: Status,
    /// The steps it took, after those for the margin.
    pub iterations: usize,
}

/// Bounds on the Euclidean distance from the two margins, of `e1` about `e2` and the other way round: no further iteration.
///
/// The lower bound is the better of the two, and so is the upper, whose points are given. On ordinary shapes they are
/// within a few per cent of the distance.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{MarginOptions, distance, distance_bracket};
///
/// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 0.5), Default::default())?;
/// let obstacle = Ellipsoid::new(DVec3::new(3.0, 2.0, 1.0), DVec3::new(0.5, 0.5, 1.0), Default::default())?;
/// let bracket = distance_bracket(&link, &obstacle, MarginOptions::default());
/// let exact = distance(&link, &obstacle, MarginOptions::default()).distance;
/// assert!(bracket.lower <= exact && exact <= bracket.upper);
/// assert!(bracket.upper - bracket.lower < 0.1 * exact);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn distance_bracket<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> DistanceBracket<V> {
    if V::DIM == 2 { bracket_in::<V, 2>(e1, e2, options) } else { bracket_in::<V, 3>(e1, e2, options) }
}

fn bracket_in<V: Vector, const N: usize>(
    e1: &Ellipsoid<V>,
    e2: &Ellipsoid<V>,
    options: MarginOptions,
) -> DistanceBracket<V> {
    let (there, back) = (Pair::<N>::new(e1, e2), Pair::<N>::new(e2, e1));
    let first = solve(&there, 0.0, options, |_, _| {});
    let Some(slab) = Slab::of_margin(&there, &first) else { return overlapping(&there, &first) };
    let second = solve(&back, 0.0, options, |_, _| {});
    // The slab of the other margin runs from E₂ to E₁.
    let other = Slab::of_margin(&back, &second).map(|s| Slab::new(&there, s.n.map(|x| -x)));
    let best = |a: Slab<N>, b: Option<Slab<N>>, better: fn(&Slab<N>, &Slab<N>) -> bool| match b {
        Some(b) if better(&b, &a) => b,
        _ => a,
    };
    let low = best(slab, other, |a, b| a.width > b.width);
    let high = best(slab, other, |a, b| a.length() < b.length());
    let bracket = |slab: Slab<N>| slab.bracket::<V>(&there, slab.exact_width(&there));
    DistanceBracket { lower: bracket(low).lower, normal: store(low.n), ..bracket(high) }
}

/// The Euclidean distance between `e1` and `e2` with its closest points, certified: the bracket is the width of a
/// separating slab and the distance of two points, and closes to about 1e-12 of the distance (1e-7 in `f32`).
///
/// Where the bodies overlap, which the sign of the margin decides, it is 0; so it may be where they are apart by less than
/// the rounding of their coordinates.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{MarginOptions, distance};
///
/// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
/// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
/// let d = distance(&link, &obstacle, MarginOptions::default());
/// assert!((d.distance - 3.0).abs() < 1e-14);
/// assert!(d.bracket.lower <= d.distance && d.distance <= d.bracket.upper);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn distance<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Distance<V> {
    if V::DIM == 2 { distance_in::<V, 2>(e1, e2, options) } else { distance_in::<V, 3>(e1, e2, options) }
}

fn distance_in<V: Vector, const N: usize>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Distance<V> {
    let pair = Pair::<N>::new(e1, e2);
    // A slab that separates the bodies settles that they are disjoint, however its normal was found.
    let rough = polynomial::rough(&pair).and_then(|y| Slab::across(&pair, y)).filter(|slab| slab.is_wide(&pair));
    let mut slab = match rough {
        Some(slab) => slab,
        None => {
            let margin = solve(&pair, 0.0, options, |_, _| {});
            let Some(slab) = Slab::of_margin(&pair, &margin) else {
                let bracket = overlapping(&pair, &margin);
                return Distance { distance: V::Scalar::ZERO, bracket, status: margin.status, iterations: 0 };
            };
            slab
        }
    };
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    if slab.width > 0.0 && slab.tangent_squared() > 2.0 * options.tolerance {
        let beta = slab.h.map(|h| h * slab.width);
        // An eighth of the steps is left for the slab to close by itself, should this end before it is at rest.
        let most = options.max_iterations - options.max_iterations / 8;
        if let Some((d, steps)) = multipliers::closest(&pair, beta, most) {
            iterations += steps;
            let next = Slab::new(&pair, unit(d));
            slab = if next.width > slab.width { next } else { slab };
        }
    }
    loop {
        if slab.tangent_squared() <= 2.0 * options.tolerance {
            status = Status::Converged;
            break;
        }
        if iterations >= options.max_iterations {
            break;
        }
        iterations += 1;
        match slab.ascend(&pair) {
            Some(next) => slab = next,
            None => {
                // No step widens the slab by more than rounding.
                status = if slab.tangent_squared() < 1e-12 { Status::Converged } else { Status::Stalled };
                break;
            }
        }
    }
    let width = slab.exact_width(&pair);
    let distance = V::Scalar::from_f64(width.max(0.0));
    Distance { distance, bracket: slab.bracket(&pair, width), status, iterations }
}

/// The bracket of two bodies with a common point.
fn overlapping<V: Vector, const N: usize>(pair: &Pair<N>, solution: &Solution<N>) -> DistanceBracket<V> {
    let point = store(if solution.nu > 0.0 { add(pair.x2, pair.out_of_ball(solution.y)) } else { pair.x1 });
    DistanceBracket { lower: V::Scalar::ZERO, upper: V::Scalar::ZERO, point1: point, point2: point, normal: V::ZERO }
}

/// A direction with what the two bodies say to it.
#[derive(Clone, Copy, Debug)]
struct Slab<const N: usize> {
    /// The unit direction from E₁ to E₂.
    n: Vec<N>,
    /// uₖ = diag(aₖ)Rₖᵀn, whose lengths are the support values hₖ.
    u: [Vec<N>; 2],
    h: [f64; 2],
    /// pₖ − xₖ = ±Rₖ·diag(aₖ)uₖ/hₖ.
    offset: [Vec<N>; 2],
    /// p₂ − p₁.
    across: Vec<N>,
    /// f(n) = n·(p₂ − p₁).
    width: f64,
}

impl<const N: usize> Slab<N> {
    /// The slab across the margin's normal; `None` where the bodies overlap.
    fn of_margin(pair: &Pair<N>, solution: &Solution<N>) -> Option<Self> {
        if solution.margin.is_nan() || solution.margin <= 0.0 {
            return None;
        }
        Self::across(pair, solution.y)
    }

    /// The slab whose normal is that of E₂ at its point y of the ball; `None` where that is not a number.
    fn across(pair: &Pair<N>, y: Vec<N>) -> Option<Self> {
        // −z = −Q(x* − x₂) points from E₁ to E₂.
        let n = unit(combine(pair.axes2, core::array::from_fn(|j| -y[j] / pair.a2[j])));
        n.iter().all(|x| x.is_finite()).then(|| Self::new(pair, n))
    }

    fn new(pair: &Pair<N>, n: Vec<N>) -> Self {
        let side = |axes: &[Vec<N>; N], a: &Vec<N>, sign: f64| {
            let u: Vec<N> = core::array::from_fn(|k| a[k] * dot(axes[k], n));
            let h = dot(u, u).sqrt();
            (u, h, combine(*axes, core::array::from_fn(|k| a[k] * (sign * u[k] / h))))
        };
        let (u1, h1, offset1) = side(&pair.axes1, &pair.a1, 1.0);
        let (u2, h2, offset2) = side(&pair.axes2, &pair.a2, -1.0);
        let r = pair.r();
        let across: Vec<N> = core::array::from_fn(|i| (offset2[i] - r[i]) - offset1[i]);
        Self { n, u: [u1, u2], h: [h1, h2], offset: [offset1, offset2], across, width: dot(n, across) }
    }

    /// ‖p₂ − p₁‖.
    fn length(&self) -> f64 {
        dot(self.across, self.across).sqrt()
    }

    /// θ²: the squared tangent of the angle between n and p₂ − p₁; infinite where they do not agree at all.
    fn tangent_squared(&self) -> f64 {
        if self.width > 0.0 {
            let t: Vec<N> = core::array::from_fn(|i| (self.across[i] - self.width * self.n[i]) / self.width);
            dot(t, t)
        } else {
            f64::INFINITY
        }
    }

    /// A wider slab; `None` where none is found.
    fn ascend(&self, pair: &Pair<N>) -> Option<Self> {
        // Newton's step, if it does a quarter of what it foresees, or brings p₂ − p₁ nearer to n where that is too little
        // for the width to show.
        let tangent = sub(self.across, self.n.map(|x| x * self.width));
        let step = cholesky_solve(self.curvature(pair, true), tangent);
        let next = Self::new(pair, unit(add(self.n, step)));
        let gain = 0.125 * dot(step, tangent);
        let hidden = gain <= self.rounding(pair) && next.tangent_squared() <= 0.25 * self.tangent_squared();
        if next.width >= self.width + gain || hidden {
            return Some(next);
        }
        let reweighted = Self::new(pair, unit(cholesky_solve(self.curvature(pair, false), pair.r().map(|x| -x))));
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

    /// What rounding may do to `width`: the products with the axes have errors of ε times the bodies' extents.
    fn rounding(&self, pair: &Pair<N>) -> f64 {
        let r = pair.r();
        let extent = pair.a1.iter().chain(&pair.a2).fold(dot(r, r).sqrt(), |m, a| m.max(*a));
        16.0 * f64::EPSILON * extent
    }

    /// Whether rounding leaves more than twelve digits of `width`.
    fn is_wide(&self, pair: &Pair<N>) -> bool {
        self.rounding(pair) <= 2.5e-13 * self.width
    }

    /// f(n) with the rounding errors kept where they would show.
    fn exact_width(&self, pair: &Pair<N>) -> f64 {
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
        width.divided_by(product(n).sqrt().value()).value()
    }

    /// The bracket, given the [`exact_width`](Self::exact_width).
    fn bracket<V: Vector>(&self, pair: &Pair<N>, width: f64) -> DistanceBracket<V> {
        let slack = if self.is_wide(pair) { self.rounding(pair) } else { 8.0 * f64::EPSILON * width.abs() };
        // The lengths along and across n, so that the width's digits are not lost.
        let t = sub(self.across, self.n.map(|x| x * self.width));
        let upper = width.hypot(dot(t, t).sqrt());
        // Rounding to an `f32` must not close the bracket either.
        let coarse = V::Scalar::EPSILON;
        DistanceBracket {
            lower: (V::Scalar::from_f64((width - slack).max(0.0))) * (V::Scalar::ONE - coarse),
            upper: V::Scalar::from_f64(upper + slack) * (V::Scalar::ONE + coarse),
            point1: store(add(pair.x1, self.offset[0])),
            point2: store(add(pair.x2, self.offset[1])),
            normal: store(self.n),
        }
    }
}

/// The unit vector along `x`, of any magnitude.
fn unit<const N: usize>(x: Vec<N>) -> Vec<N> {
    let largest = x.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let x = x.map(|x| x / largest);
    let norm = dot(x, x).sqrt();
    x.map(|x| x / norm)
}

/// `a⁻¹·b` for a symmetric positive definite matrix, of which the lower triangle is read.
fn cholesky_solve<const N: usize>(mut a: [Vec<N>; N], mut b: Vec<N>) -> Vec<N> {
    // a = L·diag(d)·Lᵀ in place
    for j in 0..N {
        for i in j + 1..N {
            let factor = a[i][j] / a[j][j];
            for k in j + 1..=i {
                a[i][k] -= factor * a[k][j];
            }
        }
        for i in j + 1..N {
            a[i][j] /= a[j][j];
            b[i] -= a[i][j] * b[j];
        }
    }
    for j in (0..N).rev() {
        b[j] /= a[j][j];
        for i in j + 1..N {
            b[j] -= a[i][j] * b[i];
        }
    }
    b
}
