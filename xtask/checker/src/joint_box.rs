//! Whether links ever meet one another, or what stands around, in a box of joint values.

use std::collections::BTreeMap;

use serde_json::Value;

use crate::claims::{Finding, Proof, flag, of_fields, within_rounding};
use crate::free::{Check, HALVINGS, Met, NOT_COVERED, NOT_MET, Pair, Parts, Surrounded, Who, count, links, numbers};
use crate::interval::{Interval, Vector};
use crate::question::{EVERY, target_distance};
use crate::reader::{Reader, Unread, field, listed, only};
use crate::robot::{Lever, Robot};

/// What the fields of the answer claim.
const CLAIMS: &[(&str, Check<Case>)] = &[
    ("meets", Case::meets),
    ("values", Case::named),
    ("link", Case::named),
    ("body", Case::named),
    ("obstacle", Case::named),
    ("other_link", Case::named),
    ("other_body", Case::named),
    ("boxes", |_, value| boxes(value)),
];

/// The fields of the answer that a pair of links says itself.
const OF_PAIR: &[&str] = &["link", "obstacle", "other_link"];

/// What those of a box that was grown claim.
fn claims_of_grown<'t>() -> [(&'static str, Check<Grown<'t>>); 3] {
    [("grown", Grown::grown), ("stops", Grown::stops), ("boxes", |_, value| boxes(value))]
}

/// A number of parts of boxes, which says nothing of the robot.
fn boxes(value: &Value) -> Finding {
    value.as_u64().map(|_| true).ok_or_else(|| "it is no number of boxes".to_owned())
}

/// The fields of the question beside those of what is asked about.
const FIELDS: &[&str] = &["box", "target_distance", "grow"];

/// What the certificate of a `joint_box` proves.
pub(crate) fn judge(line: &Value, answer: &Value, certificate: &Value, reader: &Reader<'_>) -> Result<Proof, Unread> {
    only(certificate, "the certificate", &[&["plane", "points", "free", "stops"]])?;
    let pair = line.get("pair").map(links).transpose()?;
    let around = match pair {
        Some(pair) => {
            only(line, "the query", &[EVERY, &["joints", "links", "pair"], FIELDS])?;
            Surrounded::of(Robot::read(line, reader)?, Vec::new(), vec![pair])?
        }
        None => {
            only(line, "the query", &[EVERY, Surrounded::FIELDS, FIELDS])?;
            Surrounded::read(line, reader)?
        }
    };
    let target = target_distance(line, reader)?;
    let limits = intervals(field(line, "box")?, reader)?;
    if limits.len() != around.robot.values {
        return Err("the box is not of this robot".to_owned());
    }
    let grow = line.get("grow").map(|values| numbers(values, reader)).transpose()?;
    if grow.is_some() && pair.is_some() {
        return Err("grow does not stand beside pair".to_owned());
    }
    // What is claimed to be free: all of the box, or what was grown in it.
    let whole = if grow.is_some() { intervals(field(answer, "grown")?, reader)? } else { limits.clone() };
    let meets = if grow.is_some() { false } else { flag(field(answer, "meets")?)? };
    let mut parts = Parts::of(!meets);
    // The bodies of a pair are named without their links.
    let who = |object: &Value| match pair {
        None => Who::read(object),
        Some([link, other]) => {
            let met = Met::Link { link: other, body: count(object, "other_body")? };
            Ok(Who { link, body: count(object, "body")?, met })
        }
    };
    let mut boxes = BTreeMap::<Who, Vec<Vec<[f64; 2]>>>::new();
    for part in listed(field(certificate, "free")?)? {
        only(part, "a part", &[&["box", "plane"], if pair.is_some() { &["body", "other_body"] } else { Who::FIELDS }])?;
        let who = who(part)?;
        let (joint_box, normal) = (intervals(field(part, "box")?, reader)?, reader.vector(field(part, "plane")?)?);
        if joint_box.len() != around.robot.values {
            return Err("a part has another number of intervals".to_owned());
        }
        let pair = around.pair(who, &target)?;
        if parts.count(pair.is_free_in(&joint_box, &pair.normal(&normal), HALVINGS)) {
            boxes.entry(who).or_default().push(joint_box);
        }
    }
    let is_so = if meets {
        let values = numbers(field(answer, "values")?, reader)?;
        let is_inside = values.len() == whole.len()
            && values.iter().zip(&whole).all(|(value, [low, high])| (low..=high).contains(&value));
        let who = who(answer)?;
        around.check_asked(who)?;
        let (body, met) = around.placed(who, &values.into_iter().map(Interval::from).collect::<Vec<_>>())?;
        is_inside && met.distance(body, certificate, reader)?.is_at_most(&target)
    } else {
        let none = Vec::new();
        around.asked().all(|who| is_covered(&whole, &boxes.get(&who).unwrap_or(&none).iter().collect::<Vec<_>>()))
    };
    if let Some(values) = grow {
        let grown =
            Grown { around: &around, reader, certificate, target, values, limits, grown: whole, is_covered: is_so };
        let required = ["grown", "stops"];
        return Ok(parts.proof(of_fields(answer, &claims_of_grown(), &required, |check, value| check(&grown, value))));
    }
    let required: &[&str] = match (meets, pair) {
        (false, _) => &["meets"],
        (true, None) => &["meets", "values", "link", "body"],
        (true, Some(_)) => &["meets", "values", "body", "other_body"],
    };
    let table: Vec<_> = CLAIMS.iter().copied().filter(|(name, _)| pair.is_none() || !OF_PAIR.contains(name)).collect();
    let case = Case { meets, is_so };
    Ok(parts.proof(of_fields(answer, &table, required, |check, value| check(&case, value))))
}

/// A box that was grown, and what is proved of it.
struct Grown<'t> {
    around: &'t Surrounded,
    reader: &'t Reader<'t>,
    certificate: &'t Value,
    target: Interval,
    values: Vec<f64>,
    limits: Vec<[f64; 2]>,
    grown: Vec<[f64; 2]>,
    is_covered: bool,
}

impl Grown<'_> {
    /// It is free, within its limits, and around the values.
    fn grown(&self, _: &Value) -> Finding {
        let Self { values, limits, grown, .. } = self;
        if grown.len() != limits.len() || values.len() != limits.len() {
            return Err("it is not of this robot".to_owned());
        }
        let is_within = |(ends, limits): (&[f64; 2], &[f64; 2])| limits[0] <= ends[0] && ends[1] <= limits[1];
        let is_around = |(ends, value): (&[f64; 2], &f64)| ends[0] <= *value && *value <= ends[1];
        if !(grown.iter().zip(limits).all(is_within) && grown.iter().zip(values).all(is_around)) {
            return Ok(false);
        }
        within_rounding(self.is_covered, NOT_COVERED)
    }

    /// A face that a limit stopped is at it. Bodies that stopped one are asked about; and if values are told, these are
    /// beyond the face alone, and the bodies meet there. That no more could be proved says nothing of the robot.
    fn stops(&self, value: &Value) -> Finding {
        let stops = listed(value)?;
        if stops.len() != 2 * self.grown.len() {
            return Err("there are not two for each joint".to_owned());
        }
        for (face, stop) in stops.iter().enumerate() {
            let (column, end) = (face / 2, face % 2);
            let (at, limit) = (self.grown[column][end], self.limits[column][end]);
            match stop.get("by").and_then(Value::as_str) {
                Some("limit") if at == limit => only(stop, "a stop", &[&["by"]])?,
                Some("limit") => return Ok(false),
                Some("work") => only(stop, "a stop", &[&["by"]])?,
                Some("bodies") => {
                    only(stop, "a stop", &[&["by", "values"], Who::FIELDS])?;
                    let who = Who::read(stop)?;
                    self.around.check_asked(who)?;
                    let Some(values) = stop.get("values") else { continue };
                    let values = numbers(values, self.reader)?;
                    let is_there = |(i, value): (usize, &f64)| {
                        let [low, high] = self.grown[i];
                        match (i == column, end) {
                            (false, _) => (low..=high).contains(value),
                            (true, 0) => self.limits[i][0] <= *value && *value < low,
                            (true, _) => high < *value && *value <= self.limits[i][1],
                        }
                    };
                    if values.len() != self.grown.len() || !values.iter().enumerate().all(is_there) {
                        return Ok(false);
                    }
                    let (body, met) =
                        self.around.placed(who, &values.into_iter().map(Interval::from).collect::<Vec<_>>())?;
                    let proof = field(self.certificate, "stops")?.get(face).ok_or("there is no proof of it")?;
                    if !met.distance(body, proof, self.reader)?.is_at_most(&self.target) {
                        return Err(NOT_MET.to_owned());
                    }
                }
                _ => return Err("what stopped a face is none that is known".to_owned()),
            }
        }
        Ok(true)
    }
}

/// An answer about a box of joint values.
struct Case {
    meets: bool,
    /// Whether that is proved.
    is_so: bool,
}

impl Case {
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
    pub(crate) fn is_free_in(&self, joint_box: &[[f64; 2]], normal: &Vector, halvings: u32) -> bool {
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

fn intervals(value: &Value, reader: &Reader<'_>) -> Result<Vec<[f64; 2]>, Unread> {
    let items = value.as_array().ok_or("a box is no list of intervals")?;
    let interval = |item: &Value| match numbers(item, reader)?.as_slice() {
        &[low, high] if low <= high => Ok([low, high]),
        _ => Err("an interval of a box is none".to_owned()),
    };
    items.iter().map(interval).collect()
}
