//! What can be asked of a motion cast beside the bodies and their motions.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::motion_cast::FullMotion;
use crate::StartInContact;
use crate::extra::Extra;
use crate::options::setters;

/// Times to look at, after which to give up. A contact takes about ten and each turn near another body about as many;
/// bodies that spin for long very near one another take the most.
const MAX_ITERATIONS: usize = 10_000;

/// Options of [`motion_cast`](crate::motion_cast).
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(default, deny_unknown_fields))]
pub struct MotionCastOptions<V: Vector> {
    /// The end of the motion; it belongs to the motion. A negative value is taken for zero. Default: infinity. Set an
    /// end if a body spins: beside another body, no finite search can prove that it never touches it, and the answer is
    /// undecided after [`max_iterations`](Self::max_iterations).
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub max_time: V::Scalar,
    /// How far from contact, relative to the sizes of the shapes, the answer may stay uncertain. A bracket at the level
    /// of rounding always ends the search. Default: 0.
    pub tolerance: V::Scalar,
    /// The distance at which bodies count as touching: the cast stops that far from contact. A negative value is taken
    /// for zero. Default: 0.
    pub target_distance: V::Scalar,
    /// What to answer where the bodies touch at the start. Default: [`StartInContact::Report`].
    pub start_in_contact: StartInContact,
    /// A first guess of the direction from `b` to `a` at the start, such as the axis of the last miss. Default: none.
    pub axis: Option<V>,
    /// The number of times to look at, after which to give up; each takes a few support points, which
    /// [`MotionCast::iterations`](crate::MotionCast::iterations) counts. Default: 10 000.
    pub max_iterations: usize,
    #[cfg_attr(feature = "serde", serde(skip))]
    pub(crate) extra: Extra<FullMotion<V>>,
}

impl<V: Vector> MotionCastOptions<V> {
    /// The default options.
    #[must_use]
    pub fn new() -> Self {
        Self { extra: FullMotion::named(), ..Self::lean() }
    }

    /// The default options, naming no more machine code than GJK, closed forms, and what was closest a moment ago: a
    /// program in which all options are lean has a third of the code for motion casts.
    ///
    /// What is left out is the shortest way out of an overlap, the facets of two boxes, the proof that bodies without
    /// an inside have passed through one another, and the linear cast, so that motions that do not turn are searched
    /// like those that do. The search takes more support points, the bracket may be wider, and a contact that is not
    /// certain, or a graze, may be undecided where the default options know. So is, with
    /// [`StartInContact::IfDeeper`], a start that may be in contact.
    #[must_use]
    pub fn lean() -> Self {
        Self {
            max_time: V::Scalar::infinity(),
            tolerance: V::Scalar::ZERO,
            target_distance: V::Scalar::ZERO,
            start_in_contact: StartInContact::Report,
            axis: None,
            max_iterations: MAX_ITERATIONS,
            extra: Extra::NONE,
        }
    }

    setters!(max_time, tolerance, target_distance, start_in_contact, axis);

    /// With another cap on the [times to look at](Self::max_iterations).
    #[must_use]
    pub const fn with_max_iterations(mut self, max_iterations: usize) -> Self {
        self.max_iterations = max_iterations;
        self
    }
}

impl<V: Vector> Default for MotionCastOptions<V> {
    fn default() -> Self {
        Self::new()
    }
}
