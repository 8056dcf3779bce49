// A prepared scene, to turn and to click on.

const view = {target: [0, 0, 0], distance: 1, azimuth: 200, elevation: 35, angle: 45};
const state = {byTag: false, chosen: null, sun: [0, 0, 1], findings: [], picked: null};
const ui = {};
let painter = null, drawing = false;

function resize() {
  const width = Math.max(240, ui.space.clientWidth - 2), tall = window.innerWidth < 1200 ? 0.75 * width : Infinity;
  ui.canvas.width = width, ui.canvas.height = Math.max(240, Math.min(tall, window.innerHeight - 130));
  draw();
}

function draw() {
  if (drawing) return;
  drawing = true;
  requestAnimationFrame(() => {
    drawing = false;
    const camera = cameraOf(view, ui.canvas.width, ui.canvas.height);
    painter.draw(camera, state.sun, state.byTag, state.chosen);
    drawMarks(camera);
    showMap(camera);
    window.drawnAt = performance.now();
  });
}

// Findings and the chosen place, above the picture.
function drawMarks(camera) {
  ui.marks.textContent = '';
  const mark = (p, colour, title) => {
    const at = windowOf(camera, p);
    if (!at || at[0] < 0 || at[1] < 0 || at[0] > camera.width || at[1] > camera.height) return;
    ui.marks.append(make('div', {className: 'mark', title, style: `left:${at[0] - 6}px;top:${at[1] - 6}px;border-color:${colour}`}));
  };
  for (const f of state.findings) for (const p of f.places) mark(p, f.error ? '#d00' : '#e07000', f.text);
  if (state.picked) mark(state.picked, '#0060ff', 'chosen');
}

// An arrow to the north, and a bar of scale for what is as far away as the middle of the view.
function showMap(camera) {
  const east = camera.right[1], up = camera.up[1], metres = 2 * view.distance / camera.f / camera.height, length = roundBelow(150 * metres);
  ui.map.replaceChildren(...Math.hypot(east, up) > 0.02 ? [northArrow(Math.atan2(east, up) * 180 / Math.PI)] : [],
    make('span', {}, make('div', {className: 'bar', id: 'scalebar', style: `width:${length / metres}px`}), lengthText(length)),
    make('span', {className: 'said'}, 'in the middle of the view'), ui.place);
}

// The place under the pointer, where finding it is quick.
let slow = 0;
function hover(e) {
  if (slow > 40) return;
  const box = ui.canvas.getBoundingClientRect(), begin = performance.now();
  const hit = hitAt(e.clientX - box.left, e.clientY - box.top);
  slow = Math.max(slow, performance.now() - begin);
  ui.place.textContent = hit ? geodeticText(add(hit.place, about.middle), originOfScene()) : '';
}
function originOfScene() { return about.latitude === undefined ? null : [about.latitude, about.longitude, about.height || 0]; }

// The nearest thing along the ray of a place in the window.
function hitAt(x, y) {
  const ray = rayOf(cameraOf(view, ui.canvas.width, ui.canvas.height), x, y);
  let best = null;
  for (const thing of painter.things)
    for (let i = 0; i < thing.places.length / 12; ++i) {
      const local = intoLocal(thing.places, i, ray), most = best ? best.distance : Infinity;
      if (!meetsBox(local, thing.low, thing.high, most)) continue;
      const hit = nearestTriangle(local, positionsOf(thing), thing.indices, most);
      if (hit) best = {...hit, thing, instance: i, place: add(ray.from, scaled(ray.along, hit.distance))};
    }
  return best;
}

function positionsOf(thing) {
  if (!thing.positions)
    thing.positions = Float32Array.from(thing.cells, (c, i) => thing.low[i % 3] + thing.size[i % 3] * c / 65535);
  return thing.positions;
}

function choose(x, y) {
  const hit = hitAt(x, y);
  state.picked = hit ? hit.place : null;
  if (!hit) {
    state.chosen = null;
    ui.picked.textContent = 'nothing there';
    return draw();
  }
  const [override, tag, number] = hit.thing.keys.subarray(3 * hit.instance, 3 * hit.instance + 3);
  const part = hit.thing.parts.find(([first, count]) => hit.triangle >= first && hit.triangle < first + count);
  const own = part[2] < 0 ? kNone : part[2], material = override === kNone ? own : override;
  state.chosen = state.byTag ? tag : material;
  const enu = add(hit.place, about.middle);
  state.hit = {object: hit.thing.name, instance: number, material: material === kNone ? 'none' : about.materials[material],
    tag: tag === kNone ? 'none' : about.tags[tag], place: enu};
  const row = (name, text) => make('tr', {}, make('td', {}, name), make('td', {}, text));
  ui.picked.replaceChildren(make('table', {}, row('object', hit.thing.name), row('instance', String(number)), row('material', state.hit.material),
    row('tag', state.hit.tag), row('east, m', shown(enu[0], 8)), row('north, m', shown(enu[1], 8)), row('up, m', shown(enu[2], 8)),
    ...about.latitude === undefined ? [] : [row('place', geodeticText(enu, originOfScene()))]));
  draw();
}

function look(p, distance) {
  view.target = p;
  if (distance) view.distance = distance;
  draw();
}

function shift(dx, dy) {
  const camera = cameraOf(view, ui.canvas.width, ui.canvas.height), by = 2 * view.distance / camera.f / ui.canvas.height;
  view.target = add(view.target, add(scaled(camera.right, -dx * by), scaled(camera.up, dy * by)));
}

// Mouse and fingers: one turns, two shift and draw nearer.
function listen(canvas) {
  const fingers = new Map();
  let moved = 0;
  const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
  canvas.addEventListener('pointerdown', e => {
    if (!fingers.size) moved = 0;
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener('pointermove', e => {
    const from = fingers.get(e.pointerId);
    if (!from) return hover(e);
    const dx = e.clientX - from[0], dy = e.clientY - from[1], before = fingers.size === 2 ? spread() : 0;
    moved += Math.abs(dx) + Math.abs(dy);
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    if (fingers.size === 2) {
      shift(dx / 2, dy / 2);
      view.distance *= before / Math.max(1, spread());
    } else if (e.shiftKey || e.buttons & 2) shift(dx, dy);
    else {
      view.azimuth = (view.azimuth + 0.3 * dx + 360) % 360;
      view.elevation = Math.min(89.9, Math.max(-89.9, view.elevation + 0.3 * dy));
    }
    draw();
  });
  const end = e => {
    if (!fingers.delete(e.pointerId) || e.type !== 'pointerup' || moved >= 4 || fingers.size) return;
    const box = canvas.getBoundingClientRect();
    choose(e.clientX - box.left, e.clientY - box.top);
  };
  canvas.addEventListener('pointerup', end);
  canvas.addEventListener('pointercancel', end);
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    view.distance *= Math.exp(0.001 * e.deltaY);
    draw();
  }, {passive: false});
  canvas.addEventListener('dblclick', () => { if (state.picked) look(state.picked, view.distance / 2); });
  window.addEventListener('resize', resize);
}

function setSun() {
  let azimuth = Number(ui.azimuth.value), elevation = Number(ui.elevation.value);
  if (ui.when.value && about.latitude !== undefined) {
    ({azimuth, elevation} = sunAt(new Date(ui.when.value + 'Z'), about.latitude, about.longitude));
    ui.azimuth.value = azimuth, ui.elevation.value = elevation;
  }
  state.sunAt = {azimuth, elevation};
  state.sun = directionOf(azimuth, elevation);
  ui.sunText.textContent = `azimuth ${azimuth.toFixed(2)}, elevation ${elevation.toFixed(2)} degrees` + (elevation < 0 ? ': it is down' : '');
  draw();
}

function buildPanel() {
  const box = (title, ...inside) => make('fieldset', {}, make('legend', {}, title), ...inside);
  ui.picked = make('div', {id: 'picked'}, 'Drag turns, Shift, the right button or two fingers shift, wheel or two fingers go nearer; click on something, double click looks at it.');
  ui.colour = make('select', {id: 'colour', onchange: () => { state.byTag = ui.colour.value === 'tag'; state.chosen = null; keys(); draw(); }});
  option(ui.colour, 'material', 'a colour for each material');
  option(ui.colour, 'tag', 'a colour for each tag');
  ui.keys = make('div', {className: 'keys', id: 'keys'});
  const freely = () => { ui.when.value = ''; setSun(); };
  ui.when = make('input', {type: 'datetime-local', id: 'when', onchange: setSun, disabled: about.latitude === undefined});
  ui.azimuth = make('input', {type: 'range', id: 'azimuth', min: 0, max: 360, step: 'any', value: 150, oninput: freely});
  ui.elevation = make('input', {type: 'range', id: 'elevation', min: -20, max: 90, step: 'any', value: 45, oninput: freely});
  ui.sunText = make('div', {id: 'sunText'});
  ui.findings = make('div', {className: 'keys', id: 'findings'});
  ui.lacks = make('div', {className: 'said', id: 'lacks'}, 'reading ...');
  const whole = () => { view.target = [0, 0, 0], view.distance = 2.4 * about.radius; draw(); };
  return make('div', {className: 'panel'}, box('chosen', ui.picked), box('view', make('button', {id: 'whole', onclick: whole}, 'all of it'), ' ', make('button', {id: 'tagged', onclick: lookAtTagged}, 'what has tags'), ui.colour, ui.keys),
    box('sun, no shadows', make('label', {}, 'UTC', ui.when), make('label', {}, 'azimuth', ui.azimuth), make('label', {}, 'elevation', ui.elevation), ui.sunText),
    box('findings of the check', ui.findings), ui.lacks);
}

function keys() {
  const used = new Set();
  for (const thing of painter.things) {
    const n = thing.keys.length / 3;
    for (let i = 0; i < n; ++i) {
      if (state.byTag) used.add(thing.keys[3 * i + 1]);
      else if (thing.keys[3 * i] !== kNone) used.add(thing.keys[3 * i]);
      else for (const [, , material] of thing.parts) used.add(material < 0 ? kNone : material);
    }
  }
  const names = state.byTag ? about.tags : about.materials;
  ui.keys.replaceChildren(...[...used].sort((a, b) => a - b).slice(0, 300).map(i => make('label', {},
    make('span', {className: 'box', style: `background:${colourOf(i)}`}), i === kNone ? 'none' : names[i])));
}

function showFindings(list) {
  state.findings = list.map(f => {
    const places = [];
    for (const thing of painter.things)
      if (thing.name === f.geometry || thing.name.startsWith(f.geometry + '/'))
        for (let i = 0; i < Math.min(thing.places.length / 12, 50) && places.length < 50; ++i) places.push(outOfLocal(thing.places, i, sub(f.local, thing.origin)));
    return {...f, places};
  });
  ui.findings.replaceChildren(...state.findings.map(f => make('label', {onclick: () => f.places.length && look(f.places[0], 0.1 * about.radius)},
    make('span', {className: 'box', style: `background:${f.error ? '#d00' : '#e07000'}`}), f.text)));
  if (!list.length) ui.findings.textContent = 'none with a place';
}

// The scene's date at the time that is shown, UTC; without one about noon of the place on a day of June.
function momentOf({epoch, time, longitude}) {
  const start = epoch ? Date.parse(/(Z|[-+]\d\d:?\d\d)$/.test(epoch) ? epoch : epoch + 'Z') : NaN;
  return Number.isFinite(start) ? new Date(start + 1000 * (time || 0)).toISOString().slice(0, 16) : new Date(Date.UTC(2026, 5, 21, 12) - 240000 * longitude).toISOString().slice(0, 16);
}

// Near what has tags, from where all of it is seen; all of the scene where nothing or nearly everything has one.
function lookAtTagged() {
  let low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const thing of painter.things)
    for (let i = 0; i < thing.places.length / 12; ++i) {
      if (thing.keys[3 * i + 1] === kNone) continue;
      for (let k = 0; k < 8; ++k) {
        const p = outOfLocal(thing.places, i, [0, 1, 2].map(a => k >> a & 1 ? thing.high[a] : thing.low[a]));
        low = low.map((v, a) => Math.min(v, p[a])), high = high.map((v, a) => Math.max(v, p[a]));
      }
    }
  const radius = low[0] <= high[0] ? 0.5 * Math.hypot(...sub(high, low)) : Infinity, near = radius < 0.7 * about.radius;
  view.target = near ? scaled(add(low, high), 0.5) : [0, 0, 0];
  view.distance = near ? Math.max(4 * radius, 2e-3 * about.radius) : 2.4 * about.radius || 1;
  draw();
}

function begin() {
  ui.canvas = make('canvas', {id: 'picture'});
  ui.marks = make('div', {id: 'marks'});
  ui.space = make('div', {className: 'space'}, ui.canvas, ui.marks);
  ui.place = make('span', {id: 'place'});
  ui.map = make('div', {className: 'map', id: 'map'});
  const app = document.getElementById('app');
  app.className = 'two';
  app.append(buildPanel(), make('div', {className: 'view'}, ui.space, ui.map));
  painter = new Painter(ui.canvas);
  view.distance = 2.4 * about.radius || 1;
  if (about.latitude !== undefined) ui.when.value = momentOf(about);
  listen(ui.canvas);
  setSun();
}

function ready() {
  const end = JSON.parse(document.getElementById('end').textContent);
  end.things.forEach((thing, i) => {
    const id = end.ids[i], bytes = what => bytesOf(block(id + what).text).buffer, small = thing.vertices <= 65536;
    thing.cells = new Uint16Array(bytes('v'));
    thing.indices = small ? new Uint16Array(bytes('t')) : new Uint32Array(bytes('t'));
    thing.places = numbersOf(id + 'p');
    thing.keys = numbersOf(id + 'k');
    thing.high = add(thing.low, thing.size);
    painter.add(thing);
  });
  lookAtTagged();
  keys();
  showFindings(end.findings);
  const triangles = painter.things.reduce((sum, t) => sum + t.indices.length / 3 * t.places.length / 12, 0);
  ui.lacks.textContent = [`${triangles} triangles drawn, ${painter.things.reduce((s, t) => s + t.places.length / 12, 0)} instances of ${painter.things.length} things. ` +
    'Places on surfaces are good to a 65 000th of a mesh.', ...end.notes, about.made].join('\n');
  resize();
  requestAnimationFrame(() => requestAnimationFrame(() => { window.readyAt = performance.now(); }));
}
