//! Refinement: the normal and the points right to rounding, by Newton's method along the features near those of an
//! answer.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::closest_features::{Bodies, ClosestFeatures, ClosestPoints, rounding};
use super::overlap::are_apart;
use super::span::Span;

/// The longest step of the unit normal that counts as refinement, and the most steps that are taken.
const LONGEST_STEP: f64 = 0.1;
const MAX_STEPS: usize = 5;

/// The number of rounds in which features that may hold the normal are tried, and the angle of each round as a part of
/// the last one's.
const ROUNDS: usize = 4;
const NEARER: f64 = 1.0 / 16.0;

impl<V: Vector> Bodies<'_, V> {
    /// Searches for a normal, within the angle `reach` of an answer's, along which the features overlap, as the closest
    /// points require. Returns whether there is one; features within the angle `tilt` count as held by rounding.
    ///
    /// Every feature found within `reach` is tried by making the normal exactly across it. If none fits, as when the
    /// answer is at an edge of a face within that angle, features within a smaller angle are tried.
    pub(super) fn settle(
        &self,
        features: &mut ClosestFeatures<V>,
        closest: ClosestPoints<V>,
        tilt: V::Scalar,
        reach: V::Scalar,
    ) -> bool {
        let mut within = reach;
        for _ in 0..ROUNDS {
            // NaN ends this too.
            if !(within > tilt) {
                break;
            }
            self.look(features, closest, within);
            if features.spans == [Span::Vertex; 2] {
                // They are vertices within `tilt` too.
                features.tilt = tilt;
                return self.refine(features, closest);
            }
            if self.hold(features, closest, reach) && self.refine(features, closest) {
                return true;
            }
            within *= Scalar::from_f64(NEARER);
        }
        false
    }

    /// Turns the normal to be exactly across the features found. Returns whether there is such a normal along which the
    /// features overlap.
    fn hold(&self, seen: &mut ClosestFeatures<V>, closest: ClosestPoints<V>, reach: V::Scalar) -> bool {
        let radii = self.cores.map(|core| core.radius);
        // Whether the features along another normal overlap, and are of these kinds if given.
        let is_kept = |seen: &mut ClosestFeatures<V>, normal: V, tilt, kinds: [Option<usize>; 2]| {
            let Some(normal) = normal.unit() else { return false };
            if !((normal - closest.normal).length() <= reach + reach) {
                return false;
            }
            self.look(seen, ClosestPoints { normal, ..closest }, tilt);
            seen.spans.iter().zip(kinds).all(|(span, kind)| kind.is_none_or(|kind| span.kind() == kind))
                && !are_apart(&seen.outlines, seen.slack() + tilt)
        };
        for _ in 0..MAX_STEPS {
            let kinds = seen.spans.map(Span::kind);
            let Some(step) = seen.newton_step(radii) else {
                // A face determines the normal, and each of two parallel edges a part of it.
                let normals = [0, 1].map(|i| {
                    let turn = seen.spans[i].turn(&seen.outlines[i]);
                    seen.normal + seen.out_of_plane(turn)
                });
                let most = kinds[0].max(kinds[1]);
                return (kinds[0] == most && is_kept(seen, normals[0], rounding(), [Some(most), None]))
                    || (kinds[1] == most && is_kept(seen, normals[1], rounding(), [None, Some(most)]));
            };
            // A step of Newton's method leaves the square of the error that it removes.
            let left = step.turn.length() * step.turn.length();
            if !is_kept(seen, seen.normal + step.turn, rounding::<V::Scalar>() + left, kinds.map(Some)) {
                return false;
            }
            if left <= rounding() {
                return true;
            }
        }
        false
    }

    /// Takes steps of Newton's method for the normal and the points, as long as they become shorter. Returns whether
    /// they lead to points that are opposite to each other, along the same features.
    pub(super) fn refine(&self, best: &mut ClosestFeatures<V>, closest: ClosestPoints<V>) -> bool {
        let mut length = V::Scalar::from_f64(LONGEST_STEP);
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
            // The distance is only right to the tolerance; if that is rounding, it stays.
            let error = (step.signed_distance - best.signed_distance).abs();
            if error > rounding() {
                best.signed_distance = step.signed_distance;
            }
            if size > length * Scalar::from_f64(0.5) {
                break;
            }
            let Some(normal) = (best.normal + step.turn).unit() else { return false };
            if size <= rounding() && shifts[0].max(shifts[1]) <= self.unit * rounding() {
                // The features along this normal are those found before, to rounding, and in the same coordinates:
                // another basis may be a quarter turn away if two coordinates of the normal are equal.
                best.normal = normal;
                break;
            }
            let signed_distance = best.signed_distance * self.unit;
            let kinds = best.spans.map(Span::kind);
            self.look(best, ClosestPoints { normal, points: step.points, signed_distance, ..closest }, rounding());
            if best.spans.map(Span::kind) != kinds {
                return false;
            }
            length = size;
        }
        let slack = best.slack();
        best.off() <= slack && !are_apart(&best.outlines, slack)
    }
}
