//! What proves an answer: a plane, and points of a core.

use serde_json::Value;

use crate::body::Set;
use crate::interval::{Interval, Vector, determinant};
use crate::reader::{Reader, Unread, listed};

/// What is proved of a distance or a λ: it is neither less than `lower` nor more than `upper`.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// What it is not less than.
    pub lower: Interval,
    /// What it is not more than.
    pub upper: Interval,
}

/// The plane and the points of a certificate. Whatever else it holds proves nothing.
pub(crate) struct Certificate {
    pub(crate) plane: Option<Vector>,
    /// Points of the core, and their weights, which are not negative and not all zero.
    pub(crate) points: Vec<(Vector, Interval)>,
    pub(crate) dimension: usize,
}

/// Solved weights may differ by this from those given, which are of a simplex as small as rounding lets it be; others
/// are not meant.
const MEANT: f64 = 0.125;

impl Certificate {
    pub(crate) fn read(certificate: &Value, core: &Set, reader: &Reader<'_>) -> Result<Self, Unread> {
        let plane = certificate.get("plane").map(|plane| reader.vector(plane)).transpose()?;
        let mut points = Vec::new();
        let mut total = 0.0;
        for item in certificate.get("points").map_or(Ok(&[][..]), listed)? {
            let [direction, weight] = listed(item)? else {
                return Err("a point is not a direction and a weight".to_owned());
            };
            let direction = reader.vector(direction)?;
            let weight = weight.as_f64().filter(|weight| *weight >= 0.0).ok_or("a weight is not a number from 0 up")?;
            total += weight;
            points.push((core.support(&direction).0, Interval::from(weight)));
        }
        let dimension = reader.dimension();
        if points.len() > dimension + 1 || !(points.is_empty() || (total - 1.0).abs() < MEANT) {
            return Err("the points are too many, or the sum of their weights is not 1".to_owned());
        }
        Ok(Self { plane, points, dimension })
    }

    /// The weighted mean of the points, which is in the core.
    pub(crate) fn mean(&self) -> Option<Vector> {
        let total = self.points.iter().map(|(_, weight)| weight.clone()).reduce(|a, b| &a + &b)?;
        let sum = self.points.iter().fold(Vector::zero(), |sum, (point, weight)| sum.plus(&point.times(weight)));
        Some(Vector(sum.0.each_ref().map(|x| x.over(&total))))
    }

    /// The weights with which some of the points, and a further column with any factor, come to `at`, and that factor;
    /// if the weights are certain not to be negative, and are those meant.
    ///
    /// By Cramer's rule, so that what is zero comes out as zero where numbers are short.
    pub(crate) fn solve(&self, simplex: &[usize], column: Option<&Vector>, at: &Vector) -> Option<Vec<Interval>> {
        let entry = |vector: &Vector, last: f64| {
            vector.0[..self.dimension].iter().cloned().chain([Interval::from(last)]).collect::<Vec<_>>()
        };
        let points = simplex.iter().map(|&i| entry(&self.points[i].0, 1.0));
        let columns: Vec<_> = points.chain(column.map(|column| entry(column, 0.0))).collect();
        let at = entry(at, 1.0);
        let whole = determinant(&columns);
        let solve_for = |i: usize| {
            let mut replaced = columns.clone();
            replaced[i].clone_from(&at);
            determinant(&replaced).over(&whole)
        };
        let solved: Vec<Interval> = (0..columns.len()).map(solve_for).collect();
        let meant = |i: usize| {
            let at = simplex.iter().position(|&j| j == i);
            let weight = at.map_or_else(Interval::zero, |at| solved[at].clone());
            let off = (&weight - &self.points[i].1).squared();
            weight.is_not_negative() && off.is_at_most(&Interval::from(MEANT * MEANT))
        };
        (0..self.points.len()).all(meant).then_some(solved)
    }
}
