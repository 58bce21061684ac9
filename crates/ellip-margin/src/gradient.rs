//! How the margin changes with the bodies, in closed form.
//!
//! With w = x* − x₁, v = x* − x₂ and z = Qv, stationarity says Pw = −νz, and since the minimiser moves to second order
//! only, the margin changes as (x* − x₁)ᵀP(x* − x₁) + ν((x* − x₂)ᵀQ(x* − x₂) − 1) does with x* and ν held:
//!
//! - ∂m/∂x₁ = −2Pw = 2νz =: F, ∂m/∂x₂ = −F;
//! - a turn δω of E₁ about p moves E₁ under a fixed x*: ∂m/∂ω = (x* − p) ∧ F. F at x* is a wrench. For E₂, its opposite;
//! - ∂m/∂P = wwᵀ, ∂m/∂Q = νvvᵀ; along semi-axis k, direction e: ∂m/∂a₁ₖ = −2(e·w)²/a₁ₖ³, ∂m/∂a₂ₖ = −2ν(e·v)²/a₂ₖ³.
//!
//! In the code w and v are kept as each body sees them, w = R₁·diag(a₁)β and v = R₂·diag(a₂)y. Torques about the own centre are products in body axes, where nothing cancels:
//! w ∧ F = Σ wᵢFⱼ eᵢ∧eⱼ with wᵢ = a₁ᵢβᵢ and Fⱼ = −2βⱼ/a₁ⱼ, hence −2βᵢβⱼ(a₁ᵢ/a₁ⱼ − a₁ⱼ/a₁ᵢ) for each plane i < j. It is
//! zero in a plane where the body is round, to the last bit.

use convex_support::{Ellipsoid, Matrix, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::pair::{Pair, combine, dot, load, load_columns, store, sub};
use crate::{Margin, Wedge};

/// The gradient of the margin with respect to the motion of one of the two ellipsoids: a force at a point.
///
/// Where x₁ lies in E₂ it is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct MarginGradient<V: Wedge> {
    /// The change of the margin per translation of the body: ∂m/∂x, in world axes.
    pub translation: V,
    /// The change of the margin per rotation ω of the body about its own centre, in world axes: ∂m/∂ω; one number in
    /// 2D, counter-clockwise.
    pub rotation: V::Bivector,
    /// The centre of the body.
    pub center: V,
}

impl<V: Wedge> MarginGradient<V> {
    /// The change of the margin per rotation ω of the body about `pivot`, which carries its centre along.
    #[must_use]
    pub fn rotation_about(&self, pivot: V) -> V::Bivector {
        let carried = (self.center - pivot).wedge(self.translation);
        V::bivector(|i| V::coordinates(&self.rotation)[i] + V::coordinates(&carried)[i])
    }

    /// The change of the margin per radian of a revolute joint through `pivot` about the unit `axis` (in 2D: 1 for
    /// counter-clockwise), with the body downstream of it: one entry of ∂m/∂q.
    #[must_use]
    pub fn revolute(&self, pivot: V, axis: V::Bivector) -> V::Scalar {
        V::bivector_dot(self.rotation_about(pivot), axis)
    }

    /// The change of the margin per length of a prismatic joint along the unit `axis`, with the body downstream of it.
    #[must_use]
    pub fn prismatic(&self, axis: V) -> V::Scalar {
        self.translation.dot(axis)
    }
}

/// The gradient of the margin with respect to the sizes of both ellipsoids.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct ShapeGradient<V: Vector> {
    /// ∂m/∂a₁: per length of each semi-axis of E₁; never positive.
    pub semi_axes1: V,
    /// ∂m/∂a₂: per length of each semi-axis of E₂; never positive.
    pub semi_axes2: V,
    /// ∂m/∂P = wwᵀ, as a symmetric matrix G: dm = tr(G·dP).
    pub matrix1: V::Matrix,
    /// ∂m/∂Q = νvvᵀ, as a symmetric matrix G: dm = tr(G·dQ).
    pub matrix2: V::Matrix,
}

/// β = diag(a₁)⁻¹R₁ᵀ(x* − x₁), x* − x₁ as E₁ sees it, and z = Q(x* − x₂).
#[inline]
fn contact<V: Vector, const N: usize>(m: &Margin<V>, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> ([f64; N], [f64; N]) {
    let pair = Pair::<N>::new(e1, e2);
    let y: [f64; N] = load(m.ball_point);
    let nu = m.nu.as_f64();
    let z = combine(pair.axes2, core::array::from_fn(|j| y[j] / pair.a2[j]));
    let (r, v) = (pair.r(), pair.out_of_ball(y));
    // βᵢ = −ν·a₁ᵢ·eᵢ·z = eᵢ·(v − r)/a₁ᵢ; the sums have errors of about ν·a₁ᵢ‖z‖ε and (‖v‖ + ‖r‖)ε/a₁ᵢ.
    let (norm_z, norm_w) = (nu * dot(z, z).sqrt(), dot(v, v).sqrt() + dot(r, r).sqrt());
    let beta = core::array::from_fn(|i| {
        let a = pair.a1[i];
        if a * a * norm_z < norm_w { -nu * a * dot(pair.axes1[i], z) } else { dot(pair.axes1[i], sub(v, r)) / a }
    });
    (beta, z)
}

impl<V: Wedge> Margin<V> {
    /// The gradient with respect to the motion of `e1`. `e1` and `e2` must be the ellipsoids of this margin.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{MarginOptions, free_margin};
    ///
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let m = free_margin(&link, &obstacle, MarginOptions::default());
    /// let gradient = m.gradient(&link, &obstacle);
    /// // m = ((6 − x)/2 − ½)² − 1 for the link at (x, 0, 0).
    /// assert_eq!(gradient.translation, DVec3::new(-2.5, 0.0, 0.0));
    /// // A joint at (0, −3, 0) about z swings the link towards −x for positive angles … by 3 per radian.
    /// assert_eq!(gradient.revolute(DVec3::new(0.0, -3.0, 0.0), DVec3::Z), 7.5);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[inline]
    pub fn gradient(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> MarginGradient<V> {
        if V::DIM == 2 { self.gradient_in::<2>(e1, e2) } else { self.gradient_in::<3>(e1, e2) }
    }

    #[inline]
    fn gradient_in<const N: usize>(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> MarginGradient<V> {
        let (beta, z) = contact::<V, N>(self, e1, e2);
        MarginGradient {
            translation: store(z.map(|z| 2.0 * self.nu.as_f64() * z)),
            rotation: torque(e1, beta, -2.0),
            center: e1.center(),
        }
    }

    /// The gradient with respect to the motion of `e2`. `e1` and `e2` must be the ellipsoids of this margin.
    #[inline]
    pub fn gradient_of_second(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> MarginGradient<V> {
        if V::DIM == 2 { self.gradient_of_second_in::<2>(e1, e2) } else { self.gradient_of_second_in::<3>(e1, e2) }
    }

    #[inline]
    fn gradient_of_second_in<const N: usize>(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> MarginGradient<V> {
        let (_, z) = contact::<V, N>(self, e1, e2);
        let nu = self.nu.as_f64();
        MarginGradient {
            translation: store(z.map(|z| -2.0 * nu * z)),
            rotation: torque(e2, load::<V, N>(self.ball_point), -2.0 * nu),
            center: e2.center(),
        }
    }
}

impl<V: Vector> Margin<V> {
    /// The gradient with respect to the sizes of both. `e1` and `e2` must be the ellipsoids of this margin.
    pub fn shape_gradient(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> ShapeGradient<V> {
        if V::DIM == 2 { self.shape_gradient_in::<2>(e1, e2) } else { self.shape_gradient_in::<3>(e1, e2) }
    }

    fn shape_gradient_in<const N: usize>(&self, e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> ShapeGradient<V> {
        let (beta, _) = contact::<V, N>(self, e1, e2);
        let (a1, a2): ([f64; N], [f64; N]) = (load(e1.semi_axes()), load(e2.semi_axes()));
        let y: [f64; N] = load(self.ball_point);
        let nu = self.nu.as_f64();
        let w: [f64; N] = combine(load_columns(e1.axes()), core::array::from_fn(|i| a1[i] * beta[i]));
        let v: [f64; N] = combine(load_columns(e2.axes()), core::array::from_fn(|j| a2[j] * y[j]));
        let outer = |x: [f64; N], factor: f64| {
            V::Matrix::from_cols_fn(|j| V::from_fn(|i| V::Scalar::from_f64(factor * (x[i] * x[j]))))
        };
        // (e·w)/a₁ₖ = βₖ, (e·v)/a₂ₖ = yₖ
        ShapeGradient {
            semi_axes1: store::<V, N>(core::array::from_fn(|k| -2.0 * beta[k] * beta[k] / a1[k])),
            semi_axes2: store::<V, N>(core::array::from_fn(|k| -2.0 * nu * y[k] * y[k] / a2[k])),
            matrix1: outer(w, 1.0),
            matrix2: outer(v, nu),
        }
    }
}

/// `factor`·Σ uᵢuⱼ(aᵢ/aⱼ − aⱼ/aᵢ) eᵢ∧eⱼ over the planes i < j of the axes of `body`.
#[inline]
fn torque<V: Wedge, const N: usize>(body: &Ellipsoid<V>, u: [f64; N], factor: f64) -> V::Bivector {
    let (axes, a): ([[f64; N]; N], [f64; N]) = (load_columns(body.axes()), load(body.semi_axes()));
    let mut sum = [0.0; 3];
    for i in 0..N {
        for j in i + 1..N {
            let size = factor * u[i] * u[j] * ((a[i] - a[j]) / a[i] * ((a[i] + a[j]) / a[j]));
            for (k, sum) in sum.iter_mut().enumerate() {
                let (p, q) = if N == 2 { (0, 1) } else { ((k + 1) % 3, (k + 2) % 3) };
                *sum += size * (axes[i][p] * axes[j][q] - axes[i][q] * axes[j][p]);
            }
        }
    }
    V::bivector(|k| V::Scalar::from_f64(sum[k]))
}
