//! Distances of many pairs, into a column.

use convex_support::SupportMap;

use crate::{Distance, DistanceOptions, distance};

/// Calls `ask` with the distance of `a[k]` and `b[k]`, and writes what it returns into `answers[k]`, for each k.
/// Nothing is allocated.
///
/// Each distance is the answer of [`distance`] to the last bit, whatever its neighbours are, so that a table may be
/// cut into parts anywhere. If a list has a single shape, that shape is used for every answer. `ask` chooses what to
/// keep: a number for a column of a data frame, the bracket, or the whole answer.
///
/// ```
/// use convex_support::{Ball, Cuboid, Posed, glam::DVec3};
/// use gjk_raycast::{DistanceOptions, map_distances_into};
///
/// // Columns as a data frame has them: where the balls are, and the distances to be found.
/// let (x, y, z) = ([1.5, 3.0, 0.0], [0.0, 0.0, 2.0], [0.0, 4.0, 0.0]);
/// let mut distances = [0.0; 3];
///
/// let table = Cuboid::new(DVec3::ONE)?;
/// let ball = Ball::new(0.25)?;
/// let balls = [0, 1, 2].map(|k| Posed::translated(ball, DVec3::new(x[k], y[k], z[k])));
/// let [first, second, third] = balls;
/// map_distances_into(
///     &[table],
///     &[first?, second?, third?],
///     DistanceOptions::default(),
///     &mut distances,
///     |d| d.distance,
/// );
///
/// assert_eq!(distances, [0.25, f64::sqrt(13.0) - 0.25, 0.75]);
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
///
/// # Panics
/// If a list has neither one shape nor as many as there are answers.
pub fn map_distances_into<A, B, T>(
    a: &[A],
    b: &[B],
    options: DistanceOptions<A::Vector>,
    answers: &mut [T],
    mut ask: impl FnMut(Distance<A::Vector>) -> T,
) where
    A: SupportMap,
    B: SupportMap<Vector = A::Vector>,
{
    let count = answers.len();
    assert!(a.len() == 1 || a.len() == count, "{} shapes a for {count} answers", a.len());
    assert!(b.len() == 1 || b.len() == count, "{} shapes b for {count} answers", b.len());
    for (k, answer) in answers.iter_mut().enumerate() {
        let (a, b) = (&a[if a.len() == 1 { 0 } else { k }], &b[if b.len() == 1 { 0 } else { k }]);
        *answer = ask(distance(a, b, options));
    }
}
