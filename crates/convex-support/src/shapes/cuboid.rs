//! A box about the origin, along the axes.

use crate::error::{InvalidShape, finite, measurable};
use crate::line_crossing::crossed_by_line::closely;
use crate::line_crossing::{NearLine, cuboid, lanes, rounded_cuboid};
use crate::{
    CertainCrossing, Close, CloseLine, Core, CoreKind, CrossedByLine, Feature, LineCrossing, LineQuery, Lines,
    Parallelotope, Rounding, Scalar, SupportMap, Vector,
};

/// The box `|xᵢ| ≤ half_extentsᵢ`; a rectangle in 2D.
///
/// ```
/// use convex_support::{Cuboid, SupportMap, glam::DVec3};
///
/// let cuboid = Cuboid::new(DVec3::new(1.0, 2.0, 3.0))?;
/// assert_eq!(cuboid.support(DVec3::new(1.0, -1.0, 1.0)), DVec3::new(1.0, -2.0, 3.0));
/// # Ok::<(), convex_support::InvalidShape>(())
/// ```
#[doc(alias("box", "obb", "rectangle"))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid<V: Vector> {
    half_extents: V,
    extent: V::Scalar,
}

impl<V: Vector> Cuboid<V> {
    /// The box with the given half extents, any of which may be 0.
    ///
    /// # Errors
    /// [`InvalidShape`] naming the half extent that is negative or not finite, or if the diagonal is longer than the
    /// largest number.
    pub fn new(half_extents: V) -> Result<Self, InvalidShape> {
        let half_extents = finite("half_extents", half_extents)?;
        match (0..V::DIM).find(|&i| half_extents.get(i) < V::Scalar::ZERO) {
            Some(index) => Err(InvalidShape::Negative {
                parameter: "half_extents",
                index,
                value: half_extents.get(index).as_f64(),
            }),
            None => Ok(Self { half_extents, extent: measurable("half_extents", half_extents.norm())? }),
        }
    }

    /// Half the size along each axis.
    #[must_use]
    pub fn half_extents(&self) -> V {
        self.half_extents
    }

    /// Where a line certainly enters the box swept by a ball.
    #[inline(never)]
    fn certain_crossing_swept(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        NearLine::new(line, V::ZERO, self.extent + line.radius)?.rounded_cuboid(self.half_extents, line.radius)
    }
}

impl<V: Vector> SupportMap for Cuboid<V> {
    type Vector = V;

    #[inline]
    fn support(&self, direction: V) -> V {
        self.half_extents.copysign(direction)
    }

    #[inline(always)]
    fn core(&self) -> Core<V> {
        Core::exact(CoreKind::Polytope, self.extent)
    }

    #[inline]
    fn core_closest_point(&self, x: V) -> Option<V> {
        Some(x.max(-self.half_extents).min(self.half_extents))
    }

    #[inline(always)]
    fn certain_crossing(&self, line: LineQuery<V>) -> Option<CertainCrossing<V>> {
        if line.is_close {
            return closely(self, line);
        }
        if line.radius > V::Scalar::ZERO {
            return self.certain_crossing_swept(line);
        }
        NearLine::new(line, V::ZERO, self.extent)?.cuboid(self.half_extents)
    }

    fn core_support_feature(&self, direction: V, slab: V::Scalar, feature: &mut Feature<V>) {
        for i in 0..1 << V::DIM {
            let sign = V::from_fn(|axis| if i >> axis & 1 == 1 { -V::Scalar::ONE } else { V::Scalar::ONE });
            let corner = self.half_extents * sign;
            // Each coordinate on the wrong side puts the corner behind the farthest one by twice its part.
            let along = direction * corner;
            if (along.abs() - along).dot(V::ONE) <= slab {
                feature.push(corner, i);
            }
        }
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<V>> {
        let half_edge = |i: usize| if i < V::DIM { V::axis(i) * self.half_extents.get(i) } else { V::ZERO };
        Some(Parallelotope { center: V::ZERO, half_edges: [half_edge(0), half_edge(1), half_edge(2)] })
    }

    fn close_crossing(&self, line: &CloseLine) -> Close {
        line.cuboid(self.half_extents)
    }

    fn rounding(&self) -> Rounding<V> {
        Rounding::exact(self.half_extents)
    }
}

impl<V: Vector> CrossedByLine for Cuboid<V> {
    #[inline(always)]
    fn core_line_crossing(&self, source: V, direction: V, radius: V::Scalar) -> LineCrossing<V> {
        if radius > V::Scalar::ZERO {
            return rounded_cuboid(self.half_extents, radius, source, direction).into();
        }
        cuboid(self.half_extents, source, direction).into()
    }

    #[inline]
    fn certain_crossings(&self, lines: &mut Lines<V::Scalar>) -> bool {
        lanes::cuboid(lines, self.half_extents, self.extent);
        true
    }
}
