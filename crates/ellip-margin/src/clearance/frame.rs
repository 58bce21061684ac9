//! Ellipsoids in the coordinates of the search, three in either dimension, and bounds in the norm of a link.

use convex_support::glam::Vec4;
use convex_support::numerics::elementary::sqrt;
use convex_support::{
    Aabb, Bound, Boxes, CoarseBound, CoarseUnit, Ellipsoid, Frame, Matrix, Scalar, Vector, outer_box,
};

use crate::numerics::{dot, sub};

/// A link's own coordinates: rows Rᵀ/a of the map to the ball.
pub(super) struct LinkFrame {
    center: [f64; 3],
    rows: [[f64; 3]; 3],
    /// The greatest semi-axis.
    radius: f64,
}

impl LinkFrame {
    pub(super) fn new<V: Vector>(link: &Ellipsoid<V>) -> Self {
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(link.axes()), padded(link.semi_axes()));
        let rows = core::array::from_fn(|i| if i < V::DIM { axes[i].map(|x| x / a[i]) } else { [0.0; 3] });
        Self { center: padded(link.center()), rows, radius: radius(link) }
    }

    /// A lower bound on that distance from a ball around the obstacle: (‖r‖ − radius)/a_max.
    #[inline]
    pub(super) fn sphere_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, radius: f64) -> f64 {
        let r = sub(padded(obstacle.center()), self.center);
        let norm = sqrt(dot(r, r));
        (norm - radius - 16.0 * f64::EPSILON * (norm + radius)) / self.radius
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle across the line of centres.
    pub(super) fn plane_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>) -> f64 {
        let g = self.rows.map(|row| dot(row, sub(padded(obstacle.center()), self.center)));
        self.tangent_distance(obstacle, g, g)
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle across a normal of space.
    pub(super) fn normal_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, normal: [f64; 3]) -> f64 {
        let g = self.rows.map(|row| dot(row, sub(padded(obstacle.center()), self.center)));
        // A plane's normal in the ball is A⁻ᵀn for x ↦ Ax: rowᵢ/‖rowᵢ‖²·n.
        let n = self.rows.map(|row| {
            let squared = dot(row, row);
            if squared > 0.0 { dot(row, normal) / squared } else { 0.0 }
        });
        self.tangent_distance(obstacle, n, g)
    }

    /// The distance of the ball's centre from the tangent plane of the obstacle with the normal `n` of the ball, for
    /// the obstacle's centre at `g`.
    fn tangent_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, n: [f64; 3], g: [f64; 3]) -> f64 {
        let length = sqrt(dot(n, n));
        let n = n.map(|x| x / length);
        let world: [f64; 3] = core::array::from_fn(|k| (0..3).map(|i| self.rows[i][k] * n[i]).sum());
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(obstacle.axes()), padded(obstacle.semi_axes()));
        let u: [f64; 3] = core::array::from_fn(|k| a[k] * dot(axes[k], world));
        let (along, height) = (dot(n, g), sqrt(dot(u, u)));
        along - height - 16.0 * f64::EPSILON * (sqrt(dot(g, g)) + height)
    }
}

/// The distance of the ball's centre from a box around the box.
impl<V: Vector> Bound<V> for LinkFrame {
    type Coarse = CoarseDistance;

    #[inline]
    fn bound(&self, around: &Aabb<V>) -> V::Scalar {
        let (r, half) = (sub(padded(around.center()), self.center), padded(around.half_extents()));
        let gaps = self.rows.map(|row| (dot(row, r).abs() - dot(row.map(f64::abs), half)).max(0.0));
        V::Scalar::from_f64(sqrt(dot(gaps, gaps)))
    }

    /// In the frame of a tree, `x = o + ξ/k`, a coordinate is `(n·ξ + k·n·(o − c))/k` with `n` a row, here in units of
    /// the largest number of all rows.
    fn coarse(&self, frame: &Frame<V>) -> CoarseDistance {
        let largest = self.rows.iter().flatten().fold(0.0f64, |m, x| m.max(x.abs()));
        let (origin, per_unit) = (padded(frame.origin()), frame.unit().per_unit());
        let rows = self.rows.map(|row| row.map(|x| x / largest));
        let from_center = rows.map(|n| per_unit * dot(n, sub(origin, self.center)));
        let terms =
            rows.map(|n| per_unit * dot(n.map(f64::abs), [0, 1, 2].map(|i| origin[i].abs() + self.center[i].abs())));
        let splat = |x: f64| Vec4::splat(x as f32);
        CoarseDistance {
            rows: rows.map(|n| n.map(splat)),
            from_center: from_center.map(splat),
            room: terms.map(|terms| splat(16.0 * V::Scalar::EPSILON.as_f64() * terms)),
            unit: CoarseUnit::new::<V::Scalar>(per_unit / largest),
        }
    }
}

/// A [`LinkFrame`] in the frame of a tree: the bounds are the squares of distances.
pub(super) struct CoarseDistance {
    rows: [[Vec4; 3]; 3],
    from_center: [Vec4; 3],
    /// The rounding of the bodies' numbers, beside that of single precision.
    room: [Vec4; 3],
    unit: CoarseUnit,
}

impl CoarseBound for CoarseDistance {
    fn bounds(&self, boxes: &Boxes) -> Vec4 {
        let half = Vec4::splat(0.5);
        let mut squared = Vec4::ZERO;
        for ((row, from_center), room) in self.rows.iter().zip(self.from_center).zip(self.room) {
            let (mut along, mut reach, mut terms) = (from_center, Vec4::ZERO, from_center.abs());
            for (i, &n) in row.iter().enumerate() {
                let (low, high) = (n * boxes.min(i) * half, n * boxes.max(i) * half);
                (along, reach, terms) =
                    (along + (low + high), reach + (high - low).abs(), terms + low.abs() + high.abs());
            }
            let gap = along.abs() - reach - (terms * (16.0 * f32::EPSILON) + room);
            // NaN proves nothing.
            squared += Vec4::select(gap.cmpgt(Vec4::ZERO), gap * gap, Vec4::ZERO);
        }
        squared.min(Vec4::MAX)
    }

    fn limit(&self, limit: f64) -> f32 {
        self.unit.limit_of_squares(limit)
    }
}

/// The greatest semi-axis.
pub(super) fn radius<V: Vector>(e: &Ellipsoid<V>) -> f64 {
    e.semi_axes().max_element().as_f64()
}

/// Three coordinates, with a zero in 2D.
pub(super) fn padded<V: Vector>(v: V) -> [f64; 3] {
    core::array::from_fn(|i| if i < V::DIM { v.get(i).as_f64() } else { 0.0 })
}

/// Three columns, with zeros in 2D.
pub(super) fn columns<M: Matrix>(m: M) -> [[f64; 3]; 3] {
    core::array::from_fn(|j| if j < M::Vector::DIM { padded(m.col(j)) } else { [0.0; 3] })
}

/// The box around an ellipsoid.
pub(super) fn around<V: Vector>(e: &Ellipsoid<V>) -> Aabb<V> {
    outer_box(e).unwrap_or_else(Aabb::everything)
}

/// The farthest that any point of the ellipsoid can have moved: |Δc| + ‖Δ(R·diag(a))‖.
pub(super) fn displacement<V: Vector>(before: &Ellipsoid<V>, now: &Ellipsoid<V>) -> f64 {
    let shift = sub(padded(before.center()), padded(now.center()));
    let (old, new) = (columns(before.axes()), columns(now.axes()));
    let (a, b) = (padded(before.semi_axes()), padded(now.semi_axes()));
    let turn: f64 = (0..3)
        .map(|k| {
            let d: [f64; 3] = core::array::from_fn(|i| old[k][i] * a[k] - new[k][i] * b[k]);
            dot(d, d)
        })
        .sum();
    sqrt(dot(shift, shift)) + sqrt(turn)
}
