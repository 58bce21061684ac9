//! Whether a robot's path is free, or what it meets first, and how near it comes to anything.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::body::Body;
use crate::claims::{Finding, Proof, Verdict, flag, of_fields, unit, within_rounding};
use crate::clearance::{self, Nearest};
use crate::free::{Check, NOT_CERTAIN, NOT_COVERED, NOT_MET, Obstacle, Parts, Surrounded, Who, count, numbers};
use crate::interval::Interval;
use crate::moving::{OnEdge, Places, TimedPlanes, apart_until, planes, values_at};
use crate::question::{EVERY, target_distance};
use crate::reader::{Reader, Unread, field, listed, only};

/// What the fields of the answer claim.
fn claims<'t>() -> Vec<(&'static str, Check<Case<'t>>)> {
    vec![
        ("free", Case::free),
        ("edge", Case::named),
        ("time", Case::time),
        ("link", Case::named),
        ("body", Case::named),
        ("obstacle", Case::named),
        ("other_link", Case::named),
        ("other_body", Case::named),
        ("point", Case::point),
        ("normal", Case::normal),
        ("lower", Case::lower),
        ("upper", Case::upper),
        ("certain", Case::certain),
        ("status", Case::status),
        ("clearance", Case::clearance),
        ("casts", Case::work),
    ]
}

/// The fields of the question beside those of the robot and what is around it.
const FIELDS: &[&str] = &["waypoints", "target_distance", "clearance"];

/// The path of a robot, and what is around it.
struct Way<'t> {
    around: Surrounded,
    waypoints: Vec<Vec<f64>>,
    reader: &'t Reader<'t>,
}

/// What the certificate of a `path` proves.
pub(crate) fn judge(line: &Value, answer: &Value, certificate: &Value, reader: &Reader<'_>) -> Result<Proof, Unread> {
    only(line, "the query", &[EVERY, Surrounded::FIELDS, FIELDS])?;
    only(certificate, "the certificate", &[&["plane", "points", "free", "clearance"]])?;
    let target = target_distance(line, reader)?;
    let way = Way::read(line, reader)?;
    let is_free = flag(field(answer, "free")?)?;
    let mut parts = Parts::of(is_free);
    let free = way.free(certificate, &target, &mut parts)?;
    let contact = if is_free { None } else { Some(Contact::read(answer, &way)?) };
    let until = contact.as_ref().map_or((way.edges(), 0.0), |contact| (contact.edge, contact.lower));
    let is_covered = way.is_free_until(&free, until);
    let is_met = contact.as_ref().map_or(Ok(false), |contact| contact.is_met(&way, certificate, &target))?;
    let nearest = certificate.get("clearance").zip(answer.get("clearance"));
    let nearest = nearest.map(|(certificate, claimed)| way.nearest(line, claimed, certificate, &mut parts)).transpose();
    // Where nothing is asked about nothing is near.
    let asks = line.get("clearance").map_or(Ok(false), flag)? && way.around.asked().next().is_some();
    let mut required = if is_free { vec!["free"] } else { vec!["free", "certain"] };
    required.extend(asks.then_some("clearance"));
    let case = Case { way: &way, target: &target, contact, is_covered, is_met, nearest };
    Ok(parts.proof(of_fields(answer, &claims(), &required, |check, value| check(&case, value))))
}

/// What a part of a certificate is about: the edge, and the two bodies.
type Key = (usize, Who);

impl<'t> Way<'t> {
    fn read(line: &Value, reader: &'t Reader<'t>) -> Result<Self, Unread> {
        let around = Surrounded::read(line, reader)?;
        let waypoints = listed(field(line, "waypoints")?)?;
        let waypoints = waypoints.iter().map(|row| numbers(row, reader)).collect::<Result<Vec<_>, _>>()?;
        if waypoints.is_empty() || waypoints.iter().any(|row| row.len() != around.robot.values) {
            return Err("a waypoint has another number of values".to_owned());
        }
        Ok(Self { around, waypoints, reader })
    }

    /// How many edges there are. A path of one waypoint is an edge that takes no time.
    fn edges(&self) -> usize {
        (self.waypoints.len() - 1).max(1)
    }

    /// The time at the end of an edge.
    fn last(&self) -> f64 {
        if self.waypoints.len() == 1 { 0.0 } else { 1.0 }
    }

    /// The joint values at the ends of an edge.
    fn ends(&self, edge: usize) -> Result<[&[f64]; 2], Unread> {
        let to = self.waypoints.get((edge + 1).min(self.waypoints.len() - 1));
        let ends = self.waypoints.get(edge).filter(|_| edge < self.edges()).zip(to).ok_or("there is no such edge")?;
        Ok([ends.0, ends.1])
    }

    /// Up to when each two are proved to be apart on each edge, by the parts of a certificate.
    fn free(&self, certificate: &Value, target: &Interval, counts: &mut Parts) -> Result<BTreeMap<Key, f64>, Unread> {
        let mut sorted = BTreeMap::<Key, Vec<TimedPlanes>>::new();
        for part in listed(field(certificate, "free")?)? {
            only(part, "a part", &[&["edge", "times", "normals"], Who::FIELDS])?;
            let key = (count(part, "edge")?, Who::read(part)?);
            sorted.entry(key).or_default().push(planes(part, self.reader)?);
        }
        let (mut free, places) = (BTreeMap::new(), Places::default());
        for ((edge, who), parts) in sorted {
            let pair = self.around.pair(who, target)?;
            let moving = OnEdge::new(&pair, (edge, who.link, who.base()), self.ends(edge)?, &places);
            let until = apart_until(&moving, parts, self.last(), counts);
            free.extend(until.map(|until| ((edge, who), until)));
        }
        Ok(free)
    }

    /// Whether all that is asked about is free on the edges before one, and on that until a time.
    fn is_free_until(&self, free: &BTreeMap<Key, f64>, (stop, lower): (usize, f64)) -> bool {
        let is_covered = |(edge, until): (usize, f64)| {
            self.around.asked().all(|who| free.get(&(edge, who)).is_some_and(|free| *free >= until))
        };
        let until = (0..self.edges().min(stop)).map(|edge| (edge, self.last()));
        { until }.chain((lower > 0.0).then_some((stop, lower))).all(is_covered)
    }

    /// Two bodies in the world at a time of an edge, which may be that much of the next one.
    fn bodies(&self, who: Who, edge: usize, time: f64) -> Result<(Body, Obstacle), Unread> {
        let (edge, time) = if time > 1.0 { (edge + 1, time - 1.0) } else { (edge, time) };
        if time > self.last() {
            return Err("the time is beyond the path".to_owned());
        }
        self.around.placed(who, &values_at(self.ends(edge)?, time))
    }

    /// What rounding may move points of bodies by, and what the bodies may move against one another in a while.
    fn slack(
        &self,
        edge: usize,
        (body, met): (&Body, &Obstacle),
        target: &Interval,
        width: f64,
    ) -> Result<[Interval; 2], Unread> {
        let [from, to] = self.ends(edge)?.map(|values| values.iter().copied().map(Interval::from).collect::<Vec<_>>());
        let rates: Vec<_> = from.iter().zip(&to).map(|(from, to)| (to - from).absolute()).collect();
        let most: Vec<_> = from.iter().zip(&to).map(|(a, b)| a.absolute().max(&b.absolute())).collect();
        let (size, turns) = self.around.robot.magnitude(&most);
        let size = &(&(&size + &body.magnitude()) + &met.magnitude()) + target;
        let rounding =
            &(&(&self.reader.rounding() * &Interval::from(256.0)) * &size) * &(&Interval::from(1.0) + &turns);
        let open = &Interval::from(width) * &self.around.robot.speed(&rates, &size);
        let open = &open + &(&(&size + &size) * &open).root();
        Ok([rounding.greatest(), (&open + &rounding).greatest()])
    }

    /// What is proved of the least distance along the path.
    fn nearest(
        &self,
        line: &Value,
        claimed: &'t Value,
        certificate: &Value,
        parts: &mut Parts,
    ) -> Result<Nearest<'t>, Unread> {
        only(certificate, "the certificate", &[&["plane", "points", "free", "met"]])?;
        let mut nearest = Nearest::read(line, claimed, self.reader)?;
        let mut free = self.free(certificate, &nearest.lower, parts)?;
        let (edge, who) = (count(claimed, "edge")?, Who::read(claimed)?);
        self.around.check_asked(who)?;
        let bodies = self.bodies(who, edge, nearest.time)?;
        if self.last() == 0.0 && nearest.is_by_its_normal(&bodies) {
            let _ = free.insert((edge, who), 0.0);
        }
        let mut met = None;
        let stop = if nearest.is_contact() {
            let at = field(certificate, "met")?;
            let until = self.reader.number(field(at, "upper")?)?;
            let from = self.reader.number(field(at, "lower")?)?;
            only(at, "what is met", &[&["lower", "upper"]])?;
            let (body, obstacle) = self.bodies(who, edge, until)?;
            met = Some(([from, until], obstacle.distance(body, certificate, self.reader)?));
            (edge, from)
        } else {
            (self.edges(), 0.0)
        };
        let width = met.as_ref().map_or(0.0, |(at, _)| at[1] - at[0]);
        let slack = self.slack(edge, (&bodies.0, &bodies.1), &Interval::zero(), width)?;
        nearest.prove(bodies, self.is_free_until(&free, stop), met, slack, certificate)?;
        Ok(nearest)
    }
}

/// An answer about a path, and what is proved of it.
struct Case<'t> {
    way: &'t Way<'t>,
    target: &'t Interval,
    /// The contact that is claimed, unless all is claimed to be free.
    contact: Option<Contact>,
    /// Whether all is proved to be free that is claimed to be.
    is_covered: bool,
    /// Whether the bodies of the contact are proved to meet at the end of its bracket.
    is_met: bool,
    /// What is proved of the least distance, where that is claimed.
    nearest: Result<Option<Nearest<'t>>, Unread>,
}

/// A contact that an answer claims.
struct Contact {
    edge: usize,
    time: f64,
    lower: f64,
    /// None of a contact that may be none, within rounding.
    upper: Option<f64>,
    who: Who,
}

impl Contact {
    fn read(answer: &Value, way: &Way<'_>) -> Result<Self, Unread> {
        let time = |name| field(answer, name).and_then(|time| way.reader.number(time));
        let upper = answer.get("upper").map(|upper| way.reader.number(upper)).transpose()?;
        let edge = count(answer, "edge")?;
        let contact = Self { edge, time: time("time")?, lower: time("lower")?, upper, who: Who::read(answer)? };
        let is_ordered = 0.0 <= contact.lower && contact.lower <= contact.time;
        if !(is_ordered && contact.upper.is_none_or(|upper| contact.time <= upper)) {
            return Err("the time is not within its bracket, or that is before the edge".to_owned());
        }
        if contact.time > way.last() {
            return Err("the time is beyond the end of the edge".to_owned());
        }
        let _ = way.ends(edge)?;
        Ok(contact)
    }

    /// The bodies of the contact in the world at its time.
    fn bodies(&self, way: &Way<'_>) -> Result<(Body, Obstacle), Unread> {
        way.bodies(self.who, self.edge, self.time)
    }

    /// Whether what is asked about includes these bodies, and they meet at the end of the bracket: in the next edge
    /// where that has shown the contact.
    fn is_met(&self, way: &Way<'_>, certificate: &Value, target: &Interval) -> Result<bool, Unread> {
        let Some(upper) = self.upper else { return Ok(false) };
        way.around.check_asked(self.who)?;
        let (body, met) = way.bodies(self.who, self.edge, upper)?;
        Ok(met.distance(body, certificate, way.reader)?.is_at_most(target))
    }
}

impl Case<'_> {
    /// The contact; an error where none is claimed.
    fn contact(&self) -> Result<&Contact, Unread> {
        self.contact.as_ref().ok_or_else(|| "what is free has no contact".to_owned())
    }

    /// That all is free, by the parts; or that something is met, by the points.
    fn free(&self, _: &Value) -> Finding {
        match &self.contact {
            None => within_rounding(self.is_covered, NOT_COVERED),
            Some(contact) if contact.upper.is_none() => Err(NOT_CERTAIN.to_owned()),
            Some(_) => within_rounding(self.is_met, NOT_MET),
        }
    }

    /// What says which contact it is that is proved.
    fn named(&self, _: &Value) -> Finding {
        self.contact().map(|_| true)
    }

    /// The time: it is within its bracket, and on the edge, or the contact is not read.
    fn time(&self, _: &Value) -> Finding {
        self.contact().map(|_| true)
    }

    /// Nothing is met before.
    fn lower(&self, _: &Value) -> Finding {
        let _ = self.contact()?;
        within_rounding(self.is_covered, NOT_COVERED)
    }

    /// They meet then.
    fn upper(&self, _: &Value) -> Finding {
        let _ = self.contact()?;
        within_rounding(self.is_met, NOT_MET)
    }

    /// A contact is certain if it has both bounds, and what is free always.
    fn certain(&self, value: &Value) -> Finding {
        let has_bounds = self.contact.as_ref().is_none_or(|contact| contact.upper.is_some());
        match (flag(value)?, has_bounds) {
            (true, true) => Ok(true),
            (false, false) => Err(NOT_CERTAIN.to_owned()),
            (is_certain, _) => Err(format!("it is {}, by the other fields", !is_certain)),
        }
    }

    /// By how much the bodies of a contact may be off at its time: by rounding, by the way that is left in the bracket,
    /// and across curved bodies by the root of that.
    fn slack(&self, contact: &Contact, body: &Body, met: &Obstacle) -> Result<Interval, Unread> {
        let width = contact.upper.unwrap_or(contact.time) - contact.lower;
        let [_, slack] = self.way.slack(contact.edge, (body, met), self.target, width)?;
        Ok(slack)
    }

    /// The point: at the time it is in both bodies, or in what is met and as near to the body as the target distance.
    fn point(&self, value: &Value) -> Finding {
        let contact = self.contact()?;
        let (body, met) = contact.bodies(self.way)?;
        let slack = self.slack(contact, &body, &met)?;
        let point = self.way.reader.vector(value)?;
        let near = &slack + self.target;
        let is_near = body.distance_from(&point, None, &near).is_at_most(&near);
        within_rounding(is_near && met.is_near(&point, &slack), "it is not proved to be in both bodies at the time")
    }

    /// The unit normal out of what is met: at the time a plane across it separates the bodies, to rounding. Null where
    /// they overlap as soon as they are asked about.
    fn normal(&self, value: &Value) -> Finding {
        let contact = self.contact()?;
        if value.is_null() {
            let is_at_once = contact.upper.is_some_and(|upper| upper - contact.lower <= 4.0 * f64::EPSILON);
            return within_rounding(is_at_once && self.is_met, "they are not proved to overlap from the first");
        }
        let (body, met) = contact.bodies(self.way)?;
        let apart = met.separation(&body, &unit(value, self.way.reader)?, self.way.reader);
        let least = -&self.slack(contact, &body, &met)?;
        let holds = apart.is_some_and(|apart| least.is_at_most(&(&apart - self.target)));
        within_rounding(holds, "the plane across it does not separate the bodies at the time")
    }

    /// How the search ended. What has converged has both bounds.
    fn status(&self, value: &Value) -> Finding {
        let contact = self.contact()?;
        match value.as_str() {
            Some("iteration_limit" | "stalled") => Ok(true),
            Some("converged") if contact.upper.is_some() => Ok(true),
            _ => Err("it is none that is known, or there is no upper bound".to_owned()),
        }
    }

    /// The least distance, field by field.
    fn clearance(&self, value: &Value) -> Finding {
        let nearest = self.nearest.as_ref().map_err(Clone::clone)?;
        let nearest = nearest.as_ref().ok_or("the certificate has no proof of it")?;
        let mut table = clearance::claims();
        table.extend(["edge"].iter().chain(Who::FIELDS).map(|&name| (name, Nearest::named as Check<_>)));
        match of_fields(value, &table, clearance::REQUIRED, |check, value| check(nearest, value)) {
            (Verdict::Proved, _) => Ok(true),
            (Verdict::Disproved, _) => Ok(false),
            (Verdict::NotProved, why) => Err(why.unwrap_or_default()),
        }
    }

    /// A number of casts, which says nothing of the robot.
    fn work(&self, value: &Value) -> Finding {
        value.as_u64().map(|_| true).ok_or_else(|| "it is no number of casts".to_owned())
    }
}
