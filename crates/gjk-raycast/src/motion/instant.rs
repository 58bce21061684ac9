//! What is known of two moving bodies at one time.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

/// A step may change the distance by what the closing speeds do not foretell, but for this part of what they have
/// changed.
const KINK: f64 = 0.1;

/// Bodies that are apart, or overlap, by fewer errors than this are looked at closely.
pub(super) const NEAR: f64 = 64.0;

/// What points of both cores may be off a plane that they are said to be closest across, in errors.
pub(super) const IN_PLANE: f64 = 4.0;

/// The direction of closest points that are apart by this part of the size of both bodies is known to rounding.
pub(super) const LONG: f64 = 1.0 / 16.0;

/// How much lower than contact a level may be where bodies touch, in units of what their places are rounded by at the
/// time.
pub(super) const ROUNDED: f64 = 6.0;

/// What is known of the pair at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant<V: Vector> {
    pub(super) time: V::Scalar,
    /// The unit vector from `b` to `a` along which they are nearest, or along which the way out of one another is the
    /// shortest.
    pub(super) normal: V,
    /// By how much a plane across the normal certainly separates the bodies; not positive where none may.
    pub(super) gap: V::Scalar,
    /// The signed distance as measured, which is certainly not more than `upper`.
    pub(super) distance: V::Scalar,
    pub(super) upper: V::Scalar,
    /// How far the measured distance is from the gap.
    pub(super) error: V::Scalar,
    /// How fast the closest points come nearer.
    pub(super) closing: V::Scalar,
    /// The closest point of `b`, or the one deepest in `a`, in the world.
    pub(super) point: V,
    /// Whether that is as well as it can be known, and not from afar.
    pub(super) is_close: bool,
}

impl<V: Vector> Instant<V> {
    /// The same with distances measured from a level, instead of from contact.
    #[inline(always)]
    pub(super) fn above(self, level: V::Scalar) -> Self {
        Self { gap: self.gap - level, distance: self.distance - level, upper: self.upper - level, ..self }
    }

    /// Whether the bodies certainly have a point in common.
    pub(super) fn overlaps(&self) -> bool {
        self.upper < V::Scalar::ZERO
    }

    /// Whether the distance went from here to another time without a kink: the mean of the closing speeds tells what it
    /// changed by, but for a part of what they did.
    pub(super) fn goes_smoothly_to(&self, to: &Self) -> bool {
        let (half, duration) = (V::Scalar::from_f64(0.5), to.time - self.time);
        let foretold = (self.closing + to.closing) * half * duration;
        let sped_up = (to.closing - self.closing).abs() * duration;
        let off = (self.distance - to.distance - foretold).abs();
        off <= sped_up * V::Scalar::from_f64(KINK) + self.error + to.error
    }
}

/// What need not be known exactly of an instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits<S> {
    /// How far apart the bodies are, once they are certainly farther apart than this.
    pub(super) distance: S,
    /// How deep they are in one another, once they are certainly deeper than this.
    pub(super) depth: S,
}

/// From where distances are measured.
#[derive(Clone, Copy)]
pub(super) struct Base<S> {
    /// The signed distance that counts as contact, but for how the bodies' places are [rounded](Self::loose).
    pub(super) level: S,
    pub(super) stage: Stage,
    /// The signed distance at the start, what it certainly is not more than, and by how much that is more than what it
    /// certainly is not less than.
    pub(super) start: S,
    pub(super) highest: S,
    pub(super) width: S,
    pub(super) slack: S,
    /// When the bodies came to the surface.
    pub(super) since: S,
    /// The tolerance that was asked for. A start in contact is as near as the slack, and that of what follows from it
    /// is none.
    pub(super) tolerance: S,
}

/// What the bodies have done so far.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Stage {
    /// They have been apart, or a contact counts whatever was before.
    Apart,
    /// They have touched from the start on, to rounding.
    Touching,
    /// They have overlapped from the start on, and have not been less deep.
    Deep,
    /// They overlap, less deep than they began.
    Risen,
    /// They overlapped, and touch, to rounding: they may have been apart, or not.
    Surfaced,
}

impl<S: Scalar> Base<S> {
    /// Where contact is what counts.
    pub(super) const CONTACT: Self = {
        let zero = S::ZERO;
        Self {
            level: zero,
            stage: Stage::Apart,
            start: zero,
            highest: zero,
            width: zero,
            slack: zero,
            since: zero,
            tolerance: zero,
        }
    };

    /// How much lower the level is, in units of what the places of the bodies are rounded by at the time.
    pub(super) fn loose(&self) -> S {
        let is_exact = matches!(self.stage, Stage::Apart | Stage::Risen);
        if is_exact { S::ZERO } else { S::from_f64(ROUNDED) }
    }

    /// Whether the bodies are to stay in contact until they are seen to part.
    pub(super) fn overlaps(&self) -> bool {
        matches!(self.stage, Stage::Deep | Stage::Risen)
    }
}

/// How closely bodies are to be looked at.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Closeness {
    /// Roughly, even where they are nearly in contact.
    Rough,
    /// Roughly, but closely where they are nearly in contact.
    AsNear,
    /// Closely.
    Close,
}
