// Prefix codes and the whole-number lattice of the aligned method.
#include <gtest/gtest.h>

#include <array>

#include "base/error.h"
#include "math/sampling.h"
#include "sqt/cell_centers.h"
#include "sqt/coded_lattice.h"
#include "sqt_fit/prefix_encoder.h"

namespace suite::sqt::codes_test {
namespace {

TEST(SqtPrefixCode, TokensNameEveryNumber) {
  for (const uint32_t exact : {4u, 8u, 12u})
    for (uint32_t n = 0; n < (1u << 21); n += n < 5000 ? 1 : 977) {
      const Token t = token_of(n, exact);
      ASSERT_LT(t.symbol, PrefixLengths::kSymbols);
      ASSERT_EQ(t.bits, token_bits(t.symbol, exact));
      ASSERT_EQ(token_number(t.symbol, exact, t.raw), n);
    }
}

// Contexts of one symbol, of many rare ones (codes at the limit) and unused ones.
TEST(SqtPrefixCode, SymbolsAndRawBitsComeBack) {
  Pcg32 random(4);
  std::vector<std::array<uint32_t, 3>> noted;  // context, number, raw
  PrefixEncoder encoder(5);
  for (int i = 0; i < 20000; ++i) {
    const uint32_t context = random.next() % 3;
    uint32_t number = 3;
    if (context == 1)
      while (number < 40 && random.next() % 2) ++number;
    else if (context == 2)
      number = random.next() >> (8 + random.next() % 24);
    noted.push_back({context, number, random.next() & 0xFFFF});
    encoder.number(context, number, 12);
    encoder.raw(noted.back()[2], 16);
  }
  const std::vector<std::byte> bytes = encoder.finish();
  PrefixDecoder decoder(bytes, 5);
  for (const auto& [context, number, raw] : noted) {
    ASSERT_EQ(decoder.number(context, 0, 12), number);
    ASSERT_EQ(decoder.raw(0, 16), raw);
  }
  EXPECT_FALSE(decoder.overrun());
  for (int i = 0; i < 3; ++i) decoder.raw(0, 24);
  EXPECT_TRUE(decoder.overrun());
}

TEST(SqtPrefixCode, TheCostIsCloseToTheEntropy) {
  Pcg32 random(5);
  PrefixEncoder encoder(1);
  for (int i = 0; i < 100000; ++i) {
    uint32_t n = 0;
    while (n < 7 && random.next() % 2) ++n;
    encoder.symbol(0, n);
  }
  EXPECT_NEAR(static_cast<double>(encoder.finish().size()), 100000 * (2 - 1.0 / 64) / 8, 150);
}

TEST(SqtCodedLattice, LinksLeadToTheNodeThatCoversTheNeighbour) {
  for (const bool half : {true, false})
    for (const bool upper : {true, false}) {
      const Region region{upper, half};
      CodedLattice lattice(region, 5);
      for (size_t i = 0; i < lattice.size(); ++i) std::fill_n(lattice.value(i), lattice.row(), int16_t{0});
      const int16_t* const none[3] = {};
      Pcg32 random(6);
      size_t begin = 0;
      while (begin < lattice.size() && lattice.node(begin).order < 6) {
        const size_t end = lattice.size();
        if (begin) lattice.link(begin, end);
        for (size_t i = begin; i < end; ++i) {
          lattice.find_slopes(i);
          if (random.next() % 4 > 1) lattice.divide(i, none);
        }
        begin = end;
      }
      const auto covers = [&](size_t j, CellId id) {
        CellId up = id;
        while (up.order() > lattice.node(j).order) up = up.parent();
        return up == lattice.node(j).id();
      };
      for (size_t i = 0; i < begin; ++i)
        for (size_t e = 0; e < 4; ++e) {
          CellId there = edge_neighbours(lattice.node(i).id())[e];
          if (!region.holds(there) && half) there = mirrored(there);
          int32_t expected = -1;  // the deepest node that covers it, no deeper than it
          if (region.holds(there))
            for (size_t j = 0; j < lattice.size(); ++j)
              if (lattice.node(j).order <= there.order() && covers(j, there) &&
                  (expected < 0 || lattice.node(j).order > lattice.node(static_cast<size_t>(expected)).order))
                expected = static_cast<int32_t>(j);
          ASSERT_EQ(lattice.node(i).link[e].node, expected) << "node " << i << " edge " << e;
        }
    }
}

TEST(SqtCodedLattice, MiddlesOfCellsAreThoseOfTheExactMap) {
  Pcg32 random(7);
  for (int order = 0; order <= kMaxOrder; ++order)
    for (int n = 0; n < 200; ++n) {
      const CellId id = CellId::of(order, random.next() % cell_count(order));
      CellLanes lanes;
      lanes.set(3, xy_of(id));
      EightFloats x, y, z;
      centers_of(lanes, order, x, y, z);
      EXPECT_LT(length(Dir{x[3], y[3], z[3]} - center_of(id)), 2e-6) << "order " << order << " index " << id.index();
    }
}

}  // namespace
}  // namespace suite::sqt::codes_test
