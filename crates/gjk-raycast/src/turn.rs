//! Where to look next on a curved surface.

use convex_support::{Scalar, Vector};
use num_traits::Float as _;

use crate::simplex::Simplex;

/// A support point and the direction it was found along.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Found<V> {
    pub(crate) point: V,
    pub(crate) along: V,
}

/// The last support points of a search and what they are made of, the newest last.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recent<V, W> {
    found: [Found<V>; 3],
    witnesses: [W; 3],
    len: usize,
}

impl<V: Vector, W: Copy + Default> Recent<V, W> {
    pub(crate) fn new() -> Self {
        Self { found: [Found::default(); 3], witnesses: [W::default(); 3], len: 0 }
    }

    /// Adds one; another at the same point, or the oldest of three, makes place.
    pub(crate) fn push(&mut self, found: Found<V>, witness: W) {
        let known = self.found().iter().position(|f| f.point == found.point);
        match known.or((self.len == 3).then_some(0)) {
            Some(out) => {
                self.found[out..self.len].rotate_left(1);
                self.witnesses[out..self.len].rotate_left(1);
            }
            None => self.len += 1,
        }
        self.found[self.len - 1] = found;
        self.witnesses[self.len - 1] = witness;
    }

    pub(crate) fn found(&self) -> &[Found<V>] {
        &self.found[..self.len]
    }

    /// The simplex of the points, without weights.
    pub(crate) fn simplex(&self) -> Simplex<V, W> {
        let mut simplex = Simplex::new();
        for (f, &witness) in self.found().iter().zip(&self.witnesses) {
            simplex.push(f.point, f.along, witness);
        }
        simplex
    }
}

/// The stationarity condition whose solution is the direction looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Condition<V: Vector> {
    /// A unit vector; directions `n` are compared at one value of `n·axis`, and change only across it.
    pub(crate) axis: V,
    /// What the support point has to come to, and that only across the axis.
    pub(crate) target: V,
    /// The distance kept from the target, for a direction that has to point to it: 0 for a ray.
    pub(crate) distance: V::Scalar,
    /// What rounding may have moved a point by.
    pub(crate) noise: V::Scalar,
    /// How much farther one of two pieces is made to reach than the other, so that it is the one found next: the second,
    /// unless it is a vertex, which has been found already.
    pub(crate) lead: V::Scalar,
}

/// A step of [`turn`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<V: Vector> {
    /// The unit vector to look along.
    pub(crate) to: V,
    /// The tangent of the angle it was turned by, or nearly so.
    pub(crate) angle: V::Scalar,
}

/// Two support points are of one smooth piece if the curvature at one foretells this much of the other.
const FORETOLD: f64 = 0.25;

/// The direction in which the support point should be what it has to be, from the support points found so far, the
/// newest last, and the derivative `H(n)δ` of the support map. `None` where curvature says nothing: at a vertex, or
/// where three points of different pieces span a facet.
///
/// This is Newton's method on the dual of the problem, whose variable is the plane. Its unknown is the change `δ` of the
/// direction `n`, across the axis `a`. On a smooth piece the support point moves to `p + Hδ`, and has to become the
/// target `c`, or come to point to it from the distance `ρ`; seen across the axis,
///
/// ```text
/// (H + ρ)·δ = c − p.
/// ```
///
/// Where the answer is a point between two pieces, as on the side of a cylinder between its rims, the two must support
/// the same plane. With `q` the second piece's point and `g` how much farther the first reaches, both at `n`, and with `β`
/// the weight of the second,
///
/// ```text
/// (H_β + ρ)·δ + β·e = c − p,    e·δ = g,    e = q − p,    H_β = (1 − β)·H_p + β·H_q.
/// ```
pub(crate) fn turn<V: Vector>(
    found: &[Found<V>],
    condition: Condition<V>,
    derivative: impl Fn(V, V) -> V,
) -> Option<Turn<V>> {
    let zero = V::Scalar::ZERO;
    let half = V::Scalar::from_f64(0.5);
    let (&Found { point: p, along: n }, others) = found.split_last()?;
    let basis = basis(condition.axis);
    let moved = basis.map(|u| derivative(n, u));
    if moved.iter().all(|&m| m == V::ZERO) {
        return None;
    }
    let within = |v: V| basis.map(|u| v.dot(u));
    // The matrix H + ρ seen across the axis, (a b; b d), of a piece whose points move so.
    let system = |moved: [V; 2]| {
        let [a, b] = within(moved[0]);
        let [_, d] = within(moved[1]);
        (a + condition.distance, b, d + condition.distance)
    };
    let [r0, r1] = within(condition.target - p);
    let alone = {
        let (a, b, d) = system(moved);
        let determinant = a * d - b * b;
        let (d0, d1) = ((d * r0 - b * r1) / determinant, (a * r1 - b * r0) / determinant);
        if V::DIM == 2 {
            Some((r0 / a, zero))
        } else {
            (determinant > V::Scalar::EPSILON.sqrt() * a * d).then_some((d0, d1))
        }
    };

    // A second piece, turned to n: the one that would reach farthest beyond the first in the direction that suits the
    // first alone; or where the first alone suits none, the one across from which the target lies.
    let mut second: Option<(V, V::Scalar, [V; 2])> = None;
    let mut best = if alone.is_some() { condition.noise } else { -V::Scalar::infinity() };
    for &Found { point, along } in others {
        let scale = n.dot(condition.axis) / along.dot(condition.axis);
        if !(scale > zero && scale.is_finite()) {
            continue;
        }
        let along = along * scale;
        let change = n - along;
        let shift = derivative(along, change);
        let q = point + shift;
        // Points no farther apart than rounding are one.
        let foretold = condition.noise.max((p - point).length() * V::Scalar::from_f64(FORETOLD));
        if (q - p).length() <= foretold {
            continue;
        }
        let reach = n.dot(point) + change.dot(shift) * half;
        let [e0, e1] = within(q - p);
        let score = match alone {
            Some((d0, d1)) => (reach - n.dot(p)) + (e0 * d0 + e1 * d1) - (r0 * d0 + r1 * d1) * half,
            None => {
                let share = ((e0 * r0 + e1 * r1) / (e0 * e0 + e1 * e1)).max(zero).min(V::Scalar::ONE);
                let (m0, m1) = (r0 - e0 * share, r1 - e1 * share);
                -(m0 * m0 + m1 * m1)
            }
        };
        if score >= best {
            best = score;
            second = Some((q, reach, basis.map(|u| derivative(along, u))));
        }
    }

    let (d0, d1) = match second {
        None => alone?,
        Some(_) if V::DIM == 2 => return None,
        Some((q, reach, moved_q)) => {
            let [e0, e1] = within(q - p);
            let squared = e0 * e0 + e1 * e1;
            let share = ((e0 * r0 + e1 * r1) / squared).max(zero).min(V::Scalar::ONE);
            let lead = if moved_q == [V::ZERO; 2] { -condition.lead } else { condition.lead };
            let blended = |i: usize| moved[i] * (V::Scalar::ONE - share) + moved_q[i] * share;
            let (a, b, d) = system([blended(0), blended(1)]);
            // Along e the change is given; across it, the first equation says what it is.
            let t = (n.dot(p) - reach + lead) / squared;
            let stiffness = a * e1 * e1 - (b + b) * e0 * e1 + d * e0 * e0;
            if !(stiffness > V::Scalar::EPSILON.sqrt() * squared * (a + d)) {
                return None;
            }
            let (m0, m1) = (r0 - (a * e0 + b * e1) * t, r1 - (b * e0 + d * e1) * t);
            let s = (e0 * m1 - e1 * m0) / stiffness;
            (e0 * t - e1 * s, e1 * t + e0 * s)
        }
    };
    let change = basis[0] * d0 + basis[1] * d1;
    // NaN fails this too.
    let angle = change.length();
    if !(angle <= half) {
        return None;
    }
    (n + change).unit().map(|to| Turn { to, angle })
}

/// Unit vectors across a unit vector and one another; the second is zero in 2D.
fn basis<V: Vector>(axis: V) -> [V; 2] {
    // The coordinate axes farthest from it, whose order no scaling changes.
    let mut order = [0, 1, 2];
    let size = |i: usize| axis.get(i.min(V::DIM - 1)).abs();
    order[..V::DIM].sort_unstable_by(|&i, &j| size(i).partial_cmp(&size(j)).unwrap_or(core::cmp::Ordering::Equal));
    let across = |v: V, w: V| v - w * v.dot(w);
    let first = across(across(V::axis(order[0]), axis), axis).unit().unwrap_or(V::ZERO);
    if V::DIM == 2 {
        return [first, V::ZERO];
    }
    let second = V::axis(order[1]);
    let second = across(across(across(across(second, axis), first), axis), first).unit().unwrap_or(V::ZERO);
    [first, second]
}
