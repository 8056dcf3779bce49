// Where pixels are: longitude and latitude under the pointer, an arrow to the north, a bar of scale. From the truth
// `location`, or the map that the picture is.

function columnsOf(number, names) {
  const truth = about.images[number].truth;
  const at = names.map(n => truth.findIndex(t => t.name === n && t.unit === 'm'));
  return at.every(i => i >= 0) ? at : null;
}

// East, north and up of a pixel, m; null where nothing is known.
function enuOf(number, index) {
  const one = about.images[number], at = columnsOf(number, ['east', 'north', 'up']);
  const enu = at ? at.map(t => numberAt(`i${number}.t${t}`, index))
    : one.map ? [one.map.west + (index % one.columns + 0.5) * one.step * one.map.dx, one.map.north - (Math.floor(index / one.columns) + 0.5) * one.step * one.map.dy, 0] : null;
  return enu && enu.every(Number.isFinite) ? enu : null;
}

function placeText(index) {
  const enu = enuOf(state.image, index), one = image();
  return enu ? geodeticText(enu, one.origin) : '';
}

// How places change along the columns and rows in the middle of the picture: [[de/dc, de/dr], [dn/dc, dn/dr]].
function slopesOf(number) {
  const one = about.images[number];
  if (one.map) return {j: [[one.map.dx * one.step, 0], [0, -one.map.dy * one.step]], determinant: -one.map.dx * one.map.dy * one.step ** 2};
  const at = (c, r) => c >= 0 && r >= 0 && c < one.columns && r < one.rows ? enuOf(number, r * one.columns + c) : null;
  // Medians over the middle of the picture: roofs and walls there are no slope of the ground.
  const all = [];
  for (const k of [Math.max(1, Math.round(Math.min(one.columns, one.rows) / 24)), 1])
    for (let y = 1; y <= 9 && all.length < 81; ++y)
      for (let x = 1; x <= 9; ++x) {
        const c = Math.round((0.2 + 0.06 * x) * one.columns), r = Math.round((0.2 + 0.06 * y) * one.rows);
        const [a, b, d, e] = [at(c - k, r), at(c + k, r), at(c, r - k), at(c, r + k)];
        if (a && b && d && e) all.push([(b[0] - a[0]) / (2 * k), (e[0] - d[0]) / (2 * k), (b[1] - a[1]) / (2 * k), (e[1] - d[1]) / (2 * k)]);
      }
  if (!all.length) return null;
  const [ec, er, nc, nr] = [0, 1, 2, 3].map(i => all.map(j => j[i]).sort((p, q) => p - q)[all.length >> 1]);
  const determinant = ec * nr - er * nc;
  return Math.abs(determinant) > 1e-4 * (ec * ec + er * er + nc * nc + nr * nr) ? {j: [[ec, er], [nc, nr]], determinant} : null;
}

function showMap() {
  if (!ui.map) return;
  ui.map.textContent = '';
  const slopes = slopesOf(state.image), one = image();
  if (!slopes) return;
  const {j, determinant} = slopes;
  const dc = -j[0][1] / determinant, dr = j[0][0] / determinant;  // of a step to the north
  const metres = Math.hypot(j[0][0], j[1][0]) / state.zoom;       // a pixel of the screen, to the right
  const length = roundBelow(metres * Math.min(160, Math.max(60, 0.3 * one.columns * state.zoom)));
  ui.map.append(northArrow(Math.atan2(dc, -dr) * 180 / Math.PI),
    make('span', {}, make('div', {className: 'bar', id: 'scalebar', style: `width:${length / metres}px`}), lengthText(length)),
    make('span', {className: 'said'}, one.map ? '' : 'in the middle of the picture, to the right'));
}
