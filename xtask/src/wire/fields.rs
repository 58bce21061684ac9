//! The fields of a JSON object, read by serde, with the place of whatever is wrong and the dimension of the query.
//!
//! A field that nobody reads would change nothing and say nothing: a misspelt `max_time` would be an answer about all
//! time. So the object of a query is [`Written`] until its reader says which [`Fields`] it may have, and any other is
//! an error.

use std::cell::OnceCell;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

use super::error::{Kind, Problem};
use super::names::{self, Names, Table};

/// A JSON object.
pub type Object = Map<String, Value>;

/// Up to three coordinates; those beyond the dimension of the query are zero.
pub type Coordinates = [f64; 3];

/// A rotation as written: an angle makes the query 2D, a quaternion 3D.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged, expecting = "expected an angle or a quaternion [x, y, z, w]")]
pub enum Rotation {
    /// Radians, counter-clockwise.
    Angle(f64),
    /// `[x, y, z, w]`, of any length but zero.
    Quaternion(Vec<f64>),
}

/// An angular velocity as written: a number makes the query 2D, a vector 3D.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AngularVelocity {
    /// Radians per unit of time, counter-clockwise.
    Rate(f64),
    /// Along the axis, as long as the rate.
    Vector(Coordinates),
}

/// The dimension of a query, and the first place that says so.
#[derive(Debug, Default)]
pub struct Dimension(OnceCell<(usize, String)>);

impl Dimension {
    /// The dimension that the vectors read so far have.
    #[must_use]
    pub fn known(&self) -> Option<usize> {
        self.0.get().map(|(dimension, _)| *dimension)
    }

    /// Notes that what is at `place` belongs to a space of this dimension, and why it does.
    fn note(&self, dimension: usize, place: &str, because: &str) -> Result<(), Problem> {
        let (known, first) = self.0.get_or_init(|| (dimension, place.to_owned()));
        if *known == dimension {
            return Ok(());
        }
        let message = format!("{place} {because}, but {first} makes the query {known}D");
        Err(Problem::new(Kind::DimensionMismatch, message))
    }

    /// Notes that the list at `place` has as many items as the space has dimensions.
    fn count(&self, count: usize, place: &str, items: &str) -> Result<(), Problem> {
        if !matches!(count, 2 | 3) {
            let message = format!("{place} has {count} {items}, but a space has 2 or 3");
            return Err(Problem::new(Kind::DimensionMismatch, message));
        }
        self.note(count, place, &format!("has {count} {items}"))
    }

    /// The vector at `place`.
    fn vector(&self, numbers: &[f64], place: &str) -> Result<Coordinates, Problem> {
        self.count(numbers.len(), place, "coordinates")?;
        let mut coordinates = [0.0; 3];
        coordinates[..numbers.len()].copy_from_slice(numbers);
        Ok(coordinates)
    }

    fn vectors(&self, lists: &[Vec<f64>], place: &str) -> Result<Vec<Coordinates>, Problem> {
        lists.iter().enumerate().map(|(i, numbers)| self.vector(numbers, &format!("{place}[{i}]"))).collect()
    }
}

/// An object of the query, and where it is, before it is known which fields it may have.
#[derive(Clone, Debug)]
pub struct Written<'v> {
    object: &'v Object,
    /// As in `target.of[1]`; empty for the query itself.
    place: String,
    dimension: &'v Dimension,
}

/// An object of the query that has no fields but the known ones.
#[derive(Clone, Debug)]
pub struct Fields<'v> {
    written: Written<'v>,
    known: [Names; 2],
}

/// Whether a field only describes what it stands in.
fn is_remark(key: &str) -> bool {
    key.starts_with('_') || key == "book"
}

/// The value at `place` as a `T`.
fn typed<T: DeserializeOwned>(value: &Value, place: &str) -> Result<T, Problem> {
    serde_path_to_error::deserialize(value).map_err(|why| {
        let within = why.path().to_string();
        let place = match within.as_str() {
            "." => place.to_owned(),
            item if item.starts_with('[') => format!("{place}{item}"),
            field => format!("{place}.{field}"),
        };
        Problem::new(Kind::Parse, format!("{place}: {}", why.into_inner()))
    })
}

impl<'v> Written<'v> {
    /// A query.
    #[must_use]
    pub fn new(object: &'v Object, dimension: &'v Dimension) -> Self {
        Self { object, place: String::new(), dimension }
    }

    /// Where the object is, as in `target.of[1]`.
    #[must_use]
    pub fn place(&self) -> &str {
        &self.place
    }

    /// Where a field is.
    fn at(&self, key: &str) -> String {
        if self.place.is_empty() { key.to_owned() } else { format!("{}.{key}", self.place) }
    }

    /// A field, as errors call it.
    fn field(&self, key: &str) -> String {
        let of = if self.place.is_empty() { String::new() } else { format!(" of {}", self.place) };
        format!("the field {key:?}{of}")
    }

    fn value(&self, key: &str) -> Result<&'v Value, Problem> {
        let missing = || Problem::new(Kind::Parse, format!("{} is missing", self.field(key)));
        self.object.get(key).ok_or_else(missing)
    }

    /// What the name in a field stands for; an error of this `kind` where the table does not have it.
    pub fn named<T>(&self, key: &str, table: impl Table<T>, kind: Kind) -> Result<T, Problem> {
        let place = self.at(key);
        let name: String = typed(self.value(key)?, &place)?;
        names::choose(&name, table).map_err(|unknown| Problem::new(kind, format!("{place}: {unknown}")))
    }

    /// Its fields, which are among those that `every` such object has and its `own`.
    ///
    /// # Errors
    /// [`Kind::UnknownField`] where one is not.
    pub fn fields(self, every: Names, own: Names) -> Result<Fields<'v>, Problem> {
        let known = || every.iter().chain(own).copied();
        match self.object.keys().find(|key| !is_remark(key) && !known().any(|name| name == *key)) {
            None => Ok(Fields { written: self, known: [every, own] }),
            Some(unknown) => {
                let message = format!("{} is unknown{}", self.field(unknown), names::instead_of(unknown, known()));
                Err(Problem::new(Kind::UnknownField, message))
            }
        }
    }
}

impl<'v> Fields<'v> {
    /// Where the object is, as in `target.of[1]`.
    #[must_use]
    pub fn place(&self) -> &str {
        self.written.place()
    }

    /// Where a field is.
    #[must_use]
    pub fn at(&self, key: &str) -> String {
        self.written.at(key)
    }

    /// The object, once it is known which of its fields go together.
    pub fn only(&self, every: Names, own: Names) -> Result<Self, Problem> {
        self.written.clone().fields(every, own)
    }

    /// Checks that a reader reads nothing that would be refused.
    fn check(&self, key: &str) {
        debug_assert!(self.known.iter().any(|names| names.contains(&key)), "{key} is read, but no known field");
    }

    #[must_use]
    pub fn has(&self, key: &str) -> bool {
        self.check(key);
        self.written.object.contains_key(key)
    }

    fn value(&self, key: &str) -> Result<&'v Value, Problem> {
        self.check(key);
        self.written.value(key)
    }

    /// A field that must be there.
    pub fn get<T: DeserializeOwned>(&self, key: &str) -> Result<T, Problem> {
        typed(self.value(key)?, &self.at(key))
    }

    /// A field that may be left out; null is no value.
    pub fn maybe<T: DeserializeOwned>(&self, key: &str) -> Result<Option<T>, Problem> {
        if self.has(key) { self.get(key).map(Some) } else { Ok(None) }
    }

    /// Whether an option is on that may be left out.
    pub fn flag(&self, key: &str) -> Result<bool, Problem> {
        Ok(self.maybe(key)?.unwrap_or(false))
    }

    /// What the name in a field stands for; the default where it is left out.
    pub fn named_or_default<T: Default>(&self, key: &str, table: impl Table<T>) -> Result<T, Problem> {
        if self.has(key) { self.written.named(key, table, Kind::Parse) } else { Ok(T::default()) }
    }

    /// The one field of these that there is.
    pub fn only_one_of(&self, keys: Names) -> Result<&'static str, Problem> {
        let found: Vec<_> = keys.iter().copied().filter(|key| self.has(key)).collect();
        let [key] = found[..] else {
            let subject = if self.place().is_empty() { "the query" } else { self.place() };
            return Err(Problem::new(Kind::Parse, format!("{subject} must have exactly one of {}", keys.join(", "))));
        };
        Ok(key)
    }

    /// A number that must be greater than zero, if it is there.
    pub fn positive(&self, key: &str) -> Result<Option<f64>, Problem> {
        match self.maybe(key)? {
            Some(number) if number <= 0.0 => {
                let message = format!("{} is {number}, but must be greater than zero", self.at(key));
                Err(Problem::new(Kind::Parse, message))
            }
            number => Ok(number),
        }
    }

    /// The same of one that must be there.
    pub fn above_zero(&self, key: &str) -> Result<f64, Problem> {
        let number = self.get(key)?;
        Ok(self.positive(key)?.unwrap_or(number))
    }

    /// A number that must not be less than zero, if it is there.
    pub fn not_negative(&self, key: &str) -> Result<Option<f64>, Problem> {
        match self.maybe(key)? {
            Some(number) if number < 0.0 => {
                let message = format!("{} is {number}, but must not be negative", self.at(key));
                Err(Problem::new(Kind::Parse, message))
            }
            number => Ok(number),
        }
    }

    /// The object that a field is.
    pub fn within(&self, key: &str) -> Result<Written<'v>, Problem> {
        self.of(self.value(key)?, self.at(key))
    }

    /// The objects that a field lists.
    pub fn each(&self, key: &str) -> Result<Vec<Written<'v>>, Problem> {
        let Some(items) = self.value(key)?.as_array() else {
            return Err(Problem::new(Kind::Parse, format!("{}: expected a list of objects", self.at(key))));
        };
        items.iter().enumerate().map(|(i, item)| self.of(item, format!("{}[{i}]", self.at(key)))).collect()
    }

    fn of(&self, value: &'v Value, place: String) -> Result<Written<'v>, Problem> {
        match value {
            Value::Object(object) => Ok(Written { object, place, dimension: self.written.dimension }),
            _ => Err(Problem::new(Kind::Parse, format!("{place}: expected an object, but it is {value:.40}"))),
        }
    }

    /// A vector of the space of the query.
    pub fn vector(&self, key: &str) -> Result<Coordinates, Problem> {
        self.written.dimension.vector(&self.get::<Vec<f64>>(key)?, &self.at(key))
    }

    /// The same, zero where it is left out.
    pub fn vector_or_zero(&self, key: &str) -> Result<Coordinates, Problem> {
        if self.has(key) { self.vector(key) } else { Ok([0.0; 3]) }
    }

    /// Vectors of the space of the query.
    pub fn vectors(&self, key: &str) -> Result<Vec<Coordinates>, Problem> {
        self.written.dimension.vectors(&self.get::<Vec<Vec<f64>>>(key)?, &self.at(key))
    }

    /// So many vectors.
    pub fn corners<const N: usize>(&self, key: &str) -> Result<[Coordinates; N], Problem> {
        let points = self.vectors(key)?;
        let count = points.len();
        points.try_into().map_err(|_| {
            Problem::new(Kind::InvalidShape, format!("{} must be {N} points, but there are {count}", self.at(key)))
        })
    }

    /// A square matrix of the space of the query, as a list of rows.
    pub fn matrix(&self, key: &str) -> Result<[Coordinates; 3], Problem> {
        let rows = self.vectors(key)?;
        self.written.dimension.count(rows.len(), &self.at(key), "rows")?;
        let mut matrix = [[0.0; 3]; 3];
        matrix[..rows.len()].copy_from_slice(&rows);
        Ok(matrix)
    }

    /// A rotation of the space of the query, if it is there.
    pub fn rotation(&self, key: &str) -> Result<Option<Rotation>, Problem> {
        let rotation = self.maybe(key)?;
        let place = self.at(key);
        match &rotation {
            None => {}
            Some(Rotation::Angle(_)) => self.written.dimension.note(2, &place, "is an angle, which is 2D")?,
            Some(Rotation::Quaternion(numbers)) if numbers.len() == 4 => {
                self.written.dimension.note(3, &place, "is a quaternion, which is 3D")?;
            }
            Some(Rotation::Quaternion(numbers)) => {
                let message = format!("{place} has {} numbers, but a quaternion [x, y, z, w] has 4", numbers.len());
                return Err(Problem::new(Kind::DimensionMismatch, message));
            }
        }
        Ok(rotation)
    }

    /// An angular velocity of the space of the query, if it is there.
    pub fn angular_velocity(&self, key: &str) -> Result<Option<AngularVelocity>, Problem> {
        let place = self.at(key);
        if !self.has(key) {
            return Ok(None);
        }
        match self.value(key)? {
            Value::Array(_) => {
                let numbers: Vec<f64> = self.get(key)?;
                if numbers.len() != 3 {
                    let count = numbers.len();
                    let message = format!("{place} has {count} coordinates, but is a number in 2D and has 3 in 3D");
                    return Err(Problem::new(Kind::DimensionMismatch, message));
                }
                Ok(Some(AngularVelocity::Vector(self.written.dimension.vector(&numbers, &place)?)))
            }
            _ => {
                let rate = self.get(key)?;
                self.written.dimension.note(2, &place, "is a number, which is 2D")?;
                Ok(Some(AngularVelocity::Rate(rate)))
            }
        }
    }

    /// Notes that the object is 3D, being what it is.
    pub fn is_3d(&self, what: &str) -> Result<(), Problem> {
        self.written.dimension.note(3, self.place(), &format!("is a {what}, which is 3D"))
    }
}
