//! From a query to its answer: the one place where precision and dimension become types.

mod cast;
mod clearance;
mod contact;
mod distance;
mod enclosing;
mod fit;
mod inscribed;
mod intersect;
mod linear_cast;
mod margin;
mod method;
mod motion_cast;
mod ray_cast;
mod signed_distance;
mod track;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};
use convex_support::{Scalar as _, Vector};
use cpu_time::ThreadTime;
use serde::Deserialize;

use self::clearance::Clearance;
use self::contact::Contact;
use self::distance::Distance;
use self::enclosing::Enclosing;
use self::inscribed::Inscribed;
use self::intersect::Intersect;
use self::linear_cast::LinearCast;
use self::margin::Margin;
use self::motion_cast::MotionCast;
use self::ray_cast::RayCast;
use self::signed_distance::SignedDistance;
use self::track::Track;
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Dimension, Fields, Object};
use crate::wire::shape::Space;

/// A query with its shapes built, ready to be solved.
trait Question {
    type Solution;

    /// Solves it: all that a user of the crate would call, and nothing else.
    fn solve(&self) -> Result<Self::Solution, Problem>;

    /// What the format says of the solution.
    fn answer(&self, solution: Self::Solution) -> Result<Answer, Problem>;
}

/// Any question.
pub trait Ask {
    /// Solves the question once.
    fn ask(&self) -> Result<Answer, Problem>;

    /// Nanoseconds of thread CPU time that solving it takes: the least mean of three runs of about `microseconds` each.
    fn time(&self, microseconds: u64) -> f64;
}

impl<Q: Question> Ask for Q {
    fn ask(&self) -> Result<Answer, Problem> {
        let answer = self.answer(self.solve()?)?;
        match answer.non_finite() {
            Some(field) => {
                Err(Problem::new(Kind::NotConverged, format!("{field} is out of the range of the precision")))
            }
            None => Ok(answer),
        }
    }

    fn time(&self, microseconds: u64) -> f64 {
        let run = |count: u64| {
            let start = ThreadTime::now();
            for _ in 0..count {
                let _ = std::hint::black_box(self.solve());
            }
            start.elapsed().as_nanos() as f64 / count as f64
        };
        let once = run(1).max(1.0);
        let count = ((microseconds * 1000) as f64 / once).ceil().max(1.0) as u64;
        (0..3).map(|_| run(count)).fold(once, f64::min)
    }
}

/// The kinds of queries, as written; a file each.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Name {
    RayCast,
    Distance,
    SignedDistance,
    Contact,
    Intersect,
    LinearCast,
    MotionCast,
    EnclosingEllipsoid,
    InscribedEllipsoid,
    Margin,
    Track,
    Clearance,
}

/// The question that a JSON object asks.
///
/// # Errors
/// Where it asks none.
pub fn question(object: &Object, meshes: &Meshes) -> Result<Box<dyn Ask>, Problem> {
    let dimension = Dimension::default();
    let fields = Fields::new(object, &dimension);
    let ask = match fields.name("query", Kind::UnknownQuery)? {
        Name::RayCast => read::<RayCast>,
        Name::Distance => read::<Distance>,
        Name::SignedDistance => read::<SignedDistance>,
        Name::Contact => read::<Contact>,
        Name::Intersect => read::<Intersect>,
        Name::LinearCast => read::<LinearCast>,
        Name::MotionCast => read::<MotionCast>,
        Name::EnclosingEllipsoid => read::<Enclosing>,
        Name::InscribedEllipsoid => read::<Inscribed>,
        Name::Margin => read::<Margin>,
        Name::Track => read::<Track>,
        Name::Clearance => read::<Clearance>,
    };
    ask(&fields, &dimension, meshes)
}

/// The precision to answer in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Precision {
    F32,
    #[default]
    F64,
}

/// How a query is to be answered, whatever it asks.
struct How<'a> {
    precision: Precision,
    tol: Option<f64>,
    method: Option<String>,
    meshes: &'a Meshes,
}

/// A kind of query.
trait Query: Sized {
    /// Its own fields, as written.
    fn read(fields: &Fields<'_>) -> Result<Self, Problem>;

    /// The question in a space.
    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem>;
}

/// Reads a query. Its vectors say which dimension it has; 3 where there are none.
fn read<Q: Query>(fields: &Fields<'_>, dimension: &Dimension, meshes: &Meshes) -> Result<Box<dyn Ask>, Problem> {
    let precision = fields.maybe("precision")?.unwrap_or_default();
    let how = How { precision, tol: fields.positive("tol")?, method: fields.maybe("method")?, meshes };
    let query = Q::read(fields)?;
    match (precision, dimension.known().unwrap_or(3)) {
        (Precision::F64, 2) => query.question::<DVec2>(&how),
        (Precision::F64, _) => query.question::<DVec3>(&how),
        (Precision::F32, 2) => query.question::<Vec2>(&how),
        (Precision::F32, _) => query.question::<Vec3A>(&how),
    }
}

impl How<'_> {
    /// The variant of the algorithm that is asked for; the first where none is.
    fn method<M: Copy>(&self, methods: &[(&str, M)]) -> Result<M, Problem> {
        method::choose(self.method.as_deref(), methods)
    }

    /// The relative tolerance in a precision, if one is asked for.
    fn tolerance<V: Vector>(&self) -> Result<Option<V::Scalar>, Problem> {
        match self.tol {
            Some(tol) if tol >= 1.0 => {
                Err(Problem::new(Kind::Parse, format!("tol is {tol}, but a relative tolerance is less than 1")))
            }
            tol => Ok(tol.map(scalar::<V>)),
        }
    }
}

/// A number of the query in the precision asked for.
fn scalar<V: Vector>(value: f64) -> V::Scalar {
    V::Scalar::from_f64(value)
}

/// How an iteration of gjk-raycast ended.
fn status(status: gjk_raycast::Status) -> Field {
    Field::Text(match status {
        gjk_raycast::Status::Converged => "converged",
        gjk_raycast::Status::IterationLimit => "iteration_limit",
        gjk_raycast::Status::Stalled => "stalled",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::json;

    /// What is said of a line that cannot be answered.
    fn refused(line: &str) -> Problem {
        let object = json::object(line.as_bytes()).expect("JSON");
        question(&object, &Meshes::relative_to("")).err().expect("it cannot be asked")
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place_and_what_would_be_right() {
        let cast_at =
            |shape: &str| format!(r#"{{"query":"ray_cast","target":{shape},"source":[5,0,0],"direction":[-1,0,0]}}"#);
        let cases = [
            (r#"{"query":"distance","a":{"type":"ball","radius":1}}"#.to_owned(), Kind::Parse, "the field \"b\" is missing"),
            (cast_at(r#"{"type":"ball"}"#), Kind::Parse, "the field \"radius\" of target is missing"),
            (
                cast_at(r#"{"type":"hull","of":[{"type":"ball","radius":[1]}]}"#),
                Kind::Parse,
                "target.of[0].radius: invalid type: sequence, expected f64",
            ),
            (cast_at(r#"{"type":"ball","radius":null}"#), Kind::Parse, "target.radius: invalid type: null, expected f64"),
            (
                cast_at(r#"{"type":"cuboid","half_extents":[1,"2",3]}"#),
                Kind::Parse,
                "target.half_extents[1]: invalid type: string \"2\", expected f64",
            ),
            (
                cast_at(r#"{"type":"polytope","points":[[0,0,0],[1,0]]}"#),
                Kind::DimensionMismatch,
                "target.points[1] has 2 coordinates, but target.points[0] makes the query 3D",
            ),
            (
                cast_at(r#"{"type":"posed","rotation":true,"of":{"type":"ball","radius":1}}"#),
                Kind::Parse,
                "target.rotation: expected an angle or a quaternion [x, y, z, w]",
            ),
            (
                r#"{"query":"inscribed_ellipsoid","halfspaces":[{"normal":[1,0]}]}"#.to_owned(),
                Kind::Parse,
                "halfspaces[0]: missing field `offset`",
            ),
            (
                r#"{"query":"ray_cast","target":{"type":"cuboid","half_extents":[1,1,1]},"source":[5,0],"direction":[1,0]}"#
                    .to_owned(),
                Kind::DimensionMismatch,
                "source has 2 coordinates, but target.half_extents makes the query 3D",
            ),
        ];
        for (line, kind, message) in cases {
            let problem = refused(&line);
            assert_eq!((problem.kind, problem.message.as_str()), (kind, message), "{line}");
        }
    }

    #[test]
    fn names_that_are_unknown_are_told_from_those_that_are_not() {
        let (query, shape) =
            (refused(r#"{"query":"raycast"}"#), refused(r#"{"query":"distance","a":{"type":"sphere"}}"#));
        assert_eq!(query.kind, Kind::UnknownQuery, "{query:?}");
        assert!(
            query.message.starts_with("query: unknown variant `raycast`, expected one of `ray_cast`, "),
            "{query:?}"
        );
        assert_eq!(shape.kind, Kind::UnknownShape, "{shape:?}");
        assert!(shape.message.starts_with("a.type: unknown variant `sphere`, expected one of `point`, "), "{shape:?}");
        assert_eq!(refused(r#"{"query":7}"#).kind, Kind::Parse, "no name at all");
    }
}
