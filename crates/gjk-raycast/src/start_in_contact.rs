//! Casts that begin in contact: what is known of the contact, and whether the motion goes deeper into it.

use convex_support::{Posed, Scalar, SupportMap, Vector};
use num_traits::Float as _;

use crate::contact::signed_distance_of_any;
use crate::shape::{Shape, WithoutLines};
use crate::{
    Distance, DistanceOptions, LinearCastOptions, Motion, SignedDistance, SignedDistanceOptions, distance_with,
};

/// Closing speeds below this many ε of the speed are of rounding: a normal is known to a few.
const SLIDES: f64 = 16.0;

/// Two shapes where a cast begins. They are asked behind pointers, so that what is rarely needed is compiled once.
pub(crate) struct Start<'s, V: Vector> {
    pub(crate) a: Shape<'s, V>,
    pub(crate) b: Shape<'s, V>,
    /// How far apart they count as touching.
    pub(crate) target: V::Scalar,
}

impl<V: Vector> Start<'_, V> {
    /// The distance at the start.
    #[cold]
    #[inline(never)]
    pub(crate) fn distance(&self, options: &LinearCastOptions<V>) -> Distance<V> {
        let wanted = DistanceOptions::new().with_max_iterations(options.max_iterations);
        distance_with(self.a, self.b, wanted.with_sub_algorithm(options.sub_algorithm), |_| {})
    }

    /// The normal of contact if the shapes only touch, and `None` if they certainly overlap by more than that; with the number of support
    /// points computed.
    #[cold]
    #[inline(never)]
    pub(crate) fn touching_normal(&self, options: &LinearCastOptions<V>) -> (Option<V>, usize) {
        let start = self.signed_distance(options, V::Scalar::ZERO);
        ((start.upper >= self.target).then_some(start.normal), start.iterations)
    }

    /// The signed distance at the start; the search stops as soon as the depth is certain to exceed a limit.
    fn signed_distance(&self, options: &LinearCastOptions<V>, depth_limit: V::Scalar) -> SignedDistance<V> {
        let mut wanted = SignedDistanceOptions::new().with_depth_limit(depth_limit);
        wanted.axis = options.axis;
        signed_distance_of_any(self.a, self.b, wanted)
    }

    /// The contact of shapes that touch or overlap at the start, to a slack that is the rounding of their places; `None` if they are
    /// certainly apart by more.
    ///
    /// The depth of a point in a convex set is a concave function of the point: it is the least of the distances from the supporting planes.
    /// So if it falls at first along a line, it falls along all of it. Where the depth is `−s`, along the normal `n`, it changes by `−n·w` with
    /// the relative velocity `w` of `a`; if several ways out are equally short, by the least of these. If the shapes touch at corners, `n` is
    /// one of many normals, and the shapes may part along another one although they close in along `n`. Then it counts whether they
    /// certainly overlap a little later.
    #[cold]
    #[inline(never)]
    pub(crate) fn of_motion(
        &self,
        motion: Motion<V>,
        options: &LinearCastOptions<V>,
        slack: V::Scalar,
    ) -> Option<InContact<V>> {
        let start = self.signed_distance(options, V::Scalar::infinity());
        if !(start.lower <= self.target + slack) {
            return None;
        }
        let velocity = motion.velocity_a - motion.velocity_b;
        let touching = InContact { start, leaves_along: Some(start.normal) };
        let slides = V::Scalar::from_f64(SLIDES) * V::Scalar::EPSILON * velocity.norm();
        if !(-start.normal.dot(velocity) > slides) {
            return Some(touching);
        }
        let deeper = InContact { start, leaves_along: None };
        if start.upper < self.target - slack {
            return Some(deeper);
        }
        let later = self.a_little_later(velocity)?;
        let stays = later.upper < self.target;
        Some(InContact { leaves_along: (!stays).then_some(later.normal), ..deeper })
    }

    /// The signed distance after a motion of `√ε` of the shapes' sizes.
    fn a_little_later(&self, velocity: V) -> Option<SignedDistance<V>> {
        let size = |shape: &dyn SupportMap<Vector = V>| {
            let core = shape.core();
            core.extent + core.radius
        };
        let root = V::Scalar::EPSILON.sqrt();
        let step = root * (size(self.a) + size(self.b) + self.target);
        let moved = Posed::translated(self.a, velocity.unit()? * step).ok()?;
        // So small a part of the step that it is a small angle that remains in doubt.
        let tolerance = root * V::Scalar::from_f64(1.0 / 64.0);
        Some(signed_distance_of_any(
            &WithoutLines(&moved),
            self.b,
            SignedDistanceOptions::new().with_tolerance(tolerance),
        ))
    }
}

/// Two shapes in contact.
pub(crate) struct InContact<V: Vector> {
    pub(crate) start: SignedDistance<V>,
    /// Where the motion does not go deeper: the direction from `b` to `a` along which it leaves, or slides.
    pub(crate) leaves_along: Option<V>,
}
