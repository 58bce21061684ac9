//! Many rays against one body, and one ray against many bodies.

use alloc::vec::Vec;

use convex_support::{
    Ball, BoundingSphere, Crossing, Scalar, ScalarOf, SupportMap, Vector, bounding_sphere, line_crossing,
};
use num_traits::Float;

use crate::{Outcome, Ray, RayCast, RayCastError, RayCastOptions, RayHit, ray_cast};

/// Rays after which a batch forgets the axis, so that its pieces can be cast on any number of threads and come out alike.
const RAYS_PER_PIECE: usize = 256;

/// Casts many rays against one shape, in their order; each begins with the axis that the one before ended with.
///
/// Rays that follow one another in space, those of a picture or a lidar, then take fewer support points each. Where a ray
/// hits and where it misses is what [`ray_cast`] answers, within the same bounds; the last digits may differ from those of
/// a cast that begins elsewhere. Every 256 rays the axis of the options is taken again.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, ray_casts};
///
/// let stone = Ellipsoid::new(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), Default::default())?;
/// let rays: Vec<_> = (0..100)
///     .map(|i| Ray { source: DVec3::new(0.1 * f64::from(i) - 5.0, 0.0, 10.0), direction: DVec3::NEG_Z })
///     .collect();
/// let hits = ray_casts(&stone, &rays, RayCastOptions::default())
///     .filter(|cast| cast.is_ok_and(|cast| cast.outcome.hit().is_some()))
///     .count();
/// assert_eq!(hits, 61); // from x = −3 to 3
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
pub fn ray_casts<S: SupportMap + ?Sized>(
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
) -> impl Iterator<Item = Result<RayCast<S::Vector>, RayCastError>> {
    rays.chunks(RAYS_PER_PIECE).flat_map(move |piece| {
        let mut axis = options.axis;
        piece.iter().map(move |&ray| {
            let cast = ray_cast(target, ray, RayCastOptions { axis, ..options })?;
            axis = match cast.outcome {
                Outcome::Hit(hit) => hit.normal.or(axis),
                Outcome::Miss(miss) => Some(miss.axis),
                Outcome::Undecided => axis,
            };
            Ok(cast)
        })
    })
}

/// [`ray_casts`] on all threads of the current [rayon] pool, with the same answers to the last bit.
#[cfg(feature = "rayon")]
pub fn par_ray_casts<S: SupportMap + Sync + ?Sized>(
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
) -> Vec<Result<RayCast<S::Vector>, RayCastError>> {
    use rayon::prelude::*;
    rays.par_chunks(RAYS_PER_PIECE).flat_map_iter(|piece| ray_casts(target, piece, options)).collect()
}

/// Bodies, each with a ball around it, for rays that ask which body they hit first.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, SupportMap, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, Scene};
///
/// type Body = Box<dyn SupportMap<Vector = DVec3>>;
/// let at = |x, y| DVec3::new(x, y, 0.0);
/// let scene = Scene::new([
///     Box::new(Posed::translated(Ball::new(1.0)?, at(20.0, 0.0))?) as Body,
///     Box::new(Posed::translated(Cuboid::new(DVec3::ONE)?, at(10.0, 0.0))?) as Body,
///     Box::new(Posed::translated(Cuboid::new(DVec3::ONE)?, at(10.0, 8.0))?) as Body,
/// ]);
/// let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
/// let answer = scene.ray_cast(ray, RayCastOptions::default())?;
/// let first = answer.first.ok_or("two are in the way")?;
/// assert_eq!((first.body, first.hit.lambda), (1, 9.0));
/// assert_eq!((answer.tested, answer.culled), (1, 2)); // one is beside the ray, and one behind the hit
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene<S: SupportMap> {
    bodies: Vec<S>,
    spheres: Vec<BoundingSphere<S::Vector>>,
}

/// The first body in the way of a ray, and what was done to find it.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct SceneRayCast<V: Vector> {
    /// The first hit; `None` where every body is missed. Of bodies hit at the same λ, the one with the lowest index.
    pub first: Option<FirstHit<V>>,
    /// No point of the ray before this parameter is in any body.
    pub lower: V::Scalar,
    /// Bodies that a cast was made for.
    pub tested: usize,
    /// Bodies that were left out, because the ray misses the ball around them or reaches it only behind the first hit.
    pub culled: usize,
    /// The lowest index of a body whose cast was [undecided](Outcome::Undecided), if there is one: it may be in the way
    /// from [`lower`](Self::lower) on.
    pub undecided: Option<usize>,
}

/// Which body is hit, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstHit<V: Vector> {
    /// The index of the body.
    pub body: usize,
    /// The hit, as [`ray_cast`] answers it for this body alone.
    pub hit: RayHit<V>,
}

impl<S: SupportMap> Scene<S> {
    /// The scene of these bodies; their balls are found now.
    pub fn new(bodies: impl IntoIterator<Item = S>) -> Self {
        let bodies: Vec<S> = bodies.into_iter().collect();
        let spheres = bodies.iter().map(bounding_sphere).collect();
        Self { bodies, spheres }
    }

    /// The bodies, in the order given.
    #[must_use]
    pub fn bodies(&self) -> &[S] {
        &self.bodies
    }

    /// The balls around them.
    #[must_use]
    pub fn spheres(&self) -> &[BoundingSphere<S::Vector>] {
        &self.spheres
    }

    /// The first body that the ray hits. The answer is that of [`ray_cast`] for each body, to the last bit; bodies whose
    /// balls rule them out are not asked.
    ///
    /// # Errors
    /// [`RayCastError`] if the direction is zero or a coordinate is not finite.
    pub fn ray_cast(
        &self,
        ray: Ray<S::Vector>,
        options: RayCastOptions<S::Vector>,
    ) -> Result<SceneRayCast<S::Vector>, RayCastError> {
        ray.check()?;
        // Nearest balls first: what they hit rules out most of the others.
        let mut in_the_way: Vec<(ScalarOf<S>, usize)> = Vec::new();
        for (body, sphere) in self.spheres.iter().enumerate() {
            if let Some(lambda) = reaches(sphere, ray).filter(|&lambda| !(lambda > options.max_lambda)) {
                in_the_way.push((lambda, body));
            }
        }
        in_the_way
            .sort_unstable_by(|(p, i), (q, j)| p.partial_cmp(q).unwrap_or(core::cmp::Ordering::Equal).then(i.cmp(j)));

        let mut answer =
            SceneRayCast { first: None, lower: ScalarOf::<S>::infinity(), tested: 0, culled: 0, undecided: None };
        for (lambda, body) in in_the_way {
            if answer.first.is_some_and(|first: FirstHit<S::Vector>| lambda > first.hit.lambda) {
                break;
            }
            answer.tested += 1;
            let cast = ray_cast(&self.bodies[body], ray, options)?;
            match cast.outcome {
                Outcome::Hit(hit) => {
                    answer.lower = Float::min(answer.lower, cast.lower);
                    let is_first = |first: FirstHit<S::Vector>| (hit.lambda, body) < (first.hit.lambda, first.body);
                    if answer.first.is_none_or(is_first) {
                        answer.first = Some(FirstHit { body, hit });
                    }
                }
                Outcome::Undecided => {
                    answer.lower = Float::min(answer.lower, cast.lower);
                    answer.undecided = Some(answer.undecided.map_or(body, |lowest| lowest.min(body)));
                }
                Outcome::Miss(_) => {}
            }
        }
        answer.culled = self.bodies.len() - answer.tested;
        Ok(answer)
    }

    /// [`ray_cast`](Self::ray_cast) for each of many rays, on all threads of the current [rayon] pool.
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

/// Where the ray can be in the ball at the earliest; `None` where it passes it. In doubt it is in the ball from the start.
fn reaches<V: Vector>(sphere: &BoundingSphere<V>, ray: Ray<V>) -> Option<V::Scalar> {
    let from = ray.source - sphere.center;
    // A ball's radius is rounded, and the crossing to ulps of the distance.
    let rounding = V::Scalar::from_f64(32.0) * V::Scalar::EPSILON;
    let radius = sphere.radius + rounding * (sphere.radius + from.norm());
    match Ball::<V>::new(radius) {
        Ok(ball) if is_comfortable(radius) && is_comfortable(from.norm()) => {
            let Crossing { entry, exit, .. } = line_crossing(&ball, from, ray.direction).crossing()?;
            (exit >= V::Scalar::ZERO).then(|| entry.max(V::Scalar::ZERO))
        }
        _ => Some(V::Scalar::ZERO),
    }
}

/// Whether a length can be squared without over- or underflow.
fn is_comfortable<S: Scalar>(length: S) -> bool {
    let square = length * length;
    square < S::infinity() && square > S::min_positive_value() / S::EPSILON
}
