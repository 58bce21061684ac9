//! How much two bodies have to grow about their centres until they touch.
//!
//! With `d` from the centre of `a` to that of `b`, and `C = (A − c_A) − (B − c_B)`, it is the least `s` with `d` in
//! `s·C`. A plane that has `C` behind it, `n·y ≤ h(n)`, says `n·d ≤ s·h(n)`. Points of `C` say where the line `λ·d` is
//! in it, and so that `s` is no more than `1/λ`.

use serde_json::Value;

use crate::certificate::{Bounds, Certificate};
use crate::claims::{Case, Finding, UNITS, decided, value, within_rounding};
use crate::interval::{Interval, Vector};
use crate::question::Question;

impl Question {
    /// What a certificate proves of the scale.
    pub(crate) fn proved_of_growth(&self, certificate: &Certificate) -> Bounds {
        let zero = Interval::zero;
        if self.direction.squared().is_zero() {
            return Bounds { lower: zero(), upper: zero() };
        }
        let lower = certificate.plane.as_ref().map_or_else(zero, |plane| self.least_scale(plane));
        let last = self.pierced(certificate).chain(self.exit_of_ball(certificate));
        let upper = last.map(|last| Interval::from(1.0).over(&last)).reduce(|a, b| a.min(&b));
        Bounds { lower, upper: upper.map_or_else(Interval::infinity, |upper| upper.greatest()) }
    }

    /// The least scale that the plane across a normal leaves, which is told from `b` to `a`, into `C`.
    fn least_scale(&self, told: &Vector) -> Interval {
        let normal = told.times(&Interval::from(-1.0));
        let (reach, along) = (self.reach(&normal), normal.dot(&self.direction));
        match Interval::zero().is_less_than(&along) {
            true if Interval::zero().is_less_than(&reach) => along.over(&reach).least(),
            _ => Interval::zero(),
        }
    }

    /// Where the line leaves the ball that sweeps the mean of the points: the greater root of `|λd − p|² = r²`.
    fn exit_of_ball(&self, certificate: &Certificate) -> Option<Interval> {
        let mean = certificate.mean()?;
        let (a, b) = (self.direction.squared(), self.direction.dot(&mean));
        let discriminant = &b.squared() - &(&a * &(&mean.squared() - &self.set.radius.squared()));
        let last = (&b + &discriminant.root()).over(&a);
        (discriminant.is_not_negative() && Interval::zero().is_less_than(&last)).then_some(last)
    }

    /// What rounding may move a point of a body by, where the bodies are of their own size: it is computed with this
    /// point of the grown body, and this scale.
    fn rounding_of(&self, i: usize, grown: &Vector, scale: &Interval) -> Interval {
        let way = grown.minus(&self.centers[i]).length();
        let way = if scale.is_zero() { way } else { (&way + &grown.length()).over(scale) };
        let size = &(&self.bodies[i].0.magnitude() + &self.centers[i].length()) + &way;
        (&(&self.rounding * &Interval::from(UNITS)) * &size).greatest()
    }
}

/// The scale: the centres are in their bodies, and it is in its bracket.
pub(crate) fn scale(case: &Case<'_>, claimed: &Value) -> Finding {
    let question = &case.question;
    for (i, (body, _)) in question.bodies.iter().enumerate() {
        let center = &question.centers[i];
        let slack = question.rounding_of(i, center, &Interval::zero());
        if !body.distance_from(center, None, &slack).is_at_most(&slack) {
            return Err("a centre is not proved to be in its body".to_owned());
        }
    }
    value(case, claimed)
}

/// The unit normal: the plane across it proves the lower end of the bracket. Null where the centres coincide.
pub(crate) fn normal(case: &Case<'_>, value: &Value) -> Finding {
    let (claimed, question) = (case.claimed()?, &case.question);
    if value.is_null() {
        let (coincide, differ) = (case.proved.upper.is_zero(), Interval::zero().is_less_than(&case.proved.lower));
        return decided(coincide, differ, "the centres are not proved to coincide");
    }
    let holds = claimed.lower.is_at_most(&question.least_scale(&case.unit(value)?));
    within_rounding(holds, "the plane across it does not prove the lower bound")
}

/// A point that both bodies have in common at the scale, to rounding, and to what the bracket leaves open: by so much
/// it may be off along the line, and across curved bodies by the root of that.
pub(crate) fn point(case: &Case<'_>, value: &Value) -> Finding {
    let (claimed, question, scale) = (case.claimed()?, &case.question, case.value()?);
    let point = case.reader.vector(value)?;
    let normal = case.normal();
    for (i, (body, _)) in question.bodies.iter().enumerate() {
        let center = &question.centers[i];
        let slack = question.rounding_of(i, &point, &scale);
        if scale.is_zero() {
            if !point.minus(center).length().is_at_most(&slack) {
                return Err("it is not the centre of both".to_owned());
            }
            continue;
        }
        let width = (&claimed.upper - &claimed.lower).max(&Interval::zero()).over(&scale);
        let (way, size) = (question.direction.length().over(&scale), body.magnitude());
        let open = &(&width * &way) + &slack;
        let slack = (&open + &(&(&size + &size) * &open).root()).greatest();
        let shrunk = center.plus(&point.minus(center).times(&Interval::from(1.0).over(&scale)));
        let toward = normal.as_ref().map(|n| n.times(&Interval::from(if i == 0 { -1.0 } else { 1.0 })));
        if !body.distance_from(&shrunk, toward.as_ref(), &slack).is_at_most(&slack) {
            return Err("it is not proved to be in both bodies at that scale".to_owned());
        }
    }
    Ok(true)
}
