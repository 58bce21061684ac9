//! Proofs by many planes, each of which stands between two bodies: what those of a [path](crate::path), of a
//! [box of joint values](crate::joint_box) and of a [motion](crate::motion) share.

use serde_json::Value;

use crate::body::Body;
use crate::certificate::Certificate;
use crate::claims::{Finding, Proof, Verdict};
use crate::interval::{Interval, Vector};
use crate::question::Question;
use crate::reader::{Reader, Unread, field, listed, only};
use crate::robot::{Placed, Robot, Route};

/// How often a part of a certificate is halved, where a bound of ours is less sharp than that of who made it.
pub(crate) const HALVINGS: u32 = 14;

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
pub(crate) type Check<C> = fn(&C, &Value) -> Finding;

/// What is said where parts do not cover what is free.
pub(crate) const NOT_COVERED: &str = "what is free is not covered by parts that are proved";

/// What is said of a contact that is none to rounding.
pub(crate) const NOT_CERTAIN: &str = "they may only touch, within rounding, as the answer says itself";

/// What is said where the points of a certificate do not prove a contact.
pub(crate) const NOT_MET: &str = "the bodies are not proved to meet at the pose";

impl Parts {
    pub(crate) fn of(are_of_free: bool) -> Self {
        Self { are_of_free, proved: 0, not_proved: 0 }
    }

    pub(crate) fn count(&mut self, is_proved: bool) -> bool {
        *if is_proved { &mut self.proved } else { &mut self.not_proved } += 1;
        is_proved
    }

    pub(crate) fn proof(self, (verdict, because): (Verdict, Option<String>)) -> Proof {
        Proof { verdict, because, bounds: None, parts: Some(self) }
    }
}

/// Two bodies of which one moves: the other is seen at rest.
pub(crate) struct Pair<'r> {
    pub(crate) robot: &'r Robot,
    pub(crate) route: Route,
    pub(crate) body: &'r Body,
    other: Other<'r>,
    /// How far points of the body's core are from its frame's origin.
    pub(crate) reach: Interval,
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
pub(crate) enum Obstacle {
    Body(Body),
    HalfSpace(Vector, Interval),
}

/// What a body of a link meets, or does not.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Met {
    Obstacle(usize),
    Link { link: usize, body: usize },
}

/// A body of a link, and what it meets, or does not.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Who {
    pub(crate) link: usize,
    pub(crate) body: usize,
    pub(crate) met: Met,
}

impl Who {
    /// The fields that say it.
    pub(crate) const FIELDS: &[&str] = &["link", "body", "obstacle", "other_link", "other_body"];

    pub(crate) fn read(object: &Value) -> Result<Self, Unread> {
        let count = |name| count(object, name);
        let met = match object.get("obstacle") {
            Some(_) if object.get("other_link").or(object.get("other_body")).is_some() => {
                return Err("it names both an obstacle and another link".to_owned());
            }
            Some(_) => Met::Obstacle(count("obstacle")?),
            None => Met::Link { link: count("other_link")?, body: count("other_body")? },
        };
        Ok(Self { link: count("link")?, body: count("body")?, met })
    }

    /// The link from which the first is seen.
    pub(crate) fn base(self) -> Option<usize> {
        if let Met::Link { link, .. } = self.met { Some(link) } else { None }
    }
}

/// A robot, what stands around it, and the pairs of its own links that are asked about.
pub(crate) struct Surrounded {
    pub(crate) robot: Robot,
    obstacles: Vec<Obstacle>,
    pairs: Vec<[usize; 2]>,
}

impl Surrounded {
    /// The fields that are read.
    pub(crate) const FIELDS: &[&str] = &["joints", "links", "obstacles", "self"];

    pub(crate) fn read(line: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        let obstacles = listed(field(line, "obstacles")?)?.iter().map(|obstacle| Obstacle::read(obstacle, reader));
        let obstacles = obstacles.collect::<Result<_, _>>()?;
        let pairs = line.get("self").map_or(Ok(&[][..]), listed)?.iter().map(links);
        Self::of(Robot::read(line, reader)?, obstacles, pairs.collect::<Result<_, _>>()?)
    }

    pub(crate) fn of(robot: Robot, obstacles: Vec<Obstacle>, pairs: Vec<[usize; 2]>) -> Result<Self, Unread> {
        if pairs.iter().flatten().any(|&link| link >= robot.links.len()) {
            return Err("a pair is not of this robot".to_owned());
        }
        Ok(Self { robot, obstacles, pairs })
    }

    /// All that is asked about.
    pub(crate) fn asked(&self) -> impl Iterator<Item = Who> + '_ {
        let bodies = |link: usize| 0..self.robot.links[link].bodies.len();
        let among = (0..self.robot.links.len()).flat_map(move |link| {
            let obstacles = 0..self.obstacles.len();
            bodies(link).flat_map(move |body| obstacles.clone().map(move |k| Who { link, body, met: Met::Obstacle(k) }))
        });
        let between = self.pairs.iter().flat_map(move |&[link, other]| {
            bodies(link).flat_map(move |body| {
                bodies(other).map(move |k| Who { link, body, met: Met::Link { link: other, body: k } })
            })
        });
        among.chain(between)
    }

    /// An error where these two are not among what is asked about, in either order.
    pub(crate) fn check_asked(&self, who: Who) -> Result<(), Unread> {
        let is_pair =
            |link: usize| self.pairs.iter().any(|pair| *pair == [who.link, link] || *pair == [link, who.link]);
        match who.met {
            Met::Link { link, .. } if !is_pair(link) => {
                Err("the links of the contact are no pair that is asked about".to_owned())
            }
            _ => Ok(()),
        }
    }

    /// The two, of which the first moves as the second sees it.
    pub(crate) fn pair(&self, who: Who, target: &Interval) -> Result<Pair<'_>, Unread> {
        let of = |link: usize, body: usize| self.robot.links.get(link).and_then(|link| link.bodies.get(body));
        let body = of(who.link, who.body).ok_or("there is no such body")?;
        let other = match who.met {
            Met::Link { link, body } => of(link, body).map(Other::Body),
            Met::Obstacle(index) => self.obstacles.get(index).map(|obstacle| match obstacle {
                Obstacle::Body(body) => Other::Body(body),
                Obstacle::HalfSpace(normal, offset) => Other::HalfSpace(normal, offset),
            }),
        };
        let other = other.ok_or("there is nothing of this index to be free of")?;
        let route = self.robot.route(who.link, who.base());
        let reach = body.core.reach_from(&Vector::zero());
        Ok(Pair { robot: &self.robot, route, body, other, reach, target: target.clone() })
    }

    /// The two where these joint values have them in the world.
    pub(crate) fn placed(&self, who: Who, values: &[Interval]) -> Result<(Body, Obstacle), Unread> {
        let met = match who.met {
            Met::Obstacle(index) => self.obstacles.get(index).cloned().ok_or("there is no such obstacle")?,
            Met::Link { link, body } => Obstacle::Body(self.robot.placed(link, body, values)?),
        };
        Ok((self.robot.placed(who.link, who.body, values)?, met))
    }
}

impl Obstacle {
    /// A body that stands, or a half-space.
    pub(crate) fn read(written: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        if written.get("type").and_then(Value::as_str) != Some("half_space") {
            return reader.body(written).map(Self::Body);
        }
        only(written, "a half-space", &[&["type", "normal", "offset"]])?;
        let normal = reader.vector(field(written, "normal")?)?;
        let _ = normal.unit().ok_or("the normal of a half-space is zero")?;
        Ok(Self::HalfSpace(normal, Interval::from(reader.number(field(written, "offset")?)?)))
    }

    /// How far it is from a body at most, as the points of a certificate prove.
    pub(crate) fn distance(self, body: Body, certificate: &Value, reader: &Reader<'_>) -> Result<Interval, Unread> {
        Ok(match self {
            Self::Body(other) => {
                let question = Question::of_distance(body, other, reader);
                let certificate = Certificate::read(certificate, question.core(), reader)?;
                question.proved(&certificate).upper
            }
            Self::HalfSpace(normal, offset) => {
                let depth = body.core.support(&normal.times(&Interval::from(-1.0))).1;
                let height = (-&(&depth + &offset)).over(&normal.length());
                (&height - &body.radius).max(&Interval::zero()).greatest()
            }
        })
    }

    /// By how much the plane across a unit normal separates a body from it. Of a half-space that is known of its own
    /// normal alone.
    pub(crate) fn separation(&self, body: &Body, normal: &Vector, reader: &Reader<'_>) -> Option<Interval> {
        let down = &body.core.support(&normal.times(&Interval::from(-1.0))).1 + &body.radius;
        let up = match self {
            Self::Body(other) => &other.core.support(normal).1 + &other.radius,
            Self::HalfSpace(own, offset) => {
                let length = own.length();
                let off = normal.minus(&Vector(own.0.each_ref().map(|x| x.over(&length)))).length();
                if !off.is_at_most(&(&reader.rounding() * &Interval::from(64.0))) {
                    return None;
                }
                offset.over(&length)
            }
        };
        Some(-&(&down + &up))
    }

    /// Whether a point is certainly no farther from it than this.
    pub(crate) fn is_near(&self, point: &Vector, slack: &Interval) -> bool {
        match self {
            Self::Body(body) => body.distance_from(point, None, slack).is_at_most(slack),
            Self::HalfSpace(normal, offset) => (&normal.dot(point) - offset).is_at_most(&(slack * &normal.length())),
        }
    }

    /// A bound on the numbers that computing with it comes by.
    pub(crate) fn magnitude(&self) -> Interval {
        match self {
            Self::Body(body) => body.magnitude(),
            Self::HalfSpace(normal, offset) => offset.absolute().over(&normal.length()),
        }
    }
}

impl Pair<'_> {
    /// How far the other reaches along a normal at rest, and what radii and the target take, times its length.
    pub(crate) fn level(&self, normal: &Vector) -> Interval {
        let (reach, radius) = match self.other {
            Other::Body(other) => (other.core.support(normal).1, other.radius.clone()),
            Other::HalfSpace(_, offset) => (offset.clone(), Interval::zero()),
        };
        &reach + &(&(&(&self.body.radius + &radius) + &self.target) * &normal.length())
    }

    /// The normal that counts: of a half-space always its own.
    pub(crate) fn normal(&self, given: &Vector) -> Vector {
        match self.other {
            Other::HalfSpace(own, _) => own.clone(),
            Other::Body(_) => given.clone(),
        }
    }

    /// By how much the plane across a normal separates the bodies, the one as it is placed.
    pub(crate) fn gap(&self, placed: &Placed, normal: &Vector) -> Interval {
        let down = placed.seen(normal).times(&Interval::from(-1.0));
        let least = &normal.dot(&placed.at) - &self.body.core.support(&down).1;
        &least - &self.level(normal)
    }
}

pub(crate) fn numbers(value: &Value, reader: &Reader<'_>) -> Result<Vec<f64>, Unread> {
    let items = value.as_array().ok_or("a list of numbers is none")?;
    items.iter().map(|item| reader.number(item)).collect()
}

/// The index that a field, or an item, is.
pub(crate) fn count<I: serde_json::value::Index + Copy + std::fmt::Display>(
    object: &Value,
    at: I,
) -> Result<usize, Unread> {
    let index = object.get(at).and_then(Value::as_u64).and_then(|index| usize::try_from(index).ok());
    index.ok_or_else(|| format!("{at} is no index"))
}

/// The indices of two links.
pub(crate) fn links(pair: &Value) -> Result<[usize; 2], Unread> {
    match listed(pair)? {
        [_, _] => Ok([count(pair, 0)?, count(pair, 1)?]),
        _ => Err("a pair of links is not two".to_owned()),
    }
}
