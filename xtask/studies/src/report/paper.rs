//! Algorithm 3 of van den Bergen's paper as it is printed, to measure what the paper says of it. Slow and plain: it
//! counts iterations, and is nobody's ray cast.

use convex_support::SupportMap;
use convex_support::glam::DVec3;
use gjk_raycast::Ray;

/// How a cast ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    Hit(f64),
    Miss,
    /// Not within the iterations allowed.
    Endless,
}

/// The answer of [`ray_cast`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Answer {
    pub(super) end: End,
    /// The last v: where the cast misses, it separates.
    pub(super) v: DVec3,
    pub(super) iterations: usize,
}

/// Algorithm 3 with the relative termination test of Section 4, `‖v‖² ≤ ε·max ‖x − p‖²`; `axis` is a v of before, for
/// which the test is skipped the first time, as the paper has it.
pub(super) fn ray_cast<C>(c: &C, ray: Ray<DVec3>, max_lambda: f64, epsilon: f64, axis: Option<DVec3>) -> Answer
where
    C: SupportMap<Vector = DVec3> + ?Sized,
{
    const LIMIT: usize = 1000;
    let Ray { source: s, direction: r } = ray;
    let (mut lambda, mut x) = (0.0, s);
    let mut v = axis.unwrap_or_else(|| x - c.support(DVec3::X));
    let mut vertices: Vec<DVec3> = Vec::new();
    for iterations in 1..=LIMIT {
        let p = c.support(v);
        let w = x - p;
        if v.dot(w) > 0.0 {
            if v.dot(r) >= 0.0 {
                return Answer { end: End::Miss, v, iterations };
            }
            lambda -= v.dot(w) / v.dot(r);
            if lambda > max_lambda {
                return Answer { end: End::Miss, v, iterations };
            }
            x = s + lambda * r;
        }
        if !vertices.contains(&p) {
            vertices.push(p);
        }
        let farthest = vertices.iter().map(|p| (x - *p).length_squared()).fold(0.0, f64::max);
        (v, vertices) = closest(x, &vertices);
        if v.length_squared() <= epsilon * farthest {
            return Answer { end: End::Hit(lambda), v, iterations };
        }
    }
    Answer { end: End::Endless, v, iterations: LIMIT }
}

/// `v(conv({x} − Y))` and the smallest subset of Y that carries it: of all subsets, the one whose affine hull is
/// closest to x in a convex combination.
fn closest(x: DVec3, vertices: &[DVec3]) -> (DVec3, Vec<DVec3>) {
    let mut best = (DVec3::INFINITY, Vec::new());
    for subset in 1u32..1 << vertices.len() {
        let chosen: Vec<DVec3> = (0..vertices.len()).filter(|i| subset >> i & 1 == 1).map(|i| vertices[i]).collect();
        if chosen.len() <= 4
            && let Some(v) = foot(x, &chosen)
            && v.length_squared() < best.0.length_squared()
        {
            best = (v, chosen);
        }
    }
    best
}

/// x minus its projection upon the affine hull of points, if that is a convex combination of them.
///
/// With edges eᵢ = yᵢ − y₀, the projection y₀ + Σ tᵢ·eᵢ solves Σⱼ (eᵢ·eⱼ)·tⱼ = eᵢ·(x − y₀).
fn foot(x: DVec3, points: &[DVec3]) -> Option<DVec3> {
    let (first, rest) = points.split_first()?;
    let edges: Vec<DVec3> = rest.iter().map(|p| *p - *first).collect();
    let n = edges.len();
    let mut rows: Vec<Vec<f64>> =
        edges.iter().map(|e| edges.iter().map(|f| e.dot(*f)).chain([e.dot(x - *first)]).collect()).collect();
    // Gauss–Jordan; the matrix is positive definite unless the points are dependent.
    for k in 0..n {
        let pivot = rows[k][k];
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        rows[k].iter_mut().for_each(|entry| *entry /= pivot);
        let row = rows[k].clone();
        for (_, other) in rows.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = other[k];
            other.iter_mut().zip(&row).for_each(|(entry, a)| *entry -= factor * a);
        }
    }
    let t: Vec<f64> = rows.iter().map(|row| row[n]).collect();
    let convex = t.iter().all(|t| *t >= 0.0) && t.iter().sum::<f64>() <= 1.0;
    convex.then(|| edges.iter().zip(&t).fold(x - *first, |v, (e, t)| v - *e * *t))
}

#[cfg(test)]
mod tests {
    use super::*;
    use convex_support::{Cuboid, Ellipsoid, InvalidShape};

    #[test]
    fn the_printed_algorithm_casts_rays() -> Result<(), InvalidShape> {
        let cuboid = Cuboid::new(DVec3::new(1.0, 2.0, 3.0))?;
        let cast = |source, direction, max| ray_cast(&cuboid, Ray { source, direction }, max, 1e-20, None).end;
        let End::Hit(lambda) = cast(DVec3::new(5.0, 0.3, 0.4), DVec3::NEG_X, f64::INFINITY) else { panic!("a hit") };
        assert!((lambda - 4.0).abs() < 1e-9, "{lambda}");
        assert_eq!(cast(DVec3::new(5.0, 0.3, 0.4), DVec3::NEG_X, 3.9), End::Miss, "too short");
        assert_eq!(cast(DVec3::new(5.0, 2.3, 0.4), DVec3::NEG_X, 9.0), End::Miss, "beside it");
        let ball = Ellipsoid::new(DVec3::ZERO, DVec3::ONE, Default::default())?;
        let ray = Ray { source: DVec3::new(3.0, 0.0, 0.0), direction: DVec3::new(-1.0, 0.1, 0.0) };
        // The kept vertices close in on a round body's hit point, and max ‖x − p‖² with them: a smaller ε asks for a v
        // below rounding, and no iteration ends there.
        let End::Hit(lambda) = ray_cast(&ball, ray, 9.0, 1e-15, None).end else { panic!("a hit") };
        assert!((ray.at(lambda).length() - 1.0).abs() < 1e-8, "{lambda}");
        Ok(())
    }
}
