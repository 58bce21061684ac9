//! A moving shape within balls, one after the other.

use convex_support::{BoundingSphere, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::{MotionCastOptions, MovingBall, Trajectory};

/// The most pieces that a motion is cut into.
pub(super) const MAX_PIECES: usize = 16;

/// How much larger than the ball of the shape the ball of a piece may be, before the motion is cut into more pieces.
const GROWTH: f64 = 1.5;

/// A part of a motion, and a ball that moves at constant velocity. Throughout the part, the ball contains the shape,
/// and everything no farther from it than the target distance.
pub(super) struct MotionPiece<V: Vector> {
    pub(super) start: V::Scalar,
    pub(super) duration: V::Scalar,
    pub(super) ball: MovingBall<V>,
}

impl<V: Vector> MotionPiece<V> {
    /// A bound on the coordinates of the ball's points throughout the part; infinite if it moves for ever.
    pub(super) fn reach(&self) -> V {
        let MovingBall { start, velocity, radius } = self.ball;
        V::from_fn(|i| {
            let speed = velocity.get(i).abs();
            let way = if speed == Scalar::ZERO { speed } else { speed * self.duration };
            start.get(i).abs() + way + radius
        })
    }
}

/// A motion in as few pieces as make their balls hardly larger than that of the shape. A motion without an end is one
/// piece.
pub(super) struct MotionPieces<'m, M: Trajectory> {
    motion: &'m M,
    ball: BoundingSphere<M::Vector>,
    end: <M::Vector as Vector>::Scalar,
    count: usize,
    next: usize,
}

impl<'m, M: Trajectory> MotionPieces<'m, M> {
    /// Of a shape as it moves; the options are checked.
    pub(super) fn new<A: SupportMap<Vector = M::Vector> + ?Sized>(
        shape: &A,
        motion: &'m M,
        options: &MotionCastOptions<M::Vector>,
    ) -> Self {
        let core = shape.core();
        let radius = core.extent + core.radius + options.target_distance;
        let ball = BoundingSphere { center: core.origin, radius };
        let mut pieces = Self { motion, ball, end: options.max_time, count: 1, next: 0 };
        let large = radius * Scalar::from_f64(GROWTH);
        while pieces.count < MAX_PIECES
            && pieces.end.is_finite()
            && (0..pieces.count).any(|i| pieces.piece(i).ball.radius > large)
        {
            pieces.count *= 2;
        }
        pieces
    }

    fn piece(&self, index: usize) -> MotionPiece<M::Vector> {
        let at = |index: usize| {
            let part = <M::Vector as Vector>::Scalar::from_f64(index as f64 / self.count as f64);
            if index == 0 {
                Scalar::ZERO
            } else if index == self.count {
                self.end
            } else {
                self.end * part
            }
        };
        let (start, end) = (at(index), at(index + 1));
        MotionPiece { start, duration: end - start, ball: self.motion.moving_ball(self.ball, [start, end]) }
    }
}

impl<M: Trajectory> Iterator for MotionPieces<'_, M> {
    type Item = MotionPiece<M::Vector>;

    fn next(&mut self) -> Option<MotionPiece<M::Vector>> {
        let index = self.next;
        (index < self.count).then(|| {
            self.next += 1;
            self.piece(index)
        })
    }
}
