//! Second derivatives of the signed distance.

use convex_support::{AngularVelocity, Scalar, Vector};

use super::ClosestFeatures;
use super::velocities::{Motions, Moved};

/// The coordinates of a pose: three of a translation and three of a rotation in space, two and one in the plane.
const MAX: usize = 6;

/// Second derivatives by the motion of one body, or by that of one and that of the other.
///
/// A motion is a translation `δ` and a rotation vector `ω` about a centre of the caller's, both in world axes:
///
/// > x ↦ c + δ + exp(\[ω\]×)·(x − c),   s ↦ s + gᵀθ + ½θᵀHθ + O(‖θ‖³) with θ = (δ, ω),
///
/// in 2D with the angle `ω`, counterclockwise. (A gradient taken anew in world axes at the moved body is
/// `g + Hθ + ½(0, ω × ∂s/∂ω) + O(‖θ‖²)`, since rotations do not commute.)
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V::Scalar: serde::Serialize")))]
#[cfg_attr(feature = "serde", serde(bound(deserialize = "V::Scalar: serde::Deserialize<'de>")))]
pub struct MotionHessian<V: Vector> {
    rows: [[V::Scalar; MAX]; MAX],
}

/// The second derivatives of the signed distance by the poses of both bodies: 12 by 12 numbers in space, 6 by 6 in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct PairHessian<V: Vector> {
    /// By the pose of `a`; symmetric.
    pub a: MotionHessian<V>,
    /// By the pose of `b`; symmetric.
    pub b: MotionHessian<V>,
    /// By that of `a` (rows) and that of `b` (columns).
    pub mixed: MotionHessian<V>,
}

impl<V: Vector> MotionHessian<V> {
    /// The number of rows and columns: 6 in 3D, 3 in 2D.
    pub const SIZE: usize = V::DIM * (V::DIM + 1) / 2;

    /// The entry in a row and a column, translations first.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> V::Scalar {
        assert!(row < Self::SIZE && column < Self::SIZE, "a row and a column of the matrix");
        self.rows[row][column]
    }

    /// The upper left part of the matrix, by rows: all of it with `N = 6` in 3D and `N = 3` in 2D, and with `N` the dimension the
    /// second derivatives by translations.
    ///
    /// # Panics
    /// If `N` is larger than the matrix.
    #[must_use]
    pub fn matrix<const N: usize>(&self) -> [[V::Scalar; N]; N] {
        core::array::from_fn(|i| core::array::from_fn(|j| self.entry(i, j)))
    }

    /// `θᵀHφ` for two motions `θ` and `φ`, each a translation and a rotation.
    #[must_use]
    pub fn along(&self, rows: (V, V::AngularVelocity), columns: (V, V::AngularVelocity)) -> V::Scalar {
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

/// What a change of one coordinate of the pose of a body does to the first derivatives by both poses: a row of second derivatives
/// each.
type Row<S> = [S; MAX];

impl<V: Vector> ClosestFeatures<V> {
    /// The second derivatives of the signed distance by the poses of both bodies, each turned about a centre of the caller's; `None`
    /// where there are no [`velocities`](Self::velocities).
    ///
    /// The first derivatives by the pose of `a` are the force `n` at the point `a`: `(n, (a − c) × n)`. As a coordinate `θ` of a pose moves
    /// the normal by `n′` and the point by `a′`, they change by
    ///
    /// > Q(θ) = (n′, (a − c) × n′ + (a′ − δ) × n),
    ///
    /// with `δ` the translation if `θ` is one of `a` itself, which takes the centre `c` along; and those of `b` likewise by the force `−n`
    /// at the point `b`. By the poses of both bodies that is the Hessian, by the pose of one it is `(Q + Qᵀ)/2`.
    ///
    /// It is as accurate as the normal and the points, times the condition of the bodies: what turning a needle would do with the
    /// normal held is mostly taken back by the normal.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{SignedDistanceOptions, signed_distance};
    ///
    /// let (a, b) = (Posed::translated(Ball::new(1.0)?, DVec2::Y * 4.0)?, Ball::new(2.0)?);
    /// let features =
    ///     signed_distance(&a, &b, SignedDistanceOptions::default()).closest_features(&a, &b);
    /// let hessian = features.hessian(DVec2::Y * 4.0, DVec2::ZERO).expect("balls are smooth");
    /// // The distance of the centres is √(x² + y²); turning a ball about its centre does nothing.
    /// assert_eq!(hessian.a.matrix(), [[0.25, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]);
    /// assert_eq!(hessian.mixed.entry(0, 0), -0.25);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[must_use]
    pub fn hessian(&self, center_a: V, center_b: V) -> Option<PairHessian<V>> {
        let centers = [center_a, center_b];
        let solver = self.solver()?;
        // By two coordinates of `a`, by two of `b`, and by one of `a` and one of `b`.
        let mut rows = [[[V::Scalar::ZERO; MAX]; 3]; MAX];
        for (i, [by_a, by_b, mixed]) in rows.iter_mut().enumerate().take(MotionHessian::<V>::SIZE) {
            let (of_a, of_b) = (self.coordinate(0, i, center_a), self.coordinate(1, i, center_b));
            let (moved_by_a, moved_by_b) = (solver.moved(of_a.motions), solver.moved(of_b.motions));
            *by_a = self.row(0, centers, &moved_by_a, of_a.translation);
            *by_b = self.row(1, centers, &moved_by_b, of_b.translation);
            *mixed = self.row(1, centers, &moved_by_a, V::ZERO);
        }
        Some(PairHessian {
            a: symmetric(rows.map(|[a, _, _]| a)),
            b: symmetric(rows.map(|[_, b, _]| b)),
            mixed: MotionHessian { rows: rows.map(|[_, _, mixed]| mixed) },
        })
    }

    /// The same by the pose of `a` alone.
    #[must_use]
    pub fn hessian_of_a(&self, center: V) -> Option<MotionHessian<V>> {
        self.hessian_of(0, center)
    }

    /// The same by the pose of `b` alone.
    #[must_use]
    pub fn hessian_of_b(&self, center: V) -> Option<MotionHessian<V>> {
        self.hessian_of(1, center)
    }

    fn hessian_of(&self, body: usize, center: V) -> Option<MotionHessian<V>> {
        let solver = self.solver()?;
        let mut rows = [[V::Scalar::ZERO; MAX]; MAX];
        for (i, row) in rows.iter_mut().enumerate().take(MotionHessian::<V>::SIZE) {
            let of_body = self.coordinate(body, i, center);
            *row = self.row(body, [center; 2], &solver.moved(of_body.motions), of_body.translation);
        }
        Some(symmetric(rows))
    }

    /// The motion that a coordinate of the pose of a body is.
    fn coordinate(&self, body: usize, index: usize, center: V) -> Coordinate<V> {
        let one = |i: usize| if i == index { V::Scalar::ONE } else { V::Scalar::ZERO };
        let translation = V::from_fn(one);
        let cross = V::AngularVelocity::from_coordinates(|k| one(V::DIM + k)).cross_matrix();
        let mut motions = Motions { velocities: [V::ZERO; 2], turns: [V::ZERO; 2] };
        motions.velocities[body] = translation + cross * (self.points[body] - center);
        motions.turns[body] = cross * self.normal;
        Coordinate { translation, motions }
    }

    /// How the first derivatives by the pose of a body change.
    fn row(&self, body: usize, centers: [V; 2], moved: &Moved<V>, carried: V) -> Row<V::Scalar> {
        let moment = V::AngularVelocity::moment;
        let turned = moment(self.points[body] - centers[body], moved.normal);
        let shifted = moment(moved.points[body] - carried, self.normal);
        let sign = if body == 0 { V::Scalar::ONE } else { -V::Scalar::ONE };
        core::array::from_fn(|i| match i {
            i if i < V::DIM => moved.normal.get(i) * sign,
            i if i < MotionHessian::<V>::SIZE => {
                (turned.coordinate(i - V::DIM) + shifted.coordinate(i - V::DIM)) * sign
            }
            _ => V::Scalar::ZERO,
        })
    }
}

/// A coordinate of a pose: its translation, zero for a rotation, and what it does to both bodies.
struct Coordinate<V> {
    translation: V,
    motions: Motions<V>,
}

/// The symmetric part.
fn symmetric<V: Vector>(rows: [Row<V::Scalar>; MAX]) -> MotionHessian<V> {
    let half = V::Scalar::from_f64(0.5);
    MotionHessian { rows: core::array::from_fn(|i| core::array::from_fn(|j| (rows[i][j] + rows[j][i]) * half)) }
}
