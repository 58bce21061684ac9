//! Whether the robot is free between the rows of its trajectory, too: proved by casting its links, as the joints move
//! them, at the obstacles.

use gjk_raycast::{ChainMotion, MotionCastOptions, RigidMotion, motion_cast};
use rayon::prelude::*;

use super::Scene;

/// The motions of a link from one row to the next, past an obstacle each.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Between {
    pub(super) asked: usize,
    /// Those that are certain misses.
    pub(super) free: usize,
}

impl Between {
    /// Casts every link from every row to the next, all joints at constant rates, at every obstacle.
    pub(super) fn of(scene: &Scene) -> Result<Self, String> {
        let steps = scene.trajectory.par_windows(2).map(|rows| Self::of_step(scene, &rows[0], &rows[1]));
        let add = |a: Self, b: Self| Ok(Self { asked: a.asked + b.asked, free: a.free + b.free });
        steps.try_reduce(Self::default, add)
    }

    fn of_step(scene: &Scene, from: &[f64], to: &[f64]) -> Result<Self, String> {
        let rates: Vec<f64> = from.iter().zip(to).map(|(from, to)| (to - from) / scene.dt).collect();
        let options = MotionCastOptions::new().with_max_time(scene.dt);
        let mut between = Self::default();
        for (link, joints) in scene.links_at(from)?.iter().zip(scene.robot.joints(from, &rates)) {
            let motion = ChainMotion::new(&joints);
            for obstacle in &scene.obstacles {
                let cast = motion_cast(&link.hull, motion, &obstacle.hull, RigidMotion::default(), options);
                between.asked += 1;
                between.free += usize::from(cast.map_err(|why| why.to_string())?.outcome.is_miss());
            }
        }
        Ok(between)
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use gjk_raycast::{ChainMotion, Trajectory};

    use super::super::{FREE, Scene};

    /// What is cast is the robot: in the time of a step the joints take every link from where it is in one row to where
    /// it is in the next.
    #[test]
    fn joints_take_links_to_the_next_row() {
        let scene = Scene::read(Path::new(FREE)).expect("it is embedded");
        let [from, to] = [&scene.trajectory[150], &scene.trajectory[151]];
        let rates: Vec<f64> = from.iter().zip(to).map(|(from, to)| (to - from) / scene.dt).collect();
        let [before, after] = [from, to].map(|values| scene.links_at(values).expect("numbers"));
        for ((before, after), joints) in before.iter().zip(&after).zip(scene.robot.joints(from, &rates)) {
            let moved = ChainMotion::new(&joints).displacement(scene.dt);
            // The end of each semi-axis, which tells the rotation too.
            for k in 0..3 {
                let [start, end] = [before, after].map(|link| link.outer.center() + link.outer.axes().col(k) * 0.3);
                assert!((moved.of(start) - end).length() < 1e-12, "{start} is taken to {} for {end}", moved.of(start));
            }
        }
        let hand = [&before, &after].map(|links| links.last().expect("seven").outer.center());
        assert!((hand[1] - hand[0]).length() > 1e-3, "and it does move");
    }
}
