// A question as a Rust program that prints the scalar in full, so that the page's number can be compared with it.

const number = (x) => (Number.isInteger(x) && Math.abs(x) < 1e15 ? `${x}.0` : String(x).replace('e+', 'e'));
const coordinates = (v) => v.map(number).join(', ');
const dim = (v) => (v.length === 2 ? 'DVec2' : 'DVec3');
const vector = (v) => `${dim(v)}::new(${coordinates(v)})`;
const list = (points) => `[\n${points.map((p) => `        ${vector(p)},\n`).join('')}    ]`;

function rotation(r, is_flat) {
  if (r === undefined) return 'Default::default()';
  if (is_flat) return number(r);
  return `DQuat::from_xyzw(${coordinates(r)})`;
}

// The expression of a shape, and the names it uses.
function shape(s, used, is_flat) {
  const V = is_flat ? 'DVec2' : 'DVec3';
  const of = (inner) => shape(inner, used, is_flat);
  const name = (n) => (used.add(n), n);
  const folded = (type) => s.of.map(of).reduce((a, b) => `${name(type)}::new(${a}, ${b})`);
  switch (s.type) {
    case 'point': return `${name('Point')}::new(${vector(s.at)})?`;
    case 'segment': return `${name('Segment')}::new(${list(s.points)})?`;
    case 'triangle': return `${name('Triangle')}::new(${list(s.points)})?`;
    case 'ball': return `${name('Ball')}::<${V}>::new(${number(s.radius)})?`;
    case 'cuboid': return `${name('Cuboid')}::new(${vector(s.half_extents)})?`;
    case 'capsule': return `${name('Capsule')}::<${V}>::new(${number(s.half_height)}, ${number(s.radius)})?`;
    case 'cylinder': return `${name('Cylinder')}::<DVec3>::new(${number(s.half_height)}, ${number(s.radius)})?`;
    case 'cone': return `${name('Cone')}::<DVec3>::new(${number(s.half_height)}, ${number(s.radius)})?`;
    case 'polytope': return `${name('Polytope')}::new(${list(s.points)})?`;
    case 'posed': {
      const to = s.translation ? vector(s.translation) : `${V}::ZERO`;
      if (s.rotation === undefined) return `${name('Posed')}::translated(${of(s.of)}, ${to})?`;
      return `${name('Posed')}::new(${of(s.of)}, ${rotation(s.rotation, is_flat)}, ${to})?`;
    }
    case 'minkowski_sum': return folded('MinkowskiSum');
    case 'hull': return folded('Hull');
    case 'difference': return `${name('Difference')}::new(${of(s.a)}, ${of(s.b)})`;
    case 'rounded': return `${name('Rounded')}::new(${of(s.of)}, ${number(s.radius)})?`;
    case 'half_space': case 'affine': case 'mesh': throw new Error(`a ${s.type} is left to you`);
    default:
      if (!s.semi_axes) throw new Error('a matrix is left to you');
      return `${name('Ellipsoid')}::new(${vector(s.center)}, ${vector(s.semi_axes)}, ${rotation(s.rotation, is_flat)})?`;
  }
}

const SUB = { nearest_face: 'NearestFace', johnson: 'Johnson', signed_volumes: 'SignedVolumes' };

// The program, or a sentence where there is none.
export function rust(query, dimension) {
  try {
    return program(query, dimension === 2);
  } catch (why) {
    return `// ${why.message}.`;
  }
}

function program(query, is_flat) {
  const used = new Set(), gjk = new Set();
  const say = [];
  const dependencies = [];
  if (query.precision === 'f32') throw new Error('single precision is left to you');
  const body = (key) => say.push(`let ${key} = ${shape(query[key], used, is_flat)};`);
  const options = (type, ...fields) => {
    gjk.add(type);
    if (query.tol !== undefined) fields.push(`.with_tolerance(${number(query.tol)})`);
    if (SUB[query._sub_algorithm] && type !== 'SignedDistanceOptions') {
      gjk.add('SubAlgorithm');
      dependencies.push('// gjk-raycast with the feature "paper"');
      fields.push(`.with_sub_algorithm(SubAlgorithm::${SUB[query._sub_algorithm]})`);
    }
    if (query._search === 'algorithm_3') {
      gjk.add('CastMethod');
      fields.push('.with_method(CastMethod::Gjk)');
    }
    return `${type}::new()${fields.join('')}`;
  };
  const limit = (key) => (query[key] === undefined ? '' : `.with_${key}(${number(query[key])})`);
  const show = (field) => say.push(`println!("{:?} in [{:?}, {:?}]", ${field}, answer.lower, answer.upper);`);
  const V = is_flat ? 'DVec2' : 'DVec3';
  const given = (v) => (v === undefined ? `${V}::ZERO` : vector(v));
  switch (query.query) {
    case 'distance': case 'signed_distance': {
      body('a'), body('b');
      gjk.add(query.query);
      const type = query.query === 'distance' ? 'DistanceOptions' : 'SignedDistanceOptions';
      say.push(`let answer = ${query.query}(&a, &b, ${options(type)});`);
      show(`answer.${query.query}`);
      break;
    }
    case 'ray_cast': {
      body('target');
      gjk.add('Ray');
      say.push(`let ray = Ray { source: ${vector(query.source)}, direction: ${vector(query.direction)} };`);
      const asked = options('RayCastOptions', limit('min_lambda'), limit('max_lambda'));
      if (query.method === 'iterative') {
        ['iterative_ray_cast', 'distance', 'DistanceOptions'].forEach((n) => gjk.add(n));
        used.add('Point');
        say.push('let closest = |x: Point<_>| {');
        say.push('    let d = distance(&target, &x, DistanceOptions::new());');
        say.push('    d.normal.map_or(d.point_a, |normal| x.at() + normal * d.distance)');
        say.push('};');
        say.push(`let answer = iterative_ray_cast(|x| Point::new(x).ok().map(closest), ray, ${asked})?;`);
      } else {
        gjk.add('ray_cast');
        say.push(`let answer = ray_cast(&target, ray, ${asked})?;`);
      }
      show('answer.outcome.hit().map(|hit| hit.lambda)');
      break;
    }
    case 'linear_cast': {
      body('a'), body('b');
      gjk.add('Motion'), gjk.add('linear_cast');
      say.push(`let motion = Motion { velocity_a: ${given(query.velocity_a)}, velocity_b: ${given(query.velocity_b)} };`);
      say.push(`let answer = linear_cast(&a, &b, motion, ${options('LinearCastOptions', limit('max_time'), limit('target_distance'))})?;`);
      show('answer.outcome.hit().map(|hit| hit.time)');
      break;
    }
    case 'motion_cast': {
      body('a'), body('b');
      gjk.add('RigidMotion'), gjk.add('motion_cast');
      const motion = (m) => {
        if (!m) return 'RigidMotion::default()';
        const turn = m.angular_velocity ?? (is_flat ? 0 : [0, 0, 0]);
        const angular = is_flat ? number(turn) : vector(turn);
        return `RigidMotion { velocity: ${given(m.velocity)}, angular_velocity: ${angular}, center: ${given(m.center)} }`;
      };
      say.push(`let motion_a = ${motion(query.motion_a)};`, `let motion_b = ${motion(query.motion_b)};`);
      say.push(`let answer = motion_cast(&a, motion_a, &b, motion_b, ${options('MotionCastOptions', limit('max_time'), limit('target_distance'))})?;`);
      show('answer.outcome.hit().map(|hit| hit.time)');
      break;
    }
    case 'margin':
      body('e1'), body('e2');
      say.push('let answer = free_margin(&e1, &e2, MarginOptions::default());');
      say.push('println!("{:?}, gradient {:?}", answer.margin, EllipsoidPair::new(&e1, &e2, MarginOptions::default()).margin().gradient().translation);');
      break;
    case 'enclosing_ellipsoid': {
      const methods = { khachiyan: 'Khachiyan', ellipsoid: 'EllipsoidAlgorithm', dual_newton: 'DualReducedNewton' };
      const method = methods[query.method];
      say.push(`let points: Vec<[f64; ${query.points[0].length}]> = vec![\n${query.points.map((p) => `        [${coordinates(p)}],\n`).join('')}    ];`);
      say.push(`let answer = enclosing(&points, EnclosingOptions::default()${method ? `.with_method(EnclosingMethod::${method})` : ''})?;`);
      say.push('println!("{:?}, gap at most {:e}", answer.ellipsoid.log_det(), answer.log_det_gap);');
      break;
    }
    default: throw new Error(`${query.query} is left to you`);
  }
  const text = say.join('\n    ');
  const glam = ['DVec2', 'DVec3', 'DQuat'].filter((n) => text.includes(`${n}::`) || text.includes(`<${n}>`));
  if (glam.length) used.add(glam.length === 1 ? `glam::${glam[0]}` : `glam::{${glam.join(', ')}}`);
  const use = (from, names) => (names.size ? [`use ${from}::{${[...names].sort().join(', ')}};`] : []);
  const imports = [...use('convex_support', used), ...use('gjk_raycast', gjk)];
  if (query.query === 'margin') imports.push('use ellip_margin::{EllipsoidPair, MarginOptions, free_margin};');
  if (query.query === 'enclosing_ellipsoid') imports.push(`use lj_ellipsoid::{${text.includes('EnclosingMethod') ? 'EnclosingMethod, ' : ''}EnclosingOptions, enclosing};`);
  return [...dependencies, ...imports, '', 'fn main() -> Result<(), Box<dyn std::error::Error>> {', `    ${text}`, '    Ok(())', '}', ''].join('\n');
}
