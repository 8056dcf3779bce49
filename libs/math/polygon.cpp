#include "math/polygon.h"

#include <cmath>
#include <numeric>
#include <queue>

namespace suite {

namespace {

double area2(Vec2 a, Vec2 b, Vec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool inside(Vec2 p, Vec2 a, Vec2 b, Vec2 c) {
  return area2(a, b, p) >= 0 && area2(b, c, p) >= 0 && area2(c, a, p) >= 0;
}
bool same(Vec2 a, Vec2 b) { return a.x == b.x && a.y == b.y; }

// Cuts ears, the one with the best shape first, so that slivers are avoided where there is a choice.
class EarCutter {
 public:
  explicit EarCutter(const std::vector<Vec2>& points) : p_(points), n_(static_cast<int>(points.size())) {
    for (int i = 0; i < n_; ++i) before_.push_back((i + n_ - 1) % n_), after_.push_back((i + 1) % n_);
    round_.assign(points.size(), 0);
    // Of many corners only the reflex ones are looked at: if any lies in an ear, one of them does.
    for (int i = 0; i < n_; ++i)
      if (n_ <= kFew || !(area2(p_[before_[i]], p_[i], p_[after_[i]]) > 0)) watched_.push_back(i);
    for (int i = 0; i < n_; ++i) offer(i);
  }
  // The corners that are left: three, or those of a rest without ears.
  std::vector<int> run(std::vector<std::array<int, 3>>& out) {
    int left = n_;
    size_t looked = 0;
    while (left > 3 && !offers_.empty()) {
      const Offer best = offers_.top();
      offers_.pop();
      if (best.round != round_[best.corner]) continue;
      if ((looked += watched_.size() + blocked_.size()) > kMostLooks) break;
      const int k = best.corner, a = before_[k], c = after_[k];
      if (!is_ear(a, k, c)) continue;  // offered again when a neighbour goes
      out.push_back({a, k, c});
      after_[a] = c, before_[c] = a, round_[k] = -1, --left;
      blocked_again();
      ++round_[a], offer(a);
      ++round_[c], offer(c);
    }
    std::vector<int> ring;
    for (int i = 0; i < n_; ++i)
      if (round_[i] >= 0) ring.push_back(i);
    return ring;
  }

 private:
  static constexpr int kFew = 256;
  static constexpr size_t kMostLooks = 400'000'000;  // some seconds; then the rest counts as not clean
  struct Offer {
    double quality;
    int corner, round;
    bool operator<(const Offer& o) const { return quality != o.quality ? quality < o.quality : corner > o.corner; }
  };
  void offer(int k) {
    const Vec2 a = p_[before_[k]], b = p_[k], c = p_[after_[k]];
    const double area = area2(a, b, c);
    const double edges = std::pow(std::hypot(b.x - a.x, b.y - a.y), 2) + std::pow(std::hypot(c.x - b.x, c.y - b.y), 2) +
                         std::pow(std::hypot(a.x - c.x, a.y - c.y), 2);
    if (area > 1e-14 * edges) offers_.push({area / edges, k, round_[k]});
  }
  bool is_ear(int ia, int ib, int ic) {
    const Vec2 a = p_[ia], b = p_[ib], c = p_[ic];
    for (const int q : watched_) {
      if (round_[q] < 0 || q == ia || q == ib || q == ic) continue;
      if (!same(p_[q], a) && !same(p_[q], b) && !same(p_[q], c) && inside(p_[q], a, b, c)) {
        blocked_.push_back({ib, q});
        return false;
      }
    }
    return true;
  }
  // Corners whose ear was blocked by one that has gone since.
  void blocked_again() {
    for (size_t i = 0; i < blocked_.size();) {
      const auto [corner, by] = blocked_[i];
      if (round_[corner] >= 0 && round_[by] >= 0) {
        ++i;
        continue;
      }
      if (round_[corner] >= 0) offer(corner);
      blocked_[i] = blocked_.back();
      blocked_.pop_back();
    }
  }

  const std::vector<Vec2>& p_;
  const int n_;
  std::vector<int> before_, after_, round_, watched_;  // round: changes of a corner's neighbours; -1 = gone
  std::vector<std::pair<int, int>> blocked_;
  std::priority_queue<Offer> offers_;
};

std::vector<int> cut_ears(const std::vector<Vec2>& points, std::vector<std::array<int, 3>>& out) {
  return EarCutter(points).run(out);
}

}  // namespace

std::vector<std::array<int, 3>> split_polygon(std::span<const Vec3> corners, bool& clean) {
  clean = true;
  const int n = static_cast<int>(corners.size());
  std::vector<std::array<int, 3>> out;
  if (n < 3) return out;
  if (n == 3) return {{0, 1, 2}};
  // Project along the Newell normal, which exists for slightly bent polygons too.
  Vec3 normal;
  for (int i = 0; i < n; ++i) normal += cross(corners[i] - corners[0], corners[(i + 1) % n] - corners[0]);
  std::vector<int> ring(n);
  std::iota(ring.begin(), ring.end(), 0);
  const double len = length(normal);
  std::vector<Vec2> p(n);
  if (len > 0) {
    const Frame frame = Frame::around(normal / len);
    for (int i = 0; i < n; ++i) p[i] = {dot(corners[i] - corners[0], frame.x), dot(corners[i] - corners[0], frame.y)};
  }
  if (len > 0) ring = cut_ears(p, out);
  if (ring.size() > 3) clean = false;
  for (size_t k = 1; k + 1 < ring.size(); ++k) out.push_back({ring[0], ring[k], ring[k + 1]});
  return out;
}

}  // namespace suite
