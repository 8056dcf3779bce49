// A folder of results: pictures of any band, spectra of pixels on a click, flags and truth over the picture.

const state = {image: 0, band: 0, rgb: [0, 0, 0], mode: 'band', low: 1, high: 99, srgb: true, colours: false, each: false,
  over: '', opacity: 0.6, flags: 255, zoom: 1, picks: []};
const ui = {};
const image = () => about.images[state.image];
const valuesOf = band => numbersKept(`i${state.image}.v${band}`);

function buildStage() {
  ui.canvas = make('canvas', {id: 'picture', onclick: pick, onmousemove: hover});
  ui.over = make('canvas', {className: 'over', id: 'overlay'});
  ui.marks = make('canvas', {className: 'over'});
  ui.stage = make('div', {className: 'stage', onwheel: event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomTo(state.zoom * (event.deltaY < 0 ? 1.25 : 0.8));
  }}, ui.canvas, ui.over, ui.marks);
  ui.readout = make('div', {className: 'said', id: 'readout'}, 'Click on a pixel for its spectrum; with Shift beside the others.');
  ui.bar = make('canvas', {width: 300, height: 14, id: 'bar'});
  ui.barText = make('div', {className: 'row', style: 'justify-content:space-between;width:300px;font-size:12px', id: 'legend'});
  ui.losses = make('div', {className: 'said', id: 'losses'}, 'reading ...');
  return make('div', {}, ui.stage, ui.bar, ui.barText, ui.readout, ui.losses);
}

function number(key, least, most) {
  return make('input', {type: 'number', id: key, value: String(state[key]), min: least, max: most, step: 0.5, onchange: event => {
    const v = Number(event.target.value);
    if (Number.isFinite(v)) state[key] = Math.min(most, Math.max(least, v));
    event.target.value = String(state[key]);
    draw();
  }});
}

function check(key, text) {
  return make('label', {}, make('input', {type: 'checkbox', id: key, checked: state[key], onchange: event => {
    state[key] = event.target.checked;
    draw();
  }}), ' ' + text);
}

function buildPanel() {
  ui.images = make('select', {id: 'images', onchange: () => choose(Number(ui.images.value))});
  about.images.forEach((one, i) => option(ui.images, i, one.name));
  ui.mode = make('select', {id: 'mode', onchange: () => { state.mode = ui.mode.value; draw(); }});
  option(ui.mode, 'band', 'one band');
  option(ui.mode, 'rgb', 'red, green, blue');
  ui.slider = make('input', {type: 'range', id: 'band', min: 0, step: 1, oninput: () => {
    state.band = Number(ui.slider.value);
    state.mode = ui.mode.value = 'band';
    draw();
  }});
  ui.bandName = make('div', {id: 'bandName'});
  ui.rgb = [0, 1, 2].map(k => make('select', {id: 'rgb' + k, onchange: event => { state.rgb[k] = Number(event.target.value); draw(); }}));
  ui.bandBox = make('div', {}, ui.slider, ui.bandName);
  ui.rgbBox = make('div', {}, ...ui.rgb);
  ui.over_ = make('select', {id: 'over', onchange: () => { state.over = ui.over_.value; drawOverlay(); }});
  ui.opacity = make('input', {type: 'range', id: 'opacity', min: 0, max: 1, step: 0.05, value: state.opacity, oninput: () => {
    state.opacity = Number(ui.opacity.value);
    ui.over.style.opacity = state.opacity;
  }});
  ui.keys = make('div', {className: 'keys', id: 'keys'});
  const box = (title, ...inside) => make('fieldset', {}, make('legend', {}, title), ...inside);
  return make('div', {className: 'panel'},
    box('image', ui.images, make('div', {className: 'row'}, make('button', {id: 'closer', onclick: () => zoomTo(state.zoom * 1.5)}, '+'),
      make('button', {onclick: () => zoomTo(state.zoom / 1.5)}, '-'), make('button', {onclick: () => fit()}, 'fit'), ui.zoomText = make('span'))),
    box('shows', ui.mode, ui.bandBox, ui.rgbBox),
    box('stretch', make('div', {className: 'row'}, number('low', 0, 100), 'to', number('high', 0, 100), 'per cent of the pixels'),
      check('srgb', 'as the eye sees (sRGB), else linear'), check('each', 'red, green and blue each by itself'), check('colours', 'one band in colours')),
    box('over it', ui.over_, make('label', {}, 'how much of it', ui.opacity), ui.keys));
}

function buildSpectra() {
  ui.plot = make('div', {id: 'plot'});
  ui.table = make('div', {});
  const clear = make('button', {id: 'clear', onclick: () => { state.picks = []; showPicks(); }}, 'clear');
  return make('div', {}, ui.plot, ui.table, clear);
}

// Another image: what can be chosen of it.
function choose(i) {
  state.image = i;
  state.picks = [];
  const one = image();
  const three = one.shown.length === 3;
  state.band = one.shown.length ? one.shown[0] : 0;
  state.rgb = three ? [...one.shown] : [0, 1, 2].map(k => Math.min(k, one.bands.length - 1));
  state.mode = ui.mode.value = three ? 'rgb' : 'band';
  ui.slider.max = one.bands.length - 1;
  ui.rgb.forEach((select, k) => {
    select.textContent = '';
    one.bands.forEach((b, n) => option(select, n, nameOf(b)));
    select.value = String(state.rgb[k]);
  });
  state.over = '';
  ui.over_.textContent = '';
  option(ui.over_, '', 'nothing');
  option(ui.over_, 'q', 'flags');
  one.truth.forEach((t, n) => option(ui.over_, 't' + n, `truth: ${t.name}${t.unit ? ' [' + t.unit + ']' : ''}`));
  for (const canvas of [ui.canvas, ui.over, ui.marks]) canvas.width = one.columns, canvas.height = one.rows;
  fit();
  draw();
  drawOverlay();
  showPicks();
}

function nameOf(band) { return band.um ? `${band.name} (${shown(band.um)} um)` : band.name; }

function fit() { zoomTo(Math.min(600 / image().columns, 600 / image().rows, 40)); }

function zoomTo(zoom) {
  const one = image();
  state.zoom = Math.min(Math.max(zoom, 0.05), 15000 / Math.max(one.columns, one.rows));
  for (const canvas of [ui.canvas, ui.over, ui.marks]) {
    canvas.style.width = one.columns * state.zoom + 'px';
    canvas.style.height = one.rows * state.zoom + 'px';
  }
  ui.zoomText.textContent = `x ${shown(state.zoom, 3)}`;
}

function draw() {
  const one = image(), rgb = state.mode === 'rgb', bands = rgb ? state.rgb : [state.band];
  ui.bandBox.hidden = rgb, ui.rgbBox.hidden = !rgb;
  ui.slider.value = state.band;
  const b = one.bands[state.band];
  ui.bandName.textContent = `${state.band + 1} of ${one.bands.length}: ${nameOf(b)}${b.fwhm ? `, ${shown(b.fwhm)} um wide` : ''}`;
  const lists = bands.map(valuesOf);
  if (lists.some(list => !list)) { ui.waiting = true; return; }
  ui.waiting = false;
  const context = ui.canvas.getContext('2d'), picture = context.createImageData(one.columns, one.rows);
  if (rgb) {
    const ranges = state.each ? lists.map(list => percentiles([list], state.low, state.high)) : Array(3).fill(commonRange(lists));
    paintRgb(picture.data, lists, ranges, state.srgb);
    showLegend(ranges, bands);
  } else {
    const range = percentiles(lists, state.low, state.high);
    paintScale(picture.data, lists[0], range, scaleOf(state.colours, state.srgb));
    showLegend([range], bands);
  }
  context.putImageData(picture, 0, 0);
  showPicks();
}

// One range for three bands: from each pixel's darkest to its brightest, as the preview of the renderer has it.
function commonRange(lists) {
  const n = lists[0].length, darkest = new Float32Array(n), brightest = new Float32Array(n);
  for (let i = 0; i < n; ++i) {
    const a = lists[0][i], b = lists[1][i], c = lists[2][i];
    darkest[i] = Math.min(a, b, c), brightest[i] = Math.max(a, b, c);
  }
  return [percentiles([darkest], state.low, state.high)[0], percentiles([brightest], state.low, state.high)[1]];
}

function showLegend(ranges, bands) {
  const context = ui.bar.getContext('2d'), one = image(), single = ranges.length === 1;
  ui.bar.height = single ? 14 : 36;
  for (let k = 0; k < ranges.length; ++k)
    for (let x = 0; x < 300; ++x) {
      const t = x / 299, v = encoded(t, state.srgb);
      const c = single ? scaleOf(state.colours, state.srgb)(t) : [0, 1, 2].map(i => i === k ? v : 0);
      context.fillStyle = `rgb(${c.map(Math.round).join(',')})`;
      context.fillRect(x, single ? 0 : 12 * k, 1, single ? 14 : 12);
    }
  const told = state.each && !single ? ranges : [ranges[0]];
  ui.barText.textContent = '';
  const span = text => ui.barText.append(make('span', {}, text));
  if (told.length === 1) {
    const [low, high] = told[0];
    span(shown(low)), span(`${one.quantity}${one.unit ? ', ' + one.unit : ''}`), span(shown(high));
  } else span(told.map(([low, high], k) => `${one.bands[bands[k]].name}: ${shown(low)} to ${shown(high)}`).join('; ') + ' ' + one.unit);
}

function key(colour, text, extra) {
  ui.keys.append(make('label', {}, ...(extra ? [extra] : []), make('span', {className: 'box', style: `background:${colour}`}), text));
}

function drawOverlay() {
  const one = image(), context = ui.over.getContext('2d');
  ui.keys.textContent = '';
  ui.over.style.opacity = state.opacity;
  context.clearRect(0, 0, one.columns, one.rows);
  if (!state.over) return;
  const list = numbersKept(`i${state.image}.${state.over}`);
  if (!list) { ui.keys.textContent = 'reading ...'; return; }
  const picture = context.createImageData(one.columns, one.rows);
  if (state.over === 'q') overlayFlags(picture.data, list);
  else overlayTruth(picture.data, list, one.truth[Number(state.over.slice(1))]);
  context.putImageData(picture, 0, 0);
}

function overlayFlags(pixels, bits) {
  about.flags.forEach((flag, f) => {
    let count = 0;
    for (const b of bits) if (b & flag.bit) ++count;
    const box = make('input', {type: 'checkbox', checked: !!(state.flags & flag.bit), onchange: () => { state.flags ^= flag.bit; drawOverlay(); }});
    key(kFlagColours[f % 8], `${flag.name}: ${count} of ${bits.length} pixels; ${flag.meaning}`, box);
  });
  const colours = about.flags.map((_, f) => rgbOf(kFlagColours[f % 8]));
  for (let i = 0; i < bits.length; ++i) {
    const held = about.flags.flatMap((flag, f) => bits[i] & flag.bit & state.flags ? [f] : []);
    if (!held.length) continue;
    for (let k = 0; k < 3; ++k) pixels[4 * i + k] = held.reduce((sum, f) => sum + colours[f][k], 0) / held.length;
    pixels[4 * i + 3] = 255;
  }
}

function overlayTruth(pixels, list, truth) {
  const whole = truth.classes || ['material', 'instance', 'tag', 'primitive'].includes(truth.name);
  if (!whole) {
    const range = percentiles([list], 0, 100);
    paintScale(pixels, list, range, viridis);
    for (let i = 0; i <= 4; ++i)
      key(`rgb(${viridis(i / 4).map(Math.round).join(',')})`, `${shown(range[0] + (range[1] - range[0]) * i / 4, 6)} ${truth.unit}`);
    return;
  }
  const counts = new Map();
  for (const v of list) if (!Number.isNaN(v)) counts.set(v, (counts.get(v) || 0) + 1);
  const colourOf = v => truth.classes && truth.classes[v] ? rgbOf(truth.classes[v].colour) : classColour(v);
  for (let i = 0; i < list.length; ++i) {
    if (Number.isNaN(list[i])) continue;
    const c = colourOf(list[i]);
    pixels[4 * i] = c[0], pixels[4 * i + 1] = c[1], pixels[4 * i + 2] = c[2], pixels[4 * i + 3] = 255;
  }
  const sorted = [...counts].sort((a, b) => b[1] - a[1]);
  for (const [v, count] of sorted.slice(0, 200))
    key(`rgb(${colourOf(v).map(Math.round).join(',')})`, `${truth.classes && truth.classes[v] ? truth.classes[v].name : shown(v, 8)} (${count})`);
  if (sorted.length > 200) ui.keys.append(`and ${sorted.length - 200} more`);
}

function pixelAt(event) {
  const box = ui.canvas.getBoundingClientRect(), one = image();
  const column = Math.floor((event.clientX - box.left) / box.width * one.columns), row = Math.floor((event.clientY - box.top) / box.height * one.rows);
  return column >= 0 && row >= 0 && column < one.columns && row < one.rows ? {column, row, index: row * one.columns + column} : null;
}

function hover(event) {
  const at = pixelAt(event), one = image();
  if (!at) return;
  const bands = state.mode === 'rgb' ? state.rgb : [state.band];
  const told = bands.map(b => {
    const list = valuesOf(b);
    return `${one.bands[b].name} ${list ? shown(list[at.index]) : '...'} +- ${shown(numberAt(`i${state.image}.e${b}`, at.index), 2)}`;
  });
  ui.readout.textContent = `column ${at.column * one.step}, row ${at.row * one.step}: ${told.join(', ')} ${one.unit}`;
}

function pick(event) {
  const at = pixelAt(event);
  if (!at) return;
  if (!event.shiftKey) state.picks = [];
  if (state.picks.length >= kSpectrumColours.length) state.picks.shift();
  const used = state.picks.map(p => p.colour);
  state.picks.push({...at, colour: kSpectrumColours.find(c => !used.includes(c)), spectrum: spectrumOf(image(), state.image, at.index)});
  showPicks();
}

function showPicks() {
  const one = image(), context = ui.marks.getContext('2d'), reach = one.reach || 1;
  context.clearRect(0, 0, one.columns, one.rows);
  ui.plot.textContent = ui.table.textContent = '';
  if (!state.picks.length) return;
  for (const p of state.picks) {
    context.fillStyle = p.colour;
    context.fillRect(p.column, p.row, 1, 1);
  }
  ui.plot.append(plotSpectra(state.picks, one, reach));
  ui.plot.append(make('div', {className: 'said'}, one.reach ? `Bars: 95 %, ${shown(reach, 3)} standard errors to either side.` : 'Bars: one standard error to either side.'));
  ui.table.append(tableOf(state.picks, one, state.image, state.mode === 'rgb' ? state.rgb[0] : state.band));
}

// The first picture is there before the rest of the file.
function begin() {
  const app = document.getElementById('app');
  app.append(buildPanel(), buildStage(), buildSpectra());
  ui.about = make('div', {className: 'said'}, about.made);
  app.after(ui.about);
  choose(0);
  requestAnimationFrame(() => { window.pictureAt = performance.now(); });
}

function ready() {
  if (ui.waiting) draw();
  if (state.over) drawOverlay();
  const lost = JSON.parse(document.getElementById('lost').textContent);
  const tell = () => {
    const one = image(), l = lost[state.image];
    ui.losses.textContent = `${one.fullColumns} x ${one.fullRows} pixels, ${one.bands.length} bands${one.time ? ', ' + one.time : ''}. ` +
      (one.step > 1 ? `Only every ${one.step}-th column and row is here. ` : '') +
      `Numbers here differ from the files' by at most ${shown(100 * l.values, 2)} % (values of a millionth of a band's largest or less: ` +
      `by more), standard errors by ${shown(100 * l.errors, 2)} %; truth has seven digits.\n${one.about}`;
  };
  ui.images.addEventListener('change', tell);
  tell();
  window.readyAt = performance.now();
}
