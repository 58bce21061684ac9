//! Points that are added, removed and moved, and the enclosing ellipsoid that follows them.

use crate::ellipsoid::radius_at_most;
use crate::enclosing::frame::Frame;
use crate::enclosing::iterate::Iterate;
use crate::enclosing::start::{Start, surely_spans};
use crate::enclosing::working_set::WorkingSet;
use crate::enclosing::{Enclosing, Solution, solve, solve_from};
use crate::error::EnclosingError;
use crate::numerics::dimension::{Const, Square};
use crate::options::{EnclosingOptions, Status};
use crate::points::PointSlice;

/// Points with their minimum-volume enclosing ellipsoid, kept up to date when points are added, removed or moved.
///
/// A change that cannot affect the ellipsoid costs no solve: a point added inside, or a point without weight removed
/// or moved inside, leaves the ellipsoid and its certificate as they are. Otherwise the next
/// [`enclosing`](Self::enclosing) starts from the old ellipsoid and its weights, which saves passes of a cold start.
///
/// Whether the points are flat is decided as in [`enclosing()`](crate::enclosing()). If the ellipsoid is within an
/// affine hull ([`FlatPolicy::AffineHull`](crate::FlatPolicy::AffineHull)), or so thin that rounding might make it
/// flat, it says nothing about points across it, so that after it every change is solved.
///
/// # Examples
/// ```
/// use lj_ellipsoid::{EnclosingOptions, MovingPoints};
///
/// let mut points = MovingPoints::new(
///     &[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0]],
///     EnclosingOptions::new(),
/// )?;
/// let area = points.enclosing()?.ellipsoid.log_volume().exp();
///
/// points.insert([2.0, 1.0])?; // inside: nothing to compute
/// assert_eq!(points.solves(), 1);
///
/// points.update(2, [5.0, 3.0])?; // a corner moves out
/// assert!(points.enclosing()?.ellipsoid.log_volume().exp() > area);
/// assert_eq!(points.solves(), 2);
/// # Ok::<(), lj_ellipsoid::EnclosingError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MovingPoints<const N: usize> {
    points: Vec<[f64; N]>,
    options: EnclosingOptions,
    answer: Option<Enclosing<N>>,
    /// The answer is that of the points as they are now.
    current: bool,
    /// No change inside the ellipsoid, with the weights as they are, makes the points flat or the ellipsoid another.
    steady: bool,
    solves: usize,
}

impl<const N: usize> MovingPoints<N> {
    /// Takes the points, perhaps none at first; nothing is computed yet.
    ///
    /// # Errors
    /// [`EnclosingError::NonFinite`]; [`EnclosingError::InvalidEpsilon`] and [`EnclosingError::InvalidFlatTolerance`]
    /// for options out of their range.
    pub fn new<P: Into<[f64; N]> + Copy>(points: &[P], options: EnclosingOptions) -> Result<Self, EnclosingError> {
        options.check()?;
        let points: Vec<[f64; N]> = points.iter().map(|&p| p.into()).collect();
        for (index, point) in points.iter().enumerate() {
            check_finite(index, point)?;
        }
        Ok(Self { points, options, answer: None, current: false, steady: false, solves: 0 })
    }

    /// The points, in the order of their indices.
    #[must_use]
    pub fn points(&self) -> &[[f64; N]] {
        &self.points
    }

    /// How many times an ellipsoid was computed so far.
    #[must_use]
    pub const fn solves(&self) -> usize {
        self.solves
    }

    /// Adds a point and returns its index.
    ///
    /// # Errors
    /// [`EnclosingError::NonFinite`]; then nothing changes.
    pub fn insert(&mut self, point: impl Into<[f64; N]>) -> Result<usize, EnclosingError> {
        let point = point.into();
        let index = self.points.len();
        check_finite(index, &point)?;
        self.points.push(point);
        self.current &= self.well_inside(point);
        Ok(index)
    }

    /// Removes point `index` and returns it; the last point takes its index.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn remove(&mut self, index: usize) -> [f64; N] {
        let last = self.points.len() - 1;
        let point = self.points.swap_remove(index);
        if let Some(answer) = &mut self.answer {
            self.current &= self.steady && answer.weights.iter().all(|w| w.index != index);
            answer.weights.retain(|w| w.index != index);
            answer.contacts.retain(|&i| i != index);
            answer.weights.iter_mut().filter(|w| w.index == last).for_each(|w| w.index = index);
            answer.contacts.iter_mut().filter(|i| **i == last).for_each(|i| *i = index);
            answer.contacts.sort_unstable();
        }
        point
    }

    /// Moves point `index` to `point` and returns its old place.
    ///
    /// # Errors
    /// [`EnclosingError::NonFinite`]; then nothing changes.
    ///
    /// # Panics
    /// If there is no such point.
    pub fn update(&mut self, index: usize, point: impl Into<[f64; N]>) -> Result<[f64; N], EnclosingError> {
        let point = point.into();
        check_finite(index, &point)?;
        let old = std::mem::replace(&mut self.points[index], point);
        let inside = self.well_inside(point);
        if let Some(answer) = &mut self.answer {
            self.current &= inside && answer.weights.iter().all(|w| w.index != index);
            answer.contacts.retain(|&i| i != index);
        }
        Ok(old)
    }

    /// The enclosing ellipsoid of the points as they are now.
    ///
    /// # Errors
    /// Those of [`enclosing`](crate::enclosing()).
    pub fn enclosing(&mut self) -> Result<&Enclosing<N>, EnclosingError> {
        let answer = match self.answer.take() {
            Some(answer) if self.current => answer,
            earlier => {
                self.solves += 1;
                let points = PointSlice(&self.points);
                let warm = earlier.filter(|_| self.steady).and_then(|answer| self.warm_start(&answer));
                let warm = warm.and_then(|start| solve_from(&points, start, self.options, &mut |_| {}).ok());
                let is_steady = |solution: &Solution<Const<N>>| {
                    solution.log_det_gap < 1.0 && surely_spans(&solution.shape, self.options.flat_tolerance)
                };
                // In the old frame the points may have become flat, or one of them be too far away.
                let solution = match warm.filter(|solution| solution.status != Status::Stalled && is_steady(solution)) {
                    Some(solution) => solution,
                    None => solve(&points, self.options, &mut |_| {})?,
                };
                self.steady = is_steady(&solution);
                self.current = true;
                Enclosing::from_solution(solution)
            }
        };
        Ok(self.answer.insert(answer))
    }

    /// Proved to be inside by more than what counts as contact, and such that this is all that matters.
    fn well_inside(&self, point: [f64; N]) -> bool {
        self.steady
            && self.answer.as_ref().is_some_and(|Enclosing { ellipsoid: e, .. }| {
                radius_at_most(&e.center(), e.axes().as_flattened(), &e.semi_axes(), &point) < 1.0 - 1e-8
            })
    }

    /// The old ellipsoid as frame and its points with their weights, unless these no longer span the space.
    fn warm_start(&self, answer: &Enclosing<N>) -> Option<Start<Const<N>>> {
        let (mut rows, lengths) = (answer.ellipsoid.axes(), answer.ellipsoid.semi_axes());
        rows.iter_mut().zip(lengths).for_each(|(row, a)| row.iter_mut().for_each(|x| *x /= a));
        let frame = Frame::new(answer.ellipsoid.center(), Square(rows), N);
        let working: Vec<usize> = answer.weights.iter().map(|w| w.index).collect();
        let total: f64 = answer.weights.iter().map(|w| w.weight).sum();
        let weights: Vec<f64> = answer.weights.iter().map(|w| w.weight / total).collect();
        if !frame.is_finite() || !weights.iter().all(|x| x.is_finite()) {
            return None;
        }
        let start = WorkingSet::new(working, Some(weights));
        let Iterate { frame, set, moments, .. } =
            Iterate::new(&PointSlice(&self.points), Const::<N>, frame, start, 0).ok()?;
        // A scatter far from the identity is no start worth having.
        let round = moments.factor.as_ref().iter().step_by(N + 1).all(|d| (1e-4..=1e4).contains(d));
        round.then_some(Start { frame, working: set.index, weights: Some(set.u), scans: 0 })
    }
}

fn check_finite<const N: usize>(index: usize, point: &[f64; N]) -> Result<(), EnclosingError> {
    match point.iter().position(|x| !x.is_finite()) {
        Some(coordinate) => Err(EnclosingError::NonFinite { index, coordinate, value: point[coordinate] }),
        None => Ok(()),
    }
}
