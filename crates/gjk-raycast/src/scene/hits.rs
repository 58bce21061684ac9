//! Which bodies does a ray or a moving shape hit, and which first? Those whose boxes meet what it sweeps are cast one
//! by one, earliest boxes first, until no box is earlier than a hit. If bodies move by themselves, see
//! [`moving_pairs`](super::moving_pairs).

use alloc::vec::Vec;
use core::ops::ControlFlow;

use convex_support::{Aabb, Bound, Scalar, ScalarOf, SupportMap, Vector, outer_box};
use num_traits::Float;

use super::Work;
use super::among::Among;
use super::answers::{
    BodyHit, SceneAnyHit, SceneCast, SceneHits, SceneLinearCast, SceneMotionCast, SceneRayCast, reuse,
};
use super::asked::{Asked, asked};
use super::body::seen_from;
use super::bounds::{Moving, MovingBalls, Question};
use super::instance::Id;
use crate::motion::{check, checked};
use crate::{
    Cast, ChainMotion, Impact, LinearCastOptions, Motion, MotionCastOptions, Ray, RayCastError, RayCastOptions, RayHit,
    RigidMotion, Trajectory,
};

impl<S: SupportMap> Among<'_, S> {
    /// The first body that the ray hits: the least λ of [`ray_cast`](crate::ray_cast) against each body.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneRayCast<S::Vector>, RayCastError> {
        ray.check(&options)?;
        let ask = |body: Asked<'_, '_, S>| asked!(body, body => body.ray_cast(ray, options));
        self.first(&swept_point(ray), options.max_lambda, ask, |hit| hit.lambda)
    }

    /// [`ray_cast`](Self::ray_cast) for each of many rays, written into a slice. Nothing is allocated.
    ///
    /// Each eight rays in a row share a search of the tree if they are near one another, such as those of a lidar or a
    /// picture: they take about half of the time. Each answer is that of the ray alone, but for the [`Work`]: the nodes
    /// are those of the shared search.
    ///
    /// ```
    /// use convex_support::{Ball, Posed, glam::DVec2};
    /// use gjk_raycast::{Ray, RayCastOptions, Scene, SceneCast};
    ///
    /// let ball_at = |x, y| Posed::translated(Ball::new(0.5)?, DVec2::new(x, y));
    /// let scene = Scene::new([ball_at(3.0, 0.0)?, ball_at(0.0, 5.0)?])?;
    /// let rays = [DVec2::X, DVec2::Y, DVec2::NEG_X].map(|direction| Ray { source: DVec2::ZERO, direction });
    /// let mut casts = [SceneCast::default(); 3];
    /// scene.all().ray_casts_into(&rays, RayCastOptions::new(), &mut casts)?;
    /// let first = casts.map(|cast| cast.first.map(|first| (first.body, first.hit.lambda)));
    /// assert_eq!(first, [Some((0, 2.5)), Some((1, 4.5)), None]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RayCastError`] of the first ray that has one. Then no answer is written.
    ///
    /// # Panics
    /// If the number of answers is not the number of rays.
    pub fn ray_casts_into(
        &self,
        rays: &[Ray<S::Vector>],
        options: RayCastOptions<S::Vector>,
        casts: &mut [SceneRayCast<S::Vector>],
    ) -> Result<(), RayCastError> {
        assert_eq!(rays.len(), casts.len(), "there must be as many answers as rays");
        rays.iter().try_for_each(|ray| ray.check(&options))?;
        for (rays, casts) in rays.chunks(BUNDLE).zip(casts.chunks_mut(BUNDLE)) {
            if !self.bundle(rays, options, casts)? {
                for (&ray, cast) in rays.iter().zip(casts) {
                    *cast = self.ray_cast(ray, options)?;
                }
            }
        }
        Ok(())
    }

    /// Finds all bodies that the ray hits. Writes them into `hits`, which is emptied first, in the order of λ and then
    /// of their indices.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero, a coordinate not finite, or an end of the ray NaN.
    pub fn ray_cast_all(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
        hits: &mut Vec<BodyHit<RayHit<S::Vector>, ScalarOf<S>>>,
    ) -> Result<SceneHits, RayCastError> {
        ray.check(&options)?;
        let ask = |body: Asked<'_, '_, S>| asked!(body, body => body.ray_cast(ray, options));
        self.all_hits(&swept_point(ray), options.max_lambda, hits, ask, |hit| hit.lambda)
    }

    /// [`ray_cast`](Self::ray_cast) for each of many rays, on all threads of the current [rayon](https://docs.rs/rayon)
    /// pool, with the searches of [`ray_casts_into`](Self::ray_casts_into).
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
        let each = rays.par_chunks(BUNDLE).flat_map_iter(|rays| {
            let mut casts = [SceneCast::default(); BUNDLE];
            let all = self.ray_casts_into(rays, options, &mut casts[..rays.len()]);
            let of = move |(cast, &ray)| all.map_or_else(|_| self.ray_cast(ray, options), |()| Ok(cast));
            casts.into_iter().zip(rays).map(of)
        });
        each.collect()
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
        ray.check(&options)?;
        let (mut hit, mut is_certain, mut undecided) = (false, false, None::<usize>);
        let all = (options.max_lambda, Id::LAST);
        let work = self.in_order(&swept_point(ray), options.max_lambda, |Id { body: index, .. }, _, body| {
            let cast = asked!(body, body => body.ray_cast(ray, options))?;
            hit |= cast.outcome.is_hit();
            is_certain = cast.outcome.is_hit() && cast.is_certain();
            if !cast.is_certain() {
                undecided = Some(undecided.unwrap_or(index).min(index));
            }
            Ok(if is_certain { ControlFlow::Break(()) } else { ControlFlow::Continue(all) })
        })?;
        Ok(SceneAnyHit { hit, undecided: undecided.filter(|_| !is_certain), work })
    }

    /// The first body that the moving shape meets: the least time of [`linear_cast`](crate::linear_cast) of the shape,
    /// `a`, against each body, `b`. All bodies move with the same velocity, which is zero for a scene at rest:
    /// `Motion { velocity_a, ..Motion::default() }`.
    ///
    /// # Errors
    /// Those of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
    ) -> Result<SceneLinearCast<S::Vector>, RayCastError> {
        motion.check(&options)?;
        let swept = swept_shape(shape, motion, &options);
        let ask = |body: Asked<'_, '_, S>| asked!(body, body => body.linear_cast(shape, motion, options));
        self.first(&swept, options.max_time, ask, |hit| hit.time)
    }

    /// Finds all bodies that the moving shape meets: the hits of [`linear_cast`](crate::linear_cast) against each body,
    /// as if it were alone. Writes them into `hits`, which is emptied first, in the order of the time and then of their
    /// indices.
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
    /// let _ = scene.all().linear_cast_all(&Ball::new(0.5)?, motion, LinearCastOptions::new(), &mut hits)?;
    /// let times: Vec<_> = hits.iter().map(|found| (found.body, found.hit.time)).collect();
    /// assert_eq!(times, [(2, 3.0), (0, 6.0)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`linear_cast`](crate::linear_cast()).
    pub fn linear_cast_all<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: Motion<S::Vector>,
        options: LinearCastOptions<S::Vector>,
        hits: &mut Vec<BodyHit<Impact<S::Vector>, ScalarOf<S>>>,
    ) -> Result<SceneHits, RayCastError> {
        motion.check(&options)?;
        let ask = |body: Asked<'_, '_, S>| asked!(body, body => body.linear_cast(shape, motion, options));
        self.all_hits(&swept_shape(shape, motion, &options), options.max_time, hits, ask, |hit| hit.time)
    }

    /// The first body that a shape meets as it moves and turns among bodies at rest: the least time of
    /// [`motion_cast`](crate::motion_cast()) of the shape, `a`, against each body, `b`.
    ///
    /// ```
    /// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, Scene};
    ///
    /// // A blade turns about z, once a second, among balls.
    /// let ball_at = |x, y| Posed::translated(Ball::new(0.5)?, DVec3::new(x, y, 0.0));
    /// let scene = Scene::new([ball_at(-1.0, 0.0)?, ball_at(0.0, 3.0)?, ball_at(1.0, 1.0)?])?;
    /// let blade = Capsule::new(1.0, 0.0)?; // along y
    /// let turning = RigidMotion::rotation(DVec3::Z * std::f64::consts::TAU, DVec3::ZERO);
    /// let answer = scene.all().motion_cast(&blade, turning, MotionCastOptions::new().with_max_time(1.0))?;
    /// let first = answer.first.ok_or("two are in the way")?;
    /// assert_eq!(first.body, 0);
    /// // After 60°, as the first ball reaches 30° to both sides.
    /// assert!((first.hit.time - 1.0 / 6.0).abs() < 1e-14);
    /// assert_eq!(answer.work.culled, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: impl Trajectory<Vector = S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneMotionCast<S::Vector>, RayCastError> {
        check("motion", &motion)?;
        let options = checked(options)?;
        let balls = MovingBalls::new(shape, &motion, &options);
        let ask = |body: Asked<'_, '_, S>| asked!(body, body => body.motion_cast(shape, &motion, options, |_| {}));
        self.first(&balls, options.max_time, ask, |hit| hit.time)
    }

    /// The first body that a shape meets as both move. All bodies share one rigid motion, such as loads on a vehicle or
    /// on a gripper. The answer is the least time of [`motion_cast`](crate::motion_cast()) of the shape, `a`, against
    /// each body, `b`; the point and the normal are those in the world at that time.
    ///
    /// ```
    /// use convex_support::{Ball, Capsule, Posed, glam::DVec3};
    /// use gjk_raycast::{MotionCastOptions, RigidMotion, Scene};
    ///
    /// // Two balls on a turntable, and a bar that is let down between them.
    /// let ball_at = |x| Posed::translated(Ball::new(0.5)?, DVec3::new(x, 0.0, 0.0));
    /// let balls = Scene::new([ball_at(2.0)?, ball_at(-3.0)?])?;
    /// let table = RigidMotion::rotation(DVec3::Y, DVec3::ZERO);
    /// let bar = Posed::translated(Capsule::new(1.0, 0.1)?, DVec3::new(0.0, 2.0, 2.0))?;
    /// let down = RigidMotion::translation(DVec3::NEG_Y * 0.3);
    /// let cast = balls.all().motion_cast_of_both(&bar, down, table, MotionCastOptions::new().with_max_time(6.0))?;
    /// // The first ball comes there after three quarters of a turn, and its rim a little before.
    /// let first = cast.first.ok_or("they meet")?;
    /// assert_eq!(first.body, 0);
    /// assert!(4.2 < first.hit.time && first.hit.time < 4.71);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`motion_cast`](crate::motion_cast()).
    pub fn motion_cast_of_both<A: SupportMap<Vector = S::Vector> + ?Sized>(
        &self,
        shape: &A,
        motion: RigidMotion<S::Vector>,
        of_bodies: RigidMotion<S::Vector>,
        options: MotionCastOptions<S::Vector>,
    ) -> Result<SceneMotionCast<S::Vector>, RayCastError> {
        check("motion", &motion)?;
        check("of_bodies", &of_bodies)?;
        let options = checked(options)?;
        let seen = seen_from(of_bodies, motion);
        let balls = MovingBalls::new(shape, &ChainMotion::new(&seen), &options);
        let ask =
            |body: Asked<'_, '_, S>| asked!(body, body => body.motion_cast_of_both(shape, motion, of_bodies, options));
        self.first(&balls, options.max_time, ask, |hit| hit.time)
    }

    /// All hits of bodies that `bound` does not leave out, in the order of their λ or time and then of their indices.
    fn all_hits<H: Copy, Q: Question<S::Vector>>(
        &self,
        bound: &Q,
        end: ScalarOf<S>,
        hits: &mut Vec<BodyHit<H, ScalarOf<S>>>,
        ask: impl Fn(Asked<'_, '_, S>) -> Result<Cast<H, S::Vector>, RayCastError>,
        value: impl Fn(&H) -> ScalarOf<S>,
    ) -> Result<SceneHits, RayCastError> {
        let hits = reuse(hits);
        let mut undecided = None::<usize>;
        let work = self.in_order(bound, end, |id, _, body| {
            let cast = ask(body)?;
            if cast.outcome.is_undecided() {
                undecided = Some(undecided.map_or(id.body, |lowest: usize| lowest.min(id.body)));
            }
            hits.extend(BodyHit::of(id, &cast));
            Ok(ControlFlow::Continue((end, Id::LAST)))
        })?;
        hits.sort_unstable_by(|p, q| {
            let (a, b) = (value(&p.hit), value(&q.hit));
            a.partial_cmp(&b).unwrap_or(core::cmp::Ordering::Equal).then((p.body, p.member).cmp(&(q.body, q.member)))
        });
        Ok(SceneHits { undecided, work })
    }

    /// The first hit of all bodies that `bound` does not leave out; `ask` makes the single cast, and `value` is the λ
    /// or the time of a hit.
    fn first<H: Copy, Q: Question<S::Vector>>(
        &self,
        bound: &Q,
        end: ScalarOf<S>,
        ask: impl Fn(Asked<'_, '_, S>) -> Result<Cast<H, S::Vector>, RayCastError>,
        value: impl Fn(&H) -> ScalarOf<S>,
    ) -> Result<SceneCast<H, ScalarOf<S>>, RayCastError> {
        let mut found = First::default();
        let work = self.in_order(bound, end, |id, from, body| {
            let cast = ask(body)?;
            found.add(id, from, &cast, BodyHit::of(id, &cast).map(|hit| (value(&hit.hit), hit)));
            Ok(ControlFlow::Continue(found.limit((end, Id::LAST))))
        })?;
        Ok(found.answer(work))
    }

    /// The first hit of each of a few rays by one search. False, and nothing is written, if the rays are too far from
    /// one another for that to be quicker.
    fn bundle(
        &self,
        rays: &[Ray<S::Vector>],
        options: RayCastOptions<S::Vector>,
        casts: &mut [SceneRayCast<S::Vector>],
    ) -> Result<bool, RayCastError> {
        let (end, all) = (options.max_lambda, (options.max_lambda, Id::LAST));
        let swept: [_; BUNDLE] = core::array::from_fn(|k| swept_point(rays[k.min(rays.len() - 1)]));
        // In the frames of instances, rays that are near one another hardly ever have directions of the same signs.
        let around = Moving::all(swept).filter(|_| self.scene.members == self.scene.len());
        let Some(around) = around else { return Ok(false) };
        let (mut found, mut tested, mut visited) = ([First::default(); BUNDLE], [0; BUNDLE], 0);
        let work = self.in_order(&around, end, |id, _, body| {
            let around = match body {
                Asked::Own(_) => self.scene.tree.get(id.body),
                Asked::Member(_, around) => Some(around),
            };
            visited += usize::from(around.is_some());
            if visited > MOST_VISITED {
                return Ok(ControlFlow::Break(()));
            }
            for (k, &ray) in rays.iter().enumerate() {
                let from = around.map_or(Scalar::ZERO, |around| swept[k].bound(&around));
                if from < ScalarOf::<S>::infinity() && (from, id) < found[k].limit(all) {
                    let cast = asked!(body, body => body.ray_cast(ray, options))?;
                    found[k].add(id, from, &cast, BodyHit::of(id, &cast).map(|hit| (hit.hit.lambda, hit)));
                    tested[k] += 1;
                }
            }
            let limits = found[..rays.len()].iter().map(|found| found.limit(all).0);
            let last = limits.fold(ScalarOf::<S>::neg_infinity(), Float::max);
            Ok(ControlFlow::Continue((last, Id::LAST)))
        })?;
        if visited > MOST_VISITED {
            return Ok(false);
        }
        for (k, cast) in casts.iter_mut().enumerate() {
            let mut work = Work { tested: tested[k], ..work };
            self.finish(&mut work);
            *cast = found[k].answer(work);
        }
        Ok(true)
    }
}

/// How many rays share one search.
const BUNDLE: usize = 8;

/// If a bundle meets the boxes of more bodies, its rays are cast one by one.
const MOST_VISITED: usize = 64;

/// The first hit of those that were found so far, of bodies or pairs with names `I`.
///
/// A body counts from its *key*: the λ of its hit, or where its box begins if that is later, which is impossible if
/// the hit's bracket is closed. Keys, and all values kept here, are minima over bodies, without those that their boxes
/// left out. So neither the order of the bodies matters, nor which others were tested.
#[derive(Clone, Copy)]
pub(super) struct First<I, F, S> {
    /// The least key, with the hit.
    pub(super) first: Option<((S, I), F)>,
    /// The earliest possible hit of an undecided body, with its name.
    pub(super) open: Option<(S, I)>,
    pub(super) lower: S,
}

impl<I, F, S: Scalar> Default for First<I, F, S> {
    fn default() -> Self {
        Self { first: None, open: None, lower: S::infinity() }
    }
}

impl<I: Copy + PartialOrd, F: Copy, S: Scalar> First<I, F, S> {
    /// Counts a cast; `hit` is what is kept of its hit, with the λ or the time.
    pub(super) fn add<H, V: Vector<Scalar = S>>(&mut self, id: I, from: S, cast: &Cast<H, V>, hit: Option<(S, F)>) {
        let start = (Float::max(cast.lower, from), id);
        if !cast.outcome.is_miss() {
            self.lower = Float::min(self.lower, start.0);
        }
        if cast.outcome.is_undecided() && self.open.is_none_or(|open| start < open) {
            self.open = Some(start);
        }
        if let Some((at, hit)) = hit {
            let key = (Float::max(at, from), id);
            if self.first.is_none_or(|(least, _)| key < least) {
                self.first = Some((key, hit));
            }
        }
    }

    /// The key from which on no body counts, which is `end` before there is a hit.
    pub(super) fn limit(&self, end: (S, I)) -> (S, I) {
        self.first.map_or(end, |(key, _)| key)
    }

    /// The undecided body that may be hit earliest, if that is before the first hit.
    pub(super) fn undecided(&self) -> Option<I> {
        self.open.filter(|&open| self.first.is_none_or(|(key, _)| open < key)).map(|(_, id)| id)
    }
}

impl<H: Copy, S: Scalar> First<Id, BodyHit<H, S>, S> {
    fn answer(&self, work: Work) -> SceneCast<H, S> {
        let lower = if work.cancelled { S::ZERO } else { self.lower };
        let undecided = self.undecided().map(|id| id.body);
        SceneCast { first: self.first.map(|(_, hit)| hit), lower, undecided, work }
    }
}

/// The box of a ray, with room for the rounding of its points: 32 ε of the source.
fn swept_point<V: Vector>(ray: Ray<V>) -> Moving<V> {
    let room = V::Scalar::from_f64(32.0) * V::Scalar::EPSILON * ray.source.abs().dot(V::ONE);
    Moving::new(V::splat(room), ray.source, ray.direction)
}

/// The box of a moving shape, in the frame of the bodies, with room for the target distance. If a number of the shape
/// is not finite, no body is left out and every single query reports it.
fn swept_shape<A: SupportMap + ?Sized>(
    shape: &A,
    motion: Motion<A::Vector>,
    options: &LinearCastOptions<A::Vector>,
) -> Moving<A::Vector> {
    let around = outer_box(shape).unwrap_or_else(Aabb::everything);
    swept_box(around, motion.velocity_a - motion.velocity_b, options.target_distance)
}

/// A moving box with room for the target distance.
pub(super) fn swept_box<V: Vector>(around: Aabb<V>, velocity: V, target_distance: V::Scalar) -> Moving<V> {
    let room = V::splat(Float::max(target_distance, Scalar::ZERO));
    let around = Aabb { min: around.min - room, max: around.max + room };
    let (center, half) = (around.center(), around.half_extents());
    // Both are rounded.
    let room = (center.abs() + half) * (V::Scalar::from_f64(4.0) * V::Scalar::EPSILON);
    Moving::new(half + room, center, velocity)
}
