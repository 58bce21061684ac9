//! What a search shows: its iterates while it runs, if there is an observer, and how it ended.

use convex_support::{Scalar as _, Vector};

use crate::simplex::MAX_POINTS;

/// How an iterative method ended. The bounds of the answer hold in every case.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Status {
    /// The bracket is as narrow as was asked for, or as narrow as rounding allows. A hit also has an upper bound.
    Converged,
    /// The iterations were used up before the bracket was that narrow.
    IterationLimit,
    /// No further progress was possible in floating point before the bracket was that narrow, for example if a hit may
    /// be a miss, or is certain only some way behind where it is found; or a support map returned numbers that are not
    /// finite.
    Stalled,
}

/// The state of an iteration that an observer sees.
///
/// Its points and vectors are those of the configuration space obstacle, relative to the query point: the points of
/// `A − B` for [`distance`](crate::distance) and [`intersects`](crate::intersects), and for casts the points `x − p`
/// of `{x} − C`, with the current point `x` of the ray. So in every case the iteration searches for zero.
#[derive(Clone, Copy, Debug)]
pub struct Iterate<'a, V: Vector> {
    /// The number of the iterate, from 0. The first has an empty simplex and the first direction for its `v`. If a
    /// shape knows its [closest point](convex_support::SupportMap::core_closest_point), the first simplex is that
    /// point.
    pub iteration: usize,
    /// The vertices of the simplex that `v` lies in (the paper's `W`, `S_k` in the book), relative to the query point,
    /// in units of `scale`; empty at first.
    pub simplex: &'a [V],
    /// The point of the simplex closest to zero (`V_k`), in units of `scale`; in the first iterate, the first
    /// direction.
    pub v: V,
    /// The support point found along `v` (`W_k`), in units of `scale`. In 3D the direction may have been turned from
    /// `v`, by curvature or towards the best plane known.
    pub w: V,
    /// The factor, a power of two, that turns the vectors above into lengths of the world.
    pub scale: V::Scalar,
    /// The lower bound: of the distance of the cores; or of the hit parameter λ, by the support points so far. What
    /// rounding does to it is not counted, as it is in an answer's bounds.
    pub lower: V::Scalar,
    /// The upper bound of the same value.
    pub upper: V::Scalar,
}

impl<V: Vector> Iterate<'_, V> {
    /// Shows the iterate for the bodies in the other order.
    #[inline(always)]
    pub(crate) fn reversed(&self, observer: impl FnOnce(Iterate<'_, V>)) {
        let mut simplex = [V::ZERO; MAX_POINTS];
        for (reversed, &point) in simplex.iter_mut().zip(self.simplex) {
            *reversed = -point;
        }
        observer(Iterate { simplex: &simplex[..self.simplex.len()], v: -self.v, w: -self.w, ..*self });
    }

    /// The width of the bracket.
    #[must_use]
    pub fn gap(&self) -> V::Scalar {
        let gap = self.upper - self.lower;
        if gap > V::Scalar::ZERO { gap } else { V::Scalar::ZERO }
    }
}

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
