//! What the fields of an answer claim, and by what each claim is checked.
//!
//! The tables [`claims`], and those of [`path`], [`joint_box`] and [`crate::clearance`], name every field that an
//! answer may have. An answer is proved if each of its fields is: one that is not in the table, or that no certificate
//! proves, leaves the answer without a proof, and is named. So does a field of the question that is not read
//! ([`crate::question::EVERY`], and the shapes of the [`crate::reader`]).

use serde_json::Value;

use crate::certificate::{Bounds, Certificate};
use crate::free::Parts;
use crate::interval::{Interval, Vector};
use crate::question::{Kind, Question};
use crate::reader::{Reader, Unread, field, only};
use crate::{growth, joint_box, motion, path};

/// What became of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It is true.
    Proved,
    /// The certificate does not show it.
    NotProved,
    /// The certificate shows that it is false.
    Disproved,
}

/// What became of an answer.
#[derive(Clone, Debug)]
pub struct Proof {
    /// Proved if every claim is, and disproved if one is.
    pub verdict: Verdict,
    /// The first claim that is not proved or is disproved, and why.
    pub because: Option<String>,
    /// What the certificate proves of a distance, a λ or a time.
    pub bounds: Option<Bounds>,
    /// What it proves of a robot's path, or of a box of its joint values.
    pub parts: Option<Parts>,
}

/// Whether a claim is true; or why that is not known.
pub(crate) type Finding = Result<bool, Unread>;

/// How the value of a field is checked.
type Check = fn(&Case<'_>, &Value) -> Finding;

/// What the fields of an answer claim, in the order of the format; each is checked by the function beside it.
fn claims(kind: Kind) -> &'static [(&'static str, Check)] {
    match kind {
        Kind::Distance => &[
            ("distance", value),
            ("overlap", overlap),
            ("point_a", point_of_a),
            ("point_b", point_of_b),
            ("normal", normal),
            ("gradient_a", unchecked),
            ("gradient_b", unchecked),
            ("smooth", unchecked),
            ("lower", lower),
            ("upper", upper),
            ("status", status),
            ("iterations", work),
        ],
        Kind::Intersect => &[("overlap", overlap), ("axis", axis), ("status", status), ("iterations", work)],
        Kind::RayCast => &[
            ("hit", hit),
            ("lambda", value),
            ("point", point_of_ray),
            ("normal", normal),
            ("lower", lower),
            ("upper", upper),
            ("certain", certain),
            ("axis", axis),
            ("status", status),
            ("iterations", work),
        ],
        Kind::LinearCast => &[
            ("hit", hit),
            ("time", value),
            ("point", point_of_contact),
            ("normal", normal),
            ("gradient_a", unchecked),
            ("gradient_b", unchecked),
            ("smooth", unchecked),
            ("lower", lower),
            ("upper", upper),
            ("certain", certain),
            ("axis", axis),
            ("status", status),
            ("iterations", work),
        ],
        Kind::Growth => &[
            ("scale", growth::scale),
            ("point", growth::point),
            ("normal", growth::normal),
            ("lower", lower),
            ("upper", upper),
            ("status", status),
            ("iterations", work),
        ],
    }
}

/// What the certificate of a line proves of its answer.
///
/// # Errors
/// Where the line is no query with an answer and a certificate, or a field of it is not read.
pub fn judge(line: &Value, reader: &Reader<'_>) -> Result<Proof, Unread> {
    let answer = field(line, "answer")?;
    let certificate = field(line, "certificate")?;
    match field(line, "query")?.as_str() {
        Some("path") => return path::judge(line, answer, certificate, reader),
        Some("joint_box") => return joint_box::judge(line, answer, certificate, reader),
        Some("motion_clearance") => return motion::judge(line, answer, certificate, reader),
        _ => {}
    }
    let question = Question::read(line, reader)?;
    only(certificate, "the certificate", &[&["plane", "points"]])?;
    let certificate = Certificate::read(certificate, question.core(), reader)?;
    let proved = question.proved(&certificate);
    let case = Case::read(line, answer, question, proved, certificate, reader)?;
    let kind = case.question.kind;
    let required: &[&str] = match kind {
        Kind::Distance => &["distance"],
        Kind::Intersect => &["overlap"],
        Kind::Growth => &["scale"],
        _ if case.is_hit == Some(true) => &["hit", kind.scalar()],
        _ => &["hit"],
    };
    let (verdict, because) = of_fields(answer, claims(kind), required, |check, value| check(&case, value));
    Ok(Proof { verdict, because, bounds: Some(case.proved), parts: None })
}

/// The verdict on the fields of an answer, and the first that is false, or not proved.
pub(crate) fn of_fields<C>(
    answer: &Value,
    table: &[(&str, C)],
    required: &[&str],
    find: impl Fn(&C, &Value) -> Finding,
) -> (Verdict, Option<String>) {
    let missing = required.iter().find_map(|name| field(answer, name).err());
    let names: Vec<&str> = table.iter().map(|(name, _)| *name).collect();
    let mut open = only(answer, "the answer", &[&names]).err().or(missing);
    for (name, check) in table {
        match answer.get(name).map(|value| find(check, value)) {
            None | Some(Ok(true)) => {}
            Some(Ok(false)) => return (Verdict::Disproved, Some(format!("{name} is false"))),
            Some(Err(why)) => open = open.or(Some(format!("{name}: {why}"))),
        }
    }
    (if open.is_none() { Verdict::Proved } else { Verdict::NotProved }, open)
}

/// Whether something is so that is proved to be so, or not to be so.
pub(crate) fn decided(is_so: bool, is_not: bool, why: &str) -> Finding {
    match (is_so, is_not) {
        (_, true) => Ok(false),
        (true, _) => Ok(true),
        _ => Err(why.to_owned()),
    }
}

/// Whether something holds; where it does not, it is not proved, since rounding may be larger than is allowed for.
pub(crate) fn within_rounding(holds: bool, why: &str) -> Finding {
    decided(holds, false, why)
}

pub(crate) fn flag(value: &Value) -> Result<bool, Unread> {
    value.as_bool().ok_or_else(|| format!("{value:.40} is neither true nor false"))
}

/// How many units of rounding, of the largest number that an answer comes by, are allowed for where a vector is
/// claimed.
pub(crate) const UNITS: f64 = 64.0;

/// An answer and what is proved of it.
pub(crate) struct Case<'c> {
    pub(crate) question: Question,
    answer: &'c Value,
    pub(crate) reader: &'c Reader<'c>,
    plane: Option<Vector>,
    pub(crate) proved: Bounds,
    /// What is claimed of the scalar: its bracket; where an end is missing, the number itself, give or take what the
    /// query allows.
    claimed: Option<Bounds>,
    /// Of a cast, whether it hits.
    is_hit: Option<bool>,
    /// What vectors may be off by rounding, at most.
    slack: Interval,
}

impl<'c> Case<'c> {
    fn read(
        line: &Value,
        answer: &'c Value,
        question: Question,
        proved: Bounds,
        certificate: Certificate,
        reader: &'c Reader<'c>,
    ) -> Result<Self, Unread> {
        let number = |name| answer.get(name).map(|value| reader.number(value).map(Interval::from)).transpose();
        let value = number(question.kind.scalar())?;
        let allow = match line.get("allow") {
            None => 0.0,
            Some(allow) => allow.as_f64().filter(|allow| *allow >= 0.0).ok_or("allow is no number from 0 up")?,
        };
        let allow = Interval::from(allow);
        let bound =
            |name, give: Interval| Ok::<_, Unread>(number(name)?.or_else(|| value.as_ref().map(|value| value + &give)));
        // By its own words a hit that is not certain may be none.
        let is_open = answer.get("certain").and_then(Value::as_bool) == Some(false);
        let above = if is_open { Interval::infinity() } else { allow.clone() };
        let claimed = bound("lower", -&allow)?.zip(bound("upper", above)?);
        let claimed = claimed.map(|(lower, upper)| Bounds { lower, upper });
        let is_hit = if question.kind.is_cast() { Some(flag(field(answer, "hit")?)?) } else { None };
        let until = value.as_ref().unwrap_or(&question.begin);
        let slack = &(&question.rounding * &Interval::from(UNITS)) * &question.magnitude(&until.absolute());
        Ok(Self {
            answer,
            reader,
            plane: certificate.plane,
            proved,
            claimed,
            is_hit,
            slack: slack.greatest(),
            question,
        })
    }

    /// What is claimed of the scalar; an error where there is none to be claimed.
    pub(crate) fn claimed(&self) -> Result<&Bounds, Unread> {
        if self.is_hit == Some(false) {
            return Err("a miss has none".to_owned());
        }
        self.claimed.as_ref().ok_or_else(|| format!("the field \"{}\" is missing", self.question.kind.scalar()))
    }

    pub(crate) fn value(&self) -> Result<Interval, Unread> {
        self.reader.number(field(self.answer, self.question.kind.scalar())?).map(Interval::from)
    }

    /// The unit vector that a field claims.
    pub(crate) fn unit(&self, value: &Value) -> Result<Vector, Unread> {
        unit(value, self.reader)
    }

    /// The claimed normal, if one is.
    pub(crate) fn normal(&self) -> Option<Vector> {
        self.answer.get("normal").and_then(|normal| self.unit(normal).ok())
    }

    /// The end of the ray counts for the upper end of a bracket.
    fn last(&self, upper: &Interval) -> Interval {
        if self.question.kind.is_cast() { upper.min(&self.question.end) } else { upper.clone() }
    }

    /// Whether a claimed lower end is true.
    fn is_not_before(&self, lower: &Interval) -> Finding {
        decided(
            lower.is_at_most(&self.proved.lower),
            self.proved.upper.is_less_than(lower),
            "the plane does not prove it",
        )
    }

    /// Whether a claimed upper end is true.
    fn is_not_after(&self, upper: &Interval) -> Finding {
        let is_finite = !self.proved.upper.is_infinite();
        let is_so = is_finite && self.proved.upper.is_at_most(&self.last(upper));
        decided(is_so, upper.is_less_than(&self.proved.lower), "the points do not prove it")
    }
}

/// A vector that is claimed to be a unit vector.
pub(crate) fn unit(value: &Value, reader: &Reader<'_>) -> Result<Vector, Unread> {
    let vector = reader.vector(value)?;
    let off = (&vector.length() - &Interval::from(1.0)).absolute();
    let is_unit = off.is_at_most(&(&reader.rounding() * &Interval::from(UNITS)));
    if is_unit { Ok(vector) } else { Err("it is no unit vector".to_owned()) }
}

/// The scalar: it is in its bracket, and an end that is not given is proved.
pub(crate) fn value(case: &Case<'_>, _: &Value) -> Finding {
    let (value, claimed) = (case.value()?, case.claimed()?);
    if value.is_less_than(&claimed.lower) || claimed.upper.is_less_than(&value) {
        return Err("it is not within its bracket".to_owned());
    }
    if case.question.end.is_less_than(&value) {
        return Err("it is beyond the end".to_owned());
    }
    let ends = [("lower", case.is_not_before(&claimed.lower)), ("upper", case.is_not_after(&claimed.upper))];
    // A number alone is claimed to its last digit, but not disproved for that.
    let digit = &case.question.rounding * &value.absolute();
    let is_far = case.proved.upper.is_less_than(&(&claimed.lower - &digit))
        || (&claimed.upper + &digit).is_less_than(&case.proved.lower);
    let missing = ends.into_iter().filter(|(name, _)| case.answer.get(name).is_none());
    let found: Vec<Finding> = missing.map(|(_, finding)| finding).collect();
    match found.contains(&Ok(false)) {
        true if is_far => Ok(false),
        true => Err("it is right to its last digit only; the query may `allow` that".to_owned()),
        false => found.into_iter().find(Result::is_err).unwrap_or(Ok(true)),
    }
}

/// The lower end of the bracket, by the plane.
fn lower(case: &Case<'_>, _: &Value) -> Finding {
    case.is_not_before(&case.claimed()?.lower)
}

/// The upper end, by the points; of a cast it is not after the end of the ray.
fn upper(case: &Case<'_>, _: &Value) -> Finding {
    case.is_not_after(&case.claimed()?.upper)
}

/// Whether there is a common point, by both ends of what is proved of the distance.
fn overlap(case: &Case<'_>, value: &Value) -> Finding {
    let zero = Interval::zero();
    let (is_met, is_apart) = (case.proved.upper.is_at_most(&zero), zero.is_less_than(&case.proved.lower));
    if flag(value)? {
        decided(is_met, is_apart, "the points do not prove a common point")
    } else {
        decided(is_apart, is_met, "the plane does not prove that they are apart")
    }
}

/// Whether a point of the ray from its beginning to its end is in the set, by both ends of what is proved of the first.
fn hit(case: &Case<'_>, value: &Value) -> Finding {
    let Case { proved, question, .. } = case;
    let is_met = !proved.upper.is_infinite() && proved.upper.is_at_most(&question.end);
    let is_missed = question.end.is_less_than(&proved.lower) || proved.lower.is_infinite();
    let finding = if flag(value)? {
        decided(is_met, is_missed, "the points do not prove a hit within the ray")
    } else {
        decided(is_missed, is_met, "the plane does not prove a miss")
    };
    // Of bodies that touch at the start only some hits count. Bodies that are apart there may be asked either way.
    if question.is_of_deeper
        && !case.plane.as_ref().is_some_and(|n| Interval::zero().is_less_than(&question.ahead(n).0))
    {
        return Err("start_in_contact is \"if_deeper\", and they are not proved to be apart at the start".to_owned());
    }
    finding
}

/// A hit is certain if it has both bounds, and a miss always.
fn certain(case: &Case<'_>, value: &Value) -> Finding {
    let has_bounds = ["lower", "upper"].iter().all(|name| case.answer.get(name).is_some());
    match (flag(value)?, case.is_hit == Some(true)) {
        (true, is_hit) => within_rounding(!is_hit || has_bounds, "a hit without both bounds is not certain"),
        (false, true) if !has_bounds => Err("it may be none, within rounding, as the answer says itself".to_owned()),
        (false, _) => Err("it is, by the other fields".to_owned()),
    }
}

/// The unit normal: the plane across it proves the lower end of the bracket, or is at the set to rounding where that is
/// the least that there is. Null where the bodies overlap, or the ray begins in the target.
fn normal(case: &Case<'_>, value: &Value) -> Finding {
    let (claimed, question) = (case.claimed()?, &case.question);
    if value.is_null() {
        // Of a ray that begins on the boundary, to rounding, it may be null.
        let off = &(&case.proved.upper - &question.begin) * &question.direction.length();
        let is_inside = case.proved.upper.is_at_most(&question.begin) || off.is_at_most(&case.slack);
        return decided(is_inside, question.begin.is_less_than(&case.proved.lower), "they are not proved to overlap");
    }
    let normal = case.unit(value)?;
    let is_least = claimed.lower.is_at_most(&question.begin);
    let holds = if is_least {
        (-&case.slack).is_at_most(&question.ahead(&normal).0)
    } else {
        claimed.lower.is_at_most(&question.lower(&normal))
    };
    within_rounding(holds, "the plane across it does not prove the lower bound")
}

/// The unit vector that separates what is apart, or the target from all of the ray, to rounding.
fn axis(case: &Case<'_>, value: &Value) -> Finding {
    let Case { question, .. } = case;
    let is_apart = if question.kind.is_cast() {
        case.is_hit == Some(false)
    } else {
        case.answer.get("overlap").and_then(Value::as_bool) == Some(false)
    };
    if !is_apart {
        return Err("it separates what is not said to be apart".to_owned());
    }
    let (ahead, normal) = question.ahead(&case.unit(value)?);
    let approach = -&normal.dot(&question.direction);
    let rounding = &question.rounding * &Interval::from(UNITS);
    let holds = if question.end.is_less_than(&question.begin) {
        true
    } else if question.end.is_infinite() {
        // To rounding of the axis the ray does not come nearer.
        approach.is_at_most(&(&rounding * &question.direction.length())) && (-&case.slack).is_at_most(&ahead)
    } else {
        let way = &question.end - &question.begin;
        let off = &case.slack + &(&rounding * &(&way * &question.direction.length()));
        let left = &ahead - &(&approach.max(&Interval::zero()) * &way);
        (-&off).is_at_most(&left)
    };
    within_rounding(holds, "the plane across it does not separate them")
}

/// The point of the ray at the scalar.
fn point_of_ray(case: &Case<'_>, value: &Value) -> Finding {
    case.claimed()?;
    let off = case.reader.vector(value)?.minus(&case.question.at(&case.value()?)).length();
    within_rounding(off.is_at_most(&case.slack), "it is not the point of the ray there")
}

fn point_of_a(case: &Case<'_>, value: &Value) -> Finding {
    closest_point(case, value, 0)
}

fn point_of_b(case: &Case<'_>, value: &Value) -> Finding {
    closest_point(case, value, 1)
}

/// A closest point: it is in its body, and the other is as far away along the normal as the distance says, to within
/// `√(2·upper·(upper − lower))` and rounding.
fn closest_point(case: &Case<'_>, value: &Value, of: usize) -> Finding {
    let claimed = case.claimed()?;
    let point = case.reader.vector(value)?;
    let normal = case.normal();
    let toward = normal.as_ref().map(|n| n.times(&Interval::from(if of == 0 { -1.0 } else { 1.0 })));
    let off = case.question.bodies[of].0.distance_from(&point, toward.as_ref(), &case.slack);
    if !off.is_at_most(&case.slack) {
        return Err("it is not proved to be in its body".to_owned());
    }
    let points = ["point_a", "point_b"].map(|name| case.reader.vector(field(case.answer, name)?));
    let [a, b] = points;
    let apart = a?.minus(&b?);
    let distance = case.value()?;
    let off = match normal {
        Some(normal) => apart.minus(&normal.times(&distance)).length(),
        None => (&apart.length() - &distance).absolute(),
    };
    let open = (&claimed.upper - &claimed.lower).max(&Interval::zero());
    let most = &(&(&claimed.upper + &claimed.upper) * &open).root() + &case.slack;
    within_rounding(off.is_at_most(&most), "the points are not the distance along the normal from one another")
}

/// A point of contact: at the time it is in both bodies, or in `b` and as near to `a` as the target distance. By how
/// much the time is open, and so across curved bodies by the root of that, they may be apart.
fn point_of_contact(case: &Case<'_>, value: &Value) -> Finding {
    let (claimed, question) = (case.claimed()?, &case.question);
    let (point, time) = (case.reader.vector(value)?, case.value()?);
    let open = &(&claimed.upper - &claimed.lower).max(&Interval::zero()) * &question.direction.length();
    let size = question.magnitude(&time.absolute());
    let slack = &(&open + &(&(&size + &size) * &open).root()) + &case.slack;
    let normal = case.normal();
    for (i, (body, velocity)) in question.bodies.iter().enumerate() {
        let sign = if i == 0 { -1.0 } else { 1.0 };
        let toward = normal.as_ref().map(|n| n.times(&Interval::from(sign)));
        let near = if i == 0 { &slack + &question.target_distance } else { slack.clone() };
        let off = body.distance_from(&point.minus(&velocity.times(&time)), toward.as_ref(), &near);
        if !off.is_at_most(&near) {
            return Err("it is not proved to be in both bodies at that time".to_owned());
        }
    }
    Ok(true)
}

/// How the search ended: a bracket that has converged is no wider than the tolerance and rounding make it.
fn status(case: &Case<'_>, value: &Value) -> Finding {
    match value.as_str() {
        Some("iteration_limit" | "stalled") => return Ok(true),
        Some("converged") => {}
        _ => return Err("it is none that is known".to_owned()),
    }
    let question = &case.question;
    if case.is_hit == Some(false) || question.kind == Kind::Intersect {
        return Ok(true);
    }
    let claimed = case.claimed()?;
    if ["lower", "upper"].iter().any(|name| case.answer.get(name).is_none()) {
        return Err("what has converged has both bounds".to_owned());
    }
    let (one, is_growth) = (Interval::from(1.0), question.kind == Kind::Growth);
    let width = match is_growth {
        // Of the λ at which the line leaves.
        true => &one.over(&claimed.lower) - &one.over(&claimed.upper),
        false => &claimed.upper - &claimed.lower,
    };
    let (width, most) = if is_growth && claimed.upper.is_zero() {
        (Interval::zero(), Interval::zero())
    } else if question.kind.is_cast() || is_growth {
        let until = if is_growth { one.over(&claimed.lower) } else { claimed.upper.absolute() };
        let size = question.magnitude(&until);
        // Along the plane's normal, in lengths. Where the ray grazes what is curved, rounding moves the hit by its
        // root.
        let approach = case.plane.as_ref().and_then(Vector::unit).map(|n| n.dot(&question.direction).absolute());
        let width = &width * &approach.unwrap_or_else(|| question.direction.length());
        (width, &(&(&size + &size) * &case.slack).root() + &(&question.tolerance * &size))
    } else {
        (width, &(&case.slack * &Interval::from(16.0)) + &(&question.tolerance * &claimed.upper))
    };
    within_rounding(width.is_at_most(&most), "the bracket is too wide to have converged")
}

/// A number of steps, which says nothing of the bodies.
fn work(_: &Case<'_>, value: &Value) -> Finding {
    value.as_u64().map(|_| true).ok_or_else(|| "it is no number of steps".to_owned())
}

/// What no certificate proves.
fn unchecked(_: &Case<'_>, _: &Value) -> Finding {
    Err("no certificate proves a derivative".to_owned())
}
