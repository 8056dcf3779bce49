// Vectors, cameras, rays against triangles, and where the sun stands.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => scaled(a, 1 / (Math.hypot(...a) || 1));
const radians = d => d * Math.PI / 180;

// The direction of a compass azimuth and an elevation, degrees: east, north, up.
function directionOf(azimuth, elevation) {
  const a = radians(azimuth), e = radians(elevation);
  return [Math.sin(a) * Math.cos(e), Math.cos(a) * Math.cos(e), Math.sin(e)];
}

// A camera that turns around a target. matrix: column-major, to clip space.
function cameraOf(view, width, height) {
  const back = directionOf(view.azimuth, view.elevation), eye = add(view.target, scaled(back, view.distance));
  const right = unit(cross([0, 0, 1], back)), up = cross(back, right);
  const near = view.distance * 1e-3, far = view.distance * 4 + 8 * about.radius, f = 1 / Math.tan(radians(view.angle) / 2);
  const a = f * height / width, c = (far + near) / (near - far), d = 2 * far * near / (near - far);
  const rows = [[a * right[0], a * right[1], a * right[2], -a * dot(right, eye)], [f * up[0], f * up[1], f * up[2], -f * dot(up, eye)],
    [c * back[0], c * back[1], c * back[2], -c * dot(back, eye) + d], [-back[0], -back[1], -back[2], dot(back, eye)]];
  const matrix = new Float32Array(16);
  for (let i = 0; i < 4; ++i) for (let k = 0; k < 4; ++k) matrix[4 * k + i] = rows[i][k];
  return {eye, right, up, back, matrix, f, width, height};
}

function rayOf(camera, x, y) {
  const u = (2 * x / camera.width - 1) * camera.width / camera.height / camera.f, v = (1 - 2 * y / camera.height) / camera.f;
  return {from: camera.eye, along: unit(add(sub(scaled(camera.right, u), camera.back), scaled(camera.up, v)))};
}

// Where a point is in the window, or null behind the camera.
function windowOf(camera, p) {
  const m = camera.matrix, w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
  if (!(w > 0)) return null;
  const x = (m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12]) / w, y = (m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13]) / w;
  return [(x + 1) / 2 * camera.width, (1 - y) / 2 * camera.height];
}

// Instance i of a thing: rows of three numbers and a shift. Its inverse applied to a point and a direction.
function intoLocal(places, i, ray) {
  const m = places.subarray(12 * i, 12 * i + 12);
  const r0 = [m[0], m[1], m[2]], r1 = [m[4], m[5], m[6]], r2 = [m[8], m[9], m[10]];
  const c = [cross(r1, r2), cross(r2, r0), cross(r0, r1)], inverse = 1 / dot(r0, c[0]);
  const apply = v => scaled(add(add(scaled(c[0], v[0]), scaled(c[1], v[1])), scaled(c[2], v[2])), inverse);
  return {from: apply(sub(ray.from, [m[3], m[7], m[11]])), along: apply(ray.along)};
}

function outOfLocal(places, i, p) {
  const m = places.subarray(12 * i, 12 * i + 12);
  return [0, 1, 2].map(r => m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3]);
}

function meetsBox(ray, low, high, most) {
  let near = 0, far = most;
  for (let k = 0; k < 3; ++k) {
    const a = (low[k] - ray.from[k]) / ray.along[k], b = (high[k] - ray.from[k]) / ray.along[k];
    if (Number.isNaN(a) || Number.isNaN(b)) continue;
    near = Math.max(near, Math.min(a, b)), far = Math.min(far, Math.max(a, b));
  }
  return near <= far * (1 + 1e-6) + 1e-9;
}

// The nearest triangle along a ray. Based on: T. Moeller & B. Trumbore, "Fast, minimum storage ray/triangle
// intersection", 1997.
function nearestTriangle(ray, positions, indices, most) {
  let best = null, limit = most;
  const room = 1e-6;  // of an edge: no ray slips through where triangles meet
  const [ox, oy, oz] = ray.from, [dx, dy, dz] = ray.along;
  for (let t = 0; t < indices.length; t += 3) {
    const a = 3 * indices[t], b = 3 * indices[t + 1], c = 3 * indices[t + 2];
    const ax = positions[a], ay = positions[a + 1], az = positions[a + 2];
    const e1x = positions[b] - ax, e1y = positions[b + 1] - ay, e1z = positions[b + 2] - az;
    const e2x = positions[c] - ax, e2y = positions[c + 1] - ay, e2z = positions[c + 2] - az;
    const px = dy * e2z - dz * e2y, py = dz * e2x - dx * e2z, pz = dx * e2y - dy * e2x;
    const det = e1x * px + e1y * py + e1z * pz;
    if (det === 0) continue;
    const sx = ox - ax, sy = oy - ay, sz = oz - az, u = (sx * px + sy * py + sz * pz) / det;
    if (u < -room || u > 1 + room) continue;
    const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < -room || u + v > 1 + room) continue;
    const distance = (e2x * qx + e2y * qy + e2z * qz) / det;
    if (distance > 1e-9 && distance < limit) limit = distance, best = {distance, triangle: t / 3};
  }
  return best;
}

// Compass azimuth and elevation of the sun's middle, degrees, without refraction; within 0.02 degrees from 1950 to 2050.
// Based on: J. J. Michalsky, "The Astronomical Almanac's algorithm for approximate solar position", Solar Energy 40, 1988.
function sunAt(date, latitude, longitude) {
  const n = date.getTime() / 86400000 + 2440587.5 - 2451545, hour = (n + 0.5 - Math.floor(n + 0.5)) * 24;
  const mean = 280.46 + 0.9856474 * n, g = radians(357.528 + 0.9856003 * n);
  const along = radians(mean + 1.915 * Math.sin(g) + 0.02 * Math.sin(2 * g)), tilt = radians(23.439 - 4e-7 * n);
  const ascension = Math.atan2(Math.cos(tilt) * Math.sin(along), Math.cos(along)), declination = Math.asin(Math.sin(tilt) * Math.sin(along));
  const sidereal = 6.697375 + 0.0657098242 * n + hour, angle = radians(sidereal * 15 + longitude) - ascension, place = radians(latitude);
  const up = Math.asin(Math.sin(declination) * Math.sin(place) + Math.cos(declination) * Math.cos(place) * Math.cos(angle));
  const azimuth = Math.atan2(-Math.cos(declination) * Math.sin(angle),
    Math.sin(declination) * Math.cos(place) - Math.cos(declination) * Math.sin(place) * Math.cos(angle));
  return {azimuth: (azimuth * 180 / Math.PI + 360) % 360, elevation: up * 180 / Math.PI};
}
