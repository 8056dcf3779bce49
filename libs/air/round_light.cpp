#include "air/round_light.h"

#include <algorithm>
#include <cmath>

#include "air/ordinate_angles.h"
#include "math/falling.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr int kMostOrders = 60;    // of scattering that the difference is followed through
constexpr double kSettled = 1e-4;  // of the largest source: further orders do not matter

// What the sources are at an end of a step.
float source_at(const AirSources& sources, size_t layer, const AirWays::End& e) {
  const float *low = sources.row(layer, 0) + e.at, *high = sources.row(layer, 1) + e.at;
  const float below = low[0] + e.share * (low[1] - low[0]), above = high[0] + e.share * (high[1] - high[0]);
  return below + e.height * (above - below);
}

}  // namespace

AirNodes::AirNodes(const Shells& shells, size_t ground) {
  const std::span<const double> heights = shells.heights();
  const GaussRule up = gauss_rule(kUp), limb = gauss_rule(kLimb), down = gauss_rule(kDown);
  // Even in the root of the cosine, between two of them.
  const auto add = [&](const GaussRule& rule, double side, double from, double to) {
    for (size_t i = 0; i < rule.nodes.size(); ++i) {
      const double root = from + (to - from) * rule.nodes[i];
      cosines_.push_back(side * root * root);
      weights_.push_back(2 * root * (to - from) * rule.weights[i]);
    }
  };
  for (size_t level = ground; level < heights.size(); ++level) {
    // The ground's edge: its radius over that of the level is the sine.
    const double above = shells.curvature() * (heights[level] - heights[ground]),
                 ratio = 1 / (1 + above / (1 + shells.curvature() * heights[ground]));
    const double edge = std::max(0.03, std::sqrt(std::sqrt((1 - ratio) * (1 + ratio))));
    add(up, 1, 0, 1), add(limb, -1, 0, edge), add(down, -1, edge, 1);
  }
}

AirWays::AirWays(const Shells& shells, size_t ground, AirNodes nodes, std::vector<double> cosines)
    : nodes_(std::move(nodes)), cosines_(std::move(cosines)), levels_(shells.layers() + 1 - ground) {
  const std::span<const double> heights = shells.heights();
  for (size_t level = 0; level < levels_; ++level)
    for (size_t n = 0; n < AirNodes::count(); ++n) {
      const double c = nodes_.cosine(level, n);
      Way way{static_cast<uint32_t>(steps_.size()), static_cast<uint32_t>(steps_.size()), c < 0};
      const Vec3 from = shells.above_zero(heights[ground + level]);
      const Dir d{std::sqrt((1 - c) * (1 + c)), 0, c};
      const bool up_from_ground = level == 0 && c < 0;
      const double distance = c < 0 ? shells.way_down_to(from, d, heights[ground]) : INFINITY;
      way.ground = c < 0 && (level == 0 || std::isfinite(distance));
      if (!up_from_ground)
        shells.walk(from, d, distance, [&](const Shells::Piece& p) {
          if (p.layer < ground) return;  // by rounding
          const double low = heights[p.layer], thickness = heights[p.layer + 1] - low;
          const auto at = [&](double t, double height) {
            return end(dot(d, shells.up(from + d * t)), std::clamp((height - low) / thickness, 0.0, 1.0));
          };
          steps_.push_back({static_cast<uint32_t>(p.layer - ground), static_cast<float>(p.length),
                            at(p.near, p.near_height), at(p.far, p.far_height)});
        });
      way.last = static_cast<uint32_t>(steps_.size());
      ways_.push_back(way);
    }
}

AirWays::End AirWays::end(double cosine, double height) const {
  const auto above = std::upper_bound(cosines_.begin() + 1, cosines_.end() - 1, cosine);
  const auto at = static_cast<size_t>(above - cosines_.begin()) - 1;
  const double share = std::clamp((cosine - cosines_[at]) / (cosines_[at + 1] - cosines_[at]), 0.0, 1.0);
  return {static_cast<uint32_t>(at), static_cast<float>(share), static_cast<float>(height)};
}

RoundLight::RoundLight(const AirWays& round, const AirWays& flat, size_t moments)
    : round_(round), flat_(flat), moments_(moments) {
  const auto fill = [&](std::vector<double>& to, double cosine) {
    const size_t begin = to.size();
    to.resize(begin + moments_);
    associated_legendre(0, cosine, {&to[begin], moments_});
  };
  for (size_t level = 0; level < round_.levels(); ++level)
    for (size_t n = 0; n < AirNodes::count(); ++n) fill(legendre_nodes_, round_.nodes().cosine(level, n));
  for (const double c : round_.cosines()) fill(legendre_cosines_, c);
}

// What is seen of the sources at both ends of every step, and of the ground.
void RoundLight::weigh(const AirWays& ways, std::span<const RoundLayer> layers) {
  weights_.resize(ways.size()), grounds_.assign(ways.levels() * AirNodes::count(), 0.0f);
  for (size_t level = 0; level < ways.levels(); ++level)
    for (size_t n = 0; n < AirNodes::count(); ++n) {
      const AirWays::Way& way = ways.way(level, n);
      Weights* to = &weights_[way.first];
      float left = 1;
      for (const AirWays::Step& s : ways.steps(way)) {
        const auto x = static_cast<float>(std::min(1e4, layers[s.layer].extinction * double{s.length}));
        const float keep = exp_falling(x), even = mean_of_even(x, keep), change = 0.5f * mean_of_rising(x, keep);
        *to++ = {left * x * (even - change), left * x * change};
        left *= keep;
      }
      if (way.ground) grounds_[level * AirNodes::count() + n] = left;
    }
}

// Adds the light that arrives at all levels along the ways that were weighed last, times a sign.
void RoundLight::arrive(const AirWays& ways, const AirSources& sources, double sign) {
  for (size_t level = 0; level < ways.levels(); ++level)
    for (size_t n = 0; n < AirNodes::count(); ++n) {
      const AirWays::Way& way = ways.way(level, n);
      const Weights* w = &weights_[way.first];
      const size_t at = level * AirNodes::count() + n;
      double light = double{grounds_[at]} * sources.ground;
      for (const AirWays::Step& s : ways.steps(way)) {
        light += double{w->near * source_at(sources, s.layer, s.near) + w->far * source_at(sources, s.layer, s.far)};
        ++w;
      }
      light_[at] += sign * light;
    }
}

// The sources that the light makes.
void RoundLight::scatter(std::span<const RoundLayer> layers, AirSources& to) {
  std::vector<double> of_light(moments_);
  for (size_t level = 0; level < round_.levels(); ++level) {
    std::fill(of_light.begin(), of_light.end(), 0.0);
    for (size_t n = 0; n < AirNodes::count(); ++n) {
      const double light = round_.nodes().weight(level, n) * light_[level * AirNodes::count() + n];
      for (size_t l = 0; l < moments_; ++l)
        of_light[l] += light * legendre_nodes_[(level * AirNodes::count() + n) * moments_ + l];
    }
    const auto add = [&](size_t layer, int end) {
      const RoundLayer& r = layers[layer];
      const size_t orders = std::min(moments_, r.moments.size());
      for (size_t c = 0; c < to.cosines; ++c) {
        double sum = 0;
        for (size_t l = 0; l < orders; ++l)
          sum += static_cast<double>(2 * l + 1) * r.moments[l] * of_light[l] * legendre_cosines_[c * moments_ + l];
        to.at(layer, end, c) = static_cast<float>(0.5 * r.albedo * sum);
      }
    };
    if (level > 0) add(level - 1, 1);
    if (level + 1 < round_.levels()) add(level, 0);
  }
}

// Of light that arrives at a level from above, or leaves upwards through it, W/m2.
double RoundLight::flux(size_t level, bool down) const {
  double sum = 0;
  for (size_t n = 0; n < AirNodes::count(); ++n)
    if (const double c = down ? round_.nodes().cosine(level, n) : -round_.nodes().cosine(level, n); c > 0)
      sum += 2 * kPi * c * round_.nodes().weight(level, n) * light_[level * AirNodes::count() + n];
  return sum;
}

RoundFluxes RoundLight::solve(std::span<const RoundLayer> layers, const AirSources& sources, double ground_albedo,
                              AirSources& more) {
  light_.assign(round_.levels() * AirNodes::count(), 0.0);
  weigh(flat_, layers);
  arrive(flat_, sources, -1);
  weigh(round_, layers);
  arrive(round_, sources, 1);
  base_ = light_;
  double largest = std::fabs(sources.ground);
  for (const float s : sources.values) largest = std::max(largest, std::fabs(double{s}));
  AirSources next = more;
  std::fill(more.values.begin(), more.values.end(), 0.0f);
  more.ground = 0;
  for (int order = 0; order < kMostOrders; ++order) {
    scatter(layers, next);
    next.ground = ground_albedo / kPi * flux(0, true);
    double change = std::fabs(next.ground - more.ground);
    for (size_t i = 0; i < next.values.size(); ++i)
      change = std::max(change, std::fabs(double{next.values[i] - more.values[i]}));
    std::swap(more, next);
    if (change <= kSettled * largest) break;
    light_ = base_;
    arrive(round_, more, 1);
  }
  return {flux(0, true), flux(round_.levels() - 1, false)};
}

}  // namespace suite
