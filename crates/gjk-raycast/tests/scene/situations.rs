//! What can happen to a scene.

use std::cell::Cell;
use std::sync::atomic::{AtomicUsize, Ordering};

use convex_support::glam::{DQuat, DVec2, DVec3};
use convex_support::{Ball, Capsule, Cuboid, Cylinder, Point, Posed, SupportMap, Triangle};
use gjk_raycast::{
    BodyContact, ChainMotion, Contact, DistanceOptions, HalfSpace, LinearCastOptions, Motion, MotionCastOptions,
    PairContact, Ray, RayCastError, RayCastOptions, RigidMotion, Scene, SceneCast, SceneError, contact, distance,
};

fn ball(x: f64) -> Posed<Ball<DVec3>> {
    Posed::translated(Ball::new(0.5).unwrap(), DVec3::X * x).unwrap()
}

fn along_x() -> Ray<DVec3> {
    Ray { source: DVec3::X * -5.0, direction: DVec3::X }
}

#[test]
fn an_empty_scene_answers() {
    let mut scene = Scene::<Ball<DVec3>>::default();
    let cast = scene.all().ray_cast(along_x(), RayCastOptions::default()).unwrap();
    assert_eq!((cast.first, cast.lower, cast.work.tested), (None, f64::INFINITY, 0), "nothing is in the way");
    let bad = Ray { source: DVec3::ZERO, direction: DVec3::ZERO };
    assert_eq!(
        scene.all().ray_cast(bad, RayCastOptions::default()).unwrap_err(),
        RayCastError::ZeroDirection,
        "though empty"
    );
    let point = Point::new(DVec3::ZERO).unwrap();
    assert_eq!(scene.all().nearest(&point, DistanceOptions::default()).nearest, None, "nothing is near");
    let mut pairs = Vec::new();
    assert_eq!(scene.all().pairs_within(1.0, DistanceOptions::default(), &mut pairs).tested, 0, "no pairs");
    assert_eq!(scene.remove(0), None, "nothing to remove");
    assert_eq!(scene.insert(Ball::new(1.0).unwrap()), Ok(0), "the first");
    assert_eq!(
        scene.all().ray_cast(along_x(), RayCastOptions::default()).unwrap().first.unwrap().hit.lambda,
        4.0,
        "and hit"
    );
}

/// A support map that is none.
#[derive(Clone, Copy, Debug)]
struct Broken(f64);

impl SupportMap for Broken {
    type Vector = DVec2;

    fn support(&self, _: DVec2) -> DVec2 {
        DVec2::splat(self.0)
    }
}

#[test]
fn bodies_that_are_none_are_refused_by_index() {
    let refused = Scene::new([Broken(1.0), Broken(f64::NAN), Broken(f64::INFINITY)]).unwrap_err();
    assert_eq!(refused, SceneError::NotFinite { body: 1 }, "the first that is none");
    let mut scene = Scene::new([Broken(1.0), Broken(2.0), Broken(3.0)]).unwrap();
    assert_eq!(scene.insert(Broken(f64::INFINITY)), Err(SceneError::NotFinite { body: 3 }), "the index it would have");
    assert_eq!(scene.replace(1, Broken(f64::NAN)).unwrap_err(), SceneError::NotFinite { body: 1 }, "replaced by none");
    assert_eq!(scene.replace(7, Broken(0.0)).unwrap_err(), SceneError::NoSuchBody { body: 7 }, "there is none");
    let moved = scene.update(|index, &Broken(x)| Broken(if index == 1 { f64::NAN } else { x + 10.0 }));
    assert_eq!(moved, Err(SceneError::NotFinite { body: 1 }), "one did not move");
    let nearest = |x| {
        let point = Point::new(DVec2::splat(x)).unwrap();
        scene.all().nearest(&point, DistanceOptions::default()).nearest.map(|n| (n.body, n.distance.distance))
    };
    assert_eq!([nearest(2.0), nearest(11.0), nearest(13.0)], [1, 0, 2].map(|i| Some((i, 0.0))), "the others did");
    // One that becomes none inside the scene: single queries of it are undecided, and nothing panics.
    let shape = Broken(f64::NAN);
    let _ = scene.all().nearest(&shape, DistanceOptions::default());
    let motion = Motion { velocity_a: DVec2::X, velocity_b: DVec2::ZERO };
    let _ = scene.all().linear_cast(&shape, motion, LinearCastOptions::default());
}

#[test]
fn indices_are_kept_and_given_again() {
    let mut scene = Scene::new([ball(0.0), ball(2.0), ball(4.0)]).unwrap();
    assert!(scene.remove(1).is_some() && scene.remove(1).is_none(), "once");
    assert_eq!((scene.len(), scene.iter().map(|(i, _)| i).collect::<Vec<_>>()), (2, vec![0, 2]), "the others stay");
    assert_eq!((scene.insert(ball(6.0)), scene.insert(ball(8.0))), (Ok(1), Ok(3)), "the free one first");
    let first = scene
        .all()
        .ray_cast(Ray { source: DVec3::X * 10.0, direction: DVec3::NEG_X }, RayCastOptions::default())
        .unwrap();
    assert_eq!(first.first.unwrap().body, 3, "the last one comes first from there");
}

#[test]
fn of_equals_the_lowest_index_whatever_the_order() {
    let mut scene = Scene::new((0..50).map(|_| ball(0.0))).unwrap();
    scene.remove(0);
    let first = scene.all().ray_cast(along_x(), RayCastOptions::default()).unwrap().first.unwrap();
    let nearest = scene.all().nearest(&ball(3.0), DistanceOptions::default()).nearest.unwrap();
    assert_eq!((first.body, nearest.body), (1, 1), "the lowest that is there");
    scene.insert(ball(0.0)).unwrap();
    let first = scene.all().ray_cast(along_x(), RayCastOptions::default()).unwrap().first.unwrap();
    assert_eq!(first.body, 0, "it is back, though last in the tree");
}

#[test]
fn of_equal_pairs_the_lowest_indices_whatever_the_order() {
    let row = || Scene::new((0..40).map(|i| ball(2.0 * f64::from(i)))).unwrap();
    let (mut scene, other) = (row(), row());
    let options = DistanceOptions::default();
    let pair =
        |answer: gjk_raycast::ScenePair<DVec3>| answer.nearest.map(|near| (near.a, near.b, near.distance.distance));
    assert_eq!(pair(scene.all().least_pair(options)), Some((0, 1, 1.0)), "of equal gaps");
    assert_eq!(pair(scene.all().nearest_between(&other, options)), Some((0, 0, 0.0)), "of equal overlaps");
    scene.remove(0);
    assert_eq!(pair(scene.all().least_pair(options)), Some((1, 2, 1.0)), "of those that are left");
    scene.insert(ball(500.0)).unwrap();
    assert_eq!(pair(scene.all().nearest_between(&other, options)), Some((1, 1, 0.0)), "another one is 0");
    // They all close up at the same time.
    let motion = |body: usize| RigidMotion::translation(DVec3::X * if body.is_multiple_of(2) { 0.25 } else { -0.25 });
    let first = scene.all().first_contact(&motion, MotionCastOptions::new().with_max_time(9.0)).unwrap();
    assert_eq!(first.first.map(|first| (first.a, first.b, first.impact.time)), Some((2, 3, 2.0)), "of equal times");
    assert!(first.work.tested < 40, "neighbours alone are cast");
    // Nothing, and one body.
    let empty = Scene::<Posed<Ball<DVec3>>>::default();
    let one = Scene::new([ball(0.0)]).unwrap();
    assert_eq!((pair(empty.all().least_pair(options)), pair(one.all().least_pair(options))), (None, None), "no pair");
    assert_eq!(pair(one.all().nearest_between(&empty, options)), None, "nor with none");
    assert_eq!(empty.all().least_pair(options).lower, f64::INFINITY, "nothing is near");
    assert!(
        !one.all().any_pair_within(9.0, options).any && !empty.all().any_within(&ball(0.0), 9.0, options).any,
        "none"
    );
    assert_eq!(one.all().first_contact(&motion, MotionCastOptions::new()).unwrap().first, None, "meets nobody");
}

#[test]
fn a_motion_that_is_none_is_refused() {
    let scene = Scene::new([ball(0.0), ball(900.0)]).unwrap();
    let motion = |body: usize| RigidMotion::translation(DVec3::X * if body == 0 { 0.0 } else { f64::NAN });
    let refused = scene.all().first_contact(&motion, MotionCastOptions::new().with_max_time(1.0));
    assert_eq!(refused.unwrap_err(), RayCastError::NonFinite { parameter: "motion", index: 0 }, "the second");
    let endless = MotionCastOptions::new().with_max_time(f64::NAN);
    assert!(scene.all().first_contact(&|_| RigidMotion::default(), endless).is_err(), "no end");
}

/// Of rays that share a search, some hit a near ball, and others only a far one, which the search has to reach.
#[test]
fn rays_side_by_side_share_a_search_and_no_hit() {
    let places = std::iter::once([3.0, 0.0]).chain((0..40).map(|i| [40.0, 2.0 * f64::from(i)]));
    let at = |[x, y]: [f64; 2]| Posed::translated(Ball::new(0.5).expect("a ball"), DVec3::new(x, y, 0.0));
    let scene = Scene::new(places.map(|place| at(place).expect("a place"))).expect("bodies");
    let rays: Vec<_> = (0..24)
        .map(|k| DVec3::new(1.0, 0.01 + 0.02 * f64::from(k), 0.01))
        .map(|direction| Ray { source: DVec3::NEG_Y * 0.2, direction })
        .collect();
    let mut casts = vec![SceneCast::default(); rays.len()];
    scene.all().ray_casts_into(&rays, RayCastOptions::default(), &mut casts).expect("rays");
    let alone = |&ray| scene.ray_cast(ray, RayCastOptions::default()).expect("a ray");
    let first: Vec<_> = casts.iter().map(|cast| cast.first).collect();
    assert_eq!(first, rays.iter().map(|ray| alone(ray).first).collect::<Vec<_>>(), "each as alone");
    let (near, far) = (&first[0], first[8..].iter().flatten().any(|hit| hit.hit.lambda > 39.0));
    assert!(near.is_some_and(|hit| hit.hit.lambda < 3.0) && far, "both are hit: {first:?}");
    for bundle in casts.chunks(8) {
        assert!(bundle.iter().all(|cast| cast.work.nodes == bundle[0].work.nodes), "one search: {bundle:?}");
    }
    assert!(rays.iter().zip(&casts).any(|(ray, cast)| cast.work.nodes != alone(ray).work.nodes), "of all");
}

#[test]
fn half_spaces_have_no_end() {
    let mut scene = Scene::new([ball(0.0)]).unwrap();
    let floor = scene.insert_half_space(HalfSpace::new(DVec3::Y * 2.0, -2.0).unwrap()); // y ≤ −1
    let down = Ray { source: DVec3::new(1e12, 5.0, -1e12), direction: DVec3::NEG_Y };
    let cast = scene.all().ray_cast(down, RayCastOptions::default()).unwrap();
    let first = cast.first.unwrap();
    assert_eq!((first.body, first.hit.lambda, first.hit.normal), (floor, 6.0, Some(DVec3::Y)), "far out");
    assert!(cast.lower <= 6.0 && first.upper >= 6.0, "{first:?}");
    let fall = Motion { velocity_a: DVec3::NEG_Y, velocity_b: DVec3::ZERO };
    let landed = scene.all().linear_cast(&ball(7.0), fall, LinearCastOptions::default()).unwrap().first.unwrap();
    assert_eq!(
        (landed.body, landed.hit.time, landed.hit.point),
        (floor, 0.5, DVec3::new(7.0, -1.0, 0.0)),
        "on the floor"
    );
    let mut pairs = Vec::new();
    scene.all().pairs_within(0.5, DistanceOptions::default(), &mut pairs);
    assert_eq!(pairs.len(), 1, "the ball is 0.5 above the floor");
    assert_eq!((pairs[0].a, pairs[0].b, pairs[0].distance.normal), (0, floor, Some(DVec3::Y)), "{:?}", pairs[0]);
    let below = scene.all().nearest(&Point::new(DVec3::Y * -3.0).unwrap(), DistanceOptions::default()).nearest.unwrap();
    assert!(below.body == floor && below.distance.overlap && below.distance.distance == 0.0, "{below:?}");
    assert!(HalfSpace::new(DVec3::ZERO, 1.0).is_err() && HalfSpace::new(DVec3::NAN, 1.0).is_err(), "no half-spaces");
    assert!(scene.remove(floor).is_some_and(|body| body.convex().is_none()), "taken out");
    assert!(
        scene.all().ray_cast(down, RayCastOptions::default()).unwrap().first.is_none(),
        "nothing is left to fall on"
    );
}

/// A capsule of length 2 that turns about z over a floor at y = −1, and falls.
#[test]
fn what_turns_lands_on_a_floor() {
    let mut scene = Scene::<Posed<Ball<DVec3>>>::default();
    let floor = scene.insert_half_space(HalfSpace::new(DVec3::Y * 2.0, -2.0).unwrap());
    let rod = |y| Posed::translated(Capsule::new(0.75, 0.25).unwrap(), DVec3::Y * y).unwrap();
    let turns = |y: f64, fall: f64| RigidMotion {
        velocity: DVec3::NEG_Y * fall,
        angular_velocity: DVec3::Z * 3.0,
        center: DVec3::Y * y,
    };
    let cast = |y, fall, end| {
        scene.all().motion_cast(&rod(y), turns(y, fall), MotionCastOptions::new().with_max_time(end)).unwrap()
    };
    let stays_up = cast(0.5, 0.0, 100.0);
    assert_eq!((stays_up.first, stays_up.undecided), (None, None), "its ball is clear");
    assert_eq!(cast(0.5, 0.0, f64::INFINITY).undecided, None, "for ever");

    // Its lower end is at the height 3 − t − 1/4 − 3/4·|cos 3t|.
    let height = |t: f64| 3.0 - t - 0.25 - 0.75 * (3.0 * t).cos().abs();
    let falls = cast(3.0, 1.0, 9.0);
    let first = falls.first.expect("it meets the floor at some time");
    assert_eq!((first.body, first.hit.normal), (floor, Some(DVec3::Y)), "{first:?}");
    assert!(first.lower <= first.hit.time && first.hit.time <= first.upper, "{first:?}");
    assert!(first.upper - first.lower < 1e-13 && (height(first.hit.time) + 1.0).abs() < 1e-14, "{first:?}");
    assert!((0..1000).all(|i| height(first.lower * f64::from(i) / 1000.0) > -1.0), "not before");

    assert_eq!(cast(3.0, 1.0, 2.9).undecided, None, "not yet");
    assert_eq!(cast(-0.5, 0.0, 1.0).first.map(|first| first.hit.time), Some(0.0), "in the floor");
    let straight = RigidMotion::translation(DVec3::NEG_Y);
    let lands = scene.all().motion_cast(&rod(3.0), straight, MotionCastOptions::new().with_max_time(9.0)).unwrap();
    assert_eq!(lands.first.map(|first| first.hit.time), Some(3.0), "as a linear cast");
}

#[test]
fn a_search_can_be_stopped() {
    let scene = Scene::new((0..100).map(|i| ball(f64::from(i) * 0.1))).unwrap();
    let asked = AtomicUsize::new(0);
    let stop = || asked.fetch_add(1, Ordering::Relaxed) >= 10;
    let mut pairs = Vec::new();
    let work = scene.all().until(&stop).pairs_within(1.0, DistanceOptions::default(), &mut pairs);
    assert_eq!((work.cancelled, work.tested), (true, 10), "{work:?}");
    let stop = || true;
    let cast = scene.all().until(&stop).ray_cast(along_x(), RayCastOptions::default()).unwrap();
    assert_eq!((cast.first, cast.lower, cast.work.cancelled), (None, 0.0, true), "nothing is known");
}

#[test]
fn pieces_of_a_link_do_not_meet_each_other() {
    let scene = Scene::new((0..6).map(|i| ball(f64::from(i) * 0.9))).unwrap();
    let link = |piece: usize| piece / 2;
    let mut pairs = Vec::new();
    let same = |i, j| link(i) == link(j);
    scene.all().without_pairs(&same).pairs_within(0.0, DistanceOptions::default(), &mut pairs);
    assert_eq!(pairs.iter().map(|p| (p.a, p.b)).collect::<Vec<_>>(), [(1, 2), (3, 4)], "links next to each other");
    let odd = |i: usize| i % 2 == 1;
    scene.among(&odd).pairs_within(1.0, DistanceOptions::default(), &mut pairs);
    assert_eq!(pairs.iter().map(|p| (p.a, p.b)).collect::<Vec<_>>(), [(1, 3), (3, 5)], "both have to be picked");
}

/// What the narrow phase does is near the least that could decide.
#[test]
fn few_bodies_are_asked() {
    let at = |i: usize| DVec3::new((i % 20) as f64, (i / 20 % 20) as f64, (i / 400) as f64) * 2.0;
    let boxes = (0..8000).map(|i| Posed::translated(Cuboid::new(DVec3::splat(0.5)).unwrap(), at(i)).unwrap());
    let scene = Scene::new(boxes).unwrap();
    let (mut tested, mut least) = (0, 0);
    for i in 0..500 {
        let turn = 0.1 + f64::from(i);
        let direction = DVec3::new(turn.sin(), turn.cos(), (turn * 0.7).sin());
        let ray = Ray { source: DVec3::splat(-3.0) + DVec3::splat(0.07 * turn), direction };
        let answer = scene.all().ray_cast(ray, RayCastOptions::default()).unwrap();
        tested += answer.work.tested;
        least += usize::from(answer.first.is_some());
        let point = Point::new(ray.source).unwrap();
        let answer = scene.all().nearest(&point, DistanceOptions::default());
        tested += answer.work.tested;
        least += 1;
    }
    // Boxes along the axes are their own boxes, so that one query each would do.
    assert!(tested * 2 <= least * 3, "{tested} queries where {least} could decide");
}

#[test]
fn a_filter_is_asked_for_bodies_near_only() {
    let scene = Scene::new((0..1000).map(|i| ball(f64::from(i) * 3.0))).unwrap();
    let asked = Cell::new(0);
    let near = scene.all().nearest(&ball(1500.0), DistanceOptions::default());
    asked.set(near.work.tested);
    assert!(asked.get() < 10, "{near:?}");
    let alone = distance(&ball(1500.0), scene.get(500).unwrap().convex().unwrap(), DistanceOptions::default());
    assert_eq!(near.nearest.unwrap().distance, alone, "the single query");
}

/// A ball, a sled and a capsule slide over a hundred tiles and over as many pairs of triangles. Where two of these lie
/// on one another, their edges and sides push back: with seams left out, all that is left pushes up. The edge at the
/// end of the floor still pushes outward.
#[test]
fn what_slides_over_a_floor_of_pieces_is_not_caught_at_seams() {
    type Shape = Box<dyn SupportMap<Vector = DVec3>>;
    let tile = |i: u32| {
        let tile = Cuboid::new(DVec3::new(0.5, 0.5, 1.0)).unwrap();
        Posed::translated(tile, DVec3::new(f64::from(i) + 0.5, -0.5, 0.0)).unwrap()
    };
    let tiles = Scene::new((0..100).map(|i| Box::new(tile(i)) as Shape)).unwrap();
    let corner = |i: u32, z: f64| DVec3::new(f64::from(i), 0.0, z);
    let halves = |i: u32| {
        let [a, b, c, d] = [corner(i, -1.0), corner(i + 1, -1.0), corner(i + 1, 1.0), corner(i, 1.0)];
        [[a, b, c], [a, c, d]].map(|corners| Box::new(Triangle::new(corners).unwrap()) as Shape)
    };
    let mesh = Scene::new((0..100).flat_map(halves)).unwrap();
    let lying = DQuat::from_rotation_z(core::f64::consts::FRAC_PI_2);
    let ball: Shape = Box::new(Ball::new(0.5).unwrap());
    let sled: Shape = Box::new(Cuboid::new(DVec3::new(0.5, 0.5, 0.3)).unwrap());
    let capsule: Shape = Box::new(Posed::new(Capsule::new(0.4, 0.5).unwrap(), lying, DVec3::ZERO).unwrap());
    let (mut caught, mut left_out, mut contacts) = (0, 0, Vec::new());
    for floor in [&tiles, &mesh] {
        for shape in [&ball, &sled, &capsule] {
            for step in 0..300 {
                let x = 1.5 + 0.3217 * f64::from(step);
                let body = Posed::translated(shape, DVec3::new(x, 0.498, 0.11)).unwrap();
                floor.all().contacts_of(&body, 0.001, Default::default(), &mut contacts);
                let pushes_back = |found: &BodyContact<DVec3>| found.contact.normal.y.abs() < 1.0 - 1e-9;
                caught += contacts.iter().filter(|found| pushes_back(found)).count();
                left_out += floor.leave_out_seams(&mut contacts);
                assert!(!contacts.is_empty() && !contacts.iter().any(pushes_back), "{x}: {contacts:?}");
            }
        }
    }
    assert!(caught > 100 && left_out == caught, "{caught} {left_out}");
    let over_the_end = Posed::translated(&ball, DVec3::new(100.2, 0.4, 0.0)).unwrap();
    tiles.all().contacts_of(&over_the_end, 0.0, Default::default(), &mut contacts);
    tiles.leave_out_seams(&mut contacts);
    assert!(contacts.iter().any(|found| found.contact.normal.x > 0.3), "{contacts:?}");
}

/// What slides may be a scene of its own, before or behind the floor: the contacts that are left are the same.
#[test]
fn seams_between_two_scenes_are_left_out_whichever_is_the_floor() {
    let block = |half: DVec3, at: DVec3| Posed::translated(Cuboid::new(half).unwrap(), at).unwrap();
    let floor = (0..10).map(|i| block(DVec3::new(0.5, 0.5, 1.0), DVec3::new(f64::from(i) + 0.5, -0.5, 0.0)));
    let floor = Scene::new(floor).unwrap();
    let (mut caught, mut contacts) = (0, Vec::new());
    for step in 0..30 {
        let x = 1.5 + 0.250_025 * f64::from(step);
        let sleds = [0.11, -0.6].map(|z| block(DVec3::new(0.5, 0.5, 0.3), DVec3::new(x, 0.498, z)));
        let sleds = Scene::new(sleds).unwrap();
        let pushes_back = |found: &PairContact<DVec3>| found.contact.normal.y.abs() < 1.0 - 1e-9;
        for is_swapped in [false, true] {
            let (a, b) = if is_swapped { (&sleds, &floor) } else { (&floor, &sleds) };
            a.all().contacts_between(b, 0.001, Default::default(), &mut contacts);
            let before = contacts.iter().filter(|found| pushes_back(found)).count();
            assert_eq!(a.leave_out_seams_between(b, &mut contacts), before, "{step}");
            assert!(contacts.len() >= 2 && !contacts.iter().any(pushes_back), "{contacts:?}");
            caught += before;
        }
    }
    assert!(caught > 40, "{caught}");
}

/// Among the contacts of all pairs a tile may be the first body or the second: the sled is before some of the tiles and
/// behind others. And the contacts of the last step may be handed on, to the half-space too, into a list that has room.
#[test]
fn contacts_of_all_pairs_follow_the_last_ones_without_seams() {
    let block = |half: DVec3, at: DVec3| Posed::translated(Cuboid::new(half).unwrap(), at).unwrap();
    let tile = |i: u32| block(DVec3::new(0.5, 0.5, 1.0), DVec3::new(f64::from(i) + 0.5, -0.5, 0.0));
    let (mut caught, mut last, mut contacts) = (0, Vec::new(), Vec::new());
    let mut room = 0;
    for step in 0..30 {
        let sled = block(DVec3::new(0.5, 0.5, 0.3), DVec3::new(1.5 + 0.250_025 * f64::from(step), 0.498, 0.11));
        let mut scene = Scene::new((0..5).map(tile).chain([sled]).chain((5..10).map(tile))).unwrap();
        let ground = scene.insert_half_space(HalfSpace::new(DVec3::Y, 0.0).unwrap());
        let is_floor = |i: usize| i != 5;
        let pairs = |a, b| is_floor(a) && is_floor(b);
        let asked = scene.all().without_pairs(&pairs);
        asked.after(&last).contacts_within(0.001, Default::default(), &mut contacts);
        assert!(contacts.iter().any(|found| (found.a, found.b) == (5, ground)), "{contacts:?}");
        let pushes_back = |found: &PairContact<DVec3>| found.contact.normal.y.abs() < 1.0 - 1e-9;
        let before = contacts.iter().filter(|found| pushes_back(found)).count();
        assert_eq!(scene.leave_out_seams_of_pairs(&mut contacts), before, "{step}");
        assert!(contacts.len() > 1 && !contacts.iter().any(pushes_back), "{contacts:?}");
        caught += before;
        core::mem::swap(&mut last, &mut contacts);
        if step == 15 {
            room = last.capacity() + contacts.capacity();
        }
    }
    assert!(caught > 5 && last.capacity() + contacts.capacity() == room, "{caught}");

    // A disc that is turned has four points of its rim; those of the step before stay, on a body and on a half-space.
    let disc = |angle| {
        let turn = DQuat::from_rotation_y(angle);
        Posed::new(Cylinder::new(0.5, 0.5).unwrap(), turn, DVec3::new(0.0, 0.499, 0.0)).unwrap()
    };
    let (ground, slab) = (HalfSpace::new(DVec3::Y, 0.0).unwrap(), block(DVec3::splat(1.0), DVec3::NEG_Y));
    let ids = |contact: &Contact<DVec3>| contact.points().iter().map(|p| p.feature_a).collect::<Vec<_>>();
    let mut resting = ground.contact(&disc(0.0), 0.0).unwrap();
    let mut found = vec![PairContact {
        a: 0,
        b: 1,
        member_a: None,
        member_b: None,
        contact: contact(&disc(0.0), &slab, 0.0, Default::default()).unwrap(),
    }];
    let first = [ids(&resting), ids(&found[0].contact)];
    for step in 1..20 {
        let angle = 0.01 * f64::from(step);
        resting = ground.contact_after(&resting, &disc(angle), 0.0).unwrap();
        let scene = Scene::new([Box::new(disc(angle)) as Box<dyn SupportMap<Vector = DVec3>>, Box::new(slab)]).unwrap();
        let mut next = Vec::new();
        scene.all().after(&found).contacts_within(0.0, Default::default(), &mut next);
        found = next;
        let mut now = [ids(&resting), ids(&found[0].contact)];
        let mut before = first.clone();
        now.iter_mut().chain(&mut before).for_each(|ids| ids.sort_unstable());
        assert_eq!(now, before, "{step}");
    }
}

/// A ball around a moving shape, by which a scene leaves bodies out, grows by how far the shape's way bends away from
/// its chord. That is a length of accelerations, whose squares underflowed at 1e-250: the ball did not grow, and what
/// stood beside the chord was left out.
#[test]
fn the_way_of_a_chain_bends_at_every_scale() {
    for scale in [1.0, 2f64.powi(-830)] {
        let ball_at = |x, y| Posed::translated(Ball::new(0.1 * scale).expect("a ball"), DVec3::new(x, y, 0.0) * scale);
        let scene = Scene::new([ball_at(0.0, 1.0).expect("finite")]).expect("finite");
        let shape = ball_at(1.0, 0.0).expect("finite");
        let joints = [RigidMotion::rotation(DVec3::Z * 3.0, DVec3::ZERO)];
        let cast = scene
            .all()
            .motion_cast(&shape, ChainMotion::new(&joints), MotionCastOptions::new().with_max_time(1.0))
            .expect("a good motion");
        let time = cast.first.map(|first| first.hit.time).expect("it is on the way");
        assert!(0.4 < time && time < 0.5, "{time} at {scale}");
    }
}
