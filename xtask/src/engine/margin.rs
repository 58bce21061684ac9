//! `margin`, and what the other queries of ellipsoids share with it.

use convex_support::{Ellipsoid, Vector};
#[cfg(feature = "paper")]
use ellip_margin::paper::free_margin_eigen;
use ellip_margin::{EllipsoidPair, InvalidQuery, MarginOptions, MotionGradient, Status, free_margins};

use super::gradient::moment;
use super::{Ask, How, Query, Question};
use crate::wire::answer::{Answer, Field};
use crate::wire::error::{Kind, Problem};
use crate::wire::fields::Fields;
use crate::wire::names::Names;
use crate::wire::shape::{EllipsoidSpec, Space};

pub(super) fn options(tol: Option<f64>) -> Result<MarginOptions, Problem> {
    let options = MarginOptions::default();
    tol.map_or(Ok(options), |tol| options.with_tolerance(tol).map_err(invalid))
}

pub(super) fn invalid(why: InvalidQuery) -> Problem {
    Problem::new(Kind::Parse, why.to_string())
}

/// Says that the iteration of a margin did not get as far as it was to.
pub(super) fn certain(status: Status, iterations: usize) -> Result<(), Problem> {
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

/// The query as written.
pub(super) struct Margin {
    e1: EllipsoidSpec,
    e2: EllipsoidSpec,
    gradient: bool,
}

#[derive(Clone, Copy)]
enum Method {
    /// The secular equation.
    Secular,
    /// The paper's 2N×2N eigenvalue problem.
    #[cfg(feature = "paper")]
    Eigen,
}

impl Query for Margin {
    const FIELDS: Names = &["e1", "e2", "gradient"];

    fn read(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self {
            e1: EllipsoidSpec::read(fields.within("e1")?)?,
            e2: EllipsoidSpec::read(fields.within("e2")?)?,
            gradient: fields.flag("gradient")?,
        })
    }

    fn question<V: Space>(&self, how: &How<'_>) -> Result<Box<dyn Ask>, Problem> {
        let method = how.method(&[
            ("secular", Method::Secular),
            #[cfg(feature = "paper")]
            ("eigen", Method::Eigen),
        ])?;
        let (e1, e2) = (self.e1.build("e1")?, self.e2.build("e2")?);
        Ok(Box::new(Pair::<V> { e1, e2, gradient: self.gradient, options: options(how.tol)?, method }))
    }
}

struct Pair<V: Vector> {
    e1: Ellipsoid<V>,
    e2: Ellipsoid<V>,
    gradient: bool,
    options: MarginOptions,
    method: Method,
}

impl<V: Space> Question for Pair<V> {
    type Solution = (ellip_margin::Margin<V>, Option<MotionGradient<V>>);

    fn solve(&self) -> Result<Self::Solution, Problem> {
        let margin = match self.method {
            Method::Secular => EllipsoidPair::new(&self.e1, &self.e2, self.options).margin(),
            #[cfg(feature = "paper")]
            Method::Eigen => free_margin_eigen(&self.e1, &self.e2),
        };
        Ok((*margin, self.gradient.then(|| margin.gradient())))
    }

    /// The derivatives of all that is asked of a pair, and a batch.
    fn beside(&self, _: &Self::Solution) -> String {
        let pair = EllipsoidPair::new(&self.e1, &self.e2, self.options);
        let (margin, distance, scaling) = (pair.margin(), pair.distance(), pair.scaling());
        let first = (margin.gradient(), distance.gradient(), scaling.gradient());
        let of_second = (margin.gradient_of_second(), distance.gradient_of_second(), scaling.gradient_of_second());
        let second = (margin.hessian(), distance.hessian(), scaling.hessian());
        let (e1, e2) = (self.e1, self.e2);
        let batch = free_margins(&[e1, e2, e1], &[e2, e1, e1], self.options);
        format!(
            "{:?} {first:?} {of_second:?} {second:?} {:?} {:?} {batch:?}",
            (*margin, *distance, *scaling),
            margin.shape_gradient(),
            pair.distance_bracket()
        )
    }

    fn answer(&self, (margin, gradient): Self::Solution) -> Result<Answer, Problem> {
        certain(margin.status, margin.iterations)?;
        let mut answer = Answer::default()
            .with("margin", Field::number(margin.margin))
            // −ν, and 0 rather than −0 where the centre is inside.
            .with("lambda", Field::number(V::ZERO.get(0) - margin.nu))
            .with("point", Field::vector(margin.point));
        if let Some(gradient) = gradient {
            answer = answer
                .with("gradient_translation", Field::vector(gradient.translation))
                .with("gradient_rotation", moment::<V>(gradient.rotation));
        }
        Ok(answer.with("iterations", Field::Count(margin.iterations)))
    }
}
