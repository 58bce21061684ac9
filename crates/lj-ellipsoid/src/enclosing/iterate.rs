//! The state of a method: a frame, weighted points in it, and their moments.

use crate::enclosing::frame::Frame;
use crate::enclosing::moments::Moments;
use crate::enclosing::problem::EnclosingIterate;
use crate::enclosing::solution::{Certificate, Ending, Solution, finish};
use crate::enclosing::working_set::WorkingSet;
use crate::error::EnclosingError;
use crate::numerics::dimension::Dimension;
use crate::options::Status;
use crate::points::Points;

/// The weights of some points, in the coordinates of a frame.
pub(crate) struct Iterate<D: Dimension> {
    pub(crate) rank: D,
    pub(crate) frame: Frame<D>,
    pub(crate) set: WorkingSet,
    /// The moments of the weights.
    pub(crate) moments: Moments<D>,
    /// Steps of the method so far.
    pub(crate) iterations: usize,
    /// Passes over all points so far.
    pub(crate) scans: usize,
}

impl<D: Dimension> Iterate<D> {
    /// The members and weights of `set`, in the coordinates of `frame`.
    pub(crate) fn new<P: Points<Dim = D>>(
        points: &P,
        rank: D,
        frame: Frame<D>,
        set: WorkingSet,
        scans: usize,
    ) -> Result<Self, EnclosingError> {
        let mut iterate = Self { rank, frame, set, moments: Moments::new(rank), iterations: 0, scans };
        iterate.set.locate(points, rank, &iterate.frame);
        if iterate.update() { Ok(iterate) } else { Err(EnclosingError::OutOfRange) }
    }

    /// Computes the moments from the weights; false if the points with weight do not span the space.
    pub(crate) fn update(&mut self) -> bool {
        self.moments.compute(&self.set.y, &self.set.u)
    }

    /// Makes the ellipsoid of the weights, (y − c)ᵀS⁻¹(y − c) ≤ 1, the unit ball of the frame.
    pub(crate) fn recenter<P: Points<Dim = D>>(&mut self, points: &P) {
        let origin = self.set.mean(points, &self.frame);
        self.frame.recenter(self.rank, origin, self.moments.factor.as_ref());
        self.set.locate(points, self.rank, &self.frame);
        self.update();
    }

    /// Adds the points `found`, with weight zero; present members stay as they are.
    pub(crate) fn add<P: Points<Dim = D>>(&mut self, points: &P, found: &[usize]) {
        let mut v = points.dim().zero();
        let mut y = self.rank.zero();
        for &index in found {
            if !self.set.index.contains(&index) {
                points.read(index, v.as_mut());
                self.frame.apply(points.dim(), self.rank, v.as_mut(), y.as_mut());
                self.set.push(index, y.as_ref());
            }
        }
    }

    /// The iterate for an observer, with the gap over all points.
    pub(crate) fn observed(&self, gap: f64) -> EnclosingIterate<'_> {
        EnclosingIterate {
            iteration: self.iterations,
            scans: self.scans,
            log_det_gap: gap.max(0.0),
            indices: &self.set.index,
            weights: &self.set.u,
        }
    }

    /// The bound that the weights prove.
    pub(crate) fn certificate<P: Points<Dim = D>>(&self, points: &P) -> Certificate {
        Certificate::from_weights(points, self.rank, &self.frame, &self.set, &self.moments)
    }

    /// The ellipsoid of the weights around all points.
    pub(crate) fn finish<P: Points<Dim = D>>(
        &self,
        points: &P,
        epsilon: f64,
        ended: Status,
    ) -> Result<Solution<D>, EnclosingError> {
        let ending = Ending {
            certificate: self.certificate(points),
            status: ended,
            iterations: self.iterations,
            scans: self.scans,
        };
        finish(points, self.rank, &self.frame, epsilon, ending)
    }
}
