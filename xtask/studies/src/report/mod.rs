//! The whole report of `cargo xtask validate`: the chapters that need long measurements, or code compiled for every
//! type.

mod claims;
mod difficulty;
mod enclosing_ladder;
mod growth;
mod headline;
mod left_out;
#[cfg(feature = "paper")]
mod margin_routes;
mod paper;
#[cfg(feature = "paper")]
mod random_walk;
mod swept;
mod tolerance_ladder;
mod work_precision;

use xtask::validate::page::{Block, Section};
use xtask::validate::{Chapter, Material, cases, stiff};

/// Every chapter.
pub(crate) const CHAPTERS: [Chapter; 7] = [
    Chapter { name: "headline", write: |material| headline::section(material.scope) },
    Chapter { name: "ladders", write: ladders },
    Chapter { name: "stiff", write: difficulties },
    Chapter { name: "growth", write: |material| growth::section(material.scope) },
    Chapter { name: "left-out", write: |material| left_out::section(material.scope) },
    Chapter { name: "claims", write: claims::section },
    Chapter { name: "cases", write: |material| cases::section(material.records) },
];

/// Error against run time.
fn ladders(Material { scope, cases, .. }: &Material<'_>) -> Section {
    let mut section = tolerance_ladder::section(scope);
    section.blocks.extend(work_precision::blocks(cases));
    let figures = enclosing_ladder::figures(scope);
    if !figures.is_empty() {
        section.blocks.push(Block::Heading("Enclosing ellipsoids: the certified gap against time".to_owned()));
    }
    section.blocks.extend(figures.into_iter().map(Block::Figure));
    section
}

/// Error against difficulty: figures and the sweep before the table of the cases, then the routes to the margin.
fn difficulties(Material { scope, records, cases, needles }: &Material<'_>) -> Section {
    let mut section = stiff::section(records, needles);
    if scope.quick {
        return section;
    }
    let mut blocks: Vec<Block> = difficulty::figures(cases).into_iter().map(Block::Figure).collect();
    blocks.extend(swept::swept(scope));
    blocks.append(&mut section.blocks);
    #[cfg(feature = "paper")]
    blocks.extend(margin_routes::figures(scope).into_iter().map(Block::Figure));
    #[cfg(not(feature = "paper"))]
    section.lead.push_str(NO_PAPER);
    Section { blocks, ..section }
}

/// What the report says of the routes that are not built in.
#[cfg(not(feature = "paper"))]
const NO_PAPER: &str = " The papers' own routes to the margin, by eigenvalues, are not in this report: cargo xtask validate --paper \
     builds them in.";
