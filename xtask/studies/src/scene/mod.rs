//! `cargo xtask scene FILE`: a robot along its trajectory among obstacles.
//!
//! Each pair of a link and an obstacle is asked about at three levels, and the first that knows the answer ends it: the
//! outer ellipsoids do not touch, so neither do the bodies; the inner ellipsoids overlap, so the bodies do; else GJK
//! finds the distance of the hulls.

mod between;
mod body;
mod film;
mod levels;
mod picture;
mod planar;
mod report;
pub(crate) mod robot;
mod truth;
mod waypoints;

use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Args;
use convex_support::glam::{DQuat, DVec3};
use gjk_raycast::{DistanceOptions, distance};
use serde::Deserialize;

use self::between::Between;
use self::body::{Body, Placed};
pub(crate) use self::levels::embedded_levels;
use self::levels::{Decided, Levels, Pair};
use self::robot::{Pose, Robot};
use xtask::mesh::Meshes;
use xtask::output::ended;

/// The scene that is run where none is named: the robot works among objects and touches none.
const FREE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/scenes/ur5_free.json");

/// The same robot and objects on a way that leads through them, whose truth is known: all three levels are needed
/// there.
const CROWDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/scenes/ur5_reach.json");

/// Pictures of the film strip, spread over the trajectory where the scene does not say which rows are drawn.
const PICTURES: usize = 4;

/// One row in so many is drawn.
const STRIDE: usize = 12;

/// A scene as written.
#[derive(Debug, Deserialize)]
struct SceneFile {
    robot: PathBuf,
    dt: f64,
    joints: Vec<String>,
    obstacles: Vec<ObstacleFile>,
    /// A row of joint values for each step of time …
    #[serde(default)]
    trajectory: Vec<Vec<f64>>,
    /// … or some, to be joined by so many steps each.
    #[serde(default)]
    waypoints: Vec<Vec<f64>>,
    #[serde(default)]
    steps: usize,
    /// The rows that are drawn.
    pictures: Option<Vec<usize>>,
    /// Whether it is claimed that no link meets an obstacle, at any time.
    #[serde(default)]
    free: bool,
}

#[derive(Debug, Deserialize)]
struct ObstacleFile {
    mesh: PathBuf,
    translation: [f64; 3],
    rotation: [f64; 4],
}

/// A scene with its bodies.
struct Scene {
    robot: Robot,
    /// One per link of the robot.
    bodies: Vec<Body>,
    obstacles: Vec<Placed>,
    trajectory: Vec<Vec<f64>>,
    dt: f64,
    pictures: Vec<usize>,
    /// Whether the scene claims that it is free.
    claims_free: bool,
}

impl Scene {
    fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
        let SceneFile { robot, dt, joints, obstacles, mut trajectory, waypoints, steps, pictures, free } =
            serde_json::from_str(&text).map_err(|why| format!("{} is not a scene: {why}", path.display()))?;
        if trajectory.is_empty() {
            trajectory = waypoints::through(&waypoints, steps);
        }
        if let Some(row) = trajectory.iter().position(|row| row.len() != joints.len()) {
            let found = trajectory[row].len();
            return Err(format!(
                "{}: trajectory[{row}] has {found} values for {} joints",
                path.display(),
                joints.len()
            ));
        }
        let pictures = pictures.unwrap_or_else(|| {
            (0..PICTURES).map(|k| k * trajectory.len().saturating_sub(1) / (PICTURES - 1)).collect()
        });
        let folder = path.parent().unwrap_or(Path::new(""));
        let robot = Robot::read(&folder.join(robot), &joints)?;
        let meshes = Meshes::relative_to("");
        // Ellipsoids are fitted once for every mesh, however many bodies it serves.
        let mut fitted = HashMap::<PathBuf, Body>::new();
        let mut body = |path: PathBuf| match fitted.get(&path) {
            Some(body) => Ok(body.clone()),
            None => {
                let body = Body::read(&path, &meshes)?;
                fitted.insert(path, body.clone());
                Ok::<_, String>(body)
            }
        };
        let bodies = robot.links.iter().map(|link| body(link.mesh.clone())).collect::<Result<_, _>>()?;
        let obstacles = obstacles
            .iter()
            .enumerate()
            .map(|(i, o)| {
                let pose =
                    Pose { rotation: DQuat::from_array(o.rotation), translation: DVec3::from_array(o.translation) };
                body(folder.join(&o.mesh))?.at(pose).map_err(|why| format!("obstacles[{i}]: {why}"))
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { robot, bodies, obstacles, trajectory, dt, pictures, claims_free: free })
    }

    /// The links where the joint values put them.
    fn links_at(&self, values: &[f64]) -> Result<Vec<Placed>, String> {
        let place = |(body, pose): (&Body, Pose)| body.at(pose).map_err(|why| why.to_string());
        self.bodies.iter().zip(self.robot.poses(values)).map(place).collect()
    }
}

/// What is told of a row of the trajectory.
struct Row {
    time: f64,
    least_margin: f64,
    /// The least exact distance among the pairs for which it was asked.
    least_distance: Option<f64>,
    overlaps: usize,
    hulls_asked: usize,
}

/// What came of a scene.
struct Outcome {
    /// The time to fit the ellipsoids.
    fitted: Duration,
    levels: Levels,
    /// The time per row for the distance of every pair.
    every_pair: Duration,
    rows: Vec<Row>,
    /// What is between the rows, where none has an overlap.
    between: Option<Between>,
    truth: Option<truth::Truth>,
}

/// Which scene to run.
#[derive(Debug, Args)]
pub(crate) struct Choice {
    /// A scene: robot, joints, obstacles, trajectory; without one, a UR5 at work among objects. True overlaps and
    /// distances, one JSON line per pair, are read from beside it, if they are there.
    #[arg(value_name = "FILE", default_value = FREE, hide_default_value = true)]
    file: PathBuf,
    /// Instead of a file: a chain of so many links in the plane.
    #[arg(long, value_name = "LINKS", conflicts_with = "file", value_parser = clap::value_parser!(u32).range(1..=1000))]
    planar: Option<u32>,
    /// Where tables and plots go.
    #[arg(long, value_name = "FOLDER", default_value = "target/scene")]
    output: PathBuf,
}

/// Runs the scene and writes tables and plots.
pub(crate) fn run(choice: &Choice) -> ExitCode {
    let Choice { file, planar, output } = choice;
    let outcome = match planar {
        Some(links) => planar::run(*links, output).map(|()| true),
        None => scene(file, output),
    };
    ended(outcome)
}

/// Whether all agrees with the truth, where that is known.
fn scene(file: &Path, folder: &Path) -> Result<bool, String> {
    let start = Instant::now();
    let scene = Scene::read(file)?;
    let fitted = start.elapsed();
    let mut pairs = vec![Pair::default(); scene.bodies.len() * scene.obstacles.len()];
    let mut levels = Levels::default();
    let mut rows = Vec::new();
    let (mut moments, mut way) = (Vec::new(), Vec::new());
    let mut frames = picture::Frames::new(scene.obstacles.iter().map(|o| picture::outline(&o.outer)));
    // The truth of a scene, if it is known, lies beside it.
    let beside = Some(file.with_extension("truth.jsonl")).filter(|path| path.is_file());
    let mut checked = beside.map(|path| truth::Truth::read(&path)).transpose()?;
    for (step, values) in scene.trajectory.iter().enumerate() {
        let links = scene.links_at(values)?;
        let mut row = Row {
            time: step as f64 * scene.dt,
            least_margin: f64::INFINITY,
            least_distance: None,
            overlaps: 0,
            hulls_asked: 0,
        };
        let mut nearest = None;
        let mut states = vec![picture::State::Clear; links.len()];
        for (i, link) in links.iter().enumerate() {
            for (j, obstacle) in scene.obstacles.iter().enumerate() {
                let answer = pairs[i * scene.obstacles.len() + j].ask(link, obstacle, &mut levels);
                if answer.margin.margin < row.least_margin {
                    row.least_margin = answer.margin.margin;
                    nearest = Some((i, answer.margin.point));
                }
                let state = match (answer.overlap, answer.decided) {
                    (true, _) => picture::State::Overlapping,
                    (false, Decided::Hulls) => picture::State::Near,
                    (false, _) => picture::State::Clear,
                };
                states[i] = states[i].max(state);
                row.overlaps += usize::from(answer.overlap);
                row.hulls_asked += usize::from(answer.decided == Decided::Hulls);
                if let Some(exact) = &answer.exact {
                    row.least_distance = Some(row.least_distance.map_or(exact.distance, |d| d.min(exact.distance)));
                }
                if let Some(checked) = &mut checked {
                    checked.compare(step, &scene.robot.links[i].name, j, answer.overlap, || {
                        distance(&link.hull, &obstacle.hull, DistanceOptions::new()).distance
                    });
                }
            }
        }
        way.extend(links.last().map(|link| link.outer.center()));
        if scene.pictures.contains(&step) {
            moments.push(film::Moment { links: links.iter().cloned().zip(states.iter().copied()).collect() });
        }
        if step.is_multiple_of(STRIDE) {
            let distance = row.least_distance.map_or(String::new(), |d| format!(", least distance {:.1} mm", d * 1e3));
            frames.add(picture::Frame {
                links: links.iter().map(|link| picture::outline(&link.outer)).zip(states).collect(),
                nearest: nearest.map(|(i, point)| [links[i].outer.center(), point].map(picture::project)),
                caption: format!(
                    "t = {:.2} s\nleast margin {:.3}{}\n{} pairs: ellipsoids decided {}, hulls {}\n{} overlap{distance}",
                    row.time,
                    row.least_margin,
                    nearest.map_or(String::new(), |(i, _)| format!(" of {}", scene.robot.links[i].name)),
                    links.len() * scene.obstacles.len(),
                    links.len() * scene.obstacles.len() - row.hulls_asked,
                    row.hulls_asked,
                    row.overlaps,
                ),
            });
        }
        rows.push(row);
    }
    let every_pair = every_pair(&scene)?;
    let is_free = rows.iter().all(|row| row.overlaps == 0);
    let between = is_free.then(|| Between::of(&scene)).transpose()?;
    let is_proved_free = between.is_some_and(|between| between.free == between.asked);
    let right = checked.as_ref().is_none_or(truth::Truth::holds) && (is_proved_free || !scene.claims_free);
    let outcome = Outcome { fitted, levels, every_pair, rows, between, truth: checked };
    let written = report::write(&outcome.rows, &frames, folder)
        .and_then(|()| film::write(&moments, &scene.obstacles, &way, &folder.join("film.png")))
        .and_then(|()| report::print(&scene, &outcome, folder, &mut io::stdout().lock()));
    match written {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to {}: {why}", folder.display()))
        }
        _ => Ok(right),
    }
}

/// The time per row for the exact distance of every pair, cold: what the ellipsoids and the memory of the last row
/// leave out. The median over a sample of the rows.
fn every_pair(scene: &Scene) -> Result<Duration, String> {
    let mut times = Vec::new();
    for values in scene.trajectory.iter().step_by(10) {
        let links = scene.links_at(values)?;
        let start = Instant::now();
        for link in &links {
            for obstacle in &scene.obstacles {
                std::hint::black_box(distance(&link.hull, &obstacle.hull, DistanceOptions::new()).distance);
            }
        }
        times.push(start.elapsed());
    }
    times.sort_unstable();
    Ok(times.get(times.len() / 2).copied().unwrap_or_default())
}
