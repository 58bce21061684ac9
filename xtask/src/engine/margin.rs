//! `margin`, `track` and `clearance`.

use convex_support::{Ellipsoid, Vector};
#[cfg(feature = "paper")]
use ellip_margin::InverseIterationTracker;
#[cfg(feature = "paper")]
use ellip_margin::eigen::free_margin_eigen;
use ellip_margin::{
    Clearance, ClearanceResult, Margin, MarginGradient, MarginOptions, MarginTracker, Status, clearance, free_margin,
};

use super::Question;
use super::method::choose;
use crate::wire::answer::{Answer, Field, Number};
use crate::wire::error::{Kind, Problem};
use crate::wire::query::Pose;
use crate::wire::shape::{EllipsoidSpec, Space};

fn options(tol: Option<f64>) -> MarginOptions {
    let mut options = MarginOptions::default();
    options.tolerance = tol.unwrap_or(options.tolerance);
    options
}

/// Says that the iteration of a margin did not get as far as it was to.
fn certain(status: Status, iterations: usize) -> Result<(), Problem> {
    match status {
        Status::Converged => Ok(()),
        Status::IterationLimit => {
            Err(Problem::new(Kind::NotConverged, format!("the margin was not found in {iterations} iterations")))
        }
        Status::Stalled => {
            let message = format!("the iteration for the margin made no progress after {iterations} iterations");
            Err(Problem::new(Kind::NotConverged, message))
        }
    }
}

pub(super) struct MarginQuestion<V: Vector> {
    e1: Ellipsoid<V>,
    e2: Ellipsoid<V>,
    gradient: bool,
    options: MarginOptions,
    method: MarginMethod,
}

#[derive(Clone, Copy)]
enum MarginMethod {
    /// The secular equation.
    Secular,
    /// The paper's 2N×2N eigenvalue problem.
    #[cfg(feature = "paper")]
    Eigen,
}

impl<V: Space> MarginQuestion<V> {
    pub(super) fn new(
        [e1, e2]: [&EllipsoidSpec; 2],
        gradient: bool,
        tol: Option<f64>,
        method: Option<&str>,
    ) -> Result<Self, Problem> {
        let methods = [
            ("secular", MarginMethod::Secular),
            #[cfg(feature = "paper")]
            ("eigen", MarginMethod::Eigen),
        ];
        let method = choose(method, &methods)?;
        Ok(Self { e1: e1.build("e1")?, e2: e2.build("e2")?, gradient, options: options(tol), method })
    }
}

impl<V: Space> Question for MarginQuestion<V> {
    type Solution = (Margin<V>, Option<MarginGradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let margin = match self.method {
            MarginMethod::Secular => free_margin(&self.e1, &self.e2, self.options),
            #[cfg(feature = "paper")]
            MarginMethod::Eigen => free_margin_eigen(&self.e1, &self.e2),
        };
        Ok((margin, self.gradient.then(|| margin.gradient(&self.e1, &self.e2))))
    }

    fn answer(&self, (margin, gradient): Self::Solution) -> Result<Answer, Problem> {
        certain(margin.status, margin.iterations)?;
        let mut answer = Answer::default()
            .with("margin", Field::number(margin.margin))
            // −ν, and 0 rather than −0 where the centre is inside.
            .with("lambda", Field::number(V::ZERO.get(0) - margin.nu))
            .with("point", Field::vector(margin.point));
        if let Some(gradient) = gradient {
            let rotation: Vec<Number> = V::coordinates(&gradient.rotation).iter().map(|&c| Number::of(c)).collect();
            let rotation = match rotation[..] {
                [number] => Field::Number(number),
                _ => Field::Numbers(rotation),
            };
            answer = answer
                .with("gradient_translation", Field::vector(gradient.translation))
                .with("gradient_rotation", rotation);
        }
        Ok(answer.with("iterations", Field::Count(margin.iterations)))
    }
}

/// One ellipsoid along a trajectory.
pub(super) struct TrackQuestion<V: Vector> {
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

/// The change of the unit eigenvector at which the inverse iteration ends, and the most steps: the eigenvalue's error is
/// of second order in it.
#[cfg(feature = "paper")]
const INVERSE: (f64, usize) = (1e-8, 40);

impl<V: Space> TrackQuestion<V> {
    pub(super) fn new(
        [e1, e2]: [&EllipsoidSpec; 2],
        poses: &[Pose],
        tol: Option<f64>,
        method: Option<&str>,
    ) -> Result<Self, Problem> {
        let methods = [
            ("newton", Tracker::Newton(MarginTracker::new(options(tol)))),
            #[cfg(feature = "paper")]
            ("inverse", Tracker::Inverse(InverseIterationTracker::new(tol.unwrap_or(INVERSE.0), INVERSE.1))),
        ];
        let tracker = choose(method, &methods)?;
        let at = |(i, pose)| e1.build_posed("e1", pose, &format!("poses[{i}]"));
        let moving = poses.iter().enumerate().map(at).collect::<Result<_, _>>()?;
        Ok(Self { moving, e2: e2.build("e2")?, tracker })
    }
}

impl<V: Space> Question for TrackQuestion<V> {
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

/// All links against all obstacles.
pub(super) struct ClearanceQuestion<V: Vector> {
    links: Vec<Ellipsoid<V>>,
    obstacles: Vec<Ellipsoid<V>>,
    options: MarginOptions,
    method: ClearanceMethod,
}

#[derive(Clone, Copy)]
enum ClearanceMethod {
    /// A tree of the obstacles, and only the pairs that can be the least.
    Culled,
    /// Every pair.
    AllPairs,
}

impl<V: Space> ClearanceQuestion<V> {
    pub(super) fn new(
        links: &[EllipsoidSpec],
        obstacles: &[EllipsoidSpec],
        tol: Option<f64>,
        method: Option<&str>,
    ) -> Result<Self, Problem> {
        let method = choose(method, &[("culled", ClearanceMethod::Culled), ("all_pairs", ClearanceMethod::AllPairs)])?;
        let build = |name: &str, of: &[EllipsoidSpec]| -> Result<Vec<Ellipsoid<V>>, Problem> {
            of.iter().enumerate().map(|(i, spec)| spec.build(&format!("{name}[{i}]"))).collect()
        };
        Ok(Self {
            links: build("links", links)?,
            obstacles: build("obstacles", obstacles)?,
            options: options(tol),
            method,
        })
    }
}

impl<V: Space> Question for ClearanceQuestion<V> {
    type Solution = ClearanceResult<V>;

    fn solve(&self) -> Result<ClearanceResult<V>, Problem> {
        match self.method {
            ClearanceMethod::Culled => {
                Clearance::new(&self.obstacles, self.options).and_then(|mut clearance| clearance.step(&self.links))
            }
            ClearanceMethod::AllPairs => clearance(&self.links, &self.obstacles, self.options),
        }
        .map_err(|why| Problem::new(Kind::InvalidShape, why.to_string()))
    }

    fn answer(&self, least: ClearanceResult<V>) -> Result<Answer, Problem> {
        certain(least.margin.status, least.margin.iterations)?;
        Ok(Answer::default()
            .with("min_margin", Field::number(least.margin.margin))
            .with("link", Field::Count(least.link))
            .with("obstacle", Field::Count(least.obstacle))
            .with("pairs_evaluated", Field::Count(least.pairs_evaluated)))
    }
}
