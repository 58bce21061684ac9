//! The ray cast in the frame of the ray, where it is the search for a plane by two unknowns, and for a point of the
//! line in a triangle of support points.
//!
//! Signs, and planes in the coordinates of the [frame](super::ray_frame), only decide where to look next. If the
//! [bracket](super::bracket) leaves the result in doubt, Algorithm 3 takes over.

mod closing;
mod pieces;
mod rounded;
mod smooth;
mod sqp;
mod triangle;

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::bracket::Bracket;
use super::{RayContact, Stop};
use crate::cast::ray_frame::RayFrame;
use rounded::rounded;
use smooth::smooth;
use triangle::triangle;

/// The tilt that shows another corner of the face that the last plane was across.
const OF_FACE: f64 = 0.03;

/// The tilt of the second plane against a first one whose error is an angle.
///
/// If it is tilted by less than that error, both may find the same point. The model of a smooth piece is right to the
/// third order of the angle; on a polytope the angle does not matter.
fn tilt<V: Vector>(bracket: &Bracket<'_, V>, error: V::Scalar) -> V::Scalar {
    let of_face = V::Scalar::from_f64(OF_FACE);
    if bracket.is_curved { (error + error).max(V::Scalar::EPSILON.sqrt()).min(of_face) } else { of_face }
}

/// Closes the bracket, or finds a plane that the whole ray is before.
#[inline(always)]
pub(super) fn portal<V: Vector>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    // The first plane: the one given, or the tangent plane of the ball about the body where the ray enters it; and how
    // far the next one is tilted.
    let told = bracket.options.warm_start.and_then(|warm| Some((warm.axis.unit()?, tilt(bracket, warm.error()))));
    let (first, tilt) = told.unwrap_or_else(|| (bracket.x(), Scalar::ONE));
    let mut frame = RayFrame::new(bracket.line());
    let curved = frame.is_curved(bracket, first);
    if !curved && bracket.radius > Scalar::ZERO {
        return rounded(bracket, &frame, first, tilt);
    }
    frame.radius = bracket.radius;
    let mut seen = None;
    if curved {
        match smooth(bracket, &frame, first, tilt < Scalar::ONE, &mut seen) {
            Err(Stop::InDoubt) => {}
            found => return found,
        }
    }
    // A second time if the line was found to touch the body, and is moved inward.
    for _ in 0..2 {
        match triangle(bracket, &frame, first, seen.take(), tilt) {
            Err(Stop::Touches(inward)) => frame.line.foot += inward,
            found => return found,
        }
    }
    Err(Stop::InDoubt)
}
