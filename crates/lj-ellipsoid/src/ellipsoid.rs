//! The ellipsoid of an answer.

use crate::numerics::dimension::Const;
use crate::numerics::twofold;
use crate::shape::Shape;

/// An ellipsoid in N dimensions: E(c, X) = { x : (x − c)ᵀX(x − c) ≤ 1 }.
///
/// It is kept by centre, orthonormal axes and semi-axes, which are accurate at any aspect ratio;
/// [`matrix`](Self::matrix) is formed from them. The condition of X is the square of the aspect ratio. So beyond an
/// aspect of 1e8 the doubles of X no longer determine the longest axis, and rounding may leave them without a
/// Cholesky factor: use, store and print centre, semi-axes and axes (or the [rotation](Ellipsoid::<3>::rotation))
/// there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid<const N: usize> {
    center: [f64; N],
    axes: [[f64; N]; N],
    semi_axes: [f64; N],
    matrix: [[f64; N]; N],
    log_det: f64,
}

impl<const N: usize> Ellipsoid<N> {
    pub(crate) const fn from_shape(shape: &Shape<Const<N>>) -> Self {
        Self {
            center: shape.center,
            axes: shape.axes.0,
            semi_axes: shape.semi_axes,
            matrix: shape.matrix.0,
            log_det: shape.log_det,
        }
    }

    /// The centre c.
    #[must_use]
    pub const fn center(&self) -> [f64; N] {
        self.center
    }

    /// The orthonormal directions of the semi-axes: row k is that of `semi_axes()[k]`. As a matrix these rows are the
    /// rotation from the world into the frame of the ellipsoid; its determinant is +1.
    #[must_use]
    pub const fn axes(&self) -> [[f64; N]; N] {
        self.axes
    }

    /// The lengths of the semi-axes, longest first. Those across the affine hull of a flat set are zero.
    #[must_use]
    pub const fn semi_axes(&self) -> [f64; N] {
        self.semi_axes
    }

    /// X, row by row, symmetric to the last bit, but beyond an aspect ratio of 1e8 perhaps not positive definite. For
    /// an ellipsoid within an affine hull it measures within the hull only (it is zero along the normals).
    ///
    /// It is rounded separately. The matrix of an enclosing ellipsoid is rounded outward: it too holds every point in
    /// (x − c)ᵀX(x − c) ≤ 1, evaluated in `f64` in any order or exactly. The matrix of an inscribed one is rounded
    /// inward, and proved to be within the body too, as long as the rounding takes less than half of it: up to an
    /// aspect ratio of some 1e7.
    #[must_use]
    pub const fn matrix(&self) -> [[f64; N]; N] {
        self.matrix
    }

    /// The logarithm of the determinant of X: −2·Σ ln semi-axis, over the semi-axes that are not zero.
    #[must_use]
    pub const fn log_det(&self) -> f64 {
        self.log_det
    }

    /// The logarithm of the volume; of the length or area if the ellipsoid lies in an affine hull, and 0 for a point.
    #[must_use]
    pub fn log_volume(&self) -> f64 {
        let rank = self.semi_axes.iter().filter(|a| **a > 0.0).count();
        crate::shape::log_unit_ball_volume(rank) - 0.5 * self.log_det
    }

    /// The factor by which the ellipsoid has to be scaled about its centre to have `x` on its surface: 1 on the
    /// surface, less inside. It is |diag(1/a)·Rᵀ(x − c)|. Components across the affine hull of a flat ellipsoid are
    /// ignored.
    #[must_use]
    pub fn radius_at(&self, x: impl Into<[f64; N]>) -> f64 {
        radius_at(&self.center, self.axes.as_flattened(), &self.semi_axes, &x.into())
    }

    /// Whether `x` lies in the ellipsoid, boundary included, as evaluated in `f64` by [`radius_at`](Self::radius_at).
    #[must_use]
    pub fn contains(&self, x: impl Into<[f64; N]>) -> bool {
        self.radius_at(x) <= 1.0
    }

    /// The support value: the largest direction·x over the ellipsoid, direction·c + |diag(a)·R·direction|. The
    /// direction need not be of unit length. Sums are in twice the precision, so that the value is right to a few
    /// roundings however thin the ellipsoid is.
    #[must_use]
    pub fn support_value(&self, direction: impl Into<[f64; N]>) -> f64 {
        support_value(&self.center, self.axes.as_flattened(), &self.semi_axes, &direction.into())
    }

    /// The volume of this ellipsoid over that of `outer`, to the power 1/N: with the inscribed and the enclosing
    /// ellipsoid of one body a number in [1/N, 1], which tells how nearly the body is an ellipsoid.
    #[must_use]
    pub fn tightness(&self, outer: &Self) -> f64 {
        libm::exp(0.5 * (outer.log_det - self.log_det) / N as f64)
    }
}

impl Ellipsoid<2> {
    /// The angle in radians by which the frame of the ellipsoid is turned against the world, in (−π, π]: the direction
    /// of the longest semi-axis is (cos, sin) of it.
    #[must_use]
    pub fn rotation(&self) -> f64 {
        libm::atan2(self.axes[0][1], self.axes[0][0])
    }
}

impl Ellipsoid<3> {
    /// The unit quaternion [x, y, z, w], w ≥ 0, of the rotation from the frame of the ellipsoid into the world: it
    /// takes the coordinate axis k to `axes()[k]`.
    ///
    /// The largest of the four is found from the diagonal and the others from it, so nothing is lost near half a turn
    /// (S. W. Shepperd, *Quaternion from rotation matrix*, J. Guid. Control 1, 1978).
    ///
    /// # Examples
    /// ```
    /// use lj_ellipsoid::{EnclosingOptions, enclosing};
    ///
    /// // A plate that stands in the plane of y and z: its longest axis is y, its shortest x.
    /// let plate: Vec<[f64; 3]> = (0..8u8)
    ///     .map(|i| [1e-12 * f64::from(i & 1), 4.0 * f64::from(i >> 1 & 1), 2.0 * f64::from(i >> 2)])
    ///     .collect();
    /// let ellipsoid = enclosing(&plate, EnclosingOptions::default())?.ellipsoid;
    /// assert_eq!(ellipsoid.axes()[0].map(f64::abs), [0.0, 1.0, 0.0]);
    /// // A third of a turn about a diagonal.
    /// assert!(ellipsoid.rotation().iter().all(|q| (q.abs() - 0.5).abs() < 1e-15));
    /// # Ok::<(), lj_ellipsoid::EnclosingError>(())
    /// ```
    #[must_use]
    pub fn rotation(&self) -> [f64; 4] {
        // Column k of the rotation matrix is axis k.
        let m = |i: usize, k: usize| self.axes[k][i];
        // The values 4·q² of x, y, z and w.
        let squares = [
            1.0 + m(0, 0) - m(1, 1) - m(2, 2),
            1.0 - m(0, 0) + m(1, 1) - m(2, 2),
            1.0 - m(0, 0) - m(1, 1) + m(2, 2),
            1.0 + m(0, 0) + m(1, 1) + m(2, 2),
        ];
        let largest = (1..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
        // The values 4·q·r for every pair of components.
        let (xy, xz, yz) = (m(0, 1) + m(1, 0), m(0, 2) + m(2, 0), m(1, 2) + m(2, 1));
        let (xw, yw, zw) = (m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
        let products = match largest {
            0 => [squares[0], xy, xz, xw],
            1 => [xy, squares[1], yz, yw],
            2 => [xz, yz, squares[2], zw],
            _ => [xw, yw, zw, squares[3]],
        };
        let length = products.iter().map(|p| p * p).sum::<f64>().sqrt().copysign(products[3]);
        products.map(|p| p / length)
    }
}

/// The length |diag(1/a)·R·(x − c)| over the semi-axes that are not zero. Promises about points as evaluated in `f64`
/// refer to this evaluation.
#[inline]
pub(crate) fn radius_at(center: &[f64], axes: &[f64], semi_axes: &[f64], x: &[f64]) -> f64 {
    let n = center.len();
    let mut square = 0.0;
    for (axis, &a) in axes.chunks_exact(n).zip(semi_axes) {
        if a > 0.0 {
            let mut along = 0.0;
            for k in 0..n {
                along += axis[k] * (x[k] - center[k]);
            }
            square += (along / a) * (along / a);
        }
    }
    square.sqrt()
}

/// No less than |diag(1/a)·R·(x − c)| over the semi-axes that are not zero, as exact sums of the doubles.
///
/// As in [`reach_at_most`], with one more quotient.
pub(crate) fn radius_at_most(center: &[f64], axes: &[f64], semi_axes: &[f64], x: &[f64]) -> f64 {
    let n = center.len();
    let mut square = n as f64 * f64::from_bits(1);
    for (axis, a) in axes.chunks_exact(n).zip(semi_axes).filter(|(_, a)| **a > 0.0) {
        let to_x = axis.iter().copied().zip(x.iter().copied());
        let from_center = axis.iter().copied().zip(center.iter().map(|c| -c));
        let (along, error) = twofold::dot_with_error(to_x.chain(from_center));
        let ratio = (along.abs() + error) / a;
        square += ratio * ratio;
    }
    square.sqrt() * (1.0 + (n as f64 + 6.0) * f64::EPSILON)
}

/// direction·c + |diag(a)·R·direction|. Promises about half-spaces as evaluated in `f64` refer to this evaluation.
///
/// If a turned ellipsoid is thin, a long axis along the direction and the direction along a long axis are differences
/// of large products: a plain sum would lose 1e-16 of the length of the ellipsoid, and with it all of its thickness.
pub(crate) fn support_value(center: &[f64], axes: &[f64], semi_axes: &[f64], direction: &[f64]) -> f64 {
    let reach = square_of_reach(axes, semi_axes, direction, |(along, _)| along).sqrt();
    let to_center = direction.iter().copied().zip(center.iter().copied());
    twofold::dot(to_center.chain([(reach, 1.0)]))
}

/// No less than |diag(a)·R·direction|, as exact sums of the doubles.
///
/// Squares, their sum and the root lose less than n + 4 roundings, and a square that underflows less than the smallest
/// number.
pub(crate) fn reach_at_most(axes: &[f64], semi_axes: &[f64], direction: &[f64]) -> f64 {
    let n = direction.len() as f64;
    let square = square_of_reach(axes, semi_axes, direction, |(along, error)| along.abs() + error);
    (square + n * f64::from_bits(1)).sqrt() * (1.0 + (n + 4.0) * f64::EPSILON)
}

/// The square |diag(a)·R·direction|² from components in twice the precision, each made by `component` of the sum and
/// the bound on its error.
fn square_of_reach(axes: &[f64], semi_axes: &[f64], direction: &[f64], component: impl Fn((f64, f64)) -> f64) -> f64 {
    let along = |axis: &[f64]| twofold::dot_with_error(axis.iter().copied().zip(direction.iter().copied()));
    let components = axes.chunks_exact(direction.len()).zip(semi_axes).map(|(axis, a)| a * component(along(axis)));
    components.map(|x| x * x).sum()
}
