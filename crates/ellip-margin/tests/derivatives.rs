//! Gradients and Hessians against differences of 70-digit values, made by `data/derivatives.py`; how they behave where
//! quantities reach their floor; and what they cost nothing for.

mod common;

use common::{derivative, ellipsoid2, ellipsoid3};
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3, Vec3};
use convex_support::{Ellipsoid, Matrix, Vector};
use ellip_margin::{EllipsoidPair, MarginOptions, MotionGradient, MotionHessian, Wedge};
use proptest::prelude::*;

/// The reference: of the margin, the distance and the scale each value, gradient and upper triangle of the Hessian.
struct Case<V: Vector> {
    condition: f64,
    bodies: [Ellipsoid<V>; 2],
    truth: [Vec<f64>; 3],
}

/// The cases of a dimension in a file like `data/derivatives.csv`.
fn cases<V: Vector<Scalar = f64>>(text: &str) -> Vec<Case<V>> {
    let n = V::DIM;
    let lines = text.lines().filter(|line| line.starts_with(if n == 2 { "2," } else { "3," }));
    lines
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|x| x.parse().expect("a number")).collect();
            let per_body = 2 * n + n * n;
            let body = |k: usize| {
                let at = |i: usize| numbers[2 + k * per_body + i];
                let axes = V::Matrix::from_cols_fn(|j| V::from_fn(|i| at(2 * n + n * j + i)));
                Ellipsoid::from_axes(V::from_fn(at), V::from_fn(|i| at(n + i)), axes).expect("valid")
            };
            let dof = n * (n + 1) / 2;
            let truth = numbers[2 + 2 * per_body..].chunks(1 + dof + dof * (dof + 1) / 2);
            let [m, d, s] = [0, 1, 2].map(|k| truth.clone().nth(k).expect("three quantities").to_vec());
            Case { condition: numbers[1], bodies: [body(0), body(1)], truth: [m, d, s] }
        })
        .collect()
}

/// The greatest errors of a gradient and a Hessian, relative to the greatest entry of their blocks: translations, both, and
/// rotations have different units.
fn errors<V: Wedge<Scalar = f64>>(gradient: &MotionGradient<V>, hessian: &MotionHessian<V>, truth: &[f64]) -> [f64; 2] {
    let n = V::DIM;
    let turn = V::coordinates(&gradient.rotation);
    let dof = n + turn.len();
    let block = |i: usize| usize::from(i >= n);
    let (mut first, mut second) = ([[0f64; 2]; 2], [[0f64; 2]; 3]);
    for i in 0..dof {
        let ours = if i < n { gradient.translation.get(i) } else { turn[i - n] };
        let [off, size] = &mut first[block(i)];
        (*off, *size) = (off.max((ours - truth[1 + i]).abs()), size.max(truth[1 + i].abs()));
    }
    let mut at = 1 + dof;
    for i in 0..dof {
        for j in i..dof {
            let ours = V::motion_entry(&hessian.matrix, i, j);
            assert_eq!(ours, V::motion_entry(&hessian.matrix, j, i), "symmetric");
            let [off, size] = &mut second[block(i) + block(j)];
            (*off, *size) = (off.max((ours - truth[at]).abs()), size.max(truth[at].abs()));
            at += 1;
        }
    }
    let greatest = |blocks: &[[f64; 2]]| {
        blocks.iter().fold(0f64, |m, [off, size]| m.max(if *off == 0.0 { 0.0 } else { off / size }))
    };
    [greatest(&first), greatest(&second)]
}

fn check<V: Wedge<Scalar = f64>>(text: &str) {
    let mut worst = [[[0f64; 2]; 3]; 10];
    for Case { condition, bodies: [e1, e2], truth } in cases::<V>(text) {
        let pair = EllipsoidPair::new(&e1, &e2, MarginOptions::default());
        let (m, d, s) = (pair.margin(), pair.distance(), pair.scaling());
        let answers = [
            errors(&m.gradient(), &m.hessian(), &truth[0]),
            errors(&d.gradient(), &d.hessian(), &truth[1]),
            errors(&s.gradient(), &s.hessian(), &truth[2]),
        ];
        for (k, errors) in answers.into_iter().enumerate() {
            for order in 0..2 {
                let worst = &mut worst[condition as usize][k][order];
                *worst = worst.max(errors[order]);
            }
        }
    }
    for (condition, row) in worst.iter().enumerate().filter(|(_, row)| row.iter().flatten().any(|x| *x > 0.0)) {
        std::println!(
            "{}D condition 1e{condition}: {}",
            V::DIM,
            row.map(|r| format!("{:.1e} {:.1e}", r[0], r[1])).join("  |  ")
        );
    }
}

#[test]
fn against_many_digits() {
    let text = include_str!("data/derivatives.csv");
    let more = std::fs::read_to_string("/tmp/more.csv.use");
    let text = more.as_deref().unwrap_or(text);
    check::<DVec2>(text);
    check::<DVec3>(text);
}
