//! How far a library's answers are from the truth.

use crate::w1_ray_cast::{Ambiguity, Ray};
use crate::w2_linear_cast::Cast;
use crate::w3_distance::{DistanceQuery, NEAR_DISTANCE};
use crate::w3b_intersect::IntersectQuery;

/// Relative errors above this are wrong answers.
const WRONG: f64 = 1e-3;

/// Precision of the numbers a library works with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f32`.
    Single,
    /// `f64`.
    Double,
}

/// What was found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Score {
    /// The error that 99 % of the answers stay below; NaN where there is nothing to compare.
    pub p99: f64,
    /// The largest error.
    pub max: f64,
    /// Hits where the truth is a miss.
    pub false_hits: usize,
    /// Misses where the truth is a hit.
    pub false_misses: usize,
    /// Answers that are not a number, or not given at all.
    pub undecided: usize,
    /// Answers that are far off: relative errors above 1e-3, or absolute ones above 1e-6 where the distance is 1e-6.
    pub far_off: usize,
    /// Zero where the distance is 1e-6.
    pub said_zero: usize,
}

impl Score {
    /// Everything that is not an answer.
    #[must_use]
    pub fn wrong(&self) -> usize {
        self.false_hits + self.false_misses + self.undecided + self.far_off + self.said_zero
    }

    fn with_errors(mut self, mut errors: Vec<f64>) -> Self {
        errors.sort_by(f64::total_cmp);
        let rank = (errors.len() * 99).div_ceil(100).saturating_sub(1);
        (self.p99, self.max) =
            (errors.get(rank).copied().unwrap_or(f64::NAN), errors.last().copied().unwrap_or(f64::NAN));
        self
    }

    fn add_far_off(&mut self, error: f64, limit: f64) {
        self.far_off += usize::from(error > limit);
    }
}

/// Counts a cast's answer; the relative error of λ where both hit.
fn cast(score: &mut Score, answer: f64, truth: Option<f64>, miss_allowed: bool, hit_allowed: bool) -> Option<f64> {
    match truth {
        _ if answer.is_nan() => score.undecided += 1,
        Some(lambda) if answer.is_finite() => {
            let error = ((answer - lambda) / lambda).abs();
            score.add_far_off(error, WRONG);
            return Some(error);
        }
        Some(_) => score.false_misses += usize::from(!miss_allowed),
        None => score.false_hits += usize::from(answer.is_finite() && !hit_allowed),
    }
    None
}

/// The score of ray casts.
#[must_use]
pub fn ray_casts(rays: &[Ray], answers: &[f64], precision: Precision) -> Score {
    let mut score = Score::default();
    let errors = rays.iter().zip(answers).filter_map(|(ray, &answer)| {
        let ambiguous = match ray.ambiguity {
            Ambiguity::None => false,
            Ambiguity::InF32 => precision == Precision::Single,
            Ambiguity::InF64 => true,
        };
        cast(&mut score, answer, ray.lambda, ambiguous, ambiguous)
    });
    let errors = errors.collect();
    score.with_errors(errors)
}

/// The score of linear casts. A miss of a hit that only grazes is no mistake.
#[must_use]
pub fn linear_casts(casts: &[Cast], grazing: &[bool], answers: &[f64]) -> Score {
    let mut score = Score::default();
    let errors = (casts.iter().zip(grazing).zip(answers))
        .filter_map(|((query, &grazes), &answer)| cast(&mut score, answer, query.lambda, grazes, false));
    let errors = errors.collect();
    score.with_errors(errors)
}

/// The score of distances: relative errors of the far queries, absolute ones of the near.
#[must_use]
pub fn distances(queries: &[DistanceQuery], answers: &[f64]) -> Score {
    let mut score = Score::default();
    let errors = queries.iter().zip(answers).filter_map(|(query, &answer)| {
        if answer.is_nan() {
            score.undecided += 1;
            return None;
        }
        let error = (answer - query.distance).abs();
        if query.distance > NEAR_DISTANCE {
            score.add_far_off(error / query.distance, WRONG);
            return Some(error / query.distance);
        }
        if answer == 0.0 {
            score.said_zero += 1;
            return None;
        }
        score.add_far_off(error, NEAR_DISTANCE);
        Some(error)
    });
    let errors = errors.collect();
    score.with_errors(errors)
}

/// The score of intersection tests.
#[must_use]
pub fn intersections(queries: &[IntersectQuery], answers: &[f64]) -> Score {
    let mut score = Score { p99: f64::NAN, max: f64::NAN, ..Score::default() };
    for (query, &answer) in queries.iter().zip(answers) {
        match (query.meet, answer) {
            (_, answer) if answer.is_nan() => score.undecided += 1,
            (true, 0.0) => score.false_misses += 1,
            (false, 1.0) => score.false_hits += 1,
            _ => {}
        }
    }
    score
}
