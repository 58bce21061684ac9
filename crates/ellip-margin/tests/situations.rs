//! Situations in which users of other libraries got wrong answers, and those the theory names as hard.

use crate::common::{close, ellipsoid2, ellipsoid3};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Vec3};
use convex_support::{Ellipsoid, Vector};
use ellip_margin::{EllipsoidPair, MarginOptions, Method, Status, distance, free_margin, scaling};
use proptest::prelude::*;

fn margin<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> V::Scalar {
    free_margin(e1, e2, MarginOptions::default()).margin
}

fn aligned(center: [f64; 3], a: [f64; 3]) -> Ellipsoid<DVec3> {
    Ellipsoid::new(DVec3::from_array(center), DVec3::from_array(a), DQuat::IDENTITY).expect("valid")
}

/// Geometric Tools' `IntrEllipsoid3Ellipsoid3` answers *separated* for both pairs: it divides by differences of
/// eigenvalues, and a spheroid has two that are equal.
#[test]
fn spheroids_that_overlap_are_not_separated() {
    let ball = aligned([0.0; 3], [1.0; 3]);
    for center in [[1.9, 0.0, 0.0], [0.5, 0.0, 2.9]] {
        let spheroid = aligned(center, [1.0, 2.0, 2.0]);
        assert!(margin(&ball, &spheroid) < 0.0, "overlapping at {center:?}");
        assert!(margin(&spheroid, &ball) < 0.0, "either way round");
    }
    assert!(margin(&ball, &aligned([2.1, 0.0, 0.0], [1.0, 2.0, 2.0])) > 0.0, "apart");
}

proptest! {
    #![proptest_config(convex_support::laws::config(2000))]

    /// Exact spheroids have double eigenvalues. The margin and the common scale are independent derivations.
    #[test]
    fn spheroids(p in -3.0..3.0f64, q in -3.0..3.0f64, a in 0.1..2.0f64, b in 0.1..2.0f64, c in 0.1..2.0f64, r in crate::common::rotation()) {
        let first = Ellipsoid::new(DVec3::new(p, 0.3, 0.0), DVec3::new(a, b, b), r).expect("valid");
        let second = Ellipsoid::new(DVec3::new(0.0, q, 1.0), DVec3::new(c, c, a), DQuat::IDENTITY).expect("valid");
        let m = free_margin(&first, &second, MarginOptions::default());
        let s = scaling(&first, &second, MarginOptions::default());
        prop_assert_eq!(m.status, Status::Converged);
        prop_assert_eq!(s.status, Status::Converged);
        prop_assume!((s.scale - 1.0).abs() > 1e-14);
        prop_assert_eq!(m.margin > 0.0, s.scale > 1.0, "margin {}, scale {}", m.margin, s.scale);
    }

    /// m(E₁, E₂) ≠ m(E₂, E₁), but the sign is the same; the scale is symmetric.
    #[test]
    fn swapped(e1 in ellipsoid3(3.0, 1.5), e2 in ellipsoid3(3.0, 1.5)) {
        let (there, back) = (margin(&e1, &e2), margin(&e2, &e1));
        prop_assert_eq!(there > 0.0, back > 0.0, "{} and {}", there, back);
        let (a, b) = (scaling(&e1, &e2, MarginOptions::default()), scaling(&e2, &e1, MarginOptions::default()));
        prop_assert!(close(a.scale, b.scale, 1e-12, 0.0), "{} and {}", a.scale, b.scale);
        prop_assert_eq!(there > 0.0, a.scale > 1.0, "{} and {}", there, a.scale);
    }

    /// Both routes to the equation agree, in both dimensions.
    #[test]
    fn polynomial_and_singular_basis(e1 in ellipsoid3(2.0, 2.0), e2 in ellipsoid3(2.0, 2.0), f1 in ellipsoid2(2.0, 2.0), f2 in ellipsoid2(2.0, 2.0)) {
        let exact = MarginOptions::default().with_method(Method::SingularBasis);
        let (a, b) = (free_margin(&e1, &e2, MarginOptions::default()), free_margin(&e1, &e2, exact));
        prop_assert!(close(1.0 + a.margin, 1.0 + b.margin, 1e-11, 0.0), "{} and {}", a.margin, b.margin);
        prop_assert!((a.point - b.point).length() < 1e-10, "{} and {}", a.point, b.point);
        let (a, b) = (free_margin(&f1, &f2, MarginOptions::default()), free_margin(&f1, &f2, exact));
        prop_assert!(close(1.0 + a.margin, 1.0 + b.margin, 1e-11, 0.0), "{} and {}", a.margin, b.margin);
        prop_assert!(close(a.nu, b.nu, 1e-10, 1e-300), "{} and {}", a.nu, b.nu);
    }

    /// x* lies on E₂, and x* − x₁ leaves E₂ along the normal in the norm of E₁, with axes in any order
    /// (lammps#3545, #3925: sorted axes, particles pass through).
    #[test]
    fn witness(e1 in ellipsoid3(2.0, 2.0), e2 in ellipsoid3(2.0, 2.0), turn in 0usize..3) {
        let cycle = |e: &Ellipsoid<DVec3>| {
            let (a, r) = (e.semi_axes(), e.axes());
            let at = |i: usize| (i + turn) % 3;
            let axes = DMat3::from_cols(r.col(at(0)), r.col(at(1)), r.col(at(2)));
            Ellipsoid::from_axes(e.center(), DVec3::new(a[at(0)], a[at(1)], a[at(2)]), axes).expect("valid")
        };
        let (c1, c2) = (cycle(&e1), cycle(&e2));
        let m = free_margin(&c1, &c2, MarginOptions::default());
        prop_assume!(m.nu > 0.0);
        let y = (c2.axes().transpose() * (m.point - c2.center())) / c2.semi_axes();
        prop_assert!((y.length() - 1.0).abs() < 1e-12, "on the surface of E₂: {}", y.length());
        let w = (c1.axes().transpose() * (m.point - c1.center())) / c1.semi_axes();
        prop_assert!(close(w.length_squared(), 1.0 + m.margin, 1e-10, 0.0));
        let (pw, z) = (c1.axes() * (w / c1.semi_axes()), c2.axes() * (y / c2.semi_axes()));
        prop_assert!((pw.normalize() + z.normalize()).length() < 1e-7, "normals are opposite: {} and {}", pw, z);
        prop_assert!(close(margin(&e1, &e2), m.margin, 1e-10, 1e-12), "the order of the axes does not matter");
    }
}

#[test]
fn spheres_in_closed_form() {
    for (d, r1, r2) in
        [(3.0, 1.0, 1.0), (10.0, 0.25, 4.0), (2.5, 2.0, 1.0), (1e6, 1.0, 3.0), (3.0, 1e-9, 1.0), (2e9, 1e9, 1.0)]
    {
        let a = aligned([0.6 * d, 0.8 * d, 0.0], [r1; 3]);
        let b = aligned([0.0; 3], [r2; 3]);
        let expected = if d > r2 { ((d - r2) / r1).powi(2) - 1.0 } else { -1.0 };
        assert!(close(margin(&a, &b), expected, 1e-13, 0.0), "{d} {r1} {r2}: {}", margin(&a, &b));
    }
}

#[test]
fn concentric_identical_and_contained() {
    let e = aligned([1.0, 2.0, 3.0], [3.0, 1.0, 0.5]);
    let m = free_margin(&e, &e, MarginOptions::default());
    assert_eq!((m.margin, m.nu, m.point), (-1.0, 0.0, e.center()), "identical");
    assert_eq!(scaling(&e, &e, MarginOptions::default()).scale, 0.0, "concentric");
    let small = aligned([1.1, 2.0, 3.0], [0.1; 3]);
    assert_eq!(margin(&small, &e), -1.0, "its centre is in the other");
    let beside = aligned([3.0, 2.0, 3.0], [0.1; 3]);
    assert!((-1.0..0.0).contains(&margin(&e, &beside)), "contained, the larger one's centre outside the smaller");
    assert!(scaling(&e, &beside, MarginOptions::default()).scale < 1.0, "overlapping");
}

/// x₁ exactly on the boundary of E₂: m = −1, and one ulp outside it is not quite.
#[test]
fn centre_on_the_boundary() {
    let e2 = aligned([0.0; 3], [2.0, 1.0, 1.0]);
    let at = |x: f64| free_margin(&aligned([x, 0.0, 0.0], [1.0, 0.5, 0.25]), &e2, MarginOptions::default());
    assert_eq!((at(2.0).margin, at(2.0).nu), (-1.0, 0.0), "on the boundary");
    let outside = at(2f64.next_up());
    assert!(outside.nu > 0.0, "one ulp outside");
    // To first order ν = g₀/2·q⁻¹ with g₀ = 2δ, δ = ε, q = Σc²s = (a₁/a₂)²: ν = ε·4.
    assert!(close(outside.nu, 4.0 * f64::EPSILON, 1e-12, 0.0), "{}", outside.nu);
}

/// Kissing contact, and an ulp to either side of it: the sign is that of exact arithmetic (fcl#495; python-fcl#36).
#[test]
fn kissing_contact() {
    for scale in [1.0, 1e-9, 1e9] {
        let e1 = aligned([0.0; 3], [2.0 * scale, 0.5 * scale, scale]);
        let at = |x: f64| margin(&e1, &aligned([x, 0.0, 0.0], [scale, 0.25 * scale, 3.0 * scale]));
        let contact = 2.0 * scale + scale;
        // 2s + s is not rounded for these s, or rounds to the nearest: the exact sign is that of x − 3s.
        let exact = |x: f64| (x - 2.0 * scale) - scale;
        for x in [contact.next_down(), contact, contact.next_up()] {
            let sign = |v: f64| if v == 0.0 { 0.0 } else { v.signum() };
            assert_eq!(sign(at(x)), sign(exact(x)), "at {x:e}: {:e}", at(x));
        }
    }
}

#[test]
fn needle_and_plate() {
    // A plate of aspect 1e6 and a needle of aspect 1e6 standing on it, a hair's breadth apart or overlapping.
    let plate = aligned([0.0; 3], [1.0, 1.0, 1e-6]);
    for (gap, sign) in [(1e-9, 1.0), (-1e-9, -1.0)] {
        let needle = aligned([0.0, 0.0, 1.0 + 1e-6 + gap], [1e-6, 1e-6, 1.0]);
        assert_eq!(margin(&plate, &needle).signum(), sign, "gap {gap:e}");
        assert_eq!(margin(&needle, &plate).signum(), sign, "gap {gap:e}, swapped");
    }
    // Beside the needle, symmetric: ĉ₁ = 0.
    let needle = aligned([2e-6, 0.0, 0.0], [1e-6, 1e-6, 1.0]);
    let other = aligned([-2e-6, 0.0, 0.0], [1e-6, 1.0, 1e-6]);
    assert!(close(margin(&needle, &other), 8.0, 1e-10, 0.0), "{}", margin(&needle, &other)); // (4 − 1)² − 1
}

/// The "hard case" of trust regions, b̄₁ = 0 with λ* at the least eigenvalue (Optim.jl#540, #1270; scipy#20244), needs
/// x₁ inside E₂; outside, b̄₁ = 0 is harmless.
#[test]
fn hard_case_of_trust_regions() {
    let e2 = aligned([0.0; 3], [1.0; 3]);
    let inside = aligned([0.0, 0.5, 0.0], [4.0, 1.0, 1.0]);
    assert_eq!(margin(&inside, &e2), -1.0, "x₁ inside");
    let outside = free_margin(&aligned([0.0, 3.0, 0.0], [4.0, 1.0, 1.0]), &e2, MarginOptions::default());
    assert!(close(outside.margin, 3.0, 1e-14, 0.0) && outside.point.abs_diff_eq(DVec3::Y, 1e-14), "{outside:?}");
}

/// Absolute thresholds fail in single precision and off unit scale (Optim.jl#1280, #1266).
#[test]
fn every_scale_in_single_precision() {
    for s in [1e-18f32, 1e-9, 1.0, 1e9, 1e18] {
        let e1 = Ellipsoid::new(Vec3::ZERO, Vec3::new(1.0, 0.1, 0.01) * s, Default::default()).expect("valid");
        let e2 = Ellipsoid::new(Vec3::new(3.0, 0.0, 0.0) * s, Vec3::splat(s), Default::default()).expect("valid");
        let m = free_margin(&e1, &e2, MarginOptions::default());
        assert!((m.margin - 3.0).abs() < 1e-6 && m.status == Status::Converged, "{s}: {m:?}");
    }
}

/// Near pairs at small tolerance (coal#604), near contact without convergence (coal#37): the bracket holds the exact
/// value.
#[test]
fn distance_near_contact() {
    for gap in [1e-3, 1e-6, 1e-9, 1e-12] {
        let (a, b) = (aligned([0.0; 3], [2.0, 1.0, 0.5]), aligned([3.0 + gap, 0.0, 0.0], [1.0, 0.5, 4.0]));
        let d = distance(&a, &b, MarginOptions::default());
        let exact = (3.0 + gap) - 3.0;
        assert!(close(d.distance, exact, 1e-12, 0.0), "{} for {exact}", d.distance);
        assert!(d.bracket.lower <= exact && exact <= d.bracket.upper, "{:?} holds {exact}", d.bracket);
        assert!(d.bracket.upper - d.bracket.lower <= 1e-12 * exact, "{:?}", d.bracket);
    }
}

/// As m → −1 the gradient goes to zero, and inside it is zero; the Hessian jumps there, from a definite matrix.
#[test]
fn gradient_towards_the_floor() {
    let e2 = aligned([0.0; 3], [2.0, 1.0, 1.0]);
    let mut last = f64::INFINITY;
    for k in 1..50 {
        let e1 = aligned([2.0 + 0.5f64.powi(k), 0.0, 0.0], [1.0, 0.5, 0.25]);
        let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
        let g = m.gradient().translation.length();
        assert!(close(g, 2.0 * 0.5f64.powi(k), 1e-9, 0.0) && g < last, "(x − 2)² has the slope 2(x − 2): {g}");
        assert!(close(m.hessian().entry(0, 0), 2.0, 1e-9, 0.0), "and the curvature 2");
        last = g;
    }
    let e1 = aligned([1.5, 0.0, 0.0], [1.0, 0.5, 0.25]);
    let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
    assert_eq!(m.gradient().translation, DVec3::ZERO, "inside");
    assert_eq!(m.hessian().matrix::<3>(), [[0.0; 3]; 3], "inside");
}

/// No finite numbers panic, hang, or come out as a converged NaN.
#[test]
fn the_ends_of_the_range() {
    let sizes = [5e-324, 1e-300, 1e-160, 1e-100, 1.0, 1e100, 1e160, 1e300, f64::MAX];
    for a in sizes {
        for b in sizes {
            for d in sizes {
                let e1 = Ellipsoid::new(DVec2::ZERO, DVec2::new(a, b), 0.3).expect("valid");
                let e2 = Ellipsoid::new(DVec2::new(d, -0.3 * d), DVec2::new(b, a), 1.0).expect("valid");
                let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
                assert!(m.status != Status::Converged || !m.margin.is_nan(), "{a} {b} {d}: {m:?}");
                let _ = (distance(&e1, &e2, MarginOptions::default()), scaling(&e1, &e2, MarginOptions::default()));
                let pair = EllipsoidPair::new(&e1, &e2, MarginOptions::default());
                let _ = (m.gradient(), m.hessian(), pair.distance().hessian(), pair.scaling().hessian());
            }
        }
    }
}

/// E₁ is a needle thinner than the rounding of E₂'s points: of the point where they touch, as rounded, E₁'s norm is off
/// by a hundredth, and the margin was off by the square of that, 6.5e-5, though the Lagrangian was evaluated in twice
/// the precision. The truth is of 60 digits.
#[test]
fn a_needle_thinner_than_rounding_has_all_digits_of_its_margin() {
    let rotation = DQuat::from_xyzw(0.7860294979486924, -0.8007517954872019, -0.6256291211727534, 0.4461618344665423);
    let axes = DVec3::new(4.587712236025963e-14, 7.876739738682144e-11, 9.5367431640625e-07);
    let needle = Ellipsoid::new(DVec3::ZERO, axes, rotation).expect("valid");
    let center = DVec3::new(0.29313459242586126, 0.4205549616292588, 0.8041773897445733);
    let ball = Ellipsoid::new(center, DVec3::splat(0.95367431640625), DQuat::IDENTITY).expect("valid");
    let m = margin(&needle, &ball);
    assert!((m - -3.880_660_181_822_573_3e-6).abs() < 1e-9, "{m:e}");
    // Touching balls know their margin by a formula.
    for thickness in [1e-6, 1e-9, 1e-12, 1e-15] {
        let plate = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.5, thickness), rotation).expect("valid");
        let normal = rotation.normalize() * DVec3::X;
        let ball = Ellipsoid::new(normal * 2.5, DVec3::splat(1.0), DQuat::IDENTITY).expect("valid");
        // The plate's tip is as far from its middle as it is long.
        let m = margin(&plate, &ball);
        assert!((m - 1.25).abs() < 1e-12, "{thickness:e}: {m}");
    }
}
