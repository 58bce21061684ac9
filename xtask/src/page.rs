//! `cargo xtask page`: the page in the browser, as static files in `target/page`, and a server for them.
//!
//! The page is the package `xtask/page`, which is no member of the workspace: it is compiled here alone, for wasm32.

use std::fs;
use std::io::{self, BufRead, BufReader, Read as _, Write};
use std::net::{TcpListener, TcpStream};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::thread;
use std::time::Duration;

use clap::Args;
use serde_json::Value;

use crate::engine;
use crate::output;
use crate::wire::json;

/// What to do with the page.
#[derive(Clone, Debug, Args)]
pub struct Choice {
    /// Serve the page on this machine until the program is stopped.
    #[arg(long)]
    serve: bool,
    /// The port to serve it at; 0 is any that is free.
    #[arg(long, default_value_t = 8080)]
    port: u16,
}

const PACKAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/page");
const POSES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/data/museum.jsonl");
const TARGET: &str = "wasm32-unknown-unknown";

/// Builds the page, and serves it if that is asked for.
pub fn run(choice: &Choice) -> ExitCode {
    let built = build().and_then(|folder| {
        told(&format!(
            "{}: open it through any server of files, as a browser loads no engine from a file",
            folder.display()
        ));
        if choice.serve { serve(&folder, choice.port).map_err(|why| format!("cannot serve: {why}")) } else { Ok(()) }
    });
    output::ended(built.map(|()| true))
}

fn told(text: &str) {
    // Whoever does not read it does not miss it.
    let _ = writeln!(io::stdout(), "{text}");
}

/// Compiles the engine, and puts it beside the files of the site; the folder.
fn build() -> Result<PathBuf, String> {
    let target =
        std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| Path::new(PACKAGE).join("../../target"), PathBuf::from);
    let (folder, work) = (target.join("page"), target.join("page-build"));
    let write = |name: &str, bytes: &[u8]| {
        fs::write(folder.join(name), bytes)
            .map_err(|why| format!("cannot write {name} into {}: {why}", folder.display()))
    };
    let read = |path: &Path| fs::read(path).map_err(|why| format!("cannot read {}: {why}", path.display()));
    fs::create_dir_all(&folder).map_err(|why| format!("cannot write {}: {why}", folder.display()))?;
    let site = Path::new(PACKAGE).join("site");
    for file in fs::read_dir(&site).and_then(Iterator::collect::<io::Result<Vec<_>>>).map_err(|why| why.to_string())? {
        write(&file.file_name().to_string_lossy(), &read(&file.path())?)?;
    }
    for half in ["plane", "space"] {
        compile(half, &work)?;
        write(&format!("{half}.wasm"), &read(&work.join(TARGET).join("release/page.wasm"))?)?;
    }
    let poses = String::from_utf8(read(Path::new(POSES))?).map_err(|why| why.to_string())?;
    write("museum.json", museum(&poses).as_bytes())?;
    folder.canonicalize().map_err(|why| why.to_string())
}

/// Compiles the engine for the plane or for space.
fn compile(half: &str, work: &Path) -> Result<(), String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.args(["build", "--release", "--locked", "--lib", "--target", TARGET, "--features", half]);
    // Of functions as short as those of vectors a call takes more bytes than the body, which `opt-level = "z"`
    // misjudges.
    command.env("RUSTFLAGS", "-Cllvm-args=-inline-threshold=40");
    command.arg("--target-dir").arg(work).arg("--manifest-path").arg(Path::new(PACKAGE).join("Cargo.toml"));
    let status = command.status().map_err(|why| format!("cannot run cargo: {why}"))?;
    match status.success() {
        true => Ok(()),
        false if has_target() => Err("the page does not compile".to_owned()),
        false => Err(format!("this Rust has no {TARGET}: rustup target add {TARGET}")),
    }
}

fn has_target() -> bool {
    let rustc = Command::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).output();
    rustc.is_ok_and(|told| Path::new(String::from_utf8_lossy(&told.stdout).trim()).is_dir())
}

/// The poses of the museum that the page's engine answers, as a list.
fn museum(poses: &str) -> String {
    let is_shown = |line: &&str| {
        json::object(line.as_bytes()).is_ok_and(|pose| {
            let said = |field: &str| pose.get(field).and_then(Value::as_str).unwrap_or_default();
            engine::is_of_page(said("query")) && said("precision") != "f32"
        })
    };
    format!("[\n{}\n]\n", poses.lines().filter(is_shown).collect::<Vec<_>>().join(",\n"))
}

/// Serves the files of a folder on this machine.
fn serve(folder: &Path, port: u16) -> io::Result<()> {
    let listener = TcpListener::bind(("127.0.0.1", port))?;
    told(&format!("http://{}/", listener.local_addr()?));
    for stream in listener.incoming() {
        let folder = folder.to_owned();
        // Who asks badly, or goes away, ends its own thread only.
        thread::spawn(move || stream.and_then(|stream| respond(&folder, stream)));
    }
    Ok(())
}

/// The longest request that is read.
const LONGEST: u64 = 16 << 10;

/// Answers one request.
fn respond(folder: &Path, mut stream: TcpStream) -> io::Result<()> {
    stream.set_read_timeout(Some(Duration::from_secs(10)))?;
    let mut lines = BufReader::new(stream.try_clone()?.take(LONGEST)).lines();
    let first = lines.next().transpose()?.unwrap_or_default();
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let (status, kind, body) = file(folder, &first);
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n\
         Cache-Control: no-cache\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(&body)
}

/// The status, the type and the bytes for the first line of a request. The site has no folders, so that a name with a
/// slash is none of its files.
fn file(folder: &Path, request: &str) -> (&'static str, &'static str, Vec<u8>) {
    let mut words = request.split(' ');
    let (method, target) = (words.next(), words.next().unwrap_or_default());
    if method != Some("GET") {
        return ("405 Method Not Allowed", "text/plain", Vec::new());
    }
    let name = target.split(['?', '#']).next().unwrap_or_default().trim_start_matches('/');
    let name = if name.is_empty() { "index.html" } else { name };
    let kind = match name.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "css" => "text/css",
        "js" => "text/javascript",
        "json" => "application/json",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        _ => "application/octet-stream",
    };
    let is_plain = !name.contains(['/', '\\', '%']) && !name.starts_with('.');
    match is_plain.then(|| fs::read(folder.join(name))) {
        Some(Ok(bytes)) => ("200 OK", kind, bytes),
        _ => ("404 Not Found", "text/plain", b"no such file".to_vec()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_the_site_are_served() {
        let site = Path::new(PACKAGE).join("site");
        for (request, due) in [
            ("GET / HTTP/1.1", "200 OK"),
            ("GET /page.js?x=1 HTTP/1.1", "200 OK"),
            ("GET /../Cargo.toml HTTP/1.1", "404 Not Found"),
            ("GET /%2e%2e/Cargo.toml HTTP/1.1", "404 Not Found"),
            ("GET /none.js HTTP/1.1", "404 Not Found"),
            ("POST / HTTP/1.1", "405 Method Not Allowed"),
            ("", "405 Method Not Allowed"),
        ] {
            let (status, _, body) = file(&site, request);
            assert_eq!(status, due, "{request}");
            assert_eq!(status == "200 OK", body.starts_with(b"<!doctype") || body.starts_with(b"//"), "{request}");
        }
    }

    /// Everything that the menu offers is answered by the same engine.
    #[test]
    fn the_menu_is_a_list_of_poses() {
        let poses = fs::read_to_string(POSES).expect("it is there");
        let menu: Vec<Value> = serde_json::from_str(&museum(&poses)).expect("a list");
        assert!(menu.len() >= 80, "{} poses", menu.len());
        assert!(menu.iter().all(|pose| pose["id"].is_string() && pose["_title"].is_string()), "each has a name");
    }
}
