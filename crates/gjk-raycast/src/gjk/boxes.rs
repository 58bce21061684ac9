//! Whether two boxes meet, by the axes that may separate them (Gottschalk, Lin and Manocha, 1996, on trees of oriented
//! boxes).
//!
//! The difference of two boxes is `c + Σ sᵢ·hᵢuᵢ + Σ tₖ·fₖ` with all `|sᵢ|, |tₖ| ≤ 1`: `uᵢ` are unit vectors along the
//! edges of the first and `hᵢ` half their lengths, `fₖ` half edges of the second. Zero is in it unless it is beyond a
//! facet, and each facet is spanned by two edges. So with `n` one of the 15 vectors `uᵢ`, `fₖ × fₘ` and `uᵢ × fₖ`,
//!
//! > gap(n) = |n·c| − Σ hᵢ|n·uᵢ| − Σ |n·fₖ|
//!
//! is positive for one of them if they are apart. In the frame of the first box, with `Fₖ` the coordinates of `fₖ`, all
//! terms are coordinates of the three products `Fₖ × Fₘ`, or wedges `(Fₖ × C)ᵢ`.
//!
//! *What is certain.* Let `e` bound how far rounding, here and in the boxes, moves points. Any `n` with a gap of more
//! than `|n|·e` separates. To prove that they meet takes all facets, and an edge that is nearly along another spans a
//! sliver whose normal means nothing. So let `fₖ` be within `ρ` of a multiple of `uᵢ`. With that multiple in its place,
//! the difference shrinks by `ρ` at most. Its facets are those of the other edges, and their gaps, computed with the
//! actual `fₖ`, are off by another `ρ`. Gaps of `−(e + 2ρ)·|n|` along all those facets are proof enough.
//!
//! *Why this is not the [depth](crate::signed_distance) of boxes.* The depth makes unit vectors of all axes, bounds the
//! error of each facet, and finds the points at its end. For the same pairs, half of which overlap, it takes 3.4 times
//! the instructions (`signed_distance/cuboid-cuboid` and `intersect/cuboid-cuboid` of `benches/instructions.txt`).

use convex_support::{CoreKind, Parallelotope, Scalar, Vector};
use num_traits::Float;

use super::Frame;
use crate::body::AnyPair;
use crate::double::{Vec3, array, cross, dot};

/// The rounding here, in ε of the bound on all lengths: coordinates `4ε` each, products of two `12ε`, sums of seven
/// `6ε`, for both sides.
const ROUNDING: f64 = 64.0;

/// The rounding per part by which two edges of the first box are not orthogonal: a coordinate loses `2`, a product of
/// edges `12`.
const SKEW: f64 = 16.0;

/// Edges that are less orthogonal are not those of a box.
const LARGEST_SKEW: f64 = 1.0 / 1024.0;

/// A bound on the sum of all lengths, in units of the frame: its size is below two, the centre and the edges of a box
/// together are at most twice its extent, and in the plane a sheet has a thickness of one.
const LENGTHS: f64 = 5.0;

/// Whether two boxes meet.
pub(crate) enum BoxesMeet<V> {
    /// A plane across this unit vector from the second to the first separates them.
    Apart(V),
    Meet,
}

/// Whether two boxes without a radius meet; `None` if they are not boxes, flat, or so near to contact that it is in
/// doubt.
#[inline]
pub(crate) fn boxes<V: Vector>(pair: &AnyPair<'_, V>, frame: &Frame<V>) -> Option<BoxesMeet<V>> {
    let are_polytopes = [pair.core_a.kind, pair.core_b.kind].iter().all(|kind| matches!(kind, CoreKind::Polytope));
    if !are_polytopes || frame.radius > Scalar::ZERO {
        return None;
    }
    let [a, b] = pair.shapes.each().map(|shape| shape.core_parallelotope());
    let (a, b) = (a?, b?);
    SeenFromFirst::new(&a, &b, frame)?.boxes()
}

/// The difference in the frame of the first box.
struct SeenFromFirst {
    /// The directions of the first box, in the world, and half the lengths of its edges.
    u: [Vec3; 3],
    h: Vec3,
    /// The centre and the edges of the second box, in those coordinates.
    c: Vec3,
    f: [Vec3; 3],
    /// The error by rounding, in units of the frame.
    error: f64,
}

impl SeenFromFirst {
    #[inline(always)]
    fn new<V: Vector>(a: &Parallelotope<V>, b: &Parallelotope<V>, frame: &Frame<V>) -> Option<Self> {
        let in_unit = |v: V| array(v * frame.per_unit);
        let mut edges = a.half_edges.map(in_unit);
        if V::DIM == 2 {
            // A sheet of unit thickness.
            edges[2] = [0.0, 0.0, 1.0];
        }
        let h = edges.map(|edge| Float::sqrt(dot(edge, edge)));
        let u: [Vec3; 3] = core::array::from_fn(|i| edges[i].map(|x| x / h[i]));
        let [skew_x, skew_y, skew_z] = [dot(u[0], u[1]).abs(), dot(u[1], u[2]).abs(), dot(u[2], u[0]).abs()];
        let skew = skew_x.max(skew_y).max(skew_z);
        // An edge without length makes at least one of them NaN, and so the sum.
        if !(skew_x + skew_y + skew_z <= LARGEST_SKEW) {
            return None;
        }
        let [from, to, offset] = [in_unit(a.center), in_unit(b.center), array(frame.offset)];
        let center = core::array::from_fn(|i| from[i] - to[i] + offset[i]);
        let seen = |v: Vec3| [dot(u[0], v), dot(u[1], v), dot(u[2], v)];
        let error = frame.error.as_f64() + (ROUNDING * f64::EPSILON + SKEW * skew) * LENGTHS;
        Some(Self { u, h, c: seen(center), f: b.half_edges.map(|edge| seen(in_unit(edge))), error })
    }

    #[inline(always)]
    fn boxes<V: Vector>(&self) -> Option<BoxesMeet<V>> {
        let Self { h, c, f, error, .. } = self;
        let lengths = f.map(|f| Float::sqrt(dot(f, f)));
        // Nearly along a direction of the first box, or without length.
        let off = core::array::from_fn(|k| {
            let [x, y, z] = f[k].map(|x| x * x);
            let least = (y + z).min(z + x).min(x + y);
            if least <= error * lengths[k] { Some(Float::sqrt(least)) } else { None }
        });
        let [first, second, third]: [Option<f64>; 3] = off;
        let deep = error + 2.0 * (first.unwrap_or(0.0) + second.unwrap_or(0.0) + third.unwrap_or(0.0));

        let mut all_meet = true;
        // The facets of the first box.
        for i in 0..3 {
            let gap = c[i].abs() - (h[i] + f[0][i].abs() + f[1][i].abs() + f[2][i].abs());
            if gap > *error {
                return Some(self.apart(core::array::from_fn(|j| if i == j { c[i] } else { 0.0 })));
            }
            all_meet &= -gap > deep;
        }
        // The facets of the second box.
        let products = [cross(&f[1], &f[2]), cross(&f[2], &f[0]), cross(&f[0], &f[1])];
        let volume = dot(products[0], f[0]).abs();
        for (k, n) in products.iter().enumerate() {
            let [l, m] = [(k + 1) % 3, (k + 2) % 3];
            let along = dot(*n, *c);
            let gap = along.abs() - (h[0] * n[0].abs() + h[1] * n[1].abs() + h[2] * n[2].abs() + volume);
            let length = lengths[l] * lengths[m];
            if gap > error * length {
                return Some(self.apart(n.map(|x| x * along)));
            }
            all_meet &= off[l].is_some() | off[m].is_some() | (-gap > deep * length);
        }
        // The facets spanned by an edge of each.
        for k in 0..3 {
            let (f, [l, m]) = (&f[k], [(k + 1) % 3, (k + 2) % 3]);
            for [i, p, q] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
                let along = f[p] * c[q] - f[q] * c[p];
                let reach = h[p] * f[q].abs() + h[q] * f[p].abs() + products[l][i].abs() + products[m][i].abs();
                let gap = along.abs() - reach;
                if gap > error * lengths[k] {
                    let mut n = [0.0; 3];
                    (n[p], n[q]) = (-f[q] * along, f[p] * along);
                    return Some(self.apart(n));
                }
                all_meet &= off[k].is_some() | (-gap > deep * lengths[k]);
            }
        }
        all_meet.then_some(BoxesMeet::Meet)
    }

    /// Apart along a vector in coordinates of the first box.
    #[cold]
    fn apart<V: Vector>(&self, n: Vec3) -> BoxesMeet<V> {
        let world = |i: usize| self.u[0][i] * n[0] + self.u[1][i] * n[1] + self.u[2][i] * n[2];
        let along = [world(0), world(1), world(2)];
        let length = Float::sqrt(dot(along, along));
        BoxesMeet::Apart(V::from_fn(|i| V::Scalar::from_f64(along[i] / length)))
    }
}
