//! Queries as written.

use std::path::PathBuf;

use serde_json::Value;

use super::error::{Kind, Problem};
use super::form;
use super::reader::{Coordinates, Object, Reader, Rotation};
use super::shape::{EllipsoidSpec, Shape};

/// The precision to answer in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    F32,
    F64,
}

/// A query and what all queries have in common.
#[derive(Debug)]
pub struct Request {
    pub precision: Precision,
    /// The dimension of the space, 2 or 3; 3 where nothing in the query says. Ellipsoid fits have their own.
    pub dimension: usize,
    pub tol: Option<f64>,
    pub method: Option<String>,
    pub query: Query,
}

/// The nine questions.
#[derive(Debug)]
pub enum Query {
    RayCast { target: Shape, source: Coordinates, direction: Coordinates, max_lambda: Option<f64> },
    Distance { a: Shape, b: Shape },
    Intersect { a: Shape, b: Shape },
    LinearCast { a: Shape, b: Shape, velocity_a: Coordinates, velocity_b: Coordinates, max_time: Option<f64> },
    EnclosingEllipsoid { points: Points, epsilon: Option<f64> },
    InscribedEllipsoid { body: Body, epsilon: Option<f64> },
    Margin { e1: EllipsoidSpec, e2: EllipsoidSpec, gradient: bool },
    Track { e1: EllipsoidSpec, e2: EllipsoidSpec, poses: Vec<Pose> },
    Clearance { links: Vec<EllipsoidSpec>, obstacles: Vec<EllipsoidSpec> },
}

/// Points of any dimension.
#[derive(Debug)]
pub enum Points {
    /// As a list, all of the same length.
    Listed(Vec<Vec<f64>>),
    /// The vertices of a mesh.
    Mesh(PathBuf),
}

/// What to inscribe an ellipsoid in.
#[derive(Debug)]
pub enum Body {
    /// The hull of points.
    Points(Points),
    /// The intersection of half-spaces, all of the same dimension.
    HalfSpaces(Vec<HalfSpace>),
}

/// `normal·x ≤ offset`.
#[derive(Clone, Debug)]
pub struct HalfSpace {
    pub normal: Vec<f64>,
    pub offset: f64,
}

/// Where a body is.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    pub translation: Coordinates,
    pub rotation: Option<Rotation>,
}

impl Request {
    /// The query in a JSON object.
    pub fn read(object: &Object) -> Result<Self, Problem> {
        let reader = &mut Reader::default();
        let name = reader.required(object, "query", Reader::text)?;
        let precision = reader.optional(object, "precision", |r, v| match r.text(v)?.as_str() {
            "f64" => Ok(Precision::F64),
            "f32" => Ok(Precision::F32),
            _ => Err(r.expected("\"f64\" or \"f32\"", v)),
        })?;
        let tol = reader.optional(object, "tol", Reader::positive)?;
        let method = reader.optional(object, "method", Reader::text)?;
        let epsilon = |r: &mut Reader| r.optional(object, "epsilon", Reader::positive);
        let query = match name.as_str() {
            "ray_cast" => Query::RayCast {
                target: reader.required(object, "target", Shape::read)?,
                source: reader.required(object, "source", Reader::vector)?,
                direction: reader.required(object, "direction", Reader::vector)?,
                max_lambda: reader.optional(object, "max_lambda", Reader::number)?,
            },
            "distance" => Query::Distance {
                a: reader.required(object, "a", Shape::read)?,
                b: reader.required(object, "b", Shape::read)?,
            },
            "intersect" => Query::Intersect {
                a: reader.required(object, "a", Shape::read)?,
                b: reader.required(object, "b", Shape::read)?,
            },
            "linear_cast" => Query::LinearCast {
                a: reader.required(object, "a", Shape::read)?,
                b: reader.required(object, "b", Shape::read)?,
                velocity_a: reader.optional(object, "velocity_a", Reader::vector)?.unwrap_or_default(),
                velocity_b: reader.optional(object, "velocity_b", Reader::vector)?.unwrap_or_default(),
                max_time: reader.optional(object, "max_time", Reader::number)?,
            },
            "enclosing_ellipsoid" => {
                Query::EnclosingEllipsoid { points: Points::read(reader, object)?, epsilon: epsilon(reader)? }
            }
            "inscribed_ellipsoid" => {
                Query::InscribedEllipsoid { body: Body::read(reader, object)?, epsilon: epsilon(reader)? }
            }
            "margin" => Query::Margin {
                e1: reader.required(object, "e1", EllipsoidSpec::read)?,
                e2: reader.required(object, "e2", EllipsoidSpec::read)?,
                gradient: reader.optional(object, "gradient", Reader::flag)?.unwrap_or(false),
            },
            "track" => Query::Track {
                e1: reader.required(object, "e1", EllipsoidSpec::read)?,
                e2: reader.required(object, "e2", EllipsoidSpec::read)?,
                poses: reader.required(object, "poses", |r, v| r.list(v, Pose::read))?,
            },
            "clearance" => Query::Clearance {
                links: reader.required(object, "links", |r, v| r.list(v, EllipsoidSpec::read))?,
                obstacles: reader.required(object, "obstacles", |r, v| r.list(v, EllipsoidSpec::read))?,
            },
            _ => {
                let message =
                    format!("the query {name:?} is unknown; {}", form::known(&name, form::QUERIES, "queries"));
                return Err(Problem::new(Kind::UnknownQuery, message));
            }
        };
        Ok(Self {
            precision: precision.unwrap_or(Precision::F64),
            dimension: reader.dimension().unwrap_or(3),
            tol,
            method,
            query,
        })
    }
}

impl Pose {
    fn read(reader: &mut Reader, value: &Value) -> Result<Self, Problem> {
        let object = reader.object(value)?;
        Ok(Self {
            translation: reader.optional(object, "translation", Reader::vector)?.unwrap_or_default(),
            rotation: reader.optional(object, "rotation", Reader::rotation)?,
        })
    }
}

impl Points {
    fn read(reader: &mut Reader, object: &Object) -> Result<Self, Problem> {
        if object.contains_key("points") || !object.contains_key("target") {
            return Ok(Self::Listed(reader.required(object, "points", Self::list)?));
        }
        reader.required(object, "target", |reader, value| {
            let target = reader.object(value)?;
            match target.get("type").and_then(Value::as_str) {
                // Read here rather than as a shape: these points may have any number of coordinates.
                Some("polytope") => Ok(Self::Listed(reader.required(target, "points", Self::list)?)),
                Some("mesh") => Ok(Self::Mesh(reader.required(target, "path", Reader::text)?.into())),
                _ => match Shape::read(reader, value) {
                    Err(problem) if problem.kind == Kind::UnknownShape => Err(problem),
                    _ => Err(reader.problem(Kind::InvalidShape, "must be a polytope or a mesh")),
                },
            }
        })
    }

    /// Points of one length, 2 or more.
    fn list(reader: &mut Reader, value: &Value) -> Result<Vec<Vec<f64>>, Problem> {
        let points = reader.list(value, Reader::numbers)?;
        same_length(reader, points.iter().map(Vec::len), "")?;
        Ok(points)
    }
}

impl Body {
    fn read(reader: &mut Reader, object: &Object) -> Result<Self, Problem> {
        if !object.contains_key("halfspaces") {
            return Points::read(reader, object).map(Self::Points);
        }
        let halfspaces = reader.required(object, "halfspaces", |reader, value| {
            let halfspaces = reader.list(value, |reader, value| {
                let object = reader.object(value)?;
                Ok(HalfSpace {
                    normal: reader.required(object, "normal", Reader::numbers)?,
                    offset: reader.required(object, "offset", Reader::number)?,
                })
            })?;
            same_length(reader, halfspaces.iter().map(|h| h.normal.len()), ".normal")?;
            Ok(halfspaces)
        })?;
        Ok(Self::HalfSpaces(halfspaces))
    }
}

/// Checks that a list of vectors is of one dimension.
fn same_length(reader: &Reader, lengths: impl Iterator<Item = usize>, field: &str) -> Result<(), Problem> {
    let mut first = None;
    for (i, length) in lengths.enumerate() {
        let first = *first.get_or_insert(length);
        if length != first || length < 2 {
            let list = reader.place();
            let due =
                if length < 2 { "a space has 2 or more".to_owned() } else { format!("{list}[0]{field} has {first}") };
            let s = if length == 1 { "" } else { "s" };
            let message = format!("{list}[{i}]{field} has {length} coordinate{s}, but {due}");
            return Err(Problem::new(Kind::DimensionMismatch, message));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::json::object;
    use super::*;

    #[test]
    fn the_first_vector_decides_the_dimension_and_the_second_is_blamed() {
        let text = br#"{"query":"ray_cast","target":{"type":"cuboid","half_extents":[1,1,1]},"source":[5,0],"direction":[1,0]}"#;
        let problem = Request::read(&object(text).expect("JSON")).expect_err("2D and 3D");
        assert_eq!(problem.kind, Kind::DimensionMismatch, "{problem:?}");
        assert_eq!(problem.message, "source has 2 coordinates, but target.half_extents makes the query 3D");
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place_and_what_would_be_right() {
        let cast_at =
            |shape: &str| format!(r#"{{"query":"ray_cast","target":{shape},"source":[5,0,0],"direction":[-1,0,0]}}"#);
        let cases = [
            (
                r#"{"query":"ray_cast","target":{"type":"ball","radius":1},"sourc":[5,0,0],"direction":[-1,0,0]}"#
                    .to_owned(),
                "the field \"source\" is missing (is \"sourc\" meant for it?); a ray_cast has \"target\": SHAPE, \"source\": \
                 VECTOR, \"direction\": VECTOR, and if wanted \"max_lambda\": NUMBER",
            ),
            (
                r#"{"query":"distance","a":{"type":"ball","radius":1}}"#.to_owned(),
                "the field \"b\" is missing; a distance has \"a\": SHAPE, \"b\": SHAPE",
            ),
            (
                cast_at(r#"{"type":"ball","r":1}"#),
                "the field \"radius\" of target is missing; a ball has \"radius\": NUMBER",
            ),
            (
                cast_at(r#"{"type":"hull","of":[{"type":"ball","radius":[1]}]}"#),
                "target.of[0].radius must be a number, but is a list",
            ),
            (
                cast_at(r#"{"type":"cuboid","half_extents":1}"#),
                "target.half_extents must be a vector, a list of numbers, but is 1",
            ),
            (
                cast_at(r#"{"type":"polytope","points":[[0,0,0],[1,0]]}"#),
                "target.points[1] has 2 coordinates, but target.points[0] makes the query 3D",
            ),
            (
                r#"{"query":"inscribed_ellipsoid","halfspaces":[{"normal":[1,0]}]}"#.to_owned(),
                "the field \"offset\" of halfspaces[0] is missing; a half-space has \"normal\": VECTOR, \"offset\": NUMBER",
            ),
        ];
        for (line, message) in cases {
            let problem = Request::read(&object(line.as_bytes()).expect("JSON")).expect_err("it cannot be asked");
            assert_eq!(problem.message, message, "{line}");
        }
    }
}
