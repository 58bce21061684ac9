//! Newton's method on the plane for Algorithm 3, where the body is curved ([`curvature`](crate::curvature)).
//!
//! In the plane, where that algorithm is the search, a ray against a curved body would take 17 support points instead
//! of 7 without it, and in space by the paper's method 45 instead of 30.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::PointPair;
use crate::cast::bracket::Bracket;
use crate::cast::ray_frame::RayFrame;
use crate::curvature::{between, is_stiff_across, share_of_second, swept, turned};
use crate::simplex::{MAX_POINTS, Simplex};
use crate::symmetric::{Across, Symmetric, dot, way};

/// Points of the swept body, each with the unit vector along which it is the support point; the newest last.
pub(super) struct Recent<V: Vector>(Simplex<V>);

impl<V: Vector> Recent<V> {
    pub(super) fn new() -> Self {
        Self(Simplex::new())
    }

    /// Adds a point, in place of another one at the same place, or of the oldest of three.
    pub(super) fn push(&mut self, point: V, along: V) {
        let known = self.0.points().iter().position(|&p| p == point);
        if let Some(out) = known.or((self.0.points().len() == 3).then_some(0)) {
            self.0.remove(out);
        }
        self.0.push(point, along, PointPair::default());
    }
}

/// Two support points are of one smooth piece if the curvature at one predicts this much of the other.
const SAME_PIECE: f64 = 0.25;

/// The largest tangent of an angle to turn by.
const LARGEST: f64 = 0.5;

/// The normal of the plane that should be crossed last, and the tangent of the angle to it, by the points found so
/// far. `None` if curvature does not determine it: at a vertex, or if three points of different pieces span a facet.
pub(super) fn newton<V: Vector>(
    bracket: &Bracket<'_, V>,
    simplex: &Simplex<V>,
    recent: &Recent<V>,
    model_error: V::Scalar,
) -> Option<(V, V::Scalar)> {
    if !bracket.is_curved {
        return None;
    }
    let seen = SeenAlongRay { bracket, frame: RayFrame::new(bracket.line()) };
    let mut found = [(V::ZERO, V::ZERO); 2 * MAX_POINTS];
    let mut len = 0;
    // The corners of the simplex first, since the last point found is nearest the answer.
    let corners = simplex.points().iter().zip(simplex.along()).map(|(&p, &n)| (p + n * bracket.radius, n));
    let others = recent.0.points().iter().zip(recent.0.along()).map(|(&p, &n)| (p, n));
    for (point, n) in corners.chain(others) {
        if let Some(n) = seen.normal(n) {
            found[len] = (point, n);
            len += 1;
        }
    }
    let (&(point, n), others) = found[..len].split_last()?;
    let first = seen.piece(point, n, n);
    if first.is_vertex {
        return None;
    }
    let d = match seen.second_piece(&first, others, n) {
        (None, alone) => alone?,
        (Some(_), _) if V::DIM == 2 => return None,
        (Some(second), _) => {
            let e = way(first.p, second.p);
            let hessian = first.hessian.blend(second.hessian, share_of_second(first.p, e));
            if !is_stiff_across(hessian, e) {
                return None;
            }
            // A vertex has been found already.
            let more = if second.is_vertex { -model_error } else { model_error };
            between(hessian, first.p, e, first.reach - second.reach + more)
        }
    };
    let angle = dot(d, d).sqrt() / n.length();
    // NaN fails this too.
    if !(angle <= V::Scalar::from_f64(LARGEST)) {
        return None;
    }
    (n + seen.frame.vector(d)).unit().map(|to| (to, angle))
}

/// A smooth piece at a plane that the ray crosses: its support value along the normal, its point relative to the
/// line, and its Hessian.
struct PieceAlongRay<S> {
    reach: S,
    p: Across<S>,
    hessian: Symmetric<S>,
    /// Whether the point does not move.
    is_vertex: bool,
    /// The point before it was turned.
    found: Across<S>,
}

/// The second piece, if there is one, and the change of the normal for the first piece alone, if there is one.
type SecondPiece<S> = (Option<PieceAlongRay<S>>, Option<Across<S>>);

/// Points and planes in the frame of the ray; normals have length one against it.
struct SeenAlongRay<'k, 'b, V: Vector> {
    bracket: &'k Bracket<'b, V>,
    frame: RayFrame<V>,
}

impl<V: Vector> SeenAlongRay<'_, '_, V> {
    fn across(&self, v: V) -> Across<V::Scalar> {
        self.frame.split(v).0
    }

    /// A normal, if the ray crosses the plane.
    fn normal(&self, n: V) -> Option<V> {
        let facing = -n.dot(self.bracket.line().direction);
        let n = n / facing;
        (facing > Scalar::ZERO && n.is_finite()).then_some(n)
    }

    /// The piece of a point that was found along `n`, turned to another normal.
    fn piece(&self, point: V, n: V, to: V) -> PieceAlongRay<V::Scalar> {
        let found = self.across(point - self.bracket.line().foot);
        let mut hessian = self.bracket.body.hessian(n, self.frame.axes);
        let is_vertex = hessian.is_zero();
        // A radius alone needs no iteration.
        if !is_vertex {
            hessian = swept(hessian, self.bracket.radius, self.across(n), n.length_squared());
        }
        if V::DIM == 2 {
            // There is no second axis to move along.
            hessian.d = Scalar::ONE;
        }
        let turned = turned(hessian, self.across(n), self.across(to - n));
        let p = (found.0 + turned.shift.0, found.1 + turned.shift.1);
        PieceAlongRay { reach: to.dot(point) + turned.rise, p, hessian: turned.hessian, is_vertex, found }
    }

    /// The other piece that would extend farthest beyond the first at the normal for the first alone; or if the first
    /// alone gives no normal, the one across from which the line lies. With the change to that normal.
    fn second_piece(&self, first: &PieceAlongRay<V::Scalar>, others: &[(V, V)], n: V) -> SecondPiece<V::Scalar> {
        let noise = self.bracket.noise;
        let p = first.p;
        let alone = first.hessian.is_regular().then(|| first.hessian.solve((-p.0, -p.1)));
        let mut second = None;
        let mut best = if alone.is_some() { noise } else { -V::Scalar::infinity() };
        for &(point, along) in others {
            let other = self.piece(point, along, n);
            let e = way(p, other.p);
            // Points no farther apart than rounding are one.
            let apart = way(p, other.found);
            let foretold = V::Scalar::from_f64(SAME_PIECE * SAME_PIECE) * dot(apart, apart);
            if dot(e, e) <= foretold.max(noise * noise) {
                continue;
            }
            let score = match alone {
                Some(d) => (other.reach - first.reach) + dot(e, d) + dot(p, d) * V::Scalar::from_f64(0.5),
                None => {
                    let share = share_of_second(p, e);
                    let nearest = (p.0 + e.0 * share, p.1 + e.1 * share);
                    -dot(nearest, nearest)
                }
            };
            if score >= best {
                best = score;
                second = Some(other);
            }
        }
        (second, alone)
    }
}
