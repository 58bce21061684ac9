//! Gradients by the motion of a body, about its own centre.

use convex_support::{AngularVelocity, Ellipsoid, MotionGradient, Scalar, Vector};

use super::contact::{Contact, Mover, Units};
use crate::numerics::{Vec, load, load_columns, store};

/// The gradient of the value of a contact.
pub(super) fn gradient<V: Vector, const N: usize>(
    contact: &Contact<N>,
    mover: Mover,
    body: &Ellipsoid<V>,
    units: Units,
) -> MotionGradient<V> {
    let (force, e, factor) = contact.gradient(mover);
    MotionGradient {
        translation: store(force.map(|x| x * (units.value / units.length))),
        rotation: torque(body, e, factor * units.value),
        point: body.center(),
    }
}

/// `factor`·Σ uᵢuⱼ(aᵢ/aⱼ − aⱼ/aᵢ) eᵢ∧eⱼ over the planes i < j of the axes of `body`.
///
/// Torques about the own centre are such sums in body axes, where nothing cancels: it is zero in a plane where the body
/// is round, to the last bit.
#[inline]
pub(super) fn torque<V: Vector, const N: usize>(body: &Ellipsoid<V>, u: Vec<N>, factor: f64) -> V::AngularVelocity {
    let (axes, a): ([Vec<N>; N], Vec<N>) = (load_columns(body.axes()), load(body.semi_axes()));
    let mut sum = [0.0; 3];
    for i in 0..N {
        for j in i + 1..N {
            let size = factor * u[i] * u[j] * ((a[i] - a[j]) / a[i] * ((a[i] + a[j]) / a[j]));
            for (k, sum) in sum.iter_mut().enumerate() {
                let (p, q) = if N == 2 { (0, 1) } else { ((k + 1) % 3, (k + 2) % 3) };
                *sum += size * (axes[i][p] * axes[j][q] - axes[i][q] * axes[j][p]);
            }
        }
    }
    V::AngularVelocity::from_coordinates(|k| V::Scalar::from_f64(sum[k]))
}
