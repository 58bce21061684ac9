//! The observer of a search, if there is one.

use convex_support::Vector;

use crate::Iterate;

/// An observer of a search, or none. It is behind a pointer, because the searches are compiled once. Iterates are
/// computed only for an observer.
pub(crate) struct Observer<'o, V: Vector>(Option<&'o mut Closure<'o, V>>);

type Closure<'o, V> = dyn FnMut(Iterate<'_, V>) + 'o;

impl<'o, V: Vector> Observer<'o, V> {
    #[inline(always)]
    pub(crate) fn none() -> Self {
        Self(None)
    }

    #[inline(always)]
    pub(crate) fn new(observer: &'o mut dyn FnMut(Iterate<'_, V>)) -> Self {
        Self(Some(observer))
    }

    #[inline(always)]
    pub(crate) fn show<'i>(&mut self, iterate: impl FnOnce() -> Iterate<'i, V>) {
        if let Some(observer) = &mut self.0 {
            observer(iterate());
        }
    }

    #[inline(always)]
    pub(crate) fn is_none(&self) -> bool {
        self.0.is_none()
    }

    /// Runs a search of bodies that may be swapped: the iterates are shown for the bodies in their original order.
    #[inline(always)]
    pub(crate) fn of_swapped<R>(&mut self, is_swapped: bool, search: impl FnOnce(&mut Observer<'_, V>) -> R) -> R {
        let is_watched = is_swapped && !self.is_none();
        let mut reversed = |iterate: Iterate<'_, V>| iterate.reversed(|iterate| self.show(|| iterate));
        search(&mut if is_watched { Observer::new(&mut reversed) } else { self.by_ref() })
    }

    #[inline(always)]
    pub(crate) fn by_ref(&mut self) -> Observer<'_, V> {
        Observer(self.0.as_mut().map(|observer| &mut **observer as _))
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use convex_support::glam::DVec3;

    use super::*;

    /// For swapped bodies, the difference is turned round.
    #[test]
    fn iterates_are_shown_as_of_the_bodies_in_the_order_they_were_given_in() {
        for (is_swapped, sign) in [(false, 1.0), (true, -1.0)] {
            let mut seen = Vec::new();
            let mut watch = |iterate: Iterate<'_, DVec3>| seen.push((iterate.v, iterate.simplex.to_vec()));
            Observer::new(&mut watch).of_swapped(is_swapped, |observer| {
                let (simplex, v) = ([DVec3::X, DVec3::Y], DVec3::new(0.5, 0.5, 0.0));
                let (w, scale, lower, upper) = (DVec3::X, 1.0, 0.0, 1.0);
                observer.show(|| Iterate { iteration: 0, simplex: &simplex, v, w, scale, lower, upper });
            });
            assert_eq!(seen, [(DVec3::new(0.5, 0.5, 0.0) * sign, [DVec3::X * sign, DVec3::Y * sign].to_vec())]);
        }
    }
}
