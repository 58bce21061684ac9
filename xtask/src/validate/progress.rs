//! What is being done, where somebody watches.

use std::cmp::Ordering;
use std::io::{self, IsTerminal as _, Write as _};
use std::sync::Mutex;
use std::time::{Duration, Instant};

struct State {
    chapters: usize,
    /// The chapters begun.
    begun: usize,
    name: &'static str,
    /// When something was last said where nobody watches.
    said: Option<Instant>,
}

static STATE: Mutex<State> = Mutex::new(State { chapters: 1, begun: 0, name: "", said: None });

/// How long nothing is said where nobody watches, as in a log.
const SILENCE: Duration = Duration::from_secs(5);

/// Begins the first of so many chapters.
pub fn begin(chapters: usize, name: &'static str) {
    if let Ok(mut state) = STATE.lock() {
        *state = State { chapters, begun: 1, name, said: Some(Instant::now()) };
    }
}

/// Begins the next.
pub(super) fn chapter(name: &'static str) {
    if let Ok(mut state) = STATE.lock() {
        state.begun += 1;
        state.name = name;
    }
    progress("");
}

/// Shows what is being done in a chapter: at once on a terminal, now and then in a log.
pub fn progress(what: &str) {
    let Ok(mut state) = STATE.lock() else { return };
    let State { chapters, begun, name, said } = *state;
    if io::stderr().is_terminal() {
        let cell = |i: usize| match i.cmp(&begun) {
            Ordering::Less => '█',
            Ordering::Equal => '▒',
            Ordering::Greater => '░',
        };
        let bar: String = (1..=chapters).map(cell).collect();
        let _ = write!(io::stderr(), "\r{bar} {name}: {what}\x1b[K");
    } else if said.is_none_or(|said| said.elapsed() > SILENCE) {
        state.said = Some(Instant::now());
        let _ = writeln!(io::stderr(), "{begun} of {chapters}, {name}: {what}");
    }
}

/// Clears the line.
pub fn end() {
    if io::stderr().is_terminal() {
        let _ = write!(io::stderr(), "\r\x1b[K");
    }
}
