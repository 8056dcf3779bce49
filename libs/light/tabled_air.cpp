#include "light/tabled_air.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "light/environment.h"
#include "light/sky_table.h"

namespace suite {

namespace {

constexpr double kNoGround = std::numeric_limits<double>::infinity();
constexpr double kOpaque = 1e-6;    // transmittance below which nothing is seen of what lies behind
constexpr double kRounding = 1e-9;  // of wavelengths, relative
constexpr double kPencil = 1e-4;    // rad: directions so near to a collimated sun are towards it
constexpr double kSkyStep = 18e3;   // m: one sky for all heights of a SkyTable
using Row = std::vector<float>;

Row row_of(const std::vector<double>& values) { return {values.begin(), values.end()}; }

// The table of means over the bins of a state.
std::optional<SightTable> over_bins(const std::optional<SightTable>& runs, const SpectralState& state,
                                    const Where& where) {
  if (!runs) return std::nullopt;
  std::vector<std::pair<double, double>> intervals;
  // What ends where the table ends may do so a rounding later.
  const double low = runs->table.wavelength_um().front(), high = runs->table.wavelength_um().back();
  const auto rounded = [](double a, double to) { return std::fabs(a - to) <= kRounding * to ? to : a; };
  for (const Bin& b : state.bins) intervals.emplace_back(rounded(b.low_um, low), rounded(b.high_um, high));
  try {
    SightTable means = *runs;
    means.table = runs->table.averaged(intervals);
    return means;
  } catch (const Error& e) {
    throw Error(where, e.message(), e.hint());
  }
}

// Below the least range of the runs nothing is known of two ways.
void keep_from_short(const SightTable& runs, std::vector<double>& place) {
  for (size_t a = 0; a < place.size(); ++a)
    if (runs.axes[a] == SightAxis::range) place[a] = std::max(place[a], runs.least_range);
}

class TabledAir final : public Atmosphere {
 public:
  TabledAir(const TabledAirSpec& spec, const SpectralState& state, const std::optional<TabledSun>& sun)
      : where_(spec.where),
        world_(spec.world(sun ? std::optional(normalized(sun->beam.direction)) : std::nullopt)),
        from_(spec.from),
        bins_(state.size()),
        knots_(state.knots),
        sights_(over_bins(spec.sights, state, where_)),
        sky_(over_bins(spec.sky, state, where_)),
        two_way_(spec.two_way()) {
    if (sun) bake_sun(*sun, over_bins(spec.sun, state, where_));
    if (sky_) tabulate_sky();
  }

  void transmittance(Vec3 from, Dir d, double distance, std::span<float> T) const override {
    if (distance == kNoGround) return outside(from, d, T);
    if (!through_air(from)) return std::fill(T.begin(), T.end(), 1.0f);
    const PathSpectra& path = look_up(from, d, distance);
    std::copy(path.transmittance.begin(), path.transmittance.end(), T.begin());
  }

  void path(Vec3 from, Dir d, double distance, std::span<float> T, std::span<float> S) const override {
    if (distance == kNoGround && d.z >= 0) return look_up_sky(from, d, T, S);
    if (!through_air(from)) {
      std::fill(T.begin(), T.end(), 1.0f);
      return std::fill(S.begin(), S.end(), 0.0f);
    }
    const PathSpectra& path = look_up(from, d, distance);
    std::copy(path.transmittance.begin(), path.transmittance.end(), T.begin());
    std::copy(path.radiance.begin(), path.radiance.end(), S.begin());
  }

  void skylight(Vec3 from, Dir d, std::span<float> T, std::span<float> S) const override {
    outside(from, d, T);
    if (table_ && d.z >= 0) return table_->radiance(0, d, S);
    std::fill(S.begin(), S.end(), 0.0f);
  }
  const Light* sky() const override { return table_ ? table_->light() : nullptr; }
  const SkyThroughWater* sky_through_water() const override { return sky() ? &table_->through_water(knots_) : nullptr; }
  double sky_density(Dir d) const override { return table_ ? table_->density(d) : 0; }

  const Shells& shells() const override { no_layers(); }
  std::span<const float> extinction(size_t) const override { no_layers(); }
  void source(size_t, Vec3, Dir, std::span<float>) const override { no_layers(); }
  size_t beams() const override { no_layers(); }
  void beam(size_t, size_t, Vec3, Dir, BeamAlong) const override { no_layers(); }

 private:
  [[noreturn]] static void no_layers() { throw Bug("a table of paths has no layers of air"); }

  // Whether a segment from there is one that the sights are for.
  bool through_air(Vec3 p) const {
    if (!sights_) return false;
    if (sights_->everywhere || !from_) return true;
    return std::any_of(from_->boxes.begin(), from_->boxes.end(), [p](const Box3& b) {
      return p.x >= b.low.x && p.y >= b.low.y && p.z >= b.low.z && p.x <= b.high.x && p.y <= b.high.y &&
             p.z <= b.high.z;
    });
  }

  [[noreturn]] void refuse(Vec3 from, const SightFault& fault) const {
    throw Error(where_,
                strf("the tables have no run for a line of sight from (%.6g, %.6g, %.6g) m: ", from.x, from.y, from.z) +
                    fault.what,
                fault.hint);
  }

  static PathSpectra& scratch() {
    thread_local PathSpectra s;
    return s;
  }
  const PathSpectra& look_up(Vec3 from, Dir d, double distance) const {
    const Sight sight = sight_of(*sights_, world_, from, d, distance);
    if (const auto fault = uncovered(*sights_, world_, sight)) refuse(from, *fault);
    sights_->table.at(place_of(*sights_, sight), scratch());
    return scratch();
  }

  // A sensor that looks past the scene: above the air into space, below it at the sky of the ground where it stands
  // there.
  void look_up_sky(Vec3 from, Dir d, std::span<float> T, std::span<float> S) const {
    if (world_.sea.height(from) > kTopOfAir) {
      std::fill(T.begin(), T.end(), 1.0f);
      return std::fill(S.begin(), S.end(), 0.0f);
    }
    if (sky_)
      if (const auto fault = uncovered(*sky_, world_, sight_of(*sky_, world_, from, d, kNoGround), false))
        refuse(from, *fault);
    skylight(from, d, T, S);
  }

  // What is left, at a place, of what shines outside. Lights other than the Sun are as they are at the ground.
  void outside(Vec3 from, Dir d, std::span<float> T) const {
    if (!world_.sun || angle_between(d, *world_.sun) > sun_radius_) return std::fill(T.begin(), T.end(), 1.0f);
    if (sunlight_.empty()) return both_ways(from, T);
    std::copy(sunlight_.begin(), sunlight_.end(), T.begin());
  }

  // Two-way transmittance over that of the line from the sensors to a place.
  void both_ways(Vec3 to, std::span<float> T) const {
    const Vec3 eye = from_ ? from_->middle : to + Vec3{0, 0, 1};
    const double far = length(to - eye);
    const Dir d = far > 0 ? (to - eye) / far : Dir{0, 0, -1};
    std::vector<double> place = place_of(*sights_, sight_of(*sights_, world_, eye, d, far));
    keep_from_short(*sights_, place);
    PathSpectra& path = scratch();
    sights_->table.at(place, path);
    for (size_t i = 0; i < bins_; ++i) {
      const double t = path.transmittance[i];
      T[i] = t > kOpaque ? static_cast<float>(std::min(1.0, path.two_way[i] / t)) : 0;
    }
  }

  void bake_sun(const TabledSun& sun, const std::optional<SightTable>& ground) {
    sun_radius_ = std::max(sun.half_angle * (1 + 1e-6), kPencil);
    if (two_way_) {
      if (sights_->axes.empty()) both_ways({}, std::span(sunlight_ = Row(bins_)));
      return;
    }
    if (!ground) throw Error(where_, "no run of the tables has sunlight at the ground");
    PathSpectra path;
    ground->table.at(place_of(*ground, sight_of(*ground, world_, {}, *world_.sun, kNoGround)), path);
    const float* above = sun.beam.irradiance;
    for (size_t i = 0; i < bins_; ++i)
      sunlight_.push_back(above[i] > 0 ? static_cast<float>(path.irradiance[i] / double{above[i]}) : 0.0f);
  }

  void tabulate_sky() {
    std::optional<double> symmetric;
    if (world_.sun) symmetric = azimuth(*world_.sun);
    const auto along = [this](double, Dir d, std::span<float> radiance) {
      PathSpectra path;
      sky_->table.at(place_of(*sky_, sight_of(*sky_, world_, {}, d, kNoGround)), path);
      std::copy(path.radiance.begin(), path.radiance.end(), radiance.begin());
    };
    table_ = std::make_unique<SkyTable>(bins_, !sky_->has(SightAxis::relative_azimuth), symmetric, kSkyStep, along);
    table_->make_light();
  }

  Where where_;
  SightWorld world_;
  std::optional<TabledAirSpec::Places> from_;
  size_t bins_;
  std::vector<size_t> knots_;
  std::optional<SightTable> sights_, sky_;
  bool two_way_;
  double sun_radius_ = 0;
  Row sunlight_;  // at the ground over that above the air, per bin; empty where it depends on the place
  std::unique_ptr<SkyTable> table_;
};

}  // namespace

SightWorld TabledAirSpec::world(std::optional<Dir> towards_sun) const {
  return {sea_under(scene_height.value_or(0), radius), towards_sun, within_angle, within_height};
}

bool TabledAirSpec::two_way() const {
  if (!sights) return false;
  std::vector<double> place = place_of(*sights, {});
  keep_from_short(*sights, place);
  PathSpectra path;
  sights->table.at(place, path);
  return !path.two_way.empty();
}

namespace {

// Directions over the hemisphere that a sky has to have: if it has these, it has all between them.
void check_whole_sky(const TabledAirSpec& air, const SightWorld& world) {
  if (!air.sky) return;
  const double turn = world.sun ? azimuth(*world.sun) : 0;
  for (const double zenith : {0.0, 90.0})
    for (const double beside : {0.0, 90.0, 180.0}) {
      const Dir d = dir_from_angles(zenith * kDegree, turn + beside * kDegree);
      if (const auto fault = uncovered(*air.sky, world, sight_of(*air.sky, world, {}, d, kNoGround), false))
        throw Error(air.where, "the tables do not have the whole sky over the scene: " + fault->what, fault->hint);
    }
}

// All combinations of the least and the largest of the axes.
std::vector<std::vector<double>> corners_of(const SightTable& runs) {
  std::vector<std::vector<double>> all{{}};
  for (size_t a = 0; a < runs.axes.size(); ++a) {
    auto [low, high] = runs.table.covered(a);
    if (runs.axes[a] == SightAxis::range) low = runs.least_range;
    std::vector<std::vector<double>> more;
    for (const std::vector<double>& corner : all)
      for (const double end : {low, high}) {
        more.push_back(corner);
        more.back().push_back(end);
      }
    all = std::move(more);
  }
  return all;
}

}  // namespace

void check_tabled_air(const TabledAirSpec& air, const SourceSpecs& sources, const Scene& scene) {
  if (uses_media(scene))
    throw Error(air.where,
                "the scene has media, and tables of paths have no layers of air that light could be followed through "
                "among them",
                "air of layers (`atmosphere: {profile: us_standard}`), or a scene without media");
  std::optional<Dir> sun;
  for (const LightSpecPtr& light : sources.lights) {
    if (!light->disk()) continue;
    if (!light->is_sun() || sun)
      throw Error(air.where, "the tables know the light of one Sun, and the simulation has a further " + light->key(),
                  "drop it");
    sun = normalized(light->disk()->direction);
  }
  const SightWorld world = air.world(sun);
  check_whole_sky(air, world);
  if (!sun || air.two_way()) return;
  if (!air.sun)
    throw Error(air.where, "no run of the tables has sunlight at the ground",
                "runs with REF_SOL and TOA_SUN (IEMSCT 2), or of the Sun's irradiance (IEMSCT 3); or no `sun`");
  if (const auto fault = uncovered(*air.sun, world, sight_of(*air.sun, world, {}, *sun, kNoGround), false))
    throw Error(air.where, "the tables have no run of sunlight at the ground: " + fault->what, fault->hint);
}

void check_sight(const TabledAirSpec& air, Vec3 from, Dir d, std::optional<Dir> towards_sun) {
  if (!air.sights) return;
  const auto rises = air.sights->covered(SightAxis::view_zenith);
  if (d.z >= 0 && rises && rises->first > kPi / 2) return;
  const SightWorld world = air.world(towards_sun);
  const auto fault = uncovered(*air.sights, world, sight_of(*air.sights, world, from, d, kNoGround), false);
  if (fault)
    throw Error(air.where,
                strf("the tables have no run for a line of sight from (%.6g, %.6g, %.6g) m: ", from.x, from.y, from.z) +
                    fault->what,
                fault->hint);
}

std::unique_ptr<const Atmosphere> make_tabled_air(const TabledAirSpec& spec, const SpectralState& state,
                                                  const std::optional<TabledSun>& sun) {
  return std::make_unique<TabledAir>(spec, state, sun);
}

std::pair<double, double> TabledAirSpec::covered_um() const {
  std::pair<double, double> all{0, kNoGround};
  for (const auto* runs : {&sights, &sky, &sun})
    if (*runs)
      all = {std::max(all.first, (*runs)->table.wavelength_um().front()),
             std::min(all.second, (*runs)->table.wavelength_um().back())};
  return all;
}

TabledRows tabled_rows(const TabledAirSpec& spec, const SpectralState& state) {
  TabledRows rows;
  const auto add = [](std::vector<TabledRow>& to, const std::string& name, const std::vector<double>& means) {
    if (!means.empty()) to.push_back({name + strf(", corner %zu", to.size()), row_of(means)});
  };
  for (const auto* runs : {&spec.sights, &spec.sky, &spec.sun}) {
    const std::optional<SightTable> means = over_bins(*runs, state, spec.where);
    if (!means) continue;
    PathSpectra path;
    for (const std::vector<double>& corner : corners_of(*means)) {
      means->table.at(corner, path);
      if (runs == &spec.sun) {
        add(rows.light, "the tables' sunlight", path.irradiance);
        continue;
      }
      add(rows.light, "the tables' air", path.radiance);
      add(rows.passes, "transmittance of the tables", path.transmittance);
      add(rows.passes, "transmittance of both ways", path.two_way);
    }
  }
  return rows;
}

}  // namespace suite
