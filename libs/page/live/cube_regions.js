// Regions of a picture: what their pixels have on average, and spectra and statistics as CSV.

// A rectangle's statistics in all bands; from, to: {column, row}, both inside.
function regionOf(from, to) {
  const one = image(), c0 = Math.min(from.column, to.column), c1 = Math.max(from.column, to.column);
  const r0 = Math.min(from.row, to.row), r1 = Math.max(from.row, to.row), bands = [];
  for (let b = 0; b < one.bands.length; ++b) {
    const values = numbersKept(`i${state.image}.v${b}`), errors = numbersKept(`i${state.image}.e${b}`);
    if (!values || !errors) return null;
    let n = 0, sum = 0, squares = 0, least = Infinity, most = -Infinity, errorSquares = 0;
    for (let r = r0; r <= r1; ++r)
      for (let c = c0; c <= c1; ++c) {
        const v = values[r * one.columns + c], e = errors[r * one.columns + c];
        if (!Number.isFinite(v)) continue;
        ++n, sum += v, least = Math.min(least, v), most = Math.max(most, v);
        if (Number.isFinite(e)) errorSquares += e * e;
      }
    const mean = sum / n;
    for (let r = r0; r <= r1; ++r)
      for (let c = c0; c <= c1; ++c) {
        const v = values[r * one.columns + c];
        if (Number.isFinite(v)) squares += (v - mean) ** 2;
      }
    bands.push({n, mean, deviation: n > 1 ? Math.sqrt(squares / (n - 1)) : NaN, least, most, error: Math.sqrt(errorSquares) / n});
  }
  const byLength = one.bands.every(b => b.um > 0);
  const points = bands.map((s, b) => ({x: byLength ? one.bands[b].um : b + 1, band: b, value: s.mean, error: s.error, half: s.deviation || 0}))
    .filter(p => Number.isFinite(p.value)).sort((a, b) => a.x - b.x);
  return {from: {column: c0, row: r0}, to: {column: c1, row: r1}, bands, colour: '#000', spectrum: {byLength, points}};
}

function setSelecting(on) {
  state.select = on;
  ui.select.style.background = on ? '#bde' : '';
  ui.canvas.style.touchAction = on ? 'none' : 'auto';
  ui.canvas.style.cursor = on ? 'crosshair' : '';
}

// A drag with the mouse is a region, as is one with a finger while that is switched on; what does not move is a click.
function listenRegion(canvas) {
  let from = null, at = null;
  canvas.addEventListener('pointerdown', e => {
    if (e.button || (e.pointerType === 'touch' && !state.select)) return;
    from = at = pixelAt(e);
    if (from) from = {...from, x: e.clientX, y: e.clientY};
    canvas.setPointerCapture(e.pointerId);
  });
  const far = e => Math.hypot(e.clientX - from.x, e.clientY - from.y) > 4;
  canvas.addEventListener('pointermove', e => {
    if (!from || !far(e)) return;
    at = pixelAt(e) || at;
    state.drawing = {from, to: at};
    drawRegion();
  });
  canvas.addEventListener('pointerup', e => {
    if (from && far(e)) {
      state.region = regionOf(from, pixelAt(e) || at);
      state.justDrawn = true;
      showPicks();
    }
    from = state.drawing = null;
    drawRegion();
  });
  canvas.addEventListener('pointercancel', () => {
    from = state.drawing = null;
    drawRegion();
  });
  canvas.addEventListener('click', e => {
    if (state.justDrawn) state.justDrawn = false;
    else pick(e);
  });
}

// The rectangle over the picture, in pixels of the screen whatever the zoom.
function drawRegion() {
  const region = state.drawing || state.region, style = ui.regionBox.style;
  ui.regionBox.hidden = !region;
  if (!region) return;
  style.left = Math.min(region.from.column, region.to.column) * state.zoom + 'px';
  style.top = Math.min(region.from.row, region.to.row) * state.zoom + 'px';
  style.width = (Math.abs(region.from.column - region.to.column) + 1) * state.zoom + 'px';
  style.height = (Math.abs(region.from.row - region.to.row) + 1) * state.zoom + 'px';
}

function showRegion() {
  ui.regionTable.textContent = '';
  const region = state.region, one = image();
  if (!region) return;
  const cell = (kind, text) => make(kind, {}, text), row = (kind, list) => make('tr', {}, ...list.map(t => cell(kind, t)));
  const f = p => `${p.column * one.step}, ${p.row * one.step}`;
  ui.regionTable.append(make('div', {className: 'said'}, `Region from column, row ${f(region.from)} to ${f(region.to)}${one.unit ? ', ' + one.unit : ''}; ` +
    'the last column is the standard error of the mean.'));
  const table = make('table', {}, row('th', ['band', 'pixels', 'mean', 'deviation', 'least', 'most', 'error']));
  region.bands.forEach((s, b) => table.append(row('td', [one.bands[b].name, String(s.n), shown(s.mean, 5), shown(s.deviation, 3), shown(s.least), shown(s.most), shown(s.error, 2)])));
  ui.regionTable.append(table);
}

const quoted = text => /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;

// Spectra of the chosen pixels and the statistics of the region, a band a row.
function exportCsv() {
  const one = image(), head = ['band', 'wavelength_um', 'fwhm_um'], unit = one.unit ? ` [${one.unit}]` : '';
  for (const p of state.picks) head.push(`column ${p.column * one.step} row ${p.row * one.step}${unit}`, 'standard error');
  const region = state.region;
  if (region) head.push('pixels', `mean${unit}`, 'standard deviation', 'least', 'most', 'standard error of the mean');
  const lines = [`# ${one.name}: ${one.quantity}${one.time ? ', ' + one.time : ''}`, `# ${about.made}`];
  for (const p of state.picks) {
    const enu = enuOf(state.image, p.index);
    if (enu) lines.push(`# column ${p.column * one.step} row ${p.row * one.step}: ${geodeticText(enu, one.origin)}`);
  }
  if (region) lines.push(`# region: columns ${region.from.column * one.step} to ${region.to.column * one.step}, rows ${region.from.row * one.step} to ${region.to.row * one.step}`);
  lines.push(head.map(quoted).join(','));
  one.bands.forEach((b, i) => {
    const cells = [quoted(b.name), b.um ?? '', b.fwhm ?? ''];
    for (const p of state.picks) {
      const q = p.spectrum.points.find(point => point.band === i) || {};
      cells.push(q.value ?? '', q.error ?? '');
    }
    if (region) { const s = region.bands[i]; cells.push(s.n, s.mean, s.deviation, s.least, s.most, s.error); }
    lines.push(cells.join(','));
  });
  save(`${one.name}.csv`, lines.join('\n') + '\n');
}
