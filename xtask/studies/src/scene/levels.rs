//! The three levels at which a pair is asked about, and how often each knew the answer.

use std::path::Path;
use std::time::{Duration, Instant};

use convex_support::glam::DVec3;
use ellip_margin::{Margin, MarginTracker};
use gjk_raycast::{Distance, DistanceOptions, distance};

use super::body::Placed;
use super::{CROWDED, Scene};

/// Which level knew the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Decided {
    OuterDisjoint,
    InnerOverlap,
    Hulls,
}

/// What is known of a pair.
pub(super) struct Answer {
    pub(super) decided: Decided,
    pub(super) overlap: bool,
    /// The margin of the outer ellipsoids.
    pub(super) margin: Margin<DVec3>,
    /// The exact distance, where it had to be asked for.
    pub(super) exact: Option<Distance<DVec3>>,
}

/// The memory of a pair along the trajectory.
#[derive(Clone, Default)]
pub(super) struct Pair {
    outer: MarginTracker,
    inner: MarginTracker,
    /// The direction of the last closest points.
    axis: Option<DVec3>,
}

/// How often each level was asked and knew, and how long it took.
#[derive(Default)]
pub(super) struct Levels {
    pub(super) knew: [usize; 3],
    times: [Vec<Duration>; 3],
}

impl Levels {
    pub(super) fn asked(&self, level: usize) -> usize {
        self.times[level].len()
    }

    /// The median time of a question in nanoseconds: a mean would be that of the few during which the machine did
    /// something else.
    pub(super) fn nanoseconds(&self, level: usize) -> f64 {
        let mut times = self.times[level].clone();
        let middle = times.len() / 2;
        if times.is_empty() { 0.0 } else { times.select_nth_unstable(middle).1.as_nanos() as f64 }
    }
}

impl Pair {
    pub(super) fn ask(&mut self, link: &Placed, obstacle: &Placed, levels: &mut Levels) -> Answer {
        let mut level = 0;
        let mut timed = |knows: bool, start: Instant| {
            levels.times[level].push(start.elapsed());
            levels.knew[level] += usize::from(knows);
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

/// How often a level was asked and knew, over the whole of the crowded scene.
pub(crate) struct Level {
    pub(crate) name: &'static str,
    pub(crate) asked: usize,
    pub(crate) knew: usize,
    /// Median time of a question.
    pub(crate) nanoseconds: f64,
}

/// The levels of the crowded scene.
///
/// # Errors
/// If the scene cannot be read.
pub(crate) fn embedded_levels() -> Result<Vec<Level>, String> {
    let scene = Scene::read(Path::new(CROWDED))?;
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
        asked: levels.asked(i),
        knew: levels.knew[i],
        nanoseconds: levels.nanoseconds(i),
    };
    Ok(vec![level(0, "outer ellipsoids"), level(1, "inner ellipsoids"), level(2, "exact hulls")])
}
