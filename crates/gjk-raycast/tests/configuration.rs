//! A linkage at one configuration: against every pair of placed bodies, differences, and single precision.

use crate::common::Random;
use crate::differences::{Comparison, central};
use allocation_counter::measure;
use convex_support::glam::{DQuat, DVec2, DVec3, Quat, Vec3};
use convex_support::{Ball, Capsule, Cuboid, Posed, Scalar, SupportMap, Vector};
use gjk_raycast::{
    ConfigurationWorkspace, HalfSpace, Joint, JointKind, Link, LinkClearance, Linkage, LinkageError, Met, Pose,
    RayCastError, Scene, SignedDistanceOptions, signed_distance,
};

const VALID: &str = "positive sizes and finite numbers";

type Shape<V> = Box<dyn SupportMap<Vector = V> + Send + Sync>;

/// Vectors of one precision, made of numbers that single precision holds.
trait Space: Vector {
    fn at(at: [f32; 3]) -> Self;
    fn quaternion(q: [f32; 4]) -> Self::Rotation;
    fn spin(axis: [f32; 3]) -> Self::AngularVelocity;
    fn shape(kind: usize, sizes: [f32; 3]) -> Shape<Self>;
}

macro_rules! space {
    ($V:ty, $Q:ty, $S:ty) => {
        impl Space for $V {
            fn at(at: [f32; 3]) -> Self {
                Self::from_array(at.map(<$S>::from))
            }

            fn quaternion(q: [f32; 4]) -> $Q {
                <$Q>::from_array(q.map(<$S>::from))
            }

            fn spin(axis: [f32; 3]) -> Self {
                Self::at(axis)
            }

            fn shape(kind: usize, sizes: [f32; 3]) -> Shape<Self> {
                let [x, y, _] = sizes.map(<$S>::from);
                match kind {
                    0 => Box::new(Ball::new(x).expect(VALID)),
                    1 => Box::new(Capsule::new(x, y).expect(VALID)),
                    _ => Box::new(Cuboid::new(Self::at(sizes)).expect(VALID)),
                }
            }
        }
    };
}
space!(DVec3, DQuat, f64);
space!(Vec3, Quat, f32);

struct Numbers(Random);

impl Numbers {
    fn number(&mut self, from: f64, to: f64) -> f32 {
        self.0.number(from, to) as f32
    }

    fn vector(&mut self, reach: f64) -> [f32; 3] {
        [(); 3].map(|()| self.number(-reach, reach))
    }

    fn shape<V: Space>(&mut self, size: f64) -> Posed<Shape<V>> {
        let kind = (self.number(0.0, 3.0) as usize).min(2);
        let shape = V::shape(kind, [(); 3].map(|()| self.number(0.2 * size, size)));
        let rotation = [(); 4].map(|()| self.number(0.1, 1.0));
        Posed::new(shape, V::quaternion(rotation), V::at(self.vector(0.3))).expect(VALID)
    }

    /// An arm of six joints that move, and one that does not, each with a link of two bodies; links that are not
    /// neighbours are tested against one another.
    fn arm<V: Space>(&mut self) -> Linkage<Posed<Shape<V>>> {
        let joints: Vec<_> = (0..7)
            .map(|index: usize| {
                let rotation = V::quaternion([(); 4].map(|()| self.number(0.1, 1.0)));
                let pose = Pose { translation: V::at(self.vector(0.8)), rotation };
                let kind = match index {
                    2 => JointKind::Prismatic(V::at(self.vector(1.0))),
                    4 => JointKind::Fixed,
                    _ => JointKind::Revolute(V::spin(self.vector(1.0))),
                };
                Joint { parent: index.checked_sub(1), pose, kind }
            })
            .collect();
        let links: Vec<_> =
            (0..7).map(|joint| Link { joint: Some(joint), bodies: vec![self.shape(0.25), self.shape(0.15)] }).collect();
        let pairs = (0..7).flat_map(|a| (a + 2..7).map(move |b| [b, a]));
        Linkage::new(joints, links).and_then(|arm| arm.with_pairs(pairs)).expect("a chain")
    }

    fn scene<V: Space>(&mut self, count: usize) -> Scene<Posed<Posed<Shape<V>>>> {
        let bodies: Vec<_> =
            (0..count).map(|_| Posed::translated(self.shape(0.4), V::at(self.vector(3.0))).expect(VALID)).collect();
        let mut scene = Scene::new(bodies).expect("finite");
        scene.insert_half_space(HalfSpace::new(V::at([0.0, 1.0, 0.5]), V::Scalar::from_f64(-3.0)).expect(VALID));
        scene
    }

    fn values<V: Space>(&mut self, reach: f64) -> [V::Scalar; 6] {
        [(); 6].map(|()| V::Scalar::from_f64(self.number(-reach, reach).into()))
    }
}

fn ask<V: Space>(
    arm: &Linkage<Posed<Shape<V>>>,
    scene: &Scene<Posed<Posed<Shape<V>>>>,
    values: &[V::Scalar],
) -> LinkClearance<V> {
    let mut workspace = ConfigurationWorkspace::new();
    let least = arm.clearance(values, scene, SignedDistanceOptions::new(), &mut workspace);
    least.expect("values for its joints").expect("there are bodies")
}

/// The least of all pairs, the first of equals; obstacles before own links.
#[test]
fn the_clearance_is_that_of_all_pairs_to_the_last_bit() {
    let mut random = Numbers(Random(77));
    let mut kinds = [0; 3];
    for _ in 0..60 {
        let (arm, values) = (random.arm::<DVec3>(), random.values::<DVec3>(3.0));
        let scene = random.scene::<DVec3>(12);
        let found = ask(&arm, &scene, &values);
        let mut least: Option<(f64, usize, usize, Met)> = None;
        let mut see = |value: f64, link, body, met| {
            if least.is_none_or(|(known, ..)| value < known) {
                least = Some((value, link, body, met));
            }
        };
        let placed = |link, body| arm.placed(link, body, &values).expect("a body");
        let each = |link| (0..arm.bodies(link).len()).map(move |body| (link, body));
        for (link, body) in (0..7).flat_map(each) {
            for (index, obstacle) in (0..scene.len()).filter_map(|i| Some((i, scene.get(i)?))) {
                let there = obstacle.signed_distance(&placed(link, body), SignedDistanceOptions::new());
                see(there.signed_distance, link, body, Met::Obstacle(index));
            }
        }
        for (a, b) in (0..7).flat_map(|a| (a + 2..7).map(move |b| (b, a))) {
            for ((_, i), (_, j)) in each(a).flat_map(|i| each(b).map(move |j| (i, j))) {
                let there = signed_distance(&placed(a, i), &placed(b, j), SignedDistanceOptions::new());
                see(there.signed_distance, a, i, Met::Link { link: b, body: j });
            }
        }
        let answer = (found.distance.signed_distance, found.link, found.body, found.met);
        assert_eq!(Some(answer), least, "{values:?}");
        let value = found.distance.signed_distance;
        assert!(found.lower <= value && value <= found.upper && found.upper - found.lower < 1e-11, "{found:?}");
        kinds[match found.met {
            Met::Link { .. } => 0,
            Met::Obstacle(12) => 1,
            Met::Obstacle(_) | Met::Member { .. } => 2,
        }] += 1;

        // It is free to any smaller distance, and to no greater one.
        let mut workspace = ConfigurationWorkspace::new();
        let mut is_free = |target| arm.is_free(&values, &scene, target, &mut workspace).expect("values for its joints");
        assert_eq!(is_free(0.0), value > 0.0, "{found:?}");
        if value > 0.0 {
            assert!(is_free(value * (1.0 - 1e-9)) && !is_free(value * (1.0 + 1e-9)), "{found:?}");
            assert!(!is_free(found.upper) && !is_free(value), "the pose may be nearer: {found:?}");
            let within = |limit| SignedDistanceOptions::new().with_limit(limit);
            let near = |limit| arm.clearance(&values, &scene, within(limit), &mut ConfigurationWorkspace::new());
            assert_eq!(near(value * 0.9).expect("values"), None);
            assert_eq!(near(value * 1.1).expect("values").map(|near| near.distance), Some(found.distance));
        }
    }
    assert!(kinds.iter().all(|kind| *kind > 2), "{kinds:?}");
}

#[test]
fn the_derivative_by_each_joint_is_that_of_differences() {
    let mut random = Numbers(Random(78));
    let (mut compared, mut own) = (Comparison::default(), 0);
    for _ in 0..60 {
        let (arm, values) = (random.arm::<DVec3>(), random.values::<DVec3>(3.0));
        let scene = random.scene::<DVec3>(12);
        let found = ask(&arm, &scene, &values);
        let mut gradient = [0.0; 6];
        arm.clearance_gradient(&values, &found, &mut gradient).expect("the same values");
        for joint in 0..6 {
            let moved = |t: f64| {
                let mut values = values;
                values[joint] += t;
                ask(&arm, &scene, &values)
            };
            // Where another pair is as near there is a kink.
            let step = 1e-4;
            let is_same = |t| moved(t).met == found.met && moved(t).link == found.link;
            if is_same(step) && is_same(-step) {
                let differences = central(|t| moved(t).distance.signed_distance, step);
                compared.add(gradient[joint], differences, &|| format!("joint {joint}: {found:?}"));
                own += usize::from(matches!(found.met, Met::Link { .. }) && gradient[joint] != 0.0);
            }
        }
    }
    compared.check();
    assert!(own > 20, "{own} of links against one another");
}

/// Poses in single precision are wrong by many roundings, of which the bounds know: they hold the distance of the same
/// numbers in double precision, also after many turns.
#[test]
fn bounds_hold_whatever_the_rounding_of_the_poses() {
    for seed in 0..40 {
        let reach = if seed % 2 == 0 { 3.0 } else { 300.0 };
        let known = |mut random: Numbers| {
            let (arm, scene) = (random.arm::<DVec3>(), random.scene::<DVec3>(12));
            ask(&arm, &scene, &random.values::<DVec3>(reach))
        };
        let found = |mut random: Numbers| {
            let (arm, scene) = (random.arm::<Vec3>(), random.scene::<Vec3>(12));
            let values = random.values::<Vec3>(reach);
            let mut workspace = ConfigurationWorkspace::new();
            let is_free = arm.is_free(&values, &scene, 0.0, &mut workspace).expect("values for its joints");
            (ask(&arm, &scene, &values), is_free)
        };
        let start = || Numbers(Random(1000 + seed));
        let (known, (found, is_free)) = (known(start()), found(start()));
        let truth = known.distance.signed_distance;
        assert!(f64::from(found.lower) <= truth && truth <= f64::from(found.upper), "{truth} {found:?}");
        let width = f64::from(found.upper - found.lower);
        assert!(width < 4e-6 * (100.0 + reach * reach), "{width} {found:?}");
        assert!(!is_free || truth > 0.0, "{known:?}");
    }
}

#[test]
fn frames_are_those_of_what_they_carry() {
    let mut random = Numbers(Random(79));
    let (arm, values) = (random.arm::<DVec3>(), random.values::<DVec3>(3.0));
    for joint in 0..7 {
        let (frame, body) = (arm.joint_frame(joint, &values), arm.placed(joint, 0, &values));
        let (frame, body) = (frame.expect("a joint"), body.expect("a body"));
        // A body's rotation is the nearest one.
        let off = frame.rotation - body.rotation();
        assert!((0..3).all(|i| off.col(i).length() <= frame.turn_error), "{frame:?}");
        assert_eq!(frame.translation, body.translation());
    }
    assert_eq!(arm.joint_frame(7, &values), Err(LinkageError::NoSuchFrame { joint: 7 }));
}

#[test]
fn what_is_wrong_with_a_table_or_a_question_is_said_by_its_index() {
    let joint = |parent| Joint { parent, pose: Pose::default(), kind: JointKind::Revolute(1.0) };
    let ball = || vec![Ball::<DVec2>::new(1.0).expect(VALID)];
    let on = |joint| Link { joint: Some(joint), bodies: ball() };
    let refused = |joints: &[Joint<DVec2>], links: Vec<_>| Linkage::new(joints.to_vec(), links).err();
    let circle = LinkageError::ParentNotBefore { joint: 0, parent: 1 };
    assert_eq!(refused(&[joint(Some(1)), joint(Some(0))], vec![on(0)]), Some(circle));
    let missing = LinkageError::NoSuchJoint { link: 1, joint: 2 };
    assert_eq!(refused(&[joint(None), joint(Some(0))], vec![on(1), on(2)]), Some(missing));
    let idle = LinkageError::CarriesNothing { joint: 1 };
    let robot = Linkage::new([joint(None), joint(Some(0))], [on(0)]).expect("joints in order");
    assert_eq!(robot.check_joints(), Err(idle));
    assert!(robot.to_string().contains("  joint 1 at (0, 0), turns about 1, value 1, carries nothing\n"), "{robot}");
    assert!(idle.to_string().starts_with("joint 1 moves, but no link"), "{idle}");
    let tool = Joint { kind: JointKind::Fixed, ..joint(Some(0)) };
    let robot = Linkage::new([joint(None), tool], [on(0)]).expect("joints in order");
    assert_eq!(robot.check_joints(), Ok(()), "a fixed joint may carry nothing");

    let (scene, mut workspace) = (Scene::<Ball<DVec2>>::default(), ConfigurationWorkspace::new());
    let alone = robot.clearance(&[0.0], &scene, SignedDistanceOptions::new(), &mut workspace);
    assert_eq!(alone, Ok(None));
    let count = LinkageError::Count { waypoint: 0, joints: 1, values: 2 };
    let many = robot.clearance(&[0.0; 2], &scene, SignedDistanceOptions::new(), &mut workspace);
    assert_eq!(many, Err(count));
    let nan = LinkageError::Value { waypoint: 0, value: 0 };
    assert_eq!(robot.is_free(&[f64::NAN], &scene, 0.0, &mut workspace), Err(nan));
    let option = LinkageError::Option(RayCastError::NonFinite { parameter: "target_distance", index: 0 });
    for target in [f64::NAN, f64::INFINITY] {
        let refused = robot.is_free(&[0.0], &scene, target, &mut workspace);
        assert!(matches!(refused, Err(LinkageError::Option(_))), "{refused:?}, such as {option:?}");
    }
}

#[test]
fn nothing_is_allocated_once_warm() {
    let mut random = Numbers(Random(80));
    let (arm, scene) = (random.arm::<DVec3>(), random.scene::<DVec3>(100));
    let all: Vec<_> = (0..20).map(|_| random.values::<DVec3>(3.0)).collect();
    let (mut workspace, mut gradient) = (ConfigurationWorkspace::new(), [0.0; 6]);
    let mut ask = || {
        for values in &all {
            let least = arm.clearance(values, &scene, SignedDistanceOptions::new(), &mut workspace).expect("values");
            arm.clearance_gradient(values, &least.expect("bodies"), &mut gradient).expect("values");
            let _ = std::hint::black_box(arm.is_free(values, &scene, 0.01, &mut workspace));
        }
    };
    let [cold, warm] = [(); 2].map(|()| measure(&mut ask).count_total);
    assert!(cold > 0 && warm == 0, "{cold} allocations, and then {warm}");
}
