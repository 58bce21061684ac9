//! The exchange of points that closes the bracket once the ray pierces the simplex, with Newton's method on the plane
//! where the body is curved ([`curvature`](crate::curvature)).
//!
//! In the plane, where Algorithm 3 is the search, a ray against a curved body would take 17 support points instead of 7
//! without that method, and in space by the paper's method 45 instead of 30.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::swept_simplex::{Entry, entry};
use crate::body::PointPair;
use crate::cast::bracket::Bracket;
use crate::cast::line::Line;
use crate::cast::ray_frame::RayFrame;
use crate::cast::{RayContact, Stop};
use crate::curvature::{LARGEST_TURN, SAME_PIECE, between, is_stiff_across, share_of_second, swept, turned};
use crate::simplex::{MAX_POINTS, Simplex};
use crate::symmetric::{Across, Symmetric, dot, way};

/// Exchanges of a point that gain nothing before the line is moved into the facet, and steps by curvature before the
/// facet's own normal is taken.
const IDLE_EXCHANGES: usize = 3;

/// How often the line is moved at a time, each time twice as far, until it pierces the simplex.
const MAX_MOVES: usize = 6;

/// Closes the bracket between the last plane and the entry into the simplex: the next plane is taken along the normal
/// at the entry, and the support point found there replaces one of the simplex such that the ray still enters it, and
/// earlier.
pub(super) fn refine<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    simplex: &mut Simplex<V>,
    mut at: Entry<V>,
) -> Result<RayContact<V>, Stop<V>> {
    let mut pierced = Pierced { line: bracket.line(), moved: Scalar::ZERO, failures: 0 };
    let mut steps = CurvatureSteps::new(bracket.noise);
    let mut recent = Recent::new();
    simplex.retain(at.face, at.weights);
    loop {
        let slope = -at.n.dot(bracket.line().direction);
        bracket.enter_hull(at.mu, pierced.moved, slope);
        if let &[p, q] = simplex.points()
            && V::DIM == 2
        {
            bracket.around = Some([p, q, q]);
        }
        let turned = if steps.may_turn() { newton(bracket, simplex, &recent, steps.model_error) } else { None };
        let turned = steps.accept(turned);
        let n = turned.unwrap_or(at.n);
        let (point, witness) = bracket.support(n, n, simplex.points())?;
        bracket.advance(n, point)?;
        let wanted = bracket.tolerance() + pierced.moved;
        if let Some(contact) = bracket.close_to_hull(slope, wanted, || simplex.weighted_witness()) {
            return Ok(contact);
        }
        steps.judge(bracket.gap_to_hull(slope), turned.is_some(), bracket.noise);
        recent.push(point + n * bracket.radius, n);
        if simplex.points().contains(&point) {
            if turned.is_some() {
                continue;
            }
            // No point is before the facet: only the errors of points and planes may be left.
            let all_there_is = wanted + bracket.error;
            return bracket.close_to_hull(slope, all_there_is, || simplex.weighted_witness()).ok_or(Stop::InDoubt);
        }
        let before = *simplex;
        simplex.push(point, n, witness);
        let next = entry(simplex.points(), pierced.line, bracket.radius, bracket.noise);
        let gains = next.is_some_and(|next| next.mu < at.mu);
        if turned.is_some() && !gains {
            // Away from the facet's normal, there may be no point before the facet.
            *simplex = before;
            continue;
        }
        let next = pierced.keep_pierced(bracket, next, gains, &before, simplex).ok_or(Stop::InDoubt)?;
        simplex.retain(next.face, next.weights);
        if !(next.mu > bracket.low()) {
            // The body has points of the line on both sides of the lower bound, which so is in the body.
            return Ok(bracket.close_between(pierced.moved, slope, simplex.weighted_witness()));
        }
        at = next;
    }
}

/// The line that keeps the simplex pierced.
///
/// A ray that runs through an edge or a vertex enters more than one facet there, and, as in the simplex method of
/// linear programming, the exchange of points can go round in circles. Then this line is moved into the facet; planes
/// are still crossed by the ray itself. Of 2,556 rays at curved bodies in space by this method 16 stay undecided,
/// and 99 without such moves.
struct Pierced<V: Vector> {
    line: Line<V>,
    /// How far it was moved.
    moved: V::Scalar,
    /// Exchanges since then that gained nothing.
    failures: usize,
}

impl<V: Vector> Pierced<V> {
    /// The entry of the line into the simplex. The line is moved towards the middle of the last facet if there is no
    /// entry, or too many exchanges gained nothing.
    fn keep_pierced(
        &mut self,
        bracket: &Bracket<'_, V>,
        mut next: Option<Entry<V>>,
        gains: bool,
        facet: &Simplex<V>,
        simplex: &Simplex<V>,
    ) -> Option<Entry<V>> {
        self.failures += usize::from(!gains);
        let mut step = V::Scalar::from_f64(8.0) * bracket.noise;
        for _ in 0..MAX_MOVES {
            if next.is_some() && self.failures < IDLE_EXCHANGES {
                break;
            }
            self.failures = 0;
            let inward = self.line.across(facet.middle() - self.line.foot);
            self.line.foot += inward.unit().unwrap_or(V::ZERO) * step.min(inward.norm());
            self.moved += step;
            step += step;
            next = entry(simplex.points(), self.line, bracket.radius, bracket.noise);
        }
        next
    }
}

/// Whether steps by curvature are taken. They are as long as they shrink; after one that did not, the facet's normal
/// is taken. Between two pieces, every other step only goes back and forth.
struct CurvatureSteps<S> {
    last_gap: S,
    failures: usize,
    /// The tangents of the angles of the last two steps.
    angles: [S; 2],
    /// How far one of two pieces is moved out against the other, so that it is found next.
    model_error: S,
}

impl<S: Scalar> CurvatureSteps<S> {
    fn new(noise: S) -> Self {
        Self { last_gap: S::infinity(), failures: 0, angles: [S::infinity(); 2], model_error: noise }
    }

    fn may_turn(&self) -> bool {
        self.failures <= IDLE_EXCHANGES
    }

    /// Takes a step, given by the normal and the tangent of the angle to it, if the angle shrinks.
    fn accept<V>(&mut self, turned: Option<(V, S)>) -> Option<V> {
        let shrunk = self.angles[0].max(self.angles[1]) * S::from_f64(0.5);
        let turned = turned.filter(|&(_, angle)| angle <= shrunk || self.failures > 0);
        self.angles = turned.as_ref().map_or([S::infinity(); 2], |&(_, angle)| [angle, self.angles[0]]);
        turned.map(|(n, _)| n)
    }

    fn judge(&mut self, gap: S, turned: bool, noise: S) {
        let halved = gap <= self.last_gap * S::from_f64(0.5);
        self.failures = if halved || !turned { 0 } else { self.failures + 1 };
        self.model_error = if self.failures == 0 { noise } else { self.model_error * S::from_f64(16.0) };
        self.last_gap = gap;
    }
}

/// Points of the swept body, each with the unit vector along which it is the support point; the newest last.
struct Recent<V: Vector>(Simplex<V>);

impl<V: Vector> Recent<V> {
    fn new() -> Self {
        Self(Simplex::new())
    }

    /// Adds a point, in place of another one at the same place, or of the oldest of three.
    fn push(&mut self, point: V, along: V) {
        let known = self.0.points().iter().position(|&p| p == point);
        if let Some(out) = known.or((self.0.points().len() == 3).then_some(0)) {
            self.0.remove(out);
        }
        self.0.push(point, along, PointPair::ZERO);
    }
}

/// The normal of the plane that should be crossed last, and the tangent of the angle to it, by the points found so
/// far. `None` if curvature does not determine it: at a vertex, or if three points of different pieces span a facet.
fn newton<V: Vector>(
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
    if !(angle <= V::Scalar::from_f64(LARGEST_TURN)) {
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
