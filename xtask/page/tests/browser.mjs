// The page in a real browser: `node browser.mjs SITE XTASK BROWSER PICTURES`. It drags, steps and reads numbers, and compares
// them to the bit with what `xtask query` says of the same line; opens links, good and damaged; and takes pictures.

import { execFileSync } from 'node:child_process';
import { createServer } from 'node:http';
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import { pathToFileURL } from 'node:url';
import assert from 'node:assert/strict';
import { chromium } from 'playwright-core';

const [site, xtask, browserPath, pictures] = process.argv.slice(2);
mkdirSync(pictures, { recursive: true });

const TYPES = { html: 'text/html', css: 'text/css', js: 'text/javascript', json: 'application/json', wasm: 'application/wasm', svg: 'image/svg+xml' };
const server = createServer((request, response) => {
  const name = new URL(request.url, 'http://x').pathname.slice(1) || 'index.html';
  try {
    const body = readFileSync(join(site, name.replaceAll('..', '')));
    response.writeHead(200, { 'Content-Type': TYPES[name.split('.').pop()] ?? 'text/plain' }).end(body);
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const home = `http://127.0.0.1:${server.address().port}/`;

// The lines of output of the native program for lines of input.
const native = (lines) => {
  const run = { input: lines.join('\n'), encoding: 'utf8', maxBuffer: 1 << 28 };
  let text;
  try {
    text = execFileSync(xtask, ['query', '-'], run);
  } catch (why) {
    // Status 1: some line is answered by an error, as it should be.
    if (why.status !== 1) throw why;
    text = why.stdout;
  }
  return text.trimEnd().split('\n');
};

const browser = await chromium.launch({
  executablePath: browserPath, headless: true,
  args: ['--no-sandbox', '--disable-gpu', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

const problems = [];
async function open(hash = '', { width = 900, height = 900, scheme = 'light', ...more } = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, ...more });
  const page = await context.newPage();
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  page.on('pageerror', (why) => problems.push(String(why)));
  page.on('request', (request) => /^(http:\/\/127\.0\.0\.1:|data:|blob:)/.test(request.url()) || problems.push(`a foreign host: ${request.url()}`));
  await page.goto(home + hash);
  if (more.javaScriptEnabled !== false) await page.waitForFunction(() => document.documentElement.dataset.ready === 'museum');
  return page;
}

let passed = 0;
async function test(name, run) {
  const start = Date.now();
  await run();
  assert.deepEqual(problems, [], name);
  passed += 1;
  console.log(`ok ${name} (${Date.now() - start} ms)`);
}

const lineOf = (page) => page.locator('#line').inputValue();
const settled = (page) => page.waitForTimeout(200);
const shown = (page) => page.locator('#numbers dd[data-key]').evaluateAll((all) => Object.fromEntries(all.map((dd) => [dd.dataset.key, dd.textContent])));
// Every number that the page shows is the native program's, to the bit.
async function agrees(page) {
  await settled(page);
  const line = await lineOf(page);
  const [answer] = native([line]).map((text) => JSON.parse(text));
  assert.equal(answer.error, undefined, line);
  const numbers = await shown(page);
  let compared = 0;
  for (const [key, value] of Object.entries(answer)) {
    if (!(key in numbers)) continue;
    const told = typeof value === 'number' ? Number(numbers[key]) : Array.isArray(value) ? numbers[key].split(', ').map(Number) : numbers[key];
    assert.deepEqual(told, typeof value === 'number' || Array.isArray(value) ? value : String(value ?? 'none'), `${key} of ${line}`);
    compared += 1;
  }
  assert.ok(compared >= 3, `${compared} numbers compared of ${line}`);
  return answer;
}

async function dragTo(page, id, dx, dy, moves = 12) {
  const box = await page.locator(`#bodies [data-id="${id}"]`).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let i = 1; i <= moves; i++) await page.mouse.move(x + (dx * i) / moves, y + (dy * i) / moves);
  await page.waitForTimeout(60);
  await page.mouse.up();
}

const sizes = readdirSync(site).map((name) => [name, gzipSync(readFileSync(join(site, name)), { level: 9 }).length]);
const total = sizes.reduce((sum, [name, size]) => sum + (name.startsWith('picture') || ['space.wasm', 'space.js', 'worker.js', 'museum.json', 'rust.js'].includes(name) ? 0 : size), 0);
console.log(`compressed: ${sizes.map(([name, size]) => `${name} ${(size / 1000).toFixed(1)}`).join(', ')}; ${(total / 1000).toFixed(1)} kB to open the page, without what is loaded where it is asked for`);
assert.ok(total <= 400_000, `${total} bytes`);

await test('the first paint is within a second, and nothing is fetched from elsewhere', async () => {
  const page = await open();
  const paint = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
  const all = await page.evaluate(() => performance.now());
  console.log(`   first paint after ${paint?.toFixed(0)} ms, ready by ${all.toFixed(0)} ms`);
  assert.ok(paint < 1000, `${paint} ms`);
  await agrees(page);
  await page.context().close();
});

const QUESTIONS = ['distance', 'signed_distance', 'ray_cast', 'linear_cast', 'motion_cast', 'margin', 'enclosing_ellipsoid'];
const FIRST = { ray_cast: 'target', margin: 'e1', enclosing_ellipsoid: 'point0' };
mkdirSync(join(pictures, 'rust'), { recursive: true });
for (const kind of QUESTIONS) {
  await test(`${kind}: a drag, a key and steps, to the bit of the native answers`, async () => {
    const page = await open();
    await page.locator('#question').selectOption(kind);
    const before = await agrees(page);
    const id = FIRST[kind] ?? 'a';
    await dragTo(page, id, 37, -23);
    const after = await agrees(page);
    assert.notDeepEqual(after, before, 'the drag changed nothing');
    // A key moves by a tenth, to the right.
    const place = async () => { const q = JSON.parse(await lineOf(page)); return id === 'point0' ? q.points[0] : q[id].translation ?? q[id].center; };
    const from = await place();
    await page.locator(`#bodies [data-id="${id}"]`).focus();
    await page.keyboard.press('ArrowRight');
    await settled(page);
    assert.ok(Math.abs((await place())[0] - from[0] - 0.1) < 1.1e-3, `${from} to ${await place()}`);
    if (id !== 'point0') {
      await page.keyboard.press(',');
      await agrees(page);
    }
    await page.locator('#program summary').click();
    await page.waitForFunction(() => document.querySelector('#rust').textContent.includes('fn main'));
    const copied = await page.locator('#rust').textContent();
    assert.match(copied, /^fn main/m);
    writeFileSync(join(pictures, 'rust', `${kind}.rs`), copied);
    writeFileSync(join(pictures, 'rust', `${kind}.json`), JSON.stringify(await shown(page)));
    // Each step has its bounds in order, and the bracket of the answer is no wider than that of any step.
    const last = Number(await page.locator('#step').getAttribute('max'));
    for (let k = 0; k < last; k++) {
      await page.locator('#step').fill(String(k));
      const { lower, upper } = await shown(page);
      const [low, high] = [Number(lower), upper === 'not known yet' ? Infinity : Number(upper)];
      assert.ok(low <= high, `step ${k}: ${lower} ${upper}`);
    }
    console.log(`   ${last} steps`);
    await page.context().close();
  });
}

await test('all sub-algorithms and searches end with the same answer', async () => {
  const page = await open();
  for (const [kind, name] of [['distance', 'Sub-algorithm'], ['ray_cast', 'Search'], ['linear_cast', 'Search']]) {
    await page.locator('#question').selectOption(kind);
    const select = page.locator(`select[name="${name}"]`);
    const answers = [];
    for (const value of await select.locator('option').allTextContents()) {
      await select.selectOption(value);
      const answer = await agrees(page);
      answers.push(answer.distance ?? answer.lambda ?? answer.time);
      const { run } = await shown(page);
      if (run) assert.ok(Math.abs(Number.parseFloat(run) - answers[0]) < 1e-9, `${value}: ${run}`);
    }
    assert.ok(answers.every((x) => Math.abs(x - answers[0]) < 1e-9), `${answers}`);
  }
  await page.context().close();
});

await test('a link restores the state', async () => {
  const page = await open();
  await page.locator('#question').selectOption('linear_cast');
  await dragTo(page, 'a', -30, 40);
  await page.locator('#step').fill('1');
  await page.waitForTimeout(400);
  const [line, hash, step] = [JSON.parse(await lineOf(page)), new URL(page.url()).hash, await page.locator('#step-name').textContent()];
  const other = await open(hash);
  const found = JSON.parse(await lineOf(other));
  assert.deepEqual({ ...found, _step: 1 }, { ...line, _step: 1 });
  assert.equal(await other.locator('#step-name').textContent(), step);
  await page.context().close();
  await other.context().close();
});

await test('bad input is answered by a sentence', async () => {
  for (const hash of ['#%7Bbroken', '#%', '#null', '#(1)', "#{'query':'nonsense'}", "#{'query':'distance'}", "#{'query':'distance','a':7,'b':null}", "#{'query':'enclosing_ellipsoid','points':7}", "#{'query':'motion_cast','max_time':'x'}", "#{'query':'margin','e1':{},'e2':{'center':7}}", "#{'query':'ray_cast','source':(0,0),'direction':(0,0),'target':{'type':'ball','radius':1}}"]) {
    const page = await open(hash);
    await page.waitForFunction(() => !document.querySelector('#verdict').textContent.startsWith('Loading'));
    const verdict = await page.locator('#verdict').textContent();
    assert.match(verdict, /damaged|no answer/, `${hash}: ${verdict}`);
    assert.ok(await page.locator('#main').isVisible(), hash);
    await page.context().close();
  }
  const page = await open();
  const asked = async (line) => {
    await page.locator('#line').fill(line);
    await page.locator('#ask').click();
    await page.waitForFunction(() => !document.querySelector('#verdict').textContent.startsWith('Loading'));
    return `${await page.locator('#line-problem').textContent()} ${await page.locator('#verdict').textContent()}`;
  };
  const disc = (x) => `{"type":"posed","translation":[${x},0],"of":{"type":"ball","radius":1}}`;
  for (const [line, due] of [
    [`{"query":"distance","a":${disc('NaN')},"b":${disc(3)}}`, /There is no answer: .*column/],
    [`{"query":"distance","a":${disc('1e999')},"b":${disc(3)}}`, /There is no answer: .*translation.*out of range/],
    [`{"query":"distance","a":${disc(0)},"b":{"type":"ball","radius":-1}}`, /There is no answer: .*radius/],
    [`{"query":"distance","a":${disc(0)},"b":${disc(0)}}`, /overlap or touch/],
    [`{"query":"signed_distance","a":${disc(0)},"b":${disc(0)}}`, /2 deep/],
    ['{"query":"enclosing_ellipsoid","points":[[0,0],[1,1],[2,2]]}', /There is no answer: .*(flat|affine|dimension|rank)/i],
    [`{"query":"distance","a":{"type":"polytope","points":[[0,0],[1,1],[2,2]]},"b":${disc(5)}}`, /The distance is/],
    ['hello', /There is no answer: the line is not JSON/],
    [`{"query":"distance","a":${disc(1e308)},"b":${disc(-1e308)}}`, /There is no answer|The distance is/],
  ]) assert.match(await asked(line), due, line);
  await page.context().close();
});

await test('steps of round bodies have the brackets of the bodies, and ends that read alike have one label', async () => {
  const page = await open();
  const at = (x, of) => `{"type":"posed","translation":[${x},0],"of":${of}}`;
  const disc = '{"type":"ball","radius":1}', box = '{"type":"cuboid","half_extents":[1,1]}';
  for (const [line, label] of [
    [`{"query":"distance","a":${at(0, disc)},"b":${at(3.1, disc)}}`, '1.1'],
    [`{"query":"signed_distance","a":${at(0, disc)},"b":${at(3.1, disc)}}`, '1.1'],
    [`{"query":"signed_distance","a":${at(0, box)},"b":${at(1.1, box)}}`, '−0.9'],
  ]) {
    await page.locator('#line').fill(line);
    await page.locator('#ask').click();
    await settled(page);
    assert.deepEqual(await page.locator('#bracket text[text-anchor=middle]').allTextContents(), [label], line);
  }
  await page.context().close();
});

await test('by the keyboard alone', async () => {
  const page = await open();
  // Tab reaches every control, and each has a name.
  const names = await page.evaluate(() => [...document.querySelectorAll('#main button, #main select, #main input, #main textarea, #main [tabindex]')]
    .filter((e) => e.checkVisibility())
    .map((e) => e.getAttribute('aria-label') || e.labels?.[0]?.textContent.trim() || e.textContent.trim()));
  assert.ok(names.length > 15 && names.every(Boolean), JSON.stringify(names));
  await page.locator('#bodies [data-id="b"]').focus();
  const before = await page.locator('#step').inputValue();
  await page.keyboard.press('[');
  assert.equal(Number(await page.locator('#step').inputValue()), Number(before) - 1);
  await page.keyboard.press(' ');
  await page.waitForTimeout(100);
  assert.equal(await page.locator('#play').getAttribute('aria-label'), 'Stop');
  await page.context().close();
});

await test('a picture is saved, and is the one that is shown where there are no scripts', async () => {
  for (const scheme of ['light', 'dark']) {
    const page = await open('', { scheme });
    await page.locator('#step').fill('2');
    const [download] = await Promise.all([page.waitForEvent('download'), page.locator('#save').click()]);
    const name = `picture-${scheme}.svg`;
    await download.saveAs(join(pictures, name));
    const saved = readFileSync(join(pictures, name), 'utf8');
    assert.match(saved, /^<svg .*class="body a"/s);
    assert.ok(!/NaN|Infinity|undefined/.test(saved), name);
    assert.equal(saved, readFileSync(join(site, name), 'utf8'), `copy ${join(pictures, name)} to xtask/page/site`);
    await page.context().close();
  }
});

await test('frames a second while dragging', async () => {
  const page = await open();
  const box = await page.locator('#bodies [data-id="a"]').boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.evaluate(() => {
    globalThis.frames = 0;
    globalThis.began = performance.now();
    const count = () => { globalThis.frames += 1; requestAnimationFrame(count); };
    count();
  });
  for (let i = 0; i < 90; i++) await page.mouse.move(box.x + 40 + 60 * Math.sin(i / 9), box.y + 40 + 60 * Math.cos(i / 9));
  const rate = await page.evaluate(() => (globalThis.frames * 1000) / (performance.now() - globalThis.began));
  await page.mouse.up();
  console.log(`   ${rate.toFixed(0)} frames a second`);
  await agrees(page);
  await page.context().close();
});

await test('the museum in space: a picture that turns, the truth, a proof', async () => {
  const page = await open();
  const poses = await page.locator('#museum option').evaluateAll((all) => all.map((o) => o.value).filter(Boolean));
  assert.ok(poses.length >= 80, `${poses.length} poses`);
  await page.locator('#museum').selectOption('physx-429');
  const picture = () => page.locator('#space').evaluate((c) => c.width + c.toDataURL());
  await page.waitForFunction(() => Number(document.querySelector('#space').dataset.took) > 0 && document.querySelector('#space').width > 600);
  const seen = await picture();
  assert.ok(seen.length > 4000, 'the picture is empty');
  console.log(`   ${await page.locator('#space').getAttribute('data-size')} pixels in ${await page.locator('#space').getAttribute('data-took')} ms`);
  await page.locator('#space').focus();
  await page.keyboard.press('ArrowLeft');
  await page.waitForFunction((old) => { const c = document.querySelector('#space'); return c.width > 600 && c.width + c.toDataURL() !== old; }, seen);
  // The mouse turns it too.
  const turned = await picture();
  const box = await page.locator('#space').boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 320, box.y + 160, { steps: 6 });
  await page.mouse.up();
  await page.waitForFunction((old) => { const c = document.querySelector('#space'); return c.width > 600 && c.width + c.toDataURL() !== old; }, turned);
  await agrees(page);
  await page.locator('#prove').click();
  await page.waitForFunction(() => !/^(Proving|$)/.test(document.querySelector('#proof').textContent));
  assert.match(await page.locator('#proof').textContent(), /Proved|Not proved/);
  await page.context().close();
});

// A touch of fingers, each of which moves from one place to another.
async function touch(page, fingers, moves = 8) {
  const cdp = await page.context().newCDPSession(page);
  const at = (k) => fingers.map(([from, to], id) => ({ id, x: from[0] + ((to[0] - from[0]) * k) / moves, y: from[1] + ((to[1] - from[1]) * k) / moves }));
  await cdp.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0) });
  for (let k = 1; k <= moves; k++) await cdp.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(k) });
  await page.waitForTimeout(60);
  await cdp.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
}
const middle = async (page, selector) => {
  await page.locator(selector).scrollIntoViewIfNeeded();
  const box = await page.locator(selector).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
};
// The picture in space, once it has its full size and is another one than before.
async function pictured(page, before = '') {
  await page.waitForFunction((old) => {
    const c = document.querySelector('#space');
    return !c.hidden && c.dataset.took && c.width >= c.clientWidth && c.width + c.toDataURL() !== old;
  }, before);
  return page.locator('#space').evaluate((c) => c.width + c.toDataURL());
}

await test('a finger drags a body, and turns the picture in space; two zoom it', async () => {
  const page = await open('', { width: 390, height: 844, hasTouch: true, isMobile: true });
  const before = await agrees(page);
  const [x, y] = await middle(page, '#bodies [data-id="a"]');
  await touch(page, [[[x, y], [x + 40, y - 20]]]);
  const after = await agrees(page);
  assert.notEqual(after.distance, before.distance);
  await page.locator('#museum').selectOption('physx-429');
  const seen = await pictured(page);
  const [u, v] = await middle(page, '#space');
  await touch(page, [[[u, v], [u + 60, v + 20]]]);
  const turned = await pictured(page, seen);
  await touch(page, [[[u - 30, v], [u - 60, v]], [[u + 30, v], [u + 60, v]]]);
  await pictured(page, turned);
  assert.equal(await page.evaluate(() => scrollX), 0);
  await page.context().close();
});

await test('time runs in space, and the picture with it', async () => {
  for (const [pose, end] of [['parry-317', 'max_time'], ['bevy-rapier-119', null]]) {
    const page = await open();
    await page.locator('#museum').selectOption(pose);
    const atContact = await pictured(page);
    assert.ok(await page.locator('#clock').isVisible(), pose);
    await page.locator('#time').fill('0');
    const atStart = await pictured(page, atContact);
    await page.locator('#run').click();
    assert.equal(await page.locator('#run').getAttribute('aria-label'), 'Stop time');
    await page.waitForFunction(() => document.querySelector('#time').value === document.querySelector('#time').max, null, { timeout: 15000 });
    await pictured(page, atStart);
    assert.equal(await page.locator('#run').getAttribute('aria-label'), 'Let time run');
    if (end) assert.equal(await page.locator('#time').getAttribute('max'), String(JSON.parse(await lineOf(page))[end]));
    await agrees(page);
    await page.locator('#space').screenshot({ path: join(pictures, `time-${pose}.png`) });
    await page.context().close();
  }
});

await test('half-spaces are drawn, in the plane and in space', async () => {
  const page = await open();
  const asked = async (body, normal) => {
    await page.locator('#line').fill(JSON.stringify({ query: 'distance', a: { type: 'posed', translation: normal.map((n) => 2 * n), of: body }, b: { type: 'half_space', normal, offset: -0.5 } }));
    await page.locator('#ask').click();
    await page.waitForFunction(() => !document.querySelector('#verdict').textContent.startsWith('Loading'));
    return agrees(page);
  };
  assert.equal((await asked({ type: 'ball', radius: 1 }, [0, 1])).distance, 1.5);
  // The floor begins within the picture: 1.5 below the body, which is 2 high.
  const [floor, whole] = await Promise.all(['#bodies-drawn path.body.b', '#bodies'].map((part) => page.locator(part).boundingBox()));
  assert.ok(floor.y > whole.y + whole.height / 2 && floor.y < whole.y + whole.height, `${floor.y} in ${whole.y} + ${whole.height}`);
  await page.locator('#bodies').screenshot({ path: join(pictures, 'floor-plane.png') });
  assert.equal((await asked({ type: 'cuboid', half_extents: [1, 1, 1] }, [0, 1, 0])).distance, 1.5);
  const fromAbove = await pictured(page);
  // Seen from the side, the floor is all over the lower edge, and nothing is above.
  await page.locator('#space').focus();
  for (let k = 0; k < 4; k++) await page.keyboard.press('ArrowDown');
  await page.waitForTimeout(400);
  await pictured(page, fromAbove);
  const opaque = (row) => page.locator('#space').evaluate((c, at) => {
    const { data } = c.getContext('2d').getImageData(0, Math.round(at * (c.height - 1)), c.width, 1);
    return data.filter((_, i) => i % 4 === 3 && data[i] > 0).length / c.width;
  }, row);
  assert.deepEqual([await opaque(1), await opaque(0)].map((share) => share > 0.9), [true, false]);
  await page.locator('#space').screenshot({ path: join(pictures, 'floor-space.png') });
  await page.context().close();
});

await test('every line of the museum and of the suite that the page answers is answered in the same bytes', async () => {
  const page = await open();
  const museum = JSON.parse(readFileSync(join(site, 'museum.json'), 'utf8')).map((pose) => JSON.stringify(pose));
  const suite = pathToFileURL(process.env.PAGE_SUITE);
  const of = /"query": ?"(ray_cast|distance|signed_distance|intersect|linear_cast|motion_cast|margin|enclosing_ellipsoid)"/;
  const lines = readdirSync(suite).filter((name) => name.endsWith('.jsonl')).flatMap((name) => readFileSync(new URL(name, suite), 'utf8').split('\n'))
    .filter((line) => of.test(line) && !/"f32"|"mesh"|"eigen"/.test(line) && line.startsWith('{'));
  const all = [...museum, ...lines];
  const here = await page.evaluate(async (asked) => {
    const { engine } = await import('./engine.js');
    const [plane, space] = [await engine('plane'), await engine('space')];
    // The one that has it answers.
    return asked.map((line) => [plane, space].map(({ answer }) => answer(line)).find((text) => !text.includes('not in a browser') && !text.includes('unknown_query')) ?? 'none');
  }, all);
  const due = native(all);
  let differ = 0, zeros = 0;
  here.forEach((line, i) => {
    // Their numbers in the file are not compared. Of two zeros of either sign, the processor chooses the greater one.
    const text = (answer) => answer.replace(/"line":\d+/, '').replace(/^\{"id":\d+,/, '{').replaceAll(/-0\.0(?=[,}\]])/g, '0.0');
    if (line !== due[i] && text(line) === text(due[i]) && line.split('-0.0').length !== due[i].split('-0.0').length) zeros += 1;
    if (text(line) !== text(due[i])) { differ += 1; if (differ < 4) console.log(`DIFFERS ${all[i].slice(0, 300)}\n  here ${line}\n  there ${due[i]}`); }
  });
  console.log(`   ${all.length} lines, ${museum.length} of them of the museum, ${differ} differ, ${zeros} more in the sign of a zero`);
  assert.equal(differ, 0);
  await page.context().close();
});

await test('a pose of the museum in the plane can be dragged, and then is no longer that of the report', async () => {
  const page = await open();
  await page.locator('#museum').selectOption('meshes-639');
  const before = await agrees(page);
  assert.match(await page.locator('#story').textContent(), /Meshes/);
  await dragTo(page, 'target', 20, -10);
  const after = await agrees(page);
  assert.notEqual(after.lambda, before.lambda);
  assert.ok(!(await page.locator('#story').isVisible()));
  await page.context().close();
});

await test('what the checker says of the museum is what it says elsewhere', async () => {
  const page = await open();
  const poses = JSON.parse(readFileSync(join(site, 'museum.json'), 'utf8')).filter((pose) => /^(distance|intersect|ray_cast|linear_cast)$/.test(pose.query)).map((pose) => JSON.stringify(pose));
  const run = { encoding: 'utf8', maxBuffer: 1 << 28 };
  const certified = execFileSync(xtask, ['query', '--certify', '-'], { ...run, input: poses.join('\n') });
  let due;
  try {
    due = execFileSync(xtask, ['prove', '-'], { ...run, input: certified });
  } catch (why) {
    if (why.status !== 1) throw why;
    due = why.stdout;
  }
  due = due.trimEnd().split('\n').map((line) => JSON.parse(line)).filter(({ verdict }) => verdict).map(({ verdict }) => verdict);
  const here = await page.evaluate(async (asked) => {
    const { engine } = await import('./engine.js');
    const [plane, space] = [await engine('plane'), await engine('space')];
    return asked.map((line) => {
      const query = JSON.parse(line);
      const half = plane.ask(query, 'look').drawing.dimension === 2 ? plane : space;
      return space.ask(half.ask(query, 'certify'), 'judge').verdict;
    });
  }, poses);
  console.log(`   ${here.filter((verdict) => verdict === 'proved').length} of ${poses.length} poses proved`);
  assert.deepEqual(here, due);
  await page.context().close();
});

await test('without scripts it says what it is, and shows a picture', async () => {
  const page = await open('', { javaScriptEnabled: false });
  assert.ok(await page.locator('noscript p').isVisible());
  assert.ok((await page.locator('noscript img').evaluate((i) => i.naturalWidth)) > 0, 'the picture is there');
  await page.context().close();
});

await test('pictures at 390 and 900 pixels, light and dark; nothing is wider than the screen', async () => {
  for (const width of [390, 900]) {
    for (const scheme of ['light', 'dark']) {
      const page = await open('', { width, height: width === 390 ? 844 : 900, scheme, deviceScaleFactor: width === 390 ? 2 : 1 });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      assert.ok(wide <= width, `${wide} of ${width}`);
      await page.screenshot({ path: join(pictures, `distance-${width}-${scheme}.png`) });
      for (const kind of QUESTIONS.slice(1)) {
        await page.locator('#question').selectOption(kind);
        await settled(page);
        await page.screenshot({ path: join(pictures, `${kind}-${width}-${scheme}.png`) });
      }
      await page.locator('#museum').selectOption('physx-429');
      await page.waitForFunction(() => document.querySelector('#space').width > 600 || innerWidth < 600);
      await page.waitForTimeout(1500);
      await page.screenshot({ path: join(pictures, `museum-${width}-${scheme}.png`), fullPage: true });
      await page.context().close();
    }
  }
});

await browser.close();
server.close();
console.log(`${passed} tests passed`);
