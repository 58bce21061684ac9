//! What a least distance over a motion claims, or over a path, and by what each claim is checked.
//!
//! That nothing comes nearer than the lower bound is proved by the parts of a certificate, as that a path is free with
//! this target distance. The upper bound is proved at the claimed time, by points of both bodies. If the bodies meet,
//! the distance is zero, and the time is that of their first contact: the certificate has a bracket for it, up to the
//! beginning of which the parts prove that nothing meets, and at the end of which points prove that these two do.

use serde_json::Value;

use crate::body::Body;
use crate::claims::{Finding, decided, unit, within_rounding};
use crate::free::{Check, NOT_COVERED, NOT_MET, Obstacle};
use crate::interval::{Interval, Vector};
use crate::reader::{Reader, Unread, field};

/// A least distance that an answer claims, and what is proved of it.
pub(crate) struct Nearest<'t> {
    answer: &'t Value,
    reader: &'t Reader<'t>,
    pub(crate) time: f64,
    pub(crate) lower: Interval,
    upper: Interval,
    tolerance: Interval,
    proved: Option<Proved>,
}

struct Proved {
    /// The two bodies at the time.
    body: Body,
    met: Obstacle,
    /// Whether nothing is nearer than the lower bound.
    is_covered: bool,
    /// What the distance is no more than at the time, or at the end of the bracket of a contact.
    upper: Interval,
    /// The bracket of the contact, if there is one.
    contact: Option<[f64; 2]>,
    /// What points are off by rounding at most.
    rounding: Interval,
    /// The same, and what a contact that is only bracketed leaves open.
    slack: Interval,
}

/// What each field claims, beside those that name bodies.
pub(crate) fn claims<'t>() -> Vec<(&'static str, Check<Nearest<'t>>)> {
    vec![
        ("distance", Nearest::distance),
        ("time", Nearest::named),
        ("point_a", Nearest::point_a),
        ("point_b", Nearest::point_b),
        ("normal", Nearest::normal),
        ("lower", Nearest::lower),
        ("upper", Nearest::upper),
        ("status", Nearest::status),
    ]
}

/// The fields that an answer has to have.
pub(crate) const REQUIRED: &[&str] = &["distance", "time", "lower", "upper"];

impl<'t> Nearest<'t> {
    pub(crate) fn read(line: &Value, answer: &'t Value, reader: &'t Reader<'t>) -> Result<Self, Unread> {
        let number = |name| field(answer, name).and_then(|value| reader.number(value));
        let (time, lower, upper) = (number("time")?, number("lower")?, number("upper")?);
        if !(time >= 0.0 && lower >= 0.0 && upper >= 0.0) {
            return Err("the time or a bound is negative".to_owned());
        }
        // If none is asked for, it is the root of the rounding.
        let tolerance = line.get("tol").map(|tolerance| reader.number(tolerance)).transpose()?;
        let tolerance = tolerance.map_or_else(|| reader.rounding().root(), Interval::from);
        let [lower, upper] = [lower, upper].map(Interval::from);
        Ok(Self { answer, reader, time, lower, upper, tolerance, proved: None })
    }

    /// Whether the bodies are said to meet.
    pub(crate) fn is_contact(&self) -> bool {
        self.upper.is_zero()
    }

    /// Whether the plane across the claimed normal keeps the bodies as far apart as the lower bound at the claimed
    /// time: if there is no other time, that is a proof.
    pub(crate) fn is_by_its_normal(&self, (body, met): &(Body, Obstacle)) -> bool {
        let normal = self.answer.get("normal").and_then(|normal| self.reader.vector(normal).ok()?.unit());
        let apart = normal.and_then(|normal| met.separation(body, &normal, self.reader));
        apart.is_some_and(|apart| self.lower.is_at_most(&apart))
    }

    /// Takes what is proved: whether nothing is nearer than the lower bound; of a contact its bracket, and how far
    /// apart the bodies are at the end of that; and what rounding may change, and that and what the bracket leaves
    /// open.
    pub(crate) fn prove(
        &mut self,
        (body, met): (Body, Obstacle),
        is_covered: bool,
        contact: Option<([f64; 2], Interval)>,
        [rounding, slack]: [Interval; 2],
        certificate: &Value,
    ) -> Result<(), Unread> {
        let (contact, upper) = match contact {
            None => (None, met.clone().distance(body.clone(), certificate, self.reader)?),
            Some((at, _)) if !(at[0] <= self.time && self.time <= at[1]) => {
                return Err("the time is not within the bracket of the contact".to_owned());
            }
            Some((at, upper)) => (Some(at), upper),
        };
        // There is no distance below zero.
        let is_covered = is_covered || contact.is_none() && self.lower.is_zero();
        self.proved = Some(Proved { body, met, is_covered, upper, contact, rounding, slack });
        Ok(())
    }

    fn proved(&self) -> Result<&Proved, Unread> {
        self.proved.as_ref().ok_or_else(|| "nothing is proved".to_owned())
    }

    fn number(&self, name: &str) -> Result<Interval, Unread> {
        self.reader.number(field(self.answer, name)?).map(Interval::from)
    }

    /// What the points prove of the distance, and, if all before is proved to be farther apart, the parts.
    pub(crate) fn bounds(&self) -> Option<crate::certificate::Bounds> {
        let proved = self.proved.as_ref()?;
        let lower = if proved.is_covered { self.lower.clone() } else { Interval::zero() };
        Some(crate::certificate::Bounds { lower, upper: proved.upper.clone() })
    }

    /// The distance is within its bracket.
    fn distance(&self, _: &Value) -> Finding {
        let distance = self.number("distance")?;
        let is_within = self.lower.is_at_most(&distance) && distance.is_at_most(&self.upper);
        within_rounding(is_within, "it is not within its bracket")
    }

    /// What says where and when it is, and of which bodies, is proved with the upper bound.
    pub(crate) fn named(&self, value: &Value) -> Finding {
        self.upper(value)
    }

    fn lower(&self, _: &Value) -> Finding {
        let proved = self.proved()?;
        decided(proved.is_covered, proved.upper.is_less_than(&self.lower), NOT_COVERED)
    }

    fn upper(&self, _: &Value) -> Finding {
        let proved = self.proved()?;
        let is_below = proved.is_covered && self.upper.is_less_than(&self.lower);
        // Of a first contact, nothing may be met before.
        let is_so = proved.upper.is_at_most(&self.upper) && (proved.contact.is_none() || proved.is_covered);
        decided(is_so, is_below, NOT_MET)
    }

    /// The unit normal: at the time the plane across it proves the lower bound, to rounding, or that the bodies do not
    /// overlap by more than a bracket leaves open. Null where they overlap from the first.
    fn normal(&self, value: &Value) -> Finding {
        let Proved { body, met, upper, contact, rounding, slack, .. } = self.proved()?;
        if value.is_null() {
            let is_at_once = upper.is_zero() && contact.is_some_and(|at| at == [0.0; 2]);
            return within_rounding(is_at_once, "they are not proved to overlap from the first");
        }
        let apart = met.separation(body, &unit(value, self.reader)?, self.reader);
        let least = &self.lower - if contact.is_some() { slack } else { rounding };
        let holds = apart.is_some_and(|apart| least.is_at_most(&apart));
        within_rounding(holds, "the plane across it does not separate the bodies at the time")
    }

    fn point_a(&self, value: &Value) -> Finding {
        let Proved { body, contact, rounding, slack, .. } = self.proved()?;
        let slack = if contact.is_some() { slack } else { rounding };
        let toward = self.toward(-1.0);
        let off = body.distance_from(&self.reader.vector(value)?, toward.as_ref(), slack);
        within_rounding(off.is_at_most(slack) && self.are_so_far_apart()?, "it is not proved to be closest")
    }

    fn point_b(&self, value: &Value) -> Finding {
        let Proved { met, contact, rounding, slack, .. } = self.proved()?;
        let slack = if contact.is_some() { slack } else { rounding };
        let point = self.reader.vector(value)?;
        let is_in = match met {
            Obstacle::Body(met) => met.distance_from(&point, self.toward(1.0).as_ref(), slack).is_at_most(slack),
            Obstacle::HalfSpace(..) => met.is_near(&point, slack),
        };
        within_rounding(is_in && self.are_so_far_apart()?, "it is not proved to be closest")
    }

    /// The claimed normal, seen from the body that it points into or out of.
    fn toward(&self, sign: f64) -> Option<Vector> {
        let normal = self.answer.get("normal").and_then(|normal| unit(normal, self.reader).ok())?;
        Some(normal.times(&Interval::from(sign)))
    }

    /// Whether the points are the distance from one another, to rounding, or to what a bracket leaves open.
    fn are_so_far_apart(&self) -> Result<bool, Unread> {
        let Proved { contact, rounding, slack, .. } = self.proved()?;
        let [a, b] = ["point_a", "point_b"].map(|name| self.reader.vector(field(self.answer, name)?));
        let off = (&a?.minus(&b?).length() - &self.number("distance")?).absolute();
        Ok(off.is_at_most(if contact.is_some() { slack } else { rounding }))
    }

    /// How the search ended: a bracket that has converged is no wider than the tolerance and rounding make it.
    fn status(&self, value: &Value) -> Finding {
        let Proved { rounding, contact, .. } = self.proved()?;
        match value.as_str() {
            Some("iteration_limit" | "stalled") => return Ok(true),
            Some("converged") => {}
            _ => return Err("it is none that is known".to_owned()),
        }
        let width = &self.upper - &self.lower;
        let most = &(rounding * &Interval::from(16.0)) + &(&self.tolerance * &self.upper);
        let is_narrow = contact.is_some() || width.is_at_most(&most);
        within_rounding(is_narrow, "the bracket is too wide to have converged")
    }
}
