//! The search where the body is curved in pieces.
//!
//! Near a direction where it is smooth, `τ(α) = min over the body of t − α·(u, v)` is twice differentiable: with `p(α)`
//! the support point, its gradient is `−(u, v)` of `p`, and its Hessian is `−H`, where `H` is the derivative of `(u,
//! v)` along `α`.
//!
//! Where pieces meet, such as the rims of a cylinder along its side, each is a quadratic model of its own
//! (`cast/pieces.rs`), and the next plane is where the least of the models is greatest (`best_plane`): a step of
//! sequential quadratic programming (Nocedal and Wright, *Numerical Optimization*, ch. 18), which for three pieces is
//! the portal's own plane. Between two, both have to be looked at in turn, though only the one that reaches farther
//! shows itself; so the plane is laid by a little more than the error of the older model on its side.

use convex_support::numerics::elementary::power_of_two;
use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::{BestPlane, Portal};
use crate::cast::bracket::Bracket;
use crate::cast::pieces::{OnLine, RayPiece, RayPieces, best_plane};
use crate::cast::ray_frame::{Alpha, RayFrame, RayPoint};
use crate::cast::{RayContact, Stop};
use crate::symmetric::Across;

/// Support points of the search.
const MAX_STEPS: usize = 40;

/// Steps of the models that do not halve the bracket before the next one is the portal's own plane.
const MAX_FAILURES: i32 = 3;

/// How many times as far as the last planes were tilted the next one is, at most, from pieces that do not enclose the
/// line.
const FAR: f64 = 8.0;

/// Brings a portal nearer, by planes that the curvature of the body suggests as long as they close the bracket fast,
/// and by the portal's own. Or where none is known, searches by curvature alone. The
/// points were found by planes that were tilted from one another by so much.
#[inline(never)]
pub(super) fn sqp<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    frame: &RayFrame<V>,
    points: &[RayPoint<V>],
    mut portal: Option<Portal<V>>,
    mut best: BestPlane<V>,
    tilt: V::Scalar,
) -> Result<RayContact<V>, Stop<V>> {
    let mut alpha = portal.as_ref().map_or(best.alpha, Portal::alpha);
    let mut pieces = RayPieces::new();
    for &p in points {
        pieces.push(RayPiece::new(bracket, frame, p, alpha), bracket.noise);
    }
    // What the last frame tells is near enough for models, and too near for the plane through the points.
    if tilt < Scalar::ONE
        && let Some(newest) = pieces.all().last()
    {
        let is_enclosed = portal.is_some();
        let far = tilt * V::Scalar::from_f64(FAR) * newest.alpha.length();
        let is_near = |(x, y): Across<_>| x * x + y * y <= far * far;
        match best_plane(pieces.all(), newest.alpha, bracket.noise, Scalar::ONE) {
            Some((to, _)) if is_enclosed || is_near(newest.alpha.change_to(to)) => alpha = to,
            _ if is_enclosed => {}
            _ => return Err(Stop::InDoubt),
        }
    }
    let start = bracket.low();
    let mut own = portal.as_ref().map(Portal::on_line);
    let mut steps = Steps { gap: V::Scalar::infinity(), failures: 0, error_weight: V::Scalar::ONE };
    for _ in 0..MAX_STEPS {
        let p = frame.support_of(bracket, alpha.plane())?;
        best.improve(bracket, frame, alpha, &p, Scalar::ZERO)?;
        steps.weigh_error(pieces.push(RayPiece::new(bracket, frame, p, alpha), bracket.noise));
        let floor = best.tau - bracket.noise * best.alpha.length();
        let next = match portal {
            Some(mut portal) => portal.exchange(p).ok().map(|()| portal),
            None => Portal::around([points[0], points[1], p]),
        };
        let is_nearer = |at: &OnLine<V>| at.high >= floor && own.is_none_or(|own| at.high < own.high);
        if let Some(nearer) = next.as_ref().map(Portal::on_line).filter(is_nearer) {
            (portal, own) = (next, Some(nearer));
        }
        if own.is_some_and(|own| own.high < floor) {
            // Nothing of the body is before the plane: zero was in the triangle by rounding alone.
            (portal, own) = (None, None);
        } else if own.is_some_and(|own| own.high < start) {
            break;
        }
        let within = bracket.tolerance() * best.alpha.length();
        // A segment first, since the weights in a flat triangle may be nothing but rounding.
        let passed = pieces.passed(bracket.noise).filter(|below| below.high >= start);
        for below in passed.iter().chain(&own) {
            if below.high - best.tau <= within {
                match best.close(bracket, frame, &below.corners, &below.weights, below.high) {
                    Err(Stop::InDoubt) => {}
                    found => return found,
                }
            }
        }
        let plane = own.zip(portal.as_ref()).map(|(own, portal)| (portal.alpha(), own.high));
        let Some(to) = steps.next(bracket, &pieces, plane, &best, alpha) else { break };
        alpha = to;
    }
    Err(Stop::InDoubt)
}

/// How well the steps go.
struct Steps<S> {
    /// What the last step was to leave of the bracket.
    gap: S,
    /// Steps in a row that did not halve it.
    failures: i32,
    /// How much of its error is added to an older model.
    error_weight: S,
}

impl<S: Scalar> Steps<S> {
    /// Too little of the error shows the same piece again; too much goes back and forth between two.
    #[inline(always)]
    fn weigh_error(&mut self, same_piece: bool) {
        self.error_weight =
            if same_piece { self.error_weight * S::from_f64(8.0) } else { power_of_two(-self.failures) };
    }

    /// The next plane, if there is one, given the portal's own and where the line runs through that.
    #[inline(always)]
    fn next<V: Vector<Scalar = S>>(
        &mut self,
        bracket: &Bracket<'_, V>,
        pieces: &RayPieces<V>,
        own: Option<(Alpha<S>, S)>,
        best: &BestPlane<V>,
        alpha: Alpha<S>,
    ) -> Option<Alpha<S>> {
        let gives_up = self.failures >= MAX_FAILURES && own.is_some();
        let suggested = if gives_up { None } else { best_plane(pieces.all(), alpha, bracket.noise, self.error_weight) };
        let high = own.map_or(S::infinity(), |(_, high)| high);
        let gap = suggested.map_or(high, |(_, value)| value.min(high)) - best.tau;
        let halved = gap <= self.gap * S::from_f64(0.5);
        self.failures = if halved || gives_up { 0 } else { self.failures + 1 };
        self.gap = gap;
        let (to, _) = suggested.or(own)?;
        // What is looked at twice tells nothing new.
        (to != alpha).then_some(to)
    }
}
