// Longwave exchange between surfaces: shields, cavities, coupled histories.
#include "heat/exchange.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "support/heat_kit.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::exchange_test {
namespace {

using namespace test;
using Entry = ExchangeMatrix::Entry;

double kelvin_of(double emitted) { return std::pow(emitted / kStefanBoltzmann, 0.25); }

// Two plates with `shields` sheets between them, all emissivities one. Elements are the sheets' faces, from the hot
// plate on, two a sheet; the plates are outsides. Of what a face emits towards an opposite one e is absorbed there at
// once, (1-e) comes back, (1-e)^2 returns to the opposite, and so on: e / (1 - (1-e)^2) ends at the opposite face.
ExchangeMatrix stack(int shields, double emissivity) {
  const auto faces = static_cast<size_t>(2 * shields);
  ExchangeMatrix m(faces, 2);
  const double other = emissivity / (1 - (1 - emissivity) * (1 - emissivity));
  for (uint32_t face = 0; face < faces; ++face) {
    const bool towards_hot = face % 2 == 0;
    const auto hot = static_cast<uint32_t>(faces), cold = hot + 1;
    uint32_t opposite = towards_hot ? face - 1 : face + 1;
    if (face == 0) opposite = hot;
    if (face + 1 == faces) opposite = cold;
    m.add_row(std::vector<Entry>{{opposite, other}, {face, 1 - other}});
  }
  return m;
}

// Couples what answers to received histories, all in doubles.
using Answer = std::function<void(std::span<const double> received, std::span<double> emitted)>;
CouplingResult couple(const ExchangeMatrix& m, size_t moments, std::vector<double>& emitted, const Answer& answer,
                      const CouplingOptions& options = {}) {
  Histories all(m.elements() + m.outsides(), moments);
  for (size_t row = 0; row < all.rows(); ++row) all.set(row, {&emitted[row * moments], moments});
  const Respond respond = [&](const Histories& around, Histories& answers) {
    std::vector<double> received(m.elements() * moments), emits(received.size());
    for (size_t row = 0; row < m.elements(); ++row) m.receive_one(row, around, {&received[row * moments], moments});
    answer(received, emits);
    for (size_t row = 0; row < m.elements(); ++row) answers.set(row, {&emits[row * moments], moments});
  };
  const CouplingResult result = couple_histories(m, all, respond, options);
  for (size_t row = 0; row < all.rows(); ++row) all.get(row, {&emitted[row * moments], moments});
  return result;
}

// Sheets without heat capacity: both faces take the temperature at which what they receive is what they emit.
Answer sheets(double emissivity) {
  return [emissivity](std::span<const double> received, std::span<double> emitted) {
    for (size_t i = 0; i < received.size(); i += 2) {
      std::vector<MasslessFace> faces(2);
      for (size_t k = 0; k < 2; ++k) {
        faces[k].traits.emissivity = emissivity;
        faces[k].weather.longwave = received[i + k];
      }
      emitted[i] = emitted[i + 1] = black(massless_kelvin(faces));
    }
  };
}

TEST(Exchange, ShieldsBetweenPlatesOfEmissivity2Percent) {
  const double e = 0.02, hot = 350, cold = 280;
  for (int shields = 1; shields <= 10; ++shields) {
    const ExchangeMatrix m = stack(shields, e);
    std::vector<double> emitted(m.elements() + 2, black(300));
    emitted[m.elements()] = black(hot);
    emitted[m.elements() + 1] = black(cold);
    const CouplingResult r = couple(m, 1, emitted, sheets(e), {1e-7, 60, 12});
    std::vector<double> received(m.elements());
    m.receive(emitted, 1, received);
    const double exact = (black(hot) - black(cold)) / ((shields + 1) * (2 / e - 1));
    double worst = 0;
    for (size_t face = 0; face < m.elements(); ++face)
      worst = std::fmax(worst, std::fabs(e * std::fabs(received[face] - emitted[face]) / exact - 1));
    std::printf("%2d shields: flux within %.1e of %.6f W/m2 in %d sweeps\n", shields, worst, exact, r.sweeps);
    EXPECT_LT(worst, 1e-4);
    EXPECT_LE(r.sweeps, 2 * shields + 6);
  }
  // Negative control: faces that forget what comes back to them from their opposite, as before black plates, carry
  // almost twice the flux.
  ExchangeMatrix forgetful(2, 2);
  forgetful.add_row(std::vector<Entry>{{2, 1}});
  forgetful.add_row(std::vector<Entry>{{3, 1}});
  std::vector<double> emitted{black(300), black(300), black(hot), black(cold)}, received(2);
  couple(forgetful, 1, emitted, sheets(e), {1e-7, 60, 12});
  forgetful.receive(emitted, 1, received);
  EXPECT_GT(e * (received[0] - emitted[0]) * 2 * (2 / e - 1) / (black(hot) - black(cold)), 1.9);
}

// The shield of the Fire Dynamics Simulator's verification suite (NIST) as an exchange: black plates, a sheet of 0.48.
TEST(Exchange, RadiationShieldOfFds) {
  ExchangeMatrix m(2, 2);
  m.add_row(std::vector<Entry>{{2, 1}});
  m.add_row(std::vector<Entry>{{3, 1}});
  std::vector<double> emitted{black(300), black(300), black(773.15), black(293.15)};
  couple(m, 1, emitted, sheets(0.48));
  EXPECT_NEAR(kelvin_of(emitted[0]), 653.473, 0.001);
}

// Rows of random shares, seeded; the last `outsides` ends get `open` of every row.
ExchangeMatrix random_exchange(size_t elements, size_t outsides, double open, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  ExchangeMatrix m(elements, outsides);
  for (size_t i = 0; i < elements; ++i) {
    std::vector<Entry> row;
    double sum = 0;
    for (uint32_t j = 0; j < elements; ++j)
      if (uniform(random) < 0.3 || j == i) row.push_back({j, uniform(random)}), sum += row.back().share;
    for (Entry& entry : row) entry.share *= (1 - open) / sum;
    for (uint32_t o = 0; o < outsides; ++o)
      row.push_back({static_cast<uint32_t>(elements) + o, open / static_cast<double>(outsides)});
    m.add_row(row);
  }
  return m;
}

// Slabs that radiate to each other all day; nothing else acts. `emissivity` per element.
struct Cavity {
  std::vector<double> emissivity;
  std::vector<double> steps;
  size_t moments() const { return steps.size() + 1; }  // at the steps' ends and the first begin
  // Starts every slab at its temperature and fills the histories.
  void run(const std::vector<double>& start, std::span<const double> received, std::span<double> emitted) const {
    const size_t n = emissivity.size(), count = moments();
    SlabBatch batch({uniform(1e-3, 2700, 900, 200), uniform(0.05, 1000, 1000, 0.5)}, n);
    for (size_t e = 0; e < n; ++e)
      for (size_t i = 0; i < batch.nodes(); ++i) batch.set_kelvin(e, i, start[e]);
    for (size_t k = 0; k < count; ++k) {
      for (size_t e = 0; e < n; ++e) emitted[e * count + k] = black(batch.top(e));
      if (k + 1 == count) break;
      batch.step(steps[k], [&](double, double, const SlabBatch&, FaceLines& top, FaceLines&) {
        for (size_t e = 0; e < n; ++e) {
          const double* r = &received[e * count + k];
          top.constant[e] = {emissivity[e] * r[0], emissivity[e] * r[1]};
          top.quartic[e] = emissivity[e] * kStefanBoltzmann;
        }
      });
    }
  }
};

std::vector<double> mixed_emissivities(size_t n) {
  std::vector<double> e;
  for (size_t i = 0; i < n; ++i) e.push_back(0.02 + 0.98 * static_cast<double>(i) / static_cast<double>(n - 1));
  return e;
}

TEST(Exchange, ABoxOfOneTemperatureStaysAtIt) {
  const size_t n = 40;
  const Cavity cavity{mixed_emissivities(n), std::vector<double>(24, 3600.0)};
  const size_t count = cavity.moments();
  const std::vector<double> start(n, 287.65);
  const ExchangeMatrix closed = random_exchange(n, 0, 0, 3);
  std::vector<double> emitted(n * count, black(260));  // a guess far away
  const Answer respond = [&](std::span<const double> r, std::span<double> e) { cavity.run(start, r, e); };
  const CouplingResult r = couple(closed, count, emitted, respond, {1e-9, 60, 8});
  double worst = 0;
  for (const double m : emitted) worst = std::fmax(worst, std::fabs(kelvin_of(m) - 287.65));
  std::printf("isothermal box: %.1e K after %d sweeps\n", worst, r.sweeps);
  EXPECT_LT(worst, 1e-6);

  // Negative control: a box that loses a thousandth of its exchange to the cold cools by more than that.
  const ExchangeMatrix leaky = random_exchange(n, 1, 1e-3, 3);
  std::vector<double> leaking((n + 1) * count, black(287.65));
  std::fill(leaking.end() - static_cast<std::ptrdiff_t>(count), leaking.end(), black(3));
  couple(leaky, count, leaking, respond, {1e-9, 60, 8});
  EXPECT_GT(std::fabs(kelvin_of(leaking[n * count - 1]) - 287.65), 1e-4);
}

// In a closed box of sheets without heat capacity one is held: all others come to its temperature. Plain sweeps crawl
// there, Anderson's do not.
TEST(Exchange, AHeldFaceSetsAClosedCavity) {
  const size_t n = 40;
  const ExchangeMatrix closed = random_exchange(n, 0, 0, 11);
  const std::vector<double> emissivity = mixed_emissivities(n);
  const Answer respond = [&](std::span<const double> received, std::span<double> emitted) {
    emitted[0] = black(310);
    for (size_t i = 1; i < n; ++i) {
      MasslessFace face;
      face.traits.emissivity = emissivity[i];
      face.weather.longwave = received[i];
      emitted[i] = black(massless_kelvin({&face, 1}));
    }
  };
  std::vector<double> emitted(n, black(280)), crawling(n, black(280));
  const CouplingResult r = couple(closed, 1, emitted, respond, {1e-8, 100, 20});
  const CouplingResult plain = couple(closed, 1, crawling, respond, {1e-8, 5000, 0});
  double worst = 0;
  for (const double m : emitted) worst = std::fmax(worst, std::fabs(kelvin_of(m) - 310));
  std::printf("held face: %.1e K after %d sweeps, plain %d sweeps\n", worst, r.sweeps, plain.sweeps);
  EXPECT_LT(worst, 1e-6);
  EXPECT_LT(5 * r.sweeps, plain.sweeps);
}

// Waveform sweeps and marching with everything coupled at every moment are one: here against steps so short that the
// received light of the last step does.
TEST(Exchange, SweepsAreTheCoupledMarch) {
  const size_t n = 6;
  const ExchangeMatrix m = random_exchange(n, 1, 0.3, 5);
  Cavity cavity{mixed_emissivities(n), std::vector<double>(240, 30.0)};
  std::vector<double> start(n);
  std::iota(start.begin(), start.end(), 290.0);
  const double sky = black(260);
  auto coupled = [&](const Cavity& c) {
    std::vector<double> emitted((n + 1) * c.moments(), black(290));
    std::fill(emitted.end() - static_cast<std::ptrdiff_t>(c.moments()), emitted.end(), sky);
    const Answer respond = [&](std::span<const double> r, std::span<double> e) { c.run(start, r, e); };
    const CouplingResult result = couple(m, c.moments(), emitted, respond, {1e-6, 60, 0});
    EXPECT_LE(result.sweeps, 20);
    return emitted;
  };
  const std::vector<double> fine = coupled(cavity);
  // The march: received light from the emitted of the step's begin.
  SlabBatch batch({uniform(1e-3, 2700, 900, 200), uniform(0.05, 1000, 1000, 0.5)}, n);
  for (size_t e = 0; e < n; ++e)
    for (size_t i = 0; i < batch.nodes(); ++i) batch.set_kelvin(e, i, start[e]);
  std::vector<double> now(n + 1, sky), received(n);
  for (int k = 0; k < 72000; ++k) {
    for (size_t e = 0; e < n; ++e) now[e] = black(batch.top(e));
    m.receive(now, 1, received);
    batch.step(0.1, [&](double, double, const SlabBatch&, FaceLines& top, FaceLines&) {
      for (size_t e = 0; e < n; ++e) {
        const double constant = cavity.emissivity[e] * received[e];
        top.constant[e] = {constant, constant};
        top.quartic[e] = cavity.emissivity[e] * kStefanBoltzmann;
      }
    });
  }
  double worst = 0;
  for (size_t e = 0; e < n; ++e)
    worst = std::fmax(worst, std::fabs(kelvin_of(fine[(e + 1) * cavity.moments() - 1]) - batch.top(e)));
  std::printf("sweeps against the march: %.1e K at the end\n", worst);
  EXPECT_LT(worst, 2e-3);
}

// Two films of 10 um on concrete that see each other and the sky, one in the sun, from sunrise to noon: histories in
// steps of 10 min against steps of 1 s, coupled by sweeps.
TEST(Exchange, CoupledFilmDoesNotDependOnTheStep) {
  const double e = 0.9;
  const Day days[2] = {Day(0.9, 2, e, 0), Day(0.09, 2, e, 0)};  // the sky is a part of the exchange
  ExchangeMatrix m(2, 1);
  m.add_row(std::vector<Entry>{{0, 0.05}, {1, 0.45}, {2, 0.5}});
  m.add_row(std::vector<Entry>{{0, 0.45}, {1, 0.05}, {2, 0.5}});
  // The answer of both to what they receive, through a step.
  const auto act = [&](double begin, double end, const double* a, const double* b, FaceLines& top) {
    for (size_t i = 0; i < 2; ++i) {
      const double* r = i == 0 ? a : b;
      const StepLine own = days[i].constant.over(begin, end);
      top.constant[i] = {own.begin + e * r[0], own.end + e * r[1]};
      top.linear[i] = days[i].linear.over(begin, end);
      top.quartic[i] = e * kStefanBoltzmann;
    }
  };
  // Dawn of a periodic day among neighbours of 288 K.
  SlabBatch dawn({uniform(1e-5, 2700, 900, 0.2), uniform(1, 2300, 880, 1.4)}, 2);
  const double around[2] = {160 + black(288) / 2, 160 + black(288) / 2};
  const BatchLoads alone = [&](double begin, double end, const SlabBatch&, FaceLines& top, FaceLines&) {
    act(begin, end, around, around, top);
  };
  dawn.start(0, 288);
  find_periodic(dawn, 0, std::vector<double>(144, 600.0), alone);
  dawn.restart(0);
  for (int k = 0; k < 36; ++k) dawn.step(600, alone);
  auto histories = [&](double dt) {
    const auto steps = static_cast<size_t>(std::lround(21600 / dt)), count = steps + 1;
    std::vector<double> emitted(3 * count, black(290));
    std::fill(emitted.end() - static_cast<std::ptrdiff_t>(count), emitted.end(), 320.0);
    const Answer respond = [&](std::span<const double> received, std::span<double> answer) {
      SlabBatch batch = dawn;
      for (size_t k = 0; k < count; ++k) {
        for (size_t i = 0; i < 2; ++i) answer[i * count + k] = black(batch.top(i));
        if (k + 1 == count) break;
        batch.step(dt, [&](double begin, double end, const SlabBatch&, FaceLines& top, FaceLines&) {
          act(begin, end, &received[k], &received[count + k], top);
        });
      }
    };
    const CouplingResult r = couple(m, count, emitted, respond, {1e-3, 40, 0});
    std::printf("coupled film in steps of %g s: %d sweeps\n", dt, r.sweeps);
    return emitted;
  };
  const std::vector<double> fine = histories(1), coarse = histories(600);
  double worst = 0;
  for (size_t i = 0; i < 2; ++i)
    for (size_t k = 0; k <= 36; ++k)
      worst = std::fmax(worst, std::fabs(kelvin_of(fine[i * 21601 + 600 * k]) - kelvin_of(coarse[i * 37 + k])));
  std::printf("coupled film: %.2e K\n", worst);
  EXPECT_LT(worst, 0.02);
}

TEST(Exchange, RefusesWhatIsNoExchange) {
  ExchangeMatrix m(2, 1);
  EXPECT_NE(message_of([&] {
              m.add_row(std::vector<Entry>{{0, 0.5}, {2, 0.4}});
            }).find("sum to 0.9"),
            std::string::npos);
  EXPECT_NE(message_of([&] { m.add_row(std::vector<Entry>{{3, 1}}); }).find("ends at 3"), std::string::npos);
  EXPECT_NE(message_of([&] { m.add_row(std::vector<Entry>{{0, 1.5}, {1, -0.5}}); }).find("-0.5"), std::string::npos);
  m.add_row(std::vector<Entry>{{1, 1}});
  m.add_row(std::vector<Entry>{{0, 0.25}, {0, 0.25}, {2, 0.5}});
  EXPECT_EQ(m.entries(), 3u);
  // Two mirrors of each other's guess that answer ever more: told, not looped.
  std::vector<double> emitted{100, 100, 100};
  const Answer louder = [](std::span<const double> r, std::span<double> e) { e[0] = 2 * r[0], e[1] = 2 * r[1]; };
  EXPECT_NE(message_of([&] {
              couple(m, 1, emitted, louder, {1e-3, 20, 0});
            }).find("after 20 sweeps"),
            std::string::npos);
}

}  // namespace
}  // namespace suite::exchange_test
