//! The closest points of two moving segments, as of capsules, in closed form.

use convex_support::{CoreKind, Parallelotope, Scalar, SupportMap, Vector};

use super::moved::Moved;
use super::moving_body::MovingBody;
use super::placed::Placed;
use super::trajectory::Trajectory;
use crate::body::PointPair;

/// The least part of the extent of both bodies that their radii are: nearly in contact, the direction of closest points that are nearer to
/// one another is not known well enough.
const THICK: f64 = 1.0 / 8.0;

/// A segment: its middle, and the vector from there to an end.
#[derive(Clone, Copy)]
struct Segment<V> {
    middle: V,
    half: V,
}

/// The cores of two bodies at time 0, each relative to its body's origin.
pub(super) struct Segments<V> {
    a: Segment<V>,
    b: Segment<V>,
}

impl<V: Vector> Segments<V> {
    /// The cores of two capsules, or other bodies that are segments and thick enough; `None` of all others.
    pub(super) fn of<A, MA, B, MB>(a: &MovingBody<'_, A, MA>, b: &MovingBody<'_, B, MB>) -> Option<Self>
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
        MA: Trajectory<Vector = V>,
        MB: Trajectory<Vector = V>,
    {
        let (radius, extent) = (a.core.radius + b.core.radius, a.core.extent + b.core.extent);
        let is_thick = radius > (extent + radius) * Scalar::from_f64(THICK);
        let segments = if is_thick { Segment::of(a).zip(Segment::of(b)) } else { None };
        segments.map(|(a, b)| Self { a, b })
    }

    /// The closest points where the bodies are at a time.
    pub(super) fn closest_points<A, B>(&self, Placed { a, b, offset, .. }: &Placed<'_, A, B>) -> PointPair<V>
    where
        A: SupportMap<Vector = V> + ?Sized,
        B: SupportMap<Vector = V> + ?Sized,
    {
        self.a.moved(a).closest_points(&self.b.moved(b), *offset)
    }
}

impl<V: Vector> Segment<V> {
    /// The core of a body, if it is a segment.
    fn of<S, M>(body: &MovingBody<'_, S, M>) -> Option<Self>
    where
        S: SupportMap<Vector = V> + ?Sized,
        M: Trajectory<Vector = V>,
    {
        if !matches!(body.core.kind, CoreKind::Polytope) {
            return None;
        }
        let Parallelotope { center: middle, half_edges: [half, others @ ..] } = body.shape.core_parallelotope()?;
        others.iter().all(|&edge| edge == V::ZERO).then_some(Self { middle, half })
    }

    fn moved<S: SupportMap<Vector = V> + ?Sized>(&self, body: &Moved<'_, S>) -> Self {
        Self { middle: body.turned(self.middle), half: body.turned(self.half) }
    }

    /// The points of two segments that are closest to one another, where this one is moved by `offset`.
    ///
    /// With `u` and `w` half of each, and `r` the vector between their middles, `|r + s·u − t·w|²` is least where
    ///
    /// > s·u² − t·u·w = −u·r,   t·w² − s·u·w = w·r,
    ///
    /// if `s` and `t` are from −1 to 1. Else one of them is at an end: the first is cut there, and then either is told by the other.
    /// Points of parallel segments are as good as others.
    fn closest_points(&self, other: &Self, offset: V) -> PointPair<V> {
        let (u, w, r) = (self.half, other.half, self.middle - other.middle + offset);
        let (uu, ww, uw) = (u.length_squared(), w.length_squared(), u.dot(w));
        let (ur, wr) = (u.dot(r), w.dot(r));
        let t = cut((uu * wr - uw * ur) / (uu * ww - uw * uw));
        let s = cut((t * uw - ur) / uu);
        let t = cut((s * uw + wr) / ww);
        PointPair { a: self.middle + u * s, b: other.middle + w * t }
    }
}

/// The nearest number from −1 to 1; one of them for NaN.
fn cut<S: Scalar>(x: S) -> S {
    x.max(-S::ONE).min(S::ONE)
}
