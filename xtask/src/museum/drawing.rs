//! A pose as a drawing: the outlines of its bodies, seen along an axis that shows what is asked in its true length.

use convex_support::glam::{DVec2, DVec3};
use convex_support::{SupportMap, Vector};
use gjk_raycast::{Body as SceneBody, HalfSpace};
use serde_json::{Value, json};

use crate::mesh::Meshes;
use crate::wire::body::Body;
use crate::wire::error::Problem;
use crate::wire::fields::{Dimension, Object, Written};
use crate::wire::shape::{Solid, Space};

/// By how much a picture is wider than high.
pub(super) const ASPECT: f64 = 4.0 / 3.0;

/// A point of the picture, in the units of the pose.
pub(super) type Flat = [f64; 2];

/// What a line or an area stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// The body `b`, or what a ray is cast at.
    Other,
    /// The body `a`.
    Own,
    /// A body where it is at the hit, or at the end of its way.
    Moved,
    /// The way of a ray or of a body, with an arrow at its end.
    Way,
    /// From one nearest or deepest point to the other, or the point of a hit.
    Mark,
    /// The points that an ellipsoid encloses.
    Cloud,
}

/// The lines and areas of a pose, and the part of the plane that shows them: its middle, and half of its height.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) parts: Vec<(Role, Vec<Flat>)>,
    pub(super) middle: Flat,
    pub(super) half: f64,
}

/// How many directions an outline is asked for.
const DIRECTIONS: usize = 96;
/// A body this many times as large as what else is seen is cut off at the border, if a part of it is seen.
const LARGE: f64 = 4.0;
/// A gap this many times as small as the bodies is seen from near; one that is still a hundred times smaller is not.
const SMALL: f64 = 24.0;

impl Drawing {
    /// The drawing of a query and of its answer.
    pub(super) fn new(case: &Object, answer: &Object) -> Result<Self, Problem> {
        match case.get("query").and_then(Value::as_str).unwrap_or_default() {
            "enclosing_ellipsoid" | "inscribed_ellipsoid" => Self::of_ellipsoid(case, answer),
            _ => Self::of_bodies(case, answer),
        }
    }

    fn of_bodies(case: &Object, answer: &Object) -> Result<Self, Problem> {
        let space = Dimension::default();
        let read = |key: &str| case.get(key).and_then(Value::as_object).map(|o| Body::read(Written::new(o, &space)));
        let own = read("a").transpose()?;
        let other = read("b").or_else(|| read("target")).transpose()?;
        let is_flat = space.known().or_else(|| Some(numbers(case, "source")?.len())) == Some(2);
        let motions = [Motion::new(case, "a"), Motion::new(case, "b")];
        let source = vector(case, "source");
        let view = View::new(is_flat, case, answer, &motions);
        let of = |body: Option<Body>, reach| body.map_or(Ok(Vec::new()), |body| view.outline(&body, is_flat, reach));
        let own = of(own, 1.0)?;
        let other = of(other, 20.0 * size(&own))?;

        let mut parts = Vec::new();
        let time = answer.get("time").and_then(Value::as_f64);
        let mut seen: Vec<Flat> = Vec::new();
        let flat = |object: &Object, key: &str| vector(object, key).map(|x| view.flat(x));
        for (role, outline) in [(Role::Other, &other), (Role::Own, &own)] {
            if !outline.is_empty() {
                parts.push((role, outline.clone()));
            }
        }
        for (motion, outline) in motions.iter().zip([&own, &other]) {
            if !motion.is_rest() && !outline.is_empty() {
                let until = time.unwrap_or_else(|| motion.end(case, size(outline)));
                let moved: Vec<Flat> = outline.iter().map(|x| motion.at(until, *x, &view)).collect();
                let steps = if motion.turning.length() > 0.0 { 16 } else { 1 };
                let way = |k: i32| motion.at(until * f64::from(k) / f64::from(steps), middle(outline), &view);
                parts.push((Role::Way, (0..=steps).map(way).collect()));
                seen.extend(outline.iter().chain(&moved));
                parts.push((Role::Moved, moved));
            }
        }
        if let Some(source) = source {
            let direction = vector(case, "direction").unwrap_or_default();
            let hit = answer.get("lambda").and_then(Value::as_f64);
            // A miss is drawn as far as the target, and half as far again; from inside of it, the ray is drawn there.
            let far = if hit.is_some() { 0.4 * size(&other) } else { 1.5 * size(&[middle(&other), view.flat(source)]) };
            let far = far / direction.length().max(f64::MIN_POSITIVE);
            let end = source + direction * hit.filter(|x| *x > 0.0).unwrap_or(far);
            parts.push((Role::Way, vec![view.flat(source), view.flat(end)]));
            seen.extend([view.flat(source), view.flat(end)]);
        }
        let points: Vec<Flat> = ["point_a", "point_b", "point"].iter().filter_map(|key| flat(answer, key)).collect();
        if !points.is_empty() {
            parts.push((Role::Mark, points.clone()));
            seen.extend(&points);
        }
        // What rests is seen as a whole, unless it is so large that little else would be.
        let (small, large) = if size(&own) <= size(&other) { (&own, &other) } else { (&other, &own) };
        if size(small) > 0.0 || !own.is_empty() {
            seen.extend(small);
        }
        // Between bodies at rest, a gap or a depth that would be a dot is seen from near.
        let (all, across) = (size(&[own.as_slice(), &other].concat()), size(&points));
        let is_small = across < all / SMALL && across > all / (100.0 * SMALL);
        if is_small && source.is_none() && motions.iter().all(Motion::is_rest) {
            let middle = middle(&points);
            return Ok(Self { parts, middle, half: 3.0 * across });
        }
        let drawing = Self::around(parts.clone(), &seen);
        if size(large) > LARGE * size(&seen) && size(&seen) > 0.0 && drawing.shows(large) {
            return Ok(drawing);
        }
        seen.extend(large);
        Ok(Self::around(parts, &seen))
    }

    fn of_ellipsoid(case: &Object, answer: &Object) -> Result<Self, Problem> {
        let center = answer.get("center").cloned().unwrap_or_default();
        let is_flat = center.as_array().is_some_and(|x| x.len() == 2);
        let shape = json!({"type": "ellipsoid", "center": center, "matrix": answer.get("matrix")});
        let space = Dimension::default();
        let view = if is_flat { View::PLANE } else { View::along(DVec3::new(0.36, 0.48, 0.8)) };
        let body = shape.as_object().map(|o| Body::read(Written::new(o, &space))).transpose()?;
        let ellipsoid = body.map_or(Ok(Vec::new()), |body| view.outline(&body, is_flat, 1.0))?;
        let lists = |key: &str| case.get(key).and_then(Value::as_array).cloned().unwrap_or_default();
        let cloud: Vec<Flat> = lists("points").iter().filter_map(coordinates).map(|x| view.flat(x)).collect();
        let far = 1e3 * size(&ellipsoid);
        let mut polygon = vec![[-far, -far], [far, -far], [far, far], [-far, far]];
        for half_space in &lists("halfspaces") {
            let normal = half_space.get("normal").and_then(coordinates).unwrap_or_default();
            let offset = half_space.get("offset").and_then(Value::as_f64).unwrap_or_default();
            polygon = cut(&polygon, normal.truncate().to_array(), offset);
        }
        let around = if cloud.is_empty() { (Role::Other, polygon) } else { (Role::Cloud, cloud) };
        let seen: Vec<Flat> = ellipsoid.iter().chain(&around.1).copied().collect();
        Ok(Self::around(vec![around, (Role::Own, ellipsoid)], &seen))
    }

    /// The drawing whose window holds these points.
    fn around(parts: Vec<(Role, Vec<Flat>)>, seen: &[Flat]) -> Self {
        let [low, high] = bounds(seen);
        let half =
            1.2 * [high[1] - low[1], (high[0] - low[0]) / ASPECT].map(|x| 0.5 * x).into_iter().fold(0.0, f64::max);
        Self { parts, middle: middle(seen), half: if half > 0.0 { half } else { 1.0 } }
    }
}

/// From which side a pose is seen: the directions to the right, up, and towards who looks.
#[derive(Clone, Copy, Debug)]
struct View {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
}

impl View {
    const PLANE: Self = Self { right: DVec3::X, up: DVec3::Y, towards: DVec3::Z };

    /// A view in which the ray, the way, or the normal is seen in its true length, and a turn as a turn.
    fn new(is_flat: bool, case: &Object, answer: &Object, motions: &[Motion; 2]) -> Self {
        if is_flat {
            return Self::PLANE;
        }
        if let Some(turning) = motions.iter().find(|motion| motion.turning.length() > 0.0) {
            return Self::along(turning.turning);
        }
        let between = || Some(vector(answer, "point_a")? - vector(answer, "point_b")?);
        let moving = motions.iter().map(|motion| motion.velocity).find(|v| v.length() > 0.0);
        let key = vector(case, "direction").or(moving).or_else(|| vector(answer, "normal")).or_else(between);
        let key = unit(key.unwrap_or_default());
        // Along the axis most nearly perpendicular to it, z before x before y.
        let axis = [2, 0, 1].into_iter().min_by(|i, j| round(key[*i]).total_cmp(&round(key[*j]))).unwrap_or(2);
        let axis = DVec3::AXES[axis];
        Self::along(axis - key * axis.dot(key))
    }

    /// The view along a direction, with y upwards, or z where one looks along y.
    fn along(direction: DVec3) -> Self {
        let towards = unit(direction);
        let vertical = if towards.y.abs() < 0.9 { DVec3::Y } else { DVec3::Z };
        let up = unit(vertical - towards * vertical.dot(towards));
        Self { right: up.cross(towards), up, towards }
    }

    fn flat(&self, x: DVec3) -> Flat {
        [self.right.dot(x), self.up.dot(x)]
    }

    /// The outline of a body: its support points in directions all around. Of a half-space, as far as `reach`.
    fn outline(&self, body: &Body, is_flat: bool, reach: f64) -> Result<Vec<Flat>, Problem> {
        if is_flat { self.outline_in::<DVec2>(body, reach) } else { self.outline_in::<DVec3>(body, reach) }
    }

    fn outline_in<V: Space<Scalar = f64>>(&self, body: &Body, reach: f64) -> Result<Vec<Flat>, Problem> {
        let solid: Solid<V> = match body.build::<V>("", &Meshes::relative_to(""))? {
            SceneBody::Convex(solid) => solid,
            SceneBody::HalfSpace(half_space) => return Ok(self.floor(&half_space, reach)),
        };
        let asked = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / DIRECTIONS as f64;
            let direction = self.right * angle.cos() + self.up * angle.sin();
            self.flat(from(solid.support(V::from_fn(|i| direction[i]))))
        };
        let mut outline: Vec<Flat> = (0..DIRECTIONS).map(asked).collect();
        let near = 1e-9 * size(&outline);
        outline.dedup_by(|a, b| size(&[*a, *b]) <= near);
        Ok(outline)
    }

    /// What a half-space covers beside the point of its plane that is nearest to the origin.
    fn floor<V: Vector<Scalar = f64>>(&self, half_space: &HalfSpace<V>, reach: f64) -> Vec<Flat> {
        let normal = from(half_space.normal());
        let at = self.flat(normal * (half_space.offset() / normal.dot(normal)));
        let n = self.flat(unit(normal));
        [(-reach, 0.0), (reach, 0.0), (reach, -reach), (-reach, -reach)]
            .map(|(t, d)| [at[0] - t * n[1] + d * n[0], at[1] + t * n[0] + d * n[1]])
            .to_vec()
    }
}

/// How a body moves.
#[derive(Clone, Copy, Debug, Default)]
struct Motion {
    velocity: DVec3,
    turning: DVec3,
    center: DVec3,
}

impl Motion {
    /// Of the body of this name, in either kind of cast.
    fn new(case: &Object, body: &str) -> Self {
        let Some(motion) = case.get(&format!("motion_{body}")).and_then(Value::as_object) else {
            return Self { velocity: vector(case, &format!("velocity_{body}")).unwrap_or_default(), ..Self::default() };
        };
        let of = |key: &str| vector(motion, key).unwrap_or_default();
        let rate = motion.get("angular_velocity").and_then(Value::as_f64);
        let turning = rate.map_or_else(|| of("angular_velocity"), |rate| DVec3::Z * rate);
        Self { velocity: of("velocity"), turning, center: of("center") }
    }

    fn is_rest(&self) -> bool {
        self.velocity.length() == 0.0 && self.turning.length() == 0.0
    }

    /// Until when a way without a hit is drawn, for a body of this size.
    fn end(&self, case: &Object, size: f64) -> f64 {
        let given = case.get("max_time").and_then(Value::as_f64).unwrap_or(f64::INFINITY);
        given.min(2.0 * size / self.velocity.length().max(f64::MIN_POSITIVE))
    }

    /// Where a point of the outline is at a time. One looks along the axis of a turn, so that it is one of the plane.
    fn at(&self, time: f64, x: Flat, view: &View) -> Flat {
        let (center, velocity) = (view.flat(self.center), view.flat(self.velocity));
        let (sin, cos) = (self.turning.dot(view.towards) * time).sin_cos();
        let [r, u] = [x[0] - center[0], x[1] - center[1]];
        [center[0] + velocity[0] * time + cos * r - sin * u, center[1] + velocity[1] * time + sin * r + cos * u]
    }
}

/// The part of a convex polygon in which `normal·x ≤ offset`.
pub(super) fn cut(polygon: &[Flat], normal: Flat, offset: f64) -> Vec<Flat> {
    let above = |x: Flat| normal[0] * x[0] + normal[1] * x[1] - offset;
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &x) in polygon.iter().enumerate() {
        let y = polygon[(k + 1) % polygon.len()];
        let [from, to] = [above(x), above(y)];
        if from <= 0.0 {
            kept.push(x);
        }
        if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
            let t = from / (from - to);
            kept.push([x[0] + t * (y[0] - x[0]), x[1] + t * (y[1] - x[1])]);
        }
    }
    kept
}

fn bounds(points: &[Flat]) -> [Flat; 2] {
    let first = points.first().copied().unwrap_or_default();
    let wider = |[low, high]: [Flat; 2], x: &Flat| {
        [[low[0].min(x[0]), low[1].min(x[1])], [high[0].max(x[0]), high[1].max(x[1])]]
    };
    points.iter().fold([first; 2], wider)
}

fn middle(points: &[Flat]) -> Flat {
    let [low, high] = bounds(points);
    [0, 1].map(|i| f64::midpoint(low[i], high[i]))
}

/// The diagonal of the box around the points.
fn size(points: &[Flat]) -> f64 {
    let [low, high] = bounds(points);
    (high[0] - low[0]).hypot(high[1] - low[1])
}

fn from<V: Vector<Scalar = f64>>(x: V) -> DVec3 {
    DVec3::from_fn(|i| if i < V::DIM { x.get(i) } else { 0.0 })
}

fn numbers<'o>(object: &'o Object, key: &str) -> Option<&'o Vec<Value>> {
    object.get(key)?.as_array()
}

fn vector(object: &Object, key: &str) -> Option<DVec3> {
    coordinates(object.get(key)?)
}

fn coordinates(value: &Value) -> Option<DVec3> {
    let list = value.as_array()?;
    Some(DVec3::from_fn(|i| list.get(i).and_then(Value::as_f64).unwrap_or_default()))
}

fn unit(a: DVec3) -> DVec3 {
    a * (1.0 / a.length().max(f64::MIN_POSITIVE))
}

/// The size of a coordinate, without what rounding makes of equal ones.
fn round(x: f64) -> f64 {
    (x.abs() * 1e6).round()
}
