//! `joint_box`.

use convex_support::Vector;
use gjk_raycast::{FreeBox, JointBoxOutcome, Linkage};

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
    robot: linkage::Linkage,
    pair: [usize; 2],
    intervals: Vec<[f64; 2]>,
    target_distance: f64,
}

impl Query for JointBox {
    const FIELDS: Names = &["joints", "links", "pair", "box", "target_distance"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            robot: linkage::Linkage::read(fields)?,
            pair: fields.get("pair")?,
            intervals: fields.get("box")?,
            target_distance: fields.not_negative("target_distance")?.unwrap_or(0.0),
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        how.method(&[("gjk", ())])?;
        Ok(Box::new(Ever::<V> {
            robot: self.robot.build(how.meshes)?,
            pair: self.pair,
            intervals: self.intervals.iter().map(|ends| ends.map(scalar::<V>)).collect(),
            target_distance: scalar::<V>(self.target_distance),
        }))
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
        let show = |FreeBox { bodies, joint_box, normal }: FreeBox<'_, V>| {
            let intervals = joint_box.iter().map(|ends| ends.map(Number::of).to_vec()).collect();
            let part = Answer::default()
                .with("body", Field::Count(bodies[0]))
                .with("other_body", Field::Count(bodies[1]))
                .with("box", Field::Rows(intervals));
            free.push(part.with("plane", Field::vector(normal)));
        };
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
        let meets = |meets| Answer::default().with("meets", Field::Flag(meets));
        let found = match answer.outcome {
            JointBoxOutcome::Never => meets(false),
            JointBoxOutcome::Meets { values, bodies } => meets(true)
                .with("values", Field::Numbers(values.into_iter().map(Number::of).collect()))
                .with("body", Field::Count(bodies[0]))
                .with("other_body", Field::Count(bodies[1])),
            JointBoxOutcome::Undecided { share } => {
                let boxes = answer.boxes;
                let message = format!(
                    "undecided_share {share}: so much of the box is not known to be free after a look at {boxes} parts of it"
                );
                return Err(Problem::new(Kind::NotConverged, message));
            }
        };
        Ok(found.with("boxes", Field::Count(answer.boxes)))
    }
}
