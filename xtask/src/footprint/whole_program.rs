//! `cargo xtask footprint --program`: what a whole program costs. It asks three questions about each of five shapes and
//! each two of them, with their types or behind pointers, with all options or lean ones.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::{processor_time, write_program};

/// Five shapes in places of their own: a ball, a cuboid, a polytope, a capsule and a cylinder.
const SHAPES: &str = "
use gjk_raycast::convex_support::{Ball, Capsule, Cuboid, Cylinder, Polytope, Posed, SupportMap, glam::{DQuat, DVec3}};
use gjk_raycast::*;

fn input() -> f64 {
    std::env::args().count() as f64
}

fn place<S: SupportMap<Vector = DVec3>>(shape: S) -> Posed<S> {
    Posed::new(shape, DQuat::from_rotation_x(input()), DVec3::splat(3.0 * input())).unwrap()
}

fn ball() -> Posed<Ball<DVec3>> {
    place(Ball::new(input()).unwrap())
}

fn cuboid() -> Posed<Cuboid<DVec3>> {
    place(Cuboid::new(DVec3::splat(0.5 * input())).unwrap())
}

fn polytope() -> Posed<Polytope<DVec3>> {
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * input();
    place(Polytope::hull_of((0..8).map(corner)).unwrap())
}

fn capsule() -> Posed<Capsule<DVec3>> {
    place(Capsule::new(input(), 0.5 * input()).unwrap())
}

fn cylinder() -> Posed<Cylinder<DVec3>> {
    place(Cylinder::new(input(), 0.5 * input()).unwrap())
}
";

/// The three questions; `OPTIONS` stands for the constructor of their options.
const QUESTIONS: &str = "
fn ray<S: SupportMap<Vector = DVec3> + ?Sized>(shape: &S) {
    let ray = Ray { source: DVec3::splat(12.0 * input()), direction: DVec3::splat(-input()) };
    println!(\"{:?}\", ray_cast(shape, ray, RayCastOptions::OPTIONS()).unwrap().lower);
}

fn pair<A, B>(a: &A, b: &B)
where
    A: SupportMap<Vector = DVec3> + ?Sized,
    B: SupportMap<Vector = DVec3> + ?Sized,
{
    let motion = Motion { velocity_a: DVec3::splat(input()), velocity_b: DVec3::ZERO };
    println!(\"{:?}\", linear_cast(a, b, motion, LinearCastOptions::OPTIONS()).unwrap().lower);
    println!(\"{:?}\", distance(a, b, DistanceOptions::OPTIONS()).lower);
}
";

const NAMES: [&str; 5] = ["ball", "cuboid", "polytope", "capsule", "cylinder"];

const BEHIND_POINTERS: &str = "
fn main() {
    let shapes: [Box<dyn SupportMap<Vector = DVec3>>; 5] =
        [Box::new(ball()), Box::new(cuboid()), Box::new(polytope()), Box::new(capsule()), Box::new(cylinder())];
    for (i, a) in shapes.iter().enumerate() {
        ray(a);
        for b in &shapes[i..] {
            pair(a, b);
        }
    }
}
";

/// A program whose questions know the types of its shapes.
fn with_types() -> String {
    let mut main = String::from("\nfn main() {\n");
    for name in NAMES {
        let _ = writeln!(main, "    let {name} = {name}();");
    }
    for (i, a) in NAMES.iter().enumerate() {
        let _ = writeln!(main, "    ray(&{a});");
        for b in &NAMES[i..] {
            let _ = writeln!(main, "    pair(&{a}, &{b});");
        }
    }
    main + "}\n"
}

/// Processor time, in seconds, of building everything, and of building the program again after a change in it.
fn builds(folder: &Path, source: &str, profile: &[&str]) -> Result<[f64; 2], String> {
    let main = folder.join("src/main.rs");
    let build = |text: &str| {
        fs::write(&main, text).map_err(|why| format!("cannot write {}: {why}", main.display()))?;
        processor_time(folder, profile)
    };
    Ok([build(source)?, build(&format!("{source}// A change.\n"))?])
}

/// Builds the program in every way in `folder`; the table.
pub(super) fn measure(folder: &Path) -> Result<String, String> {
    let mut table = String::from(
        "| shapes | options | clean build, release | rebuild, release | program, release \
         | clean build, debug | rebuild, debug |\n|---|---|---:|---:|---:|---:|---:|\n",
    );
    for (shapes, main) in [("five types", with_types()), ("`dyn SupportMap`", String::from(BEHIND_POINTERS))] {
        for (options, constructor) in [("default", "default"), ("lean", "lean")] {
            let source = format!("{SHAPES}{}{main}", QUESTIONS.replace("OPTIONS", constructor));
            let name = format!("{shapes} {options}");
            let failed = |why: io::Error| format!("cannot build {name}: {why}");
            let import = Some(("gjk-raycast", "\"std\", \"f64\", \"hull\""));
            let here = write_program(folder, &name, import, "[dependencies]\n", &source).map_err(failed)?;
            let [clean, again] = builds(&here, &source, &["--release"])?;
            let program = here.join("target/release").join(format!("program{}", std::env::consts::EXE_SUFFIX));
            let bytes = fs::metadata(program).map_err(failed)?.len();
            let [clean_debug, again_debug] = builds(&here, &source, &[])?;
            let _ = writeln!(
                table,
                "| {shapes} | {options} | {clean:.1} s | {again:.1} s | {} kB | {clean_debug:.1} s | {again_debug:.1} s |",
                bytes / 1000
            );
            let _ = writeln!(io::stderr(), "{name}");
        }
    }
    Ok(table)
}
