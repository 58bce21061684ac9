//! W2: when a moving body first touches a resting one.

use crate::pairs::{Pair, Touch};
use crate::reference::{Pose, shortest_vector};
use crate::rng::{Rng, round_to_f32};
use crate::shapes::face_triangles;
use crate::vec3::{Vec3, add, dot, neg, norm, scale, sub};

/// How many casts [`casts`] makes.
pub const CASTS: usize = 2_000;

/// `B` moves from `pose` by `velocity` while `λ` goes from 0 to 1.
#[derive(Clone, Copy, Debug)]
pub struct Cast {
    /// Where `B` is at `λ = 0`.
    pub pose: Pose,
    /// How far it moves; exact in `f32` for a hit.
    pub velocity: Vec3,
    /// The `λ` of the first contact; `None` if the bodies never touch.
    pub lambda: Option<f64>,
    /// For a hit the cosine between velocity and normal, for a miss the smallest distance on the way.
    pub cosine_or_gap: f64,
}

/// The casts for one pair, four in five of which hit.
#[must_use]
pub fn casts(pair: &Pair) -> Vec<Cast> {
    let mut rng = Rng::new(2000 + pair.index);
    (0..CASTS)
        .map(|_| {
            let touch = pair.touch(&mut rng);
            if rng.unit() >= 0.2 { hit(touch, &mut rng) } else { miss(touch, &mut rng) }
        })
        .collect()
}

/// Casts that hit a box or hull `A` well inside its faces; those of [`casts`] mostly hit vertices and edges of `A − B`,
/// which are what is nearest from afar.
///
/// # Panics
/// If `A` is no box or hull.
#[must_use]
pub fn inside_faces(pair: &Pair, count: usize) -> Vec<Cast> {
    let faces = face_triangles(&pair.a);
    let mut rng = Rng::new(2100 + pair.index);
    (0..count).map(|_| hit(pair.touch_inside(&faces, &mut rng), &mut rng)).collect()
}

/// Ends its way to contact at `λ` between 0.3 and 0.7, at least 3° off tangential, and goes on inwards.
fn hit(Touch { pose, normal }: Touch, rng: &mut Rng) -> Cast {
    let (along, cosine) = loop {
        let u = rng.sphere();
        let cosine = dot(u, normal);
        if cosine.abs() >= 0.05 {
            break if cosine > 0.0 { (u, cosine) } else { (neg(u), -cosine) };
        }
    };
    let velocity = scale(along, 8.0).map(round_to_f32);
    let lambda = 0.3 + 0.4 * rng.unit();
    let translation = sub(pose.translation, scale(velocity, lambda));
    Cast { pose: Pose { translation, ..pose }, velocity, lambda: Some(lambda), cosine_or_gap: cosine }
}

/// Passes the contact's tangent plane in parallel, at a distance from 1 down to 1/1024.
fn miss(Touch { pose, normal }: Touch, rng: &mut Rng) -> Cast {
    let tangent = loop {
        let u = rng.sphere();
        let tangent = sub(u, scale(normal, dot(u, normal)));
        if norm(tangent) > 0.1 {
            break tangent;
        }
    };
    let velocity = scale(tangent, 8.0 / norm(tangent));
    let gap = 1.0 / (1_u64 << (rng.bits() % 11)) as f64;
    let translation = sub(sub(pose.translation, scale(normal, gap)), scale(velocity, 0.5));
    Cast { pose: Pose { translation, ..pose }, velocity, lambda: None, cosine_or_gap: gap }
}

/// Which hits only graze: a vertex or an edge touches and slides off at once, so that the bodies are apart again at
/// `λ + 1e-5`, `λ + 1e-4` or `λ + 1e-3`. Missing those is no mistake.
#[must_use]
pub fn grazing(pair: &Pair, casts: &[Cast]) -> Vec<bool> {
    let apart = |cast: &Cast, lambda: f64| {
        let translation = add(cast.pose.translation, scale(cast.velocity, lambda));
        shortest_vector(&pair.a, &pair.b, Pose { translation, ..cast.pose }).separated()
    };
    let grazes = |cast: &Cast| {
        cast.lambda.is_some_and(|lambda| [1e-5, 1e-4, 1e-3].iter().any(|&after| apart(cast, lambda + after)))
    };
    casts.iter().map(grazes).collect()
}

/// The casts as a file: `q[4] p[3] v[3] λ c` each, with `λ = −1` for a miss.
#[must_use]
pub fn records(casts: &[Cast]) -> Vec<f64> {
    let record = |cast: &Cast| {
        let Pose { rotation, translation } = cast.pose;
        let end = [cast.lambda.unwrap_or(-1.0), cast.cosine_or_gap];
        rotation.into_iter().chain(translation).chain(cast.velocity).chain(end)
    };
    casts.iter().flat_map(record).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pairs::PAIR_NAMES;
    use crate::reference::Shortest;

    /// The shortest vector of `A − B` when `B` has moved for `lambda`.
    fn at(pair: &Pair, cast: &Cast, lambda: f64) -> Shortest {
        let translation = add(cast.pose.translation, scale(cast.velocity, lambda));
        shortest_vector(&pair.a, &pair.b, Pose { translation, ..cast.pose })
    }

    #[test]
    fn as_many_hits_graze_as_were_published() {
        let published = [
            ("cuboid-cuboid", 233),
            ("hull16-hull16", 173),
            ("hull64-hull64", 66),
            ("hull256-hull256", 19),
            ("hull1024-hull1024", 3),
            ("cuboid-hull64", 101),
        ];
        for (name, count) in published {
            let pair = Pair::named(name);
            let grazing = grazing(&pair, &casts(&pair));
            assert_eq!(grazing.iter().filter(|&&grazes| grazes).count(), count, "grazing hits of {name}");
        }
    }

    #[test]
    fn hits_inside_faces_hit_and_do_not_graze() {
        for name in ["cuboid-cuboid", "hull64-hull64"] {
            let pair = Pair::named(name);
            let casts = inside_faces(&pair, 100);
            assert_eq!(grazing(&pair, &casts), [false; 100], "{name}");
            for cast in &casts {
                let lambda = cast.lambda.expect("a hit");
                assert!(at(&pair, cast, lambda - 1e-6).separated(), "{name} overlaps before {cast:?}");
                assert!(!at(&pair, cast, lambda + 1e-6).separated(), "{name} is apart after {cast:?}");
            }
        }
    }

    #[test]
    fn hits_hit_and_misses_miss() {
        for name in PAIR_NAMES {
            let pair = Pair::named(name);
            let casts = casts(&pair);
            let hits = casts.iter().filter(|cast| cast.lambda.is_some()).count();
            assert!((1500..1700).contains(&hits), "{hits} hits of {name}");
            let grazing = grazing(&pair, &casts);
            for (cast, grazes) in casts.iter().zip(grazing).step_by(20) {
                if let Some(lambda) = cast.lambda {
                    assert!(at(&pair, cast, lambda - 1e-4).separated(), "{name} overlaps before {cast:?}");
                    assert!(grazes || !at(&pair, cast, lambda + 1e-3).separated(), "{name} is apart after {cast:?}");
                } else {
                    let least = cast.cosine_or_gap;
                    for lambda in [0.0, 0.3, 0.49, 0.5, 0.51, 0.8, 1.0] {
                        let Shortest::Outside { v, gap } = at(&pair, cast, lambda) else {
                            panic!("{name} hits in {cast:?}")
                        };
                        assert!(norm(v) >= least - 1e-11, "{name} is nearer at {lambda} in {cast:?}");
                        assert!(
                            lambda != 0.5 || norm(v) - gap <= least + 1e-11,
                            "{name} never is that near in {cast:?}"
                        );
                    }
                }
            }
        }
    }
}
