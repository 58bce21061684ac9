//! The closest points of two segments, such as the cores of capsules, in closed form. Not compiled into their callers,
//! so that other pairs do not take longer.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

/// The points of the segments from `−u` to `u`, moved by `offset`, and from `−w` to `w` that are closest to one
/// another, each relative to its segment's middle.
///
/// The length of `r + s·u − t·w`, with `r` the offset, is least where
///
/// > s·u² − t·u·w = −u·r,   t·w² − s·u·w = w·r,
///
/// if both `s` and `t` are between −1 and 1. Otherwise one of the points is an end of its segment. So the solution `t`
/// is clamped to the interval, `s` follows from that `t` by the first equation and is clamped too, and the last `t`
/// follows from that `s` by the second one. The determinant is zero for parallel segments, which have many closest
/// pairs; if `u` or `w` is zero, any `s` or `t` gives the same point. A quotient may then be NaN, and clamping makes a
/// number of it that will do.
///
/// Segments given the other way round have the same points, to the last bit.
#[inline(never)]
pub(crate) fn closest_points<V: Vector>(u: V, w: V, offset: V) -> (V, V) {
    if is_in_order(u, w, offset) {
        points_in_order(u, w, offset)
    } else {
        let (b, a) = points_in_order(w, u, -offset);
        (a, b)
    }
}

/// Whether segments keep their order: the longer one comes first, or of equal ones the one that is farther along the
/// axes.
#[inline(always)]
fn is_in_order<V: Vector>(u: V, w: V, from_second: V) -> bool {
    let (uu, ww, zero) = (u.length_squared(), w.length_squared(), V::Scalar::ZERO);
    let first = (0..V::DIM).map(|i| from_second.get(i)).find(|&x| x != zero);
    if uu == ww { first.is_none_or(|x| x > zero) } else { uu > ww }
}

#[inline(always)]
fn points_in_order<V: Vector>(u: V, w: V, offset: V) -> (V, V) {
    let (uu, ww, uw) = (u.length_squared(), w.length_squared(), u.dot(w));
    let (ur, wr) = (u.dot(offset), w.dot(offset));
    let share = uw / uu;
    let t = cut((wr - share * ur) / (ww - share * uw));
    let s = cut((t * uw - ur) / uu);
    let t = cut((s * uw + wr) / ww);
    (u * s, w * t)
}

/// A vector along the normal of the plane between two segments, with the given halves and middles, at their closest
/// points `a` and `b`, given the vector `v` from `b` to `a`.
///
/// Where a point is within its segment, the normal is across that. Of points that are near one another rounding is much
/// of the vector between them, and a step of Newton takes the part of it along the segments away, to what is rounded of
/// the vector itself.
#[inline(never)]
pub(crate) fn normal_between<V: Vector>([u, w]: [V; 2], [x, y]: [V; 2], [a, b]: [V; 2], v: V) -> V {
    if is_in_order(u, w, v) {
        normal_in_order([u, w], [x, y], [a, b], v)
    } else {
        -normal_in_order([w, u], [y, x], [b, a], -v)
    }
}

#[inline(always)]
fn normal_in_order<V: Vector>([u, w]: [V; 2], middles: [V; 2], [a, b]: [V; 2], v: V) -> V {
    let zero = V::Scalar::ZERO;
    let (uu, ww, uw) = (u.length_squared(), w.length_squared(), u.dot(w));
    let (is_within_u, is_within_w) = (is_within(u, middles[0], a), is_within(w, middles[1], b));
    let (uv, wv) = (if is_within_u { u.dot(v) } else { zero }, if is_within_w { w.dot(v) } else { zero });
    // Parallel segments are both across any vector that one of them is across.
    let squared_sine = uu * ww - uw * uw;
    let is_across_both = is_within_u && is_within_w && squared_sine > uu * ww * V::Scalar::from_f64(NEARLY_PARALLEL);
    let (s, t) = if is_across_both {
        ((uw * wv - ww * uv) / squared_sine, (uu * wv - uw * uv) / squared_sine)
    } else if is_within_u {
        (-uv / uu, zero)
    } else if is_within_w {
        (zero, wv / ww)
    } else {
        (zero, zero)
    };
    v + u * s - w * t
}

/// The error of a point, in ε of the half length and of the middle.
const AT_END: f64 = 8.0;

/// Whether a point of a segment is certainly not one of its ends: a point that was added to the middle is rounded, and
/// if the middle is far from the origin, by as much as the segment is long.
#[inline(always)]
fn is_within<V: Vector>(half: V, middle: V, point: V) -> bool {
    let squared = half.length_squared();
    let error = (squared + middle.abs().dot(half.abs())) * (V::Scalar::EPSILON * V::Scalar::from_f64(AT_END));
    (point - middle).dot(half).abs() < squared - error
}

/// The squared sine of the angle between segments below which they count as parallel.
const NEARLY_PARALLEL: f64 = 1e-6;

/// The nearest number from −1 to 1; one of them for NaN.
#[inline(always)]
fn cut<S: Scalar>(x: S) -> S {
    x.max(-S::ONE).min(S::ONE)
}
