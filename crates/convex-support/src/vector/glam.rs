//! The vectors and matrices of glam, each of which forwards to its own methods.

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3, Mat2, Mat3, Mat3A, Quat, Vec2, Vec3, Vec3A};

use super::{Matrix, Vector, Vector3, sealed};

/// Forwards [`Vector`] and [`Matrix`] to a vector of glam and to the matrix that acts on it.
macro_rules! glam_vector {
    ($V:ident {
        scalar: $S:ident,
        coordinates: [$($i:literal),+],
        rotation: $R:ident,
        angular_velocity: $W:ident,
        matrix: $M:ident $(,)?
    }) => {
        impl sealed::Sealed for $V {}
        impl sealed::Sealed for $M {}

        impl Vector for $V {
            type Scalar = $S;
            type Matrix = $M;
            type Rotation = $R;
            type AngularVelocity = $W;

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
            fn determinant(&self) -> $S { self.determinant() }
            #[inline]
            fn inverse(&self) -> Self { self.inverse() }
        }
    };
}

glam_vector!(Vec2 { scalar: f32, coordinates: [0, 1], rotation: f32, angular_velocity: f32, matrix: Mat2 });
glam_vector!(DVec2 { scalar: f64, coordinates: [0, 1], rotation: f64, angular_velocity: f64, matrix: DMat2 });
glam_vector!(Vec3 { scalar: f32, coordinates: [0, 1, 2], rotation: Quat, angular_velocity: Vec3, matrix: Mat3 });
glam_vector!(Vec3A { scalar: f32, coordinates: [0, 1, 2], rotation: Quat, angular_velocity: Vec3A, matrix: Mat3A });
glam_vector!(DVec3 { scalar: f64, coordinates: [0, 1, 2], rotation: DQuat, angular_velocity: DVec3, matrix: DMat3 });

impl Vector3 for Vec3 {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}

impl Vector3 for Vec3A {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}

impl Vector3 for DVec3 {
    #[inline]
    fn cross(self, rhs: Self) -> Self {
        self.cross(rhs)
    }
}
