//! A shape somewhere on its way.

use core::cell::Cell;

use convex_support::{
    Core, CoreKind, Feature, Hint, Matrix, Parallelotope, Rounding, Scalar, ScalarOf, SupportMap, Vector,
};

/// A shape turned by a rotation, whose origin is put where one wants it, and whose radius may be grown.
pub(crate) struct Moved<'s, S: SupportMap + ?Sized> {
    shape: &'s S,
    rotation: <S::Vector as Vector>::Matrix,
    core: Core<S::Vector>,
    rounding: Rounding<S::Vector>,
    /// Where what one query found is kept for the next.
    hint: Option<&'s Cell<Hint>>,
}

impl<'s, S: SupportMap + ?Sized> Moved<'s, S> {
    /// The shape with the given core, which may have another origin and another radius than its own, turned by `rotation` about the
    /// origin. Before that its points were known as `rounding` says, and moving it took them where they should be but for `error`.
    #[inline]
    pub(crate) fn new(
        shape: &'s S,
        core: Core<S::Vector>,
        rotation: <S::Vector as Vector>::Matrix,
        rounding: Rounding<S::Vector>,
        error: ScalarOf<S>,
    ) -> Self {
        let kind = match core.kind {
            CoreKind::Point(at) => CoreKind::Point(rotation * at),
            kind => kind,
        };
        let rounding = if rotation == Matrix::IDENTITY {
            let error_length = rounding.error_length + error;
            Rounding { error: rounding.error + Vector::splat(error), error_length, ..rounding }
        } else {
            // The length of an error stays. The product with the matrix is wrong by at most three ε of the extent, and so may be the
            // support value along a direction that is turned.
            let error = rounding.error_length + error + ScalarOf::<S>::from_f64(6.0) * Scalar::EPSILON * core.extent;
            Rounding { extent: Vector::splat(core.extent), error: Vector::splat(error), error_length: error }
        };
        Self { shape, rotation, core: Core { kind, error: rounding.error_length, ..core }, rounding, hint: None }
    }

    /// A vector of the shape as it is turned.
    #[inline]
    pub(super) fn turned(&self, vector: S::Vector) -> S::Vector {
        self.rotation * vector
    }

    /// A vector of the turned shape as it was.
    #[inline]
    pub(super) fn before(&self, vector: S::Vector) -> S::Vector {
        self.rotation.transpose_mul(vector)
    }

    /// The same, which begins its searches where the last ones ended, whoever made them.
    pub(super) fn with_hint(self, hint: &'s Cell<Hint>) -> Self {
        Self { hint: Some(hint), ..self }
    }
}

impl<S: SupportMap + ?Sized> SupportMap for Moved<'_, S> {
    type Vector = S::Vector;

    fn support(&self, direction: S::Vector) -> S::Vector {
        let swept = direction.unit().unwrap_or_else(|| Vector::axis(0)) * self.core.radius;
        self.core.origin + self.core_support(direction, &mut Hint::new()) + swept
    }

    #[inline]
    fn core(&self) -> Core<S::Vector> {
        self.core
    }

    #[inline(always)]
    fn core_support(&self, direction: S::Vector, hint: &mut Hint) -> S::Vector {
        let local = self.rotation.transpose_mul(direction);
        let Some(kept) = self.hint else { return self.rotation * self.shape.core_support(local, hint) };
        let mut hint = kept.get();
        hint.rewind();
        let point = self.shape.core_support(local, &mut hint);
        kept.set(hint);
        self.rotation * point
    }

    #[inline(always)]
    fn core_support_hessian(&self, direction: S::Vector, changes: [S::Vector; 2]) -> [ScalarOf<S>; 3] {
        let turned = |v| self.rotation.transpose_mul(v);
        self.shape.core_support_hessian(turned(direction), [turned(changes[0]), turned(changes[1])])
    }

    #[inline]
    fn core_closest_point(&self, x: S::Vector) -> Option<S::Vector> {
        Some(self.rotation * self.shape.core_closest_point(self.rotation.transpose_mul(x))?)
    }

    fn core_support_feature(&self, direction: S::Vector, slab: ScalarOf<S>, feature: &mut Feature<S::Vector>) {
        self.shape.core_support_feature(self.rotation.transpose_mul(direction), slab, feature);
        feature.map(|point| self.rotation * point);
    }

    #[inline]
    fn core_parallelotope(&self) -> Option<Parallelotope<S::Vector>> {
        let Parallelotope { center, half_edges } = self.shape.core_parallelotope()?;
        Some(Parallelotope { center: self.rotation * center, half_edges: half_edges.map(|edge| self.rotation * edge) })
    }

    fn rounding(&self) -> Rounding<S::Vector> {
        self.rounding
    }
}
