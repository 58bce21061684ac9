//! The outline of a body as it is seen along the line, by which an entry is bounded that may be at an edge, or a graze.
//!
//! Let `τ(x)` be where the line moved by `x` across itself enters the body: a convex function, whose graph is the body's lower hull. In a
//! polygon of points of the body it is at most the height `h` of the highest. Where a point of the body is known at `(x', μ)`, no farther
//! than `e` from the line, and the sides of the polygon are farther than `m`, zero is between `x'` and a point of the polygon on the other
//! side, at least `m` away, so that
//!
//! ```text
//! τ(0) ≤ μ + (h − μ)·e/(e + m).
//! ```
//!
//! All points may be wrong by `e`, too: that raises the right side by `e`, and is taken from the distance of the sides. Of the polygon
//! little matters but that it is wide, so that its corners may be support points across the line.
//!
//! Where the outline itself is within an error of the line, the ray may miss. If it does not, it enters before it leaves, and so before it
//! crosses any plane that it leaves and that the body is behind: with `n` across the line, out of the body, that across `d + k·n` is the
//! farther from being along the line the smaller `k` is, and the nearer to the outline the larger.

use convex_support::{Scalar, Vector};

use super::bracket::{Bracket, ScalarOf};
use super::line::Line;
use crate::Iterate;
use crate::body::Body;
use crate::symmetric::{Across, cross, dot};

/// As many corners as a polygon has at most.
const MAX_CORNERS: usize = 8;

/// How far from the line its sides are to be, in the bracket's unit of length.
const WIDE: f64 = 0.0625;

/// How many errors later than the known point the bound may be that a triangle gives, not to look for a wide polygon.
const LATE: f64 = 32.0;

/// How often a plane is looked at that the ray leaves, each time so many times nearer to being along it.
const MAX_TURNS: usize = 10;
const TURN: f64 = 8.0;

/// Moves the upper bound of a contact ahead of the source, that may be at an edge or a graze, to where the ray is in the body whatever
/// the errors, if the body is seen around the line by more than those; and otherwise to where it has left the body.
#[cold]
#[inline(never)]
pub(super) fn bound_entry<B: Body, O: FnMut(Iterate<'_, B::Vector>)>(bracket: &mut Bracket<'_, B, O>) {
    let (mu, error) = bracket.point_near_line();
    let view = View { line: bracket.line(), axes: bracket.line().axes() };
    let late = mu + error * ScalarOf::<B>::from_f64(LATE);
    let known = bracket.around.map(|points| view.polygon(points));
    let is_near = |known: &Polygon<_>| known.latest_entry(mu, error).is_some_and(|latest| latest <= late);
    let Some(polygon) = known.filter(is_near).or_else(|| view.look_around(bracket, error)) else { return };
    if let Some(latest) = polygon.latest_entry(mu, error) {
        bracket.enter_for_certain(latest);
    } else if let Some(side) = polygon.outermost_side(error + error) {
        view.look_behind(bracket, side);
    }
}

/// The line, and the axes across it.
struct View<V: Vector> {
    line: Line<V>,
    axes: [V; 2],
}

impl<V: Vector> View<V> {
    /// The unit vector across the line.
    fn across(&self, toward: Across<V::Scalar>) -> Option<V> {
        (self.axes[0] * toward.0 + self.axes[1] * toward.1).unit()
    }

    fn see(&self, p: V) -> Corner<V::Scalar> {
        let p = p - self.line.foot;
        Corner { across: (p.dot(self.axes[0]), p.dot(self.axes[1])), along: p.dot(self.line.direction) }
    }

    /// The polygon of points that are seen around the line, of which there are two in the plane.
    fn polygon(&self, points: [V; 3]) -> Polygon<V::Scalar> {
        let [p, q, s] = points.map(|p| self.see(p));
        if V::DIM == 2 {
            return if p.across.0 > q.across.0 { Polygon::in_plane([p, q]) } else { Polygon::in_plane([q, p]) };
        }
        let turns_left = cross(p.edge_to(&q), p.edge_to(&s)) > Scalar::ZERO;
        let mut polygon = Polygon::new();
        for corner in if turns_left { [p, q, s] } else { [q, p, s] } {
            polygon.insert(polygon.len, corner);
        }
        polygon
    }

    /// A wide polygon of support points across the line; `None` where no more can be had.
    fn look_around<B: Body<Vector = V>, O: FnMut(Iterate<'_, V>)>(
        &self,
        bracket: &mut Bracket<'_, B, O>,
        error: V::Scalar,
    ) -> Option<Polygon<V::Scalar>> {
        let radius = bracket.radius;
        let mut support = |toward: Across<V::Scalar>| {
            let n = self.across(toward)?;
            let (core, _) = bracket.support(n, n, &[]).ok()?;
            Some(self.see(core + n * radius))
        };
        let one = V::Scalar::ONE;
        let [right, left] = [support((one, Scalar::ZERO))?, support((-one, Scalar::ZERO))?];
        if V::DIM == 2 {
            return Some(Polygon::in_plane([right, left]));
        }
        let mut polygon = Polygon::new();
        polygon.insert(0, right);
        polygon.insert(1, left);
        let two = error + error;
        while polygon.len < MAX_CORNERS {
            // Where the outline is near, only what else of it is near matters.
            let is_near = polygon.sides().iter().any(|side| side.is_outermost && side.distance <= two);
            let wanted = if is_near { two } else { V::Scalar::from_f64(WIDE) };
            let Some(i) = polygon.nearest_of(|side| !side.is_outermost && side.distance < wanted) else { break };
            let Side { distance, outward, .. } = polygon.sides[i];
            let corner = support(outward)?;
            // NaN is no farther.
            if dot(corner.across, outward) > distance + error {
                polygon.insert(i + 1, corner);
            } else {
                polygon.sides[i].is_outermost = true;
            }
        }
        Some(polygon)
    }

    /// Moves the upper bound to planes that the ray leaves, until they are near and come no nearer: at first across the line but for the
    /// way that the side rises, and in the end along it.
    fn look_behind<B: Body<Vector = V>, O: FnMut(Iterate<'_, V>)>(
        &self,
        bracket: &mut Bracket<'_, B, O>,
        Side { outward, rise, .. }: Side<V::Scalar>,
    ) {
        let Some(across) = self.across(outward) else { return };
        let level = self.line.direction - self.across((-outward.1, outward.0)).map_or(V::ZERO, |side| side * rise);
        let mut k = V::Scalar::ONE;
        for _ in 0..MAX_TURNS {
            let Some(n) = (level + across * k).unit() else { return };
            let Ok((point, _)) = bracket.support(n, n, &[]) else { return };
            if !bracket.leave(n, point) && !bracket.may_slide() {
                return;
            }
            k *= V::Scalar::from_f64(TURN);
        }
    }
}

/// A point of the body, across the line and along it.
#[derive(Clone, Copy, Default)]
struct Corner<S> {
    across: Across<S>,
    along: S,
}

impl<S: Scalar> Corner<S> {
    fn edge_to(&self, to: &Self) -> Across<S> {
        (to.across.0 - self.across.0, to.across.1 - self.across.1)
    }
}

/// The side of a polygon from a corner to the next.
#[derive(Clone, Copy, Default)]
struct Side<S> {
    corner: Corner<S>,
    /// The distance of zero from its line, negative where it is beyond.
    distance: S,
    /// The unit vector across it, away from the polygon.
    outward: Across<S>,
    /// How much it rises along the line for every unit of its length.
    rise: S,
    /// Whether nothing of the body is beyond it, to an error.
    is_outermost: bool,
}

impl<S: Scalar> Side<S> {
    fn new(corner: Corner<S>, to: &Corner<S>) -> Self {
        let (du, dv) = corner.edge_to(to);
        let per_length = (du * du + dv * dv).sqrt().recip();
        Self {
            corner,
            // Twice the area that zero spans with the side is its length times its distance.
            distance: cross(corner.across, to.across) * per_length,
            outward: (dv * per_length, -du * per_length),
            rise: (to.along - corner.along) * per_length,
            is_outermost: false,
        }
    }
}

/// A polygon of points of the body as they are seen along the line, anticlockwise. That of two corners has two sides.
struct Polygon<S> {
    sides: [Side<S>; MAX_CORNERS],
    len: usize,
}

impl<S: Scalar> Polygon<S> {
    fn new() -> Self {
        Self { sides: [Side::default(); MAX_CORNERS], len: 0 }
    }

    /// In the plane, a point stands for a side across it, beyond which there is nothing.
    fn in_plane([right, left]: [Corner<S>; 2]) -> Self {
        let mut polygon = Self::new();
        let one = S::ONE;
        for (Corner { across, along }, v) in [(right, -one), (right, one), (left, one), (left, -one)] {
            polygon.insert(polygon.len, Corner { across: (across.0, v), along });
        }
        polygon.sides.iter_mut().for_each(|side| side.is_outermost = true);
        polygon
    }

    fn sides(&self) -> &[Side<S>] {
        &self.sides[..self.len]
    }

    fn insert(&mut self, at: usize, corner: Corner<S>) {
        self.sides[at..=self.len].rotate_right(1);
        self.len += 1;
        self.sides[at].corner = corner;
        for from in [at + self.len - 1, at].map(|i| i % self.len) {
            let to = self.sides[(from + 1) % self.len].corner;
            self.sides[from] = Side::new(self.sides[from].corner, &to);
        }
    }

    /// Of some sides, the one that zero is the nearest to, or the farthest beyond.
    fn nearest_of(&self, is_meant: impl Fn(&Side<S>) -> bool) -> Option<usize> {
        let meant = (0..self.len).filter(|&i| is_meant(&self.sides[i]));
        meant.reduce(|i, j| if self.sides[j].distance < self.sides[i].distance { j } else { i })
    }

    /// The side of the outline within a distance of zero; or where two meet there, one between them. Where the outline is not found, the
    /// nearest side.
    fn outermost_side(&self, within: S) -> Option<Side<S>> {
        let near = self.sides().iter().copied().filter(|side| side.is_outermost && side.distance <= within);
        let outermost = near.reduce(|a, b| {
            let between = (a.outward.0 + b.outward.0, a.outward.1 + b.outward.1);
            // Opposite sides, of a body that is seen edge on, have none between them.
            if dot(between, between) > S::EPSILON { Side { outward: between, rise: S::ZERO, ..a } } else { a }
        });
        outermost.or_else(|| self.nearest_of(|_| true).map(|i| self.sides[i]))
    }

    /// Where the line is in the body, at the latest, that has a point at `mu` to within an error; `None` where the polygon is not around
    /// it by more than that.
    fn latest_entry(&self, mu: S, error: S) -> Option<S> {
        let nearest = self.sides[self.nearest_of(|_| true)?];
        // NaN is no distance.
        let is_around = self.sides().iter().all(|side| side.distance > error + error);
        let rise = self.sides().iter().fold(S::ZERO, |rise, side| rise.max(side.corner.along - mu));
        is_around.then(|| mu + error + rise * (error / nearest.distance))
    }
}
