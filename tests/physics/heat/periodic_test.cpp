// The state of a batch that repeats with the day, and days of gusts.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "heat/convection.h"
#include "heat/slab_batch.h"
#include "support/heat_kit.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::periodic_test {
namespace {

using namespace test;
using Between = AveragedTable::Between;

const std::vector<double> kTenMinutes(144, 600.0);

// The linear part of a periodic state in closed form: without T^4, a thick solid under h (T_air(t) - T) with T_air =
// mean
// + A cos(w t) answers A |h / (h + inertia sqrt(i w))| behind it (Carslaw & Jaeger, 2.6).
TEST(Periodic, HarmonicAnswerOfAThickSolid) {
  const double h = 20, inertia = std::sqrt(1.4 * 2300 * 880), w = 2 * kPi / 86400;
  const std::complex<double> answer = 8.0 * h / (h + inertia * std::sqrt(std::complex<double>(0, w)));
  std::vector<double> times, values;
  for (int i = 0; i <= 1440; ++i) {
    times.push_back(60.0 * i);
    values.push_back(h * (290 + 8 * std::cos(2 * kPi * (i % 1440) / 1440)));
  }
  const AveragedTable table(times, values, Between::linear, true);
  SlabBatch batch({uniform(2, 2300, 880, 1.4, 800)}, 1);
  batch.start(0, 270);
  double worst = 0, t = 0;
  const BatchLoads loads = [&](double begin, double end, const SlabBatch&, FaceLines& top, FaceLines&) {
    top.constant[0] = table.over(begin, end);
    top.linear[0] = {h, h};
  };
  const PeriodicResult r = find_periodic(batch, 0, kTenMinutes, loads, {1e-4, 60}, [&](size_t step) {
    if (step == 0) worst = t = 0;
    t += 600;
    worst = std::fmax(worst, std::fabs(batch.top(0) - 290 - (answer * std::polar(1.0, w * t)).real()));
  });
  std::printf("harmonic answer: %.2e K after %d sweeps\n", worst, r.sweeps);
  EXPECT_LT(worst, 2e-3);
  EXPECT_LE(r.sweeps, 4);
}

// Against the single slab's spin-up with steps of its own, with T^4, over ground so deep that plain periods would take
// years; starts far away and near by reach the same state.
TEST(Periodic, IsTheSpunUpStateFromAnyStart) {
  const Day day;
  SlabSpec spec;
  spec.layers = {uniform(1e-4, 1400, 1000, 0.2), uniform(3, 2300, 880, 1.4)};
  const double mean = 5.7 + 3.8 * 2;
  spec.top = surface(
      0.9,
      [](double t) {
        const double c = std::cos(2 * kPi * t / 86400), sun = std::fmax(0.0, -c);
        return SurfaceLoad{0.9 * 780 * sun * sun, 320, 288 - 5 * c, 0};
      },
      mean);
  spec.bottom = flux(0);
  Slab slab(spec, {0.002, 600, 1e-9, 60});
  slab.start(0, 288);
  spin_up(slab, 0, 86400, {1e-5, 500});
  for (const double start : {250.0, 292.0, 400.0}) {
    SlabBatch batch(spec.layers, 1);
    batch.start(0, start);
    const PeriodicResult r = find_periodic(batch, 0, kTenMinutes, day.loads(), {1e-4, 60});
    double worst = 0;
    for (size_t i = 0; i < batch.nodes(); ++i)
      worst = std::fmax(worst, std::fabs(batch.kelvin(0, i) - slab.kelvin()[i]));
    std::printf("periodic from %g K: %d sweeps, largest difference %.2e K\n", start, r.sweeps, worst);
    EXPECT_LT(worst, 0.02);
    EXPECT_LE(r.sweeps, 8);
  }
  // Negative control: thirty plain days from 10 K away still are degrees off in the depth.
  SlabBatch plain(spec.layers, 1);
  plain.start(0, slab.kelvin().back() - 10);
  for (int d = 0; d < 30; ++d)
    for (const double dt : kTenMinutes) plain.step(dt, day.loads());
  EXPECT_GT(std::fabs(plain.bottom(0) - slab.kelvin().back()), 1);
}

TEST(Periodic, WithoutAnyHoldThereIsNone) {
  SlabBatch batch({uniform(0.1, 1000, 1000, 1)}, 1);
  EXPECT_NE(message_of([&] {
              find_periodic(batch, 0, kTenMinutes, steady({{{100, 0, 0}, {}}}), {1e-3, 10});
            }).find("not periodic after 10 periods"),
            std::string::npos);
}

// A day whose wind is new every second: gusts of 0 to 6 m/s, McAdams' law, sun on a dark face.
struct GustyDay {
  AveragedTable linear, constant;
  double quartic = 0.9 * kStefanBoltzmann;
  static AveragedTable table(bool gusts, bool constant) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> wind(0, 6);
    const auto law = make_convection({"mcadams", {}, "smooth"});
    double calm = 0;  // the mean coefficient, so that both days are one but for the gusts
    for (int i = 0; i < 1000; ++i) calm += law->coefficient({300, 300, 6 * (i + 0.5) / 1000}) / 1000;
    std::vector<double> times, values;
    for (int i = 0; i <= 86400; ++i) {
      const double c = std::cos(2 * kPi * i / 86400.0), sun = std::fmax(0.0, -c);
      const double h = gusts ? law->coefficient({300, 300, wind(random)}) : calm;
      times.push_back(i);
      values.push_back(constant ? 700 * sun * sun + 0.9 * 320 + h * (288 - 5 * c) : h);
    }
    return AveragedTable(std::move(times), std::move(values), Between::held, true);
  }
  explicit GustyDay(bool gusts) : linear(table(gusts, false)), constant(table(gusts, true)) {}
  GustyDay(AveragedTable l, AveragedTable c) : linear(std::move(l)), constant(std::move(c)) {}
  GustyDay averaged() const { return {linear.averaged(1800), constant.averaged(1800)}; }
  BatchLoads loads() const {
    return [this](double begin, double end, const SlabBatch&, FaceLines& top, FaceLines&) {
      top.linear[0] = linear.over(begin, end);
      top.constant[0] = constant.over(begin, end);
      top.quartic[0] = quartic;
    };
  }
};

struct Means {
  std::vector<double> hours, instants;  // means of the hours and values at their ends, K
};

template <class Steps>
Means run_day(const std::vector<SlabLayer>& layers, const BatchLoads& loads, const Steps& steps) {
  SlabBatch batch(layers, 1);
  batch.start(0, 283);
  Means m;
  double sum = 0, t = 0;
  for (const double dt : steps) {
    batch.step(dt, loads);
    sum += dt * batch.top_mean(0);
    t += dt;
    if (std::fabs(t / 3600 - std::round(t / 3600)) > 1e-7) continue;
    m.hours.push_back(sum / 3600);
    m.instants.push_back(batch.top(0));
    sum = 0;
  }
  return m;
}

double largest(const std::vector<double>& a, const std::vector<double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double d = 0;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) d = std::fmax(d, std::fabs(a[i] - b[i]));
  return d;
}

TEST(Gusts, LongStepsSeeTheirMeans) {
  const GustyDay gusty(true), calm(false);
  const GustyDay plan = gusty.averaged(), calm_plan = calm.averaged();
  const std::vector<SlabLayer> layers{uniform(0.5, 2300, 880, 1.4)};
  // Steps are chosen by loads averaged over half hours, to 10 mK, and end at full hours; then the day runs in them,
  // refined before full hours.
  auto planned = [&](const GustyDay& day, SlabBatch& batch) {
    std::vector<double> steps;
    batch.start(0, 283);
    for (int hour = 1; hour <= 24; ++hour) batch.advance(3600.0 * hour, day.loads(), {0.01, 1800, 1e-9}, &steps);
    return steps;
  };
  SlabBatch gusty_batch(layers, 1), calm_batch(layers, 1);
  const std::vector<double> steps = planned(plan, gusty_batch);
  planned(calm_plan, calm_batch);
  std::vector<double> hours;
  for (int hour = 1; hour <= 24; ++hour) hours.push_back(3600.0 * hour);
  const std::vector<double> refined = refine_steps(0, steps, hours, 1);
  const auto tried = [](const SlabBatch& b) { return b.counters().steps + b.counters().rejected; };
  const long long cost = tried(gusty_batch) + static_cast<long long>(refined.size()), calm_cost = tried(calm_batch);
  const Means fine = run_day(layers, gusty.loads(), std::vector<double>(864000, 0.1));
  const Means coarse = run_day(layers, gusty.loads(), steps), ten = run_day(layers, gusty.loads(), kTenMinutes);
  std::printf(
      "gusts: %lld steps with their planning, %lld calm; means of hours %.4f K, at their ends %.4f K; in steps of "
      "10 min %.4f K, %.4f K\n",
      cost, calm_cost, largest(fine.hours, coarse.hours), largest(fine.instants, coarse.instants),
      largest(fine.hours, ten.hours), largest(fine.instants, ten.instants));
  EXPECT_LT(largest(fine.hours, coarse.hours), 0.05);
  EXPECT_LT(largest(fine.hours, ten.hours), 0.05);
  const Means asked = run_day(layers, gusty.loads(), refined);
  std::printf("gusts, refined before full hours: %zu steps, %.4f K\n", refined.size(),
              largest(fine.instants, asked.instants));
  EXPECT_LT(largest(fine.instants, asked.instants), 0.05);
  EXPECT_LT(cost, 3 * calm_cost);

  // Negative control: loads read at the ends of ten minutes instead of averaged alias.
  const BatchLoads sampled = [&](double begin, double end, const SlabBatch&, FaceLines& top, FaceLines&) {
    const auto at = [](const AveragedTable& table, double t) { return table.over(t, t + 1).mean(); };
    top.linear[0] = {at(gusty.linear, begin), at(gusty.linear, end)};
    top.constant[0] = {at(gusty.constant, begin), at(gusty.constant, end)};
    top.quartic[0] = gusty.quartic;
  };
  const Means aliased = run_day(layers, sampled, kTenMinutes);
  std::printf("gusts sampled: means of hours %.3f K\n", largest(fine.hours, aliased.hours));
  EXPECT_GT(largest(fine.hours, aliased.hours), 0.15);
}

}  // namespace
}  // namespace suite::periodic_test
