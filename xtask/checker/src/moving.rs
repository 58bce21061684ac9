//! Whether two bodies stay apart while they move, by planes at some times and bounds on how fast they move.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::Rc;

use serde_json::Value;

use crate::free::{HALVINGS, Pair, Parts, numbers};
use crate::interval::{Interval, Vector};
use crate::reader::{Reader, Unread, field, listed};
use crate::robot::{Bounds, Placed};

/// Two bodies that move.
pub(crate) trait Moving {
    /// By how much the plane across a normal separates the bodies at a time, times its length, beyond the target.
    fn gap(&self, time: f64, normal: &Vector) -> Interval;

    /// What points of one are no faster than, and no more accelerated, as points of the other see them.
    fn bounds(&self) -> &Bounds;

    /// The normal that counts: of a half-space always its own.
    fn normal(&self, given: &Vector) -> Vector;

    /// Whether a plane separates the bodies at all times: one that turns from one normal to the other, at a constant
    /// rate, or one of the two alone.
    fn are_apart(&self, times: [f64; 2], normals: [&Vector; 2]) -> bool {
        let [first, second] = normals.map(|normal| self.normal(normal));
        let planes = [[&first, &second], [&second, &second], [&first, &first]];
        [0, HALVINGS].into_iter().any(|halvings| {
            planes.iter().any(|normals| {
                let gaps = [0, 1].map(|i| self.gap(times[i], normals[i]));
                self.stay_apart(times, &normals.map(Vector::clone), &gaps, halvings)
            })
        })
    }

    /// Whether one does that turns from one normal to the other, where it separates them by these gaps at the ends.
    ///
    /// For points `a` and `b` of the bodies `φ(t) = n(t)·(a(t) − b)` has the second derivative `2ṅ·ȧ + n·ä ≤ M`, so
    /// that it is above its chord less `M·t·(s − t)/2`, and the radii take no more than the chord of theirs, as `|n|`
    /// is convex. With `m = s²·M/2` that is positive for all times if `m < g₀ + g₁ + 2·√(g₀·g₁)`.
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
        let bent = &(&(&turned * &duration) * &self.bounds().speed)
            + &(&(&duration.squared() * &(&longest * &self.bounds().acceleration)) * &Interval::from(0.5));
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
        let gap = self.gap(middle, &normal);
        let half = |times, normals: [&Vector; 2], gaps: [&Interval; 2]| {
            self.stay_apart(times, &normals.map(Vector::clone), &gaps.map(Interval::clone), halvings - 1)
        };
        half([from, middle], [&normals[0], &normal], [&gaps[0], &gap])
            && half([middle, to], [&normal, &normals[1]], [&gap, &gaps[1]])
    }
}

/// A part of a certificate: two times, and a normal at each.
pub(crate) type TimedPlanes = ([f64; 2], [Vector; 2]);

/// The times and the normals of a part.
pub(crate) fn planes(part: &Value, reader: &Reader<'_>) -> Result<TimedPlanes, Unread> {
    let normals = listed(field(part, "normals")?)?.iter().map(|normal| reader.vector(normal));
    let normals: Result<[Vector; 2], _> = normals.collect::<Result<Vec<_>, _>>()?.try_into();
    let times: Result<[f64; 2], _> = numbers(field(part, "times")?, reader)?.try_into();
    let (Ok(times), Ok(normals)) = (times, normals) else {
        return Err("a part has not two times and two normals".to_owned());
    };
    Ok((times, normals))
}

/// Up to when parts of a certificate prove two bodies to be apart, from 0 on, no farther than `last`; `None` if that is
/// not known of any time.
pub(crate) fn apart_until(
    bodies: &impl Moving,
    mut parts: Vec<TimedPlanes>,
    last: f64,
    counts: &mut Parts,
) -> Option<f64> {
    parts.sort_by(|a, b| a.0[0].total_cmp(&b.0[0]));
    let mut until: Option<f64> = None;
    for ([start, end], normals) in parts {
        // Bounds on speeds are those of the times up to the last.
        let is_within = 0.0 <= start && start <= end && end <= last;
        let is_proved = is_within && bodies.are_apart([start, end], normals.each_ref());
        if counts.count(is_proved) && start <= until.unwrap_or(0.0) {
            until = Some(until.unwrap_or(0.0).max(end));
        }
    }
    until
}

/// The joint values at a time of an edge, by those at its ends.
pub(crate) fn values_at([from, to]: [&[f64]; 2], time: f64) -> Vec<Interval> {
    let value = |(from, to): (&f64, &f64)| {
        let [from, to, time] = [*from, *to, time].map(Interval::from);
        &from + &(&(&to - &from) * &time)
    };
    from.iter().zip(to).map(value).collect()
}

/// Two bodies along an edge.
pub(crate) struct OnEdge<'p, 'r> {
    pair: &'p Pair<'r>,
    ends: [&'p [f64]; 2],
    bounds: Bounds,
    /// What both ends of the edge and the route are of: the edge and the links.
    of: (usize, usize, Option<usize>),
    places: &'p Places,
}

/// The places that were asked for, of all bodies of a link together, by the bits of their times.
pub(crate) type Places = RefCell<HashMap<((usize, usize, Option<usize>), u64), Rc<Placed>>>;

impl<'p, 'r> OnEdge<'p, 'r> {
    pub(crate) fn new(
        pair: &'p Pair<'r>,
        of: (usize, usize, Option<usize>),
        ends: [&'p [f64]; 2],
        places: &'p Places,
    ) -> Self {
        let [from, to] = [0.0, 1.0].map(|time| values_at(ends, time));
        let rates: Vec<_> = from.iter().zip(&to).map(|(from, to)| (to - from).absolute()).collect();
        let slides: Vec<_> = from.iter().zip(&to).map(|(a, b)| a.absolute().max(&b.absolute())).collect();
        let bounds = pair.robot.bounds(&pair.route, &pair.reach, &rates, &slides);
        Self { pair, ends, bounds: bounds.greatest(), of, places }
    }

    fn at(&self, time: f64) -> Rc<Placed> {
        let place = || Rc::new(self.pair.robot.place(&self.pair.route, &values_at(self.ends, time)));
        self.places.borrow_mut().entry((self.of, time.to_bits())).or_insert_with(place).clone()
    }
}

impl Moving for OnEdge<'_, '_> {
    fn gap(&self, time: f64, normal: &Vector) -> Interval {
        self.pair.gap(&self.at(time), normal)
    }

    fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    fn normal(&self, given: &Vector) -> Vector {
        self.pair.normal(given)
    }
}
