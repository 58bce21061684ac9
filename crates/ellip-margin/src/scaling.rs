//! The common scale at which two ellipsoids touch: symmetric, smooth, and telling how deep they overlap.
//!
//! Perram and Wertheim (1985): grown or shrunk together about their own centres, E₁ and E₂ touch at the scale α with
//! α² = max over t in [0, 1] of t(1 − t)·rᵀ[(1 − t)P⁻¹ + tQ⁻¹]⁻¹r. In the singular basis of the margin, with ν = (1 − t)/t,
//! the point of contact has the coordinates x̂ᵢ = ĉᵢ/(1 + νsᵢ), sᵢ = 1/σᵢ², its distance from x₂ in the norm of E₂ is
//! ‖x̂‖, from x₁ in the norm of E₁ ‖ŵ‖, ŵᵢ = νx̂ᵢ/σᵢ, and the derivative in t vanishes where the two agree:
//!
//! > Σ ĉᵢ²(ν²sᵢ − 1)/(1 + νsᵢ)² = 0.
//!
//! The left side changes sign once, between the least and the greatest σᵢ; ln(‖ŵ‖/‖x̂‖) grows with ln ν, at a rate
//! between 0 and 2, and Newton's method on it, kept within the bracket, ends in a few steps.

use convex_support::{Ellipsoid, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::pair::{Pair, Vec, add, combine, dot, store};
use crate::svd::{Svd, svd};
use crate::{MarginOptions, Status};

/// The common scale at which two ellipsoids touch; see [`scaling`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct Scaling<V: Vector> {
    /// α ≥ 0: scaled by it about their centres, the bodies just touch. Above 1 they are disjoint, below 1 they overlap, 0
    /// is concentric.
    pub scale: V::Scalar,
    /// Where they touch then.
    pub point: V,
    /// The unit normal of the common tangent plane there, from E₁ to E₂; zero for concentric bodies.
    pub normal: V,
    /// The signed separation of the bodies along `normal`: at most the distance where they are disjoint; minus a
    /// length by which moving one along `normal` separates them where they overlap.
    pub separation: V::Scalar,
    /// How the iteration ended.
    pub status: Status,
    /// The steps it took.
    pub iterations: usize,
}

/// The scale α about their own centres at which `e1` and `e2` touch (Perram and Wertheim's contact function is α²).
///
/// α − 1 has the sign of the margin, and is smooth and informative where the margin has reached its floor of −1; it
/// is symmetric in the two.
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
    if V::DIM == 2 { scaling_in::<V, 2>(e1, e2, options) } else { scaling_in::<V, 3>(e1, e2, options) }
}

fn scaling_in<V: Vector, const N: usize>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, options: MarginOptions) -> Scaling<V> {
    let pair = Pair::<N>::new(e1, e2);
    let (c, g) = pair.c_and_g();
    let norm_c = dot(c, c).sqrt();
    if norm_c == 0.0 {
        let scale = V::Scalar::ZERO;
        let separation = V::Scalar::from_f64(-(least(pair.a1) + least(pair.a2)));
        return Scaling {
            scale,
            point: e2.center(),
            normal: V::ZERO,
            separation,
            status: Status::Converged,
            iterations: 0,
        };
    }
    let Svd { sigma, u, v } = svd(pair.b());
    let norm_g = dot(g, g).sqrt();
    let ball: Vec<N> =
        core::array::from_fn(|i| if norm_g < sigma[i] * norm_c { dot(u[i], g) / sigma[i] } else { dot(v[i], c) });

    let largest = sigma.iter().fold(0.0f64, |m, s| m.max(*s));
    let (mut low, mut high) = (least(sigma), largest);
    // Exact for round bodies.
    let mut nu = (low.sqrt() * high.sqrt()).max(low).min(high);
    let (mut status, mut iterations) = (Status::IterationLimit, 0);
    let (mut x, mut w) = ([0.0; N], [0.0; N]);
    loop {
        let (mut xx, mut ww, mut slope_x, mut slope_w) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..N {
            // νsᵢ without squares that leave the range
            let k = (nu / sigma[i]) / sigma[i];
            let denominator = 1.0 + k;
            x[i] = ball[i] / denominator;
            w[i] = (nu / sigma[i]) * x[i];
            xx += x[i] * x[i];
            ww += w[i] * w[i];
            // d ln/d ln ν of x̂ᵢ is −k/(1 + k), of ŵᵢ 1/(1 + k)
            slope_x += x[i] * x[i] * (k / denominator);
            slope_w += w[i] * w[i] / denominator;
        }
        let difference = 0.5 * (ww / xx).ln();
        if status == Status::Converged || iterations == options.max_iterations {
            break;
        }
        iterations += 1;
        if difference < 0.0 {
            low = nu;
        } else {
            high = nu;
        }
        let newton = nu * (-difference / (slope_w / ww + slope_x / xx)).exp();
        let next = if newton > low && newton < high { newton } else { low.sqrt() * high.sqrt() };
        let next = if next.is_finite() { next } else { nu };
        let change = ((next - nu) / next).abs();
        nu = next;
        if change * change <= options.tolerance || high <= low * (1.0 + 2.0 * f64::EPSILON) {
            status = Status::Converged; // after one more evaluation
        }
    }

    // α² = t(1 − t)rᵀ[…]⁻¹r = ν/(1 + ν)·Σ ĉᵢx̂ᵢ, stationary in ν.
    let scale = (nu / (1.0 + nu) * dot(ball, x)).sqrt();
    let status = if scale.is_finite() { status } else { Status::Stalled };
    let y = combine(v, x);
    let z = combine(pair.axes2, core::array::from_fn(|j| -y[j] / pair.a2[j]));
    let norm = dot(z, z).sqrt();
    let n = z.map(|z| z / norm);
    let height = |axes: &[Vec<N>; N], a: Vec<N>| {
        let u: Vec<N> = core::array::from_fn(|k| a[k] * dot(axes[k], n));
        dot(u, u).sqrt()
    };
    let heights = height(&pair.axes1, pair.a1) + height(&pair.axes2, pair.a2);
    Scaling {
        scale: V::Scalar::from_f64(scale),
        point: store(add(pair.x2, pair.out_of_ball(y))),
        normal: store(n),
        separation: V::Scalar::from_f64((scale - 1.0) * heights),
        status,
        iterations,
    }
}

fn least<const N: usize>(a: Vec<N>) -> f64 {
    a.iter().fold(a[0], |m, x| m.min(*x))
}
