// Codes that are kept as steps between neighbours (libs/page/steps.h), by blocks of 64.

const kStepsBlock = 64;
const stepHeads = new Map();  // by the id of a block of the file: codes, widths and ways of the steps, and where they begin

// Some bytes of a base64 text.
function bytesWithin(text, from, to) {
  const group = Math.floor(from / 3);
  return bytesOf(text.slice(4 * group, 4 * Math.ceil(to / 3))).subarray(from - 3 * group, to - 3 * group);
}

function stepHead(id, b) {
  let head = stepHeads.get(id);
  if (head) return head;
  const n = Math.ceil(b.count / kStepsBlock), bytes = bytesWithin(b.text, 0, 3 * n);
  head = {first: new Uint16Array(n), kind: new Uint8Array(n), from: new Uint32Array(n + 1)};
  head.from[0] = 3 * n;
  for (let i = 0; i < n; ++i) {
    head.first[i] = bytes[3 * i] | bytes[3 * i + 1] << 8;
    head.kind[i] = bytes[3 * i + 2];
    head.from[i + 1] = head.from[i] + 8 * (head.kind[i] & 31);
  }
  stepHeads.set(id, head);
  return head;
}

const codesKept = new Map();  // all codes of a block of the file, the latest last

// All codes of a block of the file.
function allCodes(id, b) {
  let codes = codesKept.get(id);
  if (codes) codesKept.delete(id);
  else codes = codesOf(id, b, 0, Math.ceil(b.count / kStepsBlock));
  codesKept.set(id, codes);
  if (codesKept.size > 16) codesKept.delete(codesKept.keys().next().value);
  return codes;
}

// The codes of blocks `begin` to `end` of 64, the last of them excluded.
function codesOf(id, b, begin, end) {
  const head = stepHead(id, b), start = head.from[begin], all = end - begin === head.first.length && end > 1;
  const bytes = bytesWithin(b.text, start, head.from[end]), out = new Uint16Array((end - begin) * kStepsBlock);
  const other = b.base ? block(b.base) : null;
  const base = !other ? null : all ? allCodes(b.base, other) : codesOf(b.base, other, begin, end);
  for (let i = begin; i < end; ++i) {
    const to = (i - begin) * kStepsBlock, kind = head.kind[i];
    readSteps(bytes, head.from[i] - start, kind & 31, kind & 64, head.first[i], out, to);
    if (kind & 32) for (let k = to; k < to + kStepsBlock; ++k) out[k] += base[k];
  }
  return out;
}

function readSteps(bytes, at, width, fromFirst, first, out, to) {
  if (!width) { out.fill(first, to, to + kStepsBlock); return; }
  const mask = (1 << width) - 1, end = to + kStepsBlock;
  let waiting = 0, bits = 0, last = first;
  for (let k = to; k < end; ++k) {
    while (bits < width) { waiting |= bytes[at++] << bits; bits += 8; }
    const folded = waiting & mask, step = folded >>> 1 ^ -(folded & 1);
    waiting >>>= width, bits -= width;
    out[k] = fromFirst ? first + step : last += step;
  }
}

// All numbers of a block of the file, and one of them.
function numbersOfSteps(id, b) { return ofCodes(allCodes(id, b).subarray(0, b.count), b.kind, b.first, b.second); }

function numberOfSteps(id, b, index) {
  const at = Math.floor(index / kStepsBlock), from = index % kStepsBlock;
  return ofCodes(codesOf(id, b, at, at + 1).subarray(from, from + 1), b.kind, b.first, b.second)[0];
}
