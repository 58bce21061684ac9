//! The bottom of a basin of the support value among unit vectors, by steps that curvature tells.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::WayOut;
use super::boundary::Boundary;
use crate::SignedDistanceOptions;
use crate::curvature::{LARGEST_TURN, SAME_PIECE, between};
use crate::separation::cores::{Cores, Vertex};
use crate::symmetric::{Across, Symmetric, axes_across, dot, turned_left};

/// How far past the fold a step leads, as a part of the square of the angle between both pieces.
const LEAD: f64 = 0.1;

/// A side of a fold: that of the piece that a step begins on, or the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FoldSide {
    Near,
    Far,
}

/// A smooth piece of the boundary of the cores' difference: a support point, the unit direction `n` it was found along,
/// and the Hessian `H` of the support value there, for which `H·n = 0`, by its entries along two unit vectors across
/// `n`.
#[derive(Clone, Copy, Debug)]
struct Piece<V: Vector> {
    n: V,
    point: V,
    across: [V; 2],
    hessian: Symmetric<V::Scalar>,
}

/// The same piece along another unit vector `u`: its support point across `u`, its support value, and its Hessian.
struct SeenAlong<S> {
    slope: Across<S>,
    value: S,
    hessian: Symmetric<S>,
}

impl<V: Vector> Piece<V> {
    fn new(cores: &Cores<'_, V>, vertex: &Vertex<V>) -> Self {
        let across = axes_across(vertex.along);
        Self { n: vertex.along, point: vertex.point, across, hessian: cores.hessian(vertex.along, across) }
    }

    /// The piece of a support point relative to this one. A point that was not found along any direction, such as one
    /// that coincides with zero, counts as a corner.
    fn beside(&self, cores: &Cores<'_, V>, vertex: &Vertex<V>) -> Self {
        if vertex.along == V::ZERO {
            return Self { point: vertex.point, hessian: Symmetric::ZERO, ..*self };
        }
        Self::new(cores, vertex)
    }

    /// How far the point moves as the direction turns from `n` to `n + c`.
    fn shift(&self, c: V) -> V {
        let [e, f] = self.across;
        let (x, y) = self.hessian.times((c.dot(e), c.dot(f)));
        e * x + f * y
    }

    /// With `u/(u·n) = n + c`, the support value is `u·n` times that along `n + c`, whose expansion is `(n + c)·p +
    /// c·Hc/2`, its gradient `p + Hc`.
    fn seen(&self, u: V, [e, f]: [V; 2]) -> SeenAlong<V::Scalar> {
        let cosine = u.dot(self.n);
        let c = u / cosine - self.n;
        let shift = self.shift(c);
        let point = self.point + shift;
        let value = u.dot(point) - cosine * c.dot(shift) * V::Scalar::from_f64(0.5);
        let (along_e, along_f) = (self.shift(e), self.shift(f));
        let per = cosine.recip();
        let hessian = Symmetric { a: e.dot(along_e) * per, b: e.dot(along_f) * per, d: f.dot(along_f) * per };
        SeenAlong { slope: (e.dot(point), f.dot(point)), value, hessian }
    }

    /// How far a support point is from what this piece predicts along its direction, as a part of its distance from
    /// the piece's own point; infinite where it is too far around.
    #[inline(never)]
    fn surprise(&self, vertex: &Vertex<V>) -> V::Scalar {
        let cosine = vertex.along.dot(self.n);
        if !(cosine > V::Scalar::from_f64(LARGEST_TURN)) {
            return V::Scalar::infinity();
        }
        let from = vertex.point - self.point;
        (from - self.shift(vertex.along / cosine - self.n)).length() / from.length()
    }

    /// How much farther along a unit vector a point lies than this piece does.
    fn exceeded_by(&self, point: V, u: V) -> V::Scalar {
        u.dot(point) - self.seen(u, self.across).value
    }

    /// Whether a support point is of this piece.
    fn foretells(&self, vertex: &Vertex<V>) -> bool {
        self.surprise(vertex) < V::Scalar::from_f64(SAME_PIECE)
    }

    /// The unit vector where the piece's support value is to be least.
    ///
    /// A step `δ` across `n` and back to unit length changes the support value `h` to
    ///
    /// ```text
    /// h((n + δ)/|n + δ|) = (h + p·δ + δ·Hδ/2)/√(1 + δ²) ≈ h + p·δ + δ·(H − h)·δ/2,   least where   (H − h)·δ = −p
    /// across n,
    /// ```
    ///
    /// if `H − h` is positive definite. It is so near a minimum on a smooth boundary, whose radii of curvature are the
    /// eigenvalues of `H`: a ball about zero that touches it from within is no larger than these.
    fn step(&self) -> Option<V> {
        let [e, f] = self.across;
        let bend = self.hessian.plus(-self.n.dot(self.point));
        let slope = (e.dot(self.point), f.dot(self.point));
        if !(bend.a > Scalar::ZERO) {
            return None;
        }
        let step = if V::DIM == 2 {
            (-slope.0 / bend.a, Scalar::ZERO)
        } else {
            bend.is_regular().then(|| bend.solve((-slope.0, -slope.1)))?
        };
        turned(self.n, self.across, step)
    }

    /// The unit vector where the larger support value of two pieces is to be least, at a fold of the support value.
    ///
    /// There both values are alike, and some share `β` of the other's slope and the rest of this one's cancel. With `p`
    /// and `q` the slopes, `h` and `k` the values, and the Hessians `H_β = (1 − β)·H + β·K`,
    ///
    /// ```text
    /// (H_β − h)·δ + p + β·e = 0,   e·δ = h − k,   e = q − p,
    /// ```
    ///
    /// of which the second gives `δ` along `e`, and the first what it is across.
    ///
    /// The prediction for a piece is off by the cube of the angle to where it was found. So the step leads past the
    /// fold by a part of the angle's square, onto the piece that has to be found again.
    fn step_along_fold(&self, other: &Self, seen: FoldSide) -> Option<V> {
        let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
        let value = self.n.dot(self.point);
        let [e, f] = self.across;
        let p = (e.dot(self.point), f.dot(self.point));
        let SeenAlong { slope: q, value: other_value, hessian } = other.seen(self.n, self.across);
        let e = (q.0 - p.0, q.1 - p.1);
        let squared = dot(e, e);
        let share = -dot(e, p) / squared;
        // Where the slopes do not cancel, the minimum is on one side of the fold.
        if share < zero || share > one {
            return if share < zero { self.step() } else { other.step() };
        }
        let bend = self.hessian.blend(hessian, share).plus(-value);
        let lead = V::Scalar::from_f64(LEAD) * (self.n - other.n).length_squared() * squared.sqrt();
        let lead = match seen {
            FoldSide::Near if !self.hessian.is_zero() => -lead,
            FoldSide::Far if !other.hessian.is_zero() => lead,
            // A vertex is exact.
            FoldSide::Near | FoldSide::Far => zero,
        };
        // Not `is_stiff_across`: a nearly flat fold has its bottom too, and a bracket without it is many times as wide.
        let across = turned_left(e);
        let has_bottom = V::DIM == 2 || dot(across, bend.times(across)) > zero;
        let step = has_bottom.then(|| between(bend, p, e, value - other_value + lead))?;
        turned(self.n, self.across, step)
    }

    /// The unit vector on the way to the edge of a piece that has no bottom of its own, if [`step`](Self::step) and
    /// [`step_along_fold`](Self::step_along_fold) lead nowhere: to the fold with another piece, if there is one that is
    /// lower.
    fn step_to_edge(&self, other: Option<&Self>) -> Option<V> {
        let [e, f] = self.across;
        let slope = (e.dot(self.point), f.dot(self.point));
        let Some(other) = other else { return turned(self.n, self.across, self.step_along_curvature(slope)?) };
        let SeenAlong { slope: of_other, value, .. } = other.seen(self.n, self.across);
        let e = (of_other.0 - slope.0, of_other.1 - slope.1);
        let along = (self.n.dot(self.point) - value) / dot(e, e);
        turned(self.n, self.across, (e.0 * along, e.1 * along))
    }

    /// The step on a piece that is curved along one direction only, as around a rim or an apex.
    ///
    /// Along that direction the minimum is where it would be on any piece. Across it the support value has a slope and
    /// no bottom: it falls until another piece begins, at the latest where it would be zero. That is far away as long
    /// as the first step gains something, which is then taken alone; otherwise the second leads a little farther than
    /// to zero, onto the other piece.
    fn step_along_curvature(&self, slope: Across<V::Scalar>) -> Option<Across<V::Scalar>> {
        let (zero, number) = (V::Scalar::ZERO, V::Scalar::from_f64);
        let value = self.n.dot(self.point);
        let (curvature, along) = self.hessian.greatest_eigen()?;
        let bend = curvature - value;
        let downhill = dot(slope, along);
        let size = if bend > zero { -downhill / bend } else { zero };
        let step = (along.0 * size, along.1 * size);
        let fall = dot(slope, (-along.1, along.0));
        let is_enough = -size * downhill * number(2.0) > value;
        if is_enough || !(value > zero) || fall == zero {
            return Some(step);
        }
        let aside = -value / fall * number(1.0 + LEAD);
        Some((step.0 - along.1 * aside, step.1 + along.0 * aside))
    }
}

/// A unit vector turned by a step across it, or by the largest part of it that is sensible.
#[inline(never)]
fn turned<V: Vector>(n: V, [e, f]: [V; 2], step: Across<V::Scalar>) -> Option<V> {
    let size = dot(step, step).sqrt();
    // NaN fails this too.
    if !(size > Scalar::ZERO && size.is_finite()) {
        return None;
    }
    let part = (V::Scalar::from_f64(LARGEST_TURN) / size).min(Scalar::ONE);
    (n + (e * step.0 + f * step.1) * part).unit()
}

/// Newton's steps from one direction.
const MAX_NEWTON_STEPS: usize = 12;

/// The steps in a row that may find nothing lower: if two pieces meet, one is predicted from farther away until it is
/// found again.
const IDLE_STEPS: usize = 2;

/// Newton's method from a direction to the bottom of its basin, on one smooth piece of the boundary or along the fold
/// between two. `others` are vertices near by, one of which may be of the second piece. The bottom, and what was not
/// predicted on the way there, make the polytope larger as well. A `last` look goes to edges, too, where pieces
/// without a bottom of their own meet others, which the polytope comes to by itself if it goes on. `None` where a
/// support point is not finite.
pub(super) fn descend<V: Vector>(
    cores: &mut Cores<'_, V>,
    boundary: &mut Boundary<V>,
    mut way: WayOut<V>,
    others: &[u16],
    options: &SignedDistanceOptions<V>,
    last: bool,
) -> Option<WayOut<V>> {
    let mut first = Piece::new(cores, &way.vertex);
    let mut second = None;
    if let Some(other) = contradiction(&first, boundary, others) {
        second = Some(first.beside(cores, &boundary.vertex(other)));
    }
    let (mut failures, mut stale, mut is_added) = (0, FoldSide::Far, true);
    for _ in 0..MAX_NEWTON_STEPS {
        let u = match &second {
            Some(second) => first.step_along_fold(second, stale),
            None => first.step(),
        };
        let u = u.or_else(|| if last { first.step_to_edge(second.as_ref()) } else { None });
        let Some(u) = u.filter(|_| cores.iterations < options.max_iterations && failures < IDLE_STEPS) else { break };
        let next = WayOut::new(cores.support(u)?);
        let piece = Piece::new(cores, &next.vertex);
        // At equal heights to rounding, the slope shows the bottom: it has twice as many accurate digits as the height.
        let is_level = (next.h - way.h).abs() <= cores.error_along(u);
        let is_lower =
            if is_level { next.rest().length_squared() < way.rest().length_squared() } else { next.h < way.h };
        let is_foretold = first.foretells(&next.vertex);
        if !is_foretold {
            let _ = boundary.insert_anywhere(&next.vertex);
        }
        if is_foretold {
            (first, stale) = (piece, FoldSide::Far);
        } else if is_lower {
            (second, stale) = (Some(core::mem::replace(&mut first, piece)), FoldSide::Far);
        } else {
            (second, stale) = (Some(piece), FoldSide::Near);
        }
        if is_lower {
            (way, failures, is_added) = (next, 0, !is_foretold);
        } else {
            failures += 1;
        }
        if is_level && !(last && is_lower && way.rest().norm() > cores.noise()) {
            break;
        }
    }
    if !is_added {
        let _ = boundary.insert_anywhere(&way.vertex);
    }
    Some(way)
}

/// The support point that is farthest beyond a piece where that piece alone would lead; where it would lead nowhere,
/// the one that it predicts worst.
fn contradiction<V: Vector>(piece: &Piece<V>, boundary: &Boundary<V>, others: &[u16]) -> Option<u16> {
    let to = piece.step();
    let excess = |vertex: &Vertex<V>| match to {
        Some(u) => piece.exceeded_by(vertex.point, u),
        None => piece.surprise(vertex),
    };
    let mut most = (V::Scalar::ZERO, None);
    for &other in others {
        let vertex = boundary.vertex(other);
        if !piece.foretells(&vertex) {
            let excess = excess(&vertex);
            if excess > most.0 {
                most = (excess, Some(other));
            }
        }
    }
    most.1
}
