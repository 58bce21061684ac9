//! The path of a robot arm with six joints leads through two obstacles. Gradient descent on the signed distance
//! pushes it out: the derivative of each distance by the pose of a link becomes that by the joints that carry the
//! link.
//!
//! `cargo run --release -p gjk-raycast --example arm_out_of_collision`

#![allow(clippy::print_stdout, reason = "an example talks")]

use gjk_raycast::convex_support::glam::{DQuat, DVec3};
use gjk_raycast::convex_support::{Ball, Cuboid, InvalidShape, Posed, Rounded, Segment, SupportMap};
use gjk_raycast::{SignedDistanceOptions, signed_distance};

type Joints = [f64; 6];
type Link = Posed<Rounded<Segment<DVec3>>>;
type Obstacle = Box<dyn SupportMap<Vector = DVec3>>;

/// What all links are to keep from the obstacles, in metres.
const MARGIN: f64 = 0.02;
const WAYPOINTS: usize = 25;

/// The axes of the joints of an arm like the UR5, and a point of each, where all angles are zero (Lynch and Park,
/// *Modern Robotics*, 2017, section 4.1).
const AXES: [(DVec3, DVec3); 6] = [
    (DVec3::Z, DVec3::ZERO),
    (DVec3::Y, DVec3::new(0.0, 0.0, 0.089)),
    (DVec3::Y, DVec3::new(0.425, 0.0, 0.089)),
    (DVec3::Y, DVec3::new(0.817, 0.0, 0.089)),
    (DVec3::NEG_Z, DVec3::new(0.817, 0.109, 0.0)),
    (DVec3::Y, DVec3::new(0.817, 0.0, -0.006)),
];

/// The links there: the ends of a segment, a radius, and how many joints carry it.
const LINKS: [(DVec3, DVec3, f64, usize); 5] = [
    (DVec3::new(0.0, 0.0, 0.089), DVec3::new(0.425, 0.0, 0.089), 0.06, 2),
    (DVec3::new(0.425, 0.0, 0.089), DVec3::new(0.817, 0.0, 0.089), 0.05, 3),
    (DVec3::new(0.817, 0.0, 0.089), DVec3::new(0.817, 0.109, 0.089), 0.04, 4),
    (DVec3::new(0.817, 0.109, 0.089), DVec3::new(0.817, 0.109, -0.006), 0.04, 5),
    (DVec3::new(0.817, 0.109, -0.006), DVec3::new(0.817, 0.291, -0.006), 0.03, 6),
];

/// The poses after each joint, the first before all of them.
fn poses(q: &Joints) -> [(DQuat, DVec3); 7] {
    let mut all = [(DQuat::IDENTITY, DVec3::ZERO); 7];
    for (i, (axis, point)) in AXES.into_iter().enumerate() {
        let (rotation, translation) = all[i];
        let turn = DQuat::from_axis_angle(axis, q[i]);
        all[i + 1] = (rotation * turn, translation + rotation * (point - turn * point));
    }
    all
}

/// The least signed distance of all links and obstacles, and its derivative by the joints.
fn clearance(q: &Joints, obstacles: &[Obstacle]) -> Result<(f64, Joints), InvalidShape> {
    let poses = poses(q);
    let mut least = (f64::INFINITY, [0.0; 6]);
    for (from, to, radius, carried_by) in LINKS {
        let (rotation, translation) = poses[carried_by];
        let link: Link = Posed::new(Rounded::new(Segment::new([from, to])?, radius)?, rotation, translation)?;
        for obstacle in obstacles {
            let answer = signed_distance(&link, obstacle, SignedDistanceOptions::default());
            if answer.signed_distance < least.0 {
                let force = answer.gradient().a;
                let by_joint = |(i, (axis, point)): (usize, (DVec3, DVec3))| {
                    let (rotation, translation) = poses[i];
                    if i < carried_by { force.revolute(translation + rotation * point, rotation * axis) } else { 0.0 }
                };
                let mut gradient = [0.0; 6];
                for (entry, joint) in gradient.iter_mut().zip(AXES.into_iter().enumerate()) {
                    *entry = by_joint(joint);
                }
                least = (answer.signed_distance, gradient);
            }
        }
    }
    Ok(least)
}

/// The derivative is that of differences.
fn check(q: &Joints, obstacles: &[Obstacle]) -> Result<(), InvalidShape> {
    let (_, gradient) = clearance(q, obstacles)?;
    for (i, ours) in gradient.into_iter().enumerate() {
        let at = |h: f64| {
            let mut q = *q;
            q[i] += h;
            clearance(&q, obstacles).map(|(distance, _)| distance)
        };
        let difference = (at(1e-6)? - at(-1e-6)?) / 2e-6;
        assert!((ours - difference).abs() < 1e-7, "joint {i}: {ours}, not {difference}");
    }
    Ok(())
}

fn main() -> Result<(), InvalidShape> {
    let (from, to) = ([-1.0, -0.6, 0.9, -0.4, 0.5, 0.0], [1.1, -0.4, 0.7, -0.2, -0.5, 0.6]);
    let obstacles: [Obstacle; 2] = [
        Box::new(Posed::translated(Cuboid::new(DVec3::new(0.06, 0.06, 0.25))?, DVec3::new(0.62, 0.1, 0.2))?),
        Box::new(Posed::translated(Ball::new(0.12)?, DVec3::new(0.45, 0.35, 0.3))?),
    ];
    let mut way: [Joints; WAYPOINTS] = core::array::from_fn(|k| {
        let part = k as f64 / (WAYPOINTS - 1) as f64;
        core::array::from_fn(|i| from[i] + (to[i] - from[i]) * part)
    });
    let depth = |way: &[Joints; WAYPOINTS]| -> Result<f64, InvalidShape> {
        way.iter().try_fold(f64::INFINITY, |least, q| Ok(least.min(clearance(q, &obstacles)?.0)))
    };
    let before = depth(&way)?;
    assert!(before < -0.05, "the straight way leads through an obstacle: {before}");
    check(&way[WAYPOINTS / 2], &obstacles)?;

    let mut rounds = 0;
    while depth(&way)? < MARGIN && rounds < 500 {
        rounds += 1;
        for k in 1..WAYPOINTS - 1 {
            // Keeps the way short for a while; the ends stay.
            let straight: Joints = core::array::from_fn(|i| 0.5 * (way[k - 1][i] + way[k + 1][i]));
            let pull = if rounds < 100 { 0.2 } else { 0.0 };
            for (q, s) in way[k].iter_mut().zip(straight) {
                *q += pull * (s - *q);
            }
            // Down the gradient of the depth, by the step that would be right if the distance were linear.
            let (distance, gradient) = clearance(&way[k], &obstacles)?;
            let squared: f64 = gradient.iter().map(|g| g * g).sum();
            if distance < MARGIN {
                let step = (1.01 * MARGIN - distance) / squared.max(0.01);
                way[k].iter_mut().zip(gradient).for_each(|(q, g)| *q += step * g);
            }
        }
    }
    let after = depth(&way)?;
    let longest = way.windows(2).map(|w| w[0].iter().zip(w[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max));
    let longest = longest.fold(0.0, f64::max);
    println!(
        "least distance {before:.4} before, {after:.4} after {rounds} rounds; largest step of a joint {longest:.3} rad"
    );
    assert!(after >= MARGIN, "the way is free by the margin");
    assert!(longest < 0.6, "and has no jumps");
    Ok(())
}
