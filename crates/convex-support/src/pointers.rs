//! References, boxes and shared pointers to a shape are that shape.

use alloc::boxed::Box;
use alloc::rc::Rc;
#[cfg(target_has_atomic = "ptr")]
use alloc::sync::Arc;

use crate::{ClosestPoint, Crossing, Hint, LineCrossing, RoundedLineCrossing, ScalarOf, SupportMap};

/// Forwards every method, the provided ones too, to what is pointed at.
macro_rules! pointer {
    ($pointer:ty) => {
        impl<S: SupportMap + ?Sized> SupportMap for $pointer {
            type Vector = S::Vector;

            #[inline]
            fn support(&self, direction: S::Vector) -> S::Vector {
                (**self).support(direction)
            }

            #[inline]
            fn support_value(&self, direction: S::Vector) -> ScalarOf<S> {
                (**self).support_value(direction)
            }

            #[inline]
            fn origin(&self) -> S::Vector {
                (**self).origin()
            }

            #[inline(always)]
            fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
                (**self).core_support(direction, hint)
            }

            #[inline(always)]
            fn core_support_derivative(&self, direction: S::Vector, change: S::Vector) -> S::Vector {
                (**self).core_support_derivative(direction, change)
            }

            #[inline(always)]
            fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
                (**self).core_support_hessian(direction, changes)
            }

            #[inline]
            fn radius(&self) -> ScalarOf<S> {
                (**self).radius()
            }

            #[inline]
            fn is_core_polyhedral(&self) -> bool {
                (**self).is_core_polyhedral()
            }

            #[inline(always)]
            fn core_point(&self) -> Option<S::Vector> {
                (**self).core_point()
            }

            #[inline(always)]
            fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
                (**self).core_closest_point(x)
            }

            #[inline]
            fn core_extent(&self) -> ScalarOf<S> {
                (**self).core_extent()
            }
        }

        impl<S: ClosestPoint + ?Sized> ClosestPoint for $pointer {
            #[inline]
            fn closest_point(&self, x: S::Vector) -> S::Vector {
                (**self).closest_point(x)
            }
        }

        impl<S: LineCrossing + ?Sized> LineCrossing for $pointer {
            #[inline]
            fn line_crossing(&self, source: S::Vector, direction: S::Vector) -> Option<Crossing<S::Vector>> {
                (**self).line_crossing(source, direction)
            }
        }

        impl<S: RoundedLineCrossing + ?Sized> RoundedLineCrossing for $pointer {
            #[inline]
            fn rounded_line_crossing(
                &self,
                radius: ScalarOf<S>,
                source: S::Vector,
                direction: S::Vector,
            ) -> Option<Crossing<S::Vector>> {
                (**self).rounded_line_crossing(radius, source, direction)
            }
        }
    };
}

pointer!(&S);
pointer!(Box<S>);
pointer!(Rc<S>);
#[cfg(target_has_atomic = "ptr")]
pointer!(Arc<S>);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Affine, Ball, Capsule, Posed, Rounded};
    use glam::DVec3;

    /// A capsule has a radius, an extent and closed forms, all of which a forgotten method would lose.
    fn is_the_capsule<S: ClosestPoint<Vector = DVec3> + LineCrossing + RoundedLineCrossing + Clone>(pointer: S) {
        let capsule = Capsule::<DVec3>::new(1.0, 0.5).expect("a capsule");
        let d = DVec3::new(1.0, -2.0, 0.5);
        let aside = DVec3::new(0.5, 0.0, 0.0);
        assert_eq!(pointer.support(d), capsule.support(d));
        assert_eq!(pointer.support_value(d), capsule.support_value(d));
        assert_eq!(pointer.core_support(d, &mut Hint::new()), capsule.core_support(d, &mut Hint::new()));
        assert_eq!(pointer.radius(), 0.5);
        assert!(pointer.is_core_polyhedral(), "a segment is the core");
        assert_eq!(pointer.core_extent(), capsule.core_extent());
        assert_eq!(pointer.core_closest_point(d), Some(DVec3::NEG_Y));
        assert_eq!(pointer.closest_point(d), capsule.closest_point(d));
        assert_eq!(pointer.line_crossing(aside - d, d), capsule.line_crossing(aside - d, d));
        let rounded = |radius| Capsule::<DVec3>::new(1.0, 0.5 + radius).expect("a thicker capsule");
        assert_eq!(
            Rounded::new(pointer.clone(), 0.25).expect("rounded").line_crossing(aside - d, d),
            rounded(0.25).line_crossing(aside - d, d)
        );
        let moved = Posed::translated(pointer, DVec3::X).expect("moved");
        assert_eq!(moved.support(d), capsule.support(d) + DVec3::X);
    }

    #[test]
    fn a_point_is_one_behind_a_pointer() {
        let ball: Box<dyn SupportMap<Vector = DVec3>> = Box::new(Ball::new(1.0).expect("a ball"));
        let turned = Affine::new(ball, glam::DMat3::from_diagonal(DVec3::splat(-2.0)), DVec3::X).expect("moved");
        assert_eq!(turned.core_point(), Some(DVec3::ZERO));
        assert_eq!(turned.core_closest_point(DVec3::Y), Some(DVec3::ZERO));
        assert_eq!(Capsule::<DVec3>::new(1.0, 0.5).expect("a capsule").core_point(), None);
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
