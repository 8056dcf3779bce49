// Spectra of chosen pixels: a plot with error bars, and a table.

const kPlot = {width: 520, height: 340, left: 74, right: 14, top: 12, bottom: 44};

function svg(tag, attributes, text) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  if (text !== undefined) element.textContent = text;
  return element;
}

// Values and standard errors of a pixel in all bands that are there; x in micron where all bands have a wavelength.
function spectrumOf(image, number, index) {
  const byLength = image.bands.every(b => b.um > 0);
  const points = image.bands.map((band, b) => ({
    x: byLength ? band.um : b + 1, band: b, value: numberAt(`i${number}.v${b}`, index), error: numberAt(`i${number}.e${b}`, index),
  }));
  return {byLength, points: points.filter(p => Number.isFinite(p.value)).sort((a, b) => a.x - b.x)};
}

function frame(plot, x, y, xLabel, yLabel) {
  const p = kPlot, bottom = p.height - p.bottom, right = p.width - p.right;
  plot.append(svg('rect', {x: p.left, y: p.top, width: right - p.left, height: bottom - p.top, fill: '#fafafa', stroke: '#999'}));
  for (const t of tickLabels(x.low, x.high, Math.max(2, Math.round((right - p.left) / 80)))) {
    plot.append(svg('line', {x1: x.at(t.at), x2: x.at(t.at), y1: p.top, y2: bottom, stroke: '#ddd'}));
    plot.append(svg('text', {x: x.at(t.at), y: bottom + 15, 'text-anchor': 'middle'}, t.text));
  }
  for (const t of tickLabels(y.low, y.high)) {
    plot.append(svg('line', {x1: p.left, x2: right, y1: y.at(t.at), y2: y.at(t.at), stroke: '#ddd'}));
    plot.append(svg('text', {x: p.left - 5, y: y.at(t.at) + 4, 'text-anchor': 'end'}, t.text));
  }
  plot.append(svg('text', {x: (p.left + right) / 2, y: p.height - 8, 'text-anchor': 'middle'}, xLabel));
  plot.append(svg('text', {transform: `translate(14 ${(p.top + bottom) / 2}) rotate(-90)`, 'text-anchor': 'middle'}, yLabel));
}

function axis(low, high, from, to) {
  if (!(high > low)) { const room = Math.abs(low) * 0.1 || 1; low -= room; high += room; }
  return {low, high, at: v => from + (v - low) / (high - low) * (to - from)};
}

// picks: [{spectrum, colour}]; reach: standard errors that bars reach to either side; width: of the page's room.
function plotSpectra(picks, image, reach, width) {
  const p = kPlot;
  p.width = Math.min(760, Math.max(280, width || 520)), p.height = Math.round(Math.min(400, Math.max(240, 0.62 * p.width)));
  const plot = svg('svg', {viewBox: `0 0 ${p.width} ${p.height}`, width: p.width, height: p.height,
    'font-size': 11, 'font-family': 'sans-serif', 'class': 'spectra'});
  const points = picks.flatMap(pick => pick.spectrum.points), bar = q => q.half !== undefined ? q.half : reach * (Number.isFinite(q.error) ? q.error : 0);
  if (!points.length) return plot;
  const least = Math.min(...points.map(q => q.value - bar(q))), most = Math.max(...points.map(q => q.value + bar(q)));
  const room = 0.05 * (most - least);
  const x = axis(Math.min(...points.map(q => q.x)), Math.max(...points.map(q => q.x)), p.left, p.width - p.right);
  const y = axis(least - room, most + room, p.height - p.bottom, p.top);
  frame(plot, x, y, picks[0].spectrum.byLength ? 'wavelength, um' : 'band', `${image.quantity}${image.unit ? ', ' + image.unit : ''}`);
  const dots = picks[0].spectrum.points.length < 60;
  for (const pick of picks) {
    const group = svg('g', {stroke: pick.colour, fill: 'none', 'class': 'spectrum'});
    group.append(svg('path', {'class': 'bars', 'stroke-width': 1, 'stroke-opacity': 0.6, d: pick.spectrum.points.map(q =>
      `M${x.at(q.x).toFixed(2)} ${y.at(q.value - bar(q)).toFixed(2)}V${y.at(q.value + bar(q)).toFixed(2)}`).join('')}));
    group.append(svg('polyline', {'stroke-width': 1.5, points: pick.spectrum.points.map(q =>
      `${x.at(q.x).toFixed(2)},${y.at(q.value).toFixed(2)}`).join(' ')}));
    if (dots) for (const q of pick.spectrum.points)
      group.append(svg('circle', {cx: x.at(q.x), cy: y.at(q.value), r: 2.2, fill: pick.colour}));
    plot.append(group);
  }
  return plot;
}

// What is known of the chosen pixels, one column each.
function tableOf(picks, image, number, band) {
  const head = make('tr', {}, make('th', {}, 'column, row'));
  for (const pick of picks) head.append(make('th', {style: `color:${pick.colour}`}, `${pick.column * image.step}, ${pick.row * image.step}`));
  const table = make('table', {id: 'table'}, head);
  const row = (name, text) => table.append(make('tr', {}, make('td', {}, name), ...picks.map(k => make('td', {}, text(k)))));
  const of = pick => pick.spectrum.points.find(q => q.band === band) || {value: NaN, error: NaN};
  row(`${image.bands[band].name}${image.unit ? ', ' + image.unit : ''}`, k => shown(of(k).value));
  row('standard error', k => shown(of(k).error, 2));
  const bits = numbersKept(`i${number}.q`);
  row('flags', k => !bits ? '' : about.flags.filter(f => bits[k.index] & f.bit).map(f => f.name).join(', ') || 'none');
  image.truth.slice(0, 40).forEach((t, i) => row(`${t.name}${t.unit ? ', ' + t.unit : ''}`, k => {
    const v = numberAt(`i${number}.t${i}`, k.index);
    return t.classes && t.classes[v] ? t.classes[v].name : shown(t.unit === 'm' && Math.abs(v) < 1e-9 ? 0 : v, 7);
  }));
  if (image.truth.length > 40) row(`and ${image.truth.length - 40} more of the truth`, () => '');
  return table;
}
