import {detectionFacts, distanceOf, metres, minutes, timeText} from './facts.js';

const $ = (id) => document.getElementById(id);

function element(tag, properties = {}, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

/** The page around the scene. */
export class Panel {
  #layers = new Map();

  /** actions: what buttons do, by name. */
  constructor(actions) {
    this.actions = actions;
    for (const name of ['play', 'step', 'restart', 'follow', 'theme'])
      $(name).addEventListener('click', () => actions[name]());
    $('reset-view').addEventListener('click', () => actions.resetView());
    $('card-close').addEventListener('click', () => actions.select(null));
    $('speed').addEventListener('change', () => actions.speed(Number($('speed').value)));
    $('colouring').addEventListener('change', () => actions.colouring($('colouring').value));
    document.addEventListener('keydown', (event) => this.#onKey(event));
  }

  addLayer(name, text, on, onChange) {
    const box = element('input', {type: 'checkbox', checked: on, id: `layer-${name}`});
    box.addEventListener('change', () => onChange(box.checked));
    const note = element('span', {className: 'note'});
    $('layers').append(element('label', {}, box, ` ${text} `, note));
    this.#layers.set(name, note);
    onChange(on);
  }

  setLayerNote(name, text) {
    this.#layers.get(name).textContent = text;
  }

  showConnection(state) {
    document.body.dataset.connection = state;
    $('connection').textContent = {open: 'connected', lost: 'connection lost, trying again'}[state];
  }

  showSource({source, log, version}) {
    $('source').textContent = source === 'log' ? `log ${log}` : 'live';
    $('source').title = `rimod ${version}`;
    $('player').hidden = source !== 'log';
    document.title = source === 'log' ? `rimod: ${log}` : 'rimod';
  }

  /** items: of Objects; state: {objects, faded, selected, sensor}. */
  showObjects(items, colours, {objects, faded, selected, sensor}) {
    const provisional = objects && !objects.detections;
    $('objects-title').textContent = provisional ? 'Found so far' : 'Found';
    $('objects').classList.toggle('faded', faded);
    const entries = items.map(({detection, index}) => {
      const swatch = element('span', {className: 'swatch'});
      swatch.style.setProperty('--colour', colours.ofClass(detection.class));
      const range = sensor ? metres(distanceOf(detection.pose, sensor)) : '';
      const button = element(
          'button', {onclick: () => this.actions.select(index === selected ? null : index)}, swatch,
          element('span', {className: 'name', textContent: detection.class, title: detection.class}),
          element('span', {className: 'number', textContent: detection.score.toFixed(2)}),
          element('span', {className: 'number', textContent: range}));
      button.setAttribute('aria-pressed', String(index === selected));
      const entry = element('li', {}, button);
      entry.dataset.class = detection.class;
      entry.dataset.score = detection.score;
      return entry;
    });
    $('objects').replaceChildren(...entries);
    $('objects').dataset.scan = objects?.id ?? '';
    $('objects').dataset.state = !objects ? 'none' : faded ? 'faded' : provisional ? 'provisional' : 'final';
    $('objects-note').textContent = this.#objectsNote(objects, faded, items.length);
  }

  #objectsNote(objects, faded, count) {
    if (!objects) return 'Nothing has been looked for yet.';
    if (faded) return 'Of an earlier scan: this one is being looked at.';
    const models = `${objects.num_models} ${objects.num_models === 1 ? 'model' : 'models'}`;
    if (!objects.detections) return `Provisional, of ${models}: the sweep goes on.`;
    const nothing = count === 0 ? 'Nothing found; ' : '';
    const time = objects.detection_ms > 0 ? `, ${objects.detection_ms.toFixed(0)} ms` : '';
    return `${nothing}${models} looked for${time}`;
  }

  showScan(header) {
    document.body.dataset.scan = header.id;
    const shown = header.points.count === header.num_points ? '' : `, ${header.points.count.toLocaleString('en')} drawn`;
    $('scan-facts').textContent = `${header.num_points.toLocaleString('en')} points${shown}`;
  }

  showRamp([low, high], theme, colouring) {
    $('ramp').hidden = colouring === 'plain';
    $('ramp-bar').style.background = `linear-gradient(to right, ${theme.ramp.join(', ')})`;
    $('ramp-low').textContent = metres(low);
    $('ramp-high').textContent = metres(high);
  }

  showTheme(name) {
    document.documentElement.dataset.theme = name;
    $('theme').textContent = name === 'dark' ? 'Light' : 'Dark';
  }

  showTimeline(scans, shownId, following) {
    const most = Math.max(1, ...scans.map(({num_detections: count}) => count ?? 0));
    const ticks = scans.map((scan) => {
      const count = scan.num_detections;
      const text = `${timeText(scan.utime)}: ${count ?? '?'} found`;
      const tick = element('button', {className: 'tick', title: text, onclick: () => this.actions.choose(scan.id)});
      tick.setAttribute('aria-label', text);
      tick.setAttribute('aria-current', String(scan.id === shownId));
      const bar = element('span', {className: count === null ? 'bar unknown' : 'bar'});
      bar.style.height = `${20 + (80 * (count ?? 0)) / most}%`;
      tick.append(bar);
      return tick;
    });
    $('scans').replaceChildren(...ticks);
    const shown = scans.find(({id}) => id === shownId);
    const number = scans.indexOf(shown) + 1;
    $('scan-time').textContent = shown ? `${timeText(shown.utime)}  (${number} of ${scans.length})` : '';
    $('follow').setAttribute('aria-pressed', String(following));
  }

  showPlayback({playing, at_end: atEnd, position, duration, speed, warning}) {
    $('play').setAttribute('aria-label', playing ? 'Pause' : 'Play');
    $('position').textContent = `${minutes(position)} / ${minutes(duration)}`;
    $('player').dataset.state = playing ? 'playing' : atEnd ? 'end' : 'paused';
    const speeds = $('speed');
    if (![...speeds.options].some(({value}) => Number(value) === speed))
      speeds.append(element('option', {textContent: String(speed)}));
    speeds.value = String(speed);
    $('source').classList.toggle('warning', warning !== '');
    if (warning !== '') $('source').title = warning;
  }

  /** facts: pairs of name and text; null hides the card. */
  showCard(title, facts) {
    $('card').hidden = facts === null;
    if (facts === null) return;
    $('card-title').textContent = title;
    $('card-facts').replaceChildren(...facts.flatMap(
        ([name, text]) => [element('dt', {textContent: name}), element('dd', {textContent: text})]));
  }

  showDetectionCard({detection, provisional}, sensor) {
    this.showCard(detection.class, detectionFacts(detection, sensor, provisional).slice(1));
  }

  #onKey(event) {
    if (['SELECT', 'INPUT', 'BUTTON'].includes(event.target.tagName)) return;
    const action = {' ': 'togglePlay', ArrowLeft: 'earlier', ArrowRight: 'later', Escape: 'unselect'}[event.key];
    if (!action) return;
    event.preventDefault();
    this.actions[action]();
  }
}
