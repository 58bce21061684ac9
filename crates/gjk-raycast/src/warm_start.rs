//! What the answer of one frame tells the cast of the next: the paper's frame coherence.

use convex_support::{Scalar, Vector};

/// How far a normal may turn from one frame to the next where nothing is known of it, in radians.
const TURN: f64 = 0.015;

/// Where a cast looks first: what the answer of one frame tells the cast of the next.
///
/// Each answer hands it out, given the one that it was found with; beside the last normal it tells how that turns from
/// frame to frame, if it turns steadily, and how far it may be off. The next answer is as certain as any. What is told
/// wrongly only takes support points; and where it would leave a cast in doubt, the cast begins again without it.
///
/// ```
/// use convex_support::{Ellipsoid, Posed, glam::DQuat, glam::DVec3};
/// use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
///
/// let stone = Ellipsoid::new(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), DQuat::IDENTITY)?;
/// let motion = Motion { velocity_a: DVec3::NEG_X, ..Motion::default() };
/// let (mut warm_start, mut support_points) = (None, 0);
/// for frame in 0..100 {
///     let turn = DQuat::from_rotation_z(0.01 * f64::from(frame));
///     let coming = Posed::new(&stone, turn, DVec3::new(10.0, 1.0, 0.5))?;
///     let options = LinearCastOptions::new().with_warm_start(warm_start);
///     let cast = linear_cast(&coming, &stone, motion, options)?;
///     warm_start = cast.warm_start(warm_start);
///     support_points += cast.iterations;
/// }
/// assert!(support_points <= 221); // cold casts take 442
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct WarmStart<V: Vector> {
    /// The normal that is expected.
    pub(crate) axis: V,
    /// How the normal turned from the hit before to the last one.
    turn: V,
    /// How far the axis may be off, as an angle.
    error: V::Scalar,
    known: Learned,
}

/// What a warm start knows; each is more than the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Learned {
    /// A guess of the axis.
    Guess,
    /// The normal of a hit, which is the axis.
    Normal,
    /// The turn and the error too.
    Turn,
    /// The turn was foretold: the axis is a turn from the normal.
    Foretold,
}

impl<V: Vector> WarmStart<V> {
    /// Nothing but an axis: a guess of the normal, or of a separating axis.
    #[must_use]
    pub const fn new(axis: V) -> Self {
        Self { axis, turn: V::ZERO, error: V::Scalar::ZERO, known: Learned::Guess }
    }

    /// After a hit with this normal, found with what was told `before`.
    ///
    /// What moves steadily turns its normal steadily, and the next one is then where the last turn is made once more,
    /// to the square of that. But from face to face a normal jumps. So the last turn counts only if it was foretold by
    /// the one before, to within a half; and by how much it was not, the next one may be off.
    pub(crate) fn after(before: Option<Self>, normal: V) -> Self {
        let first = Self { known: Learned::Normal, ..Self::new(normal) };
        let last = |before: Self| match before.known {
            Learned::Guess => None,
            Learned::Normal | Learned::Turn => Some(before.axis),
            Learned::Foretold => Some(before.axis - before.turn),
        };
        let Some((before, last)) = before.and_then(|before| Some((before, last(before)?))) else { return first };
        let turn = normal - last;
        let (still, error) = (turn.norm(), (turn - before.turn).norm());
        if before.known >= Learned::Turn && error + error < still {
            Self { axis: normal + turn, turn, error, known: Learned::Foretold }
        } else {
            Self { axis: normal, turn, error: still, known: Learned::Turn }
        }
    }

    /// How far the normal may be from the axis, as an angle.
    pub(crate) fn error(&self) -> V::Scalar {
        if self.known >= Learned::Turn { self.error } else { V::Scalar::from_f64(TURN) }
    }

    /// The same of the bodies in the other order.
    pub(crate) fn reversed(self) -> Self {
        Self { axis: -self.axis, turn: -self.turn, ..self }
    }
}
