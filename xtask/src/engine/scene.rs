//! `scene`.

use convex_support::Vector;
use gjk_raycast::{
    BodyHit, DistanceOptions, LinearCastOptions, Motion, MotionCastOptions, PairContact, Ray, RayCastOptions, RayHit,
    RigidMotion, SceneAnyWithin, SceneCast, ScenePair, SignedDistanceOptions,
};

use super::cast::{Limits, RaySpec, problem};
use super::distance::certain;
use super::{Ask, How, Query, Question, scalar, signed_distance};
use crate::wire::answer::{Answer, Field};
use crate::wire::body::{Element, refused, scene_of};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Coordinates, Fields, Written};
use crate::wire::motion::Motion as RigidSpec;
use crate::wire::names::Names;
use crate::wire::shape::{Shape, Solid, Space, vector};

/// The query as written.
pub(super) struct Scene {
    bodies: Vec<Element>,
    asks: Vec<Spec>,
}

/// One question to the scene, as written.
enum Spec {
    Ray { ray: RaySpec, all: bool },
    Nearest { shape: Shape, within: Option<f64> },
    LinearCast { shape: Shape, velocity: Coordinates, limits: Limits },
    MotionCast { shape: Shape, motion: RigidSpec, limits: Limits },
    PairsWithin(f64),
    ContactsWithin(f64),
    NearestBetween { others: Vec<Element>, within: Option<f64> },
    LeastPair { within: Option<f64> },
    AnyWithin { within: f64, of: Option<Shape> },
}

/// The kinds of questions.
const KINDS: Names = &[
    "ray",
    "nearest",
    "linear_cast",
    "motion_cast",
    "pairs_within",
    "contacts_within",
    "nearest_between",
    "least_pair",
    "any_within",
];

impl Query for Scene {
    const FIELDS: Names = &["bodies", "asks"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            bodies: fields.each("bodies")?.into_iter().map(Element::read).collect::<Result<_, _>>()?,
            asks: fields.each("asks")?.into_iter().map(Spec::read).collect::<Result<_, _>>()?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let build = |(i, body): (usize, &Element)| body.build(&format!("bodies[{i}]"), how.meshes);
        let bodies = self.bodies.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        let ask = |(i, spec): (usize, &Spec)| spec.build(&format!("asks[{i}]"), how);
        let asks = self.asks.iter().enumerate().map(ask).collect::<Result<_, _>>()?;
        Ok(Box::new(Asked::<V> { scene: scene_of(bodies).map_err(|why| refused(why, "bodies"))?, asks }))
    }
}

impl Spec {
    fn read(written: Written<'_>) -> Result<Self, Problem> {
        let fields = written.fields(KINDS, &["within", "of"])?;
        let kind = fields.only_one_of(KINDS)?;
        // What the question is about is the field itself, and this stands beside it.
        let beside: Names = match kind {
            "nearest" | "nearest_between" | "least_pair" => &["within"],
            "any_within" => &["of"],
            _ => &[],
        };
        let fields = fields.only(KINDS, beside)?;
        let distance = || Ok(fields.not_negative(kind)?.unwrap_or(0.0));
        let shape = |of: &Fields<'_>| Shape::read(of.within("shape")?);
        let cast = |own: Names| fields.within(kind)?.fields(&["max_time", "target_distance", "start_in_contact"], own);
        Ok(match kind {
            "nearest" => {
                Self::Nearest { shape: Shape::read(fields.within(kind)?)?, within: fields.not_negative("within")? }
            }
            "nearest_between" => {
                let others = fields.each(kind)?.into_iter().map(Element::read).collect::<Result<_, _>>()?;
                Self::NearestBetween { others, within: fields.not_negative("within")? }
            }
            "least_pair" if fields.flag(kind)? => Self::LeastPair { within: fields.not_negative("within")? },
            "least_pair" => {
                let message = format!("{} is false, but an ask is made by true", fields.at(kind));
                return Err(Problem::new(Kind::Parse, message));
            }
            "any_within" => {
                let of = if fields.has("of") { Some(Shape::read(fields.within("of")?)?) } else { None };
                Self::AnyWithin { within: distance()?, of }
            }
            "ray" => {
                let of = fields.within(kind)?.fields(&["source", "direction", "min_lambda", "max_lambda"], &["all"])?;
                Self::Ray { ray: RaySpec::read(&of)?, all: of.flag("all")? }
            }
            "linear_cast" => {
                let of = cast(&["shape", "velocity"])?;
                let (shape, velocity) = (shape(&of)?, of.vector("velocity")?);
                Self::LinearCast { shape, velocity, limits: Limits::read(&of)? }
            }
            "motion_cast" => {
                let of = cast(&["shape", "motion"])?;
                let (shape, motion) = (shape(&of)?, RigidSpec::read(of.within("motion")?)?);
                Self::MotionCast { shape, motion, limits: Limits::read_with_end(&of)? }
            }
            "pairs_within" => Self::PairsWithin(distance()?),
            _ => Self::ContactsWithin(distance()?),
        })
    }

    /// The question in a space; `place` is where the query says it, for errors.
    fn build<V: Space>(&self, place: &str, how: &How<'_>) -> Result<One<V>, Problem> {
        let mut near = DistanceOptions::new();
        near.tolerance = how.tolerance::<V>()?.unwrap_or(near.tolerance);
        let solid = |shape: &Shape, field: &str| shape.build(&format!("{place}.{field}"), how.meshes);
        Ok(match self {
            Self::Ray { ray, all: false } => One::Ray(ray.ray(), ray.options(how)?),
            Self::Ray { ray, all: true } => One::EveryHit(ray.ray(), ray.options(how)?),
            Self::Nearest { shape, within } => {
                near.limit = within.map_or(near.limit, scalar::<V>);
                One::Nearest(solid(shape, "nearest")?, near)
            }
            Self::LinearCast { shape, velocity, limits } => {
                let motion = Motion { velocity_a: vector(velocity), velocity_b: V::ZERO };
                One::LinearCast(solid(shape, "linear_cast.shape")?, motion, limits.linear(how)?)
            }
            Self::MotionCast { shape, motion, limits } => {
                let options = limits.motion(how, &format!("{place}.motion_cast."))?;
                One::MotionCast(solid(shape, "motion_cast.shape")?, motion.build(), options)
            }
            Self::PairsWithin(within) => One::PairsWithin(scalar::<V>(*within), near),
            Self::ContactsWithin(within) => One::ContactsWithin(scalar::<V>(*within), signed_distance::options(how)?),
            Self::NearestBetween { others, within } => {
                let list = format!("{place}.nearest_between");
                let build = |(i, body): (usize, &Element)| body.build(&format!("{list}[{i}]"), how.meshes);
                let others = others.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
                near.limit = within.map_or(near.limit, scalar::<V>);
                One::NearestBetween(scene_of(others).map_err(|why| refused(why, &list))?, near)
            }
            Self::LeastPair { within } => {
                near.limit = within.map_or(near.limit, scalar::<V>);
                One::LeastPair(near)
            }
            Self::AnyWithin { within, of } => {
                let of = of.as_ref().map(|shape| solid(shape, "of")).transpose()?;
                One::AnyWithin(of, scalar::<V>(*within), near)
            }
        })
    }
}

/// A scene and the questions to it.
struct Asked<V: Vector> {
    scene: gjk_raycast::Scene<Solid<V>>,
    asks: Vec<One<V>>,
}

/// One question.
enum One<V: Vector> {
    Ray(Ray<V>, RayCastOptions<V>),
    EveryHit(Ray<V>, RayCastOptions<V>),
    Nearest(Solid<V>, DistanceOptions<V>),
    LinearCast(Solid<V>, Motion<V>, LinearCastOptions<V>),
    MotionCast(Solid<V>, RigidMotion<V>, MotionCastOptions<V>),
    PairsWithin(V::Scalar, DistanceOptions<V>),
    ContactsWithin(V::Scalar, SignedDistanceOptions<V>),
    NearestBetween(gjk_raycast::Scene<Solid<V>>, DistanceOptions<V>),
    LeastPair(DistanceOptions<V>),
    AnyWithin(Option<Solid<V>>, V::Scalar, DistanceOptions<V>),
}

impl<V: Space> Question for Asked<V> {
    type Solution = Vec<Answer>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let one = |(i, one): (usize, &One<V>)| one.answer(&self.scene).map_err(|why| why.at(&format!("asks[{i}]")));
        self.asks.iter().enumerate().map(one).collect()
    }

    /// All that a scene is asked, with every field of the answers.
    fn beside(&self, _: &Self::Solution) -> String {
        self.asks.iter().map(|ask| ask.beside(&self.scene)).collect()
    }

    fn answer(&self, answers: Self::Solution) -> Result<Answer, Problem> {
        Ok(Answer::default().with("answers", Field::Answers(answers)))
    }
}

impl<V: Space> One<V> {
    fn beside(&self, scene: &gjk_raycast::Scene<Solid<V>>) -> String {
        match self {
            Self::Ray(ray, options) => {
                let rays = [*ray, Ray { source: ray.source, direction: -ray.direction }];
                #[cfg(feature = "parallel")]
                let first = scene.all().par_ray_casts(&rays, *options);
                #[cfg(not(feature = "parallel"))]
                let first = rays.map(|ray| scene.all().ray_cast(ray, *options)).to_vec();
                format!("{first:?} {:?}", scene.all().any_hit(*ray, *options))
            }
            Self::EveryHit(ray, options) => {
                let mut hits = Vec::new();
                format!("{:?} {hits:?}", scene.all().ray_cast_all(*ray, *options, &mut hits))
            }
            Self::LinearCast(shape, motion, options) => {
                let mut hits = Vec::new();
                let all = scene.all().linear_cast_all(shape, *motion, *options, &mut hits);
                format!("{:?} {all:?} {hits:?}", scene.all().linear_cast(shape, *motion, *options))
            }
            Self::MotionCast(shape, motion, options) => {
                let other = RigidMotion { velocity: motion.center, ..*motion };
                let both = scene.all().motion_cast_of_both(shape, *motion, other, *options);
                format!("{:?} {both:?}", scene.all().motion_cast(shape, *motion, *options))
            }
            Self::Nearest(shape, options) => {
                let (mut near, mut touched) = (Vec::new(), Vec::new());
                let (mut first, depth) = (Vec::new(), SignedDistanceOptions::new());
                let nearest = scene.all().nearest(shape, *options);
                let within = nearest.lower * scalar::<V>(2.0);
                let work = [
                    scene.all().all_within(shape, within, *options, &mut near),
                    scene.all().contacts_of(shape, within, depth, &mut touched),
                    scene.all().nearest_k(shape, 3, *options, &mut first),
                ];
                let least = scene.all().least_signed_distance(shape, depth);
                format!("{nearest:?} {work:?} {near:?} {touched:?} {first:?} {least:?}")
            }
            Self::PairsWithin(within, options) => {
                let mut pairs = Vec::new();
                #[cfg(feature = "parallel")]
                let _ = scene.all().par_pairs_within(*within, *options, &mut pairs);
                #[cfg(not(feature = "parallel"))]
                let _ = scene.all().pairs_within(*within, *options, &mut pairs);
                format!("{pairs:?}")
            }
            Self::ContactsWithin(within, options) => {
                let mut contacts = Vec::new();
                #[cfg(feature = "parallel")]
                let _ = scene.all().par_contacts_within(*within, *options, &mut contacts);
                #[cfg(not(feature = "parallel"))]
                let _ = scene.all().contacts_within(*within, *options, &mut contacts);
                format!("{contacts:?}")
            }
            Self::NearestBetween(others, options) => {
                #[cfg(feature = "parallel")]
                let nearest = scene.all().par_nearest_between(others, *options);
                #[cfg(not(feature = "parallel"))]
                let nearest = scene.all().nearest_between(others, *options);
                let any = scene.all().any_pair_between(others, nearest.lower * scalar::<V>(2.0), *options);
                format!("{:?} {:?} {:?} {:?}", nearest.nearest, nearest.lower, any.any, any.undecided)
            }
            Self::LeastPair(options) => {
                #[cfg(feature = "parallel")]
                let nearest = scene.all().par_least_pair(*options);
                #[cfg(not(feature = "parallel"))]
                let nearest = scene.all().least_pair(*options);
                format!("{:?} {:?}", nearest.nearest, nearest.lower)
            }
            Self::AnyWithin(of, within, options) => match of {
                Some(shape) => format!("{:?}", scene.all().any_within(shape, *within, *options)),
                None => format!("{:?}", scene.all().any_pair_within(*within, *options)),
            },
        }
    }

    fn answer(&self, scene: &gjk_raycast::Scene<Solid<V>>) -> Result<Answer, Problem> {
        match self {
            Self::Ray(ray, options) => {
                first(scene, "lambda", &scene.all().ray_cast(*ray, *options).map_err(problem)?, |hit| hit.lambda)
            }
            Self::EveryHit(ray, options) => every_hit(scene, *ray, *options),
            Self::LinearCast(shape, motion, options) => {
                first(scene, "time", &scene.all().linear_cast(shape, *motion, *options).map_err(problem)?, |hit| {
                    hit.time
                })
            }
            Self::MotionCast(shape, motion, options) => {
                first(scene, "time", &scene.all().motion_cast(shape, *motion, *options).map_err(problem)?, |hit| {
                    hit.time
                })
            }
            Self::Nearest(shape, options) => nearest(scene, shape, *options),
            Self::PairsWithin(within, options) => pairs(scene, *within, *options),
            Self::ContactsWithin(within, options) => contacts(scene, *within, *options),
            Self::NearestBetween(others, options) => {
                let names = [["body", "other"], ["member", "other_member"]];
                nearest_pair([scene, others], names, scene.all().nearest_between(others, *options))
            }
            Self::LeastPair(options) => {
                let names = [["a", "b"], ["member_a", "member_b"]];
                nearest_pair([scene, scene], names, scene.all().least_pair(*options))
            }
            Self::AnyWithin(Some(shape), within, options) => {
                Ok(any_within(scene.all().any_within(shape, *within, *options)))
            }
            Self::AnyWithin(None, within, options) => Ok(any_within(scene.all().any_pair_within(*within, *options))),
        }
    }
}

/// The first hit of a cast, if there is one, and whether that is certain; `scalar` gives its λ or time, which the
/// format calls `name`.
fn first<V: Space, H>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    name: &'static str,
    cast: &SceneCast<H, V::Scalar>,
    scalar: impl FnOnce(&H) -> V::Scalar,
) -> Result<Answer, Problem> {
    if let Some(body) = cast.undecided {
        return Err(undecided(body));
    }
    let answer = Answer::default().with("hit", Field::Flag(cast.first.is_some()));
    let Some(first) = &cast.first else { return Ok(answer.with("certain", Field::Flag(true))) };
    Ok(hit_of(scene, answer, first, (name, scalar(&first.hit))))
}

/// With the body that is hit, the λ or time of it, its bracket, and whether it is certain.
fn hit_of<V: Space, H>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    answer: Answer,
    &BodyHit { body, member, lower, upper, .. }: &BodyHit<H, V::Scalar>,
    (name, scalar): (&'static str, V::Scalar),
) -> Answer {
    with_member(scene, answer.with("body", Field::Count(body)), "member", (body, member))
        .with(name, Field::number(scalar))
        .with_finite("lower", lower)
        .with_finite("upper", upper)
        .with_certain([lower, upper])
}

/// With the member that a body was, if that is a group: its index, or its indices from the outer group inwards.
fn with_member<V: Space>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    answer: Answer,
    name: &'static str,
    (body, member): (usize, Option<usize>),
) -> Answer {
    let path = member.and_then(|member| Some(scene.instance(body)?.group().path(member)));
    match path.as_deref() {
        None => answer,
        Some([index]) => answer.with(name, Field::Count(*index)),
        Some(indices) => answer.with(name, Field::Counts(indices.to_vec())),
    }
}

/// All hits of a ray, in its order.
fn every_hit<V: Space>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    ray: Ray<V>,
    options: RayCastOptions<V>,
) -> Result<Answer, Problem> {
    let mut hits = Vec::new();
    if let Some(body) = scene.all().ray_cast_all(ray, options, &mut hits).map_err(problem)?.undecided {
        return Err(undecided(body));
    }
    let one =
        |found: &BodyHit<RayHit<V>, V::Scalar>| hit_of(scene, Answer::default(), found, ("lambda", found.hit.lambda));
    Ok(Answer::default().with("hits", Field::Answers(hits.iter().map(one).collect())))
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
    let Some(found) = scene.all().nearest(shape, options).nearest else {
        return Ok(Answer::default().with("body", Field::Null).with("distance", Field::Null));
    };
    certain(&found.distance)?;
    let answer = Answer::default().with("body", Field::Count(found.body));
    Ok(with_member(scene, answer, "member", (found.body, found.member))
        .with("distance", Field::number(found.distance.distance))
        .with_finite("lower", found.distance.lower)
        .with_finite("upper", found.distance.upper))
}

/// The nearest pair, whose indices are called by the first names and whose members by the second; nulls where none is
/// within the limit.
fn nearest_pair<V: Space>(
    [scene_of_a, scene_of_b]: [&gjk_raycast::Scene<Solid<V>>; 2],
    [[a, b], [member_a, member_b]]: [[&'static str; 2]; 2],
    found: ScenePair<V>,
) -> Result<Answer, Problem> {
    let Some(found) = found.nearest else {
        return Ok(Answer::default().with(a, Field::Null).with(b, Field::Null).with("distance", Field::Null));
    };
    certain(&found.distance)?;
    let answer = Answer::default().with(a, Field::Count(found.a)).with(b, Field::Count(found.b));
    let answer = with_member(scene_of_a, answer, member_a, (found.a, found.member_a));
    Ok(with_member(scene_of_b, answer, member_b, (found.b, found.member_b))
        .with("distance", Field::number(found.distance.distance))
        .with_finite("lower", found.distance.lower)
        .with_finite("upper", found.distance.upper))
}

/// Whether any is within a distance, by the distances as they are answered. Rounding alone may leave it open whether
/// one that is exactly so far is within.
fn any_within<I>(found: SceneAnyWithin<I>) -> Answer {
    let certain = found.is_certain();
    Answer::default().with("any", Field::Flag(found.any)).with("certain", Field::Flag(certain))
}

/// The pairs no farther apart than `within`, each once, however many of their members are.
fn pairs<V: Space>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    within: V::Scalar,
    options: DistanceOptions<V>,
) -> Result<Answer, Problem> {
    let mut found = Vec::new();
    scene.all().pairs_within(within, options, &mut found);
    found.iter().try_for_each(|pair| certain(&pair.distance))?;
    let mut pairs: Vec<_> = found.iter().map(|pair| [pair.a, pair.b]).collect();
    pairs.sort_unstable();
    pairs.dedup();
    Ok(Answer::default().with("pairs", Field::Pairs(pairs)))
}

/// The contacts of the pairs no farther apart than `within`.
fn contacts<V: Space>(
    scene: &gjk_raycast::Scene<Solid<V>>,
    within: V::Scalar,
    options: SignedDistanceOptions<V>,
) -> Result<Answer, Problem> {
    let mut found = Vec::new();
    scene.all().contacts_within(within, options, &mut found);
    let one = |PairContact { a, b, member_a, member_b, contact }: &PairContact<V>| {
        let distance = &contact.distance;
        signed_distance::certain(distance, within).map_err(|why| why.at(&format!("bodies[{a}] and bodies[{b}]")))?;
        let answer = Answer::default().with("a", Field::Count(*a)).with("b", Field::Count(*b));
        let answer = with_member(scene, answer, "member_a", (*a, *member_a));
        Ok(with_member(scene, answer, "member_b", (*b, *member_b))
            .with("signed_distance", Field::number(distance.signed_distance))
            .with("normal", Field::vector(contact.normal))
            .with("points", Field::Count(contact.points().len()))
            .with_finite("lower", distance.lower)
            .with_finite("upper", distance.upper))
    };
    let contacts = found.iter().map(one).collect::<Result<_, Problem>>()?;
    Ok(Answer::default().with("contacts", Field::Answers(contacts)))
}
