//! Which side of a facet a point is on, exactly.

use convex_support::numerics::orientation::{six_volumes, twice_area};
use convex_support::{Scalar, Vector};

/// Whether a point lies strictly beyond a facet of two or three corners, that are counterclockwise as seen from
/// outside.
pub(super) fn is_beyond<V: Vector>(corners: &[V], point: V) -> bool {
    let flat = |p: V| [p.get(0).as_f64(), p.get(1).as_f64()];
    match *corners {
        [a, b] => twice_area([a, b, point].map(flat)) < 0.0,
        [a, b, c] => six_volumes([a, b, c, point].map(|p| [0, 1, 2].map(|i| p.get(i).as_f64()))) > 0.0,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DVec2, DVec3};

    use super::is_beyond;

    /// The points are so near to the line `y = x` that the determinant rounds to zero, or to the other sign.
    #[test]
    fn a_point_within_rounding_of_a_facet_is_on_its_true_side() {
        let (a, b) = (DVec2::splat(12.0), DVec2::splat(24.0));
        let at = |i: u32| 0.5 + f64::from(i) * f64::EPSILON / 2.0;
        for i in 0..32 {
            for j in 0..32 {
                assert_eq!(is_beyond(&[a, b], DVec2::new(at(i), at(j))), i > j, "{i} {j}");
                let corners = [DVec3::splat(12.0), DVec3::new(24.0, 24.0, 0.0), DVec3::splat(24.0)];
                assert_eq!(is_beyond(&corners, DVec3::new(at(i), at(j), 3.0)), i > j, "{i} {j} in space");
            }
        }
    }
}
