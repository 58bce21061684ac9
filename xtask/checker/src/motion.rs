//! The least distance of two bodies that move rigidly.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use serde_json::Value;

use crate::body::{Body, Set, apply, combined, diagonal_of};
use crate::claims::{Proof, UNITS, of_fields};
use crate::clearance::{self, Nearest};
use crate::free::{Check, Obstacle, Parts};
use crate::interval::{Interval, Vector};
use crate::moving::{Moving, apart_until, planes};
use crate::question::EVERY;
use crate::reader::{Reader, Unread, field, listed, only};
use crate::robot::{Bounds, turned};

/// The fields of the question.
const FIELDS: &[&str] = &["a", "b", "motion_a", "motion_b", "max_time"];

/// A motion at a constant velocity, and at a constant angular velocity about a centre that moves so.
struct Motion {
    velocity: Vector,
    spin: Vector,
    center: Vector,
}

/// Two bodies and their motions. A half-space is seen at rest, and so is its plane.
struct Pair {
    a: Body,
    b: Obstacle,
    motions: [Motion; 2],
    target: Interval,
    bounds: Bounds,
    poses: RefCell<HashMap<u64, Rc<[Pose; 2]>>>,
}

/// Where a motion has a body at a time: `x ↦ Rx + at`.
struct Pose {
    rows: [Vector; 3],
    at: Vector,
}

/// What the certificate of a `motion_clearance` proves.
pub(crate) fn judge(line: &Value, answer: &Value, certificate: &Value, reader: &Reader<'_>) -> Result<Proof, Unread> {
    only(line, "the query", &[EVERY, FIELDS])?;
    only(certificate, "the certificate", &[&["plane", "points", "free", "met"]])?;
    let (a, b) = (reader.body(field(line, "a")?)?, Obstacle::read(field(line, "b")?, reader)?);
    let motions = [Motion::read(line, "motion_a", reader)?, Motion::read(line, "motion_b", reader)?];
    let max_time = reader.number(field(line, "max_time")?)?.max(0.0);
    let mut nearest = Nearest::read(line, answer, reader)?;
    if nearest.time > max_time {
        return Err("the time is beyond the end of the motion".to_owned());
    }
    let pair = Pair::new(a, b, motions, &nearest.lower, max_time);
    let mut parts = Parts::of(!nearest.is_contact());
    let mut timed = Vec::new();
    for part in listed(field(certificate, "free")?)? {
        only(part, "a part", &[&["times", "normals"]])?;
        timed.push(planes(part, reader)?);
    }
    let until = apart_until(&pair, timed, max_time, &mut parts);
    let (mut met, mut last) = (None, max_time);
    if nearest.is_contact() {
        let at = field(certificate, "met")?;
        only(at, "what is met", &[&["lower", "upper"]])?;
        let [lower, upper] = ["lower", "upper"].map(|name| reader.number(field(at, name)?));
        let at = [lower?, upper?];
        if at[1] > max_time {
            return Err("the end of the bracket is beyond that of the motion".to_owned());
        }
        let (body, obstacle) = pair.placed(at[1]);
        (met, last) = (Some((at, obstacle.distance(body, certificate, reader)?)), at[0]);
    }
    let bodies = pair.placed(nearest.time);
    let is_at_once = max_time == 0.0 && nearest.is_by_its_normal(&bodies) || met.is_some() && last == 0.0;
    let is_covered = until.is_some_and(|until| until >= last) || is_at_once;
    let width = met.as_ref().map_or(0.0, |(at, _)| at[1] - at[0]);
    let slack = pair.slack(reader, nearest.time, width);
    nearest.prove(bodies, is_covered, met, slack, certificate)?;
    let mut table = clearance::claims();
    table.push((
        "iterations",
        (|_, value| value.as_u64().map(|_| true).ok_or_else(|| "it is no number of steps".to_owned())) as Check<_>,
    ));
    let proof = parts.proof(of_fields(answer, &table, clearance::REQUIRED, |check, value| check(&nearest, value)));
    Ok(Proof { bounds: nearest.bounds(), ..proof })
}

impl Motion {
    fn read(line: &Value, name: &str, reader: &Reader<'_>) -> Result<Self, Unread> {
        let zero = Vector::zero;
        let Some(motion) = line.get(name) else {
            return Ok(Self { velocity: zero(), spin: zero(), center: zero() });
        };
        only(motion, "a motion", &[&["velocity", "angular_velocity", "center"]])?;
        let spin = match motion.get("angular_velocity") {
            None => zero(),
            Some(rate) if rate.is_number() => {
                reader.note(2, rate)?;
                Vector([0.0, 0.0, reader.number(rate)?].map(Interval::from))
            }
            Some(rate) => {
                reader.note(3, rate)?;
                reader.vector(rate)?
            }
        };
        let [velocity, center] = ["velocity", "center"].map(|name| reader.vector_or_zero(motion, name));
        Ok(Self { velocity: velocity?, spin, center: center? })
    }

    /// `x ↦ R(x − c) + c + t·v`.
    fn at(&self, time: f64) -> Pose {
        let time = Interval::from(time);
        let rows = match self.spin.unit() {
            Some(axis) => turned(&axis, &(&self.spin.length() * &time)),
            None => diagonal_of(&Interval::from(1.0)),
        };
        let at = self.center.plus(&self.velocity.times(&time)).minus(&apply(&rows, &self.center));
        Pose { rows, at }
    }
}

impl Pair {
    /// With bounds on how fast points of the cores move against one another, and how unevenly.
    ///
    /// A point within `r` of the centre of a motion has the velocity `v + ω×y`, and the acceleration `ω×(ω×y)`, with
    /// `|y| ≤ r`. As a half-space sees it that turns at `ω_B`, it is within a distance `D` of the centre of that one;
    /// it has the speed `s` against that centre, and the acceleration `ω_A²·r + 2·ω_B·s + ω_B²·D`.
    fn new(a: Body, b: Obstacle, motions: [Motion; 2], target: &Interval, max_time: f64) -> Self {
        let [by_a, by_b] = &motions;
        let reach = a.core.reach_from(&by_a.center);
        let [w, w_b] = [by_a, by_b].map(|motion| motion.spin.length());
        let past = by_a.velocity.minus(&by_b.velocity).length();
        let bounds = match &b {
            Obstacle::Body(b) => {
                let reach_b = b.core.reach_from(&by_b.center);
                let speed = &(&past + &(&w * &reach)) + &(&w_b * &reach_b);
                Bounds { speed, acceleration: &(&w.squared() * &reach) + &(&w_b.squared() * &reach_b) }
            }
            Obstacle::HalfSpace(..) => {
                let speed = &past + &(&w * &reach);
                let way = &past * &Interval::from(max_time);
                let far = &(&by_a.center.minus(&by_b.center).length() + &way) + &reach;
                let twice = &(&w_b * &speed) + &(&w_b * &speed);
                let acceleration = &(&(&w.squared() * &reach) + &twice) + &(&w_b.squared() * &far);
                Bounds { speed: &speed + &(&w_b * &far), acceleration }
            }
        };
        let bounds = bounds.greatest();
        Self { a, b, motions, target: target.clone(), bounds, poses: RefCell::default() }
    }

    fn poses(&self, time: f64) -> Rc<[Pose; 2]> {
        let place = || Rc::new(self.motions.each_ref().map(|motion| motion.at(time)));
        self.poses.borrow_mut().entry(time.to_bits()).or_insert_with(place).clone()
    }

    /// The bodies at a time.
    fn placed(&self, time: f64) -> (Body, Obstacle) {
        let poses = self.poses(time);
        let placed = |body: &Body, Pose { rows, at }: &Pose| Body {
            core: Set::Image(Box::new(body.core.clone()), rows.clone(), at.clone()),
            radius: body.radius.clone(),
        };
        let b = match &self.b {
            Obstacle::Body(b) => Obstacle::Body(placed(b, &poses[1])),
            Obstacle::HalfSpace(normal, offset) => {
                let normal = apply(&poses[1].rows, normal);
                let offset = offset + &normal.dot(&poses[1].at);
                Obstacle::HalfSpace(normal, offset)
            }
        };
        (placed(&self.a, &poses[0]), b)
    }

    /// What rounding may move points by, and that and what the bodies may move against one another in a while.
    fn slack(&self, reader: &Reader<'_>, time: f64, width: f64) -> [Interval; 2] {
        let time = Interval::from(time);
        let way = |motion: &Motion| {
            let turns = &Interval::from(1.0) + &(&motion.spin.length() * &time);
            (&(&motion.velocity.length() * &time) + &motion.center.length(), turns)
        };
        let [(way_a, turns_a), (way_b, turns_b)] = self.motions.each_ref().map(way);
        let size = &(&(&self.a.magnitude() + &self.b.magnitude()) + &(&way_a + &way_b)) + &self.target;
        let rounding = &(&(&reader.rounding() * &Interval::from(UNITS)) * &size) * &(&turns_a + &turns_b);
        let open = &(&self.bounds.speed * &Interval::from(width)) + &rounding;
        let slack = &open + &(&(&size + &size) * &open).root();
        [rounding.greatest(), if width > 0.0 { slack.greatest() } else { rounding.greatest() }]
    }
}

impl Moving for Pair {
    fn gap(&self, time: f64, normal: &Vector) -> Interval {
        let [a, b] = &*self.poses(time);
        let lowest = |normal: &Vector| {
            let down = combined(&a.rows, normal).times(&Interval::from(-1.0));
            &normal.dot(&a.at) - &self.a.core.support(&down).1
        };
        let (least, highest, radius) = match &self.b {
            Obstacle::Body(body) => {
                let highest = &normal.dot(&b.at) + &body.core.support(&combined(&b.rows, normal)).1;
                (lowest(normal), highest, body.radius.clone())
            }
            Obstacle::HalfSpace(own, offset) => {
                let seen = apply(&b.rows, own);
                (lowest(&seen), offset + &seen.dot(&b.at), Interval::zero())
            }
        };
        let radii = &(&self.a.radius + &radius) + &self.target;
        &(&least - &highest) - &(&radii * &normal.length())
    }

    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn normal(&self, given: &Vector) -> Vector {
        match &self.b {
            Obstacle::Body(_) => given.clone(),
            Obstacle::HalfSpace(own, _) => own.clone(),
        }
    }
}
