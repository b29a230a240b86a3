// What the page shows, and what it does when the server goes. Starts the server itself, to stop it.
//   page_test.mjs SOURCE LIBRARIES CHROMIUM URL pipeline|log SERVER ARGUMENT.. [-- PLAYER ARGUMENT..]
import assert from 'node:assert/strict';
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {createServer} from 'node:http';
import {pathToFileURL} from 'node:url';

const [source, libraries, chromium, url, part, ...commands] = process.argv.slice(2);
const {launchBrowser, openPage, waitForObjects} = await import(
    pathToFileURL(`${source}/web_viewer/page/browser.mjs`).href);
const end = commands.includes('--') ? commands.indexOf('--') : commands.length;
const serverCommand = commands.slice(0, end);
const playerCommand = commands.slice(end + 1);
const expected = readFileSync(`${source}/logs/expected/office.detections.jsonl`, 'utf8')
                     .trim().split('\n').map((line) => JSON.parse(line));

const running = new Set();

function start([program, ...words]) {
  const child = spawn(program, words, {stdio: 'inherit'});
  running.add(child);
  child.ended = new Promise((resolve) => child.on('exit', (code) => {
    running.delete(child);
    resolve(code);
  }));
  return child;
}

async function serve() {
  const server = start(serverCommand);
  for (let i = 0; i < 600; ++i) {
    if (await fetch(url).then(({ok}) => ok, () => false)) return server;
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  throw new Error('the server did not come up');
}

async function stop(server) {
  server.kill('SIGTERM');
  assert.equal(await server.ended, 0, 'exit code of the server');
}

async function play() {
  if (playerCommand.length > 0) assert.equal(await start(playerCommand).ended, 0, 'exit code of the player');
}

function waitForConnection(page, state) {
  return page.waitForFunction((wanted) => document.body.dataset.connection === wanted, state);
}

/** The objects that the page lists are those that are expected, in their order. */
async function checkObjects(page) {
  await waitForObjects(page, expected.length, 120_000);
  const listed = await page.locator('#objects li').evaluateAll((items) => items.map(({dataset}) => ({...dataset})));
  assert.deepEqual(listed.map((item) => item.class), expected.map((object) => object.class));
  listed.forEach((item, i) => assert.ok(Math.abs(item.score - expected[i].score) < 0.02, `score of ${item.class}`));
  const labels = await page.locator('.label').allTextContents();
  assert.deepEqual(labels.map((text) => text.split(' ')[0]), expected.map((object) => object.class));
}

async function checkCard(page) {
  const [x, y, z] = expected[0].pose;
  await page.locator('#objects button').first().dispatchEvent('click');
  assert.equal(await page.locator('#card-title').textContent(), expected[0].class);
  const facts = await page.locator('#card-facts').textContent();
  for (const wanted of ['score', 'distance', 'heading', 'size']) assert.ok(facts.includes(wanted), `${wanted}: ${facts}`);
  const position = facts.match(/position(-?[\d.]+), (-?[\d.]+), (-?[\d.]+) m/).slice(1).map(Number);
  [x, y, z].forEach((value, i) => assert.ok(Math.abs(position[i] - value) < 0.03, `position: ${position}`));
  await page.locator('#card-close').dispatchEvent('click');
  assert.ok(await page.locator('#card').isHidden());
}

/** A click on an object's own place in the scene picks it; its label stands right above it. */
async function checkPicking(page) {
  const name = expected[1].class;
  await page.waitForFunction(() => [...document.querySelectorAll('.label')].every(({style}) => style.transform !== ''));
  const box = await page.locator('.label', {hasText: name}).boundingBox();
  for (let down = 8; down < 100; down += 8) {
    await page.mouse.click(box.x + box.width / 2, box.y + box.height + down);
    if (await page.locator('#card-title').textContent() === name && await page.locator('#card').isVisible()) return;
  }
  assert.fail(`no click below the label picks ${name}`);
}

async function checkLayers(page) {
  await page.locator('#layer-labels').dispatchEvent('click');
  await page.waitForFunction(() => [...document.querySelectorAll('.label')].every((label) => label.hidden));
  await page.locator('#layer-labels').dispatchEvent('click');
  await page.waitForFunction(() => [...document.querySelectorAll('.label')].some((label) => !label.hidden));
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const before = await background();
  await page.locator('#theme').dispatchEvent('click');
  assert.notEqual(await background(), before);
}

async function checkPlayer(page) {
  const state = (wanted) =>
      page.waitForFunction((name) => document.getElementById('player').dataset.state === name, wanted);
  await state('end');
  await page.locator('#speed').evaluate((speed) => {
    speed.value = '0.25';  // so that the page sees it play, however slowly it draws
    speed.dispatchEvent(new Event('change'));
  });
  await page.locator('#restart').dispatchEvent('click');
  await state('playing');
  await page.locator('#play').dispatchEvent('click');
  await state('paused');
  await page.locator('#step').dispatchEvent('click');
  await page.waitForFunction(() => {
    const [at, duration] = document.getElementById('position').textContent.split(' / ');
    return at === duration && document.getElementById('player').dataset.state !== 'playing';
  });
}

/** A page of another site gets nothing out of the server: neither by WebSocket nor by reading its files. */
async function checkForeignPage(context) {
  const site = createServer((request, response) => {
    response.setHeader('content-type', 'text/html');
    response.end('<p>another site</p>');
  });
  await new Promise((resolve) => site.listen(0, '127.0.0.1', resolve));
  try {
    const page = await context.newPage();
    await page.goto(`http://localhost:${site.address().port}/`);
    const connects = (address) => page.evaluate((to) => new Promise((resolve) => {
      const socket = new WebSocket(to, 'rimod-web');
      socket.onopen = () => resolve('open');
      socket.onerror = () => resolve('refused');
    }), address);
    assert.equal(await connects(url.replace('http', 'ws')), 'refused');
    assert.equal(await connects(url.replace('http://127.0.0.1', 'ws://localhost')), 'refused');
    assert.equal(await page.evaluate((to) => fetch(to).then(() => 'read', () => 'refused'), url), 'refused');
    await page.close();
  } finally {
    site.close();
  }
}

const browser = await launchBrowser(libraries, chromium);
try {
  const server = await serve();
  const context = await browser.newContext({colorScheme: 'dark', viewport: {width: 900, height: 480}});
  context.setDefaultTimeout(150_000);  // software rendering on a busy machine
  const {page, errors} = await openPage(context, url);
  await waitForConnection(page, 'open');
  await play();
  await checkObjects(page);
  await checkCard(page);
  assert.deepEqual(errors, []);
  if (part === 'log') {
    await checkPicking(page);
    await checkLayers(page);
    await checkPlayer(page);
    await checkForeignPage(context);
  }
  await stop(server);
  await waitForConnection(page, 'lost');
  const second = await serve();
  await waitForConnection(page, 'open');
  await play();
  await checkObjects(page);
  await stop(second);
  console.log(`the page shows the ${expected.length} objects, before and after a restart`);
} finally {
  await browser.close();
  for (const child of running) child.kill('SIGKILL');
}
