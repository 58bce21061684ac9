//! `path`.

use convex_support::glam::{DVec2, DVec3};
use convex_support::{Scalar as _, Vector};
#[cfg(not(target_family = "wasm"))]
use cpu_time::ThreadTime;
use gjk_raycast::{
    BodyPair, FreeInterval, Linkage, Met, MotionCastOptions, MotionClearanceOptions, NearestOnPath, PathClearance,
    PathContact, PathWorkspace, Scene,
};
#[cfg(target_family = "wasm")]
use std::time::Instant as ThreadTime;

use super::motion_clearance::{free_part, of_met, with_points};
use super::{Ask, EVERY, How, Precision, Query, Question, clearance_plots, meeting, path_picture, scalar, status};
use crate::mesh::Meshes;
use crate::wire::answer::{Answer, Field};
use crate::wire::body::{Body, Built, refused, scene_of};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::{Dimension, Fields, Object, Written};
use crate::wire::linkage::{self, problem};
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// How often an edge is timed.
const RUNS: usize = 5;
/// The joints whose free box is drawn.
const BOX_JOINTS: [usize; 2] = [0, 1];

/// A robot among bodies at rest, as written, with the pairs of its own links that are tested.
pub(super) struct Surrounded {
    robot: linkage::Linkage,
    obstacles: Vec<Body>,
    pairs: Vec<[usize; 2]>,
}

/// A robot, and the bodies at rest around it.
type InScene<V> = (Linkage<Solid<V>>, Scene<Solid<V>>);

impl Surrounded {
    pub(super) fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            robot: linkage::Linkage::read(fields)?,
            obstacles: fields.each("obstacles")?.into_iter().map(Body::read).collect::<Result<_, _>>()?,
            pairs: fields.maybe("self")?.unwrap_or_default(),
        })
    }

    pub(super) fn build<V: Space>(&self, meshes: &Meshes) -> Result<InScene<V>, Problem> {
        let build = |(i, body): (usize, &Body)| body.build(&format!("obstacles[{i}]"), meshes).map(Built::Body);
        let obstacles = self.obstacles.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        let robot = self.robot.build(meshes)?.with_pairs(self.pairs.iter().copied()).map_err(problem)?;
        Ok((robot, scene_of(obstacles).map_err(|why| refused(why, "obstacles"))?))
    }
}

/// The query as written.
pub(super) struct Path {
    robot: Surrounded,
    waypoints: Vec<Vec<f64>>,
    target_distance: f64,
    clearance: bool,
}

impl Query for Path {
    const FIELDS: Names = &["joints", "links", "waypoints", "obstacles", "self", "target_distance", "clearance"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            robot: Surrounded::read(fields)?,
            waypoints: fields.get("waypoints")?,
            target_distance: fields.not_negative("target_distance")?.unwrap_or(0.0),
            clearance: fields.flag("clearance")?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        Ok(Box::new(self.way::<V>(how)?))
    }
}

impl Path {
    /// The way of the robot in a space.
    fn way<V: Space>(&self, how: &How<'_>) -> Result<Way<V>, Problem> {
        how.method(&[("gjk", ())])?;
        let (robot, scene) = self.robot.build(how.meshes)?;
        let mut options = MotionCastOptions::new().with_target_distance(scalar::<V>(self.target_distance));
        options.tolerance = how.tolerance::<V>()?.unwrap_or(options.tolerance);
        let mut of_clearance = MotionClearanceOptions::new();
        of_clearance.tolerance = how.tolerance::<V>()?.unwrap_or(of_clearance.tolerance);
        Ok(Way {
            robot,
            scene,
            waypoints: self.waypoints.iter().map(|row| row.iter().map(|&value| scalar::<V>(value)).collect()).collect(),
            options,
            clearance: self.clearance.then_some(of_clearance),
        })
    }
}

struct Way<V: Vector> {
    robot: Linkage<Solid<V>>,
    scene: Scene<Solid<V>>,
    waypoints: Vec<Vec<V::Scalar>>,
    options: MotionCastOptions<V>,
    /// The options of the clearance, if it is asked for.
    clearance: Option<MotionClearanceOptions<V>>,
}

impl<V: Space> Question for Way<V> {
    type Solution = (gjk_raycast::Path<V>, Option<PathClearance<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let mut workspace = PathWorkspace::new();
        let path = self.robot.path(&self.waypoints, &self.scene, self.options, &mut workspace).map_err(problem)?;
        let ask = |options| self.robot.path_clearance(&self.waypoints, &self.scene, options, &mut workspace);
        Ok((path, self.clearance.map(ask).transpose().map_err(problem)?))
    }

    /// It is watched, so that brackets are those of what is shown.
    fn prove(&self) -> Result<(Self::Solution, Option<Answer>), Problem> {
        let (path, free) = self.watched(self.options)?;
        let met = path.contact().and_then(|(contact, _)| self.met(&contact)).unwrap_or_default();
        let proof = met.with("free", Field::Answers(free));
        let clearance = self.solve()?.1;
        let nearest = clearance.and_then(|clearance| clearance.nearest).map(|nearest| self.certificate_of(&nearest));
        Ok((
            (path, clearance),
            Some(match nearest.transpose()? {
                Some(nearest) => proof.with("clearance", Field::Answer(nearest)),
                None => proof,
            }),
        ))
    }

    /// The same path, not watched.
    fn beside(&self, _: &Self::Solution) -> String {
        format!("{:?}", self.solve())
    }

    fn answer(&self, (path, clearance): Self::Solution) -> Result<Answer, Problem> {
        let answer = |free| Answer::default().with("free", Field::Flag(free));
        let answer = match (path.contact(), path.first) {
            (Some((contact, hit)), _) => {
                let answer = answer(false)
                    .with("edge", Field::Count(contact.edge))
                    .with("time", Field::number(hit.time))
                    .with("link", Field::Count(contact.link))
                    .with("body", Field::Count(contact.body));
                of_what(answer, contact.met)
                    .with("point", Field::vector(hit.point))
                    .with("normal", Field::maybe_vector(hit.normal))
                    .with_finite("lower", contact.cast.lower)
                    .with_finite("upper", contact.cast.upper)
                    .with_certain([contact.cast.lower, contact.cast.upper])
                    .with("status", status(contact.cast.status))
            }
            (None, Some(PathContact { edge, link, body, cast, .. })) => {
                let message = format!(
                    "the path is free until {} of edge {edge}; whether body {body} of link {link} meets something \
                     from there on is not certain",
                    cast.lower
                );
                return Err(Problem::new(Kind::NotConverged, message));
            }
            (None, None) => answer(true).with("certain", Field::Flag(true)),
        };
        let answer = answer.with("casts", Field::Count(path.casts));
        let nearest = clearance.and_then(|clearance| clearance.nearest);
        Ok(match nearest {
            Some(nearest) => answer.with("clearance", Field::Answer(of_clearance(nearest))),
            None => answer,
        })
    }
}

/// The least distance along a path.
fn of_clearance<V: Space>(NearestOnPath { edge, link, body, met, least }: NearestOnPath<V>) -> Answer {
    let answer = Answer::default()
        .with("distance", Field::number(least.distance))
        .with("edge", Field::Count(edge))
        .with("time", Field::number(least.time))
        .with("link", Field::Count(link))
        .with("body", Field::Count(body));
    with_points(of_what(answer, met), &least)
}

impl<V: Space> Way<V> {
    /// The path, and the intervals that prove what is free.
    fn watched(&self, options: MotionCastOptions<V>) -> Result<(gjk_raycast::Path<V>, Vec<Answer>), Problem> {
        let mut free = Vec::new();
        let show = |FreeInterval { edge, from, to, link, body, met, normals }: FreeInterval<V>| {
            let part = Answer::default().with("edge", Field::Count(edge)).with("link", Field::Count(link));
            free.push(free_part(of_what(part.with("body", Field::Count(body)), met), [from, to], normals));
        };
        let mut workspace = PathWorkspace::new();
        let path = self.robot.path_with(&self.waypoints, &self.scene, options, &mut workspace, show);
        Ok((path.map_err(problem)?, free))
    }

    /// What proves a least distance: that the path is free with its lower bound for a target distance, and points of
    /// the bodies at its time; of a contact the bracket of its time, and points at the end of that.
    fn certificate_of(
        &self,
        &NearestOnPath { edge, link, body, met, least }: &NearestOnPath<V>,
    ) -> Result<Answer, Problem> {
        let zero = V::Scalar::ZERO;
        let meets = least.upper == zero;
        let (contact, free) = if meets || least.lower > zero {
            let (path, free) = self.watched(self.options.with_target_distance(least.lower))?;
            (path.first.filter(|_| meets).map(|first| first.cast), free)
        } else {
            (None, Vec::new())
        };
        let at = contact.map_or(least.time, |cast| cast.upper);
        let points = self.meeting_at((edge, at), BodyPair { link, body, met }).unwrap_or_default();
        let met = contact.map(|cast| [cast.lower, cast.upper]);
        Ok(of_met(points, met).with("free", Field::Answers(free)))
    }

    /// What proves that the bodies of a contact meet at the end of its bracket, if it has one. A half-space needs no
    /// proof.
    fn met(&self, &PathContact { edge, link, body, met, cast }: &PathContact<V>) -> Option<Answer> {
        self.meeting_at((edge, cast.upper), BodyPair { link, body, met })
    }

    /// The same of any two bodies at a time of an edge.
    fn meeting_at(&self, (edge, time): (usize, V::Scalar), bodies: BodyPair) -> Option<Answer> {
        // A contact at a waypoint may be one that the next edge has shown.
        let one = V::Scalar::ONE;
        let (edge, time) = if time > one { (edge + 1, time - one) } else { (edge, time) };
        let [from, to] = [edge, edge + 1].map(|end| &self.waypoints[end.min(self.waypoints.len() - 1)]);
        let values: Vec<_> = from.iter().zip(to).map(|(&from, &to)| from + (to - from) * time).collect();
        meeting_of(&self.robot, &self.scene, &values, bodies)
    }
}

/// What proves how near two bodies are at joint values.
pub(super) fn meeting_of<V: Space>(
    robot: &Linkage<Solid<V>>,
    scene: &Scene<Solid<V>>,
    values: &[V::Scalar],
    BodyPair { link, body, met }: BodyPair,
) -> Option<Answer> {
    let placed = |link, body| robot.placed(link, body, values).ok();
    let a = placed(link, body)?;
    Some(match met {
        Met::Obstacle(obstacle) => meeting(&a, scene.get(obstacle)?.convex()?),
        Met::Member { obstacle, member } => meeting(&a, &scene.member(obstacle, member)?),
        Met::Link { link, body } => meeting(&a, &placed(link, body)?),
    })
}

/// With what is met, or not.
pub(super) fn of_what(answer: Answer, met: Met) -> Answer {
    match met {
        Met::Obstacle(obstacle) | Met::Member { obstacle, .. } => answer.with("obstacle", Field::Count(obstacle)),
        Met::Link { link, body } => {
            answer.with("other_link", Field::Count(link)).with("other_body", Field::Count(body))
        }
    }
}

/// How far apart planners test poses, along the joint values and in radians or metres. A common rule takes one per cent
/// of the diagonal of all joint limits, which is 0.13 rad for a Panda; careful ones take 1/32 or 1/128.
pub const STEPS: [f64; 3] = [0.13, 1.0 / 32.0, 1.0 / 128.0];

/// What is known of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    Free,
    Contact,
    Undecided,
}

/// An edge of a path, asked alone.
#[derive(Clone, Copy, Debug)]
pub struct EdgeReport {
    pub verdict: Verdict,
    /// The least of a few runs.
    pub nanoseconds: f64,
    /// Whether poses along it, at each of the steps, are all free.
    pub sampled_free: [bool; STEPS.len()],
}

/// The edges of a `path` query, one by one, in double precision; beside each what poses along it say, for each of the
/// [`STEPS`].
///
/// # Errors
/// Where the query is none.
pub fn edges(object: &Object, meshes: &Meshes) -> Result<Vec<EdgeReport>, Problem> {
    let dimension = Dimension::default();
    let fields = Written::new(object, &dimension).fields(EVERY, Path::FIELDS)?;
    let query = Path::read(&fields)?;
    let how = How { precision: Precision::F64, tol: None, method: None, meshes };
    match dimension.known() {
        Some(2) => query.way::<DVec2>(&how)?.edges(),
        _ => query.way::<DVec3>(&how)?.edges(),
    }
}

/// Pictures of the way of a `path` query, `<svg>` elements.
#[derive(Clone, Debug)]
pub enum Pictures {
    /// The way, and where it touches something.
    Touching(String),
    /// How near it comes to anything, and how far two joint values may change in the middle of its first edge.
    Free([String; 2]),
}

/// The way of a `path` query in pictures; `None` in the plane, if it is undecided, or if it is free and its robot has
/// one joint, or nothing to come near to.
///
/// # Errors
/// Where the query is none.
pub fn pictures(object: &Object, meshes: &Meshes) -> Result<Option<Pictures>, Problem> {
    let dimension = Dimension::default();
    let fields = Written::new(object, &dimension).fields(EVERY, Path::FIELDS)?;
    let query = Path::read(&fields)?;
    if dimension.known() == Some(2) {
        return Ok(None);
    }
    let way = query.way::<DVec3>(&How { precision: Precision::F64, tol: None, method: None, meshes })?;
    let path = way.solve()?.0;
    let Way { robot, scene, waypoints, .. } = &way;
    if let contact @ Some(_) = path.contact() {
        return Ok(path_picture::svg(robot, scene, waypoints, contact).map(Pictures::Touching));
    }
    if !path.is_free() || robot.values() <= BOX_JOINTS[1] {
        return Ok(None);
    }
    let Some(near) = clearance_plots::along_way(robot, scene, waypoints).map_err(problem)? else { return Ok(None) };
    let [from, to] = [0, 1].map(|end: usize| &waypoints[end.min(waypoints.len() - 1)]);
    let middle: Vec<f64> = from.iter().zip(to).map(|(&a, &b)| f64::midpoint(a, b)).collect();
    let grown = clearance_plots::grown_box(robot, scene, &middle, BOX_JOINTS).map_err(problem)?;
    Ok(Some(Pictures::Free([near.file(), grown.file()])))
}

impl<V: Space<Scalar = f64>> Way<V> {
    fn edges(&self) -> Result<Vec<EdgeReport>, Problem> {
        let mut workspace = PathWorkspace::new();
        let mut ask = |waypoints: &[Vec<f64>]| {
            self.robot.path(waypoints, &self.scene, self.options, &mut workspace).map_err(problem)
        };
        let mut reports = Vec::new();
        for edge in self.waypoints.windows(2) {
            let mut nanoseconds = f64::INFINITY;
            for _ in 0..RUNS {
                let start = ThreadTime::now();
                std::hint::black_box(&ask(edge)?);
                nanoseconds = nanoseconds.min(start.elapsed().as_nanos() as f64);
            }
            let verdict = match ask(edge)? {
                path if path.is_free() => Verdict::Free,
                path if path.contact().is_some() => Verdict::Contact,
                _ => Verdict::Undecided,
            };
            let length = edge[0].iter().zip(&edge[1]).map(|(a, b)| (b - a) * (b - a)).sum::<f64>().sqrt();
            let mut sampled_free = [true; STEPS.len()];
            for (is_free, step) in sampled_free.iter_mut().zip(STEPS) {
                let count = (length / step).ceil().max(1.0) as usize;
                for k in 0..=count {
                    let part = k as f64 / count as f64;
                    let pose = edge[0].iter().zip(&edge[1]).map(|(a, b)| a + (b - a) * part).collect();
                    *is_free &= ask(&[pose])?.is_free();
                    if !*is_free {
                        break;
                    }
                }
            }
            reports.push(EdgeReport { verdict, nanoseconds, sampled_free });
        }
        Ok(reports)
    }
}
