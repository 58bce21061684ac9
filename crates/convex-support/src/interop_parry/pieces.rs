// What is made of convex pieces: compounds, triangle meshes and polylines.

use alloc::sync::Arc;
use core::fmt;

use parry::shape::{Shape, ShapeType, TypedShape};

/// A convex shape of any kind, shared as parry's `SharedShape` is.
pub type SharedConvex = Arc<dyn SupportMap<Vector = V> + Send + Sync>;

/// A convex piece of one of parry's shapes, and its pose in the shape's frame.
#[derive(Clone)]
pub struct Piece {
    /// The piece in its own frame.
    pub shape: SharedConvex,
    /// The pose of the piece in the frame of the whole.
    pub pose: Pose,
}

impl Piece {
    /// The piece in place, given the pose of the whole.
    ///
    /// # Errors
    /// Those of [`posed`].
    pub fn at(&self, whole: &Pose) -> Result<Posed<SharedConvex>, InvalidShape> {
        posed(self.shape.clone(), &(*whole * self.pose))
    }
}

impl fmt::Debug for Piece {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Piece").field("core", &self.shape.core()).field("pose", &self.pose).finish()
    }
}

/// Why one of parry's shapes has no counterpart here.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Unconvertible {
    /// A piece is of a kind that is no bounded convex shape, nor made of such, as far as this crate knows.
    Kind {
        /// The index of the piece; 0 for a shape that has no pieces.
        piece: usize,
        /// Its kind.
        kind: ShapeType,
    },
    /// The shape cannot have a number of a piece here.
    Number {
        /// The index of the piece; 0 for a shape that has no pieces.
        piece: usize,
        /// Its kind.
        kind: ShapeType,
        /// The error of the constructor, with the number.
        why: InvalidShape,
    },
}

impl fmt::Display for Unconvertible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Kind { piece, kind } => {
                write!(f, "piece {piece} is a {kind:?}, which is not a bounded convex shape or made of such")
            }
            Self::Number { piece, kind, why } => write!(f, "piece {piece}, a {kind:?}: {why}"),
        }
    }
}

impl core::error::Error for Unconvertible {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Kind { .. } => None,
            Self::Number { why, .. } => Some(why),
        }
    }
}

/// The convex pieces of a parry shape of any kind, in parry's order: the shapes of a `Compound`, the triangles of a
/// `TriMesh`, the segments of a `Polyline`; a convex shape is one piece. A scene of the pieces answers questions
/// about the whole.
///
/// parry's `to_trimesh` in 3D and `to_polyline` in the plane make a mesh of a height field. A half-space is
/// unbounded: it is a body of a scene by itself. For a large mesh, [`triangles`] takes less memory.
///
/// # Errors
/// [`Unconvertible`] for the first piece that has no counterpart here.
pub fn pieces(shape: &dyn Shape) -> Result<Vec<Piece>, Unconvertible> {
    let here = |shape| Piece { shape, pose: Pose::IDENTITY };
    match shape.as_typed_shape() {
        TypedShape::Compound(compound) => {
            let piece = |(index, (pose, shape)): (usize, &(Pose, theirs::SharedShape))| {
                Ok(Piece { shape: convex(index, &**shape)?, pose: *pose })
            };
            compound.shapes().iter().enumerate().map(piece).collect()
        }
        TypedShape::TriMesh(mesh) => {
            Ok(triangles(mesh)?.into_iter().map(|triangle| here(Arc::new(triangle))).collect())
        }
        TypedShape::Polyline(line) => {
            line.segments().enumerate().map(|(index, segment)| convex(index, &segment).map(here)).collect()
        }
        _ => Ok(Vec::from([here(convex(0, shape)?)])),
    }
}

/// The triangles of a mesh in its frame, in parry's order and with parry's orientation, even if the mesh was scaled
/// or reversed: the bodies of a scene that knows the fronts of its triangles.
///
/// In 3D they are a surface: the space that it encloses is not part of them.
///
/// # Errors
/// [`Unconvertible::Number`] for the first triangle with a coordinate that is not finite.
pub fn triangles(mesh: &theirs::TriMesh) -> Result<Vec<Triangle<V>>, Unconvertible> {
    let triangle = |(piece, triangle)| {
        Triangle::try_from(triangle).map_err(|why| Unconvertible::Number { piece, kind: ShapeType::Triangle, why })
    };
    mesh.triangles().enumerate().map(triangle).collect()
}

/// The convex shape that this is, as a piece with this index.
fn convex(piece: usize, shape: &dyn Shape) -> Result<SharedConvex, Unconvertible> {
    let kind = shape.shape_type();
    let made = match shape.as_typed_shape() {
        TypedShape::Ball(ball) => shared(Ball::try_from(*ball)),
        TypedShape::Cuboid(cuboid) => shared(Cuboid::try_from(*cuboid)),
        TypedShape::Capsule(capsule) => shared(Rounded::<Segment<V>>::try_from(*capsule)),
        TypedShape::Segment(segment) => shared(Segment::try_from(*segment)),
        TypedShape::Triangle(triangle) => shared(Triangle::try_from(*triangle)),
        TypedShape::RoundCuboid(round) => rounded(Cuboid::try_from(round.inner_shape), round.border_radius),
        TypedShape::RoundTriangle(round) => rounded(Triangle::try_from(round.inner_shape), round.border_radius),
        other => convex_of_dimension(other).ok_or(Unconvertible::Kind { piece, kind })?,
    };
    made.map_err(|why| Unconvertible::Number { piece, kind, why })
}

fn shared<S: SupportMap<Vector = V> + Send + Sync + 'static>(
    shape: Result<S, InvalidShape>,
) -> Result<SharedConvex, InvalidShape> {
    shape.map(|shape| Arc::new(shape) as SharedConvex)
}

fn rounded<S: SupportMap<Vector = V> + Send + Sync + 'static>(
    shape: Result<S, InvalidShape>,
    radius: crate::ScalarOf<S>,
) -> Result<SharedConvex, InvalidShape> {
    shared(shape.and_then(|shape| Rounded::new(shape, radius)))
}

#[cfg(test)]
mod tests_of_pieces {
    use super::*;
    use crate::interop_parry::same;
    use crate::{Scalar, Vector as Space};

    fn vector(v: [f64; 3]) -> V {
        <V as Space>::from_fn(|axis| Scalar::from_f64(v[axis]))
    }

    fn mesh() -> theirs::TriMesh {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]].map(|v| parrys(vector(v)));
        theirs::TriMesh::new(corners.to_vec(), alloc::vec![[0, 1, 2], [1, 3, 2]]).expect("two triangles")
    }

    /// parry's support map of a shape of any kind.
    struct Any<'a>(&'a dyn theirs::SupportMap);

    impl theirs::SupportMap for Any<'_> {
        fn local_support_point(&self, dir: ParryVector) -> ParryVector {
            self.0.local_support_point(dir)
        }
    }

    #[test]
    fn every_piece_is_parrys_where_parry_has_it() {
        let half = parrys(vector([1.0, 2.0, 3.0]));
        let (a, b, c) = (parrys(vector([1.0, 0.0, 0.0])), parrys(vector([0.0, 1.0, 0.0])), parrys(V::ZERO));
        let mut shapes = convex_shapes();
        shapes.extend([
            theirs::SharedShape::ball(0.5),
            theirs::SharedShape::new(theirs::Cuboid::new(half)),
            theirs::SharedShape::capsule(a, b, 0.25),
            theirs::SharedShape::segment(a, b),
            theirs::SharedShape::triangle(a, b, c),
            theirs::SharedShape::new(theirs::RoundShape { inner_shape: theirs::Cuboid::new(half), border_radius: 0.5 }),
            theirs::SharedShape::round_triangle(a, b, c, 0.5),
        ]);
        let place = |i: usize| Pose::from_translation(parrys(vector([i as f64, -2.0, 0.5])));
        let shapes: Vec<_> = shapes.into_iter().enumerate().map(|(i, shape)| (place(i), shape)).collect();
        let compound = theirs::Compound::new(shapes.clone());
        let pieces = pieces(&compound).expect("all are convex");
        assert_eq!(pieces.len(), shapes.len());
        let whole = place(7);
        for ((pose, shape), piece) in shapes.iter().zip(&pieces) {
            let theirs = FromParry(Any(shape.as_support_map().expect("convex")));
            same(&piece.shape, &theirs);
            same(&piece.at(&whole).expect("finite"), &posed(theirs, &(whole * *pose)).expect("finite"));
        }
    }

    #[test]
    fn a_mesh_is_its_triangles_as_parry_holds_them() {
        let mut held = mesh().scaled(parrys(vector([-2.0, 1.0, 0.5])));
        held.reverse();
        let triangles = triangles(&held).expect("finite");
        assert_eq!(triangles.len(), 2);
        for (i, triangle) in triangles.iter().enumerate() {
            let theirs = held.triangle(i as u32);
            assert_eq!(triangle.points(), [theirs.a, theirs.b, theirs.c].map(ours));
        }
        assert_eq!(triangles[0].points(), [vector([-2.0, 0.0, 0.0]), V::ZERO, vector([0.0, 1.0, 0.0])]);
        for (piece, triangle) in pieces(&held).expect("finite").iter().zip(&triangles) {
            assert_eq!(piece.pose, Pose::IDENTITY);
            same(&piece.shape, triangle);
        }
    }

    #[test]
    fn a_polyline_is_its_segments_and_a_convex_shape_itself() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(|v| parrys(vector(v)));
        let line = theirs::Polyline::new(corners.to_vec(), None);
        let segments = pieces(&line).expect("finite");
        assert_eq!(segments.len(), 2);
        same(&segments[1].shape, &Segment::try_from(line.segment(1)).expect("finite"));
        let ball = pieces(&theirs::Ball::new(0.5)).expect("a ball");
        assert_eq!(ball.len(), 1);
        same(&ball[0].shape, &Ball::<V>::new(0.5).expect("a ball"));
    }

    #[test]
    fn what_is_no_shape_here_is_named() {
        let up = parrys(vector([0.0, 1.0, 0.0]));
        let half_space = theirs::SharedShape::halfspace(up);
        assert_eq!(
            pieces(&*half_space).expect_err("unbounded"),
            Unconvertible::Kind { piece: 0, kind: ShapeType::HalfSpace }
        );
        let ball = |radius| (Pose::IDENTITY, theirs::SharedShape::ball(radius));
        let compound = theirs::Compound::new(alloc::vec![ball(1.0), (Pose::IDENTITY, half_space)]);
        let refused = pieces(&compound).expect_err("one is unbounded");
        assert_eq!(refused, Unconvertible::Kind { piece: 1, kind: ShapeType::HalfSpace });
        assert_eq!(
            alloc::format!("{refused}"),
            "piece 1 is a HalfSpace, which is not a bounded convex shape or made of such"
        );
        let compound = theirs::Compound::new(alloc::vec![ball(1.0), ball(-1.0)]);
        let refused = pieces(&compound).expect_err("a negative radius");
        assert!(matches!(refused, Unconvertible::Number { piece: 1, kind: ShapeType::Ball, .. }), "{refused}");
        let mut mesh = mesh();
        mesh.update_vertices(|vertices| vertices[3].y = f64::NAN as _);
        let refused = pieces(&mesh).expect_err("NaN");
        assert!(matches!(refused, Unconvertible::Number { piece: 1, kind: ShapeType::Triangle, .. }), "{refused}");
    }
}
