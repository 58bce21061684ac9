// Ray traces pictures beside the page, so that the page never waits for one.

import { engine } from './engine.js';

const ready = engine('space');

onmessage = async ({ data: { id, query, more } }) => {
  try {
    const start = performance.now();
    const pixels = (await ready).picture(query, more);
    postMessage({ id, size: more._size, pixels, took: performance.now() - start }, [pixels.buffer]);
  } catch (why) {
    postMessage({ id, problem: why.message });
  }
};
