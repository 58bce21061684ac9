mod common;
use common::{Rng, apply, corners};
use lj_ellipsoid::*;

fn slab(rng: &mut Rng, t: f64, c: [f64; 3], redundant: bool) -> Vec<Halfspace<3>> {
    let r = rng.rotation::<3>();
    let half = [1.0, 0.7, t];
    let mut out = Vec::new();
    for k in 0..3 {
        for sign in [1.0, -1.0] {
            let normal = r[k].map(|x| sign * x);
            let at: f64 = (0..3).map(|k| normal[k] * c[k]).sum();
            out.push(Halfspace { normal, offset: at + half[k] });
        }
    }
    if redundant {
        for _ in 0..40 {
            let normal: [f64; 3] = rng.sphere::<3>(1)[0];
            out.push(Halfspace { normal, offset: 2.0 });
        }
        out.push(Halfspace { normal: [0.6, 0.0, 0.8], offset: 1e9 });
    }
    out
}

#[test]
fn stats() {
    for redundant in [false, true] {
        for e in 0..26 {
            let t = 10f64.powi(-e);
            let mut rng = Rng(e as u64);
            let (mut bad, mut gap, mut err, mut conv, mut it) = (0, 0.0f64, 0.0f64, 0, 0);
            for _ in 0..40 {
                let h = slab(&mut rng, t, [0.0; 3], redundant);
                match inscribed(&h, InscribedOptions::new()) {
                    Ok(a) => {
                        gap = gap.max(a.log_det_gap);
                        it = it.max(a.iterations);
                        conv += usize::from(a.status == Status::Converged);
                        let s = a.ellipsoid.semi_axes();
                        err = err.max((a.ellipsoid.log_det() + 2.0 * (0.7f64.ln() + t.ln())).abs());
                        assert!(h.iter().all(|h| a.ellipsoid.support_value(h.normal) <= h.offset), "out");
                        let _ = s;
                    }
                    Err(_) => bad += 1,
                }
            }
            println!(
                "slab {redundant} t=1e-{e}: bad {bad} converged {conv} gap {gap:.1e} logdet err {err:.1e} it {it}"
            );
        }
    }
    for e in 0..16 {
        let t = 10f64.powi(-e);
        let mut rng = Rng(e as u64);
        let (mut bad, mut gap, mut err, mut conv) = (0, 0.0f64, 0.0f64, 0);
        for _ in 0..40 {
            let r = rng.rotation::<3>();
            let pts: Vec<[f64; 3]> =
                corners([-1.0, -0.7, -t], [1.0, 0.7, t]).into_iter().map(|p| apply(&r, p)).collect();
            match inscribed_in_hull(&pts, InscribedOptions::new()) {
                Ok(a) => {
                    gap = gap.max(a.log_det_gap);
                    conv += usize::from(a.status == Status::Converged);
                    err = err.max((a.ellipsoid.log_det() + 2.0 * (0.7f64.ln() + t.ln())).abs());
                }
                Err(_) => bad += 1,
            }
        }
        println!("hull t=1e-{e}: bad {bad} converged {conv} gap {gap:.1e} logdet err {err:.1e}");
    }
    for e in 0..16 {
        let t = 10f64.powi(-e);
        let mut rng = Rng(e as u64);
        let (mut bad, mut gap, mut err, mut conv) = (0, 0.0f64, 0.0f64, 0);
        for _ in 0..40 {
            let c = [3.0, -2.0, 1.0];
            let h = slab(&mut rng, t, c, false);
            match inscribed(&h, InscribedOptions::new()) {
                Ok(a) => {
                    gap = gap.max(a.log_det_gap);
                    conv += usize::from(a.status == Status::Converged);
                    err = err.max((a.ellipsoid.log_det() + 2.0 * (0.7f64.ln() + t.ln())).abs());
                    assert!(h.iter().all(|h| a.ellipsoid.support_value(h.normal) <= h.offset), "out");
                }
                Err(_) => bad += 1,
            }
        }
        println!("moved t=1e-{e}: bad {bad} converged {conv} gap {gap:.1e} logdet err {err:.1e}");
    }
}

#[test]
fn aligned() {
    for e in [0, 10, 16, 20, 50, 100, 150, 200, 280, 290] {
        for c in [0.0, 0.5] {
            let t = 10f64.powi(-e);
            let h: Vec<Halfspace<2>> =
                [([1.0, 0.0], 1.0 + c), ([-1.0, 0.0], 1.0 - c), ([0.0, 1.0], t), ([0.0, -1.0], t)]
                    .map(|(normal, offset)| Halfspace { normal, offset })
                    .to_vec();
            match inscribed(&h, InscribedOptions::new()) {
                Ok(a) => println!(
                    "aligned 1e-{e} {c}: {:?} gap {:.1e} {:?} {:?}",
                    a.status,
                    a.log_det_gap,
                    a.ellipsoid.semi_axes(),
                    a.ellipsoid.center()
                ),
                Err(e2) => println!("aligned 1e-{e} {c}: {e2}"),
            }
        }
    }
    for (name, h) in [
        ("flat", vec![([1.0, 0.0], 1.0), ([-1.0, 0.0], -1.0), ([0.0, 1.0], 1.0), ([0.0, -1.0], 1.0)]),
        ("flat0", vec![([1.0, 0.0], 0.0), ([-1.0, 0.0], 0.0), ([0.0, 1.0], 1.0), ([0.0, -1.0], 1.0)]),
        ("flatturned", vec![([0.6, 0.8], 0.0), ([-0.6, -0.8], 0.0), ([-0.8, 0.6], 1.0), ([0.8, -0.6], 1.0)]),
        ("point", vec![([1.0, 0.0], 0.0), ([-1.0, 0.0], 0.0), ([0.0, 1.0], 0.0), ([0.0, -1.0], 0.0)]),
    ] {
        let h: Vec<Halfspace<2>> = h.into_iter().map(|(normal, offset)| Halfspace { normal, offset }).collect();
        let now = std::time::Instant::now();
        println!(
            "aligned {name} {:?} {:?}",
            inscribed(&h, InscribedOptions::new()).map(|a| a.ellipsoid),
            now.elapsed()
        );
    }
}
