#include "detection/counting.h"

#include <algorithm>
#include <cmath>
#include <queue>

namespace suite {

namespace {

constexpr size_t kMostEvents = 1000000;

struct Event {
  double time;
  uint32_t pixel;
  Click::Cause cause;
  bool primary;
  // The earliest first; those of one moment by pixel.
  bool operator<(const Event& o) const { return time > o.time || (time == o.time && pixel > o.pixel); }
};

class Array {
 public:
  Array(const CountingSpec& spec, std::span<const Expected> pixels, uint32_t columns, Pcg32& random)
      : spec_(spec), pixels_(pixels), columns_(columns), random_(random), blind_(pixels.size()) {
    for (const Expected& e : pixels_) {
      std::vector<double> sum(e.grid.count + 1, 0);
      for (size_t k = 0; k < e.grid.count; ++k) sum[k + 1] = sum[k] + e.signal[k] + e.background;
      sums_.push_back(std::move(sum));
    }
  }
  std::vector<Click> run() {
    const double opens = pixels_.empty() ? 0 : pixels_[0].grid.start + spec_.hold_off;
    for (uint32_t p = 0; p < pixels_.size(); ++p) blind_[p] = opens, draw(p, opens);
    for (size_t events = 0; !queue_.empty(); ++events) {
      if (events == kMostEvents)
        throw Error("a pixel would count more than 1e6 events in one gate", "a longer dead time, or a shorter gate");
      const Event e = queue_.top();
      queue_.pop();
      meet(e);
    }
    std::sort(clicks_.begin(), clicks_.end(),
              [](const Click& a, const Click& b) { return a.pixel != b.pixel ? a.pixel < b.pixel : a.time < b.time; });
    return std::move(clicks_);
  }

 private:
  // The next primary of a pixel after t: where the sum of expected ones has grown by an exponential variate.
  void draw(uint32_t pixel, double t) {
    const Expected& e = pixels_[pixel];
    if (!(t < e.grid.stop())) return;
    const std::vector<double>& sum = sums_[pixel];
    const double x = std::max(0.0, (t - e.grid.start) / e.grid.step);
    const auto in = std::min(static_cast<size_t>(x), e.grid.count - 1);
    const double wanted =
        sum[in] + (x - static_cast<double>(in)) * (sum[in + 1] - sum[in]) + exponential_variate(1, random_);
    if (!(wanted < sum.back())) return;
    const auto next = static_cast<size_t>(std::upper_bound(sum.begin(), sum.end(), wanted) - sum.begin());
    const size_t k = next - 1;
    const double n = sum[next] - sum[k];
    const bool signal = random_.uniform() * n < e.signal[k];
    const double time = std::max(t, e.grid.begin_of(k) + (wanted - sum[k]) / n * e.grid.step);
    queue_.push({time, pixel, signal ? Click::Cause::signal : Click::Cause::background, true});
  }
  void meet(const Event& e) {
    const bool sees = e.time >= blind_[e.pixel];
    if (sees) click(e);
    if (sees || spec_.paralysable) blind_[e.pixel] = e.time + spec_.dead;
    // Of a process without memory: what comes in a dead time that it cannot lengthen need not be drawn.
    if (e.primary)
      draw(e.pixel, spec_.paralysable && std::isfinite(spec_.dead) ? e.time : std::max(e.time, blind_[e.pixel]));
  }
  void click(const Event& e) {
    clicks_.push_back({told(e), e.pixel, e.cause});
    const double stop = pixels_[e.pixel].grid.stop();
    if (spec_.afterpulse > 0 && random_.uniform() < spec_.afterpulse) {
      const double t = e.time + exponential_variate(spec_.afterpulse_time, random_);
      if (t < stop) queue_.push({t, e.pixel, Click::Cause::afterpulse, false});
    }
    if (!(spec_.crosstalk > 0)) return;
    const uint32_t column = e.pixel % columns_, n = static_cast<uint32_t>(pixels_.size());
    const auto trigger = [&](bool there, uint32_t pixel) {
      if (there && random_.uniform() < spec_.crosstalk) queue_.push({e.time, pixel, Click::Cause::crosstalk, false});
    };
    trigger(column > 0, e.pixel - 1);
    trigger(column + 1 < columns_ && e.pixel + 1 < n, e.pixel + 1);
    trigger(e.pixel >= columns_, e.pixel - columns_);
    trigger(e.pixel + columns_ < n, e.pixel + columns_);
  }
  double told(const Event& e) {
    double t = e.time;
    if (spec_.jitter > 0) t += spec_.jitter / kFwhmOfDeviation * normal(random_);
    if (spec_.tail > 0 && random_.uniform() < spec_.tail) t += exponential_variate(spec_.tail_time, random_);
    if (!(spec_.resolution > 0)) return t;
    const double start = pixels_[e.pixel].grid.start;
    return start + (std::floor((t - start) / spec_.resolution) + 0.5) * spec_.resolution;
  }

  const CountingSpec& spec_;
  std::span<const Expected> pixels_;
  uint32_t columns_;
  Pcg32& random_;
  std::vector<double> blind_;              // until when
  std::vector<std::vector<double>> sums_;  // of expected primaries before each sample
  std::priority_queue<Event> queue_;
  std::vector<Click> clicks_;
};

}  // namespace

std::vector<Click> count_primaries(const CountingSpec& spec, std::span<const Expected> pixels, uint32_t columns,
                                   Pcg32& random) {
  return Array(spec, pixels, columns, random).run();
}

FirstCount first_count(const Expected& e) {
  FirstCount f;
  f.probability.reserve(e.grid.count);
  double before = 0, first = 0;
  for (size_t k = 0; k < e.grid.count; ++k) {
    const double n = e.signal[k] + e.background, p = std::exp(-before) * -std::expm1(-n);
    f.probability.push_back(p);
    f.any += p, first += p * e.grid.middle(k);
    before += n;
  }
  if (!(f.any > 0)) return f;
  f.mean = first / f.any;
  double second = 0;
  for (size_t k = 0; k < e.grid.count; ++k) {
    const double off = e.grid.middle(k) - f.mean;
    second += f.probability[k] * off * off;
  }
  f.deviation = std::sqrt(second / f.any);
  return f;
}

}  // namespace suite
