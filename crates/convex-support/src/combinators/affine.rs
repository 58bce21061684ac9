//! A shape under an affine map.

use num_traits::Float as _;

use super::placement::{Placement, is_near, length_of_error, lost_in_origin};
use crate::ball_support::{swept, swept_hessian};
use crate::error::{InvalidShape, finite, finite_matrix};
use crate::line_crossing::NearLine;
use crate::line_crossing::crossed_by_line::closely;
use crate::numerics::bound::roundings;
use crate::numerics::range::power_of_two_below;
use crate::numerics::twofold::dot_minus;
use crate::support::{ScalarOf, sum_of_hessians};
use crate::support_feature::across;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Feature, Hint, LineCrossing, LineQuery, Matrix,
    Parallelotope, Rounding, Scalar, SupportMap, Vector,
};

/// A shape under an affine map: scaled, sheared, mirrored, or, if the matrix is singular, flattened.
///
/// In symbols, the image of each point `x` is `M·x + t`.
///
/// ```
/// use convex_support::{Affine, Ball, SupportMap, glam::{DMat2, DVec2}};
///
/// let disc = Ball::<DVec2>::new(1.0)?;
/// let ellipse = Affine::new(disc, DMat2::from_diagonal(DVec2::new(3.0, 1.0)), DVec2::ZERO)?;
/// assert_eq!(ellipse.support(DVec2::X), DVec2::new(3.0, 0.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Affine<S: SupportMap> {
    shape: S,
    matrix: <S::Vector as Vector>::Matrix,
    /// The transpose in units of a power of two near the largest entry: directions stay in range.
    onto_shape: <S::Vector as Vector>::Matrix,
    /// That power of two.
    unit: ScalarOf<S>,
    translation: S::Vector,
    /// The rounding error of the origin `M·c + t`, which stays with the core.
    lost: S::Vector,
    /// The factor `s` if the matrix is `s` times a rotation or reflection: a ball then stays a ball.
    scale: Option<ScalarOf<S>>,
    /// The radius of a ball that does not stay one, and becomes part of the core.
    swept: ScalarOf<S>,
    /// The inverse of the matrix; `None` if it is singular.
    inverse: Option<<S::Vector as Vector>::Matrix>,
    /// A bound on the error of the core's support points, as a length.
    error: ScalarOf<S>,
}

impl<S: SupportMap> Affine<S> {
    /// The image of the shape under `x ↦ matrix·x + translation`. The matrix may be singular.
    ///
    /// # Errors
    /// [`InvalidShape::NonFinite`] if a number is not finite, [`InvalidShape::TooLarge`] if the image is out of range.
    pub fn new(shape: S, matrix: <S::Vector as Vector>::Matrix, translation: S::Vector) -> Result<Self, InvalidShape> {
        let matrix = finite_matrix("matrix", matrix)?;
        let translation = finite("translation", translation)?;
        let inverse = Some(matrix.inverse()).filter(Matrix::is_finite);
        let largest = S::Vector::from_fn(|j| matrix.col(j).abs().max_element()).max_element();
        let unit = power_of_two_below(largest);
        let transpose = matrix.transpose();
        let onto_shape = Matrix::from_cols_fn(|j| transpose.col(j) / unit);
        let core = shape.core();
        let lost = lost_in_origin(&matrix, core.origin, core.size(), translation)?;
        let scale = uniform_scale(matrix);
        let zero = ScalarOf::<S>::ZERO;
        let swept = if scale.is_some() { zero } else { core.radius };
        // The unit vector times the radius that becomes part of the core is right to 6 roundings. A matrix that scales
        // all lengths by one factor does so to 16 roundings.
        let swept_core = Core {
            extent: core.extent + swept,
            radius: core.radius - swept,
            error: core.error + roundings(6.0, swept) + if swept > zero { roundings(1.0, core.extent) } else { zero },
            ..core
        };
        let norm = scale.unwrap_or_else(|| frobenius_norm(&matrix));
        let stretched = scale.map_or(zero, |scale| roundings(32.0, scale * core.radius));
        let error = length_of_error(&swept_core, norm, zero, translation, lost) + stretched;
        Ok(Self { shape, matrix, onto_shape, unit, translation, lost, scale, swept, inverse, error })
    }

    /// The shape before it is mapped.
    #[must_use]
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The linear part, applied first.
    #[must_use]
    pub fn matrix(&self) -> <S::Vector as Vector>::Matrix {
        self.matrix
    }

    /// The translation, applied last.
    #[must_use]
    pub fn translation(&self) -> S::Vector {
        self.translation
    }
}

impl<S: SupportMap> SupportMap for Affine<S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        // max d·(Mx + t) = max (Mᵀd)·x + d·t, and the length of Mᵀd does not matter.
        self.matrix * self.shape.support(self.onto_shape * direction) + self.translation
    }

    #[inline(always)]
    fn core(&self) -> Core<S::Vector> {
        let Core { origin, radius, rolling_radius, extent, kind, .. } = self.shape.core();
        let is_swept = self.swept > ScalarOf::<S>::ZERO;
        let kind = if is_swept { CoreKind::Curved } else { kind.image(|v| self.matrix * v, self.lost) };
        let (extent, radius) = match self.scale {
            Some(scale) => (scale * extent, scale * radius),
            // |M·x| and every product in it are bounded by the Frobenius norm of M times |x|.
            None => (frobenius_norm(&self.matrix) * (extent + radius), ScalarOf::<S>::ZERO),
        };
        // The ratio has an error of a few roundings.
        let less = ScalarOf::<S>::ONE - ScalarOf::<S>::EPSILON * Scalar::from_f64(16.0);
        Core {
            origin: self.matrix * origin + self.translation,
            radius,
            rolling_radius: self.scale.map_or(Scalar::ZERO, |scale| scale * less * rolling_radius),
            extent: extent + self.lost.abs().max_element() * Scalar::from_f64(2.0),
            error: self.error,
            kind,
        }
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        let direction = self.onto_shape * direction;
        self.matrix * (self.shape.core_support(direction, hint) + swept(self.swept, direction)) + self.lost
    }

    /// The support value is `unit·h(onto_shape·d)` of the swept core.
    #[inline]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        let direction = self.onto_shape * direction;
        let changes = [self.onto_shape * changes[0], self.onto_shape * changes[1]];
        let core = self.shape.core_support_hessian(direction, changes);
        let [a, b, d] = sum_of_hessians(core, swept_hessian(self.swept, direction, changes));
        [a * self.unit, b * self.unit, d * self.unit]
    }

    /// A map that keeps angles also maps the closest point to the closest point.
    #[inline]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.scale?;
        let closest = self.shape.core_closest_point(self.inverse? * (x - self.lost))?;
        Some(self.matrix * closest + self.lost)
    }

    /// The line is taken relative to the image of the shape's origin, and mapped from there onto the shape.
    ///
    /// With the computed inverse `N` and `R = 1 − M·N`, a point `y` is mapped to `x = N·y` and, because `r = M·x − y`
    /// is computed in twice the precision, to `x − N·r`: as if the line were displaced by `R·r` before it is mapped
    /// exactly. If it matters, `y` is no longer than 2 sizes. The foot loses `3uD + 2uS`, and the difference from the
    /// origin `uD`.
    #[inline]
    fn certain_crossing(&self, line: LineQuery<S::Vector>) -> Option<CertainCrossing<S::Vector>> {
        if line.is_close {
            return closely(self, line);
        }
        let (inverse, zero) = (self.inverse?, ScalarOf::<S>::ZERO);
        let (core, image) = (self.shape.core(), self.core());
        let radius = match self.scale {
            Some(scale) => line.radius / scale,
            None if line.radius == zero => zero,
            None => return None,
        };
        let size = image.extent + image.radius + line.radius;
        let far = NearLine::new(line, image.origin, size)?;
        let near = far.at_foot();
        let entry = |i: usize, j: usize| self.matrix.col(j).get(i);
        let onto = |y: S::Vector| {
            let x = inverse * y;
            let left =
                S::Vector::from_fn(|i| dot_minus((0..S::Vector::DIM).map(|j| (entry(i, j), x.get(j))), y.get(i)));
            x - inverse * left
        };
        let source = onto(near.source - self.lost);
        let product = self.matrix * inverse;
        let off: <S::Vector as Vector>::Matrix = Matrix::from_cols_fn(|j| S::Vector::axis(j) - product.col(j));
        let stretch = frobenius_norm(&inverse);
        let off = frobenius_norm(&off) + roundings(6.0, frobenius_norm(&self.matrix) * stretch);
        let error = line.error + roundings(8.0, far.source.norm() + size) + off * (off + off) * size;
        let before = LineQuery {
            source: source + core.origin,
            direction: onto(near.direction),
            radius,
            // The ratio of radii is right to 16 roundings.
            error: error * stretch
                + roundings(4.0, source.norm() + core.size() + core.origin.norm())
                + roundings(32.0, radius),
            ..line
        };
        let known = self.shape.certain_crossing(before)?;
        Some(near.after(known, |normal| {
            let normal = inverse.transpose_mul(normal);
            normal.unit().unwrap_or(normal)
        }))
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        let (map, size) = ((&self.matrix, self.translation), self.shape.core().size());
        line.mapped(map, size, self.scale, |line| self.shape.close_crossing(line))
    }

    fn core_support_feature(&self, direction: S::Vector, slab: ScalarOf<S>, feature: &mut Feature<S::Vector>) {
        let onto_shape = self.onto_shape * direction;
        self.shape.core_support_feature(onto_shape, slab / self.unit, feature);
        // A ball that the matrix flattens along the direction is an edge or a face.
        let is_flat = self.swept > Scalar::ZERO
            && onto_shape.norm() * self.unit * self.swept * ScalarOf::<S>::from_f64(2.0) <= slab;
        let swept = if is_flat { Vector::ZERO } else { swept(self.swept, onto_shape) };
        feature.map(|point| self.matrix * (point + swept) + self.lost);
        if is_flat {
            feature.sweep(seen_section(&self.matrix, direction).map(|half| half * self.swept), slab);
        }
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        if self.swept > ScalarOf::<S>::ZERO {
            return None;
        }
        Some(self.shape.core_parallelotope()?.mapped(|v| self.matrix * v, self.lost))
    }

    fn rounding(&self) -> Rounding<S::Vector> {
        let Core { origin, radius, extent, .. } = self.shape.core();
        let placement = Placement {
            matrix: &self.matrix,
            matrix_error: Scalar::ZERO,
            scale: self.scale,
            translation: self.translation,
            lost: self.lost,
            is_near: is_near(origin, extent + radius),
        };
        let image = placement.image(self.shape.rounding().swept(self.swept), origin, extent);
        // A matrix that scales all lengths by one factor does so to 16 roundings.
        image.with_radius_error(self.scale.map_or(Scalar::ZERO, |scale| roundings(32.0, scale * radius)))
    }
}

impl<S: CrossedByLine> CrossedByLine for Affine<S> {
    /// An invertible map does not change where a line is in a set. A ball that sweeps the image is one before the map
    /// only if the map keeps angles. If the matrix is singular, the image is flat and the answer unknown.
    #[inline]
    fn core_line_crossing(
        &self,
        source: S::Vector,
        direction: S::Vector,
        radius: ScalarOf<S>,
    ) -> LineCrossing<S::Vector> {
        let Some(inverse) = self.inverse else { return LineCrossing::Unknown };
        let radius = match self.scale {
            Some(scale) => radius / scale,
            None if radius == ScalarOf::<S>::ZERO => self.swept,
            None => return LineCrossing::Unknown,
        };
        let crossing = self.shape.core_line_crossing(inverse * (source - self.lost), inverse * direction, radius);
        crossing.with_normal(|normal| {
            let normal = inverse.transpose_mul(normal);
            normal.unit().unwrap_or(normal)
        })
    }
}

/// Conjugate radii of the section of the image of the unit ball that is seen along a direction; the second is nearly
/// zero if the image is a segment, or seen from its edge.
///
/// With unit vectors `e` and `f` across the direction, the outline of the image `{Mu : |u| ≤ 1}` is that of all points
/// `(Mᵀe·u, Mᵀf·u)`. They are farthest out where `u` is in the plane of `Mᵀe` and `Mᵀf`, and so the images of two unit
/// vectors across one another in this plane are the radii. Whatever the rounding of that plane, they are points of the
/// image.
fn seen_section<M: Matrix>(matrix: &M, direction: M::Vector) -> [M::Vector; 2] {
    let [x, y] = across(direction).map(|e| matrix.transpose_mul(e));
    let (longer, other) = if x.norm() < y.norm() { (y, x) } else { (x, y) };
    let Some(u) = longer.unit() else { return [M::Vector::ZERO; 2] };
    // What is left of nearly parallel vectors is rounding, which may be along the first.
    let rest = |v: M::Vector| v - u * v.dot(u);
    let w = rest(other).unit().map(rest).filter(|w| w.norm() > Scalar::from_f64(0.5)).and_then(Vector::unit);
    [*matrix * u, w.map_or(M::Vector::ZERO, |w| *matrix * w)]
}

fn frobenius_norm<M: Matrix>(matrix: &M) -> <M::Vector as Vector>::Scalar {
    M::Vector::from_fn(|j| matrix.col(j).norm()).norm()
}

/// The factor `s > 0` if the matrix is, to rounding, `s` times an orthogonal one.
fn uniform_scale<M: Matrix>(matrix: M) -> Option<<M::Vector as Vector>::Scalar> {
    type S<M> = <<M as Matrix>::Vector as Vector>::Scalar;
    let scale = matrix.col(0).norm();
    let tolerance = S::<M>::EPSILON * S::<M>::from_f64(4.0);
    let like = |i: usize, j: usize| {
        // The columns in units of the scale: orthonormal.
        let product = (matrix.col(i) / scale).dot(matrix.col(j) / scale);
        (product - if i == j { S::<M>::ONE } else { S::<M>::ZERO }).abs() <= tolerance
    };
    let pairs = (0..M::Vector::DIM).flat_map(|i| (0..=i).map(move |j| (i, j)));
    (scale > S::<M>::ZERO && pairs.into_iter().all(|(i, j)| like(i, j))).then_some(scale)
}
