//! Where a frame is, and by how much rounding may have moved it.

use convex_support::{InvalidShape, Matrix, Point, Posed, Rotation, Scalar, Vector};
use num_traits::Float as _;

use crate::Pose;

/// A bound on the rounding error of the product of a rotation and a unit vector, in ε: `n·√n/2` for `n` dimensions.
const OF_VECTOR: f64 = 2.6;

/// A bound on the rounding error of the product of two rotations as an operator, in ε. Each entry is wrong by no more
/// than `n/2`, so that the root of the sum of all squared entries is no more than `n²/2`.
const OF_MATRIX: f64 = 4.5;

/// A frame that joints carry, as a rotation followed by a translation, with a bound on the error of each: it takes the
/// coordinates of a point of the frame to those in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkFrame<V: Vector> {
    /// The rotation.
    pub rotation: V::Matrix,
    /// The translation: where the origin of the frame is.
    pub translation: V,
    /// How far the matrix may take a unit vector from where the exact rotation takes it.
    pub turn_error: V::Scalar,
    /// How far the translation may be from the exact one.
    pub shift_error: V::Scalar,
}

impl<V: Vector> LinkFrame<V> {
    /// The frame of the world, which is exact.
    pub(super) const WORLD: Self = Self {
        rotation: V::Matrix::IDENTITY,
        translation: V::ZERO,
        turn_error: V::Scalar::ZERO,
        shift_error: V::Scalar::ZERO,
    };

    /// The frame with this pose.
    pub(super) fn at(pose: Pose<V>) -> Result<Self, InvalidShape> {
        if let Some(index) = (0..V::DIM).find(|&i| !pose.translation.get(i).is_finite()) {
            return Err(InvalidShape::NonFinite { parameter: "translation", index });
        }
        let rotation = pose.rotation.checked("rotation")?;
        let is_exact = rotation == V::Rotation::default();
        let units = if is_exact { 0.0 } else { V::Rotation::OPERATOR_ERROR };
        Ok(Self {
            rotation: rotation.matrix(),
            translation: pose.translation,
            turn_error: epsilons(units),
            ..Self::WORLD
        })
    }

    /// The pose of the bodies in this frame, checked once for all of them; `None` if it is not finite.
    pub(super) fn pose(&self) -> Option<Posed<Point<V>>> {
        Posed::from_matrix(Point::new(V::ZERO).ok()?, self.rotation, self.translation).ok()
    }

    /// Whether this is exactly the frame of the world.
    pub(super) fn is_world(&self) -> bool {
        self.rotation == Matrix::IDENTITY && self.translation == V::ZERO && self.turn_error == V::Scalar::ZERO
    }

    /// The frame whose place in this one is `inner`.
    #[inline]
    pub(super) fn then(&self, inner: &Self) -> Self {
        if inner.is_world() {
            return *self;
        }
        let moved = self.moved(inner.translation, inner.translation.norm(), inner.shift_error);
        Self {
            rotation: self.rotation * inner.rotation,
            turn_error: self.turn_error + inner.turn_error + epsilons(OF_MATRIX),
            ..moved
        }
    }

    /// The frame moved by `arm`, a vector in its own coordinates that has this length and is wrong by no more than
    /// `error`.
    #[inline]
    pub(super) fn moved(&self, arm: V, length: V::Scalar, error: V::Scalar) -> Self {
        let translation = self.translation + self.rotation * arm;
        // Each coordinate of the sum is rounded once.
        let rounded = translation.abs().max_element() + length * V::Scalar::from_f64(OF_VECTOR);
        let lost = rounded * V::Scalar::EPSILON;
        Self { translation, shift_error: self.shift_error + error + self.turn_error * length + lost, ..*self }
    }

    /// The inverse of this frame.
    pub(super) fn inverse(&self) -> Self {
        if self.is_world() {
            return *self;
        }
        let rotation = self.rotation.transpose();
        let back = Self { rotation, translation: V::ZERO, shift_error: self.shift_error, ..*self };
        back.moved(-self.translation, self.translation.norm(), V::Scalar::ZERO)
    }

    /// Where a point of this frame is in the frame around it.
    #[inline]
    pub(super) fn of(&self, point: V) -> V {
        self.translation + self.rotation * point
    }

    /// A bound on the error of [`of`](Self::of), for points that are no farther than `distance` from this frame's
    /// origin.
    pub(super) fn error_of(&self, distance: V::Scalar) -> V::Scalar {
        self.shift_error
            + (self.turn_error + epsilons(OF_VECTOR)) * distance
            + V::Scalar::EPSILON * self.translation.abs().max_element()
    }
}

/// This many ε.
pub(super) fn epsilons<S: Scalar>(count: f64) -> S {
    S::EPSILON * S::from_f64(count)
}
