//! `cargo xtask matrix ROBOT.urdf ROBOT.srdf`: whether the pairs of links that planners do not look at ever meet.
//!
//! Such a matrix is drawn from random poses, mostly ten thousand of them. Here each of its pairs is asked about all
//! joint values within the limits: it is proved that the hulls of the two links never meet, or a pose is found in which
//! they do, or it is said how much of the box of joint values is open.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use gjk_raycast::{JointBox, JointBoxOutcome};
use roxmltree::Document;

use crate::scene::robot::{Jointed, Robot};

/// Which robot, and what is known of it.
#[derive(Clone, Debug, Args)]
pub(crate) struct Choice {
    /// The robot.
    #[arg(value_name = "ROBOT.urdf")]
    robot: PathBuf,
    /// The file with its pairs that are not looked at; without one, all pairs are asked about.
    #[arg(value_name = "ROBOT.srdf")]
    pairs: Option<PathBuf>,
    /// The parts of the box to look at, for each pair.
    #[arg(long, value_name = "N", default_value_t = 1_000_000)]
    most: usize,
    /// Where the corrected matrix goes.
    #[arg(long, value_name = "FILE", default_value = "target/matrix.srdf")]
    output: PathBuf,
}

/// A pair of links that is not looked at, and why it is said not to be.
struct Pair {
    links: [String; 2],
    reason: String,
}

pub(crate) fn run(choice: &Choice) -> ExitCode {
    xtask::output::ended(answer(choice).map(|()| true))
}

fn answer(choice: &Choice) -> Result<(), String> {
    let robot = Robot::read_jointed(&choice.robot)?;
    let pairs = match &choice.pairs {
        Some(file) => pairs(file)?,
        None => every_pair(&robot),
    };
    let mut output = io::stdout().lock();
    let mut kept = Vec::new();
    let mut counts = [0; 4];
    let start = Instant::now();
    for Pair { links, reason } in &pairs {
        let place = |name: &String| robot.links.iter().position(|link| link == name);
        let (said, is_kept, column) = match [&links[0], &links[1]].map(place) {
            [Some(a), Some(b)] => {
                let answer = robot.linkage.joint_box([b, a], &robot.limits, 0.0, choice.most);
                let JointBox { outcome, boxes } = answer.map_err(|why| why.to_string())?;
                match outcome {
                    JointBoxOutcome::Never => (format!("never, proved by {boxes} boxes"), true, 0),
                    // Neighbours mostly overlap at their joint by construction, and are not to be looked at.
                    JointBoxOutcome::Meets { values, .. } => {
                        (format!("they meet at {}", list(&values)), reason.as_str() == "Adjacent", 1)
                    }
                    JointBoxOutcome::Undecided { share } => {
                        (format!("open in {share:.2e} of the box after {boxes} boxes"), false, 2)
                    }
                }
            }
            _ => ("a link has no mesh".to_owned(), true, 3),
        };
        counts[column] += 1;
        if is_kept {
            kept.push((links, if column == 0 { "Never" } else { reason.as_str() }));
        }
        writeln!(output, "{:<20} {:<20} {reason:<9} {said}", links[0], links[1]).map_err(|why| why.to_string())?;
    }
    let [never, meet, open, unknown] = counts;
    let (seconds, file) = (start.elapsed().as_secs_f64(), choice.output.display());
    write(&kept, &choice.output).map_err(|why| format!("cannot write {file}: {why}"))?;
    writeln!(
        output,
        "{} pairs: {never} proved never to meet, {meet} with a pose in which they do, {open} open, {unknown} without a \
         mesh; {seconds:.2} s. Written: {file}",
        pairs.len()
    )
    .map_err(|why| why.to_string())
}

/// The pairs that a file says are not to be looked at.
fn pairs(file: &Path) -> Result<Vec<Pair>, String> {
    let failed = |why: String| format!("{}: {why}", file.display());
    let text = fs::read_to_string(file).map_err(|why| failed(why.to_string()))?;
    let document = Document::parse(&text).map_err(|why| failed(why.to_string()))?;
    let elements = document.root_element().children().filter(|child| child.has_tag_name("disable_collisions"));
    let pair = |element: roxmltree::Node<'_, '_>| {
        let attribute = |name: &str| element.attribute(name).map(str::to_owned);
        let missing = || failed("a <disable_collisions> has no link1 or link2".to_owned());
        let links = [attribute("link1").ok_or_else(missing)?, attribute("link2").ok_or_else(missing)?];
        Ok(Pair { links, reason: attribute("reason").unwrap_or_default() })
    };
    elements.map(pair).collect()
}

fn every_pair(robot: &Jointed) -> Vec<Pair> {
    let pair = |i: usize, k: usize| [i, k].map(|link| robot.links[link].clone());
    let all = (0..robot.links.len()).flat_map(|i| (i + 1..robot.links.len()).map(move |k| (i, k)));
    all.map(|(i, k)| Pair { links: pair(i, k), reason: String::new() }).collect()
}

fn list(values: &[f64]) -> String {
    values.iter().map(|value| format!("{value:.4}")).collect::<Vec<_>>().join(", ")
}

/// Writes the pairs that need not be looked at.
fn write(kept: &[(&[String; 2], &str)], file: &Path) -> io::Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut text = String::new();
    for ([a, b], reason) in kept {
        text += &format!("<disable_collisions link1=\"{a}\" link2=\"{b}\" reason=\"{reason}\"/>\n");
    }
    fs::write(file, text)
}

#[cfg(test)]
mod tests {
    use convex_support::Posed;
    use gjk_raycast::{DistanceOptions, distance};
    use xtask::mesh::Meshes;

    use super::*;

    /// What is asked is the robot: as a box without extent, its links are as far apart as its poses say.
    #[test]
    fn the_linkage_has_the_poses_of_the_robot() -> Result<(), String> {
        let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data/robots/ur5/ur5.urdf"));
        let jointed = Robot::read_jointed(file)?;
        let values = [0.4, -1.1, 1.3, -0.6, 0.9, 0.2];
        assert_eq!((jointed.links.len(), jointed.limits.len()), (7, values.len()), "seven hulls, six joints");
        assert!(jointed.limits.iter().all(|[low, high]| low < high), "{:?}", jointed.limits);
        let names = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3"];
        let robot = Robot::read(file, &names.map(|name| format!("{name}_joint")))?;
        let meshes = Meshes::relative_to("");
        let placed = |link: usize| {
            let pose = robot.poses(&values)[link];
            let hull = meshes.load(&robot.links[link].mesh).map_err(|problem| problem.message)?.hull_f64();
            let hull = hull.map_err(|why| why.to_string())?;
            Posed::new(hull, pose.rotation, pose.translation).map_err(|why| why.to_string())
        };
        for (a, b) in [(0, 3), (1, 5), (2, 6)] {
            let apart = distance(&placed(a)?, &placed(b)?, DistanceOptions::new()).distance;
            assert!(apart > 0.01, "{} and {} are apart here", jointed.links[a], jointed.links[b]);
            let is_never = |target: f64| {
                let outcome = jointed.linkage.joint_box([a, b], &values.map(|value| [value; 2]), target, 100_000);
                outcome.map(|found| found.outcome == JointBoxOutcome::Never).map_err(|why| why.to_string())
            };
            assert!(is_never(apart * 0.999_999)? && !is_never(apart * 1.000_001)?, "{a} and {b}: {apart}");
        }
        Ok(())
    }
}
