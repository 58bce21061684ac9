//! `joint_box`.

use convex_support::{Scalar, Vector};
use gjk_raycast::{BodyPair, FaceStop, FreeBox, JointBoxOutcome, Linkage, Scene};

use super::path::{Surrounded, meeting_of, of_what};
use super::{Ask, How, Query, Question, meeting, scalar};
use crate::wire::answer::{Answer, Field, Number};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::linkage::{self, problem};
use crate::wire::names::Names;
use crate::wire::shape::{Solid, Space};

/// Parts of a box to look at, after which to give up.
const MAX_BOXES: usize = 100_000;

/// The query as written.
pub(super) struct JointBox {
    about: About,
    intervals: Vec<[f64; 2]>,
    target_distance: f64,
    /// The joint values to grow a free box around, within the box.
    grow: Option<Vec<f64>>,
}

/// Which links, and what they may meet.
enum About {
    Pair(linkage::Linkage, [usize; 2]),
    Scene(Surrounded),
}

impl Query for JointBox {
    const FIELDS: Names = &["joints", "links", "pair", "obstacles", "self", "box", "target_distance", "grow"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        let about = match fields.only_one_of(&["pair", "obstacles"])? {
            "obstacles" => About::Scene(Surrounded::read(fields)?),
            _ if fields.has("self") || fields.has("grow") => {
                let message = "self and grow stand beside obstacles, which may be empty, and not beside pair";
                return Err(Problem::new(Kind::UnknownField, message.to_owned()));
            }
            _ => About::Pair(linkage::Linkage::read(fields)?, fields.get("pair")?),
        };
        Ok(Self {
            about,
            intervals: fields.get("box")?,
            target_distance: fields.not_negative("target_distance")?.unwrap_or(0.0),
            grow: fields.maybe("grow")?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        let intervals = self.intervals.iter().map(|ends| ends.map(scalar::<V>)).collect();
        let target_distance = scalar::<V>(self.target_distance);
        Ok(match &self.about {
            About::Pair(robot, pair) => {
                Box::new(Ever::<V> { robot: robot.build(how.meshes)?, pair: *pair, intervals, target_distance })
            }
            About::Scene(robot) => {
                let (robot, scene) = robot.build(how.meshes)?;
                let among = EverAmong::<V> { robot, scene, intervals, target_distance };
                match &self.grow {
                    None => Box::new(among),
                    Some(values) => {
                        let values = values.iter().map(|&value| scalar::<V>(value)).collect();
                        Box::new(Grown::<V> { among, values })
                    }
                }
            }
        })
    }
}

struct Ever<V: Vector> {
    robot: Linkage<Solid<V>>,
    pair: [usize; 2],
    intervals: Vec<[V::Scalar; 2]>,
    target_distance: V::Scalar,
}

impl<V: Space> Question for Ever<V> {
    type Solution = gjk_raycast::JointBox<V::Scalar>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        self.robot.joint_box(self.pair, &self.intervals, self.target_distance, MAX_BOXES).map_err(problem)
    }

    fn prove(&self) -> Result<(Self::Solution, Option<Answer>), Problem> {
        let mut free = Vec::new();
        let show = |part: FreeBox<'_, V>| free.push(free_part(&part, of_pair(Answer::default(), part.bodies)));
        let solution = self
            .robot
            .joint_box_with(self.pair, &self.intervals, self.target_distance, MAX_BOXES, show)
            .map_err(problem)?;
        let met = match &solution.outcome {
            JointBoxOutcome::Meets { values, bodies } => {
                let placed = |end: usize| self.robot.placed(self.pair[end], bodies[end], values).map_err(problem);
                meeting(&placed(0)?, &placed(1)?)
            }
            _ => Answer::default(),
        };
        Ok((solution, Some(met.with("free", Field::Answers(free)))))
    }

    fn answer(&self, answer: Self::Solution) -> Result<Answer, Problem> {
        of_search(answer, of_pair)
    }
}

struct EverAmong<V: Vector> {
    robot: Linkage<Solid<V>>,
    scene: Scene<Solid<V>>,
    intervals: Vec<[V::Scalar; 2]>,
    target_distance: V::Scalar,
}

impl<V: Space> Question for EverAmong<V> {
    type Solution = gjk_raycast::JointBox<V::Scalar, BodyPair>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let Self { robot, scene, intervals, target_distance } = self;
        robot.joint_box_among(scene, intervals, *target_distance, MAX_BOXES).map_err(problem)
    }

    fn prove(&self) -> Result<(Self::Solution, Option<Answer>), Problem> {
        let Self { robot, scene, .. } = self;
        let (solution, free) = self.watched(&self.intervals)?;
        let met = match &solution.outcome {
            JointBoxOutcome::Meets { values, bodies } => meeting_of(robot, scene, values, *bodies).unwrap_or_default(),
            _ => Answer::default(),
        };
        Ok((solution, Some(met.with("free", Field::Answers(free)))))
    }

    fn answer(&self, answer: Self::Solution) -> Result<Answer, Problem> {
        of_search(answer, of_bodies)
    }
}

impl<V: Space> EverAmong<V> {
    /// The answer about a box, and the parts that prove that it is free.
    #[allow(clippy::type_complexity, reason = "the type is written once")]
    fn watched(
        &self,
        intervals: &[[V::Scalar; 2]],
    ) -> Result<(gjk_raycast::JointBox<V::Scalar, BodyPair>, Vec<Answer>), Problem> {
        let mut free = Vec::new();
        let show =
            |part: FreeBox<'_, V, BodyPair>| free.push(free_part(&part, of_bodies(Answer::default(), part.bodies)));
        let found = self.robot.joint_box_among_with(&self.scene, intervals, self.target_distance, MAX_BOXES, show);
        Ok((found.map_err(problem)?, free))
    }
}

/// A box to be grown around joint values.
struct Grown<V: Vector> {
    among: EverAmong<V>,
    values: Vec<V::Scalar>,
}

impl<V: Space> Question for Grown<V> {
    type Solution = gjk_raycast::GrownBox<V::Scalar>;

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let EverAmong { robot, scene, intervals, target_distance } = &self.among;
        robot.grown_box(&self.values, scene, intervals, *target_distance, MAX_BOXES).map_err(problem)
    }

    fn prove(&self) -> Result<(Self::Solution, Option<Answer>), Problem> {
        let grown = self.solve()?;
        let EverAmong { robot, scene, .. } = &self.among;
        let (_, free) = self.among.watched(&grown.joint_box)?;
        let met = |stop: &FaceStop<V::Scalar>| match stop {
            FaceStop::Bodies { bodies, values: Some(values) } => {
                meeting_of(robot, scene, values, *bodies).unwrap_or_default()
            }
            _ => Answer::default(),
        };
        let stops = Field::Answers(grown.stops.iter().flatten().map(met).collect());
        Ok((grown, Some(Answer::default().with("free", Field::Answers(free)).with("stops", stops))))
    }

    fn answer(&self, grown: Self::Solution) -> Result<Answer, Problem> {
        let stops = grown.stops.into_iter().flatten().map(|stop| match stop {
            FaceStop::Limit => Answer::default().with("by", Field::Text("limit")),
            FaceStop::Work => Answer::default().with("by", Field::Text("work")),
            FaceStop::Bodies { bodies, values } => {
                let answer = of_bodies(Answer::default().with("by", Field::Text("bodies")), bodies);
                match values {
                    Some(values) => answer.with("values", Field::Numbers(values.into_iter().map(Number::of).collect())),
                    None => answer,
                }
            }
        });
        let intervals = grown.joint_box.into_iter().map(|ends| ends.map(Number::of).to_vec()).collect();
        Ok(Answer::default()
            .with("grown", Field::Rows(intervals))
            .with("stops", Field::Answers(stops.collect()))
            .with("boxes", Field::Count(grown.boxes)))
    }
}

/// A part of a proof: a box of joint values, and what separates two bodies in it.
fn free_part<V: Space, P>(FreeBox { joint_box, normal, .. }: &FreeBox<'_, V, P>, bodies: Answer) -> Answer {
    let intervals = joint_box.iter().map(|ends| ends.map(Number::of).to_vec()).collect();
    bodies.with("box", Field::Rows(intervals)).with("plane", Field::vector(*normal))
}

/// With the names of the bodies of a pair of links.
fn of_pair(answer: Answer, [body, other]: [usize; 2]) -> Answer {
    answer.with("body", Field::Count(body)).with("other_body", Field::Count(other))
}

/// With the names of two bodies.
fn of_bodies(answer: Answer, BodyPair { link, body, met }: BodyPair) -> Answer {
    of_what(answer.with("link", Field::Count(link)).with("body", Field::Count(body)), met)
}

/// What became of a search, with the names of the bodies that meet.
fn of_search<S: Scalar, P>(
    found: gjk_raycast::JointBox<S, P>,
    name: impl Fn(Answer, P) -> Answer,
) -> Result<Answer, Problem> {
    let (boxes, meets) = (found.boxes, |meets| Answer::default().with("meets", Field::Flag(meets)));
    let answer = match found.outcome {
        JointBoxOutcome::Never => meets(false),
        JointBoxOutcome::Meets { values, bodies } => {
            let values = values.into_iter().map(Number::of).collect();
            name(meets(true).with("values", Field::Numbers(values)), bodies)
        }
        JointBoxOutcome::Undecided { share } => {
            let message = format!(
                "undecided_share {share}: so much of the box is not known to be free after a look at {boxes} parts of it"
            );
            return Err(Problem::new(Kind::NotConverged, message));
        }
    };
    Ok(answer.with("boxes", Field::Count(boxes)))
}
