//! What all casts claim: the first time at which something happens, or that it does not happen before an end.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use convex_support::{Scalar, Vector};

use super::planes::{dot, length, minus, numbers};
use super::{Law, Numbers, Report};
use crate::{Cast, Impact, Outcome, Status};

/// How far apart or deep the bodies may be within a converged bracket, in units of ε times the size and the way, plus
/// the errors.
const WIDTH_OF_CASTS: f64 = 1024.0;

/// How far a plane may be from where it should be, in the same unit.
const PLANE: f64 = 64.0;

/// A cast's answer to one question with some options.
pub(super) struct Told {
    how: &'static str,
    /// The end of the ray or the motion in this question.
    end: f64,
    said: Said,
    lower: f64,
    upper: f64,
    is_certain: bool,
    is_converged: bool,
    /// The tolerance that was asked for.
    pub(super) tolerance: f64,
    answer: String,
}

#[derive(Clone, Copy)]
enum Said {
    Hit { time: f64, normal: Option<Numbers> },
    Miss { axis: Numbers },
    Undecided,
}

impl Told {
    pub(super) fn new<H: core::fmt::Debug, V: Vector>(
        how: &'static str,
        end: V::Scalar,
        cast: &Cast<H, V>,
        hit: impl Fn(&H) -> (V::Scalar, Option<V>),
    ) -> Self {
        let said = match &cast.outcome {
            Outcome::Hit(found) => {
                let (time, normal) = hit(found);
                Said::Hit { time: time.as_f64(), normal: normal.map(numbers) }
            }
            Outcome::Miss(miss) => Said::Miss { axis: numbers(miss.axis) },
            Outcome::Undecided => Said::Undecided,
        };
        Self {
            how,
            end: end.as_f64(),
            said,
            lower: cast.lower.as_f64(),
            upper: cast.upper.as_f64(),
            is_certain: cast.is_certain(),
            is_converged: cast.status == Status::Converged,
            tolerance: 0.0,
            answer: format!("{cast:?}"),
        }
    }

    /// The cast of two bodies that move, in either order, with a tolerance.
    pub(super) fn of_motion<V: Vector>(
        how: &'static str,
        [end, tolerance]: [V::Scalar; 2],
        cast: &Cast<Impact<V>, V>,
        is_reversed: bool,
    ) -> Self {
        let normal = |hit: &Impact<V>| hit.normal.map(|n| if is_reversed { -n } else { n });
        let mut one = Self::new(how, end, cast, |hit| (hit.time, normal(hit)));
        one.tolerance = tolerance.as_f64();
        if let (true, Said::Miss { axis }) = (is_reversed, &mut one.said) {
            *axis = minus(*axis);
        }
        one
    }

    pub(super) fn is_certain_hit(&self) -> bool {
        self.is_certain && matches!(self.said, Said::Hit { .. })
    }

    pub(super) fn is_miss(&self) -> bool {
        matches!(self.said, Said::Miss { .. })
    }

    /// What was answered, for people.
    pub(super) fn answer(&self) -> &str {
        &self.answer
    }

    /// The bounds on the time, as told.
    pub(super) fn bounds(&self) -> [f64; 2] {
        [self.lower, self.upper]
    }

    pub(super) fn normal(&self) -> Option<Numbers> {
        match self.said {
            Said::Hit { normal, .. } => normal,
            Said::Miss { axis } => Some(axis),
            Said::Undecided => None,
        }
    }

    /// It happens at this time at the latest, if that is certain.
    pub(super) fn latest(&self) -> f64 {
        if self.is_certain_hit() { self.upper.min(self.end) } else { f64::INFINITY }
    }

    /// It does not happen before this time; for a miss, not at it either.
    pub(super) fn earliest(&self) -> f64 {
        if self.is_miss() { self.end } else { self.lower }
    }
}

/// How far the ray's point, or body `a`, is before the plane across a normal at a time.
pub(super) type Beyond<'f> = &'f dyn Fn(Numbers, f64) -> [f64; 2];

/// The same for a motion without an end: what does not go towards the plane, by more than its own error, is before it
/// for ever.
pub(super) fn beyond_without_end(n: Numbers, velocity: Numbers, error: f64) -> [f64; 2] {
    if dot(n, velocity) > length(n) * error { [f64::INFINITY; 2] } else { [f64::NEG_INFINITY, f64::INFINITY] }
}

/// Bounds on the signed distance of the bodies at a time.
pub(super) type Gap<'f> = &'f dyn Fn(f64) -> Option<[f64; 2]>;

/// The claims of casts about one motion.
pub(super) struct Casts<'f> {
    pub(super) query: &'static str,
    /// The rounding of a length, by the sizes and the reach of the motion.
    pub(super) unit: f64,
    /// What a tolerance is relative to.
    pub(super) size: f64,
    /// The distance at which bodies count as touching.
    pub(super) target: f64,
    /// The bodies at a time, where their hit is their contact.
    pub(super) gap: Option<Gap<'f>>,
    /// How far body `a` is before the plane, where the motion is straight.
    pub(super) beyond: Option<Beyond<'f>>,
    /// The planes to try besides those of the answers.
    pub(super) normals: Vec<Numbers>,
}

impl Casts<'_> {
    /// Holds the answers against one another and against planes.
    pub(super) fn judge(&self, told: &[Told], report: &mut Report) {
        let mut seen: Vec<[f64; 2]> = Vec::new();
        for one in told {
            self.alone(one, report);
            let bounds = one.bounds();
            if one.is_certain_hit() && one.is_converged && !seen.contains(&bounds) {
                seen.push(bounds);
                self.width(self.query, bounds, one.tolerance, report, || format!("{}: {}", one.how, one.answer));
            }
        }
        self.together(told, report);
        if let Some(beyond) = self.beyond {
            self.planes(told, beyond, report);
        }
    }

    /// A converged bracket holds only times at which the bodies are as good as in contact: neither farther apart nor
    /// deeper than the rounding, which a width in time cannot tell of a hit that grazes.
    pub(super) fn width(
        &self,
        query: &'static str,
        [lower, upper]: [f64; 2],
        tolerance: f64,
        report: &mut Report,
        what: impl FnOnce() -> String,
    ) {
        let Some(gap) = self.gap.filter(|_| lower < upper) else { return };
        let times = [lower, 0.75 * lower + 0.25 * upper, 0.5 * (lower + upper), 0.25 * lower + 0.75 * upper, upper];
        let gaps = times.into_iter().filter_map(gap);
        // Where the bodies begin in contact, they are no deeper than there.
        let least = if lower == 0.0 {
            gap(0.0).map_or(self.target, |[deepest, _]| deepest.min(self.target))
        } else {
            self.target
        };
        let off = gaps.fold(0.0, |off: f64, [lower, upper]| off.max(lower - self.target).max(least - upper));
        let allowed = WIDTH_OF_CASTS * self.unit + tolerance * self.size;
        report.widest(query, off / allowed);
        report.claim((Law::Width, query), off <= allowed, || {
            let part = off / allowed;
            format!("[{lower:e}, {upper:e}] has the bodies {part:.1e} times as deep or far as allowed, {}", what())
        });
    }

    fn alone(&self, told: &Told, report: &mut Report) {
        let query = self.query;
        let say = |what: &str| format!("{}, {what}: {}", told.how, told.answer);
        report
            .claim((Law::Bound, query), !(told.lower.is_nan() || told.upper.is_nan()), || say("a bound is no number"));
        match told.said {
            Said::Hit { time, .. } => {
                let is_within = told.lower <= time && time <= told.upper && time <= told.end;
                report.claim((Law::Bound, query), is_within, || say("the hit is not within its bounds or the end"));
                report.claim((Law::Certain, query), told.is_certain || !told.is_converged, || {
                    say("it has converged to a hit that is not certain")
                });
            }
            Said::Miss { .. } => {
                let agrees = told.lower >= told.end || told.end < 0.0;
                report.claim((Law::Certain, query), agrees, || say("it is a miss, with a lower bound before the end"));
            }
            Said::Undecided => {
                report.claim((Law::Certain, query), !told.is_converged, || say("it has converged, undecided"));
            }
        }
    }

    /// All brackets hold one time.
    fn together(&self, told: &[Told], report: &mut Report) {
        let latest = told.iter().min_by(|x, y| x.latest().total_cmp(&y.latest()));
        let Some(hit) = latest.filter(|hit| hit.latest() < f64::INFINITY) else { return };
        for one in told {
            let (earliest, latest) = (one.earliest(), hit.latest());
            let holds = if one.is_miss() { earliest < latest || one.end < 0.0 } else { earliest <= latest };
            let law = if one.is_miss() { Law::Certain } else { Law::Overlap };
            report.claim((law, self.query), holds, || {
                format!(
                    "{} it is not before {earliest:e} (end {:e}), {} it is at {latest:e} at the latest (end {:e}): {}; {}",
                    one.how, one.end, hit.how, hit.end, one.answer, hit.answer
                )
            });
        }
    }

    /// No plane refutes what is said: the bodies are not yet as near as that where they are said to touch.
    ///
    /// Of all hits, the one that is said to be the earliest claims most.
    fn planes(&self, told: &[Told], beyond: Beyond<'_>, report: &mut Report) {
        let mut normals: Vec<Numbers> = Vec::new();
        for n in told.iter().filter_map(Told::normal).chain(self.normals.iter().copied()) {
            if !normals.contains(&n) {
                normals.push(n);
            }
        }
        let query = self.query;
        let first = told.iter().min_by(|x, y| x.latest().total_cmp(&y.latest()));
        if let Some(one) = first.filter(|one| one.latest() < f64::INFINITY) {
            // Whoever is before a plane at both ends is before it at all times between.
            let from = if one.upper <= one.end { one.lower } else { 0.0 };
            for &n in &normals {
                let at_end = beyond(n, one.latest())[0];
                let is_missed = at_end > self.target && beyond(n, from)[0] > self.target;
                report.claim((Law::Bound, query), !is_missed, || {
                    format!(
                        "{}, a plane across {n:?} separates by {at_end:e} at {:e}, the upper bound or the end: {}",
                        one.how,
                        one.latest(),
                        one.answer
                    )
                });
            }
        }
        let slack = PLANE * self.unit;
        let mut seen: Vec<(Numbers, f64)> = Vec::new();
        for one in told {
            let (normal, time, what) = match one.said {
                // A bracket that is not closed may be that of another plane.
                Said::Hit { normal: Some(n), .. } if one.is_converged && one.tolerance == 0.0 && one.lower > 0.0 => {
                    (n, one.lower, "has been passed at the lower bound")
                }
                Said::Miss { axis } if one.end >= 0.0 => (axis, 0.0, "has the start behind it"),
                _ => continue,
            };
            if seen.contains(&(normal, time)) {
                continue;
            }
            seen.push((normal, time));
            let apart = beyond(normal, time)[1];
            report.claim((Law::Points, query), apart >= self.target - slack, || {
                format!("{}, the plane across the normal {what}, by {apart:e}: {}", one.how, one.answer)
            });
        }
    }
}
