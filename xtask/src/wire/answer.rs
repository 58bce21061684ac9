//! Answers, as they are written.

use convex_support::{Scalar, Vector};
use serde::ser::{Serialize, SerializeMap as _, Serializer};
use serde_json::value::RawValue;

use super::error::Problem;
use super::fields::Object;

/// A number in the precision of the query, printed with the fewest digits that tell it from its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    Single(f32),
    Double(f64),
}

impl Number {
    pub fn of<S: Scalar>(value: S) -> Self {
        if size_of::<S>() == size_of::<f32>() {
            Self::Single(f32::from_f64(value.as_f64()))
        } else {
            Self::Double(value.as_f64())
        }
    }

    fn is_finite(self) -> bool {
        match self {
            Self::Single(value) => value.is_finite(),
            Self::Double(value) => value.is_finite(),
        }
    }
}

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Single(value) => serializer.serialize_f32(value),
            Self::Double(value) => serializer.serialize_f64(value),
        }
    }
}

/// The value of a field.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Field {
    Null,
    Flag(bool),
    Count(usize),
    Text(&'static str),
    Number(Number),
    Numbers(Vec<Number>),
    Rows(Vec<Vec<Number>>),
    Counts(Vec<usize>),
    Pairs(Vec<[usize; 2]>),
    /// Vectors, each with a weight.
    Weighted(Vec<(Vec<Number>, f64)>),
    Answer(Answer),
    Answers(Vec<Answer>),
}

impl Field {
    pub fn number<S: Scalar>(value: S) -> Self {
        Self::Number(Number::of(value))
    }

    pub fn vector<V: Vector>(vector: V) -> Self {
        Self::Numbers(numbers(vector))
    }

    pub fn vectors<V: Vector>(vectors: impl IntoIterator<Item = V>) -> Self {
        Self::Rows(vectors.into_iter().map(numbers).collect())
    }

    pub fn weighted<V: Vector>(items: impl IntoIterator<Item = (V, f64)>) -> Self {
        Self::Weighted(items.into_iter().map(|(v, weight)| (numbers(v), weight)).collect())
    }

    /// The vector, or null.
    pub fn maybe_vector<V: Vector>(vector: Option<V>) -> Self {
        vector.map_or(Self::Null, Self::vector)
    }

    /// Whether JSON can hold it.
    fn is_finite(&self) -> bool {
        match self {
            Self::Number(number) => number.is_finite(),
            Self::Numbers(numbers) => numbers.iter().all(|n| n.is_finite()),
            Self::Rows(rows) => rows.iter().flatten().all(|n| n.is_finite()),
            Self::Weighted(items) => {
                items.iter().all(|(v, weight)| v.iter().all(|n| n.is_finite()) && weight.is_finite())
            }
            Self::Answer(answer) => answer.non_finite().is_none(),
            Self::Answers(answers) => answers.iter().all(|answer| answer.non_finite().is_none()),
            Self::Null | Self::Flag(_) | Self::Count(_) | Self::Text(_) | Self::Counts(_) | Self::Pairs(_) => true,
        }
    }
}

fn numbers<V: Vector>(vector: V) -> Vec<Number> {
    (0..V::DIM).map(|i| Number::of(vector.get(i))).collect()
}

/// The fields of an answer, in the order they are written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer {
    fields: Vec<(&'static str, Field)>,
}

impl Answer {
    pub fn with(mut self, name: &'static str, field: Field) -> Self {
        self.fields.push((name, field));
        self
    }

    /// With the number, where JSON can hold it: the open end of a bracket is left out.
    pub fn with_finite<S: Scalar>(self, name: &'static str, value: S) -> Self {
        if value.is_finite() { self.with(name, Field::number(value)) } else { self }
    }

    /// Whether a hit with these bounds is certain: one of them is infinite where it may be a miss.
    pub fn with_certain<S: Scalar>(self, [lower, upper]: [S; 2]) -> Self {
        self.with("certain", Field::Flag(lower.is_finite() && upper.is_finite()))
    }

    /// The field of this name.
    pub fn field(&self, name: &str) -> Option<&Field> {
        self.fields.iter().find(|(of, _)| *of == name).map(|(_, field)| field)
    }

    /// The first field that JSON cannot hold.
    pub fn non_finite(&self) -> Option<&'static str> {
        self.fields.iter().find(|(_, field)| !field.is_finite()).map(|(name, _)| *name)
    }
}

impl Serialize for Answer {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.fields.iter().map(|(name, field)| (name, field)))
    }
}

/// One line of output.
#[derive(Debug)]
pub struct Line {
    /// What the query calls itself, as it is written; the number of its line otherwise.
    pub id: Option<Box<RawValue>>,
    /// The line in its file, counted from 1.
    pub line: u64,
    pub outcome: Result<Answer, Problem>,
}

impl Serialize for Line {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        match &self.id {
            Some(id) => map.serialize_entry("id", id)?,
            None => map.serialize_entry("id", &self.line)?,
        }
        match &self.outcome {
            Ok(answer) => {
                for (name, field) in &answer.fields {
                    map.serialize_entry(name, field)?;
                }
            }
            Err(problem) => {
                #[derive(serde::Serialize)]
                struct Error<'p> {
                    kind: super::error::Kind,
                    message: &'p str,
                }
                map.serialize_entry("line", &self.line)?;
                map.serialize_entry("error", &Error { kind: problem.kind, message: &problem.message })?;
            }
        }
        map.end()
    }
}

/// The answer as whoever reads the line of output gets it.
#[must_use]
pub fn as_read(line: Line) -> Object {
    serde_json::to_vec(&line).ok().and_then(|text| serde_json::from_slice(&text).ok()).unwrap_or_default()
}
