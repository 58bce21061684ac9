//! The hit in closed form, where the shape knows the crossing of its core by a line.
//!
//! As with a search, what the shape says is where to look: the plane at the entry is that of a support point, and ends
//! or begins the bracket. Points between entry and exit are taken for points of the body, as the shape promises; if
//! they are not where the planes are, the answer is in doubt.

use convex_support::numerics::bound::roundings;
use convex_support::{CertainCrossing, Crossing, LineCrossing, LineQuery, Vector};
use num_traits::Float as _;

use super::bracket::Bracket;
use super::line::Line;
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
            let latest = latest_entry(bracket, line);
            if latest.is_none() {
                bracket.doubt_entry();
            }
            let reversed = Line { direction: -line.direction, ..line };
            if latest.is_some_and(|entry| entry < start)
                && latest_entry(bracket, reversed).is_some_and(|exit| start < -exit)
            {
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
                Ok(found) => {
                    if let Some(latest) = latest {
                        bracket.enter_for_certain(latest);
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

/// Where a line is in the body for certain, at the latest, however far the error of a point of it moves it: what is
/// computed of it there, and what the shape is wrong by, the shape knows.
fn latest_entry<V: Vector>(bracket: &Bracket<'_, V>, Line { foot, direction }: Line<V>) -> Option<V::Scalar> {
    let scale = bracket.scale;
    let source = bracket.body.measures().origin + foot * scale;
    let error = bracket.error * scale + roundings(1.0, source.norm());
    match bracket.body.certain_crossing(LineQuery::new(source, direction * scale).within(error))? {
        CertainCrossing::Enters { bounds: [_, latest], .. } => Some(latest),
        CertainCrossing::Misses(_) => None,
    }
}

/// Takes the plane across `n` that supports the body.
#[inline(always)]
fn support<V: Vector>(bracket: &mut Bracket<'_, V>, n: V) -> Result<(), Stop<V>> {
    let n = n.unit().ok_or(Stop::InDoubt)?;
    let (point, _) = bracket.support(n, n, &[])?;
    bracket.advance(n, point)
}
