//! Answers held against what is true, in thirty digits.
//!
//! Where the obstacle has a closed form, the truth is computed. Where it has none, the answer's own certificate is
//! checked instead, with exact support values: a plane bounds from below, and points bound from above by how far they
//! are from the bodies. A bound that holds is a proof, whoever found it.

use convex_support::{Scalar, Vector3};
use gjk_raycast::{Distance, Intersection, LinearCast, Outcome, RayCast, Status};

use super::obstacle::Obstacle;
use super::solid::{Solid, coordinates};
use workloads::real::{DoubleDouble, Real};
use workloads::vec3::{Vec3, add, dot, norm, scale, sub, wide};

/// What is wrong with an answer, and how wrong.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Verdict {
    /// A hit or an overlap where there is none.
    pub(super) false_hit: bool,
    /// A miss or a gap where there is none.
    pub(super) missed: bool,
    /// Neither.
    pub(super) undecided: bool,
    /// Ended for another reason than convergence.
    pub(super) unconverged: bool,
    /// The bracket does not hold the truth, or the axis does not separate.
    pub(super) violation: bool,
    /// The error of the distance or along the ray, where it is well-conditioned.
    pub(super) error: Option<f64>,
    /// How far the point of contact, or the closest points, are from the bodies.
    pub(super) excess: Option<f64>,
    pub(super) iterations: usize,
}

/// A cast of a ray against an obstacle, and how it came out; directions are outward normals of the obstacle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cast {
    pub(super) source: Vec3<DoubleDouble>,
    pub(super) direction: Vec3<DoubleDouble>,
    pub(super) max_lambda: f64,
    pub(super) outcome: CastOutcome,
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) status: Status,
    pub(super) iterations: usize,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum CastOutcome {
    /// `excess` is how far the point of contact is from the bodies.
    Hit {
        lambda: f64,
        normal: Option<Vec3>,
        excess: f64,
    },
    Miss {
        axis: Vec3,
    },
    Undecided,
}

/// What counts as sure: hits of the obstacle shrunk, and misses of the obstacle grown, by so much.
const BAND: f64 = 0.05;

/// Where no closed form tells what is sure, errors count for planes that are crossed at least so steeply: the cosine of
/// the angle between normal and ray, which for a ball is the same as the band.
const STEEP: f64 = 0.3;

/// A ray that passes within so many rounding errors, relative to the obstacle's size, may hit or miss.
const GRAZE: f64 = 64.0;

impl Cast {
    pub(super) fn of_ray<V: Vector3>(source: Vec3, direction: Vec3, max_lambda: f64, cast: &RayCast<V>) -> Self {
        let outcome = match cast.outcome {
            Outcome::Hit(hit) => {
                CastOutcome::Hit { lambda: hit.lambda.as_f64(), normal: hit.normal.map(coordinates), excess: 0.0 }
            }
            Outcome::Miss(miss) => CastOutcome::Miss { axis: coordinates(miss.axis) },
            Outcome::Undecided => CastOutcome::Undecided,
        };
        Self {
            source: wide(source),
            direction: wide(direction),
            max_lambda,
            outcome,
            lower: cast.lower.as_f64(),
            upper: cast.upper.as_f64(),
            status: cast.status,
            iterations: cast.iterations,
        }
    }

    /// The same question on the obstacle: `A + t·v_A` and `B + t·v_B` meet where `t·(v_B − v_A)` is in `A − B`.
    pub(super) fn of_motion<V: Vector3>(
        [a, b]: [&Solid; 2],
        [velocity_a, velocity_b]: [Vec3; 2],
        max_time: f64,
        cast: &LinearCast<V>,
    ) -> Self {
        let minus = |v: Vec3| v.map(|c| -c);
        let outcome = match cast.outcome {
            Outcome::Hit(hit) => {
                let (point, time) = (wide(coordinates(hit.point)), DoubleDouble::from(hit.time.as_f64()));
                let seen = |velocity: Vec3| sub(point, scale(wide(velocity), time));
                CastOutcome::Hit {
                    lambda: hit.time.as_f64(),
                    normal: hit.normal.map(|n| minus(coordinates(n))),
                    excess: a.outside(seen(velocity_a)) + b.outside(seen(velocity_b)),
                }
            }
            Outcome::Miss(miss) => CastOutcome::Miss { axis: minus(coordinates(miss.axis)) },
            Outcome::Undecided => CastOutcome::Undecided,
        };
        Self {
            source: sub(wide(b.translation), wide(a.translation)),
            direction: sub(wide(velocity_b), wide(velocity_a)),
            max_lambda: max_time,
            outcome,
            lower: cast.lower.as_f64(),
            upper: cast.upper.as_f64(),
            status: cast.status,
            iterations: cast.iterations,
        }
    }

    /// The same ray, seen from a place.
    pub(super) fn relative_to(mut self, place: Vec3) -> Self {
        self.source = sub(self.source, wide(place));
        self
    }

    fn at(&self, lambda: DoubleDouble) -> Vec3<DoubleDouble> {
        add(self.source, scale(self.direction, lambda))
    }

    /// Holds the answer against the obstacle, where the source is outside of it. `epsilon` is that of the precision
    /// asked.
    pub(super) fn judge(&self, obstacle: &Obstacle<'_>, epsilon: f64) -> Verdict {
        let mut verdict = Verdict {
            undecided: matches!(self.outcome, CastOutcome::Undecided),
            unconverged: self.status != Status::Converged,
            iterations: self.iterations,
            ..Verdict::default()
        };
        let entry = |growth: f64| {
            let entry = obstacle.entry(self.source, self.direction, growth);
            entry.filter(|&l| l >= DoubleDouble::from(0.0) && l <= DoubleDouble::from(self.max_lambda))
        };
        let speed = norm(self.direction).f64();
        let truth = entry(1.0);
        let is_surely_hit = truth.is_some() && entry(1.0 - BAND).is_some();
        if obstacle.is_known() && !matches!(self.outcome, CastOutcome::Miss { .. }) {
            // Beyond the end, too: whether a hit there counts is decided by λ as it is rounded.
            let met = obstacle.entry(self.source, self.direction, 1.0).filter(|&l| l >= DoubleDouble::from(0.0));
            let holds = |at| DoubleDouble::from(self.lower) <= at && at <= DoubleDouble::from(self.upper);
            // A miss is at infinity.
            verdict.violation = !met.map_or(self.upper == f64::INFINITY, holds);
        }
        if let CastOutcome::Hit { normal, excess, .. } = self.outcome {
            // Where the ray meets the surface is known to rounding divided by the cosine.
            let facing = normal.map_or(1.0, |n| -dot(wide(n), self.direction).f64() / speed);
            verdict.excess = Some(excess * (facing / STEEP).clamp(0.0, 1.0));
        }
        match self.outcome {
            CastOutcome::Hit { lambda, .. } if obstacle.is_known() => match truth {
                Some(truth) if is_surely_hit => {
                    verdict.error = Some((DoubleDouble::from(lambda) - truth).f64().abs() * speed);
                }
                Some(_) => {}
                None => {
                    verdict.false_hit = entry(1.0 + BAND).is_none();
                    verdict.violation |= obstacle.entry(self.source, self.direction, 1.0 + GRAZE * epsilon).is_none();
                }
            },
            CastOutcome::Hit { lambda, normal, excess } => {
                // The point of contact is rounded where it is, far from where the cast began.
                verdict.false_hit = excess > BAND * obstacle.reach() + 4.0 * epsilon * norm(self.source).f64();
                let n = wide(normal.unwrap_or([f64::NAN; 3]));
                let facing = -dot(n, self.direction).f64() / speed;
                if let Some(lower) = self.crossing(obstacle, n) {
                    verdict.violation |= DoubleDouble::from(self.upper) < lower && facing > GRAZE * epsilon;
                    let error = (DoubleDouble::from(lambda) - lower).f64().abs() * speed;
                    verdict.error = (facing > STEEP).then_some(error);
                } else {
                    // Of a graze, the plane is along the ray, and by rounding may be crossed anywhere.
                    verdict.false_hit |= facing.is_nan() || facing.abs() > GRAZE * epsilon;
                }
            }
            CastOutcome::Miss { axis } => {
                let separates = self.is_before(obstacle, wide(axis));
                verdict.violation = !separates;
                verdict.missed = if obstacle.is_known() { is_surely_hit } else { !separates };
            }
            CastOutcome::Undecided => {}
        }
        verdict
    }

    /// Where the ray crosses the obstacle's plane of support with this normal, if it comes from before it: no point of
    /// the ray before that is in the obstacle.
    fn crossing(&self, obstacle: &Obstacle<'_>, n: Vec3<DoubleDouble>) -> Option<DoubleDouble> {
        let zero = DoubleDouble::from(0.0);
        let (ahead, slope) = (dot(n, self.source) - obstacle.support_value(n), dot(n, self.direction));
        (ahead >= zero && slope < zero).then(|| -(ahead / slope))
    }

    /// Whether the obstacle's plane of support with this normal has the ray before it, as far as it is in the ball that
    /// contains the obstacle.
    fn is_before(&self, obstacle: &Obstacle<'_>, n: Vec3<DoubleDouble>) -> bool {
        let zero = DoubleDouble::from(0.0);
        let d = self.direction;
        let nearest = -(dot(self.source, d) / dot(d, d));
        let aside = norm(self.at(nearest));
        let reach = DoubleDouble::from(obstacle.reach());
        let half_chord = ((reach * reach - aside * aside).max(zero) / dot(d, d)).sqrt();
        let on_ray = |l: DoubleDouble| l.max(zero).min(DoubleDouble::from(self.max_lambda));
        let value = obstacle.support_value(n);
        [nearest - half_chord, nearest + half_chord].into_iter().all(|l| dot(n, self.at(on_ray(l))) > value)
    }
}

/// What is certain of a distance: a plane bounds it from below, and points bound it from above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proof {
    least: DoubleDouble,
    most: DoubleDouble,
    excess: f64,
}

impl Proof {
    pub(super) fn of<V: Vector3>([a, b]: [&Solid; 2], answer: &Distance<V>) -> Self {
        let (point_a, point_b) = (wide(coordinates(answer.point_a)), wide(coordinates(answer.point_b)));
        let least = answer.normal.map_or(DoubleDouble::from(0.0), |n| gap_along([a, b], coordinates(n)));
        let excess = a.outside(point_a) + b.outside(point_b);
        Self { least, most: norm(sub(point_a, point_b)) + DoubleDouble::from(excess), excess }
    }

    /// The closer bounds of both.
    pub(super) fn and(self, other: Self) -> Self {
        Self { least: self.least.max(other.least), most: self.most.min(other.most), ..self }
    }

    /// Holds an answer against it. Contact within `allowed` may be either.
    pub(super) fn judge<V: Vector3>(self, answer: &Distance<V>, allowed: f64) -> Verdict {
        let number = |x: V::Scalar| DoubleDouble::from(x.as_f64());
        let distance = number(answer.distance);
        // Planes that overlap bound no distance.
        let least = self.least.max(DoubleDouble::from(0.0));
        Verdict {
            false_hit: answer.overlap && self.most.f64() > allowed && self.least.f64() > 0.0,
            missed: !answer.overlap && self.least.f64() <= 0.0 && distance.f64() > allowed,
            undecided: false,
            unconverged: answer.status != Status::Converged,
            violation: number(answer.upper) < self.least || number(answer.lower) > self.most,
            error: Some((distance - least).abs().max((distance - self.most).abs()).f64()),
            excess: Some(self.excess),
            iterations: answer.iterations,
        }
    }
}

/// Whether the axis of an answer separates, as far as its rounded components can.
pub(super) fn judge_intersection<V: Vector3>([a, b]: [&Solid; 2], answer: &Intersection<V>) -> Verdict {
    let extent = a.form.reach() + b.form.reach() + norm(sub(wide(a.translation), wide(b.translation))).f64();
    let rounding = V::Scalar::EPSILON.as_f64() * extent;
    let separated = answer.axis.map(|axis| gap_along([a, b], coordinates(axis)).f64() > -rounding);
    let decided = answer.status == Status::Converged;
    Verdict {
        undecided: !decided,
        unconverged: !decided,
        violation: decided && separated == Some(false),
        iterations: answer.iterations,
        ..Verdict::default()
    }
}

/// How far apart the planes of support across `n` are, from `b`'s to `a`'s: no more than the bodies are.
fn gap_along([a, b]: [&Solid; 2], n: Vec3) -> DoubleDouble {
    let n = wide(n);
    let between = dot(n, sub(wide(a.translation), wide(b.translation)));
    (between - a.support_value(n.map(|c| -c)) - b.support_value(n)) / norm(n)
}
