//! Shapes that are another shape: references, boxes and shared pointers, and those that only hold one.

use crate::{CrossedByLine, SupportMap};

/// Implements [`SupportMap`] by forwarding every method, the provided ones too: `forward!([parameters] type as |this|
/// the shape that it is)`.
macro_rules! forward {
    ([$($parameters:tt)*] $shape:ty as $V:ty, |$this:ident| $inner:expr) => {
        impl<$($parameters)*> $crate::SupportMap for $shape {
            type Vector = $V;

            #[inline(always)]
            fn support(&self, direction: $V) -> $V {
                let $this = self;
                $inner.support(direction)
            }

            #[inline(always)]
            fn core(&self) -> $crate::Core<$V> {
                let $this = self;
                $inner.core()
            }

            #[inline(always)]
            fn core_support(&self, direction: $V, hint: &mut $crate::Hint) -> $V {
                let $this = self;
                $inner.core_support(direction, hint)
            }

            #[inline(always)]
            fn core_support_hessian(&self, direction: $V, changes: [$V; 2]) -> [<$V as $crate::Vector>::Scalar; 3] {
                let $this = self;
                $inner.core_support_hessian(direction, changes)
            }

            #[inline(always)]
            fn core_closest_point(&self, x: $V) -> Option<$V> {
                let $this = self;
                $inner.core_closest_point(x)
            }

            #[inline(always)]
            fn certain_crossing(&self, line: $crate::LineQuery<$V>) -> Option<$crate::CertainCrossing<$V>> {
                let $this = self;
                $inner.certain_crossing(line)
            }

            #[inline]
            fn close_crossing(&self, line: &$crate::CloseLine) -> $crate::Close {
                let $this = self;
                $inner.close_crossing(line)
            }

            #[inline]
            fn core_support_feature(
                &self,
                direction: $V,
                slab: <$V as $crate::Vector>::Scalar,
                feature: &mut $crate::Feature<$V>,
            ) {
                let $this = self;
                $inner.core_support_feature(direction, slab, feature);
            }

            #[inline]
            fn core_parallelotope(&self) -> Option<$crate::Parallelotope<$V>> {
                let $this = self;
                $inner.core_parallelotope()
            }

            #[inline]
            fn rounding(&self) -> $crate::Rounding<$V> {
                let $this = self;
                $inner.rounding()
            }
        }
    };
}

/// Implements [`CrossedByLine`] likewise.
macro_rules! forward_line_crossing {
    ([$($parameters:tt)*] $shape:ty as $V:ty, |$this:ident| $inner:expr) => {
        impl<$($parameters)*> $crate::CrossedByLine for $shape {
            #[inline(always)]
            fn core_line_crossing(
                &self,
                source: $V,
                direction: $V,
                radius: <$V as $crate::Vector>::Scalar,
            ) -> $crate::LineCrossing<$V> {
                let $this = self;
                $inner.core_line_crossing(source, direction, radius)
            }

            #[inline(always)]
            fn certain_crossings(&self, lines: &mut $crate::Lines<<$V as $crate::Vector>::Scalar>) -> bool {
                let $this = self;
                $inner.certain_crossings(lines)
            }
        }
    };
}

pub(crate) use {forward, forward_line_crossing};

forward!([S: SupportMap + ?Sized] &S as S::Vector, |pointer| (**pointer));
forward_line_crossing!([S: CrossedByLine + ?Sized] &S as S::Vector, |pointer| (**pointer));

/// Pointers to memory that an allocator gave.
#[cfg(feature = "alloc")]
mod allocated {
    use alloc::boxed::Box;
    use alloc::rc::Rc;
    #[cfg(target_has_atomic = "ptr")]
    use alloc::sync::Arc;

    use crate::{CrossedByLine, SupportMap};

    forward!([S: SupportMap + ?Sized] Box<S> as S::Vector, |pointer| (**pointer));
    forward!([S: SupportMap + ?Sized] Rc<S> as S::Vector, |pointer| (**pointer));
    #[cfg(target_has_atomic = "ptr")]
    forward!([S: SupportMap + ?Sized] Arc<S> as S::Vector, |pointer| (**pointer));

    forward_line_crossing!([S: CrossedByLine + ?Sized] Box<S> as S::Vector, |pointer| (**pointer));
    forward_line_crossing!([S: CrossedByLine + ?Sized] Rc<S> as S::Vector, |pointer| (**pointer));
    #[cfg(target_has_atomic = "ptr")]
    forward_line_crossing!([S: CrossedByLine + ?Sized] Arc<S> as S::Vector, |pointer| (**pointer));
}

#[cfg(test)]
mod tests {
    use alloc::boxed::Box;
    use alloc::rc::Rc;
    use alloc::sync::Arc;

    use super::*;
    use crate::{Affine, Ball, Capsule, CoreKind, Hint, Posed, Rounded, closest_point, line_crossing, support_value};
    use glam::DVec3;

    /// A capsule has a radius, an extent and closed forms, all of which would be lost without its methods.
    fn is_the_capsule<S: CrossedByLine<Vector = DVec3> + Clone>(pointer: S) {
        let capsule = Capsule::<DVec3>::new(1.0, 0.5).expect("a capsule");
        let d = DVec3::new(1.0, -2.0, 0.5);
        let aside = DVec3::new(0.5, 0.0, 0.0);
        assert_eq!(pointer.support(d), capsule.support(d));
        assert_eq!(support_value(&pointer, d), support_value(&capsule, d));
        assert_eq!(pointer.core_support(d, &mut Hint::new()), capsule.core_support(d, &mut Hint::new()));
        assert_eq!(pointer.core(), capsule.core());
        assert_eq!(
            pointer.core().kind,
            CoreKind::Segment { middle: DVec3::ZERO, half: DVec3::Y },
            "a segment is the core"
        );
        assert_eq!(pointer.core_support_hessian(d, [d, d]), capsule.core_support_hessian(d, [d, d]));
        assert_eq!(pointer.rounding(), capsule.rounding());
        assert_eq!(pointer.core_parallelotope(), capsule.core_parallelotope());
        assert!(pointer.core_parallelotope().is_some(), "a segment");
        assert_eq!(pointer.core_closest_point(d), Some(DVec3::NEG_Y));
        assert_eq!(closest_point(&pointer, d), closest_point(&capsule, d));
        assert!(line_crossing(&capsule, aside - d, d).crossing().is_some(), "a hit");
        assert_eq!(line_crossing(&pointer, aside - d, d), line_crossing(&capsule, aside - d, d));
        let rounded = |radius| Capsule::<DVec3>::new(1.0, 0.5 + radius).expect("a thicker capsule");
        assert_eq!(
            line_crossing(&Rounded::new(pointer.clone(), 0.25).expect("rounded"), aside - d, d),
            line_crossing(&rounded(0.25), aside - d, d)
        );
        let moved = Posed::translated(pointer, DVec3::X).expect("moved");
        assert_eq!(moved.support(d), capsule.support(d) + DVec3::X);
    }

    #[test]
    fn a_point_is_one_behind_a_pointer() {
        let ball: Box<dyn SupportMap<Vector = DVec3>> = Box::new(Ball::new(1.0).expect("a ball"));
        let turned = Affine::new(ball, glam::DMat3::from_diagonal(DVec3::splat(-2.0)), DVec3::X).expect("moved");
        assert_eq!(turned.core().kind, CoreKind::Point(DVec3::ZERO));
        assert_eq!(turned.core_closest_point(DVec3::Y), Some(DVec3::ZERO));
    }

    #[test]
    fn every_pointer_is_the_shape_it_points_to() {
        let capsule = Capsule::<DVec3>::new(1.0, 0.5).expect("a capsule");
        is_the_capsule(&capsule);
        is_the_capsule(Box::new(capsule));
        is_the_capsule(Rc::new(capsule));
        is_the_capsule(Arc::new(capsule));
    }
}
