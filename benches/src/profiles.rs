//! What the choice of the build profile does to our times: the same program, built by `cargo` in either.

use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::ratios::Ratios;
use crate::rows::{Method, Workload};

/// The methods that are compared.
const METHODS: [Method; 3] = [Method::OursF64, Method::OursF32, Method::DynF64];

/// How often either program is run, in turn; the least time counts.
const ROUNDS: usize = 3;

/// A way to build `summary`.
struct Build {
    profile: &'static str,
    /// Flags for the compiler.
    flags: &'static str,
    /// The target folder of what they build.
    folder: &'static str,
}

const TUNED: Build = Build { profile: "bench", flags: "", folder: "" };

/// What is compared with [`TUNED`], and what a reader is told of it.
const OTHERS: [(Build, &str); 2] = [
    (
        Build { profile: "release", flags: "", folder: "" },
        "Times in cargo's own `release` profile (no LTO between crates, 16 codegen units) over those in `bench`, from alternating runs: the geometric mean,\n\
         and the cases with the least and the greatest.\n",
    ),
    (
        Build { profile: "bench", flags: "-C no-vectorize-slp", folder: "../target/no-slp" },
        "Times in `bench` with `RUSTFLAGS=\"-C no-vectorize-slp\"` over those without it. LLVM packs neighbouring coordinates into registers where it can; a vector\n\
         of three is then written to memory in one way and read in another, and the processor waits.\n",
    ),
];

/// Nanoseconds by workload, case and method.
type Times = BTreeMap<[String; 3], f64>;

/// The sections on how our times depend on the build.
///
/// # Errors
/// Where `cargo` cannot be run, or `summary` not be built.
pub fn section() -> io::Result<String> {
    let mut tuned = Times::new();
    let mut others = OTHERS.each_ref().map(|_| Times::new());
    for _ in 0..ROUNDS {
        TUNED.measure(&mut tuned)?;
        for ((build, _), times) in OTHERS.iter().zip(&mut others) {
            build.measure(times)?;
        }
    }
    let mut text = String::new();
    for ((_, told), times) in OTHERS.iter().zip(&others) {
        text += &format!("{told}\n{}\n", table(times, &tuned));
    }
    Ok(text)
}

/// Ratios of times, a row for each workload.
fn table(times: &Times, tuned: &Times) -> String {
    let mut text =
        format!("| | {} |\n|---|{}\n", METHODS.map(|method| method.name()).join(" | "), "---|".repeat(METHODS.len()));
    for workload in Workload::ALL {
        let ratios = METHODS.map(|method| -> Ratios<'_> {
            let of_both = times.iter().filter(|([of, _, by], _)| of == workload.name() && by == method.name());
            of_both.filter_map(|(key, time)| Some((key[1].as_str(), time / tuned.get(key)?))).collect()
        });
        text += &format!("| {} | {} |\n", workload.question(), ratios.map(|ratios| ratios.to_string()).join(" | "));
    }
    text
}

impl Build {
    /// Builds and runs `summary` without peers, and keeps the least time of each row.
    fn measure(&self, times: &mut Times) -> io::Result<()> {
        let mut cargo = Command::new("cargo");
        cargo
            .args(["run", "--quiet", "--profile", self.profile, "--package", "benches", "--bin", "summary"])
            .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")))
            .stderr(Stdio::inherit());
        if !self.flags.is_empty() {
            cargo.args(["--target-dir", self.folder]).env("RUSTFLAGS", self.flags);
        }
        let output = cargo.args(["--", "--csv", "--milliseconds", "20"]).output()?;
        if !output.status.success() {
            return Err(io::Error::other(format!("summary failed in the profile {} {}", self.profile, self.flags)));
        }
        for line in String::from_utf8_lossy(&output.stdout).lines().skip(1) {
            let cells: Vec<&str> = line.splitn(5, ',').collect();
            if let [workload, case, method, ns, _] = cells[..]
                && let Ok(ns) = ns.parse::<f64>()
            {
                let least = times.entry([workload, case, method].map(str::to_owned)).or_insert(f64::INFINITY);
                *least = least.min(ns);
            }
        }
        Ok(())
    }
}
