// The bodies in space, ray traced in a worker: coarse while they turn, fine when they rest.

import { plain } from './questions.js';

// Where a picture is seen from at first: a ray from beside its source, so that the hit is seen.
function begin({ direction }) {
  const length = direction ? Math.hypot(...direction) : 0;
  if (!(length > 0)) return [0.6, 0.4, 1];
  const [x, y, z] = direction.map((d) => -d / length);
  return [Math.atan2(x, z) + 0.6, Math.max(-1, Math.min(1, Math.asin(y) + 0.3)), 1];
}

// A body at a time of its motion: turned about the centre of that, and moved.
function placed(query, key, time) {
  const body = query[key];
  if (!body || body.type === 'half_space') return body;
  const still = [0, 0, 0];
  const motion = query.query === 'linear_cast' ? { velocity: query[`velocity_${key}`] } : query[`motion_${key}`];
  const { velocity: v = still, angular_velocity: w = still, center: c = still } = motion ?? {};
  const speed = Math.hypot(...w), [x, y, z] = speed > 0 ? w.map((each) => each / speed) : still;
  const [sin, cos, along] = [Math.sin(speed * time), Math.cos(speed * time), c[0] * x + c[1] * y + c[2] * z];
  const across = [y * c[2] - z * c[1], z * c[0] - x * c[2], x * c[1] - y * c[0]];
  const turned = [x, y, z].map((axis, i) => cos * c[i] + sin * across[i] + (1 - cos) * along * axis);
  const half = Math.sin((speed * time) / 2);
  return {
    type: 'posed', of: body, rotation: [x * half, y * half, z * half, Math.cos((speed * time) / 2)],
    translation: c.map((each, i) => each - turned[i] + v[i] * time),
  };
}

export class Space {
  constructor(canvas) {
    this.canvas = canvas;
    this.view = [0.6, 0.4, 1];
    this.id = 0;
    this.isBusy = false;
    this.pointers = new Map();
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    canvas.addEventListener('wheel', (event) => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY / 500));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const turn = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (turn) this.turn(turn[0] * 0.1, turn[1] * 0.1);
      else if (event.key === '+' || event.key === '=') this.zoom(1.15);
      else if (event.key === '-') this.zoom(1 / 1.15);
      else return;
      event.preventDefault();
    });
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const here = [event.clientX, event.clientY];
    const other = [...this.pointers].find(([id]) => id !== event.pointerId)?.[1];
    this.pointers.set(event.pointerId, here);
    const apart = (p) => Math.hypot(p[0] - other[0], p[1] - other[1]);
    if (other) this.zoom(apart(here) / Math.max(apart(before), 1));
    else this.turn(-(here[0] - before[0]) / 150, (here[1] - before[1]) / 150);
  }

  turn(yaw, pitch) {
    this.view = [this.view[0] + yaw, Math.max(-1.55, Math.min(1.55, this.view[1] + pitch)), this.view[2]];
    this.draw();
  }

  zoom(by) {
    this.view[2] = Math.max(0.1, Math.min(40, this.view[2] * by));
    this.draw();
  }

  // The bodies of a query, with the points of its answer; of moving ones at a time, seen as far as they go until the end.
  show(query, answer, clock) {
    const marks = [answer.point_a, answer.point_b, answer.point].filter(Array.isArray);
    const ways = [];
    if (query.source && query.direction) ways.push([query.source, answer.point ?? query.source.map((x, i) => x + 1e3 * query.direction[i])]);
    if (answer.point_a && !answer.overlap) ways.push([answer.point_a, answer.point_b]);
    if (query.e1) query = { ...query, a: { type: 'ellipsoid', ...query.e1 }, b: { type: 'ellipsoid', ...query.e2 } };
    const also = [];
    if (clock) {
      also.push(...[0, clock.end].flatMap((time) => ['a', 'b'].map((body) => placed(query, body, time))));
      const center = query.motion_a?.center ?? query.a?.translation ?? [0, 0, 0], v = query.velocity_a ?? query.motion_a?.velocity;
      if (v?.some(Boolean)) ways.push([center, center.map((x, i) => x + v[i] * (answer.time ?? clock.end))]);
      query = { ...query, a: placed(query, 'a', clock.time), b: placed(query, 'b', clock.time) };
    }
    const key = JSON.stringify([query, marks]);
    if (key === this.key) return this.draw();
    if (query.query !== this.query?.query || query.id !== this.query?.id) this.view = begin(query);
    Object.assign(this, { key, query: plain(query), marks, ways, also, ellipsoid: Array.isArray(answer.axes) ? answer : null });
    this.draw();
  }

  draw() {
    if (!this.query) return;
    this.wanted = this.scale = 3;
    this.next();
  }

  // Asks for the next picture: a coarse one of the newest view first, then finer ones of the same.
  next() {
    if (this.isBusy || !this.wanted) return;
    const { canvas, query, marks, ways, also, ellipsoid, view } = this;
    const width = Math.round(Math.min(canvas.clientWidth || 480, 960)), height = Math.round(canvas.clientHeight || 400);
    const size = [Math.max(2, Math.floor(width / this.wanted)), Math.max(2, Math.floor(height / this.wanted))];
    const more = { _view: [...view], _size: size, _marks: marks, _ways: ways, _also: also };
    if (ellipsoid) more._ellipsoid = { center: ellipsoid.center, semi_axes: ellipsoid.semi_axes, rotation: ellipsoid.rotation };
    this.worker ??= this.begin();
    this.isBusy = true;
    this.asked = this.wanted;
    this.wanted = 0;
    this.worker.postMessage({ id: ++this.id, query, more });
  }

  begin() {
    const worker = new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
    worker.onmessage = ({ data: { size, pixels, problem, took } }) => {
      this.isBusy = false;
      if (problem) this.canvas.setAttribute('aria-label', `No picture: ${problem}`);
      else if (pixels.length === size[0] * size[1] * 4) {
        [this.canvas.width, this.canvas.height] = size;
        this.canvas.getContext('2d').putImageData(new ImageData(new Uint8ClampedArray(pixels.buffer), ...size), 0, 0);
        this.canvas.dataset.took = took.toFixed(1);
        this.canvas.dataset.size = size.join(' × ');
      }
      // Nothing newer is wanted: the same view, finer; four rays a pixel only where that does not take seconds.
      if (!this.wanted && !problem) this.wanted = this.asked > 2 ? 1 : this.asked === 1 && took < 800 ? 0.5 : 0;
      this.next();
    };
    return worker;
  }
}
