//! From a query to its answer: the one place where precision and dimension become types.

mod cast;
mod clearance;
mod clearance_plots;
mod contact;
mod distance;
mod enclosing;
mod fit;
mod gradient;
mod growth_distance;
mod inscribed;
mod intersect;
mod joint_box;
mod linear_cast;
mod margin;
mod method;
mod motion_cast;
mod motion_clearance;
mod pair;
pub mod path;
mod path_picture;
mod ray_cast;
mod ray_exit;
mod scene;
mod signed_distance;
mod track;

use std::fmt::{Debug, Write as _};

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};
use convex_support::{Scalar as _, SupportMap, Vector};
#[cfg(not(target_family = "wasm"))]
use cpu_time::ThreadTime;
use gjk_raycast::laws::{Numbers, PairPlanes, Report};
use gjk_raycast::{Certificate, DistanceOptions, distance_certificate};
#[cfg(target_family = "wasm")]
use std::time::Instant as ThreadTime;

use self::clearance::Clearance;
use self::contact::Contact;
use self::distance::Distance;
use self::enclosing::Enclosing;
use self::growth_distance::GrowthDistance;
use self::inscribed::Inscribed;
use self::intersect::Intersect;
use self::joint_box::JointBox;
use self::linear_cast::LinearCast;
use self::margin::Margin;
use self::motion_cast::MotionCast;
use self::motion_clearance::MotionClearance;
use self::path::Path;
use self::ray_cast::RayCast;
use self::ray_exit::RayExit;
use self::scene::Scene;
use self::signed_distance::SignedDistance;
use self::track::Track;
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Dimension, Fields, Object, Written};
use crate::wire::names::Names;
use crate::wire::shape::Space;

/// Whether this is the engine of the page in a browser (`xtask/page`), which everybody who opens it downloads first: it
/// answers in double precision, and reads no files.
pub const IN_BROWSER: bool = cfg!(all(target_family = "wasm", target_os = "unknown"));
/// Whether it also holds its answers to the laws of claims and says every bit of them, as studies ask: whoever asks for
/// an answer need not wait until that is compiled.
pub const IS_FOR_STUDIES: bool = cfg!(feature = "studies");
/// The page has an engine for the plane, with which it opens, and one for space.
const IS_FOR_PLANE: bool = IN_BROWSER && cfg!(feature = "page-plane");
const IS_FOR_SPACE: bool = IN_BROWSER && cfg!(feature = "page-space");

/// A query with its shapes built, ready to be solved.
trait Question {
    type Solution: Debug;

    /// Solves it: all that a user of the crate would call, and nothing else.
    fn solve(&self) -> Result<Self::Solution, Problem>;

    /// What the format says of the solution.
    fn answer(&self, solution: Self::Solution) -> Result<Answer, Problem>;

    /// What proves the solution, where the query is of a kind that has a proof.
    fn certificate(&self, _: &Self::Solution) -> Option<Answer> {
        None
    }

    /// Solves it, and tells what proves the solution.
    fn prove(&self) -> Result<(Self::Solution, Option<Answer>), Problem> {
        let solution = self.solve()?;
        let certificate = self.certificate(&solution);
        Ok((solution, certificate))
    }

    /// What became of the claims of its answers, asked with several options and judged by these planes; the starts are
    /// directions to begin with. `None` where there are no laws for the query.
    fn claims(&self, _starts: &[Numbers], _planes: PairPlanes<'_>) -> Option<Report> {
        None
    }

    /// What the library says besides, for which the format has no field, such as second derivatives and batches.
    fn beside(&self, _: &Self::Solution) -> String {
        String::new()
    }
}

/// Any question.
pub trait Ask {
    /// Solves the question once.
    fn ask(&self) -> Result<Answer, Problem>;

    /// The same, with what proves the answer, where the query is of a kind that has a proof.
    fn ask_with_certificate(&self) -> Result<(Answer, Option<Answer>), Problem>;

    /// Every bit that the library says: each field of the solution, what the format says of it, what proves it, and
    /// what is said besides.
    fn ask_everything(&self) -> Result<String, Problem>;

    /// What became of the claims of its answers, asked with several options from several starts, and judged by the
    /// planes of the bodies: of the target of a ray, where there is one. `None` where there are no laws for the query.
    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report>;

    /// Nanoseconds of thread CPU time that solving it takes: the least mean of three runs of about `microseconds` each.
    fn time(&self, microseconds: u64) -> f64;
}

impl<Q: Question> Ask for Q {
    fn ask(&self) -> Result<Answer, Problem> {
        in_range(self.answer(self.solve()?)?)
    }

    fn ask_with_certificate(&self) -> Result<(Answer, Option<Answer>), Problem> {
        let (solution, certificate) = self.prove()?;
        let certificate = certificate.filter(|proof| proof.non_finite().is_none());
        Ok((in_range(self.answer(solution)?)?, certificate))
    }

    fn ask_everything(&self) -> Result<String, Problem> {
        if !IS_FOR_STUDIES {
            return Err(left_out("everything that is said of an answer"));
        }
        let (solution, certificate) = self.prove()?;
        let mut said = format!("{solution:?} {}", self.beside(&solution));
        let answer = in_range(self.answer(solution)?).map_err(|problem| problem.message);
        let _ = write!(said, " {answer:?} {certificate:?}");
        Ok(said)
    }

    fn claims(&self, starts: &[Numbers], planes: PairPlanes<'_>) -> Option<Report> {
        if IS_FOR_STUDIES { Question::claims(self, starts, planes) } else { None }
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

/// The answer, if JSON can hold it.
fn in_range(answer: Answer) -> Result<Answer, Problem> {
    match answer.non_finite() {
        Some(field) => Err(Problem::new(Kind::NotConverged, format!("{field} is out of the range of the precision"))),
        None => Ok(answer),
    }
}

/// What a browser is not asked to download.
fn left_out(what: &str) -> Problem {
    Problem::new(Kind::UnknownQuery, format!("{what} is answered by `cargo xtask query`, not in a browser"))
}

/// What proves an answer, as the format says it.
fn certificate<V: Vector>(certificate: Certificate<V>) -> Answer {
    let Certificate { plane, points } = certificate;
    let mut answer = Answer::default();
    if let Some(plane) = plane {
        answer = answer.with("plane", Field::vector(plane));
    }
    answer.with("points", Field::weighted(points.into_iter().map(|p| (p.direction, p.weight))))
}

/// What proves that two bodies meet, or are as near as they are.
fn meeting<V: Vector>(a: &dyn SupportMap<Vector = V>, b: &dyn SupportMap<Vector = V>) -> Answer {
    certificate(distance_certificate(a, b, &gjk_raycast::distance(a, b, DistanceOptions::new())))
}

/// The kinds of queries, as written; a file each.
const QUERIES: &[(&str, Reader)] = &[
    ("ray_cast", read::<RayCast>),
    ("ray_exit", read::<RayExit>),
    ("distance", read::<Distance>),
    ("signed_distance", read::<SignedDistance>),
    ("growth_distance", read::<GrowthDistance>),
    ("contact", read::<Contact>),
    ("intersect", read::<Intersect>),
    ("linear_cast", read::<LinearCast>),
    ("motion_cast", read::<MotionCast>),
    ("motion_clearance", read::<MotionClearance>),
    ("scene", read::<Scene>),
    ("path", read::<Path>),
    ("joint_box", read::<JointBox>),
    ("enclosing_ellipsoid", read::<Enclosing>),
    ("inscribed_ellipsoid", read::<Inscribed>),
    ("margin", read::<Margin>),
    ("track", read::<Track>),
    ("clearance", read::<Clearance>),
];

/// Those of the page. The last has points of any dimension, and is left to the engine for space.
const OF_PAGE: [(&str, Reader); 8] = [
    ("ray_cast", read::<RayCast>),
    ("distance", read::<Distance>),
    ("signed_distance", read::<SignedDistance>),
    ("intersect", read::<Intersect>),
    ("linear_cast", read::<LinearCast>),
    ("motion_cast", read::<MotionCast>),
    ("margin", read::<Margin>),
    ("enclosing_ellipsoid", read::<Enclosing>),
];

/// A list of its own: what refers to a part of the other one has all of its functions.
const OF_PLANE: [(&str, Reader); 7] = {
    let [a, b, c, d, e, f, g, _] = OF_PAGE;
    [a, b, c, d, e, f, g]
};

/// Those of this engine.
const KNOWN: &[(&str, Reader)] = if IS_FOR_PLANE {
    &OF_PLANE
} else if IS_FOR_SPACE {
    &OF_PAGE
} else {
    QUERIES
};

/// Whether queries of this kind are answered in a browser too.
#[must_use]
pub fn is_of_page(kind: &str) -> bool {
    OF_PAGE.iter().any(|(name, _)| *name == kind)
}

type Reader = fn(Written<'_>, &Dimension, &Meshes) -> Result<Box<dyn Ask>, Problem>;

/// The fields that a query of any kind may have.
const EVERY: Names =
    &["id", "query", "precision", "tol", "method", "expect", "tags", "allow", "allow_fields", "bracket"];

/// The question that a JSON object asks.
///
/// # Errors
/// Where it asks none.
pub fn question(object: &Object, meshes: &Meshes) -> Result<Box<dyn Ask>, Problem> {
    let dimension = Dimension::default();
    let written = Written::new(object, &dimension);
    let read = written.named("query", KNOWN.iter().copied(), Kind::UnknownQuery)?;
    read(written, &dimension, meshes)
}

/// The precision to answer in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
    /// The names of its own fields.
    const FIELDS: Names;

    /// Its own fields, as written.
    fn read(fields: &Fields<'_>) -> Result<Self, Problem>;

    /// The question in a space.
    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem>;
}

/// Reads a query. Its vectors say which dimension it has; 3 where there are none.
fn read<Q: Query>(written: Written<'_>, dimension: &Dimension, meshes: &Meshes) -> Result<Box<dyn Ask>, Problem> {
    let fields = written.fields(EVERY, Q::FIELDS)?;
    let precision = fields.named_or_default("precision", [("f32", Precision::F32), ("f64", Precision::F64)])?;
    let how = How { precision, tol: fields.positive("tol")?, method: fields.maybe("method")?, meshes };
    let query = Q::read(&fields)?;
    match (precision, dimension.known().unwrap_or(3)) {
        (Precision::F64, 2) if IS_FOR_SPACE => Err(left_out("the plane")),
        (Precision::F64, 2) => query.question::<DVec2>(&how),
        (Precision::F64, _) if IS_FOR_PLANE => Err(left_out("space")),
        (Precision::F64, _) => query.question::<DVec3>(&how),
        (Precision::F32, _) if IN_BROWSER => Err(left_out("single precision")),
        (Precision::F32, 2) => query.question::<Vec2>(&how),
        (Precision::F32, _) => query.question::<Vec3A>(&how),
    }
}

impl How<'_> {
    /// The variant of the algorithm that is asked for; the first where none is.
    fn method<M: Copy>(&self, methods: &[(&'static str, M)]) -> Result<M, Problem> {
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

/// Directions in the precision asked for.
fn directions<V: Vector>(numbers: &[Numbers]) -> Vec<V> {
    numbers.iter().map(|n| V::from_fn(|i| scalar::<V>(n[i]))).collect()
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
                r#"{"query":"distance","a":{"type":"ball","radius":1},"b":{"type":"half_space","normal":[0,0],"offset":0}}"#
                    .to_owned(),
                Kind::InvalidShape,
                "b.normal must have a direction, but is zero, or too short or long for the precision",
            ),
            (
                r#"{"query":"inscribed_ellipsoid","halfspaces":[{"normal":[1,0]}]}"#.to_owned(),
                Kind::Parse,
                "the field \"offset\" of halfspaces[0] is missing",
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

    /// Of a pose that rounding may turn by a radian nothing is known, least of all that it touches something.
    #[test]
    fn a_path_whose_poses_are_lost_in_rounding_is_undecided() {
        let arm = r#"{"joint":0,"shapes":[{"type":"posed","translation":[2,0,0],"of":{"type":"ball","radius":0.5}}]}"#;
        let ball = r#"{"type":"posed","translation":[1,2,0],"of":{"type":"ball","radius":0.2}}"#;
        for (kind, from, to) in [("revolute", "1e15", "1e15"), ("revolute", "0", "-1e16"), ("prismatic", "0", "1e300")]
        {
            let line = format!(
                r#"{{"query":"path","joints":[{{"type":"{kind}","parent":-1,"axis":[0,0,1]}}],"links":[{arm}],
                "waypoints":[[{from}],[{to}]],"obstacles":[{ball}]}}"#
            );
            let object = json::object(line.as_bytes()).expect("JSON");
            let asked = question(&object, &Meshes::relative_to("")).expect("a path").ask();
            assert!(matches!(&asked, Err(why) if why.kind == Kind::NotConverged), "{asked:?}: {line}");
        }
    }

    #[test]
    fn names_that_are_unknown_are_told_from_those_that_are_not() {
        let (query, shape) =
            (refused(r#"{"query":"raycast"}"#), refused(r#"{"query":"distance","a":{"type":"sphere"}}"#));
        assert_eq!(query.kind, Kind::UnknownQuery, "{query:?}");
        let meant = "query: \"raycast\" is unknown, did you mean \"ray_cast\"? (known: ray_cast, ray_exit, distance, ";
        assert!(query.message.starts_with(meant), "{query:?}");
        assert_eq!(shape.kind, Kind::UnknownShape, "{shape:?}");
        let meant = "a.type: \"sphere\" is unknown, did you mean \"ball\"? (known: point, segment, ";
        assert!(shape.message.starts_with(meant), "{shape:?}");
        let half = refused(r#"{"query":"distance","a":{"type":"ball","radius":1},"b":{"type":"halfspace"}}"#);
        assert!(half.message.starts_with("b.type: \"halfspace\" is unknown, did you mean \"half_space\"?"), "{half:?}");
        let start = refused(&format!(r#"{{"query":"linear_cast",{PAIR},"start_in_contact":"if_deper"}}"#));
        assert!(start.message.contains("did you mean \"if_deeper\"? (known: report, if_deeper)"), "{start:?}");
        assert_eq!(refused(r#"{"query":7}"#).kind, Kind::Parse, "no name at all");
    }

    const PAIR: &str =
        r#""a":{"type":"ball","radius":1},"b":{"type":"posed","translation":[9,0,0],"of":{"type":"ball","radius":1}}"#;

    /// Whatever is misspelt would otherwise be left out without a word, and the answer be one to another question.
    #[test]
    fn a_field_that_nobody_knows_is_an_error_that_says_where() {
        const ROUND: &str = r#"{"center":[0,0],"semi_axes":[1,1]}"#;
        let posed = |fields: &str| format!(r#"{{"query":"intersect","a":{{"type":"point","at":[0,0]}},"b":{fields}}}"#);
        let asked = |ask: &str| format!(r#"{{"query":"scene","bodies":[],"asks":[{ask}]}}"#);
        let cases = [
            (
                format!(r#"{{"query":"linear_cast",{PAIR},"max_tim":1}}"#),
                "\"max_tim\" is unknown, did you mean \"max_time\"?",
            ),
            (format!(r#"{{"query":"distance",{PAIR},"max_time":1}}"#), "\"max_time\" is unknown (known: id, query, "),
            (
                posed(r#"{"type":"posed","translaton":[1,0],"of":{"type":"ball","radius":1}}"#),
                "\"translaton\" of b is unknown, did you mean \"translation\"? (known: type, translation, ",
            ),
            (
                posed(r#"{"type":"hull","of":[{"type":"ball","raduis":1}]}"#),
                "\"raduis\" of b.of[0] is unknown, did you mean \"radius\"?",
            ),
            (
                posed(r#"{"type":"half_space","normal":[0,1],"ofset":0}"#),
                "\"ofset\" of b is unknown, did you mean \"offset\"?",
            ),
            (
                posed(r#"{"type":"ellipsoid","center":[0,0],"matrix":[[1,0],[0,1]],"rotation":1}"#),
                "\"rotation\" of b is unknown (known: type, center, matrix)",
            ),
            (
                format!(r#"{{"query":"motion_cast",{PAIR},"max_time":1,"motion_a":{{"angular_velocty":[0,0,1]}}}}"#),
                "\"angular_velocty\" of motion_a is unknown, did you mean \"angular_velocity\"?",
            ),
            (asked(r#"{"pair_within":1}"#), "\"pair_within\" of asks[0] is unknown, did you mean \"pairs_within\"?"),
            (
                asked(r#"{"ray":{"source":[0,0],"direction":[1,0],"max_lamda":1}}"#),
                "\"max_lamda\" of asks[0].ray is unknown",
            ),
            (asked(r#"{"pairs_within":1,"within":2}"#), "\"within\" of asks[0] is unknown"),
            (
                format!(r#"{{"query":"track","e1":{ROUND},"e2":{ROUND},"poses":[{{"angle":1}}]}}"#),
                "\"angle\" of poses[0] is unknown",
            ),
            (
                r#"{"query":"inscribed_ellipsoid","halfspaces":[{"normal":[1,0],"offset":1,"offest":2}]}"#.to_owned(),
                "\"offest\" of halfspaces[0] is unknown, did you mean \"offset\"?",
            ),
        ];
        for (line, message) in cases {
            let problem = refused(&line);
            assert_eq!(problem.kind, Kind::UnknownField, "{line}: {problem:?}");
            assert!(problem.message.starts_with(&format!("the field {message}")), "{line}: {problem:?}");
        }
    }

    /// Three balls in a row along x: the first alone, and the others in a group, in a group.
    #[test]
    fn answers_name_the_member_of_a_group() {
        let ball = |x: i32| format!(r#"{{"type":"posed","translation":[{x},0],"of":{{"type":"ball","radius":1}}}}"#);
        let group = |at: &str, of: &str| format!(r#"{{"type":"group","translation":{at},"of":[{of}]}}"#);
        let inner = group("[0,-1]", &[ball(4), ball(8)].join(","));
        let outer = group("[0,1]", &[ball(90), inner].join(","));
        let asks = r#"{"ray":{"source":[20,0],"direction":[-1,0]}},{"ray":{"source":[2,0],"direction":[1,0],"all":true}},
            {"nearest":{"type":"point","at":[0,0]}},{"nearest":{"type":"point","at":[90,1]}},{"pairs_within":2},
            {"contacts_within":2}"#;
        let line = format!(r#"{{"query":"scene","bodies":[{},{outer}],"asks":[{asks}]}}"#, ball(0));
        let answers = &answered(&line)["answers"];
        assert_eq!(
            (&answers[0]["body"], &answers[0]["member"], &answers[0]["lambda"]),
            (&1.into(), &[1, 1][..].into(), &11.0.into())
        );
        let hits: Vec<_> = [0, 1].map(|i| (&answers[1]["hits"][i]["member"], &answers[1]["hits"][i]["lambda"])).into();
        assert_eq!(hits, [(&[1, 0][..].into(), &1.0.into()), (&[1, 1][..].into(), &5.0.into())]);
        assert_eq!((&answers[2]["body"], answers[2].get("member")), (&0.into(), None));
        assert_eq!((&answers[3]["body"], &answers[3]["member"]), (&1.into(), &0.into()));
        assert_eq!(answers[4]["pairs"], serde_json::json!([[0, 1]]), "members of one body make no pairs");
        let contact = &answers[5]["contacts"][0];
        assert_eq!((&contact["b"], &contact["member_b"]), (&1.into(), &[1, 0][..].into()));
        assert!(contact.get("member_a").is_none() && contact["signed_distance"] == 2.0, "{contact}");

        let none = r#"{"type":"ball","radius":1}"#;
        let asked = |body: &str| refused(&format!(r#"{{"query":"scene","bodies":[{none},{body}],"asks":[]}}"#));
        let empty = asked(&group("[0,0]", &group("[0,0]", "")));
        assert_eq!(empty.kind, Kind::InvalidShape);
        assert!(empty.message.starts_with("bodies[1].of[0].of: a group has no members"), "{empty:?}");
        let floor = asked(&group("[0,0]", r#"{"type":"half_space","normal":[0,1],"offset":0}"#));
        assert!(floor.message.starts_with("bodies[1].of[0] is a half-space"), "{floor:?}");
        let deep = (0..17).fold(ball(0), |of, _| group("[0,0]", &of));
        assert_eq!(asked(&deep).kind, Kind::InvalidShape, "nested too deep");
        let deep = (0..200).fold(ball(0), |of, _| group("[0,0]", &of));
        assert_eq!(json::object(deep.as_bytes()).expect_err("too deep").kind, Kind::Parse);
        let pair = refused(&format!(r#"{{"query":"distance","a":{none},"b":{}}}"#, group("[0,0]", none)));
        assert_eq!(pair.kind, Kind::UnknownShape, "only scenes have groups");
    }

    #[test]
    fn remarks_are_read_by_nobody_wherever_they_stand() {
        let b = r#"{"type":"half_space","normal":[0,1],"offset":0,"_why":"the floor"}"#;
        let line = format!(
            r#"{{"query":"intersect","_seed":7,"book":{{}},"a":{{"type":"ball","radius":1,"book":1,"_":[]}},"b":{b}}}"#
        );
        assert_eq!(answered(&line)["overlap"], true);
    }

    /// Every object in a value, by the keys and indices that lead to it.
    fn objects(value: &mut serde_json::Value, change: &mut impl FnMut(&mut Object)) {
        match value {
            serde_json::Value::Object(object) => {
                change(object);
                object.values_mut().for_each(|value| objects(value, change));
            }
            serde_json::Value::Array(items) => items.iter_mut().for_each(|value| objects(value, change)),
            _ => {}
        }
    }

    /// A field that is known but not read would be as silent as an unknown one. So each field of some line of the
    /// format is damaged, and that must be an error, and renamed, and that must be an unknown field.
    #[test]
    fn every_field_that_is_known_is_read() {
        let text = std::fs::read_to_string(format!("{}/by_hand.jsonl", crate::EMBEDDED)).expect("it is there");
        let mut seen = 0;
        for line in text.lines().filter(|line| line.starts_with('{')) {
            let mut whole: serde_json::Value = serde_json::from_str(line).expect("JSON");
            let described = ["id", "tags", "expect", "allow", "allow_fields", "bracket", "_why"];
            if let Some(line) = whole.as_object_mut() {
                line.retain(|key, _| !described.contains(&key.as_str()));
            }
            let mut places = Vec::new();
            objects(&mut whole.clone(), &mut |object| places.push(object.keys().cloned().collect::<Vec<_>>()));
            for (i, key) in places.iter().enumerate().flat_map(|(i, keys)| keys.iter().map(move |key| (i, key))) {
                let changed = |change: &dyn Fn(&mut Object)| {
                    let (mut line, mut at) = (whole.clone(), 0);
                    objects(&mut line, &mut |object| {
                        if at == i {
                            change(object);
                        }
                        at += 1;
                    });
                    refused(&line.to_string())
                };
                changed(&|object| drop(object.insert(key.clone(), "?".into())));
                // What an object is says which fields it has: without that, nothing is known of the others.
                if !matches!(key.as_str(), "type" | "query") {
                    let renamed = format!("{key}q");
                    let problem = changed(&|object| {
                        let value = object.remove(key).unwrap_or_default();
                        object.insert(renamed.clone(), value);
                    });
                    // Of a letter there is nothing that looks like it.
                    let is_named = problem.message.contains(&format!("{renamed:?}"))
                        && (key.len() == 1 || problem.message.contains(&format!("{key:?}")));
                    assert!(problem.kind == Kind::UnknownField && is_named, "{key} in {line}: {problem:?}");
                }
                seen += 1;
            }
        }
        assert!(seen > 150, "only {seen} fields");
    }

    /// The answer to a line.
    fn answered(line: &str) -> serde_json::Value {
        let object = json::object(line.as_bytes()).expect("JSON");
        let answer = question(&object, &Meshes::relative_to("")).and_then(|question| question.ask());
        serde_json::to_value(answer.expect(line)).expect("JSON")
    }

    #[test]
    fn motions_say_the_dimension_and_have_an_end() {
        let cast = |more: &str| {
            let ball = r#"{"type":"ball","radius":1}"#;
            format!(r#"{{"query":"motion_cast","a":{ball},"b":{ball}{more}}}"#)
        };
        let cases = [
            ("", Kind::Parse, "the field \"max_time\" is missing"),
            (r#","max_time":0"#, Kind::Parse, "max_time is 0, but must be greater than zero"),
            (
                r#","max_time":1e300,"precision":"f32""#,
                Kind::NonFinite,
                "max_time is not finite in the precision asked for",
            ),
            (
                r#","max_time":1,"motion_a":{"angular_velocity":1},"motion_b":{"velocity":[1,0,0]}"#,
                Kind::DimensionMismatch,
                "motion_b.velocity has 3 coordinates, but motion_a.angular_velocity makes the query 2D",
            ),
            (
                r#","max_time":1,"motion_a":{"angular_velocity":[0,1]}"#,
                Kind::DimensionMismatch,
                "motion_a.angular_velocity has 2 coordinates, but is a number in 2D and has 3 in 3D",
            ),
        ];
        for (more, kind, message) in cases {
            let problem = refused(&cast(more));
            assert_eq!((problem.kind, problem.message.as_str()), (kind, message), "{more}");
        }
        assert_eq!(answered(&cast(r#","max_time":1"#))["time"], 0.0, "they overlap");
    }

    #[test]
    fn a_hit_that_may_be_a_miss_says_so() {
        let cast = |y: f64| {
            let target = r#"{"type":"ellipsoid","center":[0,0,0],"semi_axes":[2,1,0.5]}"#;
            answered(&format!(r#"{{"query":"ray_cast","target":{target},"source":[-5,{y},0],"direction":[1,0,0]}}"#))
        };
        let told =
            |answer: serde_json::Value| (answer["hit"].clone(), answer["certain"].clone(), answer["status"].clone());
        assert_eq!(told(cast(0.5)), (true.into(), true.into(), "converged".into()));
        assert_eq!(told(cast(1.0)), (true.into(), false.into(), "stalled".into()), "it grazes");
        assert_eq!(told(cast(1.5)), (false.into(), true.into(), "converged".into()));
    }

    #[test]
    fn a_contact_is_null_beyond_its_distance() {
        let contact = |within: f64| {
            let b = r#"{"type":"posed","translation":[0,2.5],"of":{"type":"cuboid","half_extents":[2,1]}}"#;
            answered(&format!(
                r#"{{"query":"contact","a":{{"type":"cuboid","half_extents":[1,1]}},"b":{b},"within":{within}}}"#
            ))
        };
        let found = &contact(0.5)["contact"];
        assert_eq!(found["signed_distance"], 0.5);
        assert_eq!(found["points"].as_array().map(Vec::len), Some(2), "of faces in 2D two points are enough: {found}");
        let apart = contact(0.25);
        assert!(apart["contact"].is_null() && apart["lower"].as_f64() > Some(0.25), "{apart}");
    }

    #[test]
    fn a_scene_answers_as_its_bodies_one_by_one() {
        let bodies = [[4.0, 0.0], [8.0, 0.5], [-6.0, 0.0]].map(|[x, y]| {
            format!(r#"{{"type":"posed","translation":[{x},{y}],"of":{{"type":"cuboid","half_extents":[1,1]}}}}"#)
        });
        let (ball, bodies_in) = (r#"{"type":"ball","radius":0.5}"#, bodies.join(","));
        let turning = r#"{"velocity":[-2,0],"angular_velocity":1.0}"#;
        let asks = [
            r#"{"ray":{"source":[0,0],"direction":[2,0]}}"#.to_owned(),
            r#"{"ray":{"source":[0,0],"direction":[0,1]}}"#.to_owned(),
            format!(r#"{{"nearest":{ball}}}"#),
            format!(r#"{{"nearest":{ball},"within":2}}"#),
            format!(r#"{{"linear_cast":{{"shape":{ball},"velocity":[1,0],"max_time":2}}}}"#),
            format!(r#"{{"motion_cast":{{"shape":{ball},"motion":{turning},"max_time":9}}}}"#),
            r#"{"pairs_within":2}"#.to_owned(),
        ]
        .join(",");
        let scene = answered(&format!(r#"{{"query":"scene","bodies":[{bodies_in}],"asks":[{asks}]}}"#));
        let answers = &scene["answers"];
        assert_eq!((&answers[0]["body"], &answers[0]["lambda"]), (&0.into(), &1.5.into()), "{answers}");
        assert_eq!(answers[1], serde_json::json!({"hit": false, "certain": true}));
        assert_eq!((&answers[2]["body"], &answers[2]["distance"]), (&0.into(), &2.5.into()), "{answers}");
        assert_eq!(answers[3], serde_json::json!({"body": null, "distance": null}));
        assert_eq!(answers[4], serde_json::json!({"hit": false, "certain": true}), "it comes to within 0.5");
        let single = answered(&format!(
            r#"{{"query":"motion_cast","a":{ball},"b":{},"motion_a":{turning},"max_time":9}}"#,
            bodies[2]
        ));
        assert_eq!((&answers[5]["body"], &answers[5]["time"]), (&2.into(), &single["time"]), "{answers}");
        assert_eq!(answers[6]["pairs"], serde_json::json!([[0, 1]]), "the lower index first");
    }

    #[test]
    fn a_scene_may_have_a_floor() {
        let floor = r#"{"type":"half_space","normal":[0,2],"offset":-2}"#;
        let rod = |y: f64| {
            format!(
                r#"{{"type":"posed","translation":[0,{y}],"of":{{"type":"capsule","half_height":0.75,"radius":0.25}}}}"#
            )
        };
        let ask = |y, end| {
            let motion = format!(r#"{{"velocity":[0,-1],"angular_velocity":3,"center":[0,{y}]}}"#);
            let ask = format!(r#"{{"motion_cast":{{"shape":{},"motion":{motion},"max_time":{end}}}}}"#, rod(y));
            let high = r#"{"type":"posed","translation":[0,9],"of":{"type":"ball","radius":1}}"#;
            answered(&format!(r#"{{"query":"scene","bodies":[{high},{floor},{high}],"asks":[{ask}]}}"#))["answers"][0]
                .clone()
        };
        // Its lower end is at 3 − t − 1/4 − 3/4·|cos 3t|.
        let landed = ask(3.0, 9.0);
        let time = landed["time"].as_f64().expect("it turns, and lands");
        assert!((3.0 - time - 0.25 - 0.75 * (3.0 * time).cos().abs() + 1.0).abs() < 1e-13, "{landed}");
        assert_eq!(landed["body"], 1, "by its index");
        assert!(
            landed["upper"].as_f64().zip(landed["lower"].as_f64()).is_some_and(|(upper, lower)| upper - lower < 1e-13)
        );
        assert_eq!(ask(3.0, 2.5), serde_json::json!({"hit": false, "certain": true}), "not yet");

        let flat = refused(r#"{"query":"scene","bodies":[{"type":"half_space","normal":[0,0],"offset":1}],"asks":[]}"#);
        assert_eq!(flat.kind, Kind::InvalidShape, "{}", flat.message);
        let alone = refused(&format!(r#"{{"query":"ray_cast","target":{floor},"source":[5,0],"direction":[1,0]}}"#));
        assert_eq!(alone.kind, Kind::UnknownShape, "a half-space is a body of a scene alone: {}", alone.message);
    }

    #[test]
    fn algorithm_1_hits_an_edge_that_it_is_aimed_at() {
        // The closest points of curved bodies are off along their plane by the root of rounding: by those, this ray
        // passed by.
        let cylinder = r#"{"type":"cylinder","half_height":1.3741260878225547,"radius":1.3829551759415628}"#;
        let capsule = r#"{"type":"capsule","half_height":1.1848445257807128,"radius":0.5}"#;
        let target = format!(
            r#"{{"type":"difference","a":{cylinder},"b":{{"type":"posed","of":{capsule},"rotation":[0,0,-1,1]}}}}"#
        );
        let ray = r#""source":[-1.7772667886710691,2.061189131733832,2.8244327639123443],"direction":[1.1848445257807128,-1.3741260878225547,-1.8829551759415628]"#;
        for method in ["gjk", "iterative"] {
            let cast = answered(&format!(r#"{{"query":"ray_cast","method":"{method}","target":{target},{ray}}}"#));
            assert!(cast["lambda"].as_f64().is_some_and(|lambda| (lambda - 0.5).abs() < 1e-13), "{method}: {cast}");
        }
    }

    #[test]
    fn a_question_to_a_scene_is_of_one_kind() {
        let problem =
            refused(r#"{"query":"scene","bodies":[],"asks":[{"pairs_within":1},{"ray":{},"pairs_within":1}]}"#);
        let message = "asks[1] must have exactly one of ray, nearest, linear_cast, motion_cast, pairs_within, \
                       contacts_within, nearest_between, least_pair, any_within";
        assert_eq!((problem.kind, problem.message.as_str()), (Kind::Parse, message));
    }
}
