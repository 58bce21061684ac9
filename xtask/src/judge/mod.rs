//! Answers of anybody held against what is proved: the judgement of `cargo xtask judge`, and the first figure of the
//! report.

pub mod fact;
pub mod figure;
pub mod questions;
pub mod table;
pub mod verdict;
pub mod witnesses;

use serde_json::{Value, json};

use self::fact::{Bodies, Fact};
use self::questions::Question;
use self::table::Row;
use self::verdict::{Claim, Outcome, Verdict};
use self::witnesses::{Reply, Witness};

/// A question, and what is proved about it.
#[derive(Debug)]
pub struct Case {
    pub question: Question,
    pub bodies: Bodies,
    pub fact: Fact,
}

/// What is proved about the questions, telling `progress` how many are done.
pub fn proved(questions: Vec<Question>, mut progress: impl FnMut(usize)) -> Vec<Option<Case>> {
    let prove = |(k, question): (usize, Question)| {
        progress(k);
        let bodies = Bodies::of(&question.object)?;
        let fact = Fact::of(&question.object, Some(&bodies));
        Some(Case { question, bodies, fact })
    };
    questions.into_iter().enumerate().map(prove).collect()
}

/// The answers of one to all sets of questions, judged; what is disproved is appended as lines of JSON.
pub fn judged(witness: &Witness, cases: &[Option<Case>], disproved: &mut String) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (case, reply) in cases.iter().zip(&witness.replies).filter_map(|(case, reply)| Some((case.as_ref()?, reply))) {
        let set = case.question.set;
        let at = rows.iter().position(|row| row.set == set).unwrap_or_else(|| {
            rows.push(Row::new(&witness.name, set));
            rows.len() - 1
        });
        let row = &mut rows[at];
        let Reply::Answer { claim, ns } = *reply else {
            row.add_none(matches!(reply, Reply::NoAnswer));
            continue;
        };
        let allowed = witness.allowed(&case.bodies);
        let verdict = verdict::judge(claim, case.fact, &case.bodies, allowed);
        if verdict.outcome == Outcome::Disproved {
            *disproved += &reproduction(witness, case, claim, &verdict);
        }
        row.add(&verdict, ns);
    }
    rows
}

/// A claim that is disproved, with all that it takes to see that.
fn reproduction(witness: &Witness, case: &Case, claim: Claim, verdict: &Verdict) -> String {
    let claim = match claim {
        Claim { flag: Some(flag), scalar: None } => json!(flag),
        Claim { scalar, .. } => json!(scalar),
    };
    let question = Value::Object(case.question.object.clone());
    let line = json!({"peer": witness.name, "claim": claim, "evidence": verdict.evidence, "question": question});
    format!("{line}\n")
}

/// How many truths are known otherwise, and the questions whose bracket does not hold theirs.
///
/// Those of the workloads are known by construction, to some 1e-11 of a motion or of a length of one; those of the
/// suite in ninety digits, rounded to a double.
#[must_use]
pub fn violated(cases: &[Option<Case>]) -> (usize, Vec<String>) {
    let known: Vec<(&Case, f64)> =
        cases.iter().flatten().filter_map(|case| Some((case, case.question.truth?))).collect();
    let holds = |case: &Case, truth: f64| {
        let [lower, upper] = match case.fact {
            Fact::Hit(bounds) | Fact::Distance(bounds) => bounds,
            Fact::Graze(lower) => [lower, f64::INFINITY],
            Fact::Miss => return false,
            Fact::Open => return true,
        };
        let slack = 1e-11 * (case.bodies.reach + truth.abs());
        lower - slack <= truth && truth <= upper + slack
    };
    let wrong = known.iter().filter(|(case, truth)| !holds(case, *truth)).map(|(case, _)| case.question.id.clone());
    (known.len(), wrong.collect())
}
