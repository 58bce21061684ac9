//! A planner's waypoints are free, and so are the straight edges between them. A controller runs the time-parametrised
//! trajectory: quintic splines through positions, velocities and accelerations. Is that free too?
//!
//! `cargo run -p gjk-raycast --example controller_trajectory [FILE.csv]`
//!
//! A line of the file is a time, and the positions, velocities and accelerations of both joints, as in a message
//! `trajectory_msgs/JointTrajectory`. Without a file it is `controller_trajectory.csv` beside this program.

#![allow(clippy::print_stdout, reason = "an example talks")]

use convex_support::glam::DVec2;
use convex_support::{Ball, Posed, Rounded, Segment};
use gjk_raycast::{
    Joint, JointBounds, JointKind, JointState, JointTrajectory, Link, Linkage, MotionCastOptions,
    MotionClearanceOptions, PathWorkspace, Pose, Scene,
};

type Failed = Box<dyn std::error::Error>;
const JOINTS: usize = 2;
const DEGREE: usize = 5;

/// A line of the file.
struct Waypoint {
    time: f64,
    /// Positions, velocities and accelerations.
    state: [[f64; JOINTS]; 3],
}

/// The quintic of each joint from one waypoint to the next, by its Bézier points in the time from 0 to 1.
struct Piece([[f64; DEGREE + 1]; JOINTS]);

impl Piece {
    /// With duration `T`, the polynomial with points `b` has the value `b₀`, the rate `5(b₁ − b₀)/T` and the
    /// acceleration `20(b₂ − 2b₁ + b₀)/T²` at its start.
    fn between([from, to]: [&Waypoint; 2]) -> Self {
        let t = to.time - from.time;
        Self(std::array::from_fn(|joint| {
            let end = |waypoint: &Waypoint, t: f64| {
                let [position, velocity, acceleration] = waypoint.state.map(|row| row[joint]);
                let first = position + velocity * t / 5.0;
                [position, first, 2.0 * first - position + acceleration * t * t / 20.0]
            };
            let ([b0, b1, b2], [b5, b4, b3]) = (end(from, t), end(to, -t));
            [b0, b1, b2, b3, b4, b5]
        }))
    }
}

/// The points of the derivative of a Bézier curve of so many points.
fn derived(points: &[f64; DEGREE + 1], count: usize) -> [f64; DEGREE + 1] {
    std::array::from_fn(|i| if i + 1 < count { (count - 1) as f64 * (points[i + 1] - points[i]) } else { 0.0 })
}

impl JointTrajectory for Piece {
    type Scalar = f64;

    /// By de Casteljau: five rounds of means of two numbers, each of which three roundings change by less than 2ε of
    /// the largest point.
    fn state(&self, joint: usize, time: f64) -> JointState<f64> {
        let value = |mut points: [f64; DEGREE + 1], count: usize| {
            for round in 1..count {
                (0..count - round).for_each(|i| points[i] = points[i] * (1.0 - time) + points[i + 1] * time);
            }
            points[0]
        };
        let first = derived(&self.0[joint], DEGREE + 1);
        JointState {
            value: value(self.0[joint], DEGREE + 1),
            rate: value(first, DEGREE),
            acceleration: value(derived(&first, DEGREE), DEGREE - 1),
            error: 10.0 * f64::EPSILON * self.bounds(joint).value,
        }
    }

    /// A Bézier curve is in the hull of its points, and its derivatives in that of theirs. The factor is for rounding.
    fn bounds(&self, joint: usize) -> JointBounds<f64> {
        let most = |points: &[f64]| 1.000_001 * points.iter().fold(0.0_f64, |most, b| most.max(b.abs()));
        let points = self.0[joint];
        let first = derived(&points, DEGREE + 1);
        let second = derived(&first, DEGREE);
        let third = derived(&second, DEGREE - 1);
        JointBounds { value: most(&points), rate: most(&first), acceleration: most(&second), jerk: most(&third) }
    }
}

fn read(text: &str) -> Result<Vec<Waypoint>, Failed> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#') && !line.trim().is_empty());
    let waypoints = lines.map(|(number, line)| {
        let numbers = line.split(',').map(|word| word.trim().parse::<f64>()).collect::<Result<Vec<_>, _>>();
        let numbers = numbers.map_err(|why| format!("line {}: {why}", number + 1))?;
        let [time, p0, p1, v0, v1, a0, a1] = numbers[..] else {
            return Err(format!("line {} has {} numbers, but has to have 7", number + 1, numbers.len()).into());
        };
        Ok(Waypoint { time, state: [[p0, p1], [v0, v1], [a0, a1]] })
    });
    let waypoints = waypoints.collect::<Result<Vec<_>, Failed>>()?;
    let is_later = |ends: &[Waypoint]| ends[0].time.partial_cmp(&ends[1].time) == Some(std::cmp::Ordering::Less);
    match waypoints.windows(2).position(|ends| !is_later(ends)) {
        Some(at) => Err(format!("waypoint {} is no later than the one before", at + 1).into()),
        None => Ok(waypoints),
    }
}

/// An arm of two bars in the plane.
fn arm() -> Result<Linkage<Rounded<Segment<DVec2>>>, Failed> {
    let bar = Rounded::new(Segment::new([DVec2::ZERO, DVec2::X])?, 0.05)?;
    let joint = |parent, translation| {
        let pose = Pose { translation, ..Pose::default() };
        Joint { parent, pose, kind: JointKind::Revolute(1.0) }
    };
    let links = [0, 1].map(|joint| Link { joint: Some(joint), bodies: vec![bar] });
    Ok(Linkage::new([joint(None, DVec2::ZERO), joint(Some(0), DVec2::X)], links)?)
}

fn main() -> Result<(), Failed> {
    let text = match std::env::args().nth(1) {
        Some(file) => std::fs::read_to_string(file)?,
        None => include_str!("controller_trajectory.csv").to_owned(),
    };
    let (waypoints, arm, mut workspace) = (read(&text)?, arm()?, PathWorkspace::new());
    let scene = Scene::new([Posed::translated(Ball::new(0.1)?, DVec2::new(-0.7, 0.7))?])?;
    let positions: Vec<[f64; JOINTS]> = waypoints.iter().map(|waypoint| waypoint.state[0]).collect();
    let straight = arm.path_clearance(&positions, &scene, MotionClearanceOptions::new(), &mut workspace)?;
    println!("straight edges between the waypoints are free, by {:.4} at least", straight.lower);
    assert!(straight.lower > 0.0, "the plan is not free: {straight:?}");

    let ask = |waypoints: &[Waypoint], workspace: &mut PathWorkspace<DVec2>| -> Result<Option<f64>, Failed> {
        let pieces: Vec<Piece> = waypoints.windows(2).map(|ends| Piece::between([&ends[0], &ends[1]])).collect();
        let path = arm.path_along(&pieces, &scene, MotionCastOptions::new(), workspace)?;
        if let Some((contact, hit)) = path.contact() {
            let [from, to] = [contact.edge, contact.edge + 1].map(|end| waypoints[end].time);
            let time = from + hit.time * (to - from);
            println!("what the controller runs: link {} meets {:?} at {time:.6} s", contact.link, contact.met);
            assert!(contact.cast.is_certain() && contact.cast.upper - contact.cast.lower < 1e-9, "{contact:?}");
            return Ok(Some(time));
        }
        let least = arm.path_clearance_along(&pieces, &scene, MotionClearanceOptions::new(), workspace)?;
        println!("what the controller runs is free, by {:.4} at least", least.lower);
        assert!(path.is_free() && least.lower > 0.0, "{path:?} {least:?}");
        Ok(None)
    };
    let met = ask(&waypoints, &mut workspace)?;
    // The arm stops at each waypoint: then it follows the straight edges, at another pace.
    let stopping: Vec<Waypoint> =
        waypoints.into_iter().map(|w| Waypoint { state: [w.state[0], [0.0; JOINTS], [0.0; JOINTS]], ..w }).collect();
    println!("and if it stops at each waypoint:");
    let stopped = ask(&stopping, &mut workspace)?;
    assert!(stopped.is_none(), "the straight edges are free at any pace");
    if std::env::args().nth(1).is_none() {
        assert!(met.is_some_and(|time| 1.0 < time && time < 2.0), "the elbow opens too far after the second waypoint");
    }
    Ok(())
}
