// Bands of an image as numbers, and how they become colours.

const kept = new Map();  // decoded blocks, the latest last
function numbersKept(id) {
  let numbers = kept.get(id);
  if (!numbers) {
    numbers = numbersOf(id);
    if (!numbers) return null;
    if (kept.size > 12) kept.delete(kept.keys().next().value);
  } else kept.delete(id);
  kept.set(id, numbers);
  return numbers;
}

// The values below which the shares `low` and `high` (per cent) of the finite numbers lie; of at most some 60 000.
function percentiles(lists, low, high) {
  const all = [];
  for (const list of lists) {
    const stride = Math.max(1, Math.floor(list.length * lists.length / 60000));
    for (let i = 0; i < list.length; i += stride) if (Number.isFinite(list[i])) all.push(list[i]);
  }
  if (!all.length) return [0, 1];
  const sorted = Float64Array.from(all).sort();
  const at = p => sorted[Math.round(Math.min(1, Math.max(0, p / 100)) * (sorted.length - 1))];
  return [at(low), at(high)];
}

// 0 to 1 linear light as 0 to 255 of sRGB (IEC 61966-2-1), or as it is.
function encoded(t, srgb) {
  if (!(t > 0)) return 0;
  if (t >= 1) return 255;
  return 255 * (!srgb ? t : t <= 0.0031308 ? 12.92 * t : 1.055 * t ** (1 / 2.4) - 0.055);
}

// Three lists as red, green and blue, each between its range, into the pixels of a picture.
function paintRgb(pixels, lists, ranges, srgb) {
  const tables = lists.map((_, k) => {
    const [low, high] = ranges[k], scale = high > low ? 1 / (high - low) : 0;
    return {low, scale};
  });
  const steps = Uint8ClampedArray.from({length: 4097}, (_, i) => Math.round(encoded(i / 4096, srgb)));
  for (let i = 0, to = 0; i < lists[0].length; ++i, to += 4) {
    let there = true;
    for (let k = 0; k < 3; ++k) {
      const v = lists[k][i];
      if (!Number.isFinite(v)) there = false;
      const t = tables[k].scale ? (v - tables[k].low) * tables[k].scale : 0.5;
      pixels[to + k] = steps[t > 0 ? t < 1 ? Math.round(4096 * t) : 4096 : 0];
    }
    pixels[to + 3] = there ? 255 : 0;
  }
}

// A scale of one band: [r, g, b] for 0 to 1. Temperatures have colours of their own, as previews do.
function scaleOf(colours, srgb, kelvin) {
  return t => colours ? (kelvin ? inferno(t) : viridis(t)) : [0, 1, 2].map(() => encoded(t, srgb));
}

// Whether a band is one of thermal radiance, and the temperature at which a blackbody sends as much at its middle.
const kToSi = {'W/(m2 sr um)': 1, 'W/(cm2 sr um)': 1e4};
function isThermal(image, band) { return image.bands[band].um > 3 && image.unit in kToSi; }
function kelvinOf(image, band, radiance) {
  const um = image.bands[band].um, c1 = 1.191042972e8, c2 = 14387.76877;  // W um4 / (m2 sr), um K
  const v = radiance * kToSi[image.unit];
  return v > 0 ? c2 / (um * Math.log1p(c1 / (um ** 5 * v))) : NaN;
}

function paintScale(pixels, list, [low, high], scale) {
  const table = Array.from({length: 1025}, (_, i) => scale(i / 1024).map(Math.round));
  const by = high > low ? 1 / (high - low) : 0;
  for (let i = 0, to = 0; i < list.length; ++i, to += 4) {
    const t = by ? (list[i] - low) * by : 0.5, c = table[t > 0 ? t < 1 ? Math.round(1024 * t) : 1024 : 0];
    pixels[to] = c[0], pixels[to + 1] = c[1], pixels[to + 2] = c[2];
    pixels[to + 3] = Number.isFinite(list[i]) ? 255 : 0;
  }
}

function rgbOf(hex) { return [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16)); }

const kFlagColours = ['#e63946', '#ff9f1c', '#8338ec', '#2a9df4', '#06d6a0', '#b5179e', '#7f5539', '#333333'];
const kSpectrumColours = ['#1b6ca8', '#c0392b', '#1e8449', '#8e44ad', '#b9770e', '#16808a', '#7f3f1f', '#555555'];
