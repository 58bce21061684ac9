//! Hulls with facets.

use num_traits::Float as _;

use super::{Crossed, Crossing, comfortable, rebased};
use crate::shapes::{PLANES, Planes};
use crate::{Faceted, Scalar, Vector};

/// The line is in the hull while it is behind all facets. The exit and the entry are the least and the largest of the `λ` where
/// it leaves, or enters, the half-space of a facet. A negative radius moves all facets inward.
#[inline]
pub(crate) fn faceted<V: Vector>(hull: &Faceted<V>, radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
    let (direction, dd, unit) = comfortable(direction);
    let (base, near) = rebased(source, direction, dd.recip());
    let coordinates = |v: V| [v.get(0), v.get(1), if V::DIM == 3 { v.get(2) } else { V::Scalar::ZERO }];
    let Clipped { entry, exit, place } = clip(hull.planes(), radius, coordinates(near), coordinates(direction));
    // A line enters and leaves a bounded set, so that otherwise something is not a number.
    if !(entry > -V::Scalar::infinity() && exit < V::Scalar::infinity()) {
        return Err(V::ZERO);
    }
    Crossing { entry, exit, normal: hull.facet(place).0 }.shifted(base, unit, || V::ZERO)
}

/// The stretch of a line behind all planes, and the index of the plane it enters by.
struct Clipped<S> {
    entry: S,
    exit: S,
    place: usize,
}

/// Clips the line through `near` along `direction` by planes that are moved by `radius`.
///
/// A line along a plane divides by zero: it is then behind it from `−∞` to `∞` or nowhere; and `0/0`, in the plane itself, compares
/// false and leaves things as they are. Adding zero makes a positive zero of a negative one, which is told from negative numbers.
#[inline(never)]
fn clip<S: Scalar>(planes: &[Planes<S>], radius: S, [x, y, z]: [S; 3], [dx, dy, dz]: [S; 3]) -> Clipped<S> {
    let (infinity, width) = (S::infinity(), S::from_f64(PLANES as f64));
    let mut here: [S; PLANES] = core::array::from_fn(|l| S::from_f64(l as f64));
    let (mut entries, mut exits, mut places) = ([-infinity; PLANES], [infinity; PLANES], here);
    for [nx, ny, nz, reach] in planes {
        for l in 0..PLANES {
            let slope = nx[l] * dx + ny[l] * dy + nz[l] * dz + S::ZERO;
            let crossed = (reach[l] + radius - (nx[l] * x + ny[l] * y + nz[l] * z)) / slope;
            let (enters, leaves) = if slope < S::ZERO { (crossed, infinity) } else { (-infinity, crossed) };
            places[l] = if enters > entries[l] { here[l] } else { places[l] };
            entries[l] = if enters > entries[l] { enters } else { entries[l] };
            exits[l] = if leaves < exits[l] { leaves } else { exits[l] };
            here[l] += width;
        }
    }
    let (mut last, mut exit) = (0, infinity);
    for l in 0..PLANES {
        last = if entries[l] > entries[last] { l } else { last };
        exit = if exits[l] < exit { exits[l] } else { exit };
    }
    Clipped { entry: entries[last], exit, place: places[last].as_f64() as usize }
}
