//! A pair of ellipsoids, and answers that refer to their pair.

use core::ops::Deref;

use convex_support::{Ellipsoid, Vector};

use crate::{
    Distance, DistanceBracket, Margin, MarginOptions, Scaling, distance, distance_bracket, free_margin, scaling,
};

/// Two ellipsoids, with methods for their margin, their distance and their common scale, each with derivatives.
///
/// A value is computed only when its method is called. An [`Answer`] refers to the same two ellipsoids, so that its
/// derivatives cannot be those of others.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use ellip_margin::{EllipsoidPair, MarginOptions};
///
/// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 0.5), Default::default())?;
/// let obstacle =
///     Ellipsoid::new(DVec3::new(3.0, 2.0, 1.0), DVec3::new(0.5, 0.5, 1.0), Default::default())?;
/// let pair = EllipsoidPair::new(&link, &obstacle, MarginOptions::default());
///
/// let margin = pair.margin();
/// assert!(margin.margin > 0.0 && margin.gradient().translation.y < 0.0);
/// let distance = pair.distance();
/// // Away from the obstacle at unit speed the distance grows at unit speed, and no faster later.
/// let away = -distance.bracket.normal;
/// assert!((distance.gradient().prismatic(away) - 1.0).abs() < 1e-14);
/// assert!(distance.hessian().along(away, DVec3::ZERO).abs() < 1e-14);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipsoidPair<'a, V: Vector> {
    first: &'a Ellipsoid<V>,
    second: &'a Ellipsoid<V>,
    options: MarginOptions,
}

impl<'a, V: Vector> EllipsoidPair<'a, V> {
    /// The pair E₁, E₂, with the options of each answer.
    #[must_use]
    #[inline]
    pub const fn new(first: &'a Ellipsoid<V>, second: &'a Ellipsoid<V>, options: MarginOptions) -> Self {
        Self { first, second, options }
    }

    /// The [`free_margin`] of the first about the second.
    #[inline]
    pub fn margin(&self) -> Answer<'a, V, Margin<V>> {
        self.answer(free_margin(self.first, self.second, self.options))
    }

    /// The Euclidean [`distance`], certified.
    pub fn distance(&self) -> Answer<'a, V, Distance<V>> {
        self.answer(distance(self.first, self.second, self.options))
    }

    /// The [`distance_bracket`]: bounds on the distance from the margins alone.
    pub fn distance_bracket(&self) -> DistanceBracket<V> {
        distance_bracket(self.first, self.second, self.options)
    }

    /// The common scale at which both touch; see [`scaling`].
    pub fn scaling(&self) -> Answer<'a, V, Scaling<V>> {
        self.answer(scaling(self.first, self.second, self.options))
    }

    /// E₁.
    #[must_use]
    pub const fn first(&self) -> &'a Ellipsoid<V> {
        self.first
    }

    /// E₂.
    #[must_use]
    pub const fn second(&self) -> &'a Ellipsoid<V> {
        self.second
    }

    #[inline]
    pub(crate) fn answer<A>(&self, answer: A) -> Answer<'a, V, A> {
        Answer { first: self.first, second: self.second, answer }
    }
}

/// An answer about a pair, together with the pair. It dereferences to the answer itself, and has the methods
/// `gradient`, `gradient_of_second`, `hessian` and `hessian_of_second`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Answer<'a, V: Vector, A> {
    first: &'a Ellipsoid<V>,
    second: &'a Ellipsoid<V>,
    answer: A,
}

impl<'a, V: Vector, A> Answer<'a, V, A> {
    /// E₁.
    #[must_use]
    pub const fn first(&self) -> &'a Ellipsoid<V> {
        self.first
    }

    /// E₂.
    #[must_use]
    pub const fn second(&self) -> &'a Ellipsoid<V> {
        self.second
    }
}

impl<V: Vector, A> Deref for Answer<'_, V, A> {
    type Target = A;

    #[inline]
    fn deref(&self) -> &A {
        &self.answer
    }
}
