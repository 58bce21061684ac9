//! Meshes from OBJ and STL files, as the hulls of their vertices.

use std::collections::{HashMap, HashSet};
use std::fmt::{self, Display, Formatter};
use std::fs::{self, File};
use std::io::{self, Cursor, Read as _};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use convex_support::glam::{DVec3, Vec3A};
use convex_support::{InvalidShape, Polytope};

use crate::engine::IN_BROWSER;
use crate::wire::error::{Kind, Problem};

/// The vertices of a mesh, and their hull once it has been asked for.
#[derive(Debug)]
pub struct Mesh {
    points: Vec<DVec3>,
    hull_f64: OnceLock<Result<Arc<Polytope<DVec3>>, InvalidShape>>,
    hull_f32: OnceLock<Result<Arc<Polytope<Vec3A>>, InvalidShape>>,
}

impl Mesh {
    fn new(points: Vec<DVec3>) -> Self {
        Self { points, hull_f64: OnceLock::new(), hull_f32: OnceLock::new() }
    }

    /// The distinct vertices.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The convex hull in double precision.
    pub fn hull_f64(&self) -> Result<Arc<Polytope<DVec3>>, InvalidShape> {
        self.hull_f64.get_or_init(|| Polytope::hull_of(self.points.iter().copied()).map(Arc::new)).clone()
    }

    /// The convex hull of the vertices rounded to single precision.
    pub fn hull_f32(&self) -> Result<Arc<Polytope<Vec3A>>, InvalidShape> {
        let rounded = || self.points.iter().map(|p| p.as_vec3a());
        self.hull_f32.get_or_init(|| Polytope::hull_of(rounded()).map(Arc::new)).clone()
    }
}

/// The meshes in use, read once each. What is kept is bounded, whatever the number of files.
#[derive(Debug)]
pub struct Meshes {
    /// What the paths of a query file are relative to.
    folder: PathBuf,
    access: Access,
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
    pub fn relative_to(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), access: Access::default(), kept: Mutex::default() }
    }

    /// The same, of which only those are read that `access` allows.
    #[must_use]
    pub fn with_access(self, access: Access) -> Self {
        Self { access, ..self }
    }

    /// The mesh in the file at `path`.
    pub fn load(&self, path: &Path) -> Result<Arc<Mesh>, Problem> {
        let path = self.folder.join(path);
        // A panic elsewhere leaves the map whole: it is only inserted into.
        if let Some(mesh) = self.kept.lock().unwrap_or_else(PoisonError::into_inner).meshes.get(&path) {
            return Ok(Arc::clone(mesh));
        }
        let points = read(&path, &self.access)
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

/// Which files may be read as meshes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Access {
    #[default]
    Anywhere,
    /// Below this folder, links resolved.
    Below(PathBuf),
    Nowhere,
}

impl Access {
    /// `none`, a folder that is there, or nothing.
    ///
    /// # Errors
    /// If there is no such folder.
    pub fn parse(text: &str) -> Result<Self, String> {
        match text {
            "" => Ok(Self::Anywhere),
            "none" => Ok(Self::Nowhere),
            folder => match fs::canonicalize(folder) {
                Ok(folder) if folder.is_dir() => Ok(Self::Below(folder)),
                Ok(_) => Err("it is no folder".to_owned()),
                Err(why) => Err(why.to_string()),
            },
        }
    }
}

/// The largest mesh that is read, in bytes: binary STL of more than five million triangles.
const LARGEST: u64 = 1 << 28;

/// Why a mesh was not read.
#[derive(Debug)]
enum Unread {
    /// Its name ends otherwise.
    Ending,
    Forbidden,
    /// It lies elsewhere.
    Outside(PathBuf),
    /// A folder, a device, a pipe: what may have no end, or never begin.
    NotAFile,
    TooLarge,
    Io(io::Error),
    /// What is written in it is no mesh.
    Malformed(String),
}

impl Display for Unread {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ending => write!(f, "its name must end in .obj or .stl"),
            Self::Forbidden => write!(f, "this program was started with --meshes none"),
            Self::Outside(folder) => write!(f, "it is not below \"{}\", as --meshes has it", folder.display()),
            Self::NotAFile => write!(f, "it is not a regular file"),
            Self::TooLarge => write!(f, "it has more than {} MiB, the most that is read", LARGEST >> 20),
            Self::Io(why) => Display::fmt(why, f),
            Self::Malformed(why) => f.write_str(why),
        }
    }
}

impl From<io::Error> for Unread {
    fn from(why: io::Error) -> Self {
        Self::Io(why)
    }
}

/// The distinct vertices of an OBJ or STL file, told apart by the extension, in the order of the file.
fn read(path: &Path, access: &Access) -> Result<Vec<DVec3>, Unread> {
    if IN_BROWSER {
        return Err(Unread::Forbidden);
    }
    type Parse = fn(Vec<u8>) -> Result<Vec<DVec3>, String>;
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let parse: Parse = match extension.as_str() {
        "obj" => |bytes| read_obj(&bytes),
        "stl" => read_stl,
        _ => return Err(Unread::Ending),
    };
    let points = parse(read_bytes(path, access)?).map_err(Unread::Malformed)?;
    let mut seen = HashSet::with_capacity(points.len());
    // −0 and 0 are one coordinate.
    Ok(points.into_iter().filter(|p| seen.insert(p.to_array().map(|c| (c + 0.0).to_bits()))).collect())
}

/// All of a regular file, if that is allowed and not too much. Links are followed.
///
/// What it is, is asked before it is opened, as opening a pipe waits for somebody to write; and the size is counted
/// while reading, as a file may grow, and those that the system makes up have none.
fn read_bytes(path: &Path, access: &Access) -> Result<Vec<u8>, Unread> {
    if *access == Access::Nowhere {
        return Err(Unread::Forbidden);
    }
    let path = fs::canonicalize(path)?;
    if let Access::Below(folder) = access
        && !path.starts_with(folder)
    {
        return Err(Unread::Outside(folder.clone()));
    }
    if !fs::metadata(&path)?.is_file() {
        return Err(Unread::NotAFile);
    }
    let mut bytes = Vec::new();
    File::open(&path)?.take(LARGEST + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST { Err(Unread::TooLarge) } else { Ok(bytes) }
}

fn read_obj(bytes: &[u8]) -> Result<Vec<DVec3>, String> {
    // The reader returns the vertices of elements, one model after another. A last model with an element of one vertex
    // for every vertex of the file makes it return all of them, whether a face uses them or not.
    let count = bytes.split(|&b| b == b'\n').filter(|l| is_vertex(l)).count();
    if count == 0 {
        return Ok(Vec::new());
    }
    let elements = (1..=count).fold("\no all".to_owned(), |text, i| text + &format!("\nl {i}"));
    let mut text = bytes.chain(elements.as_bytes());
    let options = tobj::LoadOptions { single_index: true, ..Default::default() };
    let (models, _) = tobj::load_obj_buf(&mut io::BufReader::new(&mut text), &options, |_| Ok(Default::default()))
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

    /// A folder of its own for a test, and what it holds is gone afterwards.
    struct Folder(PathBuf);

    impl Folder {
        fn new(name: &str) -> Self {
            let folder = std::env::temp_dir().join(format!("mesh-{name}-{}", std::process::id()));
            fs::create_dir_all(&folder).expect("a folder for temporary files");
            Self(folder)
        }

        fn at(&self, name: &str) -> PathBuf {
            self.0.join(name)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn why(path: &Path, access: &Access) -> String {
        read(path, access).expect_err("it is not to be read").to_string()
    }

    #[test]
    fn the_name_is_looked_at_first() {
        assert_eq!(why(Path::new("/dev/zero"), &Access::Anywhere), "its name must end in .obj or .stl");
    }

    #[test]
    #[cfg(unix)]
    fn only_regular_files_are_read_however_they_are_called() {
        let folder = Folder::new("regular");
        let (zeros, pipe) = (folder.at("zeros.stl"), folder.at("pipe.obj"));
        std::os::unix::fs::symlink("/dev/zero", &zeros).expect("a link");
        assert_eq!(why(&zeros, &Access::Anywhere), "it is not a regular file");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success());
        assert!(made, "mkfifo makes a pipe");
        assert_eq!(why(&pipe, &Access::Anywhere), "it is not a regular file");
        fs::create_dir(folder.at("folder.obj")).expect("a folder");
        assert_eq!(why(&folder.at("folder.obj"), &Access::Anywhere), "it is not a regular file");
    }

    #[test]
    fn what_is_too_large_is_said_with_the_limit() {
        let folder = Folder::new("large");
        let path = folder.at("large.obj");
        // A hole of that size: it takes no room on disk.
        File::create(&path).and_then(|file| file.set_len(LARGEST + 1)).expect("a file");
        assert_eq!(why(&path, &Access::Anywhere), "it has more than 256 MiB, the most that is read");
    }

    #[test]
    #[cfg(unix)]
    fn a_service_reads_below_its_folder_only() {
        let folder = Folder::new("below");
        fs::create_dir(folder.at("inside")).expect("a folder");
        for name in ["outside.obj", "inside/inside.obj"] {
            fs::write(folder.at(name), "v 1 2 3\n").expect("a file");
        }
        std::os::unix::fs::symlink(folder.at("outside.obj"), folder.at("inside/link.obj")).expect("a link");
        let access = Access::parse(folder.at("inside").to_str().expect("its name is text")).expect("a folder");
        assert!(read(&folder.at("inside/inside.obj"), &access).is_ok(), "below it");
        for name in ["outside.obj", "inside/../outside.obj", "inside/link.obj"] {
            let why = why(&folder.at(name), &access);
            assert!(why.starts_with("it is not below "), "{name}: {why}");
        }
        assert_eq!(
            why(&folder.at("inside/inside.obj"), &Access::Nowhere),
            "this program was started with --meshes none"
        );
    }

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
