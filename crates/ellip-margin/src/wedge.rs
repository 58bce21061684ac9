//! Torques and infinitesimal rotations: a number in 2D, a vector in 3D.

use convex_support::Vector;
use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};

/// A vector with the product that makes torques: `r ∧ F` is `r × F` in 3D and its only coordinate in 2D.
///
/// Infinitesimal rotations and their gradients are of the product's type: in 3D a vector along the axis in world
/// coordinates, in 2D one number, counter-clockwise positive. Implemented for glam's five vectors, and sealed by
/// [`Vector`].
///
/// ```
/// use convex_support::glam::{DVec2, DVec3};
/// use ellip_margin::Wedge;
///
/// assert_eq!(DVec2::X.wedge(DVec2::Y), 1.0);
/// assert_eq!(DVec3::X.wedge(DVec3::Y), DVec3::Z);
/// assert_eq!(DVec3::coordinates(&DVec3::Z), [0.0, 0.0, 1.0]);
/// assert_eq!(DVec2::coordinates(&1.0), [1.0]);
/// ```
pub trait Wedge: Vector {
    /// An infinitesimal rotation: the scalar in 2D, the vector in 3D.
    type Bivector: Copy + core::fmt::Debug + Default + PartialEq + Send + Sync + 'static;

    /// The second derivatives by a translation and a rotation: 3 by 3 numbers in 2D, 6 by 6 in 3D, as an array of rows.
    type MotionMatrix: Copy + core::fmt::Debug + PartialEq + Send + Sync + 'static;

    /// `self ∧ rhs`.
    fn wedge(self, rhs: Self) -> Self::Bivector;

    /// `self · rhs` of two infinitesimal rotations: the turn about one that is contained in the other.
    fn bivector_dot(a: Self::Bivector, b: Self::Bivector) -> Self::Scalar;

    /// The coordinates: one in 2D, three in 3D.
    fn coordinates(bivector: &Self::Bivector) -> &[Self::Scalar];

    /// The rotation whose coordinate `i` is `f(i)`.
    fn bivector(f: impl FnMut(usize) -> Self::Scalar) -> Self::Bivector;

    /// The matrix whose entry in row `i`, column `j` is `f(i, j)`.
    fn motion_matrix(f: impl Fn(usize, usize) -> Self::Scalar) -> Self::MotionMatrix;

    /// The entry in row `i`, column `j`.
    fn motion_entry(matrix: &Self::MotionMatrix, i: usize, j: usize) -> Self::Scalar;
}

/// The matrix whose entry in row `i`, column `j` is `f(i, j)`, by loops, as `array::from_fn` of arrays is not inlined.
#[inline]
fn matrix<S: Copy + Default, const N: usize>(f: impl Fn(usize, usize) -> S) -> [[S; N]; N] {
    let mut matrix = [[S::default(); N]; N];
    for (i, row) in matrix.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            *entry = f(i, j);
        }
    }
    matrix
}

/// Forwards to the plane's perpendicular product.
macro_rules! plane {
    ($V:ident, $S:ident) => {
        impl Wedge for $V {
            type Bivector = $S;
            type MotionMatrix = [[$S; 3]; 3];

            #[inline]
            fn wedge(self, rhs: Self) -> $S {
                self.perp_dot(rhs)
            }
            #[inline]
            fn bivector_dot(a: $S, b: $S) -> $S {
                a * b
            }
            #[inline]
            fn coordinates(bivector: &$S) -> &[$S] {
                core::slice::from_ref(bivector)
            }
            #[inline]
            fn bivector(mut f: impl FnMut(usize) -> $S) -> $S {
                f(0)
            }
            #[inline]
            fn motion_matrix(f: impl Fn(usize, usize) -> $S) -> Self::MotionMatrix {
                matrix(f)
            }
            fn motion_entry(matrix: &Self::MotionMatrix, i: usize, j: usize) -> $S {
                matrix[i][j]
            }
        }
    };
}

/// Forwards to the cross product.
macro_rules! space {
    ($V:ident, $S:ident) => {
        impl Wedge for $V {
            type Bivector = Self;
            type MotionMatrix = [[$S; 6]; 6];

            #[inline]
            fn wedge(self, rhs: Self) -> Self {
                self.cross(rhs)
            }
            #[inline]
            fn bivector_dot(a: Self, b: Self) -> $S {
                a.dot(b)
            }
            #[inline]
            fn coordinates(bivector: &Self) -> &[$S] {
                let array: &[$S; 3] = bivector.as_ref();
                array
            }
            #[inline]
            fn bivector(f: impl FnMut(usize) -> $S) -> Self {
                Self::from_fn(f)
            }
            #[inline]
            fn motion_matrix(f: impl Fn(usize, usize) -> $S) -> Self::MotionMatrix {
                matrix(f)
            }
            fn motion_entry(matrix: &Self::MotionMatrix, i: usize, j: usize) -> $S {
                matrix[i][j]
            }
        }
    };
}

plane!(Vec2, f32);
plane!(DVec2, f64);
space!(Vec3, f32);
space!(Vec3A, f32);
space!(DVec3, f64);
