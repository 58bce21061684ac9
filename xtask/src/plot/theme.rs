//! Pictures that are files of their own: light where the reader's pages are light, and dark where they are dark.
//!
//! A picture says its colours by attributes, so that any viewer shows it. A style sheet outranks attributes: for a dark
//! page one is added that puts another colour in the place of each.

use std::fmt::Write as _;

/// The colour of the ground of a picture, and of text on it.
pub const GROUND: &str = "#ffffff";
pub const INK: &str = "#1c1c1e";

/// Each colour of the pictures, and what takes its place on a dark page.
const COLOURS: [(&str, &str); 19] = [
    (GROUND, "#16181c"),
    (INK, "#e8e8ea"),
    // Text that is said less loudly, outlines, lines, and areas without a meaning of their own.
    ("#48484c", "#b8b8be"),
    ("#55585f", "#a6abb3"),
    ("#6a6a70", "#a0a0a8"),
    ("#8a8a8a", "#9a9aa0"),
    ("#c7c7cc", "#4a4d55"),
    ("#d4d6db", "#33373e"),
    ("#d9d9de", "#3a3d44"),
    ("#eceef1", "#23262b"),
    // Blue, orange, green, yellow, red, and pink.
    ("#0b5cad", "#6db3f2"),
    ("#0072b2", "#56b4e9"),
    ("#c25400", "#ff9d5c"),
    ("#d55e00", "#ff8c42"),
    ("#009e73", "#2fc79a"),
    ("#e69f00", "#f0b429"),
    ("#b57d00", "#f0b429"),
    ("#b3261e", "#ff7b6e"),
    ("#c2185b", "#ff6fa5"),
];

/// The colours of series on a dark page, as in the report.
const SERIES: [&str; 12] = [
    "#56a8e8", "#f58231", "#2fc79a", "#e58fc4", "#e0b93a", "#8fd0ff", "#b79ad9", "#b0b0b0", "#d2996b", "#ff7a93",
    "#a3a9ff", "#c3d45a",
];

/// A picture with a style sheet for dark pages, which names the colours that are in the picture.
#[must_use]
pub fn by_theme(svg: &str) -> String {
    let mut rules = String::new();
    for (light, dark) in COLOURS {
        for attribute in ["fill", "stroke", "color"] {
            if svg.contains(&format!(" {attribute}=\"{light}\"")) {
                let _ = write!(rules, "[{attribute}=\"{light}\"]{{{attribute}:{dark}}}");
            }
        }
    }
    let used = |(c, _): &(usize, &&str)| svg.contains(&format!("var(--c{c},"));
    let series: Vec<String> =
        SERIES.iter().enumerate().filter(used).map(|(c, colour)| format!("--c{c}:{colour}")).collect();
    if !series.is_empty() {
        let _ = write!(rules, "svg{{{}}}", series.join(";"));
    }
    // Behind the opening tag of the picture.
    let Some(end) = svg.find('>') else { return svg.to_owned() };
    format!("{}\n<style>@media(prefers-color-scheme:dark){{{rules}}}</style>{}", &svg[..=end], &svg[end + 1..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_colour_of_a_picture_has_another_on_a_dark_page() {
        let svg = "<svg a=\"b\">\n<g fill=\"#ffffff\" stroke=\"#0072b2\"/><g style=\"fill:var(--c3,#b8508f)\"/></svg>";
        let themed = by_theme(svg);
        let style = "<style>@media(prefers-color-scheme:dark){[fill=\"#ffffff\"]{fill:#16181c}\
                     [stroke=\"#0072b2\"]{stroke:#56b4e9}svg{--c3:#e58fc4}}</style>";
        assert_eq!(themed, svg.replacen("<svg a=\"b\">", &format!("<svg a=\"b\">\n{style}"), 1));
    }

    /// What is drawn for the notes says no colour that stays the same on a dark page.
    #[test]
    fn the_pictures_of_the_notes_follow_the_theme() {
        let folder = workloads::note::path("figures");
        for picture in std::fs::read_dir(folder).expect("the folder of figures").map(|entry| entry.expect("a file")) {
            let path = picture.path();
            if path.extension().is_none_or(|end| end != "svg") {
                continue;
            }
            let svg = std::fs::read_to_string(&path).expect("it is text");
            assert!(svg.contains("@media(prefers-color-scheme:dark)"), "{} does not", path.display());
            let colour = |part: &str| part.starts_with('#').then(|| part.chars().take_while(|c| *c != '"').collect());
            let said = svg.split("</style>").skip(1).flat_map(|rest| ["fill", "stroke"].map(|of| (rest, of)));
            for (rest, of) in said {
                let attribute = format!(" {of}=\"");
                let colours = rest.split(&attribute).skip(1).filter_map(colour);
                for colour in colours.collect::<std::collections::BTreeSet<String>>() {
                    assert!(svg.contains(&format!("[{of}=\"{colour}\"]")), "{}: {of} {colour}", path.display());
                }
            }
        }
    }
}
