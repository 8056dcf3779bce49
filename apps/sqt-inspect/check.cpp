#include "check.h"

#include <algorithm>
#include <cmath>

#include "math/direction_test.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "sqt/reciprocity.h"

namespace suite {

std::vector<IssueKind> check_issues() {
  return {
      {"IN101", Severity::error, "a value is negative or not finite", "fit again"},
      {"IN102", Severity::error, "a value below the horizon of hemisphere data", "fit again"},
      {"IN103", Severity::error, "more energy is returned than received", "fit again; the default of sqt-fit clamps"},
      {"IN104", Severity::error, "the masses of a slice's cells do not sum to 1", "fit again"},
      {"IN105", Severity::error, "sampling does not follow the density", "fit again"},
      {"IN106", Severity::error, "the mean of w / pdf is not the total", "fit again"},
      {"IN107", Severity::error, "two cells of a slice overlap", "fit again"},
      {"IN108", Severity::warning, "not reciprocal",
       "measured data often are not; formats/sqt/FORMAT.md says how it is defined"}};
}

namespace {

class Check {
 public:
  Check(const sqt::Bundle& bundle, const std::string& asset, size_t samples)
      : bundle_(bundle), asset_(asset), samples_(samples), report_(check_issues()) {}

  Report operator()() {
    for (size_t c = 0; c < bundle_.channels(); ++c) {
      values(c);
      for (const size_t v : views()) {
        cells(v, c);
        energy(v, c);
      }
    }
    const std::vector<size_t> tested = tested_views();
    significance_ = 1e-3 / static_cast<double>(2 * tested.size() * bundle_.channels());
    for (const size_t v : tested)
      for (size_t c = 0; c < bundle_.channels(); ++c) sampling(v, c);
    if (bundle_.info().function.domain == sqt::Domain::hemisphere && bundle_.cosine_weighted()) reciprocity();
    return report_;
  }

 private:
  void fault(const char* code, std::string text) {
    report_.add(code, asset_, {Where{asset_, 0, 0, {}, -1}, std::move(text)});
  }
  std::string at(size_t view, size_t channel) const {
    const sqt::Bundle::View& v = bundle_.info().views[view];
    return strf("view %.2f deg, azimuth %.0f deg, channel %zu", v.theta / kDegree, v.phi / kDegree, channel);
  }
  Dir out(size_t view) const {
    return dir_from_angles(bundle_.info().views[view].theta, bundle_.info().views[view].phi);
  }
  std::vector<size_t> views() const {
    std::vector<size_t> all(bundle_.info().views.size());
    for (size_t v = 0; v < all.size(); ++v) all[v] = v;
    return all;
  }
  // Sampling is tested in at most six of the views, ends included.
  std::vector<size_t> tested_views() const {
    const size_t n = bundle_.info().views.size(), wanted = std::min<size_t>(6, n);
    std::vector<size_t> list;
    for (size_t i = 0; i < wanted; ++i) list.push_back(wanted == 1 ? 0 : i * (n - 1) / (wanted - 1));
    return list;
  }

  void values(size_t channel) {
    Pcg32 random(11, channel);
    const bool hemisphere = bundle_.info().function.domain == sqt::Domain::hemisphere;
    for (int n = 0; n < 20000; ++n) {
      Dir o = uniform_sphere({random.uniform(), random.uniform()});
      if (hemisphere) o.z = std::fabs(o.z);
      const Dir i = uniform_sphere({random.uniform(), random.uniform()});
      const double f = bundle_.value(o, i, channel), p = bundle_.pdf(o, i, channel);
      if (!(f >= 0) || !std::isfinite(f) || !(p >= 0) || !std::isfinite(p))
        return fault("IN101", strf("value %g, density %g at out %.3f %.3f %.3f, in %.3f %.3f %.3f", f, p, o.x, o.y, o.z,
                                   i.x, i.y, i.z));
      if (hemisphere && i.z <= 0 && f != 0) return fault("IN102", strf("value %g at in.z = %.4f", f, i.z));
    }
  }
  void cells(size_t view, size_t channel) {
    const std::vector<sqt::Bundle::Cell> list = bundle_.cells(view, channel);
    double mass = 0;
    // As ranges of cells of the finest order: sorted, each must end before the next begins.
    std::vector<std::pair<std::pair<int, uint64_t>, uint64_t>> ranges;
    for (const sqt::Bundle::Cell& c : list) {
      if (!(c.value >= 0) || !std::isfinite(c.value) || !(c.mass >= 0))
        return fault("IN101", at(view, channel) + strf(": a leaf holds %g, mass %g", c.value, c.mass));
      mass += c.mass;
      const int up = 2 * (sqt::kMaxOrder - c.id.order());
      ranges.push_back({{c.sheet, uint64_t{c.id.index()} << up}, uint64_t{1} << up});
    }
    std::sort(ranges.begin(), ranges.end());
    for (size_t i = 1; i < ranges.size(); ++i)
      if (ranges[i - 1].first.first == ranges[i].first.first &&
          ranges[i - 1].first.second + ranges[i - 1].second > ranges[i].first.second)
        return fault("IN107", at(view, channel));
    if (mass > 0 && std::fabs(mass - 1) > 1e-4) fault("IN104", at(view, channel) + strf(": %.6f", mass));
  }
  void energy(size_t view, size_t channel) {
    const double W = bundle_.total(out(view), channel);
    if (!(W >= 0) || !std::isfinite(W)) return fault("IN101", at(view, channel) + strf(": total %g", W));
    if (bundle_.info().function.quantity == sqt::Quantity::bsdf && W > 1 + 1e-4)
      fault("IN103", at(view, channel) + strf(": total %.5f", W));
  }
  void sampling(size_t view, size_t channel) {
    const Dir o = out(view);
    const auto delta = bundle_.delta(o, channel);
    const double scattered = bundle_.total(o, channel) - (delta ? delta->total : 0);
    if (!(scattered > 0)) return;
    Pcg32 pilot_random(1, view), random(2, view);
    auto draw = [&](Pcg32& r) {
      const Vec2 u{r.uniform(), r.uniform()};
      return bundle_.sample(o, u, r.uniform(), channel);
    };
    std::vector<Dir> pilot;
    for (int n = 0; n < 30000; ++n)
      if (const auto d = draw(pilot_random)) pilot.push_back(*d);
    DirectionHistogram histogram(pilot, 48);
    RunningStats weight;
    for (size_t n = 0; n < samples_; ++n) {
      const auto d = draw(random);
      if (d) histogram.add(*d);
      const double p = d ? bundle_.pdf(o, *d, channel) : 1;
      if (!(p > 0)) return fault("IN105", at(view, channel) + ": a drawn direction has density 0");
      weight.add(d ? bundle_.eval(o, *d, channel) / p : 0);
    }
    const auto verdict =
        histogram.judge([&](Dir in) { return bundle_.pdf(o, in, channel); }, static_cast<double>(samples_));
    if (verdict.p_value < significance_)
      fault("IN105", at(view, channel) + strf(": chi-square p = %.2g (%d degrees)", verdict.p_value, verdict.degrees));
    const double beyond = std::fabs(weight.mean() - scattered) - 1e-3 * scattered;
    if (beyond > 0 && normal_two_sided(beyond / weight.stderr_of_mean()) < significance_)
      fault("IN106", at(view, channel) + strf(": mean %.5f, total %.5f", weight.mean(), scattered));
  }
  void reciprocity() {
    const double error = sqt::reciprocity_error(bundle_).back();
    if (error > sqt::kNotReciprocal) fault("IN108", strf("reciprocity_error %.2f %%", 100 * error));
  }

  const sqt::Bundle& bundle_;
  std::string asset_;
  size_t samples_;
  double significance_ = 1e-6;
  Report report_;
};

}  // namespace

Report check_bundle(const sqt::Bundle& bundle, const std::string& asset, size_t samples) {
  return Check(bundle, asset, samples)();
}

}  // namespace suite
