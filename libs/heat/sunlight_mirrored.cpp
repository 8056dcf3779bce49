#include "heat/sunlight_mirrored.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "heat/heat_walk.h"
#include "heat/made_of.h"
#include "heat/mirror_places.h"

namespace suite {

namespace {

constexpr uint64_t kSunlightMirroredPurpose = 0x6d697272;
constexpr uint32_t kMirroredRouletteFrom = 2;  // surfaces
constexpr double kMostPoints = 1 << 14;        // of a place, in a block at a moment
constexpr uint32_t kDrawBlock = 2;             // of random numbers, from here on: surfaces on the way

struct Deposit {
  uint32_t face, block, moment;
  double watts;  // of 1 W/m2
};

// The sun over all moments, and between them.
class Suns {
 public:
  explicit Suns(const SunCourse& course) : radius_(course.angular_radius) {
    for (const double t : course.moments) suns_.push_back(course.towards(t));
    for (uint32_t m = 0; m < suns_.size(); ++m)
      if (suns_[m].z > 0) up_.push_back(m);
  }
  const std::vector<uint32_t>& up() const { return up_; }
  Dir middle(uint32_t m) const { return suns_[m]; }
  // At `away` steps (-1 to 1) from a moment; beyond the first and last one mirrored back.
  Dir near(uint32_t m, double away, Vec2 disk) const {
    if ((m == 0 && away < 0) || (m + 1 == suns_.size() && away > 0)) away = -away;
    const double share = std::fabs(away);
    const Dir other = suns_.size() == 1 ? suns_[m] : suns_[away < 0 ? m - 1 : m + 1];
    return on_disk(Frame::around(normalized(suns_[m] * (1 - share) + other * share)), disk.x, disk.y, radius_);
  }

 private:
  double radius_;
  std::vector<Dir> suns_;
  std::vector<uint32_t> up_;
};

// The working memory of one thread.
class Follower {
 public:
  Follower(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
           const SunCourse& course, const Suns& suns, const PathOptions& options)
      : tracer_(tracer),
        elements_(elements),
        faces_(faces),
        course_(course),
        suns_(suns),
        options_(options),
        surface_(tracer, *optics.sun),
        bins_(optics.sun->state().size()),
        knots_(optics.sun->state().knots.size()),
        W_(bins_),
        back_(bins_),
        walk_(optics.sun->state()) {}

  // Light of one moment that reaches a place. density: points for a m2 in every block.
  void follow(const MirrorPlaces& places, size_t place, uint32_t moment, double density, std::vector<Deposit>& out) {
    out_ = &out;
    const MirrorPlaces::Patch patch = places.patch(place, suns_.middle(moment));
    if (!(patch.area > 0)) return;
    const double facing = places.is_endless(place) ? std::fabs(suns_.middle(moment).z) : 1;
    const auto points = static_cast<uint32_t>(std::clamp(std::ceil(patch.area * facing * density), 1.0, kMostPoints));
    begin(places, patch, place, moment, points);
    blocked_.assign(sights_.size(), 0), reach_.assign(sights_.size(), INFINITY);
    tracer_.occluded(sights_, reach_, blocked_, true, trace_);
    size_t kept = 0;
    for (size_t i = 0; i < going_.size(); ++i)
      if (!blocked_[i]) going_[kept] = going_[i], rays_[kept] = rays_[i], ++kept;
    going_.resize(kept), rays_.resize(kept);
    walk(
        tracer_, going_, rays_, hits_, false, trace_,
        [this](Going& path, Ray& ray, const Hit& hit, uint32_t n) { return go_on(path, ray, hit, n); }, [] {});
  }
  uint64_t rays() const { return trace_.rays; }
  double sent() const { return sent_; }
  double unfinished() const { return unfinished_; }

 private:
  struct Going {
    uint64_t key;  // of the stream of numbers
    uint32_t block, moment, sample, spectrum;
    WalkDensities drawn;
    double start;  // m, of the first ray to its mirror
    double power;  // W, at the start, of the bin with most
  };

  void begin(const MirrorPlaces& places, const MirrorPlaces::Patch& patch, size_t place, uint32_t moment,
             uint32_t points) {
    going_.clear(), rays_.clear(), sights_.clear(), spectra_.clear();
    const double area = patch.area / (1.0 * options_.blocks * points);
    const double step = course_.moments.size() > 1 ? course_.moments[1] - course_.moments[0] : 0;
    for (uint32_t b = 0; b < options_.blocks; ++b)
      for (uint32_t k = 0; k < points; ++k) {
        Going path;
        path.key = SampleStream::problem_key(options_.seed, kSunlightMirroredPurpose, place);
        path.block = b, path.moment = moment, path.sample = moment * points + k;
        const SampleStream numbers(path.key, b);
        const std::array<double, 4> u = numbers.draw(path.sample, 0), v = numbers.draw(path.sample, 1);
        const Hit hit = places.point(patch, {numbers, path.sample, kPointBlock});
        // The straight lines between moments weigh those around a moment by a hat.
        const double away = u[3] + v[0] - 1;
        const Dir d = suns_.near(moment, away, disk_from_square({u[0], u[1]}));
        if (!(d.z > 0)) continue;
        const double facing = std::fabs(dot(d, hit.normal)), watts = area * facing;
        if (!(watts > 0)) continue;
        path.drawn.start(u[2], knots_);
        path.spectrum = static_cast<uint32_t>(spectra_.size() / bins_);
        path.power = 0;
        for (const float share : course_.beam[moment]) {
          spectra_.push_back(static_cast<float>(watts * double{share}));
          path.power = std::max(path.power, watts * double{share});
        }
        const double t =
            std::clamp(course_.moments[moment] + away * step, course_.moments.front(), course_.moments.back());
        const auto number = static_cast<uint32_t>(hash_of(path.key, b, path.sample));
        sights_.push_back({tracer_.leave(hit, d), d, t, number});
        // From just off the mirror on to it: where it has a hole or is away nothing is mirrored.
        const double off = 16 * double{hit.step};
        path.start = off / facing;
        rays_.push_back({hit.position + d * path.start, -d, t, number});
        going_.push_back(path);
        sent_ += watts;
      }
  }

  // How the light of a ray goes on from a surface. Nothing: not at all.
  std::optional<Dir> scatter(Going& path, const ScatterModel& model, Dir out, uint32_t n) {
    const SampleStream numbers(path.key, path.block);
    const std::array<double, 4> u = numbers.draw(path.sample, kDrawBlock + n);
    const auto drawn = walk_.draw(model, out, u, path.drawn.knot);
    if (!drawn || (n == 0 && !drawn->delta)) return std::nullopt;
    if (out.z * drawn->in.z < 0) to_power(model, out, *drawn, path.drawn.knot);
    const std::span<float> T = throughput(path);
    const double most = walk_.take(path.drawn, T);
    if (!(most > 0)) return std::nullopt;
    const double left = most * path.drawn.weight(knots_) / path.power;
    if (n >= kMostReflections) {
      unfinished_ += left * path.power;
      return std::nullopt;
    }
    if (n >= kMirroredRouletteFrom && !SurfaceWalk::survives(T, left, u[3])) return std::nullopt;
    return drawn->in;
  }

  // Weights of radiance across an interface as weights of power.
  void to_power(const ScatterModel& model, Dir out, const ScatterModel::Sample& drawn, int knot) {
    const std::span<float> w = walk_.weights();
    if (drawn.delta) {
      model.delta_weight(drawn.in, drawn.lobe, knot, back_);
      for (size_t i = 0; i < bins_; ++i) w[i] = std::sqrt(w[i] * back_[i]);
      return;
    }
    model.eval(drawn.in, out, back_);
    const auto cosines = static_cast<float>(std::fabs(drawn.in.z / out.z));
    for (size_t i = 0; i < bins_; ++i) w[i] = back_[i] * cosines;
  }

  bool go_on(Going& path, Ray& ray, const Hit& hit, uint32_t n) {
    if (!hit.hit() || (n == 0 && hit.distance > 2 * path.start)) return false;
    surface_.interact(hit, -ray.direction, at_, ray.time);
    if (!at_.baked || !at_.baked->model) {
      ray.origin = tracer_.leave(hit, ray.direction);
      return n > 0;
    }
    const Dir out = at_.frame.to_local(-ray.direction);
    if (n > 0) absorb(path, *at_.baked->model, out, faces_.end_at(hit, ray.direction, at_.material), hit);
    const std::optional<Dir> in = scatter(path, *at_.baked->model, out, n);
    if (!in) return false;
    const Dir d = at_.frame.to_world(*in);
    ray.origin = tracer_.leave(hit, d), ray.direction = d;
    return true;
  }

  // What a face keeps; the mirror's own share of the first light is part of the beam.
  void absorb(const Going& path, const ScatterModel& model, Dir out, uint32_t face, const Hit& hit) {
    if (face >= faces_.size() || !elements_.covers(hit)) return;
    model.total(out, W_);
    const std::span<const float> T = throughput(path);
    double watts = 0;
    for (size_t i = 0; i < bins_; ++i) watts += double{T[i]} * (1 - double{std::min(1.0f, W_[i])});
    watts *= path.drawn.weight(knots_);
    if (watts > 0) out_->push_back({face, path.block, path.moment, watts});
  }

  std::span<float> throughput(const Going& path) { return {&spectra_[size_t{path.spectrum} * bins_], bins_}; }

  const Tracer& tracer_;
  const Elements& elements_;
  const HeatFaces& faces_;
  const SunCourse& course_;
  const Suns& suns_;
  const PathOptions& options_;
  Surface surface_;
  size_t bins_, knots_;
  Interaction at_;
  std::vector<float> W_, back_, spectra_;
  SurfaceWalk walk_;
  TraceStatistics trace_;
  std::vector<Going> going_;
  std::vector<Ray> rays_, sights_;
  std::vector<Hit> hits_;
  std::vector<double> reach_;
  std::vector<uint8_t> blocked_;
  std::vector<Deposit>* out_ = nullptr;
  double sent_ = 0, unfinished_ = 0;  // W
};

// A place and the moments at which it is looked at by one thread.
struct Task {
  size_t place;
  std::span<const uint32_t> moments;
};

std::vector<Task> tasks_of(const MirrorPlaces& places, const std::vector<uint32_t>& moments) {
  std::vector<Task> tasks;
  for (size_t p = 0; p < places.size(); ++p) {
    if (!places.is_endless(p)) {
      tasks.push_back({p, moments});
      continue;
    }
    for (const uint32_t& m : moments) tasks.push_back({p, {&m, 1}});
  }
  return tasks;
}

// What is found, with room to add: of all faces and moments, and what they have of blocks.
struct Sums {
  std::vector<float> beam, of_block;
};

void add(const std::vector<Deposit>& deposits, const Elements& elements, const HeatFaces& faces, const Sunlight& light,
         Sums& out) {
  for (const Deposit& d : deposits) {
    const double value = d.watts / elements[faces.element(d.face)].area;
    out.beam[size_t{d.face} * light.moments + d.moment] += static_cast<float>(value);
    out.of_block[(size_t{d.face} * light.blocks + d.block) * Sunlight::kParts +
                 d.moment * Sunlight::kParts / light.moments] += static_cast<float>(value * light.blocks);
  }
}

// Blocks of mirrors' points are independent of each other as wholes: what they differ by from their mean stands for
// halves' differences, so that it has the same weight.
void put(const Sums& sums, Sunlight& out) {
  constexpr uint32_t kParts = Sunlight::kParts;
  const double blocks = out.blocks, scale = blocks > 1 ? std::sqrt(blocks / (blocks - 1)) : 0;
  std::array<float, kParts> of_block{}, mean{};
  for (size_t f = 0; f < out.faces(); ++f) {
    const float* found = &sums.of_block[f * out.blocks * kParts];
    for (uint32_t p = 0; p < kParts; ++p) {
      double sum = 0;
      for (uint32_t b = 0; b < out.blocks; ++b) sum += double{found[b * kParts + p]};
      mean[p] = static_cast<float>(sum / blocks);
    }
    for (uint32_t b = 0; b < out.blocks; ++b) {
      out.beam_of_block.get(f * out.blocks + b, of_block);
      for (uint32_t p = 0; p < kParts; ++p)
        of_block[p] += static_cast<float>(scale) * (found[b * kParts + p] - mean[p]);
      out.beam_of_block.set(f * out.blocks + b, of_block);
    }
  }
  std::vector<float> row(out.moments);
  for (size_t f = 0; f < out.faces(); ++f) {
    out.beam.get(f, row);
    for (size_t k = 0; k < row.size(); ++k) row[k] += sums.beam[f * row.size() + k];
    out.beam.set(f, row);
  }
  out.beam_by_mirrors = CompactRows(sums.beam, out.moments);
}

}  // namespace

void add_mirrored_sunlight(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                           const HeatOptics& optics, const SunCourse& course, const PathOptions& options,
                           Sunlight& out) {
  std::vector<bool> mirrors(optics.materials->materials.size(), false);
  for (uint32_t m = 0; m < mirrors.size(); ++m)
    if (const ScatterModel* model = optics.sun->material(m).model) mirrors[m] = model->has_delta();
  if (std::ranges::find(mirrors, true) == mirrors.end()) return;
  const MirrorPlaces places(tracer, elements, mirrors, course.moments.front());
  const Suns suns(course);
  out.mirrored = {places.size() - places.endless(), places.endless(), places.moving()};
  if (places.size() == 0) return;
  Sums sums{std::vector<float>(faces.size() * out.moments),
            std::vector<float>(out.beam_of_block.rows() * Sunlight::kParts)};
  const std::vector<Task> tasks = tasks_of(places, suns.up());
  // A ray a moment for every four paths of an element.
  const double density = (options.paths + 3) / 4 * static_cast<double>(elements.size()) / elements.total_area();
  // What is found is added up in the order of the tasks, a batch of them at a time.
  constexpr size_t kBatch = 64;
  double sent = 0, unfinished = 0;
  for (size_t begin = 0; begin < tasks.size(); begin += kBatch) {
    const size_t end = std::min(tasks.size(), begin + kBatch);
    std::vector<std::vector<Deposit>> found(end - begin);
    std::vector<std::array<double, 3>> told(end - begin);  // rays, W sent, W left
    parallel_for(begin, end, 1, [&](size_t first, size_t last) {
      const FlushDenormals denormals;
      const AtWork work(tracer);
      for (size_t t = first; t < last; ++t) {
        Follower follower(tracer, elements, faces, optics, course, suns, options);
        for (const uint32_t m : tasks[t].moments) follower.follow(places, tasks[t].place, m, density, found[t - begin]);
        told[t - begin] = {static_cast<double>(follower.rays()), follower.sent(), follower.unfinished()};
      }
    });
    for (size_t t = 0; t < found.size(); ++t) {
      add(found[t], elements, faces, out, sums);
      out.count.rays += static_cast<uint64_t>(told[t][0]), sent += told[t][1], unfinished += told[t][2];
    }
  }
  put(sums, out);
  if (sent > 0) out.mirrored.unfinished = unfinished / sent;
}

}  // namespace suite
