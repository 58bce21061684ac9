//! The shapes of a query, read from the query itself: a cylinder is the sum of a segment and a flat ball, a cone the
//! hull of a flat ball and its apex.

use std::cell::Cell;
use std::fmt;

use serde_json::Value;

use crate::body::{Body, Set, corners, diagonal, diagonal_of, difference, scale_of, sum, transposed};
use crate::interval::{Interval, Vector};

/// What a query's numbers mean: each is the nearest double to what is written, and in single precision the nearest
/// `f32` to that.
///
/// Nothing is left out: a field that is not read, or a vector of another dimension than those before it, is an error.
pub struct Reader<'m> {
    /// Whether the query is one in single precision.
    single: bool,
    /// The vertices of the mesh at a path, or why there are none.
    mesh: &'m dyn Fn(&str) -> Result<Points, Unread>,
    /// The dimension of what was read so far.
    dimension: Cell<Option<usize>>,
}

impl fmt::Debug for Reader<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reader").field("single", &self.single).finish_non_exhaustive()
    }
}

/// The vertices of a mesh.
pub type Points = Vec<[f64; 3]>;

/// A field that is missing, that is not what it must be, or that is not read.
pub type Unread = String;

/// The shapes, and the fields of each beside its `type`.
const SHAPES: &[(&str, &[&str])] = &[
    ("point", &["at"]),
    ("segment", &["points"]),
    ("triangle", &["points"]),
    ("polytope", &["points"]),
    ("mesh", &["path"]),
    ("cuboid", &["half_extents"]),
    ("ball", &["radius"]),
    ("capsule", &["half_height", "radius"]),
    ("cylinder", &["half_height", "radius"]),
    ("cone", &["half_height", "radius"]),
    ("ellipsoid", &["center", "matrix"]),
    ("ellipsoid", &["center", "semi_axes", "rotation"]),
    ("posed", &["of", "translation", "rotation"]),
    ("affine", &["of", "matrix", "translation"]),
    ("minkowski_sum", &["of"]),
    ("difference", &["a", "b"]),
    ("hull", &["of"]),
    ("rounded", &["of", "radius"]),
];

impl<'m> Reader<'m> {
    /// The reader of a query in its precision.
    ///
    /// # Errors
    /// Where the precision is none.
    pub fn new(line: &Value, mesh: &'m dyn Fn(&str) -> Result<Points, Unread>) -> Result<Self, Unread> {
        let single = match line.get("precision").map(Value::as_str) {
            None | Some(Some("f64")) => false,
            Some(Some("f32")) => true,
            Some(_) => return Err("precision is neither \"f32\" nor \"f64\"".to_owned()),
        };
        Ok(Self { single, mesh, dimension: Cell::new(None) })
    }
}

impl Reader<'_> {
    /// The unit of rounding of the query's answer.
    pub(crate) fn rounding(&self) -> Interval {
        Interval::from(if self.single { f64::from(f32::EPSILON) } else { f64::EPSILON })
    }

    /// The dimension of the query; 3 where nothing says it.
    pub(crate) fn dimension(&self) -> usize {
        self.dimension.get().unwrap_or(3)
    }

    /// Notes that something is of a dimension.
    pub(crate) fn note(&self, dimension: usize, what: &Value) -> Result<(), Unread> {
        match self.dimension.get() {
            Some(known) if known != dimension => {
                Err(format!("{what:.40} is of dimension {dimension}, but what is before it is of dimension {known}"))
            }
            _ => {
                self.dimension.set(Some(dimension));
                Ok(())
            }
        }
    }

    pub(crate) fn number(&self, value: &Value) -> Result<f64, Unread> {
        let number = double(value)?;
        Ok(if self.single { f64::from(number as f32) } else { number })
    }

    fn numbers(&self, value: &Value) -> Result<Vec<f64>, Unread> {
        listed(value)?.iter().map(|item| self.number(item)).collect()
    }

    pub(crate) fn vector(&self, value: &Value) -> Result<Vector, Unread> {
        self.space(value, &self.numbers(value)?)
    }

    /// The vector of these coordinates, written so.
    fn space(&self, written: &Value, numbers: &[f64]) -> Result<Vector, Unread> {
        if !matches!(numbers.len(), 2 | 3) {
            return Err(format!("{written:.40} is no vector"));
        }
        self.note(numbers.len(), written)?;
        Ok(Vector(std::array::from_fn(|i| Interval::from(numbers.get(i).copied().unwrap_or(0.0)))))
    }

    /// The vector in a field, zero where it is left out.
    pub(crate) fn vector_or_zero(&self, object: &Value, name: &str) -> Result<Vector, Unread> {
        object.get(name).map_or(Ok(Vector::zero()), |value| self.vector(value))
    }

    fn vectors(&self, value: &Value) -> Result<Vec<Vector>, Unread> {
        listed(value)?.iter().map(|item| self.vector(item)).collect()
    }

    /// So many points, or more than none.
    fn points(&self, shape: &Value, count: Option<usize>) -> Result<Set, Unread> {
        let points = self.vectors(field(shape, "points")?)?;
        if points.is_empty() || count.is_some_and(|count| points.len() != count) {
            return Err(format!("{} points are no such shape", points.len()));
        }
        Ok(Set::Points(points))
    }

    /// A vector of lengths, none of which is negative.
    fn lengths(&self, value: &Value) -> Result<Vector, Unread> {
        let lengths = self.vector(value)?;
        if lengths.0.iter().all(Interval::is_not_negative) {
            Ok(lengths)
        } else {
            Err(format!("{value:.40} has a negative length"))
        }
    }

    /// A length, which is not negative.
    fn length(&self, object: &Value, name: &str) -> Result<Interval, Unread> {
        match self.number(field(object, name)?)? {
            length if length >= 0.0 => Ok(Interval::from(length)),
            length => Err(format!("{name} is {length}")),
        }
    }

    /// The rows of a square matrix, and zero for those beyond the dimension.
    fn rows(&self, value: &Value) -> Result<[Vector; 3], Unread> {
        self.square(value, self.vectors(value)?)
    }

    /// The same in double precision, whatever the query's.
    fn exact_rows(&self, value: &Value) -> Result<[Vector; 3], Unread> {
        let row = |row| self.space(row, &doubles(row)?);
        self.square(value, listed(value)?.iter().map(row).collect::<Result<_, _>>()?)
    }

    fn square(&self, written: &Value, mut rows: Vec<Vector>) -> Result<[Vector; 3], Unread> {
        self.note(rows.len(), written)?;
        rows.resize_with(3, Vector::zero);
        rows.try_into().map_err(|_| "a matrix has too many rows".to_owned())
    }

    /// A rotation: an angle, or a quaternion that is divided by its length.
    ///
    /// In single precision the coordinates of a quaternion are rounded to 24 bits, whatever their exponents.
    pub(crate) fn rotation(&self, value: Option<&Value>) -> Result<[Vector; 3], Unread> {
        let one = Interval::from(1.0);
        let Some(value) = value else { return Ok(diagonal(std::array::from_fn(|_| one.clone()))) };
        if value.is_number() {
            self.note(2, value)?;
            let [sine, cosine] = Interval::from(self.number(value)?).sine_and_cosine();
            let zero = Interval::zero();
            return Ok([
                Vector([cosine.clone(), -&sine, zero.clone()]),
                Vector([sine, cosine, zero.clone()]),
                Vector([zero.clone(), zero, one]),
            ]);
        }
        let mut q = doubles(value)?;
        self.note(3, value)?;
        if self.single {
            let largest = q.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
            let unit = f64::from_bits(largest.to_bits() & f64::INFINITY.to_bits()).max(f64::MIN_POSITIVE);
            q = q.into_iter().map(|c| f64::from((c / unit) as f32)).collect();
        }
        let &[x, y, z, w] = q.as_slice() else { return Err("a quaternion has four numbers".to_owned()) };
        let [x, y, z, w] = [x, y, z, w].map(Interval::from);
        let squared = &Vector([x.clone(), y.clone(), z.clone()]).squared() + &w.squared();
        if !Interval::zero().is_less_than(&squared) {
            return Err("a quaternion is zero".to_owned());
        }
        let twice = |sum: Interval| (&sum + &sum).over(&squared);
        let less = |a: &Interval, b: &Interval| &one - &twice(&a.squared() + &b.squared());
        let (plus, minus) = (|a, b| twice(&a + &b), |a, b| twice(&a - &b));
        Ok([
            Vector([less(&y, &z), minus(&x * &y, &z * &w), plus(&x * &z, &y * &w)]),
            Vector([plus(&x * &y, &z * &w), less(&x, &z), minus(&y * &z, &x * &w)]),
            Vector([minus(&x * &z, &y * &w), plus(&y * &z, &x * &w), less(&x, &y)]),
        ])
    }

    /// The shape that an object is.
    pub(crate) fn body(&self, shape: &Value) -> Result<Body, Unread> {
        let get = |name| field(shape, name);
        let kind = get("type")?.as_str().unwrap_or_default();
        let has = |fields: &[&str]| only(shape, "a shape", &[&["type"], fields]);
        let mut unread = unread_shape(kind).map(|_| ());
        for (_, fields) in SHAPES.iter().filter(|(name, _)| *name == kind) {
            unread = has(fields);
            if unread.is_ok() {
                break;
            }
        }
        unread?;
        let of = || self.body(get("of")?);
        let several = || match get("of")?.as_array() {
            Some(of) if !of.is_empty() => of.iter().map(|one| self.body(one)).collect::<Result<Vec<_>, _>>(),
            _ => Err("a sum or hull of no shapes".to_owned()),
        };
        // A segment along y, to so far on either side.
        let upright = || -> Result<Set, Unread> {
            let end = self.length(shape, "half_height")?;
            let at = |y: Interval| Vector([Interval::zero(), y, Interval::zero()]);
            Ok(Set::Points(vec![at(end.clone()), at(-&end)]))
        };
        // A flat ball across y.
        let disc = || -> Result<Set, Unread> {
            let radius = self.length(shape, "radius")?;
            let flat = diagonal([radius.clone(), Interval::zero(), radius]);
            Ok(Set::Image(Box::new(Set::Ball), flat, Vector::zero()))
        };
        if matches!(kind, "cylinder" | "cone" | "mesh") {
            self.note(3, get("type")?)?;
        }
        Ok(match kind {
            "point" => Body::of(Set::Points(vec![self.vector(get("at")?)?])),
            "segment" => Body::of(self.points(shape, Some(2))?),
            "triangle" => Body::of(self.points(shape, Some(3))?),
            "polytope" => Body::of(self.points(shape, None)?),
            "mesh" => Body::of(self.mesh(get("path")?)?),
            "cuboid" => Body::of(corners(&self.lengths(get("half_extents")?)?)),
            "ball" => Body { core: Set::Points(vec![Vector::zero()]), radius: self.length(shape, "radius")? },
            "capsule" => Body { core: upright()?, radius: self.length(shape, "radius")? },
            "cylinder" => Body::of(Set::Sum(vec![upright()?, disc()?])),
            "cone" => {
                let Set::Points(mut ends) = upright()? else { return Err("a cone has no axis".to_owned()) };
                let bottom = Set::Points(ends.split_off(1));
                Body::of(Set::Hull(vec![Set::Points(ends), Set::Sum(vec![bottom, disc()?])]))
            }
            "ellipsoid" => Body::of(self.ellipsoid(shape)?),
            "posed" => {
                let Body { core, radius } = of()?;
                let (rows, at) = (self.rotation(shape.get("rotation"))?, self.vector_or_zero(shape, "translation")?);
                Body { core: Set::Image(Box::new(core), rows, at), radius }
            }
            "affine" => {
                let (rows, at) = (self.rows(get("matrix")?)?, self.vector_or_zero(shape, "translation")?);
                let dimension = get("matrix")?.as_array().map_or(3, Vec::len);
                let Body { core, radius } = of()?;
                match scale_of(&rows[..dimension]) {
                    Some(scale) => Body { core: Set::Image(Box::new(core), rows, at), radius: &radius * &scale },
                    None => {
                        let whole = Body { core, radius }.but_for(&Interval::zero());
                        Body::of(Set::Image(Box::new(whole), rows, at))
                    }
                }
            }
            "minkowski_sum" => match several()? {
                parts if parts.len() > 1 => sum(parts),
                _ => return Err("a sum is of two shapes or more".to_owned()),
            },
            "difference" => difference(self.body(get("a")?)?, self.body(get("b")?)?),
            "hull" => {
                let parts = several()?;
                let least = parts.iter().map(|part| part.radius.clone()).reduce(|a, b| a.min(&b));
                let radius = least.unwrap_or_else(Interval::zero).least();
                let core = Set::Hull(parts.into_iter().map(|part| part.but_for(&radius)).collect());
                Body { core, radius }
            }
            "rounded" => {
                let Body { core, radius } = of()?;
                Body { core, radius: &radius + &self.length(shape, "radius")? }
            }
            _ => return unread_shape(kind),
        })
    }

    fn mesh(&self, path: &Value) -> Result<Set, Unread> {
        let points = (self.mesh)(path.as_str().unwrap_or_default())?;
        let coordinate = |x: f64| Interval::from(if self.single { f64::from(x as f32) } else { x });
        Ok(Set::Points(points.into_iter().map(|point| Vector(point.map(coordinate))).collect()))
    }

    /// An ellipsoid: the unit ball, stretched by semi-axes and turned, or by the inverse of the matrix's factor.
    ///
    /// With `X = L·Lᵀ`, `(x−c)ᵀX(x−c) ≤ 1` says `|Lᵀ(x−c)| ≤ 1`: the image of the ball under `L⁻ᵀ`. The matrix is not
    /// rounded to single precision; the mean of it and its transpose counts.
    fn ellipsoid(&self, shape: &Value) -> Result<Set, Unread> {
        let center = self.vector_or_zero(shape, "center")?;
        if let Some(semi_axes) = shape.get("semi_axes") {
            let stretched = Set::Image(Box::new(Set::Ball), diagonal(self.lengths(semi_axes)?.0), Vector::zero());
            return Ok(Set::Image(Box::new(stretched), self.rotation(shape.get("rotation"))?, center));
        }
        let written = field(shape, "matrix")?;
        let given = self.exact_rows(written)?;
        let n = written.as_array().map_or(0, Vec::len);
        let half = Interval::from(0.5);
        // Row by row, the inverse m of the factor l beside it: l·m = 1, and the image is that under mᵀ.
        let (mut l, mut m): ([Vector; 3], [Vector; 3]) =
            (diagonal_of(&Interval::zero()), diagonal_of(&Interval::zero()));
        for i in 0..n {
            for j in 0..=i {
                let entry = &(&given[i].0[j] + &given[j].0[i]) * &half;
                let rest = (0..j).fold(entry, |rest, k| &rest - &(&l[i].0[k] * &l[j].0[k]));
                l[i].0[j] = if i == j { rest.root() } else { rest.over(&l[j].0[j]) };
                if i == j && !Interval::zero().is_less_than(&rest) {
                    return Err("a matrix is not positive definite".to_owned());
                }
            }
            for j in 0..=i {
                let one = Interval::from(f64::from(u8::from(i == j)));
                let rest = (j..i).fold(one, |rest, k| &rest - &(&l[i].0[k] * &m[k].0[j]));
                m[i].0[j] = rest.over(&l[i].0[i]);
            }
        }
        Ok(Set::Image(Box::new(Set::Ball), transposed(&m), center))
    }
}

pub(crate) fn field<'v>(object: &'v Value, name: &str) -> Result<&'v Value, Unread> {
    object.get(name).ok_or_else(|| format!("the field \"{name}\" is missing"))
}

fn unread_shape(kind: &str) -> Result<Body, Unread> {
    Err(format!("there is no shape \"{kind}\""))
}

/// Checks that an object, called so, has no fields but these, and remarks.
pub(crate) fn only(object: &Value, what: &str, fields: &[&[&str]]) -> Result<(), Unread> {
    let object = object.as_object().ok_or_else(|| format!("{what} is no object"))?;
    let is_read = |key: &str| key.starts_with('_') || key == "book" || fields.iter().any(|some| some.contains(&key));
    match object.keys().find(|key| !is_read(key)) {
        None => Ok(()),
        Some(key) => Err(format!("the field \"{key}\" of {what} is not read here, and what it says is not proved")),
    }
}

/// The items of a list.
pub(crate) fn listed(value: &Value) -> Result<&[Value], Unread> {
    value.as_array().map(Vec::as_slice).ok_or_else(|| format!("{value:.40} is no list"))
}

/// The double that a number is written as, whatever the precision of the query.
fn double(value: &Value) -> Result<f64, Unread> {
    value.as_f64().ok_or_else(|| format!("{value:.40} is no number"))
}

fn doubles(value: &Value) -> Result<Vec<f64>, Unread> {
    listed(value)?.iter().map(double).collect()
}
