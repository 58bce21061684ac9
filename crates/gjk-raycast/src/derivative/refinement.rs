//! The normal and the points to rounding, by Newton's method along the features that are near those of an answer.

use convex_support::{Scalar, ScalarOf, SupportMap, Vector};
use num_traits::Float as _;

use super::closest_features::{Closest, ClosestFeatures, rounding};
use super::look::Bodies;
use super::overlap::are_apart;
use super::span::Span;
use crate::contact::across;

/// The longest step of the unit normal that is one of refinement, and how many are made.
const LONGEST_STEP: f64 = 0.1;
const MAX_STEPS: usize = 5;

/// In how many rounds features are tried that may hold the normal, each of which looks within a part of the last.
const ROUNDS: usize = 4;
const NEARER: f64 = 1.0 / 16.0;

impl<A, B> Bodies<'_, A, B>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    /// The features at the normal within `reach` of that of an answer along which they overlap, which is the condition of the closest points; `None`
    /// where there is none, but for what is seen within `tilt`.
    ///
    /// What is seen within reach is tried: the normal across it. Where that is none, as where the answer is at an edge of a face that is seen,
    /// what is seen within less is tried.
    pub(super) fn settled(
        &self,
        closest: Closest<A::Vector>,
        tilt: ScalarOf<A>,
        reach: ScalarOf<A>,
    ) -> Option<ClosestFeatures<A::Vector>> {
        let mut within = reach;
        for _ in 0..ROUNDS {
            // NaN ends this too.
            if !(within > tilt) {
                break;
            }
            let mut seen = self.at(closest, within);
            if seen.spans == [Span::Vertex; 2] {
                // They are so within less.
                seen.tilt = tilt;
                return self.refine(&mut seen, closest).then_some(seen);
            }
            if self.hold(closest, &mut seen, reach) && self.refine(&mut seen, closest) {
                return Some(seen);
            }
            within *= Scalar::from_f64(NEARER);
        }
        None
    }

    /// Turns to the normal across which what is seen holds it, to rounding; whether there is one, along which the features overlap.
    fn hold(&self, closest: Closest<A::Vector>, seen: &mut ClosestFeatures<A::Vector>, reach: ScalarOf<A>) -> bool {
        let radii = self.cores.map(|core| core.radius);
        let turn = |seen: &mut ClosestFeatures<A::Vector>, turn: A::Vector, tilt, sides: &[usize]| {
            let Some(normal) = (seen.normal + turn).unit() else { return false };
            if !((normal - closest.normal).length() <= reach + reach) {
                return false;
            }
            let at = self.at(Closest { normal, ..closest }, tilt);
            let is_kept = sides.iter().all(|&i| at.spans[i].kind() == seen.spans[i].kind())
                && !are_apart(&at.outlines, at.slack() + tilt);
            if is_kept {
                *seen = at;
            }
            is_kept
        };
        for _ in 0..MAX_STEPS {
            let Some(step) = seen.newton_step(radii) else {
                // A face holds all of the normal, and of two edges that are parallel each a part.
                let [a, b] = seen.spans.map(Span::kind);
                return [0, 1].into_iter().filter(|&i| [a, b][i] == a.max(b)).any(|i| {
                    let across = seen.out_of_plane(seen.spans[i].turn(&seen.outlines[i]));
                    turn(seen, across, rounding(), &[i])
                });
            };
            // A step of Newton's method leaves the square of what it takes away.
            let left = step.turn.length() * step.turn.length();
            if !turn(seen, step.turn, rounding::<ScalarOf<A>>() + left, &[0, 1]) {
                return false;
            }
            if left <= rounding() {
                return true;
            }
        }
        false
    }

    /// Newton's method for the normal and the points, as long as the steps become shorter; whether it leads to points that are opposite to each
    /// other, along the same features.
    pub(super) fn refine(&self, best: &mut ClosestFeatures<A::Vector>, closest: Closest<A::Vector>) -> bool {
        let mut length = ScalarOf::<A>::from_f64(LONGEST_STEP);
        let radii = self.cores.map(|core| core.radius);
        for _ in 0..MAX_STEPS {
            let Some(step) = best.newton_step(radii) else { break };
            let size = step.turn.length();
            // NaN ends this too.
            if !(size < length) {
                break;
            }
            let shifts = [0, 1].map(|i| (step.points[i] - best.points[i]).length());
            best.points = step.points;
            // An answer knows the distance to its tolerance; to that of rounding, it stays.
            let error = (step.signed_distance - best.signed_distance).abs();
            if error > rounding() {
                best.signed_distance = step.signed_distance;
            }
            if size > length * Scalar::from_f64(0.5) {
                break;
            }
            let Some(normal) = (best.normal + step.turn).unit() else { return false };
            if size <= rounding() && shifts[0].max(shifts[1]) <= self.unit * rounding() {
                // The features along this normal are those that were seen, to rounding.
                (best.normal, best.across) = (normal, across(normal));
                break;
            }
            let signed_distance = best.signed_distance * self.unit;
            let next = self.at(Closest { normal, points: step.points, signed_distance, ..closest }, rounding());
            if next.spans.iter().zip(&best.spans).any(|(next, best)| next.kind() != best.kind()) {
                return false;
            }
            (*best, length) = (next, size);
        }
        let slack = best.slack();
        best.off() <= slack && !are_apart(&best.outlines, slack)
    }
}
