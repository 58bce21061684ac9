//! What the public modules have is at the root of the crate too. The documentation shows it in its module alone, so
//! that a tool which reads the documentation would not see that it is gone from there.

use std::collections::BTreeSet;

/// The names that a source file takes out of other modules for everybody.
fn taken(source: &str, of: impl Fn(&str) -> bool) -> BTreeSet<&str> {
    let statements = source.split(';').filter_map(|statement| statement.split_once("pub use ")?.1.split_once("::"));
    let names = statements.filter(|(module, _)| of(module)).map(|(_, names)| names);
    let words = names.flat_map(|names| names.split(|c: char| !c.is_alphanumeric() && c != '_'));
    words.filter(|word| !word.is_empty()).collect()
}

/// The names of the public items that it has itself.
fn own(source: &str) -> impl Iterator<Item = &str> {
    source.lines().filter_map(|line| {
        let [kind, name] = line.strip_prefix("pub ")?.split_once(' ').map(|(kind, name)| [kind, name])?;
        let end = name.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(name.len());
        ["fn", "struct", "enum", "trait", "type"].contains(&kind).then_some(&name[..end])
    })
}

#[test]
fn what_a_public_module_has_is_at_the_root_too() {
    let root = include_str!("../src/lib.rs");
    for (module, source) in [
        ("certificate", include_str!("../src/certificate/mod.rs")),
        ("derivative", include_str!("../src/derivative/mod.rs")),
        ("linkage", include_str!("../src/linkage/mod.rs")),
        ("motion", include_str!("../src/motion/mod.rs")),
        ("scene", include_str!("../src/scene/mod.rs")),
    ] {
        let here: BTreeSet<_> = taken(source, |_| true).into_iter().chain(own(source)).collect();
        let there = taken(root, |of| of == module);
        let missing: Vec<_> = here.difference(&there).collect();
        assert!(here.len() > 5 && missing.is_empty(), "{module}: {missing:?} are not");
    }
}
