//! Whether a robot's path, or a box of its joint values, is free, by planes that stand between bodies; and whether what
//! is met is met, by the certificate of a distance at a pose.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use serde_json::Value;

use crate::body::{Body, Set};
use crate::certificate::Certificate;
use crate::claims::{Finding, Proof, Verdict, flag, of_fields, unit, within_rounding};
use crate::interval::{Interval, Vector};
use crate::question::{EVERY, Question};
use crate::reader::{Reader, Unread, field, listed, only};
use crate::robot::{Lever, Placed, Robot, Route};

/// How often a part of a certificate is halved, where a bound of ours is less sharp than that of who made it.
const HALVINGS: u32 = 14;

/// What became of the parts of a certificate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Whether it is claimed that all is free, and nothing met.
    pub are_of_free: bool,
    /// The parts that are proved.
    pub proved: u64,
    /// Those that are not.
    pub not_proved: u64,
}

/// How the value of a field is checked.
type Check<C> = fn(&C, &Value) -> Finding;

/// What the fields of the answer to a `path` claim.
fn path_claims<'t>() -> [(&'static str, Check<PathCase<'t>>); 15] {
    [
        ("free", PathCase::free),
        ("edge", PathCase::named),
        ("time", PathCase::time),
        ("link", PathCase::named),
        ("body", PathCase::named),
        ("obstacle", PathCase::named),
        ("other_link", PathCase::named),
        ("other_body", PathCase::named),
        ("point", PathCase::point),
        ("normal", PathCase::normal),
        ("lower", PathCase::lower),
        ("upper", PathCase::upper),
        ("certain", PathCase::certain),
        ("status", PathCase::status),
        ("casts", PathCase::work),
    ]
}

/// What those of the answer to a `joint_box` claim.
const BOX: &[(&str, Check<BoxCase>)] = &[
    ("meets", BoxCase::meets),
    ("values", BoxCase::named),
    ("body", BoxCase::named),
    ("other_body", BoxCase::named),
    ("boxes", |_, value| value.as_u64().map(|_| true).ok_or_else(|| "it is no number of boxes".to_owned())),
];

/// The fields of the questions.
const OF_ROBOT: &[&str] = &["joints", "links", "target_distance"];
const OF_PATH: &[&str] = &["waypoints", "obstacles", "self"];
const OF_BOX: &[&str] = &["pair", "box"];

/// Two bodies of which one moves: the other is seen at rest.
struct Pair<'r> {
    robot: &'r Robot,
    route: Route,
    body: &'r Body,
    other: Other<'r>,
    /// How far points of the body's core are from its frame's origin.
    reach: Interval,
    /// How near is too near.
    target: Interval,
}

enum Other<'r> {
    Body(&'r Body),
    /// Where `normal·x ≤ offset`.
    HalfSpace(&'r Vector, &'r Interval),
}

/// A thing that stands in the way.
#[derive(Clone)]
#[allow(clippy::large_enum_variant, reason = "there are a few of them")]
enum Obstacle {
    Body(Body),
    HalfSpace(Vector, Interval),
}

/// What a part of a certificate is about: the edge, the link and its body, and what it does not meet.
type Key = (usize, usize, usize, usize, Option<usize>);

/// What the certificate of a `path` or a `joint_box` proves.
pub(crate) fn judge(line: &Value, answer: &Value, certificate: &Value, reader: &Reader<'_>) -> Result<Proof, Unread> {
    let is_path = field(line, "query")?.as_str() == Some("path");
    only(line, "the query", &[EVERY, OF_ROBOT, if is_path { OF_PATH } else { OF_BOX }])?;
    only(certificate, "the certificate", &[&["plane", "points", "free"]])?;
    let robot = Robot::read(line, reader)?;
    let target = line.get("target_distance").map_or(Ok(0.0), |value| reader.number(value))?;
    if target < 0.0 {
        return Err("target_distance is negative".to_owned());
    }
    let target = Interval::from(target);
    let parts = listed(field(certificate, "free")?)?;
    let told = Told { line, answer, certificate, reader, robot: &robot, target: &target, parts };
    if is_path { judge_path(told) } else { judge_box(&told) }
}

/// What a line tells of a robot.
#[derive(Clone, Copy)]
struct Told<'t> {
    line: &'t Value,
    answer: &'t Value,
    certificate: &'t Value,
    reader: &'t Reader<'t>,
    robot: &'t Robot,
    target: &'t Interval,
    parts: &'t [Value],
}

impl Parts {
    fn count(&mut self, is_proved: bool) -> bool {
        *if is_proved { &mut self.proved } else { &mut self.not_proved } += 1;
        is_proved
    }

    fn proof(self, (verdict, because): (Verdict, Option<String>)) -> Proof {
        Proof { verdict, because, bounds: None, parts: Some(self) }
    }
}

/// What is said where parts do not cover what is free.
const NOT_COVERED: &str = "what is free is not covered by parts that are proved";

/// What is said of a contact that is none to rounding.
const NOT_CERTAIN: &str = "they may only touch, within rounding, as the answer says itself";

/// What is said where the points of a certificate do not prove a contact.
const NOT_MET: &str = "the bodies are not proved to meet at the pose";

/// The path of a robot, and the obstacles.
struct Way<'t> {
    told: Told<'t>,
    waypoints: Vec<Vec<f64>>,
    obstacles: Vec<Obstacle>,
}

impl<'t> Way<'t> {
    fn read(told: Told<'t>) -> Result<Self, Unread> {
        let Told { line, reader, robot, .. } = told;
        let waypoints = listed(field(line, "waypoints")?)?;
        let waypoints = waypoints.iter().map(|row| numbers(row, reader)).collect::<Result<Vec<_>, _>>()?;
        if waypoints.is_empty() || waypoints.iter().any(|row| row.len() != robot.values) {
            return Err("a waypoint has another number of values".to_owned());
        }
        let obstacles = listed(field(line, "obstacles")?)?.iter().map(|obstacle| Obstacle::read(obstacle, reader));
        Ok(Self { told, waypoints, obstacles: obstacles.collect::<Result<_, _>>()? })
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

    /// Up to when each pair is proved to be apart on each edge, by the parts of the certificate.
    fn free(&self, counts: &mut Parts) -> Result<BTreeMap<Key, f64>, Unread> {
        const PART: &[&str] = &["edge", "times", "link", "body", "normals"];
        let Told { reader, robot, target, .. } = self.told;
        let mut sorted = BTreeMap::<Key, Vec<([f64; 2], [Vector; 2])>>::new();
        for part in self.told.parts {
            let count = |name| count(part, name);
            let other = if part.get("obstacle").is_some() {
                only(part, "a part", &[PART, &["obstacle"]])?;
                (count("obstacle")?, None)
            } else {
                only(part, "a part", &[PART, &["other_link", "other_body"]])?;
                (count("other_link")?, Some(count("other_body")?))
            };
            let key = (count("edge")?, count("link")?, count("body")?, other.0, other.1);
            let normals = listed(field(part, "normals")?)?.iter().map(|normal| reader.vector(normal));
            let normals: Result<[Vector; 2], _> = normals.collect::<Result<Vec<_>, _>>()?.try_into();
            let times: Result<[f64; 2], _> = numbers(field(part, "times")?, reader)?.try_into();
            let (Ok(times), Ok(normals)) = (times, normals) else {
                return Err("a part has not two times and two normals".to_owned());
            };
            sorted.entry(key).or_default().push((times, normals));
        }
        let mut free = BTreeMap::new();
        let places = Places::default();
        for (key, mut parts) in sorted {
            let (edge, link, body, other, of_link) = key;
            let body = robot.links.get(link).and_then(|link| link.bodies.get(body)).ok_or("there is no such body")?;
            let from = of_link.map(|_| other);
            let stands = match of_link {
                Some(k) => robot.links.get(other).and_then(|link| link.bodies.get(k)).map(Other::Body),
                None => self.obstacles.get(other).map(|obstacle| match obstacle {
                    Obstacle::Body(body) => Other::Body(body),
                    Obstacle::HalfSpace(normal, offset) => Other::HalfSpace(normal, offset),
                }),
            };
            let other = stands.ok_or("there is nothing of this index to be free of")?;
            let pair = Pair::new(robot, robot.route(link, from), body, other, target);
            let moving = MovingPair::new(&pair, (edge, link, from), self.ends(edge)?, &places);
            parts.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
            // Up to when the two are proved to be apart; nothing is known before the first part.
            let mut until: Option<f64> = None;
            for ([start, end], normals) in parts {
                // Bounds on speeds are those of the edge.
                let is_on_edge = 0.0 <= start && start <= end && end <= self.last();
                let is_proved = is_on_edge && moving.are_apart([start, end], normals.each_ref());
                if counts.count(is_proved) && start <= until.unwrap_or(0.0) {
                    until = Some(until.unwrap_or(0.0).max(end));
                }
            }
            free.extend(until.map(|until| (key, until)));
        }
        Ok(free)
    }

    /// Whether all that is asked about is free on the edges before one, and on that until a time.
    fn is_free_until(&self, free: &BTreeMap<Key, f64>, (stop, lower): (usize, f64)) -> Result<bool, Unread> {
        let Told { line, robot, .. } = self.told;
        let pairs = line.get("self").map_or(Ok(&[][..]), listed)?;
        let pairs = pairs.iter().map(|pair| match listed(pair)? {
            [_, _] => Ok([count(pair, 0)?, count(pair, 1)?]),
            _ => Err("a pair of links is not two".to_owned()),
        });
        let pairs = pairs.collect::<Result<Vec<[usize; 2]>, Unread>>()?;
        if pairs.iter().flatten().any(|&link| link >= robot.links.len()) {
            return Err("a pair is not of this robot".to_owned());
        }
        let bodies = |link: usize| robot.links[link].bodies.len();
        let is_free = |key: Key, until: f64| free.get(&key).is_some_and(|free| *free >= until);
        let is_covered = |(edge, until): (usize, f64)| {
            let among = (0..robot.links.len()).all(|link| {
                (0..bodies(link))
                    .all(|body| (0..self.obstacles.len()).all(|k| is_free((edge, link, body, k, None), until)))
            });
            let apart = |&[a, b]: &[usize; 2]| {
                (0..bodies(a)).all(|i| (0..bodies(b)).all(|k| is_free((edge, a, i, b, Some(k)), until)))
            };
            among && pairs.iter().all(apart)
        };
        let until = (0..self.edges().min(stop)).map(|edge| (edge, self.last()));
        Ok({ until }.chain((lower > 0.0).then_some((stop, lower))).all(is_covered))
    }
}

fn judge_path(told: Told<'_>) -> Result<Proof, Unread> {
    let way = Way::read(told)?;
    let is_free = flag(field(told.answer, "free")?)?;
    let mut parts = Parts { are_of_free: is_free, proved: 0, not_proved: 0 };
    let free = way.free(&mut parts)?;
    let contact = if is_free { None } else { Some(Contact::read(&way)?) };
    let until = contact.as_ref().map_or((way.edges(), 0.0), |contact| (contact.edge, contact.lower));
    let is_covered = way.is_free_until(&free, until)?;
    let is_met = contact.as_ref().map_or(Ok(false), |contact| contact.is_met(&way))?;
    let case = PathCase { way, contact, is_covered, is_met };
    let required: &[&str] = if is_free { &["free"] } else { &["free", "certain"] };
    Ok(parts.proof(of_fields(told.answer, &path_claims(), required, |check, value| check(&case, value))))
}

/// An answer about a path, and what is proved of it.
struct PathCase<'t> {
    way: Way<'t>,
    /// The contact that is claimed, unless all is claimed to be free.
    contact: Option<Contact>,
    /// Whether all is proved to be free that is claimed to be.
    is_covered: bool,
    /// Whether the bodies of the contact are proved to meet at the end of its bracket.
    is_met: bool,
}

/// A contact that an answer claims.
struct Contact {
    edge: usize,
    time: f64,
    lower: f64,
    /// None of a contact that may be none, within rounding.
    upper: Option<f64>,
    link: usize,
    body: usize,
    met: Met,
}

/// What is met.
#[derive(Clone, Copy)]
enum Met {
    Obstacle(usize),
    Link { link: usize, body: usize },
}

impl Contact {
    fn read(way: &Way<'_>) -> Result<Self, Unread> {
        let Told { answer, reader, .. } = way.told;
        let time = |name| field(answer, name).and_then(|time| reader.number(time));
        let count = |name| count(answer, name);
        let met = match answer.get("obstacle") {
            Some(_) if answer.get("other_link").or(answer.get("other_body")).is_some() => {
                return Err("it names both an obstacle and another link".to_owned());
            }
            Some(_) => Met::Obstacle(count("obstacle")?),
            None => Met::Link { link: count("other_link")?, body: count("other_body")? },
        };
        let upper = answer.get("upper").map(|upper| reader.number(upper)).transpose()?;
        let (edge, link, body) = (count("edge")?, count("link")?, count("body")?);
        let contact = Self { edge, time: time("time")?, lower: time("lower")?, upper, link, body, met };
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

    /// The bodies of the contact in the world at a time of an edge.
    fn bodies(&self, way: &Way<'_>, edge: usize, time: f64) -> Result<(Body, Obstacle), Unread> {
        let Told { robot, .. } = way.told;
        let values = values_at(way.ends(edge)?, time);
        let met = match self.met {
            Met::Obstacle(index) => way.obstacles.get(index).cloned().ok_or("there is no such obstacle")?,
            Met::Link { link, body } => Obstacle::Body(robot.placed(link, body, &values)?),
        };
        Ok((robot.placed(self.link, self.body, &values)?, met))
    }

    /// Whether what is asked about includes these bodies, and they meet at the end of the bracket: in the next edge
    /// where that has shown the contact.
    fn is_met(&self, way: &Way<'_>) -> Result<bool, Unread> {
        let Some(upper) = self.upper else { return Ok(false) };
        if let Met::Link { link, .. } = self.met {
            let pairs = way.told.line.get("self").map_or(Ok(&[][..]), listed)?;
            let is_asked = |pair: &Value| {
                let pair = [0, 1].map(|i| count(pair, i).ok());
                pair == [Some(self.link), Some(link)] || pair == [Some(link), Some(self.link)]
            };
            if !pairs.iter().any(is_asked) {
                return Err("the links of the contact are no pair that is asked about".to_owned());
            }
        }
        let (edge, time) = if upper > 1.0 { (self.edge + 1, upper - 1.0) } else { (self.edge, upper) };
        if time > way.last() {
            return Err("the end of the bracket is beyond the path".to_owned());
        }
        let (body, met) = self.bodies(way, edge, time)?;
        met.meets(body, &way.told)
    }
}

impl PathCase<'_> {
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
        let Told { robot, reader, .. } = self.way.told;
        let ends = self.way.ends(contact.edge)?;
        let [from, to] = ends.map(|values| values.iter().copied().map(Interval::from).collect::<Vec<_>>());
        let rates: Vec<_> = from.iter().zip(&to).map(|(from, to)| (to - from).absolute()).collect();
        let most: Vec<_> = from.iter().zip(&to).map(|(a, b)| a.absolute().max(&b.absolute())).collect();
        let (size, turns) = robot.magnitude(&most);
        let size = &(&(&size + &body.magnitude()) + &met.magnitude()) + self.way.told.target;
        let rounding = &(&(&reader.rounding() * &Interval::from(256.0)) * &size) * &(&Interval::from(1.0) + &turns);
        let width = Interval::from(contact.upper.unwrap_or(contact.time) - contact.lower);
        let speed = rates.iter().fold(Interval::zero(), |sum, rate| &sum + rate);
        let open = &(&width * &speed) * &(&size + &Interval::from(1.0));
        Ok((&(&open + &(&(&size + &size) * &open).root()) + &rounding).greatest())
    }

    /// The point: at the time it is in both bodies, or in what is met and as near to the body as the target distance.
    fn point(&self, value: &Value) -> Finding {
        let (contact, Told { reader, target, .. }) = (self.contact()?, self.way.told);
        let (body, met) = contact.bodies(&self.way, contact.edge, contact.time)?;
        let slack = self.slack(contact, &body, &met)?;
        let point = reader.vector(value)?;
        let near = &slack + target;
        let is_near = body.distance_from(&point, None, &near).is_at_most(&near);
        within_rounding(is_near && met.is_near(&point, &slack), "it is not proved to be in both bodies at the time")
    }

    /// The unit normal out of what is met: at the time a plane across it separates the bodies, to rounding. Null where
    /// they overlap as soon as they are asked about.
    fn normal(&self, value: &Value) -> Finding {
        let (contact, Told { reader, target, .. }) = (self.contact()?, self.way.told);
        if value.is_null() {
            let is_at_once = contact.upper.is_some_and(|upper| upper - contact.lower <= 4.0 * f64::EPSILON);
            return within_rounding(is_at_once && self.is_met, "they are not proved to overlap from the first");
        }
        let normal = unit(value, reader)?;
        let (body, met) = contact.bodies(&self.way, contact.edge, contact.time)?;
        let down = &body.core.support(&normal.times(&Interval::from(-1.0))).1 + &(&body.radius + target);
        let slack = self.slack(contact, &body, &met)?;
        let holds = match &met {
            Obstacle::Body(other) => {
                let up = &other.core.support(&normal).1 + &other.radius;
                (&down + &up).is_at_most(&slack)
            }
            Obstacle::HalfSpace(own, offset) => {
                let length = own.length();
                let off = normal.minus(&Vector(own.0.each_ref().map(|x| x.over(&length)))).length();
                off.is_at_most(&(&reader.rounding() * &Interval::from(64.0)))
                    && (&down + &offset.over(&length)).is_at_most(&slack)
            }
        };
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

    /// A number of casts, which says nothing of the robot.
    fn work(&self, value: &Value) -> Finding {
        value.as_u64().map(|_| true).ok_or_else(|| "it is no number of casts".to_owned())
    }
}

/// The joint values at a time of an edge, by those at its ends.
fn values_at([from, to]: [&[f64]; 2], time: f64) -> Vec<Interval> {
    let value = |(from, to): (&f64, &f64)| {
        let [from, to, time] = [*from, *to, time].map(Interval::from);
        &from + &(&(&to - &from) * &time)
    };
    from.iter().zip(to).map(value).collect()
}

impl Obstacle {
    /// A body that stands, or a half-space.
    fn read(written: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        if written.get("type").and_then(Value::as_str) != Some("half_space") {
            return reader.body(written).map(Self::Body);
        }
        only(written, "a half-space", &[&["type", "normal", "offset"]])?;
        let normal = reader.vector(field(written, "normal")?)?;
        let _ = normal.unit().ok_or("the normal of a half-space is zero")?;
        Ok(Self::HalfSpace(normal, Interval::from(reader.number(field(written, "offset")?)?)))
    }

    /// Whether it is certainly as near to a body as the target, as the certificate of a line shows.
    fn meets(self, body: Body, told: &Told<'_>) -> Result<bool, Unread> {
        let Told { certificate, reader, target, .. } = told;
        Ok(match self {
            Self::Body(other) => {
                let question = Question::of_distance(body, other, reader);
                let certificate = Certificate::read(certificate, question.core(), reader)?;
                question.proved(&certificate).upper.is_at_most(target)
            }
            Self::HalfSpace(normal, offset) => {
                let depth = body.core.support(&normal.times(&Interval::from(-1.0))).1;
                let reach = &(&body.radius + target) * &normal.length();
                (-&(&depth + &reach)).is_at_most(&offset)
            }
        })
    }

    /// Whether a point is certainly no farther from it than this.
    fn is_near(&self, point: &Vector, slack: &Interval) -> bool {
        match self {
            Self::Body(body) => body.distance_from(point, None, slack).is_at_most(slack),
            Self::HalfSpace(normal, offset) => (&normal.dot(point) - offset).is_at_most(&(slack * &normal.length())),
        }
    }

    /// A bound on the numbers that computing with it comes by.
    fn magnitude(&self) -> Interval {
        match self {
            Self::Body(body) => body.magnitude(),
            Self::HalfSpace(normal, offset) => offset.absolute().over(&normal.length()),
        }
    }
}

impl<'r> Pair<'r> {
    fn new(robot: &'r Robot, route: Route, body: &'r Body, other: Other<'r>, target: &Interval) -> Self {
        let farthest = |i: usize| {
            let along = |sign: f64| {
                let mut axis = Vector::zero();
                axis.0[i] = Interval::from(sign);
                body.core.support(&axis).1
            };
            along(1.0).max(&along(-1.0)).squared()
        };
        let [x, y, z] = std::array::from_fn(farthest);
        let reach = (&(&x + &y) + &z).root().greatest();
        Self { robot, route, body, other, reach, target: target.clone() }
    }

    /// How far the other reaches along a normal at rest, and what radii and the target take, times its length.
    fn level(&self, normal: &Vector) -> Interval {
        let (reach, radius) = match self.other {
            Other::Body(other) => (other.core.support(normal).1, other.radius.clone()),
            Other::HalfSpace(_, offset) => (offset.clone(), Interval::zero()),
        };
        &reach + &(&(&(&self.body.radius + &radius) + &self.target) * &normal.length())
    }

    /// The normal that counts: of a half-space always its own.
    fn normal(&self, given: &Vector) -> Vector {
        match self.other {
            Other::HalfSpace(own, _) => own.clone(),
            Other::Body(_) => given.clone(),
        }
    }

    /// By how much the plane across a normal separates the bodies, the one as it is placed.
    fn gap(&self, placed: &Placed, normal: &Vector) -> Interval {
        let down = placed.seen(normal).times(&Interval::from(-1.0));
        let least = &normal.dot(&placed.at) - &self.body.core.support(&down).1;
        &least - &self.level(normal)
    }
}

/// Two bodies along an edge.
struct MovingPair<'p, 'r> {
    pair: &'p Pair<'r>,
    ends: [&'p [f64]; 2],
    speed: Interval,
    acceleration: Interval,
    /// What both ends of the edge and the route are of: the edge and the links.
    of: (usize, usize, Option<usize>),
    places: &'p Places,
}

/// The places that were asked for, of all bodies of a link together, by the bits of their times.
type Places = RefCell<HashMap<((usize, usize, Option<usize>), u64), Rc<Placed>>>;

impl<'p, 'r> MovingPair<'p, 'r> {
    fn new(pair: &'p Pair<'r>, of: (usize, usize, Option<usize>), ends: [&'p [f64]; 2], places: &'p Places) -> Self {
        let [from, to] = [0.0, 1.0].map(|time| values_at(ends, time));
        let rates: Vec<_> = from.iter().zip(&to).map(|(from, to)| (to - from).absolute()).collect();
        let slides: Vec<_> = from.iter().zip(&to).map(|(a, b)| a.absolute().max(&b.absolute())).collect();
        let bounds = pair.robot.bounds(&pair.route, &pair.reach, &rates, &slides);
        let (speed, acceleration) = (bounds.speed.greatest(), bounds.acceleration.greatest());
        Self { pair, ends, speed, acceleration, of, places }
    }

    fn at(&self, time: f64) -> Rc<Placed> {
        let place = || Rc::new(self.pair.robot.place(&self.pair.route, &values_at(self.ends, time)));
        self.places.borrow_mut().entry((self.of, time.to_bits())).or_insert_with(place).clone()
    }

    /// Whether a plane separates the bodies at all times: one that turns from one normal to the other, at a constant rate,
    /// or one of the two alone.
    fn are_apart(&self, times: [f64; 2], normals: [&Vector; 2]) -> bool {
        let [first, second] = normals.map(|normal| self.pair.normal(normal));
        let planes = [[&first, &second], [&second, &second], [&first, &first]];
        [0, HALVINGS].into_iter().any(|halvings| {
            planes.iter().any(|normals| {
                let gaps = [0, 1].map(|i| self.pair.gap(&self.at(times[i]), normals[i]));
                self.stay_apart(times, &normals.map(Vector::clone), &gaps, halvings)
            })
        })
    }

    /// Whether one does that turns from one normal to the other, where it separates them by these gaps at the ends.
    ///
    /// For points `a` and `b` of the bodies `φ(t) = n(t)·(a(t) − b)` has the second derivative `2ṅ·ȧ + n·ä ≤ M`, so
    /// that it is above its chord less `M·t·(s − t)/2`, and the radii take no more than the chord of theirs, as `|n|` is
    /// convex. With `m = s²·M/2` that is positive for all times if `m < g₀ + g₁ + 2·√(g₀·g₁)`.
    fn stay_apart(&self, [from, to]: [f64; 2], normals: &[Vector; 2], gaps: &[Interval; 2], halvings: u32) -> bool {
        let zero = Interval::zero();
        if !gaps.iter().all(|gap| zero.is_less_than(gap)) {
            return false;
        }
        let [one, two] = [1.0, 2.0].map(Interval::from);
        let duration = &Interval::from(to) - &Interval::from(from);
        let turned = normals[1].minus(&normals[0]).length();
        let longest = normals[0].length().max(&normals[1].length());
        // s²·M/2, with |ṅ|·s for how far the normal turns.
        let bent = &(&(&turned * &duration) * &self.speed)
            + &(&(&duration.squared() * &(&longest * &self.acceleration)) * &Interval::from(0.5));
        let open = &(&gaps[0] + &gaps[1]) + &(&two * &(&gaps[0] * &gaps[1]).root());
        if bent.is_less_than(&open) {
            return true;
        }
        let middle = from + (to - from) * 0.5;
        if halvings == 0 || !(from < middle && middle < to) {
            return false;
        }
        let part = (&Interval::from(middle) - &Interval::from(from)).over(&duration);
        let normal = normals[0].times(&(&one - &part)).plus(&normals[1].times(&part));
        let gap = self.pair.gap(&self.at(middle), &normal);
        let half = |times, normals: [&Vector; 2], gaps: [&Interval; 2]| {
            self.stay_apart(times, &normals.map(Vector::clone), &gaps.map(Interval::clone), halvings - 1)
        };
        half([from, middle], [&normals[0], &normal], [&gaps[0], &gap])
            && half([middle, to], [&normal, &normals[1]], [&gap, &gaps[1]])
    }
}

fn judge_box(told: &Told<'_>) -> Result<Proof, Unread> {
    let Told { line, answer, reader, robot, target, .. } = *told;
    let whole = intervals(field(line, "box")?, reader)?;
    let pair = field(line, "pair")?;
    let links = [count(pair, 0)?, count(pair, 1)?];
    if whole.len() != robot.values || listed(pair)?.len() != 2 || links.iter().any(|&link| link >= robot.links.len()) {
        return Err("the box or the pair is not of this robot".to_owned());
    }
    let meets = flag(field(answer, "meets")?)?;
    let mut parts = Parts { are_of_free: !meets, proved: 0, not_proved: 0 };
    let [a, b] = links.map(|link| &robot.links[link].bodies);
    let mut boxes = vec![vec![Vec::new(); b.len()]; a.len()];
    for part in told.parts {
        only(part, "a part", &[&["body", "other_body", "box", "plane"]])?;
        let [i, k] = [count(part, "body")?, count(part, "other_body")?];
        let (body, other) = a.get(i).zip(b.get(k)).ok_or("there is no such body")?;
        let (joint_box, normal) = (intervals(field(part, "box")?, reader)?, reader.vector(field(part, "plane")?)?);
        if joint_box.len() != robot.values {
            return Err("a part has another number of intervals".to_owned());
        }
        let pair = Pair::new(robot, robot.route(links[0], Some(links[1])), body, Other::Body(other), target);
        if parts.count(pair.is_free_in(&joint_box, &normal, HALVINGS)) {
            boxes[i][k].push(joint_box);
        }
    }
    let is_covered = || boxes.iter().flatten().all(|boxes| is_covered(&whole, &boxes.iter().collect::<Vec<_>>()));
    let is_so = if meets { is_met_in(told, &whole, links)? } else { is_covered() };
    let required: &[&str] = if meets { &["meets", "values", "body", "other_body"] } else { &["meets"] };
    let case = BoxCase { meets, is_so };
    Ok(parts.proof(of_fields(answer, BOX, required, |check, value| check(&case, value))))
}

/// Whether the links meet at the joint values of the answer, and these are in the box.
fn is_met_in(told: &Told<'_>, whole: &[[f64; 2]], links: [usize; 2]) -> Result<bool, Unread> {
    let values = numbers(field(told.answer, "values")?, told.reader)?;
    let is_inside = values.len() == whole.len()
        && values.iter().zip(whole).all(|(value, [low, high])| (low..=high).contains(&value));
    if !is_inside {
        return Ok(false);
    }
    let values: Vec<_> = values.into_iter().map(Interval::from).collect();
    let placed = |link: usize, body| told.robot.placed(links[link], count(told.answer, body)?, &values);
    Obstacle::Body(placed(1, "other_body")?).meets(placed(0, "body")?, told)
}

/// An answer about a box of joint values.
struct BoxCase {
    meets: bool,
    /// Whether that is proved.
    is_so: bool,
}

impl BoxCase {
    /// That nothing ever meets, by the parts; or that something does, by the points.
    fn meets(&self, _: &Value) -> Finding {
        within_rounding(self.is_so, if self.meets { NOT_MET } else { NOT_COVERED })
    }

    /// What says where that is.
    fn named(&self, _: &Value) -> Finding {
        if self.meets { Ok(true) } else { Err("what never meets has none".to_owned()) }
    }
}

impl Pair<'_> {
    /// Whether a plane separates the bodies wherever the joints are in a box.
    ///
    /// From the middle of the box go straight to any place in it, within a unit of time: the height of a point over the
    /// plane is that in the middle, less what its joints take at first, `Σ δⱼ·|∂ⱼ|`, and half of its acceleration.
    fn is_free_in(&self, joint_box: &[[f64; 2]], normal: &Vector, halvings: u32) -> bool {
        let middle: Vec<f64> = joint_box.iter().map(|[low, high]| low * 0.5 + high * 0.5).collect();
        let half = |(&[low, high], &middle): (&[f64; 2], &f64)| {
            let [low, high, middle] = [low, high, middle].map(Interval::from);
            (&high - &middle).max(&(&middle - &low)).greatest()
        };
        let halves: Vec<Interval> = joint_box.iter().zip(&middle).map(half).collect();
        let slides: Vec<Interval> = joint_box
            .iter()
            .map(|ends| Interval::from(ends[0]).absolute().max(&Interval::from(ends[1]).absolute()))
            .collect();
        let values: Vec<Interval> = middle.iter().copied().map(Interval::from).collect();
        let placed = self.robot.place(&self.route, &values);
        // Along each joint, how far a point of the body goes: a vector of its frame and a number.
        let ways: Vec<(usize, Vector, Interval)> = placed
            .levers
            .iter()
            .map(|(column, lever)| {
                let half = &halves[*column];
                let (way, along) = match lever {
                    Lever::Turn { axis, origin } => {
                        let across = normal.cross(axis);
                        (placed.seen(&across), across.dot(&placed.at.minus(origin)))
                    }
                    Lever::Slide { axis } => (Vector::zero(), normal.dot(axis)),
                };
                (*column, way.times(half), &along * half)
            })
            .collect();
        let up = placed.seen(normal);
        let sinks = |point: &Vector| {
            let way = |(_, way, along): &(usize, Vector, Interval)| (&way.dot(point) + along).absolute();
            ways.iter().map(way).fold(-&up.dot(point), |sum, way| &sum + &way)
        };
        let level = &normal.dot(&placed.at) - &self.level(normal);
        let bounds = self.robot.bounds(&self.route, &self.reach, &halves, &slides);
        let bent = &(&bounds.acceleration * &normal.length()) * &Interval::from(0.5);
        let lowest = match self.body.core.corners() {
            Some(corners) => corners.iter().map(sinks).reduce(|a, b| a.max(&b)),
            // Of others each joint takes what it takes of any point.
            None => {
                let support = |along: &Vector| self.body.core.support(along).1;
                let way = |(_, way, along): &(usize, Vector, Interval)| {
                    let back = way.times(&Interval::from(-1.0));
                    (&support(way) + along).max(&(&support(&back) - along)).max(&Interval::zero())
                };
                Some(ways.iter().map(way).fold(support(&up.times(&Interval::from(-1.0))), |sum, way| &sum + &way))
            }
        };
        let Some(lowest) = lowest else { return false };
        let gap = &(&level - &lowest) - &bent;
        if Interval::zero().is_less_than(&gap) {
            return true;
        }
        // The joint that may move a point the most.
        let most = |(column, _): &(usize, Lever)| {
            let rates: Vec<Interval> = (0..halves.len())
                .map(|other| if other == *column { halves[other].clone() } else { Interval::zero() })
                .collect();
            (self.robot.bounds(&self.route, &self.reach, &rates, &slides).speed.to_f64(), *column)
        };
        let widest = placed.levers.iter().map(most).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, column)) = widest.filter(|_| halvings > 0) else { return false };
        let [low, high] = joint_box[column];
        [[low, middle[column]], [middle[column], high]].into_iter().all(|interval| {
            let mut part = joint_box.to_vec();
            part[column] = interval;
            self.is_free_in(&part, normal, halvings - 1)
        })
    }
}

/// Whether boxes cover a box: one of them contains it, or it is cut where the largest of them ends, and both parts are
/// covered.
fn is_covered(whole: &[[f64; 2]], boxes: &[&Vec<[f64; 2]>]) -> bool {
    // What the boxes have in common with it.
    let cut = |of: &Vec<[f64; 2]>| -> Option<(f64, Vec<[f64; 2]>)> {
        let common: Vec<[f64; 2]> = whole.iter().zip(of).map(|(w, o)| [w[0].max(o[0]), w[1].min(o[1])]).collect();
        // An interval of the whole that is one number has no inside.
        let meets = common.iter().zip(whole).all(|(c, w)| c[0] < c[1] || (w[0] == w[1] && c[0] == c[1]));
        let share = |(c, w): (&[f64; 2], &[f64; 2])| if w[0] < w[1] { (c[1] - c[0]) / (w[1] - w[0]) } else { 1.0 };
        let share = common.iter().zip(whole).map(share).product();
        meets.then_some((share, common))
    };
    let found: Vec<_> = boxes.iter().filter_map(|of| cut(of).map(|(share, common)| (share, common, *of))).collect();
    let Some((_, common, _)) = found.iter().max_by(|a, b| a.0.total_cmp(&b.0)) else { return false };
    let side = whole.iter().zip(common).enumerate().find_map(|(i, (w, c))| match () {
        () if c[0] > w[0] => Some((i, c[0])),
        () if c[1] < w[1] => Some((i, c[1])),
        () => None,
    });
    let Some((column, at)) = side else { return true };
    let boxes: Vec<_> = found.iter().map(|(_, _, of)| *of).collect();
    [[whole[column][0], at], [at, whole[column][1]]].into_iter().all(|interval| {
        let mut part = whole.to_vec();
        part[column] = interval;
        is_covered(&part, &boxes)
    })
}

fn numbers(value: &Value, reader: &Reader<'_>) -> Result<Vec<f64>, Unread> {
    let items = value.as_array().ok_or("a list of numbers is none")?;
    items.iter().map(|item| reader.number(item)).collect()
}

fn intervals(value: &Value, reader: &Reader<'_>) -> Result<Vec<[f64; 2]>, Unread> {
    let items = value.as_array().ok_or("a box is no list of intervals")?;
    let interval = |item: &Value| match numbers(item, reader)?.as_slice() {
        &[low, high] if low <= high => Ok([low, high]),
        _ => Err("an interval of a box is none".to_owned()),
    };
    items.iter().map(interval).collect()
}

/// The index that a field, or an item, is.
fn count<I: serde_json::value::Index + Copy + std::fmt::Display>(object: &Value, at: I) -> Result<usize, Unread> {
    let index = object.get(at).and_then(Value::as_u64).and_then(|index| usize::try_from(index).ok());
    index.ok_or_else(|| format!("{at} is no index"))
}

impl Set {
    /// Points whose hull the set is, if it is one of few.
    fn corners(&self) -> Option<Vec<Vector>> {
        match self {
            Self::Points(points) => Some(points.clone()),
            Self::Ball => None,
            Self::Image(of, rows, at) => {
                Some(of.corners()?.iter().map(|point| crate::body::apply(rows, point).plus(at)).collect())
            }
            Self::Sum(of) => of.iter().try_fold(vec![Vector::zero()], |sums, part| {
                let corners = part.corners()?;
                Some(sums.iter().flat_map(|sum| corners.iter().map(|corner| sum.plus(corner))).collect())
            }),
            Self::Hull(of) => of.iter().map(Self::corners).collect::<Option<Vec<_>>>().map(|parts| parts.concat()),
        }
    }
}
