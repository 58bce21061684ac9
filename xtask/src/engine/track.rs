//! `track`.

use convex_support::{Ellipsoid, Vector};
#[cfg(feature = "paper")]
use ellip_margin::paper::InverseIterationTracker;
use ellip_margin::{Margin, MarginTracker};

#[cfg(feature = "paper")]
use super::margin::invalid;
use super::margin::{certain, options};
use super::{Ask, How, Query, Question};
use crate::wire::answer::{Answer, Field, Number};
use crate::wire::error::Problem;
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{EllipsoidSpec, Pose, Space};

/// The query as written.
pub(super) struct Track {
    e1: EllipsoidSpec,
    e2: EllipsoidSpec,
    poses: Vec<Pose>,
}

impl Query for Track {
    const FIELDS: Names = &["e1", "e2", "poses"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            e1: EllipsoidSpec::read(fields.within("e1")?)?,
            e2: EllipsoidSpec::read(fields.within("e2")?)?,
            poses: fields.each("poses")?.into_iter().map(Pose::read).collect::<Result<_, _>>()?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        let tracker = how.method(&[
            ("newton", Tracker::Newton(MarginTracker::new(options(how.tol)?))),
            #[cfg(feature = "paper")]
            ("inverse", {
                let tracker = InverseIterationTracker::new(how.tol.unwrap_or(INVERSE.0), INVERSE.1);
                Tracker::Inverse(tracker.map_err(invalid)?)
            }),
        ])?;
        let at = |(i, pose)| self.e1.build_posed("e1", pose, &format!("poses[{i}]"));
        let moving = self.poses.iter().enumerate().map(at).collect::<Result<_, _>>()?;
        Ok(Box::new(Trajectory::<V> { moving, e2: self.e2.build("e2")?, tracker }))
    }
}

/// One ellipsoid along a trajectory.
struct Trajectory<V: Vector> {
    /// E₁ at every pose.
    moving: Vec<Ellipsoid<V>>,
    e2: Ellipsoid<V>,
    tracker: Tracker,
}

#[derive(Clone, Copy)]
enum Tracker {
    /// Newton's method for the secular equation, started from the last pose.
    Newton(MarginTracker),
    /// The paper's inverse iteration.
    #[cfg(feature = "paper")]
    Inverse(InverseIterationTracker),
}

/// The change of the unit eigenvector at which the inverse iteration ends, and the most steps: the eigenvalue's error
/// is of second order in it.
#[cfg(feature = "paper")]
const INVERSE: (f64, usize) = (1e-8, 40);

impl<V: Space> Question for Trajectory<V> {
    type Solution = (Vec<Margin<V>>, u64);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        Ok(match self.tracker {
            // Newton's method converges from any start: there is nothing to fall back on.
            Tracker::Newton(mut tracker) => (self.moving.iter().map(|e1| tracker.step(e1, &self.e2)).collect(), 0),
            #[cfg(feature = "paper")]
            Tracker::Inverse(mut tracker) => {
                let margins = self.moving.iter().map(|e1| tracker.step(e1, &self.e2)).collect();
                (margins, tracker.fallbacks())
            }
        })
    }

    fn answer(&self, (margins, fallbacks): Self::Solution) -> Result<Answer, Problem> {
        for (i, margin) in margins.iter().enumerate() {
            certain(margin.status, margin.iterations)
                .map_err(|problem| Problem::new(problem.kind, format!("poses[{i}]: {}", problem.message)))?;
        }
        Ok(Answer::default()
            .with("margins", Field::Numbers(margins.iter().map(|m| Number::of(m.margin)).collect()))
            .with("iterations", Field::Counts(margins.iter().map(|m| m.iterations).collect()))
            .with("fallbacks", Field::Count(fallbacks as usize)))
    }
}
