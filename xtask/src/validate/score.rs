//! Whether an answer is right, as the query format defines it.

use gjk_raycast::laws::{Law, Report};
use serde_json::Value;

use crate::wire::fields::Object;

/// The field that holds the scalar of an answer.
pub fn scalar_of(query: &str) -> Option<&'static str> {
    Some(match query {
        "ray_cast" | "ray_exit" => "lambda",
        "distance" | "motion_clearance" => "distance",
        "signed_distance" => "signed_distance",
        "growth_distance" => "scale",
        "linear_cast" | "motion_cast" | "path" => "time",
        "enclosing_ellipsoid" | "inscribed_ellipsoid" => "log_det",
        "margin" => "margin",
        "track" => "margins",
        "clearance" => "min_margin",
        _ => return None,
    })
}

/// A query as a reader says it.
#[must_use]
pub fn called(query: &str) -> String {
    match query {
        "intersect" => "overlap",
        "motion_cast" => "turning cast",
        "motion_clearance" => "least distance over a motion",
        "margin" => "margin of ellipsoids",
        "track" => "margin along a motion",
        "clearance" => "clearance of a robot",
        "path" => "path of a robot",
        "none" => "unreadable line",
        known if scalar_of(known).is_some() || OTHERS.contains(&known) => return known.replace('_', " "),
        _ => "unknown query",
    }
    .to_owned()
}

/// Queries whose answer is not one number.
const OTHERS: [&str; 3] = ["contact", "scene", "joint_box"];

/// What became of one case.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// What makes the answer wrong; none if it is right.
    pub wrong: Vec<String>,
    /// What else is amiss: other fields, normals, certificates.
    pub soft: Vec<String>,
    /// Whether an error came where an answer was due.
    pub errored: bool,
    /// The error of the scalar that is worst in units of what is allowed: absolute, and relative to the truth where
    /// that is larger than what is allowed. That of the logarithm of a volume is relative already: to the volume.
    pub error: Option<f64>,
    pub relative: Option<f64>,
    /// The error over what is allowed.
    pub ratio: Option<f64>,
}

impl Verdict {
    /// Whether a bound that the answer certifies does not hold the truth.
    pub fn violates_certificate(&self) -> bool {
        self.soft.iter().any(|why| why.starts_with("bracket") || why.starts_with("gap"))
    }

    /// Whether a bracket is wide although the answer says that it has converged.
    #[must_use]
    pub fn is_wide(&self) -> bool {
        self.wrong.iter().any(|why| why.starts_with(WIDE))
    }

    fn wrong(why: impl Into<String>) -> Self {
        Self { wrong: vec![why.into()], ..Self::default() }
    }
}

/// Judges the answer to a line that is not even an object: it must be a parse error.
pub fn judge_unreadable(answer: &Object) -> Verdict {
    match error_kind(answer) {
        Some("parse") => Verdict::default(),
        kind => Verdict::wrong(format!("not a parse error: {kind:?}")),
    }
}

/// Judges an answer by the `expect`, `allow` and `allow_fields` of its case.
///
/// Where `allow` is absent, it is the first term of the format's formula: 1e-7 (in `f32` 1e-4) of the scalar, for
/// `log_det` 1e-7.
pub fn judge(case: &Object, answer: &Object) -> Verdict {
    let Some(expect) = case.get("expect").and_then(Value::as_object) else {
        return Verdict { errored: error_kind(answer).is_some(), ..Verdict::default() };
    };
    let kind = error_kind(answer);
    if let Some(due) = expect.get("error") {
        let due: Vec<&str> = match due {
            Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).collect(),
            kind => kind.as_str().into_iter().collect(),
        };
        return match kind {
            Some(kind) if due.contains(&kind) => Verdict::default(),
            _ => Verdict::wrong(format!("error {kind:?}, due {}", due.join("/"))),
        };
    }
    if let Some(kind) = kind {
        if expect.is_empty() {
            return Verdict { errored: true, ..Verdict::default() };
        }
        return Verdict { errored: true, ..Verdict::wrong(format!("error {kind}")) };
    }
    let mut verdict = Verdict::default();
    for flag in ["hit", "overlap", "smooth", "free", "meets"] {
        if let Some(due) = expect.get(flag)
            && answer.get(flag) != Some(due)
        {
            verdict.wrong.push(format!("{flag} {}, true {due}", text(answer.get(flag))));
        }
    }
    let query = case.get("query").and_then(Value::as_str).unwrap_or_default();
    let scalar = scalar_of(query);
    if let Some(name) = scalar
        && let Some(due) = expect.get(name)
        && verdict.wrong.is_empty()
    {
        judge_scalar(case, answer, name, due, &mut verdict);
    }
    if let Some(due) = expect.get("clearance").and_then(Value::as_object) {
        judge_clearance(case, due, answer.get("clearance").and_then(Value::as_object), &mut verdict);
    }
    judge_fields(case, expect, answer, scalar == Some("log_det"), &mut verdict);
    verdict
}

/// Compares the least distance along a path, and which bodies have it.
fn judge_clearance(case: &Object, due: &Object, answer: Option<&Object>, verdict: &mut Verdict) {
    let Some(answer) = answer else { return verdict.wrong.push("clearance missing".to_owned()) };
    for name in ["edge", "link", "obstacle", "other_link"] {
        if let Some(due) = due.get(name)
            && answer.get(name) != Some(due)
        {
            verdict.wrong.push(format!("clearance.{name} {}, true {due}", text(answer.get(name))));
        }
    }
    if let Some(distance) = due.get("distance")
        && verdict.wrong.is_empty()
    {
        judge_scalar(case, answer, "distance", distance, verdict);
    }
}

/// How the reason begins that an answer is wrong whose bracket is wide although it has converged.
const WIDE: &str = "wide although converged";

/// Counts what an answer says of itself and is not so: if the bracket of the answer given is wide although it has
/// converged, it is wrong. Other claims that are false, and those of answers with other options, are told beside it.
pub fn judge_claims(report: Report, verdict: &mut Verdict) {
    for broken in report.broken {
        match broken.law {
            Law::Width if broken.what.contains("by default") => verdict.wrong.push(format!("{WIDE}: {broken}")),
            _ => verdict.soft.push(format!("claim: {broken}")),
        }
    }
}

/// Compares the scalar, and what certifies it.
fn judge_scalar(case: &Object, answer: &Object, name: &str, due: &Value, verdict: &mut Verdict) {
    let single = case.get("precision").and_then(Value::as_str) == Some("f32");
    let base = if single { 1e-4 } else { 1e-7 };
    let due = numbers(due);
    let got = answer.get(name).map(numbers).unwrap_or_default();
    let given = case.get("allow").map(numbers);
    let allow: Vec<f64> = match given.as_deref() {
        Some([one]) => vec![*one; due.len()],
        Some(list) => list.to_vec(),
        None if name == "log_det" => vec![1e-7; due.len()],
        None => due.iter().map(|d| base * d.abs()).collect(),
    };
    if got.len() != due.len() || allow.len() != due.len() || !got.iter().all(|g| g.is_finite()) {
        verdict.wrong.push(format!("{name} missing, of another length or not finite"));
        return;
    }
    let ratio = |i: usize| match ((got[i] - due[i]).abs(), allow[i]) {
        (0.0, _) => 0.0,
        (error, allow) => error / allow,
    };
    let Some(worst) = (0..due.len()).max_by(|&i, &j| ratio(i).total_cmp(&ratio(j))) else { return };
    let error = (got[worst] - due[worst]).abs();
    verdict.error = Some(error);
    verdict.ratio = Some(ratio(worst));
    verdict.relative = match due[worst].abs() {
        _ if name == "log_det" => Some(error),
        0.0 => None,
        // Of a truth smaller than what is allowed, such as a hit at 3e-17, no part has a meaning.
        due if due < allow[worst] && error <= allow[worst] => None,
        due => Some(error / due.max(f64::MIN_POSITIVE)),
    };
    if ratio(worst) > 1.0 {
        verdict.wrong.push(format!(
            "{name} {}, true {}: off by {error:.3e}, where {:.3e} is allowed{}",
            got[worst],
            due[worst],
            allow[worst],
            if due.len() > 1 { format!(" at {worst}") } else { String::new() }
        ));
    }
    if let Some(gap) = answer.get("gap").and_then(Value::as_f64) {
        let enclosing = case.get("query").and_then(Value::as_str) == Some("enclosing_ellipsoid");
        let true_gap = if enclosing { due[0] - got[0] } else { got[0] - due[0] };
        if gap < -1e-12 || true_gap > gap + allow[0] {
            verdict.soft.push(format!("gap {gap:.3e} does not bound {true_gap:.3e}"));
        }
    }
    let bound = |name: &str| answer.get(name).and_then(Value::as_f64);
    if bound("lower").is_some_and(|lower| lower > due[0] + allow[0])
        || bound("upper").is_some_and(|upper| upper < due[0] - allow[0])
    {
        verdict.soft.push(format!("bracket {:?} to {:?} does not hold {}", bound("lower"), bound("upper"), due[0]));
    }
}

/// Compares the fields beside the scalar.
fn judge_fields(case: &Object, expect: &Object, answer: &Object, ellipsoid: bool, verdict: &mut Verdict) {
    if !verdict.wrong.is_empty() {
        return;
    }
    for (field, tolerance) in case.get("allow_fields").and_then(Value::as_object).into_iter().flatten() {
        let (Some(due), Some(tolerance)) = (expect.get(field), tolerance.as_f64()) else { continue };
        let Some(got) = answer.get(field).filter(|got| !got.is_null()) else {
            verdict.soft.push(format!("{field} missing"));
            continue;
        };
        let shape = expect.get("matrix").filter(|_| ellipsoid && matches!(field.as_str(), "matrix" | "center"));
        let off = match shape {
            Some(shape) => in_norm_of(shape, got, due),
            None => difference(got, due),
        };
        if off.is_nan() || off > tolerance {
            verdict.soft.push(format!("{field} is off by {off:.3e}, where {tolerance:.3e} is allowed"));
        }
    }
    let normal = answer.get("normal");
    if expect.get("normal").is_some_and(Value::is_null) && normal.is_some_and(|n| !n.is_null()) {
        verdict.soft.push("normal must be null".to_owned());
    }
    if answer.get("hit") == Some(&Value::Bool(true))
        && let Some(normal @ Value::Array(_)) = normal
    {
        let length = numbers(normal).iter().map(|c| c * c).sum::<f64>().sqrt();
        let single = case.get("precision").and_then(Value::as_str) == Some("f32");
        if (length - 1.0).abs() > if single { 1e-3 } else { 1e-9 } {
            verdict.soft.push(format!("normal has length {length}"));
        }
    }
}

fn error_kind(answer: &Object) -> Option<&str> {
    match answer.get("error")? {
        Value::Object(error) => error.get("kind")?.as_str(),
        kind => kind.as_str(),
    }
}

fn text(value: Option<&Value>) -> String {
    value.map_or_else(|| "missing".to_owned(), Value::to_string)
}

/// All numbers of a value, in order, and of its fields in that of their names; a flag is 0 or 1, and what else is no
/// number becomes NaN.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().flat_map(numbers).collect(),
        Value::Object(fields) => fields.values().flat_map(numbers).collect(),
        Value::Bool(flag) => vec![f64::from(u8::from(*flag))],
        number => vec![number.as_f64().unwrap_or(f64::NAN)],
    }
}

/// The Euclidean norm of the difference.
fn difference(got: &Value, due: &Value) -> f64 {
    let (got, due) = (numbers(got), numbers(due));
    if got.len() != due.len() {
        return f64::INFINITY;
    }
    got.iter().zip(&due).map(|(g, d)| (g - d) * (g - d)).sum::<f64>().sqrt()
}

/// The difference of centres in the norm of the true matrix X = L·Lᵀ, or ‖L⁻¹·X'·L⁻ᵀ − I‖ of matrices.
fn in_norm_of(shape: &Value, got: &Value, due: &Value) -> f64 {
    let shape = numbers(shape);
    let (got, due) = (numbers(got), numbers(due));
    let n = shape.len().isqrt();
    if got.len() != due.len() || n * n != shape.len() {
        return f64::INFINITY;
    }
    let Some(l) = cholesky(&shape, n) else { return 0.0 };
    if got.len() == n {
        // |Lᵀ·(c − c*)|
        let at = |i: usize| (i..n).map(|k| l[k * n + i] * (got[k] - due[k])).sum::<f64>();
        return (0..n).map(|i| at(i) * at(i)).sum::<f64>().sqrt();
    }
    if got.len() != n * n {
        return f64::INFINITY;
    }
    // Columns of Y = L⁻¹·X', then rows of Z = Y·L⁻ᵀ, each by forward substitution.
    let y: Vec<Vec<f64>> = (0..n).map(|j| forward(&l, n, |i| got[i * n + j])).collect();
    let z: Vec<Vec<f64>> = (0..n).map(|i| forward(&l, n, |j| y[j][i])).collect();
    let entry = |i: usize, j: usize| z[i][j] - if i == j { 1.0 } else { 0.0 };
    (0..n * n).map(|at| entry(at / n, at % n).powi(2)).sum::<f64>().sqrt()
}

fn cholesky(x: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut l = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let s = x[i * n + j] - (0..j).map(|k| l[i * n + k] * l[j * n + k]).sum::<f64>();
            if i == j && s.is_nan() | (s <= 0.0) {
                return None;
            }
            l[i * n + j] = if i == j { s.sqrt() } else { s / l[j * n + j] };
        }
    }
    Some(l)
}

fn forward(l: &[f64], n: usize, b: impl Fn(usize) -> f64) -> Vec<f64> {
    let mut y = Vec::with_capacity(n);
    for i in 0..n {
        let s = b(i) - (0..i).map(|k| l[i * n + k] * y[k]).sum::<f64>();
        y.push(s / l[i * n + i]);
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(text: &str) -> Object {
        serde_json::from_str(text).expect("JSON")
    }

    #[test]
    fn the_scalar_decides() {
        let case = object(r#"{"query":"ray_cast","expect":{"hit":true,"lambda":2.0},"allow":0.5}"#);
        let verdict = |answer: &str| judge(&case, &object(answer));
        assert!(verdict(r#"{"hit":true,"lambda":2.5}"#).wrong.is_empty(), "within what is allowed");
        assert!(!verdict(r#"{"hit":true,"lambda":2.6}"#).wrong.is_empty(), "beyond it");
        assert!(!verdict(r#"{"hit":false}"#).wrong.is_empty(), "the wrong flag");
        assert!(!verdict(r#"{"hit":true}"#).wrong.is_empty(), "no scalar");
        let error = verdict(r#"{"error":{"kind":"not_converged","message":""}}"#);
        assert!(error.errored && !error.wrong.is_empty(), "an error where an answer is due");
    }

    #[test]
    fn errors_are_answers_where_they_are_due() {
        let case = object(r#"{"query":"ray_cast","expect":{"error":["parse","non_finite"]}}"#);
        let verdict = |answer: &str| judge(&case, &object(answer)).wrong.is_empty();
        assert!(verdict(r#"{"error":{"kind":"parse","message":""}}"#), "one of the kinds");
        assert!(!verdict(r#"{"error":{"kind":"io","message":""}}"#), "another kind");
        assert!(!verdict(r#"{"hit":true,"lambda":1}"#), "an answer where an error is due");
    }

    #[test]
    fn matrices_are_compared_in_their_own_norm() {
        let shape: Value = serde_json::from_str("[[4.0,0.0],[0.0,1.0]]").expect("JSON");
        let longer: Value = serde_json::from_str("[[4.4,0.0],[0.0,1.0]]").expect("JSON");
        assert!((in_norm_of(&shape, &longer, &shape) - 0.1).abs() < 1e-15, "4.4 is 10 % above 4");
        let (moved, centre): (Value, Value) = (Value::from(vec![0.5, 0.0]), Value::from(vec![0.0, 0.0]));
        assert_eq!(in_norm_of(&shape, &moved, &centre), 1.0, "0.5 is a whole semi-axis");
    }

    #[test]
    fn certificates_must_hold() {
        let case = object(r#"{"query":"enclosing_ellipsoid","expect":{"log_det":1.0},"allow":1e-9}"#);
        let soft = |answer: &str| judge(&case, &object(answer)).soft.len();
        assert_eq!(soft(r#"{"log_det":0.9999999995,"gap":1e-9}"#), 0, "the gap covers what is missing");
        assert_eq!(soft(r#"{"log_det":0.999999999,"gap":-1e-9}"#), 1, "a gap is not negative");
    }
}
