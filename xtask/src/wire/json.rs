//! A line of JSON.

use serde_json::Value;

use super::error::{Kind, Problem};
use super::fields::Object;

/// The deepest nesting of lists and objects that is read.
const DEEPEST: usize = 128;

/// The JSON object on a line.
///
/// # Errors
/// [`Kind::Parse`] where it is not JSON, not an object, or nested deeper than 128 levels; [`Kind::NonFinite`] where a
/// number is too large for a double.
pub fn object(line: &[u8]) -> Result<Object, Problem> {
    if deepest(line) > DEEPEST {
        return Err(Problem::new(Kind::Parse, format!("lists and objects are nested deeper than {DEEPEST} levels")));
    }
    let mut deserializer = serde_json::Deserializer::from_slice(line);
    deserializer.disable_recursion_limit();
    let value: Value = serde_path_to_error::deserialize(&mut deserializer)
        .map_err(|why| not_json(&format!("{}: ", why.path()), why.inner()))?;
    deserializer.end().map_err(|why| not_json("after the object: ", &why))?;
    match value {
        Value::Object(object) => Ok(object),
        other => {
            let message = format!("the line must be an object, {{\"query\": …}}, but is {other:.40}");
            Err(Problem::new(Kind::Parse, message))
        }
    }
}

/// What serde says of a line that is not JSON, and where.
fn not_json(place: &str, why: &serde_json::Error) -> Problem {
    let place = if place == ".: " { "" } else { place };
    let text = why.to_string().replace("line 1 column", "column");
    if text.starts_with("number out of range") {
        return Problem::new(Kind::NonFinite, format!("{place}too large for a double, {text}"));
    }
    Problem::new(Kind::Parse, format!("the line is not JSON: {place}{text}"))
}

/// What a line that could not be read calls itself, as far as that can be told.
#[must_use]
pub fn id_of(line: &[u8]) -> Option<Value> {
    #[derive(serde::Deserialize)]
    struct Named {
        id: Option<Value>,
    }
    // Fields that are not asked for are skipped without looking at their numbers or their depth.
    serde_json::from_slice::<Named>(line).ok()?.id
}

/// What a line that could not be read says is expected of it: a case without its query.
#[must_use]
pub fn expectation_of(line: &[u8]) -> Option<Object> {
    #[derive(serde::Deserialize)]
    struct Expecting {
        id: Option<Value>,
        tags: Option<Value>,
        expect: Value,
    }
    let Expecting { id, tags, expect } = serde_json::from_slice(line).ok()?;
    let fields = [("id", id), ("tags", tags), ("expect", Some(expect))];
    Some(fields.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect())
}

/// The deepest nesting of brackets outside strings.
fn deepest(line: &[u8]) -> usize {
    let (mut depth, mut deepest) = (0usize, 0usize);
    let (mut quoted, mut escaped) = (false, false);
    for &byte in line {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if quoted => escaped = true,
            b'"' => quoted = !quoted,
            b'[' | b'{' if !quoted => {
                depth += 1;
                deepest = deepest.max(depth);
            }
            b']' | b'}' if !quoted => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    deepest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_json_is_said_with_its_place() {
        let cases: [(&[u8], Kind, &str); 6] = [
            (br#"{"a":NaN}"#, Kind::Parse, "the line is not JSON: a: expected value at column 6"),
            (br#"{"a":{"b":[1,2"#, Kind::Parse, "the line is not JSON: a.b: EOF while parsing a list at column 14"),
            (br#"{"a":1} {}"#, Kind::Parse, "the line is not JSON: after the object: trailing characters at column 9"),
            (b"hello", Kind::Parse, "the line is not JSON: expected value at column 1"),
            (b"[1]", Kind::Parse, "the line must be an object, {\"query\": …}, but is [1]"),
            (
                br#"{"a":{"half_extents":[1,1e999,1]}}"#,
                Kind::NonFinite,
                "a.half_extents[1]: too large for a double, number out of range at column 29",
            ),
        ];
        for (line, kind, message) in cases {
            let problem = object(line).expect_err("it cannot be read");
            assert_eq!((problem.kind, problem.message.as_str()), (kind, message), "{}", String::from_utf8_lossy(line));
        }
    }

    #[test]
    fn nesting_is_bounded_and_of_equal_names_the_last_counts() {
        let nested = |levels: usize| format!("{{\"a\":{}{}}}", "[".repeat(levels), "]".repeat(levels));
        assert!(object(nested(DEEPEST - 1).as_bytes()).is_ok(), "as deep as may be");
        for levels in [DEEPEST, 100_000] {
            let problem = object(nested(levels).as_bytes()).expect_err("too deep");
            assert_eq!(problem.kind, Kind::Parse, "{problem:?}");
        }
        let twice = object(br#"{"a":1,"a":2}"#).expect("JSON");
        assert_eq!(twice["a"], 2, "the last");
    }

    #[test]
    fn any_line_cut_anywhere_is_refused() {
        let whole =
            r#"{"id":"ü\"[","query":"ray_cast","source":[5e0,-1],"target":{"type":"ball","radius":1e-3}}"#.as_bytes();
        for end in 0..whole.len() {
            assert_eq!(object(&whole[..end]).expect_err("it is cut short").kind, Kind::Parse, "after {end} bytes");
            for byte in [0, b',', b'"', b'N', b'{', b']', 0xFF] {
                let mut damaged = whole.to_vec();
                damaged[end] = byte;
                let _ = object(&damaged);
            }
        }
    }
}
