//! Which side of a line or a plane a point is on, exactly (Shewchuk, *Adaptive precision floating-point arithmetic and
//! fast robust geometric predicates*, 1997).
//!
//! Both determinants are right in sign, and in value to half of it, for all points whose coordinates are finite and
//! whose products neither over- nor underflow. Plain numbers determine the sign if the determinant is larger than their
//! rounding, and for a volume so do numbers of twice the precision. The rest are added up without rounding, term by
//! term in loops, with a tenth of the machine code of Shewchuk's last steps.

use super::twofold::{two_product, two_sum};

/// Half the distance from 1 to the next number.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Twice the area of a triangle, positive if its corners are counterclockwise.
#[inline]
#[must_use]
pub fn twice_area([a, b, c]: [[f64; 2]; 3]) -> f64 {
    let (u, v) = ([a[0] - c[0], a[1] - c[1]], [b[0] - c[0], b[1] - c[1]]);
    let (left, right) = (u[0] * v[1], u[1] * v[0]);
    let determinant = left - right;
    let lost = (left.abs() + right.abs()) * ((3.0 + 16.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF);
    if determinant.abs() > lost { determinant } else { exact_twice_area(a, b, c) }
}

/// Six times the volume of a tetrahedron, positive if `a`, `b` and `c` are counterclockwise as seen from `d`.
#[inline]
#[must_use]
pub fn six_volumes([a, b, c, d]: [[f64; 3]; 4]) -> f64 {
    let from = |p: [f64; 3]| (p[0] - d[0], p[1] - d[1], p[2] - d[2]);
    let ((ux, uy, uz), (vx, vy, vz), (wx, wy, wz)) = (from(a), from(b), from(c));
    // By the cross product of the last two, which points away from `d` if they are counterclockwise.
    let (vy_wz, vz_wy) = (vy * wz, vz * wy);
    let (vz_wx, vx_wz) = (vz * wx, vx * wz);
    let (vx_wy, vy_wx) = (vx * wy, vy * wx);
    let determinant = ux * (vz_wy - vy_wz) + uy * (vx_wz - vz_wx) + uz * (vy_wx - vx_wy);
    let size = ux.abs() * (vy_wz.abs() + vz_wy.abs())
        + uy.abs() * (vz_wx.abs() + vx_wz.abs())
        + uz.abs() * (vx_wy.abs() + vy_wx.abs());
    let lost = size * ((7.0 + 56.0 * UNIT_ROUNDOFF) * UNIT_ROUNDOFF);
    if determinant.abs() > lost { determinant } else { exact_six_volumes([a, b, c], d) }
}

/// The even permutations of the axes.
const CYCLIC: [[usize; 3]; 3] = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];

#[cold]
#[inline(never)]
fn exact_twice_area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    let difference = |p: [f64; 2], i: usize| two_sum(p[i], -c[i]);
    let mut sum = ExactSum::new();
    sum.add_product([1.0, 0.0], difference(a, 0), difference(b, 1));
    sum.add_product([-1.0, 0.0], difference(a, 1), difference(b, 0));
    sum.rounded()
}

/// The volume if plain numbers leave its sign open.
///
/// Every difference is `h + l` with `|l| ≤ ε·|h|`. To the rounded determinant of the `h`, all terms of the first order
/// in ε are added: the rounding error of each product and each sum, and the terms with one `l`. The terms with two `l`
/// are at most ε times these, of which there are 30, so that less than `40·ε` of the sum of their magnitudes is
/// missing; and nothing if they are zero.
#[cold]
#[inline(never)]
fn exact_six_volumes([a, b, c]: [[f64; 3]; 3], d: [f64; 3]) -> f64 {
    let [u, v, w] = [a, b, c].map(|p| [0, 1, 2].map(|i| two_sum(p[i], -d[i])));
    let (mut high, mut low, mut size_of_low) = (0.0, 0.0, 0.0);
    let mut add = |term: f64| {
        low += term;
        size_of_low += term.abs();
    };
    for [i, j, k] in CYCLIC {
        let [right, lost_right] = two_product(v[j][0], w[i][0]);
        let [left, lost_left] = two_product(v[i][0], w[j][0]);
        let [minor, lost] = two_sum(right, -left);
        let [term, lost_term] = two_product(u[k][0], minor);
        let [sum, lost_sum] = two_sum(high, term);
        high = sum;
        add(lost_term);
        add(lost_sum);
        add(u[k][1] * minor);
        for more in [lost, lost_right, -lost_left] {
            add(u[k][0] * more);
        }
        for (x, y) in [(v[j][0], w[i][1]), (v[j][1], w[i][0]), (-v[i][0], w[j][1]), (-v[i][1], w[j][0])] {
            add(u[k][0] * (x * y));
        }
    }
    let determinant = high + low;
    if determinant.abs() >= size_of_low * (128.0 * UNIT_ROUNDOFF) {
        return determinant;
    }
    let mut sum = ExactSum::new();
    for [i, j, k] in CYCLIC {
        sum.add_product(u[k], v[j], w[i]);
        sum.add_product(u[k].map(|part| -part), v[i], w[j]);
    }
    sum.rounded()
}

/// A sum of numbers as an expansion: nonzero numbers whose bits do not overlap, from the least to the largest, so that
/// the last one has its sign.
struct ExactSum {
    /// The most terms of six products of three differences: each difference is two numbers, and each product of three
    /// numbers four.
    terms: [f64; 6 * 8 * 4],
    len: usize,
}

impl ExactSum {
    fn new() -> Self {
        Self { terms: [0.0; 6 * 8 * 4], len: 0 }
    }

    /// Shewchuk's Grow-Expansion, with zeros left out; it adds one term at most.
    fn add(&mut self, number: f64) {
        let (mut carry, mut kept) = (number, 0);
        for i in 0..self.len {
            let [sum, lost] = two_sum(carry, self.terms[i]);
            carry = sum;
            if lost != 0.0 {
                self.terms[kept] = lost;
                kept += 1;
            }
        }
        if carry != 0.0 {
            self.terms[kept] = carry;
            kept += 1;
        }
        self.len = kept;
    }

    /// Adds the product of three numbers, each of which is a sum of two.
    fn add_product(&mut self, x: [f64; 2], y: [f64; 2], z: [f64; 2]) {
        for (x, y) in x.into_iter().flat_map(|x| y.map(|y| (x, y))) {
            for (xy, z) in two_product(x, y).into_iter().flat_map(|xy| z.map(|z| (xy, z))) {
                // Differences are mostly exact, and then this is zero.
                if xy * z != 0.0 {
                    two_product(xy, z).into_iter().for_each(|term| self.add(term));
                }
            }
        }
    }

    fn rounded(&self) -> f64 {
        self.terms[..self.len].iter().sum()
    }
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;
    use proptest::prelude::*;

    use super::*;

    /// In units of 2^-200, of which all numbers here are multiples.
    fn integer(x: f64) -> BigInt {
        if x == 0.0 {
            return BigInt::ZERO;
        }
        let (mantissa, exponent, sign) = num_traits::Float::integer_decode(x);
        (BigInt::from(mantissa) * i64::from(sign)) << (i32::from(exponent) + 200)
    }

    /// A coordinate near a multiple of a half, by a few of its last bits, or one below those.
    fn coordinate() -> impl Strategy<Value = f64> {
        let near = (-4i32..=4, -3i32..=3, prop_oneof![Just(0.0), Just(1.0), Just(1e-8), Just(1e8)])
            .prop_map(|(n, bits, scale)| f64::from(n) * 0.5 + f64::from(bits) * f64::EPSILON * scale);
        prop_oneof![3 => near, 1 => (-3i32..=3).prop_map(|n| f64::from(n) * (1e-17 / 3.0))]
    }

    fn few_digits() -> impl Strategy<Value = [[f64; 3]; 4]> {
        prop::array::uniform4(prop::array::uniform3(coordinate()))
    }

    /// Four points in a plane along the third axis, to rounding, whose projections along it are on a line.
    fn nearly_in_a_plane() -> impl Strategy<Value = [[f64; 3]; 4]> {
        let corners = prop::array::uniform3(prop::array::uniform3(-1.0..1.0));
        (corners, -2.0..2.0, -2.0..2.0).prop_map(|([a, b, c], s, t)| {
            let on_the_line = |s: f64, z: f64| [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z];
            [a, b, on_the_line(s, c[2]), on_the_line(t, c[0])]
        })
    }

    proptest! {
        #![proptest_config(crate::laws::config(4096))]

        #[test]
        fn signs_are_those_of_the_exact_determinants(p in prop_oneof![few_digits(), nearly_in_a_plane()]) {
            let at = |i: usize, axis: usize| integer(p[i][axis]);
            let from = |i: usize, last: usize| -> [BigInt; 3] { core::array::from_fn(|k| at(i, k) - at(last, k)) };
            let (u, v) = (from(0, 2), from(1, 2));
            let area = &u[0] * &v[1] - &u[1] * &v[0];
            let flat = [0, 1, 2].map(|i| [p[i][0], p[i][1]]);
            prop_assert_eq!(twice_area(flat).partial_cmp(&0.0), Some(area.cmp(&BigInt::ZERO)));

            let [u, v, w] = [0, 1, 2].map(|i| from(i, 3));
            let cross = [&v[1] * &w[2] - &v[2] * &w[1], &v[2] * &w[0] - &v[0] * &w[2], &v[0] * &w[1] - &v[1] * &w[0]];
            let volume = -(&u[0] * &cross[0] + &u[1] * &cross[1] + &u[2] * &cross[2]);
            prop_assert_eq!(six_volumes(p).partial_cmp(&0.0), Some(volume.cmp(&BigInt::ZERO)));
        }
    }

    #[test]
    fn a_triangle_and_a_tetrahedron_are_counterclockwise_and_measured() {
        assert_eq!(twice_area([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), 1.0);
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let from = |d| six_volumes([corners[0], corners[1], corners[2], d]);
        assert_eq!([from([0.0, 0.0, 2.0]), from([0.0, 0.0, -2.0]), from([7.0, 5.0, 0.0])], [2.0, -2.0, 0.0]);
    }
}
