//! The twelve pairs of shapes of W2, W3 and W3b, and how they are made to touch.

use crate::reference::{Pose, Shortest, shortest_vector};
use crate::rng::Rng;
use crate::shapes::{Shape, point_inside};
use crate::vec3::{Vec3, add, conjugate, neg, norm, rotate, scale, sub};

/// Names of the pairs, in the order of their numbers: first `A`, then `B`.
pub const PAIR_NAMES: [&str; 12] = [
    "ball-cuboid",
    "cuboid-cuboid",
    "cylinder-cone",
    "capsule-ellipsoid",
    "ellipsoid-ellipsoid",
    "hull16-hull16",
    "hull64-hull64",
    "hull256-hull256",
    "hull1024-hull1024",
    "roundbox-roundbox",
    "cuboid-hull64",
    "capsule-capsule",
];

/// Two shapes to be asked about.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Its number, which is part of the seeds.
    pub(crate) index: u64,
    /// The body that stays at the origin.
    pub a: Shape,
    /// The body that is posed, and in W2 moves.
    pub b: Shape,
}

impl Pair {
    /// Two bodies of no name, and of no seeds of their own.
    #[must_use]
    pub const fn new(a: Shape, b: Shape) -> Self {
        Self { index: 0, a, b }
    }

    /// The pair of that name.
    ///
    /// # Panics
    /// If it is none of [`PAIR_NAMES`].
    #[must_use]
    pub fn named(name: &str) -> Self {
        let index = PAIR_NAMES.iter().position(|&pair| pair == name).expect("a name of `PAIR_NAMES`");
        let (a, b) = name.split_once('-').expect("the names of two shapes");
        Self { index: index as u64, a: Shape::named(a), b: Shape::named(b) }
    }

    /// The vector that moves `b` from `pose` until it touches `a` at the features that are closest there; `None` if
    /// they overlap there, are too near to have a normal, or the reference is not sure to 1e-12.
    fn gap_vector(&self, pose: Pose) -> Option<Vec3> {
        match shortest_vector(&self.a, &self.b, pose) {
            Shortest::Outside { v, gap } if norm(v) >= 0.01 && gap <= 1e-12 => Some(v),
            _ => None,
        }
    }

    /// `B` in a random rotation, moved until it touches `A`.
    ///
    /// Distances and times of impact along any motion from here are known by construction, to about 1e-12.
    pub(crate) fn touch(&self, rng: &mut Rng) -> Touch {
        loop {
            let (rotation, translation) = (rng.quat(), scale(rng.sphere(), 2.5));
            if let Some(v) = self.gap_vector(Pose { rotation, translation }) {
                let pose = Pose { rotation, translation: add(translation, v) };
                return Touch { pose, normal: scale(v, 1.0 / norm(v)) };
            }
        }
    }

    /// `B` in a random rotation, touching `A` well inside one of these triangles of its faces.
    pub(crate) fn touch_inside(&self, faces: &[[Vec3; 3]], rng: &mut Rng) -> Touch {
        let (point, outward) = point_inside(faces, rng);
        let (rotation, normal) = (rng.quat(), neg(outward));
        let lowest = rotate(rotation, self.b.support(rotate(conjugate(rotation), normal)));
        Touch { pose: Pose { rotation, translation: sub(point, lowest) }, normal }
    }
}

/// A pose in which `B` touches `A`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Touch {
    pub pose: Pose,
    /// The unit normal from `B` to `A`.
    pub normal: Vec3,
}
