//! W3b: whether two bodies meet.

use crate::pairs::{Pair, Touch};
use crate::reference::{Pose, Shortest, shortest_vector};
use crate::rng::Rng;
use crate::vec3::{Vec3, norm, scale, sub};

/// How many queries [`queries`] makes.
pub const QUERIES: usize = 2_000;

/// Two bodies near contact.
#[derive(Clone, Copy, Debug)]
pub struct IntersectQuery {
    /// Where `B` is.
    pub pose: Pose,
    /// The unit vector along which `B` was moved from contact.
    pub normal: Vec3,
    /// Whether the bodies meet.
    pub meet: bool,
    /// How far `B` was moved from contact, from 1/2 to 1/1024: away from `A`, or into it if negative.
    pub moved: f64,
}

/// The queries for one pair.
#[must_use]
pub fn queries(pair: &Pair) -> Vec<IntersectQuery> {
    let mut rng = Rng::new(4000 + pair.index);
    (0..QUERIES)
        .map(|_| {
            loop {
                let Touch { pose, normal } = pair.touch(&mut rng);
                let size = 1.0 / (1_u64 << (1 + rng.bits() % 10)) as f64;
                let moved = if rng.bits() >> 63 == 1 { -size } else { size };
                let pose = Pose { translation: sub(pose.translation, scale(normal, moved)), ..pose };
                if moved > 0.0 {
                    return IntersectQuery { pose, normal, meet: false, moved };
                }
                // Pushed in, a thin body may come out at the other side.
                match shortest_vector(&pair.a, &pair.b, pose) {
                    Shortest::Inside => return IntersectQuery { pose, normal, meet: true, moved },
                    Shortest::Outside { v, .. } if norm(v) >= 1e-6 => {
                        return IntersectQuery { pose, normal, meet: false, moved };
                    }
                    Shortest::Outside { .. } => {}
                }
            }
        })
        .collect()
}

/// The queries as a file: `q[4] p[3] n[3] truth moved` each, with 1 for a meeting.
#[must_use]
pub fn records(queries: &[IntersectQuery]) -> Vec<f64> {
    let record = |query: &IntersectQuery| {
        let Pose { rotation, translation } = query.pose;
        let truth = if query.meet { 1.0 } else { 0.0 };
        rotation.into_iter().chain(translation).chain(query.normal).chain([truth, query.moved])
    };
    queries.iter().flat_map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pairs::PAIR_NAMES;

    #[test]
    fn the_sample_is_fair() {
        for name in PAIR_NAMES {
            let meetings = queries(&Pair::named(name)).iter().filter(|query| query.meet).count();
            assert!((900..1100).contains(&meetings), "{meetings} of {QUERIES} meet in {name}");
        }
    }
}
