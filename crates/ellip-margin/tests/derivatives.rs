//! Gradients and Hessians against differences of 70-digit values, made by `data/derivatives.py`, and how they behave
//! where the quantities reach their floors.

use crate::common::close;
use convex_support::glam::{DMat3, DQuat, DVec2, DVec3};
use convex_support::{AngularVelocity, Ellipsoid, Matrix, Vector};
use ellip_margin::{EllipsoidPair, MarginOptions, MotionGradient, MotionHessian, map_margins, map_pairs};

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

/// The greatest errors of a gradient and a Hessian, relative to the greatest entry of their blocks: translations, both,
/// and rotations have different units.
fn errors<V: Vector<Scalar = f64>>(
    gradient: &MotionGradient<V>,
    hessian: &MotionHessian<V>,
    truth: &[f64],
) -> [f64; 2] {
    let n = V::DIM;
    let dof = MotionHessian::<V>::SIZE;
    let block = |i: usize| usize::from(i >= n);
    let (mut first, mut second) = ([[0f64; 2]; 2], [[0f64; 2]; 3]);
    for i in 0..dof {
        let ours = if i < n { gradient.translation.get(i) } else { gradient.rotation.coordinate(i - n) };
        let [off, size] = &mut first[block(i)];
        (*off, *size) = (off.max((ours - truth[1 + i]).abs()), size.max(truth[1 + i].abs()));
    }
    let mut at = 1 + dof;
    for i in 0..dof {
        for j in i..dof {
            let ours = hessian.entry(i, j);
            assert_eq!(ours, hessian.entry(j, i), "symmetric");
            let [off, size] = &mut second[block(i) + block(j)];
            (*off, *size) = (off.max((ours - truth[at]).abs()), size.max(truth[at].abs()));
            at += 1;
        }
    }
    // A block that is 0 has differences of rounding only.
    let greatest = |blocks: &[[f64; 2]]| blocks.iter().fold(0f64, |m, [off, size]| m.max(off / size.max(1e-6)));
    [greatest(&first), greatest(&second)]
}

fn check<V: Vector<Scalar = f64>>() {
    let cases = cases::<V>(include_str!("data/derivatives.csv"));
    assert_eq!(cases.len(), 24, "all lines");
    for Case { condition, bodies: [e1, e2], truth } in cases {
        let pair = EllipsoidPair::new(&e1, &e2, MarginOptions::default());
        let (m, d, s) = (pair.margin(), pair.distance(), pair.scaling());
        let values = [m.margin, d.distance, s.scale];
        let errors = [
            errors(&m.gradient(), &m.hessian(), &truth[0]),
            errors(&d.gradient(), &d.hessian(), &truth[1]),
            errors(&s.gradient(), &s.hessian(), &truth[2]),
        ];
        for k in 0..3 {
            assert!(close(values[k], truth[k][0], 1e-11, 0.0), "value {k}: {} for {}", values[k], truth[k][0]);
            let worst = errors[k][0].max(errors[k][1]);
            assert!(worst <= 2e-11, "{}D, quantity {k}, condition 1e{condition}: {:?}", V::DIM, errors[k]);
        }
    }
}

#[test]
fn against_many_digits() {
    check::<DVec2>();
    check::<DVec3>();
}

/// What moves one body moves the other the opposite way, about a common pivot; and where a quantity is symmetric, the
/// second derivatives by the second body are those by the first of the pair swapped.
#[test]
fn of_the_second_body() {
    for Case { bodies: [e1, e2], .. } in cases::<DVec3>(include_str!("data/derivatives.csv")) {
        let o = MarginOptions::default();
        let (there, back) = (EllipsoidPair::new(&e1, &e2, o).scaling(), EllipsoidPair::new(&e2, &e1, o).scaling());
        let (first, second) = (there.gradient(), there.gradient_of_second());
        let size = first.translation.length() + first.rotation.length();
        assert!((first.translation + second.translation).length() <= 1e-10 * size, "{first:?} {second:?}");
        let sum = first.rotation_about(DVec3::ZERO) + second.rotation_about(DVec3::ZERO);
        assert!(sum.length() <= 1e-9 * size, "{sum} of {first:?}");
        let (a, b) = (there.hessian_of_second().matrix::<6>(), back.hessian().matrix::<6>());
        let size = a.as_flattened().iter().fold(0f64, |m, x| m.max(x.abs()));
        for (x, y) in a.as_flattened().iter().zip(b.as_flattened()) {
            assert!(close(*x, *y, 0.0, 1e-9 * size), "{x} and {y} of {size}");
        }
    }
}

/// The convention: a gradient taken anew at the moved body, in world axes, is g + Hθ + ½(0, ω × ∂f/∂ω).
#[test]
fn the_gradient_follows_the_hessian() {
    let body = |center, a, turn| Ellipsoid::new(center, a, turn).expect("valid");
    let e1 = body(DVec3::new(0.3, 0.1, 0.0), DVec3::new(2.0, 1.0, 0.5), DQuat::from_rotation_x(0.4));
    let e2 = body(DVec3::new(1.0, 2.5, 0.7), DVec3::new(1.0, 0.4, 0.7), DQuat::IDENTITY);
    let o = MarginOptions::default();
    let m = EllipsoidPair::new(&e1, &e2, o).margin();
    let (g, h) = (m.gradient(), m.hessian().matrix::<6>());
    let (translation, rotation) = (DVec3::new(0.2, -0.5, 0.3) * 1e-6, DVec3::new(0.7, 0.1, -0.4) * 1e-6);
    let turned = DMat3::from_quat(DQuat::from_scaled_axis(rotation)) * e1.axes();
    let moved = Ellipsoid::from_axes(e1.center() + translation, e1.semi_axes(), turned).expect("valid");
    let now = EllipsoidPair::new(&moved, &e2, o).margin().gradient();
    let theta = [translation.to_array(), rotation.to_array()].concat();
    let rate = |i: usize| (0..6).map(|j| h[i][j] * theta[j]).sum::<f64>();
    let foreseen = g.translation + DVec3::new(rate(0), rate(1), rate(2));
    assert!((now.translation - foreseen).length() < 1e-9, "{} and {foreseen}", now.translation);
    let foreseen = g.rotation + DVec3::new(rate(3), rate(4), rate(5)) + rotation.cross(g.rotation) * 0.5;
    assert!((now.rotation - foreseen).length() < 1e-9, "{} and {foreseen}", now.rotation);
}

/// Where the centres meet α reaches 0 with a slope that does not. The normal jumps there, `separation` does not.
#[test]
fn through_the_centre() {
    let e2 = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 0.5, 1.0), DQuat::IDENTITY).expect("valid");
    let at = |x: DVec3| Ellipsoid::new(x, DVec3::new(1.0, 0.3, 0.3), DQuat::from_rotation_z(0.5)).expect("valid");
    let o = MarginOptions::default();
    for away in [1e-3, 1e-9, 1e-100, 1e-200] {
        for direction in [DVec3::X, -DVec3::X, DVec3::Y, DVec3::new(0.6, 0.0, 0.8)] {
            let e1 = at(direction * away);
            let pair = EllipsoidPair::new(&e1, &e2, o);
            let s = pair.scaling();
            assert!(s.scale > 0.0 && s.scale < 4.0 * away, "{s:?}");
            assert!(close(s.separation, -0.8, 1e-14, 4.0 * away), "−(0.3 + 0.5): {}", s.separation);
            // α is homogeneous: its slope along the line of centres is α over their distance.
            assert!(close(s.gradient().prismatic(direction), s.scale / away, 1e-13, 0.0), "{:?}", s.gradient());
            assert_eq!(pair.margin().gradient().translation, DVec3::ZERO, "the margin is at its floor");
        }
    }
    let concentric = at(DVec3::ZERO);
    let s = EllipsoidPair::new(&concentric, &e2, o).scaling();
    assert_eq!((s.scale, s.separation, s.gradient().translation), (0.0, -0.8, DVec3::ZERO), "concentric");
}

/// Batches ask the same of every pair.
#[test]
fn batches() {
    let cases = cases::<DVec3>(include_str!("data/derivatives.csv"));
    let (first, second): (Vec<_>, Vec<_>) = cases.iter().map(|case| (case.bodies[0], case.bodies[1])).unzip();
    let o = MarginOptions::default();
    let scales = map_pairs(&first, &second, o, |pair| pair.scaling().gradient()).expect("of one length");
    let margins = map_margins(&first, &second, o, |m| m.gradient()).expect("of one length");
    assert_eq!((scales.len(), margins.len()), (first.len(), first.len()), "one for each pair");
    for (k, (e1, e2)) in first.iter().zip(&second).enumerate() {
        let pair = EllipsoidPair::new(e1, e2, o);
        assert_eq!(scales[k], pair.scaling().gradient(), "pair {k}");
        let (g, h) = (margins[k].translation, pair.margin().gradient().translation);
        assert!((g - h).length() <= 1e-11 * h.length(), "pair {k}: {g} and {h}");
    }
    assert!(map_pairs(&first[..2], &second[..3], o, |pair| pair.margin().margin).is_err(), "two and three");
}

/// Ellipses so far apart that the normal is the line of centres, which a turn does not move: the distance then changes
/// as minus the height h = √(a²cos² + b²sin²) of the one that turns. The second derivative had been written as a
/// difference of the distance of the centres and the like, of which 1e12 sizes left four digits.
#[test]
fn turns_of_bodies_far_apart() {
    let o = MarginOptions::default();
    for (a, b, angle, away) in [(1.0, 0.64, 0.3, 1e12), (1.0, 0.008, 1.1, 1e12), (0.25, 1.0, -0.7, 1e13)] {
        let mover = Ellipsoid::new(DVec2::ZERO, DVec2::new(a, b), angle).expect("valid");
        let other = Ellipsoid::new(DVec2::new(away, 0.0), DVec2::new(1.0, 0.016), 0.4).expect("valid");
        let [c2, s2] = [f64::cos(2.0 * angle), f64::sin(2.0 * angle)];
        let h = (a * a * f64::cos(angle).powi(2) + b * b * f64::sin(angle).powi(2)).sqrt();
        let spread = b * b - a * a;
        let due = -(spread * c2 / h - (spread * s2).powi(2) / (4.0 * h.powi(3)));
        let first = EllipsoidPair::new(&mover, &other, o).distance().hessian().entry(2, 2);
        let second = EllipsoidPair::new(&other, &mover, o).distance().hessian_of_second().entry(2, 2);
        assert!(close(first, due, 1e-10, 0.0) && close(second, due, 1e-10, 0.0), "{first} and {second} for {due}");
    }
}

/// Where x₁ has just left E₂, ρ = √(1 + m) is next to nothing. It had been a difference, which was negative here, so
/// that the root of the curvature was no number.
#[test]
fn the_curvature_of_a_margin_next_to_its_floor() {
    let turn1 = DMat3::from_cols_array_2d(&[
        [-0.9459417056420136, 0.0875635921834636, -0.31229298239154557],
        [0.316297799949074, 0.03600713671382261, -0.9479763646067594],
        [-0.07176343967824891, -0.9955079625144141, -0.061756823881625955],
    ]);
    let turn2 = DMat3::from_cols_array_2d(&[
        [-0.5990646800353929, -0.27902059486505815, 0.750512502744119],
        [-0.41383910820138625, -0.6945240730443134, -0.5885350494957953],
        [0.6854623998857804, -0.6631619859454294, 0.3005952074463938],
    ]);
    let a = DVec3::new(0.6442746071287375, 0.011670579184314618, 0.6442746071287375);
    let e1 = Ellipsoid::from_axes(DVec3::ZERO, a, turn1).expect("valid");
    let center = DVec3::new(-0.08464408737273964, -0.14123470086164405, -0.12023982185263889);
    let semi_axes = DVec3::new(0.0004059747194366427, 0.6442746071287375, 0.0005608677573178187);
    let e2 = Ellipsoid::from_axes(center, semi_axes, turn2).expect("valid");
    let m = EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin();
    assert!(m.margin == -1.0 && m.nu > 0.0 && m.nu < 1e-18, "{m:?}");
    // E₂ is a half-space from so near: 1 + m = δ²/h² at a depth of δ, with h² = nᵀSn.
    let n = m.gradient().translation.normalize();
    let h = (e1.axes().transpose() * n * a).length();
    let along = m.hessian().along(n, DVec3::ZERO);
    assert!(close(along, 2.0 / (h * h), 1e-9, 0.0), "{along} and {}", 2.0 / (h * h));
    assert!(m.hessian().matrix::<6>().as_flattened().iter().all(|x| x.is_finite()), "{:?}", m.hessian());
}
