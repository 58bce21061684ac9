//! What must not change the answer, to the last bit where that can be asked.

use crate::common::{close, ellipsoid2, ellipsoid3, rotation, within};
use convex_support::glam::{DMat3, DVec3, Vec3, Vec3A};
use convex_support::{Ellipsoid, Matrix, Scalar, Vector};
use ellip_margin::{
    Clearance, EllipsoidPair, MarginOptions, MarginTracker, distance, distance_bracket, free_margin, scaling,
};
use proptest::prelude::*;

/// All lengths times `s`.
fn scaled<V: Vector>(e: &Ellipsoid<V>, s: V::Scalar) -> Ellipsoid<V> {
    Ellipsoid::from_axes(e.center() * s, e.semi_axes() * s, e.axes()).expect("in range")
}

fn assert_scale_free<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>, s: f64) {
    let (o, k) = (MarginOptions::default(), V::Scalar::from_f64(s));
    let (a, b) = (free_margin(e1, e2, o), free_margin(&scaled(e1, k), &scaled(e2, k), o));
    assert_eq!((a.margin, a.nu, a.iterations), (b.margin, b.nu, b.iterations), "scaled by {s}");
    assert_eq!(a.point * k, b.point, "scaled by {s}");
    let (a, b) = (distance(e1, e2, o), distance(&scaled(e1, k), &scaled(e2, k), o));
    assert_eq!(a.distance * k, b.distance, "scaled by {s}");
    assert_eq!(a.bracket.lower * k, b.bracket.lower, "scaled by {s}");
    assert_eq!(a.bracket.upper * k, b.bracket.upper, "scaled by {s}");
    assert_eq!((a.bracket.normal, a.status, a.iterations), (b.bracket.normal, b.status, b.iterations), "scaled by {s}");
    let (a, b) = (distance_bracket(e1, e2, o), distance_bracket(&scaled(e1, k), &scaled(e2, k), o));
    assert_eq!((a.lower * k, a.upper * k, a.normal), (b.lower, b.upper, b.normal), "scaled by {s}");
    let (a, b) = (scaling(e1, e2, o), scaling(&scaled(e1, k), &scaled(e2, k), o));
    assert_eq!((a.scale, a.normal, a.separation * k), (b.scale, b.normal, b.separation), "scaled by {s}");
    assert_eq!((a.point * k, a.status, a.iterations), (b.point, b.status, b.iterations), "scaled by {s}");
    let all = |k| [*e1, *e2, between(e1, e2)].map(|e| scaled(&e, k));
    let tracked = |[e1, e2, e3]: [Ellipsoid<V>; 3]| {
        let mut track = MarginTracker::default();
        [track.step(&e1, &e2), track.step(&e3, &e2), track.step(&e3, &e1)]
    };
    let stepped = |[e1, e2, e3]: [Ellipsoid<V>; 3]| {
        let mut scene = Clearance::new(&[e2, e3], o).expect("two");
        [[e1], [e3], [e2]].map(|link| scene.step(&link).expect("one"))
    };
    for (a, b) in tracked(all(V::Scalar::ONE)).into_iter().zip(tracked(all(k))) {
        assert_eq!((a.margin, a.nu, a.point * k, a.iterations), (b.margin, b.nu, b.point, b.iterations), "by {s}");
    }
    for (a, b) in stepped(all(V::Scalar::ONE)).into_iter().zip(stepped(all(k))) {
        assert_eq!((a.margin.margin, a.margin.point * k), (b.margin.margin, b.margin.point), "scaled by {s}");
        // Squares that are no numbers leave a pair out by another of the means, or none.
        let in_range = s.log2().abs() <= 250.0;
        assert!(a.obstacle == b.obstacle && (!in_range || a.left_out == b.left_out), "scaled by {s}");
    }
}

/// The first body halfway to the second.
fn between<V: Vector>(e1: &Ellipsoid<V>, e2: &Ellipsoid<V>) -> Ellipsoid<V> {
    let center = (e1.center() + e2.center()) * V::Scalar::from_f64(0.5);
    Ellipsoid::from_axes(center, e1.semi_axes(), e1.axes()).expect("in range")
}

/// The same body in single precision.
fn single(e: &Ellipsoid<DVec3>) -> Ellipsoid<Vec3> {
    let axes = Matrix::from_cols_fn(|j| Vector::from_fn(|i| e.axes().col(j)[i] as f32));
    Ellipsoid::from_axes(e.center().as_vec3(), e.semi_axes().as_vec3(), axes).expect("in range")
}

proptest! {
    #![proptest_config(convex_support::laws::config(300))]

    #[test]
    fn powers_of_two(e1 in ellipsoid3(4.0, 2.0), e2 in ellipsoid3(4.0, 2.0), f1 in ellipsoid2(4.0, 2.0), f2 in ellipsoid2(4.0, 2.0), k in -40i32..40) {
        let s = 2f64.powi(k);
        assert_scale_free(&e1, &e2, s);
        assert_scale_free(&f1, &f2, s);
        assert_scale_free(&single(&e1), &single(&e2), s);
    }

    /// Squares of such lengths are no numbers any more. Aspects are moderate, so that nothing leaves the range that
    /// need not.
    #[test]
    fn great_powers_of_two(e1 in ellipsoid3(3.0, 2.0), e2 in ellipsoid3(3.0, 2.0), f1 in ellipsoid2(3.0, 2.0), f2 in ellipsoid2(3.0, 2.0), k in 500i32..900, down: bool) {
        let s = 2f64.powi(if down { -k } else { k });
        assert_scale_free(&e1, &e2, s);
        assert_scale_free(&f1, &f2, s);
        let (t1, t2) = (scaled(&e1, s), scaled(&e2, s));
        let gradients = |e1: &Ellipsoid<DVec3>, e2: &Ellipsoid<DVec3>| {
            let pair = EllipsoidPair::new(e1, e2, MarginOptions::default());
            (pair.margin().gradient(), pair.distance().gradient(), pair.scaling().gradient())
        };
        let ((m, d, a), (n, e, b)) = (gradients(&e1, &e2), gradients(&t1, &t2));
        prop_assert_eq!((m.rotation, d.rotation * s, a.rotation), (n.rotation, e.rotation, b.rotation));
        prop_assert_eq!((m.translation, d.translation, a.translation), (n.translation * s, e.translation, b.translation * s));
    }

    /// Second derivatives are a number, or a length for the distance, per length for each translation.
    #[test]
    fn powers_of_two_of_second_derivatives(e1 in ellipsoid3(3.0, 2.0), e2 in ellipsoid3(3.0, 2.0), k in -200i32..200) {
        let s = 2f64.powi(k);
        let all = |e1: &Ellipsoid<DVec3>, e2: &Ellipsoid<DVec3>| {
            let pair = EllipsoidPair::new(e1, e2, MarginOptions::default());
            let hessians = [pair.margin().hessian(), pair.scaling().hessian(), pair.distance().hessian()];
            (hessians, pair.margin().shape_gradient())
        };
        let ((a, shape), (b, scaled_shape)) = (all(&e1, &e2), all(&scaled(&e1, s), &scaled(&e2, s)));
        for (n, (a, b)) in a.iter().zip(&b).enumerate() {
            for (i, j) in (0..36).map(|place| (place / 6, place % 6)) {
                let lengths = i32::from(n == 2) - i32::from(i < 3) - i32::from(j < 3);
                prop_assert_eq!(a.entry(i, j) * s.powi(lengths), b.entry(i, j), "{} {} {}", n, i, j);
            }
        }
        prop_assert_eq!(shape.semi_axes1, scaled_shape.semi_axes1 * s);
        prop_assert_eq!(shape.semi_axes2, scaled_shape.semi_axes2 * s);
    }

    #[test]
    fn rigid_motions(e1 in ellipsoid3(1.0, 2.0), e2 in ellipsoid3(1.0, 2.0), r in rotation(), t in within(3.0)) {
        let o = MarginOptions::default();
        let (a, b) = (free_margin(&e1, &e2, o), free_margin(&e1.posed(r, t).expect("finite"), &e2.posed(r, t).expect("finite"), o));
        prop_assert!(close(1.0 + a.margin, 1.0 + b.margin, 1e-12, 1e-12), "{} and {}", a.margin, b.margin);
        prop_assert!((r * a.point + t).abs_diff_eq(b.point, 1e-12));
        let (a, b) = (distance(&e1, &e2, o), distance(&e1.posed(r, t).expect("finite"), &e2.posed(r, t).expect("finite"), o));
        prop_assert!(close(a.distance, b.distance, 1e-11, 1e-13), "{} and {}", a.distance, b.distance);
    }

    /// An affine map changes both bodies and no margin.
    #[test]
    fn affine_maps(e1 in ellipsoid3(0.7, 2.0), e2 in ellipsoid3(0.7, 2.0), r in rotation(), d in [0.5..2.0f64, 0.5..2.0, 0.5..2.0]) {
        let map = DMat3::from_quat(r) * DMat3::from_diagonal(DVec3::from_array(d));
        let back = map.inverse();
        let mapped = |e: &Ellipsoid<DVec3>| {
            let x = back.transpose() * e.matrix() * back;
            Ellipsoid::from_matrix(map * e.center(), (x + x.transpose()) * 0.5).expect("positive definite")
        };
        let o = MarginOptions::default();
        let (a, b) = (free_margin(&e1, &e2, o), free_margin(&mapped(&e1), &mapped(&e2), o));
        prop_assert!(close(1.0 + a.margin, 1.0 + b.margin, 1e-10, 1e-10), "{} and {}", a.margin, b.margin);
    }

    /// Vec3 and Vec3A hold the same numbers and get the same answer.
    #[test]
    fn layouts(e1 in ellipsoid3(2.0, 2.0), e2 in ellipsoid3(2.0, 2.0)) {
        let aligned = |e: &Ellipsoid<Vec3>| {
            let axes = Matrix::from_cols_fn(|j| Vec3A::from(e.axes().col(j)));
            Ellipsoid::from_axes(Vec3A::from(e.center()), Vec3A::from(e.semi_axes()), axes).expect("valid")
        };
        let (a, b) = (single(&e1), single(&e2));
        let o = MarginOptions::default();
        let (m, n) = (free_margin(&a, &b, o), free_margin(&aligned(&a), &aligned(&b), o));
        prop_assert_eq!((m.margin, m.nu), (n.margin, n.nu));
    }

    /// √(1 + m) is 1-Lipschitz in x₁ in the norm of P, and m is convex in it.
    #[test]
    fn lipschitz_and_convex(e1 in ellipsoid3(1.0, 2.0), e2 in ellipsoid3(1.0, 2.0), by in within(1.0)) {
        let at = |t: f64| {
            let e = Ellipsoid::from_axes(e1.center() + by * t, e1.semi_axes(), e1.axes()).expect("finite");
            free_margin(&e, &e2, MarginOptions::default())
        };
        let (a, middle, b) = (at(0.0), at(0.5), at(1.0));
        let step = ((e1.axes().transpose() * by) / e1.semi_axes()).length();
        prop_assert!((a.scale() - b.scale()).abs() <= step * (1.0 + 1e-12) + 1e-12);
        prop_assert!(2.0 * middle.margin <= (a.margin + b.margin) + 1e-12 * (2.0 + a.margin + b.margin));
    }
}
