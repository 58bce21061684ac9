// The questions of the page, each begun by a line of the query format, and the bodies to choose from.

const at = (x, y, of, rotation = 0) => ({ type: 'posed', translation: [x, y], rotation, of });

export const BODIES = {
  'hexagon': { type: 'polytope', points: [[-1.5, -0.25], [-0.75, -1.25], [0.75, -1], [1.5, 0.25], [0.5, 1.25], [-1, 1]] },
  'triangle': { type: 'triangle', points: [[-1.25, -0.75], [1.5, -0.75], [0, 1.25]] },
  'ellipse': { type: 'ellipsoid', center: [0, 0], semi_axes: [1.75, 0.75] },
  'box': { type: 'cuboid', half_extents: [1.25, 0.75] },
  'disc': { type: 'ball', radius: 1 },
  'capsule': { type: 'capsule', half_height: 1, radius: 0.5 },
  'rounded triangle': { type: 'rounded', radius: 0.375, of: { type: 'triangle', points: [[-1, -0.5], [1, -0.5], [0, 1]] } },
  'sum of a box and an ellipse': { type: 'minkowski_sum', of: [{ type: 'cuboid', half_extents: [0.75, 0.5] }, { type: 'ellipsoid', center: [0, 0], semi_axes: [1, 0.375] }] },
  'hull of two discs': { type: 'hull', of: [{ type: 'ball', radius: 0.875 }, at(2, 0, { type: 'ball', radius: 0.375 })] },
  'segment': { type: 'segment', points: [[-1.5, 0], [1.5, 0]] },
  'point': { type: 'point', at: [0, 0] },
};

const SUB_ALGORITHMS = {
  field: '_sub_algorithm', name: 'Sub-algorithm',
  values: { 'regions (default)': undefined, 'nearest face': 'nearest_face', 'Johnson': 'johnson', 'signed volumes': 'signed_volumes' },
};
const SEARCH = {
  field: '_search', name: 'Search',
  values: { 'default: closed form, portal': undefined, 'Algorithm 3': 'algorithm_3' },
};

export const QUESTIONS = {
  distance: {
    name: 'Distance', bodies: ['a', 'b'], options: [SUB_ALGORITHMS], scalar: 'distance',
    line: { query: 'distance', a: at(-2.5, 0.5, BODIES.hexagon, 0.25), b: at(2, -0.75, BODIES.ellipse, 0.5) },
  },
  signed_distance: {
    name: 'Depth (signed distance)', bodies: ['a', 'b'], options: [], scalar: 'signed_distance',
    line: { query: 'signed_distance', a: at(-0.75, 0.25, BODIES.hexagon, 0.25), b: at(0.75, -0.25, BODIES.ellipse, 0.5) },
  },
  ray_cast: {
    name: 'Ray cast', bodies: ['target'], scalar: 'lambda', points: ['source', 'direction'],
    options: [{
      field: '_method', name: 'Search',
      values: { 'default: closed form, portal': undefined, 'Algorithm 3': 'algorithm_3', 'Algorithm 1': 'iterative' },
    }, SUB_ALGORITHMS],
    line: { query: 'ray_cast', target: at(1.5, 0, BODIES['sum of a box and an ellipse'], 0.5), source: [-4, -1.5], direction: [2, 0.75], _search: 'algorithm_3' },
  },
  linear_cast: {
    name: 'Linear cast', bodies: ['a', 'b'], points: ['velocity_a'], options: [SEARCH, SUB_ALGORITHMS], scalar: 'time',
    line: { query: 'linear_cast', a: at(-3, -1, BODIES.triangle, 0.25), b: at(2, 0.5, BODIES.ellipse, 1), velocity_a: [2, 0.5], _search: 'algorithm_3' },
  },
  motion_cast: {
    name: 'Turning cast', bodies: ['a', 'b'], points: ['velocity'], options: [], scalar: 'time',
    line: {
      query: 'motion_cast', a: at(-2.5, 0, BODIES.box, 0), b: at(1.75, 0.25, BODIES.ellipse, 1.25),
      motion_a: { velocity: [1.25, 0], angular_velocity: 2.5, center: [-2.5, 0] }, max_time: 3,
    },
  },
  margin: {
    name: 'Free margin of ellipses', bodies: ['e1', 'e2'], options: [], scalar: 'margin',
    line: { query: 'margin', e1: { center: [-1.75, 0.25], semi_axes: [1.5, 0.75], rotation: 0.5 }, e2: { center: [1.75, -0.25], semi_axes: [1.25, 0.5], rotation: -0.75 }, gradient: true },
  },
  enclosing_ellipsoid: {
    name: 'Löwner–John ellipse', bodies: [], points: ['points'], scalar: 'log_det',
    options: [{
      field: 'method', name: 'Method',
      values: { 'Newton (default)': undefined, 'Khachiyan': 'khachiyan', 'ellipsoid algorithm': 'ellipsoid', 'dual Newton': 'dual_newton' },
    }],
    line: { query: 'enclosing_ellipsoid', points: [[-2.5, -0.5], [-1, 1.5], [1.5, 1.25], [2.75, -0.25], [0.5, -1.75], [-0.5, 0.25], [1, 0.5]] },
  },
};

// A copy of a line that nobody else changes.
export const copy = (value) => JSON.parse(JSON.stringify(value));

// What is sent to the engine and copied: without what only the page needs.
export function plain(query) {
  return Object.fromEntries(Object.entries(query).filter(([key]) => !key.startsWith('_')));
}

// A body's place and turn, which a drag changes: of a posed body its pose, of an ellipse its centre. Any other is posed first.
export function handle(query, key) {
  let body = query[key];
  if (!body || typeof body !== 'object') return null;
  if (Array.isArray(body.center)) return { of: body, place: 'center' };
  if (typeof body.type !== 'string' || body.type === 'half_space') return null;
  if (body.type !== 'posed') body = query[key] = { type: 'posed', translation: [0, 0], of: body };
  body.translation ??= [0, 0];
  return { of: body, place: 'translation' };
}
