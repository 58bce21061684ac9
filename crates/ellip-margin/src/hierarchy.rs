//! A tree of boxes over ellipsoids: which of many can be near, without looking at each.

use alloc::vec::Vec;

/// An axis-aligned box; unused coordinates are 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aabb {
    pub(crate) center: [f64; 3],
    pub(crate) half: [f64; 3],
}

impl Aabb {
    fn union(self, other: Self) -> Self {
        let low: [f64; 3] =
            core::array::from_fn(|i| (self.center[i] - self.half[i]).min(other.center[i] - other.half[i]));
        let high: [f64; 3] =
            core::array::from_fn(|i| (self.center[i] + self.half[i]).max(other.center[i] + other.half[i]));
        let center: [f64; 3] = core::array::from_fn(|i| 0.5 * low[i] + 0.5 * high[i]);
        // Outward, so that rounding never lets a part of an ellipsoid out.
        let half = core::array::from_fn(|i| {
            let half = (high[i] - center[i]).max(center[i] - low[i]);
            half + 4.0 * f64::EPSILON * (half + center[i].abs())
        });
        Self { center, half }
    }
}

/// What a node holds: the two halves, or up to [`LEAF`] of the items.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Node<'a> {
    /// The indices of two nodes.
    Split(usize, usize),
    /// The items.
    Leaf(&'a [usize]),
}

/// A binary tree of boxes; node 0 is the root, and the first half of a node comes right after it.
#[derive(Clone, Debug)]
pub(crate) struct Hierarchy {
    boxes: Vec<Aabb>,
    spans: Vec<Span>,
    items: Vec<usize>,
}

/// The range of a node's items, and the node of its second half; 0 in a leaf.
#[derive(Clone, Copy, Debug)]
struct Span {
    start: usize,
    end: usize,
    second: usize,
}

/// The largest number of items in a leaf.
const LEAF: usize = 2;

impl Hierarchy {
    /// A tree over `boxes`, of which there is at least one: split at the median along the longest side.
    pub(crate) fn new(boxes: &[Aabb]) -> Self {
        let mut tree = Self { boxes: Vec::new(), spans: Vec::new(), items: (0..boxes.len()).collect() };
        tree.build(boxes, 0, boxes.len());
        tree
    }

    /// Depth is the logarithm of the number of items: halves are equal.
    fn build(&mut self, boxes: &[Aabb], start: usize, end: usize) {
        let index = self.spans.len();
        let around = union(boxes, &self.items[start..end]);
        self.boxes.push(around);
        self.spans.push(Span { start, end, second: 0 });
        if end - start > LEAF {
            let axis = (1..3).fold(0, |a, i| if around.half[i] > around.half[a] { i } else { a });
            let half = (end - start) / 2;
            self.items[start..end]
                .select_nth_unstable_by(half, |&a, &b| boxes[a].center[axis].total_cmp(&boxes[b].center[axis]));
            self.build(boxes, start, start + half);
            self.spans[index].second = self.spans.len();
            self.build(boxes, start + half, end);
        }
    }

    /// The same tree around the items where they are now.
    pub(crate) fn refit(&mut self, boxes: &[Aabb]) {
        // Children come after their parents.
        for index in (0..self.spans.len()).rev() {
            self.boxes[index] = match self.node(index) {
                Node::Split(a, b) => self.boxes[a].union(self.boxes[b]),
                Node::Leaf(items) => union(boxes, items),
            };
        }
    }

    #[inline]
    pub(crate) fn node(&self, index: usize) -> Node<'_> {
        let Span { start, end, second } = self.spans[index];
        if second == 0 { Node::Leaf(&self.items[start..end]) } else { Node::Split(index + 1, second) }
    }

    /// Looks at all items of the leaves whose boxes, and those above, may concern.
    #[inline]
    pub(crate) fn search(&self, concerns: impl Fn(&Aabb) -> bool, mut look: impl FnMut(usize)) {
        // Halves are equal: the depth is below 64 for any list that fits a memory, and each level leaves one node.
        let mut stack = [0; 64];
        let mut depth = 1;
        while depth > 0 {
            depth -= 1;
            let node = stack[depth];
            if !concerns(self.bounds(node)) {
                continue;
            }
            match self.node(node) {
                Node::Split(a, b) => {
                    (stack[depth], stack[depth + 1]) = (b, a);
                    depth += 2;
                }
                Node::Leaf(items) => items.iter().for_each(|&item| look(item)),
            }
        }
    }

    #[inline]
    pub(crate) fn bounds(&self, index: usize) -> &Aabb {
        &self.boxes[index]
    }

    /// The number of items under node `index`.
    #[inline]
    pub(crate) fn count(&self, index: usize) -> usize {
        self.spans[index].end - self.spans[index].start
    }
}

/// The box around the boxes of `items`, of which there is at least one.
fn union(boxes: &[Aabb], items: &[usize]) -> Aabb {
    items[1..].iter().fold(boxes[items[0]], |sum, &i| sum.union(boxes[i]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_once_and_within_its_boxes() {
        let at = |i: usize| Aabb { center: [(i * 37 % 101) as f64, (i * 53 % 89) as f64, 0.0], half: [0.5, 0.25, 0.0] };
        for n in [1, 2, 3, 100] {
            let boxes: Vec<Aabb> = (0..n).map(at).collect();
            let tree = Hierarchy::new(&boxes);
            assert_eq!(tree.count(0), n, "all items under the root");
            let mut seen = alloc::vec![0; n];
            let mut stack = alloc::vec![(0, alloc::vec![])];
            while let Some((index, mut above)) = stack.pop() {
                above.push(*tree.bounds(index));
                match tree.node(index) {
                    Node::Split(a, b) => stack.extend([(a, above.clone()), (b, above)]),
                    Node::Leaf(items) => {
                        for &item in items {
                            seen[item] += 1;
                            for b in &above {
                                let inside = (0..3).all(|k| {
                                    (boxes[item].center[k] - b.center[k]).abs() + boxes[item].half[k] <= b.half[k]
                                });
                                assert!(inside, "item {item} lies within every box above it");
                            }
                        }
                    }
                }
            }
            assert!(seen.iter().all(|&s| s == 1), "each item in one leaf");
        }
    }
}
