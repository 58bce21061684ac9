//! A prediction from the answer of one frame for the cast of the next: the paper's frame coherence.

use convex_support::{Scalar, Vector};

/// How far a normal may turn from one frame to the next if nothing is known about it, in radians.
const USUAL_TURN: f64 = 0.015;

/// A prediction of the normal for the next frame's cast, made from the answer of this frame.
///
/// The method `warm_start` of an answer makes it, from the answer and the warm start of its own cast. It holds the
/// last normal, how the normal turns from frame to frame if it turns steadily, and how large the error may be. The
/// next answer is as certain as any. A wrong prediction only costs support points. If it would leave a cast in doubt,
/// the cast begins again without it.
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
    /// The predicted normal.
    pub(crate) axis: V,
    /// How the normal turned from the hit before to the last one.
    turn: V,
    /// How far the axis may be off, as an angle.
    error: V::Scalar,
    known: Learned,
}

/// What a warm start knows; each variant knows more than the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
enum Learned {
    /// A guess of the axis.
    Guess,
    /// The normal of a hit, which is the axis.
    Normal,
    /// The turn and the error too.
    Turn,
    /// The turn was predicted: the axis is a turn from the normal.
    Foretold,
}

impl<V: Vector> WarmStart<V> {
    /// A warm start with only an axis: a guess of the normal, or of a separating axis.
    #[must_use]
    pub const fn new(axis: V) -> Self {
        Self { axis, turn: V::ZERO, error: V::Scalar::ZERO, known: Learned::Guess }
    }

    /// The warm start after a hit with this normal, found with the warm start `before`.
    ///
    /// If bodies move steadily, the normal turns steadily, and repeating the last turn predicts the next normal to the
    /// square of the turn. But from face to face a normal jumps. So the last turn counts only if the turn before
    /// predicted it to within a half. The error of that prediction estimates the error of the next normal.
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
        if self.known >= Learned::Turn { self.error } else { V::Scalar::from_f64(USUAL_TURN) }
    }

    pub(crate) fn reversed(self) -> Self {
        Self { axis: -self.axis, turn: -self.turn, ..self }
    }
}
