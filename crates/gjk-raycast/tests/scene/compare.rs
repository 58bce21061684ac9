//! Questions to a scene, and the same to every body.

use convex_support::{AngularVelocity as _, Rotation as _, Scalar, bounding_box};
use gjk_raycast::{
    BodyHit, CastMethod, DistanceOptions, LinearCastOptions, Motion, MotionCast, MotionCastOptions, Outcome,
    PairDistance, PairImpact, Ray, RayCastOptions, RigidMotion, SceneRayCast, SignedDistanceOptions, StartInContact,
    Status, SubAlgorithm,
};
use num_traits::Float;

use super::brute_force;
use super::numbers::Numbers;
use super::worlds::{World, body};
use crate::common::space::Space;

/// How many questions were asked, and how they came out.
#[derive(Debug, Default)]
pub(crate) struct Count {
    pub(crate) questions: usize,
    hits: usize,
    starts: usize,
    open: usize,
    undecided: usize,
    within: usize,
    overlaps: usize,
    pairs: usize,
    contacts: usize,
    moving: usize,
    tested: usize,
    culled: usize,
}

impl Count {
    pub(crate) fn is_fair(&self) -> bool {
        let many = self.questions / 50;
        self.hits > many
            && self.starts > many / 10
            && self.within > many
            && self.overlaps > many / 10
            && self.pairs > many
            && self.contacts > many
            && self.moving > many
            && self.culled > self.tested
    }
}

/// Asks everything once.
pub(crate) fn ask<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    for _ in 0..4 {
        ray(world, numbers, count);
        linear_cast(world, numbers, count);
        distances(world, numbers, count);
    }
    if numbers.below(4) == 0 {
        many_rays(world, numbers);
    }
    motion_cast(world, numbers, count);
    pairs(world, numbers, count);
    contacts(world, numbers, count);
    nearest_pairs(world, numbers, count);
    moving_pairs(world, numbers, count);
}

/// A length at the scale of the world, and a point in it or about.
fn scale<V: Space>(world: &World<V>, numbers: &mut Numbers) -> (f64, V) {
    let count = world.scene.len().max(1);
    let near = world.scene.iter().nth(numbers.below(count)).and_then(|(_, body)| Some(bounding_box(body.convex()?)));
    let Some(near) = near else { return (1.0, numbers.vector(2.0)) };
    let size = near.half_extents().max_element().as_f64().max(V::Scalar::min_positive_value().as_f64() * 1e6);
    let reach = size * [0.5, 3.0, 20.0][numbers.below(3)];
    (size, near.center() + numbers.vector(reach))
}

/// A first guess, which may be no direction.
fn axis<V: Space>(numbers: &mut Numbers) -> V {
    match numbers.below(4) {
        0 => V::ZERO,
        1 => V::splat(V::Scalar::nan()),
        _ => numbers.vector(1.0),
    }
}

fn ray<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, source) = scale(world, numbers);
    let (_, goal) = scale(world, numbers);
    let mut direction = if numbers.below(3) == 0 { numbers.vector(1.0) } else { goal - source };
    if direction == V::ZERO {
        direction = V::axis(0);
    }
    let (ray, mut options) = (Ray { source, direction }, RayCastOptions::default());
    match numbers.below(4) {
        0 => options.max_lambda = V::Scalar::from_f64(0.9),
        1 => options.max_lambda = V::Scalar::from_f64(size / direction.norm().as_f64()),
        // Brackets that stay open.
        2 => options.max_iterations = 1 + numbers.below(6),
        _ => {}
    }
    match numbers.below(6) {
        0 => options.min_lambda = V::Scalar::from_f64(0.7),
        1 => options.min_lambda = V::Scalar::from_f64(size / direction.norm().as_f64()),
        2 => options.tolerance = V::Scalar::from_f64([1e-3, 0.1, 10.0][numbers.below(3)]),
        3 => options = options.with_axis(axis(numbers)).with_method(CastMethod::Gjk),
        4 => options.sub_algorithm = SubAlgorithm::SignedVolumes,
        _ => {}
    }
    let casts = brute_force::rays(world, ray, options);
    let answer = world.scene.all().ray_cast(ray, options).expect("a good ray");
    let singles = casts
        .iter()
        .map(|&(body, cast)| Single::new(body, cast.outcome, [cast.lower, cast.upper], cast.status, |hit| hit.lambda));
    first(
        &answer,
        singles,
        options.tolerance > V::Scalar::ZERO,
        &format!("kind {}, {ray:?}, {options:?}", world.kind),
        count,
    );

    let mut hits = Vec::new();
    let all = world.scene.all().ray_cast_all(ray, options, &mut hits).expect("a good ray");
    let mut due: Vec<_> = casts.iter().filter_map(|(body, cast)| Some((cast.outcome.hit()?.lambda, *body))).collect();
    due.sort_by(|a, b| a.partial_cmp(b).expect("no NaN"));
    let found: Vec<_> = hits.iter().map(|hit| (hit.hit.lambda, hit.body)).collect();
    let any = world.scene.all().any_hit(ray, options).expect("a good ray");
    if options.tolerance > V::Scalar::ZERO {
        // Where a bracket stays open the box may prove that the end comes first.
        assert!(found.iter().all(|hit| due.contains(hit)), "all hits of {ray:?}");
        assert_ne!(any.hit, found.is_empty(), "any hit of {ray:?}");
    } else {
        assert_eq!(found, due, "all hits of {ray:?}");
        assert_eq!(any.hit, !due.is_empty(), "any hit of {ray:?}");
    }
    assert!(any.hit || any.undecided == all.undecided, "who is undecided");
    count.questions += 3;
}

/// Rays that share searches are answered as each alone: near one another, every way from one source, from anywhere.
fn many_rays<V: Space>(world: &World<V>, numbers: &mut Numbers) {
    let (size, source) = scale(world, numbers);
    let middle: V = scale(world, numbers).1 - source;
    let (kind, near) = (numbers.below(4), 0.03 * middle.norm().as_f64());
    let mut rays: Vec<_> = (0..19)
        .map(|_| match kind {
            0 => Ray { source, direction: middle + numbers.vector(near) },
            1 => Ray { source: source + numbers.vector(near), direction: middle },
            2 => Ray { source, direction: numbers.vector(size) },
            _ => Ray { source: scale(world, numbers).1, direction: numbers.vector(size) },
        })
        .collect();
    // The last ones go along axes, forwards and back, and one of them is much longer than the others.
    for (k, ray) in rays.iter_mut().enumerate().filter(|(k, ray)| *k >= 16 || ray.direction == V::ZERO) {
        ray.direction = V::axis(k % V::DIM) * V::Scalar::from_f64([1e12, -1.0, 1.0][k % 3]);
    }
    let mut options = RayCastOptions::default();
    match numbers.below(4) {
        0 => options.max_lambda = V::Scalar::from_f64(0.9),
        1 => options.max_iterations = 1 + numbers.below(6),
        2 => options.tolerance = V::Scalar::from_f64(0.1),
        _ => {}
    }
    let all = world.scene.all();
    let alone: Vec<_> = rays.iter().map(|&ray| all.ray_cast(ray, options).expect("a good ray")).collect();
    let mut together: Vec<_> = rays.iter().map(|_| alone[0]).collect();
    all.ray_casts_into(&rays, options, &mut together).expect("good rays");
    #[cfg(feature = "rayon")]
    assert_eq!(
        all.par_ray_casts(&rays, options),
        together.iter().map(|&cast| Ok(cast)).collect::<Vec<_>>(),
        "in parallel"
    );
    for ((ray, alone), together) in rays.iter().zip(&alone).zip(&together) {
        let answer = |cast: &SceneRayCast<V>| (cast.first, cast.lower, cast.undecided);
        assert_eq!(answer(together), answer(alone), "kind {}, {kind}, {ray:?}, {options:?}", world.kind);
    }
}

fn linear_cast<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, _) = scale(world, numbers);
    let (goal, shape) = (scale(world, numbers).1, body::<V>(numbers, world.kind, 1));
    let from = bounding_box(&shape).center();
    let velocity_a = if numbers.below(4) == 0 { numbers.vector(size) } else { goal - from };
    let velocity_b = if numbers.below(2) == 0 { V::ZERO } else { numbers.vector(size) };
    let motion = Motion { velocity_a, velocity_b };
    let mut options = LinearCastOptions::default();
    if numbers.below(3) == 0 {
        options.max_time = V::Scalar::from_f64(0.8);
    }
    match numbers.below(7) {
        0 => options.target_distance = V::Scalar::from_f64(size * [0.01, 1.0, 1e5, -1.0][numbers.below(4)]),
        1 => options.start_in_contact = StartInContact::IfDeeper,
        2 => options.tolerance = V::Scalar::from_f64([1e-3, 0.1, 10.0][numbers.below(3)]),
        3 => options = options.with_axis(axis(numbers)).with_method(CastMethod::Gjk),
        4 => options.max_iterations = numbers.below(6),
        5 => {
            options.target_distance = V::Scalar::from_f64(size * 0.1 * numbers.unit());
            options.start_in_contact = StartInContact::IfDeeper;
        }
        _ => {}
    }
    let casts = brute_force::casts(world, &shape, motion, options);
    let answer = world.scene.all().linear_cast(&shape, motion, options).expect("a good motion");
    let singles = casts
        .iter()
        .map(|&(body, cast)| Single::new(body, cast.outcome, [cast.lower, cast.upper], cast.status, |hit| hit.time));
    let is_rough = options.tolerance > V::Scalar::ZERO;
    first(&answer, singles, is_rough, &format!("kind {}, {motion:?}, {options:?}", world.kind), count);

    let mut hits = Vec::new();
    let all = world.scene.all().linear_cast_all(&shape, motion, options, &mut hits).expect("a good motion");
    let mut due: Vec<_> = casts.iter().filter_map(|(body, cast)| Some((cast.outcome.hit()?, *body))).collect();
    due.sort_by(|(p, a), (q, b)| p.time.partial_cmp(&q.time).expect("no NaN").then(a.cmp(b)));
    let found: Vec<_> = hits.iter().map(|hit| (hit.hit, hit.body)).collect();
    // Where a bracket stays open the box may prove that the end comes first.
    let is_open = is_rough || casts.iter().any(|(_, cast)| cast.status != Status::Converged);
    assert!(found == due || is_open && found.iter().all(|hit| due.contains(hit)), "{found:?} of {due:?}: {motion:?}");
    assert_eq!(all.work.tested + all.work.culled, world.scene.len(), "every body is one or the other");
    count.questions += 2;
}

fn motion_cast<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, center) = scale(world, numbers);
    let (goal, shape) = (scale(world, numbers).1, body::<V>(numbers, world.kind, 1));
    let from = bounding_box(&shape).center();
    let velocity = if numbers.below(3) == 0 { numbers.vector(size) } else { goal - from };
    let center = if numbers.below(2) == 0 { from } else { center };
    // None, a part of a turn, some turns.
    let turned = V::Rotation::from_xyzw([0; 4].map(|_| V::Scalar::from_f64(numbers.signed())));
    let rate = V::AngularVelocity::between(V::Rotation::default(), turned);
    let angular_velocity = rate.scaled(V::Scalar::from_f64([0.0, 1.0, 9.0][numbers.below(3)]));
    let motion = RigidMotion { velocity, angular_velocity, center };
    let mut options =
        MotionCastOptions::default().with_max_time(V::Scalar::from_f64([0.8, 1.0, 10.0][numbers.below(3)]));
    match numbers.below(7) {
        0 => options.target_distance = V::Scalar::from_f64(size * [0.01, 1.0, 1e5, -1.0][numbers.below(4)]),
        1 => options.start_in_contact = StartInContact::IfDeeper,
        2 => options.tolerance = V::Scalar::from_f64([1e-3, 0.1, 10.0][numbers.below(3)]),
        3 => options = options.with_axis(axis(numbers)),
        4 => options.max_iterations = numbers.below(6),
        5 => {
            options.target_distance = V::Scalar::from_f64(size * 0.1 * numbers.unit());
            options.start_in_contact = StartInContact::IfDeeper;
        }
        _ => {}
    }
    let of_bodies = match numbers.below(3) {
        0 => RigidMotion::default(),
        1 => RigidMotion::translation(numbers.vector(size)),
        _ => RigidMotion { velocity: numbers.vector(size), angular_velocity, center },
    };
    let casts = brute_force::motions(world, &shape, motion, of_bodies, options);
    let answer = if of_bodies == RigidMotion::default() {
        world.scene.all().motion_cast(&shape, motion, options)
    } else {
        world.scene.all().motion_cast_of_both(&shape, motion, of_bodies, options)
    };
    let answer = answer.expect("a good motion");
    let singles = casts
        .iter()
        .map(|&(body, cast)| Single::new(body, cast.outcome, [cast.lower, cast.upper], cast.status, |hit| hit.time));
    first(
        &answer,
        singles,
        options.tolerance > V::Scalar::ZERO,
        &format!("kind {}, {motion:?}, {options:?}", world.kind),
        count,
    );
    count.questions += 1;
}

/// The cast of one body.
struct Single<H, S: Scalar> {
    body: usize,
    /// The hit, with its λ or time.
    hit: Option<(S, BodyHit<H, S>)>,
    is_undecided: bool,
    lower: S,
}

impl<H: Copy, S: Scalar> Single<H, S> {
    fn new<V>(body: usize, outcome: Outcome<H, V>, [lower, upper]: [S; 2], status: Status, of: fn(&H) -> S) -> Self {
        let is_undecided = matches!(outcome, Outcome::Undecided);
        let hit = outcome.hit().map(|hit| (of(&hit), BodyHit { body, member: None, hit, lower, upper, status }));
        Self { body, hit, is_undecided, lower }
    }
}

/// The first hit is that of the single casts; where a bracket stayed open, the box may know better, and then the answer
/// keeps to what both say. With a tolerance they are rough, and any bracket may be open.
fn first<H: Copy + PartialEq + std::fmt::Debug, S: Scalar>(
    answer: &gjk_raycast::SceneCast<H, S>,
    singles: impl Iterator<Item = Single<H, S>>,
    is_rough: bool,
    question: &str,
    count: &mut Count,
) {
    let (mut due, mut lower, mut is_open, mut undecided): (Option<(S, BodyHit<H, S>)>, _, _, _) =
        (None, S::infinity(), false, Vec::new());
    for Single { body, hit, is_undecided, lower: from } in singles {
        if is_undecided || hit.is_some() {
            lower = Float::min(lower, from);
        }
        if is_undecided {
            undecided.push(body);
        }
        if let Some((value, hit)) = hit {
            is_open |= hit.status != Status::Converged || is_rough;
            if due.is_none_or(|(least, _)| value < least) {
                due = Some((value, hit));
            }
        }
    }
    count.tested += answer.work.tested;
    count.culled += answer.work.culled;
    count.hits += usize::from(due.is_some());
    count.starts += usize::from(due.is_some_and(|(value, _)| value == S::ZERO));
    count.open += usize::from(is_open);
    count.undecided += usize::from(!undecided.is_empty());
    if !is_open {
        assert_eq!(answer.first, due.map(|(_, hit)| hit), "{question}");
    }
    assert!(answer.lower >= lower, "{} is below {lower}, which no single cast is: {question}", answer.lower);
    assert!(answer.undecided.is_none_or(|body| undecided.contains(&body)), "{question}");
}

fn distances<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, _) = scale(world, numbers);
    let shape = body::<V>(numbers, world.kind, 1);
    let all = brute_force::distances(world, &shape);
    let limit = if numbers.below(2) == 0 { V::Scalar::infinity() } else { V::Scalar::from_f64(size * numbers.unit()) };
    let answer = world.scene.all().nearest(&shape, DistanceOptions::default().with_limit(limit));
    let near = all.iter().filter(|body| body.distance.distance <= limit);
    let due = near.copied().reduce(|a, b| if b.distance.distance < a.distance.distance { b } else { a });
    assert_eq!(answer.nearest, due, "kind {}, the nearest within {limit}", world.kind);
    assert!(answer.lower <= due.map_or(limit, |due| due.distance.distance), "kind {}, {answer:?}", world.kind);
    count.tested += answer.work.tested;
    count.culled += answer.work.culled;

    let within = V::Scalar::from_f64(size * numbers.unit());
    let mut found = Vec::new();
    let work = world.scene.all().all_within(&shape, within, DistanceOptions::default(), &mut found);
    let due: Vec<_> = all.iter().copied().filter(|body| body.distance.distance <= within).collect();
    assert_eq!(found, due, "kind {}, within {within}", world.kind);
    assert_eq!(work.tested + work.culled, world.scene.len(), "every body is one or the other");
    count.within += found.len();
    // Some bodies do not count.
    let even = |index: usize| index.is_multiple_of(2);
    let answer = world.scene.among(&even).nearest(&shape, DistanceOptions::default());
    let even = all.iter().filter(|body| even(body.body)).copied();
    let due = even.reduce(|a, b| if b.distance.distance < a.distance.distance { b } else { a });
    assert_eq!(answer.nearest, due, "kind {}, the nearest of every other", world.kind);

    let mut several = Vec::new();
    let wanted = numbers.below(8);
    let work = world.scene.all().nearest_k(&shape, wanted, DistanceOptions::default().with_limit(limit), &mut several);
    let mut due: Vec<_> = all.iter().copied().filter(|body| body.distance.distance <= limit).collect();
    due.sort_by(|a, b| {
        a.distance.distance.partial_cmp(&b.distance.distance).expect("no NaN").then(a.body.cmp(&b.body))
    });
    due.truncate(wanted);
    assert_eq!(several, due, "kind {}, the {wanted} nearest within {limit}", world.kind);
    assert_eq!(work.tested + work.culled, world.scene.len(), "every body is one or the other");

    let options = SignedDistanceOptions::default();
    let answer = world.scene.all().least_signed_distance(&shape, options.with_limit(limit));
    let signed = world.scene.iter().map(|(body, other)| (other.signed_distance(&shape, options), body));
    let near = signed.filter(|(distance, _)| distance.signed_distance <= limit);
    let due = near.reduce(|a, b| if b.0.signed_distance < a.0.signed_distance { b } else { a });
    let found = answer.least.map(|least| (least.distance, least.body));
    assert_eq!(found, due, "kind {}, the least signed distance within {limit}", world.kind);
    assert!(answer.lower <= due.map_or(limit, |(due, _)| due.signed_distance), "kind {}, {answer:?}", world.kind);
    count.overlaps += usize::from(due.is_some_and(|(due, _)| due.overlap));
    count.questions += 5;
}

fn pairs<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, _) = scale(world, numbers);
    let within = V::Scalar::from_f64([0.0, size, size * 0.1][numbers.below(3)]);
    let mut found = Vec::new();
    let work = world.scene.all().pairs_within(within, DistanceOptions::default(), &mut found);
    let due = brute_force::pairs(world, within);
    assert_eq!(brute_force::bounded(&found, &world.scene), due, "kind {}, pairs within {within}", world.kind);
    let is_sorted = found.windows(2).all(|w| (w[0].a, w[0].b) < (w[1].a, w[1].b));
    assert!(is_sorted, "pairs are in order, each once");
    count.tested += work.tested;
    count.culled += work.culled;
    count.pairs += found.len();
    // Those with half-spaces are what the half-space says.
    for (index, half_space) in world.scene.iter().filter(|(_, body)| body.convex().is_none()) {
        let gjk_raycast::Body::HalfSpace(half_space) = half_space else { continue };
        let near = |(i, body): (usize, &gjk_raycast::Body<_>)| {
            let distance = half_space.distance_from(body.convex()?).distance;
            (distance <= within).then_some((i.min(index), i.max(index)))
        };
        let mut due: Vec<_> = world.scene.iter().filter_map(near).collect();
        due.sort_unstable();
        let with = found.iter().map(|pair| (pair.a, pair.b)).filter(|&(a, b)| a == index || b == index);
        assert_eq!(with.collect::<Vec<_>>(), due, "pairs with a half-space");
    }
    // Between two scenes; of a scene and itself each pair twice, and every body with itself.
    let mut between = Vec::new();
    world.scene.all().pairs_between(&world.scene, within, DistanceOptions::default(), &mut between);
    between.retain(|pair| pair.a < pair.b);
    let ours: Vec<_> = between.iter().map(|pair| (pair.a, pair.b, pair.distance)).collect();
    assert_eq!(ours, found.iter().map(|pair| (pair.a, pair.b, pair.distance)).collect::<Vec<_>>(), "between two");
    #[cfg(feature = "rayon")]
    {
        let mut parallel = Vec::new();
        world.scene.all().par_pairs_within(within, DistanceOptions::default(), &mut parallel);
        assert_eq!(parallel, found, "on all threads");
    }
    count.questions += 2;
}

fn contacts<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, _) = scale(world, numbers);
    // Some are deep in one another, and some a little apart.
    let within = V::Scalar::from_f64([0.0, size * 0.1, size, -0.2 * size][numbers.below(4)]);
    let options = SignedDistanceOptions::default();
    let mut found = Vec::new();
    let work = world.scene.all().contacts_within(within, options, &mut found);
    let due = brute_force::contacts(world, within);
    assert_eq!(found, due, "kind {}, contacts within {within}", world.kind);
    count.contacts += found.len();
    count.tested += work.tested;
    count.culled += work.culled;
    // Between two scenes; of a scene and itself each pair twice, and every body with itself.
    let mut between = Vec::new();
    world.scene.all().contacts_between(&world.scene, within, options, &mut between);
    between.retain(|pair| pair.a < pair.b);
    assert_eq!(between, found, "between two");
    // Some bodies do not count.
    let even = |index: usize| index.is_multiple_of(2);
    world.scene.among(&even).contacts_within(within, options, &mut between);
    let due: Vec<_> = found.iter().copied().filter(|pair| even(pair.a) && even(pair.b)).collect();
    assert_eq!(between, due, "of every other");
    #[cfg(feature = "rayon")]
    {
        let mut parallel = Vec::new();
        world.scene.all().par_contacts_within(within, options, &mut parallel);
        assert_eq!(parallel, found, "on all threads");
    }
    // Of one shape.
    let shape = body::<V>(numbers, world.kind, 1);
    let mut of_shape = Vec::new();
    let work = world.scene.all().contacts_of(&shape, within, options, &mut of_shape);
    assert_eq!(of_shape, brute_force::contacts_of(world, &shape, within), "kind {}, within {within}", world.kind);
    assert_eq!(work.tested + work.culled, world.scene.len(), "every body is one or the other");
    count.questions += 3;
}

/// The nearest pair within one scene and of two, and whether any is near, with all bodies or some.
fn nearest_pairs<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, _) = scale(world, numbers);
    let others = super::worlds::world::<V>(numbers, world.kind).scene;
    let all = brute_force::distances_between(&world.scene, &others);
    let own: Vec<_> =
        brute_force::distances_between(&world.scene, &world.scene).into_iter().filter(|pair| pair.a < pair.b).collect();
    let every = numbers.below(3) > 0;
    let picked = |index: usize| every || index.is_multiple_of(2);
    let left_out = |a: usize, b: usize| !every && (a + b).is_multiple_of(3);
    let questions = world.scene.among(&picked);
    let questions = questions.without_pairs(&left_out);
    let options = DistanceOptions::default();
    let least = [&all, &own]
        .map(|pairs| pairs.iter().map(|pair| pair.distance.distance).fold(V::Scalar::infinity(), Float::min));
    for (pairs, least, is_own) in [(&all, least[0], false), (&own, least[1], true)] {
        let counts =
            |pair: &&PairDistance<V>| picked(pair.a) && (!is_own || picked(pair.b)) && !left_out(pair.a, pair.b);
        let pairs: Vec<_> = pairs.iter().filter(counts).copied().collect();
        let some = V::Scalar::from_f64(size * numbers.unit());
        // None, a pair exactly at the limit, a limit that no distance is within.
        let limits = [V::Scalar::infinity(), some, least, V::Scalar::nan(), V::Scalar::ZERO, -some];
        for limit in [limits[0], limits[1 + numbers.below(5)]] {
            let ask = |options| {
                if is_own { questions.least_pair(options) } else { questions.nearest_between(&others, options) }
            };
            let answer = ask(options.with_limit(limit));
            let end = if limit.is_nan() { V::Scalar::infinity() } else { limit };
            let near = pairs.iter().filter(|pair| pair.distance.distance <= end).copied();
            let due = near.reduce(|a, b| if b.distance.distance < a.distance.distance { b } else { a });
            assert_eq!(answer.nearest, due, "kind {}, own {is_own}, within {limit}", world.kind);
            let lower = pairs.iter().map(|pair| pair.distance.lower).fold(end, Float::min);
            // Boxes may know better, and no more than the distance.
            let most = due.map_or(end, |due| due.distance.distance);
            assert!(lower <= answer.lower && answer.lower <= most, "{lower} {} {most}", answer.lower);
            assert!(answer.work.tested <= pairs.len(), "each pair once");
            count.tested += answer.work.tested;
            count.culled += answer.work.culled;
            #[cfg(feature = "rayon")]
            {
                let options = options.with_limit(limit);
                let parallel = if is_own {
                    questions.par_least_pair(options)
                } else {
                    questions.par_nearest_between(&others, options)
                };
                assert_eq!((parallel.nearest, parallel.lower), (answer.nearest, answer.lower), "on all threads");
                assert_eq!(
                    parallel.work.tested + parallel.work.culled,
                    answer.work.tested + answer.work.culled,
                    "all pairs"
                );
            }
            let any = if is_own {
                questions.any_pair_within(limit, options)
            } else {
                questions.any_pair_between(&others, limit, options)
            };
            assert_eq!(any.any, pairs.iter().any(|pair| pair.distance.distance <= limit), "any within {limit}");
            let is_sure = pairs.iter().any(|pair| pair.distance.upper <= limit);
            let open = |pair: &&PairDistance<V>| pair.distance.lower <= limit && limit < pair.distance.upper;
            let open = pairs.iter().find(open).map(|pair| [pair.a, pair.b]);
            assert!(
                if is_sure { any.is_certain() } else { any.undecided.is_none() || any.undecided >= open },
                "{any:?}"
            );
        }
        let stopped = if is_own {
            questions.until(&|| true).least_pair(options)
        } else {
            questions.until(&|| true).nearest_between(&others, options)
        };
        let is_empty = pairs.is_empty();
        assert_eq!((stopped.nearest, stopped.work.tested, stopped.work.cancelled), (None, 0, !is_empty), "at once");
        count.questions += 4;
    }
    // Of one shape.
    let shape = body::<V>(numbers, world.kind, 1);
    let within = V::Scalar::from_f64(size * [0.0, 0.1, 1.0][numbers.below(3)]);
    let any = world.scene.all().any_within(&shape, within, options);
    let near = brute_force::distances(world, &shape);
    assert_eq!(any.any, near.iter().any(|near| near.distance.distance <= within), "any within {within} of a shape");
    assert_eq!(any.work.tested + any.work.culled, world.scene.len(), "every body is one or the other");
    count.questions += 1;
}

/// The first contacts of all pairs that move, within one scene and of two, straight, turning, or at rest.
fn moving_pairs<V: Space>(world: &World<V>, numbers: &mut Numbers, count: &mut Count) {
    let (size, _) = scale(world, numbers);
    let others = super::worlds::world::<V>(numbers, world.kind).scene;
    if world.scene.len() * others.len() > 400 || world.scene.len() > 20 {
        return;
    }
    let end = world.scene.iter().chain(others.iter()).map(|(index, _)| index + 1).max().unwrap_or(0);
    let straight = numbers.below(2) == 0;
    let mut motion = || match numbers.below(if straight { 3 } else { 5 }) {
        0 => RigidMotion::default(),
        1 => RigidMotion::translation(V::axis(0) * V::Scalar::from_f64(size)),
        2 => RigidMotion::translation(numbers.vector(size * 3.0)),
        _ => {
            let turned = V::Rotation::from_xyzw([0; 4].map(|_| V::Scalar::from_f64(numbers.signed())));
            let angular_velocity = V::AngularVelocity::between(V::Rotation::default(), turned);
            RigidMotion { velocity: numbers.vector(size), angular_velocity, center: numbers.vector(size * 3.0) }
        }
    };
    let motions: [Vec<_>; 2] = [(); 2].map(|()| (0..end).map(|_| motion()).collect());
    let time = [0.7, 1.0, 0.0, f64::INFINITY][numbers.below(if straight { 4 } else { 3 })];
    let mut options = MotionCastOptions::default().with_max_time(V::Scalar::from_f64(time));
    match numbers.below(5) {
        0 => options.target_distance = V::Scalar::from_f64(size * [0.01, 1.0, -1.0][numbers.below(3)]),
        1 => options.start_in_contact = StartInContact::IfDeeper,
        2 => options.max_iterations = 3 + numbers.below(20),
        _ => {}
    }
    let every = numbers.below(3) > 0;
    let picked = |index: usize| every || index.is_multiple_of(2);
    let left_out = |a: usize, b: usize| !every && (a + b).is_multiple_of(3);
    let questions = world.scene.among(&picked);
    let questions = questions.without_pairs(&left_out);
    for is_own in [true, false] {
        let second = if is_own { &world.scene } else { &others };
        let of_second = &motions[usize::from(!is_own)];
        let [of_a, of_b] =
            [&|i: usize| motions[0][i], &|i: usize| of_second[i]] as [&dyn Fn(usize) -> RigidMotion<V>; 2];
        let mut casts = Vec::new();
        for (a, first) in world.scene.iter().filter(|(a, _)| picked(*a)) {
            for (b, other) in second.iter().filter(|(b, _)| !is_own || a < *b && picked(*b)) {
                let cast = match (first, other) {
                    _ if left_out(a, b) => continue,
                    (gjk_raycast::Body::Convex(first), other) => {
                        other.motion_cast_of_both(first, of_a(a), of_b(b), options).expect("good motions")
                    }
                    (first, gjk_raycast::Body::Convex(other)) => {
                        let cast = first.motion_cast_of_both(other, of_b(b), of_a(a), options).expect("good motions");
                        let outcome = match cast.outcome {
                            Outcome::Hit(mut hit) => {
                                hit.normal = hit.normal.map(|normal| -normal);
                                Outcome::Hit(hit)
                            }
                            outcome => outcome,
                        };
                        MotionCast { outcome, ..cast }
                    }
                    _ => continue,
                };
                casts.push(([a, b], cast));
            }
        }
        let mut due: Vec<_> = casts
            .iter()
            .filter_map(|&([a, b], cast)| {
                let (lower, upper, status) = (cast.lower, cast.upper, cast.status);
                Some(PairImpact {
                    a,
                    b,
                    member_a: None,
                    member_b: None,
                    impact: cast.outcome.hit()?,
                    lower,
                    upper,
                    status,
                })
            })
            .collect();
        due.sort_by(|p, q| {
            p.impact.time.partial_cmp(&q.impact.time).expect("no NaN").then((p.a, p.b).cmp(&(q.a, q.b)))
        });
        let mut found = Vec::new();
        let (all, first) = if is_own {
            (questions.first_contacts(of_a, options, &mut found), questions.first_contact(of_a, options))
        } else {
            let motions = [of_a, of_b];
            (
                questions.first_contacts_between(second, motions, options, &mut found),
                questions.first_contact_between(second, motions, options),
            )
        };
        let (all, first) = (all.expect("good motions"), first.expect("good motions"));
        let question = format!("kind {}, own {is_own}, {options:?}", world.kind);
        // Where a bracket stays open the box may know better.
        let is_open = casts.iter().any(|(_, cast)| !cast.outcome.is_miss() && cast.status != Status::Converged);
        assert!(
            found == due || is_open && found.iter().all(|hit| due.contains(hit)),
            "{found:?}, not {due:?}: {question}"
        );
        if !is_open {
            assert_eq!((first.first, all.first), (due.first().copied(), due.first().copied()), "the first: {question}");
            assert_eq!((first.undecided, all.undecided), (None, None), "{question}");
        }
        assert_eq!(first.first, all.first, "alone: {question}");
        assert_eq!(first.lower, all.lower, "alone: {question}");
        let lower = casts.iter().filter(|(_, cast)| !cast.outcome.is_miss()).map(|(_, cast)| cast.lower);
        let lower = lower.fold(V::Scalar::infinity(), Float::min);
        assert!(lower <= all.lower && (is_open || lower == all.lower), "{lower} {}: {question}", all.lower);
        assert!(first.work.tested <= all.work.tested && all.work.tested <= casts.len(), "each once: {question}");
        assert_eq!(first.work.tested + first.work.culled, all.work.tested + all.work.culled, "all pairs: {question}");
        count.tested += all.work.tested;
        count.culled += all.work.culled;
        count.moving += due.len();
        count.questions += 2;
    }
}
