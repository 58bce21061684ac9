//! The tree finds exactly what looking at every box finds, however it was made.

use std::ops::ControlFlow;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3, Vec3A};
use convex_support::{Aabb, Ball, Bound, BoxDistance, Bvh, Posed, Scalar, SweptBox, Vector, outer_box};
use num_traits::Float as _;

/// Numbers that look random and are the same on every machine (xorshift).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end as u64) as usize
    }

    /// In −1..1.
    fn signed(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    fn vector<V: Vector>(&mut self, size: f64) -> V {
        V::from_fn(|_| V::Scalar::from_f64(size * self.signed()))
    }

    fn around<V: Vector>(&mut self, reach: f64, size: f64) -> Aabb<V> {
        let (center, half): (V, V) = (self.vector(reach), self.vector::<V>(size).abs());
        Aabb { min: center - half, max: center + half }
    }
}

/// What kinds of scenes there are.
const KINDS: usize = 9;

fn scene<V: Vector>(numbers: &mut Numbers, kind: usize, count: usize) -> Vec<Aabb<V>> {
    let tiny = V::Scalar::min_positive_value().as_f64();
    let one = numbers.around(1.0, 0.5);
    (0..count)
        .map(|i| match kind {
            0 => numbers.around(1.0, 0.05),
            1 => one,
            2 if i == 0 => numbers.around(1e6, 1e6),
            2 => numbers.around(1.0, 1e-6),
            3 => numbers.around(tiny * 8.0, tiny),
            4 => Aabb {
                min: V::axis(0) * V::Scalar::from_f64(i as f64),
                max: V::axis(0) * V::Scalar::from_f64(i as f64),
            },
            5 => {
                let far = V::splat(V::Scalar::from_f64(1e7));
                let Aabb { min, max } = numbers.around::<V>(10.0, 1.0);
                Aabb { min: min + far, max: max + far }
            }
            // Two towns, of which no single origin is near.
            8 => {
                let far = V::splat(V::Scalar::from_f64(if i % 2 == 0 { 1e9 } else { -1e9 }));
                let Aabb { min, max } = numbers.around::<V>(10.0, 1.0);
                Aabb { min: min + far, max: max + far }
            }
            6 => numbers.around(10f64.powi(-(i as i32 % 30)), 10f64.powi(-(i as i32 % 30))),
            _ => numbers.around(V::Scalar::max_value().as_f64() / 8.0, V::Scalar::max_value().as_f64() / 16.0),
        })
        .collect()
}

/// The bound of one box, by a tree of it alone.
fn bound_of<V: Vector, B: Bound<V>>(question: &B, around: Aabb<V>) -> Option<V::Scalar> {
    let mut bound = None;
    let _ = Bvh::new(&[around]).search(question, V::Scalar::max_value(), |_, b| {
        bound = Some(b);
        ControlFlow::Continue(V::Scalar::max_value())
    });
    bound
}

/// Everything within a limit, and the least: as by asking each box.
fn check<V: Vector, B: Bound<V>>(tree: &Bvh<V>, boxes: &[Option<Aabb<V>>], question: &B, share: f64) -> usize {
    let bounds: Vec<_> = boxes.iter().map(|b| b.and_then(|b| bound_of(question, b))).collect();
    let zero = V::Scalar::ZERO;
    let greatest = bounds.iter().flatten().fold(zero, |a, &b| if b > a { b } else { a });
    let limit = greatest * V::Scalar::from_f64(share);
    let mut found = Vec::new();
    tree.search(question, limit, |item, bound| {
        assert_eq!(Some(bound), bounds[item], "the bound of an item is that of its box");
        found.push(item);
        ControlFlow::Continue(limit)
    });
    found.sort_unstable();
    let due: Vec<_> = (0..boxes.len()).filter(|&i| bounds[i].is_some_and(|b| b <= limit)).collect();
    assert_eq!(found, due, "all within the limit, each once");

    let mut shown = Vec::new();
    tree.within(question, limit, |item| {
        shown.push(item);
        ControlFlow::Continue(())
    });
    shown.sort_unstable();
    let a_little_more = limit * V::Scalar::from_f64(1.0 + 32.0 * V::Scalar::EPSILON.as_f64());
    let may = |i: usize| bounds[i].is_some_and(|b| b <= a_little_more);
    assert!(due.iter().all(|i| shown.contains(i)), "all within the limit, in any order");
    assert!(
        shown.iter().all(|&i| may(i)) && shown.windows(2).all(|w| w[0] < w[1]),
        "and none but for rounding, each once"
    );

    let mut nearest: Option<(V::Scalar, usize)> = None;
    tree.search(question, V::Scalar::max_value(), |item, bound| {
        if nearest.is_none_or(|(b, i)| bound < b || (bound == b && item < i)) {
            nearest = Some((bound, item));
        }
        ControlFlow::Continue(nearest.map_or(bound, |(b, _)| b))
    });
    let least = (0..boxes.len()).filter_map(|i| Some((bounds[i]?, i))).reduce(|a, b| if b.0 < a.0 { b } else { a });
    assert_eq!(nearest, least, "the least bound, and the lowest index of equals");
    found.len()
}

fn pairs<V: Vector>(tree: &Bvh<V>, boxes: &[Option<Aabb<V>>], distance: V::Scalar) -> usize {
    let mut found = Vec::new();
    let mut again = Vec::new();
    tree.pairs_within(distance).visit(|i, j| {
        found.push((i.min(j), i.max(j)));
        ControlFlow::Continue(())
    });
    for piece in tree.pairs_within(distance).split(50) {
        piece.visit(|i, j| {
            again.push((i.min(j), i.max(j)));
            ControlFlow::Continue(())
        });
    }
    let mut due = Vec::new();
    for (i, a) in boxes.iter().enumerate() {
        let Some(a) = a else { continue };
        for (j, b) in boxes.iter().enumerate().skip(i + 1) {
            if b.is_some_and(|b| bound_of(&BoxDistance::new(*a), b).is_some_and(|d| d <= distance)) {
                due.push((i, j));
            }
        }
    }
    found.sort_unstable();
    again.sort_unstable();
    assert_eq!(found, due, "pairs");
    assert_eq!(again, due, "pairs, in pieces");

    for mut nearest in [tree.nearest_pairs_within(), tree.nearest_pairs_within().depth_first()] {
        let told = core::iter::from_fn(|| nearest.next(distance));
        let mut told: Vec<_> = told.map(|([i, j], _)| (i.min(j), i.max(j))).collect();
        told.sort_unstable();
        assert_eq!(told, due, "pairs, mostly the nearest first, or depth first");
    }

    let mut between = Vec::new();
    tree.pairs_between(tree, distance).visit(|i, j| {
        between.push((i, j));
        ControlFlow::Continue(())
    });
    assert_eq!(between.len(), 2 * due.len() + tree.len(), "of two trees, both orders, and each with itself");
    due.len()
}

fn all_kinds<V: Vector>(seed: u64) {
    let mut numbers = Numbers(seed);
    let (mut found, mut near, mut bundles) = (0, 0, 0);
    for kind in 0..KINDS {
        for count in [0, 1, 2, 4, 5, 17, 150] {
            let mut boxes: Vec<Option<Aabb<V>>> = scene(&mut numbers, kind, count).into_iter().map(Some).collect();
            let mut tree = Bvh::new(&boxes.iter().flatten().copied().collect::<Vec<_>>());
            for round in 0..6 {
                for share in [0.0, 0.05, 0.6] {
                    let size = boxes.iter().flatten().next().map_or(1.0, |b| b.center().abs().max_element().as_f64());
                    let (source, direction): (V, V) = (numbers.vector(size * 1.5), numbers.vector(1.0));
                    let along = if round % 2 == 0 { direction } else { V::axis(0) };
                    found += check(
                        &tree,
                        &boxes,
                        &SweptBox::new(numbers.vector::<V>(size * 0.05).abs(), source, along),
                        share,
                    );
                    // Of several at once, beside one another and from anywhere.
                    let several: [_; 4] = core::array::from_fn(|k| {
                        let (at, by) = if k == 3 { (size, 1.0) } else { (size * 0.01, 0.1) };
                        let half: V = numbers.vector::<V>(size * 0.05).abs();
                        SweptBox::new(half, source + numbers.vector(at), along + numbers.vector(by))
                    });
                    let (mut all, mut of) = (several[0], vec![several[0]]);
                    for one in &several[1..] {
                        if let Some(both) = all.and(one) {
                            all = both;
                            of.push(*one);
                        }
                    }
                    bundles += usize::from(of.len() > 1);
                    found += check(&tree, &boxes, &all, share);
                    for (around, one) in
                        boxes.iter().flatten().flat_map(|around| of.iter().map(move |one| (around, one)))
                    {
                        assert!(all.bound(around) <= one.bound(around), "{around:?} by {one:?} of {of:?}");
                    }
                    let box_distance = BoxDistance::new(numbers.around(size, size * 0.1));
                    found += check(&tree, &boxes, &box_distance, share);
                    let radius = V::Scalar::from_f64(size * 0.2 * numbers.signed().abs());
                    let rounded = BoxDistance::rounded(box_distance.of(), radius);
                    found += check(&tree, &boxes, &rounded, share);
                    for around in boxes.iter().flatten() {
                        let (least, most) = (rounded.bound(around), box_distance.bound(around));
                        assert!(
                            least <= most
                                && (least > V::Scalar::ZERO
                                    || most <= radius + radius * V::Scalar::EPSILON * V::Scalar::from_f64(16.0)),
                            "{around:?}"
                        );
                    }
                }
                if round == 0 {
                    near += pairs(&tree, &boxes, V::Scalar::ZERO);
                }
                // Then something changes.
                let others: Vec<Aabb<V>> = scene(&mut numbers, kind, 40);
                match round {
                    0 => {
                        for (i, b) in boxes.iter_mut().enumerate() {
                            *b = Some(others[i % 40]);
                        }
                        tree.refit(|i| others[i % 40]);
                    }
                    1 => {
                        for other in &others {
                            tree.insert(boxes.len(), *other);
                            boxes.push(Some(*other));
                        }
                    }
                    2 => {
                        for _ in 0..boxes.len() / 2 {
                            let i = numbers.below(boxes.len());
                            assert_eq!(tree.remove(i), boxes[i].take().is_some(), "an item is removed once");
                        }
                    }
                    3 => {
                        for other in &others {
                            let i = numbers.below(boxes.len());
                            boxes[i] = Some(*other);
                            tree.set(i, *other);
                        }
                    }
                    _ => tree.rebuild(),
                }
                assert_eq!(tree.len(), boxes.iter().flatten().count(), "the number of items");
                assert!((0..boxes.len()).all(|i| tree.get(i) == boxes[i]), "each with its box");
            }
        }
    }
    assert!(bundles > 500, "{bundles} bundles are no fair sample");
    assert!(found > 5000 && near > 1000, "{found} found, {near} pairs are no fair sample");
}

#[test]
fn solid_double() {
    all_kinds::<DVec3>(1);
}

#[test]
fn planar_double() {
    all_kinds::<DVec2>(2);
}

#[test]
fn single_precision() {
    all_kinds::<Vec3>(3);
    all_kinds::<Vec3A>(4);
    all_kinds::<Vec2>(5);
}

/// A tree grown in order, the order that makes a chain where nothing prevents it, is nearly as good as a built one.
#[test]
fn items_inserted_in_order_make_no_chain() {
    let at = |i: usize| Aabb { min: DVec3::X * i as f64, max: DVec3::X * (i as f64 + 0.5) };
    let mut grown = Bvh::default();
    for i in 0..20_000 {
        grown.insert(i, at(i));
    }
    let built = Bvh::new(&(0..20_000).map(at).collect::<Vec<_>>());
    let look = |tree: &Bvh<DVec3>| {
        (0..20_000)
            .step_by(100)
            .map(|i| tree.search(&BoxDistance::new(at(i)), 0.0, |_, _| ControlFlow::Continue(0.0)))
            .sum()
    };
    let (grown, built): (usize, usize) = (look(&grown), look(&built));
    assert!(grown < 3 * built, "{grown} nodes are looked into where {built} would do");
    // Taken out again in order, to the last.
    let mut tree = Bvh::new(&(0..2000).map(at).collect::<Vec<_>>());
    for i in 0..2000 {
        assert!(tree.remove(i), "item {i} was in the tree");
        let mut left = 0;
        tree.search(&BoxDistance::new(at(1999)), 0.0, |_, _| {
            left += 1;
            ControlFlow::Continue(0.0)
        });
        assert_eq!(left, usize::from(i < 1999), "the last one stays to the end");
    }
    assert!(tree.is_empty(), "nothing is left");
}

/// All of a tree is within reach: the most that can wait to be looked at, in trees as lopsided as they get.
#[test]
fn everything_is_shown_once() {
    let mut numbers = Numbers(0x5EED);
    let size = |i: usize| 10f64.powi(-(i as i32 % 60));
    let mut trees = [Bvh::<DVec3>::default(), Bvh::default(), Bvh::default()];
    for i in 0..5000 {
        trees[0].insert(i, Aabb { min: DVec3::X * i as f64, max: DVec3::X * (i as f64 + 0.5) });
        trees[1].insert(i, numbers.around(size(i), size(i)));
        trees[2].insert(i, numbers.around(1.0, 0.05));
    }
    for (kind, mut tree) in trees.into_iter().enumerate() {
        for removed in [0, 1000, 4000] {
            (0..removed).for_each(|i| _ = tree.remove(i));
            let left = tree.len();
            assert_eq!(left, 5000 - removed, "tree {kind}");
            let question = BoxDistance::new(numbers.around(1.0, 0.0));
            let mut times = vec![0; 5000];
            let nodes = tree.within(&question, f64::INFINITY, |item| {
                times[item] += 1;
                ControlFlow::Continue(())
            });
            assert!((0..5000).all(|i| times[i] == usize::from(i >= removed)), "tree {kind}: each once");
            assert!(nodes <= left, "tree {kind}: {nodes} nodes, each once, which hold two or more");
            // Broken off after any number of items, no more are shown.
            let (mut shown, end) = (0, 1 + numbers.below(left));
            let _ = tree.within(&question, f64::INFINITY, |_| {
                shown += 1;
                if shown < end { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            });
            assert_eq!(shown, end, "tree {kind}");
            let (mut shown, end) = (0, 1 + numbers.below(left));
            let _ = tree.pairs_within(f64::INFINITY).visit(|i, j| {
                assert!(i != j && i >= removed && j >= removed, "tree {kind}: {i} and {j}");
                shown += 1;
                if shown < end { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
            });
            assert_eq!(shown, end, "tree {kind}, pairs");
        }
    }
}

/// A bound is a distance, less what it may be rounded by: of boxes that overlap or touch 0, and of tiny and huge gaps
/// as well.
#[test]
fn bounds_of_boxes_at_every_magnitude() {
    fn check<V: Vector>(magnitudes: &[f64]) {
        let at = |x: V| Aabb { min: x, max: x + V::ONE * V::Scalar::ZERO };
        for &m in magnitudes {
            let m = V::Scalar::from_f64(m);
            let gap = V::from_fn(|axis| [m, m + m, V::Scalar::ZERO][axis % 3]);
            let bound = BoxDistance::new(at(V::ZERO)).bound(&at(gap));
            let slack = V::Scalar::from_f64(1.0 - 16.0 * V::Scalar::EPSILON.as_f64());
            assert!(bound <= gap.norm() && bound >= gap.norm() * slack, "{bound:?} of {gap:?}");
        }
        let overlapping = Aabb { min: -V::ONE, max: V::ONE };
        assert_eq!(BoxDistance::new(overlapping).bound(&at(V::ZERO)), V::Scalar::ZERO, "one in the other");
        assert_eq!(BoxDistance::new(overlapping).bound(&at(V::ONE)), V::Scalar::ZERO, "touching");
        // A ball at a corner is farther from it than the box around the ball.
        let (corner, radius) = (V::splat(V::Scalar::from_f64(5.0)), V::Scalar::from_f64(2.0));
        let ball = Posed::translated(Ball::<V>::new(radius).expect("a radius"), corner).expect("a place");
        let by_ball = BoxDistance::of_shape(&ball).expect("finite").bound(&overlapping);
        let due = V::splat(V::Scalar::from_f64(4.0)).norm() - radius;
        let slack = V::Scalar::from_f64(1.0 - 512.0 * V::Scalar::EPSILON.as_f64());
        assert!(by_ball <= due && by_ball >= due * slack, "{by_ball:?} or {due:?}");
        let by_box = BoxDistance::new(outer_box(&ball).expect("finite")).bound(&overlapping);
        assert!(by_box < due * V::Scalar::from_f64(0.8), "{by_box:?}");
    }
    let double = [1e-300, 1e-160, 1e-8, 1.0, 1e8, 1e160, 1e300];
    check::<DVec3>(&double);
    check::<DVec2>(&double);
    let single = [1e-30, 1e-20, 1e-8, 1.0, 1e8, 1e20, 1e30];
    check::<Vec2>(&single);
    check::<Vec3>(&single);
    check::<Vec3A>(&single);
}

/// Each tree sees boxes from its own origin and in its own unit; which pairs there are does not depend on that.
#[test]
fn pairs_of_trees_that_see_differently() {
    let mut numbers = Numbers(6);
    for (reach, outlier) in [(1.0, 1e3), (1e-5, 1e12), (1e3, 1e-3)] {
        let mut boxes = || (0..80).map(|_| numbers.around::<DVec3>(1.0, 0.3)).collect::<Vec<_>>();
        let (a, mut b) = (boxes(), boxes());
        b.extend(boxes().iter().map(|around| {
            let away = DVec3::splat(outlier);
            Aabb { min: around.min * reach + away, max: around.max * reach + away }
        }));
        let (tree, other) = (Bvh::new(&a), Bvh::new(&b));
        let (mut found, mut back, mut due) = (Vec::new(), Vec::new(), Vec::new());
        tree.pairs_between(&other, 0.05).visit(|i, j| {
            found.push((i, j));
            ControlFlow::Continue(())
        });
        other.pairs_between(&tree, 0.05).visit(|j, i| {
            back.push((i, j));
            ControlFlow::Continue(())
        });
        for (i, a) in a.iter().enumerate() {
            due.extend((0..b.len()).filter(|&j| BoxDistance::new(*a).bound(&b[j]) <= 0.05).map(|j| (i, j)));
        }
        found.sort_unstable();
        back.sort_unstable();
        assert!(due.len() > 80, "no fair sample");
        assert_eq!((&found, &back), (&due, &due), "pairs, and the same in the other order");
    }
}

/// What cannot be culled is looked at once: the work is proportional to what is found.
#[test]
fn coincident_boxes_cost_what_they_are() {
    let one = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    let tree = Bvh::new(&vec![one; 10_000]);
    let mut found = 0;
    let nodes = tree.search(&BoxDistance::new(one), 0.0, |_, _| {
        found += 1;
        ControlFlow::Continue(0.0)
    });
    assert!(found == 10_000 && nodes < 10_000, "{found} found in {nodes} nodes");
    // Those apart from the rest are found at once.
    let apart = tree.search(&BoxDistance::new(Aabb { min: DVec3::splat(3.0), max: DVec3::splat(4.0) }), 1.0, |_, _| {
        ControlFlow::Continue(1.0)
    });
    assert_eq!(apart, 1, "the root says that nothing is near");
}

#[test]
fn nothing_is_within_a_negative_distance() {
    let square = |x: f64| Aabb { min: DVec2::new(x, 0.0), max: DVec2::new(x + 1.0, 1.0) };
    let tree = Bvh::new(&[square(0.0), square(0.5), square(9.0)]);
    let (mut pairs, mut shown) = (0, 0);
    tree.pairs_within(-1.0).visit(|_, _| {
        pairs += 1;
        ControlFlow::Continue(())
    });
    tree.within(&BoxDistance::new(square(0.0)), -1.0, |_| {
        shown += 1;
        ControlFlow::Continue(())
    });
    assert_eq!((pairs, shown), (0, 0), "boxes that overlap are 0 apart");
}

#[test]
fn numbers_that_are_not_finite_do_no_harm() {
    let nan = Aabb { min: DVec3::NAN, max: DVec3::NAN };
    let all = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
    let good = |i: usize| Aabb { min: DVec3::X * i as f64, max: DVec3::X * (i as f64 + 0.5) };
    let mut tree = Bvh::new(&[good(0), nan, good(2), all, nan, good(5), nan]);
    for i in 7..40 {
        tree.insert(i, [nan, all, good(i)][i % 3]);
    }
    tree.refit(|i| [nan, all, good(i)][i % 3]);
    tree.rebuild();
    let _ = tree
        .search(&SweptBox::new(DVec3::NAN, DVec3::NAN, DVec3::NAN), f64::NAN, |_, _| ControlFlow::Continue(f64::NAN));
    let _ = tree.pairs_within(f64::NAN).visit(|_, _| ControlFlow::Continue(()));
    assert_eq!(tree.len(), 40, "all are counted");
}
