//! The start: finite coordinates, the rank of the points, a frame in which they are of unit size, and a few extreme points.
//!
//! # References
//! P. Kumar, E. A. Yıldırım, *Minimum-volume enclosing ellipsoids and core sets*, J. Optim. Theory Appl. 126 (2005):
//! extreme points along directions orthogonal to those already found are a start within a constant factor of the optimum,
//! and a direction without spread is a normal of the affine hull.

use std::ops::Range;

use crate::dimension::{Dimension, LANES};
use crate::error::EnclosingError;
use crate::frame::Frame;
use crate::linalg::dot;
use crate::parallel::map_ranges;
use crate::points::Points;

/// A spread of this many [`f64::EPSILON`] of the coordinates is rounding of the points, not thickness.
const ROUNDING_FLOOR: f64 = 32.0;

/// Sets of at most this many points are their own start.
const SMALL_SET: usize = 16;

/// Where every method begins.
pub(crate) struct Start {
    /// Coordinates in which the affine hull of the points has unit size along every axis.
    pub(crate) frame: Frame,
    /// Points whose affine hull is that of all points, without repetition.
    pub(crate) working: Vec<usize>,
    /// Their weights, if an earlier answer supplies them; equal ones otherwise.
    pub(crate) weights: Option<Vec<f64>>,
    /// Passes over all points so far.
    pub(crate) scans: usize,
}

/// The bounding box of the points: extreme coordinates and who attains them.
#[derive(Clone, Debug)]
struct Bounds<V> {
    low: V,
    high: V,
    argmin: Vec<usize>,
    argmax: Vec<usize>,
}

impl<V: AsRef<[f64]> + AsMut<[f64]>> Bounds<V> {
    fn include(&mut self, index: usize, v: &[f64]) -> Result<(), EnclosingError> {
        for (k, &x) in v.iter().enumerate() {
            if !x.is_finite() {
                return Err(EnclosingError::NonFinite { index, coordinate: k, value: x });
            }
            if x < self.low.as_ref()[k] {
                self.low.as_mut()[k] = x;
                self.argmin[k] = index;
            }
            if x > self.high.as_ref()[k] {
                self.high.as_mut()[k] = x;
                self.argmax[k] = index;
            }
        }
        Ok(())
    }
}

fn bounds<P: Points>(points: &P) -> Result<Bounds<<P::Dim as Dimension>::Point>, EnclosingError> {
    let n = points.dim().get();
    if points.len() == 0 || n == 0 {
        return Err(EnclosingError::Empty);
    }
    let mut parts = map_ranges(points.len(), |range| bounds_of(points, range)).into_iter();
    let mut all = parts.next().unwrap_or(Err(EnclosingError::Empty))?;
    for part in parts {
        let part = part?;
        for k in 0..n {
            if part.low.as_ref()[k] < all.low.as_ref()[k] {
                all.low.as_mut()[k] = part.low.as_ref()[k];
                all.argmin[k] = part.argmin[k];
            }
            if part.high.as_ref()[k] > all.high.as_ref()[k] {
                all.high.as_mut()[k] = part.high.as_ref()[k];
                all.argmax[k] = part.argmax[k];
            }
        }
    }
    Ok(all)
}

fn bounds_of<P: Points>(
    points: &P,
    range: Range<usize>,
) -> Result<Bounds<<P::Dim as Dimension>::Point>, EnclosingError> {
    let dim = points.dim();
    let n = dim.get();
    let mut v = dim.zero();
    points.read(range.start, v.as_mut());
    let (argmin, argmax) = (vec![range.start; n], vec![range.start; n]);
    let mut b = Bounds { low: v.clone(), high: v.clone(), argmin, argmax };
    let mut block = dim.zero_block();
    let mut at = range.start;
    while at < range.end {
        for lane in 0..LANES {
            points.read((at + lane).min(range.end - 1), v.as_mut());
            for k in 0..n {
                block.as_mut()[k][lane] = v.as_ref()[k];
            }
        }
        // Few blocks hold a new extreme, and a look at the lanes together tells which. x·0 is 0 unless x is NaN or infinite.
        let (low, high) = (b.low.as_ref(), b.high.as_ref());
        let mut extreme = false;
        let mut finite = [0.0; LANES];
        for k in 0..n {
            let x = &block.as_ref()[k];
            for lane in 0..LANES {
                extreme |= (x[lane] < low[k]) | (x[lane] > high[k]);
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

/// The power of two that brings `extent` near one, so that scaling by it is exact.
pub(crate) fn power_of_two_inverse(extent: f64) -> f64 {
    if extent == 0.0 {
        return 1.0;
    }
    // Exponents are kept to where the power and its inverse are normal numbers.
    let exponent = ((extent.to_bits() >> 52) as i64 - 1023).clamp(-1000, 1000);
    f64::from_bits(((1023 - exponent) as u64) << 52)
}

/// Finds the rank of the points, a frame, and a starting working set.
///
/// Pass 1 takes the bounding box. Coordinates are scaled by powers of two so that its sides are near one: axes of
/// wildly different units are then alike. If the extreme points along the axes span the space well, they are the start.
/// Otherwise each further pass takes the extreme points along a direction d orthogonal to the differences b found so
/// far and to the normals found so far: their difference is a new b, or, where the spread is no more than rounding (or
/// the tolerance asked for), d is a normal of the affine hull.
pub(crate) fn start<P: Points>(points: &P, flat_tolerance: f64) -> Result<Start, EnclosingError> {
    let dim = points.dim();
    let n = dim.get();
    let b = bounds(points)?;
    let (low, high) = (b.low.as_ref(), b.high.as_ref());
    // Halves first: the extent of finite coordinates may overflow.
    let half_extent: Vec<f64> = (0..n).map(|k| 0.5 * high[k] - 0.5 * low[k]).collect();
    let scale: Vec<f64> = half_extent.iter().map(|&e| 0.5 * power_of_two_inverse(e)).collect();
    let center: Vec<f64> = (0..n).map(|k| 0.5 * low[k] + 0.5 * high[k]).collect();
    let magnitude: Vec<f64> = (0..n).map(|k| low[k].abs().max(high[k].abs())).collect();

    // Spreads below this along the unit vector d of scaled coordinates are not thickness.
    let flat_below = |d: &[f64]| {
        let rounding: f64 = (0..n).map(|k| d[k].abs() * (magnitude[k] * scale[k])).sum();
        let extent: f64 = (0..n).map(|k| d[k].abs() * (2.0 * half_extent[k] * scale[k])).sum();
        (ROUNDING_FLOOR * f64::EPSILON * rounding).max(flat_tolerance * extent)
    };
    let scaled = |index: usize| {
        let mut v = dim.zero();
        points.read(index, v.as_mut());
        for k in 0..n {
            v.as_mut()[k] = (v.as_ref()[k] - center[k]) * scale[k];
        }
        v
    };

    let mut working: Vec<usize> = (0..n).flat_map(|k| [b.argmin[k], b.argmax[k]]).collect();
    let differences: Vec<_> = (0..n)
        .map(|k| {
            let (mut high, low) = (scaled(b.argmax[k]), scaled(b.argmin[k]));
            high.as_mut().iter_mut().zip(low.as_ref()).for_each(|(h, l)| *h -= l);
            high
        })
        .collect();
    let mut scans = 1;
    let mut basis = well_spread_basis(n, &differences, 0.1);
    if basis.rank() < n {
        basis = Basis::new(n);
        let mut normals = Basis::new(n);
        while basis.rank() + normals.rank() < n {
            let d = furthest_axis(n, &basis, &normals);
            scans += 1;
            let (lowest, highest) = extremes(points, &d, &center, &scale);
            let mut z = scaled(highest);
            let lowest_scaled = scaled(lowest);
            z.as_mut().iter_mut().zip(lowest_scaled.as_ref()).for_each(|(h, l)| *h -= l);
            if !(dot(z.as_ref(), &d) > flat_below(&d)) {
                normals.push(d, 0.0);
                continue;
            }
            working.extend([lowest, highest]);
            let mut z = z.as_ref().to_vec();
            normals.project_out(&mut z);
            basis.project_out(&mut z);
            let spread = dot(&z, &z).sqrt();
            z.iter_mut().for_each(|x| *x /= spread);
            basis.push(z, spread);
        }
    }
    if points.len() <= SMALL_SET {
        working = (0..points.len()).collect();
    }
    working.sort_unstable();
    working.dedup();

    let frame = if basis.rank() == n {
        let map = basis.rows().flat_map(|(b, spread)| b.iter().zip(&scale).map(move |(x, s)| x * s / spread)).collect();
        Frame { origin: center, map }
    } else {
        hull_frame(points, &basis, center, &scale, &working)
    };
    if frame.map.iter().all(|x| x.is_finite()) && frame.origin.iter().all(|x| x.is_finite()) {
        Ok(Start { frame, working, weights: None, scans })
    } else {
        Err(EnclosingError::OutOfRange)
    }
}

/// Orthonormal vectors, each with the spread of the points along it.
struct Basis {
    n: usize,
    vectors: Vec<f64>,
    spreads: Vec<f64>,
}

impl Basis {
    fn new(n: usize) -> Self {
        Self { n, vectors: Vec::with_capacity(n * n), spreads: Vec::with_capacity(n) }
    }

    fn rank(&self) -> usize {
        self.spreads.len()
    }

    fn push(&mut self, vector: Vec<f64>, spread: f64) {
        self.vectors.extend(vector);
        self.spreads.push(spread);
    }

    fn rows(&self) -> impl Iterator<Item = (&[f64], f64)> {
        self.vectors.chunks_exact(self.n).zip(self.spreads.iter().copied())
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
}

/// Gram–Schmidt with pivoting over `vectors`: stops where no residual exceeds `threshold`.
fn well_spread_basis(n: usize, vectors: &[impl AsRef<[f64]>], threshold: f64) -> Basis {
    let mut basis = Basis::new(n);
    let mut left: Vec<Vec<f64>> = vectors.iter().map(|v| v.as_ref().to_vec()).collect();
    while !left.is_empty() {
        left.iter_mut().for_each(|z| basis.project_out(z));
        let lengths: Vec<f64> = left.iter().map(|z| dot(z, z).sqrt()).collect();
        let longest = (0..left.len()).fold(0, |best, i| if lengths[i] > lengths[best] { i } else { best });
        let spread = lengths[longest];
        if !(spread > threshold) {
            break;
        }
        let mut z = left.swap_remove(longest);
        z.iter_mut().for_each(|x| *x /= spread);
        basis.push(z, spread);
    }
    basis
}

/// The unit vector orthogonal to both bases that is nearest to a coordinate axis.
fn furthest_axis(n: usize, basis: &Basis, normals: &Basis) -> Vec<f64> {
    let mut best = (vec![0.0; n], -1.0);
    for k in 0..n {
        let mut d = vec![0.0; n];
        d[k] = 1.0;
        basis.project_out(&mut d);
        normals.project_out(&mut d);
        let length = dot(&d, &d).sqrt();
        if length > best.1 {
            best = (d, length);
        }
    }
    let (mut d, length) = best;
    d.iter_mut().for_each(|x| *x /= length);
    // Normalising a short residual magnifies what was left of the bases.
    basis.project_out(&mut d);
    normals.project_out(&mut d);
    d
}

/// The points of least and greatest d·(v − center)·scale.
fn extremes<P: Points>(points: &P, d: &[f64], center: &[f64], scale: &[f64]) -> (usize, usize) {
    let dim = points.dim();
    let n = dim.get();
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
fn hull_frame<P: Points>(points: &P, basis: &Basis, center: Vec<f64>, scale: &[f64], working: &[usize]) -> Frame {
    let dim = points.dim();
    let n = dim.get();
    let mut v = dim.zero();
    // The hull is through the points, while the centre of the bounding box need not lie in it exactly: start at a point.
    points.read(working[0], v.as_mut());
    let origin = if basis.rank() == 0 { v.as_ref().to_vec() } else { center };
    let directions: Vec<Vec<f64>> =
        basis.rows().map(|(b, spread)| b.iter().zip(scale).map(|(x, s)| x * spread / s).collect()).collect();
    let orthonormal = well_spread_basis(n, &directions, 0.0);
    let mut map = Vec::with_capacity(basis.rank() * n);
    for (b, _) in orthonormal.rows() {
        let mut spread: f64 = 0.0;
        for &index in working {
            points.read(index, v.as_mut());
            let along: f64 = (0..n).map(|k| b[k] * (v.as_ref()[k] - origin[k])).sum();
            spread = spread.max(along.abs());
        }
        map.extend(b.iter().map(|x| x / spread));
    }
    Frame { origin, map }
}
