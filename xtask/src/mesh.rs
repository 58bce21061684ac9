//! Meshes from OBJ and STL files, as the hulls of their vertices.

use std::collections::HashMap;
use std::fs;
use std::io::{Cursor, Read as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{InvalidShape, Polytope};

use crate::wire::error::{Kind, Problem};

/// The vertices of a mesh, and their hull once it has been asked for.
#[derive(Debug)]
pub(crate) struct Mesh {
    points: Vec<DVec3>,
    hull_f64: OnceLock<Result<Arc<Polytope<DVec3>>, InvalidShape>>,
    hull_f32: OnceLock<Result<Arc<Polytope<Vec3A>>, InvalidShape>>,
}

impl Mesh {
    fn new(points: Vec<DVec3>) -> Self {
        Self { points, hull_f64: OnceLock::new(), hull_f32: OnceLock::new() }
    }

    /// The distinct vertices.
    pub(crate) fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The convex hull in double precision.
    pub(crate) fn hull_f64(&self) -> Result<Arc<Polytope<DVec3>>, InvalidShape> {
        self.hull_f64.get_or_init(|| Polytope::hull_of(self.points.iter().copied()).map(Arc::new)).clone()
    }

    /// The convex hull of the vertices rounded to single precision.
    pub(crate) fn hull_f32(&self) -> Result<Arc<Polytope<Vec3A>>, InvalidShape> {
        let rounded = || self.points.iter().map(|p| p.as_vec3a());
        self.hull_f32.get_or_init(|| Polytope::hull_of(rounded()).map(Arc::new)).clone()
    }
}

/// The meshes in use, read once each. What is kept is bounded, whatever the number of files.
#[derive(Debug)]
pub(crate) struct Meshes {
    /// What the paths of a query file are relative to.
    folder: PathBuf,
    kept: Mutex<Kept>,
}

#[derive(Debug, Default)]
struct Kept {
    meshes: HashMap<PathBuf, Arc<Mesh>>,
    vertices: usize,
}

impl Kept {
    /// 48 MB of vertices, and twice that with both hulls.
    const MOST_VERTICES: usize = 2_000_000;
}

impl Meshes {
    /// Meshes whose paths are relative to `folder`.
    pub(crate) fn relative_to(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), kept: Mutex::default() }
    }

    /// The mesh in the file at `path`.
    pub(crate) fn load(&self, path: &Path) -> Result<Arc<Mesh>, Problem> {
        let path = self.folder.join(path);
        // A panic elsewhere leaves the map whole: it is only inserted into.
        if let Some(mesh) = self.kept.lock().unwrap_or_else(PoisonError::into_inner).meshes.get(&path) {
            return Ok(Arc::clone(mesh));
        }
        let points = read(&path)
            .map_err(|why| Problem::new(Kind::Io, format!("the mesh \"{}\" cannot be read: {why}", path.display())))?;
        if points.is_empty() {
            return Err(Problem::new(Kind::InvalidShape, format!("the mesh \"{}\" has no vertices", path.display())));
        }
        let mesh = Arc::new(Mesh::new(points));
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.vertices + mesh.points.len() > Kept::MOST_VERTICES {
            *kept = Kept::default();
        }
        kept.vertices += mesh.points.len();
        kept.meshes.insert(path, Arc::clone(&mesh));
        Ok(mesh)
    }
}

/// The distinct vertices of an OBJ or STL file, told apart by the extension, in the order of the file.
fn read(path: &Path) -> Result<Vec<DVec3>, String> {
    let bytes = fs::read(path).map_err(|why| why.to_string())?;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let points = match extension.as_str() {
        "obj" => read_obj(&bytes)?,
        "stl" => read_stl(bytes)?,
        _ => return Err("its name must end in .obj or .stl".to_owned()),
    };
    let mut seen = std::collections::HashSet::with_capacity(points.len());
    // −0 and 0 are one coordinate.
    Ok(points.into_iter().filter(|p| seen.insert(p.to_array().map(|c| (c + 0.0).to_bits()))).collect())
}

fn read_obj(bytes: &[u8]) -> Result<Vec<DVec3>, String> {
    // The reader returns the vertices of elements, one model after another. A last model with an element of one vertex for
    // every vertex of the file makes it return all of them, whether a face uses them or not.
    let count = bytes.split(|&b| b == b'\n').filter(|l| is_vertex(l)).count();
    if count == 0 {
        return Ok(Vec::new());
    }
    let elements = (1..=count).fold("\no all".to_owned(), |text, i| text + &format!("\nl {i}"));
    let mut text = bytes.chain(elements.as_bytes());
    let options = tobj::LoadOptions { single_index: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut std::io::BufReader::new(&mut text), &options, |_| Ok(Default::default()))
        .map_err(|why| broken_vertex(bytes).unwrap_or_else(|| why.to_string()))?;
    let last = models.last().map(|m| m.mesh.positions.as_slice()).unwrap_or_default();
    Ok(last.chunks_exact(3).map(DVec3::from_slice).collect())
}

/// Whether the line of an OBJ file is a vertex.
fn is_vertex(line: &[u8]) -> bool {
    let line = line.trim_ascii_start();
    line.first() == Some(&b'v') && line.get(1).is_some_and(u8::is_ascii_whitespace)
}

/// Says which line of an OBJ file is a vertex without three numbers.
fn broken_vertex(bytes: &[u8]) -> Option<String> {
    let lines = bytes.split(|&b| b == b'\n').map(String::from_utf8_lossy);
    let is_broken = |line: &str| {
        is_vertex(line.as_bytes())
            && line.split_whitespace().skip(1).map_while(|word| word.parse::<f64>().ok()).take(3).count() < 3
    };
    let (i, line) = lines.enumerate().find(|(_, line)| is_broken(line))?;
    Some(format!("line {} is {:?}, but a vertex is \"v x y z\"", i + 1, line.trim_end()))
}

fn read_stl(bytes: Vec<u8>) -> Result<Vec<DVec3>, String> {
    let mut cursor = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut cursor).map_err(|why| why.to_string())?;
    let mut points = Vec::new();
    for triangle in triangles {
        let triangle = triangle.map_err(|why| why.to_string())?;
        points.extend(triangle.vertices.iter().map(|v| DVec3::from_array(v.0.map(f64::from))));
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_vertex_is_named_by_its_line() {
        let why = read_obj(b"v 0 0 0\nv 1 2\nv 3 4 5\n").expect_err("two numbers are no vertex");
        assert_eq!(why, r#"line 2 is "v 1 2", but a vertex is "v x y z""#, "what stands there");
    }

    #[test]
    fn every_vertex_counts_whether_a_face_uses_it_or_not() {
        let xs = |text: &str| read_obj(text.as_bytes()).map(|points| points.iter().map(|p| p.x).collect::<Vec<_>>());
        assert_eq!(xs("v 4 0 0\nv 3 0 0\nv 2 0 0\nv 1 0 0\nf 4 2 1\n"), Ok(vec![4.0, 3.0, 2.0, 1.0]), "one is unused");
        assert_eq!(xs("v 4 0 0\nv 3 0 0"), Ok(vec![4.0, 3.0]), "no faces, no end of line");
        assert_eq!(
            xs("o a\nv 4 0 0\np 1\no b\nv 3 0 0\nv 6 0 0 2\nl 2 3\n"),
            Ok(vec![4.0, 3.0, 3.0]),
            "groups, a weight"
        );
        assert_eq!(xs("# nothing\n"), Ok(Vec::new()), "no vertices");
    }
}
