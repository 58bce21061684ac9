//! The depth of overlapping boxes, parallelograms and segments, in closed form.

use convex_support::numerics::twofold::two_product;
use convex_support::{Core, CoreKind, Parallelotope, Scalar, SupportMap, Vector};
use num_traits::Float;

use crate::body::PointPair;
use crate::double::{LEAST, Vec3, array, cross, dot, vector};

const EDGES: usize = 6;

/// Below this squared sine of the angle between two edges their product is computed in twice the precision.
const ACUTE: f64 = 0.25;

/// Edges with a sine of the angle below this many ε count as parallel.
const PARALLEL: f64 = 8.0;

/// How much a unit normal may be turned by rounding, in ε: the product of two edges is wrong by one of the product of
/// their lengths, which is at most twice as long; the rest are its own roundings.
const TURN: f64 = 4.0;

/// How much longer or shorter than one it may be, in ε.
const STRETCH: f64 = 3.0;

/// The rounding of a sum of five products of three terms each, with the centre in the last of them, in ε of the sum
/// of their magnitudes.
const SUM: f64 = 4.5;

/// Facets that are by this many ε of the size farther than the nearest may be the nearest: more than all of the above.
const TIE: f64 = 32.0;

/// Edges that leave a plane by fewer ε of the size lie in it.
const IN_PLANE: f64 = 16.0;

/// How far outside of its facet a projection may seem to be by rounding, as a part of the edges.
const OUTSIDE: f64 = 1e-12;

/// Heights of the edges, relative to their lengths, by which a facet of more than two edges becomes a roof of
/// parallelograms: any that are not multiples of one another.
const HEIGHTS: [f64; EDGES] = [1.0, -0.7, 0.45, 0.83, -0.37, 0.61];

/// The edges that span a facet: any two in space, and one alone, named twice, in the plane.
const SPANS: [[usize; 2]; EDGES * (EDGES - 1) / 2] = {
    let mut spans = [[0; 2]; EDGES * (EDGES - 1) / 2];
    let (mut i, mut j, mut at) = (0, 1, 0);
    while at < EDGES * (EDGES - 1) / 2 {
        spans[at] = [i, j];
        at += 1;
        j += 1;
        if j == EDGES {
            i += 1;
            j = i + 1;
        }
    }
    spans
};
const SPANS_OF_PLANE: [[usize; 2]; EDGES] = [[0; 2], [1; 2], [2; 2], [3; 2], [4; 2], [5; 2]];

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

/// The difference of two parallelotopes: `center + Σ tₖ·edgesₖ` with all `|tₖ| ≤ 1`, the edges of the first and then of
/// the second.
///
/// It is a zonotope, and each of its facets is spanned by two edges, in 2D by one: the axes of the separating axis
/// test. All other edges lead to the facet from the centre, so that its distance from there is `Σ |n·eₖ|`. Everything
/// is computed in double precision, and in the unit of the cores, so that it adds nothing to the rounding of `f32`
/// before.
pub(super) struct Zonotope {
    center: Vec3,
    edges: [Vec3; EDGES],
    /// The squared lengths of the edges, and their coordinates: all first ones, all second ones, all third ones.
    squared: [f64; EDGES],
    coordinates: [[f64; EDGES]; 3],
    /// A bound on its lengths.
    size: f64,
}

pub(super) struct NearestFacet {
    pub(super) normal: Vec3,
    /// How far it is from zero, and bounds on how far that and all others are.
    pub(super) depth: f64,
    pub(super) inner: f64,
    pub(super) outer: f64,
    /// The place of zero's projection along each edge.
    weights: [f64; EDGES],
}

/// A facet by the two edges that span it, and its distance from zero.
#[derive(Clone, Copy)]
struct ZonotopeFacet {
    edges: [usize; 2],
    normal: Vec3,
    depth: f64,
}

/// The span of two edges.
enum EdgeSpan {
    /// A facet, and its unit normal.
    ZonotopeFacet(Vec3),
    /// None: by so much one of them would have to be changed for there to be none.
    Parallel(f64),
}

/// The core of a shape as a parallelotope; a point is one without edges.
pub(super) fn parallelotope<S: SupportMap + ?Sized>(
    shape: &S,
    core: &Core<S::Vector>,
) -> Option<Parallelotope<S::Vector>> {
    match core.kind {
        CoreKind::Point(at) => Some(Parallelotope::point(at)),
        CoreKind::Segment { .. } | CoreKind::Polytope => shape.core_parallelotope(),
        CoreKind::Curved => None,
    }
}

impl Zonotope {
    /// The difference `(a − b)·per_unit + offset`.
    pub(super) fn new<V: Vector>([a, b]: &[Parallelotope<V>; 2], offset: V, per_unit: V::Scalar) -> Self {
        let center = sum(sum(array(a.center * per_unit), array(-b.center * per_unit)), array(offset));
        let edges: [Vec3; EDGES] =
            core::array::from_fn(|k| array(if k < 3 { a.half_edges[k] } else { b.half_edges[k - 3] } * per_unit));
        let squared = edges.map(|edge| dot(edge, edge));
        let coordinates = core::array::from_fn(|i| edges.map(|edge| edge[i]));
        let size = squared.iter().fold(length(center), |size, &squared| size + Float::sqrt(squared));
        Self { center, edges, squared, coordinates, size }
    }

    /// Whether all of it certainly lies beyond zero along a vector.
    pub(super) fn is_beyond<V: Vector>(&self, along: V) -> bool {
        let along = array(along);
        let reach = self.edges.iter().map(|&edge| dot(edge, along).abs());
        dot(self.center, along) > reach.fold(0.0, |sum, reach| sum + reach)
    }

    /// The facet nearest to zero; `None` if zero is not certainly within.
    pub(super) fn nearest_facet<V: Vector>(&self) -> Option<NearestFacet> {
        let spans: &[[usize; 2]] = if V::DIM == 2 { &SPANS_OF_PLANE } else { &SPANS };
        let mut depths = [f64::INFINITY; SPANS.len()];
        let tie = TIE * f64::EPSILON * self.size;
        let (mut least, mut parallel) = (f64::INFINITY, 0.0);
        for (depth, &spanned) in depths.iter_mut().zip(spans) {
            match self.span::<V>(spanned) {
                EdgeSpan::Parallel(change) => parallel += 2.0 * change,
                EdgeSpan::ZonotopeFacet(normal) => {
                    *depth = self.depth(normal, spanned);
                    // NaN ends here too.
                    if !(*depth > tie) {
                        return None;
                    }
                    least = least.min(*depth);
                }
            }
        }
        let near = || {
            let near = depths.iter().zip(spans).filter(|(depth, _)| **depth <= least + tie);
            near.filter_map(|(&depth, &spanned)| self.facet::<V>(depth, spanned))
        };
        let nearest = near().find(|facet| facet.depth <= least)?;
        let inner = near().map(|facet| facet.depth - self.error(&facet)).fold(f64::INFINITY, f64::min) - parallel;
        let outer = nearest.depth + self.error(&nearest);
        if !(inner > 0.0 && outer.is_finite()) {
            return None;
        }
        let (mut weights, mut outside) = self.foot::<V>(&nearest);
        let mut normal = nearest.normal;
        if outside > OUTSIDE {
            // Another one is as near to rounding, and has the projection.
            for facet in near() {
                let (found, by) = self.foot::<V>(&facet);
                if by < outside {
                    (normal, weights, outside) = (facet.normal, found, by);
                }
            }
        }
        Some(NearestFacet { normal, depth: nearest.depth, inner, outer, weights: weights.map(|t| t.clamp(-1.0, 1.0)) })
    }

    /// The span of two edges of the zonotope, or of one in the plane.
    #[inline(always)]
    fn span<V: Vector>(&self, [i, j]: [usize; 2]) -> EdgeSpan {
        let (edges, squared) = (&self.edges, &self.squared);
        if V::DIM == 2 { span_of_one(edges[i]) } else { span(&edges[i], &edges[j], squared[i], squared[j]) }
    }

    /// How far the facets with a normal, spanned by the given edges, are from zero: the nearer of the two.
    #[inline(always)]
    fn depth(&self, n: Vec3, [i, j]: [usize; 2]) -> f64 {
        let ([x, y, z], counts) = (&self.coordinates, &OTHERS[i][j]);
        let along = |k: usize| (n[0] * x[k] + n[1] * y[k] + n[2] * z[k]).abs() * counts[k];
        let [a, b, c, d, e, f]: [f64; EDGES] = core::array::from_fn(along);
        (a + c + e) + (b + d + f) - dot(n, self.center).abs()
    }

    /// The nearer of the two facets that are spanned by the given edges.
    fn facet<V: Vector>(&self, depth: f64, spanned: [usize; 2]) -> Option<ZonotopeFacet> {
        let EdgeSpan::ZonotopeFacet(normal) = self.span::<V>(spanned) else { return None };
        let normal = if dot(normal, self.center) > 0.0 { normal.map(|x| -x) } else { normal };
        Some(ZonotopeFacet { edges: spanned, normal, depth })
    }

    /// A bound on the error of a facet's distance.
    ///
    /// Let `n` be its normal and `z` a point in the middle of it. The support value of the zonotope along the true
    /// normal `n + δ` is at least that of `z`, `n·z + δ·z`, in which only the part of `z` across `n` counts: both are
    /// unit vectors.
    fn error(&self, facet: &ZonotopeFacet) -> f64 {
        let n = facet.normal;
        let magnitude = |v: Vec3| (n[0] * v[0]).abs() + (n[1] * v[1]).abs() + (n[2] * v[2]).abs();
        let (mut middle, mut total) = (self.center, magnitude(self.center));
        for (k, &edge) in self.edges.iter().enumerate() {
            if !facet.edges.contains(&k) {
                let height = dot(n, edge);
                let side = if height.abs() > self.flat() { height.signum() } else { 0.0 };
                middle = core::array::from_fn(|i| middle[i] + edge[i] * side);
                total += magnitude(edge);
            }
        }
        let along = dot(n, middle);
        let across = length(core::array::from_fn(|i| middle[i] - n[i] * along));
        f64::EPSILON * (SUM * total + STRETCH * facet.depth + TURN * across)
    }

    /// Edges that leave a plane by less lie in it.
    fn flat(&self) -> f64 {
        IN_PLANE * f64::EPSILON * self.size
    }

    /// The place of zero's projection on the plane of a facet along each edge; and how far it seems to be outside of
    /// the facet, as a part of the edges.
    ///
    /// Edges that do not lie in the plane lead to it all the way. If the facet is not a parallelogram, some of the
    /// others do not span it. Lifted to heights `wₖ`, its lower side becomes a roof of parallelograms: that of the
    /// edges `p`, `q` is below `φ·x`, with `φ·e_p = w_p` and `φ·e_q = w_q`, and there every other edge leads to where
    /// it is lower, the sign of `φ·eₖ − wₖ`. One of them has the projection.
    fn foot<V: Vector>(&self, facet: &ZonotopeFacet) -> ([f64; EDGES], f64) {
        let n = facet.normal;
        let flat = self.flat();
        let mut weights = [0.0; EDGES];
        let mut rest: Vec3 = core::array::from_fn(|i| n[i] * facet.depth - self.center[i]);
        let (mut plane, mut count) = ([0; EDGES], 0);
        for (k, &edge) in self.edges.iter().enumerate() {
            // Edges whose length does not count, as those of a point, span nothing and lead nowhere.
            if self.squared[k] <= 0.0 {
                continue;
            }
            let height = dot(n, edge);
            if facet.edges.contains(&k) || height.abs() <= flat {
                plane[count] = k;
                count += 1;
            } else {
                weights[k] = height.signum();
                rest = core::array::from_fn(|i| rest[i] - edge[i] * weights[k]);
            }
        }
        let plane = &plane[..count];
        let first = self.edges[facet.edges[0]];
        let x = first.map(|c| c / length(first));
        let y = cross(&n, &x);
        let seen = |v: Vec3| (dot(v, x), dot(v, y));
        if V::DIM == 2 {
            // All lie along the facet, and share the way.
            let along = |k: usize| dot(self.edges[k], x);
            let total = plane.iter().map(|&k| along(k).abs()).sum::<f64>();
            let part = dot(rest, x) / total;
            for &k in plane {
                weights[k] = part * along(k).signum();
            }
            return (weights, part.abs() - 1.0);
        }
        let (mut best, mut outside) = (weights, f64::INFINITY);
        for (i, &p) in plane.iter().enumerate() {
            for &q in &plane[i + 1..] {
                let (e, f) = (seen(self.edges[p]), seen(self.edges[q]));
                let area = e.0 * f.1 - e.1 * f.0;
                let height = |k: usize| HEIGHTS[k] * length(self.edges[k]);
                let (u, w) = (height(p), height(q));
                let slope = ((u * f.1 - w * e.1) / area, (w * e.0 - u * f.0) / area);
                let mut found = weights;
                let mut rest = seen(rest);
                for &k in plane.iter().filter(|&&k| k != p && k != q) {
                    let edge = seen(self.edges[k]);
                    found[k] = (slope.0 * edge.0 + slope.1 * edge.1 - height(k)).signum();
                    rest = (rest.0 - edge.0 * found[k], rest.1 - edge.1 * found[k]);
                }
                found[p] = (rest.0 * f.1 - rest.1 * f.0) / area;
                found[q] = (e.0 * rest.1 - e.1 * rest.0) / area;
                let by = found[p].abs().max(found[q].abs()) - 1.0;
                // NaN, of edges along one another, is no foot.
                if by < outside && area != 0.0 {
                    (best, outside) = (found, by);
                }
                if outside <= OUTSIDE {
                    return (best, outside);
                }
            }
        }
        (best, outside)
    }
}

impl NearestFacet {
    /// The points of both parallelotopes at zero's projection, in the unit. Each is moved half of the way by which
    /// rounding keeps them apart.
    pub(super) fn points<V: Vector>(
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

    pub(super) fn unit<V: Vector>(&self) -> V {
        vector(self.normal)
    }
}

/// What two edges of the given squared lengths span in space.
#[inline(always)]
fn span(e: &Vec3, f: &Vec3, le: f64, lf: f64) -> EdgeSpan {
    let product = le * lf;
    if product < LEAST {
        return EdgeSpan::Parallel(Float::sqrt(le.min(lf)));
    }
    let mut m = cross(e, f);
    let mut area = dot(m, m);
    if area < ACUTE * product {
        m = exact_cross(e, f);
        area = dot(m, m);
        let parallel = PARALLEL * f64::EPSILON;
        if area <= parallel * parallel * product {
            return EdgeSpan::Parallel(Float::sqrt(area / le.max(lf)));
        }
    }
    let per = Float::sqrt(area).recip();
    EdgeSpan::ZonotopeFacet(m.map(|x| x * per))
}

fn span_of_one(e: Vec3) -> EdgeSpan {
    let squared = dot(e, e);
    if squared < LEAST {
        return EdgeSpan::Parallel(Float::sqrt(squared));
    }
    let per = Float::sqrt(squared).recip();
    EdgeSpan::ZonotopeFacet([e[1] * per, -e[0] * per, 0.0])
}

#[inline(always)]
fn sum(a: Vec3, b: Vec3) -> Vec3 {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn length(a: Vec3) -> f64 {
    Float::sqrt(dot(a, a))
}

/// The same with every coordinate right to its last digit but one, however much of the products cancels.
#[cold]
#[inline(never)]
fn exact_cross(a: &Vec3, b: &Vec3) -> Vec3 {
    let minor = |i: usize, j: usize| {
        let [[p, lost_p], [q, lost_q]] = [two_product(a[i], b[j]), two_product(a[j], b[i])];
        (p - q) + (lost_p - lost_q)
    };
    [minor(1, 2), minor(2, 0), minor(0, 1)]
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

    /// In the plane a facet has one edge and its parallels: the unit square, and one on its corner at (0, 2 + 1/4), whose
    /// lowest corner is √2 below.
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

    /// Edges nearly along one another, of whole coordinates up to 2⁴⁰: all products are exact as integers.
    #[test]
    fn the_product_of_nearly_parallel_edges_has_all_its_digits() {
        let big = 1_i64 << 40;
        for (a, b) in [([big + 1, big, 3], [big, big - 1, 7]), ([big - 5, 11, big], [big - 7, 13, big + 2])] {
            let [e, f] = [a, b].map(|edge| edge.map(|x| x as f64));
            let minor = |i: usize, j: usize| i128::from(a[i]) * i128::from(b[j]) - i128::from(a[j]) * i128::from(b[i]);
            let known = [minor(1, 2), minor(2, 0), minor(0, 1)].map(|x| x as f64);
            assert_eq!(exact_cross(&e, &f), known);
            let EdgeSpan::ZonotopeFacet(normal) = span(&e, &f, dot(e, e), dot(f, f)) else {
                panic!("they span a plane")
            };
            assert!((0..3).all(|i| (normal[i] * length(known) - known[i]).abs() <= 4.0 * f64::EPSILON * length(known)));
        }
        let edge = [1.0, 2.0, 3.0];
        assert!(matches!(span(&edge, &edge.map(|x| 4.0 * x), 14.0, 224.0), EdgeSpan::Parallel(0.0)));
    }
}
