//! The least margin of many links about many obstacles.

use convex_support::{Ellipsoid, Vector};

use crate::{InvalidQuery, Margin, MarginOptions, free_margin};

/// The least margin over all pairs of a link and an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct ClearanceResult<V: Vector> {
    /// The margin of the pair with the least one, E₁ being the link; among equal ones the first by link, then obstacle.
    pub margin: Margin<V>,
    /// The index of its link.
    pub link: usize,
    /// The index of its obstacle.
    pub obstacle: usize,
    /// How many pairs were solved.
    pub pairs_evaluated: usize,
}

/// The least margin of any of `links` about any of `obstacles`, every pair solved: n·m margins.
///
/// The plain reference; [`Clearance`] gives the same for a fraction of the work.
///
/// # Errors
/// [`InvalidQuery`] if a list is empty.
pub fn clearance<V: Vector>(
    links: &[Ellipsoid<V>],
    obstacles: &[Ellipsoid<V>],
    options: MarginOptions,
) -> Result<ClearanceResult<V>, InvalidQuery> {
    check(links, obstacles)?;
    let mut least: Option<ClearanceResult<V>> = None;
    for (link, e1) in links.iter().enumerate() {
        for (obstacle, e2) in obstacles.iter().enumerate() {
            let margin = free_margin(e1, e2, options);
            if least.is_none_or(|l| margin.margin < l.margin.margin) {
                least = Some(ClearanceResult { margin, link, obstacle, pairs_evaluated: 0 });
            }
        }
    }
    let least = least.ok_or(InvalidQuery::NoLinks)?;
    Ok(ClearanceResult { pairs_evaluated: links.len() * obstacles.len(), ..least })
}

/// Whether there is a pair at all.
pub(crate) fn check<V: Vector>(links: &[Ellipsoid<V>], obstacles: &[Ellipsoid<V>]) -> Result<(), InvalidQuery> {
    match (links.is_empty(), obstacles.is_empty()) {
        (true, _) => Err(InvalidQuery::NoLinks),
        (_, true) => Err(InvalidQuery::NoObstacles),
        _ => Ok(()),
    }
}
