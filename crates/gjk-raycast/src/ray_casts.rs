//! Many rays against one shape.

#[cfg(feature = "rayon")]
use alloc::vec::Vec;

use convex_support::SupportMap;

use crate::{Ray, RayCast, RayCastError, RayCastOptions, ray_cast};

/// Rays after which a batch forgets the warm start, so that its pieces can be cast on any number of threads and come out
/// alike.
const RAYS_PER_PIECE: usize = 256;

/// Casts many rays against one shape, in their order; each begins with [what the one before tells](crate::WarmStart).
///
/// Rays that are near one another, such as those of a picture or a lidar, then take fewer support points each. The hits
/// and misses are those of [`ray_cast`], within the same bounds; the last digits may differ from those of a cast that
/// begins otherwise. Every 256 rays the warm start of the options is taken again, so that batches can be cut there.
///
/// ```
/// use convex_support::{Ellipsoid, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, ray_casts};
///
/// let stone = Ellipsoid::new(DVec3::ZERO, DVec3::new(3.0, 2.0, 1.0), Default::default())?;
/// let rays: Vec<_> = (0..100)
///     .map(|i| Ray {
///         source: DVec3::new(0.1 * f64::from(i) - 5.0, 0.0, 10.0),
///         direction: DVec3::NEG_Z,
///     })
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
        let mut warm_start = options.warm_start;
        piece.iter().map(move |&ray| {
            let cast = ray_cast(target, ray, RayCastOptions { warm_start, ..options })?;
            warm_start = cast.warm_start(warm_start);
            Ok(cast)
        })
    })
}

/// [`ray_casts`] on all threads of the current [rayon](https://docs.rs/rayon) pool, with the same answers to the last
/// bit.
#[cfg(feature = "rayon")]
pub fn par_ray_casts<S: SupportMap + Sync + ?Sized>(
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
) -> Vec<Result<RayCast<S::Vector>, RayCastError>> {
    use rayon::prelude::*;
    rays.par_chunks(RAYS_PER_PIECE).flat_map_iter(|piece| ray_casts(target, piece, options)).collect()
}
