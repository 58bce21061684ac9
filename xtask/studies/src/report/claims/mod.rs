//! What the two papers claim, beside what is measured here.

#[cfg(feature = "paper")]
mod eigenvalues;
mod ellipsoids;
mod ray_casts;

use xtask::validate::page::{Block, Row, Section, Table};
use xtask::validate::{Material, progress};

/// One line of the table.
struct Claim {
    place: &'static str,
    claim: &'static str,
    measured: String,
    verdict: &'static str,
}

impl Claim {
    fn row(self) -> Row {
        Row::of([self.claim.to_owned(), self.place.to_owned(), self.measured, self.verdict.to_owned()])
            .bad_if(self.verdict.starts_with("fails here"))
    }
}

const HEADERS: [&str; 4] = ["claim", "where", "measured", "verdict"];

/// The chapter.
pub(super) fn section(material: &Material<'_>) -> Section {
    let scope = material.scope;
    let mut blocks = Vec::new();
    if scope.holds("ray_cast") {
        progress("claims on ray casts");
        let spheres = ray_casts::spheres();
        blocks.push(Block::Table(Table::new(
            "claims-ray-cast",
            "van den Bergen, Ray Casting against General Convex Objects with Application to Continuous Collision Detection, 2004.",
            &HEADERS,
            ray_casts::claims(&spheres).into_iter().map(Claim::row).collect(),
        ).prose()));
        blocks.push(Block::Figure(ray_casts::convergence(&spheres)));
    }
    if scope.holds("enclosing_ellipsoid") || scope.holds("margin") {
        progress("claims on ellipsoids");
        #[cfg_attr(not(feature = "paper"), allow(unused_mut, reason = "eigenvalues add to them"))]
        let mut claims = ellipsoids::claims();
        #[cfg(feature = "paper")]
        claims.extend(eigenvalues::claims(material.cases));
        blocks.push(Block::Table(Table::new(
            "claims-ellipsoids",
            "Rimon and Boyd, Obstacle Collision Detection Using Best Ellipsoid Fit, Journal of Intelligent and Robotic Systems 18, \
             1997. Their times are those of a DEC 5000.",
            &HEADERS,
            claims.into_iter().map(Claim::row).collect(),
        ).prose()));
    }
    #[cfg(feature = "paper")]
    blocks.extend(super::random_walk::figures(scope).into_iter().map(Block::Figure));
    Section {
        id: "claims",
        title: "The papers' claims, measured again",
        lead: "Each claim is put to the algorithm as it is printed, and to what is used here in its place. Verdicts are computed from the \
               numbers beside them. Misprints and corrections are told in the notes on each method in docs/."
            .to_owned(),
        blocks,
    }
}
