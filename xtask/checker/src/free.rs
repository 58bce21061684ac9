//! Whether a robot's path, or a box of its joint values, is free, by planes that stand between bodies; and whether what
//! is met is met, by the certificate of a distance at a pose.

use std::cell::RefCell;
use std::collections::{BTreeMap, HashMap};
use std::rc::Rc;

use serde_json::Value;

use crate::body::{Body, Set};
use crate::certificate::{Verdict, distance};
use crate::interval::{Interval, Vector};
use crate::reader::{Reader, Unread, field};
use crate::robot::{Lever, Placed, Robot, Route};

/// How often a part of a certificate is halved, where a bound of ours is less sharp than that of who made it.
const HALVINGS: u32 = 14;

/// What became of the parts of a certificate, and of the claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RobotProof {
    /// Whether it is claimed that all is free, and nothing met.
    pub is_of_free: bool,
    /// Whether what is claimed to be free is covered by parts that are proved, and what is claimed to meet does.
    pub verdict: Verdict,
    /// Why not, where the claim is not proved.
    pub because: Option<&'static str>,
    /// The parts that are proved.
    pub proved: u64,
    /// Those that are not.
    pub not_proved: u64,
}

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
///
/// # Errors
/// Where the line is no such query with an answer and a certificate.
pub fn judge_robot(line: &Value, reader: &Reader<'_>) -> Result<RobotProof, Unread> {
    let robot = Robot::read(line, reader)?;
    let target = line.get("target_distance").map_or(Ok(0.0), |value| reader.number(value))?;
    let target = Interval::from(target.max(0.0));
    let parts = field(field(line, "certificate")?, "free")?.as_array().ok_or("the parts are no list")?;
    match field(line, "query")?.as_str() {
        Some("path") => judge_path(line, reader, &robot, &target, parts),
        Some("joint_box") => judge_box(line, reader, &robot, &target, parts),
        _ => Err("the query is neither a path nor a box of joints".to_owned()),
    }
}

impl RobotProof {
    fn new(is_of_free: bool) -> Self {
        Self { is_of_free, verdict: Verdict::NotProved, because: None, proved: 0, not_proved: 0 }
    }

    fn count(&mut self, is_proved: bool) -> bool {
        *if is_proved { &mut self.proved } else { &mut self.not_proved } += 1;
        is_proved
    }

    /// The verdict on what has to be so, each with what is said where it is not.
    fn of(self, claims: impl IntoIterator<Item = (bool, &'static str)>) -> Self {
        let because = claims.into_iter().find_map(|(is_so, because)| (!is_so).then_some(because));
        Self { verdict: if because.is_none() { Verdict::Proved } else { Verdict::NotProved }, because, ..self }
    }
}

/// What is said where parts do not cover what is free.
const NOT_COVERED: &str = "what is free is not covered by parts that are proved";

/// What is said of a contact that is none to rounding.
const NOT_CERTAIN: &str = "they may only touch, within rounding, as the answer says itself";

/// What is said where the points of a certificate do not prove a contact.
const NOT_MET: &str = "the bodies are not proved to meet at the pose";

fn judge_path(
    line: &Value,
    reader: &Reader<'_>,
    robot: &Robot,
    target: &Interval,
    parts: &[Value],
) -> Result<RobotProof, Unread> {
    let list = |name: &str| field(line, name)?.as_array().ok_or_else(|| format!("the field \"{name}\" is no list"));
    let waypoints = list("waypoints")?.iter().map(|row| numbers(row, reader)).collect::<Result<Vec<_>, _>>()?;
    if waypoints.is_empty() || waypoints.iter().any(|row| row.len() != robot.values) {
        return Err("a waypoint has another number of values".to_owned());
    }
    let obstacles = list("obstacles")?.iter().map(|obstacle| {
        if obstacle.get("type").and_then(Value::as_str) != Some("half_space") {
            return reader.body(obstacle).map(Obstacle::Body);
        }
        let offset = Interval::from(reader.number(field(obstacle, "offset")?)?);
        Ok(Obstacle::HalfSpace(reader.vector(field(obstacle, "normal")?)?, offset))
    });
    let obstacles = obstacles.collect::<Result<Vec<_>, Unread>>()?;

    let mut sorted = BTreeMap::<Key, Vec<(Vec<f64>, Vec<Vector>)>>::new();
    for part in parts {
        let count = |name| count(part, name);
        let other = if part.get("obstacle").is_some() {
            (count("obstacle")?, None)
        } else {
            (count("other_link")?, Some(count("other_body")?))
        };
        let key = (count("edge")?, count("link")?, count("body")?, other.0, other.1);
        let normals = field(part, "normals")?.as_array().ok_or("the normals are no list")?;
        let normals = normals.iter().map(|normal| reader.vector(normal)).collect::<Result<Vec<_>, _>>()?;
        let times = numbers(field(part, "times")?, reader)?;
        if normals.len() != 2 || times.len() != 2 || !(times[0] >= 0.0 && times[0] <= times[1]) {
            return Err("a part has not two times and two normals".to_owned());
        }
        sorted.entry(key).or_default().push((times, normals));
    }
    let answer = field(line, "answer")?;
    let is_free = field(answer, "free")?.as_bool().ok_or("free is neither true nor false")?;
    let mut proof = RobotProof::new(is_free);
    let last = if waypoints.len() == 1 { 0.0 } else { 1.0 };
    let edges = (waypoints.len() - 1).max(1);
    // The ends of an edge.
    let ends = |edge: usize| {
        let to = waypoints.get((edge + 1).min(waypoints.len() - 1));
        let ends = waypoints.get(edge).filter(|_| edge < edges).zip(to).ok_or("there is no such edge")?;
        Ok::<[&[f64]; 2], Unread>([ends.0, ends.1])
    };
    let mut free = BTreeMap::new();
    let places = Places::default();
    for (key, mut parts) in sorted {
        let (edge, link, body, other, of_link) = key;
        let body = robot.links.get(link).and_then(|link| link.bodies.get(body)).ok_or("there is no such body")?;
        let from = of_link.map(|_| other);
        let stands = match of_link {
            Some(k) => robot.links.get(other).and_then(|link| link.bodies.get(k)).map(Other::Body),
            None => obstacles.get(other).map(|obstacle| match obstacle {
                Obstacle::Body(body) => Other::Body(body),
                Obstacle::HalfSpace(normal, offset) => Other::HalfSpace(normal, offset),
            }),
        };
        let other = stands.ok_or("there is nothing of this index to be free of")?;
        let pair = Pair::new(robot, robot.route(link, from), body, other, target);
        let moving = MovingPair::new(&pair, (edge, link, from), ends(edge)?, &places);
        parts.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
        // Up to when the two are proved to be apart; nothing is known before the first part.
        let mut until: Option<f64> = None;
        for (times, normals) in parts {
            let is_proved = moving.are_apart([times[0], times[1]], [&normals[0], &normals[1]]);
            if proof.count(is_proved) && times[0] <= until.unwrap_or(0.0) {
                until = Some(until.unwrap_or(0.0).max(times[1]));
            }
        }
        free.extend(until.map(|until| (key, until)));
    }
    // The edge that is not free, and up to when it is.
    let time = |name| field(answer, name).and_then(|time| reader.number(time));
    let (stop, lower) = if is_free { (edges, 0.0) } else { (count(answer, "edge")?, time("lower")?) };
    let pairs = line.get("self").and_then(Value::as_array);
    let pairs = pairs.into_iter().flatten().map(|pair| Ok([count(pair, 0)?, count(pair, 1)?]));
    let pairs = pairs.collect::<Result<Vec<[usize; 2]>, Unread>>()?;
    let bodies = |link: usize| robot.links.get(link).map_or(0, |link| link.bodies.len());
    let is_free_until = |key: Key, until: f64| free.get(&key).is_some_and(|free| *free >= until);
    let is_covered = |(edge, until): (usize, f64)| {
        let among = (0..robot.links.len()).all(|link| {
            (0..bodies(link))
                .all(|body| (0..obstacles.len()).all(|k| is_free_until((edge, link, body, k, None), until)))
        });
        let apart = |&[a, b]: &[usize; 2]| {
            (0..bodies(a)).all(|i| (0..bodies(b)).all(|k| is_free_until((edge, a, i, b, Some(k)), until)))
        };
        among && pairs.iter().all(apart)
    };
    let until = (0..edges.min(stop)).map(|edge| (edge, last)).chain((lower > 0.0).then_some((stop, lower)));
    let covered = ({ until }.all(is_covered), NOT_COVERED);
    if is_free {
        return Ok(proof.of([covered]));
    }
    let certain = (field(answer, "certain")?.as_bool() == Some(true), NOT_CERTAIN);
    if !certain.0 {
        return Ok(proof.of([covered, certain]));
    }
    // The pose at the end of the bracket, in the next edge where that has shown the contact.
    let (at, upper) = (time("time")?, time("upper")?);
    if !(lower <= at && at <= upper) {
        return Err("the time is not within its bracket".to_owned());
    }
    let (edge, time) = if upper > 1.0 { (stop + 1, upper - 1.0) } else { (stop, upper) };
    let values = values_at(ends(edge)?, time);
    let met = match answer.get("obstacle") {
        Some(_) => obstacles.get(count(answer, "obstacle")?).cloned().ok_or("there is no such obstacle")?,
        None => Obstacle::Body(robot.placed(count(answer, "other_link")?, count(answer, "other_body")?, &values)?),
    };
    let body = robot.placed(count(answer, "link")?, count(answer, "body")?, &values)?;
    Ok(proof.of([covered, (met.meets(body, target, line, reader)?, NOT_MET)]))
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
    /// Whether it is certainly as near to a body as the target, as the certificate of a line shows.
    fn meets(self, body: Body, target: &Interval, line: &Value, reader: &Reader<'_>) -> Result<bool, Unread> {
        Ok(match self {
            Self::Body(other) => distance(body, other, field(line, "certificate")?, reader)?.upper.is_at_most(target),
            Self::HalfSpace(normal, offset) => {
                let depth = body.core.support(&normal.times(&Interval::from(-1.0))).1;
                let reach = &(&body.radius + target) * &normal.length();
                (-&(&depth + &reach)).is_at_most(&offset)
            }
        })
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

fn judge_box(
    line: &Value,
    reader: &Reader<'_>,
    robot: &Robot,
    target: &Interval,
    parts: &[Value],
) -> Result<RobotProof, Unread> {
    let whole = intervals(field(line, "box")?, reader)?;
    let pair = field(line, "pair")?;
    let links = [count(pair, 0)?, count(pair, 1)?];
    if whole.len() != robot.values || links.iter().any(|&link| link >= robot.links.len()) {
        return Err("the box or the pair is not of this robot".to_owned());
    }
    let answer = field(line, "answer")?;
    let meets = field(answer, "meets")?.as_bool().ok_or("meets is neither true nor false")?;
    let mut proof = RobotProof::new(!meets);
    let [a, b] = links.map(|link| &robot.links[link].bodies);
    let mut boxes = vec![vec![Vec::new(); b.len()]; a.len()];
    for part in parts {
        let [i, k] = [count(part, "body")?, count(part, "other_body")?];
        let (body, other) = a.get(i).zip(b.get(k)).ok_or("there is no such body")?;
        let (joint_box, normal) = (intervals(field(part, "box")?, reader)?, reader.vector(field(part, "plane")?)?);
        if joint_box.len() != robot.values {
            return Err("a part has another number of intervals".to_owned());
        }
        let pair = Pair::new(robot, robot.route(links[0], Some(links[1])), body, Other::Body(other), target);
        if proof.count(pair.is_free_in(&joint_box, &normal, HALVINGS)) {
            boxes[i][k].push(joint_box);
        }
    }
    if meets {
        let values = numbers(field(answer, "values")?, reader)?;
        let is_inside = values.len() == whole.len()
            && values.iter().zip(&whole).all(|(value, [low, high])| (low..=high).contains(&value));
        let values: Vec<_> = values.into_iter().map(Interval::from).collect();
        let placed = |link: usize, body| robot.placed(links[link], count(answer, body)?, &values);
        let is_met =
            is_inside && Obstacle::Body(placed(1, "other_body")?).meets(placed(0, "body")?, target, line, reader)?;
        return Ok(proof.of([(is_met, NOT_MET)]));
    }
    let covered = boxes.iter().flatten().all(|boxes| is_covered(&whole, &boxes.iter().collect::<Vec<_>>()));
    Ok(proof.of([(covered, NOT_COVERED)]))
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
