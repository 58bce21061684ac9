// Drawings in the plane: what the bodies, the search and the bracket look like at one step. Text of SVG in, nothing kept.

export const STYLE = `
.body{fill-opacity:.16;stroke-width:2.5;stroke-linejoin:round}.a{fill:var(--a);stroke:var(--a)}.b{fill:var(--b);stroke:var(--b)}.c{fill:var(--c);stroke:var(--c)}
.ghost{fill-opacity:.07;stroke-opacity:.75;stroke-dasharray:5 4}
.simplex{fill:var(--simplex);fill-opacity:.22;stroke:var(--simplex);stroke-width:2.5;stroke-linejoin:round}.of-simplex{fill:var(--simplex);stroke:var(--simplex)}
.plane{stroke:var(--plane);fill:var(--plane)}.ink{stroke:var(--ink);fill:var(--ink)}.soft{stroke:var(--soft);fill:var(--soft)}
.dot{stroke:var(--card);stroke-width:1.5}.grid{stroke:var(--grid);stroke-width:1;fill:none}.axis{stroke:var(--line);stroke-width:1.5;fill:none}
text{font:13px system-ui,sans-serif;stroke:none;fill:var(--soft)}text.ink{fill:var(--ink)}text.a{fill:var(--a)}text.b{fill:var(--b)}text.plane{fill:var(--plane)}text.of-simplex{fill:var(--simplex)}text.strong{font-weight:600}
path.line{fill:none;stroke-width:2;stroke-linecap:round}text:not(.halo){stroke:none}
.shade{fill:var(--shade);fill-opacity:.16;stroke:none}.bar{fill:var(--simplex);fill-opacity:.35}.bar.now{fill-opacity:1}.bar.answer{fill:var(--plane);fill-opacity:1}
text.halo{paint-order:stroke;stroke:var(--card);stroke-width:4px;stroke-linejoin:round}
`;

export const WIDTH = 480, HEIGHT = 400;

// A number as people read it.
export function short(x, digits = 6) {
  if (x === null || x === undefined || !Number.isFinite(x)) return '∞';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size < 1e-4 || size >= 1e7) return x.toExponential(2).replace('-', '−').replace('e−', 'e−');
  return String(Number(x.toPrecision(digits))).replace('-', '−');
}

// The part of the plane that is seen: its middle, and pixels for a unit.
export class View {
  constructor(points, { width = WIDTH, height = HEIGHT, least = 0, margin = 56 } = {}) {
    const seen = points.filter((p) => p && p.every(Number.isFinite));
    const side = (i) => seen.map((p) => p[i]);
    const [x0, x1, y0, y1] = seen.length
      ? [Math.min(...side(0)), Math.max(...side(0)), Math.min(...side(1)), Math.max(...side(1))] : [-1, 1, -1, 1];
    Object.assign(this, { width, height, x: (x0 + x1) / 2, y: (y0 + y1) / 2 });
    const span = [Math.max(x1 - x0, least), Math.max(y1 - y0, least)];
    const fit = Math.min((width - 2 * margin) / span[0], (height - 2 * margin) / span[1]);
    this.unit = Number.isFinite(fit) && fit > 0 ? fit : 40;
  }
  at([x, y]) { return [this.width / 2 + (x - this.x) * this.unit, this.height / 2 - (y - this.y) * this.unit]; }
  from([x, y]) { return [this.x + (x - this.width / 2) / this.unit, this.y - (y - this.height / 2) / this.unit]; }
  sees(points) {
    return points.every((p) => this.at(p).every((c, i) => c > 8 && c < [this.width, this.height][i] - 8));
  }
}

const f = (x) => (Number.isFinite(x) ? Math.max(-1e6, Math.min(1e6, x)).toFixed(2) : '0');

export function path(view, points, closed = true) {
  if (!points || !points.length) return '';
  return `M${points.map((p) => view.at(p).map(f).join(' ')).join('L')}${closed ? 'Z' : ''}`;
}

const line = (view, points, name) => `<path class="line ${name}" d="${path(view, points, false)}"/>`;

export function dot(view, p, name, label = '', [dx, dy] = [9, -9]) {
  if (!p) return '';
  const [x, y] = view.at(p);
  const text = label && `<text class="halo ${name} strong" x="${f(x + dx)}" y="${f(y + dy)}">${label}</text>`;
  return `<circle class="dot ${name}" cx="${f(x)}" cy="${f(y)}" r="5"/>${text}`;
}

export function arrow(view, from, to, name, label = '') {
  const [[x0, y0], [x1, y1]] = [view.at(from), view.at(to)];
  const length = Math.hypot(x1 - x0, y1 - y0);
  if (!(length > 1)) return '';
  const [u, v] = [(x1 - x0) / length, (y1 - y0) / length];
  const back = (s) => `${f(x1 - 10 * u - s * 5 * v)} ${f(y1 - 10 * v + s * 5 * u)}`;
  const text = label && `<text class="halo ${name} strong" x="${f(x1 + 8)}" y="${f(y1 - 8)}">${label}</text>`;
  return `<path class="line ${name}" d="M${f(x0)} ${f(y0)}L${f(x1)} ${f(y1)}"/><path class="${name}" d="M${f(x1)} ${f(y1)}L${back(1)}L${back(-1)}Z"/>${text}`;
}

// The line through p across the direction n, over all of the view.
function across(view, p, n, name, label) {
  const length = Math.hypot(...n);
  if (!(length > 0) || !p) return '';
  const reach = (view.width + view.height) / view.unit;
  const t = [-n[1] / length, n[0] / length];
  const end = (s) => [p[0] + s * reach * t[0], p[1] + s * reach * t[1]];
  // The label where the line leaves the picture.
  let at = null;
  for (let s = 0; s < 1; s += 0.01) {
    const q = view.at(end(s));
    if (q[0] > 20 && q[0] < view.width - 60 && q[1] > 24 && q[1] < view.height - 12) at = q;
  }
  const text = at && label ? `<text class="halo ${name}" x="${f(at[0] + 6)}" y="${f(at[1] - 6)}">${label}</text>` : '';
  return `<path class="line ${name}" stroke-dasharray="7 5" d="${path(view, [end(-1), end(1)], false)}"/>${text}`;
}

// The half-plane n·x ≤ c, as far as the picture goes.
export function halfPlane(view, { normal: n, offset: c }, name) {
  const square = n[0] * n[0] + n[1] * n[1];
  if (!(square > 0)) return '';
  const length = Math.sqrt(square), u = [n[0] / length, n[1] / length], away = (c - n[0] * view.x - n[1] * view.y) / length;
  const reach = (view.width + view.height) / view.unit;
  const corner = (s, depth) => [view.x + (away - depth) * u[0] - s * reach * u[1], view.y + (away - depth) * u[1] + s * reach * u[0]];
  return `<path class="body ${name}" d="${path(view, [corner(-1, 0), corner(1, 0), corner(1, 2 * reach), corner(-1, 2 * reach)])}"/>`;
}

export function grid(view) {
  const step = 10 ** Math.ceil(Math.log10(36 / view.unit));
  const unit = [step / 5, step / 2, step].find((s) => s * view.unit >= 36) ?? step;
  const [left, top] = view.from([0, 0]), [right, bottom] = view.from([view.width, view.height]);
  let d = '';
  for (let x = Math.ceil(left / unit) * unit, n = 0; x < right && n < 60; x += unit, n++) d += `M${f(view.at([x, 0])[0])} 0V${view.height}`;
  for (let y = Math.ceil(bottom / unit) * unit, n = 0; y < top && n < 60; y += unit, n++) d += `M0 ${f(view.at([0, y])[1])}H${view.width}`;
  return `<path class="grid" d="${d}"/>`;
}

// What the search sees at an iterate: the simplex, the direction, the support point and the plane through it.
export function iterate(view, it, origin) {
  if (!it || !it.v) return '';
  const base = it.x ?? origin;
  const polygon = it.simplex;
  let out = across(view, it.w, it.direction, 'plane', 'plane');
  if (polygon.length) {
    // Four vertices are never in the plane; three in any order are a triangle.
    out += `<path class="simplex" d="${path(view, polygon)}"/>`;
    // A cast has moved on since it had its closest point.
    if (!it.x) out += line(view, [base, it.v], 'of-simplex') + dot(view, it.v, 'of-simplex', 'v');
    out += polygon.map((p) => dot(view, p, 'of-simplex')).join('');
  } else {
    const length = Math.hypot(...it.direction) || 1;
    const tip = base.map((c, i) => c + (it.direction[i] / length) * (60 / view.unit));
    out += arrow(view, base, tip, 'of-simplex', 'first direction');
  }
  return out + dot(view, it.w, 'plane', 'w', [9, 18]);
}

export function cross(view, p, label) {
  const [x, y] = view.at(p);
  return `<path class="line ink" d="M${f(x - 8)} ${f(y)}H${f(x + 8)}M${f(x)} ${f(y - 8)}V${f(y + 8)}"/><text class="halo ink" x="${f(x + 10)}" y="${f(y + 18)}">${label}</text>`;
}

export { line, f };

// The brackets of the steps up to one of them, as bars over a number line, the narrowest with its width.
export function bracket(steps, now, width) {
  const rows = 11, height = 22, left = 58, right = width < 420 ? 74 : 92;
  const first = Math.max(0, Math.min(now - rows + 2, steps.length - rows));
  const shown = steps.slice(first, first + rows);
  const ends = steps.flatMap(({ lower, upper }) => [lower, upper]).filter((x) => Number.isFinite(x) && Math.abs(x) < 1e300);
  let [low, high] = [Math.min(...ends), Math.max(...ends)];
  if (!ends.length) [low, high] = [0, 1];
  if (!(high > low)) [low, high] = [low - Math.max(Math.abs(low), 1) / 2, high + Math.max(Math.abs(high), 1) / 2];
  const room = width - left - right;
  const x = (value) => left + Math.max(0, Math.min(1, 0.04 + (0.92 * (value - low)) / (high - low))) * room;
  const total = shown.length * height + 34;
  let out = '';
  shown.forEach(({ lower, upper, name }, i) => {
    const k = first + i, y = i * height + 6;
    // What is still to come is only hinted at.
    out += `<g${k > now ? ' opacity=".2"' : ''}>`;
    const isNow = k === now, isLast = k === steps.length - 1;
    const [x0, x1] = [Number.isFinite(lower) ? x(lower) : left, Number.isFinite(upper) ? x(upper) : width - right];
    const bar = Math.max(x1 - x0, 3);
    const wide = Number.isFinite(upper) && Number.isFinite(lower) ? short(Math.max(upper - lower, 0) / 2, 2) : '∞';
    const open = Number.isFinite(upper) ? '' : `<path class="line of-simplex" d="M${f(x1 - 7)} ${y + 1}l7 6l-7 6"/>`;
    out += `<text x="0" y="${y + 12}" class="${isNow ? 'ink strong' : ''}">${name}</text>`;
    out += `<rect class="bar ${isNow ? 'now' : ''} ${isLast && isNow ? 'answer' : ''}" x="${f(x0 - (bar > 3 ? 0 : 1.5))}" y="${y + 1}" width="${f(bar)}" height="12" rx="2"/>${open}`;
    out += `<text x="${width}" y="${y + 12}" text-anchor="end" class="${isNow ? 'ink strong' : ''}">± ${wide}</text></g>`;
  });
  const y = shown.length * height + 10;
  out += `<path class="axis" d="M${left} ${y}H${width - right}"/>`;
  // Ends that read alike are one.
  for (const value of short(low, 5) === short(high, 5) ? [(low + high) / 2] : [low, high]) {
    out += `<path class="axis" d="M${f(x(value))} ${y - 3}v6"/><text x="${f(x(value))}" y="${y + 18}" text-anchor="middle">${short(value, 5)}</text>`;
  }
  return { text: out, height: total };
}

// The gap over time that a turning cast examined, and the intervals in which it proved the bodies apart.
export function gaps(seen, end, answer, time) {
  const view = { width: WIDTH, height: HEIGHT };
  const [left, right, top, bottom] = [46, 14, 20, 40];
  const high = Math.max(...seen.map((it) => it.gap).filter(Number.isFinite), 1e-9);
  const x = (t) => left + (Math.max(0, Math.min(end, t)) / end) * (view.width - left - right);
  const y = (g) => view.height - bottom - (Math.max(0, g) / high) * (view.height - top - bottom);
  let out = '', low = 0;
  const ends = [...seen.map((it) => it.lower), answer.lower ?? (answer.hit === false ? end : null)];
  for (const next of ends) {
    if (!(next > low)) continue;
    const [x0, x1] = [x(low), x(next)];
    out += `<rect class="shade" x="${f(x0)}" y="${top}" width="${f(Math.max(x1 - x0 - 1, 0.5))}" height="${view.height - top - bottom}"/>`;
    low = next;
  }
  const sorted = seen.filter((it) => Number.isFinite(it.gap)).sort((p, q) => p.time - q.time);
  out += `<path class="line of-simplex" stroke-opacity=".6" d="${sorted.map((it, i) => `${i ? 'L' : 'M'}${f(x(it.time))} ${f(y(it.gap))}`).join('')}"/>`;
  out += sorted.map((it) => `<circle class="dot of-simplex" cx="${f(x(it.time))}" cy="${f(y(it.gap))}" r="4"/>`).join('');
  out += `<path class="axis" d="M${left} ${top}V${view.height - bottom}H${view.width - right}"/>`;
  out += `<path class="line ink" d="M${f(x(time))} ${top}V${view.height - bottom}"/>`;
  if (answer.hit) out += `<path class="line b" stroke-dasharray="4 4" d="M${f(x(answer.time))} ${top}V${view.height - bottom}"/><text class="halo b strong" x="${f(Math.min(x(answer.time) + 6, view.width - 90))}" y="${top + 14}">contact</text>`;
  out += `<text x="${left}" y="${view.height - 16}">0</text><text x="${view.width - right}" y="${view.height - 16}" text-anchor="end">time ${short(end, 4)}</text>`;
  out += `<text x="4" y="${top + 4}">${seen.length ? short(high, 3) : ''}</text><text x="4" y="${view.height - bottom}">gap 0</text>`;
  return out;
}
