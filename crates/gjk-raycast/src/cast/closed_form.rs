//! The hit in closed form, where the shape knows the crossing of its core by a line.
//!
//! As with a search, what the shape says is where to look: the plane at the entry is that of a support point, and ends
//! or begins the bracket. Points between entry and exit are taken for points of the body, as the shape promises; if
//! they are not where the planes are, the answer is in doubt.

use convex_support::{Crossing, LineCrossing, Vector};
use num_traits::Float as _;

use super::bracket::Bracket;
use super::{RayContact, Stop};

/// Closes the bracket between the plane at the entry and the entry, or finds a plane that the whole ray is before.
#[inline(always)]
pub(super) fn closed_form<V: Vector>(bracket: &mut Bracket<'_, V>) -> Result<RayContact<V>, Stop<V>> {
    let line = bracket.line();
    // Closed forms square lengths.
    if !bracket.is_moderate {
        return Err(Stop::InDoubt);
    }
    match bracket.body.line_crossing(line.foot, line.direction) {
        LineCrossing::Unknown => Err(Stop::InDoubt),
        LineCrossing::Misses(axis) => {
            bracket.doubt_entry();
            // Where no other is known, the plane across the vector to the line is one along it.
            let axis = axis.unit().or(bracket.options.axis).or_else(|| line.foot.unit()).ok_or(Stop::InDoubt)?;
            support(bracket, axis)?;
            Err(Stop::InDoubt)
        }
        LineCrossing::Crosses(Crossing { entry, normal, .. }) => {
            let start = bracket.ray.start;
            // What is in the body by two errors is so for certain: one moves the body, and one what is computed of the
            // line.
            let by = bracket.error + bracket.error;
            let eroded = bracket.body.eroded_line_crossing(line.foot, line.direction, by);
            match eroded {
                LineCrossing::Crosses(within) if within.entry < start && start < within.exit => {
                    return Ok(bracket.close_inside());
                }
                LineCrossing::Misses(_) | LineCrossing::Unknown => bracket.doubt_entry(),
                LineCrossing::Crosses(_) => {}
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
                Ok(found) => {
                    if let LineCrossing::Crosses(within) = eroded {
                        bracket.enter_for_certain(within.entry);
                    }
                    Ok(found)
                }
                Err(stop) => {
                    bracket.doubt_entry();
                    Err(stop)
                }
            }
        }
    }
}

/// Takes the plane across `n` that supports the body.
#[inline(always)]
fn support<V: Vector>(bracket: &mut Bracket<'_, V>, n: V) -> Result<(), Stop<V>> {
    let n = n.unit().ok_or(Stop::InDoubt)?;
    let (point, _) = bracket.support(n, n, &[])?;
    bracket.advance(n, point)
}
