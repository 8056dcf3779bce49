#include "formats/sqt/sqt.h"
#include "formats/sqt/container.h"
#include "formats/sqt/sqt_write.h"
#include "support/fuzz.h"
#include "support/polished_metal.h"
#include "support/sqt_examples.h"

namespace suite::format_sqt_sqt_test {
namespace {

void parse_and_ask(std::span<const std::byte> bytes) {
  const SqtFile file = parse_sqt(bytes, "x.sqt");
  if (const sqt::MuellerTable* const table = file.bundle->info().mueller.get()) {
    std::vector<Mueller> m(table->data().wavelength_um.size());
    table->at(dir_from_angles(0.4, 0.1), dir_from_angles(1.1, -2), m);
  }
  for (const double theta : {0.0, 0.4, 1.2, 1.57}) {
    const Dir out = dir_from_angles(theta, 0.1);
    const auto in = file.bundle->sample(out, {0.3, 0.6}, 0.4, 0);
    const double f = file.bundle->value(out, in ? *in : dir_from_angles(0.5, 2), 0);
    if (!(f >= 0)) throw std::runtime_error("a value that is negative or not a number came out");
  }
}

// With the checksum set right again, so that mutations reach what lies behind it.
void resealed(std::span<const std::byte> bytes) {
  std::vector<std::byte> copy(bytes.begin(), bytes.end());
  if (copy.size() >= sqt_file::kFixed) {
    uint64_t crc = sqt_file::crc64(std::span(copy).first(sqt_file::kFixed - 8));
    crc = sqt_file::crc64(std::span(copy).subspan(sqt_file::kFixed), crc);
    std::memcpy(&copy[sqt_file::kFixed - 8], &crc, sizeof crc);
  }
  parse_and_ask(copy);
}

const std::vector<std::string> kWords{"\"leaves\":", "\"sheets\":2", "1e308", "-1",   "99999999", "\"phi_count\":1000",
                                      "[",           "\"half\"",     "null",  "paper"};

TEST(FuzzSqt, Aligned) { test::fuzz(pack_sqt(test::small_fit(test::glossy(), 0.5), {}, {}), parse_and_ask); }
TEST(FuzzSqt, AlignedBehindTheChecksum) {
  test::fuzz(pack_sqt(test::small_fit(test::glossy(), 0.5), {}, {}), resealed, 2, test::kMutations, kWords);
}
// Cut off at every byte, with the checksum of what is left.
TEST(FuzzSqt, EveryTruncationIsRefused) {
  const std::vector<std::byte> whole = pack_sqt(test::small_fit(test::glossy(), 1), {}, {});
  for (size_t n = 0; n < whole.size(); ++n) {
    const std::vector<std::byte> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(n));
    for (const auto& read : {parse_and_ask, resealed}) try {
        read(cut);
        FAIL() << n << " of " << whole.size() << " bytes were accepted";
      } catch (const Error& e) {
        ASSERT_EQ(e.where().file, "x.sqt") << n;
      }
  }
}
TEST(FuzzSqt, MatricesBehindTheChecksum) {
  sqt::AlignedFit fit = test::small_fit(test::glossy(), 0.5);
  fit.data.mueller = sqt::fit_mueller(*test::polished_metal(), 0.1).table;
  test::fuzz(pack_sqt(fit, {}, {}), resealed, 4, test::kMutations, kWords);
}
TEST(FuzzSqt, PaperBehindTheChecksum) {
  test::fuzz(pack_sqt(test::small_paper(test::glossy()), {}, {}), resealed, 3, test::kMutations, kWords);
}

}  // namespace
}  // namespace suite::format_sqt_sqt_test
