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
#[doc(alias("ellipsoid_distance", "clearance"))]
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
    ///
    /// Its derivatives are zero where x₁ lies in E₂. Its gradient is continuous, and its second derivatives jump at the
    /// boundary of E₂, where m has none; their block of translations is positive semidefinite, since m is convex in the
    /// centres.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let pair = EllipsoidPair::new(&link, &obstacle, MarginOptions::default());
    /// let gradient = pair.margin().gradient();
    /// // m = ((6 − x)/2 − ½)² − 1 for the link at (x, 0, 0).
    /// assert_eq!(gradient.translation, DVec3::new(-2.5, 0.0, 0.0));
    /// // A joint at (0, −3, 0) about z swings the link towards −x, by 3 a radian.
    /// assert_eq!(gradient.revolute(DVec3::new(0.0, -3.0, 0.0), DVec3::Z), 7.5);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::{DMat3, DVec3}};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// // m = (d/2 − ½)² − 1 for balls of radius 2 and 1 at a distance of d: m″ = ½ along,
    /// // m′/d = (d − 1)/2d across.
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(5.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let pair = EllipsoidPair::new(&link, &obstacle, MarginOptions::default());
    /// let hessian = pair.margin().hessian();
    /// let due = DMat3::from_diagonal(DVec3::new(0.5, 0.4, 0.4));
    /// assert!(DMat3::from_cols_array_2d(&hessian.matrix()).abs_diff_eq(due, 1e-15));
    /// // A ball may turn as it likes.
    /// assert_eq!(hessian.along(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)), 0.0);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[inline]
    pub fn margin(&self) -> Answer<'a, V, Margin<V>> {
        self.answer(free_margin(self.first, self.second, self.options))
    }

    /// The Euclidean [`distance`], certified.
    ///
    /// Its gradient is minus the unit normal, as a force at the closest point of the first. Of its second derivatives
    /// the block of translations is positive semidefinite, with the normal in its kernel; they grow without bound for
    /// bodies of no extent. All are zero where the bodies overlap.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// let link = Ellipsoid::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0), Default::default())?;
    /// let obstacle = Ellipsoid::new(DVec3::new(6.0, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let distance = EllipsoidPair::new(&link, &obstacle, MarginOptions::default()).distance();
    /// assert_eq!(distance.gradient().translation, DVec3::new(-1.0, 0.0, 0.0));
    /// // The tip at (2, 0, 0) swings away from the obstacle to second order only, by (r + r²/ρ)/2·ω².
    /// assert_eq!(distance.gradient().rotation, DVec3::ZERO);
    /// assert!(distance.hessian().along(DVec3::ZERO, DVec3::Z) > 0.0);
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    pub fn distance(&self) -> Answer<'a, V, Distance<V>> {
        self.answer(distance(self.first, self.second, self.options))
    }

    /// The [`distance_bracket`]: bounds on the distance from the margins alone.
    pub fn distance_bracket(&self) -> DistanceBracket<V> {
        distance_bracket(self.first, self.second, self.options)
    }

    /// The common scale at which both touch; see [`scaling`].
    ///
    /// Its gradient tells the way out at any depth, also where the margin has reached its floor. α is homogeneous in
    /// the line of centres: its second derivatives grow as its inverse towards concentric bodies. These have the least
    /// α there is and no derivatives, and zero is the answer.
    ///
    /// ```
    /// use convex_support::{Ellipsoid, glam::DVec3};
    /// use ellip_margin::{EllipsoidPair, MarginOptions};
    ///
    /// // Balls of radius 2 and 1, their centres 0.6 apart: α = distance of the centres/3.
    /// let e1 = Ellipsoid::new(DVec3::ZERO, DVec3::splat(2.0), Default::default())?;
    /// let e2 = Ellipsoid::new(DVec3::new(0.6, 0.0, 0.0), DVec3::ONE, Default::default())?;
    /// let pair = EllipsoidPair::new(&e1, &e2, MarginOptions::default());
    /// assert_eq!(pair.margin().gradient().translation, DVec3::ZERO);
    /// assert!(
    ///     pair.scaling().gradient().translation.abs_diff_eq(DVec3::new(-1.0 / 3.0, 0.0, 0.0), 1e-15)
    /// );
    /// # Ok::<(), convex_support::InvalidShape>(())
    /// ```
    #[doc(alias("growth_distance", "perram_wertheim", "common_scaling"))]
    pub fn scaling(&self) -> Answer<'a, V, Scaling<V>> {
        self.answer(scaling(self.first, self.second, self.options))
    }

    /// The first ellipsoid, E₁.
    #[must_use]
    pub const fn first(&self) -> &'a Ellipsoid<V> {
        self.first
    }

    /// The second ellipsoid, E₂.
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
    /// The first ellipsoid, E₁.
    #[must_use]
    pub const fn first(&self) -> &'a Ellipsoid<V> {
        self.first
    }

    /// The second ellipsoid, E₂.
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
