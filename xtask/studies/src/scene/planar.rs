//! A chain of links in the plane among elliptic obstacles, as in Figure 4 of Rimon and Boyd.
//!
//! Links and obstacles are ellipses, so that the margin is all there is to know. Each step asks for the least margin of
//! all pairs and for its gradient in the joint angles: which joint to turn, and which way, to be safer.

use std::f64::consts::TAU;
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use convex_support::glam::DVec2;
use convex_support::{Ellipsoid, InvalidShape};
use ellip_margin::{Clearance, EllipsoidPair, LeftOut, MarginOptions, MarginTracker};

use super::picture;
use xtask::plot::{Plot, Scale, Series};

const STEPS: usize = 720;

/// The chain at a time between 0 and 1: its links and the joints before them. It is of length 1 whatever the links.
fn chain(links: u32, time: f64) -> Result<(Vec<Ellipsoid<DVec2>>, Vec<DVec2>), InvalidShape> {
    let length = 1.0 / f64::from(links);
    let (mut joint, mut angle) = (DVec2::ZERO, 0.0);
    let (mut bodies, mut joints) = (Vec::new(), Vec::new());
    for i in 0..links {
        // The first joint goes around once; the others swing, each a little after the one before.
        let swing = (TAU * (2.0 * time + f64::from(i) * length)).sin();
        angle += if i == 0 { TAU * time } else { 1.6 * length * swing };
        let end = joint + DVec2::from_angle(angle) * length;
        let semi_axes = DVec2::new(0.55 * length, (0.2 * length).max(0.01));
        bodies.push(Ellipsoid::new((joint + end) / 2.0, semi_axes, angle)?);
        joints.push(joint);
        joint = end;
    }
    Ok((bodies, joints))
}

/// Obstacles around the reach of the chain, some within it.
fn obstacles() -> Result<Vec<Ellipsoid<DVec2>>, InvalidShape> {
    let at = |i: u32| {
        let part = f64::from(i) / 9.0;
        let center = DVec2::from_angle(TAU * part) * (1.02 + 0.18 * (TAU * 2.0 * part).sin());
        Ellipsoid::new(center, DVec2::new(0.10 + 0.02 * f64::from(i % 3), 0.05), 2.0 * f64::from(i))
    };
    (0..9).map(at).collect()
}

/// Runs the chain once around and writes a table, a plot and a picture.
pub(super) fn run(links: u32, folder: &Path) -> Result<(), String> {
    let invalid = |why: InvalidShape| why.to_string();
    let obstacles = obstacles().map_err(invalid)?;
    let mut clearance = Clearance::new(&obstacles, MarginOptions::default()).map_err(|why| why.to_string())?;
    let mut trackers = vec![MarginTracker::default(); links as usize * obstacles.len()];
    let mut frames = picture::Frames::new(obstacles.iter().map(picture::flat));
    let mut csv = String::from("time,least_margin,link,obstacle,pairs_evaluated,steepest_joint,slope_per_radian\n");
    let (mut margins, mut left_out, mut evaluated) = (Vec::new(), LeftOut::default(), 0);
    let (mut time, mut tracking) = (Duration::ZERO, Duration::ZERO);
    for step in 0..STEPS {
        let now = step as f64 / STEPS as f64;
        let (bodies, joints) = chain(links, now).map_err(invalid)?;
        let start = Instant::now();
        let least = clearance.step(&bodies).map_err(|why| why.to_string())?;
        let pair = EllipsoidPair::new(&bodies[least.link], &obstacles[least.obstacle], MarginOptions::default());
        let gradient = pair.margin().gradient();
        time += start.elapsed();
        // Joints beyond the link do not move it.
        let slopes = joints.iter().take(least.link + 1).map(|&joint| gradient.revolute(joint, 1.0)).enumerate();
        let steepest = slopes.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())).unwrap_or_default();

        let start = Instant::now();
        let pairs = bodies.iter().flat_map(|link| obstacles.iter().map(move |obstacle| (link, obstacle)));
        for (tracker, (link, obstacle)) in trackers.iter_mut().zip(pairs) {
            std::hint::black_box(tracker.step(link, obstacle).margin);
        }
        tracking += start.elapsed();

        left_out.by_motion += least.left_out.by_motion;
        left_out.by_box += least.left_out.by_box;
        left_out.by_sphere += least.left_out.by_sphere;
        left_out.by_plane += least.left_out.by_plane;
        left_out.by_normal += least.left_out.by_normal;
        evaluated += least.pairs_evaluated;
        margins.push([now, least.margin.margin]);
        csv += &format!(
            "{now},{},{},{},{},{},{}\n",
            least.margin.margin, least.link, least.obstacle, least.pairs_evaluated, steepest.0, steepest.1
        );
        if step.is_multiple_of(10) {
            // A margin of 0 or less is an overlap of what is drawn.
            let near = clearance.within(&bodies, 0.0).map_err(|why| why.to_string())?;
            let overlaps: Vec<usize> = near.iter().map(|pair| pair.link).collect();
            let state =
                |i: usize| if overlaps.contains(&i) { picture::State::Overlapping } else { picture::State::Clear };
            frames.add(picture::Frame {
                links: bodies.iter().enumerate().map(|(i, link)| (picture::flat(link), state(i))).collect(),
                nearest: Some([bodies[least.link].center(), least.margin.point]),
                caption: format!(
                    "t = {now:.2}\nleast margin {:.3} of link {}\n{} of {} pairs solved\nturn joint {}: {:+.1} per radian",
                    least.margin.margin,
                    least.link,
                    least.pairs_evaluated,
                    trackers.len(),
                    steepest.0,
                    steepest.1
                ),
            });
        }
    }
    let plot = Plot {
        title: format!("Least margin of a chain of {links} links among {} obstacles", obstacles.len()),
        x: "time (turns of the first joint)".to_owned(),
        y: "least margin".to_owned(),
        scales: [Scale::Linear, Scale::Linear],
        floor: f64::NEG_INFINITY,
        series: vec![Series { name: "least margin".to_owned(), points: margins, joined: false, colour: 0 }],
    };
    let write = || -> io::Result<()> {
        fs::create_dir_all(folder)?;
        fs::write(folder.join("planar.csv"), &csv)?;
        fs::write(folder.join("planar-margin.svg"), plot.svg())?;
        fs::write(folder.join("planar.svg"), frames.svg())?;
        let mut output = io::stdout().lock();
        let pairs = trackers.len() * STEPS;
        let share = |count: usize| 100.0 * count as f64 / pairs as f64;
        writeln!(output, "{links} links, {} obstacles, {STEPS} steps: {pairs} pairs", obstacles.len())?;
        writeln!(output, "solved                              {evaluated:>9} {:>6.2}%", share(evaluated))?;
        for (why, count) in [
            ("the link has hardly moved", left_out.by_motion),
            ("a box around obstacles is too far", left_out.by_box),
            ("balls around both are too far", left_out.by_sphere),
            ("a plane separates them far enough", left_out.by_plane),
            ("so does the plane of the last normal", left_out.by_normal),
        ] {
            writeln!(output, "left out: {why:25} {count:>9} {:>6.2}%", share(count))?;
        }
        let iterations: u64 = trackers.iter().map(MarginTracker::iterations).sum();
        let per_step = |time: Duration| time.as_secs_f64() * 1e6 / STEPS as f64;
        writeln!(output, "least margin and its gradient: {:.2} µs per step", per_step(time))?;
        writeln!(
            output,
            "every pair tracked instead: {:.2} µs per step, {:.2} iterations per pair",
            per_step(tracking),
            iterations as f64 / pairs as f64
        )?;
        writeln!(output, "written: {}", folder.display())
    };
    match write() {
        Err(why) if why.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write to {}: {why}", folder.display()))
        }
        _ => Ok(()),
    }
}
