// Products of matrices that do not commute, in the order from the path to the light; and throughputs that are kept and
// gone back to with theirs.
#include "transport/path/suffix_matrices.h"

#include <gtest/gtest.h>

#include "transport/stokes_throughputs.h"

namespace suite::suffix_matrices_test {
namespace {

constexpr size_t kBins = 3;
const Mueller kA = polarizer(0.3, 0.2) * 2, kB = retarder(1.1, 0.9), kC = polarizer(-0.8, 0.5) * 1.5;

void expect_near(const Mueller& a, const Mueller& b) {
  for (size_t i = 0; i < 16; ++i) EXPECT_NEAR(a.m[i], b.m[i], 1e-15) << i;
}
// One matrix for all bins, or one a bin, turned by another angle in each.
Mueller turned(const Mueller& m, size_t b) {
  const double angle = 0.1 * static_cast<double>(b);
  return frame_rotation(std::cos(angle), std::sin(angle)) * m;
}
void take(SuffixMatrices& suffix, const Mueller& m, bool grey = true, double unknown = 0) {
  const std::span<Mueller> to = suffix.next(kBins);
  for (size_t b = 0; b < (grey ? 1 : kBins); ++b) to[b] = grey ? m : turned(m, b);
  suffix.take({grey, unknown});
}

TEST(SuffixMatrices, LaterEventsStandOnTheRight) {
  SuffixMatrices suffix;
  for (const int round : {0, 1}) {  // memory is used again
    suffix.begin();
    EXPECT_EQ(suffix.event(), nullptr) << round;
    take(suffix, kA);
    take(suffix, kB);
    take(suffix, kC);
    const PolarisedEvent* const all = suffix.event();
    ASSERT_EQ(all->matrices.size(), 1u);
    expect_near(all->matrices[0], kA * kB * kC);
    // Any other order is another matrix.
    EXPECT_GT(std::fabs((kA * kB * kC)(1, 0) - (kA * kC * kB)(1, 0)), 0.05);
    EXPECT_GT(std::fabs((kA * kB * kC)(1, 0) - (kC * kB * kA)(1, 0)), 0.05);
  }
}

// Where the first event that tells wavelengths apart stands makes no difference.
TEST(SuffixMatrices, BinsPartWhereAnEventTellsThemApart) {
  for (const size_t apart : {0u, 1u, 2u, 3u}) {
    SuffixMatrices suffix;
    const Mueller m[] = {kA, kB, kC};
    for (size_t i = 0; i < 3; ++i) take(suffix, m[i], i != apart);
    ASSERT_EQ(suffix.event()->matrices.size(), apart < 3 ? kBins : 1u);
    for (size_t b = 0; b < suffix.event()->matrices.size(); ++b) {
      const auto of = [&](size_t i) { return i == apart ? turned(m[i], b) : m[i]; };
      expect_near(suffix.event()->matrices[b], of(0) * of(1) * of(2));
    }
  }
}

// A suffix goes on from another's beginning, which stays.
TEST(SuffixMatrices, BeginningsAreShared) {
  SuffixMatrices begun, first, second;
  take(begun, kA, false, 0.5);
  first.begin(begun), second.begin(begun);
  take(first, kB, true, 0.2);
  take(second, kC);
  for (size_t b = 0; b < kBins; ++b) {
    expect_near(begun.event()->matrices[b], turned(kA, b));
    expect_near(first.event()->matrices[b], turned(kA, b) * kB);
    expect_near(second.event()->matrices[b], turned(kA, b) * kC);
  }
  EXPECT_FLOAT_EQ(begun.event()->unknown, 0.5f);
  EXPECT_FLOAT_EQ(first.event()->unknown, 0.6f);
  EXPECT_FLOAT_EQ(second.event()->unknown, 0.5f);
}

// What a path brings that goes back to where it was kept is what it would have brought there; bins may have parted in
// between, or before.
TEST(StokesThroughputs, PathsGoBackToWhatWasKept) {
  const std::vector<float> w{0.5f, 0.7f, 0.9f};
  for (const bool apart_before : {false, true})
    for (const bool apart_between : {false, true}) {
      StokesThroughputs paths(1, kBins, 4);
      const auto scatter = [&](const Mueller& m, bool grey, float unknown) {
        SuffixMatrices event;
        take(event, m, grey, unknown);
        paths.scatter(0, {1, w.data()}, {{}, {}, 0, false, false, event.event()});
      };
      paths.begin(0, 1, nullptr);
      paths.begin_rows(0, Mueller::identity());
      scatter(kA, !apart_before, 0.25f);
      StokesThroughputs::Kept kept;
      paths.keep(0, 0.5f, kept);
      scatter(kB, !apart_between, 0.5f);
      paths.resume(0, kept);
      SuffixMatrices light;
      take(light, kC);
      Contribution c;
      c.polarised = light.event();
      EXPECT_FLOAT_EQ(paths.unknown(c), 0.25f);
      paths.shine_stokes(c, 1, {{0, 1, 2, 3}});
      for (size_t b = 0; b < kBins; ++b) {
        const Mueller M = (apart_before ? turned(kA, b) : kA) * kC;
        for (size_t k = 0; k < 4; ++k)
          EXPECT_NEAR(paths.light(0, k)[b], 0.5 * double{w[b]} * M(static_cast<int>(k), 0), 1e-6) << b << "IQUV"[k];
      }
    }
}

}  // namespace
}  // namespace suite::suffix_matrices_test
