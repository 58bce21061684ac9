//! Brackets that hold the truth, whatever became of a shape on its way: nested poses, far origins, floors a thousand
//! times as wide as what stands on them, starts within an ulp of contact.
//!
//! The same numbers in double precision are the truth of single precision: their rounding is a billion times smaller.

use crate::common::behind_pointers::{distance, intersects, linear_cast, ray_cast};
use crate::common::{Random, at, cuboid, s, v};
use convex_support::glam::{DQuat, DVec3, Quat, Vec3A};
use convex_support::{
    Affine, Cone, Cylinder, Hull, Matrix, MinkowskiSum, Point, Polytope, Posed, Rotation, Scalar, Segment, SupportMap,
    Vector, Vector3,
};
use gjk_raycast::{DistanceOptions, IntersectOptions, LinearCastOptions, Motion, Outcome, Ray, RayCastOptions, Status};

const VALID: &str = "finite numbers and positive sizes";

type Shape<V> = Box<dyn SupportMap<Vector = V>>;

/// Numbers of single precision, so that both precisions build the same shapes.
impl Random {
    /// Between −1 and 1, in single precision.
    fn single(&mut self) -> f64 {
        f64::from(self.number(-1.0, 1.0) as f32)
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.single() + 1.0) * 0.5 * n as f64) as usize % n
    }

    fn coordinates(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| f64::from((self.single() * size) as f32))
    }

    fn quaternion(&mut self) -> [f64; 4] {
        [0; 4].map(|_| self.single())
    }
}

/// What a shape is built of, in either precision.
#[derive(Clone, Debug)]
enum Tree {
    Cuboid([f64; 3]),
    Cylinder([f64; 2]),
    Cone([f64; 2]),
    Points(Vec<[f64; 3]>),
    Posed(Box<Self>, [f64; 4], [f64; 3]),
    Affine(Box<Self>, [[f64; 3]; 3], [f64; 3]),
    Sum(Box<Self>, Box<Self>),
    Hull(Box<Self>, Box<Self>),
}

impl Tree {
    fn leaf(random: &mut Random) -> Self {
        let mut size = || f64::from((random.single() * 0.5 + 0.75) as f32);
        let sizes = [size(), size(), size()];
        match random.below(4) {
            0 => Self::Cuboid(sizes),
            1 => Self::Cylinder([sizes[0], sizes[1]]),
            2 => Self::Cone([sizes[0], sizes[1]]),
            _ => Self::Points((0..8).map(|_| random.coordinates(1.0)).collect()),
        }
    }

    /// Of a few levels, with origins up to `reach` away.
    fn random(random: &mut Random, levels: usize, reach: f64) -> Self {
        if levels == 0 {
            return Self::leaf(random);
        }
        let inner = Box::new(Self::random(random, levels - 1, reach));
        match random.below(6) {
            0 => Self::Affine(inner, [0; 3].map(|_| random.coordinates(1.0)), random.coordinates(reach)),
            1 => Self::Sum(inner, Box::new(Self::leaf(random))),
            2 => Self::Hull(inner, Box::new(Self::leaf(random))),
            _ => Self::Posed(inner, random.quaternion(), random.coordinates(reach)),
        }
    }

    fn build<V: Vector3>(&self) -> Shape<V> {
        match self {
            Self::Cuboid(sizes) => Box::new(cuboid::<V>(*sizes)),
            Self::Cylinder([h, r]) => Box::new(Cylinder::<V>::new(s::<V>(*h), s::<V>(*r)).expect(VALID)),
            Self::Cone([h, r]) => Box::new(Cone::<V>::new(s::<V>(*h), s::<V>(*r)).expect(VALID)),
            Self::Points(points) => Box::new(Polytope::new(points.iter().map(|&p| v::<V>(p))).expect(VALID)),
            Self::Posed(inner, q, t) => {
                let turn = V::Rotation::from_xyzw(q.map(V::Scalar::from_f64));
                Box::new(Posed::new(inner.build::<V>(), turn, v(*t)).expect(VALID))
            }
            Self::Affine(inner, columns, t) => {
                let matrix = V::Matrix::from_cols_fn(|j| v(columns[j]));
                Box::new(Affine::new(inner.build::<V>(), matrix, v(*t)).expect(VALID))
            }
            Self::Sum(a, b) => Box::new(MinkowskiSum::new(a.build::<V>(), b.build::<V>())),
            Self::Hull(a, b) => Box::new(Hull::new(a.build::<V>(), b.build::<V>())),
        }
    }

    /// The same, moved back to near zero, but for some offset.
    fn brought_back(self, offset: [f64; 3]) -> Self {
        let origin = self.build::<DVec3>().core().origin;
        let back = [0, 1, 2].map(|i| f64::from((offset[i] - origin.get(i)) as f32));
        Self::Posed(Box::new(self), [0.0, 0.0, 0.0, 1.0], back)
    }
}

fn composed(random: &mut Random, i: usize) -> Tree {
    let reach = [1.0, 30.0, 1e3, 1e4][i % 4];
    let levels = [1, 2, 3, 8, 40][i % 5];
    let tree = Tree::random(random, levels.min(if i.is_multiple_of(3) { 40 } else { 3 }), reach);
    tree.brought_back(random.coordinates(2.0))
}

/// Holds an answer in single precision against the truth, each of lower and upper bound and whether it is a miss: what
/// is proved must be so. A miss is at infinity: where bodies graze within what is known of them, a hit may be said that
/// has no upper bound.
fn holds(answer: ([f64; 2], bool), truth: ([f64; 2], bool), what: impl Fn() -> String) {
    let (([lower, upper], misses), ([least, most], must_miss)) = (answer, truth);
    assert!(must_miss || !misses, "a miss that is a hit: {}", what());
    assert!(lower <= most && least <= upper, "{lower:e} … {upper:e} is not {least:e} … {most:e}: {}", what());
}

/// Class A: of bodies that were posed far away, turned and moved back, the bracket in single precision holds what
/// double precision says.
#[test]
fn composed_poses_keep_the_truth_in_the_bracket() {
    let mut random = Random(1);
    for i in 0..4000 {
        let (a, b) = (composed(&mut random, i), Tree::leaf(&mut random).brought_back(random.coordinates(2.0)));
        let (direction, source, velocity) = (random.coordinates(1.0), random.coordinates(4.0), random.coordinates(1.0));
        let what = || format!("{i}: {a:?} {b:?} {source:?} {direction:?} {velocity:?}");
        let (fine, coarse) = ((a.build::<DVec3>(), b.build::<DVec3>()), (a.build::<Vec3A>(), b.build::<Vec3A>()));
        holds(apart(&coarse.0, &coarse.1), apart(&fine.0, &fine.1), what);
        let (ray, truth) = (cast::<Vec3A>(&coarse.0, source, direction), cast::<DVec3>(&fine.0, source, direction));
        holds(ray, truth, what);
        let ends = [velocity, source];
        holds(sweep(&coarse.0, &coarse.1, ends), sweep(&fine.0, &fine.1, ends), what);
    }
}

fn apart<V: Vector>(a: &Shape<V>, b: &Shape<V>) -> ([f64; 2], bool) {
    let answer = distance(a, b, DistanceOptions::default());
    ([answer.lower, answer.upper].map(Scalar::as_f64), false)
}

fn cast<V: Vector>(target: &Shape<V>, source: [f64; 3], direction: [f64; 3]) -> ([f64; 2], bool) {
    let ray = Ray { source: v(source), direction: v(direction) };
    let answer = ray_cast(target, ray, RayCastOptions::default()).expect("a ray");
    ([answer.lower, answer.upper].map(Scalar::as_f64), answer.outcome.is_miss())
}

fn sweep<V: Vector>(a: &Shape<V>, b: &Shape<V>, [va, vb]: [[f64; 3]; 2]) -> ([f64; 2], bool) {
    let answer = linear_cast(a, b, motion(va, vb), LinearCastOptions::default()).expect("velocities");
    ([answer.lower, answer.upper].map(Scalar::as_f64), answer.outcome.is_miss())
}

fn motion<V: Vector>(a: [f64; 3], b: [f64; 3]) -> Motion<V> {
    Motion { velocity_a: v(a), velocity_b: v(b) }
}

/// Class B: a source outside is outside, however near.
#[test]
fn a_source_outside_is_outside() {
    let ground = at(cuboid::<Vec3A>([1e6, 1.0, 1e6]), [0.0, -1.0, 0.0]);
    let up = Ray { source: Vec3A::Y, direction: Vec3A::Y };
    assert!(
        ray_cast(&ground, up, RayCastOptions::default()).expect("a ray").outcome.is_miss(),
        "a metre above the ground"
    );

    let mut random = Random(2);
    let (mut misses, mut hits) = (0, 0);
    for i in 0..800 {
        let half = random.coordinates(1.0).map(|x| x.abs() + 0.25);
        let body = cuboid::<DVec3>(half);
        // Above the face, by one to eight ulps of the size.
        let above = half[1] + (1 + i % 8) as f64 * f64::EPSILON;
        let source = DVec3::new(half[0] * random.single() * 0.9, above, half[2] * random.single() * 0.9);
        let direction = v::<DVec3>(random.coordinates(1.0));
        let answer = ray_cast(&body, Ray { source, direction }, RayCastOptions::default()).expect("a ray");
        let truth = (above - half[1]) / -direction.y;
        match answer.outcome {
            Outcome::Miss(_) => {
                assert!(direction.y >= 0.0, "{answer:?} {source} {direction}");
                misses += 1;
            }
            Outcome::Hit(hit) => {
                assert!(direction.y < 0.0, "{answer:?} {source} {direction}");
                assert!(answer.lower <= truth && truth <= answer.upper, "{answer:?} {truth:e} {source} {direction}");
                assert!(hit.lambda > 0.0 && hit.normal.is_some(), "{answer:?} {source} {direction}");
                hits += 1;
            }
            Outcome::Undecided => panic!("{answer:?} {source} {direction}"),
        }
    }
    assert!(misses > 300 && hits > 300, "{misses} misses, {hits} hits");
}

/// Class D: whatever the axis and the order, `intersects` decides as `distance` does.
#[test]
fn intersects_agrees_with_distance() {
    let mut random = Random(3);
    let mut met = [0; 2];
    for i in 0..4000 {
        let (a, b) = (Tree::leaf(&mut random), Tree::leaf(&mut random));
        let (turn_a, turn_b) = (random.quaternion(), random.quaternion());
        let posed = |tree: &Tree, q, t| Tree::Posed(Box::new(tree.clone()), q, t).build::<DVec3>();
        let fixed = posed(&a, turn_a, [0.0; 3]);
        // Moved along the normal until the gap is that many errors.
        let away = random.coordinates(1.0).map(|x| 4.0 * x.signum() + x);
        let first = distance(&fixed, &posed(&b, turn_b, away), DistanceOptions::default());
        let normal = first.normal.expect("apart");
        let gap = (i % 13) as f64 * 4.0 * f64::EPSILON - 8.0 * f64::EPSILON;
        let there = v::<DVec3>(away) + normal * (first.distance - gap);
        let moved = posed(&b, turn_b, there.to_array());

        let near = distance(&fixed, &moved, DistanceOptions::default());
        met[usize::from(near.overlap)] += 1;
        for axis in [None, Some(normal), Some(-normal), Some(v(random.coordinates(1.0))), Some(DVec3::Y)] {
            let options = IntersectOptions::default();
            let options = axis.map_or(options, |axis| options.with_axis(axis));
            for found in [intersects(&fixed, &moved, options), intersects(&moved, &fixed, options)] {
                let agrees = found.decided().is_none_or(|overlap| overlap == near.overlap);
                assert!(
                    agrees,
                    "{i}: {found:?} with {axis:?}, but {near:?} of {a:?} {turn_a:?}, {b:?} {turn_b:?} at {there}"
                );
            }
        }
    }
    assert!(met[0] > 500 && met[1] > 500, "{met:?}");
}

/// Class G: in single precision a box near a wide floor is as far from it as it is, with a normal and points.
#[test]
fn a_box_stands_near_a_wide_floor() {
    let mut random = Random(4);
    for half in [0.5, 50.0, 500.0, 5000.0] {
        let floor = at(cuboid::<Vec3A>([half, 1.0, half]), [0.0, -1.0, 0.0]);
        for gap in [1e-5, 1e-4, 1e-3] {
            for _ in 0..30 {
                let height = (0.5 + gap) as f32;
                let place =
                    Vec3A::new((random.single() * half * 0.5) as f32, height, (random.single() * half * 0.5) as f32);
                let turn = Quat::from_xyzw(0.0, random.single() as f32, 0.0, 1.0);
                for parcel in [
                    Posed::translated(cuboid::<Vec3A>([0.5; 3]), place).expect(VALID),
                    Posed::new(cuboid::<Vec3A>([0.5; 3]), turn, place).expect(VALID),
                ] {
                    let answer = distance(&parcel, &floor, DistanceOptions::default());
                    let truth = f64::from(height) - 0.5;
                    let what = format!("{half} {gap} {place}: {answer:?}");
                    assert!((f64::from(answer.distance) - truth).abs() <= 5e-7, "{what}");
                    assert!(f64::from(answer.lower) <= truth && truth <= f64::from(answer.upper), "{what}");
                    assert!(!answer.overlap && answer.lower > 0.0 && answer.normal == Some(Vec3A::Y), "{what}");
                    assert!(!intersects(&parcel, &floor, IntersectOptions::default()).overlap, "{what}");
                    assert!(
                        (answer.point_b.y).abs() <= 1e-6 && (answer.point_a.y - gap as f32).abs() <= 1e-6,
                        "{what}"
                    );
                }
            }
        }
    }
}

/// Class I: where an edge is parallel to a face, the distance converges, at gaps down to nothing.
#[test]
fn an_edge_parallel_to_a_face_is_no_stall() {
    let mut random = Random(5);
    for i in 0..3000 {
        let plate = cuboid::<DVec3>([1.0 + random.single() * 0.5, 0.25, 1.0 + random.single() * 0.5]);
        let gap = [0.0, 1e-16, 1e-15, 1e-13, 1e-10, 1e-7, 1e-4, 1e-2][i % 8];
        let level = 0.25 + gap;
        let rise = [level + random.single().abs() * 0.5 + 0.01, level + random.single().abs() * 0.5 + 0.01];
        let side = |x: f64, y: f64| DVec3::new(x, y, 0.5 + 0.2 * x.abs());
        let points = [
            DVec3::new(random.single() * 0.3 - 0.4, level, random.single() * 0.5),
            DVec3::new(random.single() * 0.3 + 0.4, level, random.single() * 0.5),
            side(random.single() * 0.4, rise[0]),
            side(random.single() * 0.4, rise[1]),
        ];
        let edge = Polytope::new(points[..3 + i % 2].iter().copied()).expect(VALID);
        let q = random.quaternion();
        let place = DVec3::from_array(random.coordinates(3.0));
        let pose = |shape| Posed::new(shape, DQuat::from_array(q), place).expect("a rotation");
        let (a, b) = (pose(Box::new(edge) as Shape<DVec3>), pose(Box::new(plate) as Shape<DVec3>));
        let answer = distance(&a, &b, DistanceOptions::default());
        let what = format!("{i}: {answer:?}, {gap:e} {points:?} {q:?} {place}");
        assert_eq!(answer.status, Status::Converged, "{what}");
        assert!((answer.distance - gap).abs() < 2e-14 && answer.normal.is_some(), "{what}");
        assert!(
            answer.lower <= gap + 1e-15 && gap - 1e-15 <= answer.upper && answer.upper - answer.lower < 2e-13,
            "{what}"
        );
        assert!(intersects(&a, &b, IntersectOptions::default()).decided().is_some(), "{what}");
    }
}

/// Points posed by a turn about a far origin are known to that lever, and casts against small bodies say so.
#[test]
fn a_point_at_the_end_of_a_lever_is_known_to_the_lever() {
    let mut random = Random(6);
    for i in 0..500 {
        let lever = random.coordinates(1.0);
        let (q, size) = (random.quaternion(), [1e-3, 1e-2, 1.0][i % 3]);
        let build = |offset: [f64; 3]| Tree::Posed(Box::new(Tree::Cuboid([size; 3])), random_turn(i), offset);
        let there = posed_point::<DVec3>(lever, q).support(DVec3::X);
        let target = build(there.to_array().map(|x| f64::from((x + 3.0 * size) as f32)));
        let velocity = [-1.0, -1.0, -1.0];
        let ends = [velocity, [0.0; 3]];
        let fine: Shape<DVec3> = Box::new(posed_point::<DVec3>(lever, q));
        let coarse: Shape<Vec3A> = Box::new(posed_point::<Vec3A>(lever, q));
        let truth = sweep(&target.build::<DVec3>(), &fine, ends);
        holds(sweep(&target.build::<Vec3A>(), &coarse, ends), truth, || format!("{i}: {target:?} {lever:?} {q:?}"));
    }
}

fn random_turn(i: usize) -> [f64; 4] {
    Random(i as u64 + 77).quaternion()
}

fn posed_point<V: Vector3>(at: [f64; 3], q: [f64; 4]) -> Posed<Point<V>> {
    let turn = V::Rotation::from_xyzw(q.map(V::Scalar::from_f64));
    Posed::new(Point::new(v(at)).expect(VALID), turn, V::ZERO).expect(VALID)
}

fn turned_by<V: Vector3>(shape: Shape<V>, q: [f64; 4], t: [f64; 3]) -> Shape<V> {
    Box::new(Posed::new(shape, V::Rotation::from_xyzw(q.map(V::Scalar::from_f64)), v(t)).expect(VALID))
}

const NO_TURN: [f64; 4] = [0.0, 0.0, 0.0, 1.0];

/// A plane along the ray is crossed anywhere, within the error of a far origin. The line there, hundreds of sizes
/// behind the body, is known to less than that error, and no miss was to be told from it.
#[test]
fn a_hit_a_hair_inside_a_far_corner_is_no_miss() {
    fn ask<V: Vector3>() -> ([f64; 2], bool) {
        let points = [
            [-0.04013073444366455, 0.8677005767822266, -0.26848340034484863],
            [-0.8194324970245361, -0.9436192512512207, 0.17580270767211914],
            [0.6264070272445679, 0.9108214378356934, -0.057860612869262695],
            [-0.6380823850631714, 0.4811750650405884, 0.613060712814331],
            [0.9852228164672852, -0.49467921257019043, 0.253093957901001],
            [-0.23650074005126953, -0.043012142181396484, -0.6551324129104614],
        ];
        let parts =
            (Tree::Cuboid([0.5981817245483398, 0.8565518856048584, 0.284895122051239]), Tree::Points(points.into()));
        let turn = [0.22249174118041992, -0.1420220136642456, 0.2977330684661865, 0.5971602201461792];
        let hull = Tree::Hull(Box::new(parts.0), Box::new(parts.1)).build::<V>();
        let hull = turned_by(hull, turn, [-3561.740478515625, 783.7467651367188, -9444.640625]);
        let lever = [-0.661270260810852, -0.15586411952972412, 0.9753227233886719, -0.5237548351287842];
        let point = Box::new(Point::new(v::<V>([8315.89453125, -5277.607421875, -2357.589111328125])).expect(VALID));
        let point = turned_by(point, lever, [5.910774230957031, 0.20402312278747559, 0.6793880462646484]);
        sweep(&hull, &point, [[-0.6633007526397705, -0.5558138489723206, -0.5011018514633179], [0.0; 3]])
    }
    let truth = ask::<DVec3>();
    assert!(!truth.1, "{truth:?}");
    holds(ask::<Vec3A>(), truth, || "a far corner".to_owned());
}

/// Pairs that `distance` and `intersects` told apart in one order and not in the other, or beginning at points closest
/// to one another.
#[test]
fn a_pair_is_one_pair_in_either_order() {
    fn agree<V: Vector3>(a: &Shape<V>, b: &Shape<V>) {
        let apart = distance(a, b, DistanceOptions::default()).overlap;
        assert_eq!(apart, distance(b, a, DistanceOptions::default()).overlap);
        for axis in [None, Some(V::axis(0)), Some(-V::axis(1))] {
            let options = IntersectOptions::default();
            let options = axis.map_or(options, |axis| options.with_axis(axis));
            for found in [intersects(a, b, options), intersects(b, a, options)] {
                assert!(found.decided().is_none_or(|overlap| overlap == apart), "{found:?} {axis:?}");
            }
        }
    }
    let ends = [
        [0.5085499286651611, -0.6002038717269897, 0.7861831188201904],
        [0.5026311874389648, 0.8838636875152588, 0.5765872001647949],
    ];
    let turn = [0.9936037063598633, 0.9866538047790527, 0.974090576171875, 0.5561541318893433];
    let segment: Shape<DVec3> = Box::new(Segment::new(ends.map(v::<DVec3>)).expect(VALID));
    let segment = turned_by(segment, turn, [-69.2721756977046, 709.9579734425554, 433.6336641137157]);
    let cylinder = Tree::Cylinder([1.0474164485931396, 0.48484623432159424]).build();
    agree(&segment, &turned_by(cylinder, NO_TURN, [-68.2120361328125, 711.4476928710938, 434.7789306640625]));

    let point = |at: [f64; 3]| Box::new(Point::new(v::<Vec3A>(at)).expect(VALID)) as Shape<Vec3A>;
    let tip = point([0.3329474925994873, -0.5141216516494751, -0.8392845392227173]);
    let tip = turned_by(tip, NO_TURN, [-0.3329474925994873, 4343.5859375, 0.8392845392227173]);
    agree(&tip, &Tree::Cone([4343.07177734375, 4764.1552734375]).build());
    let corner = point([-0.2569887638092041, -0.6136962175369263, 0.44518542289733887]);
    let turn = [-0.017670154571533203, 0.5522764921188354, -0.22632551193237305, -0.3231595754623413];
    let corner = turned_by(corner, turn, [-10036.01171875, 8022.24169921875, -11855.388671875]);
    agree(&corner, &Tree::Cuboid([10035.9873046875, 8021.44189453125, 11855.4189453125]).build());
}

/// Rays from sources within a few errors of a curved boundary: what single precision says holds what double precision
/// does, whichever face the ray goes through in the end; and what leaves is a miss for certain.
#[test]
fn rays_from_the_boundary_keep_the_truth_in_the_bracket() {
    let named = [
        (
            Tree::Cuboid([0.44313591718673706, 0.7198100090026855, 0.41866475343704224]),
            NO_TURN,
            [-0.1977778673171997, 0.17167532444000244, 0.6084573268890381],
            [0.24535882472991943, -0.5481354594230652, 1.0271228551864624],
            [-0.2787884473800659, 0.03195183351635933, -0.3688994348049164],
        ),
        (
            Tree::Cylinder([0.8217793703079224, 0.6916605234146118]),
            [-0.30359017848968506, 0.17462825775146484, 0.609056830406189, -0.4510892629623413],
            [-0.34786081314086914, -0.7422415018081665, 0.005733370780944824],
            [-0.3862897455692291, -0.03922656923532486, -0.8054442405700684],
            [0.0005869029555469751, 0.00015758008521515876, 0.0014983927831053734],
        ),
    ];
    for (i, (tree, turn, place, source, direction)) in named.into_iter().enumerate() {
        let tree = Tree::Posed(Box::new(tree), turn, place);
        let truth = cast::<DVec3>(&tree.build(), source, direction);
        holds(cast::<Vec3A>(&tree.build(), source, direction), truth, || format!("the one numbered {i}"));
    }

    let mut random = Random(7);
    for i in 0..4000 {
        let leaf = Tree::leaf(&mut random);
        // Of a polytope the plane at the source counts, but within an error of an edge.
        if matches!(leaf, Tree::Cuboid(_) | Tree::Points(_)) {
            continue;
        }
        let tree = Tree::Posed(Box::new(leaf), random.quaternion(), random.coordinates(1.0));
        let (fine, coarse) = (tree.build::<DVec3>(), tree.build::<Vec3A>());
        let outside = random.coordinates(4.0).map(|x| x + 3.0 * x.signum());
        let nearest = distance(&Point::new(v::<DVec3>(outside)).expect(VALID), &fine, DistanceOptions::default());
        let n = nearest.normal.expect("apart");
        let off = f64::from(f32::EPSILON) * 8.0 * random.single();
        let source = (nearest.point_b + n * off).to_array().map(|x| f64::from(x as f32));
        let direction = random.coordinates(1.0);
        let cosine = n.dot(v(direction)) / norm(direction);
        // Where it grazes, what is round may be entered anywhere.
        if cosine.abs() < 0.01 {
            continue;
        }
        let what = || format!("{i}: {tree:?} {source:?} {direction:?}");
        holds(cast::<Vec3A>(&coarse, source, direction), cast::<DVec3>(&fine, source, direction), what);
        let ray = Ray { source: v::<Vec3A>(source), direction: v(direction) };
        let answer = ray_cast(&coarse, ray, RayCastOptions::default()).expect("a ray");
        assert!(!answer.outcome.is_miss() || answer.status == Status::Converged, "{answer:?} {}", what());
        assert!(answer.lower <= answer.upper, "{answer:?} {}", what());
    }
}

fn norm(a: [f64; 3]) -> f64 {
    DVec3::from_array(a).length()
}
