//! The ray cast as it is seen along the ray, where it is the search for a plane by two unknowns, and for a point of the
//! line in a triangle of support points.
//!
//! What is decided here, by signs and by planes in the coordinates of the [frame](ray_frame), is where to look next.
//! Where the [bracket](super::bracket) finds that in doubt, so is the answer, and Algorithm 3 takes over.

mod best_plane;
mod closing;
mod pieces;
mod ray_frame;
mod rounded;
mod smooth;
mod sqp;
mod triangle;

use convex_support::{Scalar, Vector};

use super::bracket::Bracket;
use super::{RayContact, Stop};
use ray_frame::RayFrame;
use rounded::rounded;
use smooth::smooth;
use triangle::triangle;

/// Closes the bracket, or finds a plane that the whole ray is before.
#[inline(always)]
pub(super) fn portal<V: Vector>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    // The first plane: the one given, or the tangent plane of the ball about the body where the ray enters it; and how
    // far the next one is tilted.
    let (first, tilt) = match bracket.options.axis.and_then(Vector::unit) {
        Some(axis) => (axis, V::Scalar::from_f64(0.03)),
        None => (bracket.x(), V::Scalar::ONE),
    };
    let frame = RayFrame::new(bracket.line(), Scalar::ZERO);
    let curved = frame.is_curved(bracket.body, first);
    if !curved && bracket.radius > Scalar::ZERO {
        return rounded(bracket, &frame, first, tilt);
    }
    let mut frame = if curved { RayFrame::new(bracket.line(), bracket.radius) } else { frame };
    if curved {
        match smooth(bracket, &frame, first) {
            Err(Stop::InDoubt) => {}
            found => return found,
        }
    }
    // A second time where the line was found to touch the body, and is moved inward.
    for _ in 0..2 {
        match triangle(bracket, &frame, first, tilt) {
            Err(Stop::Touches(inward)) => frame = frame.moved(inward),
            found => return found,
        }
    }
    Err(Stop::InDoubt)
}
