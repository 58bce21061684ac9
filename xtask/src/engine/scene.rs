//! `scene`.

use convex_support::{Scalar, Vector};
use gjk_raycast::{
    DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastOptions, RigidMotion, SceneCast,
    SceneError,
};

use super::cast::problem;
use super::distance::certain;
use super::{Ask, How, Query, Question, motion_cast as motion, scalar};
use crate::wire::answer::{Answer, Field};
use crate::wire::body::Body;
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Coordinates, Fields};
use crate::wire::motion::Motion as RigidSpec;
use crate::wire::shape::{Shape, Solid, Space, vector};

/// The query as written.
pub(super) struct Scene {
    bodies: Vec<Body>,
    asks: Vec<Spec>,
}

/// One question to the scene, as written.
enum Spec {
    Ray { source: Coordinates, direction: Coordinates, max_lambda: Option<f64> },
    Nearest { shape: Shape, within: Option<f64> },
    LinearCast { shape: Shape, velocity: Coordinates, max_time: Option<f64> },
    MotionCast { shape: Shape, motion: RigidSpec, max_time: f64 },
    PairsWithin(f64),
}

/// The kinds of questions.
const KINDS: [&str; 5] = ["ray", "nearest", "linear_cast", "motion_cast", "pairs_within"];

impl Query for Scene {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            bodies: fields.each("bodies")?.iter().map(Body::read).collect::<Result<_, _>>()?,
            asks: fields.each("asks")?.iter().map(Spec::read).collect::<Result<_, _>>()?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let build = |(i, body): (usize, &Body)| body.build(&format!("bodies[{i}]"), how.meshes);
        let bodies = self.bodies.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        let ask = |(i, spec): (usize, &Spec)| spec.build(&format!("asks[{i}]"), how);
        let asks = self.asks.iter().enumerate().map(ask).collect::<Result<_, _>>()?;
        Ok(Box::new(Asked::<V> { scene: scene_of(bodies).map_err(refused)?, asks }))
    }
}

impl Spec {
    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let named: Vec<&str> = KINDS.into_iter().filter(|kind| fields.has(kind)).collect();
        let [kind] = named[..] else {
            let message = format!("{} must have exactly one of {}", fields.place(), KINDS.join(", "));
            return Err(Problem::new(Kind::Parse, message));
        };
        if kind == "pairs_within" {
            return Ok(Self::PairsWithin(fields.not_negative(kind)?.unwrap_or(0.0)));
        }
        let of = fields.within(kind)?;
        let shape = || Shape::read(&of.within("shape")?);
        Ok(match kind {
            "ray" => Self::Ray {
                source: of.vector("source")?,
                direction: of.vector("direction")?,
                max_lambda: of.maybe("max_lambda")?,
            },
            // The shape is the field itself, and its limit stands beside it.
            "nearest" => Self::Nearest { shape: Shape::read(&of)?, within: fields.not_negative("within")? },
            "linear_cast" => {
                Self::LinearCast { shape: shape()?, velocity: of.vector("velocity")?, max_time: of.maybe("max_time")? }
            }
            _ => Self::MotionCast {
                shape: shape()?,
                motion: RigidSpec::read(&of.within("motion")?)?,
                max_time: of.above_zero("max_time")?,
            },
        })
    }

    /// The question in a space; `place` is where the query says it, for errors.
    fn build<V: Space>(&self, place: &str, how: &How<'_>) -> Result<One<V>, Problem> {
        let tolerance = how.tolerance::<V>()?;
        let solid = |shape: &Shape, field: &str| shape.build(&format!("{place}.{field}"), how.meshes);
        Ok(match self {
            Self::Ray { source, direction, max_lambda } => {
                let mut options = RayCastOptions::new();
                options.tolerance = tolerance.unwrap_or(options.tolerance);
                options.max_lambda = max_lambda.map_or(options.max_lambda, scalar::<V>);
                One::Ray(Ray { source: vector(source), direction: vector(direction) }, options)
            }
            Self::Nearest { shape, within } => {
                let mut options = DistanceOptions::new();
                options.tolerance = tolerance.unwrap_or(options.tolerance);
                options.limit = within.map_or(options.limit, scalar::<V>);
                One::Nearest(solid(shape, "nearest")?, options)
            }
            Self::LinearCast { shape, velocity, max_time } => {
                let mut options = LinearCastOptions::new();
                options.tolerance = tolerance.unwrap_or(options.tolerance);
                options.max_time = max_time.map_or(options.max_time, scalar::<V>);
                let motion = Motion { velocity_a: vector(velocity), velocity_b: V::ZERO };
                One::LinearCast(solid(shape, "linear_cast.shape")?, motion, options)
            }
            Self::MotionCast { shape, motion, max_time } => {
                let options = motion::options(how, *max_time, &format!("{place}.motion_cast.max_time"))?;
                One::MotionCast(solid(shape, "motion_cast.shape")?, motion.build(), options)
            }
            Self::PairsWithin(within) => {
                let mut options = DistanceOptions::new();
                options.tolerance = tolerance.unwrap_or(options.tolerance);
                One::PairsWithin(scalar::<V>(*within), options)
            }
        })
    }
}

/// The scene of these bodies, with indices in their order: built at once up to the first half-space.
fn scene_of<V: Vector>(
    mut bodies: Vec<gjk_raycast::Body<Solid<V>>>,
) -> Result<gjk_raycast::Scene<Solid<V>>, SceneError> {
    use gjk_raycast::Body::{Convex, HalfSpace};
    let first = bodies.iter().position(|body| body.convex().is_none()).unwrap_or(bodies.len());
    let rest = bodies.split_off(first);
    let convex = |body| if let Convex(body) = body { Some(body) } else { None };
    let mut scene = gjk_raycast::Scene::new(bodies.into_iter().filter_map(convex))?;
    for body in rest {
        match body {
            Convex(body) => scene.insert(body)?,
            HalfSpace(half_space) => scene.insert_half_space(half_space),
        };
    }
    Ok(scene)
}

/// A body that has no place in a scene.
fn refused(why: SceneError) -> Problem {
    let message = match why {
        SceneError::NotFinite { body } => {
            format!("the box of bodies[{body}] is not finite in the precision asked for")
        }
        other => other.to_string(),
    };
    Problem::new(Kind::NonFinite, message)
}

/// A scene and the questions to it.
struct Asked<V: Vector> {
    scene: gjk_raycast::Scene<Solid<V>>,
    asks: Vec<One<V>>,
}

/// One question.
enum One<V: Vector> {
    Ray(Ray<V>, RayCastOptions<V>),
    Nearest(Solid<V>, DistanceOptions<V>),
    LinearCast(Solid<V>, Motion<V>, LinearCastOptions<V>),
    MotionCast(Solid<V>, RigidMotion<V>, MotionCastOptions<V>),
    PairsWithin(V::Scalar, DistanceOptions<V>),
}

impl<V: Space> Question for Asked<V> {
    type Solution = Vec<Answer>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let one = |(i, one): (usize, &One<V>)| one.answer(&self.scene).map_err(|why| why.at(&format!("asks[{i}]")));
        self.asks.iter().enumerate().map(one).collect()
    }

    fn answer(&self, answers: Self::Solution) -> Result<Answer, Problem> {
        Ok(Answer::default().with("answers", Field::Answers(answers)))
    }
}

impl<V: Space> One<V> {
    fn answer(&self, scene: &gjk_raycast::Scene<Solid<V>>) -> Result<Answer, Problem> {
        match self {
            Self::Ray(ray, options) => {
                first("lambda", &scene.ray_cast(*ray, *options).map_err(problem)?, |hit| hit.lambda)
            }
            Self::LinearCast(shape, motion, options) => {
                first("time", &scene.linear_cast(shape, *motion, *options).map_err(problem)?, |hit| hit.time)
            }
            Self::MotionCast(shape, motion, options) => {
                first("time", &scene.motion_cast(shape, *motion, *options).map_err(problem)?, |hit| hit.time)
            }
            Self::Nearest(shape, options) => nearest(scene, shape, *options),
            Self::PairsWithin(within, options) => pairs(scene, *within, *options),
        }
    }
}

/// The first hit of a cast; `scalar` gives its λ or time, which the format calls `name`.
fn first<H, S: Scalar>(
    name: &'static str,
    cast: &SceneCast<H, S>,
    scalar: impl FnOnce(&H) -> S,
) -> Result<Answer, Problem> {
    if let Some(body) = cast.undecided {
        return Err(undecided(body));
    }
    Ok(hit(name, cast.first.as_ref().map(|first| (first.body, scalar(&first.hit), [first.lower, first.upper]))))
}

/// The body that is hit first, the λ or time of it, and its bracket.
fn hit<S: Scalar>(name: &'static str, first: Option<(usize, S, [S; 2])>) -> Answer {
    let answer = Answer::default().with("hit", Field::Flag(first.is_some()));
    let Some((body, scalar, [lower, upper])) = first else { return answer };
    answer
        .with("body", Field::Count(body))
        .with(name, Field::number(scalar))
        .with_finite("lower", lower)
        .with_finite("upper", upper)
}

/// A cast that does not tell which body is first.
fn undecided(body: usize) -> Problem {
    Problem::new(Kind::NotConverged, format!("neither hit nor miss of bodies[{body}] is certain"))
}

/// The nearest body; nulls where none is within the limit.
fn nearest<V: Space>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    shape: &Solid<V>,
    options: DistanceOptions<V>,
) -> Result<Answer, Problem> {
    let Some(found) = scene.nearest(shape, options).nearest else {
        return Ok(Answer::default().with("body", Field::Null).with("distance", Field::Null));
    };
    certain(&found.distance)?;
    Ok(Answer::default()
        .with("body", Field::Count(found.body))
        .with("distance", Field::number(found.distance.distance))
        .with_finite("lower", found.distance.lower)
        .with_finite("upper", found.distance.upper))
}

/// The pairs no farther apart than `within`.
fn pairs<V: Space>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    within: V::Scalar,
    options: DistanceOptions<V>,
) -> Result<Answer, Problem> {
    let mut found = Vec::new();
    scene.pairs_within(within, options, &mut found);
    found.iter().try_for_each(|pair| certain(&pair.distance))?;
    Ok(Answer::default().with("pairs", Field::Pairs(found.iter().map(|pair| [pair.a, pair.b]).collect())))
}
