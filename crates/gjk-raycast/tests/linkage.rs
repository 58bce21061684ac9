//! Robots along paths, and anywhere in a box of joint values: against closed forms, poses by quaternions at many times,
//! and what is refused.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3Swizzles as _};
use convex_support::{
    Ball, Capsule, Cuboid, InvalidShape, Point, Polytope, Posed, Rounded, Segment, SupportMap, Vector, support_value,
};
use gjk_raycast::{
    Body, BodyPair, FreeBox, Group, HalfSpace, Joint, JointBounds, JointBoxOutcome, JointKind, JointState,
    JointTrajectory, Link, Linkage, LinkageError, Met, MotionCastOptions, Path, PathContact, PathWorkspace, Pose,
    RayCastError, Scene, SignedDistanceOptions, Status, signed_distance,
};

type Bar = Rounded<Segment<DVec2>>;
type Shape = Box<dyn SupportMap<Vector = DVec3>>;

fn bar() -> Bar {
    Rounded::new(Segment::new([DVec2::ZERO, DVec2::X]).expect("finite"), 0.05).expect("a radius")
}

/// A joint at a place, that turns counter-clockwise.
fn turning(parent: Option<usize>, at: DVec2) -> Joint<DVec2> {
    Joint { parent, pose: Pose { translation: at, ..Pose::default() }, kind: JointKind::Revolute(1.0) }
}

/// A joint at the place of its parent.
fn at_parent<V: Vector>(parent: Option<usize>, kind: JointKind<V>) -> Joint<V> {
    Joint { parent, pose: Pose::default(), kind }
}

/// An arm of two bars of length 1.
fn arm() -> Linkage<Bar> {
    let joints = [turning(None, DVec2::ZERO), turning(Some(0), DVec2::X)];
    let links = [0, 1].map(|joint| Link { joint: Some(joint), bodies: vec![bar()] });
    Linkage::new(joints, links).expect("a linkage")
}

fn ball_at(x: f64, y: f64) -> Posed<Ball<DVec2>> {
    Posed::translated(Ball::new(0.1).expect("a radius"), DVec2::new(x, y)).expect("finite")
}

fn ask(robot: &Linkage<Bar>, ways: &[Vec<f64>], scene: &Scene<Posed<Ball<DVec2>>>) -> Path<DVec2> {
    robot.path(ways, scene, MotionCastOptions::new(), &mut PathWorkspace::new()).expect("values for its joints")
}

/// A polynomial for each joint: a + b·t + c·t² + d·t³.
#[derive(Clone, Debug)]
struct Cubic(Vec<[f64; 4]>);

impl Cubic {
    fn straight(from: &[f64], to: &[f64]) -> Self {
        Self(from.iter().zip(to).map(|(a, b)| [*a, b - a, 0.0, 0.0]).collect())
    }
}

impl JointTrajectory for Cubic {
    type Scalar = f64;

    fn state(&self, joint: usize, t: f64) -> JointState<f64> {
        let [a, b, c, d] = self.0[joint];
        let value = a + (b + (c + d * t) * t) * t;
        let error = 8.0 * f64::EPSILON * self.bounds(joint).value;
        JointState { value, rate: b + (2.0 * c + 3.0 * d * t) * t, acceleration: 2.0 * c + 6.0 * d * t, error }
    }

    fn bounds(&self, joint: usize) -> JointBounds<f64> {
        let [a, b, c, d] = self.0[joint].map(f64::abs);
        let (value, rate) = (a + b + c + d, b + 2.0 * c + 3.0 * d);
        JointBounds { value, rate, acceleration: 2.0 * c + 6.0 * d, jerk: 6.0 * d }
    }
}

/// A straight edge that is given as a trajectory has the same answers. One that speeds up and slows down has the
/// contact at the time at which its joint has the same value, and one that swings out and back meets a body or does
/// not, by a billionth of its angle.
#[test]
fn first_contacts_along_trajectories_are_those_of_their_closed_form() -> Result<(), LinkageError> {
    let (robot, options, mut workspace) = (arm(), MotionCastOptions::new(), PathWorkspace::new());
    for k in 0..12 {
        let (angle, far) = (0.6 + 0.1 * f64::from(k), 0.4 + 0.12 * f64::from(k));
        let scene = Scene::new([ball_at(far * angle.cos(), far * angle.sin())]).expect("finite");
        let touch = angle - (0.15 / far).asin();
        let ways = [[-0.4, 0.0], [0.0, 0.0], [2.0, 0.0]];
        let straight = [0, 1].map(|i| Cubic::straight(&ways[i], &ways[i + 1]));
        let along = robot.path_along(&straight, &scene, options, &mut workspace)?;
        let path = robot.path(&ways, &scene, options, &mut workspace)?;
        let [(a, hit_a), (b, hit_b)] = [along, path].map(|path| path.contact().expect("it turns by 2"));
        assert_eq!(
            [(a.edge, a.link, a.met), (1, b.link, Met::Obstacle(0))],
            [(1, b.link, b.met), (a.edge, a.link, a.met)]
        );
        assert!((hit_a.time - hit_b.time).abs() < 1e-13 && a.cast.upper - a.cast.lower < 1e-12, "{a:?} {b:?}");

        // The same from rest to rest.
        let smooth = [Cubic::straight(&ways[0], &ways[1]), Cubic(vec![[0.0, 0.0, 6.0, -4.0], [0.0; 4]])];
        let path = robot.path_along(&smooth, &scene, options, &mut workspace)?;
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            *(if smooth[1].state(0, middle).value < touch { &mut low } else { &mut high }) = middle;
        }
        let (contact, hit) = path.contact().expect("it turns by 2");
        assert!(contact.edge == 1 && contact.cast.lower <= high && low <= contact.cast.upper, "{low} {contact:?}");
        assert!(contact.cast.upper - contact.cast.lower < 1e-11 && (hit.time - low).abs() < 1e-12, "{contact:?}");

        // Out to an angle at the time 1/2, and back.
        let swing = |most: f64| [Cubic(vec![[0.0, 4.0 * most, -4.0 * most, 0.0], [0.0; 4]])];
        assert!(robot.path_along(&swing(touch - 1e-9), &scene, options, &mut workspace)?.is_free(), "{far}");
        let path = robot.path_along(&swing(touch + 1e-9), &scene, options, &mut workspace)?;
        let truth = 0.5 - 0.5 * (1e-9 / (touch + 1e-9)).sqrt();
        let holds = |cast: gjk_raycast::MotionCast<_>| cast.lower <= truth + 1e-9 && truth - 1e-9 <= cast.upper;
        assert!(path.contact().is_some_and(|(contact, hit)| holds(contact.cast) && (hit.time - truth).abs() < 1e-9));
    }
    Ok(())
}

/// What is no trajectory is refused by its index. If a value is not finite while a body is near, the answer is open.
#[test]
fn what_is_no_trajectory_is_refused_or_undecided() -> Result<(), LinkageError> {
    struct With(f64, JointBounds<f64>);
    impl JointTrajectory for With {
        type Scalar = f64;
        fn state(&self, joint: usize, time: f64) -> JointState<f64> {
            let value = if joint == 1 && (0.3..0.6).contains(&time) { self.0 } else { time };
            JointState { value, rate: 1.0, acceleration: 0.0, error: 1e-15 }
        }
        fn bounds(&self, joint: usize) -> JointBounds<f64> {
            let good = JointBounds { value: 1.0, rate: 1.0, acceleration: 0.0, jerk: 0.0 };
            if joint == 1 { self.1 } else { good }
        }
    }
    let (robot, good) = (arm(), JointBounds { value: 1.0, rate: 1.0, acceleration: 0.0, jerk: 0.0 });
    let ask = |edges: &[With], scene: &Scene<_>| {
        robot.path_along(edges, scene, MotionCastOptions::new(), &mut PathWorkspace::new())
    };
    // The forearm would meet it at 0.39.
    let scene = Scene::new([ball_at(0.45_f64.cos() + 0.7 * 0.9_f64.cos(), 0.45_f64.sin() + 0.7 * 0.9_f64.sin())])
        .expect("finite");
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        for bounds in [
            JointBounds { value: bad, ..good },
            JointBounds { rate: bad, ..good },
            JointBounds { acceleration: bad, ..good },
            JointBounds { jerk: bad, ..good },
        ] {
            let refused = ask(&[With(0.5, good), With(0.5, bounds)], &scene);
            assert_eq!(refused, Err(LinkageError::Bounds { edge: 1, value: 1 }), "{bad}");
        }
    }
    assert_eq!(ask(&[Cubic(vec![[0.0; 4]; 2])].map(|_| With(0.5, good)), &Scene::default())?.first, None);
    for bad in [f64::NAN, f64::INFINITY] {
        let path = ask(&[With(bad, good)], &scene)?;
        assert!(!path.is_free() && path.contact().is_none(), "{path:?}");
        let ends = [Cubic(vec![[0.0; 4], [0.0, 0.0, bad, 0.0]])];
        let refused = robot.path_along(&ends, &scene, MotionCastOptions::new(), &mut PathWorkspace::new());
        assert_eq!(refused, Err(LinkageError::Bounds { edge: 0, value: 1 }));
    }
    let lies = JointBounds { value: 0.0, rate: 0.0, acceleration: 0.0, jerk: 0.0 };
    let _ = ask(&[With(1e300, lies)], &scene)?;
    Ok(())
}

/// A stretched arm that turns from an angle on meets a ball on its way when its middle line is 0.15 from the ball's
/// middle, from whichever edge and with whichever workspace it is asked.
#[test]
fn first_contacts_of_an_arm_are_those_of_its_closed_form() {
    let robot = arm();
    let mut workspace = PathWorkspace::new();
    for k in 0..12 {
        let (angle, far) = (0.6 + 0.1 * f64::from(k), 0.4 + 0.12 * f64::from(k));
        let scene = Scene::new([ball_at(far * angle.cos(), far * angle.sin())]).expect("finite");
        let ways = [[-0.4, 0.0], [0.0, 0.0], [2.0, 0.0], [0.0, 0.0]];
        let path = robot.path(&ways, &scene, MotionCastOptions::new(), &mut workspace).expect("two values each");
        let (contact, hit) = path.contact().expect("it turns by 2");
        let truth = (angle - (0.15 / far).asin()) / 2.0;
        assert_eq!((contact.edge, contact.link, contact.met), (1, usize::from(far > 1.0), Met::Obstacle(0)), "{far}");
        assert!(contact.cast.lower <= truth && truth <= contact.cast.upper, "{truth} is not in {contact:?}");
        assert!(contact.cast.upper - contact.cast.lower < 1e-12 && (hit.time - truth).abs() < 1e-13, "{contact:?}");
        assert!((hit.point - DVec2::from_angle(angle) * far).length() - 0.1 < 1e-12, "{contact:?}");
        assert_eq!(path, ask(&robot, &ways.map(Vec::from), &scene), "a workspace remembers nothing");
        let lean = robot.path(&ways, &scene, MotionCastOptions::lean(), &mut workspace).expect("two values each").first;
        let holds = |lean: PathContact<DVec2>| lean.edge == 1 && lean.cast.lower <= truth && truth <= lean.cast.upper;
        assert!(lean.is_some_and(holds), "{truth} is not in {lean:?}");
        // Short of the ball by 1e-9 it is free.
        assert!(ask(&robot, &[vec![0.0, 0.0], vec![2.0 * truth - 1e-9, 0.0]], &scene).is_free(), "{far}");
    }
}

/// The time of a chain of three bars whose joints turn alike, when its ends are so far apart: |1 + 2·cos α| = far.
#[test]
fn links_of_one_robot_meet_one_another() {
    let joints = [turning(None, DVec2::X), turning(Some(0), DVec2::X)];
    let links = [None, Some(0), Some(1)].map(|joint| Link { joint, bodies: vec![bar()] });
    let chain = Linkage::new(joints, links).expect("a linkage");
    let nothing = Scene::default();
    for (pair, sign) in [([2, 0], 1.0), ([0, 2], -1.0)] {
        let chain = chain.clone().with_pairs([pair]).expect("two links");
        let path = ask(&chain, &[vec![0.0; 2], vec![2.5; 2]], &nothing);
        let (contact, hit) = path.contact().expect("the ends come together at 120°");
        let (alpha, truth) = ((-0.45_f64).acos(), (-0.45_f64).acos() / 2.5);
        assert!(
            contact.cast.lower <= truth
                && truth <= contact.cast.upper
                && contact.cast.upper - contact.cast.lower < 1e-12,
            "{contact:?}"
        );
        assert_eq!((contact.link, contact.met), (pair[0], Met::Link { link: pair[1], body: 0 }), "in the order asked");
        let end = DVec2::X + DVec2::from_angle(alpha) + DVec2::from_angle(2.0 * alpha);
        assert!((hit.point - end * 0.5).length() < 1e-12, "halfway between the ends: {contact:?}");
        let normal = hit.normal.expect("they were apart");
        assert!((normal - end.normalize() * sign).length() < 1e-12, "out of the second, in the world: {contact:?}");
        assert!(ask(&chain, &[vec![0.0; 2], vec![alpha - 1e-9; 2]], &nothing).is_free(), "{pair:?}");
        let near = MotionCastOptions::new().with_target_distance(0.1);
        let sooner = chain.path(&[[0.0; 2], [2.0; 2]], &nothing, near, &mut PathWorkspace::new()).expect("valid");
        let truth = (-0.4_f64).acos() / 2.0;
        assert!(sooner.contact().is_some_and(|(_, hit)| (hit.time - truth).abs() < 1e-13), "{sooner:?}");
    }
    assert!(ask(&chain, &[vec![0.0; 2], vec![2.5; 2]], &nothing).is_free(), "none is asked about another");
}

/// Two robots that both move are one linkage of two trees. Bars of length 1, 1.8 apart at their other ends, sink
/// towards one another like a gate: their tips touch where they are 0.1 apart, at the cosine 0.85.
#[test]
fn two_robots_meet_one_another() {
    let joints = [turning(None, DVec2::ZERO), turning(None, DVec2::new(1.8, 0.0))];
    let links = [0, 1].map(|joint| Link { joint: Some(joint), bodies: vec![bar()] });
    let gate = Linkage::new(joints, links).expect("a linkage").with_pairs([[0, 1]]).expect("two links");
    let path = ask(&gate, &[vec![1.2, PI - 1.2], vec![0.0, PI]], &Scene::default());
    let ((contact, hit), truth) = (path.contact().expect("they meet"), (1.2 - 0.85_f64.acos()) / 1.2);
    assert_eq!((contact.link, contact.met), (0, Met::Link { link: 1, body: 0 }), "{contact:?}");
    assert!(
        contact.cast.lower <= truth && truth <= contact.cast.upper && contact.cast.upper - contact.cast.lower < 1e-12,
        "{contact:?}"
    );
    assert!((hit.point - DVec2::new(0.9, (1.0_f64 - 0.85 * 0.85).sqrt())).length() < 1e-12, "{contact:?}");
}

#[cfg(feature = "rayon")]
#[test]
fn paths_on_threads_are_answered_as_one_by_one() {
    let (robot, scene) = (arm(), Scene::new([ball_at(1.0, 1.0)]).expect("finite"));
    let paths: Vec<_> = (0..40).map(|k| vec![vec![0.0, 0.0], vec![0.05 * f64::from(k), 0.3]]).collect();
    let alone: Vec<_> = paths.iter().map(|path| Ok(ask(&robot, path, &scene))).collect();
    assert_eq!(robot.par_paths(&paths, &scene, MotionCastOptions::new()), alone, "in the same order");
}

/// What slides, in a frame that is turned, towards a wall.
#[test]
fn a_joint_slides_along_its_axis() -> Result<(), Box<dyn std::error::Error>> {
    let quarter = Pose { rotation: DQuat::from_rotation_z(FRAC_PI_2), translation: DVec3::Y };
    let joints = [
        Joint { parent: None, pose: quarter, kind: JointKind::Fixed },
        at_parent(Some(0), JointKind::Prismatic(DVec3::NEG_Y * 3.0)),
    ];
    let robot = Linkage::new(joints, [Link { joint: Some(1), bodies: vec![Ball::new(0.5)?] }])?;
    let mut scene = Scene::<Ball<DVec3>>::default();
    let wall = scene.insert_half_space(HalfSpace::new(DVec3::NEG_X, -3.0)?);
    let path = robot.path(&[[0.0], [1.0], [5.0]], &scene, MotionCastOptions::new(), &mut PathWorkspace::new())?;
    let (contact, hit) = path.contact().ok_or("it comes to 2.5")?;
    assert_eq!((contact.edge, contact.met), (1, Met::Obstacle(wall)), "{contact:?}");
    assert!(
        contact.cast.lower <= 0.375 && 0.375 <= contact.cast.upper && contact.cast.upper - contact.cast.lower < 1e-13,
        "{contact:?}"
    );
    assert!((hit.point - DVec3::new(3.0, 1.0, 0.0)).length() < 1e-13, "{contact:?}");
    Ok(())
}

/// A path is undecided, neither free nor in contact, from where a search was cut short, or where only rounding decides:
/// a ball that the hand grazes in the middle of an edge. What is certainly met counts if it is met before that.
#[test]
fn a_path_is_undecided_from_where_a_cast_is() {
    let (robot, ways) = (arm(), [vec![0.0, 0.0], vec![2.0, 0.0]]);
    let at = |far: f64, angle: f64| ball_at(far * angle.cos(), far * angle.sin());
    let (grazed, before, after) = (at(2.15, 1.0), at(1.5, 0.5), at(1.5, 1.8));
    let first_of = |bodies: &[Posed<Ball<DVec2>>]| ask(&robot, &ways, &Scene::new(bodies.to_vec()).expect("finite"));
    for bodies in [&[grazed][..], &[grazed, after], &[after, grazed]] {
        let path = first_of(bodies);
        let first = path.first.expect("it may touch");
        assert!(first.cast.outcome.is_undecided() && path.contact().is_none() && !path.is_free(), "{path:?}");
        assert_eq!(Some(first.met), bodies.iter().position(|body| *body == grazed).map(Met::Obstacle), "{path:?}");
        assert!((first.cast.lower - 0.5).abs() < 1e-6, "the time of the graze: {path:?}");
    }
    for (bodies, index) in [([grazed, before], 1), ([before, grazed], 0)] {
        let path = first_of(&bodies);
        assert!(path.contact().is_some_and(|(it, hit)| it.met == Met::Obstacle(index) && hit.time < 0.25), "{path:?}");
    }
    let (scene, truth) = (Scene::new([before]).expect("finite"), (0.5 - (0.15_f64 / 1.5).asin()) / 2.0);
    for (looks, is_cut) in [(0, true), (1, true), (3, true), (100, false)] {
        let options = MotionCastOptions::new().with_max_iterations(looks);
        let path = robot.path(&ways, &scene, options, &mut PathWorkspace::new()).expect("two values each");
        let cast = path.first.expect("it is met").cast;
        assert!(cast.lower <= truth && truth <= cast.upper, "{looks}: {path:?}");
        let is_undecided = cast.status == Status::IterationLimit && path.contact().is_none() && !path.is_free();
        assert_eq!(is_undecided, is_cut, "{looks}: {path:?}");
    }
}

#[test]
fn a_path_of_one_waypoint_is_a_pose() {
    let (robot, scene) = (arm(), Scene::new([ball_at(1.0, 1.0)]).expect("finite"));
    let (contact, hit) = ask(&robot, &[vec![FRAC_PI_4, 0.0]], &scene).contact().expect("the ball is in the forearm");
    assert_eq!((contact.edge, hit.time, contact.link, hit.normal), (0, 0.0, 1, None), "{contact:?}");
    assert!(ask(&robot, &[vec![0.0, 0.0]], &scene).is_free());
    let still = ask(&robot, &vec![vec![0.3, 0.0]; 3], &scene);
    assert!(still.is_free(), "it may also rest for two edges: {still:?}");
}

/// A number from 0 to 1, from a seed.
fn random(seed: &mut u64) -> f64 {
    *seed ^= *seed << 13;
    *seed ^= *seed >> 7;
    *seed ^= *seed << 17;
    (*seed >> 11) as f64 / (1_u64 << 53) as f64
}

fn random_vector(seed: &mut u64) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|_| 2.0 * random(seed) - 1.0))
}

fn random_pose(seed: &mut u64, size: f64) -> Pose<DVec3> {
    let axis = random_vector(seed);
    let rotation = DQuat::from_xyzw(axis.x, axis.y, axis.z, random(seed));
    Pose { rotation, translation: random_vector(seed) * size }
}

fn random_shape(seed: &mut u64) -> Result<Shape, InvalidShape> {
    let size = random_vector(seed).abs() * 0.25;
    let shape: Shape = match (random(seed) * 5.0) as usize {
        0 => Box::new(Ball::new(size.x)?),
        1 => Box::new(Cuboid::new(size)?),
        2 => Box::new(Capsule::<DVec3>::new(size.x, size.y)?),
        3 => Box::new(Point::new(size)?),
        _ => Box::new(Polytope::new([size, -size, size.yzx(), -size.zxy(), random_vector(seed) * 0.2])?),
    };
    let Pose { rotation, translation } = random_pose(seed, 0.2);
    Ok(Box::new(Posed::new(shape, rotation, translation)?))
}

/// Poses by quaternions, one after the other, in place of the matrices of the library.
fn frames(joints: &[Joint<DVec3>], values: &[f64]) -> Vec<(DQuat, DVec3)> {
    let (mut frames, mut values) = (Vec::<(DQuat, DVec3)>::new(), values.iter());
    for Joint { parent, pose, kind } in joints {
        let (carrier, at) = parent.map_or((DQuat::IDENTITY, DVec3::ZERO), |parent| frames[parent]);
        let (rotation, origin) = (carrier * pose.rotation.normalize(), at + carrier * pose.translation);
        frames.push(match *kind {
            JointKind::Fixed => (rotation, origin),
            JointKind::Revolute(axis) => {
                let turn = DQuat::from_axis_angle(axis.normalize(), *values.next().expect("one each"));
                (rotation * turn, origin)
            }
            JointKind::Prismatic(axis) => {
                (rotation, origin + rotation * axis.normalize() * *values.next().expect("one each"))
            }
        });
    }
    frames
}

/// Robots of random joints in a tree, some of which slide, among random bodies, on straight edges and on splines: at
/// 40 or 200 times of what is said to be free, every pair is apart; and by the upper bound of a contact one pair is
/// not.
#[test]
fn what_is_said_to_be_free_is_free_at_every_time_that_is_looked_at() -> Result<(), Box<dyn std::error::Error>> {
    let (mut seed, mut free, mut contacts) = (0x2004_1120_u64, 0, 0);
    for round in 0..80 {
        let joints: Vec<Joint<DVec3>> = (0..4)
            .map(|i: usize| {
                let parent = i.checked_sub(1).filter(|_| random(&mut seed) < 0.8);
                let axis = random_vector(&mut seed);
                let kind = match (random(&mut seed) * 5.0) as usize {
                    0 => JointKind::Fixed,
                    1 => JointKind::Prismatic(axis),
                    _ => JointKind::Revolute(axis),
                };
                Joint { parent, pose: random_pose(&mut seed, 0.4), kind }
            })
            .collect();
        let places = [None, Some(1), Some(2), Some(3)];
        let shapes = places.map(|_| [random_shape(&mut seed), random_shape(&mut seed)]);
        let mut links = Vec::new();
        for (joint, [first, second]) in places.into_iter().zip(shapes) {
            links.push(Link { joint, bodies: vec![first?, second?] });
        }
        let pairs = [[3, 0], [1, 3]];
        let robot = Linkage::new(joints.clone(), links)?.with_pairs(pairs)?;
        let obstacle = |seed: &mut u64| Posed::translated(random_shape(seed)?, random_vector(seed) * 1.2);
        let scene = Scene::new([obstacle(&mut seed)?, obstacle(&mut seed)?])?;
        let size = [0.3, 1.0, 4.0][(random(&mut seed) * 3.0) as usize];
        let ways =
            [0; 3].map(|_| (0..robot.values()).map(|_| size * (2.0 * random(&mut seed) - 1.0)).collect::<Vec<_>>());
        let (options, mut workspace) = (MotionCastOptions::new(), PathWorkspace::new());
        let mut edges = [0, 1].map(|edge| Cubic::straight(&ways[edge], &ways[edge + 1]));
        let path = if round < 40 {
            robot.path(&ways, &scene, options, &mut workspace)?
        } else {
            // Each edge is a spline with these rates at its ends.
            let rates =
                [0; 3].map(|_| ways[0].iter().map(|_| size * (4.0 * random(&mut seed) - 2.0)).collect::<Vec<_>>());
            for (edge, cubic) in edges.iter_mut().enumerate() {
                for (joint, [_, b, c, d]) in cubic.0.iter_mut().enumerate() {
                    let (way, from, to) = (*b, rates[edge][joint], rates[edge + 1][joint]);
                    (*b, *c, *d) = (from, 3.0 * way - 2.0 * from - to, from + to - 2.0 * way);
                }
            }
            robot.path_along(&edges, &scene, options, &mut workspace)?
        };
        // The least signed distance at a time.
        let least = |edge: usize, time: f64| -> Result<f64, InvalidShape> {
            let values: Vec<f64> = (0..robot.values()).map(|joint| edges[edge].state(joint, time).value).collect();
            let frames = frames(&joints, &values);
            let placed = |link: usize| {
                let (rotation, at) = places[link].map_or((DQuat::IDENTITY, DVec3::ZERO), |joint| frames[joint]);
                robot.bodies(link).iter().map(|body| Posed::new(body, rotation, at)).collect::<Result<Vec<_>, _>>()
            };
            let mut least = f64::INFINITY;
            let mut near = |distance: f64| least = least.min(distance);
            for link in 0..robot.links() {
                for body in placed(link)? {
                    for obstacle in scene.iter().filter_map(|(_, body)| body.convex()) {
                        near(signed_distance(&body, obstacle, SignedDistanceOptions::new()).signed_distance);
                    }
                }
            }
            for [a, b] in pairs {
                for (a, b) in placed(a)?.iter().flat_map(|a| placed(b).into_iter().flatten().map(move |b| (*a, b))) {
                    near(signed_distance(&a, &b, SignedDistanceOptions::new()).signed_distance);
                }
            }
            Ok(least)
        };
        let proved = path.first.map_or((1, 1.0), |first| (first.edge, first.cast.lower));
        let times = if round < 40 { 20 } else { 100 };
        for k in 0..times {
            for (edge, end) in
                [(0, if proved.0 == 0 { proved.1 } else { 1.0 }), (1, if proved.0 == 0 { 0.0 } else { proved.1 })]
            {
                let time = end * f64::from(k) / f64::from(times);
                let distance = if end > 0.0 { least(edge, time)? } else { 1.0 };
                assert!(distance > -1e-13, "{distance} at {time} of edge {edge}: {path:?}");
            }
        }
        match path.contact() {
            Some((contact, _)) => {
                contacts += 1;
                assert!(least(contact.edge, contact.cast.upper)? < 1e-12, "{path:?}");
            }
            None => free += usize::from(path.is_free()),
        }
    }
    assert!(free > 20 && contacts > 20, "both are exercised: {free} and {contacts}");
    Ok(())
}

/// The last of three bars in a row meets the first where both joints turn far enough: at α in both, |1 + 2·cos α| ≤
/// 0.1.
#[test]
fn a_box_of_joints_is_proved_or_refuted() -> Result<(), Box<dyn std::error::Error>> {
    let joints = [turning(None, DVec2::X), turning(Some(0), DVec2::X)];
    let links = [None, Some(0), Some(1)].map(|joint| Link { joint, bodies: vec![bar()] });
    let chain = Linkage::new(joints, links)?;
    let ask = |half: f64| chain.joint_box([2, 0], &[[-half, half]; 2], 0.0, 100_000);
    assert_eq!(ask(1.5)?.outcome, JointBoxOutcome::Never);
    let JointBoxOutcome::Meets { values, bodies } = ask(2.1)?.outcome else { return Err("they may meet".into()) };
    assert_eq!(bodies, [0, 0]);
    // The pose is one, by the path of one waypoint.
    let own = chain.clone().with_pairs([[2, 0]])?;
    assert!(!ask_own(&own, &values).is_free(), "{values:?}");

    // No wider interval is free, and none that is free has a pose that is not.
    let mut seed = 7;
    let (limits, mut met) = ([[-1.9, 1.9], [-1.9, 2.4]], 0);
    let found = chain.joint_box([2, 0], &limits, 0.0, 100_000)?;
    for _ in 0..500 {
        let values = limits.map(|[low, high]: [f64; 2]| low + (high - low) * random(&mut seed)).to_vec();
        met += usize::from(!ask_own(&own, &values).is_free());
    }
    assert_eq!(met > 0, matches!(found.outcome, JointBoxOutcome::Meets { .. }), "{met} poses, {found:?}");

    // A search that is cut short says how much of the box is open.
    let cut = chain.joint_box([2, 0], &[[-1.5, 1.5]; 2], 0.0, 9)?;
    assert!(matches!(cut.outcome, JointBoxOutcome::Undecided { share } if share > 0.0 && share < 1.0), "{cut:?}");
    // However few, at least one part is looked at, and none is lost.
    for most in 0..4 {
        let cut = chain.joint_box([2, 0], &[[-1.5, 1.5]; 2], 0.0, most)?;
        let JointBoxOutcome::Undecided { share } = cut.outcome else { return Err("not by so few".into()) };
        assert!(share > 0.0 && cut.boxes <= most + 1, "{most}: {cut:?}");
    }
    // Of no extent, the box is a pose.
    let pose = [[0.0, 0.0], [0.0, 0.0]];
    let touching = chain.joint_box([1, 0], &pose, 0.0, 100)?;
    assert!(matches!(touching.outcome, JointBoxOutcome::Meets { .. }), "neighbours overlap: {touching:?}");
    Ok(())
}

/// In the middle of the box the first ball of the hand is nearest to the post, and by the thousandth part of a
/// millimetre never meets it, wherever the first joint is. The second one does, elsewhere. While the nearest boxes came
/// first, 36,827 parts were looked at before that was found. And a pose in which bodies touch to rounding, a box
/// without a width, was halved until the limit of parts was reached.
#[test]
fn where_links_almost_meet_does_not_hide_where_they_do() -> Result<(), Box<dyn std::error::Error>> {
    let ball = |radius: f64, at: DVec2| Posed::translated(Ball::new(radius)?, at);
    let (aside, post) = (DVec2::from_angle(0.9) * -0.3, Link { joint: None, bodies: vec![ball(0.5, DVec2::ZERO)?] });
    for short in [1e-3, 1e-6] {
        let hand = vec![ball(0.2 - short, DVec2::X * -0.3)?, ball(0.201, aside)?];
        let joints = [turning(None, DVec2::ZERO), turning(Some(0), DVec2::X)];
        let robot = Linkage::new(joints, [post.clone(), Link { joint: Some(1), bodies: hand }])?;
        let answer = robot.joint_box([1, 0], &[[-1.0, 1.0]; 2], 0.0, 100_000)?;
        assert!(matches!(answer.outcome, JointBoxOutcome::Meets { bodies: [1, 0], .. }), "{answer:?}");
        assert!(answer.boxes < 100, "{answer:?}");
    }
    let hand = Link { joint: Some(0), bodies: vec![ball(0.5, DVec2::X)?] };
    let touching = Linkage::new([turning(None, DVec2::ZERO)], [post, hand])?;
    let answer = touching.joint_box([1, 0], &[[0.25; 2]], 0.0, 100_000)?;
    assert_eq!((answer.outcome, answer.boxes), (JointBoxOutcome::Undecided { share: 1.0 }, 1), "nothing can be halved");
    Ok(())
}

/// In a part of the box that is proved free for two bodies they are farther apart than the target at any joint values,
/// and such parts cover a box in which nothing ever meets. Values at which something is said to meet are such by its
/// distance. Bodies at rest are a ball, a box, a member of a group and a half-space.
#[test]
fn a_box_among_bodies_at_rest_agrees_with_the_distances_in_it() -> Result<(), Box<dyn std::error::Error>> {
    let at = |x: f64, y: f64, z: f64| Pose { translation: DVec3::new(x, y, z), ..Pose::default() };
    let bar = |half: f64| -> Result<Shape, InvalidShape> {
        let ends = [DVec3::ZERO, DVec3::X * 2.0 * half];
        Ok(Box::new(Rounded::new(Segment::new(ends)?, 0.05)?))
    };
    let joint = |parent, pose, kind| Joint { parent, pose, kind };
    let robot = Linkage::new(
        [
            joint(None, at(0.0, 0.0, 0.2), JointKind::Revolute(DVec3::Z)),
            joint(Some(0), at(0.6, 0.0, 0.0), JointKind::Revolute(DVec3::new(0.2, 1.0, 0.0))),
            joint(Some(1), at(0.6, 0.0, 0.0), JointKind::Prismatic(DVec3::new(0.3, 0.0, 1.0))),
        ],
        [
            Link { joint: None, bodies: vec![bar(0.05)?] },
            Link { joint: Some(0), bodies: vec![bar(0.3)?] },
            Link { joint: Some(2), bodies: vec![bar(0.1)?, Box::new(Cuboid::new(DVec3::splat(0.04))?)] },
        ],
    )?;
    let (robot, own) = (robot.with_pairs([[2, 0], [2, 1]])?, [[2, 0], [2, 1]]);
    let mut seed = 5;
    let [mut met, mut never] = [0; 2];
    for _ in 0..60 {
        let mut place = || {
            let [x, y, z] = [0; 3].map(|_| 2.4 * random(&mut seed) - 1.2);
            at(x, y, z)
        };
        let mut scene = Scene::<Shape>::default();
        scene.insert(Box::new(Posed::translated(Ball::new(0.1)?, place().translation)?))?;
        scene.insert(Box::new(Posed::translated(Cuboid::new(DVec3::new(0.1, 0.05, 0.2))?, place().translation)?))?;
        let two = [-0.1, 0.1].map(|x| Posed::translated(Ball::new(0.07).expect("a radius"), DVec3::X * x));
        scene.insert_group(&Group::new(Scene::new(two.into_iter().collect::<Result<Vec<_>, _>>()?)?)?, place())?;
        scene.insert_half_space(HalfSpace::new(DVec3::new(0.1, 0.2, 2.0), -2.0 * random(&mut seed))?);
        let target = 0.05 * random(&mut seed);
        let mut interval = |most: f64| {
            let [middle, half] = [most * (2.0 * random(&mut seed) - 1.0), 0.4 * most * random(&mut seed)];
            [middle - half, middle + half]
        };
        let whole = [interval(3.0), interval(1.2), interval(0.4)];
        let mut free: Vec<(BodyPair, Vec<[f64; 2]>)> = Vec::new();
        let show = |FreeBox { bodies, joint_box, .. }: FreeBox<'_, DVec3, BodyPair>| {
            free.push((bodies, joint_box.to_vec()));
        };
        let answer = robot.joint_box_among_with(&scene, &whole, target, 100_000, show)?;
        let distance = |BodyPair { link, body, met }: BodyPair, values: &[f64]| {
            let placed = |link, body| robot.placed(link, body, values).expect("a body");
            let (shape, options) = (placed(link, body), SignedDistanceOptions::new());
            match met {
                Met::Obstacle(obstacle) => scene.get(obstacle).expect("a body").signed_distance(&shape, options),
                Met::Member { obstacle, member } => {
                    signed_distance(&shape, &scene.member(obstacle, member).expect("a member"), options)
                }
                Met::Link { link, body } => signed_distance(&shape, &placed(link, body), options),
            }
            .signed_distance
        };
        for (bodies, part) in &free {
            for _ in 0..5 {
                let values: Vec<_> =
                    part.iter().map(|[low, high]| low + (high - low) * random(&mut seed).round()).collect();
                assert!(distance(*bodies, &values) > target, "{bodies:?} at {values:?} in {part:?}");
                let values: Vec<_> = part.iter().map(|[low, high]| low + (high - low) * random(&mut seed)).collect();
                assert!(distance(*bodies, &values) > target, "{bodies:?} at {values:?} in {part:?}");
            }
        }
        match answer.outcome {
            JointBoxOutcome::Never => {
                never += 1;
                let at_rest = [0, 1, 3].map(Met::Obstacle).into_iter();
                let members = [0, 1].map(|member| Met::Member { obstacle: 2, member });
                let at_rest: Vec<_> = at_rest.chain(members).collect();
                let bodies = (0..3).flat_map(|link| (0..robot.bodies(link).len()).map(move |body| (link, body)));
                let among =
                    bodies.flat_map(|(link, body)| at_rest.iter().map(move |&met| BodyPair { link, body, met }));
                let met = |[link, other]: [usize; 2]| {
                    [0, 1].map(|body| BodyPair { link, body, met: Met::Link { link: other, body: 0 } })
                };
                let volume = |part: &[[f64; 2]]| part.iter().map(|[low, high]| high - low).product::<f64>();
                for pair in among.chain(own.into_iter().flat_map(met)) {
                    let covered: f64 = free.iter().filter(|part| part.0 == pair).map(|part| volume(&part.1)).sum();
                    assert!((covered / volume(&whole) - 1.0).abs() < 1e-9, "{pair:?}: {covered}");
                }
            }
            JointBoxOutcome::Meets { values, bodies } => {
                met += 1;
                assert!(values.iter().zip(&whole).all(|(value, [low, high])| low <= value && value <= high));
                let there = distance(bodies, &values);
                assert!(there <= target, "{bodies:?} at {values:?}: {there}");
            }
            JointBoxOutcome::Undecided { share } => return Err(format!("{share} of {whole:?} is open").into()),
        }
    }
    assert!(met > 10 && never > 10, "{met} met, {never} never");
    Ok(())
}

/// Without bodies at rest the answer is that of the pair, and without a pair nothing meets.
#[test]
fn a_box_among_nothing_is_that_of_its_pairs() -> Result<(), Box<dyn std::error::Error>> {
    let joints = [turning(None, DVec2::X), turning(Some(0), DVec2::X)];
    let chain = Linkage::new(joints, [None, Some(0), Some(1)].map(|joint| Link { joint, bodies: vec![bar()] }))?;
    let own = chain.clone().with_pairs([[2, 0]])?;
    let nothing = Scene::<Bar>::default();
    for half in [1.5, 2.05, 2.1] {
        for most in [0, 9, 100_000] {
            let limits = [[-half, half]; 2];
            let (one, all) =
                (chain.joint_box([2, 0], &limits, 0.0, most)?, own.joint_box_among(&nothing, &limits, 0.0, most)?);
            assert_eq!(one.boxes, all.boxes);
            let met = |[body, other]: [usize; 2]| BodyPair { link: 2, body, met: Met::Link { link: 0, body: other } };
            let expected = match one.outcome {
                JointBoxOutcome::Never => JointBoxOutcome::Never,
                JointBoxOutcome::Meets { values, bodies } => JointBoxOutcome::Meets { values, bodies: met(bodies) },
                JointBoxOutcome::Undecided { share } => JointBoxOutcome::Undecided { share },
            };
            assert_eq!(all.outcome, expected);
            let without = chain.joint_box_among(&nothing, &limits, 0.0, most)?;
            assert_eq!((without.outcome, without.boxes), (JointBoxOutcome::Never, 0));
        }
    }
    let boxes = |limits: &[[f64; 2]], target| own.joint_box_among(&nothing, limits, target, 100).err();
    assert_eq!(boxes(&[[0.0, 1.0], [1.0, 0.5]], 0.0), Some(LinkageError::Interval { value: 1 }));
    assert_eq!(boxes(&[[0.0, 1.0]], 0.0), Some(LinkageError::Count { waypoint: 0, joints: 2, values: 1 }));
    assert_eq!(boxes(&[[f64::NAN, 1.0], [0.0, 1.0]], 0.0), Some(LinkageError::Value { waypoint: 0, value: 0 }));
    assert!(matches!(boxes(&[[0.0, 1.0]; 2], f64::NAN), Some(LinkageError::Option(_))));
    Ok(())
}

fn ask_own(robot: &Linkage<Bar>, values: &[f64]) -> Path<DVec2> {
    ask(robot, &[values.to_vec()], &Scene::default())
}

#[test]
fn what_is_no_linkage_or_path_is_refused_by_its_index() -> Result<(), Box<dyn std::error::Error>> {
    let joints = |joint: Joint<DVec2>| Linkage::<Bar>::new([turning(None, DVec2::ZERO), joint], []).err();
    let place = |x: f64, rotation: f64| Pose { translation: DVec2::new(x, 0.0), rotation };
    assert_eq!(joints(turning(Some(1), DVec2::X)), Some(LinkageError::ParentNotBefore { joint: 1, parent: 1 }));
    assert_eq!(joints(at_parent(Some(0), JointKind::Revolute(0.0))), Some(LinkageError::Axis { joint: 1 }));
    assert_eq!(joints(at_parent(Some(0), JointKind::Revolute(f64::NAN))), Some(LinkageError::Axis { joint: 1 }));
    assert_eq!(joints(at_parent(Some(0), JointKind::Prismatic(DVec2::ZERO))), Some(LinkageError::Axis { joint: 1 }));
    for (pose, parameter) in [(place(f64::NAN, 0.0), "translation"), (place(0.0, f64::INFINITY), "rotation")] {
        let why = InvalidShape::NonFinite { parameter, index: 0 };
        assert_eq!(
            joints(Joint { parent: None, pose, kind: JointKind::Fixed }),
            Some(LinkageError::Pose { joint: 1, why })
        );
    }
    let lost = Linkage::new([turning(None, DVec2::ZERO)], [Link { joint: Some(3), bodies: vec![bar()] }]);
    assert_eq!(lost.err(), Some(LinkageError::NoSuchJoint { link: 0, joint: 3 }));
    for pair in [[0, 2], [1, 1]] {
        assert_eq!(arm().with_pairs([[0, 1], pair]).err(), Some(LinkageError::Pair { pair: 1 }), "{pair:?}");
    }

    let scene = Scene::<Bar>::default();
    let refused = |ways: &[Vec<f64>], options| arm().path(ways, &scene, options, &mut PathWorkspace::new()).err();
    let options = MotionCastOptions::new();
    assert_eq!(refused(&[], options), Some(LinkageError::EmptyPath));
    let short = LinkageError::Count { waypoint: 1, joints: 2, values: 1 };
    assert_eq!(refused(&[vec![0.0; 2], vec![1.0]], options), Some(short));
    let nan = LinkageError::Value { waypoint: 0, value: 1 };
    assert_eq!(refused(&[vec![0.0, f64::NAN]], options), Some(nan));
    let option = LinkageError::Option(RayCastError::NonFinite { parameter: "target_distance", index: 0 });
    let without_end = options.with_target_distance(f64::INFINITY);
    assert!(
        refused(&[vec![0.0; 2]], without_end).is_some_and(|why| matches!(why, LinkageError::Option(_))),
        "{option}"
    );

    let boxes = |limits: &[[f64; 2]]| arm().joint_box([0, 1], limits, 0.0, 100_000).err();
    assert_eq!(boxes(&[[0.0, 1.0], [1.0, 0.5]]), Some(LinkageError::Interval { value: 1 }));
    assert_eq!(boxes(&[[0.0, 1.0]]), Some(LinkageError::Count { waypoint: 0, joints: 2, values: 1 }));
    assert_eq!(boxes(&[[0.0, 1.0], [0.0, f64::NAN]]), Some(LinkageError::Value { waypoint: 0, value: 1 }));
    Ok(())
}

/// Numbers out of any range, and turns by 1e300 radians, are undecided or refused, and end.
#[test]
fn the_largest_numbers_end() {
    let scene = Scene::new([ball_at(1.0, 1.0)]).expect("finite");
    for values in [[1e300, -1e300], [1e17, 1.0], [f64::MAX, f64::MIN]] {
        let path = ask(&arm(), &[vec![0.0; 2], values.to_vec()], &scene);
        assert!(!path.is_free() || values[0] < 1e18, "{path:?}");
    }
    let far = Linkage::new([turning(None, DVec2::splat(1e300))], [Link { joint: Some(0), bodies: vec![bar()] }]);
    let path = ask(&far.expect("finite"), &[vec![0.0], vec![1.0]], &scene);
    assert!(path.is_free(), "it is far away: {path:?}");
}

/// An edge is looked at in parts, whose ends are none of the motion. A contact exactly at the end of one, a quarter of
/// the edge, was undecided there, as one at the end of a motion is: whether it comes before that, rounding decides.
#[test]
fn a_contact_at_the_end_of_a_part_is_one() -> Result<(), Box<dyn std::error::Error>> {
    // By a quarter of a turn: the quaternion is not unit.
    let quarter = Pose { rotation: DQuat::from_xyzw(0.0, 0.0, 1.0, 1.0), translation: DVec3::ZERO };
    let joints = [
        Joint { parent: None, pose: quarter, kind: JointKind::Fixed },
        at_parent(Some(0), JointKind::Prismatic(DVec3::NEG_Y * 2.0)),
    ];
    let robot = Linkage::new(joints, [Link { joint: Some(1), bodies: vec![Ball::new(0.5)?] }])?;
    let mut scene = Scene::<Ball<DVec3>>::default();
    scene.insert_half_space(HalfSpace::new(DVec3::NEG_X * 2.0, -6.0)?);
    for (part, target) in [(0.25, 0.5), (0.5, 0.5), (0.75, 0.5), (0.125, 0.0), (0.625, 0.25)] {
        // The ball touches the wall, or comes as near as the target, when its middle is there.
        let (end, wanted) = (2.5 - target, MotionCastOptions::new().with_target_distance(target));
        let ways = [[end - 4.0 * part], [end + 4.0 * (1.0 - part)]];
        let path = robot.path(&ways, &scene, wanted, &mut PathWorkspace::new())?;
        let (contact, _) = path.contact().ok_or("it is decided")?;
        assert!(
            contact.cast.lower <= part && part <= contact.cast.upper && contact.cast.is_certain(),
            "{part}: {contact:?}"
        );
        assert!(contact.cast.upper - contact.cast.lower < 1e-13, "{part}: {contact:?}");
    }
    Ok(())
}

/// A contact exactly at a waypoint was undecided: whether it comes before the end of the one edge, rounding decides,
/// and the next edge begins in it. That it does is what decides.
#[test]
fn a_contact_at_a_waypoint_is_one() -> Result<(), Box<dyn std::error::Error>> {
    let robot = Linkage::new(
        [at_parent(None, JointKind::Prismatic(DVec3::X))],
        [Link { joint: Some(0), bodies: vec![Ball::new(0.5)?] }],
    )?;
    let mut scene = Scene::new([Posed::translated(Ball::new(0.3)?, DVec3::new(2.9, 0.0, 0.0))?])?;
    let wall = scene.insert_half_space(HalfSpace::new(DVec3::NEG_X * 2.0, -6.0)?);
    let ask = |ways: &[[f64; 1]], target: f64| {
        let options = MotionCastOptions::new().with_target_distance(target);
        robot.path(ways, &scene, options, &mut PathWorkspace::new())
    };
    for target in [0.0, 0.25, 0.1] {
        let end = 2.1 - target;
        for (ways, edge) in [(vec![[0.0], [end], [3.0]], 0), (vec![[-1.0], [-0.5], [end], [end + 1.0], [end]], 1)] {
            let (contact, hit) = ask(&ways, target)?.contact().ok_or("it is decided")?;
            assert_eq!((contact.edge, contact.met), (edge, Met::Obstacle(0)), "before the wall {wall}: {contact:?}");
            assert!(contact.cast.lower <= 1.0 && 1.0 <= contact.cast.upper && contact.cast.is_certain(), "{contact:?}");
            assert!(contact.cast.upper - contact.cast.lower < 1e-12 && hit.time == 1.0, "{contact:?}");
        }
        // One that only touches there stays undecided, as nobody can know it, and what comes later is not taken for it.
        let touching = ask(&[[0.0], [end], [0.0], [3.0]], target)?;
        assert!(!touching.is_free(), "{touching:?}");
        assert!(touching.contact().is_none_or(|(contact, _)| contact.edge == 0), "{touching:?}");
    }
    Ok(())
}

/// The derivatives of the time by each value of both waypoints are what differences of the times of other paths tell,
/// for a link against the scene and for one against another, near to and far from what it meets.
#[test]
fn the_time_of_a_contact_is_derived_by_the_waypoints() -> Result<(), Box<dyn std::error::Error>> {
    let robot = arm();
    let joints = [turning(None, DVec2::X), turning(Some(0), DVec2::X), turning(Some(1), DVec2::X)];
    let links = [None, Some(0), Some(1), Some(2)].map(|joint| Link { joint, bodies: vec![bar()] });
    let chain = Linkage::new(joints, links)?.with_pairs([[3, 0], [2, 0]])?;
    let scene = Scene::new([ball_at(0.9, 1.2), ball_at(-3.0, 0.0)])?;
    let ways = |from: &[f64], to: &[f64]| [from.to_vec(), to.to_vec()];
    let cases = [
        (&robot, ways(&[0.1, 0.4], &[1.9, -0.3]), &scene),
        (&robot, ways(&[-0.4, 0.2], &[1.5, 0.9]), &scene),
        (&chain, ways(&[0.1, 0.2, 0.0], &[1.9, 1.6, 2.3]), &Scene::default()),
    ];
    for (robot, ways, scene) in cases {
        let options = MotionCastOptions::new().with_target_distance(0.02);
        let time = |ways: &[Vec<f64>]| -> Result<_, LinkageError> {
            let path = robot.path(ways, scene, options, &mut PathWorkspace::new())?;
            Ok(path.contact())
        };
        let (contact, _) = time(&ways)?.ok_or("it is on its way")?;
        assert_eq!(matches!(contact.met, Met::Link { .. }), scene.is_empty(), "{contact:?}");
        let gradient = robot.time_gradient(&ways, &contact).ok_or("it comes nearer")?;
        for (k, end) in (0..robot.values()).flat_map(|k| [(k, 0), (k, 1)]) {
            let at = |step: f64| {
                let mut ways = ways.clone();
                ways[end][k] += step;
                time(&ways).map(|contact| contact.map_or(f64::NAN, |(_, hit)| hit.time))
            };
            let difference = (at(1e-6)? - at(-1e-6)?) / 2e-6;
            let derivative = gradient[k][end];
            assert!((derivative - difference).abs() < 1e-7, "{derivative} and {difference} by value {k} of {end}");
        }
        let apart = robot.time_gradient(&ways[..1], &contact);
        assert_eq!(apart, None, "a path of one waypoint has no such edge");
    }
    Ok(())
}

/// A path is asked until a time, which may be within an edge: what is met later is not.
#[test]
fn a_path_is_asked_until_a_time() -> Result<(), Box<dyn std::error::Error>> {
    let (robot, scene) = (arm(), Scene::new([ball_at(1.0, 1.0)])?);
    let ways = [[-1.0, 0.0], [0.0, 0.0], [2.0, 0.0]];
    let ask = |until: f64| {
        robot.path(&ways, &scene, MotionCastOptions::new().with_max_time(until), &mut PathWorkspace::new())
    };
    let (contact, hit) = ask(f64::INFINITY)?.contact().ok_or("it turns past the ball")?;
    assert_eq!(contact.edge, 1);
    let at = 1.0 + hit.time;
    for until in [-1.0, 0.0, 0.5, 1.0, at - 1e-9] {
        assert!(ask(until)?.is_free(), "{until}");
    }
    for until in [at + 1e-9, 1.9, 2.0, 7.0] {
        let (sooner, there) = ask(until)?.contact().ok_or("it is met before")?;
        assert!(sooner.cast.is_certain() && (there.time - hit.time).abs() < 1e-13, "{until}: {sooner:?}");
    }
    assert!(ask(at)?.contact().is_none_or(|(contact, _)| !contact.cast.is_certain()), "rounding decides");
    assert!(matches!(ask(f64::NAN), Err(LinkageError::Option(_))), "no time");
    Ok(())
}

/// Each interval that is shown is one in which the plane between two bodies, as it turns, separates them, and together
/// they cover the path for every two bodies: those that are cast, and those that are far away.
#[test]
fn the_planes_of_a_free_path_are_shown() {
    let robot = arm();
    let mut scene = Scene::new([ball_at(1.25, 1.25), ball_at(-0.9, 0.3), ball_at(0.3, 6.0)]).expect("finite");
    scene.insert_half_space(HalfSpace::new(DVec2::Y, -1.0).expect("a normal"));
    let ways = [[0.0, 0.2], [0.0, 2.6], [1.5, 2.6], [1.5, 0.2]];
    let (mut shown, mut workspace) = (Vec::new(), PathWorkspace::new());
    let path = robot.path_with(&ways, &scene, MotionCastOptions::new(), &mut workspace, |part| shown.push(part));
    assert!(path.is_ok_and(|path| path.is_free()), "bent, it passes the first ball");
    for (edge, link, other) in (0..24).map(|k| (k / 8, k / 4 % 2, k % 4)) {
        let met = Met::Obstacle(other);
        let mut parts: Vec<_> = shown.iter().filter(|p| (p.edge, p.link, p.met) == (edge, link, met)).collect();
        parts.sort_by(|a, b| a.from.total_cmp(&b.from));
        let end = parts.iter().fold(0.0, |end, part| if part.from <= end { part.to.max(end) } else { end });
        assert_eq!(end, 1.0, "link {link} and body {other} on edge {edge}: {parts:?}");
        for (part, k) in parts.iter().flat_map(|part| (0..=8).map(move |k| (part, f64::from(k) / 8.0))) {
            let time = part.from + k * (part.to - part.from);
            let at = |joint: usize| ways[edge][joint] + time * (ways[edge + 1][joint] - ways[edge][joint]);
            let normal = part.normals[0].lerp(part.normals[1], k);
            let body = robot.placed(link, 0, &[at(0), at(1)]).expect("values for its joints");
            let height = -support_value(&body, -normal);
            let reach = match scene.get(other) {
                Some(Body::Convex(ball)) => support_value(&ball, normal),
                _ => -1.0,
            };
            assert!(height > reach, "{height} and {reach} at {time}: {part:?}");
        }
    }
}

/// No point of a link goes farther than is said, in any direction and along one, and short ways are known well.
#[test]
fn a_link_goes_no_farther_than_its_way() -> Result<(), Box<dyn std::error::Error>> {
    let (robot, mut seed, mut most) = (arm(), 0x2004_1120_u64, 0.0_f64);
    for k in 0..200 {
        let size = [0.05, 0.5, 3.0][k % 3];
        let from = [0, 1].map(|_| 3.0 * random(&mut seed));
        let to = from.map(|value| value + size * (2.0 * random(&mut seed) - 1.0));
        for link in 0..2 {
            let way = robot.way(link, &from, &to, None)?;
            let n = DVec2::from_angle(6.3 * random(&mut seed));
            let along = robot.way(link, &from, &to, Some(n))?;
            assert!(along <= way + 1e-12, "a direction is one of all: {along} of {way}");
            let [before, after] = [robot.placed(link, 0, &from)?, robot.placed(link, 0, &to)?];
            for point in [DVec2::new(-0.05, 0.0), DVec2::new(1.05, 0.0)] {
                let [before, after] = [&before, &after].map(|body| body.translation() + body.rotation() * point);
                let gone = (after - before).length();
                assert!(gone <= way, "{gone} of {way}, from {from:?} to {to:?}");
                assert!(n.dot(after - before) <= along, "{along} along {n}, from {from:?} to {to:?}");
                most = most.max(if size < 0.1 { gone / way } else { 0.0 });
            }
        }
    }
    assert!(most > 0.9, "a short way is known well: {most}");
    let unknown = LinkageError::NoSuchBody { link: 2, body: 0 };
    assert_eq!(robot.way(2, &[0.0; 2], &[0.0; 2], None), Err(unknown), "there are two links");
    assert_eq!(robot.placed(2, 0, &[0.0; 2]).err(), Some(unknown), "there are two links");
    Ok(())
}

/// In `f32` the joints' own rounding is most of what a bracket is wide by, and the numbers given are those of `f32`.
#[test]
fn brackets_hold_in_single_precision() -> Result<(), Box<dyn std::error::Error>> {
    let bar = Rounded::new(Segment::new([Vec2::ZERO, Vec2::X])?, 0.0625)?;
    let elbow = Pose { translation: Vec2::X, ..Pose::default() };
    let joints = [
        at_parent(None, JointKind::Revolute(1.0)),
        Joint { parent: Some(0), pose: elbow, kind: JointKind::Revolute(-1.0) },
    ];
    let robot = Linkage::new(joints, [0, 1].map(|joint| Link { joint: Some(joint), bodies: vec![bar] }))?;
    for k in 0..10_u8 {
        let (x, y) = (0.75 - 0.0625 * f32::from(k), 0.5 + 0.125 * f32::from(k));
        let scene = Scene::new([Posed::translated(Ball::new(0.125)?, Vec2::new(x, y))?])?;
        let ways = [[-0.5, 0.0], [2.5, 0.0]];
        let path = robot.path(&ways, &scene, MotionCastOptions::new(), &mut PathWorkspace::new())?;
        let (contact, _) = path.contact().ok_or("it turns past the ball")?;
        let (x, y) = (f64::from(x), f64::from(y));
        let truth = (y.atan2(x) - (0.1875 / x.hypot(y)).asin() + 0.5) / 3.0;
        let [lower, upper] = [contact.cast.lower, contact.cast.upper].map(f64::from);
        assert!(lower <= truth && truth <= upper && upper - lower < 1e-4, "{truth} is not in {contact:?}");
    }
    Ok(())
}

/// The members of an instance are obstacles each, and whoever sees the proof sees all of them.
#[test]
fn a_path_meets_the_members_of_an_instance() {
    let (robot, options) = (arm(), MotionCastOptions::new());
    let places = [[1.7, 0.4], [0.2, 1.6], [-0.9, 1.2], [4.0, 4.0]].map(|[x, y]| DVec2::new(x, y));
    let group = Scene::new(places.map(|at| ball_at(at.x, at.y))).expect("finite");
    let group = Group::new(group).expect("four members");
    let mut met = Vec::new();
    for k in 0..200 {
        let number = f64::from(k);
        let pose = Pose { rotation: 0.3 * number, translation: DVec2::new((0.7 * number).sin(), (1.1 * number).cos()) };
        let mut scene = Scene::<Posed<Ball<DVec2>>>::default();
        scene.insert_group(&group, pose).expect("a pose");
        let alone = places.map(|at| Posed::new(ball_at(at.x, at.y), pose.rotation, pose.translation).expect("finite"));
        let alone = Scene::new(alone).expect("finite");
        let ways = [vec![0.0, 0.0], vec![(0.37 * number).sin() * 2.0, 0.5], vec![2.5, -1.0]];
        let mut workspace = PathWorkspace::new();
        let path = robot.path(&ways, &scene, options, &mut workspace).expect("a path");
        let due = robot.path(&ways, &alone, options, &mut workspace).expect("a path");
        assert_eq!(path.is_free(), due.is_free());
        if let (Some((contact, hit)), Some((flat, due))) = (path.contact(), due.contact()) {
            assert!((hit.time - due.time).abs() < 1e-12 && contact.edge == flat.edge, "{contact:?} {flat:?}");
            let Met::Member { obstacle: 0, member } = contact.met else { panic!("{contact:?}") };
            assert_eq!((flat.met, flat.link), (Met::Obstacle(member), contact.link), "{contact:?} {flat:?}");
            met.push(member);
        }
        let mut seen = std::collections::BTreeSet::new();
        let watched = robot.path_with(&ways, &scene, options, &mut workspace, |free| {
            seen.insert((free.edge, free.link, format!("{:?}", free.met)));
        });
        assert_eq!(watched.expect("a path").is_free(), path.is_free());
        assert!(!path.is_free() || seen.len() == 2 * (2 * 4), "each link and each member on each edge: {seen:?}");
    }
    assert!(met.len() > 20 && [0, 1, 2].iter().all(|member| met.contains(member)), "{met:?}");
}
