//! The bottom of a basin of the support value among unit vectors.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use super::boundary::Boundary;
use super::cores::{Cores, Vertex, WayOut};
use super::newton::{FoldSide, Piece};
use crate::SignedDistanceOptions;

/// Newton's steps from one direction.
const MAX_STEPS: usize = 12;

/// The steps in a row that may find nothing lower: if two pieces meet, one is predicted from farther away until it is
/// found again.
const PATIENCE: usize = 2;

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
    for _ in 0..MAX_STEPS {
        let u = match &second {
            Some(second) => first.step_along_fold(second, stale),
            None => first.step(),
        };
        let u = u.or_else(|| if last { first.step_to_edge(second.as_ref()) } else { None });
        let Some(u) = u.filter(|_| cores.iterations < options.max_iterations && failures < PATIENCE) else { break };
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
