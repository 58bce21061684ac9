//! Worlds that stand, fall, roll, rock and slide on their contacts, each checked: no energy from nowhere, no body that
//! sinks, drifts or trembles.
//!
//! `cargo run --release -p gjk-raycast --example worlds` checks them; with a folder after `--` it draws them there.

#![allow(clippy::print_stdout, reason = "examples print what they find")]

#[path = "world/film.rs"]
mod film;
mod world;

use std::error::Error;
use std::f64::consts::{FRAC_PI_2, TAU};

use film::Film;
use gjk_raycast::convex_support::glam::{DMat3, DVec3};
use gjk_raycast::convex_support::{Cylinder, Polytope};
use world::{Body, World, moments_of_box};

const GRAVITY: DVec3 = DVec3::new(0.0, -9.81, 0.0);
const STEP: f64 = 1.0 / 120.0;

type Checked = Result<Film, Box<dyn Error>>;
type Check = fn() -> Checked;

fn floor() -> Result<Body<DVec3>, Box<dyn Error>> {
    Ok(Body::fixed(DVec3::new(20.0, 1.0, 20.0), DVec3::new(0.0, -1.0, 0.0), DMat3::IDENTITY)?)
}

/// Steps a world for so many seconds and takes pictures at these times. The greatest rise of the energy in a step is
/// told, as a part of how much there was at first.
fn run(world: &mut World<DVec3>, film: &mut Film, seconds: f64, at: &[f64]) -> Result<f64, Box<dyn Error>> {
    let (first, mut last, mut rise) = (world.energy(), world.energy(), 0.0_f64);
    for i in 0..=(seconds / STEP).round() as usize {
        world.step(STEP)?;
        let energy = world.energy();
        rise = rise.max((energy - last) / first.abs());
        last = energy;
        if at.iter().any(|at| (at / STEP).round() as usize == i) {
            film.take(world, format!("{:.2} s", i as f64 * STEP));
        }
    }
    Ok(rise)
}

/// The greatest speed among bodies, that of turning included.
fn speed(world: &World<DVec3>) -> f64 {
    world.bodies.iter().map(|body| body.velocity.length() + body.angular_velocity.length()).fold(0.0, f64::max)
}

/// How far the own vertical axis of a body leans.
fn lean(body: &Body<DVec3>) -> f64 {
    body.rotation.y_axis.y.clamp(-1.0, 1.0).acos()
}

/// Ten bodies on one another, each a unit high.
fn stack(title: &'static str, body: impl Fn(DVec3) -> Result<Body<DVec3>, Box<dyn Error>>) -> Checked {
    let place = |i: usize| DVec3::new(0.0, 0.5 + i as f64, 0.0);
    let mut bodies = vec![floor()?];
    for i in 0..10 {
        bodies.push(body(place(i))?);
    }
    let mut world = World::new(bodies, GRAVITY, 0.5);
    let mut film = Film::new(title, [[-2.0, 2.0], [-0.5, 10.3]], 2);
    let rise = run(&mut world, &mut film, 1.0, &[0.0, 1.0])?;
    let moved = world.bodies[1..].iter().enumerate().map(|(i, body)| (body.center - place(i)).length());
    let moved = moved.fold(0.0, f64::max);
    let speed = speed(&world);
    println!("{title}: moved by {moved:.1e} m at most, speed {speed:.1e}, energy rose by {rise:.1e}");
    assert!(moved < 2e-3 && speed < 2e-2 && rise < 1e-4, "{moved} {speed} {rise}");
    Ok(film)
}

fn ten_boxes() -> Checked {
    stack("Ten boxes", |center| Ok(Body::cuboid(DVec3::splat(0.5), center, DMat3::IDENTITY)?))
}

/// Prisms of seven sides, each turned against the one below.
fn ten_hulls() -> Checked {
    stack("Ten hulls", |center| {
        let corner = |i: u32| DMat3::from_rotation_y(TAU * f64::from(i) / 7.0) * DVec3::X * 0.7;
        let corners = (0..7).flat_map(|i| [corner(i) - DVec3::Y * 0.5, corner(i) + DVec3::Y * 0.5]);
        let moments = moments_of_box(DVec3::new(0.6, 0.5, 0.6));
        Ok(Body::new(Polytope::new(corners)?, moments, center, DMat3::from_rotation_y(0.4 * center.y)))
    })
}

/// A coin that is tipped, turns on its rim, and comes to lie on its face.
fn cylinder() -> Checked {
    let (half_height, radius): (f64, f64) = (0.25, 0.5);
    let across = radius * radius / 4.0 + half_height * half_height / 3.0;
    let moments = DVec3::new(across, radius * radius / 2.0, across);
    let tipped = 0.9_f64;
    let height = half_height * tipped.cos() + radius * tipped.sin();
    let turn = DMat3::from_rotation_z(tipped);
    let mut coin = Body::new(Cylinder::new(half_height, radius)?, moments, DVec3::Y * height, turn);
    coin.angular_velocity = DVec3::new(0.0, 0.3, 0.0);
    let mut world = World::new(vec![floor()?, coin], GRAVITY, 0.5);
    let mut film = Film::new("A cylinder comes to rest on its face", [[-1.4, 1.2], [-0.2, 1.3]], 2);
    let rise = run(&mut world, &mut film, 4.0, &[0.0, 0.3, 0.45, 0.6, 0.8, 4.0])?;
    let (coin, speed) = (&world.bodies[1], speed(&world));
    let (lean, sunk) = (lean(coin), half_height - coin.center.y);
    println!("cylinder: leans by {lean:.1e}, sunk by {sunk:.1e} m, speed {speed:.1e}, energy rose by {rise:.1e}");
    assert!(lean < 5e-3 && sunk.abs() < 3e-3 && speed < 1e-2 && rise < 5e-3, "{lean} {sunk} {speed} {rise}");
    Ok(film)
}

/// A box let go on one of its edges rocks from edge to edge, and stands.
fn rocking() -> Checked {
    let (half, tipped) = (DVec3::new(0.25, 0.5, 0.25), 0.35_f64);
    let turn = DMat3::from_rotation_z(tipped);
    // Its lower edge on the side to which it is tipped is at zero.
    let block = Body::cuboid(half, turn * DVec3::new(half.x, half.y, 0.0) - DVec3::X * half.x, turn)?;
    let mut world = World::new(vec![floor()?, block], GRAVITY, 0.6);
    let mut film = Film::new("A box rocks on its edges", [[-0.8, 0.7], [-0.1, 1.2]], 3);
    let rise = run(&mut world, &mut film, 3.0, &[0.0, 0.35, 0.55, 0.75, 1.0, 3.0])?;
    let (block, speed) = (&world.bodies[1], speed(&world));
    let (lean, drift) = (lean(block), block.center.x.hypot(block.center.z));
    println!(
        "rocking box: leans by {lean:.1e}, drifted by {drift:.1e} m, speed {speed:.1e}, energy rose by {rise:.1e}"
    );
    assert!(lean < 5e-3 && drift < 0.05 && speed < 1e-2 && rise < 5e-3, "{lean} {drift} {speed} {rise}");
    Ok(film)
}

/// A row of dominoes, of which the first is pushed over.
fn dominoes() -> Checked {
    let half = DVec3::new(0.05, 0.5, 0.2);
    let mut bodies = vec![floor()?];
    for i in 0..8 {
        bodies.push(Body::cuboid(half, DVec3::new(0.5 * f64::from(i), half.y, 0.0), DMat3::IDENTITY)?);
    }
    bodies[1].angular_velocity = DVec3::new(0.0, 0.0, -2.0);
    bodies[1].velocity = DVec3::new(1.0, 0.0, 0.0);
    let mut world = World::new(bodies, GRAVITY, 0.4);
    let mut film = Film::new("A row of dominoes", [[-0.3, 4.8], [-0.1, 1.2]], 1);
    let rise = run(&mut world, &mut film, 3.0, &[0.0, 0.4, 0.8, 3.0])?;
    let fallen = world.bodies[1..].iter().map(lean).fold(FRAC_PI_2, f64::min);
    let deepest = world.contacts.iter().map(|found| found.contact.distance.signed_distance).fold(0.0, f64::min);
    let speed = speed(&world);
    println!(
        "dominoes: the least fallen leans by {fallen:.2}, {deepest:.1e} m deep, speed {speed:.1e}, energy {rise:.1e}"
    );
    assert!(fallen > 0.8 && deepest > -5e-3 && speed < 0.05 && rise < 5e-3, "{fallen} {deepest} {speed} {rise}");
    Ok(film)
}

/// How fast a box is that slid over tiles without friction, how far off its height, and the time it took.
fn slide(film: &mut Film, has_seams: bool) -> Result<[f64; 3], Box<dyn Error>> {
    let mut bodies = Vec::new();
    for i in 0..12 {
        let center = DVec3::new(f64::from(i) - 0.5, -0.5, 0.0);
        bodies.push(Body::fixed(DVec3::new(0.5, 0.5, 1.0), center, DMat3::IDENTITY)?);
    }
    let mut sled = Body::cuboid(DVec3::new(0.4, 0.25, 0.4), DVec3::Y * 0.249, DMat3::IDENTITY)?;
    sled.velocity = DVec3::X * 3.0;
    bodies.push(sled);
    let mut world = World::new(bodies, GRAVITY, 0.0);
    world.has_seams = has_seams;
    let (mut slowest, mut off, mut turned) = (f64::INFINITY, 0.0_f64, 0.0_f64);
    for i in 0..=300 {
        world.step(STEP)?;
        let sled = &world.bodies[12];
        slowest = slowest.min(sled.velocity.x);
        off = off.max((sled.center.y - 0.249).abs());
        turned = turned.max(lean(sled));
        if [0, 150, 300].contains(&i) {
            let seams = if has_seams { "seams count" } else { "seams left out" };
            film.take(&world, format!("{seams}, {:.2} s: {:.2} m/s", f64::from(i) * STEP, sled.velocity.x));
        }
    }
    Ok([slowest, off, turned])
}

fn tiles() -> Checked {
    let mut film = Film::new("A box slides over tiles", [[-1.0, 11.0], [-0.4, 1.4]], 1);
    let [slowest, off, turned] = slide(&mut film, false)?;
    let caught = slide(&mut film, true)?;
    println!("tiles: {slowest:.6} m/s, {off:.1e} m off, turned by {turned:.1e}; with seams {caught:.3?}");
    assert!(slowest > 3.0 - 1e-9 && off < 2e-3 && turned < 1e-3, "{slowest} {off} {turned}");
    Ok(film)
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1);
    let worlds: [(&str, Check); 6] = [
        ("boxes", ten_boxes),
        ("hulls", ten_hulls),
        ("cylinder", cylinder),
        ("rocking", rocking),
        ("dominoes", dominoes),
        ("tiles", tiles),
    ];
    for (name, check) in worlds {
        let film = check()?;
        if let Some(folder) = &folder {
            std::fs::write(format!("{folder}/world-{name}.svg"), film.svg())?;
        }
    }
    Ok(())
}
