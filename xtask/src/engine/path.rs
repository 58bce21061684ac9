//! `path`.

use convex_support::Vector;
use gjk_raycast::{Linkage, Met, PathOptions, PathOutcome, PathStop, PathWorkspace, Scene};

use super::scene::{refused, scene_of};
use super::{Ask, How, Query, Question, scalar, status};
use crate::wire::answer::{Answer, Field};
use crate::wire::body::Body;
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::linkage::{self, problem};
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// The query as written.
pub(super) struct Path {
    robot: linkage::Linkage,
    waypoints: Vec<Vec<f64>>,
    obstacles: Vec<Body>,
    pairs: Vec<[usize; 2]>,
    target_distance: f64,
}

impl Query for Path {
    const FIELDS: Names = &["joints", "links", "waypoints", "obstacles", "self", "target_distance"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            robot: linkage::Linkage::read(fields)?,
            waypoints: fields.get("waypoints")?,
            obstacles: fields.each("obstacles")?.into_iter().map(Body::read).collect::<Result<_, _>>()?,
            pairs: fields.maybe("self")?.unwrap_or_default(),
            target_distance: fields.not_negative("target_distance")?.unwrap_or(0.0),
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let build = |(i, body): (usize, &Body)| body.build(&format!("obstacles[{i}]"), how.meshes);
        let obstacles = self.obstacles.iter().enumerate().map(build).collect::<Result<Vec<_>, _>>()?;
        let mut options = PathOptions::new().with_target_distance(scalar::<V>(self.target_distance));
        options.tolerance = how.tolerance::<V>()?.unwrap_or(options.tolerance);
        let pairs = self.pairs.iter().copied();
        Ok(Box::new(Way::<V> {
            robot: self.robot.build(how.meshes)?.with_pairs(pairs).map_err(problem)?,
            scene: scene_of(obstacles).map_err(|why| refused(why, "obstacles"))?,
            waypoints: self.waypoints.iter().map(|row| row.iter().map(|&value| scalar::<V>(value)).collect()).collect(),
            options,
        }))
    }
}

struct Way<V: Vector> {
    robot: Linkage<Solid<V>>,
    scene: Scene<Solid<V>>,
    waypoints: Vec<Vec<V::Scalar>>,
    options: PathOptions<V>,
}

impl<V: Space> Question for Way<V> {
    type Solution = gjk_raycast::Path<V>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        self.robot.path(&self.waypoints, &self.scene, self.options, &mut PathWorkspace::new()).map_err(problem)
    }

    fn answer(&self, path: Self::Solution) -> Result<Answer, Problem> {
        let answer = |free| Answer::default().with("free", Field::Flag(free));
        let answer = match path.outcome {
            PathOutcome::Free => answer(true).with("certain", Field::Flag(true)),
            PathOutcome::Contact(contact) => {
                let answer = answer(false)
                    .with("edge", Field::Count(contact.edge))
                    .with("time", Field::number(contact.time))
                    .with("link", Field::Count(contact.link))
                    .with("body", Field::Count(contact.body));
                let answer = match contact.met {
                    Met::Obstacle(obstacle) => answer.with("obstacle", Field::Count(obstacle)),
                    Met::Link { link, body } => {
                        answer.with("other_link", Field::Count(link)).with("other_body", Field::Count(body))
                    }
                };
                answer
                    .with("point", Field::vector(contact.point))
                    .with("normal", Field::maybe_vector(contact.normal))
                    .with_finite("lower", contact.lower)
                    .with_finite("upper", contact.upper)
                    .with_certain([contact.lower, contact.upper])
                    .with("status", status(contact.status))
            }
            PathOutcome::Undecided(PathStop { edge, lower, link, body, .. }) => {
                let message = format!(
                    "the path is free until {lower} of edge {edge}; whether body {body} of link {link} meets something \
                     from there on is not certain"
                );
                return Err(Problem::new(Kind::NotConverged, message));
            }
        };
        Ok(answer.with("casts", Field::Count(path.work.casts)))
    }
}
