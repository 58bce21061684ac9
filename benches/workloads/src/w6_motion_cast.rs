//! W6: when a body that moves and turns first touches a resting one.

use core::f64::consts::FRAC_PI_2;

use crate::pairs::Pair;
use crate::reference::Pose;
use crate::rng::Rng;
use crate::vec3::{Vec3, scale};
use crate::w2_linear_cast;

/// `B` moves from `pose` by `velocity` while `λ` goes from 0 to 1, and turns about its own origin by a right angle.
#[derive(Clone, Copy, Debug)]
pub struct TurningCast {
    /// Where `B` is at `λ = 0`.
    pub pose: Pose,
    /// How far its origin moves.
    pub velocity: Vec3,
    /// The axis that it turns about, as long as the angle.
    pub angular_velocity: Vec3,
}

/// The casts of W2 for one pair, turning about a random axis. Most still hit, but at another time.
#[must_use]
pub fn casts(pair: &Pair) -> Vec<TurningCast> {
    let mut rng = Rng::new(6000 + pair.index);
    let turned = |cast: w2_linear_cast::Cast| TurningCast {
        pose: cast.pose,
        velocity: cast.velocity,
        angular_velocity: scale(rng.sphere(), FRAC_PI_2),
    };
    w2_linear_cast::casts(pair).into_iter().map(turned).collect()
}
