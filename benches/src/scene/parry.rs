//! The same bodies in parry's tree, each question with parry's own narrow phase.

use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::partitioning::{Bvh, BvhBuildStrategy, BvhWorkspace};
use parry3d_f64::query::{self, NonlinearRigidMotion, Ray, RayCast, ShapeCastOptions};
use parry3d_f64::shape::{Ball, Compound, Cuboid, SharedShape};

use super::{END, HALF_EXTENTS, NEAR, Question, RADIUS, WITHIN};

/// Balls in parry's tree, and in its compound, which knows how to cast.
#[derive(Debug)]
pub struct Balls {
    shape: Ball,
    poses: Vec<Pose>,
    tree: Bvh,
    /// The tree of boxes that overlap where bodies are near each other.
    loose: Bvh,
    compound: Compound,
}

impl Balls {
    /// The scene of balls at these places.
    #[must_use]
    pub fn new(places: &[[f64; 3]]) -> Self {
        let shape = Ball::new(RADIUS);
        let poses: Vec<Pose> = places.iter().map(|&place| Pose::from_translation(vector(place))).collect();
        let boxes = boxes(&shape, &poses);
        let loose: Vec<Aabb> = boxes.iter().map(|around| around.loosened(0.5 * NEAR)).collect();
        let shared = SharedShape::new(shape);
        let compound = Compound::new(poses.iter().map(|&pose| (pose, shared.clone())).collect());
        Self { shape, tree: tree(&boxes), loose: tree(&loose), poses, compound }
    }

    /// How many they are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.poses.len()
    }

    /// Builds the tree of these balls anew.
    #[must_use]
    pub fn rebuilt(&self) -> Bvh {
        tree(&boxes(&self.shape, &self.poses))
    }

    /// Where the first body is on a ray; infinite for a miss.
    #[must_use]
    pub fn ray_cast(&self, [source, direction, _]: Question) -> f64 {
        let ray = Ray::new(vector(source), vector(direction));
        let body = |leaf: u32, best| self.shape.cast_ray(&self.poses[leaf as usize], &ray, best, true);
        self.tree.cast_ray(&ray, f64::MAX, body).map_or(f64::INFINITY, |hit| hit.1)
    }

    /// How far the nearest body is from a ball.
    #[must_use]
    pub fn nearest(&self, [source, ..]: Question) -> f64 {
        let (place, around) = (vector(source), Vector::splat(RADIUS));
        let (pose, low, high) = (Pose::from_translation(place), place - around, place + around);
        let nearest = self.tree.find_best(
            f64::MAX,
            |node, _| (node.mins() - high).max(low - node.maxs()).max(Vector::ZERO).length(),
            |leaf, _| self.distance(&pose, leaf),
        );
        nearest.map_or(f64::INFINITY, |nearest| nearest.1)
    }

    /// How many bodies are near a ball.
    #[must_use]
    pub fn all_within(&self, [source, ..]: Question) -> usize {
        let pose = Pose::from_translation(vector(source));
        let around = self.shape.aabb(&pose).loosened(WITHIN);
        let near = |leaf: &u32| self.distance(&pose, *leaf).is_some_and(|distance| distance <= WITHIN);
        self.tree.intersect_aabb(&around).filter(near).count()
    }

    /// When a ball meets the first body; infinite for a miss.
    #[must_use]
    pub fn linear_cast(&self, [source, velocity, _]: Question) -> f64 {
        let pose = Pose::from_translation(vector(source));
        let options = ShapeCastOptions::with_max_time_of_impact(f64::MAX);
        let (scene, rest) = (&self.compound, (Pose::IDENTITY, Vector::ZERO));
        let hit = query::cast_shapes(&rest.0, rest.1, scene, &pose, vector(velocity), &self.shape, options);
        hit.ok().flatten().map_or(f64::INFINITY, |hit| hit.time_of_impact)
    }

    /// When a box that turns meets the first body; infinite for a miss.
    #[must_use]
    pub fn motion_cast(&self, [source, velocity, angular_velocity]: Question) -> f64 {
        let rest = NonlinearRigidMotion::constant_position(Pose::IDENTITY);
        let [source, velocity, angular_velocity] = [source, velocity, angular_velocity].map(vector);
        let start = Pose::from_translation(source);
        let motion = NonlinearRigidMotion::new(start, Vector::ZERO, velocity, angular_velocity);
        let cuboid = Cuboid::new(vector(HALF_EXTENTS));
        let hit = query::cast_shapes_nonlinear(&rest, &self.compound, &motion, &cuboid, 0.0, END, true);
        hit.ok().flatten().map_or(f64::INFINITY, |hit| hit.time_of_impact)
    }

    /// How many pairs are near each other.
    #[must_use]
    pub fn pairs(&self, workspace: &mut BvhWorkspace) -> usize {
        let mut near = 0_usize;
        self.loose.traverse_bvtt_single_tree::<false>(workspace, &mut |i, j| {
            let distance = self.distance(&self.poses[i as usize], j);
            near += usize::from(distance.is_some_and(|distance| distance <= NEAR));
        });
        near
    }

    fn distance(&self, pose: &Pose, leaf: u32) -> Option<f64> {
        let distance = query::distance(pose, &self.shape, &self.poses[leaf as usize], &self.shape);
        distance.ok().map(|distance| distance.distance)
    }
}

fn vector(v: [f64; 3]) -> Vector {
    Vector::new(v[0], v[1], v[2])
}

fn boxes(shape: &Ball, poses: &[Pose]) -> Vec<Aabb> {
    poses.iter().map(|pose| shape.aabb(pose)).collect()
}

fn tree(boxes: &[Aabb]) -> Bvh {
    Bvh::from_leaves(BvhBuildStrategy::Binned, boxes)
}
