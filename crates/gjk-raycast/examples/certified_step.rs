//! A UR5 follows an operator who does not look where it goes, among ten thousand obstacles, at 50 steps a second. A
//! filter lets a step through only if the arm certainly stays farther from everything than a margin. It asks for
//! distances only when the room of the last ones is used up.
//!
//! `cargo run -p gjk-raycast --example certified_step`, or `cargo run --release … certified_step 1000000` for so many
//! steps.

#![allow(clippy::print_stdout, reason = "an example talks")]

use std::error::Error;
use std::f64::consts::FRAC_PI_2;

use convex_support::glam::{DQuat, DVec3};
use convex_support::{Ball, Posed, Rounded, Segment};
use gjk_raycast::{
    BodyDistance, DistanceOptions, Joint, JointKind, Link, Linkage, MotionCastOptions, PathWorkspace, Pose, Scene,
};

/// A bar around each link of the arm.
type Bar = Rounded<Segment<DVec3>>;
type Values = [f64; 6];

/// How near is too near, in metres.
const MARGIN: f64 = 0.02;
/// How fast a joint is mostly asked to turn within a step, in radians.
const STEP: f64 = 0.3 / 50.0;
/// For how many steps the arm holds after a wish was refused.
const HOLD: u32 = 10;
/// How many obstacles are asked for about each link. All others are farther away than the last of them.
const NEAREST: usize = 12;

/// The arm by the lengths of its data sheet: each joint's place in the one before, its axis, and the end of its bar.
fn ur5() -> Result<Linkage<Bar>, Box<dyn Error>> {
    let (y, z) = (DVec3::Y, DVec3::Z);
    let arm = [
        (0.0, z * 0.089_159, z, y * 0.135_85, 0.07),
        (FRAC_PI_2, y * 0.135_85, y, z * 0.425, 0.06),
        (0.0, z * 0.425 - y * 0.119_7, y, z * 0.392_25, 0.05),
        (FRAC_PI_2, z * 0.392_25, y, y * 0.093, 0.045),
        (0.0, y * 0.093, z, z * 0.094_65, 0.045),
        (0.0, z * 0.094_65, y, y * 0.082_3, 0.04),
    ];
    let (mut joints, mut links) = (Vec::new(), Vec::new());
    for (i, (turn, translation, axis, end, radius)) in arm.into_iter().enumerate() {
        let pose = Pose { rotation: DQuat::from_rotation_y(turn), translation };
        joints.push(Joint { parent: i.checked_sub(1), pose, kind: JointKind::Revolute(axis) });
        let bar = Rounded::new(Segment::new([DVec3::ZERO, end])?, radius)?;
        links.push(Link { joint: Some(i), bodies: vec![bar] });
    }
    Ok(Linkage::new(joints, links)?)
}

/// Lets steps through that are certainly free.
struct Filter<'s> {
    arm: &'s Linkage<Bar>,
    scene: &'s Scene<Posed<Ball<DVec3>>>,
    at: Values,
    /// Where distances were asked for, and the obstacles near each link.
    asked_at: Values,
    near: Vec<Vec<BodyDistance<DVec3>>>,
    questions: usize,
    /// For how many more steps the arm holds.
    held: u32,
}

impl Filter<'_> {
    /// Whether what the last distances allow is enough to go to these values, for every link.
    fn allows(&self, wish: &Values) -> Result<bool, Box<dyn Error>> {
        for (link, near) in self.near.iter().enumerate() {
            let room = |near: &BodyDistance<DVec3>| near.distance.lower - MARGIN;
            // No point goes farther than that, whatever the joints do in between.
            let way = self.arm.way(link, &self.asked_at, wish, None)?;
            for obstacle in near.iter().filter(|obstacle| room(obstacle) <= way) {
                // Nor nearer to this one; of those that were not asked for, nothing else is known.
                let towards = -obstacle.distance.normal.ok_or("it is apart")?;
                let is_last = obstacle.body == near[NEAREST - 1].body;
                if is_last || room(obstacle) <= self.arm.way(link, &self.asked_at, wish, Some(towards))? {
                    return Ok(false);
                }
            }
        }
        Ok(!self.near.is_empty())
    }

    fn ask(&mut self) -> Result<(), Box<dyn Error>> {
        self.questions += 1;
        self.asked_at = self.at;
        self.near.resize(self.arm.links(), Vec::new());
        for (link, near) in self.near.iter_mut().enumerate() {
            let body = self.arm.placed(link, 0, &self.at)?;
            self.scene.all().nearest_k(&body, NEAREST, DistanceOptions::new(), near);
        }
        Ok(())
    }

    /// Goes where it is wished, or stays.
    fn follow(&mut self, wish: Values) -> Result<bool, Box<dyn Error>> {
        if self.held > 0 {
            self.held -= 1;
            return Ok(false);
        }
        if !self.allows(&wish)? {
            self.ask()?;
        }
        let goes = self.allows(&wish)?;
        if goes {
            self.at = wish;
        } else {
            self.held = HOLD;
        }
        Ok(goes)
    }
}

/// Numbers from -1 to 1.
fn random(seed: &mut u64) -> f64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

fn main() -> Result<(), Box<dyn Error>> {
    let steps: usize = std::env::args().nth(1).map_or(Ok(2000), |count| count.parse())?;
    let (arm, seed) = (ur5()?, &mut 0x2004_1120_u64);
    let start = [0.0, -1.2, 1.0, -1.0, -1.5, 0.0];

    // Clutter all around, from where the arm reaches to the walls, and a few things within its reach.
    let mut clear =
        Scene::new((0..arm.links()).map(|link| arm.placed(link, 0, &start)).collect::<Result<Vec<_>, _>>()?)?;
    clear.rebuild();
    let mut balls = Vec::new();
    while balls.len() < 10_000 {
        let at = DVec3::new(random(seed), random(seed), random(seed)) * 1.5;
        let is_far = at.length() > 0.8 || balls.len() < 12 && at.length() > 0.4;
        let ball = Posed::translated(Ball::new(0.01 + 0.01 * random(seed).abs())?, at)?;
        let near = clear.all().nearest(&ball, DistanceOptions::new()).nearest;
        if is_far && near.is_some_and(|near| near.distance.lower > 2.0 * MARGIN) {
            balls.push(ball);
        }
    }
    let scene = Scene::new(balls)?;

    let mut filter =
        Filter { arm: &arm, scene: &scene, at: start, asked_at: start, near: Vec::new(), questions: 0, held: 0 };
    let (mut wished, mut rates) = ([0.0; 6], [0.0; 6]);
    let (mut moved, mut refused, mut violations) = (0, 0, 0);
    let (options, mut workspace) =
        (MotionCastOptions::new().with_target_distance(MARGIN - 1e-12), PathWorkspace::new());
    for step in 0..steps {
        // Twice a second the operator wishes to go elsewhere, and is drawn back to the start a little.
        let before = filter.at;
        let mut wish = before;
        for i in 0..6 {
            if step % 25 == 0 {
                wished[i] = STEP * (1.5 * random(seed) - 0.2 * (before[i] - start[i]));
            }
            rates[i] += 0.1 * (wished[i] - rates[i]);
            wish[i] += rates[i];
        }
        if filter.follow(wish)? {
            moved += 1;
            // The judge asks at every step, and about all times of it.
            let is_free = arm.path(&[before, wish], &scene, options, &mut workspace)?.is_free();
            violations += usize::from(!is_free);
        } else {
            refused += 1;
            rates = [0.0; 6];
        }
    }
    let fewer = steps as f64 / filter.questions as f64;
    println!("{steps} steps, of which {moved} were taken and {refused} were not, as {MARGIN} m were not certain");
    println!("{} questions: one in {fewer:.1} steps; {violations} steps came too near", filter.questions);
    assert!(moved > steps / 2, "it follows");
    assert!(fewer >= 10.0 && violations == 0, "{fewer} steps a question, {violations} violations");
    Ok(())
}
