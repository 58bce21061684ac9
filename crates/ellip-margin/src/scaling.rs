//! The common scale at which two ellipsoids touch: symmetric, smooth, and a measure of their overlap.
//!
//! Perram and Wertheim (1985): grown or shrunk together about their own centres, E₁ and E₂ touch at the scale α with
//! α² = max over t in [0, 1] of t(1 − t)·rᵀ[(1 − t)P⁻¹ + tQ⁻¹]⁻¹r. In the singular basis of the margin, with ν = (1 −
//! t)/t, the point of contact has the coordinates x̂ᵢ = ĉᵢ/(1 + νsᵢ), sᵢ = 1/σᵢ², its distance from x₂ in the norm of
//! E₂ is ‖x̂‖, from x₁ in the norm of E₁ ‖ŵ‖, ŵᵢ = νx̂ᵢ/σᵢ, and the derivative in t vanishes where the two agree:
//!
//! > Σ ĉᵢ²(ν²sᵢ − 1)/(1 + νsᵢ)² = 0.
//!
//! The left side changes sign once, between the least and the greatest σᵢ; ln(‖ŵ‖/‖x̂‖) grows with ln ν, at a rate
//! between 0 and 2, and Newton's method on it, kept within the bracket, ends in a few steps.

use convex_support::numerics::elementary::{exp, ln, sqrt};
use convex_support::{Ellipsoid, Scalar, Vector};

use crate::numerics::{Svd, Vec, add, combine, dot, power_of_two_near, size, store, svd, unit};
use crate::pair::Pair;
use crate::{MarginOptions, Status};

/// The common scale at which two ellipsoids touch; see [`scaling`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Scaling<V: Vector> {
    /// The scale α ≥ 0: if both bodies are scaled by it about their centres, they just touch. If it is above 1 they are
    /// disjoint, below 1 they overlap, and it is 0 if they are concentric.
    pub scale: V::Scalar,
    /// The point of contact then.
    pub point: V,
    /// The unit normal of the common tangent plane there, from E₁ to E₂. Zero for concentric bodies, since it jumps
    /// where the centres meet.
    pub normal: V,
    /// (α − 1)(a₁ + a₂) with the least semi-axis of each: a length that is negative where the bodies overlap,
    /// continuous and as smooth as α. It is exact for balls. For others its magnitude is a lower bound, where they are
    /// disjoint of their distance, and where they overlap of the depth: no shorter translation of one separates them.
    pub separation: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The steps it took.
    pub iterations: usize,
    /// The point of contact in the frame of each body, as unit vectors of the balls they are images of, that of E₂ with
    /// the opposite sign; zero for concentric bodies. Kept because derivatives from `point` or `normal` would lose
    /// digits.
    pub(crate) ball_points: [V; 2],
}

/// The scale α about their own centres at which `e1` and `e2` touch (Perram and Wertheim's contact function is α²).
///
/// α − 1 has the sign of the margin and is symmetric in the two. It is smooth, and has a slope at any depth, also where
/// the margin has reached its floor of −1. [`EllipsoidPair::scaling`](crate::EllipsoidPair::scaling) has its
/// derivatives.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{MarginOptions, free_margin, scaling};
///
/// // Balls of radius 2 and 1, their centres 0.6 apart: one deep inside the other.
/// let e1 = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
/// let e2 = Ellipsoid::new(DVec3::new(0.6, 0.0, 0.0), DVec3::ONE, Default::default())?;
/// assert_eq!(free_margin(&e1, &e2, MarginOptions::default()).margin, -1.0);
/// let contact = scaling(&e1, &e2, MarginOptions::default());
/// assert!((contact.scale - 0.2).abs() < 1e-15);
/// assert!((contact.separation + 2.4).abs() < 1e-14); // 0.6 − 2 − 1
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn scaling<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Scaling<V> {
    in_dimension!(scaling_in::<V>(e1, e2, options))
}

fn scaling_in<V: Vector, const N: usize>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Scaling<V> {
    let pair = Pair::<N>::new(e1, e2);
    let (c, g) = pair.c_and_g();
    // α is proportional to r. If the centres nearly coincide, squares of c would leave the range.
    let unit_of_r = power_of_two_near(size(c).max(size(g)));
    let (c, g) = (c.map(|x| x / unit_of_r), g.map(|x| x / unit_of_r));
    let least = |a: Vec<N>| a.iter().fold(a[0], |m, x| m.min(*x));
    let apart = |scale: f64| V::Scalar::from_f64((scale - 1.0) * (least(pair.a1) + least(pair.a2)));
    if dot(c, c) == 0.0 {
        return Scaling {
            scale: V::Scalar::ZERO,
            point: e2.center(),
            normal: V::ZERO,
            separation: apart(0.0),
            status: Status::Converged,
            iterations: 0,
            ball_points: [V::ZERO; 2],
        };
    }
    let basis = svd(pair.b());
    let (Svd { sigma, u, v }, ball) = (basis, basis.coordinates(c, g));
    let Root { nu, x, status, iterations } = root(sigma, ball, options);
    // α² = t(1 − t)rᵀ[…]⁻¹r = ν/(1 + ν)·Σ ĉᵢx̂ᵢ, stationary in ν.
    let scale = sqrt(nu / (1.0 + nu) * dot(ball, x)) * unit_of_r;
    let y = combine(v, x.map(|x| x * unit_of_r));
    // x* − x₁ = R₁·diag(a₁)Uŵ with the sign that Pw = −νQv has.
    let (e1, e2) = (unit(combine(u, core::array::from_fn(|i| -x[i] / sigma[i]))), unit(y.map(|y| -y)));
    let normal = unit(combine(pair.axes2, core::array::from_fn(|j| e2[j] / pair.a2[j])));
    Scaling {
        scale: V::Scalar::from_f64(scale),
        point: store(add(pair.x2, pair.out_of_ball(y))),
        normal: store(normal),
        separation: apart(scale),
        status: if scale.is_finite() { status } else { Status::Stalled },
        iterations,
        ball_points: [store(e1), store(e2)],
    }
}

/// ν with its x̂, and how it was found.
struct Root<const N: usize> {
    nu: f64,
    x: Vec<N>,
    status: Status,
    iterations: usize,
}

/// Solves ‖ŵ‖ = ‖x̂‖ for the singular values σ and ĉ.
fn root<const N: usize>(sigma: Vec<N>, ball: Vec<N>, options: MarginOptions) -> Root<N> {
    let (mut low, mut high) = sigma.iter().fold((sigma[0], sigma[0]), |(low, high), s| (low.min(*s), high.max(*s)));
    // Exact for round bodies.
    let mut nu = (sqrt(low) * sqrt(high)).max(low).min(high);
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    loop {
        let mut x = [0.0; N];
        let (mut xx, mut ww, mut slope_x, mut slope_w) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..N {
            // νsᵢ without squares that leave the range
            let k = (nu / sigma[i]) / sigma[i];
            let denominator = 1.0 + k;
            x[i] = ball[i] / denominator;
            let w = (nu / sigma[i]) * x[i];
            xx += x[i] * x[i];
            ww += w * w;
            // d ln/d ln ν of x̂ᵢ is −k/(1 + k), of ŵᵢ 1/(1 + k)
            slope_x += x[i] * x[i] * (k / denominator);
            slope_w += w * w / denominator;
        }
        let difference = 0.5 * ln(ww / xx);
        if status == Status::Converged || iterations == options.max_iterations {
            return Root { nu, x, status, iterations };
        }
        iterations += 1;
        // An exact root is an end of the bracket.
        if difference < 0.0 {
            low = nu;
        } else {
            high = nu;
        }
        let newton = nu * exp(-difference / (slope_w / ww + slope_x / xx));
        let next = if newton >= low && newton <= high { newton } else { sqrt(low) * sqrt(high) };
        let next = if next.is_finite() { next } else { nu };
        let change = ((next - nu) / next).abs();
        nu = next;
        if change * change <= options.tolerance() || high <= low * (1.0 + 2.0 * f64::EPSILON) {
            status = Status::Converged; // after one more evaluation
        }
    }
}
