//! The outline of a body as it is seen along the line, by which an entry is bounded that may be at an edge, or a graze.
//!
//! Let `τ(x)` be where the line moved by `x` across itself enters the body: a convex function, whose graph is the
//! body's lower hull. In a polygon of points of the body it is at most the height `h` of the highest. Where a point of
//! the body is known at `(x', μ)`, no farther than `e` from the line, and the sides of the polygon are farther than
//! `m`, zero is between `x'` and a point of the polygon on the other side, at least `m` away, so that
//!
//! ```text
//! τ(0) ≤ μ + (h − μ)·e/(e + m).
//! ```
//!
//! The corners of the polygon are also known only to `e`. An error along the line raises the right side by `e`; an
//! error across the line brings a side nearer, so that `e` is subtracted from the distance of every side. The polygon
//! has to be wide and need not be near the entry: support points across the line will do for its corners.
//!
//! If the outline itself is within an error of the line, the ray may miss.
//!
//! By the known points alone, without support points across the line, more hits would have no bound.

use convex_support::{Scalar, Vector};

use super::bracket::Bracket;
use super::ray_frame::RayFrame;
use crate::symmetric::{Across, cross, dot, way};

/// The most corners of a polygon. Each further one near the line quarters how far the outline is beyond its side: with
/// eight, a line that enters by a ten-thousandth of the size might have no bound, with twelve a millionth is enough.
const MAX_CORNERS: usize = 12;

/// How far from the line its sides are to be, in the bracket's unit of length.
const WIDE: f64 = 0.0625;

/// If a triangle gives a bound at most so many errors later than the known point, no wide polygon is sought.
const LATE: f64 = 32.0;

/// Moves the upper bound of a contact ahead of the source, that may be at an edge or a graze, to where the ray is
/// certainly in the body, if points of the body surround the line by more than the errors.
#[cold]
#[inline(never)]
pub(super) fn bound_entry<V: Vector>(bracket: &mut Bracket<'_, V>) {
    let (mu, error) = bracket.point_near_line();
    let frame = RayFrame::new(bracket.line());
    let late = mu + error * V::Scalar::from_f64(LATE);
    let known = bracket.around.map(|points| frame.polygon(points));
    let is_near = |known: &Polygon<_>| known.latest_entry(mu, error).is_some_and(|latest| latest <= late);
    let Some(mut polygon) = known.filter(is_near).or_else(|| frame.look_around(bracket, error)) else { return };
    if let Some(latest) = polygon.latest_entry(mu, error) {
        bracket.enter_for_certain(latest);
        while !bracket.is_narrow(latest) && polygon.len < MAX_CORNERS {
            let Some(i) = polygon.nearest_of(|_| true) else { return };
            let Some(n) = (frame.vector(polygon.beside(i, mu)) - frame.line.direction).unit() else { return };
            let Some(point) = bracket.measure_depth(n) else { return };
            polygon.insert(i + 1, frame.corner(point));
        }
    }
}

impl<V: Vector> RayFrame<V> {
    fn corner(&self, p: V) -> ProjectedCorner<V::Scalar> {
        let (across, against) = self.split(p - self.line.foot);
        ProjectedCorner { across, along: -against }
    }

    /// The polygon of points that surround the line, two of them in the plane.
    fn polygon(&self, points: [V; 3]) -> Polygon<V::Scalar> {
        let [p, q, s] = points.map(|p| self.corner(p));
        if V::DIM == 2 {
            return if p.across.0 > q.across.0 { Polygon::in_plane([p, q]) } else { Polygon::in_plane([q, p]) };
        }
        let turns_left = cross(way(p.across, q.across), way(p.across, s.across)) > Scalar::ZERO;
        let mut polygon = Polygon::new();
        for corner in if turns_left { [p, q, s] } else { [q, p, s] } {
            polygon.insert(polygon.len, corner);
        }
        polygon
    }

    /// A wide polygon of support points across the line; `None` if the outline is known to be near the line, or there
    /// are no more support points.
    fn look_around(&self, bracket: &mut Bracket<'_, V>, error: V::Scalar) -> Option<Polygon<V::Scalar>> {
        let radius = bracket.radius;
        let mut support = |toward: Across<V::Scalar>| {
            let n = self.vector(toward).unit()?;
            let (core, _) = bracket.support(n, n, &[]).ok()?;
            Some(self.corner(core + n * radius))
        };
        let one = V::Scalar::ONE;
        let [right, left] = [support((one, Scalar::ZERO))?, support((-one, Scalar::ZERO))?];
        if V::DIM == 2 {
            return Some(Polygon::in_plane([right, left]));
        }
        let mut polygon = Polygon::new();
        polygon.insert(0, right);
        polygon.insert(1, left);
        while polygon.len < MAX_CORNERS {
            let wide = V::Scalar::from_f64(WIDE);
            let Some(i) = polygon.nearest_of(|side| !side.is_outermost && side.distance < wide) else { break };
            let PolygonSide { distance, outward, .. } = polygon.sides[i];
            let corner = support(outward)?;
            // NaN is no farther.
            if dot(corner.across, outward) > distance + error {
                polygon.insert(i + 1, corner);
            } else if distance <= error + error {
                // No further point surrounds the line there.
                return None;
            } else {
                polygon.sides[i].is_outermost = true;
            }
        }
        Some(polygon)
    }
}

/// A point of the body, across the line and along it.
#[derive(Clone, Copy, Default)]
struct ProjectedCorner<S> {
    across: Across<S>,
    along: S,
}

/// The side of a polygon from a corner to the next.
#[derive(Clone, Copy, Default)]
struct PolygonSide<S> {
    corner: ProjectedCorner<S>,
    /// The distance of zero from its line, negative where it is beyond.
    distance: S,
    /// The unit vector across it, away from the polygon.
    outward: Across<S>,
    /// Whether no part of the body is beyond it, to an error.
    is_outermost: bool,
}

impl<S: Scalar> PolygonSide<S> {
    fn new(corner: ProjectedCorner<S>, to: &ProjectedCorner<S>) -> Self {
        let (du, dv) = way(corner.across, to.across);
        let per_length = (du * du + dv * dv).sqrt().recip();
        Self {
            corner,
            // Twice the area that zero spans with the side is its length times its distance.
            distance: cross(corner.across, to.across) * per_length,
            outward: (dv * per_length, -du * per_length),
            is_outermost: false,
        }
    }
}

/// A polygon of points of the body in the projection along the line, anticlockwise. A polygon of two corners has two
/// sides.
struct Polygon<S> {
    sides: [PolygonSide<S>; MAX_CORNERS],
    len: usize,
}

impl<S: Scalar> Polygon<S> {
    fn new() -> Self {
        Self { sides: [PolygonSide::default(); MAX_CORNERS], len: 0 }
    }

    /// In the plane, a point stands for a side across it, with no part of the body beyond.
    fn in_plane([right, left]: [ProjectedCorner<S>; 2]) -> Self {
        let mut polygon = Self::new();
        let one = S::ONE;
        for (ProjectedCorner { across, along }, v) in [(right, -one), (right, one), (left, one), (left, -one)] {
            polygon.insert(polygon.len, ProjectedCorner { across: (across.0, v), along });
        }
        polygon.sides.iter_mut().for_each(|side| side.is_outermost = true);
        polygon
    }

    fn sides(&self) -> &[PolygonSide<S>] {
        &self.sides[..self.len]
    }

    fn insert(&mut self, at: usize, corner: ProjectedCorner<S>) {
        self.sides[at..=self.len].rotate_right(1);
        self.len += 1;
        self.sides[at].corner = corner;
        for from in [at + self.len - 1, at].map(|i| i % self.len) {
            let to = self.sides[(from + 1) % self.len].corner;
            self.sides[from] = PolygonSide::new(self.sides[from].corner, &to);
        }
    }

    /// Among the sides picked, the one that zero is nearest to, or farthest beyond.
    fn nearest_of(&self, is_meant: impl Fn(&PolygonSide<S>) -> bool) -> Option<usize> {
        let meant = (0..self.len).filter(|&i| is_meant(&self.sides[i]));
        meant.reduce(|i, j| if self.sides[j].distance < self.sides[i].distance { j } else { i })
    }

    /// The plane through the point at `mu` on the line and a side, by how steeply it rises across the line.
    fn beside(&self, i: usize, mu: S) -> Across<S> {
        let [c, d] = [i, (i + 1) % self.len].map(|i| self.sides[i].corner);
        let (up_c, up_d) = (c.along - mu, d.along - mu);
        let per_area = cross(c.across, d.across).recip();
        let (c, d) = (c.across, d.across);
        ((up_c * d.1 - up_d * c.1) * per_area, (c.0 * up_d - d.0 * up_c) * per_area)
    }

    /// Where the line is in the body, at the latest, given a point of the body at `mu` to within an error; `None` if
    /// the polygon does not surround the line by more than that.
    fn latest_entry(&self, mu: S, error: S) -> Option<S> {
        let nearest = self.sides[self.nearest_of(|_| true)?];
        // NaN is no distance.
        let is_around = self.sides().iter().all(|side| side.distance > error + error);
        let rise = self.sides().iter().fold(S::ZERO, |rise, side| rise.max(side.corner.along - mu));
        is_around.then(|| mu + error + rise * (error / nearest.distance))
    }
}
