#include "formats/hitran/hitran.h"
#include "support/fuzz.h"

namespace suite::format_hitran_hitran_test {

namespace {
std::string_view text_of(std::span<const std::byte> b) { return {reinterpret_cast<const char*>(b.data()), b.size()}; }
}  // namespace

TEST(FuzzHitran, Lines) {
  test::fuzz(test::bytes_of(" 11 1554.352490 9.750E-20 1.082E+01.09850.488  136.16390.77-.001840          0 1 0\n"
                            " 22 2283.488000 3.000E-20 2.000E+02.07130.095    0.78000.75-.002900\n"),
             [](std::span<const std::byte> b) { parse_hitran(text_of(b), "l.par"); }, 21, test::kMutations,
             {"nan", "1E+99", "-1", " 71", "\n", "   "});
}

TEST(FuzzHitran, PartitionSum) {
  test::fuzz(test::bytes_of("200 80\n290 130\n300 140\n"),
             [](std::span<const std::byte> b) { parse_partition_sum(text_of(b), "q.txt")(296); }, 22, test::kMutations,
             {"nan", "1e99", "-1", "#", "\n"});
}

TEST(FuzzHitran, Continuum) {
  test::fuzz(test::bytes_of(
                 "wavenumber_cm,self,foreign,self_exponent\n-20,1e-22,2e-24,4\n-10,3e-22,4e-24,5\n0,5e-22,6e-24,6\n"),
             [](std::span<const std::byte> b) { parse_water_continuum(text_of(b), "c.csv"); }, 23, test::kMutations,
             {"nan", "1e99", "-1", "self", ",", "\n"});
}

}  // namespace suite::format_hitran_hitran_test
