//! The start: finite coordinates, the rank of the points, a frame in which they are of unit size, and a few extreme
//! points.
//!
//! # References
//! P. Kumar, E. A. Yıldırım, *Minimum-volume enclosing ellipsoids and core sets*, J. Optim. Theory Appl. 126 (2005):
//! extreme points along directions orthogonal to those already found are a start within a constant factor of the
//! optimum, and a direction without spread is a normal of the affine hull.

use std::ops::Range;

use crate::enclosing::frame::Frame;
use crate::error::EnclosingError;
use crate::numerics::dimension::{Dimension, Dynamic, LANES};
use crate::numerics::linalg::{dot, power_of_two_inverse};
use crate::points::Points;
use crate::points::parallel::in_parts;
use crate::shape::Shape;

/// A spread of this many [`f64::EPSILON`] of the coordinates is rounding of the points, not thickness.
const ROUNDING_FLOOR: f64 = 32.0;

/// Sets of at most this many points are their own start.
const SMALL_SET: usize = 16;

/// The start of every method.
pub(crate) struct Start<N: Dimension> {
    /// Coordinates in which the affine hull of the points has unit size along every axis.
    pub(crate) frame: Frame<N>,
    /// Points whose affine hull is that of all points, without repetition.
    pub(crate) working: Vec<usize>,
    /// Their weights, if an earlier answer supplies them; equal ones otherwise.
    pub(crate) weights: Option<Vec<f64>>,
    /// Passes over all points so far.
    pub(crate) scans: usize,
}

impl<N: Dimension> Start<N> {
    /// The same with a dimension known only at run time.
    pub(crate) fn at_run_time(self) -> Start<Dynamic> {
        let Self { frame, working, weights, scans } = self;
        Start { frame: frame.at_run_time(), working, weights, scans }
    }
}

/// The bounding box of the points: extreme coordinates and the points that attain them.
struct Bounds<N: Dimension> {
    low: N::Point,
    high: N::Point,
    argmin: N::Indices,
    argmax: N::Indices,
}

impl<N: Dimension> Bounds<N> {
    fn include(&mut self, index: usize, v: &[f64]) -> Result<(), EnclosingError> {
        for (k, &x) in v.iter().enumerate() {
            if !x.is_finite() {
                return Err(EnclosingError::NonFinite { index, coordinate: k, value: x });
            }
            if x < self.low.as_ref()[k] {
                self.low.as_mut()[k] = x;
                self.argmin.as_mut()[k] = index;
            }
            if x > self.high.as_ref()[k] {
                self.high.as_mut()[k] = x;
                self.argmax.as_mut()[k] = index;
            }
        }
        Ok(())
    }
}

fn bounds<P: Points>(points: &P) -> Result<Bounds<P::Dim>, EnclosingError> {
    let n = points.dim().get();
    if points.len() == 0 || n == 0 {
        return Err(EnclosingError::Empty);
    }
    in_parts(
        points.len(),
        |range| bounds_of(points, range),
        |all, part| {
            let (mut all, part) = (all?, part?);
            for k in 0..n {
                if part.low.as_ref()[k] < all.low.as_ref()[k] {
                    all.low.as_mut()[k] = part.low.as_ref()[k];
                    all.argmin.as_mut()[k] = part.argmin.as_ref()[k];
                }
                if part.high.as_ref()[k] > all.high.as_ref()[k] {
                    all.high.as_mut()[k] = part.high.as_ref()[k];
                    all.argmax.as_mut()[k] = part.argmax.as_ref()[k];
                }
            }
            Ok(all)
        },
    )
}

fn bounds_of<P: Points>(points: &P, range: Range<usize>) -> Result<Bounds<P::Dim>, EnclosingError> {
    let dim = points.dim();
    let n = dim.get();
    let mut v = dim.zero();
    points.read(range.start, v.as_mut());
    let (argmin, argmax) = (dim.indices(range.start), dim.indices(range.start));
    let mut b: Bounds<P::Dim> = Bounds { low: v.clone(), high: v.clone(), argmin, argmax };
    let mut block = dim.zero_block();
    let mut at = range.start;
    while at < range.end {
        points.read_block(at, range.end, v.as_mut(), &mut block.as_mut()[..n]);
        // Few blocks contain a new extreme, and testing the lanes together finds them. x·0 is 0 unless x is NaN or
        // infinite.
        let (low, high) = (b.low.as_ref(), b.high.as_ref());
        let mut extreme = false;
        let mut finite = [0.0; LANES];
        for k in 0..n {
            let x = &block.as_ref()[k];
            let least = x.iter().fold(x[0], |m, &x| if x < m { x } else { m });
            let most = x.iter().fold(x[0], |m, &x| if x > m { x } else { m });
            extreme |= (least < low[k]) | (most > high[k]);
            for lane in 0..LANES {
                finite[lane] += x[lane] * 0.0;
            }
        }
        if extreme || finite.iter().any(|z| *z != 0.0) {
            for index in at..(at + LANES).min(range.end) {
                points.read(index, v.as_mut());
                b.include(index, v.as_ref())?;
            }
        }
        at += LANES;
    }
    Ok(b)
}

/// Finds the rank of the points, a frame, and a starting working set.
///
/// Pass 1 takes the bounding box. Coordinates are scaled by powers of two so that its sides are near one: axes of very
/// different units are then alike. If the extreme points along the axes span the space well, they are the start.
/// Otherwise each further pass takes the extreme points along a direction d orthogonal to the differences b and the
/// normals found so far. Their difference is a new b, or, if the spread is no more than rounding (or the given
/// tolerance), d is a normal of the affine hull.
pub(crate) fn start<P: Points>(points: &P, flat_tolerance: f64) -> Result<Start<P::Dim>, EnclosingError> {
    let dim = points.dim();
    let n = dim.get();
    let bounds = bounds(points)?;
    let (low, high) = (&bounds.low.as_ref()[..n], &bounds.high.as_ref()[..n]);
    // Halves first: the extent of finite coordinates may overflow.
    let half_extent = dim.point((0..n).map(|k| 0.5 * high[k] - 0.5 * low[k]));
    let half_extent = &half_extent.as_ref()[..n];
    let unit = Units {
        center: dim.point((0..n).map(|k| 0.5 * low[k] + 0.5 * high[k])),
        scale: dim.point(half_extent.iter().map(|&e| 0.5 * power_of_two_inverse(e))),
    };

    let mut working = Vec::with_capacity(if points.len() <= SMALL_SET { points.len() } else { 4 * n });
    working.extend(bounds.argmin.as_ref().iter().zip(bounds.argmax.as_ref()).flat_map(|(low, high)| [*low, *high]));
    let mut basis = Basis::new(dim);
    basis.extend_well_spread(&mut working.chunks_exact(2).map(|ends| unit.difference(points, ends[0], ends[1])), 0.1);
    let mut scans = 1;
    if basis.rank < n {
        // Spreads below this along the unit vector d of scaled coordinates are not thickness.
        let flat_below = |d: &[f64]| {
            let (mut rounding, mut extent) = (0.0, 0.0);
            for k in 0..n {
                let scaled = d[k].abs() * unit.scale.as_ref()[k];
                rounding += scaled * low[k].abs().max(high[k].abs());
                extent += scaled * (2.0 * half_extent[k]);
            }
            (ROUNDING_FLOOR * f64::EPSILON * rounding).max(flat_tolerance * extent)
        };
        basis = Basis::new(dim);
        let mut normals = Basis::new(dim);
        // If the differences are one fewer than the points, every direction orthogonal to them is a normal.
        while basis.rank + normals.rank < n && basis.rank + 1 < points.len() {
            let d = furthest_axis(dim, &basis, &normals);
            scans += 1;
            let (lowest, highest) = extremes(points, d.as_ref(), &unit);
            let mut z = unit.difference(points, lowest, highest);
            if !(dot(z.as_ref(), d.as_ref()) > flat_below(d.as_ref())) {
                normals.push(&d, 1.0, 0.0);
                continue;
            }
            working.extend([lowest, highest]);
            normals.project_out(z.as_mut());
            basis.project_out(z.as_mut());
            let spread = dot(z.as_ref(), z.as_ref()).sqrt();
            basis.push(&z, spread, spread);
        }
    }
    if points.len() <= SMALL_SET {
        working.clear();
        working.extend(0..points.len());
    } else {
        working.sort_unstable();
        working.dedup();
    }
    let frame = if basis.rank == n { unit.frame(dim, &basis) } else { hull_frame(points, &basis, unit, &working) };
    if frame.is_finite() { Ok(Start { frame, working, weights: None, scans }) } else { Err(EnclosingError::OutOfRange) }
}

/// Whether [`start`] finds the full rank of any points with weights that prove this ellipsoid nearly optimal.
///
/// With weights of scatter S the points spread along any d by 2√(dᵀSd) at least, and the ellipsoid's half-extent is
/// √(κ·dᵀSd), κ ≈ N. The spread below which d is a normal is a sum Σ|dₖ|Wₖ ≤ |diag(a)·R·d|·ΣWₖ|diag(1/a)·R·eₖ|. So
/// ΣWₖ|diag(1/a)·R·eₖ| < 2/√κ is enough; half of 2/N is required.
pub(crate) fn surely_spans<N: Dimension>(shape: &Shape<N>, flat_tolerance: f64) -> bool {
    let (center, axes, semi_axes) = (shape.center.as_ref(), shape.axes.as_ref(), shape.semi_axes.as_ref());
    let n = center.len();
    let column = |k: usize, of: &dyn Fn(f64, f64) -> f64| {
        axes.chunks_exact(n).zip(semi_axes).map(|(axis, a)| of(axis[k], *a)).map(|x| x * x).sum::<f64>().sqrt()
    };
    let share = |k: usize| {
        let half_extent = column(k, &|x, a| x * a);
        let rounding = ROUNDING_FLOOR * f64::EPSILON * (center[k].abs() + half_extent);
        rounding.max(flat_tolerance * 2.0 * half_extent) * column(k, &|x, a| x / a)
    };
    n as f64 * (0..n).map(share).sum::<f64>() <= 1.0
}

/// Coordinates (v − center)·scale in which the bounding box is about the origin, its sides near one.
struct Units<N: Dimension> {
    center: N::Point,
    /// Powers of two.
    scale: N::Point,
}

impl<N: Dimension> Units<N> {
    /// Point `to` minus point `from`, in these coordinates.
    fn difference<P: Points<Dim = N>>(&self, points: &P, from: usize, to: usize) -> N::Point {
        let dim = points.dim();
        let (mut a, mut b) = (dim.zero(), dim.zero());
        points.read(from, a.as_mut());
        points.read(to, b.as_mut());
        let (center, scale) = (self.center.as_ref(), self.scale.as_ref());
        let (a, to) = (a.as_ref(), b.as_mut());
        for k in 0..dim.get() {
            to[k] = (to[k] - center[k]) * scale[k] - (a[k] - center[k]) * scale[k];
        }
        b
    }

    /// The frame whose rows are those of the basis divided by its spreads.
    fn frame(self, dim: N, basis: &Basis<N>) -> Frame<N> {
        let scale = self.scale.as_ref();
        let rows = basis.rows().flat_map(|(b, spread)| b.iter().zip(scale).map(move |(x, s)| x * s / spread));
        Frame::new(self.center, dim.matrix(rows), basis.rank)
    }
}

/// Orthonormal vectors, each with the spread of the points along it.
struct Basis<N: Dimension> {
    dim: N,
    rank: usize,
    vectors: N::Matrix,
    spreads: N::Point,
}

impl<N: Dimension> Basis<N> {
    fn new(dim: N) -> Self {
        Self { dim, rank: 0, vectors: dim.zero_matrix(), spreads: dim.zero() }
    }

    /// Adds z/length with its spread.
    fn push(&mut self, z: &N::Point, length: f64, spread: f64) {
        let n = self.dim.get();
        let row = &mut self.vectors.as_mut()[self.rank * n..(self.rank + 1) * n];
        row.iter_mut().zip(z.as_ref()).for_each(|(to, x)| *to = x / length);
        self.spreads.as_mut()[self.rank] = spread;
        self.rank += 1;
    }

    fn rows(&self) -> impl Iterator<Item = (&[f64], f64)> {
        let n = self.dim.get();
        self.vectors.as_ref().chunks_exact(n).zip(self.spreads.as_ref().iter().copied()).take(self.rank)
    }

    /// Removes from `z` its components along the basis; twice, which is enough for orthogonality to rounding.
    fn project_out(&self, z: &mut [f64]) {
        for _ in 0..2 {
            for (b, _) in self.rows() {
                let along = dot(b, z);
                z.iter_mut().zip(b).for_each(|(x, y)| *x -= along * y);
            }
        }
    }

    /// Gram–Schmidt with pivoting over `vectors`, at most as many as there are dimensions: stops when no residual
    /// exceeds `threshold`.
    fn extend_well_spread(&mut self, vectors: &mut dyn Iterator<Item = N::Point>, threshold: f64) {
        let n = self.dim.get();
        let mut residuals = self.dim.zero_matrix();
        let left = &mut residuals.as_mut()[..n * n];
        let mut count = 0;
        for (row, vector) in left.chunks_exact_mut(n).zip(vectors) {
            row.copy_from_slice(vector.as_ref());
            count += 1;
        }
        let left = &mut left[..count * n];
        debug_assert_eq!(self.rank, 0, "the vectors are made orthogonal to the last one of the basis only");
        while self.rank < count {
            let mut longest = (0, 0.0);
            for (i, z) in left.chunks_exact_mut(n).enumerate() {
                // It is already orthogonal to the others.
                if let Some((b, _)) = self.rows().last() {
                    let along = dot(b, z);
                    z.iter_mut().zip(b).for_each(|(x, y)| *x -= along * y);
                }
                let square = dot(z, z);
                if square > longest.1 {
                    longest = (i, square);
                }
            }
            let z = &mut left[longest.0 * n..(longest.0 + 1) * n];
            self.project_out(z);
            let spread = dot(z, z).sqrt();
            if !(spread > threshold) {
                break;
            }
            let vector = self.dim.point(z.iter().copied());
            z.fill(0.0);
            self.push(&vector, spread, spread);
        }
    }
}

/// The unit vector orthogonal to both bases that is nearest to a coordinate axis.
fn furthest_axis<N: Dimension>(dim: N, basis: &Basis<N>, normals: &Basis<N>) -> N::Point {
    // The rest of axis k has the squared length 1 − Σbₖ², over the vectors b of both.
    let mut within = dim.zero();
    for (b, _) in basis.rows().chain(normals.rows()) {
        within.as_mut().iter_mut().zip(b).for_each(|(sum, x)| *sum += x * x);
    }
    let within = within.as_ref();
    let axis = (1..dim.get()).fold(0, |least, k| if within[k] < within[least] { k } else { least });
    let mut d = dim.zero();
    d.as_mut()[axis] = 1.0;
    // Twice, because normalising a short residual magnifies the rest along the bases.
    for _ in 0..2 {
        basis.project_out(d.as_mut());
        normals.project_out(d.as_mut());
        let length = dot(d.as_ref(), d.as_ref()).sqrt();
        d.as_mut().iter_mut().for_each(|x| *x /= length);
    }
    d
}

/// The points of least and greatest d·(v − center)·scale.
fn extremes<P: Points>(points: &P, d: &[f64], unit: &Units<P::Dim>) -> (usize, usize) {
    let dim = points.dim();
    let n = dim.get();
    let (center, scale) = (&unit.center.as_ref()[..n], &unit.scale.as_ref()[..n]);
    let mut v = dim.zero();
    let (mut lowest, mut highest) = ((0, f64::INFINITY), (0, f64::NEG_INFINITY));
    for index in 0..points.len() {
        points.read(index, v.as_mut());
        let v = v.as_ref();
        let along: f64 = (0..n).map(|k| d[k] * ((v[k] - center[k]) * scale[k])).sum();
        if along < lowest.1 {
            lowest = (index, along);
        }
        if along > highest.1 {
            highest = (index, along);
        }
    }
    (lowest.0, highest.0)
}

/// The frame of a flat set: orthonormal directions of its affine hull in the original coordinates, each divided by the
/// spread of the working points along it.
fn hull_frame<P: Points>(points: &P, basis: &Basis<P::Dim>, unit: Units<P::Dim>, working: &[usize]) -> Frame<P::Dim> {
    let dim = points.dim();
    let n = dim.get();
    let mut v = dim.zero();
    let mut orthonormal = Basis::new(dim);
    let scale = unit.scale.as_ref();
    let directions = |(b, spread): (&[f64], f64)| dim.point(b.iter().zip(scale).map(|(x, s)| x * spread / s));
    orthonormal.extend_well_spread(&mut basis.rows().map(directions), 0.0);
    // The hull contains the points, but not exactly the centre of the bounding box: start at a point.
    let mut origin = unit.center;
    if basis.rank == 0 {
        points.read(working[0], origin.as_mut());
    }
    let mut map = dim.zero_matrix();
    for (row, (b, _)) in map.as_mut().chunks_exact_mut(n).zip(orthonormal.rows()) {
        let mut spread: f64 = 0.0;
        for &index in working {
            points.read(index, v.as_mut());
            let along: f64 = (0..n).map(|k| b[k] * (v.as_ref()[k] - origin.as_ref()[k])).sum();
            spread = spread.max(along.abs());
        }
        row.iter_mut().zip(b).for_each(|(to, x)| *to = x / spread);
    }
    Frame::new(origin, map, orthonormal.rank)
}
