//! Many rays against one shape.

#[cfg(feature = "rayon")]
use alloc::vec::Vec;

use convex_support::numerics::widest::{Loop, widest};
use convex_support::{CrossedByLine, LINES, Lines, Scalar, SupportMap, Vector, compiled_once};
use num_traits::Float as _;

use crate::cast::{is_plain, last_number};
use crate::{Outcome, Ray, RayCast, RayCastError, RayCastOptions, ray_cast};

/// Rays after which a batch drops the warm start, so that its pieces can be cast on any number of threads with the
/// same answers.
const RAYS_PER_PIECE: usize = 256;

/// Casts many rays against one shape, in their order, each with the [warm start](crate::WarmStart) of the one before.
///
/// Rays that are near one another, such as those of a picture or a lidar, then take fewer support points each. The
/// hits and misses are those of [`ray_cast`], within the same bounds; the last digits may differ from those of a cast
/// that begins otherwise. Every 256 rays the warm start of the options is used again, so that batches can be cut
/// there.
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

/// Where a ray enters a shape, as plain numbers for columns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(bound(serialize = "V: serde::Serialize, V::Scalar: serde::Serialize")))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "V: serde::Deserialize<'de>, V::Scalar: serde::Deserialize<'de>"))
)]
pub struct RayEntry<V: Vector> {
    /// The parameter of the hit. Infinity is a certain miss, and NaN an [undecided](Outcome::Undecided) cast.
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lambda: V::Scalar,
    /// The same as [`RayCast::lower`].
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub lower: V::Scalar,
    /// The same as [`RayCast::upper`].
    #[cfg_attr(feature = "serde", serde(with = "crate::data::or_infinity"))]
    pub upper: V::Scalar,
    /// The unit outward normal where the ray enters; zero if the source is inside, and for a miss.
    pub normal: V,
}

impl<V: Vector> From<RayCast<V>> for RayEntry<V> {
    fn from(RayCast { outcome, lower, upper, .. }: RayCast<V>) -> Self {
        let (lambda, normal) = match outcome {
            Outcome::Hit(hit) => (hit.lambda, hit.normal.unwrap_or_default()),
            Outcome::Miss(_) => (V::Scalar::infinity(), V::ZERO),
            Outcome::Undecided => (V::Scalar::nan(), V::ZERO),
        };
        Self { lambda, lower, upper, normal }
    }
}

/// Casts many rays against one shape, and writes where each enters into a slice. Nothing is allocated.
///
/// Balls, boxes, capsules and hulls with facets, also posed, are tested against several rays at a time, and rays that
/// are then in doubt are cast alone. Each answer is that of [`ray_cast`] to the last bit, whatever its neighbours are:
/// the same λ, bounds and normal. For other shapes, such as sums, and for options that ask for a search, the answers
/// are those of [`ray_casts`], which starts each ray from the last. With the feature `simd`, the widest vector
/// instructions of the processor are chosen at run time.
///
/// ```
/// use convex_support::{Ball, glam::DVec3};
/// use gjk_raycast::{Ray, RayCastOptions, RayEntry, ray_entries_into};
///
/// let ball = Ball::new(1.0)?;
/// let rays = [0.0, 0.6, 2.0].map(|y| Ray { source: DVec3::new(-5.0, y, 0.0), direction: DVec3::X });
/// let mut entries = [RayEntry::default(); 3];
/// ray_entries_into(&ball, &rays, RayCastOptions::default(), &mut entries)?;
/// assert_eq!(entries[0].lambda, 4.0);
/// assert!(entries[1].lower <= 4.2 && 4.2 <= entries[1].upper);
/// assert_eq!(entries[2].lambda, f64::INFINITY);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The first error that [`ray_cast`] has for a ray. The answer of such a ray is NaN, and all others are written.
///
/// # Panics
/// If the number of answers is not the number of rays.
pub fn ray_entries_into<S: CrossedByLine + ?Sized>(
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
    entries: &mut [RayEntry<S::Vector>],
) -> Result<(), RayCastError> {
    assert_eq!(rays.len(), entries.len(), "there must be as many answers as rays");
    let mut outcome = Ok(());
    let mut write = |entry: &mut RayEntry<_>, cast: Result<RayCast<_>, RayCastError>| {
        *entry = cast.map_or_else(
            |error| {
                outcome = outcome.and(Err(error));
                let nan = <S::Vector as Vector>::Scalar::nan();
                RayEntry { lambda: nan, lower: nan, upper: nan, normal: <S::Vector as Vector>::splat(nan) }
            },
            RayEntry::from,
        );
    };
    let mut by_lanes = is_plain(&options) && !options.max_lambda.is_nan();
    let mut lines = Lines::default();
    for (piece, entries) in rays.chunks(RAYS_PER_PIECE).zip(entries.chunks_mut(RAYS_PER_PIECE)) {
        for (rays, entries) in piece.chunks(LINES).zip(entries.chunks_mut(LINES)) {
            if by_lanes {
                gather(rays, &mut lines);
                by_lanes = target.certain_crossings(&mut lines);
            }
            if !by_lanes {
                break;
            }
            scatter(&mut lines, options.max_lambda, entries);
            if !lines.any_in_doubt() {
                continue;
            }
            for (line, (&ray, entry)) in rays.iter().zip(entries).enumerate() {
                if lines.known[line] == Scalar::ZERO {
                    write(entry, ray_cast(target, ray, options));
                }
            }
        }
        if !by_lanes {
            for (entry, cast) in entries.iter_mut().zip(ray_casts(target, piece, options)) {
                write(entry, cast);
            }
        }
    }
    outcome
}

/// [`ray_entries_into`] on all threads of the current [rayon](https://docs.rs/rayon) pool, with the same answers to the
/// last bit.
///
/// # Errors
/// The first error that [`ray_cast`] has for a ray. The answer of such a ray is NaN, and all others are written.
///
/// # Panics
/// If the number of answers is not the number of rays.
#[cfg(feature = "rayon")]
pub fn par_ray_entries_into<S: CrossedByLine + Sync + ?Sized>(
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
    entries: &mut [RayEntry<S::Vector>],
) -> Result<(), RayCastError> {
    use rayon::prelude::*;
    assert_eq!(rays.len(), entries.len(), "there must be as many answers as rays");
    let pieces = rays.par_chunks(RAYS_PER_PIECE).zip(entries.par_chunks_mut(RAYS_PER_PIECE));
    let cast = |(rays, entries): (&[_], &mut [_])| ray_entries_into(target, rays, options, entries);
    pieces.map(cast).reduce(|| Ok(()), Result::and)
}

compiled_once! {
    #[allow(clippy::needless_range_loop, reason = "arrays are read side by side, as vector instructions do")]
    /// The lines of up to [`LINES`] rays; the last one fills the remaining places.
    fn gather<V>(rays: &[Ray<V>], lines: &mut Lines<<V as Vector>::Scalar>) -> () {
        struct Gather<'a, V: Vector>(&'a [Ray<V>; LINES], &'a mut Lines<V::Scalar>);
        impl<V: Vector> Loop for Gather<'_, V> {
            #[inline(always)]
            fn run(self) {
                let Self(rays, lines) = self;
                for line in 0..LINES {
                    lines.error[line] = Scalar::ZERO;
                    for i in 0..V::DIM {
                        lines.source[i][line] = rays[line].source.get(i);
                        lines.direction[i][line] = rays[line].direction.get(i);
                    }
                }
            }
        }
        let Some(&last) = rays.last() else { return };
        match rays.try_into() {
            Ok(rays) => widest(Gather(rays, lines)),
            Err(_) => {
                let mut all = [last; LINES];
                all[..rays.len()].copy_from_slice(rays);
                widest(Gather(&all, lines));
            }
        }
    }
}

compiled_once! {
    /// Writes the certain answers of lines as answers of rays, which begin at 0 and stop at `end`. Where a line enters
    /// within rounding of either, its answer tells nothing of the ray: that ray is marked to be cast alone.
    fn scatter<V>(
        lines: &mut Lines<<V as Vector>::Scalar>,
        end: <V as Vector>::Scalar,
        entries: &mut [RayEntry<V>],
    ) -> () {
        struct Scatter<'a, V: Vector>(&'a mut Lines<V::Scalar>, V::Scalar, &'a mut [RayEntry<V>]);
        impl<V: Vector> Loop for Scatter<'_, V> {
            #[inline(always)]
            fn run(self) {
                let Self(lines, end, entries) = self;
                let (zero, infinity) = (V::Scalar::ZERO, V::Scalar::infinity());
                let last = last_number(end);
                for (line, slot) in entries.iter_mut().enumerate().take(LINES) {
                    let [lower, upper] = [lines.bounds[0][line], lines.bounds[1][line]];
                    let (lambda, is_missed) = (lines.entry[line], lines.known[line] < zero);
                    // As `certain` of one ray.
                    let is_hit = !is_missed & (lower > zero) & (upper <= last);
                    let is_certain = is_missed | is_hit | (lower > end) & (upper < infinity);
                    lines.known[line] = if is_certain { lines.known[line] } else { zero };
                    let of_hit = |x: V::Scalar, else_: V::Scalar| if is_hit { x } else { else_ };
                    *slot = RayEntry {
                        lambda: of_hit(lambda, infinity),
                        lower: of_hit(lower, infinity),
                        upper: of_hit(upper, infinity),
                        normal: V::from_fn(|i| of_hit(lines.normal[i][line], zero)),
                    };
                }
            }
        }
        widest(Scatter(lines, end, entries));
    }
}
