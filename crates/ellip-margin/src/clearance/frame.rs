//! Ellipsoids in the coordinates of the search, three in either dimension, and bounds in the norm of a link.

use convex_support::{Ellipsoid, Matrix, Scalar, Vector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use crate::hierarchy::Aabb;
use crate::numerics::{dot, sub};

/// A link's own coordinates: rows Rᵀ/a of the map to the ball.
pub(super) struct Frame {
    center: [f64; 3],
    rows: [[f64; 3]; 3],
    /// The greatest semi-axis.
    radius: f64,
}

impl Frame {
    pub(super) fn new<V: Vector>(link: &Ellipsoid<V>) -> Self {
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(link.axes()), padded(link.semi_axes()));
        let rows = core::array::from_fn(|i| if i < V::DIM { axes[i].map(|x| x / a[i]) } else { [0.0; 3] });
        Self { center: padded(link.center()), rows, radius: radius(link) }
    }

    /// The distance of the ball's centre from a box around the box.
    #[inline]
    pub(super) fn box_distance(&self, b: &Aabb) -> f64 {
        let r = sub(b.center, self.center);
        let mut squared = 0.0;
        for row in &self.rows {
            let half = row[0].abs() * b.half[0] + row[1].abs() * b.half[1] + row[2].abs() * b.half[2];
            let gap = (dot(*row, r).abs() - half).max(0.0);
            squared += gap * gap;
        }
        squared.sqrt()
    }

    /// A lower bound on that distance from a ball around the obstacle: (‖r‖ − radius)/a_max.
    #[inline]
    pub(super) fn sphere_distance<V: Vector>(&self, obstacle: &Ellipsoid<V>, radius: f64) -> f64 {
        let r = sub(padded(obstacle.center()), self.center);
        let norm = dot(r, r).sqrt();
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
        let length = dot(n, n).sqrt();
        let n = n.map(|x| x / length);
        let world: [f64; 3] = core::array::from_fn(|k| (0..3).map(|i| self.rows[i][k] * n[i]).sum());
        let (axes, a): ([[f64; 3]; 3], [f64; 3]) = (columns(obstacle.axes()), padded(obstacle.semi_axes()));
        let u: [f64; 3] = core::array::from_fn(|k| a[k] * dot(axes[k], world));
        let (along, height) = (dot(n, g), dot(u, u).sqrt());
        along - height - 16.0 * f64::EPSILON * (dot(g, g).sqrt() + height)
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

/// The box around an ellipsoid: half extents √diag(Q⁻¹).
pub(super) fn around<V: Vector>(e: &Ellipsoid<V>) -> Aabb {
    let (center, axes, a) = (padded(e.center()), columns(e.axes()), padded(e.semi_axes()));
    let half = core::array::from_fn(|i| {
        let extent = (0..3).map(|k| (axes[k][i] * a[k]) * (axes[k][i] * a[k])).sum::<f64>().sqrt();
        extent + 8.0 * f64::EPSILON * (a[0].max(a[1]).max(a[2]) + center[i].abs())
    });
    Aabb { center, half }
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
    dot(shift, shift).sqrt() + turn.sqrt()
}
