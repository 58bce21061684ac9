//! Robots: where joints have what they carry, and how fast that may move, in intervals.

use serde_json::Value;

use crate::body::{Body, Set, apply, combined, product, transposed};
use crate::interval::{Interval, Vector};
use crate::reader::{Reader, Unread, field, only};

/// A robot as its query says it.
pub(crate) struct Robot {
    joints: Vec<Joint>,
    pub(crate) links: Vec<Link>,
    /// How many joints move.
    pub(crate) values: usize,
}

/// A joint: its frame in its parent's, at the value 0, and how it moves from there.
struct Joint {
    parent: Option<usize>,
    rows: [Vector; 3],
    at: Vector,
    /// The unit axis and the place of its value, of a joint that moves.
    moves: Option<(Kind, Vector, usize)>,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Turns,
    Slides,
}

/// Bodies that a joint carries.
pub(crate) struct Link {
    joint: Option<usize>,
    pub(crate) bodies: Vec<Body>,
}

/// The joints that move one link against another, or against the world: those back from the other to where both ways
/// part, outermost first, and those on from there.
pub(crate) struct Route {
    back: Vec<usize>,
    on: Vec<usize>,
}

/// Where a link is, seen from the end of a route where it begins.
pub(crate) struct Placed {
    pub(crate) rows: [Vector; 3],
    pub(crate) at: Vector,
    /// For each joint that moves, its place among the values and what its way along `n` is of: with the axis `a` and
    /// the origin `c`, `(n × a)·(x − c)` for one that turns, and `n·a` for one that slides.
    pub(crate) levers: Vec<(usize, Lever)>,
}

pub(crate) enum Lever {
    Turn { axis: Vector, origin: Vector },
    Slide { axis: Vector },
}

/// What points are no faster than, and no more accelerated.
pub(crate) struct Bounds {
    pub(crate) speed: Interval,
    pub(crate) acceleration: Interval,
}

impl Robot {
    pub(crate) fn read(line: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        let list = |name: &str| {
            field(line, name)?.as_array().cloned().ok_or_else(|| format!("the field \"{name}\" is no list"))
        };
        let mut joints = Vec::new();
        let mut values = 0;
        for joint in list("joints")? {
            only(&joint, "a joint", &[&["type", "parent", "translation", "rotation", "axis"]])?;
            let kind = match field(&joint, "type")?.as_str().unwrap_or_default() {
                "revolute" => Some(Kind::Turns),
                "prismatic" => Some(Kind::Slides),
                "fixed" => None,
                other => return Err(format!("there is no joint \"{other}\"")),
            };
            let axis = |kind: Kind| -> Result<(Kind, Vector, usize), Unread> {
                let written = field(&joint, "axis")?;
                let axis = if written.is_number() {
                    Vector([0.0, 0.0, reader.number(written)?].map(Interval::from))
                } else {
                    reader.vector(written)?
                };
                let unit = axis.unit().ok_or("an axis is zero")?;
                values += 1;
                Ok((kind, unit, values - 1))
            };
            let parent = index(&joint, "parent", joints.len())?;
            let (rows, at) = (reader.rotation(joint.get("rotation"))?, reader.vector_or_zero(&joint, "translation")?);
            joints.push(Joint { parent, rows, at, moves: kind.map(axis).transpose()? });
        }
        let written = list("links")?;
        let links = written.iter().map(|link| {
            only(link, "a link", &[&["joint", "shapes"]])?;
            let shapes = field(link, "shapes")?.as_array().ok_or("the shapes of a link are no list")?;
            let bodies = shapes.iter().map(|shape| reader.body(shape)).collect::<Result<_, _>>()?;
            Ok(Link { joint: index(link, "joint", joints.len())?, bodies })
        });
        let links = links.collect::<Result<_, Unread>>()?;
        Ok(Self { joints, links, values })
    }

    /// A bound on how far from the world's origin joints take what they carry, and on the sum of the angles that they
    /// turn by, while no value is more than `most`.
    pub(crate) fn magnitude(&self, most: &[Interval]) -> (Interval, Interval) {
        let (mut size, mut turns) = (Interval::zero(), Interval::zero());
        for joint in &self.joints {
            size = &size + &joint.at.length();
            match &joint.moves {
                Some((Kind::Slides, _, value)) => size = &size + &most[*value],
                Some((Kind::Turns, _, value)) => turns = &turns + &most[*value],
                None => {}
            }
        }
        (size, turns)
    }

    /// A bound on how fast joints move what is nowhere farther than `reach` from any of their axes.
    pub(crate) fn speed(&self, rates: &[Interval], reach: &Interval) -> Interval {
        let of = |(kind, _, value): &(Kind, Vector, usize)| match kind {
            Kind::Slides => rates[*value].clone(),
            Kind::Turns => &rates[*value] * reach,
        };
        self.joints.iter().filter_map(|joint| joint.moves.as_ref()).map(of).fold(Interval::zero(), |sum, w| &sum + &w)
    }

    /// The joints from the world to a link.
    fn way(&self, link: usize) -> Vec<usize> {
        let mut way = Vec::new();
        let mut next = self.links[link].joint;
        while let Some(joint) = next {
            way.push(joint);
            next = self.joints[joint].parent;
        }
        way.reverse();
        way
    }

    /// The route to a link from another, or from the world.
    pub(crate) fn route(&self, link: usize, from: Option<usize>) -> Route {
        let (to, from) = (self.way(link), from.map_or(Vec::new(), |from| self.way(from)));
        let shared = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
        Route { back: from[shared..].iter().rev().copied().collect(), on: to[shared..].to_vec() }
    }

    /// Where a route leads with these joint values.
    pub(crate) fn place(&self, route: &Route, values: &[Interval]) -> Placed {
        let one = Interval::from(1.0);
        let mut rows = crate::body::diagonal_of(&one);
        let (mut at, mut levers) = (Vector::zero(), Vec::new());
        let lever = |kind, axis: Vector, origin: &Vector| match kind {
            Kind::Turns => Lever::Turn { axis, origin: origin.clone() },
            Kind::Slides => Lever::Slide { axis },
        };
        for &joint in &route.back {
            let Joint { rows: fixed, at: arm, moves, .. } = &self.joints[joint];
            if let Some((kind, axis, column)) = moves {
                let seen = apply(&rows, axis);
                match kind {
                    Kind::Turns => rows = product(&rows, &transposed(&turned(axis, &values[*column]))),
                    Kind::Slides => at = at.minus(&seen.times(&values[*column])),
                }
                levers.push((*column, lever(*kind, seen, &at)));
            }
            rows = product(&rows, &transposed(fixed));
            at = at.minus(&apply(&rows, arm));
        }
        for &joint in &route.on {
            let Joint { rows: fixed, at: arm, moves, .. } = &self.joints[joint];
            at = at.plus(&apply(&rows, arm));
            rows = product(&rows, fixed);
            if let Some((kind, axis, column)) = moves {
                let seen = apply(&rows, axis);
                match kind {
                    Kind::Turns => rows = product(&rows, &turned(axis, &values[*column])),
                    Kind::Slides => at = at.plus(&seen.times(&values[*column])),
                }
                levers.push((*column, lever(*kind, seen, &at)));
            }
        }
        Placed { rows, at, levers }
    }

    /// A body of a link, if there is one, where these joint values have it in the world.
    pub(crate) fn placed(&self, link: usize, body: usize, values: &[Interval]) -> Result<Body, Unread> {
        let of = self.links.get(link).and_then(|link| link.bodies.get(body));
        let Body { core, radius } = of.ok_or("there is no such body")?.clone();
        let Placed { rows, at, .. } = self.place(&self.route(link, None), values);
        Ok(Body { core: Set::Image(Box::new(core), rows, at), radius })
    }

    /// Bounds for points of the link within `reach` of its frame's origin, whatever the joint values are, if they
    /// change at constant rates, and slide no farther than `slides`.
    ///
    /// A joint that turns at `w` what moves at the speed `s` and the acceleration `a`, at a distance `l` from its axis,
    /// gives it the speed `w·l + s` and the acceleration `w²·l + 2w·s + a`: the derivatives of a product. One that
    /// slides adds to the speed. The distance from an origin is at most that from the next, and the way between them,
    /// of which only what is across the axis counts for `l`.
    pub(crate) fn bounds(&self, route: &Route, reach: &Interval, rates: &[Interval], slides: &[Interval]) -> Bounds {
        let mut bounds = Bounds { speed: Interval::zero(), acceleration: Interval::zero() };
        let mut reach = reach.clone();
        // Of a way that is the next joint's, seen along the axis.
        let across = |arm: &Vector, axis: &Vector| arm.minus(&axis.times(&arm.dot(axis))).length();
        let mut turn = |column: usize, kind: Kind, off: &Interval, reach: &Interval| -> Interval {
            let w = &rates[column];
            if kind == Kind::Slides {
                bounds.speed = &bounds.speed + w;
                return reach + &slides[column];
            }
            let twice = &bounds.speed + &bounds.speed;
            let bent = &(&(w * &(off * w)) + &(w * &twice)) + &bounds.acceleration;
            bounds.speed = &(w * off) + &bounds.speed;
            bounds.acceleration = bent;
            reach.clone()
        };
        let mut next: Option<&Vector> = None;
        for &joint in route.on.iter().rev() {
            let Joint { at: arm, moves, .. } = &self.joints[joint];
            if let Some((kind, axis, column)) = moves {
                let off = &reach + &next.map_or_else(Interval::zero, |arm| across(arm, axis));
                reach = &reach + &next.map_or_else(Interval::zero, Vector::length);
                reach = turn(*column, *kind, &off, &reach);
            } else {
                reach = &reach + &next.map_or_else(Interval::zero, Vector::length);
            }
            next = Some(arm);
        }
        reach = &reach + &next.map_or_else(Interval::zero, Vector::length);
        for &joint in route.back.iter().rev() {
            let Joint { rows, at: arm, moves, .. } = &self.joints[joint];
            let before = reach.clone();
            reach = &reach + &arm.length();
            if let Some((kind, axis, column)) = moves {
                let off = &before + &across(arm, &apply(rows, axis));
                reach = turn(*column, *kind, &off, &reach);
            }
        }
        bounds
    }
}

impl Bounds {
    /// The upper ends of both.
    pub(crate) fn greatest(&self) -> Self {
        Self { speed: self.speed.greatest(), acceleration: self.acceleration.greatest() }
    }
}

impl Placed {
    /// A direction as the link sees it.
    pub(crate) fn seen(&self, direction: &Vector) -> Vector {
        combined(&self.rows, direction)
    }
}

/// An index that is less than a count; -1 is none.
fn index(object: &Value, name: &str, count: usize) -> Result<Option<usize>, Unread> {
    match field(object, name)?.as_i64() {
        Some(-1) => Ok(None),
        Some(index) if usize::try_from(index).is_ok_and(|index| index < count) => Ok(usize::try_from(index).ok()),
        _ => Err(format!("{name} is no index of a joint that comes before")),
    }
}

/// The rotation by an angle about a unit axis `u`, `cos·1 + sin·[u]ₓ + (1 − cos)·u·uᵀ`, by its rows.
pub(crate) fn turned(axis: &Vector, angle: &Interval) -> [Vector; 3] {
    let [sine, cosine] = angle.sine_and_cosine();
    let rest = &Interval::from(1.0) - &cosine;
    let Vector([x, y, z]) = axis;
    let zero = Interval::zero();
    let cross = [[zero.clone(), -z, y.clone()], [z.clone(), zero.clone(), -x], [-y, x.clone(), zero]];
    std::array::from_fn(|i| {
        Vector(std::array::from_fn(|j| {
            let entry = &(&sine * &cross[i][j]) + &(&rest * &(&axis.0[i] * &axis.0[j]));
            if i == j { &entry + &cosine } else { entry }
        }))
    })
}
