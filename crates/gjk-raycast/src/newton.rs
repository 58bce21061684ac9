//! Steps of a descent towards the closest points of curved bodies.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::body::Body;
use crate::descent::Descent;
use crate::regions::cross;
use crate::simplex::MAX_POINTS;
use crate::turn::{Condition, Found, Recent, turn};

/// Chooses directions to look along by curvature, where the support map knows it.
///
/// Among the unit vectors `n`, the distance of `C = A − B` from zero is the maximum of `n·p(n)`, with `p(n)` the point of
/// `C` lowest along `n`: all of `C` lies beyond the plane through it. There `p` points along `n`. With the derivative
/// `Hδ` of the support point as its direction turns by `δ`, and `ρ = n·p`, the condition is to first order
///
/// ```text
/// (H + ρ)·δ = −(p − ρ·n)   across n,   n' ~ n − δ.
/// ```
///
/// `H` has no negative eigenvalue and `ρ` tends to the distance, so that the matrix is definite, and Newton's steps double
/// the digits: then `n·p` and `|p|` are bounds that meet. That holds as long as `p` moves on one smooth piece; the point
/// that a step foretold tells whether it did. Where it did not, the closest point may be between pieces, as on the side of
/// a cylinder between its rims, and [`turn`] looks for the direction that supports both.
///
/// Steps are taken while they shrink the bracket. Otherwise a step of GJK is next, which always makes progress.
pub(crate) struct Newton<V: Vector> {
    recent: Recent<V, ()>,
    noise: V::Scalar,
    /// See [`Condition::lead`].
    lead: V::Scalar,
    /// The width of the bracket before the last turn, if the last step was one.
    before: Option<V::Scalar>,
    /// Turns in a row that did not shrink the bracket.
    failures: usize,
    /// A support point, and where it was expected to move by the last turn.
    foretold: Option<[V; 2]>,
    /// Turns for which the closest point is taken to be between pieces.
    between: usize,
}

/// Turns between pieces after one that did not find the point that was foretold.
const BETWEEN: usize = 8;

/// Turns that fail to halve the bracket before the next step is one of GJK.
const PATIENCE: usize = 2;

/// How far one piece is made to lead over another, relative to the bracket.
const LEAD: f64 = 0.01;

/// A support point was foretold if it is this near, relative to how far it moved.
const FORETOLD: f64 = 0.25;

impl<V: Vector> Newton<V> {
    pub(crate) fn new(noise: V::Scalar) -> Self {
        Self { recent: Recent::new(), noise, lead: noise, before: None, failures: 0, foretold: None, between: 0 }
    }

    /// Whether the last direction was chosen here.
    pub(crate) fn has_turned(&self) -> bool {
        self.before.is_some()
    }

    /// The next unit direction, after `p` was found as the lowest point along the unit vector `n`, with `reach = n·p`.
    /// `None` where the next should be that of the shortest vector.
    #[inline(never)]
    pub(crate) fn next<B: Body<Vector = V>>(
        &mut self,
        body: &B,
        descent: &Descent<V, B::Witness>,
        p: V,
        n: V,
        reach: V::Scalar,
    ) -> Option<V> {
        let along = -n;
        self.recent.push(Found { point: p, along }, ());
        let foretold = self.foretold.take();
        let gap = descent.length - descent.lower;
        if let Some(before) = self.before.take() {
            if gap <= before * V::Scalar::from_f64(0.5) {
                (self.failures, self.lead) = (0, self.noise);
            } else {
                self.failures += 1;
                self.lead *= V::Scalar::from_f64(16.0);
                if self.failures >= PATIENCE {
                    return None;
                }
            }
        }
        // As far as below, the bodies are as likely to overlap.
        if !(reach > -descent.length) {
            return None;
        }
        let distance = reach.max(V::Scalar::ZERO);
        let as_foretold = foretold.is_none_or(|[from, to]| {
            (p - to).length() <= (to - from).length() * V::Scalar::from_f64(FORETOLD) + self.noise
        });
        if !as_foretold {
            self.between = BETWEEN;
        }
        let to = if self.between == 0 {
            let change = change(body, along, p + along * reach, distance)?;
            self.foretold = Some([p, p + change.moved]);
            (along + change.turn).unit()?
        } else {
            self.between -= 1;
            let condition = Condition {
                axis: along,
                target: V::ZERO,
                distance,
                noise: self.noise,
                lead: self.lead.max(gap * V::Scalar::from_f64(LEAD)),
            };
            let mut known = [Found::default(); 2 * MAX_POINTS];
            let mut len = 0;
            for (&point, &along) in descent.simplex.points().iter().zip(descent.simplex.along()) {
                known[len] = Found { point, along };
                len += 1;
            }
            for &last in self.recent.found() {
                known[len] = last;
                len += 1;
            }
            turn(&known[..len], condition, |n, change| body.derivative(n, change))?.to
        };
        self.before = Some(gap);
        Some(-to)
    }
}

/// A change of the direction, and how the support point is to move by it.
struct Change<V> {
    turn: V,
    moved: V,
}

/// The Newton step on one smooth piece: `(H + ρ)·δ = −rest`, with `rest` the support point's part across the direction.
///
/// With `u` the unit vector along `rest` and `w` across both, and the matrix `(a b; b d)` in that basis,
/// `δ = −|rest|·(d·u − b·w) / (a·d − b²)`.
#[inline]
fn change<B: Body>(
    body: &B,
    along: B::Vector,
    rest: B::Vector,
    distance: <B::Vector as Vector>::Scalar,
) -> Option<Change<B::Vector>> {
    type S<B> = <<B as Body>::Vector as Vector>::Scalar;
    let length = rest.length();
    let u = rest / length;
    let moved_u = body.derivative(along, u);
    let a = u.dot(moved_u) + distance;
    let change = if B::Vector::DIM == 2 {
        let part = -length / a;
        Change { turn: u * part, moved: moved_u * part }
    } else {
        let w = cross(along, u);
        let moved_w = body.derivative(along, w);
        let (b, d) = (u.dot(moved_w), w.dot(moved_w) + distance);
        let determinant = a * d - b * b;
        if !(determinant > S::<B>::EPSILON.sqrt() * a * d) {
            return None;
        }
        let (s, t) = (-length * d / determinant, length * b / determinant);
        Change { turn: u * s + w * t, moved: moved_u * s + moved_w * t }
    };
    // NaN fails this too.
    (change.turn.length_squared() <= S::<B>::from_f64(0.25)).then_some(change)
}
