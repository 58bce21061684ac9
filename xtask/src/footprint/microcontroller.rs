//! `cargo xtask footprint --microcontroller`: what one question costs a Cortex-M4 with single-precision hardware. Code,
//! stack, memory that is allocated, and instructions, of programs that are built for `thumbv7em-none-eabihf` and run by
//! QEMU.

use std::fs;
use std::io::{self, BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};

use super::{cargo, write_program};

/// How the programs are built, and what they stand on beside the libraries. `paint-stack` fills the memory of the stack
/// before `main`, so that what was used shows afterwards.
const RUNTIME: &str = "lto = true
codegen-units = 1
panic = \"abort\"
opt-level = \"s\"
[dependencies]
cortex-m = \"0.7\"
cortex-m-rt = { version = \"0.7\", features = [\"paint-stack\"] }
cortex-m-semihosting = \"0.5\"
panic-halt = \"1\"
static-alloc = { version = \"0.2\", default-features = false }
";

/// The machine that QEMU plays: 4 MB of each.
const MEMORY: &str = "MEMORY { FLASH : ORIGIN = 0x00000000, LENGTH = 4M
RAM : ORIGIN = 0x20000000, LENGTH = 4M }
";
const RAM: [usize; 2] = [0x2000_0000, 4 << 20];
const PAINT: [u8; 4] = [0xcc; 4];

/// The clock counts 25 million ticks a second, and the machine executes an instruction each nanosecond.
const INSTRUCTIONS_PER_TICK: u64 = 40;
const REPETITIONS: u64 = 32;

const BUILD: &str = "fn main() {
    println!(\"cargo:rustc-link-search={}\", env!(\"CARGO_MANIFEST_DIR\"));
    println!(\"cargo:rustc-link-arg=-Tlink.x\");
}
";

/// Asks the question once, in which the stack grows to its greatest depth, and more often for the clock; says what the
/// clock and the allocator have counted.
const HARNESS: &str = "#![no_std]
#![no_main]
use core::hint::black_box;
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use panic_halt as _;

#[global_allocator]
static HEAP: static_alloc::Bump<[u8; 2 << 20]> = static_alloc::Bump::uninit();

fn ask<T>(question: impl Fn() -> T) {
    let from = HEAP.level();
    let _ = black_box(question());
    let to = HEAP.level();
    let start = SYST::get_current();
    for _ in 0..REPETITIONS {
        let _ = black_box(question());
    }
    let end = SYST::get_current();
    cortex_m_semihosting::heprintln!(\"counted {} {:?} {:?}\", start.wrapping_sub(end) & 0xff_ffff, from, to);
}

#[cortex_m_rt::entry]
fn main() -> ! {
    let mut clock = Peripherals::take().unwrap().SYST;
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(0xff_ffff);
    clock.clear_current();
    clock.enable_counter();
    let input = || black_box(1.0_f32);
    BODY
    loop {
        cortex_m::asm::wfi();
    }
}
";

/// Two boxes, of which the second is turned and moved as far as this along x.
const BOXES: &str = "use gjk_raycast::convex_support::{Cuboid, Cylinder, Posed, glam::{Quat, Vec3}};
    let cylinder = Cylinder::<Vec3>::new(input(), 1.0).unwrap();
    let a = Cuboid::new(Vec3::splat(input())).unwrap();
    let b = Cuboid::new(Vec3::splat(0.5 * input())).unwrap();
    let b = Posed::new(b, Quat::from_rotation_x(input()), Vec3::new(AWAY * input(), 0.5, 0.25)).unwrap();
    use gjk_raycast::*;
    ";

const CASTS: &str = "let ray = Ray { source: Vec3::new(-9.0, 0.25, 0.125) * input(), direction: Vec3::X };
    let motion = Motion { velocity_a: Vec3::X * input(), velocity_b: Vec3::ZERO };
    let turning = RigidMotion::rotation(Vec3::new(0.0, 0.0, input()), Vec3::ZERO);
    ";

const ELLIPSOIDS: &str = "use ellip_margin::convex_support::{Ellipsoid, glam::{Quat, Vec3}};
    use ellip_margin::{MarginOptions, free_margin};
    let at = |x| Ellipsoid::new(Vec3::splat(x), Vec3::new(1.0, 2.0, input()), Quat::from_rotation_x(input())).unwrap();
    let (a, b) = (at(0.0), at(9.0));
    ";

/// A question: its name, how far the boxes are from one another, and the expression that asks it.
const QUESTIONS: &[(&str, &str, &str)] = &[
    ("`intersects`", "3.0", "intersects(&a, &b, Default::default())"),
    ("`distance`, lean", "3.0", "distance(&a, &b, DistanceOptions::lean())"),
    ("`distance`", "3.0", "distance(&a, &b, Default::default())"),
    ("`distance` and its gradient", "3.0", "distance(&a, &b, Default::default()).gradient()"),
    ("`signed_distance`", "1.25", "signed_distance(&a, &b, Default::default())"),
    ("`signed_distance` of a cylinder", "1.25", "signed_distance(&cylinder, &b, Default::default())"),
    ("`contact`", "1.25", "contact(&a, &b, 0.0, Default::default())"),
    ("`contact` of a cylinder", "1.25", "contact(&cylinder, &b, 0.0, Default::default())"),
    ("`ray_cast`, lean", "3.0", "ray_cast(&b, ray, RayCastOptions::lean())"),
    ("`ray_cast`", "3.0", "ray_cast(&b, ray, Default::default())"),
    ("`linear_cast`, lean", "3.0", "linear_cast(&a, &b, motion, LinearCastOptions::lean())"),
    ("`linear_cast`", "3.0", "linear_cast(&a, &b, motion, Default::default())"),
    (
        "`motion_cast`, lean",
        "2.0",
        "motion_cast(&a, turning, &b, RigidMotion::default(), MotionCastOptions::lean().with_max_time(3.0))",
    ),
    (
        "`motion_cast`",
        "2.0",
        "motion_cast(&a, turning, &b, RigidMotion::default(), MotionCastOptions::new().with_max_time(3.0))",
    ),
];

/// What a program costs: bytes of code and constants, of the stack, and of memory that is allocated; instructions.
struct Cost {
    code: usize,
    stack: usize,
    heap: u64,
    instructions: u64,
}

/// Builds and runs the programs, and returns the table.
pub(super) fn measure(folder: &Path) -> Result<String, String> {
    let nothing = run("nothing", "", "ask(input);", folder)?;
    let mut table =
        "| question, in `f32` | code | stack | allocated | instructions |\n|---|---:|---:|---:|---:|\n".to_owned();
    let boxes = QUESTIONS.iter().map(|&(name, away, question)| {
        let body = format!("{}{CASTS}ask(|| {question});", BOXES.replace("AWAY", away));
        (name, "gjk-raycast", body)
    });
    let margin = format!("{ELLIPSOIDS}ask(|| free_margin(&a, &b, MarginOptions::default()));");
    for (name, import, body) in boxes.chain([("`free_margin` of ellipsoids", "ellip-margin", margin)]) {
        let cost = run(name, import, &body, folder)?;
        table += &format!(
            "| {name} | {} kB | {:.1} kB | {} B | {} |\n",
            cost.code.saturating_sub(nothing.code) / 1000,
            cost.stack as f64 / 1000.0,
            cost.heap,
            cost.instructions.saturating_sub(nothing.instructions),
        );
        let _ = writeln!(io::stderr(), "{name}");
    }
    Ok(table)
}

fn run(name: &str, import: &str, body: &str, folder: &Path) -> Result<Cost, String> {
    let failed = |why: &dyn std::fmt::Display| format!("cannot measure {name}: {why}");
    let features = if import == "gjk-raycast" { "\"alloc\", \"f64\"" } else { "\"f64\"" };
    let import = (!import.is_empty()).then_some((import, features));
    let source = HARNESS.replace("BODY", body).replace("REPETITIONS", &REPETITIONS.to_string());
    let here = write_program(folder, name, import, RUNTIME, &source).map_err(|why| failed(&why))?;
    fs::write(here.join("build.rs"), BUILD).map_err(|why| failed(&why))?;
    fs::write(here.join("memory.x"), MEMORY).map_err(|why| failed(&why))?;
    // One for all, so that the runtime is compiled once.
    let target = folder.join("target");
    cargo(&here, &target, &["build", "--quiet", "--release", "--target", "thumbv7em-none-eabihf"])?;
    let binary = target.join("thumbv7em-none-eabihf/release/program");
    let sizes = Command::new("size").arg(&binary).output().map_err(|why| failed(&format!("`size`: {why}")))?;
    let code = code_of(&String::from_utf8_lossy(&sizes.stdout)).ok_or_else(|| failed(&"`size` told no size"))?;

    let mut machine = Command::new("qemu-system-arm")
        .args(["-machine", "mps2-an386", "-display", "none", "-serial", "none", "-monitor", "stdio"])
        .args(["-semihosting-config", "enable=on,target=native", "-icount", "shift=0", "-kernel"])
        .arg(&binary)
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|why| failed(&format!("`qemu-system-arm` (apt-get install qemu-system-arm): {why}")))?;
    let said = machine.stderr.take().map(BufReader::new).into_iter().flat_map(BufRead::lines).map_while(Result::ok);
    let counted = said.into_iter().find_map(|line| counts(&line));
    let memory = here.join("memory");
    if let Some(monitor) = &mut machine.stdin {
        let _ = writeln!(monitor, "pmemsave {} {} \"{}\"\nquit", RAM[0], RAM[1], memory.display());
    }
    machine.wait().map_err(|why| failed(&why))?;
    let [ticks, heap] = counted.ok_or_else(|| failed(&"the program said nothing"))?;
    let memory = fs::read(memory).map_err(|why| failed(&why))?;
    let instructions = ticks * INSTRUCTIONS_PER_TICK / REPETITIONS;
    Ok(Cost { code, stack: stack_in(&memory), heap, instructions })
}

/// The bytes of code and constants, as `size` says them.
fn code_of(sizes: &str) -> Option<usize> {
    sizes.lines().nth(1)?.split_whitespace().take(2).map(|bytes| bytes.parse::<usize>().ok()).sum()
}

/// The ticks of the clock and the bytes that were allocated, as the harness says them.
fn counts(line: &str) -> Option<[u64; 2]> {
    let number = |word: &str| word.trim_matches(|c: char| !c.is_ascii_digit()).parse::<u64>().ok();
    let mut counted = line.strip_prefix("counted ")?.split_whitespace().map(number);
    let [ticks, from, to] = [counted.next()??, counted.next()??, counted.next()??];
    Some([ticks, to - from])
}

/// How much of the memory is behind the longest stretch that is as it was painted: that is what the stack never
/// reached.
fn stack_in(memory: &[u8]) -> usize {
    let (mut run, mut longest) = (0, (0, memory.len() / 4));
    for (at, word) in memory.chunks_exact(4).enumerate() {
        run = if word == PAINT { run + 1 } else { 0 };
        if run > longest.0 {
            longest = (run, memory.len() / 4 - (at + 1));
        }
    }
    4 * longest.1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_is_read() {
        assert_eq!(code_of("   text\t   data\n  173780\t     20\t 65552\n"), Some(173_800));
        assert_eq!(counts("counted 120 Level(8) Level(48)"), Some([120, 40]));
        assert_eq!(counts("qemu-system-arm: terminating"), None);
    }

    /// Frames of the stack may have gaps that nobody writes.
    #[test]
    fn the_stack_is_behind_the_longest_painted_stretch() {
        let words = [(7, 2), (0xcc, 5), (7, 1), (0xcc, 2), (7, 1)];
        let memory: Vec<u8> = words.iter().flat_map(|&(byte, count)| vec![byte; 4 * count]).collect();
        assert_eq!(stack_in(&memory), 16);
        assert_eq!(stack_in(&[7; 16]), 16, "nothing is painted");
    }
}
