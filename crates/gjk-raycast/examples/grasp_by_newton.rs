//! Eight fingertips of a hand are to come as near as they can to a clearance of 5 mm from an object. Newton's method
//! finds the pose of the hand, with the gradients and Hessians of the distances; without the Hessians (Gauss and
//! Newton) it takes longer.
//!
//! `cargo run --release -p gjk-raycast --example grasp_by_newton`

#![allow(clippy::print_stdout, reason = "an example talks")]

use gjk_raycast::convex_support::glam::{DQuat, DVec3};
use gjk_raycast::convex_support::{Ball, Ellipsoid, Posed};
use gjk_raycast::{ClosestFeatures, SignedDistanceOptions, signed_distance};

const CLEARANCE: f64 = 0.005;

/// Where the fingertips are, in the frame of the hand, in metres.
const TIPS: [[f64; 3]; 8] = [
    [0.060, 0.010, 0.008],
    [-0.058, 0.012, -0.006],
    [0.008, 0.046, 0.010],
    [-0.010, -0.047, 0.004],
    [0.005, 0.010, 0.038],
    [0.030, -0.028, 0.022],
    [-0.032, 0.026, 0.021],
    [0.028, 0.026, -0.022],
];

/// The pose of the hand.
#[derive(Clone, Copy)]
struct Hand {
    rotation: DQuat,
    translation: DVec3,
}

/// Half the sum of squares of what the distances miss the clearance by, its gradient by the motion of the hand, and its
/// second derivatives: those that the gradients of the distances make up, and the rest, which is of their Hessians.
struct Objective {
    value: f64,
    gradient: [f64; 6],
    of_gradients: [[f64; 6]; 6],
    of_hessians: [[f64; 6]; 6],
}

fn objective(hand: Hand, object: &Ellipsoid<DVec3>) -> Objective {
    let nothing = [[0.0; 6]; 6];
    let mut sum = Objective { value: 0.0, gradient: [0.0; 6], of_gradients: nothing, of_hessians: nothing };
    for tip in TIPS.map(DVec3::from_array) {
        let tip = Posed::translated(Ball::new(0.006).expect("positive"), hand.translation + hand.rotation * tip)
            .expect("finite");
        let answer = signed_distance(&tip, object, SignedDistanceOptions::default());
        let features: ClosestFeatures<DVec3> = answer.closest_features(&tip, object);
        // The tip moves with the hand, about the centre of the hand.
        let force = features.gradient().a;
        let turn = force.rotation_about(hand.translation);
        let first: [f64; 6] = core::array::from_fn(|i| if i < 3 { force.translation[i] } else { turn[i - 3] });
        let second = features.hessian_of_a(hand.translation).expect("a ball and an ellipsoid are smooth");
        let missed = answer.signed_distance - CLEARANCE;
        sum.value += 0.5 * missed * missed;
        for i in 0..6 {
            sum.gradient[i] += missed * first[i];
            for j in 0..6 {
                sum.of_gradients[i][j] += first[i] * first[j];
                sum.of_hessians[i][j] += missed * second.entry(i, j);
            }
        }
    }
    sum
}

/// The solution of a linear system, by elimination with pivots.
fn solved(mut matrix: [[f64; 6]; 6], mut right: [f64; 6]) -> [f64; 6] {
    for k in 0..6 {
        let pivot = (k..6).max_by(|&i, &j| matrix[i][k].abs().total_cmp(&matrix[j][k].abs())).unwrap_or(k);
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        let row = matrix[k];
        for i in k + 1..6 {
            let share = matrix[i][k] / row[k];
            for (entry, pivot) in matrix[i].iter_mut().zip(row).skip(k) {
                *entry -= share * pivot;
            }
            right[i] -= share * right[k];
        }
    }
    for k in (0..6).rev() {
        let known: f64 = (k + 1..6).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - known) / matrix[k][k];
    }
    right
}

impl Hand {
    fn moved(self, [x, y, z, a, b, c]: [f64; 6]) -> Self {
        Self {
            rotation: (DQuat::from_scaled_axis(DVec3::new(a, b, c)) * self.rotation).normalize(),
            translation: self.translation + DVec3::new(x, y, z),
        }
    }
}

/// The pose after as many steps as it takes for the gradient to vanish, and their number.
fn minimised(mut hand: Hand, object: &Ellipsoid<DVec3>, with_curvature: bool) -> (Hand, usize) {
    for step in 0..200 {
        let Objective { value, gradient, of_gradients, of_hessians } = objective(hand, object);
        let size = gradient.iter().fold(0.0_f64, |m, g| m.max(g.abs()));
        if with_curvature {
            println!("{step}: rms {:.9} mm, gradient {size:.1e} m", 1e3 * (2.0 * value / 8.0).sqrt());
        }
        if size < 1e-15 {
            return (hand, step);
        }
        let down = gradient.map(|g| -g);
        let newton =
            solved(core::array::from_fn(|i| core::array::from_fn(|j| of_gradients[i][j] + of_hessians[i][j])), down);
        // Far from the minimum the Hessian may lead up.
        let falls = newton.iter().zip(down).map(|(step, down)| step * down).sum::<f64>() > 0.0;
        let mut change = if with_curvature && falls { newton } else { solved(of_gradients, down) };
        // Half as far, until it is better, where that is more than rounding.
        for _ in 0..20 {
            if objective(hand.moved(change), object).value <= value * (1.0 + 1e-12) {
                break;
            }
            change = change.map(|x| 0.5 * x);
        }
        hand = hand.moved(change);
    }
    (hand, 200)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let object = Ellipsoid::new(DVec3::ZERO, DVec3::new(0.05, 0.036, 0.026), DQuat::from_rotation_x(0.1))?;
    let start = Hand {
        rotation: DQuat::from_scaled_axis(DVec3::new(0.05, -0.06, 0.08)),
        translation: DVec3::new(0.003, -0.002, 0.004),
    };
    let (found, newton) = minimised(start, &object, true);
    let (same, gauss) = minimised(start, &object, false);
    let (at, before) = (objective(found, &object), objective(start, &object));
    println!(
        "{newton} steps of Newton, {gauss} of Gauss and Newton; objective {:.3e} at first, {:.3e} m² at last",
        before.value, at.value
    );
    assert!(2 * newton < gauss, "curvature is worth its price");
    assert!((found.translation - same.translation).length() < 1e-10, "and leads to the same place");
    assert!(at.value > 0.0 && at.value < before.value, "not all fingers can be right at once");
    Ok(())
}
