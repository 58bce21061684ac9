//! Who answers: this workspace, the libraries that are built in, and answers out of files.

use std::collections::HashMap;
use std::fs;
use std::path::Path;

use crate::engine;
use crate::mesh::Meshes;
use crate::validate::score::scalar_of;
use crate::wire::answer::Line;
use crate::wire::answer::as_read;
use crate::wire::fields::Object;
use crate::wire::json;
use serde_json::{Value, json};

use super::fact::Bodies;
use super::questions::Question;
use super::verdict::Claim;

/// What was answered to a question.
#[derive(Clone, Copy, Debug)]
pub enum Reply {
    Answer {
        claim: Claim,
        /// Nanoseconds for one query.
        ns: f64,
    },
    /// An error, or something that is no number.
    NoAnswer,
    /// The shapes or the question are none of this library's.
    NotAsked,
}

/// Somebody who answers.
#[derive(Clone, Debug)]
pub struct Witness {
    /// Name, version and precision.
    pub name: String,
    /// Lengths that its documentation leaves open.
    pub tolerance: f64,
    /// The part of a motion that its documentation leaves open.
    pub of_motion: f64,
    /// What is nobody's mistake in its precision, in parts of the reach of the scene: that of the query format.
    pub rounding: f64,
    /// How it was asked.
    pub settings: String,
    pub replies: Vec<Reply>,
}

impl Witness {
    /// The length that is nobody's mistake in a scene.
    #[must_use]
    pub fn allowed(&self, bodies: &Bodies) -> f64 {
        let way = bodies.speed * bodies.max_time;
        // The way without end of a motion without end leaves no time open.
        let along = if way.is_finite() { self.of_motion * way } else { 0.0 };
        self.tolerance.max(self.rounding * bodies.reach).max(along)
    }

    /// Writes the answers as a file that [`from_file`] reads.
    ///
    /// # Errors
    /// Why the file cannot be written, as a sentence.
    pub fn write(&self, questions: &[Question], path: &Path) -> Result<(), String> {
        let Self { name, tolerance, of_motion, settings, .. } = self;
        let mut lines =
            vec![json!({"peer": name, "tolerance": tolerance, "of_motion": of_motion, "settings": settings})];
        for (Question { id, object, .. }, reply) in questions.iter().zip(&self.replies) {
            let Reply::Answer { claim: Claim { flag, scalar }, ns } = *reply else {
                if matches!(reply, Reply::NoAnswer) {
                    lines.push(json!({"id": id, "error": "no answer"}));
                }
                continue;
            };
            let mut line = json!({"id": id, "ns": ns});
            let query = object.get("query").and_then(Value::as_str).unwrap_or_default();
            if let Some(flag) = flag {
                line[if query.ends_with("cast") { "hit" } else { "overlap" }] = json!(flag);
            }
            if let (Some(name), Some(scalar)) = (scalar_of(query), scalar) {
                line[name] = json!(scalar);
            }
            lines.push(line);
        }
        let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
        fs::write(path, text).map_err(|why| format!("cannot write {}: {why}", path.display()))
    }
}

/// Relative errors that are nobody's mistake.
pub fn rounding(precision: &str) -> f64 {
    if precision == "f32" { 1e-4 } else { 1e-7 }
}

/// How long a question is timed: three runs of this, of which the fastest counts.
pub const MICROSECONDS: u64 = 30;

/// This workspace, by `dyn SupportMap`, as `cargo xtask query` asks it.
pub fn ours(questions: &[Question], precision: &'static str, mut progress: impl FnMut(usize)) -> Witness {
    let reply = |(k, question): (usize, &Question)| {
        progress(k);
        let mut object = question.object.clone();
        object.insert("precision".to_owned(), Value::from(precision));
        let Ok(question) = engine::question(&object, &Meshes::relative_to("")) else { return Reply::NotAsked };
        let outcome = question.ask();
        if outcome.is_err() {
            return Reply::NoAnswer;
        }
        let answer = as_read(Line { id: None, line: 0, outcome });
        Reply::Answer { claim: claim(&object, &answer), ns: question.time(MICROSECONDS) }
    };
    Witness {
        name: format!("ours {precision}"),
        tolerance: 0.0,
        of_motion: 0.0,
        rounding: rounding(precision),
        settings: "the defaults; shapes behind dyn SupportMap".to_owned(),
        replies: questions.iter().enumerate().map(reply).collect(),
    }
}

/// What an answer in the query format says.
fn claim(question: &Object, answer: &Object) -> Claim {
    let flag = ["hit", "overlap"].iter().find_map(|name| answer.get(*name)?.as_bool());
    let query = question.get("query").and_then(Value::as_str).unwrap_or_default();
    Claim { flag, scalar: scalar_of(query).and_then(|name| answer.get(name)?.as_f64()) }
}

/// Answers out of a file: in its first line who answered, then one line for each question that was.
///
/// `{"peer", "precision", "tolerance", "of_motion", "settings"}`, where either tolerance may be left out, and then
/// `{"id", "ns", …}` with the fields of the query format, or with `"error"` in their place. A question without a line
/// was not asked.
///
/// # Errors
/// What is wrong with the file, as a sentence.
pub fn from_file(path: &Path, questions: &[Question]) -> Result<Witness, String> {
    let text = fs::read_to_string(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
    let read = |(k, line): (usize, &str)| -> Result<Object, String> {
        json::object(line.as_bytes()).map_err(|why| format!("{}, line {}: {}", path.display(), k + 1, why.message))
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).map(read);
    let head = lines.next().unwrap_or_else(|| Err(format!("{} is empty", path.display())))?;
    let mut answers = HashMap::new();
    for answer in lines {
        let answer = answer?;
        let id = answer.get("id").and_then(Value::as_str).ok_or("an answer has no id")?.to_owned();
        if answers.contains_key(&id) {
            return Err(format!("{}: there are two answers to {id:?}", path.display()));
        }
        answers.insert(id, answer);
    }
    let reply = |question: &Question| {
        let Some(answer) = answers.get(&question.id) else { return Reply::NotAsked };
        let claim = claim(&question.object, answer);
        if answer.contains_key("error") || claim.flag.is_none() && claim.scalar.is_none() {
            return Reply::NoAnswer;
        }
        Reply::Answer { claim, ns: answer.get("ns").and_then(Value::as_f64).unwrap_or(f64::NAN) }
    };
    let number = |field: &str| head.get(field).and_then(Value::as_f64).unwrap_or(0.0);
    let word = |field: &str| head.get(field).and_then(Value::as_str).unwrap_or_default().to_owned();
    if word("peer").is_empty() {
        return Err(format!("{}: the first line does not say who the peer is", path.display()));
    }
    Ok(Witness {
        name: word("peer"),
        tolerance: number("tolerance"),
        of_motion: number("of_motion"),
        rounding: rounding(&word("precision")),
        settings: word("settings"),
        replies: questions.iter().map(reply).collect(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::json;

    fn question(id: &str, query: &str) -> Question {
        let object = json::object(format!(r#"{{"id":"{id}","query":"{query}"}}"#).as_bytes()).expect("JSON");
        Question { id: id.to_owned(), set: "set", object, truth: None }
    }

    #[test]
    fn answers_are_read_from_lines_in_any_order() {
        let questions = [
            question("a", "distance"),
            question("b", "intersect"),
            question("c", "ray_cast"),
            question("d", "ray_cast"),
        ];
        let file = std::env::temp_dir().join(format!("answers-{}.jsonl", std::process::id()));
        let lines = r#"{"peer":"someone 1.0","precision":"f32","tolerance":0.005,"of_motion":1e-4,"settings":"as they come"}
{"id":"c","error":"it gave up"}
{"id":"b","overlap":true,"ns":12.5}

{"id":"a","distance":0.25,"overlap":false}
"#;
        fs::write(&file, lines).expect("a file");
        let read = from_file(&file, &questions);
        fs::remove_file(&file).expect("it was there");
        let Witness { name, tolerance, of_motion, rounding, replies, .. } = read.expect("answers");
        assert_eq!((name.as_str(), tolerance, of_motion, rounding), ("someone 1.0", 0.005, 1e-4, 1e-4));
        let told = |k: usize| match replies[k] {
            Reply::Answer { claim, ns } => Some((claim.flag, claim.scalar, ns.is_finite())),
            _ => None,
        };
        assert_eq!(told(0), Some((Some(false), Some(0.25), false)), "no time was said");
        assert_eq!(told(1), Some((Some(true), None, true)), "a boolean has no scalar");
        assert!(matches!(replies[2], Reply::NoAnswer), "an error");
        assert!(matches!(replies[3], Reply::NotAsked), "no line");
        assert!(from_file(&file, &questions).is_err(), "the file is gone");
    }
}
