#include "transport/gloss_guide.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace suite {

namespace {

Box3 box_of(std::span<const GlossPhoton> photons) {
  Box3 box;
  for (const GlossPhoton& p : photons) box.grow(p.place);
  return box;
}

int longest(Vec3 size) { return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2; }

// Of a patch of surface that fills the box, m2.
double area_of(Vec3 size) {
  std::array<double, 3> s{size.x, size.y, size.z};
  std::sort(s.begin(), s.end());
  return s[2] * std::max(s[1], 1e-3 * s[2]);
}

constexpr double kFinest = 1e-8;  // squared width of a lobe, rad2
// Nearest others of which the distance is the width of a lobe.
constexpr size_t kNearest = 4;

// Squared distance of a point to the k-th nearest of the others, but for what is along `way` (unit; or none).
double spacing2(std::span<const Vec3> points, size_t i, Vec3 way) {
  std::vector<double> all;
  for (size_t j = 0; j < points.size(); ++j) {
    const Vec3 d = points[j] - points[i];
    const double along = dot(d, way);
    if (j != i) all.push_back(dot(d, d) - along * along);
  }
  const size_t k = std::min(kNearest, all.size()) - 1;
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(k), all.end());
  return all[k];
}

// Where photons seem to come from: `reach` times as far as where they do.
std::vector<Vec3> images(std::span<const GlossPhoton> photons, double reach) {
  std::vector<Vec3> all;
  for (const GlossPhoton& p : photons) all.push_back(p.place + (p.from - p.place) * reach);
  return all;
}

// The reach at which they come from closest together, as their places see it. Rough surfaces shine from where they are;
// what smooth ones throw has its image elsewhere: behind convex mirrors, and infinitely far behind plane ones.
double best_reach(std::span<const GlossPhoton> photons) {
  constexpr size_t kLookedAt = 12;
  double best = 1, least = std::numeric_limits<double>::infinity();
  for (const double reach : {1.0, 1.15, 1.3, 1.5, 2.0, 3.0, 8.0, 1000.0}) {
    const std::vector<Vec3> from = images(photons, reach);
    double sum = 0;
    for (size_t i = 0; i < std::min(kLookedAt, photons.size()); ++i) {
      const Vec3 way = from[i] - photons[i].place;
      const double way2 = std::max(dot(way, way), 1e-30);
      sum += std::log(std::max(spacing2(from, i, way / std::sqrt(way2)) / way2, kFinest));
    }
    if (sum < least) best = reach, least = sum;
  }
  return best;
}

}  // namespace

GlossGuide::GlossGuide(std::vector<GlossPhoton> photons) {
  if (photons.empty()) throw Bug("a guide without photons");
  build(photons);
}

// Cut in the middle of space, not of the photons: a cut among photons of one plane would part places that are on it.
void GlossGuide::build(std::span<GlossPhoton> photons) {
  const size_t here = nodes_.size();
  nodes_.push_back({});
  const Box3 box = box_of(photons);
  const int axis = longest(box.size());
  const double split = box.center()[axis];
  const bool cuts = split > box.low[axis] && split < box.high[axis];
  if (photons.size() <= Cell::kMost || !cuts) {
    nodes_[here].next = static_cast<uint32_t>(cells_.size());
    return add_cell(photons.first(std::min(photons.size(), Cell::kMost)), photons.size());
  }
  const auto above =
      std::partition(photons.begin(), photons.end(), [&](const GlossPhoton& p) { return p.place[axis] < split; });
  const auto below = static_cast<size_t>(above - photons.begin());
  nodes_[here].axis = axis, nodes_[here].split = split;
  build(photons.first(below));
  nodes_[here].next = static_cast<uint32_t>(nodes_.size());
  build(photons.subspan(below));
}

// photons: those that are remembered of `all`.
void GlossGuide::add_cell(std::span<const GlossPhoton> photons, size_t landed) {
  // kRest: noise of other light over the light's irradiance.
  constexpr double kRest = 0.1, kMargin = 0.25;
  constexpr size_t kLeast = 6;
  Cell cell;
  if (photons.size() < kLeast) return cells_.push_back(cell);
  const Box3 box = box_of(photons);
  const double margin = kMargin * std::max({box.size().x, box.size().y, box.size().z});
  cell.centre_ = box.center();
  cell.box_ = {box.low - Vec3{margin, margin, margin}, box.high + Vec3{margin, margin, margin}};
  cell.count_ = photons.size();
  double flux = 0, irradiance = 0;
  for (const GlossPhoton& p : photons) flux += double{p.flux}, irradiance += double{p.flux} * double{p.irradiance};
  const double reach = best_reach(photons);
  const std::vector<Vec3> all = images(photons, reach);
  double sum = 0;
  for (size_t i = 0; i < photons.size(); ++i) {
    const Vec3 from = all[i] - cell.centre_;
    const double part = double{photons[i].flux} / flux;
    // An image has no surface: it is seen from the front.
    const bool image = reach > 1;
    const Dir facing = normalized(from);
    const double width2 = spacing2(all, i, image ? facing : Vec3{});
    cell.middle_ += (photons[i].from - cell.centre_) * part;
    cell.set_lobe(i, from, image ? facing : photons[i].normal, std::sqrt(std::max(width2, kFinest * dot(from, from))),
                  part);
    cell.sum_[i] = static_cast<float>(sum += part);
  }
  const double of_light = flux * static_cast<double>(landed) / static_cast<double>(photons.size()) /
                          std::max(area_of(box.size()), 1e-30) / (irradiance / flux);
  cell.share_ = std::min(kMostShare, of_light / (of_light + kRest));
  cells_.push_back(cell);
}

const GlossGuide::Cell* GlossGuide::at(Vec3 place) const {
  uint32_t n = 0;
  while (nodes_[n].axis >= 0) n = place[nodes_[n].axis] < nodes_[n].split ? n + 1 : nodes_[n].next;
  const Cell& cell = cells_[nodes_[n].next];
  const Box3& b = cell.box_;
  const bool inside = place.x >= b.low.x && place.y >= b.low.y && place.z >= b.low.z && place.x <= b.high.x &&
                      place.y <= b.high.y && place.z <= b.high.z;
  return inside ? &cell : nullptr;
}

// A disk on the surface as the centre sees it: foreshortened.
void GlossGuide::Cell::set_lobe(size_t i, Vec3 from, Dir normal, double width, double part) {
  constexpr double kEdgeOn = 0.1;
  const double away = length(from);
  const Dir facing = away > 0 ? from / away : -normal;
  const Frame frame = Frame::with_tangent(facing, normal);
  const double narrow = width * std::clamp(std::fabs(dot(normal, facing)), kEdgeOn, 1.0);
  from_.set(i, from), facing_.set(i, facing);
  along_.set(i, frame.x / narrow), across_.set(i, frame.y / width);
  height_[i] = static_cast<float>(part / (kPi * width * narrow));
}

// A lobe is 1 / (1 + a^2 + b^2)^2 over its area, at coordinates a, b in the photon's plane.
float GlossGuide::Cell::density(Vec3 place, Dir in) const {
  const Vec3 off = place - centre_;
  const auto ox = static_cast<float>(off.x), oy = static_cast<float>(off.y), oz = static_cast<float>(off.z);
  const auto ix = static_cast<float>(in.x), iy = static_cast<float>(in.y), iz = static_cast<float>(in.z);
  constexpr float kFarOut = 1e15f;
  constexpr size_t kLanes = 8;  // of a vector
  static_assert(kMost % kLanes == 0);
  std::array<float, kMost> each;
  const auto lobe = [&](size_t i) {
    const float x = from_.x[i] - ox, y = from_.y[i] - oy, z = from_.z[i] - oz;
    const float ahead = x * facing_.x[i] + y * facing_.y[i] + z * facing_.z[i];
    const float cosine = ix * facing_.x[i] + iy * facing_.y[i] + iz * facing_.z[i];
    const float way = ahead / cosine;  // to where the ray meets the plane
    const float px = ix * way - x, py = iy * way - y, pz = iz * way - z;
    const float a = px * along_.x[i] + py * along_.y[i] + pz * along_.z[i];
    const float b = px * across_.x[i] + py * across_.y[i] + pz * across_.z[i];
    const float q = 1 + a * a + b * b;
    // Far out in the plane single precision ends.
    return way > 0 && q < kFarOut ? height_[i] * way * way / (std::fabs(cosine) * q * q) : 0.0f;
  };
  for (size_t first = 0; first < count_; first += kLanes)
    for (size_t i = first; i < first + kLanes; ++i) each[i] = lobe(i);
  float sum = 0;
  for (size_t i = 0; i < count_; ++i) sum += each[i];
  return sum;
}

Dir GlossGuide::Cell::draw(Vec3 place, Vec2 u) const {
  size_t i = 0;
  const auto at = static_cast<float>(u.x);
  while (i + 1 < count_ && at >= sum_[i]) ++i;
  const double before = i > 0 ? double{sum_[i - 1]} : 0, part = double{sum_[i]} - before;
  const double v = part > 0 ? std::clamp((u.x - before) / part, 0.0, 1 - 0x1p-24) : 0.5;
  const double r = std::sqrt(v / (1 - v)), phi = 2 * kPi * u.y;
  const Vec3 a = along_[i], b = across_[i];
  const Vec3 to =
      centre_ + from_[i] + a * (r * std::cos(phi) / dot(a, a)) + b * (r * std::sin(phi) / dot(b, b)) - place;
  return length(to) > 0 ? normalized(to) : Dir{0, 0, 1};
}

}  // namespace suite
