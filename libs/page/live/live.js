'use strict';
// What all live pages share: the blocks of the file as numbers, and elements.

const about = JSON.parse(document.getElementById('about').textContent);

// A block of the file, or null while the browser has not come to it.
function block(id) {
  const element = document.getElementById(id);
  return element && {
    text: element.firstChild ? element.firstChild.data : '', kind: element.dataset.kind,
    first: Number(element.dataset.first), second: Number(element.dataset.second),
    count: Number(element.dataset.count || 0), base: element.dataset.base,  // of codes in steps alone (steps.js)
  };
}

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// All binary16 numbers, by their bits.
let halves = null;
function halfTable() {
  if (halves) return halves;
  halves = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = bits >> 10 & 31, mantissa = bits & 1023;
    const size = exponent === 31 ? (mantissa ? NaN : Infinity)
      : exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24;
    halves[bits] = bits & 0x8000 ? -size : size;
  }
  return halves;
}

const kBytes = {half: 2, log8: 1, u8: 1, u32: 4, f32: 4};

function unpacked(bytes, kind, first, second) {
  if (kind === 'u8') return bytes;
  if (kind === 'u32') return new Uint32Array(bytes.buffer, 0, bytes.length >> 2);
  if (kind === 'f32') return new Float32Array(bytes.buffer, 0, bytes.length >> 2);
  return ofCodes(kind === 'half' ? new Uint16Array(bytes.buffer, 0, bytes.length >> 1) : bytes, kind, first, second);
}

// Numbers of codes: bits of binary16, or steps of the logarithm.
function ofCodes(codes, kind, first, second) {
  const out = new Float32Array(codes.length), half = kind === 'half', scale = half ? 2 ** first : 1;
  const table = half ? halfTable() : Float32Array.from({length: 256}, (_, c) => c === 0 ? NaN : c === 1 ? 0 : first * second ** (c - 2));
  for (let i = 0; i < codes.length; ++i) out[i] = table[codes[i]] * scale;
  return out;
}

// All numbers of a block; null while it is not there.
function numbersOf(id) {
  const b = block(id);
  if (b && b.count) return numbersOfSteps(id, b);
  return b && unpacked(bytesOf(b.text), b.kind, b.first, b.second);
}

// One number of a block, without decoding the others.
function numberAt(id, index) {
  const b = block(id);
  if (!b) return NaN;
  if (b.count) return numberOfSteps(id, b, index);
  const size = kBytes[b.kind], from = index * size, group = Math.floor(from / 3);
  const bytes = bytesOf(b.text.slice(4 * group, 4 * (Math.floor((from + size - 1) / 3) + 1)));
  return unpacked(bytes.slice(from - 3 * group, from - 3 * group + size), b.kind, b.first, b.second)[0];
}

// An element with attributes (on...: listeners) and children.
function make(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith('on')) element.addEventListener(key.slice(2), value);
    else if (key in element && key !== 'list') element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children);
  return element;
}

function option(select, value, text) { select.append(make('option', {value: String(value)}, text)); }

// A number for people.
function shown(x, digits = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return '-';
  if (!Number.isFinite(x)) return String(x);
  return Number(x.toPrecision(digits)).toString();
}

// Round steps over a range.
function ticks(low, high, count = 5) {
  const raw = (high - low) / count, unit = 10 ** Math.floor(Math.log10(raw)), part = raw / unit;
  const step = unit * (part < 1.5 ? 1 : part < 3.5 ? 2 : part < 7.5 ? 5 : 10), out = [];
  for (let v = Math.ceil(low / step) * step; v <= high + 1e-9 * step; v += step) out.push(Math.abs(v) < 1e-9 * step ? 0 : v);
  return out;
}

// A tick in as many digits as tell it from its neighbours, `step` away.
function tickText(v, step) {
  if (v === 0) return '0';
  const size = Math.abs(v);
  if (size >= 1e6 || size < 1e-4) return shown(v, Math.min(15, Math.max(1, Math.floor(Math.log10(size)) - Math.floor(Math.log10(step)) + 1)));
  return v.toFixed(Math.min(15, Math.max(0, -Math.floor(Math.log10(step) + 1e-9))));
}

// Labels of an axis or a bar: round places with their texts.
function tickLabels(low, high, count = 5) {
  const at = ticks(low, high, count), step = at.length > 1 ? at[1] - at[0] : high - low || 1;
  return at.map(v => ({at: v, text: tickText(v, step)}));
}

// Round decades, and 2 and 5 of them where there are few.
function logTicks(low, high) {
  const out = [], decades = Math.log10(high / low);
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
    for (const m of decades < 2.5 ? [1, 2, 5] : [1]) {
      const v = Number(`${m}e${e}`);
      if (v >= low * (1 - 1e-9) && v <= high * (1 + 1e-9)) out.push({at: v, text: shown(v, 3)});
    }
  return out;
}

// 1, 2 or 5 times a power of ten, at most x.
function roundBelow(x) {
  const unit = 10 ** Math.floor(Math.log10(x)), part = x / unit;
  return unit * (part >= 5 ? 5 : part >= 2 ? 2 : 1);
}

// A length for people, m.
function lengthText(m) { return m >= 1000 ? `${shown(m / 1000)} km` : m >= 1 ? `${shown(m)} m` : m >= 0.01 ? `${shown(100 * m)} cm` : `${shown(1000 * m)} mm`; }

// A text as a file of the reader's.
function save(name, text, type = 'text/csv') {
  window.lastSaved = {name, text};
  const link = make('a', {download: name, href: URL.createObjectURL(text instanceof Blob ? text : new Blob([text], {type}))});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

// Black over red to yellow: a polynomial (M. Zucker, 2019) through the map "inferno" (S. van der Walt and N. Smith, 2015, CC0).
function inferno(t) {
  const c = [[0.0002, 0.0017, -0.0195], [0.1065, 0.5640, 3.9327], [11.6025, -3.9729, -15.9424], [-41.7040, 17.4364, 44.3541],
    [77.1629, -33.4024, -81.8073], [-71.3194, 32.6261, 73.2095], [25.1311, -12.2427, -23.0703]];
  return [0, 1, 2].map(k => 255 * Math.min(1, Math.max(0, c.reduceRight((sum, row) => sum * t + row[k], 0))));
}

// The colour of the i-th material, tag or class, the same in all pages and in the classes of ENVI (headers.cpp).
function classColour(i) {
  const hue = (0.11 + 0.6180339887498949 * i) % 1 * 6, bright = 255 - 55 * (i % 3);
  return [0, 1, 2].map(c => {
    const from = (hue + 6 - 2 * c) % 6, share = Math.min(1, Math.max(0, 2 - Math.min(from, 6 - from)));
    return bright * (0.15 + 0.85 * share);
  });
}

// Longitude and latitude, degrees, and ellipsoidal height of scene ENU; origin: latitude, longitude, height (WGS84).
function geodeticOf([e, n, u], [latitude, longitude, height]) {
  const a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f), rad = Math.PI / 180;
  const sp = Math.sin(latitude * rad), cp = Math.cos(latitude * rad), sl = Math.sin(longitude * rad), cl = Math.cos(longitude * rad);
  const N = a / Math.sqrt(1 - e2 * sp * sp);
  const x = (N + height) * cp * cl - sl * e - sp * cl * n + cp * cl * u, y = (N + height) * cp * sl + cl * e - sp * sl * n + cp * sl * u;
  const z = (N * (1 - e2) + height) * sp + cp * n + sp * u, p = Math.hypot(x, y);
  let phi = Math.atan2(z, p * (1 - e2)), h = 0;
  for (let i = 0; i < 8; ++i) {
    const s = Math.sin(phi), M = a / Math.sqrt(1 - e2 * s * s);
    h = p * Math.cos(phi) + z * s - a * Math.sqrt(1 - e2 * s * s);
    phi = Math.atan2(z, p * (1 - e2 * M / (M + h)));
  }
  return [Math.atan2(y, x) / rad, phi / rad, h];
}

function geodeticText(enu, origin) {
  if (!origin) return `east ${enu[0].toFixed(2)}, north ${enu[1].toFixed(2)}, up ${enu[2].toFixed(2)} m`;
  const [longitude, latitude, height] = geodeticOf(enu, origin);
  return `${Math.abs(latitude).toFixed(6)} ${latitude < 0 ? 'S' : 'N'}, ${Math.abs(longitude).toFixed(6)} ${longitude < 0 ? 'W' : 'E'}, ${height.toFixed(1)} m`;
}

// An arrow to the north: degrees clockwise from up in the picture.
function northArrow(degrees) {
  const holder = make('span', {title: 'north', id: 'north'});
  holder.innerHTML = `<svg width="30" height="30" viewBox="-15 -15 30 30"><g transform="rotate(${degrees.toFixed(1)})">` +
    '<path d="M0 -13L5 8L0 4L-5 8Z" fill="#222"/></g></svg>';
  holder.append('N');
  return holder;
}

// Dark violet over green to yellow in even steps of brightness: a polynomial (M. Zucker, 2019) through the map "viridis"
// (S. van der Walt and N. Smith, 2015, CC0). 0 to 1 gives red, green and blue, 0 to 255.
function viridis(t) {
  const c = [[0.2777, 0.0054, 0.3341], [0.1051, 1.4046, 1.3846], [-0.3309, 0.2148, 0.0951], [-4.6342, -5.7991, -19.3324],
    [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.3530], [-5.4355, 4.6459, 26.3124]];
  return [0, 1, 2].map(k => 255 * Math.min(1, Math.max(0, c.reduceRight((sum, row) => sum * t + row[k], 0))));
}
