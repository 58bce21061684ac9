//! Many lines at one hull with facets.

use super::{LINES, Lane, Lines, Told, approach, numbers, set};
use crate::line_crossing::faceted::Clipped;
use crate::numerics::widest::{Loop, widest};
use crate::shapes::{PLANES, Planes};
use crate::{Scalar, Vector, compiled_once};

compiled_once! {
    /// A hull by the planes of its facets relative to a point, known to within an `error`.
    pub(crate) fn hull<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        planes: &[Planes<<V as Vector>::Scalar>],
        origin: V,
        size: <V as Vector>::Scalar,
        error: <V as Vector>::Scalar,
    ) -> () {
        struct ClippedByHull<'a, V: Vector>(&'a mut Lines<V::Scalar>, &'a [Planes<V::Scalar>], V::Scalar);
        impl<V: Vector> Loop for ClippedByHull<'_, V> {
            #[inline(always)]
            fn run(self) {
                let Self(lines, planes, size) = self;
                for line in 0..LINES {
                    let foot = lines.near::<V>(line, size).at_foot();
                    (lines.base[line], lines.near_error[line]) = (foot.base, foot.error);
                    set(&mut lines.near, line, foot.source);
                }
                let clipped = clip_lines(planes, &lines.near, &lines.direction);
                // The parameter at which each line is in the hull if it enters it.
                let mut inner = [[V::Scalar::ZERO; LINES]; 3];
                for line in 0..LINES {
                    let near = lines.near::<V>(line, size);
                    let (told, latest) = match near.cut(planes, clipped.get(line)) {
                        Some((known, latest)) => (Told::new(known), latest),
                        None => (Told::NOTHING, V::Scalar::ZERO),
                    };
                    lines.tell(line, told);
                    set(&mut inner, line, near.source + near.direction * latest);
                }
                let most = most_beyond_of_all(planes, &inner);
                for line in 0..LINES {
                    let is_known = (lines.known[line] < V::Scalar::ZERO) | (most[line] <= -lines.near_error[line]);
                    lines.known[line] = if is_known { lines.known[line] } else { V::Scalar::ZERO };
                }
            }
        }
        approach(lines, numbers(origin), size, error);
        widest(ClippedByHull::<V::Numbers>(lines, planes, size));
    }
}

/// [`Clipped`] for many lines; the exits are negated.
struct ClippedLines<S> {
    entries: Lane<S>,
    exits: Lane<S>,
    into: Lane<S>,
    out_of: Lane<S>,
}

impl<S: Scalar> ClippedLines<S> {
    #[inline(always)]
    fn get(&self, line: usize) -> Clipped<S> {
        let [into, out_of] = [self.into[line], self.out_of[line]].map(|place| place.as_f64() as usize);
        Clipped { entry: self.entries[line], exit: -self.exits[line], into, out_of }
    }
}

/// `clip` for many lines, each at one plane after the other; for one line, planes are side by side. Among planes that
/// are entered at the same parameter both find the same one: the first of the first row.
#[inline(always)]
fn clip_lines<S: Scalar>(
    planes: &[Planes<S>],
    [x, y, z]: &[Lane<S>; 3],
    [dx, dy, dz]: &[Lane<S>; 3],
) -> ClippedLines<S> {
    let (below, width) = (-S::infinity(), S::from_f64(PLANES as f64));
    let mut found = ClippedLines {
        entries: [below; LINES],
        exits: [below; LINES],
        into: [S::ZERO; LINES],
        out_of: [S::ZERO; LINES],
    };
    for row in 0..PLANES {
        let mut here = S::from_f64(row as f64);
        for [nx, ny, nz, reach] in planes {
            let [nx, ny, nz, reach] = [nx[row], ny[row], nz[row], reach[row]];
            for l in 0..LINES {
                let slope = nx * dx[l] + ny * dy[l] + nz * dz[l] + S::ZERO;
                let crossed = (reach - (nx * x[l] + ny * y[l] + nz * z[l])) / slope;
                let entry = if slope < S::ZERO { crossed } else { below };
                let exit = if slope < S::ZERO { below } else { -crossed };
                let (enters, leaves) = (entry > found.entries[l], exit > found.exits[l]);
                found.into[l] = if enters { here } else { found.into[l] };
                found.entries[l] = if enters { entry } else { found.entries[l] };
                found.out_of[l] = if leaves { here } else { found.out_of[l] };
                found.exits[l] = if leaves { exit } else { found.exits[l] };
            }
            here += width;
        }
    }
    found
}

/// `most_beyond` for many points, each at one plane after the other.
#[inline(always)]
fn most_beyond_of_all<S: Scalar>(planes: &[Planes<S>], [x, y, z]: &[Lane<S>; 3]) -> Lane<S> {
    let mut most = [-S::infinity(); LINES];
    for [nx, ny, nz, reach] in planes {
        for row in 0..PLANES {
            let [nx, ny, nz, reach] = [nx[row], ny[row], nz[row], reach[row]];
            for l in 0..LINES {
                let beyond = nx * x[l] + ny * y[l] + nz * z[l] - reach;
                most[l] = if beyond > most[l] { beyond } else { most[l] };
            }
        }
    }
    most
}
