// A folder of results: pictures of any band, spectra of pixels on a click, flags and truth over the picture.

const kHelp = 'Click on a pixel for its spectrum; with Shift beside the others. Drag over a region for its statistics.';

const state = {image: 0, band: 0, rgb: [0, 0, 0], mode: 'band', low: 1, high: 99, srgb: true, colours: false, each: false, kelvin: true,
  over: '', opacity: 0.6, flags: 255, zoom: 1, picks: [], region: null, select: false};
const ui = {};
const image = () => about.images[state.image];
const valuesOf = band => numbersKept(`i${state.image}.v${band}`);
// One band of a thermal picture is shown in kelvin, unless that is switched off.
const inKelvin = () => state.mode === 'band' && (image().unit === 'K' || (state.kelvin && isThermal(image(), state.band)));
const toKelvin = () => inKelvin() && image().unit !== 'K';

function buildStage() {
  ui.canvas = make('canvas', {id: 'picture', onpointermove: hover});
  ui.over = make('canvas', {className: 'over', id: 'overlay'});
  ui.marks = make('canvas', {className: 'over'});
  listenRegion(ui.canvas);
  ui.stage = make('div', {className: 'stage', onwheel: event => {
    if (!event.ctrlKey) return;
    event.preventDefault();
    zoomTo(state.zoom * (event.deltaY < 0 ? 1.25 : 0.8));
  }}, ui.canvas, ui.over, ui.marks, ui.regionBox = make('div', {className: 'region', hidden: true}));
  ui.readout = make('div', {className: 'said', id: 'readout'}, 'Point at a pixel for its values.');
  ui.map = make('div', {className: 'map', id: 'map'});
  ui.bar = make('canvas', {width: 420, height: 14, id: 'bar'});
  ui.barText = make('div', {className: 'row', id: 'legend'});
  ui.losses = make('div', {className: 'said', id: 'losses'}, 'reading ...');
  ui.view = make('div', {className: 'view'}, ui.stage, ui.map, make('div', {className: 'scale'}, ui.bar, ui.barText), ui.readout, ui.losses);
  return ui.view;
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
      make('button', {onclick: () => zoomTo(state.zoom / 1.5)}, '-'), make('button', {onclick: () => fit()}, 'fit'), ui.zoomText = make('span')), buildPlayer()),
    box('shows', ui.mode, ui.bandBox, ui.rgbBox),
    box('stretch', make('div', {className: 'row'}, number('low', 0, 100), 'to', number('high', 0, 100), 'per cent of the pixels'),
      check('srgb', 'as the eye sees (sRGB), else linear'), check('each', 'red, green and blue each by itself'), check('colours', 'one band in colours'), check('kelvin', 'thermal bands in kelvin')),
    box('over it', ui.over_, make('label', {}, 'how much of it', ui.opacity), ui.keys));
}

function buildSpectra() {
  ui.plot = make('div', {id: 'plot'});
  ui.table = make('div', {className: 'tables'});
  ui.regionTable = make('div', {className: 'tables', id: 'region'});
  const clear = make('button', {id: 'clear', onclick: () => { state.picks = []; state.region = null; showPicks(); }}, 'clear');
  ui.select = make('button', {id: 'select', onclick: () => setSelecting(!state.select)}, 'select a region');
  const csv = make('button', {id: 'csv', onclick: exportCsv}, 'save as CSV');
  return make('div', {className: 'chart'}, ui.plot, make('div', {className: 'row'}, ui.select, clear, csv), ui.regionTable, ui.table);
}

// Another image: what can be chosen of it. same: of the same kind as the one before (another frame), whose choices stay.
function choose(i, same = false) {
  const one = about.images[i], before = image();
  const shift = kept => kept.map(p => ({...p, spectrum: spectrumOf(one, i, p.index)}));
  state.image = i;
  ui.images.value = String(i);
  state.picks = same ? shift(state.picks) : [];
  if (!same) chooseAnew(one);
  state.region = same && state.region ? regionOf(state.region.from, state.region.to) : null;
  for (const canvas of [ui.canvas, ui.over, ui.marks])
    if (!same || canvas.width !== one.columns || canvas.height !== one.rows) canvas.width = one.columns, canvas.height = one.rows;
  if (!same || before.columns !== one.columns) fit();
  draw();
  drawOverlay();
  if (!same) showMap();
  if (ui.tell) ui.tell();
}

function chooseAnew(one) {
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
  state.colours = document.getElementById('colours').checked = inKelvin();
  document.getElementById('kelvin').parentElement.hidden = !one.bands.some((_, b) => isThermal(one, b));
  showPlayer();
}

function nameOf(band) { return band.um ? `${band.name} (${shown(band.um)} um)` : band.name; }

function fit() {
  const room = (ui.view && ui.view.clientWidth ? ui.view.clientWidth : 600) - 4;
  zoomTo(Math.min(room / image().columns, Math.max(240, 0.68 * window.innerHeight) / image().rows, 40));
}

function zoomTo(zoom) {
  const one = image();
  state.zoom = Math.min(Math.max(zoom, 0.05), 15000 / Math.max(one.columns, one.rows));
  for (const canvas of [ui.canvas, ui.over, ui.marks]) {
    canvas.style.width = one.columns * state.zoom + 'px';
    canvas.style.height = one.rows * state.zoom + 'px';
  }
  ui.zoomText.textContent = `x ${shown(state.zoom, 3)}`;
  showMap();
  drawRegion();
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
    const ranges = rangesShown() || (state.each ? lists.map(list => percentiles([list], state.low, state.high)) : Array(3).fill(commonRange(lists)));
    paintRgb(picture.data, lists, ranges, state.srgb);
    showLegend(ranges, bands);
  } else {
    const shownList = toKelvin() ? lists[0].map(v => kelvinOf(one, state.band, v)) : lists[0];
    const range = rangesShown() ? rangesShown()[0] : percentiles([shownList], state.low, state.high);
    paintScale(picture.data, shownList, range, scaleOf(state.colours, state.srgb && !inKelvin(), inKelvin()));
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
  const context = ui.bar.getContext('2d'), one = image(), single = ranges.length === 1, wide = ui.bar.width;
  ui.bar.height = single ? 14 : 36;
  for (let k = 0; k < ranges.length; ++k)
    for (let x = 0; x < wide; ++x) {
      const t = x / (wide - 1), v = encoded(t, state.srgb);
      const c = single ? scaleOf(state.colours, state.srgb && !inKelvin(), inKelvin())(t) : [0, 1, 2].map(i => i === k ? v : 0);
      context.fillStyle = `rgb(${c.map(Math.round).join(',')})`;
      context.fillRect(x, single ? 0 : 12 * k, 1, single ? 14 : 12);
    }
  const ranged = state.each && !single ? ranges : [ranges[0]];
  ui.barText.textContent = '';
  const span = text => ui.barText.append(make('span', {}, text));
  const ends = ([low, high]) => { const step = (high - low) / 200 || 1; return [tickText(low, step), tickText(high, step)]; };
  if (ranged.length === 1) {
    const [low, high] = ends(ranged[0]), what = toKelvin() ? 'brightness temperature at the band\'s middle, K' : `${one.quantity}${one.unit ? ', ' + one.unit : ''}`;
    span(low), span(what), span(high);
  } else span(ranged.map((range, k) => `${one.bands[bands[k]].name}: ${ends(range).join(' to ')}`).join('; ') + ' ' + one.unit);
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
  const values = bands.map(b => {
    const list = valuesOf(b);
    const kelvin = toKelvin() && list ? ` (${shown(kelvinOf(one, b, list[at.index]), 5)} K)` : '';
    return `${one.bands[b].name} ${list ? shown(list[at.index]) : '...'} +- ${shown(numberAt(`i${state.image}.e${b}`, at.index), 2)}${kelvin}`;
  });
  const place = placeText(at.index);
  ui.readout.textContent = `column ${at.column * one.step}, row ${at.row * one.step}: ${values.join(', ')} ${one.unit}${place ? '\n' + place : ''}`;
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
  drawRegion();
  ui.plot.textContent = ui.table.textContent = '';
  const drawn = [...state.picks, ...(state.region ? [state.region] : [])];
  showRegion();
  if (!drawn.length) {
    ui.plot.append(make('div', {className: 'said'}, kHelp));
    return;
  }
  for (const p of state.picks) {
    context.fillStyle = p.colour;
    context.fillRect(p.column, p.row, 1, 1);
  }
  ui.plot.append(plotSpectra(drawn, one, reach, ui.plot.clientWidth));
  ui.plot.append(make('div', {className: 'said'}, (one.reach ? `Bars: 95 %, ${shown(reach, 3)} standard errors to either side` : 'Bars: one standard error to either side') +
    (state.region ? '; of the region (black): one standard deviation of its pixels.' : '.')));
  if (state.picks.length) ui.table.append(tableOf(state.picks, one, state.image, state.mode === 'rgb' ? state.rgb[0] : state.band));
}

// The first picture is there before the rest of the file.
function begin() {
  const app = document.getElementById('app');
  app.append(buildPanel(), buildStage(), buildSpectra());
  window.addEventListener('resize', () => { fit(); showPicks(); });
  ui.about = make('div', {className: 'said'}, about.made);
  app.after(ui.about);
  choose(0);
  requestAnimationFrame(() => { window.pictureAt = performance.now(); });
}

function ready() {
  if (ui.waiting || framesOf(state.image).length > 1) draw();  // the stretch of all frames, which are here only now
  if (state.over) drawOverlay();
  showMap();
  const lost = JSON.parse(document.getElementById('lost').textContent);
  const tell = () => {
    const one = image(), l = lost[state.image];
    ui.losses.textContent = `${one.fullColumns} x ${one.fullRows} pixels, ${one.bands.length} ${one.bands.length === 1 ? 'band' : 'bands'}${one.time ? ', ' + one.time : ''}. ` +
      (one.step > 1 ? `Only one in ${one.step} columns and rows is here. ` : '') +
      `Numbers here differ from the files' by at most ${shown(100 * l.values, 2)} % (values of a millionth of a band's largest or less: ` +
      `by more), standard errors by ${shown(100 * l.errors, 2)} %; truth has seven digits.\n${one.about}`;
  };
  ui.tell = tell;
  tell();
  window.readyAt = performance.now();
}
