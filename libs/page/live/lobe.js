// Lobes of a fitted scattering function: patches of its cells, as far out as its value, for one view direction at a time.

const view = {azimuth: 215, elevation: 30, zoom: 1};
const state = {view: 0, channel: 0, scale: 'root', edges: true, chosen: -1};
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
  return Math.max(0.02, Math.log(v / cells.low) / Math.log(cells.high / cells.low || 2));
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
  ui.told.textContent = c ? `cell of order ${c.order}: ${shown(c.value)} 1/sr; a draw lands in it with ${shown(100 * c.mass, 3)} %; ` +
    `zenith ${shown(c.zenith)}, azimuth ${shown(c.azimuth)} degrees` : 'no cell there';
  draw();
}

function listen(canvas) {
  let from = null, moved = 0;
  canvas.addEventListener('mousedown', e => { from = [e.clientX, e.clientY]; moved = 0; e.preventDefault(); });
  window.addEventListener('mousemove', e => {
    if (!from) return;
    const dx = e.clientX - from[0], dy = e.clientY - from[1];
    moved += Math.abs(dx) + Math.abs(dy);
    from = [e.clientX, e.clientY];
    view.azimuth = (view.azimuth + 0.4 * dx + 360) % 360;
    view.elevation = Math.min(89.9, Math.max(-89.9, view.elevation + 0.4 * dy));
    draw();
  });
  window.addEventListener('mouseup', e => {
    const box = canvas.getBoundingClientRect();
    if (from && moved < 4 && e.target === canvas) choose(e.clientX - box.left, e.clientY - box.top);
    from = null;
  });
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    view.zoom = Math.min(200, Math.max(0.2, view.zoom * Math.exp(-0.001 * e.deltaY)));
    draw();
  }, {passive: false});
}

function begin() {
  const box = (title, ...inside) => make('fieldset', {}, make('legend', {}, title), ...inside);
  const again = () => { load(); draw(); };
  ui.slider = make('input', {type: 'range', id: 'view', min: 0, max: about.views.length - 1, step: 1, value: 0, oninput: () => { state.view = Number(ui.slider.value); again(); }});
  ui.viewText = make('div', {id: 'viewText'});
  ui.channel = make('select', {id: 'channel', onchange: () => { state.channel = Number(ui.channel.value); again(); }});
  about.channels.forEach((um, c) => option(ui.channel, c, `${shown(um)} um`));
  ui.scale = make('select', {id: 'scale', onchange: () => { state.scale = ui.scale.value; draw(); }});
  for (const [key, text] of [['root', 'cube root of the value'], ['linear', 'the value'], ['log', 'its logarithm'], ['sphere', 'none: the sphere of directions']]) option(ui.scale, key, text);
  ui.edges = make('input', {type: 'checkbox', id: 'edges', checked: true, onchange: () => { state.edges = ui.edges.checked; draw(); }});
  ui.facts = make('div', {id: 'facts'});
  ui.told = make('div', {id: 'told'}, 'Drag turns, the wheel goes nearer, a click tells of a cell.');
  ui.bar = make('canvas', {width: 280, height: 12});
  ui.barText = make('div', {className: 'row', style: 'justify-content:space-between;font-size:12px', id: 'legend'});
  ui.lacks = make('div', {className: 'said', id: 'lacks'});
  ui.canvas = make('canvas', {id: 'picture', width: Math.max(400, Math.min(window.innerWidth - 360, 1200)), height: Math.max(400, window.innerHeight - 90)});
  document.getElementById('app').append(make('div', {className: 'panel'}, box('view direction', ui.slider, ui.viewText), box('shows', ui.channel,
    make('label', {}, 'distance from the middle', ui.scale), make('label', {}, ui.edges, ' borders of the cells'), ui.bar, ui.barText),
    box('slice', ui.facts), box('chosen', ui.told), ui.lacks), make('div', {className: 'space'}, ui.canvas));
  state.view = Math.floor(about.views.length / 3);
  ui.slider.value = state.view;
  listen(ui.canvas);
  load();
  draw();
}

function ready() {
  const lost = JSON.parse(document.getElementById('end').textContent).lost;
  ui.lacks.textContent = `Method ${about.method}, cells of the ${about.frame} directions, ${about.leaves} leaves stored in all. Values here differ by at most ` +
    `${shown(100 * lost, 2)} %; between corners surfaces are straight.` + (about.step > 1 ? ` Every ${about.step}-th of ${about.allViews} view directions is here.` : '') + `\n${about.made}`;
  window.readyAt = performance.now();
}
