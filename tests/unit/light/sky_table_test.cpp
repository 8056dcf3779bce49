// Tables of the sky are made row by row where they are asked, once, whatever the threads.
#include "light/sky_table.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <thread>

#include "math/sampling.h"

namespace suite::sky_table_test {
namespace {

constexpr size_t kBins = 3, kRows = 91, kColumns = 73;  // one sun: half of the azimuths
constexpr double kLow = -6000, kStep = 1000, kSun = 0.3;

// A sky whose nodes are counted, by height and zenith angle.
struct Counted {
  std::array<std::array<std::atomic<int>, kRows>, 19> nodes{};
  SkyTable table{kBins, false, kSun, kStep, [this](double height, Dir d, std::span<float> radiance) {
                   const auto row = static_cast<size_t>(std::lround(std::acos(std::min(d.z, 1.0)) / kDegree));
                   ++nodes[static_cast<size_t>(std::lround((height - kLow) / kStep))][row];
                   for (size_t i = 0; i < kBins; ++i)
                     radiance[i] = static_cast<float>(1 + 1e-4 * height + d.z + 0.1 * static_cast<double>(i) * d.x);
                 }};
  int all() const {
    int sum = 0;
    for (const auto& floor : nodes)
      for (const auto& row : floor) sum += row;
    return sum;
  }
};

TEST(SkyTable, MakesTheRowsThatAreAsked) {
  Counted sky;
  const Dir d = dir_from_angles(20.5 * kDegree, kSun + 0.8);
  std::array<float, kBins> L{};
  sky.table.radiance(0, d, L);
  EXPECT_EQ(sky.all(), 2 * static_cast<int>(kColumns));
  for (size_t i = 0; i < kBins; ++i) EXPECT_NEAR(L[i], 1 + d.z + 0.1 * static_cast<double>(i) * d.x, 1e-3) << i;
  sky.table.radiance(0, d, L);
  EXPECT_EQ(sky.all(), 2 * static_cast<int>(kColumns));
  // Between two heights four; one of them is of a row that is there.
  sky.table.radiance(500, dir_from_angles(21.5 * kDegree, kSun), L);
  EXPECT_EQ(sky.all(), 5 * static_cast<int>(kColumns));
  EXPECT_NEAR(L[0], 1.05 + std::cos(21.5 * kDegree), 1e-3);
  // A light draws from all of the sky over the ground.
  sky.table.make_light();
  ASSERT_NE(sky.table.light(), nullptr);
  for (const auto& nodes : sky.nodes[6]) EXPECT_EQ(nodes, static_cast<int>(kColumns));
  EXPECT_EQ(sky.all(), static_cast<int>((kRows + 2) * kColumns));
}

TEST(SkyTable, IsTheSameForManyThreads) {
  constexpr size_t kThreads = 4, kAsked = 2000;
  struct Question {
    double height;
    Dir d;
  };
  std::vector<Question> questions;
  Pcg32 random(5);
  for (size_t n = 0; n < kAsked; ++n)
    questions.push_back(
        {random.uniform() * 4000 - 1000, dir_from_angles(random.uniform() * kPi / 2, random.uniform() * 2 * kPi)});
  const auto answers = [&](Counted& sky, size_t first) {
    std::vector<float> all(2 * kAsked);
    std::array<float, kBins> L{};
    for (size_t k = 0; k < kAsked; ++k) {
      const size_t n = (first + k) % kAsked;
      sky.table.radiance(questions[n].height, questions[n].d, L);
      all[2 * n] = L[1], all[2 * n + 1] = sky.table.drawn(questions[n].height, questions[n].d)[2];
    }
    return all;
  };
  Counted alone, shared;
  const std::vector<float> wanted = answers(alone, 0);
  std::array<std::vector<float>, kThreads> found;
  std::vector<std::thread> threads;
  for (size_t t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] { found[t] = answers(shared, t * kAsked / kThreads); });
  for (std::thread& t : threads) t.join();
  for (const auto& of : found) EXPECT_EQ(of, wanted);
  for (size_t f = 0; f < shared.nodes.size(); ++f)
    for (size_t r = 0; r < kRows; ++r) {
      EXPECT_TRUE(shared.nodes[f][r] == 0 || shared.nodes[f][r] == static_cast<int>(kColumns)) << f << ' ' << r;
      EXPECT_EQ(shared.nodes[f][r] > 0, alone.nodes[f][r] > 0) << f << ' ' << r;
    }
}

}  // namespace
}  // namespace suite::sky_table_test
