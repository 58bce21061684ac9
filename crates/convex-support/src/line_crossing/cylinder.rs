//! Where a line is in a cylinder: in its slab, and in the circle that is seen along the axis.

use num_traits::Float as _;

use super::{Chord, Crossed, Crossing, comfortable, past_rim, rebased, slab};
use crate::shapes::axial::across;
use crate::{Scalar, Vector3};

/// The crossing of the cylinder of radius `r` about the second axis.
#[inline(always)]
pub(crate) fn cylinder<V: Vector3>(half_height: V::Scalar, r: V::Scalar, source: V, direction: V) -> Crossed<V> {
    let (direction, dd, unit) = comfortable(direction);
    let (base, source) = rebased(source, direction, dd.recip());
    let rise = direction.get(1);
    let (top, bottom) = slab(source.get(1), rise, half_height);
    let lid = V::axis(1) * V::Scalar::ONE.copysign(-rise);

    let (out, radial) = (across(source), across(direction));
    let slope = radial.length_squared();
    if slope <= dd * (V::Scalar::EPSILON * V::Scalar::EPSILON) {
        // Along the axis to rounding.
        let within = out.length_squared() <= r * r;
        let crossing = Crossing { entry: top, exit: bottom, normal: lid };
        return if within { crossing.shifted(base, unit, || out) } else { Err(out) };
    }
    let recip = slope.recip();
    let middle = -out.dot(radial) * recip;
    let side = Chord::about(middle, out + radial * middle, recip, r);
    let (enters, leaves) = side.ends();
    let through_side = enters > top;
    // The line leaves the side before it is at the height of the lids, or enters it after that.
    let rim = || past_rim(source, direction, if leaves < top { top } else { bottom });
    Crossing {
        // A `NaN`, if the line misses the side, must reach the comparison of entry and exit.
        entry: if top >= enters { top } else { enters },
        exit: if bottom < leaves { bottom } else { leaves },
        normal: if through_side { side.normal(r, radial, recip) } else { lid },
    }
    .shifted(base, unit, || if side.is_some() { rim() } else { side.nearest })
}
