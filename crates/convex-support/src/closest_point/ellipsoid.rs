//! The point of an ellipsoid nearest a given point, by Newton's method on the secular equation.

use num_traits::Float as _;

use crate::numerics::range::comfortable_unit_of_length;
use crate::{Scalar, Vector};

/// Newton's iteration below climbs through the scales of the semi-axes one after another and then doubles its digits:
/// about twelve steps at an aspect of 1e6, and never more than a few dozen.
const MAX_SECULAR_STEPS: usize = 100;

/// The point of `{ z : Σ(zᵢ/aᵢ)² ≤ 1 }` nearest `y`; `None` where `y` is inside.
///
/// Outside, `y − z` is a normal at `z`, so there is a `t > 0` with `yᵢ − zᵢ = t·zᵢ/aᵢ²`, that is `zᵢ/aᵢ = wᵢ(t) =
/// aᵢyᵢ/(t + aᵢ²)` where `|w(t)| = 1`: the secular equation. As a function of `t`, `1/|w| − 1` is increasing, concave
/// and, far out, a straight line, so that Newton's iterates from below the root increase towards it and never pass it
/// (Reinsch; Moré and Sorensen, *Computing a trust region step*, 1983). Two lower bounds on the root to start from:
/// `|wᵢ(t)| ≤ 1` for each `i`, and `|w(t)| ≥ |a∘y|/(t + a²ₘₐₓ)`.
pub(crate) fn closest_of_ellipsoid<V: Vector>(a: V, y: V) -> Option<V> {
    let (zero, one) = (V::Scalar::ZERO, V::Scalar::ONE);
    if V::from_fn(|i| y.get(i) / a.get(i)).norm() <= one {
        return None;
    }
    let unit = comfortable_unit_of_length(a.max(y.abs()).max_element());
    let (a, y) = (a / unit, y / unit);
    let squares = a * a;
    let products = a * y;
    let mut t = (products.abs() - squares).max_element().max(products.norm() - squares.max_element()).max(zero);
    let w = |t: V::Scalar| V::from_fn(|i| ratio(products.get(i), t + squares.get(i)));
    for _ in 0..MAX_SECULAR_STEPS {
        // φ(t) = 1/|w| − 1 and φ′ = Σ wᵢ²/(t + aᵢ²)/|w|³, so −φ/φ′ = |w|²(|w| − 1)/Σ wᵢ²/(t + aᵢ²).
        let w = w(t);
        let norm = w.norm();
        let slope = w.dot(V::from_fn(|i| ratio(w.get(i), t + squares.get(i))));
        let next = t + norm * norm / slope * (norm - one);
        // Also ends where the step is lost to rounding, and for a NaN.
        if !(next > t && next.is_finite()) {
            break;
        }
        t = next;
    }
    // The last factor puts the point on the surface, which t alone does only to its own rounding.
    let w = w(t);
    let z = a * (w / w.norm().max(one)) * unit;
    Some(z)
}

/// `p/q`, and 0 where `p` is.
#[inline]
fn ratio<S: Scalar>(p: S, q: S) -> S {
    if p == S::ZERO { S::ZERO } else { p / q }
}
