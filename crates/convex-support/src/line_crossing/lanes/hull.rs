//! Many lines at one hull with facets.

use core::array::from_fn;

use super::{LINES, Lane, Lines, Told, approach, numbers, set};
use crate::line_crossing::faceted::{Clipped, side_by_side};
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
                for at in (0..LINES).step_by(TOGETHER) {
                    let clipped = clip_lines(planes, together(&lines.near, at), together(&lines.direction, at));
                    // A point of each line, which is in the hull if the line enters it.
                    let mut inner = [[V::Scalar::ZERO; TOGETHER]; 3];
                    for l in 0..TOGETHER {
                        let near = lines.near::<V>(at + l, size);
                        let (told, latest) = match near.cut(planes, clipped.get(l)) {
                            Some((known, latest)) => (Told::new(known), latest),
                            None => (Told::NOTHING, V::Scalar::ZERO),
                        };
                        lines.tell(at + l, told);
                        let point = near.source + near.direction * latest;
                        (0..V::DIM).for_each(|i| inner[i][l] = point.get(i));
                    }
                    let most = most_beyond_of_all(planes, inner);
                    for l in 0..TOGETHER {
                        let line = at + l;
                        let is_known = (lines.known[line] < V::Scalar::ZERO) | (most[l] <= -lines.near_error[line]);
                        lines.known[line] = if is_known { lines.known[line] } else { V::Scalar::ZERO };
                    }
                }
            }
        }
        approach(lines, numbers(origin), size, error);
        widest(ClippedByHull::<V::Numbers>(lines, planes, size));
    }
}

/// Lines that are clipped together: what is found of them so far stays in registers while the planes go by.
const TOGETHER: usize = 8;

#[inline(always)]
fn by_line<S>(number: impl FnMut(usize) -> S) -> [S; TOGETHER] {
    from_fn(number)
}

/// Vectors of the lines from `at` on that are clipped together.
#[inline(always)]
fn together<S: Scalar>(lanes: &[Lane<S>; 3], at: usize) -> [[S; TOGETHER]; 3] {
    from_fn(|i| by_line(|l| lanes[i][at + l]))
}

/// [`Clipped`] for many lines; the exits are negated.
struct ClippedLines<S> {
    entries: [S; TOGETHER],
    exits: [S; TOGETHER],
    into: [S; TOGETHER],
    out_of: [S; TOGETHER],
}

impl<S: Scalar> ClippedLines<S> {
    #[inline(always)]
    fn get(&self, l: usize) -> Clipped<S> {
        let [into, out_of] = [self.into[l], self.out_of[l]].map(|place| place.as_f64() as usize);
        Clipped { entry: self.entries[l], exit: -self.exits[l], into, out_of }
    }
}

/// `clip` for many lines, each by one plane after the other; for one line, planes are side by side. Among planes that
/// are entered at the same parameter both find the same one: the first of the first row. A step that both share takes
/// 1.1 to 2 times as long in one of them, since compilers choose by other instructions where the planes lie otherwise.
#[inline(always)]
fn clip_lines<S: Scalar>(
    planes: &[Planes<S>],
    [x, y, z]: [[S; TOGETHER]; 3],
    [dx, dy, dz]: [[S; TOGETHER]; 3],
) -> ClippedLines<S> {
    let (below, rows) = (-S::infinity(), side_by_side::<S>());
    let width = S::from_f64(rows as f64);
    let (mut entries, mut exits) = ([below; TOGETHER], [below; TOGETHER]);
    let (mut into, mut out_of) = ([S::ZERO; TOGETHER], [S::ZERO; TOGETHER]);
    for row in 0..rows {
        let mut here = S::from_f64(row as f64);
        for [nx, ny, nz, reach] in planes {
            for p in 0..PLANES / rows {
                let [nx, ny, nz, reach] = [nx, ny, nz, reach].map(|numbers| numbers[row + p * rows]);
                // Each step makes an array. A loop that changes one is compiled to stores under a mask, which take
                // three times as long as all the rest.
                let slope = by_line(|l| nx * dx[l] + ny * dy[l] + nz * dz[l] + S::ZERO);
                let crossed = by_line(|l| (reach - (nx * x[l] + ny * y[l] + nz * z[l])) / slope[l]);
                let entry = by_line(|l| if slope[l] < S::ZERO { crossed[l] } else { below });
                let exit = by_line(|l| if slope[l] < S::ZERO { below } else { -crossed[l] });
                into = by_line(|l| if entry[l] > entries[l] { here } else { into[l] });
                entries = by_line(|l| if entry[l] > entries[l] { entry[l] } else { entries[l] });
                out_of = by_line(|l| if exit[l] > exits[l] { here } else { out_of[l] });
                exits = by_line(|l| if exit[l] > exits[l] { exit[l] } else { exits[l] });
                here += width;
            }
        }
    }
    ClippedLines { entries, exits, into, out_of }
}

/// `most_beyond` for many points, each at one plane after the other.
#[inline(always)]
fn most_beyond_of_all<S: Scalar>(planes: &[Planes<S>], [x, y, z]: [[S; TOGETHER]; 3]) -> [S; TOGETHER] {
    let mut most = [-S::infinity(); TOGETHER];
    for [nx, ny, nz, reach] in planes {
        for row in 0..PLANES {
            let [nx, ny, nz, reach] = [nx[row], ny[row], nz[row], reach[row]];
            let beyond = by_line(|l| nx * x[l] + ny * y[l] + nz * z[l] - reach);
            most = by_line(|l| if beyond[l] > most[l] { beyond[l] } else { most[l] });
        }
    }
    most
}
