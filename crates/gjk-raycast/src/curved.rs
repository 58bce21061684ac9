//! The search of `portal.rs` where the body is curved and says how.
//!
//! Near a direction where it is smooth, `τ(α) = min over the body of t − α·(u, v)` is twice differentiable: with `p(α)` the
//! support point, its gradient is `−(u, v)` of `p`, and its Hessian is `−H`, where `H` is the derivative of `(u, v)` along `α`.
//! Where the body is smooth all around, `osculate.rs` models it as a whole.
//!
//! Where pieces meet, such as the rims of a cylinder along its side, each is a quadratic model of its own (`piece.rs`), and
//! the next plane is where the least of the models is greatest (`summit.rs`): a step of sequential quadratic programming,
//! which for three pieces is the portal's own plane. Between two, both have to be looked at in turn, though only the one
//! that reaches farther shows itself; so the plane is laid by a little more than the error of the older model on its side.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Iterate;
use crate::body::Body;
use crate::cast::{ScalarOf, Search};
use crate::piece::{Below, Piece, Pieces};
use crate::portal::{Exit, SeenBy};
use crate::summit::summit;
use crate::symmetric::Symmetric;
use crate::view::{Best, Frame, Portal, Slant};

/// Support points of the search.
const MAX_STEPS: usize = 40;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// The derivative of the swept body's `(u, v)` at `n`.
    #[inline(always)]
    pub(crate) fn bend(&self, frame: &Frame<B::Vector>, n: B::Vector) -> Symmetric<ScalarOf<B>> {
        let mut bend = self.body.hessian(n, [frame.e1, frame.e2]);
        if self.radius > ScalarOf::<B>::ZERO {
            let squared = n.length_squared();
            let (lift, u) = (self.radius / n.norm(), (n.dot(frame.e1), n.dot(frame.e2)));
            bend.a += lift * (ScalarOf::<B>::ONE - u.0 * u.0 / squared);
            bend.b -= lift * (u.0 * u.1 / squared);
            bend.d += lift * (ScalarOf::<B>::ONE - u.1 * u.1 / squared);
        }
        bend
    }

    fn piece(
        &self,
        frame: &Frame<B::Vector>,
        seen: SeenBy<B>,
        slant: Slant<ScalarOf<B>>,
    ) -> Piece<B::Vector, B::Witness> {
        let n = frame.normal(self.local.line.direction, slant);
        Piece { seen, slant, bend: self.bend(frame, n) }
    }

    /// Brings a portal nearer, by planes that the curvature of the body suggests as long as they close the bracket fast,
    /// and by the portal's own.
    pub(crate) fn curved(
        &mut self,
        frame: &Frame<B::Vector>,
        mut portal: Portal<B::Vector, B::Witness>,
        mut best: Best<B::Vector>,
    ) -> Result<(), Exit<B>> {
        let wanted = self.noise.max(self.options.tolerance);
        let end = self.end();
        let (zero, half) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::from_f64(0.5));
        let mut pieces: Option<Pieces<B::Vector, B::Witness>> = None;
        let mut slant = if portal.high.is_finite() { portal.slant() } else { best.slant };
        for seen in &portal.corners {
            // A point found on a plane along the ray counts for itself alone.
            let piece = match seen.slant {
                Some(found_at) => self.piece(frame, *seen, found_at),
                None => Piece { seen: *seen, slant, bend: Symmetric { a: zero, b: zero, d: zero } },
            };
            match &mut pieces {
                Some(pieces) => _ = pieces.push(piece, self.noise),
                None => pieces = Some(Pieces::new(piece)),
            }
        }
        let start = self.low;
        let (mut gap, mut stuck) = (ScalarOf::<B>::infinity(), 0);
        let mut caution = ScalarOf::<B>::ONE;
        // At a small slope, what closes the bracket to rounding of the planes is long along the ray, and there one more plane
        // mostly shortens it by all of the rest: `λ` is where the last plane is crossed. Meanwhile this is what closes it.
        let fine = (self.noise + self.noise).max(self.options.tolerance);
        let mut closing: Option<Below<B::Vector, B::Witness>> = None;
        for _ in 0..MAX_STEPS {
            let seen = match self.look_slanted(frame, slant) {
                Ok(seen) => seen,
                Err(_) if closing.is_some() => break,
                Err(exit) => return Err(exit),
            };
            let tau = slant.crossing(&seen);
            if tau > best.tau {
                best = Best { tau, slant, point: seen.point };
                if tau > end {
                    self.separate_end(frame.normal(self.local.line.direction, slant), seen.point)?;
                }
            }
            let piece = self.piece(frame, seen, slant);
            let pieces = match &mut pieces {
                Some(pieces) => {
                    let again = pieces.push(piece, self.noise);
                    // Too little shows the same piece again; too much goes back and forth between two.
                    caution = if again { caution * ScalarOf::<B>::from_f64(8.0) } else { half.powi(stuck) };
                    pieces
                }
                None => pieces.insert(Pieces::new(piece)),
            };
            let floor = best.tau - self.noise * best.slant.length();
            portal.exchange(&seen, floor);
            if portal.high < floor {
                // Nothing of the body is before the plane: zero was in the triangle by rounding alone.
                portal.high = ScalarOf::<B>::infinity();
            } else if portal.high < start {
                break;
            }
            let within = wanted * best.slant.length();
            // A segment first, since the weights in a flat triangle may be nothing but rounding.
            let passed = pieces.passed(self.noise).filter(|below| below.high >= start);
            let enclosing = (portal.high - best.tau <= within).then(|| Below::from(portal));
            let mut coarse = None;
            for below in [&passed, &enclosing, &closing].into_iter().flatten() {
                let gap = below.high - best.tau;
                if !(gap <= within) {
                    continue;
                }
                if closing.is_none() && gap > fine {
                    coarse = coarse.or(Some(*below));
                    continue;
                }
                match self.close(frame, below.corners(), below.weights(), below.high, &best) {
                    Err(None) => {}
                    end => return end,
                }
            }
            closing = closing.or(coarse);
            let suggested = if stuck < 3 || portal.high.is_infinite() {
                summit(pieces.all(), slant, self.noise, caution)
            } else {
                None
            };
            let gone = suggested.map_or(portal.high, |(_, value)| value.min(portal.high)) - best.tau;
            stuck = if gone <= gap * half || stuck >= 3 && portal.high.is_finite() { 0 } else { stuck + 1 };
            gap = gone;
            if suggested.is_none() && portal.high.is_infinite() {
                break;
            }
            let to = suggested.map_or_else(|| portal.slant(), |(slant, _)| slant);
            // What is looked at twice tells nothing new.
            if to.a == slant.a && to.b == slant.b {
                break;
            }
            slant = to;
        }
        match closing {
            Some(below) => self.close(frame, below.corners(), below.weights(), below.high, &best),
            None => Err(None),
        }
    }
}
