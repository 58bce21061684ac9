//! Which side of a facet a point is on, exactly.

use convex_support::{Scalar, Vector};
use robust::{Coord, Coord3D, orient2d, orient3d};

/// Whether a point lies strictly beyond a facet of two or three corners, that are counterclockwise as seen from
/// outside. The answer is exact (Shewchuk, *Adaptive precision floating-point arithmetic and fast robust geometric
/// predicates*, 1997, by the crate `robust`).
pub(super) fn is_beyond<V: Vector>(corners: &[V], point: V) -> bool {
    let flat = |p: V| Coord { x: p.get(0).as_f64(), y: p.get(1).as_f64() };
    match *corners {
        [a, b] => orient2d(flat(a), flat(b), flat(point)) < 0.0,
        [a, b, c] => {
            let coord = |p: V| Coord3D { x: p.get(0).as_f64(), y: p.get(1).as_f64(), z: p.get(2).as_f64() };
            orient3d(coord(a), coord(b), coord(c), coord(point)) < 0.0
        }
        _ => false,
    }
}
