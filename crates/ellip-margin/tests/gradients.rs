//! Every gradient against differences of high order, on random pairs.

use crate::common::{close, derivative, ellipsoid2, ellipsoid3};
use convex_support::glam::{DMat2, DMat3, DQuat, DVec2, DVec3};
use convex_support::{Ellipsoid, Matrix};
use ellip_margin::{EllipsoidPair, Margin, MarginOptions, Status, free_margin};
use proptest::prelude::*;

fn margin3(e1: &Ellipsoid<DVec3>, e2: &Ellipsoid<DVec3>) -> f64 {
    free_margin(e1, e2, MarginOptions::default()).margin
}

fn moved(e: &Ellipsoid<DVec3>, by: DVec3) -> Ellipsoid<DVec3> {
    Ellipsoid::from_axes(e.center() + by, e.semi_axes(), e.axes()).expect("finite")
}

/// Turned by the rotation vector `by` about `pivot`.
fn turned(e: &Ellipsoid<DVec3>, by: DVec3, pivot: DVec3) -> Ellipsoid<DVec3> {
    let q = DQuat::from_scaled_axis(by);
    Ellipsoid::from_axes(pivot + q * (e.center() - pivot), e.semi_axes(), DMat3::from_quat(q) * e.axes())
        .expect("finite")
}

/// Differences resolve a derivative only as far as the margin is smooth on their step, which is a part of the least
/// semi-axis and of the way to the boundary of E₂.
fn smooth(m: &Margin<DVec3>) -> bool {
    m.status == Status::Converged && m.nu > 1e-2 && m.margin < 1e4
}

const H: f64 = 2e-3;

proptest! {
    #![proptest_config(convex_support::laws::config(200))]

    #[test]
    fn motion_in_space(e1 in ellipsoid3(0.6, 2.0), e2 in ellipsoid3(0.6, 2.0), pivot in crate::common::within(2.0)) {
        let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
        prop_assume!(smooth(&m));
        let (first, second) = (m.gradient(), m.gradient_of_second());
        let size = first.translation.length();
        prop_assert!((first.translation + second.translation).length() <= 1e-12 * size);
        for (k, axis) in DVec3::AXES.into_iter().enumerate() {
            let d = |f: &dyn Fn(f64) -> f64| derivative(H, f);
            let cases = [
                (first.translation[k], d(&|t| margin3(&moved(&e1, axis * t), &e2))),
                (second.translation[k], d(&|t| margin3(&e1, &moved(&e2, axis * t)))),
                (first.rotation[k], d(&|t| margin3(&turned(&e1, axis * t, e1.center()), &e2))),
                (second.rotation[k], d(&|t| margin3(&e1, &turned(&e2, axis * t, e2.center())))),
                (first.rotation_about(pivot)[k], d(&|t| margin3(&turned(&e1, axis * t, pivot), &e2))),
                (second.revolute(pivot, axis), d(&|t| margin3(&e1, &turned(&e2, axis * t, pivot)))),
                (first.prismatic(axis), d(&|t| margin3(&moved(&e1, axis * t), &e2))),
            ];
            for (i, (exact, difference)) in cases.into_iter().enumerate() {
                prop_assert!(close(exact, difference, 1e-6, 1e-6 * size * 4.0), "case {}: {} for {}", i, exact, difference);
            }
        }
    }

    #[test]
    fn motion_in_the_plane(e1 in ellipsoid2(0.6, 2.0), e2 in ellipsoid2(0.6, 2.0)) {
        let margin = |a: &Ellipsoid<DVec2>, b: &Ellipsoid<DVec2>| free_margin(a, b, MarginOptions::default()).margin;
        let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
        prop_assume!(m.nu > 1e-2 && m.margin < 1e4);
        let gradient = m.gradient();
        let turned = |e: &Ellipsoid<DVec2>, t: f64| {
            Ellipsoid::from_axes(e.center(), e.semi_axes(), DMat2::from_angle(t) * e.axes()).expect("finite")
        };
        let size = gradient.translation.length();
        let rotation = derivative(H, |t| margin(&turned(&e1, t), &e2));
        prop_assert!(close(gradient.rotation, rotation, 1e-6, 4e-6 * size), "{} for {}", gradient.rotation, rotation);
        let second = m.gradient_of_second();
        let rotation = derivative(H, |t| margin(&e1, &turned(&e2, t)));
        prop_assert!(close(second.rotation, rotation, 1e-6, 4e-6 * size), "{} for {}", second.rotation, rotation);
        for k in 0..2 {
            let by = |t: f64| Ellipsoid::from_axes(e1.center() + DVec2::AXES[k] * t, e1.semi_axes(), e1.axes()).expect("finite");
            let difference = derivative(H, |t| margin(&by(t), &e2));
            prop_assert!(close(gradient.translation[k], difference, 1e-6, 1e-6 * size));
        }
    }

    #[test]
    fn sizes(e1 in ellipsoid3(0.6, 2.0), e2 in ellipsoid3(0.6, 2.0)) {
        let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
        prop_assume!(smooth(&m));
        let gradient = m.shape_gradient();
        let grown = |e: &Ellipsoid<DVec3>, k: usize, t: f64| {
            let mut a = e.semi_axes();
            a[k] += t;
            Ellipsoid::from_axes(e.center(), a, e.axes()).expect("positive")
        };
        let size = gradient.semi_axes1.length() + gradient.semi_axes2.length();
        for k in 0..3 {
            let first = derivative(H, |t| margin3(&grown(&e1, k, t), &e2));
            prop_assert!(close(gradient.semi_axes1[k], first, 1e-6, 1e-6 * size), "{} for {}", gradient.semi_axes1[k], first);
            let second = derivative(H, |t| margin3(&e1, &grown(&e2, k, t)));
            prop_assert!(close(gradient.semi_axes2[k], second, 1e-6, 1e-6 * size), "{} for {}", gradient.semi_axes2[k], second);
        }
    }

    #[test]
    fn matrices(e1 in ellipsoid3(0.4, 2.0), e2 in ellipsoid3(0.4, 2.0)) {
        let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
        prop_assume!(smooth(&m));
        let gradient = m.shape_gradient();
        let with = |e: &Ellipsoid<DVec3>, i: usize, j: usize, t: f64| {
            let mut x = e.matrix();
            x.col_mut(j)[i] += t;
            if i != j {
                x.col_mut(i)[j] += t;
            }
            Ellipsoid::from_matrix(e.center(), x).expect("still positive definite")
        };
        for i in 0..3 {
            for j in 0..=i {
                // An entry off the diagonal is there twice.
                let twice = if i == j { 1.0 } else { 2.0 };
                let g1 = twice * Matrix::col(&gradient.matrix1, j)[i];
                let g2 = twice * Matrix::col(&gradient.matrix2, j)[i];
                let d1 = derivative(H, |t| margin3(&with(&e1, i, j, t), &e2));
                let d2 = derivative(H, |t| margin3(&e1, &with(&e2, i, j, t)));
                let size = gradient.matrix1.x_axis.length() + gradient.matrix1.y_axis.length() + gradient.matrix1.z_axis.length();
                prop_assert!(close(g1, d1, 1e-6, 1e-6 * size), "entry ({}, {}) of P: {} for {}", i, j, g1, d1);
                let size = gradient.matrix2.x_axis.length() + gradient.matrix2.y_axis.length() + gradient.matrix2.z_axis.length();
                prop_assert!(close(g2, d2, 1e-6, 1e-6 * size), "entry ({}, {}) of Q: {} for {}", i, j, g2, d2);
            }
        }
    }
}

/// A round body has no direction to turn.
#[test]
fn a_ball_feels_no_turn() {
    let ball =
        Ellipsoid::new(DVec3::new(0.3, -2.0, 1.0), DVec3::splat(0.7), DQuat::from_rotation_x(0.4)).expect("valid");
    let other = Ellipsoid::new(DVec3::ZERO, DVec3::new(1.0, 0.5, 0.2), DQuat::from_rotation_z(1.0)).expect("valid");
    let m = EllipsoidPair::new(&ball, &other, MarginOptions::default()).margin();
    assert!(m.margin > 0.0, "disjoint");
    assert_eq!(m.gradient().rotation, DVec3::ZERO, "to the last bit");
}
