//! An oracle that shares nothing with the crate: brute force over the vertices of a hull, in integers.
//!
//! The convex hull of a finite set is the union of the simplices it spans (Carathéodory). So the ray enters it where it
//! first meets one of the triangles, segments and points, unless it starts in a tetrahedron; and the distance of zero
//! is the least distance of zero from one of them. Coordinates are integers below 2⁹, so that every determinant and
//! every cross product of two fractions is exact in 128 bits. Planar sets have `z = 0`: flatness needs no case of its
//! own.

pub(crate) mod agree;

/// A point with integer coordinates.
pub(crate) type Point = [i128; 3];

/// The fraction `numerator / denominator`, with a positive denominator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fraction {
    pub(crate) numerator: i128,
    pub(crate) denominator: i128,
}

impl Fraction {
    const ZERO: Self = Self { numerator: 0, denominator: 1 };

    fn new(numerator: i128, denominator: i128) -> Self {
        Self { numerator: numerator * denominator.signum(), denominator: denominator.abs() }
    }

    fn min(self, other: Self) -> Self {
        if other.numerator * self.denominator < self.numerator * other.denominator { other } else { self }
    }

    /// The nearest double, but for an ulp.
    #[allow(clippy::cast_precision_loss, reason = "rounding is the purpose")]
    pub(crate) fn as_f64(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn scale(a: Point, s: i128) -> Point {
    a.map(|c| c * s)
}

/// All differences `a − b`.
pub(crate) fn difference(a: &[Point], b: &[Point]) -> Vec<Point> {
    a.iter().flat_map(|&p| b.iter().map(move |&q| sub(p, q))).collect()
}

/// The index tuples `i < j < k` and so on of `count` entries below `n`.
fn tuples<const COUNT: usize>(n: usize) -> impl Iterator<Item = [usize; COUNT]> {
    let mut next: Option<[usize; COUNT]> = (n >= COUNT).then(|| core::array::from_fn(|i| i));
    core::iter::from_fn(move || {
        let current = next?;
        next = (0..COUNT).rev().find(|&i| current[i] < n - COUNT + i).map(|i| {
            let mut following = current;
            for (offset, slot) in following[i..].iter_mut().enumerate() {
                *slot = current[i] + 1 + offset;
            }
            following
        });
        Some(current)
    })
}

/// Whether `x / scale` lies in the triangle `abc` with the non-zero normal `n`, given that it lies in its plane.
fn within(n: Point, [a, b, c]: [Point; 3], x: Point, s: i128) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|&(p, q)| dot(n, cross(sub(q, p), sub(x, scale(p, s)))) >= 0)
}

/// Whether the hull of the points contains `q`.
pub(crate) fn contains(points: &[Point], q: Point) -> bool {
    let p: Vec<Point> = points.iter().map(|&p| sub(p, q)).collect();
    let on_point = p.contains(&[0; 3]);
    let on_segment = || tuples::<2>(p.len()).any(|[i, j]| cross(p[i], p[j]) == [0; 3] && dot(p[i], p[j]) <= 0);
    let on_triangle = || {
        tuples::<3>(p.len()).any(|[i, j, k]| {
            let n = cross(sub(p[j], p[i]), sub(p[k], p[i]));
            n != [0; 3] && dot(n, p[i]) == 0 && within(n, [p[i], p[j], p[k]], [0; 3], 1)
        })
    };
    let in_tetrahedron = || {
        tuples::<4>(p.len()).any(|[i, j, k, l]| {
            let signs = [
                dot(p[j], cross(p[k], p[l])),
                -dot(p[i], cross(p[k], p[l])),
                dot(p[i], cross(p[j], p[l])),
                -dot(p[i], cross(p[j], p[k])),
            ];
            signs.iter().sum::<i128>() != 0 && (signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0))
        })
    };
    on_point || on_segment() || on_triangle() || in_tetrahedron()
}

/// The least λ ≥ 0 at which `source + λ·direction` is in the hull of the points.
pub(crate) fn ray_entry(points: &[Point], source: Point, direction: Point) -> Option<Fraction> {
    if contains(points, source) {
        return Some(Fraction::ZERO);
    }
    let r = direction;
    let p: Vec<Point> = points.iter().map(|&p| sub(p, source)).collect();
    let at_points = p.iter().filter(|&&p| cross(p, r) == [0; 3]).map(|&p| Fraction::new(dot(p, r), dot(r, r)));
    let at_segments = tuples::<2>(p.len()).filter_map(|[i, j]| {
        let (a, d) = (p[i], sub(p[j], p[i]));
        let c = cross(r, d);
        let (mu, whole) = (dot(cross(a, r), c), dot(c, c));
        (whole != 0 && dot(a, c) == 0 && (0..=whole).contains(&mu)).then(|| Fraction::new(dot(cross(a, d), c), whole))
    });
    let at_triangles = tuples::<3>(p.len()).filter_map(|[i, j, k]| {
        let n = cross(sub(p[j], p[i]), sub(p[k], p[i]));
        let lambda = match dot(n, r) {
            0 => return None,
            slope => Fraction::new(dot(n, p[i]), slope),
        };
        let x = scale(r, lambda.numerator);
        within(n, [p[i], p[j], p[k]], x, lambda.denominator).then_some(lambda)
    });
    at_points.chain(at_segments).chain(at_triangles).filter(|l| l.numerator >= 0).reduce(Fraction::min)
}

/// The squared distance of zero from the hull of the points.
pub(crate) fn squared_distance(points: &[Point]) -> Fraction {
    let p = points;
    if contains(p, [0; 3]) {
        return Fraction::ZERO;
    }
    let to_points = p.iter().map(|&p| Fraction::new(dot(p, p), 1));
    let to_segments = tuples::<2>(p.len()).filter_map(|[i, j]| {
        let (a, d) = (p[i], sub(p[j], p[i]));
        let (t, whole) = (-dot(a, d), dot(d, d));
        let c = cross(a, d);
        (0 < t && t < whole).then(|| Fraction::new(dot(c, c), whole))
    });
    let to_triangles = tuples::<3>(p.len()).filter_map(|[i, j, k]| {
        let n = cross(sub(p[j], p[i]), sub(p[k], p[i]));
        let (height, whole) = (dot(n, p[i]), dot(n, n));
        // The foot of the perpendicular is n·height/whole.
        (whole != 0 && within(n, [p[i], p[j], p[k]], scale(n, height), whole))
            .then(|| Fraction::new(height * height, whole))
    });
    to_points.chain(to_segments).chain(to_triangles).fold(Fraction::new(i64::MAX.into(), 1), Fraction::min)
}
