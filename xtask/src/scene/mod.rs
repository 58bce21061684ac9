//! `cargo xtask scene FILE`: a robot along its trajectory among obstacles.
//!
//! Each pair of a link and an obstacle is asked about at three levels, and the first that knows the answer ends it: the
//! outer ellipsoids do not touch, so neither do the bodies; the inner ellipsoids overlap, so the bodies do; else GJK
//! finds the distance of the hulls.

mod body;
mod picture;
mod planar;
mod robot;
mod truth;

use std::collections::HashMap;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use clap::Args;
use convex_support::glam::{DQuat, DVec3};
use ellip_margin::{Margin, MarginTracker};
use gjk_raycast::{Distance, DistanceOptions, distance};
use serde::Deserialize;

use self::body::{Body, Placed};
use self::robot::{Pose, Robot};
use crate::mesh::Meshes;
use crate::plot::{Plot, Scale, Series};

/// The scene that is run where none is named.
pub(crate) const EMBEDDED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/scenes/ur5_reach.json");

/// One row in so many is drawn.
const STRIDE: usize = 12;

/// A scene as written.
#[derive(Debug, Deserialize)]
struct SceneFile {
    robot: PathBuf,
    dt: f64,
    joints: Vec<String>,
    obstacles: Vec<ObstacleFile>,
    trajectory: Vec<Vec<f64>>,
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
}

impl Scene {
    fn read(path: &Path) -> Result<Self, String> {
        let text = fs::read_to_string(path).map_err(|why| format!("cannot read {}: {why}", path.display()))?;
        let SceneFile { robot, dt, joints, obstacles, trajectory } =
            serde_json::from_str(&text).map_err(|why| format!("{} is not a scene: {why}", path.display()))?;
        if let Some(row) = trajectory.iter().position(|row| row.len() != joints.len()) {
            let found = trajectory[row].len();
            return Err(format!(
                "{}: trajectory[{row}] has {found} values for {} joints",
                path.display(),
                joints.len()
            ));
        }
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
        Ok(Self { robot, bodies, obstacles, trajectory, dt })
    }

    /// The links where the joint values put them.
    fn links_at(&self, values: &[f64]) -> Result<Vec<Placed>, String> {
        let place = |(body, pose): (&Body, Pose)| body.at(pose).map_err(|why| why.to_string());
        self.bodies.iter().zip(self.robot.poses(values)).map(place).collect()
    }
}

/// Which level knew the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Decided {
    OuterDisjoint,
    InnerOverlap,
    Hulls,
}

/// What is known of a pair.
struct Answer {
    decided: Decided,
    overlap: bool,
    /// The margin of the outer ellipsoids.
    margin: Margin<DVec3>,
    /// The exact distance, where it had to be asked for.
    exact: Option<Distance<DVec3>>,
}

/// The memory of a pair along the trajectory.
#[derive(Clone, Default)]
struct Pair {
    outer: MarginTracker,
    inner: MarginTracker,
    /// The direction of the last closest points.
    axis: Option<DVec3>,
}

/// How often each level knew, and how long it took.
#[derive(Default)]
struct Levels {
    asked: [u64; 3],
    knew: [u64; 3],
    time: [Duration; 3],
}

impl Pair {
    fn ask(&mut self, link: &Placed, obstacle: &Placed, levels: &mut Levels) -> Answer {
        let mut level = 0;
        let mut timed = |knows: bool, start: Instant| {
            levels.asked[level] += 1;
            levels.knew[level] += u64::from(knows);
            levels.time[level] += start.elapsed();
            level += 1;
            knows
        };
        let start = Instant::now();
        let margin = self.outer.step(&link.outer, &obstacle.outer);
        if timed(margin.margin > 0.0, start) {
            return Answer { decided: Decided::OuterDisjoint, overlap: false, margin, exact: None };
        }
        let start = Instant::now();
        let inner = self.inner.step(&link.inner, &obstacle.inner);
        if timed(inner.margin <= 0.0, start) {
            return Answer { decided: Decided::InnerOverlap, overlap: true, margin, exact: None };
        }
        let start = Instant::now();
        let mut options = DistanceOptions::new();
        options.axis = self.axis;
        let exact = distance(&link.hull, &obstacle.hull, options);
        self.axis = exact.normal;
        timed(true, start);
        Answer { decided: Decided::Hulls, overlap: exact.overlap, margin, exact: Some(exact) }
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
    truth: Option<truth::Truth>,
}

/// Which scene to run.
#[derive(Debug, Args)]
pub(crate) struct Choice {
    /// A scene: robot, joints, obstacles, trajectory; without one, a UR5 reaching among objects.
    #[arg(value_name = "FILE", default_value = EMBEDDED, hide_default_value = true)]
    file: PathBuf,
    /// True overlaps and distances, one JSON line per pair [default: beside FILE, if there]
    #[arg(long, value_name = "FILE")]
    truth: Option<PathBuf>,
    /// Instead of a file: a chain of so many links in the plane.
    #[arg(long, value_name = "LINKS", conflicts_with_all = ["file", "truth"], value_parser = clap::value_parser!(u32).range(1..=1000))]
    planar: Option<u32>,
    /// Where tables and plots go.
    #[arg(long, value_name = "FOLDER", default_value = "target/scene")]
    output: PathBuf,
}

/// Runs the scene and writes tables and plots.
pub(crate) fn run(choice: &Choice) -> ExitCode {
    let Choice { file, truth, planar, output } = choice;
    let outcome = match planar {
        Some(links) => planar::run(*links, output).map(|()| true),
        None => scene(file, truth.as_deref(), output),
    };
    match outcome {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(why) => {
            let _ = writeln!(io::stderr(), "error: {why}");
            ExitCode::from(2)
        }
    }
}

/// Whether all agrees with the truth, where that is known.
fn scene(file: &Path, truth: Option<&Path>, folder: &Path) -> Result<bool, String> {
    let start = Instant::now();
    let scene = Scene::read(file)?;
    let fitted = start.elapsed();
    let mut pairs = vec![Pair::default(); scene.bodies.len() * scene.obstacles.len()];
    let mut levels = Levels::default();
    let mut rows = Vec::new();
    let mut frames = picture::Frames::new(scene.obstacles.iter().map(|o| picture::outline(&o.outer)));
    // The truth of a scene, if it is known, lies beside it.
    let beside = Some(file.with_extension("truth.jsonl")).filter(|path| path.is_file());
    let mut checked = truth.map(Path::to_path_buf).or(beside).map(|path| truth::Truth::read(&path)).transpose()?;
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
    let right = checked.as_ref().is_none_or(truth::Truth::holds);
    let outcome = Outcome { fitted, levels, every_pair, rows, truth: checked };
    let written =
        write(&outcome.rows, &frames, folder).and_then(|()| print(&scene, &outcome, folder, &mut io::stdout().lock()));
    match written {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to {}: {why}", folder.display()))
        }
        _ => Ok(right),
    }
}

/// How often a level was asked and knew, over the whole embedded scene.
pub(crate) struct Level {
    pub(crate) name: &'static str,
    pub(crate) asked: u64,
    pub(crate) knew: u64,
    /// Mean time of a question.
    pub(crate) nanoseconds: f64,
}

/// The levels of the embedded scene.
///
/// # Errors
/// If the scene cannot be read.
pub(crate) fn embedded_levels() -> Result<Vec<Level>, String> {
    let scene = Scene::read(Path::new(EMBEDDED))?;
    let mut pairs = vec![Pair::default(); scene.bodies.len() * scene.obstacles.len()];
    let mut levels = Levels::default();
    for values in &scene.trajectory {
        let links = scene.links_at(values)?;
        let asked = links.iter().flat_map(|link| scene.obstacles.iter().map(move |obstacle| (link, obstacle)));
        for (pair, (link, obstacle)) in pairs.iter_mut().zip(asked) {
            let _ = pair.ask(link, obstacle, &mut levels);
        }
    }
    let level = |i: usize, name| Level {
        name,
        asked: levels.asked[i],
        knew: levels.knew[i],
        nanoseconds: levels.time[i].as_nanos() as f64 / levels.asked[i].max(1) as f64,
    };
    Ok(vec![level(0, "outer ellipsoids"), level(1, "inner ellipsoids"), level(2, "exact hulls")])
}

/// The time per row for the exact distance of every pair, cold: what the ellipsoids and the memory of the last row
/// leave out. A sample of the rows.
fn every_pair(scene: &Scene) -> Result<Duration, String> {
    let (mut time, mut count) = (Duration::ZERO, 0);
    for values in scene.trajectory.iter().step_by(10) {
        let links = scene.links_at(values)?;
        let start = Instant::now();
        for link in &links {
            for obstacle in &scene.obstacles {
                std::hint::black_box(distance(&link.hull, &obstacle.hull, DistanceOptions::new()).distance);
            }
        }
        time += start.elapsed();
        count += 1;
    }
    Ok(time / count.max(1))
}

fn write(rows: &[Row], frames: &picture::Frames, folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut csv = String::from("time_s,least_margin,least_exact_distance_m,overlapping_pairs,hull_queries\n");
    for row in rows {
        let distance = row.least_distance.map_or_else(String::new, |d| d.to_string());
        csv += &format!("{},{},{distance},{},{}\n", row.time, row.least_margin, row.overlaps, row.hulls_asked);
    }
    fs::write(folder.join("rows.csv"), csv)?;
    let plot = |title: &str, y: &str, colour: usize, value: &dyn Fn(&Row) -> Option<f64>| Plot {
        title: title.to_owned(),
        x: "time (s)".to_owned(),
        y: y.to_owned(),
        scales: [Scale::Linear, Scale::Linear],
        floor: f64::NEG_INFINITY,
        series: vec![Series {
            name: y.to_owned(),
            points: rows.iter().filter_map(|row| Some([row.time, value(row)?])).collect(),
            joined: false,
            colour,
        }],
    };
    let margin = plot("Least margin of the outer ellipsoids", "margin", 0, &|row| Some(row.least_margin));
    fs::write(folder.join("margin.svg"), margin.svg())?;
    let distance = plot("Least exact distance, where the ellipsoids could not decide", "distance (mm)", 4, &|row| {
        row.least_distance.map(|metres| metres * 1e3)
    });
    fs::write(folder.join("distance.svg"), distance.svg())?;
    fs::write(folder.join("robot.svg"), frames.svg())
}

fn print(scene: &Scene, outcome: &Outcome, folder: &Path, output: &mut impl Write) -> io::Result<()> {
    let Outcome { fitted, levels, every_pair, rows, truth } = outcome;
    let (links, obstacles) = (scene.bodies.len(), scene.obstacles.len());
    writeln!(output, "{links} links, {obstacles} obstacles, {} rows: {} pairs", rows.len(), levels.asked[0])?;
    writeln!(output, "ellipsoids around and inside every mesh: {:.1} ms, once", fitted.as_secs_f64() * 1e3)?;
    for (link, body) in scene.robot.links.iter().zip(&scene.bodies) {
        writeln!(output, "  {:24} tightness {:.3}", link.name, body.tightness)?;
    }
    writeln!(output, "{:34} {:>9} {:>9} {:>7} {:>10}", "level", "asked", "decided", "share", "ns each")?;
    let names = ["outer ellipsoids are disjoint", "inner ellipsoids overlap", "exact distance of the hulls"];
    for (i, name) in names.iter().enumerate() {
        writeln!(
            output,
            "{name:34} {:>9} {:>9} {:>6.2}% {:>10.0}",
            levels.asked[i],
            levels.knew[i],
            100.0 * levels.knew[i] as f64 / levels.asked[0].max(1) as f64,
            levels.time[i].as_nanos() as f64 / levels.asked[i].max(1) as f64,
        )?;
    }
    let total: Duration = levels.time.iter().sum();
    writeln!(
        output,
        "{:.1} µs per row of {} pairs",
        total.as_secs_f64() * 1e6 / rows.len().max(1) as f64,
        links * obstacles
    )?;
    writeln!(
        output,
        "{:.1} µs per row for the distance of every pair of hulls instead",
        every_pair.as_secs_f64() * 1e6
    )?;
    let overlapping = rows.iter().filter(|row| row.overlaps > 0).count();
    let least = rows.iter().filter_map(|row| row.least_distance).filter(|d| *d > 0.0).fold(f64::INFINITY, f64::min);
    writeln!(output, "{overlapping} rows with an overlap; least exact distance otherwise {least:.6} m")?;
    if let Some(truth) = truth {
        truth.print(output)?;
    }
    writeln!(output, "written: {}", folder.display())
}
