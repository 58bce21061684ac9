//! The least margin with every pair solved: the reference.

use convex_support::{Ellipsoid, Vector};

use super::least::Least;
use super::{ClearanceResult, LeftOut};
use crate::{InvalidQuery, MarginOptions, free_margin};

/// The least margin of any of `links` about any of `obstacles`, every pair solved: n·m margins.
///
/// The plain reference; [`Clearance`](super::Clearance) gives the same for a fraction of the work.
///
/// # Errors
/// [`InvalidQuery`] if a list is empty.
pub fn clearance<V: Vector>(
    links: &[Ellipsoid<V>],
    obstacles: &[Ellipsoid<V>],
    options: MarginOptions,
) -> Result<ClearanceResult<V>, InvalidQuery> {
    if obstacles.is_empty() {
        return Err(InvalidQuery::NoObstacles);
    }
    let of_link = |(link, e1): (usize, &Ellipsoid<V>)| {
        let mut least = Least::default();
        for (obstacle, e2) in obstacles.iter().enumerate() {
            least.take(free_margin(e1, e2, options), link, obstacle);
        }
        least
    };
    let least = least_of(links, of_link);
    let (margin, link, obstacle) = least.0.ok_or(InvalidQuery::NoLinks)?;
    let pairs_evaluated = links.len() * obstacles.len();
    Ok(ClearanceResult { margin, link, obstacle, pairs_evaluated, left_out: LeftOut::default() })
}

/// The least of the results for each link: which core finds which does not matter, because ties go by index.
#[cfg(feature = "rayon")]
fn least_of<V: Vector>(
    links: &[Ellipsoid<V>],
    of_link: impl Fn((usize, &Ellipsoid<V>)) -> Least<V> + Sync + Send,
) -> Least<V> {
    use rayon::prelude::*;
    links.par_iter().enumerate().map(of_link).reduce(Least::default, Least::or)
}

/// The least of the results for each link.
#[cfg(not(feature = "rayon"))]
fn least_of<V: Vector>(links: &[Ellipsoid<V>], of_link: impl Fn((usize, &Ellipsoid<V>)) -> Least<V>) -> Least<V> {
    links.iter().enumerate().map(of_link).fold(Least::default(), Least::or)
}
