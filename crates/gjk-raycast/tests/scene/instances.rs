//! A scene of instances answers as the scene in which every member is a body of its own, to the last bit.

use std::sync::Arc;

use convex_support::glam::{DQuat, DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{Ball, InvalidShape, Posed, Rotation as _, Scalar, SupportMap, bounding_box};
use gjk_raycast::{
    DistanceOptions, Group, HalfSpace, LinearCastOptions, Motion, MotionCastOptions, Pose, Ray, RayCastOptions,
    RigidMotion, Scene, SceneCast, SceneError, SignedDistanceOptions, StartInContact, Status,
};
use num_traits::Float as _;

use super::numbers::Numbers;
use super::worlds::{KINDS, Shape, body, place};
use crate::common::space::Space;

/// A shape that the scene of instances and the flat one share.
type Shared<V> = Arc<dyn SupportMap<Vector = V> + Send + Sync>;

/// Where each member is: its indices from the outside in.
type Path = Vec<usize>;

fn shared<V: Space>(numbers: &mut Numbers, kind: usize) -> Shared<V> {
    let shape: Shape<V> = body(numbers, kind, 1);
    Arc::from(shape)
}

fn posed<V: Space>(shape: &Shared<V>, pose: Pose<V>) -> Shared<V> {
    Arc::new(Posed::new(Arc::clone(shape), pose.rotation, pose.translation).expect("in the world"))
}

/// A pose in a world; some are exact.
fn pose<V: Space>(numbers: &mut Numbers, kind: usize) -> Pose<V> {
    let (size, mut pose) = place::<V>(numbers, kind, 1);
    match numbers.below(4) {
        0 => pose.rotation = V::Rotation::default(),
        1 => pose.translation = numbers.vector(size),
        _ => {}
    }
    if pose.rotation.checked("rotation").is_ok() { pose } else { Pose::default() }
}

/// The members of a group in its own frame, in their order.
type Members<V> = Vec<(Path, Shared<V>)>;

fn group<V: Space>(numbers: &mut Numbers, kind: usize, depth: usize) -> (Group<V>, Members<V>) {
    let mut members: Members<V> = (0..1 + numbers.below(8)).map(|index| (vec![index], shared(numbers, kind))).collect();
    let mut scene = Scene::new(members.iter().map(|(_, shape)| Arc::clone(shape))).expect("finite");
    if members.len() > 3 && numbers.below(2) == 0 {
        let index = numbers.below(members.len());
        scene.remove(index).expect("it is there");
        members.remove(index);
    }
    for _ in 0..if depth > 0 { 1 + numbers.below(3) } else { 0 } {
        let (inner, of_inner) = group(numbers, kind, depth - 1);
        let pose = pose(numbers, kind);
        let Ok(index) = scene.insert_group(&inner, pose) else { continue };
        members.extend(of_inner.iter().map(|(path, shape)| ([vec![index], path.clone()].concat(), posed(shape, pose))));
    }
    members.sort_by(|(p, _), (q, _)| p.cmp(q));
    let group = Group::new(scene).expect("there are members");
    assert_eq!(group.len(), members.len(), "as of the flat scene");
    (group, members)
}

struct World<V: Space> {
    scene: Scene<Shared<V>>,
    flat: Scene<Shared<V>>,
    /// The place in the scene of each body of the flat one.
    paths: Vec<Path>,
    /// The groups of the instances, by their index.
    groups: Vec<(usize, Members<V>)>,
    bodies: Vec<(usize, Shared<V>)>,
    half_spaces: Vec<(usize, HalfSpace<V>)>,
}

impl<V: Space> World<V> {
    fn new(numbers: &mut Numbers, kind: usize) -> Self {
        let groups: Vec<_> = (0..1 + numbers.below(2)).map(|depth| group(numbers, kind, depth)).collect();
        let mut world = Self {
            scene: Scene::default(),
            flat: Scene::default(),
            paths: Vec::new(),
            groups: Vec::new(),
            bodies: Vec::new(),
            half_spaces: Vec::new(),
        };
        for _ in 0..1 + numbers.below(6) {
            match numbers.below(5) {
                0 => {
                    let shape = shared(numbers, kind);
                    world.bodies.push((world.scene.insert(Arc::clone(&shape)).expect("finite"), shape));
                }
                1 if world.half_spaces.is_empty() => {
                    if let Ok(half_space) = HalfSpace::new(numbers.vector(1.0), V::Scalar::from_f64(-1.0)) {
                        world.half_spaces.push((world.scene.insert_half_space(half_space), half_space));
                    }
                }
                _ => {
                    let (group, members) = &groups[numbers.below(groups.len())];
                    let index = world.scene.insert_group(group, pose(numbers, kind)).expect("finite");
                    world.groups.push((index, members.clone()));
                }
            }
        }
        world.flatten();
        world
    }

    fn change(&mut self, numbers: &mut Numbers, kind: usize) {
        match numbers.below(3) {
            0 => self.scene.update_instances(|_, _| pose(numbers, kind)).expect("finite"),
            1 => {
                let Some((index, _)) = self.groups.pop() else { return };
                assert!(
                    self.scene.remove(index).is_none() && self.scene.remove_instance(index).is_some(),
                    "an instance is taken out as what it is"
                );
            }
            _ => {
                for (index, _) in &self.groups {
                    self.scene.place(*index, pose(numbers, kind)).expect("finite");
                }
            }
        }
        self.flatten();
    }

    fn flatten(&mut self) {
        enum Alone<V: Space> {
            Shape(Shared<V>),
            HalfSpace(HalfSpace<V>),
        }
        let mut all: Vec<(Path, Alone<V>)> = Vec::new();
        all.extend(self.bodies.iter().map(|(index, shape)| (vec![*index], Alone::Shape(Arc::clone(shape)))));
        all.extend(self.half_spaces.iter().map(|(index, half_space)| (vec![*index], Alone::HalfSpace(*half_space))));
        for (index, members) in &self.groups {
            let pose = self.scene.instance(*index).expect("an instance").pose();
            let moved = |(path, shape): &(Path, Shared<V>)| {
                ([vec![*index], path.clone()].concat(), Alone::Shape(posed(shape, pose)))
            };
            all.extend(members.iter().map(moved));
        }
        all.sort_by(|(p, _), (q, _)| p.cmp(q));
        (self.flat, self.paths) = (Scene::default(), Vec::new());
        for (path, alone) in all {
            match alone {
                Alone::Shape(shape) => self.flat.insert(shape).expect("finite"),
                Alone::HalfSpace(half_space) => self.flat.insert_half_space(half_space),
            };
            self.paths.push(path);
        }
    }

    /// The body of the flat scene.
    fn flat(&self, body: usize, member: Option<usize>) -> usize {
        let inner = member.map(|member| self.scene.instance(body).expect("an instance").group().path(member));
        let path = [vec![body], inner.unwrap_or_default()].concat();
        self.paths.binary_search(&path).expect("a member")
    }

    fn shape(&self, numbers: &mut Numbers, kind: usize) -> (f64, V, Shared<V>) {
        let shape = shared::<V>(numbers, kind);
        let near = self.flat.iter().nth(numbers.below(self.flat.len().max(1))).and_then(|(_, body)| body.convex());
        let Some(near) = near.map(bounding_box) else { return (1.0, V::ZERO, shape) };
        let size = near.half_extents().max_element().as_f64().max(V::Scalar::min_positive_value().as_f64() * 1e6);
        let reach = size * [0.5, 3.0, 20.0][numbers.below(3)];
        (size, near.center() + numbers.vector(reach), shape)
    }

    /// Both are the same. If brackets stay open, the box of a member in its group may prove more than the one in the
    /// world.
    fn first<H: Copy + PartialEq + std::fmt::Debug>(&self, casts: [SceneCast<H, V::Scalar>; 2], is_open: bool) {
        let [ours, flat] = casts;
        assert_eq!(ours.work.tested + ours.work.culled, self.flat.len(), "every member is one or the other");
        assert!(ours.lower >= flat.lower, "the greatest that is known");
        let answer = |first: &gjk_raycast::BodyHit<H, V::Scalar>| (first.hit, first.lower, first.upper, first.status);
        let found = ours.first.as_ref().map(|first| (self.flat(first.body, first.member), answer(first)));
        let due = flat.first.as_ref().map(|first| (first.body, answer(first)));
        let is_open = is_open || !flat.is_certain() || flat.first.is_some_and(|it| it.status != Status::Converged);
        if !is_open {
            assert_eq!(found, due, "as of the flat scene");
            assert_eq!(ours.lower, flat.lower, "as of the flat scene");
            assert_eq!(ours.undecided, flat.undecided.map(|body| self.paths[body][0]), "{casts:?} {:?}", self.paths);
        }
    }

    fn ask(&self, numbers: &mut Numbers, kind: usize) -> usize {
        let (size, source, shape) = self.shape(numbers, kind);
        let (_, goal, _) = self.shape(numbers, kind);
        let direction = if goal == source { V::axis(0) } else { goal - source };
        let (ours, flat) = (self.scene.all(), self.flat.all());

        let ray = Ray { source, direction };
        let mut options = RayCastOptions::default();
        match numbers.below(4) {
            0 => options.max_lambda = V::Scalar::from_f64(0.9),
            // Brackets that stay open.
            1 => options.max_iterations = 1 + numbers.below(6),
            _ => {}
        }
        let is_open = options.max_iterations < 9;
        self.first([ours, flat].map(|all| all.ray_cast(ray, options).expect("a good ray")), is_open);
        let any = |any: gjk_raycast::SceneAnyHit| any.hit;
        let hit = [ours, flat].map(|all| any(all.any_hit(ray, options).expect("a good ray")));
        assert!(hit[0] == hit[1] || is_open, "as of the flat scene");
        let (mut hits, mut of_flat) = (Vec::new(), Vec::new());
        let _ = ours.ray_cast_all(ray, options, &mut hits).expect("a good ray");
        let _ = flat.ray_cast_all(ray, options, &mut of_flat).expect("a good ray");
        let found: Vec<_> = hits.iter().map(|hit| (self.flat(hit.body, hit.member), hit.hit, hit.upper)).collect();
        let due: Vec<_> = of_flat.iter().map(|hit| (hit.body, hit.hit, hit.upper)).collect();
        assert!(found == due || is_open && found.iter().all(|hit| due.contains(hit)), "{found:?} {due:?}");
        let spread = direction.norm().as_f64() * [0.0, 0.05, 0.5][numbers.below(3)];
        let rays: [_; 11] =
            core::array::from_fn(|_| Ray { source, direction: direction + numbers.vector::<V>(spread) });
        if rays.iter().all(|ray| ray.direction != V::ZERO) {
            let mut casts = [SceneCast::default(); 11];
            ours.ray_casts_into(&rays, options, &mut casts).expect("good rays");
            for (&ray, cast) in rays.iter().zip(&casts) {
                self.first([*cast, flat.ray_cast(ray, options).expect("a good ray")], is_open);
            }
        }

        let motion = Motion { velocity_a: goal - bounding_box(&shape).center(), velocity_b: V::ZERO };
        let mut options = LinearCastOptions::default();
        match numbers.below(4) {
            0 => options.target_distance = V::Scalar::from_f64(size * 0.1),
            1 => options.start_in_contact = StartInContact::IfDeeper,
            2 => options.max_iterations = numbers.below(6),
            _ => {}
        }
        let is_open = options.max_iterations < 9;
        self.first([ours, flat].map(|all| all.linear_cast(&shape, motion, options).expect("a good motion")), is_open);
        let (mut hits, mut of_flat) = (Vec::new(), Vec::new());
        let _ = ours.linear_cast_all(&shape, motion, options, &mut hits).expect("a good motion");
        let _ = flat.linear_cast_all(&shape, motion, options, &mut of_flat).expect("a good motion");
        let found: Vec<_> = hits.iter().map(|hit| (self.flat(hit.body, hit.member), hit.hit, hit.upper)).collect();
        let due: Vec<_> = of_flat.iter().map(|hit| (hit.body, hit.hit, hit.upper)).collect();
        assert!(found == due || is_open && found.iter().all(|hit| due.contains(hit)), "{found:?} {due:?}");

        let turned = V::Rotation::from_xyzw([0; 4].map(|_| V::Scalar::from_f64(numbers.signed())));
        let angular_velocity = convex_support::AngularVelocity::between(V::Rotation::default(), turned);
        let motion = RigidMotion { velocity: motion.velocity_a, angular_velocity, center: source };
        let options = MotionCastOptions::default().with_max_time(V::Scalar::from_f64(1.0));
        self.first([ours, flat].map(|all| all.motion_cast(&shape, motion, options).expect("a good motion")), false);
        let of_bodies = RigidMotion { velocity: numbers.vector(size), ..motion };
        let casts =
            [ours, flat].map(|all| all.motion_cast_of_both(&shape, motion, of_bodies, options).expect("a good motion"));
        self.first(casts, false);

        self.distances(numbers, size, &shape);
        self.pairs(numbers, size);
        self.nearest_pairs(numbers, size);
        self.moving_pairs(numbers, size);
        23
    }

    fn distances(&self, numbers: &mut Numbers, size: f64, shape: &Shared<V>) {
        let (ours, flat) = (self.scene.all(), self.flat.all());
        let near = if numbers.below(2) == 0 { f64::INFINITY } else { size * numbers.unit() };
        let options = DistanceOptions::default().with_limit(V::Scalar::from_f64(near));
        let [a, b] = [ours, flat].map(|all| all.nearest(shape, options));
        let found = a.nearest.map(|near| (self.flat(near.body, near.member), near.distance));
        assert_eq!(found, b.nearest.map(|near| (near.body, near.distance)), "as of the flat scene");
        assert!(
            a.lower >= b.lower && a.nearest.is_none_or(|near| a.lower <= near.distance.distance),
            "the greatest that is known"
        );
        let within = V::Scalar::from_f64(size * numbers.unit() * 3.0);
        let mut found = Vec::new();
        let work = ours.nearest_k(shape, 5, options, &mut found);
        assert_eq!(work.tested + work.culled, self.flat.len(), "every member is one or the other");
        let of_flat = |near: &[gjk_raycast::BodyDistance<V>]| {
            near.iter().map(|near| (near.body, near.distance)).collect::<Vec<_>>()
        };
        let named = |near: &[gjk_raycast::BodyDistance<V>]| {
            near.iter().map(|near| (self.flat(near.body, near.member), near.distance)).collect::<Vec<_>>()
        };
        let mut others = Vec::new();
        flat.nearest_k(shape, 5, options, &mut others);
        assert_eq!(named(&found), of_flat(&others), "as of the flat scene");
        let work = ours.all_within(shape, within, DistanceOptions::default(), &mut found);
        flat.all_within(shape, within, DistanceOptions::default(), &mut others);
        assert_eq!(named(&found), of_flat(&others), "as of the flat scene");
        assert_eq!(work.tested + work.culled, self.flat.len(), "every member is one or the other");
        let options = SignedDistanceOptions::default();
        let [a, b] = [ours, flat].map(|all| all.least_signed_distance(shape, options));
        let found = a.least.map(|least| (self.flat(least.body, least.member), least.distance));
        assert_eq!(found, b.least.map(|least| (least.body, least.distance)), "as of the flat scene");
        assert!(
            a.lower >= b.lower && a.least.is_none_or(|least| a.lower <= least.distance.signed_distance),
            "the greatest that is known"
        );
        // A layer.
        let even = |body: usize| body.is_multiple_of(2);
        let even_path = |body: usize| even(self.paths[body][0]);
        let a = self.scene.among(&even).nearest(shape, DistanceOptions::default());
        let b = self.flat.among(&even_path).nearest(shape, DistanceOptions::default());
        let found = a.nearest.map(|near| (self.flat(near.body, near.member), near.distance));
        assert_eq!(found, b.nearest.map(|near| (near.body, near.distance)), "as of the flat scene");

        let (mut contacts, mut of_flat) = (Vec::new(), Vec::new());
        ours.contacts_of(shape, within, options, &mut contacts);
        flat.contacts_of(shape, within, options, &mut of_flat);
        let named = contacts.iter().map(|found| (self.flat(found.body, found.member), found.contact));
        assert_eq!(
            named.collect::<Vec<_>>(),
            of_flat.iter().map(|it| (it.body, it.contact)).collect::<Vec<_>>(),
            "as of the flat scene"
        );
        assert_eq!(
            self.scene.leave_out_seams(&mut contacts),
            self.flat.leave_out_seams(&mut of_flat),
            "as of the flat scene"
        );
        // The member by itself has the same answer.
        if let Some(found) = contacts.iter().find(|found| found.member.is_some()) {
            let member = self.scene.member(found.body, found.member.expect("a member")).expect("it was found");
            assert_eq!(
                gjk_raycast::contact(shape, &member, within, options),
                Some(found.contact),
                "as of the flat scene"
            );
        }
    }

    fn nearest_pairs(&self, numbers: &mut Numbers, size: f64) {
        let (ours, flat) = (self.scene.all(), self.flat.all());
        let of_one = |a: usize, b: usize| self.paths[a][0] == self.paths[b][0];
        let apart = flat.without_pairs(&of_one);
        let near = if numbers.below(2) == 0 { f64::INFINITY } else { size * numbers.unit() };
        let options = DistanceOptions::default().with_limit(V::Scalar::from_f64(near));
        let [a, b] = [ours.least_pair(options), apart.least_pair(options)];
        let named =
            |p: gjk_raycast::PairDistance<V>| (self.flat(p.a, p.member_a), self.flat(p.b, p.member_b), p.distance);
        assert_eq!(a.nearest.map(named), b.nearest.map(|p| (p.a, p.b, p.distance)), "as in the flat scene");
        assert!(
            a.lower >= b.lower && a.nearest.is_none_or(|pair| a.lower <= pair.distance.distance),
            "as in the flat scene"
        );
        assert_eq!(
            a.work.tested + a.work.culled,
            b.work.tested + b.work.culled - self.pairs_of_one(),
            "as in the flat scene"
        );
        let within = V::Scalar::from_f64(size * numbers.unit());
        let [a, b] = [ours, apart].map(|all| all.any_pair_within(within, DistanceOptions::default()));
        assert_eq!((a.any, a.is_certain()), (b.any, b.is_certain()), "as in the flat scene");
        let (shape, all) = (self.shape(numbers, 0).2, DistanceOptions::default());
        assert_eq!(
            ours.any_within(&shape, within, all).any,
            flat.any_within(&shape, within, all).any,
            "as in the flat scene"
        );
        // Some bodies of one scene, and all of the other.
        let even = |body: usize| body.is_multiple_of(2);
        let even_path = |body: usize| even(self.paths[body][0]);
        let a = self.scene.among(&even).nearest_between(&self.flat, options);
        let b = self.flat.among(&even_path).nearest_between(&self.flat, options);
        let named = |p: gjk_raycast::PairDistance<V>| (self.flat(p.a, p.member_a), p.b, p.distance);
        assert_eq!(a.nearest.map(named), b.nearest.map(|p| (p.a, p.b, p.distance)), "as in the flat scene");
        let a = self.flat.among(&even_path).nearest_between(&self.scene, options);
        let named = |p: gjk_raycast::PairDistance<V>| (p.a, self.flat(p.b, p.member_b), p.distance);
        assert_eq!(a.nearest.map(named), b.nearest.map(|p| (p.a, p.b, p.distance)), "as in the flat scene");
    }

    /// The number of pairs of members of one body.
    fn pairs_of_one(&self) -> usize {
        self.groups.iter().map(|(_, members)| members.len() * (members.len() - 1) / 2).sum()
    }

    fn moving_pairs(&self, numbers: &mut Numbers, size: f64) {
        let count = 1 + self.paths.iter().map(|path| path[0]).max().unwrap_or(0);
        let motions: Vec<_> = (0..count)
            .map(|_| {
                let turned = V::Rotation::from_xyzw([0; 4].map(|_| V::Scalar::from_f64(numbers.signed())));
                let angular_velocity = match numbers.below(2) {
                    0 => convex_support::AngularVelocity::between(V::Rotation::default(), turned),
                    _ => Default::default(),
                };
                RigidMotion { velocity: numbers.vector(2.0 * size), angular_velocity, center: numbers.vector(size) }
            })
            .collect();
        let (ours, flat) = (self.scene.all(), self.flat.all());
        let of_one = |a: usize, b: usize| self.paths[a][0] == self.paths[b][0];
        let flat = flat.without_pairs(&of_one);
        let (of_body, of_member) = (|body: usize| motions[body], |body: usize| motions[self.paths[body][0]]);
        let step = MotionCastOptions::default().with_max_time(V::Scalar::from_f64(1.0));
        let (mut found, mut due) = (Vec::new(), Vec::new());
        let a = ours.first_contacts(&of_body, step, &mut found).expect("good motions");
        let b = flat.first_contacts(&of_member, step, &mut due).expect("good motions");
        let named = |p: &gjk_raycast::PairImpact<V>| {
            (self.flat(p.a, p.member_a), self.flat(p.b, p.member_b), p.impact, p.lower, p.upper)
        };
        let own = |p: &gjk_raycast::PairImpact<V>| (p.a, p.b, p.impact, p.lower, p.upper);
        assert_eq!(
            found.iter().map(named).collect::<Vec<_>>(),
            due.iter().map(own).collect::<Vec<_>>(),
            "as in the flat scene"
        );
        assert_eq!(a.first.as_ref().map(named), b.first.as_ref().map(own), "as in the flat scene");
        let a = ours.first_contact(&of_body, step).expect("good motions");
        assert_eq!(a.first.as_ref().map(named), b.first.as_ref().map(own), "as in the flat scene");
        let motions = [&of_member as _, &of_body as _];
        let _ = self.flat.all().first_contacts_between(&self.scene, motions, step, &mut found).expect("good motions");
        let named = |p: &gjk_raycast::PairImpact<V>| (p.a, self.flat(p.b, p.member_b), p.impact, p.lower, p.upper);
        let kept = found.iter().map(named).filter(|&(a, b, ..)| a < b && !of_one(a, b));
        assert_eq!(kept.collect::<Vec<_>>(), due.iter().map(own).collect::<Vec<_>>(), "as in the flat scene");
    }

    fn pairs(&self, numbers: &mut Numbers, size: f64) {
        let (ours, flat) = (self.scene.all(), self.flat.all());
        let within = V::Scalar::from_f64(size * [0.0, 0.1, 1.0][numbers.below(3)]);
        // Members of one body make no pairs.
        let of_one = |a: usize, b: usize| self.paths[a][0] == self.paths[b][0];
        let flat = flat.without_pairs(&of_one);
        let (mut pairs, mut of_flat) = (Vec::new(), Vec::new());
        let work = ours.pairs_within(within, DistanceOptions::default(), &mut pairs);
        flat.pairs_within(within, DistanceOptions::default(), &mut of_flat);
        let named = pairs.iter().map(|p| (self.flat(p.a, p.member_a), self.flat(p.b, p.member_b), p.distance));
        assert_eq!(
            named.collect::<Vec<_>>(),
            of_flat.iter().map(|p| (p.a, p.b, p.distance)).collect::<Vec<_>>(),
            "as of the flat scene"
        );
        let mut all = 0;
        for (a, first) in self.flat.iter() {
            let rest = self.flat.iter().filter(|&(b, _)| b > a && !of_one(a, b));
            all += rest.filter(|(_, b)| first.convex().is_some() || b.convex().is_some()).count();
        }
        assert_eq!(work.tested + work.culled, all, "every pair of members is one or the other");
        // With the members as bodies of another scene, on either side.
        let mut between = Vec::new();
        self.flat.all().pairs_between(&self.scene, within, DistanceOptions::default(), &mut between);
        let ab = |p: &gjk_raycast::PairDistance<V>| (p.a, self.flat(p.b, p.member_b), p.distance);
        let kept = between.iter().map(ab).filter(|&(a, b, _)| a < b && !of_one(a, b));
        assert_eq!(
            kept.collect::<Vec<_>>(),
            of_flat.iter().map(|p| (p.a, p.b, p.distance)).collect::<Vec<_>>(),
            "as of the flat scene"
        );
        ours.pairs_between(&self.flat, within, DistanceOptions::default(), &mut between);
        let ab = |p: &gjk_raycast::PairDistance<V>| (self.flat(p.a, p.member_a), p.b, p.distance);
        let kept = between.iter().map(ab).filter(|&(a, b, _)| a < b && !of_one(a, b));
        assert_eq!(
            kept.collect::<Vec<_>>(),
            of_flat.iter().map(|p| (p.a, p.b, p.distance)).collect::<Vec<_>>(),
            "as of the flat scene"
        );

        let options = SignedDistanceOptions::default();
        let (mut contacts, mut of_flat) = (Vec::new(), Vec::new());
        ours.contacts_within(within, options, &mut contacts);
        flat.contacts_within(within, options, &mut of_flat);
        let named = contacts.iter().map(|p| (self.flat(p.a, p.member_a), self.flat(p.b, p.member_b), p.contact));
        assert_eq!(
            named.collect::<Vec<_>>(),
            of_flat.iter().map(|p| (p.a, p.b, p.contact)).collect::<Vec<_>>(),
            "as of the flat scene"
        );
        // The next step knows the last.
        let (mut next, mut next_of_flat) = (Vec::new(), Vec::new());
        ours.after(&contacts).contacts_within(within, options, &mut next);
        flat.after(&of_flat).contacts_within(within, options, &mut next_of_flat);
        let contact = |found: &gjk_raycast::PairContact<V>| found.contact;
        assert_eq!(
            next.iter().map(contact).collect::<Vec<_>>(),
            next_of_flat.iter().map(contact).collect::<Vec<_>>(),
            "as of the flat scene"
        );
        #[cfg(feature = "rayon")]
        {
            let (mut parallel, mut parallel_contacts) = (Vec::new(), Vec::new());
            ours.par_pairs_within(within, DistanceOptions::default(), &mut parallel);
            ours.par_contacts_within(within, options, &mut parallel_contacts);
            assert_eq!((parallel, parallel_contacts), (pairs, contacts.clone()), "on all threads");
        }
        let left_out = self.scene.leave_out_seams_of_pairs(&mut contacts);
        assert_eq!(left_out, self.flat.leave_out_seams_of_pairs(&mut of_flat), "as of the flat scene");
    }
}

/// How many questions are asked in all, unless `SCENE_QUESTIONS` says another number.
fn random_scenes<V: Space>(seed: u64) {
    let wanted = std::env::var("SCENE_QUESTIONS").ok().and_then(|n| n.parse().ok()).unwrap_or(12_000) / 10;
    let (mut numbers, mut questions) = (Numbers(seed), 0);
    while questions < wanted {
        for kind in 0..KINDS {
            let mut world = World::<V>::new(&mut numbers, kind);
            for _ in 0..3 {
                questions += world.ask(&mut numbers, kind);
                world.change(&mut numbers, kind);
            }
        }
    }
}

#[test]
fn solid_double() {
    random_scenes::<DVec3>(11);
}

#[test]
fn planar_double() {
    random_scenes::<DVec2>(12);
}

#[test]
fn solid_single() {
    random_scenes::<Vec3>(13);
}

#[test]
fn solid_single_aligned() {
    random_scenes::<Vec3A>(14);
}

#[test]
fn planar_single() {
    random_scenes::<Vec2>(15);
}

fn ball(x: f64) -> Posed<Ball<DVec3>> {
    Posed::translated(Ball::new(0.5).expect("a radius"), DVec3::X * x).expect("finite")
}

#[test]
fn what_cannot_be_a_group_or_a_place_is_said() {
    let none = Scene::<Ball<DVec3>>::default();
    assert_eq!(Group::new(none).err(), Some(SceneError::EmptyGroup), "nothing to move");
    let mesh = Scene::mesh(&[DVec3::ZERO], &[[0_u32; 3]; 0]).expect("an empty scene");
    assert_eq!(Group::new(mesh).err(), Some(SceneError::EmptyGroup), "a mesh of no triangles");
    let mut floor = Scene::new([ball(0.0)]).expect("finite");
    floor.insert_half_space(HalfSpace::new(DVec3::Y, 0.0).expect("a normal"));
    assert_eq!(Group::new(floor).err(), Some(SceneError::UnboundedMember { member: 1 }));

    let group = Group::new(Scene::new([ball(0.0)]).expect("finite")).expect("one member");
    let mut scene = Scene::new([ball(9.0)]).expect("finite");
    let at = |rotation, translation| Pose { rotation, translation };
    let bad = at(DQuat::IDENTITY, DVec3::new(0.0, f64::NAN, 0.0));
    let why = InvalidShape::NonFinite { parameter: "translation", index: 1 };
    assert_eq!(scene.insert_group(&group, bad), Err(SceneError::NoPose { body: 1, why }));
    let bad = at(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), DVec3::ZERO);
    let refused = SceneError::NoPose { body: 1, why: InvalidShape::ZeroRotation };
    assert_eq!(scene.insert_group(&group, bad), Err(refused));
    let far = at(DQuat::IDENTITY, DVec3::splat(1e308));
    assert_eq!(scene.insert_group(&group, far), Err(SceneError::NotFinite { body: 1 }));
    assert_eq!(scene.place(0, Pose::default()), Err(SceneError::NoSuchInstance { body: 0 }), "a ball has no pose");
    let instance = scene.insert_group(&group, Pose::default()).expect("a pose");
    assert_eq!(scene.place(instance, far), Err(SceneError::NotFinite { body: 1 }));
    assert_eq!(scene.instance(instance).map(|it| it.pose()), Some(Pose::default()), "it stays where it was");
    assert_eq!(scene.update_instances(|_, _| bad), Err(refused));
    assert!(scene.member(instance, 0).is_some() && scene.member(instance, 1).is_none());
    assert_eq!((group.path(0), group.path(1)), (vec![0], vec![]));
}

#[test]
fn groups_are_nested_so_deep_and_no_deeper() {
    let mut group = Group::new(Scene::new([ball(0.0)]).expect("finite")).expect("one member");
    let shift = Pose { rotation: DQuat::IDENTITY, translation: DVec3::X };
    for _ in 1..16 {
        let mut scene = Scene::<Ball<DVec3>>::default();
        scene.insert_group(&group, shift).expect("a pose");
        group = Group::new(scene).expect("not too deep");
    }
    let mut scene = Scene::<Ball<DVec3>>::default();
    scene.insert_group(&group, shift).expect("a pose");
    assert_eq!(group.path(0), vec![0; 16]);
    let ray = Ray { source: DVec3::ZERO, direction: DVec3::X };
    let first = scene.ray_cast(ray, RayCastOptions::default()).expect("a good ray").first.expect("it is ahead");
    assert_eq!((first.body, first.member, first.hit.lambda), (0, Some(0), 15.5));
    assert_eq!(Group::new(scene).err(), Some(SceneError::TooDeep));
}

#[test]
fn a_question_that_is_stopped_says_so_within_an_instance() {
    let group = Group::new(Scene::new((0..9).map(|i| ball(f64::from(i)))).expect("finite")).expect("members");
    let mut scene = Scene::<Ball<DVec3>>::default();
    scene.insert_group(&group, Pose::default()).expect("a pose");
    let asked = std::sync::atomic::AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) == 3;
    let mut near = Vec::new();
    let work = scene.all().until(&stop).all_within(&ball(4.0), 99.0, DistanceOptions::default(), &mut near);
    assert_eq!((near.len(), work.tested, work.culled, work.cancelled), (3, 3, 6, true));
}
