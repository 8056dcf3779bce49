#include "scheduler/air_paths.h"

#include <algorithm>
#include <cmath>

#include "air/column.h"
#include "scheduler/sensor_diagnostics.h"

namespace suite {

namespace {

using Row = std::vector<float>;
using Rows = std::vector<Row>;

constexpr double kMostMass = 10, kHighM = 200e3;

double mass_of(double cosine) { return 1 / std::max(std::fabs(cosine), 1 / kMostMass); }

// Adds a value to a list that has none within some 5 % of it.
void add_apart(std::vector<double>& list, double value, size_t most) {
  if (list.size() >= most) return;
  for (const double v : list)
    if (std::fabs(v - value) <= 0.05 * std::max(v, value)) return;
  list.push_back(value);
}

// Where paths go: air masses of suns and of views, and heights of their upper ends over the ground, m.
struct Paths {
  std::vector<double> suns, heights, views;
  std::vector<double> sky;  // air masses of views from the ground up
};

// The optical depth over the ground at each level, per bin, and what the layers scatter and emit.
class Depths {
 public:
  struct Scatterers {
    bool molecules, particles;
  };
  Depths(const AirColumn& column, size_t bins, Scatterers any) : bins_(bins), ground_(column.ground) {
    const std::span<const double> heights = column.shells.heights();
    for (size_t l = ground_; l < heights.size(); ++l) heights_.push_back(heights[l] - heights[ground_]);
    depth_.assign(heights_.size() * bins, 0.0f);
    for (size_t l = 0; l + 1 < heights_.size(); ++l)
      for (size_t i = 0; i < bins; ++i)
        depth_[(l + 1) * bins + i] = depth_[l * bins + i] + column.extinction[(ground_ + l) * bins + i] *
                                                                static_cast<float>(heights_[l + 1] - heights_[l]);
    if (any.molecules) molecules_.assign(layers() * bins, 0.0f);
    if (any.particles) particles_.assign(layers() * bins, 0.0f);
    for (size_t k = 0; k < column.kinds.size(); ++k) {
      Row& scattered = k == 0 && any.molecules ? molecules_ : particles_;
      for (size_t l = 0; l + 1 < heights_.size(); ++l)
        for (size_t i = 0; i < bins; ++i)
          scattered[l * bins + i] +=
              column.kinds[k].scattering[(ground_ + l) * bins + i] * static_cast<float>(heights_[l + 1] - heights_[l]);
    }
    blackbody_.assign(column.blackbody.begin() + static_cast<long>(ground_ * bins), column.blackbody.end());
  }
  size_t layers() const { return heights_.size() - 1; }
  const float* at(size_t level) const { return &depth_[level * bins_]; }
  const float* total() const { return at(layers()); }
  // Layers below a height, and its own depth.
  size_t layers_below(double height) const {
    size_t n = 0;
    while (n < layers() && heights_[n] < height - 1) ++n;
    return n;
  }
  Row up_to(double height) const {
    const size_t n = layers_below(height);
    Row row(at(n), at(n) + bins_);
    if (n == 0 || height >= heights_[n]) return row;
    const auto s = static_cast<float>((height - heights_[n - 1]) / (heights_[n] - heights_[n - 1]));
    for (size_t i = 0; i < bins_; ++i) row[i] = at(n - 1)[i] + s * (at(n)[i] - at(n - 1)[i]);
    return row;
  }
  const Row& molecules() const { return molecules_; }
  const Row& particles() const { return particles_; }
  float blackbody(size_t layer, size_t bin) const {
    return 0.5f * (blackbody_[layer * bins_ + bin] + blackbody_[(layer + 1) * bins_ + bin]);
  }
  Row ground_glow() const { return Row(blackbody_.begin(), blackbody_.begin() + static_cast<long>(bins_)); }
  size_t bins() const { return bins_; }

 private:
  size_t bins_, ground_;
  std::vector<double> heights_;
  Row depth_, molecules_, particles_, blackbody_;
};

// Light along the paths through one column of air.
class PathLight {
 public:
  PathLight(const Depths& depths, const Row& sun, const Paths& paths) : d_(depths), sun_(sun), paths_(paths) {}

  Rows sunlight() const {
    Rows rows;
    if (sun_.empty()) return rows;
    for (const double m : paths_.suns) {
      rows.push_back(per([&](size_t i) { return sun_[i] * pass(m, d_.total()[i]); }));
      for (const double h : paths_.heights) {
        const Row up = d_.up_to(h);
        for (const double v : paths_.views)
          rows.push_back(per([&](size_t i) { return sun_[i] * pass(m, d_.total()[i], v, up[i]); }));
      }
    }
    const double m = paths_.suns.front();
    for (const Row* scattered : {&d_.molecules(), &d_.particles()}) {
      if (scattered->empty()) continue;
      for (const double h : paths_.heights)
        for (const double v : paths_.views) rows.push_back(sent_up(*scattered, m, h, v));
      for (const double v : paths_.sky) rows.push_back(sent_down(*scattered, m, v));
    }
    return rows;
  }
  // What the ground sends up, what the air does, what the air sends down, and that reflected.
  Rows glow() const {
    Rows rows;
    const Row ground = d_.ground_glow();
    for (const double h : paths_.heights) {
      const Row up = d_.up_to(h);
      for (const double v : paths_.views) {
        rows.push_back(per([&](size_t i) { return ground[i] * pass(v, up[i]); }));
        rows.push_back(emitted_up(h, v));
      }
    }
    for (const double v : paths_.sky) rows.push_back(emitted_down(v));
    Row reflected = rows.back();
    for (size_t i = 0; i < d_.bins(); ++i) reflected[i] *= pass(paths_.views.front(), d_.total()[i]);
    rows.push_back(std::move(reflected));
    return rows;
  }

 private:
  static float pass(double mass, float depth) { return std::exp(-static_cast<float>(mass) * depth); }
  static float pass(double mass, float depth, double other, float other_depth) {
    return std::exp(-static_cast<float>(mass) * depth - static_cast<float>(other) * other_depth);
  }
  template <class Value>
  Row per(const Value& value) const {
    Row row(d_.bins());
    for (size_t i = 0; i < row.size(); ++i) row[i] = value(i);
    return row;
  }
  // Scattered once in the layers, the light of the middle of each standing for it.
  Row sent_up(const Row& scattered, double sun, double height, double view) const {
    Row row(d_.bins(), 0.0f);
    const Row up = d_.up_to(height);
    for (size_t l = 0; l < d_.layers_below(height); ++l)
      for (size_t i = 0; i < row.size(); ++i) {
        const float low = d_.at(l)[i], middle = 0.5f * (low + std::min(d_.at(l + 1)[i], up[i]));
        row[i] += sun_[i] * scattered[l * row.size() + i] *
                  pass(sun, d_.total()[i] - middle, view, std::max(0.0f, up[i] - middle));
      }
    return row;
  }
  Row sent_down(const Row& scattered, double sun, double view) const {
    Row row(d_.bins(), 0.0f);
    for (size_t l = 0; l < d_.layers(); ++l)
      for (size_t i = 0; i < row.size(); ++i) {
        const float middle = 0.5f * (d_.at(l)[i] + d_.at(l + 1)[i]);
        row[i] += sun_[i] * scattered[l * row.size() + i] * pass(sun, d_.total()[i] - middle, view, middle);
      }
    return row;
  }
  Row emitted_up(double height, double view) const {
    Row row(d_.bins(), 0.0f);
    const Row up = d_.up_to(height);
    for (size_t l = 0; l < d_.layers_below(height); ++l)
      for (size_t i = 0; i < row.size(); ++i)
        row[i] += d_.blackbody(l, i) * (pass(view, std::max(0.0f, up[i] - d_.at(l + 1)[i])) -
                                        pass(view, std::max(0.0f, up[i] - d_.at(l)[i])));
    return row;
  }
  Row emitted_down(double view) const {
    Row row(d_.bins(), 0.0f);
    for (size_t l = 0; l < d_.layers(); ++l)
      for (size_t i = 0; i < row.size(); ++i)
        row[i] += d_.blackbody(l, i) * (pass(view, d_.at(l)[i]) - pass(view, d_.at(l + 1)[i]));
    return row;
  }

  const Depths& d_;
  const Row& sun_;
  const Paths& paths_;
};

// A height, and how much longer the way down from there is than straight down.
std::string seen_from(double height, double longer) {
  return strf("%.3g km", height / 1000) +
         (longer < 1.0005 ? " straight down" : strf(", %.3g times the way straight down", longer));
}

// Names of the rows, in their order.
std::vector<std::string> sunlight_names(const Paths& p, Depths::Scatterers scatterers) {
  std::vector<std::string> names;
  for (const double m : p.suns) {
    names.push_back(strf("sunlight through %.3g air masses", m));
    for (const double h : p.heights)
      for (const double v : p.views)
        names.push_back(strf("sunlight through %.3g air masses (seen from %s)", m, seen_from(h, v).c_str()));
  }
  for (const auto& [what, any] :
       {std::pair{"molecules", scatterers.molecules}, std::pair{"particles", scatterers.particles}}) {
    if (!any) continue;
    for (const double h : p.heights)
      for (const double v : p.views)
        names.push_back(strf("sunlight that %s scatter below (seen from %s)", what, seen_from(h, v).c_str()));
    for (const double v : p.sky) names.push_back(strf("sky that %s scatter, at %.3g air masses", what, v));
  }
  return names;
}
std::vector<std::string> glow_names(const Paths& p) {
  std::vector<std::string> names;
  for (const double h : p.heights)
    for (const double v : p.views)
      for (const char* what : {"the ground's emission", "emission of the air below"})
        names.push_back(strf("%s (seen from %s)", what, seen_from(h, v).c_str()));
  for (const double v : p.sky) names.push_back(strf("emission downwards of %.3g air masses", v));
  names.push_back("reflected emission of the air");
  return names;
}

// Suns, moons and the sensor's own rays.
struct Own {
  std::vector<double> suns, heights, views;
  Curve sun = Curve::constant(0);
  bool any_sun = false;
};

Own own_paths(std::span<const SourceSpecs> sources, const Sensor& sensor, size_t state) {
  constexpr size_t kSuns = 2, kHeights = 2, kViews = 2;
  Own own;
  double brightest = 0;
  const size_t step = std::max<size_t>(1, sources.size() / 4);
  for (size_t s = 0; s < sources.size(); s += step)
    for (const LightSpecPtr& light : sources[s].lights)
      if (const FarDisk* disk = light->disk()) {
        if (disk->irradiance.max() > brightest) {
          if (disk->irradiance.max() > 100 * brightest) own.suns.clear();  // moonlight beside the sun
          brightest = disk->irradiance.max(), own.sun = disk->irradiance, own.any_sun = true;
        }
        if (disk->irradiance.max() >= 0.01 * brightest) add_apart(own.suns, mass_of(disk->direction.z), kSuns);
      }
  const double ground = sources[0].air->height_of_ground() - sources[0].air->height_of_scene();
  for (const Task& task : sensor.tasks())
    for (const Capture& c : task.captures) {
      if (c.state != state || c.problems() == 0) continue;
      const SensorRay ray = middle_ray(sensor, c, (c.rows / 2) * c.columns + c.columns / 2);
      add_apart(own.heights, std::clamp(ray.ray.origin.z - ground, 10.0, kHighM), kHeights);
      if (ray.receiver == SensorRay::Receiver::none) add_apart(own.views, mass_of(ray.ray.direction.z), kViews);
    }
  return own;
}

Paths paths_of(const Own& own, PathSet set) {
  const bool training = set == PathSet::training;
  Paths p{own.suns, own.heights, own.views, training ? std::vector<double>{1, 5} : std::vector<double>{1.6, 4}};
  const auto add = [](std::vector<double>& to, std::initializer_list<double> more, size_t most) {
    for (const double v : more) add_apart(to, v, most);
  };
  if (own.any_sun)
    add(p.suns, training ? std::initializer_list<double>{1.1, 6} : std::initializer_list<double>{1.8, 4.5}, 3);
  add(p.heights,
      training ? std::initializer_list<double>{kHighM, 800, 3500} : std::initializer_list<double>{kHighM, 1800}, 4);
  add(p.views, training ? std::initializer_list<double>{1, 4} : std::initializer_list<double>{1.4, 3}, 3);
  return p;
}

// Through which air lights other than disks are seen: a vertical air mass, up to a height, m. Lamps may be near.
struct Way {
  double mass, height;
};
std::vector<Way> ways_of(const Paths& p) {
  std::vector<Way> ways{{0, kHighM}, {p.views.front(), p.heights.front()}};
  for (const double m : p.sky) ways.push_back({m, kHighM});
  return ways;
}

// A light's spectra through each of the ways.
Rows through(const Rows& lights, const Depths& depths, const std::vector<Way>& ways) {
  Rows rows;
  for (const Way& way : ways) {
    const Row up = depths.up_to(way.height);
    for (Row light : lights) {
      for (size_t i = 0; i < light.size(); ++i) light[i] *= std::exp(-static_cast<float>(way.mass) * up[i]);
      rows.push_back(std::move(light));
    }
  }
  return rows;
}

}  // namespace

struct AirPaths::Shared {
  AirSpec air, clear;  // with gases and without
  Own own;
  std::vector<LightSpectra> others;  // lights but for disks
  Depths::Scatterers any = {false, false};

  struct Made {
    std::vector<double> key;
    std::unique_ptr<const Depths> with, without;
    Row sun;
  };
  std::vector<std::shared_ptr<const Made>> made;  // the last few
  std::mutex guard;

  std::shared_ptr<const Made> of(const SpectralState& state) {
    const std::lock_guard lock(guard);
    std::vector<double> key = state.key();
    for (const auto& m : made)
      if (m->key == key) return m;
    auto m = std::make_shared<Made>();
    m->key = std::move(key);
    m->with = std::make_unique<Depths>(bake_column(air, state, ColumnParts::extinction), state.size(), any);
    SpectralState plain = state;
    for (Bin& b : plain.bins) b.g = 0;
    m->without = std::make_unique<Depths>(bake_column(clear, plain, ColumnParts::extinction), state.size(), any);
    if (own.any_sun) m->sun = state.sample(own.sun);
    for (float& s : m->sun) s /= static_cast<float>(kPi);
    constexpr size_t kKept = 3;
    if (made.size() >= kKept) made.erase(made.begin());
    made.push_back(m);
    return m;
  }
};

AirPaths::AirPaths(std::span<const SourceSpecs> sources, const Sensor& sensor, size_t state)
    : shared_(std::make_shared<Shared>()) {
  shared_->air = shared_->clear = *sources[0].air;
  shared_->clear.gases = nullptr;
  shared_->own = own_paths(sources, sensor, state);
  for (const LightSpecPtr& light : sources[0].lights)
    if (!light->disk()) light->add_spectra(shared_->others);
  shared_->any = {shared_->air.molecules, shared_->air.aerosol || !shared_->air.clouds.empty()};
}
AirPaths::~AirPaths() = default;
AirPaths::AirPaths(AirPaths&&) noexcept = default;

std::vector<SeenSpectra> AirPaths::spectra(PathSet set) const {
  std::vector<SeenSpectra> seen;
  const auto add = [&](SpectrumRole role, std::vector<std::string> names, auto rows) {
    if (names.empty()) return;
    const auto with = [s = shared_, rows](const SpectralState& state) {
      const auto made = s->of(state);
      return rows(*made->with, made->sun);
    };
    const auto without = [s = shared_, rows, role](const SpectralState& state) {
      const auto made = s->of(state);
      Rows of = rows(*made->without, made->sun);
      // Air without gases emits next to nothing: what it may be is held to a tenth of the ground's emission.
      const Row ground = made->without->ground_glow();
      constexpr float kTenth = 10;  // of a hundred
      if (role == SpectrumRole::glow)
        for (Row& row : of) {
          row = ground;
          for (float& v : row) v *= kTenth;
        }
      return of;
    };
    seen.push_back({role, std::move(names), with, without});
  };
  const Paths paths = paths_of(shared_->own, set);
  if (shared_->own.any_sun)
    add(SpectrumRole::light, sunlight_names(paths, shared_->any),
        [paths, s = shared_](const Depths& d, const Row& sun) { return PathLight(d, sun, paths).sunlight(); });
  add(SpectrumRole::glow, glow_names(paths),
      [paths](const Depths& d, const Row& sun) { return PathLight(d, sun, paths).glow(); });
  for (const LightSpectra& other : shared_->others) {
    const std::vector<Way> ways = ways_of(paths);
    SeenSpectra of{SpectrumRole::light, {}, {}};
    for (const Way& way : ways)
      for (const std::string& name : other.names)
        of.names.push_back(strf("%s (seen from %s)", name.c_str(), seen_from(way.height, way.mass).c_str()));
    of.over = [s = shared_, over = other.over, ways](const SpectralState& state) {
      return through(over(state), *s->of(state)->with, ways);
    };
    of.unabsorbed = [s = shared_, over = other.over, ways](const SpectralState& state) {
      return through(over(state), *s->of(state)->without, ways);
    };
    seen.push_back(std::move(of));
  }
  return seen;
}

std::vector<double> AirPaths::key() const {
  std::vector<double> key = shared_->own.heights;
  key.push_back(-1);  // no height and no air mass
  key.insert(key.end(), shared_->own.views.begin(), shared_->own.views.end());
  return key;
}

std::vector<float> AirPaths::gas_depth(const SpectralState& state) const {
  const auto made = shared_->of(state);
  std::vector<float> depth(made->with->total(), made->with->total() + state.size());
  for (size_t i = 0; i < depth.size(); ++i) depth[i] = std::max(0.0f, depth[i] - made->without->total()[i]);
  return depth;
}

}  // namespace suite
