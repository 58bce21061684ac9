//! An ellipsoid by its centre, axes and semi-axes.

use num_traits::Float as _;

use crate::closest_point::closest_of_ellipsoid;
use crate::error::{InvalidShape, finite, finite_matrix, orthonormal};
use crate::line_crossing::{NearLine, closely, ellipsoid, skew};
use crate::numerics::bound::{image, raised, roundings, roundings_of};
use crate::numerics::jacobi;
use crate::numerics::range::power_of_two_below;
use crate::support::swept_hessian;
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Hint, LineCrossing, LineQuery, Matrix, Rotation,
    Rounding, Scalar, SupportMap, Vector,
};

/// An ellipsoid, in 2D an ellipse: the points `c + R·diag(a)·u` with `|u| ≤ 1`.
///
/// It is kept as centre `c`, orthonormal axes (the columns of `R`) and semi-axes `a`. The matrix form
/// `{ x : (x − c)ᵀX(x − c) ≤ 1 }` has `X = R·diag(a)⁻²·Rᵀ`, whose condition is the square of the aspect ratio:
/// forming it loses all accuracy of the longest axis at an aspect of 1e8 in `f64`. So give the axes if you know them.
///
/// ```
/// use convex_support::{Ellipsoid, glam::{DMat2, DVec2}, support_value};
///
/// let ellipse = Ellipsoid::new(DVec2::ZERO, DVec2::new(2.0, 1.0), 0.0)?;
/// assert_eq!(support_value(&ellipse, DVec2::X), 2.0);
///
/// let same = Ellipsoid::from_matrix(DVec2::ZERO, DMat2::from_diagonal(DVec2::new(0.25, 1.0)))?;
/// assert_eq!(support_value(&same, DVec2::X), 2.0);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<V: Vector> {
    center: V,
    axes: V::Matrix,
    semi_axes: V,
    inverse_semi_axes: V,
    /// A bound on the error of every entry of the axes, except columns along a coordinate axis, in units of epsilon.
    axes_error: V::Scalar,
    /// A bound on the error of the support points, as a length.
    error: V::Scalar,
    /// A bound on the distance of the points from where they would be if the transpose of the axes were their inverse,
    /// and these were exact.
    skew: V::Scalar,
    /// The radius of a ball that rolls around within.
    rolling_radius: V::Scalar,
    /// The semi-axes in units of a power of two near the largest: products with a direction stay in range.
    scaled_semi_axes: V,
    /// That power of two.
    unit: V::Scalar,
}

impl<V: Vector> Ellipsoid<V> {
    /// The ellipsoid about `center` whose semi-axes, along the coordinate axes, are turned by `rotation`.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite, a semi-axis is not positive, or the rotation is the zero quaternion.
    pub fn new(center: V, semi_axes: V, rotation: V::Rotation) -> Result<Self, InvalidShape> {
        let axes = rotation.checked("rotation")?.matrix();
        let axes_error = V::Scalar::from_f64(V::Rotation::MATRIX_ERROR);
        let turned = roundings(2.0 * V::Rotation::OPERATOR_ERROR, semi_axes.max_element());
        let about_axes = Self::from_axes(center, semi_axes, axes)?;
        Ok(Self { axes_error, error: about_axes.error + turned, skew: about_axes.skew + turned, ..about_axes })
    }

    /// The ellipsoid about `center` whose semi-axis `i` lies along column `i` of `axes`, which must be orthonormal.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite, a semi-axis is not positive, or the axes are not orthonormal to half
    /// of their digits.
    pub fn from_axes(center: V, semi_axes: V, axes: V::Matrix) -> Result<Self, InvalidShape> {
        let center = finite("center", center)?;
        let semi_axes = finite("semi_axes", semi_axes)?;
        let axes = orthonormal("axes", axes)?;
        let unit = power_of_two_below(semi_axes.max_element());
        match (0..V::DIM).find(|&i| semi_axes.get(i) <= V::Scalar::ZERO) {
            Some(index) => {
                Err(InvalidShape::NotPositive { parameter: "semi_axes", index, value: semi_axes.get(index).as_f64() })
            }
            None => Ok(Self {
                center,
                axes,
                semi_axes,
                inverse_semi_axes: V::ONE / semi_axes,
                axes_error: V::Scalar::ZERO,
                error: roundings(SUPPORT_POINT_ERROR, semi_axes.max_element()),
                skew: skew(&axes) * semi_axes.max_element(),
                rolling_radius: rolling_radius(semi_axes),
                scaled_semi_axes: semi_axes / unit,
                unit,
            }),
        }
    }

    /// The ellipsoid `{ x : (x − center)ᵀ·matrix·(x − center) ≤ 1 }`.
    ///
    /// The axes and semi-axes are found from a pivoted Cholesky factor by one-sided Jacobi rotations in `f64`: each
    /// semi-axis is as accurate, relative to itself, as the matrix determines it. From then on the axes and semi-axes
    /// define the ellipsoid.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite, or the matrix is not symmetric or not positive definite to rounding.
    pub fn from_matrix(center: V, matrix: V::Matrix) -> Result<Self, InvalidShape> {
        let center = finite("center", center)?;
        let matrix = finite_matrix("matrix", matrix)?;
        let mut x = [[0.0; 3]; 3];
        for (j, column) in x.iter_mut().enumerate().take(V::DIM) {
            for (i, entry) in column.iter_mut().enumerate().take(V::DIM) {
                *entry = matrix.col(j).get(i).as_f64();
            }
        }
        let jacobi::Axes { directions, roots } = jacobi::axes(x, V::DIM, V::Scalar::EPSILON.as_f64())?;
        let axes = V::Matrix::from_cols_fn(|j| V::from_fn(|i| V::Scalar::from_f64(directions[j][i])));
        let semi_axes = V::from_fn(|i| V::Scalar::from_f64(1.0 / roots[i]));
        Self::from_axes(center, semi_axes, axes)
    }

    /// The centre.
    #[must_use]
    pub fn center(&self) -> V {
        self.center
    }

    /// The semi-axes: half the size along each column of [`axes`](Self::axes).
    #[must_use]
    pub fn semi_axes(&self) -> V {
        self.semi_axes
    }

    /// The directions of the semi-axes, as orthonormal columns.
    #[must_use]
    pub fn axes(&self) -> V::Matrix {
        self.axes
    }

    /// The matrix `X = R·diag(a)⁻²·Rᵀ` of the form `(x − c)ᵀX(x − c) ≤ 1`; entries may overflow if a semi-axis is below
    /// the square root of the smallest number.
    #[must_use]
    pub fn matrix(&self) -> V::Matrix {
        self.sum_of_squares(|a| (a * a).recip())
    }

    /// The inverse of [`matrix`](Self::matrix), `R·diag(a)²·Rᵀ`: the squared support value about the centre is
    /// `dᵀ·shape_matrix·d`.
    #[must_use]
    pub fn shape_matrix(&self) -> V::Matrix {
        self.sum_of_squares(|a| a * a)
    }

    /// `R·diag(f(a))·Rᵀ`.
    fn sum_of_squares(&self, f: impl Fn(V::Scalar) -> V::Scalar) -> V::Matrix {
        let scaled = V::Matrix::from_cols_fn(|j| self.axes.col(j) * f(self.semi_axes.get(j)));
        // Column by column from the outer products, so that the result is symmetric to the last bit.
        V::Matrix::from_cols_fn(|j| {
            V::from_fn(|i| {
                let mut sum = V::Scalar::ZERO;
                for k in 0..V::DIM {
                    let (low, high) = (i.min(j), i.max(j));
                    sum += scaled.col(k).get(low) * self.axes.col(k).get(high);
                }
                sum
            })
        })
    }

    /// The same ellipsoid after the rigid motion `x ↦ rotation·x + translation`.
    ///
    /// # Errors
    /// [`InvalidShape`] if a number is not finite or the rotation is the zero quaternion.
    pub fn posed(&self, rotation: V::Rotation, translation: V) -> Result<Self, InvalidShape> {
        let rotation = rotation.checked("rotation")?.matrix();
        Self::from_axes(rotation * self.center + translation, self.semi_axes, rotation * self.axes)
    }
}

/// The radius of a ball that rolls around within an ellipsoid.
///
/// The least radius of curvature is `c²/a`, of the least and the largest semi-axis. Axes that are orthonormal to half
/// of their digits may change it by a part, which is less than an eighth unless the ellipsoid is thin; and then there
/// is not much to gain.
fn rolling_radius<V: Vector>(semi_axes: V) -> V::Scalar {
    let (least, largest) = (semi_axes.min_element(), semi_axes.max_element());
    let ratio = least / largest;
    let is_thin = ratio < V::Scalar::from_f64(1.0 / 16.0);
    if is_thin { V::Scalar::ZERO } else { ratio * least * V::Scalar::from_f64(0.875) }
}

/// The error of a support point `R·(a∘u)`, in roundings of the largest semi-axis: 8 for the unit vector and the
/// products with the semi-axes, `3√3` for those with the axes; and twice the `3√3 + 1` that the direction loses in the
/// ellipsoid's frame.
const SUPPORT_POINT_ERROR: f64 = 26.0;

impl<V: Vector> SupportMap for Ellipsoid<V> {
    type Vector = V;

    #[inline(always)]
    fn support(&self, direction: V) -> V {
        self.center + self.core_support(direction, &mut Hint::new())
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        let exact = Core::exact(CoreKind::Curved, self.semi_axes.max_element());
        Core { origin: self.center, rolling_radius: self.rolling_radius, error: self.error, ..exact }
    }

    #[inline(always)]
    fn core_support(&self, direction: V, _hint: &mut Hint) -> V {
        // max e·(a∘u) over |u| ≤ 1, with e = Rᵀd: u is the unit vector along a∘e.
        let e = self.axes.transpose_mul(direction);
        let u = (self.scaled_semi_axes * e).unit().unwrap_or_else(|| V::axis(0));
        self.axes * (self.semi_axes * u)
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: V, changes: [V; 2]) -> [V::Scalar; 3] {
        // h(d) = |a∘e| with e = Rᵀd, and a change u moves a∘e by a∘Rᵀu: the Hessian of a length.
        let onto_ball = |v| self.scaled_semi_axes * self.axes.transpose_mul(v);
        swept_hessian(self.unit, onto_ball(direction), [onto_ball(changes[0]), onto_ball(changes[1])])
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        let closest = closest_of_ellipsoid(self.semi_axes, self.axes.transpose_mul(x));
        Some(closest.map_or(x, |z| self.axes * z))
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        if line.radius > V::Scalar::ZERO {
            return None;
        }
        if line.is_close {
            return closely(self, line);
        }
        NearLine::new(line.within(self.skew), self.center, self.semi_axes.max_element())?
            .ellipsoid(&self.axes, self.inverse_semi_axes)
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        let (axes, size) = ((&self.axes, self.center), [self.semi_axes.max_element(), V::Scalar::ZERO]);
        line.turned(axes, self.axes_error, size, |line| line.ellipsoid(self.semi_axes))
    }

    /// The support point is `R·(a∘u)` with a unit vector `u` that is right to 7 roundings, for the direction along
    /// which the point is farthest: with three for the product, 11 roundings of the extent. That direction is `d` to 4
    /// roundings in the ellipsoid's frame, and the point is short by that times twice the semi-axes at most. Errors of
    /// the axes move all of it.
    fn rounding(&self) -> Rounding<V> {
        let row = |i: usize| V::from_fn(|j| self.axes.col(j).get(i) * self.semi_axes.get(j));
        let extent = V::from_fn(|i| raised(row(i).norm()));
        let moved = roundings(2.0, self.semi_axes.norm()) * self.axes_error;
        let along_axis = |i: usize| (0..V::DIM).any(|j| self.axes.col(j).get(i).abs() == V::Scalar::ONE);
        let moved = V::from_fn(|i| if along_axis(i) { V::Scalar::ZERO } else { moved });
        let short = roundings_of(8.0, image(&self.axes, self.semi_axes));
        Rounding::exact(extent).with_error(roundings_of(11.0, extent) + short + moved)
    }
}

impl<V: Vector> CrossedByLine for Ellipsoid<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius > V::Scalar::ZERO {
            return LineCrossing::Unknown;
        }
        ellipsoid(&self.axes, self.inverse_semi_axes, source, direction).into()
    }
}
