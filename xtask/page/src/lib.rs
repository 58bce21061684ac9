//! The page in the browser, as one function of wasm32: a request in JSON in, an answer in JSON or a picture out.
//!
//! The page's state is one line of the query format ([`xtask::query`] answers it, as on the command line); what the
//! page wants beside the answer it says in fields that begin with `_`, which the format ignores. So a link, a line to
//! copy, and the state are the same text, and no number of the page comes from other code than the answers of the
//! command line do.
//!
//! There are two engines, by the features of this package: one for the plane, with which the page opens, and one for
//! space, for points of any dimension and for the checker of certificates, downloaded where one of these is asked for.
//!
//! The exports are plain: bytes in, bytes out, in one buffer each way. wasm-bindgen would add a command that has to be
//! of the very version of its crate, and glue for types, of which JSON and bytes need none.

mod draw;
mod observed;
#[cfg(feature = "space")]
mod space;

use std::cell::RefCell;

use serde_json::Value;
use xtask::mesh::{Access, Meshes};
use xtask::wire::json::object;

/// What the page writes a request into, and what it reads the reply from.
#[derive(Default)]
struct Buffers {
    request: Vec<u8>,
    reply: Vec<u8>,
}

thread_local! {
    static BUFFERS: RefCell<Buffers> = RefCell::default();
}

/// Where the page is to write a request of so many bytes.
#[allow(unsafe_code, reason = "the page finds the function by its name")]
#[unsafe(no_mangle)]
pub extern "C" fn request(length: usize) -> *mut u8 {
    BUFFERS.with_borrow_mut(|buffers| {
        buffers.request.clear();
        buffers.request.resize(length, 0);
        buffers.request.as_mut_ptr()
    })
}

/// Replies to the request, and says how many bytes the reply has.
#[allow(unsafe_code, reason = "the page finds the function by its name")]
#[unsafe(no_mangle)]
pub extern "C" fn respond() -> usize {
    let request = BUFFERS.with_borrow_mut(|buffers| std::mem::take(&mut buffers.request));
    let reply = reply(&request);
    let length = reply.len();
    BUFFERS.with_borrow_mut(|buffers| buffers.reply = reply);
    length
}

/// Where the reply is.
#[allow(unsafe_code, reason = "the page finds the function by its name")]
#[unsafe(no_mangle)]
pub extern "C" fn response() -> *const u8 {
    BUFFERS.with_borrow(|buffers| buffers.reply.as_ptr())
}

/// Meshes, none of which can be read in a browser.
fn no_meshes() -> Meshes {
    Meshes::relative_to("").with_access(Access::Nowhere)
}

/// The reply to a request: a query line, of which `_want` says what is wanted.
///
/// - nothing: the line of output of `cargo xtask query`, byte for byte;
/// - `"look"`: `{"answer", "drawing", "seen"}`, that line, with what is drawn of the question and the iterates of its
///   search;
/// - `"certify"`: the line with answer and certificate, as `cargo xtask query --certify` writes it;
/// - in space, `"judge"`: what the checker says of such a line; and `"picture"`: the pixels of the bodies, four bytes
///   each.
#[must_use]
pub fn reply(request: &[u8]) -> Vec<u8> {
    let meshes = no_meshes();
    let Ok(object) = object(request) else { return xtask::query::answer(request, &meshes) };
    match object.get("_want").and_then(Value::as_str) {
        Some("look") => {
            let answer = xtask::query::answer(request, &meshes);
            let is_error = serde_json::from_slice(&answer).is_ok_and(|answer: Value| answer.get("error").is_some());
            let seen = if is_error { Value::Null } else { observed::look(&object, &meshes) };
            let drawing = draw::drawing(&object, &meshes);
            // As it is written, its fields in their order.
            let answer = String::from_utf8_lossy(&answer);
            format!("{{\"answer\":{answer},\"drawing\":{drawing},\"seen\":{seen}}}").into_bytes()
        }
        Some("certify") => xtask::query::certified(request, &meshes).unwrap_or_default(),
        #[cfg(feature = "space")]
        Some("judge") => xtask::prove::judge_line(request, &meshes).1.to_string().into_bytes(),
        #[cfg(feature = "space")]
        Some("picture") => space::picture(&object, &meshes),
        _ => xtask::query::answer(request, &meshes),
    }
}
