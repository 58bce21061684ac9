// An engine: one function of plane.wasm or space.wasm, bytes in and bytes out. The page and the worker of pictures each have
// their own.

const encoder = new TextEncoder();
const decoder = new TextDecoder();

export async function engine(half) {
  const response = await fetch(new URL(`${half}.wasm`, import.meta.url));
  if (!response.ok) throw new Error(`${half}.wasm: ${response.status} ${response.statusText}`);
  // Whatever type the server says the file has.
  const module = await WebAssembly.compile(await response.arrayBuffer());
  let exports = (await WebAssembly.instantiate(module, {})).exports;

  // The bytes of the reply to a line of text.
  function reply(text) {
    const bytes = encoder.encode(text);
    try {
      // The memory is another one after it has grown: where is asked first.
      const place = exports.request(bytes.length);
      new Uint8Array(exports.memory.buffer, place, bytes.length).set(bytes);
      const length = exports.respond(), found = exports.response();
      return new Uint8Array(exports.memory.buffer, found, length).slice();
    } catch (why) {
      // What stopped in the middle has no state that can be trusted: begin anew.
      exports = new WebAssembly.Instance(module, {}).exports;
      throw new Error(`the engine stopped (${why.message}); please report this line`);
    }
  }

  return {
    // The line of output for a line of the query format, as `cargo xtask query` writes it.
    answer: (line) => decoder.decode(reply(line)).trimEnd(),
    // What is asked for of a query beside its answer.
    ask: (query, want) => JSON.parse(decoder.decode(reply(JSON.stringify({ ...query, _want: want })))),
    picture: (query, more) => reply(JSON.stringify({ ...query, ...more, _want: 'picture' })),
  };
}
