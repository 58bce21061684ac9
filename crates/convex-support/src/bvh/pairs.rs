//! Pairs of items whose boxes are near each other, of one tree or of two.

use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::Bvh;
use super::bound::{Bound, BoxDistance};
use super::node::{Boxes, Child, Link, Node, WIDTH};
use super::search::{MAX_DEPTH, finite};
use crate::glam::{Vec3A, Vec4, Vec4Swizzles as _};
use crate::{Aabb, Scalar as _, Vector};

/// Two nodes leave at most 16 pairs of children, and a node and an item 4, one of which is searched next.
const PAIR_STACK: usize = (WIDTH * WIDTH + WIDTH) * MAX_DEPTH;

/// The pairs of items whose boxes are within a distance; found by [`visit`](Self::visit), in [pieces](Self::split) if
/// need be.
#[derive(Clone, Copy, Debug)]
pub struct PairSearch<'t, V: Vector> {
    pub(super) a: &'t Bvh<V>,
    pub(super) b: &'t Bvh<V>,
    /// Whether both trees are the same one, so that each pair counts once.
    pub(super) same: bool,
    distance: V::Scalar,
    /// At least the distance, in the frames of the trees.
    rooms: [f32; 2],
    pub(super) start: Pair,
}

/// How many pairs of items are found before their own boxes are tested: one after the other and without a branch, so
/// that boxes outside the caches are fetched together.
const PAIR_BATCH: usize = 4 * WIDTH * WIDTH;

/// A child of the first tree and one of the second.
pub(super) type Pair = (Link, Link);

#[inline(always)]
pub(super) fn are_items((a, b): Pair) -> bool {
    a.is_item() & b.is_item()
}

impl<V: Vector> Bvh<V> {
    /// All pairs of different items whose boxes are at most `distance` apart, each once.
    #[must_use]
    pub fn pairs_within(&self, distance: V::Scalar) -> PairSearch<'_, V> {
        PairSearch { same: true, ..self.pairs_between(self, distance) }
    }

    /// All pairs of an item of this tree and one of `other` whose boxes are at most `distance` apart.
    #[must_use]
    pub fn pairs_between<'t>(&'t self, other: &'t Self, distance: V::Scalar) -> PairSearch<'t, V> {
        let rooms = [self, other].map(|tree| tree.frame.unit().limit(distance.as_f64()));
        PairSearch { a: self, b: other, same: false, distance, rooms, start: (Link::ROOT, Link::ROOT) }
    }

    /// The box of a child, which is not the root, in the tree's frame.
    #[inline]
    pub(super) fn seen(&self, child: Child) -> Aabb<Vec3A> {
        let slot = match child {
            Child::Item(item) => self.slots[item],
            Child::Node(node) => self.nodes[node].parent,
            Child::None => return Aabb { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY },
        };
        self.nodes[slot.node()].boxes.get(slot.lane())
    }
}

impl<'t, V: Vector> PairSearch<'t, V> {
    /// Visits every pair, in no particular order, until `visit` breaks off. Returns the number of pairs of nodes, or of
    /// a node and an item, that were tested.
    pub fn visit(self, mut visit: impl FnMut(usize, usize) -> ControlFlow<()>) -> usize {
        let mut looked = 0;
        let Some(distance) = finite(self.distance) else { return looked };
        let (mut stack, mut found) = ([self.start; PAIR_STACK], [self.start; PAIR_BATCH]);
        let (mut top, mut count) = if are_items(self.start) { (0, 1) } else { (1, 0) };
        while top > 0 {
            top -= 1;
            looked += 1;
            self.expand(stack[top], |pair| {
                if are_items(pair) {
                    (found[count], count) = (pair, count + 1);
                } else {
                    (stack[top], top) = (pair, top + 1);
                }
            });
            if count > PAIR_BATCH - WIDTH * WIDTH {
                if self.show(&found[..count], distance, &mut visit).is_break() {
                    return looked;
                }
                count = 0;
            }
        }
        // The search is over, so a break no longer matters.
        let _ = self.show(&found[..count], distance, &mut visit);
        looked
    }

    /// Visits those of some pairs of items, at most a batch, whose own boxes are near. By coarse bounds, all are.
    #[inline(always)]
    fn show(
        &self,
        pairs: &[Pair],
        distance: V::Scalar,
        visit: &mut impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut are_near = [false; PAIR_BATCH];
        for (is_near, (a, b)) in are_near.iter_mut().zip(pairs) {
            let bound = BoxDistance::new(self.a.boxes[a.index()]).bound(&self.b.boxes[b.index()]);
            *is_near = bound <= distance;
        }
        let mut near = pairs.iter().zip(are_near).filter(|(_, is_near)| *is_near);
        near.try_for_each(|((a, b), _)| visit(a.index(), b.index()))
    }

    /// The same search in pieces, `at_least` so many if there are as many pairs, for as many threads. The pieces do not
    /// depend on the number of threads.
    #[must_use]
    pub fn split(self, at_least: usize) -> Vec<Self> {
        let mut pieces = VecDeque::from([self.start]);
        let mut whole = 0;
        while pieces.len() < at_least && whole < pieces.len() {
            let Some(pair) = pieces.pop_front() else { break };
            if are_items(pair) {
                pieces.push_back(pair);
                whole += 1;
            } else {
                whole = 0;
                self.expand(pair, |next| pieces.push_back(next));
            }
        }
        pieces.into_iter().map(|start| Self { start, ..self }).collect()
    }

    /// Boxes of the first tree in the frame of the second.
    pub(super) fn as_b_sees(&self, boxes: &Boxes) -> Boxes {
        let mut seen = *boxes;
        for lane in 0..WIDTH {
            seen.set(lane, self.b.frame.outwards_from(&self.a.frame, &boxes.get(lane)));
        }
        seen
    }

    /// The pairs of children of a pair whose boxes are near, by coarse bounds. Not for two items.
    #[inline(always)]
    fn expand(&self, (a, b): Pair, mut push: impl FnMut(Pair)) {
        match (a.child(), b.child()) {
            (Child::Node(i), Child::Node(j)) => {
                let (first, second) = (&self.a.nodes[i], &self.b.nodes[j]);
                let mut near = if self.same {
                    near_pairs::<V>(&first.boxes, &second.boxes, self.rooms[1])
                } else {
                    near_pairs::<V>(&self.as_b_sees(&first.boxes), &second.boxes, self.rooms[1])
                };
                let is_one = self.same && i == j;
                if is_one {
                    // A pair counts once, and an item makes none with itself.
                    near &= 0b0000_1000_1100_1110;
                }
                while near != 0 {
                    let bit = near.trailing_zeros() as usize;
                    near &= near - 1;
                    let (a, b) = (first.children[bit / WIDTH], second.children[bit % WIDTH]);
                    if a != Link::NONE && b != Link::NONE {
                        push((a, b));
                    }
                }
                if is_one {
                    // On top, so that each part is searched by itself, in the order of its nodes in memory, before
                    // parts are compared.
                    for link in first.children {
                        if let Child::Node(_) = link.child() {
                            push((link, link));
                        }
                    }
                }
            }
            (Child::Node(i), other @ Child::Item(_)) => {
                let around = self.b.seen(other);
                let around = if self.same { around } else { self.a.frame.outwards_from(&self.b.frame, &around) };
                near::<V>(&around, self.rooms[0], &self.a.nodes[i], |link| push((link, b)));
            }
            (other @ Child::Item(_), Child::Node(j)) => {
                let around = self.a.seen(other);
                let around = if self.same { around } else { self.b.frame.outwards_from(&self.a.frame, &around) };
                near::<V>(&around, self.rooms[1], &self.b.nodes[j], |link| push((a, link)));
            }
            _ => {}
        }
    }
}

/// The children of a node that are near a box: no farther along any coordinate.
#[inline(always)]
fn near<V: Vector>(around: &Aabb<Vec3A>, room: f32, node: &Node, mut push: impl FnMut(Link)) {
    let all_of = |corner: Vec3A| [Vec4::splat(corner.x), Vec4::splat(corner.y), Vec4::splat(corner.z)];
    let boxes = grown(&node.boxes, room);
    let mut near = are_near::<V>(&all_of(around.min), &all_of(around.max), &boxes);
    while near != 0 {
        let link = node.children[near.trailing_zeros() as usize];
        near &= near - 1;
        if link != Link::NONE {
            push(link);
        }
    }
}

/// The pairs of boxes that are near each other: a bit for each, four for the first box of `a`.
#[inline(always)]
fn near_pairs<V: Vector>(a: &Boxes, b: &Boxes, room: f32) -> u32 {
    let b = grown(b, room);
    let (min, max) = (by_lane(a.min(0), a.min(1), a.min(2)), by_lane(a.max(0), a.max(1), a.max(2)));
    (0..WIDTH).fold(0, |near, lane| near | are_near::<V>(&min[lane], &max[lane], &b) << (WIDTH * lane))
}

/// Coordinates of four points, each in all places of a vector. They stay in registers: a vector that was written to
/// memory number by number makes the processor wait.
#[inline(always)]
fn by_lane(x: Vec4, y: Vec4, z: Vec4) -> [[Vec4; 3]; WIDTH] {
    [
        [x.xxxx(), y.xxxx(), z.xxxx()],
        [x.yyyy(), y.yyyy(), z.yyyy()],
        [x.zzzz(), y.zzzz(), z.zzzz()],
        [x.wwww(), y.wwww(), z.wwww()],
    ]
}

/// Boxes enlarged by this room. A number not above the exact sum is not above the rounded one.
#[inline(always)]
fn grown(boxes: &Boxes, room: f32) -> [[Vec4; 2]; 3] {
    let room = Vec4::splat(room);
    core::array::from_fn(|axis| [boxes.min(axis) - room, boxes.max(axis) + room])
}

/// Which of four boxes have a point in common with another, a bit for each. (glam's own mask is of another type with
/// its feature `scalar-math`, which parry's `enhanced-determinism` turns on.)
#[inline(always)]
fn are_near<V: Vector>(min: &[Vec4; 3], max: &[Vec4; 3], boxes: &[[Vec4; 2]; 3]) -> u32 {
    let along = |axis: usize| {
        let [low, high]: [Vec4; 2] = boxes[axis];
        min[axis].cmple(high) & max[axis].cmpge(low)
    };
    let in_plane = along(0) & along(1);
    if V::DIM == 2 { in_plane.bitmask() } else { (in_plane & along(2)).bitmask() }
}
