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

// Dark violet over green to yellow in even steps of brightness: a polynomial (M. Zucker, 2019) through the map "viridis"
// (S. van der Walt and N. Smith, 2015, CC0). 0 to 1 gives red, green and blue, 0 to 255.
function viridis(t) {
  const c = [[0.2777, 0.0054, 0.3341], [0.1051, 1.4046, 1.3846], [-0.3309, 0.2148, 0.0951], [-4.6342, -5.7991, -19.3324],
    [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.3530], [-5.4355, 4.6459, 26.3124]];
  return [0, 1, 2].map(k => 255 * Math.min(1, Math.max(0, c.reduceRight((sum, row) => sum * t + row[k], 0))));
}
