//! The ray cast as it is seen along the ray, where it is the search for a plane by two unknowns, and for a point of the
//! line in a triangle of support points.
//!
//! What is decided here, by signs and by planes in the coordinates of the [frame](super::ray_frame), is where to look
//! next. Where the [bracket](super::bracket) finds that in doubt, so is the answer, and Algorithm 3 takes over.

mod best_plane;
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

/// By how much the second plane is tilted from a first one that is off by an angle.
///
/// If it is tilted by less than the first one is off, both may show the same point. A smooth piece that is looked at
/// from aside is known to the third order of that angle; where a polytope is looked at along, it is the same.
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
    let core = RayFrame::new(bracket.line());
    let curved = core.is_curved(bracket, first);
    if !curved && bracket.radius > Scalar::ZERO {
        return rounded(bracket, &core, first, tilt);
    }
    let mut frame = RayFrame { radius: bracket.radius, ..core };
    let mut seen = None;
    if curved {
        match smooth(bracket, &frame, first, tilt < Scalar::ONE, &mut seen) {
            Err(Stop::InDoubt) => {}
            found => return found,
        }
    }
    // A second time where the line was found to touch the body, and is moved inward.
    for _ in 0..2 {
        match triangle(bracket, &frame, first, seen.take(), tilt) {
            Err(Stop::Touches(inward)) => frame.line.foot += inward,
            found => return found,
        }
    }
    Err(Stop::InDoubt)
}
