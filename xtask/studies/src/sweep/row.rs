//! A cell of the table.

use std::fmt::{self, Display, Formatter};

use super::Question;
use super::judge::Verdict;

/// One subject at one size and one distance in one precision, and what was found there.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) question: Question,
    /// The body, or the pair.
    pub(crate) subject: &'static str,
    /// Whether `f32` was asked, not `f64`.
    pub(crate) is_single: bool,
    /// The size of the bodies.
    pub(crate) size: f64,
    /// How far the source is, or how wide the gap, in sizes.
    pub(crate) distance: f64,
    pub(crate) queries: u64,
    pub(crate) false_hits: u64,
    pub(crate) missed: u64,
    pub(crate) undecided: u64,
    pub(crate) unconverged: u64,
    pub(crate) violations: u64,
    /// The largest error of λ times the length of the direction, or of the distance, in sizes; of a first derivative,
    /// in units of one plus its amount.
    pub(crate) worst: f64,
    /// The largest distance of a point of contact from the bodies, in sizes; the largest error of a second derivative.
    pub(crate) worst_point: f64,
    /// What is allowed of both.
    pub(crate) allowed: f64,
    pub(crate) iterations: u64,
    pub(crate) most_iterations: u64,
    /// The first query that was answered wrong.
    pub(crate) example: Option<String>,
}

impl Row {
    pub(super) const HEADER: &str = "question,subject,precision,size,distance,queries,false_hits,missed,undecided,\
                                     unconverged,violations,worst_error_in_sizes,worst_point_in_sizes,allowed,worst_error_in_ulps_of_distance,\
                                     mean_iterations,most_iterations,example";

    pub(super) const TITLES: &str = "question     subject             prec distance  queries false missed undec. unconv. \
                                     violat. error/size point/size  allowed ulp(dist) iterations";

    pub(super) fn new(question: Question, subject: &'static str, is_single: bool, size: f64, distance: f64) -> Self {
        Self {
            question,
            subject,
            is_single,
            size,
            distance,
            queries: 0,
            false_hits: 0,
            missed: 0,
            undecided: 0,
            unconverged: 0,
            violations: 0,
            worst: 0.0,
            worst_point: 0.0,
            allowed: 0.0,
            iterations: 0,
            most_iterations: 0,
            example: None,
        }
    }

    pub(crate) fn epsilon(&self) -> f64 {
        if self.is_single { f64::from(f32::EPSILON) } else { f64::EPSILON }
    }

    pub(super) fn add(&mut self, verdict: &Verdict, example: impl FnOnce() -> String) {
        self.queries += 1;
        self.false_hits += u64::from(verdict.false_hit);
        self.missed += u64::from(verdict.missed);
        self.undecided += u64::from(verdict.undecided);
        self.unconverged += u64::from(verdict.unconverged);
        self.violations += u64::from(verdict.violation);
        // Where queries are stopped early, errors are of no account.
        let in_sizes = |length: Option<f64>| match length {
            None => 0.0,
            Some(_) if self.question == Question::Certificates => 0.0,
            // NaN is the worst of all.
            Some(length) if length.is_nan() => f64::INFINITY,
            Some(length) => length / self.size,
        };
        let (error, excess) = (in_sizes(verdict.error), in_sizes(verdict.excess));
        self.worst = self.worst.max(error);
        self.worst_point = self.worst_point.max(excess);
        self.iterations += verdict.iterations as u64;
        self.most_iterations = self.most_iterations.max(verdict.iterations as u64);
        let wrong = verdict.violation
            || (self.question != Question::Certificates
                && (verdict.false_hit || verdict.missed || verdict.undecided || error.max(excess) > self.allowed));
        if wrong && self.example.is_none() {
            self.example = Some(example());
        }
    }

    /// No wrong answer, and no error beyond what is allowed. Where queries are stopped early, only certificates count.
    pub(crate) fn is_right(&self) -> bool {
        let counted =
            if self.question == Question::Certificates { 0 } else { self.false_hits + self.missed + self.undecided };
        counted + self.violations == 0 && self.worst.max(self.worst_point) <= self.allowed
    }

    /// The error in rounding errors of the distance of the source.
    pub(crate) fn ulps(&self) -> f64 {
        self.worst / (self.epsilon() * self.distance.max(1.0))
    }

    fn precision(&self) -> &'static str {
        if self.is_single { "f32" } else { "f64" }
    }

    fn mean_iterations(&self) -> f64 {
        self.iterations as f64 / self.queries.max(1) as f64
    }

    fn name(&self) -> &'static str {
        match self.question {
            Question::Ray => "ray",
            Question::Linear => "linear",
            Question::Distance => "distance",
            Question::Certificates => "certificates",
            Question::Derivatives => "derivatives",
        }
    }

    pub(super) fn csv(&self) -> String {
        format!(
            "{},{},{},{:e},{:e},{},{},{},{},{},{},{:e},{:e},{:e},{:.2},{:.2},{},\"{}\"",
            self.name(),
            self.subject,
            self.precision(),
            self.size,
            self.distance,
            self.queries,
            self.false_hits,
            self.missed,
            self.undecided,
            self.unconverged,
            self.violations,
            self.worst,
            self.worst_point,
            self.allowed,
            self.ulps(),
            self.mean_iterations(),
            self.most_iterations,
            self.example.as_deref().unwrap_or("").replace('"', "\"\""),
        )
    }

    pub(super) fn differs_in_size(&self, other: &Self) -> bool {
        (self.question, self.subject, self.is_single) == (other.question, other.subject, other.is_single)
            && self.distance.to_bits() == other.distance.to_bits()
    }

    /// Takes in a row of another size.
    pub(super) fn join(&mut self, other: &Self) {
        self.queries += other.queries;
        self.false_hits += other.false_hits;
        self.missed += other.missed;
        self.undecided += other.undecided;
        self.unconverged += other.unconverged;
        self.violations += other.violations;
        self.worst = self.worst.max(other.worst);
        self.worst_point = self.worst_point.max(other.worst_point);
        self.iterations += other.iterations;
        self.most_iterations = self.most_iterations.max(other.most_iterations);
        self.example = self.example.take().or_else(|| other.example.clone());
    }
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:<12} {:<19} {:<4} {:>8} {:>8} {:>5} {:>6} {:>6} {:>7} {:>7} {:>10.1e} {:>10.1e} {:>8.1e} {:>9.2} {:>6.1} ≤{:>3}{}",
            self.name(),
            self.subject,
            self.precision(),
            format!("{:.0e}", self.distance),
            self.queries,
            self.false_hits,
            self.missed,
            self.undecided,
            self.unconverged,
            self.violations,
            self.worst,
            self.worst_point,
            self.allowed,
            self.ulps(),
            self.mean_iterations(),
            self.most_iterations,
            if self.is_right() { "" } else { "  WRONG" },
        )
    }
}
