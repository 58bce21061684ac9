//! Which bodies a ray or a moving shape hits.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{Aabb, Bound, Scalar, SupportMap, SweptBox, Vector, outer_box};
use num_traits::Float;

use super::result::{SceneAnyHit, SceneCast, SceneHits, SceneLinearCast, SceneRayCast, Work, reuse};
use super::single::SingleAnswer;
use super::{Among, Body, BodyHit, Scene};
use crate::{Impact, LinearCastOptions, Motion, Ray, RayCastError, RayCastOptions, RayHit};

/// A hit of a ray and the body that it is of.
type RayBodyHit<V> = BodyHit<RayHit<V>, <V as Vector>::Scalar>;

impl<S: SupportMap> Scene<S> {
    /// The first body that the ray hits: the least λ of [`ray_cast`](crate::ray_cast) for each body.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneRayCast<S::Vector>, RayCastError> {
        self.all().ray_cast(ray, options)
    }

    /// All bodies that the ray hits, in the order of λ and then of their indices, into `hits`, which is emptied first.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast_all(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
        hits: &mut Vec<RayBodyHit<S::Vector>>,
    ) -> Result<SceneHits, RayCastError> {
        self.all().ray_cast_all(ray, options, hits)
    }

    /// Whether the ray hits any body: a shadow ray.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn any_hit(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneAnyHit, RayCastError> {
        self.all().any_hit(ray, options)
    }

    /// The first body that the moving shape meets: the least time of [`linear_cast`](crate::linear_cast) of the shape,
    /// `a`, against each body, `b`. All bodies move with the same velocity, which is zero for a scene at rest: `Motion
    /// { velocity_a, ..Motion::default() }`.
    ///
    /// # Errors
    /// As of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
    ) -> Result<SceneLinearCast<S::Vector>, RayCastError> {
        self.all().linear_cast(shape, motion, options)
    }

    /// All bodies that the moving shape meets, in the order of the time and then of their indices, into `hits`, which is
    /// emptied first: the hits of [`linear_cast`](crate::linear_cast) against each body, as if it were alone.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{LinearCastOptions, Motion, Scene};
    ///
    /// // What does a plough push that goes along x?
    /// let ball_at = |x, y| Posed::translated(Ball::new(0.5)?, DVec2::new(x, y));
    /// let scene = Scene::new([ball_at(7.0, 0.0)?, ball_at(3.0, 4.0)?, ball_at(4.0, 0.0)?])?;
    /// let motion = Motion { velocity_a: DVec2::X, ..Motion::default() };
    /// let mut hits = Vec::new();
    /// let _ = scene.linear_cast_all(&Ball::new(0.5)?, motion, LinearCastOptions::new(), &mut hits)?;
    /// let times: Vec<_> = hits.iter().map(|found| (found.body, found.hit.time)).collect();
    /// assert_eq!(times, [(2, 3.0), (0, 6.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast_all<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
        hits: &mut Vec<BodyHit<Impact<S::Vector>, Number<S>>>,
    ) -> Result<SceneHits, RayCastError> {
        self.all().linear_cast_all(shape, motion, options, hits)
    }

    /// [`ray_cast`](Self::ray_cast) for each of many rays, on all threads of the current [rayon](https://docs.rs/rayon)
    /// pool.
    #[cfg(feature = "rayon")]
    pub fn par_ray_casts(
        &self,
        rays: &[Ray<S::Vector>],
        options: RayCastOptions<S::Vector>,
    ) -> Vec<Result<SceneRayCast<S::Vector>, RayCastError>>
    where
        S: Sync,
    {
        use rayon::prelude::*;
        rays.par_iter().map(|&ray| self.ray_cast(ray, options)).collect()
    }
}

impl<S: SupportMap> Among<'_, S> {
    /// [`Scene::ray_cast`] among these bodies.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneRayCast<S::Vector>, RayCastError> {
        ray.check(&options)?;
        self.first(&swept_point(ray), options.max_lambda, |body| Ok(body.ray_cast(ray, options)?.into()))
    }

    /// [`Scene::ray_cast_all`] among these bodies.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast_all(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
        hits: &mut Vec<RayBodyHit<S::Vector>>,
    ) -> Result<SceneHits, RayCastError> {
        ray.check(&options)?;
        let ask = |body: &Body<S>| Ok(body.ray_cast(ray, options)?.into());
        self.all_hits(&swept_point(ray), options.max_lambda, hits, |hit| hit.lambda, ask)
    }

    /// [`Scene::any_hit`] among these bodies.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn any_hit(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneAnyHit, RayCastError> {
        ray.check(&options)?;
        let (mut hit, mut is_certain, mut undecided) = (false, false, None);
        let work = self.each(&swept_point(ray), options.max_lambda, |index, body| {
            let cast = body.ray_cast(ray, options)?;
            hit |= cast.outcome.is_hit();
            is_certain = cast.outcome.is_hit() && cast.is_certain();
            if !cast.is_certain() {
                undecided = Some(undecided.map_or(index, |lowest: usize| lowest.min(index)));
            }
            Ok(if is_certain { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })?;
        Ok(SceneAnyHit { hit, undecided: undecided.filter(|_| !is_certain), work })
    }

    /// [`Scene::linear_cast`] among these bodies.
    ///
    /// # Errors
    /// As of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
    ) -> Result<SceneLinearCast<S::Vector>, RayCastError> {
        motion.check(&options)?;
        let swept = swept_shape(shape, motion, &options);
        self.first(&swept, options.max_time, |body| Ok(body.linear_cast(shape, motion, options)?.into()))
    }

    /// [`Scene::linear_cast_all`] among these bodies.
    ///
    /// # Errors
    /// As of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast_all<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
        hits: &mut Vec<BodyHit<Impact<S::Vector>, Number<S>>>,
    ) -> Result<SceneHits, RayCastError> {
        motion.check(&options)?;
        let ask = |body: &Body<S>| Ok(body.linear_cast(shape, motion, options)?.into());
        self.all_hits(&swept_shape(shape, motion, &options), options.max_time, hits, |hit| hit.time, ask)
    }

    /// All hits of bodies that `bound` does not leave out, in the order of their λ or time and then of their indices.
    fn all_hits<H: Copy, B: Bound<S::Vector>>(
        &self,
        bound: &B,
        end: Number<S>,
        hits: &mut Vec<BodyHit<H, Number<S>>>,
        value: impl Fn(&H) -> Number<S>,
        ask: impl Fn(&Body<S>) -> Result<SingleAnswer<H, Number<S>>, RayCastError>,
    ) -> Result<SceneHits, RayCastError> {
        let hits = reuse(hits);
        let mut undecided = None;
        let work = self.each(bound, end, |index, body| {
            let single = ask(body)?;
            if single.is_undecided {
                undecided = Some(undecided.map_or(index, |lowest: usize| lowest.min(index)));
            }
            hits.extend(single.of(index));
            Ok(ControlFlow::Continue(()))
        })?;
        hits.sort_unstable_by(|p, q| {
            let (a, b) = (value(&p.hit), value(&q.hit));
            a.partial_cmp(&b).unwrap_or(core::cmp::Ordering::Equal).then(p.body.cmp(&q.body))
        });
        Ok(SceneHits { undecided, work })
    }

    /// The first hit of all bodies that `bound` does not leave out; `ask` makes the single cast.
    pub(super) fn first<H: Copy, B: Bound<S::Vector>>(
        &self,
        bound: &B,
        end: Number<S>,
        mut ask: impl FnMut(&Body<S>) -> Result<SingleAnswer<H, Number<S>>, RayCastError>,
    ) -> Result<SceneCast<H, Number<S>>, RayCastError> {
        let mut first = FirstHit { hit: None, open: None, lower: Number::<S>::infinity() };
        let mut error = None;
        // A body is hit where its box begins at the earliest.
        let work = self.in_order(bound, end, |index, from, body| {
            match ask(body) {
                Ok(single) => first.take(index, from, single),
                Err(refused) => {
                    error = Some(refused);
                    return ControlFlow::Break(());
                }
            }
            ControlFlow::Continue(first.hit.map_or((end, usize::MAX), |(key, hit)| (key, hit.body)))
        });
        if let Some(error) = error {
            return Err(error);
        }
        let FirstHit { hit, open, lower } = first;
        let undecided = open.filter(|&open| hit.is_none_or(|(key, hit)| open < (key, hit.body))).map(|(_, body)| body);
        let lower = if work.cancelled { Number::<S>::ZERO } else { lower };
        Ok(SceneCast { first: hit.map(|(_, hit)| hit), lower, undecided, work })
    }

    /// Shows every body that `bound` does not leave out, those with the least bound mostly first.
    fn each<B: Bound<S::Vector>>(
        &self,
        bound: &B,
        end: Number<S>,
        mut ask: impl FnMut(usize, &Body<S>) -> Result<ControlFlow<()>, RayCastError>,
    ) -> Result<Work, RayCastError> {
        let mut outcome = Ok(ControlFlow::Continue(()));
        let work = self.in_order(bound, end, |index, _, body| {
            outcome = ask(index, body);
            match outcome {
                Ok(ControlFlow::Continue(())) => ControlFlow::Continue((end, usize::MAX)),
                _ => ControlFlow::Break(()),
            }
        });
        outcome.map(|_| work)
    }
}

/// The scalar of a scene.
type Number<S> = convex_support::ScalarOf<S>;

/// The first hit so far.
///
/// A body counts from its *key*: the λ of its hit, or where its box begins if that is later, as it cannot be where the
/// hit's bracket is closed. Keys, and all that is kept here, are minima over bodies, in which one that was left out by
/// its box takes no part: so the order in which bodies are met does not matter, nor which others were met.
struct FirstHit<H, S> {
    /// The least key, with the hit.
    hit: Option<(S, BodyHit<H, S>)>,
    /// Where an undecided body may be hit at the earliest, and which.
    open: Option<(S, usize)>,
    /// Nothing is hit before.
    lower: S,
}

impl<H: Copy, S: Scalar> FirstHit<H, S> {
    /// Takes the cast of a body whose box begins at `from`.
    fn take(&mut self, body: usize, from: S, single: SingleAnswer<H, S>) {
        let start = Float::max(single.lower, from);
        if single.is_undecided {
            self.lower = Float::min(self.lower, start);
            if self.open.is_none_or(|open| (start, body) < open) {
                self.open = Some((start, body));
            }
        }
        if let Some((value, _)) = single.hit {
            self.lower = Float::min(self.lower, start);
            let key = Float::max(value, from);
            if self.hit.is_none_or(|(least, hit)| (key, body) < (least, hit.body)) {
                self.hit = single.of(body).map(|hit| (key, hit));
            }
        }
    }
}

/// A ray, with room for the rounding of its points: 32 ε of the source.
fn swept_point<V: Vector>(ray: Ray<V>) -> SweptBox<V> {
    let room = V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * ray.source.abs().dot(V::ONE);
    SweptBox::new(V::splat(room), ray.source, ray.direction)
}

/// A box with room for a distance from it, if that is positive.
fn grown<V: Vector>(around: Aabb<V>, distance: V::Scalar) -> Aabb<V> {
    let room = V::splat(if distance > V::Scalar::ZERO { distance } else { V::Scalar::ZERO });
    Aabb { min: around.min - room, max: around.max + room }
}

/// The box of a shape that moves, as seen from the bodies.
fn swept_shape<A: SupportMap + ?Sized>(
    shape: &A,
    motion: Motion<A::Vector>,
    options: &LinearCastOptions<A::Vector>,
) -> SweptBox<A::Vector> {
    let around = grown(outer_box_of_question(shape), options.target_distance);
    swept_box(around, motion.velocity_a - motion.velocity_b)
}

/// A box that moves.
fn swept_box<V: Vector>(around: Aabb<V>, velocity: V) -> SweptBox<V> {
    let (center, half) = (around.center(), around.half_extents());
    // The two are rounded.
    let room = (center.abs() + half) * (V::Scalar::from_f64(4.0) * V::Scalar::EPSILON);
    SweptBox::new(half + room, center, velocity)
}

/// The box of a shape that a scene is asked about: one that contains everything where a number of the shape is not
/// finite, so that no body is left out and every single query says so.
pub(super) fn outer_box_of_question<S: SupportMap + ?Sized>(shape: &S) -> Aabb<S::Vector> {
    let all = S::Vector::splat(Number::<S>::max_value());
    outer_box(shape).unwrap_or(Aabb { min: -all, max: all })
}
