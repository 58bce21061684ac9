//! Where, when and with what a measurement was made.

use std::fs;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};

/// The name of the processor, or of its architecture where it has none.
#[must_use]
pub fn processor() -> String {
    let named = fs::read_to_string("/proc/cpuinfo").ok().and_then(|text| {
        let line = text.lines().find(|line| line.starts_with("model name"))?;
        Some(line.split_once(':')?.1.trim().to_owned())
    });
    named.unwrap_or_else(|| std::env::consts::ARCH.to_owned())
}

/// The version of the compiler, as it says it.
#[must_use]
pub fn compiler() -> Option<String> {
    said("rustc", &["--version"])
}

/// The commit, and whether anything differs from it.
#[must_use]
pub fn commit() -> Option<String> {
    said("git", &["describe", "--always", "--dirty"])
}

fn said(program: &str, arguments: &[&str]) -> Option<String> {
    let output = Command::new(program).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
    let text = String::from_utf8_lossy(&output.stdout).trim().to_owned();
    (output.status.success() && !text.is_empty()).then_some(text)
}

/// The date in UTC, as year-month-day.
#[must_use]
pub fn today() -> String {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    let [year, month, day] = civil(seconds / 86_400);
    format!("{year}-{month:02}-{day:02}")
}

/// Processor, threads, compiler, date and commit, as far as they can be told.
#[must_use]
pub fn provenance() -> String {
    let parts = [
        Some(processor()),
        std::thread::available_parallelism().ok().map(|n| format!("{n} threads")),
        compiler(),
        Some(today()),
        commit().map(|commit| format!("commit {commit}")),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Year, month and day, so many days after 1970-01-01.
///
/// Years are counted from March 1st of year 0, so that a leap day ends one: days since then fall into eras of 400 years
/// of 146097 days, and months of 30 or 31 days into groups of five of 153 (Hinnant, `civil_from_days`).
fn civil(days: u64) -> [u64; 3] {
    let days = days + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let (year, month) = if month < 10 { (year_of_era, month + 3) } else { (year_of_era + 1, month - 9) };
    [year + era * 400, month, day]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates() {
        assert_eq!(civil(0), [1970, 1, 1], "the first day");
        assert_eq!(civil(11_016), [2000, 2, 29], "a leap day of a century");
        assert_eq!(civil(20_454), [2026, 1, 1], "a new year");
    }
}
