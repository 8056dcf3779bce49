// Lobes of a fitted scattering function: patches of its cells, as far out as its value, for one view direction at a time.

const view = {azimuth: 215, elevation: 30, zoom: 1};
const state = {view: 0, channel: 0, scale: 'log', edges: true, chosen: -1};
const ui = {};
let cells = null, shapes = [];

function load() {
  const id = `${about.views[state.view].number}.${state.channel}`;
  const corners = new Int16Array(bytesOf(block('c' + id).text).buffer);
  cells = {corners, values: numbersOf('v' + id), masses: numbersOf('m' + id), orders: numbersOf('o' + id)};
  cells.count = cells.orders.length;
  cells.high = 0, cells.low = Infinity;
  for (const v of cells.values) if (v > 0) cells.high = Math.max(cells.high, v), cells.low = Math.min(cells.low, v);
  cells.low = Math.max(cells.low, cells.high * 1e-4);
  state.chosen = -1;
}

// How far out a value is drawn: 1 for the largest.
function reach(v) {
  if (!(v > 0) || !(cells.high > 0)) return 0;
  if (state.scale === 'sphere') return 1;
  if (state.scale === 'linear') return v / cells.high;
  if (state.scale === 'root') return Math.cbrt(v / cells.high);
  const zero = cells.low / 3;  // what is least is not nothing
  return Math.max(0.02, Math.log(v / zero) / Math.log(cells.high / zero));
}

function colour(v) {
  const span = Math.log(cells.high / cells.low);
  const t = v > 0 && span > 0 ? Math.log(v / cells.low) / span : v > 0 ? 1 : 0;
  return viridis(Math.min(1, Math.max(0, t)));
}

function projector() {
  const back = directionOf(view.azimuth, view.elevation), right = unit(cross([0, 0, 1], back)), up = cross(back, right);
  const size = 0.42 * Math.min(ui.canvas.width, ui.canvas.height) * view.zoom, x0 = ui.canvas.width / 2, y0 = ui.canvas.height * 0.62;
  return p => [x0 + size * dot(p, right), y0 - size * dot(p, up), dot(p, back)];
}

function corner(i, k) {
  const c = cells.corners, at = 3 * (4 * i + k);
  return [c[at] / 32767, c[at + 1] / 32767, c[at + 2] / 32767];
}

function drawRing(context, project) {
  context.beginPath();
  for (let a = 0; a <= 360; a += 3) {
    const [x, y] = project(directionOf(a, 0));
    a ? context.lineTo(x, y) : context.moveTo(x, y);
  }
  context.fillStyle = '#d8d8d855';
  context.fill();
  context.strokeStyle = '#888';
  context.stroke();
}

function drawArrow(context, project, d, ink, text, inward) {
  const a = project([0, 0, 0]), b = project(scaled(d, 1.15));
  context.strokeStyle = context.fillStyle = ink;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(a[0], a[1]);
  context.lineTo(b[0], b[1]);
  context.stroke();
  if (!inward) {
    context.beginPath();
    context.arc(b[0], b[1], 4, 0, 7);
    context.fill();
  }
  context.fillText(text, b[0] + 7, b[1]);
  context.lineWidth = 1;
}

function draw() {
  const context = ui.canvas.getContext('2d'), project = projector();
  context.clearRect(0, 0, ui.canvas.width, ui.canvas.height);
  context.font = '13px sans-serif';
  drawRing(context, project);
  shapes = [];
  for (let i = 0; i < cells.count; ++i) {
    const points = [0, 1, 2, 3].map(k => project(scaled(corner(i, k), reach(cells.values[5 * i + k]))));
    shapes.push({i, points, depth: points.reduce((s, p) => s + p[2], 0)});
  }
  shapes.sort((a, b) => a.depth - b.depth);
  for (const {i, points} of shapes) {
    const c = i === state.chosen ? [255, 60, 30] : colour(cells.values[5 * i + 4]);
    context.beginPath();
    points.forEach((p, k) => k ? context.lineTo(p[0], p[1]) : context.moveTo(p[0], p[1]));
    context.closePath();
    context.fillStyle = context.strokeStyle = `rgb(${c.map(Math.round).join(',')})`;
    context.fill();
    if (state.edges) context.strokeStyle = '#0006';
    context.stroke();
  }
  const v = about.views[state.view], out = outOf(v);
  drawArrow(context, project, out, '#c0392b', 'view');
  drawArrow(context, project, [-out[0], -out[1], out[2]], '#2471a3', 'mirror direction', true);
  showTexts(v);
  drawProfile();
}

// Directions of files: azimuths count from x to y.
function outOf(v) {
  const t = radians(v.theta), p = radians(v.phi);
  return [Math.sin(t) * Math.cos(p), Math.sin(t) * Math.sin(p), Math.cos(t)];
}

function showTexts(v) {
  ui.viewText.textContent = `${state.view + 1} of ${about.views.length}: zenith ${shown(v.theta)}, azimuth ${shown(v.phi)} degrees`;
  const delta = v.deltas[state.channel];
  ui.facts.textContent = `total W ${shown(v.totals[state.channel])}${delta > 0 ? `, of it ${shown(delta)} in a mirrored ray (not drawn)` : ''}; ` +
    `${cells.count} cells, values ${shown(cells.low)} (or less) to ${shown(cells.high)} 1/sr`;
  const context = ui.bar.getContext('2d');
  for (let x = 0; x < 280; ++x) {
    context.fillStyle = `rgb(${viridis(x / 279).map(Math.round).join(',')})`;
    context.fillRect(x, 0, 1, 12);
  }
  ui.barText.replaceChildren(make('span', {}, shown(cells.low)), make('span', {}, '1/sr, even steps of its logarithm'), make('span', {}, shown(cells.high)));
}

function choose(x, y) {
  const inside = points => {
    let odd = false;
    for (let a = 0, b = 3; a < 4; b = a++)
      if (points[a][1] > y !== points[b][1] > y && x < (points[b][0] - points[a][0]) * (y - points[a][1]) / (points[b][1] - points[a][1]) + points[a][0]) odd = !odd;
    return odd;
  };
  const hit = shapes.findLast(s => inside(s.points));
  state.chosen = hit ? hit.i : -1;
  state.cell = null;
  if (hit) {
    const middle = unit([0, 1, 2, 3].map(k => corner(hit.i, k)).reduce(add));
    state.cell = {value: cells.values[5 * hit.i + 4], mass: cells.masses[hit.i], order: cells.orders[hit.i],
      zenith: Math.acos(middle[2]) * 180 / Math.PI, azimuth: Math.atan2(middle[1], middle[0]) * 180 / Math.PI};
  }
  const c = state.cell;
  ui.picked.textContent = c ? `cell of order ${c.order}: ${shown(c.value)} 1/sr; a draw lands in it with ${shown(100 * c.mass, 3)} %; ` +
    `zenith ${shown(c.zenith)}, azimuth ${shown(c.azimuth)} degrees` : 'no cell there';
  draw();
}

// The cell of a direction, or -1; i begins the search with one that is likely.
function cellOf(c, d) {
  const at = (i, k) => [c.corners[12 * i + 3 * k], c.corners[12 * i + 3 * k + 1], c.corners[12 * i + 3 * k + 2]];
  for (let i = 0; i < c.orders.length; ++i) {
    let left = 0, right = 0;
    for (let k = 0; k < 4; ++k) dot(cross(at(i, k), at(i, (k + 1) % 4)), d) >= 0 ? ++left : ++right;
    if ((left === 4 || right === 4) && dot(at(i, 0), d) > 0) return i;
  }
  return -1;
}

// Values in the plane of the view, all channels over each other: zenith angles towards the mirror direction are negative, as in the plot and the table of sqt-inspect.
function profileOf(channel) {
  const id = `${about.views[state.view].number}.${channel}`, v = about.views[state.view], out = [];
  const c = {corners: new Int16Array(bytesOf(block('c' + id).text).buffer), values: numbersOf('v' + id), orders: numbersOf('o' + id)};
  for (let angle = -89; angle <= 89; angle += 2) {
    const t = radians(angle), p = radians(v.phi);
    const i = cellOf(c, [Math.sin(t) * Math.cos(p), Math.sin(t) * Math.sin(p), Math.cos(t)]);
    if (i >= 0 && c.values[5 * i + 4] > 0) out.push([angle, c.values[5 * i + 4]]);
  }
  return out;
}

const profiles = new Map();
function profilesOfView() {
  if (!profiles.has(state.view)) profiles.set(state.view, about.channels.map((_, c) => profileOf(c)));
  return profiles.get(state.view);
}

function drawProfile() {
  const all = profilesOfView(), values = all.flat().map(p => p[1]);
  const signature = JSON.stringify([state.view, state.channel, ui.profile.clientWidth]);
  if (ui.drawnProfile === signature) return;
  ui.drawnProfile = signature;
  ui.profile.textContent = '';
  if (!values.length) return;
  const p = {width: Math.min(760, Math.max(280, ui.profile.clientWidth || 420)), left: 62, right: 10, top: 10, bottom: 40};
  p.height = Math.round(Math.min(420, 0.75 * p.width));
  let low = Math.min(...values), high = Math.max(...values);
  low = Math.max(low, 1e-8 * high) / 1.3, high *= 1.3;
  const x = a => p.left + (a + 90) / 180 * (p.width - p.left - p.right);
  const y = v => p.top + Math.log(high / Math.max(v, low)) / Math.log(high / low) * (p.height - p.top - p.bottom);
  const tag = (name, attributes, text) => {
    const e = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const [k, v] of Object.entries(attributes)) e.setAttribute(k, v);
    if (text !== undefined) e.textContent = text;
    return e;
  };
  const plot = tag('svg', {viewBox: `0 0 ${p.width} ${p.height}`, width: p.width, height: p.height, 'font-size': 11, 'font-family': 'sans-serif', 'class': 'spectra'});
  plot.append(tag('rect', {x: p.left, y: p.top, width: p.width - p.left - p.right, height: p.height - p.top - p.bottom, fill: '#fafafa', stroke: '#999'}));
  for (let a = -90; a <= 90; a += 30) plot.append(tag('line', {x1: x(a), x2: x(a), y1: p.top, y2: p.height - p.bottom, stroke: '#ddd'}),
    tag('text', {x: x(a), y: p.height - p.bottom + 14, 'text-anchor': 'middle'}, a));
  const decades = logTicks(low, high), labelled = decades.length > 1 ? decades : tickLabels(low, high, 3);
  for (const t of labelled) plot.append(tag('line', {x1: p.left, x2: p.width - p.right, y1: y(t.at), y2: y(t.at), stroke: '#ddd'}),
    tag('text', {x: p.left - 5, y: y(t.at) + 4, 'text-anchor': 'end'}, t.text));
  plot.append(tag('text', {x: (p.left + p.width - p.right) / 2, y: p.height - 8, 'text-anchor': 'middle'}, 'zenith angle, degrees; towards the mirror: < 0'),
    tag('text', {transform: `translate(12 ${(p.top + p.height - p.bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle'}, 'value, 1/sr'));
  all.forEach((points, c) => plot.append(tag('polyline', {'class': 'channel', fill: 'none', stroke: channelColour(c), 'stroke-width': c === state.channel ? 2.5 : 1.2,
    points: points.map(([a, v]) => `${x(a).toFixed(1)},${y(v).toFixed(1)}`).join(' ')})));
  ui.profile.append(plot, make('div', {className: 'keys'}, ...about.channels.map((um, c) => make('label', {style: 'display:inline-block;margin-right:10px'},
    make('span', {className: 'box', style: `background:${channelColour(c)}`}), channelText(c)))));
}

function channelColour(c) {
  const n = about.channels.length;
  return `rgb(${viridis(n > 1 ? 0.9 * (n - 1 - c) / (n - 1) : 0.3).map(Math.round).join(',')})`;
}
function channelText(c) { return about.channels[c] > 0 ? `${shown(about.channels[c])} um` : `channel ${c + 1}`; }

function listen(canvas) {
  const fingers = new Map();
  let moved = 0;
  const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
  const nearer = by => { view.zoom = Math.min(200, Math.max(0.2, view.zoom * by)); };
  canvas.addEventListener('pointerdown', e => {
    if (!fingers.size) moved = 0;
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    canvas.setPointerCapture(e.pointerId);
  });
  canvas.addEventListener('pointermove', e => {
    const from = fingers.get(e.pointerId);
    if (!from) return;
    const dx = e.clientX - from[0], dy = e.clientY - from[1], before = fingers.size === 2 ? spread() : 0;
    moved += Math.abs(dx) + Math.abs(dy);
    fingers.set(e.pointerId, [e.clientX, e.clientY]);
    if (before) nearer(spread() / Math.max(1, before));
    else {
      view.azimuth = (view.azimuth + 0.4 * dx + 360) % 360;
      view.elevation = Math.min(89.9, Math.max(-89.9, view.elevation + 0.4 * dy));
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
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    nearer(Math.exp(-0.001 * e.deltaY));
    draw();
  }, {passive: false});
}

function resize() {
  const width = Math.max(240, ui.space.clientWidth - 2), tall = window.innerWidth < 1200 ? width : Infinity;
  ui.canvas.width = width, ui.canvas.height = Math.max(240, Math.min(tall, window.innerHeight - 110));
  draw();
}

function begin() {
  const box = (title, ...inside) => make('fieldset', {}, make('legend', {}, title), ...inside);
  const again = () => { load(); draw(); };
  ui.slider = make('input', {type: 'range', id: 'view', min: 0, max: about.views.length - 1, step: 1, value: 0, oninput: () => { state.view = Number(ui.slider.value); again(); }});
  ui.viewText = make('div', {id: 'viewText'});
  ui.channel = make('select', {id: 'channel', onchange: () => { state.channel = Number(ui.channel.value); again(); }});
  about.channels.forEach((_, c) => option(ui.channel, c, channelText(c)));
  ui.scale = make('select', {id: 'scale', onchange: () => { state.scale = ui.scale.value; draw(); }});
  for (const [key, text] of [['log', 'logarithm of the value'], ['root', 'its cube root'], ['linear', 'the value'], ['sphere', 'none: the sphere of directions']]) option(ui.scale, key, text);
  ui.edges = make('input', {type: 'checkbox', id: 'edges', checked: true, onchange: () => { state.edges = ui.edges.checked; draw(); }});
  ui.facts = make('div', {id: 'facts'});
  ui.picked = make('div', {id: 'picked'}, 'Drag turns, the wheel goes nearer, a click shows the value of a cell.');
  ui.bar = make('canvas', {width: 280, height: 12});
  ui.barText = make('div', {className: 'row', style: 'justify-content:space-between;flex-wrap:nowrap;font-size:12px', id: 'legend'});
  ui.lacks = make('div', {className: 'said', id: 'lacks'});
  ui.canvas = make('canvas', {id: 'picture'});
  ui.space = make('div', {className: 'space'}, ui.canvas);
  ui.profile = make('div', {id: 'profile'});
  document.getElementById('app').append(make('div', {className: 'panel'}, box('view direction', ui.slider, ui.viewText), box('shows', ui.channel,
    make('label', {}, 'distance from the middle', ui.scale), make('label', {}, ui.edges, ' borders of the cells'), ui.bar, ui.barText),
    box('slice', ui.facts), box('chosen', ui.picked), ui.lacks), make('div', {className: 'view'}, ui.space), make('div', {className: 'chart'}, ui.profile));
  state.view = Math.floor(about.views.length / 3);
  ui.slider.value = state.view;
  listen(ui.canvas);
  load();
  resize();
  window.addEventListener('resize', resize);
}

function ready() {
  const lost = JSON.parse(document.getElementById('end').textContent).lost;
  ui.lacks.textContent = `Method ${about.method}, cells of the ${about.frame} directions, ${about.leaves} leaves stored in all. Values here differ by at most ` +
    `${shown(100 * lost, 2)} %; between corners surfaces are straight.` + (about.step > 1 ? ` One in ${about.step} of the ${about.allViews} view directions is here.` : '') + `\n${about.made}`;
  window.readyAt = performance.now();
}
