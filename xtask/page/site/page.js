// The page. Its whole state is one line of the query format, with what only the page needs in fields that begin with `_`;
// every change asks the engine that line and draws the reply.

import { engine } from './engine.js';
import { BODIES, QUESTIONS, copy, handle, plain } from './questions.js';
import { HEIGHT, STYLE, View, WIDTH, arrow, bracket, cross, dot, f, gaps, grid, halfPlane, iterate, line, path, short } from './plane.js';

const $ = (id) => document.getElementById(id);
const SVG = 'http://www.w3.org/2000/svg';
const round = (x) => Math.round(x * 1000) / 1000;
const escape = (text) => String(text).replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);
const colours = { a: 'a', b: 'b', target: 'b', e1: 'a', e2: 'b' };

// The engine for the plane, with which the page opens, and the one for space, once it is asked for.
let plane;
let spatial = null;
let query = copy(QUESTIONS.distance.line);
let reply = null;
let steps = [];
let views = {};
let museum = [];
let playing = null;
let space = null;

const question = () => QUESTIONS[query.query];
const isSpatial = () => (reply?.drawing?.dimension ?? 2) === 3;
// What moves by itself: a cast in the plane without turning shows its way by its steps.
const hasClock = () => query.query === 'motion_cast' || (query.query === 'linear_cast' && isSpatial());
const isFloor = (key) => query[key]?.type === 'half_space';

// ---- state: the line, the address, the fields ----

function link() {
  return `#${encodeURIComponent(JSON.stringify(query)).replace(/%22/g, "'").replace(/%3A/g, ':').replace(/%2C/g, ',').replace(/%5B/g, '(').replace(/%5D/g, ')').replace(/%7B/g, '{').replace(/%7D/g, '}')}`;
}

// The line in an address. Quotes and brackets, which chat programs and shells cut links at, are written as ' ( ).
function fromLink(hash) {
  const text = decodeURIComponent(hash.slice(1));
  try {
    return JSON.parse(text);
  } catch {
    return JSON.parse(text.replace(/'/g, '"').replace(/\(/g, '[').replace(/\)/g, ']'));
  }
}

let remembered = 0;
function remember() {
  clearTimeout(remembered);
  // Browsers refuse an address that changes at every frame.
  remembered = setTimeout(() => history.replaceState(null, '', link()), 250);
}

function show(line, why = '') {
  stop();
  query = line;
  views = {};
  update();
  fillOptions();
  fit();
  $('line-problem').textContent = why;
}

// ---- asking ----

// The engine that a question needs; none while it is being downloaded.
function engineFor() {
  const isOfSpace = query.query === 'enclosing_ellipsoid' || plane.ask(query, 'look').drawing.dimension === 3;
  if (!isOfSpace) return plane;
  if (!spatial) loadSpace().then(() => (update(), fillOptions(), fit()), (why) => lost(why));
  return spatial;
}

let loading = null;
const loadSpace = () => (loading ??= Promise.all([engine('space'), import('./space.js')]).then(([found, { Space }]) => {
  space = new Space($('space'));
  spatial = found;
}));

function lost(why) {
  loading = null;
  $('verdict').textContent = `There is no answer: the engine for space did not load (${why.message}).`;
  $('verdict').classList.add('problem');
}

function update({ isDrag = false } = {}) {
  try {
    const asked = engineFor();
    if (!asked) {
      $('verdict').textContent = 'Loading the engine for space …';
      reply ??= plane.ask(query, 'look');
      return;
    }
    reply = { ...asked.ask(query, 'look'), of: query.query };
  } catch (why) {
    reply = { answer: { error: { message: why.message } }, drawing: reply?.drawing ?? {}, seen: null, of: query.query };
  }
  const { answer, seen } = reply;
  steps = (seen?.iterates ?? []).map((it, i) => ({ lower: it.lower, upper: it.upper ?? Infinity, name: `step ${i}`, it }));
  const end = seen ?? answer;
  if (!answer.error) {
    const lower = end.lower ?? (answer.hit === false ? Infinity : -Infinity);
    steps.push({ lower, upper: end.upper ?? Infinity, name: 'answer', it: null });
  }
  if (isDrag) delete query._step;
  if (isDrag && query._issue) {
    // A pose that was moved is no longer the report's, and has another truth.
    for (const key of ['id', '_issue', '_title', '_reported', '_pose', '_truth', '_today', 'expect', 'allow']) delete query[key];
    fillOptions();
  }
  const last = Math.max(steps.length - 1, 0);
  const step = Math.min(query._step ?? last, last);
  Object.assign($('step'), { max: last, value: step, disabled: last === 0 });
  draw();
  if (!isDrag) tell();
  remember();
}

const now = () => Number($('step').value);

// ---- what is seen ----

function points() {
  try {
    return extent();
  } catch {
    return [];
  }
}

function extent() {
  const { answer, drawing } = reply;
  const outlines = drawing.outlines ?? {};
  const moved = (key, time) => (outlines[key] ?? []).map((p) => moveTo(key, p, time));
  switch (query.query) {
    case 'ray_cast': return [...(outlines.target ?? []), query.source, tip(), ...(answer.hit ? [answer.point] : [])];
    case 'linear_cast': return [...(outlines.a ?? []), ...(outlines.b ?? []), tip(), ...moved('a', answer.time ?? 1)];
    case 'motion_cast': return [...(outlines.a ?? []), ...(outlines.b ?? []), ...moved('a', answer.time ?? query.max_time)];
    case 'margin': return [query.e1, query.e2].flatMap((e) => around(e));
    case 'enclosing_ellipsoid': return [...(query.points ?? []), ...around(answer)];
    // Of a floor, what lies below the body.
    default: return [...(outlines.a ?? []), ...(outlines.b ?? []), ...(isFloor('b') && answer.point_b ? [answer.point_b] : [])];
  }
}

// The corners of a square around an ellipse.
function around(e) {
  if (!Array.isArray(e?.center) || !Array.isArray(e.semi_axes)) return [];
  const r = Math.max(...e.semi_axes);
  return [[-r, -r], [r, r]].map((d) => e.center.map((c, i) => c + d[i]));
}

const tip = () => {
  if (query.query === 'ray_cast') return query.source?.map((x, i) => x + query.direction[i]);
  const body = handle(query, 'a');
  const velocity = query.query === 'linear_cast' ? query.velocity_a : query.motion_a?.velocity;
  return body?.of[body.place].map((x, i) => x + (velocity?.[i] ?? 0));
};

// A point of a body at a time of its motion.
function moveTo(key, p, time) {
  if (query.query === 'linear_cast') return p.map((x, i) => x + time * (query[`velocity_${key}`]?.[i] ?? 0));
  const { velocity = [0, 0], angular_velocity: w = 0, center = [0, 0] } = query[`motion_${key}`] ?? {};
  const [cos, sin] = [Math.cos(w * time), Math.sin(w * time)];
  const [x, y] = [p[0] - center[0], p[1] - center[1]];
  return [center[0] + cos * x - sin * y + velocity[0] * time, center[1] + sin * x + cos * y + velocity[1] * time];
}

function fit() {
  if (!reply || reply.of !== query.query) return;
  if (isSpatial()) return draw();
  views.bodies = new View(points(), { width: $('panes').classList.contains('single') && innerWidth > 700 ? 960 : WIDTH });
  views.search = new View(searched());
  draw();
}

function searched() {
  const outline = reply.drawing.outlines?.difference ?? [];
  return query.query === 'linear_cast' && Array.isArray(query.velocity_a) ? [...outline, [0, 0], ray().at(1)] : [...outline, [0, 0]];
}

function ray() {
  const [a, b] = ['velocity_a', 'velocity_b'].map((key) => query[key] ?? [0, 0]);
  return { at: (t) => [t * (b[0] - a[0]), t * (b[1] - a[1])] };
}

function draw() {
  const { answer, drawing, seen } = reply;
  const k = now(), step = steps[k], isEnd = k === steps.length - 1;
  $('step-name').textContent = isEnd && steps.length > 1 ? `the answer` : steps.length > 1 ? `${step?.name} of ${steps.length - 1}` : 'no steps';
  if (answer.error) $('step-name').textContent = '';
  const single = isSpatial() || isFloor('b') || !['distance', 'signed_distance', 'linear_cast', 'motion_cast'].includes(query.query);
  const width = single && innerWidth > 700 ? 960 : WIDTH;
  if (views.bodies?.width !== width && views.bodies) views.bodies = new View(points(), { width });
  $('panes').classList.toggle('single', single);
  $('search-pane').hidden = single;
  $('clock').hidden = !hasClock() || Boolean(answer.error);
  $('space').hidden = !isSpatial();
  $('bodies').toggleAttribute('hidden', isSpatial());
  $('bodies').setAttribute('viewBox', `0 0 ${width} ${HEIGHT}`);
  // What cannot be drawn of a question without an answer is left out.
  const attempt = (part) => { try { part(); } catch (why) { if (!answer.error) throw why; } };
  if (isSpatial()) {
    $('bodies-caption').textContent = 'Drag the picture to turn it; pinch, or use the wheel, to zoom';
    space?.show(query, answer, hasClock() ? { time: Number($('time').value), end: Number($('time').max) } : null);
  } else {
    attempt(() => drawBodies(answer, drawing.outlines ?? {}, seen, step, isEnd));
    if (!single) attempt(() => drawSearch(answer, drawing.outlines ?? {}, seen, step, isEnd));
  }
  const box = Math.max($('bracket-pane').clientWidth - 26, 260);
  // A margin has neither steps nor a bracket.
  $('below').classList.toggle('single', query.query === 'margin');
  $('bracket-pane').hidden = $('player').hidden = query.query === 'margin';
  const funnel = steps.length ? bracket(steps, k, box) : { text: '', height: 10 };
  $('bracket').setAttribute('viewBox', `0 0 ${box} ${funnel.height}`);
  $('bracket').innerHTML = funnel.text;
  $('bracket').setAttribute('aria-label', step ? `${step.name}: from ${short(step.lower)} to ${short(step.upper)}` : 'No bracket');
  numbers();
}

function drawBodies(answer, outlines, seen, step, isEnd) {
  const view = (views.bodies ??= new View(points()));
  let out = grid(view) + (isFloor('b') ? halfPlane(view, query.b, 'b') : ''), over = '';
  const outline = (key, name, at) => outlines[key] && `<path class="body ${name}" d="${path(view, outlines[key].map(at ?? ((p) => p)))}"/>`;
  switch (query.query) {
    case 'distance': case 'signed_distance':
      if (answer.point_a) {
        over += line(view, [answer.point_a, answer.point_b], 'ink');
        over += dot(view, answer.point_a, 'a') + dot(view, answer.point_b, 'b');
      }
      break;
    case 'ray_cast':
      if (query.source && query.direction) {
        const far = answer.hit ? answer.point : query.source.map((x, i) => x + query.direction[i] * 1e3);
        over += line(view, [query.source, far], 'ink') + arrow(view, query.source, tip(), 'ink');
        if (step?.it) over += iterate(view, step.it, query.source) + dot(view, step.it.x, 'ink', 'x', [-4, 20]);
        if (isEnd && answer.hit) {
          if (answer.normal) over += arrow(view, answer.point, answer.point.map((x, i) => x + answer.normal[i] * (50 / view.unit)), 'plane', 'normal');
          over += dot(view, answer.point, 'plane');
        }
      }
      break;
    case 'linear_cast': {
      const time = isEnd ? answer.time : step?.it?.lower;
      if (Number.isFinite(time)) for (const key of ['a', 'b'].filter((key) => query[`velocity_${key}`])) out += outline(key, `${key} ghost`, (p) => moveTo(key, p, time)) ?? '';
      if (isEnd && answer.hit) over += dot(view, answer.point, 'plane', 'contact');
      over += arrow(view, handle(query, 'a')?.of.translation ?? [0, 0], tip(), 'a', 'velocity');
      break;
    }
    case 'motion_cast': {
      const time = Number($('time').value);
      for (const key of ['a', 'b'].filter((key) => query[`motion_${key}`])) {
        for (let i = 1; i < 8; i++) out += `<g opacity=".35">${outline(key, `${key} ghost`, (p) => moveTo(key, p, (query.max_time * i) / 8)) ?? ''}</g>`;
        out += outline(key, key, (p) => moveTo(key, p, time)) ?? '';
      }
      if (answer.hit) over += dot(view, answer.point, 'plane', 'contact');
      over += arrow(view, handle(query, 'a')?.of.translation ?? [0, 0], tip(), 'a', 'velocity');
      break;
    }
    case 'margin':
      if (!answer.error) {
        out += ellipse(view, { ...query.e1, semi_axes: query.e1.semi_axes.map((s) => s * Math.sqrt(1 + answer.margin)) }, 'a ghost');
        over += dot(view, answer.point, 'plane', 'touches here');
        const g = answer.gradient_translation;
        if (g) over += arrow(view, query.e1.center, query.e1.center.map((x, i) => x + g[i] * (90 / view.unit / (1 + Math.hypot(...g)))), 'of-simplex', 'gradient');
      }
      break;
    case 'enclosing_ellipsoid': {
      const weights = step?.it?.weights?.length ? step.it.weights : isEnd ? seen?.weights : null;
      out += isEnd && !answer.error ? ellipse(view, answer, 'c') : weights ? ellipse(view, weighted(weights), 'c') : '';
      for (const [i, weight] of weights ?? []) {
        const [x, y] = view.at(query.points[i]);
        out += `<circle class="simplex" cx="${f(x)}" cy="${f(y)}" r="${f(6 + 60 * Math.sqrt(weight / Math.PI))}"/>`;
        if (weight > 5e-4) over += `<text class="halo of-simplex strong" x="${f(x + 10)}" y="${f(y - 12)}">${weight.toFixed(3)}</text>`;
      }
      if (isEnd && answer.center) over += cross(view, answer.center, 'centre');
      break;
    }
  }
  const captions = {
    distance: 'The bodies and their closest points', signed_distance: 'The bodies, and the shortest way out where they overlap',
    ray_cast: 'The ray, the target, and the simplex of the search', linear_cast: 'They move until they touch',
    motion_cast: 'What moves and turns; drag time below', margin: 'A grown about its centre until it touches B',
    enclosing_ellipsoid: 'The least ellipse around the points; the discs are their weights',
  };
  $('bodies-caption').textContent = captions[query.query] ?? 'The bodies';
  layer('bodies', 'drawn').innerHTML = out;
  handles(view, outlines);
  layer('bodies', 'over').innerHTML = over;
}

// The ellipse that weights of points stand for: (x − c)ᵀS⁻¹(x − c) ≤ 2 for the weighted mean c and covariance S.
function weighted(weights) {
  const sum = (g) => weights.reduce((total, [i, w]) => total + w * g(query.points[i]), 0);
  const center = [sum((p) => p[0]), sum((p) => p[1])];
  const s = (i, j) => sum((p) => (p[i] - center[i]) * (p[j] - center[j]));
  const [xx, xy, yy] = [s(0, 0), s(0, 1), s(1, 1)];
  const [mean, radius] = [(xx + yy) / 2, Math.hypot((xx - yy) / 2, xy)];
  return { center, semi_axes: [Math.sqrt(2 * (mean + radius)), Math.sqrt(Math.max(2 * (mean - radius), 0))], rotation: Math.atan2(2 * xy, xx - yy) / 2 };
}

function ellipse(view, e, name) {
  if (!Array.isArray(e?.center) || e.center.length !== 2 || !Array.isArray(e.semi_axes)) return '';
  const [x, y] = view.at(e.center), [r, s] = e.semi_axes.map((a) => Math.abs(a) * view.unit);
  return `<ellipse class="body ${name}" cx="${f(x)}" cy="${f(y)}" rx="${f(r)}" ry="${f(s)}" transform="rotate(${f((-(e.rotation ?? 0) * 180) / Math.PI)} ${f(x)} ${f(y)})"/>`;
}

function drawSearch(answer, outlines, seen, step, isEnd) {
  const svg = $('search');
  if (query.query === 'motion_cast') {
    $('search-caption').textContent = 'The gap at each time examined; shaded: proved apart';
    svg.innerHTML = seen ? gaps(seen.iterates.slice(0, now() + 1), query.max_time, isEnd ? answer : { lower: step?.it?.lower }, Number($('time').value)) : '';
    svg.setAttribute('aria-label', `Gap over time; proved apart until ${short(step?.lower)}`);
    return;
  }
  const view = (views.search ??= new View(searched()));
  let out = grid(view);
  if (outlines.difference) out += `<path class="body c" d="${path(view, outlines.difference)}"/>`;
  let origin = [0, 0];
  if (query.query === 'linear_cast') {
    const way = ray();
    out += arrow(view, [0, 0], way.at(1), 'ink') + line(view, [[0, 0], way.at(answer.time ?? 1e3)], 'ink');
    if (step?.it) out += dot(view, step.it.x, 'ink', 'x', [-4, 20]);
    if (isEnd && answer.hit) out += dot(view, way.at(answer.time), 'plane', 'hit');
  } else if (isEnd && answer.point_a) {
    const v = answer.point_a.map((x, i) => x - answer.point_b[i]);
    out += line(view, [[0, 0], v], 'of-simplex') + dot(view, v, 'of-simplex', answer.overlap ? 'way out' : 'closest');
  }
  if (step?.it) out += iterate(view, step.it, origin);
  out += cross(view, origin, 'origin');
  svg.innerHTML = out;
  $('search-caption').textContent = 'Their difference A − B: how far is the origin?';
  if (query.query === 'linear_cast') $('search-caption').textContent = 'The same as a ray at the difference A − B';
  const it = step?.it;
  svg.setAttribute('aria-label', it?.simplex ? `Difference of the bodies; a simplex of ${it.simplex.length} vertices, support point ${it.w.map((x) => short(x, 4)).join(', ')}` : 'Difference of the bodies with the answer');
}

// ---- numbers and words ----

// To the bit: a script writes -0 as 0.
const exact = (x) => (Object.is(x, -0) ? '-0' : x);

function numbers() {
  const { answer, seen } = reply;
  const k = now(), step = steps[k], isEnd = k >= steps.length - 1;
  const rows = [];
  const add = (name, value, key = '') => value !== undefined && value !== null && rows.push(`<dt>${name}</dt><dd ${key && `data-key="${key}"`}>${escape([value].flat().map(exact).join(', '))}</dd>`);
  if (!answer.error && !isEnd && step) {
    add('step', `${k} of ${steps.length - 1}`);
    add('lower', step.lower, 'lower');
    add('upper', Number.isFinite(step.upper) ? step.upper : 'not known yet', 'upper');
    if (step.it.simplex) add('simplex', `${step.it.simplex.length} ${step.it.simplex.length === 1 ? 'vertex' : 'vertices'}`);
    if (step.it.v) add(step.it.x ? 'x' : 'v', step.it.x ?? step.it.v), add('w', step.it.w);
    if (step.it.gap !== undefined) add('time', step.it.time), add('gap then', step.it.gap);
  } else if (!answer.error) {
    const { id, error, ...fields } = answer;
    const scalar = question()?.scalar;
    for (const [key, value] of Object.entries(fields)) {
      if (['axes', 'matrix', 'features'].includes(key) || (value !== null && typeof value === 'object' && !Array.isArray(value))) continue;
      add(key.replaceAll('_', ' '), value ?? 'none', key);
      if (key === scalar && fields.lower !== undefined && fields.upper !== undefined) add('width', fields.upper - fields.lower, 'width');
    }
    if (seen?.status && (query._search || query._sub_algorithm || query.method)) {
      add('this search', `${seen.value ?? 'a miss'} in [${seen.lower}, ${seen.upper ?? '∞'}], ${seen.iterations} support points, ${seen.status}`, 'run');
    }
    if (seen?.weights) add('weights', seen.weights.map(([i, w]) => `${i}: ${w}`).join('; '), 'weights');
  }
  $('numbers').innerHTML = rows.join('');
}

const between = (answer) => (answer.lower !== undefined && answer.upper !== undefined ? `, proved to be within [${answer.lower}, ${answer.upper}]` : answer.certain === false ? ', which is not certain: it grazes' : '');

function sentence() {
  const { answer } = reply;
  switch (query.query) {
    case 'distance': return answer.overlap ? 'The bodies overlap or touch: their distance is 0. Ask for the depth to see the shortest way out.' : `The distance is ${answer.distance}${between(answer)}.`;
    case 'signed_distance': return answer.signed_distance < 0 ? `They are ${-answer.signed_distance} deep in one another${between({ lower: -answer.upper, upper: -answer.lower })}.` : `The distance is ${answer.signed_distance}${between(answer)}.`;
    case 'intersect': return answer.overlap ? 'They overlap.' : 'They are apart.';
    case 'ray_cast': return answer.hit ? `The ray hits at λ = ${answer.lambda}${between(answer)}.` : 'The ray misses: a plane proves it.';
    case 'linear_cast': return answer.hit ? `They meet at time ${answer.time}${between(answer)}.` : 'They never meet: a plane proves it.';
    case 'motion_cast': return answer.hit ? `They meet at time ${answer.time}${between(answer)}.` : 'They do not meet in all that time: it is proved for every moment, not only for those examined.';
    case 'margin': return answer.margin > 0 ? `The margin is ${answer.margin}: A has to grow by ${short(Math.sqrt(1 + answer.margin))} to touch B.` : `The margin is ${answer.margin}: they overlap.`;
    case 'enclosing_ellipsoid': return `No ellipse around the points has a ln det X greater by more than ${answer.gap} than this one, ${answer.log_det}.`;
    default: return 'The answer is below.';
  }
}

let told = 0;
function tell() {
  clearTimeout(told);
  const { answer } = reply;
  const verdict = $('verdict');
  verdict.classList.toggle('problem', Boolean(answer.error));
  verdict.textContent = answer.error ? `There is no answer: ${answer.error.message}.` : sentence();
  $('proof').textContent = '';
  $('proof').className = '';
  $('prove').hidden = Boolean(answer.error) || !['distance', 'intersect', 'ray_cast', 'linear_cast'].includes(query.query);
  if (document.activeElement !== $('line')) $('line').value = JSON.stringify(query);
  if ($('program').open) write();
}

// The program is written where it is looked at.
const program = async () => (await import('./rust.js')).rust(query, reply.drawing?.dimension ?? 2);
const write = async () => ($('rust').textContent = await program());
$('program').addEventListener('toggle', write);

function later() {
  clearTimeout(told);
  told = setTimeout(tell, 120);
}

// ---- dragging ----

function layer(svg, name) {
  const id = `${svg}-${name}`;
  let g = document.getElementById(id);
  if (!g) {
    for (const each of ['drawn', 'handles', 'over']) {
      const made = document.createElementNS(SVG, 'g');
      made.id = `${svg}-${each}`;
      if (each === 'over') made.setAttribute('pointer-events', 'none');
      $(svg).append(made);
    }
    g = document.getElementById(id);
  }
  return g;
}

// What can be dragged: for each, where it is and what moving and turning it changes.
function movable() {
  const list = [];
  const kind = question();
  for (const key of kind?.bodies ?? ['a', 'b', 'target', 'e1', 'e2'].filter((key) => query[key])) {
    const body = handle(query, key);
    const place = body?.of[body.place];
    if (!Array.isArray(place) || place.length !== 2) continue;
    const name = { a: 'Body A', b: 'Body B', target: 'The target', e1: 'Ellipse A', e2: 'Ellipse B' }[key];
    const angle = typeof body.of.rotation === 'number' ? body.of.rotation : 0;
    list.push({
      id: key, key, name, place, angle,
      move(to) {
        if (key === 'a' && query.motion_a?.center) query.motion_a.center = to;
        body.of[body.place] = to;
      },
      turn(by) { body.of.rotation = round(angle + by); },
    });
  }
  const point = (id, name, place, move) => Array.isArray(place) && place.length === 2 && list.push({ id, name, place, move, isPoint: true });
  if (query.query === 'ray_cast' && query.source) {
    const { source, direction } = query;
    point('source', 'Start of the ray', source, (to) => { query.source = to; });
    point('direction', 'Tip of the direction', tip(), (to) => { query.direction = to.map((x, i) => round(x - source[i])); });
    if (!direction) list.pop();
  }
  if (query.query === 'linear_cast' || query.query === 'motion_cast') {
    const center = handle(query, 'a')?.of.translation;
    const set = (v) => { if (query.query === 'linear_cast') query.velocity_a = v; else (query.motion_a ??= {}).velocity = v; };
    point('velocity', 'Tip of the velocity of A', tip(), (to) => set(to.map((x, i) => round(x - center[i]))));
  }
  if (query.query === 'enclosing_ellipsoid') (query.points ?? []).forEach((p, i) => point(`point${i}`, `Point ${i + 1}`, p, (to) => { query.points[i] = to; }));
  return list;
}

function handles(view, outlines) {
  const g = layer('bodies', 'handles');
  const list = movable();
  const wanted = new Set(list.flatMap(({ id, isPoint }) => (isPoint ? [id] : [id, `${id}-knob`])));
  for (const old of [...g.children]) if (!wanted.has(old.dataset.id)) old.remove();
  const element = (id, name) => {
    let found = [...g.children].find((child) => child.dataset.id === id);
    if (found?.localName !== name) {
      found?.remove();
      found = document.createElementNS(SVG, name);
      Object.assign(found.dataset, { id });
      found.style.cursor = 'grab';
      g.append(found);
    }
    return found;
  };
  for (const item of list) {
    const { id, key, name, place, angle, isPoint } = item;
    const [x, y] = view.at(place);
    const label = `${name} at ${short(place[0], 4)}, ${short(place[1], 4)}. Arrow keys move it${isPoint ? '' : '; comma and full stop turn it'}.`;
    const set = (it, attributes) => Object.entries(attributes).forEach(([k, v]) => it.setAttribute(k, v));
    const common = { tabindex: 0, role: 'button', 'aria-roledescription': 'movable', 'aria-label': label };
    if (isPoint) {
      set(element(id, 'circle'), { ...common, class: `dot ${id === 'velocity' ? 'a' : 'ink'}`, cx: f(x), cy: f(y), r: 9 });
      continue;
    }
    if (outlines[key]) set(element(id, 'path'), { ...common, class: `body ${colours[key]}`, d: path(view, outlines[key]) });
    else if (query[key]?.semi_axes) {
      const [rx, ry] = query[key].semi_axes.map((s) => Math.abs(s) * view.unit);
      set(element(id, 'ellipse'), { ...common, class: `body ${colours[key]}`, cx: f(x), cy: f(y), rx: f(rx), ry: f(ry), transform: `rotate(${f((-angle * 180) / Math.PI)} ${f(x)} ${f(y)})` });
    } else continue;
    const reach = 46;
    set(element(`${id}-knob`, 'circle'), { class: `dot ${colours[key]}`, cx: f(x + reach * Math.cos(angle)), cy: f(y - reach * Math.sin(angle)), r: 7, 'aria-hidden': 'true' });
  }
}

function pointerPlace(event) {
  const svg = $('bodies');
  const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  return views.bodies.from([p.x, p.y]);
}

let held = null;
$('bodies').addEventListener('pointerdown', (event) => {
  const id = event.target.dataset?.id;
  if (!id) return;
  const isKnob = id.endsWith('-knob');
  const item = movable().find((each) => each.id === id.replace(/-knob$/, ''));
  if (!item) return;
  event.preventDefault();
  event.target.focus?.();
  $('bodies').setPointerCapture(event.pointerId);
  const at = pointerPlace(event);
  held = { id: item.id, isKnob, by: item.place.map((x, i) => x - at[i]) };
});

// Several moves between two frames are one.
let frame = 0;
$('bodies').addEventListener('pointermove', (event) => {
  if (!held) return;
  const at = pointerPlace(event);
  cancelAnimationFrame(frame);
  frame = requestAnimationFrame(() => drag(at));
});

function drag(at) {
  const item = held && movable().find((each) => each.id === held.id);
  if (!item) return;
  stop();
  if (held.isKnob) item.turn(Math.atan2(at[1] - item.place[1], at[0] - item.place[0]) - item.angle);
  else item.move(at.map((x, i) => round(x + held.by[i])));
  update({ isDrag: true });
  later();
}

function release() {
  if (!held) return;
  held = null;
  tell();
  const { search, bodies } = views;
  if ((search && !search.sees(searched())) || !bodies.sees(movable().map(({ place }) => place))) fit();
  else if (search && searched().length > 1) (views.search = new View(searched())), draw();
}
for (const name of ['pointerup', 'pointercancel', 'lostpointercapture']) $('bodies').addEventListener(name, release);

$('bodies').addEventListener('keydown', (event) => {
  const item = movable().find((each) => each.id === event.target.dataset?.id);
  const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
  const by = event.shiftKey ? 0.5 : event.altKey ? 0.01 : 0.1;
  if (!item) return;
  if (way) item.move(item.place.map((x, i) => round(x + way[i] * by)));
  else if (event.key === ',' && item.turn) item.turn(by);
  else if (event.key === '.' && item.turn) item.turn(-by);
  else return;
  event.preventDefault();
  stop();
  update({ isDrag: true });
  later();
});

// ---- steps ----

function go(step) {
  $('step').value = step;
  if (now() >= steps.length - 1) delete query._step;
  else query._step = now();
  const time = steps[now()]?.it?.time ?? reply.answer.time;
  if (query.query === 'motion_cast' && Number.isFinite(time)) setTime(time);
  draw();
  remember();
}

function setTime(time) {
  $('time').value = time;
  $('time-name').textContent = short(time, 5);
}

// Time runs from where it is, or from its beginning, to its end: all of it in four seconds.
let running = 0;
function run() {
  if (running) return halt();
  const time = $('time'), end = Number(time.max), start = performance.now();
  const from = Number(time.value) < end ? Number(time.value) : 0;
  const tick = (at) => {
    const t = Math.min(end, from + (end * Math.max(at - start, 0)) / 4000);
    setTime(t);
    draw();
    if (t < end) running = requestAnimationFrame(tick);
    else halt();
  };
  running = requestAnimationFrame(tick);
  $('run').textContent = '❚❚';
  $('run').setAttribute('aria-label', 'Stop time');
}

function halt() {
  cancelAnimationFrame(running);
  running = 0;
  $('run').textContent = '▶';
  $('run').setAttribute('aria-label', 'Let time run');
}

function stop() {
  halt();
  clearInterval(playing);
  playing = null;
  $('play').textContent = '▶';
  $('play').setAttribute('aria-label', 'Play the steps');
}

function play() {
  if (playing) return stop();
  if (now() >= steps.length - 1) go(0);
  playing = setInterval(() => (now() >= steps.length - 1 ? stop() : go(now() + 1)), Math.max(60, Math.min(700, 9000 / steps.length)));
  $('play').textContent = '❚❚';
  $('play').setAttribute('aria-label', 'Stop');
}

$('step').addEventListener('input', () => (stop(), go(now())));
$('back').addEventListener('click', () => (stop(), go(now() - 1)));
$('on').addEventListener('click', () => (stop(), go(now() + 1)));
$('play').addEventListener('click', play);
$('time').addEventListener('input', () => (halt(), setTime(Number($('time').value)), draw()));
$('run').addEventListener('click', run);
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest('textarea, select, input, button, summary')) return;
  if (event.key === ' ') event.preventDefault(), play();
  if (event.key === '[') stop(), go(now() - 1);
  if (event.key === ']') stop(), go(now() + 1);
});

// ---- choices ----

const entries = (list) => list.map(([value, name]) => `<option value="${escape(value)}">${escape(name)}</option>`).join('');

function fillOptions() {
  const kind = question();
  $('question').value = kind && !query._issue ? query.query : '';
  $('museum').value = query._issue ? String(query.id) : '';
  $('options').innerHTML = '';
  const choose = (name, values, value, change) => {
    const label = document.createElement('label');
    label.innerHTML = `${name} <select>${entries(values)}</select>`;
    const select = label.querySelector('select');
    select.name = name;
    select.value = value;
    select.addEventListener('change', () => (change(select.value), update(), fit()));
    $('options').append(label);
  };
  if (!query._issue) {
    for (const key of isSpatial() ? [] : kind?.bodies ?? []) {
      if (key.startsWith('e')) continue;
      const inner = JSON.stringify(handle(query, key)?.of.of);
      const found = Object.entries(BODIES).find(([, body]) => JSON.stringify(body) === inner)?.[0] ?? '';
      const values = [...(found ? [] : [['', 'its own']]), ...Object.keys(BODIES).map((name) => [name, name])];
      choose({ a: 'A', b: 'B', target: 'Target' }[key], values, found, (name) => { if (BODIES[name]) handle(query, key).of.of = copy(BODIES[name]); });
    }
  }
  for (const { field, name, values } of kind?.options ?? []) {
    const isMethod = field === '_method';
    const value = isMethod ? query.method ?? query._search : query[field];
    const chosen = Object.keys(values).find((key) => values[key] === value) ?? Object.keys(values)[0];
    choose(name, Object.keys(values).map((key) => [key, key]), chosen, (key) => {
      if (isMethod) delete query.method, delete query._search;
      const to = isMethod ? (values[key] === 'iterative' ? 'method' : '_search') : field;
      if (values[key] === undefined) delete query[to];
      else query[to] = values[key];
    });
  }
  if (query.query === 'enclosing_ellipsoid' && query.points?.[0]?.length === 2) {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = 'Add a point';
    button.addEventListener('click', () => (query.points.push([round(Math.sin(query.points.length * 2.4) * 2), round(Math.cos(query.points.length * 2.4) * 2)]), update(), fit()));
    $('options').append(button);
  }
  const story = query._issue ? `<strong>${escape(query._title)}.</strong> Reported at ${escape(query._issue)}: ${escape(query._reported)}. The truth: ${escape(truth())} (${escape(query._truth)}).` : '';
  $('story').innerHTML = story;
  $('story').hidden = !story;
  if (hasClock()) {
    const { time } = reply?.answer ?? {};
    $('time').max = query.max_time ?? time ?? 1;
    setTime(time ?? 0);
  }
}

function truth() {
  const expect = query.expect ?? {};
  if (expect.hit === false) return 'a miss';
  for (const key of ['lambda', 'time', 'distance', 'signed_distance', 'log_det']) if (expect[key] !== undefined) return `${key.replaceAll('_', ' ')} ${expect[key]}`;
  return expect.overlap ? 'they overlap' : 'they are apart';
}

$('question').innerHTML = `<option value="" hidden>as in the museum</option>${entries(Object.entries(QUESTIONS).map(([key, { name }]) => [key, name]))}`;
$('question').addEventListener('change', () => show(copy(QUESTIONS[$('question').value].line)));
$('museum').addEventListener('change', () => {
  const pose = museum.find(({ id }) => id === $('museum').value);
  show(copy(pose ?? QUESTIONS.distance.line));
});
$('choices').addEventListener('submit', (event) => event.preventDefault());

// ---- take it home ----

async function take(text, what) {
  try {
    await navigator.clipboard.writeText(text);
    $('copied').textContent = `${what} copied`;
  } catch {
    // Without leave to the clipboard the text is shown where it can be copied by hand.
    $('line').value = text;
    $('line').select();
    $('copied').textContent = `${what} is selected below: copy it from there`;
  }
  setTimeout(() => ($('copied').textContent = ''), 4000);
}

$('copy-link').addEventListener('click', () => (history.replaceState(null, '', link()), take(location.href, 'The link')));
$('copy-rust').addEventListener('click', async () => take(await program(), 'The program'));
$('copy-line').addEventListener('click', () => take(JSON.stringify(plain(query)), 'The query line'));
$('prove').addEventListener('click', () => {
  $('proof').textContent = 'Proving in intervals of 256 bits …';
  // The words are painted before the work begins.
  setTimeout(async () => {
    let text, isProved = false;
    try {
      await loadSpace();
      const line = engineFor().ask(plain(query), 'certify');
      const verdict = spatial.ask(line, 'judge');
      isProved = verdict.verdict === 'proved';
      text = isProved ? `Proved by a checker that shares nothing with the search: within [${verdict.lower ?? '−∞'}, ${verdict.upper ?? '∞'}].` : `Not proved by the checker: ${verdict.because ?? 'rounding alone decides here'}.`;
    } catch (why) {
      text = `The checker has no verdict: ${why.message}.`;
    }
    $('proof').textContent = text;
    $('proof').className = isProved ? 'proved' : '';
  }, 30);
});

$('ask').addEventListener('click', () => {
  const text = $('line').value.trim();
  try {
    // What is too large for a number is said by the engine too.
    const read = JSON.parse(text, (_, x) => { if (x === Infinity || x === -Infinity) throw x; return x; });
    if (read === null || typeof read !== 'object' || Array.isArray(read)) throw new Error('it must be an object');
    show(read);
  } catch {
    // The engine says what is wrong, and where.
    let message;
    try { message = JSON.parse(plane.answer(text)).error?.message; } catch (why) { message = why.message; }
    $('line-problem').textContent = `There is no answer: ${message ?? 'it cannot be read'}.`;
  }
});

function svgText() {
  const style = getComputedStyle(document.documentElement);
  const names = ['paper', 'card', 'ink', 'soft', 'line', 'grid', 'a', 'b', 'c', 'simplex', 'plane', 'shade'];
  const root = `svg{${names.map((name) => `--${name}:${style.getPropertyValue(`--${name}`)}`).join(';')}}`;
  const isTwo = !$('search-pane').hidden;
  const part = (id, x, y, w, h) => `<svg x="${x}" y="${y}" width="${w}" height="${h}" viewBox="${$(id).getAttribute('viewBox')}">${$(id).innerHTML.replace(/ tabindex="0"/g, '')}</svg>`;
  const [, , bw, bh] = $('bracket').getAttribute('viewBox').split(' ').map(Number);
  const below = (960 * bh) / Math.max(bw, 640);
  const height = 440 + below + 20;
  return `<svg xmlns="${SVG}" viewBox="0 0 1000 ${height}" width="1000" height="${height}"><title>${escape($('verdict').textContent)}</title><style>${root}${STYLE}</style><rect width="1000" height="${height}" fill="var(--card)"/>${isTwo ? part('bodies', 10, 10, 480, 400) + part('search', 510, 10, 480, 400) : part('bodies', 20, 10, 960, 400)}${part('bracket', 20, 430, 960, below)}</svg>`;
}

$('save').addEventListener('click', async () => {
  const blob = isSpatial() ? await new Promise((done) => $('space').toBlob(done)) : new Blob([svgText()], { type: 'image/svg+xml' });
  const a = document.createElement('a');
  a.href = URL.createObjectURL(blob);
  a.download = `${query.id ?? query.query}.${isSpatial() ? 'png' : 'svg'}`;
  a.click();
  setTimeout(() => URL.revokeObjectURL(a.href), 10000);
});

// ---- begin ----

addEventListener('hashchange', open);
addEventListener('resize', () => reply?.of === query.query && draw());

function open() {
  if (location.hash.length < 2) return show(copy(QUESTIONS.distance.line));
  try {
    const read = fromLink(location.hash);
    if (read === null || typeof read !== 'object' || Array.isArray(read)) throw new Error('it holds no question');
    show(read);
  } catch (why) {
    show(copy(QUESTIONS.distance.line));
    $('line-problem').textContent = '';
    $('verdict').textContent = `This link is damaged (${why.message}), so the page shows its first question instead.`;
    $('verdict').classList.add('problem');
  }
}

document.head.append(Object.assign(document.createElement('style'), { textContent: STYLE }));
try {
  plane = await engine('plane');
  $('loading').hidden = true;
  $('main').hidden = false;
  open();
  document.documentElement.dataset.ready = 'yes';
  const response = await fetch('museum.json');
  museum = response.ok ? await response.json() : [];
  $('museum').innerHTML = entries([['', 'poses of public bug reports'], ...museum.map(({ id, _title }) => [id, `${id}: ${_title}`])]);
  $('museum').value = query._issue ? String(query.id) : '';
  document.documentElement.dataset.ready = 'museum';
} catch (why) {
  $('loading').hidden = false;
  $('loading').textContent = `The page could not start: ${why.message}. It needs a file server (a page opened as a file may not load its engine) and a browser of the last few years.`;
}

export { svgText };
