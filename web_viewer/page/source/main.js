import {Cloud} from './cloud.js';
import {Colours} from './colours.js';
import {Connection} from './connection.js';
import {pointFacts} from './facts.js';
import {Labels} from './labels.js';
import {Objects} from './objects.js';
import {Panel} from './panel.js';
import {Sensor} from './sensor.js';
import {View} from './view.js';

/** What the server told last, and what the user wants to see of it. */
const state = {
  scan: null,      // header
  objects: null,   // header
  timeline: [],
  playback: null,
  models: [],
  asked: new Set(),  // models
  following: true,
  selected: null,  // index among the detections
};

const colours = new Colours();
const cloud = new Cloud();
const objects = new Objects(colours);
const sensor = new Sensor();
const labels = new Labels(document.getElementById('labels'));
const view = new View(document.getElementById('canvas'), onClick, onDraw);
view.scene.add(cloud.points, objects.found, objects.ghosts, sensor.lines);
const panel = new Panel({
  play: togglePlay,
  togglePlay,
  step: () => connection.send({type: 'step'}),
  restart: () => connection.send({type: 'restart'}),
  speed: (factor) => connection.send({type: 'speed', factor}),
  follow,
  choose,
  earlier: () => chooseNeighbour(-1),
  later: () => chooseNeighbour(1),
  select,
  unselect: () => select(null),
  resetView: () => state.scan && view.lookAlong(state.scan, cloud.floor),
  theme: () => {
    colours.switchTheme();
    recolour();
  },
  colouring: (name) => {
    cloud.colouring = name;
    recolour();
  },
});
addLayers();
recolour();
panel.showObjects([], colours, state);
const connection = new Connection(onFrame, (now) => panel.showConnection(now));

function addLayers() {
  const layer = (name, text, on, set) => panel.addLayer(name, text, on, (visible) => {
    set(visible);
    view.draw();
  });
  layer('cloud', 'Scan', true, (visible) => { cloud.points.material.visible = visible; });
  layer('found', 'Found objects', true, (visible) => { objects.found.visible = visible; });
  layer('labels', 'Names and scores', true, (visible) => { labels.visible = visible; });
  layer('ghosts', 'Hypotheses', false, (visible) => { objects.ghosts.visible = visible; });
  layer('sensor', 'Sensor and its view', true, (visible) => { sensor.lines.material.visible = visible; });
  layer('grid', 'Floor, 1 m squares', true, (visible) => { view.grid.visible = visible; });
}

function onFrame({header, lists}) {
  const handlers = {hello: onHello, scan: onScan, objects: onObjects, timeline: onTimeline, playback: onPlayback,
                    model: onModel};
  handlers[header.type]?.(header, lists);
  view.draw(() => connection.shown());
}

function onHello(header) {
  // Also after a restart of the server, which knows nothing of this page and has other ids.
  state.models = header.models;
  state.asked.clear();
  state.following = true;
  state.scan = state.objects = state.playback = null;
  state.timeline = [];
  colours.setNames(header.models);
  cloud.hide();
  sensor.lines.visible = false;
  select(null);
  panel.showSource(header);
  showTimeline();
}

function onScan(header, lists) {
  const moved = view.centre(header.sensor);
  state.scan = header;
  cloud.show(header, lists, view.origin);
  sensor.show(header, view.origin);
  view.grid.position.z = cloud.floor;
  if (moved) view.lookAlong(header, cloud.floor);
  panel.showScan(header);
  recolour();
  showTimeline();
}

function onObjects(header) {
  if (header.id !== state.objects?.id) state.selected = null;
  state.objects = header;
  if (!view.origin && header.sensor) view.centre(header.sensor);
  const classes = [...(header.detections ?? header.early), ...header.hypotheses].map((object) => object.class);
  for (const name of new Set(classes)) {
    if (!state.models.includes(name) || objects.has(name) || state.asked.has(name)) continue;
    state.asked.add(name);
    connection.send({type: 'model', name});
  }
  const open = header.hypotheses.filter(({stage}) => stage !== 'validated').length;
  panel.setLayerNote('ghosts', header.num_hypotheses > 0 ? `${open} not confirmed` : '');
  showObjects();
}

function onModel(header, lists) {
  objects.addModel(header, lists);
  showObjects();
}

function onTimeline(header) {
  state.timeline = header.scans;
  if (!state.following && !header.scans.some(({id}) => id === state.scan?.id)) state.following = true;
  showTimeline();
}

function onPlayback(header) {
  state.playback = header;
  panel.showPlayback(header);
}

function showObjects() {
  if (!view.origin) return;
  const ofThisScan = state.objects?.id === state.scan?.id || !state.scan;
  const provisional = state.objects && !state.objects.detections;
  const shown = ofThisScan || state.following ? state.objects : null;
  const faded = Boolean(shown) && !ofThisScan && !provisional;
  objects.show(shown, view.origin, {faded, selected: state.selected});
  labels.show(objects.items, colours, faded);
  document.body.dataset.waiting = [...state.asked].filter((name) => !objects.has(name)).length;  // for surfaces
  panel.showObjects(objects.items, colours, {
    objects: shown, faded, selected: state.selected, sensor: shown?.sensor ?? state.scan?.sensor ?? null});
  view.draw();
}

function showTimeline() {
  panel.showTimeline(state.timeline, state.scan?.id, state.following);
}

function recolour() {
  panel.showTheme(colours.themeName);
  view.recolour(colours.theme);
  cloud.recolour(colours.theme);
  sensor.recolour(colours.theme);
  panel.showRamp(cloud.rampEnds(view.origin ?? {z: 0}), colours.theme, cloud.colouring);
  showObjects();
  view.draw();
}

function onDraw(camera, width, height) {
  cloud.viewHeight = view.pixels;
  objects.viewHeight = view.pixels;
  labels.place(camera, width, height);
}

function select(index) {
  state.selected = index;
  showObjects();
  const item = objects.items.find((other) => other.index === index);
  if (item) {
    panel.showDetectionCard(item, state.objects.sensor ?? state.scan?.sensor ?? null);
  } else {
    panel.showCard('', null);
  }
}

function onClick(ray, angle) {
  const item = objects.found.visible ? objects.pick(ray) : null;
  select(item ? item.index : null);
  if (item || !state.scan) return;
  const point = cloud.pick(ray, angle);
  if (point) panel.showCard('measured point', pointFacts(point.add(view.origin).toArray(), state.scan.sensor));
}

function follow() {
  state.following = true;
  connection.send({type: 'follow'});
  showTimeline();
  showObjects();
}

function choose(id) {
  state.following = false;
  connection.send({type: 'choose', id});
  showTimeline();
}

function chooseNeighbour(step) {
  const index = state.timeline.findIndex(({id}) => id === state.scan?.id) + step;
  if (index >= 0 && index < state.timeline.length) choose(state.timeline[index].id);
}

function togglePlay() {
  connection.send({type: state.playback?.playing ? 'pause' : 'play'});
}
