//! How near a robot comes along its way, and a free box of two of its joint values, as plots: what is proved, beside
//! what single poses say.

use convex_support::glam::DVec3;
use gjk_raycast::{
    ConfigurationWorkspace, Linkage, LinkageError, MotionClearanceOptions, PathWorkspace, Scene, SignedDistanceOptions,
};

use crate::plot::{Plot, Scale, Series};
use crate::wire::shape::Solid;

type Robot = Linkage<Solid<DVec3>>;
type Around = Scene<Solid<DVec3>>;

/// The parts of each edge whose least distance is proved, and the poses in each that are looked at.
const PARTS: usize = 24;
const POSES: usize = 6;
/// The poses along each side of the plane of two joints.
const GRID: usize = 44;
/// How far these joints go from the pose, in radians or units of length.
const REACH: f64 = 1.2;
/// The parts of boxes after which a box is grown no more.
const MAX_BOXES: usize = 100_000;

fn plot(title: &str, axes: [&str; 2], series: Vec<Series>) -> Plot {
    let [x, y] = axes.map(str::to_owned);
    Plot { title: title.to_owned(), x, y, scales: [Scale::Linear; 2], floor: f64::NEG_INFINITY, series }
}

fn series(name: &str, points: Vec<[f64; 2]>, joined: bool, colour: usize) -> Series {
    Series { name: name.to_owned(), points, joined, colour }
}

/// The least distance of each part of the way, which is proved, and the distance at poses; `None` where there is
/// nothing to come near to.
pub(super) fn along_way(robot: &Robot, scene: &Around, waypoints: &[Vec<f64>]) -> Result<Option<Plot>, LinkageError> {
    let (mut paths, mut poses, options) =
        (PathWorkspace::new(), ConfigurationWorkspace::new(), MotionClearanceOptions::new());
    let Some(least) = robot.path_clearance(waypoints, scene, options, &mut paths)?.nearest else { return Ok(None) };
    let (mut sampled, mut proved) = (Vec::new(), Vec::new());
    for (edge, ends) in waypoints.windows(2).enumerate() {
        let at = |time: f64| -> Vec<f64> { ends[0].iter().zip(&ends[1]).map(|(a, b)| a + time * (b - a)).collect() };
        let time = |k: usize| k as f64 / (PARTS * POSES) as f64;
        for k in 0..=PARTS * POSES {
            let there = robot.clearance(&at(time(k)), scene, SignedDistanceOptions::new(), &mut poses)?;
            sampled.extend(there.map(|there| [edge as f64 + time(k), there.distance.signed_distance]));
        }
        for ends in (0..PARTS).map(|part| [part, part + 1].map(|end| time(end * POSES))) {
            let part = robot.path_clearance(&ends.map(at), scene, options, &mut paths)?;
            proved.extend(ends.map(|time| [edge as f64 + time, part.lower]));
        }
    }
    let nearest = vec![[least.edge as f64 + least.least.time, least.least.distance]];
    let series = vec![
        series("proved: no nearer in this part", proved, true, 0),
        series("distance at poses", sampled, false, 1),
        series("the least of the way", nearest, false, 3),
    ];
    Ok(Some(plot("How near a robot comes along its way", ["time, in edges", "distance, m"], series)))
}

/// The box of two joint values that is grown around a pose with all others at rest, and the poses around it that touch
/// something.
pub(super) fn grown_box(robot: &Robot, scene: &Around, pose: &[f64], moving: [usize; 2]) -> Result<Plot, LinkageError> {
    let limits: Vec<[f64; 2]> = (0..pose.len())
        .map(|joint| if moving.contains(&joint) { [-REACH, REACH] } else { [0.0; 2] }.map(|by| pose[joint] + by))
        .collect();
    let grown = robot.grown_box(pose, scene, &limits, 0.0, MAX_BOXES)?.joint_box;
    let [[left, right], [low, high]] = moving.map(|joint| grown[joint]);
    let (mut poses, mut touching, mut values) = (ConfigurationWorkspace::new(), Vec::new(), pose.to_vec());
    for (i, k) in (0..=GRID).flat_map(|i| (0..=GRID).map(move |k| (i, k))) {
        for (joint, step) in moving.into_iter().zip([i, k]) {
            values[joint] = limits[joint][0] + 2.0 * REACH * step as f64 / GRID as f64;
        }
        if !robot.is_free(&values, scene, 0.0, &mut poses)? {
            touching.push(moving.map(|joint| values[joint]));
        }
    }
    let corners = vec![[left, low], [right, low], [right, high], [left, high], [left, low]];
    let series = vec![
        series("grown box: proved free", corners, true, 0),
        series("poses that touch something", touching, false, 8),
        series("the pose", vec![moving.map(|joint| pose[joint])], false, 2),
    ];
    let [x, y] = moving.map(|joint| format!("joint {joint}, rad"));
    Ok(plot("A free box grown around a pose, in two joints", [&x, &y], series))
}
