//! W3: the distance of two bodies.

use crate::pairs::{Pair, Touch};
use crate::reference::Pose;
use crate::rng::Rng;
use crate::vec3::{Vec3, scale, sub};

/// How many queries [`queries`] makes that are far: the first ones.
pub const FAR: usize = 2_000;
/// How many near ones follow, at [`NEAR_DISTANCE`].
pub const NEAR: usize = 1_000;
/// The distance of the near queries.
pub const NEAR_DISTANCE: f64 = 1e-6;

/// Two bodies and their distance.
#[derive(Clone, Copy, Debug)]
pub struct DistanceQuery {
    /// Where `B` is.
    pub pose: Pose,
    /// The unit vector from the nearest point of `B` to that of `A`.
    pub normal: Vec3,
    /// The true distance: from 3 down to 0.0117 by powers of two, then 1e-6.
    pub distance: f64,
}

/// The queries for one pair: [`FAR`] far ones, then [`NEAR`] near ones.
#[must_use]
pub fn queries(pair: &Pair) -> Vec<DistanceQuery> {
    let mut rng = Rng::new(3000 + pair.index);
    (0..FAR + NEAR)
        .map(|i| {
            let Touch { pose, normal } = pair.touch(&mut rng);
            let distance = if i < FAR { 3.0 / (1_u64 << (rng.bits() % 9)) as f64 } else { NEAR_DISTANCE };
            let translation = sub(pose.translation, scale(normal, distance));
            DistanceQuery { pose: Pose { translation, ..pose }, normal, distance }
        })
        .collect()
}

/// The queries as a file: `q[4] p[3] n[3] distance 0` each.
#[must_use]
pub fn records(queries: &[DistanceQuery]) -> Vec<f64> {
    let record = |query: &DistanceQuery| {
        let Pose { rotation, translation } = query.pose;
        rotation.into_iter().chain(translation).chain(query.normal).chain([query.distance, 0.0])
    };
    queries.iter().flat_map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pairs::PAIR_NAMES;
    use crate::reference::{Shortest, shortest_vector};
    use crate::vec3::norm;

    #[test]
    fn the_reference_finds_the_distance_that_was_made() {
        for name in PAIR_NAMES {
            let pair = Pair::named(name);
            for query in queries(&pair).iter().step_by(17) {
                let Shortest::Outside { v, gap } = shortest_vector(&pair.a, &pair.b, query.pose) else {
                    panic!("{name} overlaps in {query:?}")
                };
                let error = (norm(v) - query.distance).abs();
                assert!(error <= gap + 2e-12, "{name} is {} apart, gap {gap:e}, in {query:?}", norm(v));
            }
        }
    }
}
