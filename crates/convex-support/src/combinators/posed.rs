//! A shape moved without deforming it.

use core::fmt;

use num_traits::Float as _;

use super::placement::{Placement, is_near, length_of_error, lost_in_origin};
use crate::error::{InvalidShape, finite, orthonormal};
use crate::line_crossing::crossed_by_line::closely;
use crate::line_crossing::{NearLine, Turned, lanes, skew};
use crate::numerics::bound::roundings;
use crate::numerics::twofold::lost_in_sum;
use crate::support::ScalarOf;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Lines,
    Matrix, Parallelotope, Rotation, Rounding, Scalar, SupportMap, Vector,
};

/// The image `R·C + t` of a shape under a rotation and then a translation.
///
/// ```
/// use convex_support::{Cuboid, Posed, glam::DVec2, support_value};
/// use std::f64::consts::FRAC_PI_2;
///
/// let plank = Cuboid::new(DVec2::new(3.0, 1.0))?;
/// let upright = Posed::new(plank, FRAC_PI_2, DVec2::new(10.0, 0.0))?;
/// assert!((support_value(&upright, DVec2::Y) - 3.0).abs() < 1e-15);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, PartialEq)]
// In this order, the rotation, which is computed last, lies behind the numbers of an error that `new` might return in
// its place. A field that shares its place with those is copied in other pieces than it was written in, for which a
// processor waits.
#[doc(alias("transform", "isometry", "oriented", "obb"))]
#[repr(C)]
pub struct Posed<S: SupportMap> {
    /// A bound on the error of the core's support points, as a length.
    error: ScalarOf<S>,
    /// A bound on the distance of points from where they would be if the transpose of the rotation were exactly its
    /// inverse.
    skew: ScalarOf<S>,
    /// A bound on the error of every entry of the rotation, except rows along a coordinate axis, in units of epsilon.
    rotation_error: ScalarOf<S>,
    shape: S,
    /// The rounding error of the origin `R·c + t`. Far from the world's origin it is a large part of the shape's size,
    /// and it stays with the core.
    lost: S::Vector,
    translation: S::Vector,
    rotation: <S::Vector as Vector>::Matrix,
}

/// The numbers that it was made of, without the bounds on their rounding.
impl<S: SupportMap + fmt::Debug> fmt::Debug for Posed<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Posed")
            .field("shape", &self.shape)
            .field("rotation", &self.rotation)
            .field("translation", &self.translation)
            .finish()
    }
}

/// Bounds on the error of a rotation matrix, in units of epsilon: of every entry, and of the image of a unit vector.
struct Errors {
    entry: f64,
    operator: f64,
}

impl Errors {
    const NONE: Self = Self { entry: 0.0, operator: 0.0 };

    /// Those that a pose can have.
    fn known<V: Vector>() -> [Self; 3] {
        [Self::NONE, Self::of_rotation::<V>(), POLISHED]
    }

    /// Those of the matrix of a rotation.
    #[inline(always)]
    fn of_rotation<V: Vector>() -> Self {
        Self { entry: V::Rotation::MATRIX_ERROR, operator: V::Rotation::OPERATOR_ERROR }
    }
}

impl<S: SupportMap> Posed<S> {
    /// The shape in a pose that has been checked.
    #[inline(always)]
    fn placed(
        shape: S,
        rotation: <S::Vector as Vector>::Matrix,
        errors: Errors,
        translation: S::Vector,
    ) -> Result<Self, InvalidShape> {
        let core = shape.core();
        let lost = lost_in_origin(&rotation, core.origin, core.size(), translation)?;
        let error = length_of_error(&core, Scalar::ONE, Scalar::from_f64(errors.operator), translation, lost);
        let skew = if errors.operator > 0.0 { Scalar::ZERO } else { skew(&rotation) * core.size() };
        Ok(Self { shape, rotation, rotation_error: Scalar::from_f64(errors.entry), translation, lost, error, skew })
    }

    /// The shape turned about the origin by `rotation` (an angle in radians in 2D, a quaternion in 3D, which is
    /// normalised first), then moved by `translation`.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite or the rotation is the zero quaternion.
    #[inline(always)]
    pub fn new(
        shape: S,
        rotation: <S::Vector as Vector>::Rotation,
        translation: S::Vector,
    ) -> Result<Self, InvalidShape> {
        let rotation = rotation.checked("rotation")?.matrix();
        Self::placed(shape, rotation, Errors::of_rotation::<S::Vector>(), finite("translation", translation)?)
    }

    /// The shape moved by a rotation matrix, then by `translation`: for poses given as glam's `DAffine3` or as a
    /// matrix. A matrix that has drifted from orthonormality is replaced by the nearest rotation.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite, the columns are not orthonormal to half of their digits, or the
    /// matrix mirrors.
    pub fn from_matrix(
        shape: S,
        rotation: <S::Vector as Vector>::Matrix,
        translation: S::Vector,
    ) -> Result<Self, InvalidShape> {
        let rotation = proper(rotation)?;
        if rotation == Matrix::IDENTITY {
            return Self::translated(shape, translation);
        }
        let polished = polished(rotation);
        let errors = if polished == rotation { Errors::NONE } else { POLISHED };
        Self::placed(shape, polished, errors, finite("translation", translation)?)
    }

    /// Another shape in the pose of this one: the numbers are those that the same constructor would make for it.
    ///
    /// The pose was checked and made a matrix once, which is a sixth of the work of the distance of a ball and a box.
    /// So where several shapes share a pose, or one is asked about again, keep the pose as that of a
    /// [`Point`](crate::Point), and give it to each shape:
    ///
    /// ```
    /// use convex_support::{Ball, Cuboid, Point, Posed, glam::DQuat, glam::DVec3};
    ///
    /// let pose = Posed::new(Point::new(DVec3::ZERO)?, DQuat::from_rotation_y(0.3), DVec3::X * 2.0)?;
    /// let (hull, mast) = (Cuboid::new(DVec3::new(4.0, 1.0, 1.5))?, Ball::new(0.5)?);
    /// let hull = pose.with_shape(&hull)?;
    /// let mast = pose.with_shape(&mast)?;
    /// assert_eq!(hull.translation(), mast.translation());
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// # Errors
    /// [`InvalidShape::TooLarge`] if the origin of the moved shape is not finite.
    #[inline(always)]
    pub fn with_shape<T: SupportMap<Vector = S::Vector>>(&self, shape: T) -> Result<Posed<T>, InvalidShape> {
        if self.rotation_error == Scalar::ZERO && self.rotation == Matrix::IDENTITY {
            return Posed::translated(shape, self.translation);
        }
        let is_it = |errors: &Errors| ScalarOf::<S>::from_f64(errors.entry) == self.rotation_error;
        let errors = Errors::known::<S::Vector>().into_iter().find(is_it).unwrap_or(POLISHED);
        Posed::placed(shape, self.rotation, errors, self.translation)
    }

    /// The shape in the pose of another one, from its matrix and the [error](Self::rotation_error) of that. A matrix
    /// without an error is exact, or comes from elsewhere, and may have drifted.
    #[cfg(feature = "serde")]
    pub(crate) fn restored(
        shape: S,
        rotation: <S::Vector as Vector>::Matrix,
        translation: S::Vector,
        rotation_error: f64,
    ) -> Result<Self, InvalidShape> {
        let known = Errors::known::<S::Vector>();
        let entry = crate::error::known_error("rotation_error", rotation_error, &known.each_ref().map(|e| e.entry))?;
        match known.into_iter().find(|errors| errors.entry == entry && entry > 0.0) {
            Some(errors) => Self::placed(shape, proper(rotation)?, errors, finite("translation", translation)?),
            None => Self::from_matrix(shape, rotation, translation),
        }
    }

    /// A bound on the error of every entry of the rotation, in units of epsilon.
    #[cfg(feature = "serde")]
    pub(crate) fn rotation_error(&self) -> f64 {
        self.rotation_error.as_f64()
    }

    /// The shape moved by `translation`.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a coordinate is not finite.
    #[inline]
    pub fn translated(shape: S, translation: S::Vector) -> Result<Self, InvalidShape> {
        let core = shape.core();
        let translation = finite("translation", translation)?;
        let origin = core.origin + translation;
        if !origin.is_finite() {
            return Err(InvalidShape::TooLarge { parameter: "translation" });
        }
        let lost = lost_in_sum(core.origin, translation);
        let zero = ScalarOf::<S>::ZERO;
        // Products with the identity are exact, and the sum with zero is.
        let summed = if lost == S::Vector::ZERO { zero } else { roundings(1.0, core.extent + lost.norm()) };
        let (rotation, error) = (Matrix::IDENTITY, core.error + summed);
        Ok(Self { shape, rotation, rotation_error: zero, translation, lost, error, skew: zero })
    }

    /// The shape before it is moved.
    #[must_use]
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The rotation, applied first.
    #[must_use]
    pub fn rotation(&self) -> <S::Vector as Vector>::Matrix {
        self.rotation
    }

    /// The translation, applied last.
    #[must_use]
    pub fn translation(&self) -> S::Vector {
        self.translation
    }

    /// The frame in which the shape tests lines: about the image of its origin.
    ///
    /// If the origin `c` is not zero, the foot of a line, no more than 2 sizes `S` from there, loses `4uS` and `u|c|`
    /// as the lost part of the image of `c` is subtracted and `c` is added. The lost part is turned, which loses `3u`;
    /// if it is larger than the size, no line is near the shape to rounding.
    #[inline(always)]
    fn frame(&self, core: &Core<S::Vector>, size: ScalarOf<S>) -> Turned<S::Vector> {
        let (rotation, error) = (self.rotation, self.error + self.skew);
        if core.origin == S::Vector::ZERO {
            return Turned { rotation, center: self.translation, size, error, from: None };
        }
        let center = rotation * core.origin + self.translation;
        let rounding = roundings(8.0, size) + roundings(2.0, core.origin.norm() + self.lost.norm());
        let from = Some((rotation.transpose_mul(self.lost), core.origin, rounding));
        Turned { rotation, center, size, error, from }
    }

    /// The image of a vector of the shape under the rotation. For zero, the origin of most shapes and the core of
    /// balls, the rotation need not even be read.
    #[inline(always)]
    fn turned(&self, v: S::Vector) -> S::Vector {
        if v == S::Vector::ZERO { v } else { self.rotation * v }
    }
}

/// The matrix if it is a rotation to half its digits.
fn proper<M: Matrix>(rotation: M) -> Result<M, InvalidShape> {
    let rotation = orthonormal("rotation", rotation)?;
    if rotation.determinant() < Scalar::ZERO { Err(InvalidShape::Mirrors) } else { Ok(rotation) }
}

/// The largest distance of an entry of a [`polished`] matrix from the nearest rotation, in units of epsilon. With
/// `RᵀR = 1 + E`, the step leaves `3/8·|E|²`, where the entries of `E` are at most `√ε`: 3.4; and its own operations
/// leave as much again.
const POLISHED: Errors = Errors { entry: 8.0, operator: 14.0 };

/// The nearest rotation to a matrix that is one to half its digits, by one step of Newton's method for the orthogonal
/// polar factor, `R·(3 − RᵀR)/2`, which squares the error. A rotation to rounding stays as it is.
fn polished<M: Matrix>(matrix: M) -> M {
    type S<M> = <<M as Matrix>::Vector as Vector>::Scalar;
    let gram = M::from_cols_fn(|j| matrix.transpose_mul(matrix.col(j)));
    let off = (0..M::Vector::DIM).map(|j| (gram.col(j) - M::Vector::axis(j)).abs().max_element());
    if off.fold(S::<M>::ZERO, S::<M>::max) <= S::<M>::EPSILON * S::<M>::from_f64(8.0) {
        return matrix;
    }
    let (half, three) = (S::<M>::from_f64(0.5), S::<M>::from_f64(3.0));
    matrix * M::from_cols_fn(|j| (M::Vector::axis(j) * three - gram.col(j)) * half)
}

impl<S: SupportMap> SupportMap for Posed<S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        self.rotation * self.shape.support(self.rotation.transpose_mul(direction)) + self.translation
    }

    #[inline(always)]
    fn core(&self) -> Core<S::Vector> {
        let core = self.shape.core();
        Core {
            origin: self.turned(core.origin) + self.translation,
            extent: core.extent + self.lost.abs().max_element() * Scalar::from_f64(2.0),
            error: self.error,
            kind: core.kind.image(|v| self.turned(v), self.lost),
            ..core
        }
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.rotation * self.shape.core_support(self.rotation.transpose_mul(direction), hint) + self.lost
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        let turned = |v| self.rotation.transpose_mul(v);
        self.shape.core_support_hessian(turned(direction), [turned(changes[0]), turned(changes[1])])
    }

    #[inline(always)]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        let closest = self.shape.core_closest_point(self.rotation.transpose_mul(x - self.lost))?;
        Some(self.rotation * closest + self.lost)
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<S::Vector>) -> Option<CertainCrossing<S::Vector>> {
        if line.is_close {
            return closely(self, line);
        }
        let core = self.shape.core();
        let line = line.within(self.error + self.skew);
        let size = core.size() + line.radius;
        // A ball, whichever way it is turned.
        if core.origin == S::Vector::ZERO && core.kind == CoreKind::Point(S::Vector::ZERO) {
            let line = line.sweeping(core.radius);
            return NearLine::new(line, self.translation, size)?.swept_point(line);
        }
        let turned = self.frame(&core, size);
        let near = NearLine::new(line, turned.center, size)?.at_foot();
        let known = self.shape.certain_crossing(turned.before(&near, line))?;
        Some(near.after(known, |n| self.rotation * n))
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        let (pose, core) = ((&self.rotation, self.translation), self.shape.core());
        let size = [core.size(), core.origin.norm()];
        line.turned(pose, self.rotation_error, size, |line| self.shape.close_crossing(line))
    }

    fn core_support_feature(&self, direction: S::Vector, slab: ScalarOf<S>, feature: &mut Feature<S::Vector>) {
        self.shape.core_support_feature(self.rotation.transpose_mul(direction), slab, feature);
        feature.map(|point| self.rotation * point + self.lost);
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        Some(self.shape.core_parallelotope()?.mapped(|v| self.rotation * v, self.lost))
    }

    fn rounding(&self) -> Rounding<S::Vector> {
        let core = self.shape.core();
        let placement = Placement {
            matrix: &self.rotation,
            matrix_error: self.rotation_error,
            scale: Some(Scalar::ONE),
            translation: self.translation,
            lost: self.lost,
            is_near: is_near(core.origin, core.size()),
        };
        placement.image(self.shape.rounding(), core.origin, core.extent)
    }
}

impl<S: CrossedByLine> CrossedByLine for Posed<S> {
    #[inline(always)]
    fn core_line_crossing(
        &self,
        source: S::Vector,
        direction: S::Vector,
        radius: ScalarOf<S>,
    ) -> LineCrossing<S::Vector> {
        let local = self.rotation.transpose_mul(source - self.lost);
        let crossing = self.shape.core_line_crossing(local, self.rotation.transpose_mul(direction), radius);
        crossing.with_normal(|normal| self.rotation * normal)
    }

    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<ScalarOf<S>>) -> bool {
        let core = self.shape.core();
        if core.origin == S::Vector::ZERO && core.kind == CoreKind::Point(S::Vector::ZERO) {
            lanes::ball(lines, self.translation, core.radius, self.error + self.skew);
            return true;
        }
        let counted = lanes::before_turn(lines, self.frame(&core, core.size()));
        let is_known = self.shape.certain_crossings(lines);
        if is_known {
            lanes::after_turn::<S::Vector>(lines, self.rotation, &counted);
        }
        is_known
    }
}
