//! Second derivatives of the signed distance.

use convex_support::{AngularVelocity, MotionHessian, Scalar, Vector};

use super::ClosestFeatures;
use super::velocities::{Shifted, Solver};
use crate::symmetric::Across;

/// The coordinates of a pose: three of a translation and three of a rotation in space, two and one in the plane.
const MAX: usize = 6;

type Rows<S> = [[S; MAX]; MAX];

/// The second derivatives of the signed distance by the poses of both bodies: 12 by 12 numbers in space, 6 by 6 in the
/// plane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound = "V: crate::data::VectorData"))]
pub struct PairHessian<V: Vector> {
    /// By the pose of `a`; symmetric.
    pub a: MotionHessian<V>,
    /// By the pose of `b`; symmetric.
    pub b: MotionHessian<V>,
    /// By that of `a` (rows) and that of `b` (columns).
    pub mixed: MotionHessian<V>,
}

impl<V: Vector> ClosestFeatures<V> {
    /// The second derivatives of the signed distance by the poses of both bodies, each turned about a given centre;
    /// `None` if there are no [`velocities`](Self::velocities).
    ///
    /// The first derivatives by the pose of `a` are the force `n` at the point `a`: `(n, (a − c) × n)`. As a coordinate
    /// `θ` of a pose moves the normal by `n′` and the point by `a′`, they change by
    ///
    /// > Q(θ) = (n′, (a − c) × n′ + (a′ − δ) × n),
    ///
    /// where `δ` is the translation if `θ` is one of `a` itself, which moves the centre `c` too; and those of `b`
    /// likewise by the force `−n` at the point `b`. By the poses of both bodies this is the Hessian, by the pose of one
    /// it is `(Q + Qᵀ)/2`. Along a coordinate `φ`, which moves the material point by `v` and turns the normal by
    /// `t = ω × n`, it is `Q(θ)·φ = n′·v − (a′ − δ)·t`, of which both are across the normal.
    ///
    /// If second derivatives jump, as for a ball exactly above the border of a face, there is [more than
    /// one](Self::is_hessian_unique) Hessian. This one is that of the feature that holds the normal fastest, such as
    /// the face. The Hessian [says so](MotionHessian::is_unique).
    ///
    /// It is as accurate as the normal and the points, times the condition of the bodies, since most of the effect of
    /// turning a needle with the normal held is cancelled by the turn of the normal.
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
        let [of_a, of_b] = [self.coordinates(0, center_a), self.coordinates(1, center_b)];
        let [by_a, by_b] = [0, 1].map(|body| solver.responses(body));
        let is_unique = self.is_hessian_unique();
        let mixed = by_a.moved(&of_a, 1).along(&of_b).map(|row| row.map(|entry| -entry));
        let of = |rows| MotionHessian::from_rows(rows, is_unique);
        Some(PairHessian { a: of(by_a.hessian::<V>(&of_a, 0)), b: of(by_b.hessian::<V>(&of_b, 1)), mixed: of(mixed) })
    }

    /// The second derivatives by the pose of `a` alone.
    #[must_use]
    pub fn hessian_of_a(&self, center: V) -> Option<MotionHessian<V>> {
        self.hessian_of(0, center)
    }

    /// The second derivatives by the pose of `b` alone.
    #[must_use]
    pub fn hessian_of_b(&self, center: V) -> Option<MotionHessian<V>> {
        self.hessian_of(1, center)
    }

    fn hessian_of(&self, body: usize, center: V) -> Option<MotionHessian<V>> {
        let rows = self.solver()?.responses(body).hessian::<V>(&self.coordinates(body, center), body);
        Some(MotionHessian::from_rows(rows, self.is_hessian_unique()))
    }

    /// The coordinates of the pose of a body. Of a turn `ω` the part along a unit vector `e` is `e·(ω × arm) = ω·(arm ×
    /// e)`, which is that of a moment.
    #[inline]
    fn coordinates(&self, body: usize, center: V) -> Coordinates<V::Scalar> {
        let arm = self.points[body] - center;
        let mut coordinates = Coordinates { velocity: [[V::Scalar::ZERO; MAX]; 2], turn: [[V::Scalar::ZERO; MAX]; 2] };
        for (along, e) in self.across.into_iter().enumerate() {
            let (swing, turn) = (V::AngularVelocity::moment(arm, e), V::AngularVelocity::moment(self.normal, e));
            for i in 0..V::DIM {
                coordinates.velocity[along][i] = e.get(i);
            }
            for k in 0..MotionHessian::<V>::SIZE - V::DIM {
                coordinates.velocity[along][V::DIM + k] = swing.coordinate(k);
                coordinates.turn[along][V::DIM + k] = turn.coordinate(k);
            }
        }
        coordinates
    }
}

/// The coordinates of a pose, translations first, and in 2D zeros: across the normal, along either unit vector, the
/// velocity of the material point that is closest, and how it turns the normal.
struct Coordinates<S> {
    velocity: [[S; MAX]; 2],
    turn: [[S; MAX]; 2],
}

/// What unit velocities of the closest material point of a body across the normal do, and unit turns of the normal by
/// it: with them it is known what every coordinate of the pose of the body does.
struct Responses<S> {
    velocities: [Shifted<S>; 2],
    turns: [Shifted<S>; 2],
}

/// What the coordinates of a pose do, along either unit vector across the normal: how they turn the normal, and by what
/// the point of a body moves more than the centre of that.
struct MovedCoordinates<S> {
    normal: [[S; MAX]; 2],
    shift: [[S; MAX]; 2],
}

impl<V: Vector> Solver<'_, V> {
    #[inline]
    fn responses(&self, body: usize) -> Responses<V::Scalar> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let (rest, toward) = ((zero, zero), if body == 0 { one } else { -one });
        let turned = |turn| self.shifted(rest, if body == 0 { [turn, rest] } else { [rest, turn] });
        Responses {
            velocities: [self.shifted((toward, zero), [rest; 2]), self.shifted((zero, toward), [rest; 2])],
            turns: [turned((one, zero)), turned((zero, one))],
        }
    }
}

impl<S: Scalar> Responses<S> {
    /// What the coordinates of the pose of the body do, with the point of the body of that index.
    #[inline]
    fn moved(&self, coordinates: &Coordinates<S>, index: usize) -> MovedCoordinates<S> {
        let Coordinates { velocity: [v, w], turn: [t, u] } = coordinates;
        let [[p, q], [r, s]] = [&self.velocities, &self.turns];
        let sum = |p: S, q: S, r: S, s: S| {
            let mut sum = [S::ZERO; MAX];
            for i in 0..MAX {
                sum[i] = p * v[i] + q * w[i] + (r * t[i] + s * u[i]);
            }
            sum
        };
        let both = |[p, q, r, s]: [Across<S>; 4]| [sum(p.0, q.0, r.0, s.0), sum(p.1, q.1, r.1, s.1)];
        let all = [p, q, r, s];
        MovedCoordinates { normal: both(all.map(|of| of.normal)), shift: both(all.map(|of| of.shifts[index])) }
    }

    /// The Hessian by the pose of the body. Of two rotations it is the symmetric part of `Q`; what a rotation does
    /// along a translation, which turns nothing, is `n′·v`.
    #[inline]
    fn hessian<V: Vector<Scalar = S>>(&self, coordinates: &Coordinates<S>, body: usize) -> Rows<S> {
        let MovedCoordinates { normal: [n, m], shift: [a, b] } = self.moved(coordinates, body);
        let Coordinates { velocity: [v, w], turn: [t, u] } = coordinates;
        let (half, sign) = (S::from_f64(0.5), if body == 0 { S::ONE } else { -S::ONE });
        let mut rows = [[S::ZERO; MAX]; MAX];
        for i in 0..MotionHessian::<V>::SIZE {
            for j in 0..i.min(V::DIM - 1) + 1 {
                rows[i][j] = (n[i] * v[j] + m[i] * w[j]) * sign;
                rows[j][i] = rows[i][j];
            }
        }
        for i in V::DIM..MotionHessian::<V>::SIZE {
            // A turn about the centre moves the material point, and the point that is closest with it.
            let (a, b) = (a[i] + v[i], b[i] + w[i]);
            for j in V::DIM..MotionHessian::<V>::SIZE {
                let along = (n[i] * v[j] + m[i] * w[j] - (a * t[j] + b * u[j])) * (half * sign);
                rows[i][j] += along;
                rows[j][i] += along;
            }
        }
        rows
    }
}

impl<S: Scalar> MovedCoordinates<S> {
    /// `Q(θ)·φ` for a force along the normal, by coordinates `φ` of the pose of its body.
    #[inline]
    fn along(&self, coordinates: &Coordinates<S>) -> Rows<S> {
        let Self { normal: [n, m], shift: [a, b] } = self;
        let Coordinates { velocity: [v, w], turn: [t, u] } = coordinates;
        let mut rows = [[S::ZERO; MAX]; MAX];
        for i in 0..MAX {
            for j in 0..MAX {
                rows[i][j] = n[i] * v[j] + m[i] * w[j] - (a[i] * t[j] + b[i] * u[j]);
            }
        }
        rows
    }
}
