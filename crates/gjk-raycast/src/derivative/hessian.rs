//! Second derivatives of the signed distance.

use convex_support::{AngularVelocity, Scalar, Vector};

use super::ClosestFeatures;
use super::velocities::{Shifted, Solver};
use crate::symmetric::{Across, dot};

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
    /// at the point `b`. By the poses of both bodies that is the Hessian, by the pose of one it is `(Q + Qᵀ)/2`. Along a coordinate `φ`, which moves the
    /// material point by `v` and turns the normal by `t = ω × n`, it is `Q(θ)·φ = n′·v − (a′ − δ)·t`, of which both are across the normal.
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
        let solver = self.solver()?;
        let coordinates = [self.coordinates(0, center_a), self.coordinates(1, center_b)];
        let [by_a, by_b] = [0, 1].map(|body| moved(&solver, body, &coordinates[body]));
        Some(PairHessian {
            a: symmetric(self.rows(0, &by_a, &coordinates[0], true)),
            b: symmetric(self.rows(1, &by_b, &coordinates[1], true)),
            mixed: MotionHessian { rows: self.rows(1, &by_a, &coordinates[1], false) },
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
        let coordinates = self.coordinates(body, center);
        let moved = moved(&solver, body, &coordinates);
        Some(symmetric(self.rows(body, &moved, &coordinates, true)))
    }

    /// The coordinates of the pose of a body, translations first, and in 2D zeros.
    fn coordinates(&self, body: usize, center: V) -> [Coordinate<V::Scalar>; MAX] {
        let arm = self.points[body] - center;
        let zero = (V::Scalar::ZERO, V::Scalar::ZERO);
        let mut coordinates = [Coordinate { velocity: zero, swing: zero, turn: zero }; MAX];
        let (translations, rotations) = coordinates.split_at_mut(V::DIM);
        for (i, translation) in translations.iter_mut().enumerate() {
            translation.velocity = self.in_plane(V::axis(i));
        }
        for (k, rotation) in rotations.iter_mut().enumerate().take(MotionHessian::<V>::SIZE - V::DIM) {
            let one = |i: usize| if i == k { V::Scalar::ONE } else { V::Scalar::ZERO };
            let cross = V::AngularVelocity::from_coordinates(one).cross_matrix();
            let swing = self.in_plane(cross * arm);
            *rotation = Coordinate { velocity: swing, swing, turn: self.in_plane(cross * self.normal) };
        }
        coordinates
    }

    /// `Q(θ)·φ` for the force on a body, by what the coordinates `θ` of a pose do, its own or the other's, and the coordinates `φ` of its own. A
    /// translation takes its centre along, so that of `a′ − δ` there is the shift.
    fn rows(
        &self,
        body: usize,
        moved: &[Shifted<V::Scalar>; MAX],
        coordinates: &[Coordinate<V::Scalar>; MAX],
        is_own: bool,
    ) -> [[V::Scalar; MAX]; MAX] {
        let sign = if body == 0 { V::Scalar::ONE } else { -V::Scalar::ONE };
        let size = MotionHessian::<V>::SIZE;
        let mut rows = [[V::Scalar::ZERO; MAX]; MAX];
        for i in 0..size {
            let Shifted { normal, shifts } = moved[i];
            let ((x, y), swing) = (shifts[body], coordinates[i].swing);
            let shifted = if is_own { (x + swing.0, y + swing.1) } else { (x, y) };
            for j in 0..size {
                let Coordinate { velocity, turn, .. } = coordinates[j];
                rows[i][j] = (dot(normal, velocity) - dot(shifted, turn)) * sign;
            }
        }
        rows
    }
}

/// A coordinate of a pose, across the normal: the velocity of the material point that is closest, the part of it that is of a turn about the centre,
/// and how it turns the normal.
#[derive(Clone, Copy, Debug)]
struct Coordinate<S> {
    velocity: Across<S>,
    swing: Across<S>,
    turn: Across<S>,
}

impl<S: Scalar> Coordinate<S> {
    /// What it does as a coordinate of the pose of a body.
    fn shifted<V: Vector<Scalar = S>>(self, solver: &Solver<'_, V>, body: usize) -> Shifted<S> {
        let ((x, y), zero) = (self.velocity, (S::ZERO, S::ZERO));
        if body == 0 { solver.shifted((x, y), [self.turn, zero]) } else { solver.shifted((-x, -y), [zero, self.turn]) }
    }
}

/// What each coordinate of the pose of a body does; in 2D the last do nothing.
fn moved<V: Vector>(
    solver: &Solver<'_, V>,
    body: usize,
    coordinates: &[Coordinate<V::Scalar>; MAX],
) -> [Shifted<V::Scalar>; MAX] {
    let zero = (V::Scalar::ZERO, V::Scalar::ZERO);
    let mut moved = [Shifted { normal: zero, shifts: [zero; 2] }; MAX];
    for (moved, coordinate) in moved.iter_mut().zip(coordinates).take(MotionHessian::<V>::SIZE) {
        *moved = coordinate.shifted(solver, body);
    }
    moved
}

/// The symmetric part.
fn symmetric<V: Vector>(rows: [[V::Scalar; MAX]; MAX]) -> MotionHessian<V> {
    let half = V::Scalar::from_f64(0.5);
    MotionHessian { rows: core::array::from_fn(|i| core::array::from_fn(|j| (rows[i][j] + rows[j][i]) * half)) }
}
