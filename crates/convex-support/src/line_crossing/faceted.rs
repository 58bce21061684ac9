//! Where a line is in a hull of known facets: behind all of their planes.

use core::array::from_fn;

use num_traits::Float as _;

use super::{CertainCrossing, Crossed, Crossing, NearLine, comfortable, rebased};
use crate::shapes::{PLANES, Planes, facet};
use crate::{Scalar, Vector};

/// The line is in the hull while it is behind all facets. The exit and the entry are the least and the largest of the
/// `λ` where it leaves, or enters, the half-space of a facet.
#[inline]
pub(crate) fn faceted<V: Vector>(planes: &[Planes<V::Scalar>], source: V, direction: V) -> Crossed<V> {
    let (direction, dd, unit) = comfortable(direction);
    let (base, near) = rebased(source, direction, dd.recip());
    let clipped = clip(planes, coordinates(near), coordinates(direction));
    let Clipped { entry, exit, into, .. } = clipped;
    // A line enters and leaves a bounded set; otherwise some number is NaN.
    if !(entry > -V::Scalar::infinity() && exit < V::Scalar::infinity()) {
        return Err(V::ZERO);
    }
    Crossing { entry, exit, normal: facet(planes, into).0 }.shifted(base, unit, || V::ZERO)
}

impl<V: Vector> NearLine<V> {
    /// A hull, relative to its middle, that is within the half-spaces of its facets, and contains all points that are
    /// behind their planes by more than the error.
    ///
    /// The line enters the half-space of one facet last. Before that by the error, it is outside; behind that plane by
    /// twice the error, the point of the line is tested to be behind all planes by the error.
    ///
    /// If it matters, the foot of the line is no more than 2 sizes `S` from the middle. The product of a normal with
    /// the foot loses `6uS`, that with the direction `9uS`, up to 3 sizes away, the two differences and the quotient
    /// `12uS`: with the rounding of the support values `30uS`, less than [`at_foot`](Self::at_foot) allows for. A point
    /// of the line loses `4uS`, and its product with a normal `3uS`.
    #[inline(always)]
    pub(crate) fn faceted(&self, planes: &[Planes<V::Scalar>]) -> Option<CertainCrossing<V>> {
        let line = self.at_foot();
        let Self { source, direction, error, .. } = line;
        let (known, latest) = line.cut(planes, clip(planes, coordinates(source), coordinates(direction)))?;
        let is_in = || most_beyond(planes, coordinates(source + direction * latest)) <= -error;
        (matches!(known, CertainCrossing::Misses(_)) || is_in()).then_some(known)
    }

    /// The answer by the planes that the line, from its foot, enters and leaves by. It enters if the point at the
    /// returned parameter is in the hull.
    #[inline(always)]
    pub(super) fn cut(
        &self,
        planes: &[Planes<V::Scalar>],
        clipped: Clipped<V::Scalar>,
    ) -> Option<(CertainCrossing<V>, V::Scalar)> {
        let Self { source, direction, error, .. } = *self;
        let Clipped { entry, exit, into, out_of } = clipped;
        let plane = |index: usize| {
            let (normal, reach): (V, _) = facet(planes, index);
            (normal, normal.dot(direction), reach - normal.dot(source) + error)
        };
        let (normal, falls, behind) = plane(into);
        if !(falls < V::Scalar::ZERO) {
            return None;
        }
        if entry < exit {
            let slack = error / falls;
            let (earliest, latest) = (entry + slack, entry - (slack + slack));
            return Some((self.enters([earliest, entry, latest], normal), latest));
        }
        // The line leaves one half-space before it enters the other: the plane along it through their common edge
        // separates. A plane parallel to the line has the line before it at any parameter.
        let (other, rises, behind_other) = plane(out_of);
        let is_missed = (rises >= V::Scalar::ZERO) & (behind / falls > behind_other / rises);
        is_missed.then(|| (CertainCrossing::Misses(normal * rises - other * falls), entry))
    }
}

fn coordinates<V: Vector>(v: V) -> [V::Scalar; 3] {
    [v.get(0), v.get(1), if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO }]
}

/// The stretch of a line behind all planes, and the indices of those it enters and leaves by.
pub(super) struct Clipped<S> {
    pub(super) entry: S,
    pub(super) exit: S,
    pub(super) into: usize,
    pub(super) out_of: usize,
}

/// Clips the line through a point along a direction by planes.
///
/// A line along a plane divides by zero: it is then behind it from `−∞` to `∞` or nowhere; and `0/0`, in the plane
/// itself, compares false and changes nothing. Adding zero makes a negative zero positive, so that it does not count as
/// a negative number.
#[inline(never)]
fn clip<S: Scalar>(planes: &[Planes<S>], point: [S; 3], direction: [S; 3]) -> Clipped<S> {
    match side_by_side::<S>() {
        4 => clip_by::<S, 4>(planes, point, direction),
        _ => clip_by::<S, 2>(planes, point, direction),
    }
}

/// How many planes a line is clipped by at a time: as many as a vector register of every target has room for. With
/// more of them, compilers pack the results of comparisons and unpack them again, and it takes up to twice as long.
pub(super) const fn side_by_side<S>() -> usize {
    if size_of::<S>() > 4 { 2 } else { 4 }
}

#[inline(always)]
fn clip_by<S: Scalar, const N: usize>(planes: &[Planes<S>], [x, y, z]: [S; 3], [dx, dy, dz]: [S; 3]) -> Clipped<S> {
    let (below, width) = (-S::infinity(), S::from_f64(N as f64));
    let larger = |a: S, b: S| if b > a { b } else { a };
    let mut here: [S; N] = from_fn(|l| S::from_f64(l as f64));
    // The last of the parameters at which the line enters a half-space, and at which the reversed line does; and the
    // indices of their planes.
    let (mut entries, mut into) = ([[below; N]; 2], [[S::ZERO; N]; 2]);
    for part in 0..planes.len() * (PLANES / N) {
        let ([nx, ny, nz, reach], at) = (&planes[part / (PLANES / N)], part % (PLANES / N) * N);
        let slope: [S; N] = from_fn(|l| nx[at + l] * dx + ny[at + l] * dy + nz[at + l] * dz + S::ZERO);
        let room: [S; N] = from_fn(|l| reach[at + l] - (nx[at + l] * x + ny[at + l] * y + nz[at + l] * z));
        let crossed: [S; N] = from_fn(|l| room[l] / slope[l]);
        let enters: [[S; N]; 2] = [
            from_fn(|l| if slope[l] < S::ZERO { crossed[l] } else { below }),
            from_fn(|l| if slope[l] < S::ZERO { below } else { -crossed[l] }),
        ];
        for way in 0..2 {
            for l in 0..N {
                let is_later = enters[way][l] > entries[way][l];
                into[way][l] = larger(into[way][l], if is_later { here[l] } else { S::ZERO });
                entries[way][l] = larger(entries[way][l], enters[way][l]);
            }
        }
        here = here.map(|here| here + width);
    }
    let last = |way: usize| {
        let l = (0..N).fold(0, |last, l| if entries[way][l] > entries[way][last] { l } else { last });
        (entries[way][l], into[way][l].as_f64() as usize)
    };
    let ((entry, into), (exit, out_of)) = (last(0), last(1));
    Clipped { entry, exit: -exit, into, out_of }
}

/// How far a point is beyond the plane that it is farthest beyond, or negative.
#[inline(never)]
fn most_beyond<S: Scalar>(planes: &[Planes<S>], [x, y, z]: [S; 3]) -> S {
    let mut most = [-S::infinity(); PLANES];
    for [nx, ny, nz, reach] in planes {
        for l in 0..PLANES {
            let beyond = nx[l] * x + ny[l] * y + nz[l] * z - reach[l];
            most[l] = if beyond > most[l] { beyond } else { most[l] };
        }
    }
    most.into_iter().fold(-S::infinity(), S::max)
}
