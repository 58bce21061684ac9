//! Two boxes, by the facets of their difference: whether they meet, how deep they are in one another, and for turning
//! casts (`motion/box_look.rs`) which facet keeps them apart.
//!
//! The difference of two boxes is the set of all `c + Σ tₖ·eₖ` with `|tₖ| ≤ 1`, where `eₖ` are half the edges of the
//! first box and then of the second. It is a zonotope. Each of its facets is spanned by two edges: those of a face of
//! one box, or one edge of each box. The other four lead from the centre to the facet. So along the unit vector `n`
//! across the facet, zero is beyond the facet by
//!
//! > level(n) = |n·c| − Σ |n·eₖ|,
//!
//! which is how far apart the plane of the facet keeps the boxes. If the boxes overlap, the highest level of all facets
//! is minus the depth. If they are apart, and the foot of the perpendicular from zero to the highest facet is within
//! the facet, the highest level is their distance. Otherwise an edge or a corner of the difference is closest to zero,
//! and the highest level is less than the distance, but no less than `1/√3` of it. This is because the vector to the
//! closest point is a sum of the normals of facets that meet there, and all of these are in one octant of the first
//! box's coordinates.
//!
//! A [`Zonotope`] is the difference of any two parallelotopes, also of segments and points. In the plane the first has
//! a third edge, perpendicular to the plane, so that each facet is spanned by two edges there too.

use convex_support::numerics::coordinates::{LEAST, Vec3, array, cross, dot, vector};
use convex_support::numerics::twofold::two_product;
use convex_support::{Parallelotope, Scalar, Vector};
use num_traits::Float;

use crate::body::PointPair;
use crate::gjk::Frame;

/// The number of edges of two boxes that count, three of each.
pub(crate) const EDGES: usize = 6;

/// Below this squared sine of the angle between two edges their product is computed in twice the precision.
const ACUTE_EDGES: f64 = 0.25;

/// Edges with a sine of the angle below this many ε count as parallel.
const PARALLEL_EDGES: f64 = 8.0;

/// The two edges of each facet.
const SPANS: [[usize; 2]; EDGES * (EDGES - 1) / 2] = {
    let mut spans = [[0, 1]; EDGES * (EDGES - 1) / 2];
    let mut at = 1;
    while at < spans.len() {
        let [i, j] = spans[at - 1];
        spans[at] = if j + 1 < EDGES { [i, j + 1] } else { [i + 1, i + 2] };
        at += 1;
    }
    spans
};
const SPANS_OF_PLANE: [[usize; 2]; 4] = [[0, 2], [1, 2], [3, 2], [4, 2]];

/// One for each edge that is neither of two, which would otherwise add their rounding.
const OTHERS: [[[f64; EDGES]; EDGES]; EDGES] = {
    let mut others = [[[1.0; EDGES]; EDGES]; EDGES];
    let mut at = 0;
    while at < EDGES * EDGES {
        let (i, j) = (at / EDGES, at % EDGES);
        (others[i][j][i], others[i][j][j]) = (0.0, 0.0);
        at += 1;
    }
    others
};

/// The difference of two parallelotopes, in double precision, so that it adds nothing to the rounding of `f32` before.
pub(crate) struct Zonotope {
    center: Vec3,
    /// Half of each edge of the first and then of the second: first the x coordinates of all, then the y coordinates,
    /// then the z coordinates.
    edges: [[f64; EDGES]; 3],
    /// The squares of their lengths.
    squared: [f64; EDGES],
}

/// Of the two facets that two edges span, the one on the side of zero.
pub(crate) struct ZonotopeFacet {
    pub(crate) span: [usize; 2],
    /// The unit vector across it, from the second box to the first.
    pub(crate) normal: Vec3,
    /// The area that the two edges span, negative if the normal is opposite to their cross product.
    pub(crate) area: f64,
    /// How far each edge leads along the normal.
    pub(crate) heights: [f64; EDGES],
    /// How far zero is beyond the facet; negative if it is behind.
    pub(crate) level: f64,
}

impl Zonotope {
    /// The difference `(a − b)·per_unit + offset`, in a unit in which the size of both is below two: in the plane the
    /// third edge is longer, so that the facets at its ends are never those nearest to zero.
    #[inline(always)]
    pub(crate) fn new<V: Vector>([a, b]: &[Parallelotope<V>; 2], offset: V, per_unit: V::Scalar) -> Self {
        let in_unit = |v: V| array(v * per_unit);
        let [from, to, offset] = [in_unit(a.center), in_unit(b.center), array(offset)];
        let center = core::array::from_fn(|i| from[i] - to[i] + offset[i]);
        let edges: [Vec3; EDGES] = core::array::from_fn(|k| match k {
            // Minus zero, for the cross product with `(x, y, 0)` to be along `(y, −x, 0)` to the signs of zeros.
            2 if V::DIM == 2 => [-0.0, 0.0, 2.0],
            0..3 => in_unit(a.half_edges[k]),
            _ => in_unit(b.half_edges[k - 3]),
        });
        let [x, y, z] = core::array::from_fn(|i| core::array::from_fn(|k| edges[k][i]));
        let squared = core::array::from_fn(|k| x[k] * x[k] + y[k] * y[k] + z[k] * z[k]);
        Self { center, edges: [x, y, z], squared }
    }

    #[inline(always)]
    pub(crate) fn edge(&self, k: usize) -> Vec3 {
        let [x, y, z] = &self.edges;
        [x[k], y[k], z[k]]
    }

    /// Half the length of an edge.
    #[inline(always)]
    pub(crate) fn length(&self, k: usize) -> f64 {
        Float::sqrt(self.squared[k])
    }

    /// The unit vector along the cross product of two edges, and their area; or if they are parallel, by how much one
    /// of them would have to be changed to be a multiple of the other.
    #[inline(always)]
    fn across(&self, [i, j]: [usize; 2]) -> Result<(Vec3, f64), f64> {
        let (e, f, le, lf) = (self.edge(i), self.edge(j), self.squared[i], self.squared[j]);
        let product = le * lf;
        if product < LEAST {
            return Err(Float::sqrt(le.min(lf)));
        }
        let mut across = cross(&e, &f);
        let mut area = dot(across, across);
        if area < ACUTE_EDGES * product {
            across = exact_cross(&e, &f);
            area = dot(across, across);
            let parallel = PARALLEL_EDGES * f64::EPSILON;
            if area <= parallel * parallel * product {
                return Err(Float::sqrt(area / le.max(lf)));
            }
        }
        let area = Float::sqrt(area);
        let per = area.recip();
        Ok((across.map(|x| x * per), area))
    }

    /// How far each edge leads along a unit vector, and the level of the facets that two edges span across it.
    #[inline(always)]
    fn level(&self, n: Vec3, [i, j]: [usize; 2]) -> ([f64; EDGES], f64) {
        let ([x, y, z], others) = (&self.edges, &OTHERS[i][j]);
        let heights = core::array::from_fn(|k| n[0] * x[k] + n[1] * y[k] + n[2] * z[k]);
        let [a, b, c, d, e, f]: [f64; EDGES] = core::array::from_fn(|k| Float::abs(heights[k]) * others[k]);
        (heights, dot(n, self.center).abs() - ((a + c + e) + (b + d + f)))
    }

    /// The facet of two edges, unless they are parallel.
    #[inline(always)]
    pub(crate) fn facet(&self, span: [usize; 2]) -> Option<ZonotopeFacet> {
        let (n, area) = self.across(span).ok()?;
        let (normal, area) = if dot(n, self.center) > 0.0 { (n, area) } else { (n.map(|x| -x), -area) };
        let (heights, level) = self.level(normal, span);
        Some(ZonotopeFacet { span, normal, area, heights, level })
    }

    /// The place of zero's foot on a facet along each edge, if every edge but the two that span the facet leads to it
    /// all the way.
    #[inline(always)]
    pub(crate) fn foot(&self, facet: &ZonotopeFacet) -> [f64; EDGES] {
        let [i, j] = facet.span;
        let others = &OTHERS[i][j];
        let mut weights = core::array::from_fn(|k| -Float::copysign(others[k], facet.heights[k]));
        let rest = self.rest(facet, &weights);
        let per = facet.area.recip();
        weights[i] = dot(cross(&rest, &self.edge(j)), facet.normal) * per;
        weights[j] = dot(cross(&self.edge(i), &rest), facet.normal) * per;
        weights
    }

    /// What leads to zero's foot on a facet from where the centre and some weights lead.
    #[inline(always)]
    fn rest(&self, facet: &ZonotopeFacet, weights: &[f64; EDGES]) -> Vec3 {
        core::array::from_fn(|x| {
            let rest = facet.normal[x] * facet.level - self.center[x];
            self.edges[x].iter().zip(weights).fold(rest, |rest, (edge, weight)| rest - edge * weight)
        })
    }
}

fn spans<V: Vector>() -> &'static [[usize; 2]] {
    if V::DIM == 2 { &SPANS_OF_PLANE } else { &SPANS }
}

/// How far two edges of a plane lead on the way `rest`, and the area that they span.
#[inline(always)]
fn ways([e, f]: [[f64; 2]; 2], rest: [f64; 2]) -> ([f64; 2], f64) {
    let area = e[0] * f[1] - e[1] * f[0];
    ([(rest[0] * f[1] - rest[1] * f[0]) / area, (e[0] * rest[1] - e[1] * rest[0]) / area], area)
}

fn length(v: Vec3) -> f64 {
    Float::sqrt(dot(v, v))
}

/// The product with every coordinate right to its last digit but one, however much of the terms cancels.
#[cold]
#[inline(never)]
fn exact_cross(a: &Vec3, b: &Vec3) -> Vec3 {
    let minor = |i: usize, j: usize| {
        let [[p, lost_p], [q, lost_q]] = [two_product(a[i], b[j]), two_product(a[j], b[i])];
        (p - q) + (lost_p - lost_q)
    };
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// The axes that may separate two boxes (Gottschalk, Lin and Manocha, 1996, on trees of oriented boxes), in the
/// coordinates of the first box.
///
/// Let `uᵢ` be unit vectors along its edges, `hᵢ` half their lengths, and `fₖ` half the edges of the second. The axes
/// are `uᵢ`, `fₖ × fₘ` and `uᵢ × fₖ`, and all terms along them are coordinates of the three products `fₖ × fₘ`, or of
/// `fₖ × c`. The *gap* along an axis `n` is `|n|` times the level: it takes no root.
struct SeparatingAxes {
    u: [Vec3; 3],
    h: Vec3,
    c: Vec3,
    f: [Vec3; 3],
}

impl SeparatingAxes {
    #[inline(always)]
    fn new(zonotope: &Zonotope) -> Self {
        let h: Vec3 = core::array::from_fn(|i| zonotope.length(i));
        let u: [Vec3; 3] = core::array::from_fn(|i| zonotope.edge(i).map(|x| x / h[i]));
        let coordinates = |v: Vec3| [dot(u[0], v), dot(u[1], v), dot(u[2], v)];
        let f = core::array::from_fn(|k| coordinates(zonotope.edge(3 + k)));
        Self { u, h, c: coordinates(zonotope.center), f }
    }

    /// The first axis that is wanted, by the two edges that it is across and the gap along it. It is told in the
    /// coordinates of the first box, from the second to the first.
    #[inline(always)]
    fn find(&self, mut is_wanted: impl FnMut([usize; 2], f64) -> bool) -> Option<Vec3> {
        let Self { h, c, f, .. } = self;
        for i in 0..3 {
            let gap = c[i].abs() - (h[i] + f[0][i].abs() + f[1][i].abs() + f[2][i].abs());
            if is_wanted([(i + 1) % 3, (i + 2) % 3], gap) {
                return Some(core::array::from_fn(|j| if i == j { c[i] } else { 0.0 }));
            }
        }
        let products = [cross(&f[1], &f[2]), cross(&f[2], &f[0]), cross(&f[0], &f[1])];
        let volume = dot(products[0], f[0]).abs();
        for (k, n) in products.iter().enumerate() {
            let along = dot(*n, *c);
            let gap = along.abs() - (h[0] * n[0].abs() + h[1] * n[1].abs() + h[2] * n[2].abs() + volume);
            if is_wanted([3 + (k + 1) % 3, 3 + (k + 2) % 3], gap) {
                return Some(n.map(|x| x * along));
            }
        }
        for k in 0..3 {
            let (f, [l, m]) = (&f[k], [(k + 1) % 3, (k + 2) % 3]);
            for [i, p, q] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
                let along = f[p] * c[q] - f[q] * c[p];
                let reach = h[p] * f[q].abs() + h[q] * f[p].abs() + products[l][i].abs() + products[m][i].abs();
                if is_wanted([i, 3 + k], along.abs() - reach) {
                    let mut n = [0.0; 3];
                    (n[p], n[q]) = (-f[q] * along, f[p] * along);
                    return Some(n);
                }
            }
        }
        None
    }
}

/// The squared sine of the angle between two edges below which [`Zonotope::highest`] leaves out their facet. It is a
/// sliver, and its level is higher than those of other facets by no more than the sine times the shorter edge.
const SLIVER: f64 = 1e-6;

/// The part of the highest level that slivers may add to it without being computed.
const OVERLOOKED: f64 = 0.1;

impl Zonotope {
    /// The highest facet of two boxes. `None` if some edges are so nearly parallel that their facet, which is not
    /// computed, may be the highest.
    #[inline(always)]
    pub(crate) fn highest(&self) -> Option<ZonotopeFacet> {
        let axes = SeparatingAxes::new(self);
        let squared = [1.0, 1.0, 1.0, self.squared[3], self.squared[4], self.squared[5]];
        // Squares with the signs of the levels are compared, so that no root is needed.
        let (mut highest, mut span, mut overlooked) = (f64::NEG_INFINITY, [1, 2], 0.0);
        let _ = axes.find(|[i, j], gap| {
            let (product, level) = (squared[i] * squared[j], gap * gap.abs());
            let cosine = if i < 3 && j >= 3 { axes.f[j - 3][i] } else { 0.0 };
            let area = product - cosine * cosine;
            if area < SLIVER * product {
                overlooked += area.abs() / product * self.squared[i].min(self.squared[j]);
            } else if level > highest * area {
                (highest, span) = (level / area, [i, j]);
            }
            false
        });
        // If a number is NaN, the comparison fails.
        if overlooked <= highest.abs() * (OVERLOOKED * OVERLOOKED) { self.facet(span) } else { None }
    }
}

/// The rounding of [`boxes`], in ε of the bound on all lengths: coordinates `4ε` each, products of two `12ε`, sums of
/// seven `6ε`, for both sides.
const ROUNDING_OF_OVERLAP: f64 = 64.0;

/// The rounding per part by which two edges of the first box are not orthogonal: a coordinate loses `2`, a product of
/// edges `12`.
const SKEW_OF_EDGES: f64 = 16.0;

/// Edges that are less orthogonal are not those of a box.
const LARGEST_SKEW: f64 = 1.0 / 1024.0;

/// A bound on the sum of all lengths that are rounded, in units of the frame: its size is below two, and the centre and
/// the edges of a box together are at most twice its extent.
const LENGTHS: f64 = 5.0;

/// Whether two boxes meet.
pub(crate) enum BoxesMeet<V> {
    /// A plane across this unit vector from the second to the first separates them.
    Apart(V),
    Meet,
}

/// Whether two boxes meet; `None` if they are not boxes, the first is flat, or they are so near to contact that it is
/// in doubt. The search ends at the first axis that separates them. For the same pairs, half of which overlap,
/// [`Zonotope::nearest_facet`] takes 3.4 times the instructions (`signed_distance/cuboid-cuboid` and
/// `intersect/cuboid-cuboid` of `benches/instructions.txt`).
///
/// *What is certain.* Let `e` bound how far rounding, here and in the boxes, moves points. Any `n` with a gap of more
/// than `|n|·e` separates. To prove that they meet takes all facets, and an edge that is nearly along another spans a
/// sliver whose normal means nothing. So let `fₖ` be within `ρ` of a multiple of `uᵢ`. With that multiple in its place,
/// the difference shrinks by `ρ` at most. Its facets are those of the other edges, and their gaps, computed with the
/// actual `fₖ`, are off by another `ρ`. Gaps of `−(e + 2ρ)·|n|` along all those facets are proof enough.
#[inline]
pub(crate) fn boxes<V: Vector>(parts: &[Parallelotope<V>; 2], frame: &Frame<V>) -> Option<BoxesMeet<V>> {
    let zonotope = Zonotope::new(parts, frame.offset, frame.per_unit);
    let axes = SeparatingAxes::new(&zonotope);
    let SeparatingAxes { u, f, .. } = &axes;
    let [skew_x, skew_y, skew_z] = [dot(u[0], u[1]).abs(), dot(u[1], u[2]).abs(), dot(u[2], u[0]).abs()];
    // An edge without length makes at least one of them NaN, and so the sum.
    if !(skew_x + skew_y + skew_z <= LARGEST_SKEW) {
        return None;
    }
    let skew = skew_x.max(skew_y).max(skew_z);
    let error = frame.error.as_f64() + (ROUNDING_OF_OVERLAP * f64::EPSILON + SKEW_OF_EDGES * skew) * LENGTHS;
    let lengths = [1.0, 1.0, 1.0, zonotope.length(3), zonotope.length(4), zonotope.length(5)];
    // Nearly along a direction of the first box, or without length.
    let off: [Option<f64>; 3] = core::array::from_fn(|k| {
        let [x, y, z] = f[k].map(|x| x * x);
        let least = (y + z).min(z + x).min(x + y);
        if least <= error * lengths[3 + k] { Some(Float::sqrt(least)) } else { None }
    });
    let deep = error + 2.0 * (off[0].unwrap_or(0.0) + off[1].unwrap_or(0.0) + off[2].unwrap_or(0.0));
    let is_off = |k: usize| k >= 3 && off[k - 3].is_some();
    let mut all_meet = true;
    let separating = axes.find(|[i, j], gap| {
        let length = lengths[i] * lengths[j];
        all_meet &= is_off(i) | is_off(j) | (-gap > deep * length);
        gap > error * length
    });
    match separating {
        Some(n) => Some(BoxesMeet::Apart(axes.unit_along(n))),
        None if all_meet => Some(BoxesMeet::Meet),
        None => None,
    }
}

impl SeparatingAxes {
    /// The unit vector along a vector in coordinates of the first box.
    #[cold]
    fn unit_along<V: Vector>(&self, n: Vec3) -> V {
        let [u, v, w] = &self.u;
        let along: Vec3 = core::array::from_fn(|i| u[i] * n[0] + v[i] * n[1] + w[i] * n[2]);
        let length = length(along);
        vector(along.map(|x| x / length))
    }
}

/// How much a unit normal may be turned by rounding, in ε: the product of two edges is wrong by one of the product of
/// their lengths, which is at most twice as long; the rest are its own roundings.
const NORMAL_TURNED: f64 = 4.0;

/// How much longer or shorter than one it may be, in ε.
const STRETCH: f64 = 3.0;

/// The rounding of a sum of five products of three terms each, with the centre in the last of them, in ε of the sum
/// of their magnitudes.
const SUM_OF_PRODUCTS: f64 = 4.5;

/// Facets that are by this many ε of the size farther than the nearest may be the nearest: more than all of the above.
const TIE: f64 = 32.0;

/// Edges that leave a plane by fewer ε of the size lie in it.
const EDGE_IN_PLANE: f64 = 16.0;

/// How far outside of its facet a projection may seem to be by rounding, as a part of the edges.
const OUTSIDE: f64 = 1e-12;

/// Heights of the edges, relative to their lengths, by which a facet of more than two edges becomes a roof of
/// parallelograms: any that are not multiples of one another.
const HEIGHTS: [f64; EDGES] = [1.0, -0.7, 0.45, 0.83, -0.37, 0.61];

/// The way out of two parallelotopes that overlap.
pub(crate) struct NearestFacet {
    /// The unit vector across the facet, out of the difference.
    pub(crate) normal: Vec3,
    /// How far it is from zero, and bounds on how far that and all others are.
    pub(crate) depth: f64,
    pub(crate) inner: f64,
    pub(crate) outer: f64,
    /// The place of zero's projection along each edge.
    weights: [f64; EDGES],
}

impl Zonotope {
    /// Whether all of it certainly lies beyond zero along a vector.
    pub(crate) fn is_beyond<V: Vector>(&self, along: V) -> bool {
        let along = array(along);
        let reach = (0..EDGES).map(|k| dot(self.edge(k), along).abs());
        dot(self.center, along) > reach.fold(0.0, |sum, reach| sum + reach)
    }

    /// The facet nearest to zero; `None` if zero is not certainly within.
    pub(crate) fn nearest_facet<V: Vector>(&self) -> Option<NearestFacet> {
        let lengths = (0..EDGES).filter(|&k| V::DIM == 3 || k != 2).map(|k| self.length(k));
        let size = lengths.fold(length(self.center), |size, length| size + length);
        let (tie, flat) = (TIE * f64::EPSILON * size, EDGE_IN_PLANE * f64::EPSILON * size);
        let mut levels = [f64::NEG_INFINITY; SPANS.len()];
        let (mut highest, mut parallel) = (f64::NEG_INFINITY, 0.0);
        for (level, &span) in levels.iter_mut().zip(spans::<V>()) {
            match self.across(span) {
                Err(change) => parallel += 2.0 * change,
                Ok((n, _)) => {
                    (_, *level) = self.level(n, span);
                    // NaN ends here too.
                    if !(*level < -tie) {
                        return None;
                    }
                    highest = highest.max(*level);
                }
            }
        }
        let near = || {
            let near = levels.iter().zip(spans::<V>()).filter(|(level, _)| **level >= highest - tie);
            near.filter_map(|(_, &span)| self.facet(span))
        };
        let nearest = near().find(|facet| facet.level >= highest)?;
        let inner =
            near().map(|facet| -facet.level - self.error(&facet, flat)).fold(f64::INFINITY, f64::min) - parallel;
        let outer = -nearest.level + self.error(&nearest, flat);
        if !(inner > 0.0 && outer.is_finite()) {
            return None;
        }
        let (mut normal, (mut weights, mut outside)) = (nearest.normal, self.foot_on_polygon::<V>(&nearest, flat));
        if outside > OUTSIDE {
            // Another one is as near to rounding, and has the projection.
            for facet in near() {
                let (found, by) = self.foot_on_polygon::<V>(&facet, flat);
                if by < outside {
                    (normal, weights, outside) = (facet.normal, found, by);
                }
            }
        }
        let (normal, weights) = (normal.map(|x| -x), weights.map(|t| t.clamp(-1.0, 1.0)));
        Some(NearestFacet { normal, depth: -nearest.level, inner, outer, weights })
    }

    /// A bound on the error of a facet's distance. Edges that leave its plane by no more than `flat` lie in it.
    ///
    /// Let `n` be its normal and `z` a point in the middle of it. The support value of the zonotope along the true
    /// normal `n + δ` is at least that of `z`, `n·z + δ·z`, in which only the part of `z` across `n` counts: both are
    /// unit vectors.
    fn error(&self, facet: &ZonotopeFacet, flat: f64) -> f64 {
        let n = facet.normal;
        let magnitude = |v: Vec3| (n[0] * v[0]).abs() + (n[1] * v[1]).abs() + (n[2] * v[2]).abs();
        let (mut middle, mut total) = (self.center, magnitude(self.center));
        for k in (0..EDGES).filter(|k| !facet.span.contains(k)) {
            let (edge, height) = (self.edge(k), facet.heights[k]);
            let side = if height.abs() > flat { height.signum() } else { 0.0 };
            middle = core::array::from_fn(|i| middle[i] - edge[i] * side);
            total += magnitude(edge);
        }
        let along = dot(n, middle);
        let across = length(core::array::from_fn(|i| middle[i] - n[i] * along));
        f64::EPSILON * (SUM_OF_PRODUCTS * total + STRETCH * facet.level.abs() + NORMAL_TURNED * across)
    }

    /// The place of zero's foot along each edge, on a facet in whose plane others than the two edges that span it may
    /// lie; and how far the foot seems to be outside of the facet, as a part of the edges.
    ///
    /// If others do, the facet is no parallelogram. Lifted to heights `wₖ`, its lower side becomes a roof of
    /// parallelograms: that of the edges `p`, `q` is below `φ·x`, with `φ·e_p = w_p` and `φ·e_q = w_q`, and there every
    /// other edge leads to where it is lower, the sign of `φ·eₖ − wₖ`. One of them has the foot.
    fn foot_on_polygon<V: Vector>(&self, facet: &ZonotopeFacet, flat: f64) -> ([f64; EDGES], f64) {
        let outside = |[p, q]: [f64; 2]| p.abs().max(q.abs()) - 1.0;
        let mut weights = facet.heights.map(|height| -height.signum());
        let (mut plane, mut count) = ([0; EDGES], 0);
        for (k, weight) in weights.iter_mut().enumerate() {
            // Edges whose length does not count, as those of a point, span nothing.
            if facet.span.contains(&k) || facet.heights[k].abs() <= flat && self.squared[k] > 0.0 {
                (plane[count], *weight) = (k, 0.0);
                count += 1;
            }
        }
        let plane = &plane[..count];
        let (first, length) = (self.edge(facet.span[0]), self.length(facet.span[0]));
        let x = first.map(|c| c / length);
        let y = cross(&facet.normal, &x);
        let coordinates = |v: Vec3| [dot(v, x), dot(v, y)];
        let rest = coordinates(self.rest(facet, &weights));
        let edge = |k: usize| coordinates(self.edge(k));
        if V::DIM == 2 {
            // All lie along the facet, and share the way.
            let part = rest[0] / plane.iter().map(|&k| edge(k)[0].abs()).sum::<f64>();
            plane.iter().for_each(|&k| weights[k] = part * edge(k)[0].signum());
            return (weights, part.abs() - 1.0);
        }
        let mut best = (weights, f64::INFINITY);
        for (i, &p) in plane.iter().enumerate() {
            for &q in &plane[i + 1..] {
                let (e, f) = (edge(p), edge(q));
                let height = |k: usize| HEIGHTS[k] * self.length(k);
                let ([u, v], area) = ways([[e[0], f[0]], [e[1], f[1]]], [height(p), height(q)]);
                let (mut weights, mut rest) = (weights, rest);
                for &k in plane.iter().filter(|&&k| k != p && k != q) {
                    let [x, y] = edge(k);
                    weights[k] = (u * x + v * y - height(k)).signum();
                    rest = [rest[0] - x * weights[k], rest[1] - y * weights[k]];
                }
                let (found, _) = ways([e, f], rest);
                (weights[p], weights[q]) = (found[0], found[1]);
                // NaN, of edges along one another, is no foot.
                if outside(found) < best.1 && area != 0.0 {
                    best = (weights, outside(found));
                }
                if best.1 <= OUTSIDE {
                    return best;
                }
            }
        }
        best
    }
}

impl NearestFacet {
    /// The points of both parallelotopes at zero's projection, in the unit. Each is moved half of the way by which
    /// rounding keeps them apart.
    pub(crate) fn points<V: Vector>(
        &self,
        [a, b]: &[Parallelotope<V>; 2],
        offset: V,
        per_unit: V::Scalar,
    ) -> PointPair<V> {
        let along = |parallelotope: &Parallelotope<V>, weights: &[f64]| {
            let edges = parallelotope.half_edges.iter().zip(weights);
            edges.fold(V::ZERO, |sum, (&edge, &t)| sum + edge * V::Scalar::from_f64(t)) * per_unit
        };
        let from = a.center * per_unit + along(a, &self.weights[..3]);
        let to = b.center * per_unit - along(b, &self.weights[3..]);
        let end = vector::<V>(self.normal) * V::Scalar::from_f64(self.depth);
        let half = (end - (from - to + offset)) * V::Scalar::from_f64(0.5);
        PointPair { a: from + half, b: to - half }
    }

    pub(crate) fn unit<V: Vector>(&self) -> V {
        vector(self.normal)
    }
}

#[cfg(test)]
mod tests {
    use convex_support::glam::{DVec2, DVec3};

    use super::*;

    /// Half edges along the axes; in space the difference is a box then.
    fn cube(half: f64) -> Parallelotope<DVec3> {
        Parallelotope { center: DVec3::ZERO, half_edges: [DVec3::X * half, DVec3::Y * half, DVec3::Z * half] }
    }

    #[test]
    fn two_cubes_leave_one_another_through_the_nearest_face() {
        let cubes = [cube(1.0), cube(0.5)];
        let nearest = Zonotope::new(&cubes, DVec3::new(0.25, 0.0, 1.25), 1.0).nearest_facet::<DVec3>().expect("inside");
        assert_eq!((nearest.depth, nearest.unit::<DVec3>()), (0.25, DVec3::NEG_Z));
        assert!(nearest.inner <= 0.25 && 0.25 <= nearest.outer);
        let points = nearest.points(&cubes, DVec3::new(0.25, 0.0, 1.25), 1.0);
        assert_eq!(points.a - points.b + DVec3::new(0.25, 0.0, 1.25), nearest.unit::<DVec3>() * nearest.depth);
    }

    /// In contact the rounding of the facets leaves it open whether zero is inside, and the search has to tell.
    #[test]
    fn nothing_is_told_of_cubes_in_contact() {
        let cubes = [cube(1.0), cube(0.5)];
        assert!(Zonotope::new(&cubes, DVec3::Z * 1.5, 1.0).nearest_facet::<DVec3>().is_none());
        assert!(Zonotope::new(&cubes, DVec3::Z * 1.75, 1.0).is_beyond(DVec3::Z));
        assert!(!Zonotope::new(&cubes, DVec3::Z * 1.5, 1.0).is_beyond(DVec3::Z));
    }

    /// Half edges turned by 45° about z.
    fn turned(half: f64) -> Parallelotope<DVec3> {
        let side = half * 0.5_f64.sqrt();
        let half_edges = [DVec3::new(side, side, 0.0), DVec3::new(-side, side, 0.0), DVec3::Z * half];
        Parallelotope { center: DVec3::ZERO, half_edges }
    }

    /// Along x the turned cube reaches √2 and the other 1, of which the offset takes its part off.
    #[test]
    fn a_cube_on_its_edge_leaves_across_the_edge() {
        for offset in [0.5, 0.75, 1.0, 2.0] {
            let cubes = [cube(1.0), turned(1.0)];
            let nearest = Zonotope::new(&cubes, DVec3::X * offset, 1.0).nearest_facet::<DVec3>().expect("inside");
            let known = 1.0 + 2.0_f64.sqrt() - offset;
            assert!(nearest.inner <= known && known <= nearest.outer, "{known}: {} {}", nearest.inner, nearest.outer);
            assert!(nearest.outer - nearest.inner < 1e-13, "{} {}", nearest.inner, nearest.outer);
            assert!(nearest.unit::<DVec3>().distance(DVec3::NEG_X) < 1e-15);
        }
    }

    /// A face of both cubes, whose edges are along one another: of many points at zero's projection, any in both cubes
    /// will do.
    #[test]
    fn the_points_of_parallel_faces_lie_in_both_cubes() {
        for (i, j) in (-5..=5).flat_map(|i| (-5..=5).map(move |j| (f64::from(i) / 4.0, f64::from(j) / 4.0))) {
            let (cubes, offset) = ([cube(1.0), cube(0.5)], DVec3::new(i, j, -1.375));
            let nearest = Zonotope::new(&cubes, offset, 1.0).nearest_facet::<DVec3>().expect("inside");
            let points = nearest.points(&cubes, offset, 1.0);
            assert!(points.a.abs().max_element() <= 1.0 + 1e-15 && points.b.abs().max_element() <= 0.5 + 1e-15);
            let apart = points.a - points.b + offset;
            assert!(apart.distance(nearest.unit::<DVec3>() * nearest.depth) < 1e-15, "{apart}");
        }
    }

    /// The edges of a turned square are along no others, so that its facets have four edges in one plane, in pairs that
    /// cross at 45°.
    #[test]
    fn the_points_of_faces_turned_in_their_plane_lie_in_both_cubes() {
        for (i, j) in (-5..=5).flat_map(|i| (-5..=5).map(move |j| (f64::from(i) / 4.0, f64::from(j) / 4.0))) {
            let (cubes, offset) = ([cube(1.0), turned(0.5)], DVec3::new(i, j, 1.375));
            let nearest = Zonotope::new(&cubes, offset, 1.0).nearest_facet::<DVec3>();
            let Some(nearest) = nearest.filter(|nearest| nearest.unit::<DVec3>() == DVec3::NEG_Z) else { continue };
            assert!((nearest.depth - 0.125).abs() < 1e-15);
            let points = nearest.points(&cubes, offset, 1.0);
            let [x, y] = [points.b.x + points.b.y, points.b.x - points.b.y].map(|along| (along * 0.5_f64.sqrt()).abs());
            assert!(points.a.abs().max_element() <= 1.0 + 1e-15 && x.max(y).max(points.b.z.abs()) <= 0.5 + 1e-15);
            assert!((points.a - points.b + offset).distance(DVec3::NEG_Z * 0.125) < 1e-15);
        }
    }

    /// A segment has one edge, and a point none; the others have no length. The segment through (0, 0, −1/2) along
    /// (12, 0, 1) leaves across itself, over the edge at (1, −1): its line is (1 + 12 − 6)/√145 from there.
    #[test]
    fn a_segment_and_a_point_leave_a_cube_over_an_edge_and_through_a_side() {
        let none = DVec3::ZERO;
        let segment = Parallelotope { center: none, half_edges: [DVec3::new(3.0, 0.0, 0.25), none, none] };
        for (inside, known, normal) in [
            (Parallelotope::point(none), 0.5, DVec3::NEG_Z),
            (segment, 7.0 / 145.0_f64.sqrt(), DVec3::new(1.0, 0.0, -12.0).normalize()),
        ] {
            let cubes = [cube(1.0), inside];
            let nearest = Zonotope::new(&cubes, DVec3::Z * 0.5, 1.0).nearest_facet::<DVec3>().expect("inside");
            assert!(nearest.inner <= known && known <= nearest.outer && nearest.outer - nearest.inner < 1e-13);
            assert!(nearest.unit::<DVec3>().distance(normal) < 1e-15);
        }
        let segments = Zonotope::new(&[segment, segment], none, 1.0);
        assert!(segments.nearest_facet::<DVec3>().is_none(), "their difference has no inside");
    }

    /// In the plane a facet has one edge and its parallels: the unit square, and one on its corner at (0, 2 + 1/4),
    /// whose lowest corner is √2 below.
    #[test]
    fn a_square_on_its_corner_leaves_a_square_upward() {
        let square = Parallelotope { center: DVec2::ZERO, half_edges: [DVec2::X, DVec2::Y, DVec2::ZERO] };
        let side = 0.5_f64.sqrt();
        let turned = Parallelotope {
            center: DVec2::new(0.125, 2.25),
            half_edges: [DVec2::new(side, side), DVec2::new(-side, side), DVec2::ZERO],
        };
        let nearest = Zonotope::new(&[square, turned], DVec2::ZERO, 1.0).nearest_facet::<DVec2>().expect("inside");
        let known = 1.0 - (2.25 - 2.0_f64.sqrt());
        assert!(nearest.inner <= known && known <= nearest.outer && nearest.outer - nearest.inner < 1e-14);
        let points = nearest.points(&[square, turned], DVec2::ZERO, 1.0);
        assert!(points.b.distance(DVec2::new(0.125, 1.0 - known)) < 1e-14, "its lowest corner: {}", points.b);
        assert!(points.a.distance(DVec2::new(0.125, 1.0)) < 1e-14, "the point above it: {}", points.a);
    }

    /// Their edges are along one another, and one of them the other way.
    #[test]
    fn the_points_of_parallel_sides_lie_in_both_squares() {
        let square = |x: DVec2| Parallelotope { center: DVec2::ZERO, half_edges: [x, DVec2::Y, DVec2::ZERO] };
        for x in (-11..=11).map(|i| f64::from(i) / 8.0) {
            let (squares, offset) = ([square(DVec2::X), square(DVec2::NEG_X * 0.5)], DVec2::new(x, -1.875));
            let nearest = Zonotope::new(&squares, offset, 1.0).nearest_facet::<DVec2>().expect("inside");
            assert_eq!((nearest.depth, nearest.unit::<DVec2>()), (0.125, DVec2::Y));
            let points = nearest.points(&squares, offset, 1.0);
            assert!(points.a.x.abs() <= 1.0 + 1e-15 && points.b.x.abs() <= 0.5 + 1e-15, "{points:?}");
            assert!((points.a - points.b + offset).distance(nearest.unit::<DVec2>() * nearest.depth) < 1e-15);
        }
    }

    /// The bounds and the answer scale with the unit, to the bit.
    #[test]
    fn a_power_of_two_changes_no_mantissa() {
        let answer = |scale: f64| {
            let scaled = |cube: Parallelotope<DVec3>| Parallelotope {
                half_edges: cube.half_edges.map(|edge| edge * scale),
                ..cube
            };
            let cubes = [scaled(cube(0.7)), scaled(turned(1.1))];
            let offset = DVec3::new(0.3, -0.4, 0.9);
            let nearest = Zonotope::new(&cubes, offset, scale.recip()).nearest_facet::<DVec3>().expect("inside");
            (nearest.depth, nearest.inner, nearest.outer, nearest.normal)
        };
        assert_eq!(answer(1.0), answer(2.0_f64.powi(-500)));
        assert_eq!(answer(1.0), answer(2.0_f64.powi(500)));
    }

    /// The difference of two needles, given half of their edges.
    fn needles(e: Vec3, f: Vec3) -> Zonotope {
        let needle = |edge| Parallelotope {
            center: DVec3::ZERO,
            half_edges: [DVec3::from_array(edge), DVec3::ZERO, DVec3::ZERO],
        };
        Zonotope::new(&[needle(e), needle(f)], DVec3::ZERO, 1.0)
    }

    /// Edges nearly along one another, of whole coordinates up to 2⁴⁰: all products are exact as integers.
    #[test]
    fn the_product_of_nearly_parallel_edges_has_all_its_digits() {
        let big = 1_i64 << 40;
        for (a, b) in [([big + 1, big, 3], [big, big - 1, 7]), ([big - 5, 11, big], [big - 7, 13, big + 2])] {
            let [e, f] = [a, b].map(|edge| edge.map(|x| x as f64));
            let minor = |i: usize, j: usize| i128::from(a[i]) * i128::from(b[j]) - i128::from(a[j]) * i128::from(b[i]);
            let known = [minor(1, 2), minor(2, 0), minor(0, 1)].map(|x| x as f64);
            assert_eq!(exact_cross(&e, &f), known);
            let Some(ZonotopeFacet { normal, area, .. }) = needles(e, f).facet([0, 3]) else {
                panic!("they span a plane")
            };
            let off = |i: usize| (normal[i] * length(known).copysign(area) - known[i]).abs();
            assert!((0..3).all(|i| off(i) <= 4.0 * f64::EPSILON * length(known)));
        }
        let edge = [1.0, 2.0, 3.0];
        assert!(matches!(needles(edge, edge.map(|x| 4.0 * x)).across([0, 3]), Err(0.0)));
    }
}
