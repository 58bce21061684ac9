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

/// The profile of all other tables, and that in which users build.
const PROFILES: [&str; 2] = ["bench", "release"];

/// Nanoseconds by workload, case and method.
type Times = BTreeMap<[String; 3], f64>;

/// The section on how our times depend on the profile.
///
/// # Errors
/// Where `cargo` cannot be run, or `summary` not be built.
pub fn section() -> io::Result<String> {
    let mut times = [Times::new(), Times::new()];
    for _ in 0..ROUNDS {
        for (profile, times) in PROFILES.iter().zip(&mut times) {
            measure(profile, times)?;
        }
    }
    let [tuned, release] = &times;
    Ok(format!(
        "Times in cargo's own `release` profile (no LTO between crates, 16 codegen units) over those in `bench`, from alternating runs: the geometric mean,\n\
         and the cases with the least and the greatest.\n\n{}\n",
        table(release, tuned)
    ))
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

/// Builds and runs `summary` in a profile, without peers, and keeps the least time of each row.
fn measure(profile: &str, times: &mut Times) -> io::Result<()> {
    let output = Command::new("cargo")
        .args(["run", "--quiet", "--profile", profile, "--package", "benches", "--bin", "summary"])
        .args(["--", "--csv", "--milliseconds", "20"])
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")))
        .stderr(Stdio::inherit())
        .output()?;
    if !output.status.success() {
        return Err(io::Error::other(format!("summary failed in the profile {profile}")));
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
