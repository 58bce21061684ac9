//! The least distance of a robot along paths: against poses at many times, every pair by itself, and against its first
//! contact.

use crate::common::Random;
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec3};
use convex_support::{Ball, Capsule, Cuboid, Posed, Rounded, Scalar as _, Segment, SupportMap, Vector};
use gjk_raycast::{
    DistanceOptions, HalfSpace, Joint, JointBounds, JointKind, JointState, JointTrajectory, Link, Linkage,
    LinkageError, Met, MotionCastOptions, MotionClearanceOptions, PathWorkspace, Pose, RayCastError, Scene, Status,
    distance,
};

type Shape<V> = Box<dyn SupportMap<Vector = V> + Sync>;
type Any<'s, V> = &'s dyn SupportMap<Vector = V>;

/// A planar arm of two bars of length 1.
fn arm() -> Linkage<Rounded<Segment<DVec2>>> {
    let bar = Rounded::new(Segment::new([DVec2::ZERO, DVec2::X]).expect("finite"), 0.05).expect("a radius");
    let joint = |parent, translation| {
        let pose = Pose { translation, ..Pose::default() };
        Joint { parent, pose, kind: JointKind::Revolute(1.0) }
    };
    let links = [0, 1].map(|joint| Link { joint: Some(joint), bodies: vec![bar] });
    Linkage::new([joint(None, DVec2::ZERO), joint(Some(0), DVec2::X)], links).expect("a linkage")
}

fn ball_at(x: f64, y: f64) -> Posed<Ball<DVec2>> {
    Posed::translated(Ball::new(0.1).expect("a radius"), DVec2::new(x, y)).expect("finite")
}

#[test]
fn an_arm_passes_a_ball() {
    let (robot, options, mut workspace) = (arm(), MotionClearanceOptions::new(), PathWorkspace::new());
    // Stretched out it reaches 2.05, and the ball begins at 2.4. It points at it in the middle of the second edge.
    let mut scene = Scene::new([ball_at(-7.0, 0.0), ball_at(0.0, 2.5)]).expect("finite");
    let ways = [[0.0, 0.0], [1.0, 0.0], [std::f64::consts::PI - 1.0, 0.0]];
    let answer = robot.path_clearance(&ways, &scene, options, &mut workspace).expect("values for its joints");
    let nearest = answer.nearest.expect("a ball is near");
    let least = nearest.least;
    assert_eq!((nearest.edge, nearest.link, nearest.body, nearest.met), (1, 1, 0, Met::Obstacle(1)), "{answer:?}");
    assert!((least.distance - 0.35).abs() < 1e-14 && (least.time - 0.5).abs() < 1e-7, "{answer:?}");
    assert!(least.lower <= 0.35 && 0.35 <= least.upper && least.upper - least.lower < 1e-8, "{answer:?}");
    assert!(answer.lower == least.lower && least.status == Status::Converged, "{answer:?}");
    assert!((least.point_b - DVec2::Y * 2.4).length() < 1e-7, "{answer:?}");
    // A wall is nearer.
    scene.insert_half_space(HalfSpace::new(DVec2::NEG_X, -2.1).expect("a direction"));
    let nearest = robot.path_clearance(&ways, &scene, options, &mut workspace).expect("values").nearest;
    let nearest = nearest.expect("a wall is near");
    assert_eq!((nearest.edge, nearest.met), (0, Met::Obstacle(2)), "{nearest:?}");
    assert!((nearest.least.distance - 0.05).abs() < 1e-14 && nearest.least.time == 0.0, "{nearest:?}");
    // A pose, and only the first edge.
    let pose = robot.path_clearance(&ways[1..2], &scene, options, &mut workspace).expect("values");
    let first = robot.path_clearance(&ways, &scene, options.with_max_time(0.5), &mut workspace).expect("values");
    assert!(pose.nearest.is_some_and(|nearest| nearest.least.distance > 0.1), "{pose:?}");
    assert_eq!(first.nearest.map(|nearest| nearest.edge), Some(0), "{first:?}");
    // Nothing to come near to.
    let nothing = Scene::<Ball<DVec2>>::default();
    let alone = robot.path_clearance(&ways, &nothing, options, &mut workspace).expect("values");
    assert!(alone.nearest.is_none() && alone.lower == f64::INFINITY, "{alone:?}");
}

#[test]
fn what_is_refused() {
    let (robot, mut workspace) = (arm(), PathWorkspace::new());
    let scene = Scene::new([ball_at(0.0, 2.5)]).expect("finite");
    let options = MotionClearanceOptions::new();
    let mut ask = |ways: &[Vec<f64>], options| robot.path_clearance(ways, &scene, options, &mut workspace);
    assert_eq!(ask(&[], options), Err(LinkageError::EmptyPath));
    assert!(matches!(ask(&[vec![0.0]], options), Err(LinkageError::Count { .. })));
    assert_eq!(ask(&[vec![0.0, f64::NAN]], options), Err(LinkageError::Value { waypoint: 0, value: 1 }));
    let error = LinkageError::Option(RayCastError::NonFinite { parameter: "max_time", index: 0 });
    assert_eq!(ask(&[vec![0.0; 2], vec![1.0; 2]], options.with_max_time(f64::NAN)), Err(error));
}

/// From rest to rest along the same ways as straight edges.
struct Smooth(Vec<[f64; 2]>);

impl JointTrajectory for Smooth {
    type Scalar = f64;

    fn state(&self, joint: usize, t: f64) -> JointState<f64> {
        let [from, to] = self.0[joint];
        let d = to - from;
        let value = from + d * t * t * (3.0 - 2.0 * t);
        let error = 8.0 * f64::EPSILON * (from.abs() + d.abs());
        JointState { value, rate: 6.0 * d * t * (1.0 - t), acceleration: d * (6.0 - 12.0 * t), error }
    }

    fn bounds(&self, joint: usize) -> JointBounds<f64> {
        let [from, to] = self.0[joint];
        let d = (to - from).abs();
        JointBounds { value: from.abs() + d, rate: 1.5 * d, acceleration: 6.0 * d, jerk: 12.0 * d }
    }
}

fn shape<V: Vector>(random: &mut Random, at: V) -> Shape<V> {
    let size = |random: &mut Random| V::Scalar::from_f64(random.number(0.03, 0.3));
    let (a, b) = (size(random), size(random));
    match random.number(0.0, 3.0) as usize {
        0 => Box::new(Posed::translated(Ball::new(a).expect("positive"), at).expect("finite")),
        1 => Box::new(Posed::translated(Capsule::new(a, b).expect("positive"), at).expect("finite")),
        _ => Box::new(Posed::translated(Cuboid::new(V::splat(b)).expect("positive"), at).expect("finite")),
    }
}

struct Case<V: Vector> {
    robot: Linkage<Shape<V>>,
    obstacles: Vec<Shape<V>>,
    ways: Vec<Vec<V::Scalar>>,
}

/// A chain of joints in space, among obstacles in a shell around it.
fn case<V: Vector>(random: &mut Random, kinds: impl Fn(&mut Random) -> (Pose<V>, JointKind<V>)) -> Case<V> {
    let count = random.number(2.0, 5.0) as usize;
    let joints: Vec<_> = (0..count)
        .map(|i| {
            let (pose, kind) = kinds(random);
            Joint { parent: i.checked_sub(1), pose, kind }
        })
        .collect();
    let links: Vec<_> = (0..count)
        .map(|joint| {
            let bodies = (0..random.number(1.0, 3.0) as usize).map(|_| {
                let at = random.vector(0.3);
                shape(random, at)
            });
            Link { joint: Some(joint), bodies: bodies.collect() }
        })
        .collect();
    let robot = Linkage::new(joints, links).expect("a chain");
    let robot = if count > 2 { robot.with_pairs([[0, count - 1]]).expect("two links") } else { robot };
    let far = random.number(0.5, 4.0);
    let obstacles = (0..random.number(1.0, 9.0) as usize).map(|_| {
        let at = random.vector::<V>(1.0);
        let at = at * V::Scalar::from_f64(far + random.number(0.0, 2.0)) / at.norm();
        shape(random, at)
    });
    let obstacles = obstacles.collect();
    let values = robot.values();
    let ways = (0..random.number(2.0, 4.0) as usize)
        .map(|_| (0..values).map(|_| V::Scalar::from_f64(random.number(-1.5, 1.5))).collect());
    Case { ways: ways.collect(), robot, obstacles }
}

impl<V: Vector> Case<V> {
    /// The least distance of anything in a pose, every two bodies by themselves.
    fn distance(&self, values: &[V::Scalar]) -> V::Scalar {
        let placed = |link: usize| {
            (0..self.robot.bodies(link).len()).map(move |k| self.robot.placed(link, k, values).expect("finite"))
        };
        let ask = |a: Any<'_, V>, b: Any<'_, V>| distance(a, b, DistanceOptions::new()).distance;
        let mut least = V::Scalar::from_f64(f64::INFINITY);
        for link in 0..self.robot.links() {
            for a in placed(link) {
                let others: Vec<_> = if link == 0 && self.robot.links() > 2 {
                    placed(self.robot.links() - 1).collect()
                } else {
                    Vec::new()
                };
                let own = others.iter().map(|b| b as Any<'_, V>);
                for b in self.obstacles.iter().map(|b| &**b as Any<'_, V>).chain(own) {
                    let distance = ask(&a, b);
                    least = if distance < least { distance } else { least };
                }
            }
        }
        least
    }
}

fn agrees_with_samples<V: Vector>(
    seed: u64,
    count: usize,
    kinds: impl Fn(&mut Random) -> (Pose<V>, JointKind<V>) + Copy,
) {
    let (mut random, mut workspace, mut met) = (Random(seed), PathWorkspace::new(), 0);
    let number = V::Scalar::as_f64;
    let rounded = 1e4 * V::Scalar::EPSILON.as_f64();
    for index in 0..count {
        let case = case::<V>(&mut random, kinds);
        let scene = Scene::new(case.obstacles.iter().map(|shape| &**shape as Any<'_, V>)).expect("finite");
        let options = MotionClearanceOptions::new();
        let answer = case.robot.path_clearance(&case.ways, &scene, options, &mut workspace).expect("values");
        let nearest = answer.nearest.expect("something is near");
        let least = nearest.least;
        let path = case.robot.path(&case.ways, &scene, MotionCastOptions::new(), &mut workspace).expect("values");
        if let Some((contact, hit)) = path.contact() {
            met += 1;
            assert!(number(least.distance) <= rounded, "{index}: {answer:?} {path:?}");
            if contact.cast.is_certain() && least.upper == V::Scalar::ZERO {
                let [ours, theirs] = [nearest.edge as f64 + number(least.time), contact.edge as f64 + number(hit.time)];
                assert!((ours - theirs).abs() < 100.0 * rounded, "{index}: {answer:?} {path:?}");
            }
            continue;
        }
        assert!(least.lower > V::Scalar::ZERO && least.status == Status::Converged, "{index}: {answer:?}");
        let width = V::Scalar::EPSILON.as_f64().sqrt() * number(least.upper) + rounded;
        assert!(number(least.upper - least.lower) <= width, "{index}: {answer:?}");
        let at = |edge: usize, time: V::Scalar| -> Vec<V::Scalar> {
            let [from, to] = [&case.ways[edge], &case.ways[(edge + 1).min(case.ways.len() - 1)]];
            from.iter().zip(to).map(|(&from, &to)| from + (to - from) * time).collect()
        };
        let there = case.distance(&at(nearest.edge, least.time));
        assert!((number(there) - number(least.distance)).abs() <= rounded, "{index}: {there} {answer:?}");
        let between = number((least.point_a - least.point_b).norm());
        assert!((between - number(least.distance)).abs() <= rounded, "{index}: {answer:?}");
        for edge in 0..case.ways.len() - 1 {
            for k in 0..=50 {
                let time = V::Scalar::from_f64(f64::from(k) / 50.0);
                let sample = number(case.distance(&at(edge, time)));
                assert!(sample >= number(least.lower) - rounded, "{index}: {sample} at {edge} {time}: {answer:?}");
                assert!(sample >= number(least.distance) - width, "{index}: {sample} at {edge} {time}: {answer:?}");
            }
        }
    }
    assert!(met > count / 20 && met < count - count / 5, "{met} of {count} met something");
}

#[test]
fn no_pose_on_the_way_is_nearer_than_the_lower_bound() {
    agrees_with_samples::<DVec3>(1, 60, |random| {
        let rotation = DQuat::from_euler(convex_support::glam::EulerRot::XYZ, random.number(-2.0, 2.0), 0.7, 0.1);
        let pose = Pose { rotation, translation: random.vector(0.7) };
        let axis = random.direction();
        (pose, if random.number(0.0, 1.0) < 0.8 { JointKind::Revolute(axis) } else { JointKind::Prismatic(axis) })
    });
    agrees_with_samples::<DVec2>(2, 60, |random| {
        let pose = Pose { rotation: random.number(-2.0, 2.0), translation: random.vector(0.7) };
        let slides = random.number(0.0, 1.0) < 0.2;
        (pose, if slides { JointKind::Prismatic(DVec2::X) } else { JointKind::Revolute(1.0) })
    });
    agrees_with_samples::<Vec3>(3, 40, |random| {
        let rotation = Quat::from_rotation_x(random.number(-2.0, 2.0) as f32);
        let pose = Pose { rotation, translation: random.vector(0.7) };
        (pose, JointKind::Revolute(random.direction().as_vec3()))
    });
}

/// The same way from rest to rest has the same least distance.
#[test]
fn the_least_distance_does_not_depend_on_the_pace() {
    let (mut random, mut workspace) = (Random(4), PathWorkspace::new());
    for index in 0..30 {
        let case = case::<DVec3>(&mut random, |random| {
            (Pose { translation: random.vector(0.7), ..Pose::default() }, JointKind::Revolute(random.direction()))
        });
        let scene = Scene::new(case.obstacles.iter().map(|shape| &**shape as Any<'_, DVec3>)).expect("finite");
        let smooth =
            case.ways.windows(2).map(|way| Smooth(way[0].iter().zip(&way[1]).map(|(&a, &b)| [a, b]).collect()));
        let smooth: Vec<_> = smooth.collect();
        let options = MotionClearanceOptions::new();
        let answers = [
            case.robot.path_clearance(&case.ways, &scene, options, &mut workspace).expect("values"),
            case.robot.path_clearance_along(&smooth, &scene, options, &mut workspace).expect("values"),
        ];
        let [plain, along] = answers.map(|answer| answer.nearest.expect("something is near").least);
        assert!((plain.distance - along.distance).abs() < 1e-7 * (1.0 + plain.distance), "{index}: {answers:?}");
        assert!(plain.lower <= along.upper + 1e-12 && along.lower <= plain.upper + 1e-12, "{index}: {answers:?}");
    }
}
