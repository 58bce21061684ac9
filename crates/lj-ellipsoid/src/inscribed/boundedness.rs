//! Is an intersection of half-spaces bounded?

use crate::numerics::linalg::dot;

/// Whether the rows, of unit length, which span the space, do so with non-negative combinations: then no direction z has aᵢ·z ≤ 0 for all.
///
/// By Stiemke's lemma this is so exactly if −g, g = Σaᵢ, is a non-negative combination of the rows. The residual of
/// the non-negative least-squares problem (Lawson and Hanson) is otherwise such a direction.
pub(crate) fn positively_spans(n: usize, rows: &[f64]) -> bool {
    let m = rows.len() / n;
    let unit = |i: usize| &rows[i * n..(i + 1) * n];
    let mut target = vec![0.0; n];
    for i in 0..m {
        target.iter_mut().zip(unit(i)).for_each(|(t, x)| *t -= x);
    }
    let tolerance = 1e-12 * m as f64;
    let mut passive: Vec<usize> = Vec::new();
    let mut weights: Vec<f64> = Vec::new();
    // Whether the weights are those of the least squares, all positive.
    let mut is_solved = false;
    for _ in 0..20 * (m + n) {
        let mut residual = target.clone();
        for (&i, w) in passive.iter().zip(&weights) {
            residual.iter_mut().zip(unit(i)).for_each(|(r, x)| *r -= w * x);
        }
        let length = dot(&residual, &residual).sqrt();
        if length <= tolerance {
            return true;
        }
        let best = (0..m)
            .filter(|i| !passive.contains(i))
            .map(|i| (i, dot(unit(i), &residual)))
            .fold((usize::MAX, 1e-13 * length), |best, now| if now.1 > best.1 { now } else { best });
        if is_solved && passive.len() == n {
            // Independent rows that span the space combine to anything: what is left is the rounding of large weights, as of a needle.
            return true;
        }
        if best.0 == usize::MAX || passive.len() == n {
            return false;
        }
        is_solved = false;
        passive.push(best.0);
        weights.push(0.0);
        while let Some(solution) = least_squares(&passive.iter().map(|&i| unit(i)).collect::<Vec<_>>(), &target) {
            // As far as no weight becomes negative; the one that stops the way leaves.
            let limits = weights.iter().zip(&solution).enumerate().filter(|(_, (_, s))| **s <= 0.0);
            let (blocking, alpha) = limits
                .map(|(k, (w, s))| (k, w / (w - s)))
                .fold((usize::MAX, 1.0), |least, now| if now.1 <= least.1 { now } else { least });
            weights.iter_mut().zip(&solution).for_each(|(w, s)| *w += alpha * (s - *w));
            if blocking == usize::MAX {
                is_solved = true;
                break;
            }
            passive.remove(blocking);
            weights.remove(blocking);
        }
    }
    false
}

/// The combination of `vectors` nearest to `target`, by orthogonalisation; `None` if they are dependent.
fn least_squares(vectors: &[&[f64]], target: &[f64]) -> Option<Vec<f64>> {
    let k = vectors.len();
    if k == 0 {
        return None;
    }
    let mut q: Vec<Vec<f64>> = Vec::with_capacity(k);
    let mut r = vec![0.0; k * k];
    for (j, v) in vectors.iter().enumerate() {
        let mut v = v.to_vec();
        for _ in 0..2 {
            for (i, q) in q.iter().enumerate() {
                let along = dot(q, &v);
                r[i * k + j] += along;
                v.iter_mut().zip(q).for_each(|(x, y)| *x -= along * y);
            }
        }
        let length = dot(&v, &v).sqrt();
        if !(length > 1e-14) {
            return None;
        }
        r[j * k + j] = length;
        v.iter_mut().for_each(|x| *x /= length);
        q.push(v);
    }
    let mut x: Vec<f64> = q.iter().map(|q| dot(q, target)).collect();
    for i in (0..k).rev() {
        for j in i + 1..k {
            x[i] -= r[i * k + j] * x[j];
        }
        x[i] /= r[i * k + i];
    }
    Some(x)
}
