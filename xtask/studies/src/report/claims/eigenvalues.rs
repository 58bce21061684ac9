//! Claims of Rimon and Boyd on the eigenvalues that their margin is found by.

use convex_support::glam::DVec2;
use convex_support::{Ellipsoid, InvalidShape};
use ellip_margin::paper::{InverseIterationTracker, free_margin_eigen};
use ellip_margin::{MarginOptions, MarginTracker, free_margin};
use serde_json::Value;
use workloads::rng::Rng;
use xtask::engine;
use xtask::plot::duration;
use xtask::validate::page::error;
use xtask::validate::{Case, progress, score};
use xtask::wire::answer::Line;
use xtask::wire::answer::as_read;

use super::super::growth::time;
use super::Claim;

/// The claims, with the numbers that decide them.
pub(super) fn claims(cases: &[Case]) -> Vec<Claim> {
    let mut claims: Vec<Claim> = eigenvalue(cases).into_iter().collect();
    progress("the random walk");
    claims.extend(walks().unwrap_or_default());
    claims
}

/// The eigenvalue route against true margins, by condition.
fn eigenvalue(cases: &[Case]) -> Option<Claim> {
    let mut worst = [[0.0f64; 2]; 2];
    let mut seen = false;
    for case in cases {
        let text = |name: &str| case.object.get(name).and_then(Value::as_str);
        if text("query") != Some("margin") || text("precision") == Some("f32") {
            continue;
        }
        let tags = case.object.get("tags").and_then(Value::as_array).into_iter().flatten();
        let condition = tags.filter_map(Value::as_str).find_map(|tag| tag.strip_prefix("cond")?.parse::<f64>().ok());
        let Some(condition) = condition else { continue };
        for (k, method) in ["eigen", "secular"].into_iter().enumerate() {
            let mut object = case.object.clone();
            object.insert("method".to_owned(), method.into());
            let outcome = engine::question(&object, &case.meshes).and_then(|question| question.ask());
            let answer = as_read(Line { id: None, line: 0, outcome });
            let verdict = score::judge(&object, &answer);
            let stiff = usize::from(condition > 1e4);
            worst[stiff][k] = worst[stiff][k].max(if verdict.errored { 1.0 } else { verdict.relative.unwrap_or(0.0) });
            seen = true;
        }
    }
    seen.then(|| Claim {
        place: "Section 3, Theorem 1",
        claim: "the margin follows from the minimal eigenvalue of a 2N × 2N matrix, found by the QR algorithm",
        measured: format!(
            "worst relative error at condition to 1e4: {}, beyond {}; from the secular equation {} and {}",
            error(worst[0][0]),
            error(worst[1][0]),
            error(worst[0][1]),
            error(worst[1][1])
        ),
        verdict: if worst[0][0] < 1e-6 && worst[1][0] > 1e-6 {
            "holds, loses its digits on stiff pairs"
        } else if worst[0][0] < 1e-6 {
            "holds"
        } else {
            "differs"
        },
    })
}

/// The random walk of Section 4 on a grid of 128 × 128 cells.
fn walks() -> Result<Vec<Claim>, InvalidShape> {
    let mut claims = Vec::new();
    let mut by_step = Vec::new();
    for step in [1.0, 5.0, 20.0] {
        let mut random = Rng::new(7);
        let (mut steps, mut wrong, mut ours_wrong, mut paper_sum, mut ours_sum) = (0u64, 0u64, 0u64, 0u64, 0u64);
        let mut failed = 0;
        let mut trajectories = Vec::new();
        for _ in 0..20 {
            let unit = |random: &mut Rng| f64::midpoint(random.signed(), 1.0);
            let link = DVec2::new(0.06 + 0.08 * unit(&mut random), 0.02 + 0.03 * unit(&mut random));
            let obstacle = Ellipsoid::new(
                DVec2::splat(0.4) + 0.2 * DVec2::new(unit(&mut random), unit(&mut random)),
                DVec2::new(0.08 + 0.1 * unit(&mut random), 0.04 + 0.05 * unit(&mut random)),
                3.0 * unit(&mut random),
            )?;
            let (mut at, mut angle) = (DVec2::new(0.1, 0.9), 0.0);
            let mut poses = Vec::new();
            for _ in 0..150 {
                poses.push(Ellipsoid::new(at, link, angle)?);
                // Half of the moves go to the opposite corner, a quarter stay, a quarter go back.
                let draw = |u: f64| {
                    if u < 0.5 {
                        1.0
                    } else if u < 0.75 {
                        0.0
                    } else {
                        -1.0
                    }
                };
                let cells = DVec2::new(draw(unit(&mut random)), -draw(unit(&mut random)));
                at = (at + cells * (step / 128.0)).clamp(DVec2::ZERO, DVec2::ONE);
                angle += draw(unit(&mut random)) * f64::to_radians(step);
            }
            let (mut paper, mut ours) =
                (InverseIterationTracker::new(1e-6, 14).expect("a positive tolerance"), MarginTracker::default());
            for pose in &poses {
                let exact = free_margin(pose, &obstacle, MarginOptions::default()).margin;
                let close = |m: f64, tolerance: f64| (m - exact).abs() <= tolerance * (1.0 + exact);
                wrong += u64::from(!close(paper.step(pose, &obstacle).margin, 1e-4));
                ours_wrong += u64::from(!close(ours.step(pose, &obstacle).margin, 1e-12));
                steps += 1;
            }
            failed += paper.fallbacks().saturating_sub(1);
            paper_sum += paper.iterations();
            ours_sum += ours.iterations();
            trajectories.push((poses, obstacle));
        }
        let per = |count: u64| count as f64 / steps as f64;
        by_step.push((step, per(paper_sum), per(failed), wrong, per(ours_sum), ours_wrong));
        if step == 1.0 {
            type Run<'a> = &'a dyn Fn(&[Ellipsoid<DVec2>], &Ellipsoid<DVec2>);
            let all = |run: Run<'_>| {
                time(|| trajectories.iter().for_each(|(poses, obstacle)| run(poses, obstacle))) / steps as f64
            };
            let qr = all(&|poses, obstacle| {
                poses.iter().for_each(|p| _ = std::hint::black_box(&free_margin_eigen(p, obstacle)));
            });
            let inverse = all(&|poses, obstacle| {
                let mut tracker = InverseIterationTracker::new(1e-6, 14).expect("a positive tolerance");
                poses.iter().for_each(|p| _ = std::hint::black_box(&tracker.step(p, obstacle)));
            });
            let newton = all(&|poses, obstacle| {
                let mut tracker = MarginTracker::default();
                poses.iter().for_each(|p| _ = std::hint::black_box(&tracker.step(p, obstacle)));
            });
            claims.push(Claim {
                place: "Sections 3 and 4",
                claim: "a margin takes 2.5 ms by QR and 1 ms by inverse iteration: 2.5 times less",
                measured: format!(
                    "QR {}, inverse iteration {}: {:.1} times less; our tracker {}",
                    duration(qr),
                    duration(inverse),
                    qr / inverse,
                    duration(newton)
                ),
                verdict: if qr > 1.5 * inverse { "holds" } else { "differs" },
            });
        }
    }
    let [(_, iterations, _, _, newton, _), five, twenty] = by_step[..] else { return Ok(claims) };
    claims.push(Claim {
        place: "Section 4",
        claim: "along a random walk by 1° and 1 cell, inverse iteration takes 7 iterations to 1e-6",
        measured: format!("as corrected {iterations:.1}; our tracker, to rounding, {newton:.1} Newton steps"),
        verdict: if iterations < 4.0 {
            "holds, with fewer"
        } else if iterations < 11.0 {
            "holds"
        } else {
            "differs"
        },
    });
    let told = |(step, _, failed, wrong, _, ours): (f64, f64, f64, u64, f64, u64)| {
        format!("at {step}: {:.1} % fall back, {wrong} wrong; our tracker {ours} wrong", 100.0 * failed)
    };
    claims.push(Claim {
        place: "Section 4",
        claim: "it ceases to converge correctly at about 5° and 5 cells",
        measured: format!("{}; {}", told(five), told(twenty)),
        verdict: if twenty.5 == 0 && five.5 == 0 { "overcome: the tracker has no step limit" } else { "fails here" },
    });
    Ok(claims)
}
