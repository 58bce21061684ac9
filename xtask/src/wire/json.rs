//! A line of JSON, and what is wrong with one that is none.

use std::fmt::Write as _;

use serde::Deserialize as _;
use serde_json::Value;
use serde_json::error::Category;

use super::error::{Kind, Problem};
use super::reader::Object;

/// The deepest nesting of lists and objects that is read.
const DEEPEST: usize = 128;

/// The JSON object on a line.
///
/// # Errors
/// [`Kind::Parse`] where it is not JSON, not an object, or nested deeper than 128 levels.
pub fn object(line: &[u8]) -> Result<Object, Problem> {
    if deepest(line) > DEEPEST {
        return Err(Problem::new(Kind::Parse, format!("lists and objects are nested deeper than {DEEPEST} levels")));
    }
    let mut deserializer = serde_json::Deserializer::from_slice(line);
    deserializer.disable_recursion_limit();
    let value = Value::deserialize(&mut deserializer).and_then(|value| deserializer.end().map(|()| value));
    match value {
        Ok(Value::Object(object)) => Ok(object),
        Ok(other) => {
            let found = match other {
                Value::Array(_) => "a list",
                Value::String(_) => "a string",
                Value::Number(_) => "a number",
                _ => "a bare word",
            };
            let message = format!("the line is {found}, but must be an object, {{\"query\": …}}, one to a line");
            Err(Problem::new(Kind::Parse, message))
        }
        Err(why) => Err(explain(line, &why)),
    }
}

/// What a line that could not be read calls itself, as far as that can be told.
pub fn id_of(line: &[u8]) -> Option<Value> {
    #[derive(serde::Deserialize)]
    struct Named {
        id: Option<Value>,
    }
    // Fields that are not asked for are skipped without looking at their numbers or their depth.
    serde_json::from_slice::<Named>(line).ok()?.id
}

/// What a line that could not be read says is expected of it: a case without its query.
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

/// Says what is wrong with a line that is not JSON, and where: the field, the column, and what stands there.
fn explain(line: &[u8], why: &serde_json::Error) -> Problem {
    let parse = |message: String| Problem::new(Kind::Parse, format!("the line is not JSON: {message}"));
    if line.starts_with(b"\xFF\xFE") || line.starts_with(b"\xFE\xFF") || line.contains(&0) {
        return parse("it looks like UTF-16 or binary data; query files are UTF-8 text".to_owned());
    }
    if let Err(broken) = std::str::from_utf8(line) {
        let at = broken.valid_up_to();
        return parse(format!("byte {:#04x} at column {} is not UTF-8", line[at], column(line, at)));
    }
    if line.starts_with(b"\xEF\xBB\xBF") {
        return parse("it starts with a byte order mark, which may stand only at the start of a file".to_owned());
    }
    // Columns of serde_json are counted from 1, in bytes.
    let (start, word) = word_at(line, why.column().saturating_sub(1));
    let place = place_of(line, start);
    let of = if place.is_empty() { String::new() } else { format!("{place}: ") };
    let column = column(line, start);
    let text = why.to_string();
    let text = text.split(" at line ").next().unwrap_or(&text);
    if text == "number out of range" {
        let message = format!("{of}{word} at column {column} is too large for a double");
        return Problem::new(Kind::NonFinite, message);
    }
    let lower = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
    parse(match text {
        "trailing comma" => format!("{of}a comma with nothing after it, before column {column}"),
        "trailing characters" if line[start] == b',' => format!("a comma after the object, at column {column}"),
        "trailing characters" => {
            format!("there is more after the object, from column {column} on; write one object to a line")
        }
        "key must be a string" => format!("a name at column {column} that is not in double quotes"),
        _ if why.classify() == Category::Eof => {
            let within = text.strip_prefix("EOF while parsing ").unwrap_or("a value");
            format!("{of}it ends within {within}")
        }
        _ if matches!(lower.as_str(), "nan" | "inf" | "infinity") => {
            format!("{of}{word} at column {column} is no JSON value, and numbers must be finite")
        }
        _ if matches!(lower.as_str(), "true" | "false") => {
            format!("{of}{word} at column {column} must be written {lower}")
        }
        _ if line.get(start) == Some(&b'\'') => format!("{of}the string at column {column} is not in double quotes"),
        _ if !word.is_empty() => format!("{of}{word} at column {column} is no JSON value"),
        other => format!("{of}{other} at column {column}"),
    })
}

/// The word or number that the byte `at` belongs to or ends, and where it starts; that byte alone where there is none.
fn word_at(line: &[u8], at: usize) -> (usize, String) {
    let is_part = |i: usize| line.get(i).is_some_and(|b| b.is_ascii_alphanumeric() || b"+-._".contains(b));
    let at = at.min(line.len().saturating_sub(1));
    let inside = if !is_part(at) && at > 0 && is_part(at - 1) { at - 1 } else { at };
    if !is_part(inside) {
        return (at, String::new());
    }
    let start = (0..=inside).rev().take_while(|&i| is_part(i)).last().unwrap_or(inside);
    let end = (inside..line.len()).find(|&i| !is_part(i)).unwrap_or(line.len());
    // No number or word that is meant as one is longer.
    (start, String::from_utf8_lossy(&line[start..end.min(start + 40)]).into_owned())
}

/// The column of the byte `at`, counted from 1 in characters, as editors do.
fn column(line: &[u8], at: usize) -> usize {
    String::from_utf8_lossy(&line[..at]).chars().count() + 1
}

/// Where in the query the byte `end` is, as in `target.points[3]`; nothing at the top.
fn place_of(line: &[u8], end: usize) -> String {
    /// A list with the index of the item, or an object with the name of the field.
    enum Level {
        List(usize),
        Object { key: String, is_key_next: bool },
    }
    let mut levels = Vec::new();
    let (mut quoted, mut escaped) = (None, false);
    for (i, &byte) in line[..end].iter().enumerate() {
        match (byte, quoted) {
            (_, Some(_)) if escaped => escaped = false,
            (b'\\', Some(_)) => escaped = true,
            (b'"', Some(start)) => {
                quoted = None;
                if let Some(Level::Object { key, is_key_next: true }) = levels.last_mut() {
                    *key = String::from_utf8_lossy(&line[start..i]).into_owned();
                }
            }
            (_, Some(_)) => {}
            (b'"', None) => quoted = Some(i + 1),
            (b'[', None) => levels.push(Level::List(0)),
            (b'{', None) => levels.push(Level::Object { key: String::new(), is_key_next: true }),
            (b']' | b'}', None) => drop(levels.pop()),
            (b':', None) => {
                if let Some(Level::Object { is_key_next, .. }) = levels.last_mut() {
                    *is_key_next = false;
                }
            }
            (b',', None) => match levels.last_mut() {
                Some(Level::List(index)) => *index += 1,
                Some(Level::Object { key, is_key_next }) => {
                    key.clear();
                    *is_key_next = true;
                }
                None => {}
            },
            _ => {}
        }
    }
    let mut text = String::new();
    for level in levels {
        match level {
            Level::List(index) => {
                let _ = write!(text, "[{index}]");
            }
            Level::Object { key, is_key_next: false } => {
                let dot = if text.is_empty() { "" } else { "." };
                let _ = write!(text, "{dot}{key}");
            }
            Level::Object { .. } => {}
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn nested(levels: usize) -> String {
        // The object is one level, each list one more.
        format!(r#"{{"query":"x","deep":{}1{}}}"#, "[".repeat(levels - 1), "]".repeat(levels - 1))
    }

    #[test]
    fn reads_128_levels_and_no_more() {
        object(nested(128).as_bytes()).expect("the deepest that is read");
        let problem = object(nested(129).as_bytes()).expect_err("too deep");
        assert_eq!(problem.kind, Kind::Parse, "{problem:?}");
        object(nested(1_000_000).as_bytes()).expect_err("far too deep, and no crash");
        assert_eq!(deepest(br#"{"a":"[[[\"[[","b":[{}]}"#), 3, "brackets in strings do not nest");
    }

    #[test]
    fn a_line_that_cannot_be_read_may_still_be_named() {
        let line = br#"{"id":"far","source":[1e400,0,0]}"#;
        assert_eq!(object(line).expect_err("beyond doubles").kind, Kind::NonFinite, "a number too large");
        assert_eq!(id_of(line), Some(Value::from("far")), "the name");
        assert_eq!(id_of(b"not json"), None, "no name");
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        let cases: &[(&[u8], &str)] = &[
            (br#"{"a":{"r":NaN}}"#, "a.r: NaN at column 11 is no JSON value, and numbers must be finite"),
            (br#"{"s":[0,-Infinity]}"#, "s[1]: -Infinity at column 9 is no JSON value, and numbers must be finite"),
            ("{\"ä\":[0,inf]}".as_bytes(), "ä[1]: inf at column 9 is no JSON value, and numbers must be finite"),
            (br#"{"a":True}"#, "a: True at column 6 must be written true"),
            (br#"{"a":.5}"#, "a: .5 at column 6 is no JSON value"),
            (br#"{"a":'x'}"#, "a: the string at column 6 is not in double quotes"),
            (br#"{'a':1}"#, "a name at column 2 that is not in double quotes"),
            (br#"{"a":[1,2,],"b":3}"#, "a[2]: a comma with nothing after it, before column 11"),
            (br#"{"a":1,}"#, "a comma with nothing after it, before column 8"),
            (br#"{"a":1},"#, "a comma after the object, at column 8"),
            (br#"{"a":1} {}"#, "there is more after the object, from column 9 on; write one object to a line"),
            (br#"{"a":{"b":[1,2"#, "a.b[1]: it ends within a list"),
            (br#"{"a":"x"#, "a: it ends within a string"),
            (b"hello", "hello at column 1 is no JSON value"),
            (b"\xEF\xBB\xBF{}", "it starts with a byte order mark, which may stand only at the start of a file"),
            (b"{\"a\":\"\xC3(\"}", "byte 0xc3 at column 7 is not UTF-8"),
            (b"\xFF\xFE{\0", "it looks like UTF-16 or binary data; query files are UTF-8 text"),
        ];
        for (line, message) in cases {
            let problem = object(line).expect_err("not JSON");
            assert_eq!(problem.kind, Kind::Parse, "{problem:?}");
            assert_eq!(
                problem.message,
                format!("the line is not JSON: {message}"),
                "{}",
                String::from_utf8_lossy(line)
            );
        }
        let problem = object(br#"{"a":{"half_extents":[1,1e999,1]}}"#).expect_err("too large");
        assert_eq!(problem.message, "a.half_extents[1]: 1e999 at column 25 is too large for a double", "{problem:?}");
        let problem = object(b"[]").expect_err("not an object");
        assert_eq!(
            problem.message, r#"the line is a list, but must be an object, {"query": …}, one to a line"#,
            "{problem:?}"
        );
    }

    #[test]
    fn any_line_cut_anywhere_is_explained() {
        let whole =
            r#"{"id":"ü\"[","query":"ray_cast","source":[5e0,-1],"target":{"type":"ball","radius":1e-3}}"#.as_bytes();
        for end in 0..whole.len() {
            let problem = object(&whole[..end]).expect_err("it is cut short");
            assert_eq!(problem.kind, Kind::Parse, "{problem:?}");
            for byte in [0, b',', b'"', b'N', b'{', b']', 0xFF] {
                let mut damaged = whole.to_vec();
                damaged[end] = byte;
                let _ = object(&damaged);
            }
        }
    }
}
