//! Derivatives of a number by the motion of a body.

use crate::{AngularVelocity, Scalar, Vector};

/// The derivative of a number by the motion of a body. It is like a force and a moment that act on the body at a point.
///
/// A translation `δ` of the body changes the number by `translation·δ`, and a turn `ω` about [`point`](Self::point) by
/// `rotation·ω`, in world axes and to first order.
///
/// ```
/// use convex_support::{MotionGradient, glam::DVec3};
///
/// // A force along y at a point on an arm along x, and a moment of 3 about the arm.
/// let gradient =
///     MotionGradient { translation: DVec3::Y, rotation: DVec3::X * 3.0, point: DVec3::X * 2.0 };
/// assert_eq!(gradient.rotation_about(DVec3::ZERO), DVec3::new(3.0, 0.0, 2.0));
/// assert_eq!(gradient.revolute(DVec3::ZERO, DVec3::Z), 2.0); // per radian of a joint about z
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MotionGradient<V: Vector> {
    /// The change per translation of the body, in world axes: the force.
    pub translation: V,
    /// The change per turn of the body about the point, in world axes: a vector in 3D, in 2D a number,
    /// counterclockwise.
    pub rotation: V::AngularVelocity,
    /// The point, in the world.
    pub point: V,
}

impl<V: Vector> MotionGradient<V> {
    /// A force at a point: a turn about the point changes nothing.
    #[inline]
    pub fn force(translation: V, point: V) -> Self {
        Self { translation, rotation: V::AngularVelocity::default(), point }
    }

    /// The derivative by the motion of the other body, which has the reaction.
    pub fn reversed(self) -> Self {
        let rotation = V::AngularVelocity::from_coordinates(|i| -self.rotation.coordinate(i));
        Self { translation: -self.translation, rotation, ..self }
    }

    /// The change per turn of the body about the point `pivot`, in world axes.
    #[must_use]
    pub fn rotation_about(&self, pivot: V) -> V::AngularVelocity {
        let moment = V::AngularVelocity::moment(self.point - pivot, self.translation);
        V::AngularVelocity::from_coordinates(|i| self.rotation.coordinate(i) + moment.coordinate(i))
    }

    /// The change per radian of a revolute joint that carries the body, about the unit vector `axis` through `pivot`
    /// (in 2D an axis of 1 is counterclockwise): one entry of the gradient by the joint angles.
    #[must_use]
    pub fn revolute(&self, pivot: V, axis: V::AngularVelocity) -> V::Scalar {
        let turn = (0..MotionHessian::<V>::SIZE - V::DIM).map(|i| self.rotation.coordinate(i) * axis.coordinate(i));
        turn.fold(self.translation.dot(axis.cross_matrix() * (self.point - pivot)), |sum, term| sum + term)
    }

    /// The change per unit of length of a prismatic joint that carries the body, along the unit vector `axis`.
    #[must_use]
    pub fn prismatic(&self, axis: V) -> V::Scalar {
        self.translation.dot(axis)
    }
}

/// The coordinates of a pose: three of a translation and three of a rotation in space, two and one in the plane.
const MAX: usize = 6;

/// Second derivatives of a number `f` by the motion of a body, or by the motions of two.
///
/// A motion is a translation `δ` and a rotation vector `ω` about a centre `c`, both in world axes:
///
/// > x ↦ c + δ + exp(\[ω\]×)·(x − c),   f ↦ f + gᵀθ + ½θᵀHθ + O(‖θ‖³) with θ = (δ, ω),
///
/// in 2D with the angle `ω`, counterclockwise. (A gradient taken anew in world axes at the moved body is
/// `g + Hθ + ½(0, ω × ∂f/∂ω) + O(‖θ‖²)`, since rotations do not commute.)
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V::Scalar: serde::Serialize")))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "V::Scalar: serde::Deserialize<'de>")))]
pub struct MotionHessian<V: Vector> {
    rows: [[V::Scalar; MAX]; MAX],
    is_unique: bool,
}

impl<V: Vector> MotionHessian<V> {
    /// The number of rows and columns: 6 in 3D, 3 in 2D.
    pub const SIZE: usize = V::DIM * (V::DIM + 1) / 2;

    /// The matrix with the upper left part of these rows, translations first, and whether it is the [only
    /// one](Self::is_unique).
    #[inline]
    pub fn from_rows(rows: [[V::Scalar; MAX]; MAX], is_unique: bool) -> Self {
        Self { rows, is_unique }
    }

    /// Whether these are the only second derivatives. If not, they jump here, and are those on one side.
    #[must_use]
    pub fn is_unique(&self) -> bool {
        self.is_unique
    }

    /// The entry in a row and a column, translations first.
    ///
    /// # Panics
    /// If there is no such entry.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> V::Scalar {
        assert!(row < Self::SIZE && column < Self::SIZE, "a row and a column of the matrix");
        self.rows[row][column]
    }

    /// The upper left part of the matrix, by rows: all of it with `N = 6` in 3D and `N = 3` in 2D, and with `N` the
    /// dimension the second derivatives by translations.
    ///
    /// # Panics
    /// If `N` is larger than the matrix.
    #[must_use]
    pub fn matrix<const N: usize>(&self) -> [[V::Scalar; N]; N] {
        core::array::from_fn(|i| core::array::from_fn(|j| self.entry(i, j)))
    }

    /// The second derivative along a motion: `θᵀHθ` for `θ = (translation, rotation)`.
    #[must_use]
    pub fn along(&self, translation: V, rotation: V::AngularVelocity) -> V::Scalar {
        self.between((translation, rotation), (translation, rotation))
    }

    /// The second derivative along two motions `θ` and `φ`, each a translation and a rotation: `θᵀHφ`.
    #[must_use]
    pub fn between(&self, rows: (V, V::AngularVelocity), columns: (V, V::AngularVelocity)) -> V::Scalar {
        let coordinate = |(translation, rotation): (V, V::AngularVelocity), i: usize| {
            if i < V::DIM { translation.get(i) } else { rotation.coordinate(i - V::DIM) }
        };
        let mut sum = V::Scalar::ZERO;
        for i in 0..Self::SIZE {
            for j in 0..Self::SIZE {
                sum += coordinate(rows, i) * coordinate(columns, j) * self.rows[i][j];
            }
        }
        sum
    }
}
