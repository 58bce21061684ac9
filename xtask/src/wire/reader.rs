//! Reads fields out of JSON, keeping track of where it is and of the dimension of the query.

use std::fmt::Write as _;

use serde_json::{Map, Value};

use super::error::{Kind, Problem};
use super::form;

/// A JSON object.
pub type Object = Map<String, Value>;

/// Up to three coordinates; those beyond the dimension of the query are zero.
pub type Coordinates = [f64; 3];

/// A rotation as written: an angle makes the query 2D, a quaternion 3D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rotation {
    /// Radians, counter-clockwise.
    Angle(f64),
    /// `[x, y, z, w]`, of any length but zero.
    Quaternion([f64; 4]),
}

/// A step from a JSON value to one within it.
#[derive(Clone, Copy, Debug)]
enum Step {
    Key(&'static str),
    Index(usize),
}

/// A walk through one query.
#[derive(Debug, Default)]
pub struct Reader {
    place: Vec<Step>,
    /// The dimension, and the first place that says so.
    dimension: Option<(usize, String)>,
}

impl Reader {
    /// The dimension that the vectors read so far have.
    pub fn dimension(&self) -> Option<usize> {
        self.dimension.as_ref().map(|(dimension, _)| *dimension)
    }

    /// Where the walk is, as in `target.of.points[3]`.
    pub fn place(&self) -> String {
        let mut text = String::new();
        for step in &self.place {
            match step {
                Step::Key(key) if text.is_empty() => text.push_str(key),
                Step::Key(key) => {
                    let _ = write!(text, ".{key}");
                }
                Step::Index(index) => {
                    let _ = write!(text, "[{index}]");
                }
            }
        }
        text
    }

    /// A problem at the present place.
    pub fn problem(&self, kind: Kind, message: impl AsRef<str>) -> Problem {
        let (place, message) = (self.place(), message.as_ref());
        if place.is_empty() { Problem::new(kind, message) } else { Problem::new(kind, format!("{place} {message}")) }
    }

    fn inside<T>(&mut self, step: Step, read: impl FnOnce(&mut Self) -> Result<T, Problem>) -> Result<T, Problem> {
        self.place.push(step);
        let result = read(self);
        self.place.pop();
        result
    }

    /// The field `key`, which must be there.
    pub fn required<T>(
        &mut self,
        object: &Object,
        key: &'static str,
        read: impl FnOnce(&mut Self, &Value) -> Result<T, Problem>,
    ) -> Result<T, Problem> {
        match object.get(key) {
            Some(value) => self.inside(Step::Key(key), |reader| read(reader, value)),
            None => {
                let of = self.place();
                let of = if of.is_empty() { String::new() } else { format!(" of {of}") };
                let form = form::missing(object, key);
                Err(Problem::new(Kind::Parse, format!("the field \"{key}\"{of} is missing{form}")))
            }
        }
    }

    /// The field `key`, if it is there.
    pub fn optional<T>(
        &mut self,
        object: &Object,
        key: &'static str,
        read: impl FnOnce(&mut Self, &Value) -> Result<T, Problem>,
    ) -> Result<Option<T>, Problem> {
        object.get(key).map(|value| self.inside(Step::Key(key), |reader| read(reader, value))).transpose()
    }

    /// Every item of a list.
    pub fn list<T>(
        &mut self,
        value: &Value,
        read: impl FnMut(&mut Self, &Value) -> Result<T, Problem>,
    ) -> Result<Vec<T>, Problem> {
        self.list_called("a list", value, read)
    }

    /// Every item of a list that is called `what` where it is missing.
    fn list_called<T>(
        &mut self,
        what: &str,
        value: &Value,
        mut read: impl FnMut(&mut Self, &Value) -> Result<T, Problem>,
    ) -> Result<Vec<T>, Problem> {
        let Some(items) = value.as_array() else { return Err(self.expected(what, value)) };
        items.iter().enumerate().map(|(i, item)| self.inside(Step::Index(i), |reader| read(reader, item))).collect()
    }

    pub fn object<'v>(&self, value: &'v Value) -> Result<&'v Object, Problem> {
        value.as_object().ok_or_else(|| self.expected("an object", value))
    }

    pub fn text(&mut self, value: &Value) -> Result<String, Problem> {
        value.as_str().map(str::to_owned).ok_or_else(|| self.expected("a string", value))
    }

    pub fn flag(&mut self, value: &Value) -> Result<bool, Problem> {
        value.as_bool().ok_or_else(|| self.expected("true or false", value))
    }

    pub fn number(&mut self, value: &Value) -> Result<f64, Problem> {
        match value.as_f64() {
            Some(number) if number.is_finite() => Ok(number),
            Some(_) => Err(self.problem(Kind::NonFinite, "is too large for a double")),
            None => Err(self.expected("a number", value)),
        }
    }

    /// A number that must be greater than zero.
    pub fn positive(&mut self, value: &Value) -> Result<f64, Problem> {
        let number = self.number(value)?;
        if number > 0.0 {
            Ok(number)
        } else {
            Err(self.problem(Kind::Parse, format!("is {number}, but must be greater than zero")))
        }
    }

    /// A list of numbers of any length.
    pub fn numbers(&mut self, value: &Value) -> Result<Vec<f64>, Problem> {
        self.list_called("a vector, a list of numbers", value, Self::number)
    }

    /// A vector of the space of the query.
    pub fn vector(&mut self, value: &Value) -> Result<Coordinates, Problem> {
        let numbers = self.numbers(value)?;
        self.found_dimension(numbers.len(), "coordinates")?;
        let mut coordinates = [0.0; 3];
        coordinates[..numbers.len()].copy_from_slice(&numbers);
        Ok(coordinates)
    }

    /// A square matrix of the space of the query, as a list of rows.
    pub fn matrix(&mut self, value: &Value) -> Result<[Coordinates; 3], Problem> {
        let rows = self.list_called("a matrix, a list of rows", value, Self::vector)?;
        self.found_dimension(rows.len(), "rows")?;
        let mut matrix = [[0.0; 3]; 3];
        matrix[..rows.len()].copy_from_slice(&rows);
        Ok(matrix)
    }

    /// A rotation: a number in 2D, four numbers in 3D.
    pub fn rotation(&mut self, value: &Value) -> Result<Rotation, Problem> {
        if value.is_array() {
            let numbers = self.numbers(value)?;
            let quaternion: [f64; 4] = numbers.try_into().map_err(|numbers: Vec<f64>| {
                let found = numbers.len();
                self.problem(
                    Kind::DimensionMismatch,
                    format!("has {found} numbers, but a quaternion [x, y, z, w] has 4"),
                )
            })?;
            self.is_of_dimension(3, "is a quaternion, which is 3D")?;
            Ok(Rotation::Quaternion(quaternion))
        } else if value.is_number() {
            let angle = self.number(value)?;
            self.is_of_dimension(2, "is an angle, which is 2D")?;
            Ok(Rotation::Angle(angle))
        } else {
            Err(self.expected("an angle or a quaternion [x, y, z, w]", value))
        }
    }

    /// Notes that the present place has `count` of something that a space has as many of as dimensions.
    pub fn found_dimension(&mut self, count: usize, of: &str) -> Result<(), Problem> {
        if !matches!(count, 2 | 3) {
            let one = if count == 1 { of.trim_end_matches('s') } else { of };
            return Err(self.problem(Kind::DimensionMismatch, format!("has {count} {one}, but a space has 2 or 3")));
        }
        self.is_of_dimension(count, &format!("has {count} {of}"))
    }

    /// Notes that what is at the present place belongs to a space of this dimension.
    pub fn is_of_dimension(&mut self, dimension: usize, because: &str) -> Result<(), Problem> {
        match &self.dimension {
            Some((known, _)) if *known == dimension => Ok(()),
            Some((known, place)) => {
                Err(self.problem(Kind::DimensionMismatch, format!("{because}, but {place} makes the query {known}D")))
            }
            None => {
                self.dimension = Some((dimension, self.place()));
                Ok(())
            }
        }
    }

    /// `value` is not what it should be.
    pub fn expected(&self, what: &str, value: &Value) -> Problem {
        let found = match value {
            Value::Null => "null".to_owned(),
            Value::Bool(flag) => flag.to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(text) if text.len() <= 40 => format!("{text:?}"),
            Value::String(_) => "a string".to_owned(),
            Value::Array(items) if items.is_empty() => "an empty list".to_owned(),
            Value::Array(_) => "a list".to_owned(),
            Value::Object(_) => "an object".to_owned(),
        };
        self.problem(Kind::Parse, format!("must be {what}, but is {found}"))
    }
}
