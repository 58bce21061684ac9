//! The search of `portal.rs` where the body is smooth: it is replaced by the ellipsoid about its origin that has the same support
//! point and derivative where it is looked at.
//!
//! The support value of an ellipsoid is `h(n) = √(n·Qn)`, so its support point and the derivative of that are `p = Qn/h` and
//! `D = (Q − p·pᵀ)/h`, whence `Q = h·D + p·pᵀ`. Where the ray enters it is known in closed form, and the next plane is the
//! one there. An ellipsoid is its own model.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::Iterate;
use crate::body::Body;
use crate::cast::{ScalarOf, Search};
use crate::piece::{Piece, Pieces};
use crate::portal::Exit;
use crate::symmetric::{Symmetric, dot};
use crate::view::{Best, Frame, Slant};

/// Support points of the search.
const MAX_STEPS: usize = 12;

/// Planes along the ray, between it and an ellipsoid that it misses, that do not separate it from the body.
const MAX_MISSES: usize = 2;

impl<B: Body, O: FnMut(Iterate<'_, B::Vector>)> Search<'_, B, O> {
    /// Replaces a smooth body by the ellipsoid that osculates it, takes the plane where the ray enters that, and so on.
    pub(crate) fn osculate(&mut self, frame: &Frame<B::Vector>, first: B::Vector) -> Result<(), Exit<B>> {
        let (zero, one) = (ScalarOf::<B>::ZERO, ScalarOf::<B>::ONE);
        let direction = self.local.line.direction;
        let foot = (self.local.line.foot.dot(frame.e1), self.local.line.foot.dot(frame.e2));
        let wanted = self.noise.max(self.options.tolerance);
        let end = self.end();
        let (mut n, mut slant): (_, Option<Slant<ScalarOf<B>>>) = (first, None);
        let mut best: Option<Best<B::Vector>> = None;
        let mut pieces: Option<Pieces<B::Vector, B::Witness>> = None;
        let mut last = ScalarOf::<B>::infinity();
        let mut misses = 0;
        for _ in 0..MAX_STEPS {
            let bend = self.bend(frame, n);
            // Of a plane along the ray it never is, since H·n = 0 and n is across the ray.
            if (slant.is_some() || misses == 0) && !bend.is_regular() {
                return Err(None);
            }
            let mut seen = self.look(frame, n)?;
            seen.slant = slant;
            match slant {
                None => {
                    self.separate(n, &seen)?;
                    if misses == MAX_MISSES {
                        return Err(None);
                    }
                }
                Some(slant) => {
                    let tau = slant.crossing(&seen);
                    if best.is_none_or(|best| tau > best.tau) {
                        best = Some(Best { tau, slant, point: seen.point });
                        if tau > end {
                            self.separate(n, &seen)?;
                        }
                    }
                    let piece = Piece { seen, slant, bend };
                    match &mut pieces {
                        Some(pieces) => pieces.follow(piece),
                        None => pieces = Some(Pieces::new(piece)),
                    }
                }
            }
            if let (Some(best), Some(pieces), Some(at)) = (&best, &pieces, slant) {
                if let Some(below) = pieces.passed(self.noise) {
                    if below.high < self.low {
                        return Err(None);
                    }
                    if below.high - best.tau <= wanted * best.slant.length() {
                        return self.close(frame, below.corners(), below.weights(), below.high, best);
                    }
                }
                // Near the end, Newton's step is the same, and does not cancel.
                let (x, y) = bend.solve((seen.u, seen.v));
                let rest = x * seen.u + y * seen.v;
                if !(rest <= last * ScalarOf::<B>::from_f64(0.5)) {
                    return Err(None);
                }
                last = rest;
                let small = at.length() * ScalarOf::<B>::from_f64(0.05);
                if x * x + y * y <= small * small {
                    let to = Slant { a: at.a - x, b: at.b - y };
                    (n, slant) = (frame.normal(direction, to), Some(to));
                    continue;
                }
            }
            // Q in the axes e₁, e₂ and −d: (A b; b·ᵀ c). With α = A⁻¹(s·φ − b) for the line's foot φ, and
            // s² = n·Qn = (c − b·A⁻¹b)/(1 − φ·A⁻¹φ), the support point of the ellipsoid is on the line.
            let touch = [seen.u + foot.0, seen.v + foot.1, -seen.t];
            let (within, facing) = ((n.dot(frame.e1), n.dot(frame.e2)), -n.dot(direction));
            let value = within.0 * touch[0] + within.1 * touch[1] + facing * touch[2];
            // The last column of D, from D·n = 0 unless the plane is nearly along the ray.
            let (beside, ahead) = if facing * facing > n.length_squared() * ScalarOf::<B>::from_f64(0.01) {
                let (x, y) = bend.times(within);
                let beside = (-x / facing, -y / facing);
                (beside, -dot(within, beside) / facing)
            } else {
                let moved = self.swept_derivative(self.body.derivative(n, -direction), n, -direction);
                ((moved.dot(frame.e1), moved.dot(frame.e2)), -moved.dot(direction))
            };
            let across = Symmetric {
                a: value * bend.a + touch[0] * touch[0],
                b: value * bend.b + touch[0] * touch[1],
                d: value * bend.d + touch[1] * touch[1],
            };
            let b = (value * beside.0 + touch[0] * touch[2], value * beside.1 + touch[1] * touch[2]);
            let c = value * ahead + touch[2] * touch[2];
            let (away, tilted) = (across.solve(foot), across.solve(b));
            let rest = one - dot(foot, away);
            if !(value > zero) {
                return Err(None);
            }
            if rest > zero {
                let s = ((c - dot(b, tilted)).max(zero) / rest).sqrt();
                let to = Slant { a: s * away.0 - tilted.0, b: s * away.1 - tilted.1 };
                (n, slant) = (frame.normal(direction, to), Some(to));
            } else {
                // The line misses the ellipsoid, and the plane between is along it.
                misses += 1;
                (n, slant) = (frame.e1 * away.0 + frame.e2 * away.1, None);
            }
        }
        Err(None)
    }
}
