#include "heat/exchange_paths.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "heat/heat_walk.h"
#include "heat/path_numbers.h"

namespace suite {

namespace {

constexpr uint64_t kPurpose = 0x6c6f6e67;  // of the random numbers
constexpr double kUnfinishedUnit = 1e6;

struct Going {
  uint32_t slot;  // of its end
  uint8_t bin;
  double weight;
  double until = 0, left = 1;  // it ends where no more than `until` of what set out would be left
};

// Faces that go together.
class Wave {
 public:
  Wave(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
       const PathOptions& options, ExchangePaths& out)
      : tracer_(tracer),
        elements_(elements),
        faces_(faces),
        options_(options),
        surface_(tracer, *optics.glow),
        out_(out),
        W_(optics.glow->state().size()),
        walk_(optics.glow->state()) {}

  void run(size_t begin, size_t end) {
    going_.clear(), rays_.clear();
    for (size_t f = begin; f < end; ++f) start(static_cast<uint32_t>(f));
    fly(
        tracer_, going_, rays_, hits_, trace_,
        [this](Going& path, Ray& ray, const Hit& hit, uint32_t n) { return go_on(path, ray, hit, n); }, [] {});
  }
  uint64_t rays() const { return trace_.rays; }
  double unfinished() const { return unfinished_; }

 private:
  PathNumbers numbers_of(uint32_t slot) const {
    const uint32_t each = options_.blocks * options_.paths;
    return {options_, kPurpose, slot / each, slot % each};
  }

  void start(uint32_t face) {
    const uint32_t each = options_.blocks * options_.paths;
    double emissivity = 0;
    for (uint32_t k = 0; k < each; ++k) {
      const uint32_t slot = face * each + k;
      const PathNumbers numbers = numbers_of(slot);
      const Hit hit = elements_.point(faces_.element(face), {numbers.net(), numbers.sample(), kPointBlock});
      const std::array<double, 4> u = numbers.net().draw(numbers.sample(), 0);
      const Dir normal = faces_.is_back(face) ? -hit.normal : hit.normal;
      const Dir d = normalized(Frame::around(normal).to_world(cosine_hemisphere(numbers.first_direction())));
      surface_.interact(hit, d, at_, hit.time);
      if (at_.baked && at_.baked->model)
        at_.baked->model->total(at_.frame.to_local(d), W_);
      else
        std::fill(W_.begin(), W_.end(), 0.0f);
      double sum = 0;
      for (float& w : W_) sum += 1 - std::min(1.0f, w);
      out_.weights[slot] = 0, out_.ends[slot] = face;
      emissivity += sum / static_cast<double>(W_.size());
      if (!(sum > 0)) continue;
      double left = u[2] * sum;
      uint8_t bin = 0;
      while (bin + 1u < W_.size() && left >= 1 - std::min(1.0f, W_[bin])) left -= 1 - std::min(1.0f, W_[bin]), ++bin;
      going_.push_back({slot, bin, sum / static_cast<double>(W_.size()), u[3]});
      rays_.push_back(
          {tracer_.leave(hit, d), d, time_of_path(tracer_, numbers.net(), numbers.sample(), hit.time), slot});
    }
    out_.emissivity[face] = emissivity / each;
    if (emissivity == 0) {  // it neither emits nor takes anything: whatever its row is
      out_.weights[face * each] = 1;
    }
  }

  void finish(const Going& path, uint32_t end) {
    out_.ends[path.slot] = end;
    out_.weights[path.slot] = static_cast<float>(path.weight);
  }

  // False when the path has ended.
  bool go_on(Going& path, Ray& ray, const Hit& hit, uint32_t n) {
    if (!hit.hit()) {
      finish(path, ray.direction.z > 0 ? faces_.outside_ring(HeatFaces::ring(ray.direction)) : faces_.outside_below());
      return false;
    }
    surface_.interact(hit, -ray.direction, at_, ray.time);
    if (!at_.baked || !at_.baked->model) {  // nothing that light takes notice of
      ray.origin = tracer_.leave(hit, ray.direction);
      return true;
    }
    const Dir out = at_.frame.to_local(-ray.direction);
    at_.baked->model->total(out, W_);
    const double kept = std::min(1.0f, W_[path.bin]);
    const PathNumbers numbers = numbers_of(path.slot);
    const std::array<double, 4> u = numbers.net().draw(numbers.sample(), 1 + n);
    const bool last = n >= kMostReflections;
    path.left *= kept;
    if (path.left <= path.until || last) {
      if (last) unfinished_ += path.weight;
      finish(path, faces_.end_at(hit, ray.direction, at_.material));
      return false;
    }
    const auto in = walk_.reflect(*at_.baked->model, out, u, path.bin);
    if (!in) {  // drawn in vain: the others of its kind make up for it
      finish({path.slot, path.bin, 0}, faces_.outside_below());
      return false;
    }
    path.weight *= in->weight / kept;
    const Dir d = at_.frame.to_world(in->direction);
    ray.origin = tracer_.leave(hit, d), ray.direction = d;
    return true;
  }

  const Tracer& tracer_;
  const Elements& elements_;
  const HeatFaces& faces_;
  const PathOptions& options_;
  Surface surface_;
  ExchangePaths& out_;
  Interaction at_;
  std::vector<float> W_;
  OneBinWalk walk_;
  TraceStatistics trace_;
  std::vector<Going> going_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  double unfinished_ = 0;
};

}  // namespace

double ExchangePaths::unfinished() const {
  return static_cast<double>(count.unfinished) / kUnfinishedUnit / static_cast<double>(weights.size());
}

ExchangePaths untraced_exchange(const Elements& elements, const HeatFaces& faces, const PathOptions& options) {
  ExchangePaths out;
  out.blocks = options.blocks, out.paths = options.paths;
  const size_t each = size_t{options.blocks} * options.paths;
  SUITE_CHECK(each > 0 && options.paths % 2 == 0 && faces.size() * each < UINT32_MAX);
  out.ends.resize(faces.size() * each), out.weights.resize(faces.size() * each);
  out.emissivity.resize(faces.size());
  for (size_t f = 0; f < faces.size(); ++f) out.area.push_back(elements[faces.element(f)].area);
  return out;
}

void trace_exchange(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                    const PathOptions& options, FaceRange range, ExchangePaths& out,
                    const std::function<void(size_t)>& progress) {
  constexpr size_t kWave = ExchangePaths::kTogether;
  SUITE_CHECK(range.begin % kWave == 0 && (range.end % kWave == 0 || range.end == faces.size()));
  std::atomic<uint64_t> rays{0}, unfinished{0};
  // Waves are always the same: rays that go together may decide the last bits of a hit.
  parallel_for(range.begin / kWave, (range.end + kWave - 1) / kWave, 1, [&](size_t first, size_t last) {
    const FlushDenormals denormals;
    const AtWork work(tracer);
    for (size_t w = first; w < last; ++w) {
      Wave wave(tracer, elements, faces, optics, options, out);
      wave.run(w * kWave, std::min(faces.size(), (w + 1) * kWave));
      rays += wave.rays();
      unfinished += static_cast<uint64_t>(wave.unfinished() * kUnfinishedUnit);
    }
    if (progress) progress(std::min(faces.size(), last * kWave) - first * kWave);
  });
  out.count += {rays, unfinished};
}

ExchangePaths trace_exchange(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                             const HeatOptics& optics, const PathOptions& options,
                             const std::function<void(size_t)>& progress) {
  ExchangePaths out = untraced_exchange(elements, faces, options);
  trace_exchange(tracer, elements, faces, optics, options, {0, faces.size()}, out, progress);
  return out;
}

}  // namespace suite
