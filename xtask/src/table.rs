//! Tables for the terminal, and the quantiles in them.

use std::io::{self, Write};

/// The smallest value that at least the fraction `p` of the values does not exceed.
pub fn quantile(values: &[f64], p: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (p * sorted.len() as f64).ceil() as usize;
    sorted.get(rank.saturating_sub(1)).copied()
}

/// Writes rows under their headers; the first columns are names and the others numbers.
pub(crate) fn aligned(output: &mut impl Write, headers: &[&str], rows: &[Vec<String>], names: usize) -> io::Result<()> {
    let width = |k: usize| rows.iter().map(|row| row[k].chars().count()).chain([headers[k].len()]).max().unwrap_or(0);
    let widths: Vec<usize> = (0..headers.len()).map(width).collect();
    let headers = headers.iter().map(|header| (*header).to_owned()).collect();
    for row in [&headers].into_iter().chain(rows) {
        let cells = row.iter().zip(&widths).enumerate();
        let line = cells.map(|(k, (cell, &w))| if k < names { format!("{cell:w$}") } else { format!("{cell:>w$}") });
        writeln!(output, "{}", line.collect::<Vec<String>>().join("  "))?;
    }
    writeln!(output)
}
