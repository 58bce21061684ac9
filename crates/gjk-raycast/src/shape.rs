//! A shape behind a pointer, for rare queries that are compiled once.

use convex_support::{Core, Hint, Parallelotope, Rounding, ScalarOf, SupportMap};

/// A shape behind a pointer, mostly [without line crossings](WithoutLines).
pub(crate) type Shape<'s, V> = &'s dyn SupportMap<Vector = V>;

/// A shape for distances and depths, which need neither its crossings by lines nor its feature.
///
/// All methods of a shape behind a pointer are compiled into a program, whether it calls them or not. The closed forms
/// of line crossings are as much code as the whole search for a distance, so they are left out here.
#[derive(Clone, Copy)]
pub(crate) struct WithoutLines<'s, S: ?Sized>(pub(crate) &'s S);

impl<S: SupportMap + ?Sized> SupportMap for WithoutLines<'_, S> {
    type Vector = S::Vector;

    #[inline]
    fn support(&self, direction: S::Vector) -> S::Vector {
        self.0.support(direction)
    }

    #[inline]
    fn core(&self) -> Core<S::Vector> {
        self.0.core()
    }

    #[inline]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        self.0.core_support(direction, hint)
    }

    #[inline]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        self.0.core_support_hessian(direction, changes)
    }

    #[inline]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        self.0.core_closest_point(x)
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        self.0.core_parallelotope()
    }

    #[inline]
    fn rounding(&self) -> Rounding<S::Vector> {
        self.0.rounding()
    }
}
