//! What is being done, where somebody watches.

use std::io::{self, IsTerminal as _, Write as _};
use std::sync::Mutex;

struct State {
    chapters: usize,
    /// The chapters begun.
    begun: usize,
    name: &'static str,
}

static STATE: Mutex<State> = Mutex::new(State { chapters: 1, begun: 0, name: "" });

/// Begins the first of so many chapters.
pub(super) fn begin(chapters: usize, name: &'static str) {
    if let Ok(mut state) = STATE.lock() {
        *state = State { chapters, begun: 1, name };
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

/// Shows what is being done in a chapter.
pub fn progress(what: &str) {
    if io::stderr().is_terminal()
        && let Ok(State { chapters, begun, name }) = STATE.lock().as_deref()
    {
        let bar: String = (1..=*chapters)
            .map(|i| {
                if i < *begun {
                    '█'
                } else if i == *begun {
                    '▒'
                } else {
                    '░'
                }
            })
            .collect();
        let _ = write!(io::stderr(), "\r{bar} {name}: {what}\x1b[K");
    }
}

/// Clears the line.
pub(super) fn end() {
    if io::stderr().is_terminal() {
        let _ = write!(io::stderr(), "\r\x1b[K");
    }
}
