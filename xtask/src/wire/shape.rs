//! Shapes as written, and the support maps they stand for.

use std::path::PathBuf;

use convex_support::glam::{DVec2, DVec3, Vec2, Vec3A};
use convex_support::{
    Affine, Ball, Capsule, Cone, Cuboid, Cylinder, Difference, Ellipsoid, Hull, InvalidShape, Matrix, MinkowskiSum,
    Point, Polytope, Posed, Rounded, Scalar, Segment, SupportMap, Triangle, Vector, glam,
};

use super::error::{Kind, Problem};
use super::fields::{AngularVelocity, Coordinates, Fields, Rotation, Written};
use super::names::Names;
use crate::mesh::{Mesh, Meshes};

/// A shape as the query says it.
#[derive(Debug)]
pub enum Shape {
    Point(Coordinates),
    Segment([Coordinates; 2]),
    Triangle([Coordinates; 3]),
    Ball { radius: f64 },
    Cuboid { half_extents: Coordinates },
    Capsule { half_height: f64, radius: f64 },
    Upright { kind: Upright, half_height: f64, radius: f64 },
    Ellipsoid(EllipsoidSpec),
    Polytope(Vec<Coordinates>),
    Mesh(PathBuf),
    Posed { translation: Coordinates, rotation: Option<Rotation>, of: Box<Self> },
    Affine { matrix: [Coordinates; 3], translation: Coordinates, of: Box<Self> },
    MinkowskiSum(Vec<Self>),
    Difference(Box<[Self; 2]>),
    Hull(Vec<Self>),
    Rounded { radius: f64, of: Box<Self> },
}

/// The shapes with a disc for a base, which exist in 3D only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Upright {
    Cylinder,
    Cone,
}

/// An ellipsoid as the query says it.
#[derive(Clone, Debug)]
pub struct EllipsoidSpec {
    center: Coordinates,
    form: EllipsoidForm,
}

#[derive(Clone, Debug)]
enum EllipsoidForm {
    Matrix([Coordinates; 3]),
    Axes { semi_axes: Coordinates, rotation: Option<Rotation> },
}

/// A type of shapes: the fields that one has beside `type`, and what they make.
#[derive(Clone, Copy, Debug)]
pub struct Type {
    fields: Names,
    shape: fn(&Fields<'_>) -> Result<Shape, Problem>,
}

impl Type {
    /// The shape that an object of this type is.
    pub fn read(&self, written: Written<'_>) -> Result<Shape, Problem> {
        (self.shape)(&written.fields(&["type"], self.fields)?)
    }
}

const fn new(fields: Names, shape: fn(&Fields<'_>) -> Result<Shape, Problem>) -> Type {
    Type { fields, shape }
}

/// The types of shapes, as written.
pub const TYPES: &[(&str, Type)] = &[
    ("point", new(&["at"], |of| Ok(Shape::Point(of.vector("at")?)))),
    ("segment", new(&["points"], |of| Ok(Shape::Segment(of.corners("points")?)))),
    ("triangle", new(&["points"], |of| Ok(Shape::Triangle(of.corners("points")?)))),
    ("ball", new(&["radius"], |of| Ok(Shape::Ball { radius: of.get("radius")? }))),
    ("cuboid", new(&["half_extents"], |of| Ok(Shape::Cuboid { half_extents: of.vector("half_extents")? }))),
    (
        "capsule",
        new(&["half_height", "radius"], |of| {
            Ok(Shape::Capsule { half_height: of.get("half_height")?, radius: of.get("radius")? })
        }),
    ),
    ("cylinder", new(&["half_height", "radius"], |of| Shape::upright(of, Upright::Cylinder, "cylinder"))),
    ("cone", new(&["half_height", "radius"], |of| Shape::upright(of, Upright::Cone, "cone"))),
    ("ellipsoid", new(EllipsoidSpec::FIELDS, |of| Ok(Shape::Ellipsoid(EllipsoidSpec::of(of)?)))),
    ("polytope", new(&["points"], |of| Ok(Shape::Polytope(of.vectors("points")?)))),
    (
        "mesh",
        new(&["path"], |of| {
            of.is_3d("mesh")?;
            Ok(Shape::Mesh(of.get("path")?))
        }),
    ),
    (
        "posed",
        new(&["translation", "rotation", "of"], |of| {
            let Pose { translation, rotation } = Pose::of(of)?;
            Ok(Shape::Posed { translation, rotation, of: Shape::within(of)? })
        }),
    ),
    (
        "affine",
        new(&["matrix", "translation", "of"], |of| {
            let (matrix, translation) = (of.matrix("matrix")?, of.vector_or_zero("translation")?);
            Ok(Shape::Affine { matrix, translation, of: Shape::within(of)? })
        }),
    ),
    ("minkowski_sum", new(&["of"], |of| Ok(Shape::MinkowskiSum(Shape::several(of)?)))),
    (
        "difference",
        new(&["a", "b"], |of| {
            Ok(Shape::Difference(Box::new([Shape::read(of.within("a")?)?, Shape::read(of.within("b")?)?])))
        }),
    ),
    ("hull", new(&["of"], |of| Ok(Shape::Hull(Shape::several(of)?)))),
    ("rounded", new(&["radius", "of"], |of| Ok(Shape::Rounded { radius: of.get("radius")?, of: Shape::within(of)? }))),
];

impl Shape {
    /// The shape that an object is.
    pub fn read(written: Written<'_>) -> Result<Self, Problem> {
        written.named("type", TYPES.iter().copied(), Kind::UnknownShape)?.read(written)
    }

    /// The one that a shape is made of.
    fn within(fields: &Fields<'_>) -> Result<Box<Self>, Problem> {
        Self::read(fields.within("of")?).map(Box::new)
    }

    /// Those that a shape is made of.
    fn several(fields: &Fields<'_>) -> Result<Vec<Self>, Problem> {
        fields.each("of")?.into_iter().map(Self::read).collect()
    }

    /// A cylinder or cone.
    fn upright(fields: &Fields<'_>, kind: Upright, what: &str) -> Result<Self, Problem> {
        fields.is_3d(what)?;
        Ok(Self::Upright { kind, half_height: fields.get("half_height")?, radius: fields.get("radius")? })
    }
}

/// Where a body is.
#[derive(Clone, Debug)]
pub struct Pose {
    pub translation: Coordinates,
    pub rotation: Option<Rotation>,
}

impl Pose {
    /// The pose that an object is.
    pub fn read(written: Written<'_>) -> Result<Self, Problem> {
        Self::of(&written.fields(&["translation", "rotation"], &[])?)
    }

    /// The pose that is among the fields of an object.
    pub fn of(fields: &Fields<'_>) -> Result<Self, Problem> {
        Ok(Self { translation: fields.vector_or_zero("translation")?, rotation: fields.rotation("rotation")? })
    }
}

impl EllipsoidSpec {
    const FIELDS: Names = &["center", "matrix", "semi_axes", "rotation"];

    /// The ellipsoid that an object is.
    pub fn read(written: Written<'_>) -> Result<Self, Problem> {
        Self::of(&written.fields(&[], Self::FIELDS)?)
    }

    /// The ellipsoid that is among the fields of an object.
    fn of(fields: &Fields<'_>) -> Result<Self, Problem> {
        let center = fields.vector("center")?;
        let form = if fields.only_one_of(&["matrix", "semi_axes"])? == "matrix" {
            // It has a rotation of its own.
            EllipsoidForm::Matrix(fields.only(&["type"], &["center", "matrix"])?.matrix("matrix")?)
        } else {
            let (semi_axes, rotation) = (fields.vector("semi_axes")?, fields.rotation("rotation")?);
            EllipsoidForm::Axes { semi_axes, rotation }
        };
        Ok(Self { center, form })
    }

    /// The ellipsoid; `place` is where the query says it, for errors.
    ///
    /// Its axes are found in double precision and then rounded: that loses least where the matrix is given.
    pub fn build<V: Space>(&self, place: &str) -> Result<Ellipsoid<V>, Problem> {
        self.made::<V::Wide>().and_then(round).map_err(|why| Problem::invalid_shape(place, why))
    }

    /// The ellipsoid as a body, made of the numbers of the query in their precision, so that it states the errors of
    /// its axes.
    fn solid<V: Space>(&self, place: &str) -> Result<Ellipsoid<V>, Problem> {
        match &self.form {
            EllipsoidForm::Matrix(_) => self.build(place),
            EllipsoidForm::Axes { .. } => self.made().map_err(|why| Problem::invalid_shape(place, why)),
        }
    }

    /// The ellipsoid at a pose, which is written at `pose_place`.
    pub fn build_posed<V: Space>(&self, place: &str, pose: &Pose, pose_place: &str) -> Result<Ellipsoid<V>, Problem> {
        let body = self.made::<V::Wide>().map_err(|why| Problem::invalid_shape(place, why))?;
        body.posed(rotation_of::<V::Wide>(pose.rotation.as_ref()), vector(&pose.translation))
            .and_then(round)
            .map_err(|why| Problem::invalid_shape(pose_place, why))
    }

    /// The ellipsoid in a precision.
    fn made<W: Space>(&self) -> Result<Ellipsoid<W>, InvalidShape> {
        match &self.form {
            EllipsoidForm::Matrix(matrix) => Ellipsoid::from_matrix(vector(&self.center), matrix_of_rows(matrix)),
            EllipsoidForm::Axes { semi_axes, rotation } => {
                Ellipsoid::new(vector(&self.center), vector(semi_axes), rotation_of::<W>(rotation.as_ref()))
            }
        }
    }
}

/// The ellipsoid in the precision asked for.
fn round<V: Space>(wide: Ellipsoid<V::Wide>) -> Result<Ellipsoid<V>, InvalidShape> {
    let round = |v: V::Wide| V::from_fn(|i| V::Scalar::from_f64(v.get(i).as_f64()));
    let axes = V::Matrix::from_cols_fn(|j| round(wide.axes().col(j)));
    Ellipsoid::from_axes(round(wide.center()), round(wide.semi_axes()), axes)
}

/// A shape of any kind.
pub type Solid<V> = Box<dyn SupportMap<Vector = V> + Send + Sync>;

/// The spaces of the format: what depends on the precision or the dimension and is not the vector's own.
pub trait Space: Vector {
    /// The space of the same dimension in double precision.
    type Wide: Space<Scalar = f64>;

    /// The rotation, rounded to this precision; that of another dimension is a broken contract and gives none.
    fn rotation(rotation: &Rotation) -> Self::Rotation;

    /// The angular velocity, likewise.
    fn angular_velocity(velocity: AngularVelocity) -> Self::AngularVelocity;

    /// A cylinder or cone.
    ///
    /// # Panics
    /// In 2D, where the reader lets none pass.
    fn upright(_: Upright, _: f64, _: f64) -> Result<Solid<Self>, InvalidShape> {
        unreachable!("the reader refuses cylinders and cones in 2D")
    }

    /// The hull of a mesh.
    ///
    /// # Panics
    /// In 2D, where the reader lets none pass.
    fn mesh(_: &Mesh) -> Result<Solid<Self>, InvalidShape> {
        unreachable!("the reader refuses meshes in 2D")
    }
}

impl Space for DVec2 {
    type Wide = Self;

    fn rotation(rotation: &Rotation) -> f64 {
        match rotation {
            Rotation::Angle(angle) => *angle,
            Rotation::Quaternion(_) => 0.0,
        }
    }

    fn angular_velocity(velocity: AngularVelocity) -> f64 {
        match velocity {
            AngularVelocity::Rate(rate) => rate,
            AngularVelocity::Vector(_) => 0.0,
        }
    }
}

impl Space for Vec2 {
    type Wide = DVec2;

    fn rotation(rotation: &Rotation) -> f32 {
        f32::from_f64(DVec2::rotation(rotation))
    }

    fn angular_velocity(velocity: AngularVelocity) -> f32 {
        f32::from_f64(DVec2::angular_velocity(velocity))
    }
}

impl Space for DVec3 {
    type Wide = Self;

    fn rotation(rotation: &Rotation) -> glam::DQuat {
        match rotation {
            Rotation::Quaternion(q) if q.len() == 4 => glam::DQuat::from_slice(q),
            _ => glam::DQuat::IDENTITY,
        }
    }

    fn angular_velocity(velocity: AngularVelocity) -> Self {
        match velocity {
            AngularVelocity::Rate(_) => Self::ZERO,
            AngularVelocity::Vector(coordinates) => vector(&coordinates),
        }
    }

    fn upright(kind: Upright, half_height: f64, radius: f64) -> Result<Solid<Self>, InvalidShape> {
        Ok(match kind {
            Upright::Cylinder => Box::new(Cylinder::<Self>::new(half_height, radius)?),
            Upright::Cone => Box::new(Cone::<Self>::new(half_height, radius)?),
        })
    }

    fn mesh(mesh: &Mesh) -> Result<Solid<Self>, InvalidShape> {
        Ok(Box::new(mesh.hull_f64()?))
    }
}

impl Space for Vec3A {
    type Wide = DVec3;

    fn rotation(rotation: &Rotation) -> glam::Quat {
        // In units of a power of two, so that its length, whatever it is, survives the rounding of its coordinates.
        let q = glam::DVec4::from(DVec3::rotation(rotation));
        let power = f64::from_bits(q.abs().max_element().to_bits() & f64::INFINITY.to_bits());
        let unit = q / power.max(f64::MIN_POSITIVE);
        glam::Quat::from_vec4(if unit.is_finite() { unit.as_vec4() } else { q.as_vec4() })
    }

    fn angular_velocity(velocity: AngularVelocity) -> Self {
        DVec3::angular_velocity(velocity).as_vec3a()
    }

    fn upright(kind: Upright, half_height: f64, radius: f64) -> Result<Solid<Self>, InvalidShape> {
        let (half_height, radius) = (f32::from_f64(half_height), f32::from_f64(radius));
        Ok(match kind {
            Upright::Cylinder => Box::new(Cylinder::<Self>::new(half_height, radius)?),
            Upright::Cone => Box::new(Cone::<Self>::new(half_height, radius)?),
        })
    }

    fn mesh(mesh: &Mesh) -> Result<Solid<Self>, InvalidShape> {
        Ok(Box::new(mesh.hull_f32()?))
    }
}

/// The vector with these coordinates, rounded to its precision.
pub fn vector<V: Vector>(coordinates: &Coordinates) -> V {
    V::from_fn(|i| V::Scalar::from_f64(coordinates[i]))
}

fn matrix_of_rows<M: Matrix>(rows: &[Coordinates; 3]) -> M {
    M::from_cols_fn(|j| M::Vector::from_fn(|i| <M::Vector as Vector>::Scalar::from_f64(rows[i][j])))
}

/// The rotation, or none.
pub fn rotation_of<V: Space>(rotation: Option<&Rotation>) -> V::Rotation {
    rotation.map_or_else(V::Rotation::default, V::rotation)
}

impl Shape {
    /// The support map of the shape; `place` is where the query says it, for errors.
    pub fn build<V: Space>(&self, place: &str, meshes: &Meshes) -> Result<Solid<V>, Problem> {
        let s = V::Scalar::from_f64;
        let invalid = |why| Problem::invalid_shape(place, why);
        let inner = |of: &Self| of.build::<V>(&format!("{place}.of"), meshes);
        Ok(match self {
            Self::Point(at) => Box::new(Point::<V>::new(vector(at)).map_err(invalid)?),
            Self::Segment(points) => Box::new(Segment::<V>::new(points.each_ref().map(vector)).map_err(invalid)?),
            Self::Triangle(points) => Box::new(Triangle::<V>::new(points.each_ref().map(vector)).map_err(invalid)?),
            Self::Ball { radius } => Box::new(Ball::<V>::new(s(*radius)).map_err(invalid)?),
            Self::Cuboid { half_extents } => Box::new(Cuboid::<V>::new(vector(half_extents)).map_err(invalid)?),
            Self::Capsule { half_height, radius } => {
                Box::new(Capsule::<V>::new(s(*half_height), s(*radius)).map_err(invalid)?)
            }
            Self::Upright { kind, half_height, radius } => V::upright(*kind, *half_height, *radius).map_err(invalid)?,
            Self::Ellipsoid(spec) => Box::new(spec.solid::<V>(place)?),
            Self::Polytope(points) => Box::new(Polytope::<V>::new(points.iter().map(vector)).map_err(invalid)?),
            Self::Mesh(path) => {
                let mesh = meshes.load(path).map_err(|why| why.at(&format!("{place}.path")))?;
                V::mesh(&mesh).map_err(invalid)?
            }
            Self::Posed { translation, rotation: None, of } => {
                Box::new(Posed::translated(inner(of)?, vector(translation)).map_err(invalid)?)
            }
            Self::Posed { translation, rotation, of } => {
                let rotation = rotation_of::<V>(rotation.as_ref());
                Box::new(Posed::new(inner(of)?, rotation, vector(translation)).map_err(invalid)?)
            }
            Self::Affine { matrix, translation, of } => {
                Box::new(Affine::new(inner(of)?, matrix_of_rows(matrix), vector(translation)).map_err(invalid)?)
            }
            Self::MinkowskiSum(of) if of.len() < 2 => {
                let message = format!("{place}.of must be 2 or more shapes, but there are {}", of.len());
                return Err(Problem::new(Kind::InvalidShape, message));
            }
            Self::MinkowskiSum(of) => combine(of, place, meshes, &|a, b| Box::new(MinkowskiSum::new(a, b)))?,
            Self::Difference(pair) => {
                let a = pair[0].build::<V>(&format!("{place}.a"), meshes)?;
                Box::new(Difference::new(a, pair[1].build::<V>(&format!("{place}.b"), meshes)?))
            }
            Self::Hull(of) if of.is_empty() => {
                return Err(Problem::new(Kind::InvalidShape, format!("{place}.of must be 1 or more shapes")));
            }
            Self::Hull(of) => combine(of, place, meshes, &|a, b| Box::new(Hull::new(a, b)))?,
            Self::Rounded { radius, of } => Box::new(Rounded::new(inner(of)?, s(*radius)).map_err(invalid)?),
        })
    }
}

/// Joins a list of shapes by twos, and twos by twos: thousands of them nest a dozen levels deep.
fn combine<V: Space>(
    of: &[Shape],
    place: &str,
    meshes: &Meshes,
    join: &impl Fn(Solid<V>, Solid<V>) -> Solid<V>,
) -> Result<Solid<V>, Problem> {
    let mut level = of
        .iter()
        .enumerate()
        .map(|(i, shape)| shape.build::<V>(&format!("{place}.of[{i}]"), meshes))
        .collect::<Result<Vec<_>, _>>()?;
    while level.len() > 1 {
        let mut pairs = Vec::with_capacity(level.len().div_ceil(2));
        let mut rest = level.into_iter();
        while let Some(a) = rest.next() {
            pairs.push(match rest.next() {
                Some(b) => join(a, b),
                None => a,
            });
        }
        level = pairs;
    }
    level.pop().ok_or_else(|| Problem::new(Kind::InvalidShape, format!("{place}.of is empty")))
}
