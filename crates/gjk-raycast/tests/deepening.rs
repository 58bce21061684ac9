//! Casts from contact of bodies whose depth is known exactly, or in closed form: whether they get deeper is proved, or
//! undecided.

use crate::common::{Random, at, cuboid, s, v};
use convex_support::glam::{DVec2, DVec3, Vec2, Vec3};
use convex_support::{Ball, Polytope, Posed, Scalar, Segment, SupportMap, Vector};
use gjk_raycast::{CastMethod, HalfSpace, LinearCast, LinearCastOptions, Motion, Outcome, StartInContact, linear_cast};

type Corner = [i64; 2];

fn dot(a: Corner, b: Corner) -> i64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The lines `(g, c, n)` of all planes across edges of the difference: at the time `t` the plane across `n` keeps the
/// polygons apart by `(g + c·t)/|n|`. The signed distance of polygons that touch or overlap is the greatest.
fn lines(a: &[Corner], b: &[Corner], velocity: Corner) -> Vec<(i64, i64, Corner)> {
    let edges = |of: &[Corner]| -> Vec<Corner> {
        of.iter().flat_map(|p| of.iter().map(move |q| [p[1] - q[1], q[0] - p[0]])).filter(|n| *n != [0; 2]).collect()
    };
    let least = |of: &[Corner], n| of.iter().map(|&p| dot(p, n)).min().expect("a corner");
    let line = |n: Corner| (least(a, n) + least(b, [-n[0], -n[1]]), dot(velocity, n), n);
    edges(a).into_iter().chain(edges(b)).map(line).collect()
}

/// By how much polygons get deeper, if they touch or overlap; zero is exact.
fn deepening(lines: &[(i64, i64, Corner)]) -> Option<f64> {
    let squared = |&(g, ..): &(i64, i64, Corner), other: Corner| {
        i128::from(g.signum()) * i128::from(g * g) * i128::from(dot(other, other))
    };
    let nearest = lines.iter().max_by(|x, y| squared(x, y.2).cmp(&squared(y, x.2)))?;
    if nearest.0 > 0 {
        return None;
    }
    let is_nearest = |x: &&(i64, i64, Corner)| squared(x, nearest.2) == squared(nearest, x.2);
    if lines.iter().filter(is_nearest).any(|&(_, c, _)| c >= 0) {
        return Some(0.0);
    }
    // The least of the greatest line is where two of them cross.
    let lines: Vec<_> = lines.iter().map(|&(g, c, n)| [g, c].map(|x| x as f64 / (dot(n, n) as f64).sqrt())).collect();
    let signed_distance = |t: f64| lines.iter().map(|[g, c]| g + c * t).fold(f64::NEG_INFINITY, f64::max);
    let crossings = lines.iter().flat_map(|x| lines.iter().map(move |y| (x[0] - y[0]) / (y[1] - x[1])));
    let least = crossings.filter(|&t| t > 0.0 && t.is_finite()).map(signed_distance).fold(f64::INFINITY, f64::min);
    Some(signed_distance(0.0) - least)
}

/// What counts as no deeper, as the documents say.
fn slack<V: Vector>(bodies: [&dyn SupportMap<Vector = V>; 2]) -> f64 {
    let of = |body: &dyn SupportMap<Vector = V>| {
        let core = body.core();
        let [size, far] = [core.extent + core.radius, core.origin.norm()].map(Scalar::as_f64);
        V::Scalar::EPSILON.as_f64() * (16.0 * size + 4.0 * far) + 4.0 * core.error.as_f64()
    };
    bodies.into_iter().map(of).sum()
}

/// Asserts that no answer about a start in contact is false, whatever the options, and counts those that are open
/// although the bodies get deeper by much more than the slack, or much less.
fn asked<V: Vector>(bodies: [&dyn SupportMap<Vector = V>; 2], velocities: [V; 2], deepening: f64) -> usize {
    let [a, b] = bodies;
    let (slack, [velocity_a, velocity_b]) = (slack(bodies), velocities);
    let options = LinearCastOptions::new().with_start_in_contact(StartInContact::IfDeeper);
    let warm = |axis: V| options.with_axis(axis);
    let all = [
        options,
        options.with_method(CastMethod::Gjk),
        warm(V::axis(0)),
        warm(V::axis(1)),
        warm(-V::axis(0)),
        warm(-V::axis(1)),
    ];
    let asked: Vec<LinearCast<V>> = all
        .into_iter()
        .map(|options| linear_cast(a, b, Motion { velocity_a, velocity_b }, options).expect("finite"))
        .collect();
    for answer in &asked {
        let is_true = match answer.outcome {
            Outcome::Hit(hit) => deepening > 0.0 && answer.is_certain() && hit.time == V::Scalar::ZERO,
            Outcome::Miss(_) => deepening <= slack * 1.01,
            Outcome::Undecided => true,
        };
        assert!(is_true, "{:?} {:?} {velocities:?}: deeper by {deepening}: {answer:?}", a.core(), b.core());
    }
    let is_near_slack = (slack * 0.25..slack * 4.0).contains(&deepening);
    asked.iter().filter(|answer| matches!(answer.outcome, Outcome::Undecided) && !is_near_slack).count()
}

/// Motions along an edge of the difference, or nearly so, and any others. A look beyond the greatest depth was taken
/// for a proof that polygons never get deeper, and one that told nothing for a proof that they do.
#[test]
fn polygons_are_told_to_get_deeper_only_if_they_do() {
    fn run<V: Vector>(seed: u64) {
        let mut random = Random(seed);
        let mut number = |most: i64| random.number(-(most as f64), most as f64).round() as i64;
        let (mut scenes, mut open) = (0, 0);
        while scenes < 1000 {
            let size = [2, 4, 9, 250][number(2).unsigned_abs() as usize + usize::from(number(1) == 0)];
            let corners = |number: &mut dyn FnMut(i64) -> i64| -> Vec<Corner> {
                (0..2 + number(4).abs()).map(|_| [number(size), number(size)]).collect()
            };
            let (a, b) = (corners(&mut number), corners(&mut number));
            let mut velocity = [number(4), number(4)];
            let edges = lines(&a, &b, velocity);
            if number(1) == 0 && !edges.is_empty() {
                let [x, y] = edges[number(100).unsigned_abs() as usize % edges.len()].2;
                let times = 1 + number(60).abs();
                velocity = [times * -y, times * x + number(1)];
            }
            let lines = lines(&a, &b, velocity);
            let is_flat = |n: Corner| {
                let extent = |of: &[Corner]| of.iter().map(|&p| dot(p, n)).max() == of.iter().map(|&p| dot(p, n)).min();
                extent(&a) && extent(&b)
            };
            if lines.iter().any(|&(_, _, n)| is_flat(n)) {
                continue;
            }
            let Some(deepening) = deepening(&lines) else { continue };
            let polygon = |of: &[Corner]| Polytope::new(of.iter().map(|&p| point::<V>(p))).expect("finite");
            let drift = [number(3), number(3)];
            let moving = point::<V>([velocity[0] + drift[0], velocity[1] + drift[1]]);
            open += asked([&polygon(&a), &polygon(&b)], [moving, point(drift)], deepening);
            scenes += 1;
        }
        assert!(open * 100 < scenes, "{open} of six times {scenes} are undecided");
    }
    run::<Vec2>(0x9E37_79B9_7F4A_7C15);
    run::<DVec2>(0x2545_F491_4F6C_DD1D);
}

fn point<V: Vector>([x, y]: Corner) -> V {
    v([x as f64, y as f64, 0.0])
}

/// The depth stays the same until the segment's end is as near to another side. The bracket of that depth was wider
/// than the slack, and what was not known was taken for deeper.
#[test]
fn a_constant_depth_is_no_hit() {
    fn run<V: Vector>() {
        let segment = Segment::new([v::<V>([0.0, 1.0, 0.0]), v([-1.0, 0.0, 0.0])]).expect("finite");
        let square = cuboid::<V>([2.0, 2.0, 0.0]);
        assert_eq!(asked([&segment, &square], [v([0.0, -3.0, 0.0]), V::ZERO], 0.0), 0, "certain misses");
    }
    run::<Vec2>();
    run::<DVec2>();
}

/// The depth of two balls is the sum of their radii less the distance of their centres, which is least where those
/// pass. A closing speed of 16ε counted as sliding, and a depth known to rounding was not looked at again.
#[test]
fn balls_are_told_to_get_deeper_only_if_they_do() {
    fn run<V: Vector>() {
        let mut random = Random(0xDA94_2042_E4DD_58B5);
        let (mut scenes, mut open) = (0, 0);
        while scenes < 1000 {
            let mut place = || random.number(-20.0, 20.0).round();
            let (centre, velocity) = (DVec3::new(place(), place(), 0.0), DVec3::new(place(), place(), 0.0));
            // Of two motions, one is nearly across the way to the other ball.
            let across = DVec3::new(-centre.y * 100.0, centre.x * 100.0 + (place() / 8.0).round(), 0.0);
            let velocity = if scenes % 2 == 0 { velocity } else { across };
            let radii = [place().abs() + 1.0, place().abs() + 1.0];
            if !(1.0..=radii[0] + radii[1]).contains(&centre.length()) || velocity == DVec3::ZERO {
                continue;
            }
            let closing = -centre.dot(velocity);
            let passed = closing * closing / velocity.length_squared();
            let nearest = (centre.length_squared() - passed).max(0.0).sqrt();
            let deepening = if closing > 0.0 { passed / (centre.length() + nearest) } else { 0.0 };
            let [a, b] = radii.map(|radius| Ball::<V>::new(s::<V>(radius)).expect("positive"));
            let a = Posed::translated(a, v(centre.to_array())).expect("finite");
            open += asked([&a, &b], [v(velocity.to_array()), V::ZERO], deepening);
            scenes += 1;
        }
        assert!(open * 100 < scenes, "{open} of six times {scenes} are undecided");
    }
    run::<Vec3>();
    run::<DVec3>();
}

/// A body in a half-space gets deeper just if it sinks. A speed that is no number was taken for one that does not.
#[test]
fn a_speed_beyond_all_numbers_proves_nothing_over_a_half_space() {
    let ground = HalfSpace::new(DVec3::new(1.0, 1.0, 1.0), 0.0).expect("a normal");
    let ball = at(Ball::<DVec3>::new(1.0).expect("positive"), [0.0; 3]);
    let options = LinearCastOptions::new().with_start_in_contact(StartInContact::IfDeeper);
    let motion = Motion { velocity_a: DVec3::new(-1e308, -1e308, 1.7e308), velocity_b: DVec3::splat(1e308) };
    let answer = ground.linear_cast(&ball, motion, options).expect("finite");
    assert_eq!(answer.outcome, Outcome::Undecided, "{answer:?}");
}
