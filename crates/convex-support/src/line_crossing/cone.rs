//! Where a line is in a cone: in its slab, and on the side of the axis of a quadratic about the apex.

use num_traits::Float as _;

use super::{Crossed, Crossing, comfortable, cylinder, past_rim, rebased, slab};
use crate::shapes::axial::{ConeMeasures, across};
use crate::{Scalar, Vector3};

/// Within its slab, the cone is `F(x) ≤ 0` below the apex, with `F(x) = cos²α·(x² + z²) − sin²α·(h − y)²` and `α` half
/// the opening angle. Along the line, counted from the apex, `F = Aλ² + 2Bλ + C`; and by Lagrange's identity the
/// discriminant is, with the moment `m = p × d`, `B² − AC = cos²α·(sin²α·(m_x² + m_z²) − cos²α·m_y²)`: no difference
/// of the products of `B` and `AC` is formed.
#[inline(always)]
pub(crate) fn cone<V: Vector3>(cone: &ConeMeasures<V::Scalar>, source: V, direction: V) -> Crossed<V> {
    let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
    let (h, r) = (cone.half_height, cone.radius);
    if h == zero || r == zero {
        return flat(h, r, source, direction);
    }
    let (direction, dd, unit) = comfortable(direction);
    let recip = dd.recip();
    // Relative to the apex: near it, and along the slant through it, only the differences of squares there determine
    // the line.
    let (base, source) = rebased(source - V::axis(1) * h, direction, recip);
    // From here on, near the cone, a unit direction keeps the products of four lengths and directions in range.
    let per_length = recip.sqrt();
    let direction = direction * per_length;
    let (y, rise) = (source.get(1), direction.get(1));
    let (top, bottom) = slab(y + h, rise, h);

    let (cosine, sine) = cone.slant;
    let (out, radial) = (across(source) * cosine, across(direction) * cosine);
    let (drop, fall) = (-sine * y, -sine * rise);
    let a = radial.length_squared() - fall * fall;
    let b = out.dot(radial) - drop * fall;
    let c = out.length_squared() - drop * drop;
    let m = source.cross(direction);
    let (swing, twist) = (sine * across(m).length(), cosine * m.get(1).abs());
    let discriminant = (swing - twist) * (swing + twist);
    let root = cosine * discriminant.sqrt();
    // The larger of the two in magnitude first, so that B and the root do not cancel; the other from the product.
    let q = -(b + root.copysign(b));
    let far = if a == zero { infinity.copysign(-q) } else { q / a };
    // With p from the apex and rounding u, the quotient C/q is wrong by u·p²/q, and the difference of B and the root,
    // divided by A, by u·p/A².
    let squared = a * a;
    let is_touched = q * q < source.length_squared() * (squared * squared);
    let near = if is_touched { (root.copysign(b) - b) / a } else { c / q };
    let near = if q == zero { far } else { near };
    let (low, high) = if near < far { (near, far) } else { (far, near) };
    // Across the cone; or, if the line is steeper than the slant, into it for good, or out of it.
    let steep = if fall > zero { (high, infinity) } else { (-infinity, low) };
    let (enters, leaves) = if a > zero { (low, high) } else { steep };
    // Across the cone, through its nappe below the apex, tested at −B/A as a point between the roots.
    let below = !(a > zero) | (drop * a >= fall * b);

    // From above, the line passes the plane of the apex outside of the cone.
    let through_slant = (enters > top) | (rise < zero);
    let entry = if through_slant & !(enters < top) { enters } else { top };
    let exit = if leaves < bottom { leaves } else { bottom };
    // The slant and the base of a flat cone are nearly parallel, and rounding moves the place where they meet along
    // both. But the rim is at a distance r from the axis: the crossing neither begins beyond it nor ends before it.
    let place = across(source + direction * entry);
    let rounding = V::Scalar::EPSILON * V::Scalar::from_f64(8.0);
    let within = place.length_squared() <= r * r * (V::Scalar::ONE + rounding);
    let in_order = entry <= exit + rounding * (h + h + r + entry.abs());

    let normal = if through_slant {
        // At the apex any normal of the cone will do that is against the line.
        let facing = |out: V| out * cosine + V::axis(1) * sine;
        let normal = place.unit().map(facing).filter(|n| n.dot(direction) <= zero);
        normal.unwrap_or_else(|| across(direction).unit().map_or(V::axis(1), |out| facing(-out)))
    } else {
        V::axis(1) * V::Scalar::ONE.copysign(-rise)
    };
    if !((discriminant >= zero) & below & within & in_order) {
        return Err(beside(cone, source, direction, if rise > zero { top } else { bottom }));
    }
    Ok(Crossing {
        entry: (base + entry * per_length) * unit,
        exit: (base + if exit > entry { exit } else { entry } * per_length) * unit,
        normal,
    })
}

/// A vector across the line along which it is apart from the cone; it crosses the plane of the base at `at`.
///
/// Projected along the line, the cone is the hull of an ellipse, its base, and of the apex. Either the line is beyond
/// the rim, or beyond one of the two planes along it that touch the slant all along: their normals `cosα·u + sinα·y`,
/// with a unit vector `u` across the axis, are across the direction `d` if `u·d = −tanα·d_y`.
#[inline(always)]
fn beside<V: Vector3>(cone: &ConeMeasures<V::Scalar>, source: V, direction: V, at: V::Scalar) -> V {
    let beyond_rim = past_rim(source, direction, at);
    let (cosine, sine) = cone.slant;
    // The apex is farther than the base along that vector.
    if !(cosine * beyond_rim.get(1) > sine * across(beyond_rim).length()) {
        return beyond_rim;
    }
    let radial = across(direction);
    let length = radial.length();
    let forward = radial * length.recip();
    let aside = V::axis(1).cross(forward);
    let along = -sine * direction.get(1) / (cosine * length);
    let rest = (V::Scalar::ONE - along * along).sqrt().copysign(source.dot(aside));
    (forward * along + aside * rest) * cosine + V::axis(1) * sine
}

/// A disc or a segment.
#[cold]
#[inline(never)]
fn flat<V: Vector3>(half_height: V::Scalar, radius: V::Scalar, source: V, direction: V) -> Crossed<V> {
    cylinder(half_height, radius, source, direction)
}
