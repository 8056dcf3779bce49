// The four verbs of a bundle agree with one another: what sample draws is what pdf says, pdf weighs what eval says, and
// total is their mean; for both methods and every kind of function. With negative controls.
//
// Significance: 1e-3 over all chi-square tests of this file (fewer than 100), evenly divided.
#include <gtest/gtest.h>

#include "math/sampling.h"
#include "math/stats.h"
#include "math/warps.h"
#include "support/sqt_examples.h"

namespace suite::sqt::verbs_test {
namespace {

using test::Analytic;

double ward_like(Dir out, Dir in, double ax, double ay) {
  const Dir h = normalized(out + in);
  const double e = (h.x * h.x / (ax * ax) + h.y * h.y / (ay * ay)) / (h.z * h.z);
  return 0.05 + 0.1 * std::exp(-e) / (ax * ay * std::max(0.2, in.z + out.z));
}
Analytic brushed() {
  return Analytic([](Dir o, Dir i) { return 0.5 * ward_like(o, i, 0.4, 0.15); }, 1, Domain::hemisphere, Quantity::bsdf,
                  false);
}
Analytic leaf() {  // reflects and lets through, each with a lobe
  return Analytic(
      [](Dir o, Dir i) {
        const bool through = i.z < 0;
        i.z = std::fabs(i.z);
        return (through ? 0.4 : 0.3) * test::glossy_value(o, i, through ? 0.4 : 0.3);
      },
      2, Domain::sphere);
}
Analytic rough() {
  return Analytic([](Dir o, Dir i) {
    const Dir h = normalized(o + i);
    const double d = 1 - 0.8 * h.z * h.z;
    return 0.2 / kPi / (4 * d * d) / (0.5 + o.z + i.z + o.z * i.z);
  });
}
Analytic haze() {
  return Analytic([](Dir o, Dir i) { return test::henyey_greenstein(-dot(o, i), 0.8); }, 1, Domain::sphere,
                  Quantity::phase);
}
Analytic street_light() {
  return Analytic([](Dir, Dir i) { return i.z < 0 ? i.z * i.z * (1 + 0.5 * i.x) : 0.0; }, 1, Domain::sphere,
                  Quantity::intensity, false);
}

struct Case {
  std::string name;
  std::shared_ptr<const Bundle> bundle;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    auto aligned = [](const Analytic& f) { return make_bundle(test::small_fit(f).data); };
    auto direct = [](const Analytic& f) {
      AlignedSource::Options options = test::small_options();
      options.frame = LobeFrame::direct;
      return make_bundle(encode_aligned(AlignedSource(f, options), 0.1).data);
    };
    auto paper = [](const Analytic& f) { return make_bundle(test::small_paper(f)); };
    return std::vector<Case>{{"paper_glossy", paper(test::glossy())},
                             {"paper_leaf", paper(leaf())},
                             {"paper_haze", paper(haze())},
                             {"paper_light", paper(street_light())},
                             {"aligned_glossy", aligned(test::glossy())},
                             {"aligned_narrow", aligned(test::glossy(0.03))},
                             {"aligned_brushed", aligned(brushed())},
                             {"aligned_rough", direct(rough())},
                             {"aligned_leaf", aligned(leaf())},
                             {"aligned_haze", aligned(haze())},
                             {"aligned_light", aligned(street_light())}};
  }();
  return all;
}

// Directions of the quadrature below, made once: side x side in each cell of an order.
constexpr int kOrder = 3, kSide = 24;
const std::vector<Dir>& directions() {
  static const std::vector<Dir> all = [] {
    std::vector<Dir> list;
    std::vector<double> x(kSide * kSide), y(x.size()), z(x.size());
    for (uint32_t i = 0; i < cell_count(kOrder); ++i) {
      directions_in(CellId::of(kOrder, i), kSide, x.data(), y.data(), z.data());
      for (size_t k = 0; k < x.size(); ++k) list.push_back({x[k], y[k], z[k]});
    }
    return list;
  }();
  return all;
}

// Chi-square of n draws against the density integrated over HEALPix cells of order 3, given how many draws succeeded;
// the share that does is held to the density's integral directly (to the 0.4 % that this quadrature is good for).
double chi_square_of(const Bundle& bundle, Dir out, size_t channel, double spoil, int n = 60000) {
  constexpr size_t kPoints = kSide * kSide;
  Pcg32 rng(7);
  std::vector<double> expected(cell_count(kOrder), 0.0), seen(expected.size(), 0.0);
  double sum = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    for (size_t k = 0; k < kPoints; ++k) {
      const Dir in = directions()[i * kPoints + k];
      expected[i] +=
          n * bundle.pdf(out, in, channel) * cell_solid_angle(kOrder) / kPoints * (in.x > 0 ? 1 + spoil : 1 - spoil);
    }
    sum += expected[i];
  }
  double drawn = 0;
  for (int i = 0; i < n; ++i) {
    const auto in = bundle.sample(out, {rng.uniform(), rng.uniform()}, rng.uniform(), channel);
    if (in) ++seen[cell_of(*in, kOrder).index()], ++drawn;
  }
  EXPECT_NEAR(drawn / n, sum / n, 4e-3);
  for (double& e : expected) e *= drawn / sum;
  return chi_square_test(seen, expected, 20);
}

class Verbs : public testing::TestWithParam<size_t> {
 protected:
  const Bundle& bundle() const { return *cases()[GetParam()].bundle; }
  std::vector<Dir> views() const {
    std::vector<Dir> v;
    for (const double theta : {0.0, 0.3, 0.8, 1.3, 89.9 * kDegree}) v.push_back(dir_from_angles(theta, 0.4));
    if (bundle().info().function.domain == Domain::sphere) v.push_back(dir_from_angles(2.2, 1));
    return v;
  }
};

// The same for all bundles and views, made once.
const std::array<double, 4>& point(uint32_t i) {
  static std::vector<std::array<double, 4>> points;
  const SampleStream stream(3, 0, 0);
  while (points.size() <= i) points.push_back(stream.draw(static_cast<uint32_t>(points.size()), 0));
  return points[i];
}

TEST_P(Verbs, SampleFollowsPdf) {
  if (cases()[GetParam()].name == "aligned_narrow")
    GTEST_SKIP() << "its lobe is narrower than this test's quadrature; see the conformance kit";
  for (const Dir out : views())
    EXPECT_GT(chi_square_of(bundle(), out, bundle().channels() - 1, 0), 1e-5) << "cos view " << out.z;
}

TEST_P(Verbs, MeanWeightIsTotal) {
  for (const Dir out : views()) {
    const size_t c = 0;
    double sum = 0;
    const uint32_t n = std::fabs(out.z) < 0.01 ? 1 << 18 : 1 << 16;  // grazing: rarer draws
    for (uint32_t i = 0; i < n; ++i) {
      const auto& u = point(i);
      const auto in = bundle().sample(out, {u[0], u[1]}, u[2], c);
      if (!in) continue;
      const double p = bundle().pdf(out, *in, c), w = bundle().eval(out, *in, c);
      ASSERT_GT(p, 0);
      sum += w / p;
      EXPECT_LT(w / p, 20 * bundle().total(out, c));
    }
    const double W = bundle().total(out, c);
    EXPECT_NEAR(sum / n / W, 1, 1e-3) << "cos view " << out.z;
  }
}

INSTANTIATE_TEST_SUITE_P(Sqt, Verbs, testing::Range(size_t{0}, size_t{11}),
                         [](const auto& i) { return cases()[i.param].name; });

TEST(VerbsFrames, AllKindsAreThere) {
  EXPECT_EQ(cases()[4].bundle->info().frame, "half");
  EXPECT_EQ(cases()[7].bundle->info().frame, "direct");
}

TEST(VerbsControl, TwoPercentAreRejected) {
  EXPECT_LT(chi_square_of(*cases()[4].bundle, {0, 0, 1}, 0, 0.02, 600000), 1e-5);
}

}  // namespace
}  // namespace suite::sqt::verbs_test
