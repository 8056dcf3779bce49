// Every kind of light of the table, and one that a test adds to it: its example is read, its samples follow its
// density, what it samples adds up to the irradiance of its radiance, and asking for it and meeting it by chance share
// that irradiance. Significance 1e-5 for the family; a density 2 % off must be refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formats/picture/picture.h"
#include "formats/sim_text/sources.h"
#include "light/light_rows.h"
#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "tests/support/message_of.h"
#include "tests/support/radiometry_kit.h"
#include "tests/support/ring_light.h"
#include "tests/support/temp_folder.h"

namespace suite::test::sources_test {
namespace {

// One more row, before anything asks the table.
const bool kRingAdded = (light_rows().add(ring_row()), true);

// A horizontal glowing triangle 1.5 m over the origin, facing down.
std::shared_ptr<Scene> lamp_scene() {
  return scene_of({mesh_of({{-1, -1, 1.5}, {0.5, 1, 1.5}, {1, -0.5, 1.5}}, {0, 1, 2}, 0)},
                  {material("lamp", lambert(0))});
}

const LightRow& row_of(size_t number) { return *(light_rows().begin() + static_cast<ptrdiff_t>(number)); }

struct Draw {
  Dir direction;
  double density;
  std::vector<float> radiance;
};

// The light of a row, asked from the origin.
class Asked {
 public:
  Asked(const Environment& e, const std::string& key, const Tracer& tracer, size_t bins)
      // The sky may stand beside the sun that it needs.
      : light_(key == "sun" ? *e.lights.front() : *e.lights.back()), tracer_(tracer), bins_(bins) {}

  const Light& light() const { return light_; }
  std::optional<Draw> draw(const std::array<double, 4>& u) const {
    const auto s = light_.sample(at_, u, 0);
    if (!s) return std::nullopt;
    return Draw{s->direction, s->density, radiance(s->direction, s->scale, s->spectrum)};
  }
  std::optional<Draw> draw(Pcg32& random) const {
    std::array<double, 4> u{};
    for (int i = 0; i < light_.nature().numbers; ++i) u[static_cast<size_t>(i)] = random.uniform();
    return draw(u);
  }
  std::optional<LightMet> met(Dir d) const {
    if (light_.nature().far) return light_.met_outside(d, 0);
    Hit hit;
    TraceStatistics statistics;
    const Ray ray{at_.position, d, 0};
    tracer_.nearest({&ray, 1}, {&hit, 1}, false, statistics);
    if (!hit.hit()) return std::nullopt;
    return light_.met_surface(at_, hit, 0, d, hit.distance, -dot(hit.normal, d), 0);
  }
  double density(Dir d) const {
    const auto m = met(d);
    return m ? m->density : 0;
  }
  std::vector<float> radiance(Dir d) const {
    const auto m = met(d);
    return m ? radiance(d, m->scale, m->spectrum) : std::vector<float>(bins_, 0.0f);
  }

 private:
  std::vector<float> radiance(Dir d, double scale, const float* spectrum) const {
    std::vector<float> all(bins_, 0.0f);
    if (spectrum)
      for (size_t i = 0; i < bins_; ++i) all[i] = static_cast<float>(scale) * spectrum[i];
    else
      light_.add(d, 0, static_cast<float>(scale), all);
    return all;
  }

  const Light& light_;
  LightReceiver at_{{0, 0, 0}, {}, true};
  const Tracer& tracer_;
  size_t bins_;
};

class SourceKinds : public testing::TestWithParam<size_t> {
 protected:
  bool polarised_ = false;  // what the text of the row says
  const LightRow& row() const { return row_of(GetParam()); }
  // The example's sources, resolved.
  SourceSpecs specs(const Scene& scene) {
    Canvas picture(16, 8);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 16; ++x)
        picture.set(x, y,
                    {static_cast<uint8_t>(10 + 13 * x), static_cast<uint8_t>(250 - 30 * y),
                     static_cast<uint8_t>((x * y * 7) % 256)});
    write_png(folder_ / "sky.png", picture, "test");
    std::string text = row().example;
    if (const size_t at = text.find("file: sky.png"); at != std::string::npos)
      text.insert(at, "wavelength_um: [0.45, 0.55, 0.65], ");
    if (polarised_) text.insert(text.find('{') + 1, "stokes: [1, 0.6, 0.3, -0.2], stokes_axis: [1, 2, 0.5], ");
    const Params root = Params::parse_text(text, folder_ / "example.yaml");
    std::vector<AskedCurve> asked;
    SourceSpecs s = read_sources(root, asked);
    root.reject_unread();
    resolve_sources(s, scene);
    return s;
  }
  // The light of the row, baked for narrow bands over the lamp, and asked from the origin.
  struct Stage {
    SpectralState state;
    Tracer tracer;
    Environment environment;
    Asked source;
    Stage(SourceKinds& test, const std::vector<double>& centers_um)
        : state(make_state(narrow(centers_um), 0.01)),
          tracer(lamp_scene()),
          environment(bake_environment(test.specs(tracer.scene()), tracer, false, state)),
          source(environment, test.row().key(), tracer, state.size()) {}
  };

 private:
  static std::vector<Band> narrow(const std::vector<double>& centers_um) {
    std::vector<Band> bands;
    for (const double c : centers_um) bands.push_back(Band::rectangular("b" + std::to_string(c), c, 0.01));
    return bands;
  }
  TempFolder folder_;
};

TEST_P(SourceKinds, SamplesFollowTheDensity) {
  const Stage stage(*this, {0.45, 0.55, 0.65});
  const Asked& source = stage.source;
  const auto first = source.draw({0.5, 0.5, 0.5, 0.5});
  ASSERT_TRUE(first);
  if (first->density == 0) {  // a point or a collimated beam: one direction, nothing to distribute
    EXPECT_TRUE(source.light().nature().delta);
    EXPECT_EQ(source.draw({0.9, 0.1, 0.7, 0.3})->direction, first->direction);
    return;
  }
  EXPECT_FALSE(source.light().nature().delta);
  // Cells of equal solid angle around the mean direction of a pilot, out to its farthest draw.
  Pcg32 random(11);
  Vec3 sum;
  double farthest = 0;
  std::vector<Dir> pilot;
  for (int i = 0; i < 2000; ++i) pilot.push_back(source.draw(random)->direction), sum += pilot.back();
  const Frame frame = Frame::around(normalized(sum));
  for (const Dir& d : pilot) farthest = std::max(farthest, angle_between(d, frame.z));
  const double drop = one_minus_cos(std::min(kPi, 1.1 * farthest));
  constexpr int rings = 10, sectors = 12;
  auto cell_of = [&](Dir d) {
    const Vec3 l = frame.to_local(d);
    const int r = std::min(rings - 1, static_cast<int>(rings * 0.5 * dot(d - frame.z, d - frame.z) / drop));
    double phi = azimuth(l) / (2 * kPi);
    phi -= std::floor(phi);
    return static_cast<size_t>(r * sectors + std::min(sectors - 1, static_cast<int>(phi * sectors)));
  };
  // Cells stratified finely enough that the quadrature of the density errs by less than a tenth of the counts' own
  // spread.
  const uint64_t n = 150000;
  std::vector<double> observed(rings * sectors, 0.0), expected(rings * sectors, 0.0);
  for (uint64_t i = 0; i < n; ++i) {
    const auto d = source.draw(random);
    if (d) observed[cell_of(d->direction)] += 1;
  }
  const int fine = row().key() == "lamps" ? 150 : 100;
  for (int r = 0; r < rings * fine; ++r)
    for (int k = 0; k < sectors * fine; ++k) {
      const double h = drop * (r + 0.5) / (rings * fine), phi = 2 * kPi * (k + 0.5) / (sectors * fine), z = 1 - h,
                   t = std::sqrt(h * (2 - h));
      expected[static_cast<size_t>(r / fine * sectors + k / fine)] +=
          source.density(frame.to_world({t * std::cos(phi), t * std::sin(phi), z})) * 2 * kPi * drop /
          (rings * fine * sectors * fine) * static_cast<double>(n);
    }
  double total = 0;
  for (const double x : expected) total += x;
  EXPECT_NEAR(total / static_cast<double>(n), 1, 3e-3);
  std::vector<double> wrong = expected;
  for (size_t i = 0; i < wrong.size(); ++i) wrong[i] *= i % 2 ? 1.04 : 0.96;
  EXPECT_GT(chi_square_test(observed, expected, 20), 1e-6);
  EXPECT_LT(chi_square_test(observed, wrong, 20), 1e-6);
}

TEST_P(SourceKinds, MembersIncludeTheirProbability) {
  const Stage stage(*this, {0.55});
  const Light& light = stage.source.light();
  if (light.nature().wide) {
    EXPECT_EQ(light.members(), 0u);
    return;
  }
  ASSERT_EQ(light.members(), 1u);
  // The same place on the only member there is, chosen always and every fourth time.
  const LightReceiver at{{0, 0, 0}, {}, true};
  const auto whole = light.nature().numbers == 2 ? light.sample(at, {0.3, 0.6}, 0) : light.sample(at, {0, 0.3, 0.6}, 0);
  const auto part = light.sample_member(0, 0.25, at, {0, 0.3, 0.6}, 0);
  ASSERT_TRUE(whole && part);
  EXPECT_EQ(part->direction, whole->direction);
  EXPECT_EQ(part->spectrum, whole->spectrum);
  EXPECT_EQ(part->density, 0.25 * whole->density);
  EXPECT_EQ(part->scale, whole->density > 0 ? whole->scale : 4 * whole->scale);
}

// Lamps tell the Stokes vector that they were given, in the frame of the way of their light; drawn or met by chance.
// Others are not polarised, and a text that says so is refused.
TEST_P(SourceKinds, PolarisesAsItSays) {
  const Stage plain(*this, {0.55});
  const LightReceiver at{{0, 0, 0}, {}, true};
  const std::array<double, 4> u{0.3, 0.6, 0.2, 0.7};
  if (row().name == "sky clear") return;  // unit_light_clear_sky_polarisation
  EXPECT_EQ(plain.source.light().sample(at, u, 0)->source, kUnpolarised);
  polarised_ = true;
  if (row().key() != "lamps") {
    EXPECT_THAT(message_of([&] { Stage refused(*this, {0.55}); }), testing::HasSubstr("stokes"));
    return;
  }
  const Stage stage(*this, {0.55});
  const Light& light = stage.source.light();
  const auto drawn = light.sample(at, u, 0);
  ASSERT_TRUE(drawn);
  const Dir k = -drawn->direction;
  const Stokes seen = light.stokes(drawn->source, k, 0);
  // Turned by the angle from the projection of the axis, [1, 2, 0.5], to the meridian.
  const Vec3 axis{1, 2, 0.5}, across = normalized(axis - k * dot(axis, k));
  const Vec3 e1 = meridian_frame(k).e1;
  const double angle = std::atan2(dot(e1, cross(k, across)), dot(e1, across)), c = std::cos(2 * angle),
               s = std::sin(2 * angle);
  const Stokes wanted{1, c * 0.6 + s * 0.3, -s * 0.6 + c * 0.3, -0.2};
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(seen[i], wanted[i], 1e-9) << "IQUV"[i];
  const auto met = stage.source.met(drawn->direction);
  EXPECT_EQ(met ? met->source : drawn->source, drawn->source);
}

TEST_P(SourceKinds, TimeIsThatOfTheRay) {
  const Stage stage(*this, {0.55});
  const Light& light = stage.source.light();
  ASSERT_FALSE(light.nature().moves);  // what moves: physics_light_lamps_in_time
  const LightReceiver at{{0, 0, 0}, {}, true};
  const auto now = light.sample(at, {0.3, 0.6, 0.2, 0.7}, 0), later = light.sample(at, {0.3, 0.6, 0.2, 0.7}, 1e4);
  ASSERT_TRUE(now && later);
  EXPECT_EQ(now->direction, later->direction);
  EXPECT_EQ(now->scale, later->scale);
}

// Sums of estimates of an irradiance.
struct Mean {
  double sum = 0, square = 0;
  int n = 0;
  void add(double x) { sum += x, square += x * x, ++n; }
  double mean() const { return sum / n; }
  double variance() const { return (square / n - mean() * mean()) / n; }
};
double p_of(const Mean& a, const Mean& b) {
  return normal_two_sided((a.mean() - b.mean()) / std::sqrt(a.variance() + b.variance()));
}

TEST_P(SourceKinds, AskingAndMeetingByChanceAreComplements) {
  const Stage stage(*this, {0.55});
  const Asked& source = stage.source;
  Pcg32 random(23);
  if (source.light().nature().delta) {
    for (int i = 0; i < 1000; ++i) {
      const Dir d = uniform_sphere({random.uniform(), random.uniform()});
      EXPECT_FALSE(source.met(d));
    }
    EXPECT_FALSE(source.met(source.draw(random)->direction)) << "not even where it is";
    return;
  }
  // By chance: evenly over a cone that holds the light.
  Vec3 sum;
  std::vector<Dir> pilot;
  for (int i = 0; i < 2000; ++i) pilot.push_back(source.draw(random)->direction), sum += pilot.back();
  const Frame frame = Frame::around(normalized(sum));
  double farthest = 0;
  for (const Dir& d : pilot) farthest = std::max(farthest, angle_between(d, frame.z));
  const double drop = one_minus_cos(std::min(kPi, 1.2 * farthest)), chance = 1 / (2 * kPi * drop);
  // Radiance times cosine over the density: one of the two alone, and both with the balance heuristic. off: of the
  // density that chance is told, for the control.
  const auto flux = [](Dir d, float radiance) { return static_cast<double>(radiance) * std::max(0.0, d.z); };
  Mean asked, met, both, wrong;
  for (int i = 0; i < 300000; ++i) {
    const auto drawn = source.draw(random);
    ASSERT_TRUE(drawn);
    const double f = flux(drawn->direction, drawn->radiance[0]);
    const bool inside = 0.5 * dot(drawn->direction - frame.z, drawn->direction - frame.z) < drop;
    asked.add(f / drawn->density);
    const Dir d = frame.to_world(uniform_cone({random.uniform(), random.uniform()}, drop));
    const double g = flux(d, source.radiance(d)[0]), density = source.density(d);
    met.add(g / chance);
    const double by_asking = f / (drawn->density + (inside ? chance : 0));
    both.add(by_asking + g / (density + chance));
    wrong.add(by_asking + g / (1.15 * density + chance));
  }
  EXPECT_GT(p_of(both, asked), 1e-4);
  EXPECT_GT(p_of(both, met), 1e-4);
  EXPECT_LT(std::min(p_of(wrong, asked), p_of(wrong, met)), 1e-6) << "a density 15 % off must be noticed";
}

class DistantKinds : public SourceKinds {};  // lamps are held to form factors in physics_light_lamps
TEST_P(DistantKinds, SamplesAddUpToTheIrradiance) {
  // Irradiance of a horizontal plane: mean of radiance x cosine / density of the samples, against midpoint quadrature
  // of the radiance over the hemisphere.
  const Stage stage(*this, {0.45, 0.65});
  const SpectralState& state = stage.state;
  const Asked& source = stage.source;
  std::vector<double> by_samples(state.size(), 0.0), by_quadrature(state.size(), 0.0), square(state.size(), 0.0);
  Pcg32 random(4);
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const auto d = source.draw(random);
    if (i < 100) {
      EXPECT_EQ(source.radiance(d->direction), d->radiance);
    }
    for (size_t b = 0; b < state.size(); ++b) {
      const double x = d->radiance[b] * std::max(0.0, d->direction.z) / d->density;
      by_samples[b] += x / n;
      square[b] += x * x / n;
    }
  }
  if (source.light().nature().disk) {
    // A disk wholly above the horizon: irradiance of the beam x cosine of its centre.
    const Beam beam = *source.light().beam();
    for (size_t b = 0; b < state.size(); ++b) by_quadrature[b] = beam.irradiance[b] * beam.direction.z;
  } else {
    const int rows = 900, columns = 1440;
    for (int r = 0; r < rows; ++r)
      for (int c = 0; c < columns; ++c) {
        const double theta = (r + 0.5) / rows * kPi / 2;
        const std::vector<float> L = source.radiance(dir_from_angles(theta, (c + 0.5) / columns * 2 * kPi));
        for (size_t b = 0; b < state.size(); ++b)
          by_quadrature[b] += L[b] * std::cos(theta) * std::sin(theta) * (kPi / 2 / rows) * (2 * kPi / columns);
      }
  }
  for (size_t b = 0; b < state.size(); ++b) {
    const double se = std::sqrt((square[b] - by_samples[b] * by_samples[b]) / n);
    EXPECT_NEAR(by_samples[b], by_quadrature[b], 5 * se + 2e-4 * by_quadrature[b]) << "bin " << b;
    EXPECT_LT(5 * se, 0.02 * by_quadrature[b]);
  }
}

std::string name_of(const testing::TestParamInfo<size_t>& one) {
  std::string name = row_of(one.param).name;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
}
std::vector<size_t> distant() {
  std::vector<size_t> rows;
  for (size_t i = 0; i < light_rows().size(); ++i)
    if (row_of(i).key() != "lamps") rows.push_back(i);
  return rows;
}
INSTANTIATE_TEST_SUITE_P(Table, SourceKinds, testing::Range(size_t{0}, light_rows().size()), name_of);
INSTANTIATE_TEST_SUITE_P(Table, DistantKinds, testing::ValuesIn(distant()), name_of);

TEST(Sources, AnUnknownKindIsAnsweredWithThoseOfTheTable) {
  for (const LightRow& row : light_rows()) {
    if (row.kind().empty()) continue;
    const std::string text = row.key() + (row.list ? ": [{kind: none}]\n" : ": {kind: none}\n");
    EXPECT_THAT(message_of([&] {
                  std::vector<AskedCurve> asked;
                  read_sources(Params::parse_text(text, "x.yaml"), asked);
                }),
                testing::HasSubstr(row.kind()))
        << row.name;
  }
}

TEST(Sky, ShapesThatDifferByWavelengthStayUnbiased) {
  // At 0.45 um all light comes from the east, at 0.65 um from the west: one density serves both. Expected radiance from
  // the sky's own quadrature; a sky that drew from one of its tables alone could not bring the other.
  SkySpec sky;
  sky.radiance = Curve::constant(2);
  sky.zeniths = 10, sky.azimuths = 16, sky.cells = true;
  sky.wavelength_um = {0.45, 0.65};
  for (const int side : {0, 1})
    for (size_t r = 0; r < sky.zeniths; ++r)
      for (size_t c = 0; c < sky.azimuths; ++c) sky.table.push_back((c < 4 || c >= 12) == (side == 0) ? 1 : 0);
  SourceSpecs sources;
  sources.add(sky);
  const std::vector<Band> bands{Band::rectangular("a", 0.45, 0.002), Band::rectangular("b", 0.65, 0.002)};
  const auto run =
      render(scene_of({quad(5, 0, 0)}, {material("m", lambert(0.5))}), sources,
             std::make_unique<RaySensor>(std::vector<Ray>{{{0, 0, 1}, {0, 0, -1}, 0}}, bands, 1 << 14, 0.002));
  for (size_t b = 0; b < 2; ++b) {
    EXPECT_NEAR(run.result.radiance[b], 0.5 * 2 / 2, 4.5 * run.result.standard_error[b]);
    EXPECT_LT(run.result.standard_error[b], 0.01);
    EXPECT_GT(run.result.standard_error[b], 0) << "a split sky cannot be free of noise";
  }
}

}  // namespace
}  // namespace suite::test::sources_test
