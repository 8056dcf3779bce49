// .sqt files come back as they went, and damaged ones do not come back at all.
#include <gtest/gtest.h>

#include "base/error.h"
#include "base/parallel.h"
#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"
#include "math/sampling.h"
#include "math/warps.h"
#include "support/polished_metal.h"
#include "support/sqt_examples.h"

namespace suite::format_sqt_file_test {
namespace {

void expect_same(const sqt::Bundle& a, const sqt::Bundle& b) {
  ASSERT_EQ(a.channels(), b.channels());
  EXPECT_EQ(a.info().leaves, b.info().leaves);
  Pcg32 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Dir out = uniform_sphere({0.5 * random.uniform(), random.uniform()}),
              in = uniform_sphere({0.5 * random.uniform(), random.uniform()});
    for (size_t c = 0; c < a.channels(); ++c) {
      EXPECT_EQ(a.value(out, in, c), b.value(out, in, c));
      EXPECT_EQ(a.pdf(out, in, c), b.pdf(out, in, c));
      EXPECT_EQ(a.total(out, c), b.total(out, c));
    }
  }
}

TEST(SqtFile, AlignedComesBackAsItWent) {
  const sqt::AlignedFit fit = test::small_fit(test::glossy());
  const SqtFile file = parse_sqt(pack_sqt(fit, {"sqt-fit x", "sqt-fit 1", "x.bsdf", "00", "none"}, {}), "x.sqt");
  expect_same(*sqt::make_bundle(fit.data), *file.bundle);
  EXPECT_EQ(file.bundle->info().method, "aligned");
  EXPECT_NE(file.header.find("\"command\":"), std::string::npos);
}

TEST(SqtFile, PaperComesBackAsItWent) {
  const sqt::PaperData data = test::small_paper(test::glossy());
  expect_same(*sqt::make_bundle(data), *parse_sqt(pack_sqt(data, {}, {}), "x.sqt").bundle);
}

// With matrices behind either payload.
TEST(SqtFile, MatricesComeBackAsTheyWent) {
  const sqt::MuellerFit mueller = sqt::fit_mueller(*test::polished_metal(), 0.02);
  sqt::AlignedFit fit = test::small_fit(test::glossy());
  sqt::PaperData data = test::small_paper(test::glossy());
  fit.data.mueller = data.mueller = mueller.table;
  SqtProvenance provenance;
  provenance.mueller = mueller.errors;
  for (const auto& bytes : {pack_sqt(fit, provenance, {}), pack_sqt(data, provenance, {})}) {
    const SqtFile file = parse_sqt(bytes, "x.sqt");
    EXPECT_EQ(file.version, 5);
    ASSERT_TRUE(file.bundle->info().mueller);
    EXPECT_EQ(file.bundle->info().mueller->data().elements, mueller.table->data().elements);
    EXPECT_EQ(file.bundle->info().mueller->data().grid.theta_h, mueller.table->data().grid.theta_h);
    EXPECT_NE(file.header.find("\"lit\""), std::string::npos);
    for (size_t n = 0; n < bytes.size(); n += 7) EXPECT_THROW(parse_sqt(std::span(bytes).first(n), "x.sqt"), Error);
  }
  expect_same(*sqt::make_bundle(fit.data), *parse_sqt(pack_sqt(fit, provenance, {}), "x.sqt").bundle);
  EXPECT_LT(parse_sqt(pack_sqt(test::small_fit(test::glossy()), {}, {}), "x.sqt").version, 5)
      << "a file is of the oldest version that says what it holds";
}

TEST(SqtFile, BytesDoNotDependOnTheThreadCount) {
  std::vector<std::byte> first;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    const auto bytes = pack_sqt(test::small_fit(test::glossy()), {}, {});
    if (first.empty()) first = bytes;
    EXPECT_EQ(bytes, first) << count << " threads";
  }
  set_threads(0);
}

TEST(SqtFile, TruncationAtEveryByteIsRefused) {
  for (const auto& bytes : {pack_sqt(test::small_fit(test::glossy(0.3), 1.0), {}, {}),
                            pack_sqt(test::small_paper(test::glossy(0.3, 1)), {}, {})})
    for (size_t n = 0; n < bytes.size(); ++n) EXPECT_THROW(parse_sqt(std::span(bytes).first(n), "x.sqt"), Error) << n;
}

TEST(SqtFile, EveryFlippedBitIsRefused) {
  std::vector<std::byte> bytes = pack_sqt(test::small_fit(test::glossy(0.3), 1.0), {}, {});
  for (size_t n = 0; n < 8 * bytes.size(); n += 3) {
    bytes[n / 8] ^= std::byte(1u << (n % 8));
    EXPECT_THROW(parse_sqt(bytes, "x.sqt"), Error) << "bit " << n;
    bytes[n / 8] ^= std::byte(1u << (n % 8));
  }
}

TEST(SqtFile, MessagesSayWhatIsWrong) {
  auto message = [](std::span<const std::byte> bytes) -> std::string {
    try {
      parse_sqt(bytes, "x.sqt");
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  std::vector<std::byte> bytes = pack_sqt(test::small_fit(test::glossy(0.3), 1.0), {}, {});
  EXPECT_NE(message(std::span(bytes).first(3)).find("not an SQT file"), std::string::npos);
  EXPECT_NE(message(std::span(bytes).first(100)).find("is it truncated?"), std::string::npos);
  bytes[8] = std::byte{9};
  EXPECT_NE(message(bytes).find("SQT version 9"), std::string::npos);
}

}  // namespace
}  // namespace suite::format_sqt_file_test
