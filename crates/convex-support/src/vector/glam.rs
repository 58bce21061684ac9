//! The vectors and matrices of glam. They forward to its methods, unless these compute different bits on some machines:
//! products are fused in `Vec3A::cross` on some processors, and the minors of glam sum determinants in different
//! orders.

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3, Mat2, Mat3, Mat3A, Quat, Vec2, Vec3, Vec3A, Vec3Swizzles as _};

use super::{Matrix, Vector, Vector3};
use crate::sealed::Sealed;

/// Forwards [`Vector`] and [`Matrix`] to a vector of glam and to the matrix that acts on it.
macro_rules! glam_vector {
    ($V:ident {
        scalar: $S:ident,
        coordinates: [$($i:literal),+],
        rotation: $R:ident,
        angular_velocity: $W:ident,
        matrix: $M:ident of $space:ident,
        numbers: $N:ident $(,)?
    }) => {
        impl Sealed for $V {}
        impl Sealed for $M {}

        impl Vector for $V {
            type Scalar = $S;
            type Matrix = $M;
            type Rotation = $R;
            type AngularVelocity = $W;
            type Numbers = $N;

            const DIM: usize = [$($i),+].len();
            const ZERO: Self = Self::ZERO;
            const ONE: Self = Self::ONE;

            #[inline]
            fn splat(value: $S) -> Self { Self::splat(value) }
            #[inline]
            fn from_fn(mut f: impl FnMut(usize) -> $S) -> Self { Self::new($(f($i)),+) }
            #[inline]
            fn get(self, index: usize) -> $S { self[index] }
            #[inline]
            fn dot(self, rhs: Self) -> $S { self.dot(rhs) }
            #[inline]
            fn length_squared(self) -> $S { self.length_squared() }
            #[inline]
            fn length(self) -> $S { self.length() }
            #[inline]
            fn abs(self) -> Self { self.abs() }
            #[inline]
            fn min(self, rhs: Self) -> Self { self.min(rhs) }
            #[inline]
            fn max(self, rhs: Self) -> Self { self.max(rhs) }
            #[inline]
            fn copysign(self, sign: Self) -> Self { self.copysign(sign) }
            #[inline]
            fn max_element(self) -> $S { self.max_element() }
            #[inline]
            fn min_element(self) -> $S { self.min_element() }
            #[inline]
            fn is_finite(self) -> bool { self.is_finite() }
            #[inline]
            fn is_nan(self) -> bool { self.is_nan() }
        }

        impl Matrix for $M {
            type Vector = $V;

            const IDENTITY: Self = Self::IDENTITY;

            #[inline]
            fn from_cols_fn(mut f: impl FnMut(usize) -> $V) -> Self { Self::from_cols($(f($i)),+) }
            #[inline]
            fn col(&self, index: usize) -> $V { self.col(index) }
            #[inline]
            fn transpose(&self) -> Self { self.transpose() }
            #[inline]
            fn transpose_mul(&self, rhs: $V) -> $V { $V::new($(self.col($i).dot(rhs)),+) }
            #[inline]
            fn determinant(&self) -> $S { $space::determinant(self) }
            #[inline]
            fn inverse(&self) -> Self { $space::inverse(self) }
        }
    };
}

/// Matrices of the plane.
mod plane {
    use crate::{Matrix, Scalar as _, Vector};

    #[inline]
    pub(super) fn determinant<M: Matrix>(matrix: &M) -> <M::Vector as Vector>::Scalar {
        let (x, y) = (matrix.col(0), matrix.col(1));
        x.get(0) * y.get(1) - x.get(1) * y.get(0)
    }

    #[inline]
    pub(super) fn inverse<M: Matrix>(matrix: &M) -> M {
        let (x, y) = (matrix.col(0), matrix.col(1));
        let per = <M::Vector as Vector>::Scalar::ONE / determinant(matrix);
        let entries = [[y.get(1) * per, -x.get(1) * per], [-y.get(0) * per, x.get(0) * per]];
        M::from_cols_fn(|j| M::Vector::from_fn(|i| entries[j][i]))
    }
}

/// Matrices of space.
mod space {
    use crate::{Matrix, Scalar as _, Vector, Vector3};

    #[inline]
    pub(super) fn determinant<M: Matrix<Vector: Vector3>>(matrix: &M) -> <M::Vector as Vector>::Scalar {
        matrix.col(0).dot(matrix.col(1).cross(matrix.col(2)))
    }

    #[inline]
    pub(super) fn inverse<M: Matrix<Vector: Vector3>>(matrix: &M) -> M {
        let [x, y, z] = [0, 1, 2].map(|j| matrix.col(j));
        let rows = [y.cross(z), z.cross(x), x.cross(y)];
        let per = <M::Vector as Vector>::Scalar::ONE / x.dot(rows[0]);
        M::from_cols_fn(|j| rows[j] * per).transpose()
    }
}

glam_vector!(Vec2 {
    scalar: f32,
    coordinates: [0, 1],
    rotation: f32,
    angular_velocity: f32,
    matrix: Mat2 of plane,
    numbers: Vec2,
});
glam_vector!(DVec2 {
    scalar: f64,
    coordinates: [0, 1],
    rotation: f64,
    angular_velocity: f64,
    matrix: DMat2 of plane,
    numbers: DVec2,
});
glam_vector!(Vec3 {
    scalar: f32,
    coordinates: [0, 1, 2],
    rotation: Quat,
    angular_velocity: Vec3,
    matrix: Mat3 of space,
    numbers: Vec3,
});
glam_vector!(Vec3A {
    scalar: f32,
    coordinates: [0, 1, 2],
    rotation: Quat,
    angular_velocity: Vec3A,
    matrix: Mat3A of space,
    numbers: Vec3,
});
glam_vector!(DVec3 {
    scalar: f64,
    coordinates: [0, 1, 2],
    rotation: DQuat,
    angular_velocity: DVec3,
    matrix: DMat3 of space,
    numbers: DVec3,
});

impl Vector3 for Vec3 {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}

impl Vector3 for Vec3A {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        (self.zxy() * rhs - self * rhs.zxy()).zxy()
    }
}

impl Vector3 for DVec3 {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}
