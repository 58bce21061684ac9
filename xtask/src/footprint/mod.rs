//! `cargo xtask footprint`: what importing each crate alone costs. Packages in the tree, time of a clean build, and the
//! code of a program that asks one question, beside a program that asks none.

mod microcontroller;
mod whole_program;

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use clap::Args;
use workloads::note;
use workloads::provenance::provenance;

/// A program that asks one question.
struct Program {
    name: &'static str,
    /// The crate it imports, and the features it does so with; none for the program to compare with.
    import: Option<(&'static str, &'static str)>,
    /// The parts of its text.
    body: &'static [&'static str],
}

const SUPPORT: &str = "
    use convex_support::{Cuboid, SupportMap, glam::DVec3};
    let cuboid = Cuboid::new(DVec3::splat(input())).unwrap();
    println!(\"{}\", cuboid.support(DVec3::splat(input())));";

const HULL: &str = "
    use convex_support::{Polytope, SupportMap, glam::DVec3};
    let corner = |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * input();
    let cube = Polytope::hull_of((0..8).map(corner)).unwrap();
    println!(\"{}\", cube.support(DVec3::splat(input())));";

/// Two boxes, of which the second is turned and moved.
const BOXES: &str = "
    use gjk_raycast::convex_support::{Cuboid, Posed, glam::{DQuat, DVec3}};
    let a = Cuboid::new(DVec3::splat(input())).unwrap();
    let turn = DQuat::from_rotation_x(input());
    let b = Posed::new(Cuboid::new(DVec3::splat(0.5 * input())).unwrap(), turn, DVec3::splat(9.0 * input())).unwrap();";

const INTERSECTS: &str = "
    println!(\"{:?}\", gjk_raycast::intersects(&a, &b, Default::default()).overlap);";

const DISTANCE: &str = "
    println!(\"{:?}\", gjk_raycast::distance(&a, &b, Default::default()).lower);";

const LEAN_DISTANCE: &str = "
    println!(\"{:?}\", gjk_raycast::distance(&a, &b, gjk_raycast::DistanceOptions::lean()).lower);";

const DEPTH: &str = "
    println!(\"{:?}\", gjk_raycast::signed_distance(&a, &b, Default::default()).lower);";

const RAY: &str = "
    use gjk_raycast::{Ray, RayCastOptions, ray_cast};
    let ray = Ray { source: DVec3::splat(12.0 * input()), direction: DVec3::splat(-input()) };
    println!(\"{:?}\", ray_cast(&b, ray, RayCastOptions::default()).unwrap().lower);";

const LEAN_RAY: &str = "
    use gjk_raycast::{Ray, RayCastOptions, ray_cast};
    let ray = Ray { source: DVec3::splat(12.0 * input()), direction: DVec3::splat(-input()) };
    println!(\"{:?}\", ray_cast(&b, ray, RayCastOptions::lean()).unwrap().lower);";

const LINEAR: &str = "
    use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
    let motion = Motion { velocity_a: DVec3::splat(input()), velocity_b: DVec3::ZERO };
    println!(\"{:?}\", linear_cast(&a, &b, motion, LinearCastOptions::default()).unwrap().lower);";

const LEAN_LINEAR: &str = "
    use gjk_raycast::{LinearCastOptions, Motion, linear_cast};
    let motion = Motion { velocity_a: DVec3::splat(input()), velocity_b: DVec3::ZERO };
    println!(\"{:?}\", linear_cast(&a, &b, motion, LinearCastOptions::lean()).unwrap().lower);";

const TURNING: &str = "
    use gjk_raycast::{MotionCastOptions, RigidMotion, motion_cast};
    let turning = RigidMotion::rotation(DVec3::splat(input()), DVec3::splat(9.0));
    let options = MotionCastOptions::new().with_max_time(input());
    println!(\"{:?}\", motion_cast(&a, turning, &b, RigidMotion::default(), options).unwrap().lower);";

const LEAN_TURNING: &str = "
    use gjk_raycast::{MotionCastOptions, RigidMotion, motion_cast};
    let turning = RigidMotion::rotation(DVec3::splat(input()), DVec3::splat(9.0));
    let options = MotionCastOptions::lean().with_max_time(input());
    println!(\"{:?}\", motion_cast(&a, turning, &b, RigidMotion::default(), options).unwrap().lower);";

const ENCLOSING: &str = "
    use lj_ellipsoid::{EnclosingOptions, enclosing};
    let a = input();
    let points = [[a, 0.0, 0.0], [0.0, a, 0.0], [0.0, 0.0, a], [a, a, a], [-a, a, 0.5]];
    println!(\"{}\", enclosing(&points, EnclosingOptions::default()).unwrap().log_det_gap);";

const MARGIN: &str = "
    use ellip_margin::convex_support::{Ellipsoid, glam::{DQuat, DVec3}};
    use ellip_margin::{MarginOptions, free_margin};
    let at = |x| Ellipsoid::new(DVec3::splat(x), DVec3::new(1.0, 2.0, input()), DQuat::IDENTITY).unwrap();
    println!(\"{}\", free_margin(&at(0.0), &at(9.0), MarginOptions::default()).margin);";

const EIGEN: &str = "
    use ellip_margin::convex_support::{Ellipsoid, glam::{DQuat, DVec3}};
    let at = |x| Ellipsoid::new(DVec3::splat(x), DVec3::new(1.0, 2.0, input()), DQuat::IDENTITY).unwrap();
    println!(\"{}\", ellip_margin::paper::free_margin_eigen(&at(0.0), &at(9.0)).margin);";

const GJK_RAYCAST: Option<(&str, &str)> = Some(("gjk-raycast", "\"std\", \"f64\""));

const PROGRAMS: &[Program] = &[
    Program { name: "nothing", import: None, body: &["println!(\"{:?}\", input());"] },
    Program { name: "convex-support", import: Some(("convex-support", "\"std\", \"f64\"")), body: &[SUPPORT] },
    Program {
        name: "convex-support, no `std`",
        import: Some(("convex-support", "\"f64\", \"alloc\"")),
        body: &[SUPPORT],
    },
    Program {
        name: "convex-support, hull",
        import: Some(("convex-support", "\"std\", \"f64\", \"hull\"")),
        body: &[HULL],
    },
    Program {
        name: "convex-support, serde",
        import: Some(("convex-support", "\"std\", \"f64\", \"serde\"")),
        body: &[SUPPORT],
    },
    Program {
        name: "convex-support, mint",
        import: Some(("convex-support", "\"std\", \"f64\", \"mint\"")),
        body: &[SUPPORT],
    },
    Program { name: "gjk-raycast, `intersects`", import: GJK_RAYCAST, body: &[BOXES, INTERSECTS] },
    Program { name: "gjk-raycast, `distance`", import: GJK_RAYCAST, body: &[BOXES, DISTANCE] },
    Program { name: "gjk-raycast, `distance`, lean", import: GJK_RAYCAST, body: &[BOXES, LEAN_DISTANCE] },
    Program { name: "gjk-raycast, `signed_distance`", import: GJK_RAYCAST, body: &[BOXES, DEPTH] },
    Program { name: "gjk-raycast, `ray_cast`", import: GJK_RAYCAST, body: &[BOXES, RAY] },
    Program { name: "gjk-raycast, `ray_cast`, lean", import: GJK_RAYCAST, body: &[BOXES, LEAN_RAY] },
    Program { name: "gjk-raycast, `linear_cast`", import: GJK_RAYCAST, body: &[BOXES, LINEAR] },
    Program { name: "gjk-raycast, `linear_cast`, lean", import: GJK_RAYCAST, body: &[BOXES, LEAN_LINEAR] },
    Program { name: "gjk-raycast, `motion_cast`", import: GJK_RAYCAST, body: &[BOXES, TURNING] },
    Program { name: "gjk-raycast, `motion_cast`, lean", import: GJK_RAYCAST, body: &[BOXES, LEAN_TURNING] },
    Program {
        name: "gjk-raycast, no `std`, `distance`",
        import: Some(("gjk-raycast", "\"f64\", \"alloc\"")),
        body: &[BOXES, DISTANCE],
    },
    Program {
        name: "gjk-raycast, no `alloc`, `distance`",
        import: Some(("gjk-raycast", "\"f64\"")),
        body: &[BOXES, DISTANCE],
    },
    Program {
        name: "gjk-raycast, serde, `distance`",
        import: Some(("gjk-raycast", "\"std\", \"f64\", \"serde\"")),
        body: &[BOXES, DISTANCE],
    },
    Program { name: "lj-ellipsoid", import: Some(("lj-ellipsoid", "")), body: &[ENCLOSING] },
    Program { name: "lj-ellipsoid, rayon", import: Some(("lj-ellipsoid", "\"rayon\"")), body: &[ENCLOSING] },
    Program {
        name: "lj-ellipsoid, convex-support",
        import: Some(("lj-ellipsoid", "\"convex-support\"")),
        body: &[ENCLOSING],
    },
    Program { name: "lj-ellipsoid, serde", import: Some(("lj-ellipsoid", "\"serde\"")), body: &[ENCLOSING] },
    Program { name: "ellip-margin", import: Some(("ellip-margin", "\"std\", \"f64\"")), body: &[MARGIN] },
    Program { name: "ellip-margin, no `std`", import: Some(("ellip-margin", "\"f64\"")), body: &[MARGIN] },
    Program {
        name: "ellip-margin, paper",
        import: Some(("ellip-margin", "\"std\", \"f64\", \"paper\"")),
        body: &[EIGEN],
    },
    Program {
        name: "ellip-margin, simd",
        import: Some(("ellip-margin", "\"std\", \"f64\", \"simd\"")),
        body: &[MARGIN],
    },
];

/// The rest of the release profile: as small as the linker makes it.
const SMALL: &str = "lto = true\ncodegen-units = 1\npanic = \"abort\"\n[dependencies]\n";

/// What a program costs.
struct Cost {
    packages: usize,
    seconds: f64,
    bytes: u64,
}

/// Which programs are built, and where.
#[derive(Debug, Args)]
pub struct Choice {
    /// Where the programs are built; emptied first.
    #[arg(long, value_name = "FOLDER", default_value = "target/footprint")]
    output: PathBuf,
    /// Measure what one question costs a Cortex-M4 instead: code, stack, memory and instructions. Needs
    /// `rustup target add thumbv7em-none-eabihf` and `qemu-system-arm`.
    #[arg(long)]
    microcontroller: bool,
    /// Measure a whole program instead, which asks three questions about five shapes: code, and the time to build it
    /// and to build it again.
    #[arg(long, conflicts_with = "microcontroller")]
    program: bool,
}

/// Builds the programs, prints their table, and puts it into `docs/choosing-a-method.md`.
pub fn run(choice: &Choice) -> ExitCode {
    let (name, measure): (_, fn(&Path) -> _) = match choice {
        Choice { microcontroller: true, .. } => ("microcontroller", microcontroller::measure),
        Choice { program: true, .. } => ("program", whole_program::measure),
        _ => ("footprint", measure),
    };
    let written = emptied(&choice.output).and_then(|folder| measure(&folder)).and_then(|table| {
        let _ = io::stdout().write_all(table.as_bytes());
        let part = format!("{table}\nMeasured on {}.", provenance());
        let note = note::path("choosing-a-method.md");
        note::write(&note, name, &part).map_err(|why| format!("cannot write {}: {why}", note.display()))
    });
    crate::output::ended(written.map(|()| true))
}

fn emptied(folder: &Path) -> Result<PathBuf, String> {
    let failed = |why: io::Error| format!("cannot build in {}: {why}", folder.display());
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(failed)?;
    }
    fs::create_dir_all(folder).map_err(failed)?;
    folder.canonicalize().map_err(failed)
}

fn measure(folder: &Path) -> Result<String, String> {
    let mut table = String::from(
        "| program that asks one question | packages | clean build (processor time) | code |\n|---|---:|---:|---:|\n",
    );
    let mut nothing = 0;
    for program in PROGRAMS {
        let cost = build(program, folder)?;
        if program.import.is_none() {
            nothing = cost.bytes;
        }
        table += &format!(
            "| {} | {} | {:.1} s | {} kB |\n",
            program.name,
            cost.packages,
            cost.seconds,
            cost.bytes.saturating_sub(nothing) / 1000
        );
        let _ = writeln!(io::stderr(), "{}", program.name);
    }
    Ok(table)
}

fn build(program: &Program, folder: &Path) -> Result<Cost, String> {
    let failed = |why: io::Error| format!("cannot build {}: {why}", program.name);
    let source = format!(
        "fn input() -> f64 {{ std::env::args().count() as f64 }}\nfn main() {{\n{}\n}}\n",
        program.body.concat()
    );
    let here = write_program(folder, program.name, program.import, SMALL, &source).map_err(failed)?;
    let tree = cargo(
        &here,
        &here.join("target"),
        &["tree", "--quiet", "--edges", "normal", "--prefix", "none", "--format", "{p}"],
    )?;
    // The program itself does not count.
    let packages: BTreeSet<&str> = tree.lines().filter(|line| !line.starts_with("program ")).collect();
    let seconds = processor_time(&here, &["--release"])?;
    let binary = here.join("target/release").join(format!("program{}", std::env::consts::EXE_SUFFIX));
    let bytes = fs::metadata(binary).map_err(failed)?.len();
    Ok(Cost { packages: packages.len(), seconds, bytes })
}

/// Writes a program that imports a crate with some features; its folder. Its manifest has `more` lines: the rest of the
/// release profile, and of the dependencies.
fn write_program(
    folder: &Path,
    name: &str,
    import: Option<(&str, &str)>,
    more: &str,
    source: &str,
) -> io::Result<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap_or(Path::new("."));
    let here = folder.join(name.replace([',', '`'], "").replace(' ', "-"));
    let import = import.map_or_else(String::new, |(name, features)| {
        let path = root.join("crates").join(name);
        format!("{name} = {{ path = {path:?}, default-features = false, features = [{features}] }}\n")
    });
    let manifest = format!(
        "[package]\nname = \"program\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n\
         [profile.release]\nstrip = true\n\
         {more}{import}"
    );
    fs::create_dir_all(here.join("src"))?;
    fs::write(here.join("Cargo.toml"), manifest)?;
    fs::write(here.join("src/main.rs"), source)?;
    // The versions of the workspace, so that nothing new of these is fetched.
    fs::copy(root.join("Cargo.lock"), here.join("Cargo.lock"))?;
    Ok(here)
}

/// What `cargo` says of the program in `folder`. It is built in a `target` of its own and not in that of whoever runs
/// this.
fn cargo(folder: &Path, target: &Path, arguments: &[&str]) -> Result<String, String> {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(arguments).current_dir(folder).env("CARGO_TARGET_DIR", target);
    let output = command.output().map_err(|why| format!("cannot build in {}: {why}", folder.display()))?;
    if output.status.success() {
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    } else {
        Err(format!("cannot build in {}: {}", folder.display(), String::from_utf8_lossy(&output.stderr)))
    }
}

/// Builds the program in `folder` in this profile, and says how many seconds of processor time that took: the shell
/// knows it of its children, and does not mind how busy the machine is.
fn processor_time(folder: &Path, profile: &[&str]) -> Result<f64, String> {
    let mut command = Command::new("sh");
    command.args(["-c", "\"${CARGO:-cargo}\" build --quiet \"$@\" && times", "sh"]).args(profile);
    let output = command.current_dir(folder).env("CARGO_TARGET_DIR", folder.join("target")).output();
    let output = output.map_err(|why| format!("cannot build in {}: {why}", folder.display()))?;
    let text = String::from_utf8_lossy(&output.stdout);
    // The last line is that of the children: user and system time, as in 1m2.34s 0m5.67s.
    let times = text.lines().last().filter(|_| output.status.success()).and_then(children_seconds);
    times.ok_or_else(|| format!("cannot build in {}: {}", folder.display(), String::from_utf8_lossy(&output.stderr)))
}

fn children_seconds(line: &str) -> Option<f64> {
    line.split_whitespace()
        .map(|time| {
            let (minutes, seconds) = time.strip_suffix('s')?.split_once('m')?;
            Some(60.0 * minutes.parse::<f64>().ok()? + seconds.parse::<f64>().ok()?)
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_the_shell() {
        assert_eq!(children_seconds("1m2.50s 0m5.25s"), Some(67.75), "user and system time");
        assert_eq!(children_seconds("no times"), None, "something else");
    }
}
