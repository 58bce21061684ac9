//! Whether the ray is near the body throughout its bracket, as a converged answer says, and a later lower bound where
//! it is not.
//!
//! How far apart the bounds are across the last plane tells how deep the ray is between them. It does not tell how far
//! the ray is from the body: at an edge another plane may have the lower bound far before it, and behind the edge the
//! ray may have left the body by the upper bound. So where the bounds are farther apart than a converged answer leaves
//! open, points of the body near both of them are looked for, by steps of GJK from the point that is known. The
//! distance from the body is convex along the ray, and so no larger in between. A plane found on the way, with the
//! lower bound before it, moves that.
//!
//! Along a face, or a curved surface, one look is enough. If the normal there is tilted by an angle `θ` towards the
//! point of the ray, the support point along it is the face's corner on that side, or on a surface of radius `R` a
//! point `Rθ` away. The chord to it is within `Rθ²/8` of the surface, so that `θ` is the root of what may be left open.

use convex_support::Vector;
use num_traits::Float as _;

use super::closest;
use crate::body::PointPair;
use crate::cast::RayContact;
use crate::cast::bracket::Bracket;
use crate::simplex::{Closest, Simplex};

/// The most support points, for each of both ends. Beside an edge it takes two or three.
const LOOKS_BESIDE_END: usize = 8;

/// Whether points of the body are known near both bounds, given that a point of the body is on the line at `on`. Bounds
/// without an upper one, or too deep to be told converged, are left as they are.
#[cold]
#[inline(never)]
pub(in crate::cast) fn draw_near<V: Vector>(
    bracket: &mut Bracket<'_, V>,
    contact: &mut RayContact<V>,
    on: V::Scalar,
) -> bool {
    let [low, high] = bracket.ends();
    if bracket.is_entry_open() || high - low <= bracket.narrow() || !bracket.is_narrow(high) {
        return true;
    }
    let core_point = bracket.line().at(on) - contact.normal.unwrap_or(V::ZERO) * bracket.radius;
    bracket.keep_depth();
    let is_near = |bracket: &mut Bracket<'_, V>, end: usize| {
        let (mut simplex, mut tilted) = (Simplex::new(), contact.normal);
        simplex.push(core_point, V::ZERO, PointPair::ZERO);
        for _ in 0..LOOKS_BESIDE_END {
            let x = bracket.line().at(bracket.ends()[end]);
            let Ok(Closest { v, face, weights }) = closest(bracket, &simplex, |p| x - p, V::DIM) else { break };
            let length = v.norm();
            if length - bracket.radius <= bracket.narrow() {
                return true;
            }
            simplex.retain(face, weights);
            let toward = v / length;
            let tilt = tilted.take().and_then(|normal| (normal + toward * bracket.narrow().sqrt()).unit());
            let n = tilt.unwrap_or(toward);
            let Ok((point, witness)) = bracket.support(n, v, simplex.points()) else { break };
            let is_known = simplex.points().contains(&point);
            if bracket.advance(n, point).is_err() || is_known && tilt.is_none() || simplex.points().len() > V::DIM {
                break;
            }
            if !is_known {
                simplex.push(point, n, witness);
            }
        }
        false
    };
    let is_near = is_near(bracket, 0) & is_near(bracket, 1);
    if bracket.low() > contact.mu {
        *contact = bracket.at_low(contact.witness);
    }
    is_near
}
