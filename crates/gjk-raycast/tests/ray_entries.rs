//! Many rays at one shape, side by side, are answered as each alone; other shapes are asked as by `ray_casts`.

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{Ball, Capsule, CrossedByLine, Cuboid, Posed, Rotation, Rounded, Scalar, Vector};
use gjk_raycast::{Ray, RayCast, RayCastError, RayCastOptions, RayEntry, ray_cast, ray_casts, ray_entries_into};

use crate::common::{Random, s, turned, v};

/// Rays of all kinds at a shape of a `size` about the origin: from near and from far, through it, past it, from within
/// it, along axes, and through where it is round or has an edge.
fn rays<V: Vector>(random: &mut Random, count: usize, size: f64) -> Vec<Ray<V>> {
    let mut vector = |size: f64| [0; 3].map(|_| random.number(-size, size));
    (0..count)
        .map(|i| {
            let from = if i % 7 == 6 { 0.5 } else { [2.0, 20.0, 1e4][i % 3] };
            let (source, mut at) = (vector(from * size), vector(1.2 * size));
            if i % 5 == 4 {
                // On corners, edges and axes.
                at = at.map(|x| size * (2.0 * x / size).round() / 2.0);
            }
            let direction: [f64; 3] =
                core::array::from_fn(|k| if i % 11 == 10 && k != i % 2 { 0.0 } else { (at[k] - source[k]) / size });
            Ray { source: v(source), direction: v(direction) }
        })
        .collect()
}

fn bits<V: Vector>(entry: RayEntry<V>) -> [u64; 6] {
    let coordinate = |i| if i < V::DIM { entry.normal.get(i) } else { V::Scalar::ZERO };
    [entry.lambda, entry.lower, entry.upper, coordinate(0), coordinate(1), coordinate(2)].map(|x| x.as_f64().to_bits())
}

/// Compares all rays with those of single casts; how many of them hit.
fn hits_beside<S: CrossedByLine + ?Sized>(
    single: impl Iterator<Item = Result<RayCast<S::Vector>, RayCastError>>,
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
) -> usize {
    let mut entries = vec![RayEntry::default(); rays.len()];
    ray_entries_into(target, rays, options, &mut entries).expect("rays can be cast");
    for ((ray, &entry), single) in rays.iter().zip(&entries).zip(single) {
        let single = single.expect("it can be cast").into();
        assert_eq!(bits(entry), bits(single), "{ray:?}: {entry:?} is not {single:?}");
    }
    entries.iter().filter(|entry| entry.lambda < Scalar::from_f64(f64::INFINITY)).count()
}

/// Of a shape that is asked side by side: each ray as alone.
fn hits<S: CrossedByLine + ?Sized>(target: &S, rays: &[Ray<S::Vector>], options: RayCastOptions<S::Vector>) -> usize {
    hits_beside(rays.iter().map(|&ray| ray_cast(target, ray, options)), target, rays, options)
}

/// Of any other: each ray after the last.
fn hits_in_turn<S: CrossedByLine + ?Sized>(
    target: &S,
    rays: &[Ray<S::Vector>],
    options: RayCastOptions<S::Vector>,
) -> usize {
    hits_beside(ray_casts(target, rays, options), target, rays, options)
}

fn all_shapes<V: Vector>(seed: u64, angle: f64) {
    let mut random = Random(seed);
    // Not a multiple of how many are asked at a time.
    let count = 165;
    for size in [1.0, 1e-3, 300.0] {
        let cuboid = Cuboid::new(v::<V>([0.5 * size, size, 0.25 * size])).expect("a box");
        let capsule = Capsule::<V>::new(s::<V>(0.6 * size), s::<V>(0.4 * size)).expect("a capsule");
        let ball = Ball::<V>::new(s::<V>(size)).expect("a ball");
        let rotation = V::Rotation::from_xyzw([0.1 * angle, 0.5 * angle, angle, 1.0].map(s::<V>));
        let place = [0.1 * size, -0.3 * size, 0.2 * size];
        let (rays, all) = (rays::<V>(&mut random, count, size), RayCastOptions::new());
        let ended = all.with_max_lambda(s::<V>(0.8));
        let shapes: [&dyn CrossedByLine<Vector = V>; 6] = [
            &ball,
            &cuboid,
            &capsule,
            &turned(ball, rotation, place),
            &turned(cuboid, rotation, place),
            &turned(turned(capsule, rotation, place), rotation, place),
        ];
        for shape in shapes {
            let of_all = hits(shape, &rays, all);
            assert!(of_all > count / 8, "{of_all} of {count} hit");
            let of_ended = hits(shape, &rays, ended);
            assert!(of_ended <= of_all, "those that end hit no more");
        }
        let rounded = Rounded::new(cuboid, s::<V>(0.1 * size)).expect("rounded");
        let many = rays.repeat(2);
        assert!(hits_in_turn(&rounded, &many, all) > count / 8, "rays hit");
        hits_in_turn(&Posed::translated(rounded, v(place)).expect("moved"), &many, ended);
        hits_in_turn(&ball, &many, all.with_min_lambda(s::<V>(0.5)));
    }
}

/// The closed form of many lines reads that of one line; what differs is how they are run: by vector instructions, in
/// plain numbers instead of registers, and both sides of each branch. None of that may change a bit of λ, a bound or a
/// normal; and rays whose closed form is in doubt are to be found, and cast alone.
#[test]
fn each_entry_is_that_of_its_ray_alone() {
    all_shapes::<DVec3>(1, 0.3);
    all_shapes::<Vec3>(2, 0.7);
    all_shapes::<Vec3A>(3, -0.2);
    all_shapes::<DVec2>(4, 0.4);
    all_shapes::<Vec2>(5, 0.9);
}

#[cfg(feature = "hull")]
#[test]
fn each_entry_of_a_hull_is_that_of_its_ray_alone() {
    fn of<V: Vector>(seed: u64) {
        let mut random = Random(seed);
        let vertices = (0..20).map(|_| v::<V>([0; 3].map(|_| random.number(-1.0, 1.0))));
        let hull = convex_support::Faceted::hull_of(vertices).expect("a hull");
        let posed = turned(hull.clone(), V::Rotation::from_xyzw([0.0, 0.0, 0.6, 0.8].map(s::<V>)), [0.3, 0.2, -0.1]);
        let rays = rays::<V>(&mut random, 400, 1.0);
        for shape in [&hull as &dyn CrossedByLine<Vector = V>, &posed] {
            assert!(hits(shape, &rays, RayCastOptions::new()) > 50, "rays hit");
        }
        // In the planes of facets, and through edges of four of them.
        let octahedron = (0..6).map(|i| V::axis(i % V::DIM) * s::<V>(if i < V::DIM { 1.0 } else { -1.0 }));
        let octahedron = convex_support::Faceted::hull_of(octahedron).expect("a hull");
        hits(&octahedron, &rays, RayCastOptions::new());
    }
    of::<DVec3>(6);
    of::<Vec3A>(7);
    of::<DVec2>(8);
}

#[test]
fn a_ray_that_is_none_is_an_error_and_spoils_no_other() {
    let ball = Ball::<DVec3>::new(1.0).expect("a ball");
    let ray = Ray { source: DVec3::new(-4.0, 0.0, 0.0), direction: DVec3::X };
    let mut rays = [ray; 70];
    rays[3].direction = DVec3::ZERO;
    rays[40].source.y = f64::NAN;
    let mut entries = [RayEntry::default(); 70];
    let outcome = ray_entries_into(&ball, &rays, RayCastOptions::new(), &mut entries);
    assert_eq!(outcome, Err(RayCastError::ZeroDirection), "that of the first");
    #[cfg(feature = "rayon")]
    {
        let (many, mut by_threads) = (rays.repeat(30), vec![RayEntry::default(); 2100]);
        let outcome = gjk_raycast::par_ray_entries_into(&ball, &many, RayCastOptions::new(), &mut by_threads);
        assert_eq!(outcome, Err(RayCastError::ZeroDirection), "that of the first, on all threads");
        assert!(by_threads.chunks(70).all(|some| some.iter().zip(&entries).all(|(p, q)| bits(*p) == bits(*q))), "all");
    }
    for (k, entry) in entries.iter().enumerate() {
        assert!(if k == 3 || k == 40 { entry.lambda.is_nan() } else { entry.lambda == 3.0 }, "{k}: {entry:?}");
    }
    let options = RayCastOptions::new().with_max_lambda(f64::NAN);
    assert!(ray_entries_into(&ball, &rays[..1], options, &mut entries[..1]).is_err(), "an end that is not a number");
}

/// A coordinate that is not a number may be passed over where the largest of them is sought; slabs pass over it too.
#[test]
fn no_coordinate_that_is_not_a_number_is_passed_over() {
    let cuboid = Cuboid::new(DVec3::ONE).expect("a box");
    let ray = Ray { source: DVec3::new(-4.0, -4.0, -4.0), direction: DVec3::ONE };
    for i in 0..3 {
        let (mut by_source, mut by_direction) = (ray, ray);
        by_source.source[i] = f64::NAN;
        by_direction.direction[i] = f64::NAN;
        for ray in [by_source, by_direction] {
            assert!(ray_cast(&cuboid, ray, RayCastOptions::new()).is_err(), "{ray:?} alone");
            let mut entries = [RayEntry::default(); 2];
            let outcome = ray_entries_into(&cuboid, &[ray; 2], RayCastOptions::new(), &mut entries);
            assert!(outcome.is_err() && entries[1].lambda.is_nan(), "{ray:?}: {entries:?}");
        }
    }
}
