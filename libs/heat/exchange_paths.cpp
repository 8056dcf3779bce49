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
    changing_ = begin < faces_.size() ? elements_.changing() : nullptr;  // of faces it is to be found
    for (size_t row = begin; row < end; ++row) start(static_cast<uint32_t>(row));
    walk(
        tracer_, going_, rays_, hits_, false, trace_,
        [this](Going& path, Ray& ray, const Hit& hit, uint32_t n) { return go_on(path, ray, hit, n); }, [] {});
  }
  uint64_t rays() const { return trace_.rays; }
  double unfinished() const { return unfinished_; }

 private:
  PathNumbers numbers_of(uint32_t slot) const {
    const uint32_t each = options_.blocks * options_.paths;
    return {options_, kPurpose, out_.rows.face(slot / each), slot % each};
  }

  void start(uint32_t row) {
    const uint32_t each = options_.blocks * options_.paths, face = out_.rows.face(row),
                   interval = out_.rows.interval(row);
    const std::optional<TimeSpan> window = path_window(tracer_, elements_, interval);
    double emissivity = 0;
    for (uint32_t k = 0; k < each; ++k) {
      const uint32_t slot = row * each + k;
      const PathNumbers numbers = numbers_of(slot);
      const Hit hit =
          elements_.point(faces_.element(face), {numbers.net(), numbers.sample(), kPointBlock, 0, 1, interval});
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
          {tracer_.leave(hit, d), d, time_of_path(window, numbers.net(), numbers.sample(), hit.time), slot});
    }
    if (interval == 0) out_.emissivity[face] = emissivity / each;
    if (emissivity == 0) {  // it neither emits nor takes anything: whatever its row is
      out_.weights[row * each] = 1;
    }
    // Whatever changes around what changes its place.
    if (interval == 0 && elements_.changing() && elements_.changes_place(faces_.element(face)))
      out_.rows.changing[face] = 1;
  }

  void finish(const Going& path, uint32_t end) {
    out_.ends[path.slot] = end;
    out_.weights[path.slot] = static_cast<float>(path.weight);
  }

  // False when the path has ended.
  bool go_on(Going& path, Ray& ray, const Hit& hit, uint32_t n) {
    if (changing_ && changing_->meets(ray, hit.hit() ? hit.distance : INFINITY))
      out_.rows.changing[path.slot / (options_.blocks * options_.paths)] = 1;
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
  const ChangingRoom* changing_ = nullptr;
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

ExchangePaths ExchangePaths::in_interval(size_t interval) const {
  ExchangePaths out;
  out.blocks = blocks, out.paths = paths, out.emissivity = emissivity, out.area = area;
  out.rows.faces = faces();
  out.presence = {presence[interval]};
  const size_t each = size_t{blocks} * paths;
  out.ends.resize(faces() * each), out.weights.resize(faces() * each);
  for (size_t f = 0; f < faces(); ++f) {
    const size_t from = rows.row(f, interval) * each;
    std::copy_n(&ends[from], each, &out.ends[f * each]);
    std::copy_n(&weights[from], each, &out.weights[f * each]);
  }
  return out;
}

void ExchangePaths::make_more() {
  rows.add_more();
  const size_t each = size_t{blocks} * paths;
  if (rows.size() * each >= UINT32_MAX)
    throw Error(
        strf("%zu faces with %zu paths each, which see things that move or come and go, in %zu intervals of rest "
             "are more paths than there can be",
             rows.faces, each, rows.intervals),
        "2^32 at most: fewer elements or paths, or 'geometry_intervals: 1'");
  ends.resize(rows.size() * each), weights.resize(rows.size() * each);
}

ExchangePaths untraced_exchange(const Elements& elements, const HeatFaces& faces, const PathOptions& options) {
  ExchangePaths out;
  out.blocks = options.blocks, out.paths = options.paths;
  out.rows = rows_of_faces(elements, faces.size());
  const size_t each = size_t{options.blocks} * options.paths;
  SUITE_CHECK(each > 0 && options.paths % 2 == 0 && faces.size() * each < UINT32_MAX);
  out.ends.resize(faces.size() * each), out.weights.resize(faces.size() * each);
  out.emissivity.resize(faces.size());
  for (size_t f = 0; f < faces.size(); ++f) out.area.push_back(elements[faces.element(f)].area);
  for (size_t k = 0; k < out.rows.intervals; ++k) {
    const std::vector<float> of_elements = elements.presence(k);
    out.presence.emplace_back();
    for (size_t f = 0; f < faces.size() && !of_elements.empty(); ++f)
      out.presence.back().push_back(of_elements[faces.element(f)]);
  }
  return out;
}

void trace_exchange(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                    const PathOptions& options, FaceRange range, ExchangePaths& out,
                    const std::function<void(size_t)>& progress) {
  constexpr size_t kWave = ExchangePaths::kTogether;
  const auto [first_row, end_row] = out.rows.alike(range.begin);
  SUITE_CHECK((range.begin - first_row) % kWave == 0 && range.end <= end_row &&
              ((range.end - first_row) % kWave == 0 || range.end == end_row));
  range = {range.begin - first_row, range.end - first_row};
  std::atomic<uint64_t> rays{0}, unfinished{0};
  // Waves are always the same: rays that go together may decide the last bits of a hit.
  parallel_for(range.begin / kWave, (range.end + kWave - 1) / kWave, 1, [&](size_t first, size_t last) {
    const FlushDenormals denormals;
    const AtWork work(tracer);
    for (size_t w = first; w < last; ++w) {
      Wave wave(tracer, elements, faces, optics, options, out);
      wave.run(first_row + w * kWave, std::min(end_row, first_row + (w + 1) * kWave));
      rays += wave.rays();
      unfinished += static_cast<uint64_t>(wave.unfinished() * kUnfinishedUnit);
    }
    if (progress) progress(std::min(end_row - first_row, last * kWave) - first * kWave);
  });
  out.count += {rays, unfinished};
}

ExchangePaths trace_exchange(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                             const HeatOptics& optics, const PathOptions& options,
                             const std::function<void(size_t)>& progress) {
  ExchangePaths out = untraced_exchange(elements, faces, options);
  trace_exchange(tracer, elements, faces, optics, options, {0, faces.size()}, out, progress);
  out.make_more();
  if (const size_t all = out.rows.size(); all > faces.size())
    trace_exchange(tracer, elements, faces, optics, options, {faces.size(), all}, out, progress);
  return out;
}

}  // namespace suite
