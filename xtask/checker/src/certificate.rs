//! What a certificate proves of a query, and whether that is what the answer claims.
//!
//! All is about one set `C`, the target of a ray or `A − B`, and the points `x(λ) = source + λ·direction`, λ ≥ 0; for
//! `distance` and `intersect`, whose `x` is zero, the direction is zero too. A plane across `n` has `C` behind it, `n·y
//! ≤ h(n)`: that bounds distance, or the first λ with `x(λ)` in `C`, from below. Points of `C` bound it from above.

use serde_json::Value;

use crate::body::{Body, difference};
use crate::interval::{Interval, Vector, determinant};
use crate::reader::{Reader, Unread, field};

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

/// What is proved of a number that is not negative, a distance or a λ: it is neither less than `lower` nor more than
/// `upper`.
#[derive(Clone, Debug)]
pub struct Bounds {
    /// What it is not less than.
    pub lower: Interval,
    /// What it is not more than.
    pub upper: Interval,
}

/// What is claimed of it.
enum Claim {
    /// It is within these bounds.
    Within(Bounds),
    /// It is more than this; infinite, if this is infinity.
    Beyond(Interval),
}

/// A query as one set and one ray.
struct Question {
    set: Body,
    source: Vector,
    direction: Vector,
    /// The end of the ray, which may be infinite.
    end: Interval,
    /// Whether planes are told with the set before them, as those between two shapes.
    is_pair: bool,
}

/// The plane and the points of a certificate.
struct Certificate {
    plane: Option<Vector>,
    /// Points of the core, and their weights, which are not negative and not all zero.
    points: Vec<(Vector, Interval)>,
    dimension: usize,
}

/// Solved weights may differ by this from those given, which are of a simplex as small as rounding lets it be; others
/// are not meant.
const MEANT: f64 = 0.125;

/// What the certificate of a line proves, and what that says of the answer.
pub fn judge(line: &Value, reader: &Reader<'_>) -> Result<(Verdict, Bounds), Unread> {
    let query = field(line, "query")?.as_str().unwrap_or_default();
    if !matches!(query, "distance" | "intersect" | "ray_cast" | "linear_cast") {
        return Err(format!("there are no certificates for \"{query}\""));
    }
    let question = Question::read(line, reader)?;
    let answer = field(line, "answer")?;
    let certificate = Certificate::read(field(line, "certificate")?, &question.set, reader)?;
    let flag = |name| field(answer, name)?.as_bool().ok_or_else(|| format!("{name} is neither true nor false"));
    let (proved, claim) = match query {
        "distance" => (question.distance(&certificate), Claim::Within(claim(answer, "distance", line, reader)?)),
        "intersect" => {
            let zero = || Interval::zero();
            let none = Bounds { lower: zero(), upper: zero() };
            let claim = if flag("overlap")? { Claim::Within(none) } else { Claim::Beyond(zero()) };
            (question.distance(&certificate), claim)
        }
        _ => {
            let name = if query == "ray_cast" { "lambda" } else { "time" };
            let claim = if flag("hit")? {
                let Bounds { lower, upper } = claim(answer, name, line, reader)?;
                // A hit without an upper bound may be a miss, by its own words.
                let upper = if upper.is_infinite() { upper } else { upper.min(&question.end) };
                Claim::Within(Bounds { lower, upper })
            } else {
                Claim::Beyond(question.end.clone())
            };
            (question.cast(&certificate), claim)
        }
    };
    Ok((proved.judge(&claim), proved))
}

/// What the certificate of a distance proves of that between two bodies.
pub(crate) fn distance(a: Body, b: Body, certificate: &Value, reader: &Reader<'_>) -> Result<Bounds, Unread> {
    let (zero, end) = (Vector::zero, Interval::infinity());
    let question = Question { set: difference(a, b), source: zero(), direction: zero(), end, is_pair: true };
    Ok(question.distance(&Certificate::read(certificate, &question.set, reader)?))
}

/// The bracket of an answer; without one, the number itself, give or take what the query allows.
fn claim(answer: &Value, name: &str, line: &Value, reader: &Reader<'_>) -> Result<Bounds, Unread> {
    let bound = |name| answer.get(name).map(|value| reader.number(value).map(Interval::from)).transpose();
    let value = bound(name)?.ok_or_else(|| format!("the field \"{name}\" is missing"))?;
    let Bounds { lower, upper } = match (bound("lower")?, bound("upper")?) {
        (None, None) => {
            let allow = Interval::from(line.get("allow").and_then(Value::as_f64).unwrap_or(0.0));
            Bounds { lower: &value - &allow, upper: &value + &allow }
        }
        (lower, upper) => {
            Bounds { lower: lower.unwrap_or_else(Interval::zero), upper: upper.unwrap_or_else(Interval::infinity) }
        }
    };
    if value.is_less_than(&lower) || upper.is_less_than(&value) {
        return Err(format!("{name} is not within its bracket"));
    }
    Ok(Bounds { lower, upper })
}

impl Bounds {
    fn judge(&self, claim: &Claim) -> Verdict {
        let is_finite = self.upper.is_less_than(&Interval::infinity());
        let (is_so, is_not) = match claim {
            Claim::Within(Self { lower, upper }) => (
                is_finite && lower.is_at_most(&self.lower) && self.upper.is_at_most(upper),
                self.upper.is_less_than(lower) || upper.is_less_than(&self.lower),
            ),
            Claim::Beyond(bound) => {
                (bound.is_less_than(&self.lower) || self.lower.is_infinite(), is_finite && self.upper.is_at_most(bound))
            }
        };
        match (is_so, is_not) {
            (_, true) => Verdict::Disproved,
            (true, _) => Verdict::Proved,
            _ => Verdict::NotProved,
        }
    }
}

impl Question {
    fn read(line: &Value, reader: &Reader<'_>) -> Result<Self, Unread> {
        let get = |name| field(line, name);
        let end =
            |name| line.get(name).map_or(Ok(Interval::infinity()), |value| reader.number(value).map(Interval::from));
        if get("query")?.as_str() == Some("ray_cast") {
            let (source, direction) = (reader.vector(get("source")?)?, reader.vector(get("direction")?)?);
            let (set, end) = (reader.body(get("target")?)?, end("max_lambda")?);
            return Ok(Self { set, source, direction, end, is_pair: false });
        }
        // `A + t·v_A` and `B + t·v_B` meet where `t·(v_B − v_A)` is in `A − B`.
        let set = difference(reader.body(get("a")?)?, reader.body(get("b")?)?);
        let velocity = |name| reader.vector_or_zero(line, name);
        let direction = velocity("velocity_b")?.minus(&velocity("velocity_a")?);
        Ok(Self { set, source: Vector::zero(), direction, end: end("max_time")?, is_pair: true })
    }

    /// How far the source is before the plane of a certificate at least, times the length of its normal, and that
    /// normal.
    fn ahead(&self, certificate: &Certificate) -> Option<(Interval, Vector)> {
        let normal = certificate.plane.as_ref()?;
        let normal = if self.is_pair { normal.times(&Interval::from(-1.0)) } else { normal.clone() };
        let reach = &self.set.core.support(&normal).1 + &(&self.set.radius * &normal.length());
        Some((&normal.dot(&self.source) - &reach, normal))
    }

    /// What is proved of the distance of the set from the source.
    fn distance(&self, certificate: &Certificate) -> Bounds {
        let lower = self.ahead(certificate).map(|(ahead, n)| ahead.over(&n.length()).least());
        let gap = certificate.mean().map(|mean| &mean.minus(&self.source).length() - &self.set.radius);
        let gap = if self.contains_source(certificate) { Some(Interval::zero()) } else { gap };
        let zero = Interval::zero();
        let upper = gap.map_or_else(Interval::infinity, |gap| gap.max(&zero).greatest());
        Bounds { lower: lower.map_or(zero.clone(), |lower| lower.max(&zero)), upper }
    }

    /// What is proved of the first λ with `x(λ)` in the set; infinite where the plane has all of the ray before it.
    fn cast(&self, certificate: &Certificate) -> Bounds {
        let lower = match self.ahead(certificate) {
            Some((ahead, n)) if Interval::zero().is_less_than(&ahead) => {
                let approach = -&n.dot(&self.direction);
                let never = approach.is_at_most(&Interval::zero());
                if never { Interval::infinity() } else { ahead.over(&approach).least() }
            }
            _ => Interval::zero(),
        };
        let source = self.contains_source(certificate).then(Interval::zero);
        let found = [source, self.entry_of_ball(certificate), self.entry_of_simplex(certificate)];
        let first = found.into_iter().flatten().reduce(|a, b| a.min(&b));
        Bounds { lower, upper: first.map_or_else(Interval::infinity, |first| first.greatest()) }
    }

    /// Where the ray enters the ball that sweeps the mean of the points: the lesser root of `|x(λ) − p|² = r²`.
    fn entry_of_ball(&self, certificate: &Certificate) -> Option<Interval> {
        let from = self.source.minus(&certificate.mean()?);
        let excess = &from.squared() - &self.set.radius.squared();
        if excess.is_at_most(&Interval::zero()) {
            return Some(Interval::zero());
        }
        let (a, b) = (self.direction.squared(), self.direction.dot(&from));
        let discriminant = &b.squared() - &(&a * &excess);
        let at = (&-&b - &discriminant.root()).over(&a);
        (discriminant.is_not_negative() && at.is_not_negative()).then_some(at)
    }

    /// Where the ray pierces a simplex of as many of the points as there are dimensions.
    ///
    /// The unknowns are the weights `w` and λ of `Σ wᵢ·pᵢ − λ·direction = source`, `Σ wᵢ = 1`.
    fn entry_of_simplex(&self, certificate: &Certificate) -> Option<Interval> {
        let Certificate { points, dimension, .. } = certificate;
        let simplices: Vec<Vec<usize>> = match points.len().checked_sub(*dimension)? {
            0 => vec![(0..points.len()).collect()],
            _ => (0..points.len()).map(|i| (0..points.len()).filter(|j| *j != i).collect()).collect(),
        };
        let column = self.direction.times(&Interval::from(-1.0));
        let entry = |simplex: Vec<usize>| {
            let solved = certificate.solve(&simplex, Some(&column), &self.source)?;
            solved.last().filter(|at| at.is_not_negative()).cloned()
        };
        simplices.into_iter().filter_map(entry).reduce(|a, b| a.min(&b))
    }

    /// Whether the source is in the ball about the mean of the points, or in their simplex.
    fn contains_source(&self, certificate: &Certificate) -> bool {
        let beside = certificate.mean().map(|mean| mean.minus(&self.source).squared());
        let is_in_ball = beside.is_some_and(|squared| squared.is_at_most(&self.set.radius.squared()));
        let all: Vec<usize> = (0..certificate.points.len()).collect();
        is_in_ball || (all.len() == certificate.dimension + 1 && certificate.solve(&all, None, &self.source).is_some())
    }
}

impl Certificate {
    fn read(certificate: &Value, set: &Body, reader: &Reader<'_>) -> Result<Self, Unread> {
        let plane = certificate.get("plane").map(|plane| reader.vector(plane)).transpose()?;
        let mut points = Vec::new();
        let mut dimension = 3;
        let mut total = 0.0;
        for item in certificate.get("points").and_then(Value::as_array).into_iter().flatten() {
            let direction = reader.vector(&item[0])?;
            dimension = item[0].as_array().map_or(3, Vec::len);
            let weight =
                item[1].as_f64().filter(|weight| *weight >= 0.0).ok_or("a weight is not a number from 0 up")?;
            total += weight;
            points.push((set.core.support(&direction).0, Interval::from(weight)));
        }
        if points.len() > dimension + 1 || !(points.is_empty() || (total - 1.0).abs() < MEANT) {
            return Err("the points are too many, or the sum of their weights is not 1".to_owned());
        }
        Ok(Self { plane, points, dimension })
    }

    /// The weighted mean of the points, which is in the core.
    fn mean(&self) -> Option<Vector> {
        let total = self.points.iter().map(|(_, weight)| weight.clone()).reduce(|a, b| &a + &b)?;
        let sum = self.points.iter().fold(Vector::zero(), |sum, (point, weight)| sum.plus(&point.times(weight)));
        Some(Vector(sum.0.each_ref().map(|x| x.over(&total))))
    }

    /// The weights with which some of the points, and a further column with any factor, come to `at`, and that factor;
    /// if the weights are certain not to be negative, and are those meant.
    ///
    /// By Cramer's rule, so that what is zero comes out as zero where numbers are short.
    fn solve(&self, simplex: &[usize], column: Option<&Vector>, at: &Vector) -> Option<Vec<Interval>> {
        // A certificate of the plane tells nothing of space.
        let entry = |vector: &Vector, last: f64| {
            let (entries, beyond) = vector.0.split_at(self.dimension);
            let flat = beyond.iter().all(Interval::is_zero);
            flat.then(|| entries.iter().cloned().chain([Interval::from(last)]).collect::<Vec<_>>())
        };
        let points = simplex.iter().map(|&i| entry(&self.points[i].0, 1.0));
        let columns: Vec<_> = points.chain(column.map(|column| entry(column, 0.0))).collect::<Option<_>>()?;
        let at = entry(at, 1.0)?;
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
