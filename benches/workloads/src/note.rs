//! Tables in the notes that a program writes: each stands between two comments that name it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The note of this name, in the folder of the notes.
#[must_use]
pub fn path(name: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs")).join(name)
}

/// Puts `text` into a note, in place of what stands between `<!-- NAME, … -->` and `<!-- end of NAME -->`.
///
/// # Errors
/// Where the note cannot be read or written, or has no such part.
pub fn write(note: &Path, name: &str, text: &str) -> io::Result<()> {
    let page = fs::read_to_string(note)?;
    let old = part(&page, name).ok_or_else(|| {
        io::Error::other(format!("{} has no comments that begin and end the part {name:?}", note.display()))
    })?;
    let end = format!("<!-- end of {name} -->");
    fs::write(note, page.replacen(&format!("{old}{end}"), &format!("\n\n{}\n\n{end}", text.trim()), 1))
}

/// What stands between the comments.
#[must_use]
pub fn part<'p>(page: &'p str, name: &str) -> Option<&'p str> {
    let (_, rest) = page.split_once(&format!("<!-- {name}, "))?;
    let (_, rest) = rest.split_once("-->")?;
    let (part, _) = rest.split_once(&format!("<!-- end of {name} -->"))?;
    Some(part)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_replaced_and_nothing_else() {
        let note = std::env::temp_dir().join(format!("note-{}.md", std::process::id()));
        fs::write(&note, "Before.\n<!-- times, by a program -->\nold\n<!-- end of times -->\nAfter.\n")
            .expect("written");
        write(&note, "times", "| new |\n").expect("there is such a part");
        let page = fs::read_to_string(&note).expect("it was written");
        let refused = write(&note, "ratios", "").is_err();
        fs::remove_file(&note).expect("it was there");
        assert_eq!(page, "Before.\n<!-- times, by a program -->\n\n| new |\n\n<!-- end of times -->\nAfter.\n");
        assert!(refused, "no such part");
    }
}
