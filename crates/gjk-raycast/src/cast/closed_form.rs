//! The hit in closed form, where the shape knows the crossing of its core by a line.
//!
//! As with a search, what the shape says is where to look: the plane at the entry is that of a support point, and ends or
//! begins the bracket. Points between entry and exit are taken for points of the body, as the shape promises; if they are not
//! where the planes are, the answer is in doubt.

use convex_support::{Crossing, LineCrossing, Scalar, Vector};
use num_traits::Float as _;

use super::bracket::{Bracket, ScalarOf};
use super::{Contact, Stop};
use crate::Iterate;
use crate::body::Body;

/// Closes the bracket between the plane at the entry and the entry, or finds a plane that the whole ray is before.
#[inline(always)]
pub(super) fn closed_form<B: Body, O: FnMut(Iterate<'_, B::Vector>)>(
    bracket: &mut Bracket<'_, B, O>,
) -> Result<Contact<B>, Stop<B::Vector>> {
    let line = bracket.line();
    // Closed forms square lengths.
    if !bracket.is_moderate {
        return Err(Stop::InDoubt);
    }
    match bracket.body.line_crossing(line.foot, line.direction) {
        LineCrossing::Unknown => Err(Stop::InDoubt),
        LineCrossing::Misses => {
            // The plane across the vector to the line is one along it.
            let axis = bracket.options.axis.or_else(|| line.foot.unit()).ok_or(Stop::InDoubt)?;
            support(bracket, axis)?;
            Err(Stop::InDoubt)
        }
        LineCrossing::Crosses(Crossing { entry, exit, normal }) => {
            let start = bracket.ray.start;
            if start > entry && start < exit && is_inside(bracket, (start - entry).min(exit - start)) {
                return Ok(bracket.close_inside());
            }
            if entry < start {
                return Err(Stop::InDoubt);
            }
            support(bracket, normal)?;
            let point = line.at(entry) - normal * bracket.radius;
            let witness = bracket.body.witness(point);
            match bracket.close(point, witness, entry) {
                // A plane that the line runs along to rounding is crossed anywhere; but the line touches the point.
                Err(Stop::InDoubt) if normal.dot(line.direction).abs() <= bracket.noise => {
                    let aside = line.across(line.foot - point);
                    bracket.close_beside(aside, bracket.noise, point, witness, Some(normal)).ok_or(Stop::InDoubt)
                }
                closed => closed,
            }
        }
    }
}

/// Whether the source, with a `margin` of the line before and behind it in the body, is in the body for certain.
///
/// A line may run along the surface, wrong by an error, for any margin. So do chords across it count, too: their ends are on the surface
/// but for an error `e`, and with the least margin `m` the hull of all of them has a ball of radius `m/√3` about the source, of which the
/// body has all but `e`. The source is wrong by another.
#[cold]
#[inline(never)]
fn is_inside<B: Body, O: FnMut(Iterate<'_, B::Vector>)>(bracket: &Bracket<'_, B, O>, margin: ScalarOf<B>) -> bool {
    let (line, start) = (bracket.line(), bracket.ray.start);
    let across = line.axes().into_iter().take(B::Vector::DIM - 1);
    let least = across.fold(margin, |least, axis| match bracket.body.line_crossing(line.at(start), axis) {
        LineCrossing::Crosses(Crossing { entry, exit, .. }) => least.min(exit.min(-entry)),
        LineCrossing::Misses | LineCrossing::Unknown => Scalar::ZERO,
    });
    least > bracket.error * Scalar::from_f64(4.0)
}

/// Takes the plane across `n` that supports the body.
#[inline(always)]
fn support<B: Body, O: FnMut(Iterate<'_, B::Vector>)>(
    bracket: &mut Bracket<'_, B, O>,
    n: B::Vector,
) -> Result<(), Stop<B::Vector>> {
    let n = n.unit().ok_or(Stop::InDoubt)?;
    let (point, _) = bracket.support(n, n, &[])?;
    bracket.advance(n, point)
}
