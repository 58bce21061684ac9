//! A line of JSON.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::Value;
use serde_json::value::RawValue;

use super::error::{Kind, Problem};
use super::fields::Object;

/// The deepest nesting of lists and objects that is read.
const DEEPEST: usize = 128;

/// The JSON object on a line.
///
/// # Errors
/// [`Kind::Parse`] where it is not JSON, not an object, an object in it has a field twice, or it is nested deeper than
/// 128 levels; [`Kind::NonFinite`] where a
/// number is too large for a double.
pub fn object(line: &[u8]) -> Result<Object, Problem> {
    if deepest(line) > DEEPEST {
        return Err(Problem::new(Kind::Parse, format!("lists and objects are nested deeper than {DEEPEST} levels")));
    }
    let mut deserializer = serde_json::Deserializer::from_slice(line);
    deserializer.disable_recursion_limit();
    let Unique(value) = serde_path_to_error::deserialize(&mut deserializer)
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

/// A value of which no object has a field twice: of two values one would be left out without a word, and programs
/// differ in which.
struct Unique(Value);

impl<'de> Deserialize<'de> for Unique {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Uniquely).map(Self)
    }
}

struct Uniquely;

impl<'de> Visitor<'de> for Uniquely {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a JSON value")
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_bool<E: Error>(self, flag: bool) -> Result<Value, E> {
        Ok(flag.into())
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list = Vec::new();
        while let Some(Unique(item)) = items.next_element()? {
            list.push(item);
        }
        Ok(list.into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut fields: A) -> Result<Value, A::Error> {
        let mut object = Object::new();
        while let Some(name) = fields.next_key::<String>()? {
            if object.contains_key(&name) {
                return Err(Error::custom(format_args!("{TWICE} {name:?} twice")));
            }
            let Unique(value) = fields.next_value()?;
            object.insert(name, value);
        }
        Ok(object.into())
    }
}

/// How the message begins where an object has a field twice.
const TWICE: &str = "the object has the field";

/// What serde says of a line that is not JSON, and where.
fn not_json(place: &str, why: &serde_json::Error) -> Problem {
    let place = if place == ".: " { "" } else { place };
    let text = why.to_string().replace("line 1 column", "column");
    if text.starts_with("number out of range") {
        return Problem::new(Kind::NonFinite, format!("{place}too large for a double, {text}"));
    }
    if text.starts_with(TWICE) {
        return Problem::new(Kind::Parse, format!("{place}{text}"));
    }
    Problem::new(Kind::Parse, format!("the line is not JSON: {place}{text}"))
}

/// What a line calls itself, as it is written, as far as that can be told.
#[must_use]
pub fn id_of(line: &[u8]) -> Option<Box<RawValue>> {
    #[derive(serde::Deserialize)]
    struct Named {
        id: Option<Box<RawValue>>,
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
    fn nesting_is_bounded() {
        let nested = |levels: usize| format!("{{\"a\":{}{}}}", "[".repeat(levels), "]".repeat(levels));
        assert!(object(nested(DEEPEST - 1).as_bytes()).is_ok(), "as deep as may be");
        for levels in [DEEPEST, 100_000] {
            let problem = object(nested(levels).as_bytes()).expect_err("too deep");
            assert_eq!(problem.kind, Kind::Parse, "{problem:?}");
        }
    }

    #[test]
    fn no_object_has_a_field_twice() {
        let cases = [
            (r#"{"a":1,"a":1}"#, "the object has the field \"a\" twice at column 10"),
            (r#"{"a":1,"\u0061":2}"#, "the object has the field \"a\" twice at column 15"),
            (r#"{"a":[0,{"of":{"b":1,"c":2,"b":3}}]}"#, "a[1].of: the object has the field \"b\" twice at column 30"),
            (r#"{"_note":{"x":1,"x":1}}"#, "_note: the object has the field \"x\" twice at column 19"),
        ];
        for (line, message) in cases {
            let problem = object(line.as_bytes()).expect_err("a field is there twice");
            assert_eq!((problem.kind, problem.message.as_str()), (Kind::Parse, message), "{line}");
        }
        assert!(object(br#"{"a":{"b":1},"b":{"a":1}}"#).is_ok(), "in different objects");
    }

    #[test]
    fn ids_come_back_as_they_are_written() {
        for id in ["123456789012345678901234567890", "-0", "1e999", "1.50", "\"\\u00e9\"", "[1, {\"a\":-0.0}]", "null"]
        {
            let line = format!(r#"{{"query":"ray_cast","id": {id} ,"x":1}}"#);
            let read = id_of(line.as_bytes()).map_or("null".to_owned(), |id| id.get().to_owned());
            assert_eq!(read, id, "{line}");
        }
        assert!(id_of(br#"{"id":1,"id":2}"#).is_none(), "it has two");
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
