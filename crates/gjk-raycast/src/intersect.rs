//! Whether two shapes meet.

use convex_support::{Scalar, SupportMap, Vector};

use crate::body::{Pair, Untraced};
use crate::descent::{End, Frame, Wanted, descend};
use crate::{IntersectOptions, Intersection, Iterate};

/// Whether two shapes have a point in common, decided as soon as it can be.
///
/// This is the incremental separating axis variant of GJK: it ends at the first plane that separates the shapes, and
/// beginning with the axis of a similar query usually finds one at once.
///
/// ```
/// use convex_support::{Cuboid, Posed, glam::DVec2};
/// use gjk_raycast::{IntersectOptions, intersects};
///
/// let box_at = |x| Posed::translated(Cuboid::new(DVec2::ONE)?, DVec2::new(x, 0.5));
/// let (fixed, moving) = (box_at(0.0)?, box_at(2.5)?);
/// let first = intersects(&fixed, &moving, IntersectOptions::default());
/// assert!(!first.overlap);
///
/// let axis = first.axis.ok_or("apart, so there is an axis")?;
/// let next = intersects(&fixed, &box_at(2.4)?, IntersectOptions::default().with_axis(axis));
/// assert_eq!((next.overlap, next.iterations), (false, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn intersects<A, B>(a: &A, b: &B, options: IntersectOptions<A::Vector>) -> Intersection<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    intersects_with(a, b, options, |_| {})
}

/// [`intersects`], showing an observer every iterate.
pub fn intersects_with<A, B>(
    a: &A,
    b: &B,
    options: IntersectOptions<A::Vector>,
    observer: impl FnMut(Iterate<'_, A::Vector>),
) -> Intersection<A::Vector>
where
    A: SupportMap + ?Sized,
    B: SupportMap<Vector = A::Vector> + ?Sized,
{
    let mut pair = Pair::new(a, b);
    let frame = Frame::new(&mut pair);
    let wanted = Wanted {
        first: options.axis.and_then(Vector::unit).or_else(|| frame.offset.unit()).unwrap_or_else(|| Vector::axis(0)),
        limit: frame.radius,
        tolerance: Scalar::ZERO,
        max_iterations: options.max_iterations,
        sub_algorithm: options.sub_algorithm,
    };
    let descent = descend(&mut Untraced(&mut pair), frame, wanted, None, observer);
    let overlap = match descent.end {
        End::Overlap => true,
        End::Separated => false,
        End::IterationLimit | End::Stalled => descent.lower <= frame.radius,
    };
    let axis = descent.axis.unit().filter(|_| !overlap);
    Intersection { overlap, axis, status: descent.end.status(), iterations: descent.iterations }
}
