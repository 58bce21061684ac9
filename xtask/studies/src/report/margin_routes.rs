//! The routes to the margin side by side: how many digits each keeps, and how long it takes, as the bodies get thin.
//!
//! The truth is computed in double-double arithmetic, 32 digits, from the bodies as stored, by the polynomial whose
//! terms are positive: it loses a factor of the condition of B at most, 1e14 here, and so keeps 18.

use std::hint::black_box;

use convex_support::Ellipsoid;
use convex_support::glam::{DMat3, DQuat, DVec3};
use ellip_margin::paper::{eigenvalue_gradient, free_margin_eigen};
use ellip_margin::{MarginOptions, Method, free_margin};
use faer::{Mat, Side};
use qd::Quad;

use super::growth::time;
use workloads::rng::Rng;
use xtask::plot::{Plot, Scale, Series};
use xtask::validate::page::Figure;
use xtask::validate::{Scope, progress};

/// Pairs of each condition.
const PAIRS: usize = 60;

type Pair = [Ellipsoid<DVec3>; 2];

/// The figures, where margins are asked for.
pub(super) fn figures(scope: &Scope) -> Vec<Figure> {
    if scope.quick || !scope.holds("margin") {
        return Vec::new();
    }
    let options = MarginOptions::default();
    let singular = options.with_method(Method::SingularBasis);
    let names =
        ["secular equation", "in the singular basis", "2N×2N eigenvalues", "C formed, secular", "Corollary 4.1"];
    let mut errors: [Vec<[f64; 2]>; 6] = Default::default();
    let mut times: [Vec<[f64; 2]>; 4] = Default::default();
    let mut random = Rng::new(5);
    for exponent in (0..=14).step_by(2) {
        progress(&format!("routes to the margin at condition 1e{exponent}"));
        let condition = 10f64.powi(exponent);
        let pairs = pairs(&mut random, condition);
        let mut worst = [0.0f64; 6];
        for [e1, e2] in &pairs {
            let truth = Truth::of(e1, e2);
            let ours = free_margin(e1, e2, options);
            let paper = by_corollary(e1, e2);
            let each = [
                relative(ours.nu, truth.nu),
                relative(free_margin(e1, e2, singular).nu, truth.nu),
                relative(free_margin_eigen(e1, e2).nu, truth.nu),
                relative(-paper.lambda, truth.nu),
                (paper.gradient + truth.gradient).length() / truth.gradient.length(),
                relative(1.0 + ours.margin, truth.squared),
            ];
            for (worst, error) in worst.iter_mut().zip(each) {
                // An eigenvalue that is not a number is as wrong as can be.
                *worst = worst.max(if error.is_nan() { 1.0 } else { error.min(1.0) });
            }
        }
        for (series, worst) in errors.iter_mut().zip(worst) {
            series.push([condition, worst]);
        }
        let mut clock = |route: usize, of: &dyn Fn(&Pair)| {
            let each = time(|| pairs.iter().for_each(of)) / pairs.len() as f64;
            times[route].push([condition, each]);
        };
        clock(0, &|[e1, e2]| _ = black_box(&free_margin(black_box(e1), black_box(e2), options)));
        clock(1, &|[e1, e2]| _ = black_box(&free_margin(black_box(e1), black_box(e2), singular)));
        clock(2, &|[e1, e2]| _ = black_box(&free_margin_eigen(black_box(e1), black_box(e2))));
        clock(3, &|[e1, e2]| _ = black_box(by_corollary(black_box(e1), black_box(e2)).lambda));
    }

    let [first, basis, eigenvalues, formed, corollary, value] = errors;
    let accuracy = [
        (format!("{}: λ*", names[0]), first),
        (format!("{}: 1 + m", names[0]), value),
        (format!("{}: λ*", names[1]), basis),
        (format!("{}: λ*", names[2]), eigenvalues),
        (format!("{}: λ*", names[3]), formed),
        (format!("{}: ∂λ*/∂x₁", names[4]), corollary),
    ];
    let [first, basis, eigenvalues, formed] = times;
    let clocked = [
        (names[0].to_owned(), first),
        (names[1].to_owned(), basis),
        (names[2].to_owned(), eigenvalues),
        (format!("{}, and its gradient", names[4]), formed),
    ];
    vec![
        figure(
            "margin-routes-error",
            "margin: worst relative error against the condition of both bodies",
            "worst relative error",
            1e-17,
            accuracy.into(),
            "Sixty random pairs in space of each condition, against 32 digits. The eigenvalues of the paper's 2N×2N matrix are found \
             by faer; Corollary 4.1 needs C = Q^-½PQ^-½ formed and diagonalised. The secular equation, set up from the axes, forms \
             neither.",
        ),
        figure(
            "margin-routes-time",
            "margin: time against the condition of both bodies",
            "nanoseconds",
            1.0,
            clocked.into(),
            "The same pairs, cold, one thread.",
        ),
    ]
}

fn figure(name: &str, title: &str, y: &str, floor: f64, series: Vec<(String, Vec<[f64; 2]>)>, caption: &str) -> Figure {
    let series = series.into_iter().enumerate();
    Figure {
        name: name.to_owned(),
        plot: Plot {
            title: title.to_owned(),
            x: "condition".to_owned(),
            y: y.to_owned(),
            scales: [Scale::Log, Scale::Log],
            floor,
            series: series.map(|(colour, (name, points))| Series { name, points, joined: true, colour }).collect(),
        },
        caption: caption.to_owned(),
    }
}

/// Pairs whose matrices have the given condition, their centres 3 apart.
fn pairs(random: &mut Rng, condition: f64) -> Vec<Pair> {
    let shortest = condition.sqrt().recip();
    let mut ellipsoid = |center: DVec3| {
        let middle = shortest.powf(0.5 + 0.5 * random.signed());
        let turn = DQuat::from_scaled_axis(DVec3::from(random.sphere()) * 3.0 * random.signed());
        Ellipsoid::from_axes(center, DVec3::new(1.0, middle, shortest), DMat3::from_quat(turn)).ok()
    };
    let mut pairs = Vec::new();
    while pairs.len() < PAIRS {
        // Both bodies first, then the way between them: the draws stay independent.
        let (first, second) = (ellipsoid(DVec3::ZERO), ellipsoid(DVec3::new(1.0, 2.0, 2.0)));
        pairs.extend(first.zip(second).map(|(e1, e2)| [e1, e2]));
    }
    pairs
}

fn relative(found: f64, truth: Quad) -> f64 {
    ((Quad::from(found) - truth) / truth).abs().0
}

/// ν = −λ*, 1 + m, and ∂ν/∂x₁.
struct Truth {
    nu: Quad,
    squared: Quad,
    gradient: DVec3,
}

type Vec3 = [Quad; 3];

const ZERO: Quad = Quad(0.0, 0.0);

fn dot(a: Vec3, b: Vec3) -> Quad {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `m·x`, for the rows of `m`.
fn apply(m: &[Vec3; 3], x: Vec3) -> Vec3 {
    m.map(|row| dot(row, x))
}

fn transpose(m: &[Vec3; 3]) -> [Vec3; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

impl Truth {
    /// With B = diag(a₁)⁻¹R₁ᵀR₂·diag(a₂), g = diag(a₁)⁻¹R₁ᵀ(x₁ − x₂): adj(C + ν) = A·Aᵀ + ν(tr C − C) + ν², A = adj B,
    /// and y = adj(C + ν)Bᵀg/det(C + ν) is a unit vector.
    fn of(e1: &Ellipsoid<DVec3>, e2: &Ellipsoid<DVec3>) -> Self {
        let exact = |v: DVec3| -> Vec3 { v.to_array().map(Quad::from) };
        let columns = |e: &Ellipsoid<DVec3>| e.axes().to_cols_array_2d().map(|c| c.map(Quad::from));
        let (axes1, axes2) = (columns(e1), columns(e2));
        let (a1, a2) = (exact(e1.semi_axes()), exact(e2.semi_axes()));
        let (x1, x2) = (exact(e1.center()), exact(e2.center()));
        let r: Vec3 = std::array::from_fn(|i| x1[i] - x2[i]);
        let g: Vec3 = std::array::from_fn(|i| dot(axes1[i], r) / a1[i]);
        let b: [Vec3; 3] = std::array::from_fn(|i| std::array::from_fn(|j| dot(axes1[i], axes2[j]) * a2[j] / a1[i]));

        let adjugate: [Vec3; 3] = std::array::from_fn(|j| {
            std::array::from_fn(|i| {
                let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
                b[i1][j1] * b[i2][j2] - b[i1][j2] * b[i2][j1]
            })
        });
        let det = dot(b[0], std::array::from_fn(|j| adjugate[j][0]));
        let squares = |m: &[Vec3; 3]| m.iter().fold(ZERO, |sum, row| sum + dot(*row, *row));
        let (trace, minors) = (squares(&b), squares(&adjugate));
        let bt = transpose(&b);
        // adj(C + ν)x for x = Bᵀu: det B·(adj B)u + ν(tr C·x − Cx) + ν²x
        let solve = |nu: Quad, u: Vec3| -> Vec3 {
            let x = apply(&bt, u);
            let cx = apply(&bt, apply(&b, x));
            let low = apply(&adjugate, u).map(|v| det * v);
            let d = det * det + nu * (minors + nu * (trace + nu));
            std::array::from_fn(|j| (low[j] + nu * (trace * x[j] - cx[j] + nu * x[j])) / d)
        };
        // C + ν on a vector y of the ball, inverted: y = BᵀB⁻ᵀy, B⁻ᵀ = (adj B)ᵀ/det B.
        let inverse = |nu: Quad, y: Vec3| solve(nu, apply(&transpose(&adjugate), y).map(|v| v / det));

        // Newton's method for 1/‖y‖ = 1, from the answer to be judged: three steps square 1e-3 away, and more do no
        // harm.
        let mut nu = Quad::from(free_margin(e1, e2, MarginOptions::default()).nu);
        for _ in 0..6 {
            let y = solve(nu, g);
            let phi = dot(y, y).sqrt();
            nu = nu + (phi - Quad::from(1.0)) * phi * phi / dot(y, inverse(nu, y));
        }
        let y = solve(nu, g);
        let w: Vec3 = std::array::from_fn(|i| dot(b[i], y) - g[i]);
        // yᵀdy = 0 with (C + ν)dy + y·dν = Bᵀdg: dν = (BTᵀ)·dg, T = (C + ν)⁻¹y/yᵀ(C + ν)⁻¹y.
        let t = inverse(nu, y);
        let along = apply(&b, t).map(|v| v / dot(y, t));
        let gradient = std::array::from_fn(|k| (0..3).fold(ZERO, |sum, i| sum + axes1[i][k] * along[i] / a1[i]).0);
        Self { nu, squared: dot(w, w), gradient: DVec3::from_array(gradient) }
    }
}

/// λ* and its gradient in the centre of the first body, as Corollary 4.1 has them.
struct Corollary {
    lambda: f64,
    gradient: DVec3,
}

/// C and b formed, C diagonalised, Σ b̄ᵢ²/(λᵢ − λ)² = 1 solved from below, and the corollary.
fn by_corollary(e1: &Ellipsoid<DVec3>, e2: &Ellipsoid<DVec3>) -> Corollary {
    let p = e1.matrix();
    let root = e2.axes() * DMat3::from_diagonal(e2.semi_axes()) * e2.axes().transpose(); // Q^-½
    let c = root * p * root;
    let b = root * (p * (e1.center() - e2.center()));
    let matrix = Mat::from_fn(3, 3, |i, j| 0.5 * (c.col(j)[i] + c.col(i)[j]));
    let Ok(eigen) = matrix.self_adjoint_eigen(Side::Lower) else {
        return Corollary { lambda: f64::NAN, gradient: DVec3::NAN };
    };
    let eigenvalues = DVec3::from_array(std::array::from_fn(|i| eigen.S()[i]));
    let basis = DMat3::from_cols_array_2d(&std::array::from_fn(|j| std::array::from_fn(|i| eigen.U()[(i, j)])));
    let b = basis.transpose() * b;
    // The root is the least: Newton's method for 1/φ from a lower bound on ν = −λ.
    let mut nu = (b.length() - eigenvalues.max_element()).max(0.0);
    for _ in 0..64 {
        let shifted = eigenvalues + nu;
        let (squared, cubic) = ((b / shifted).length_squared(), (b * b / (shifted * shifted * shifted)).element_sum());
        let next = (nu + (squared.sqrt() - 1.0) * squared / cubic).max(0.0);
        let change = (next - nu).abs();
        nu = next;
        if change <= 1e-15 * nu {
            break;
        }
    }
    let gradient = eigenvalue_gradient(b, eigenvalues, -nu);
    Corollary { lambda: -nu, gradient: p * (root * (basis * gradient.b)) }
}
