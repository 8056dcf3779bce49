// Damaged star catalogues.
#include "formats/star_catalogue/star_catalogue.h"
#include "support/fuzz.h"

namespace suite::format_star_catalogue_star_catalogue_test {
namespace {

TEST(FuzzStarCatalogue, Text) {
  const std::string file =
      "# stars\r\nname,ra_deg,dec_deg,epoch,pm_ra_mas,pm_dec_mas,v_mag,b_v,temperature_k,type\r\n"
      "Vega,279.2347,38.7837,2000,200.94,286.23,0.03,0.00,,A0V\r\nB,269.4485,4.7394,2016,-801.55,10362.39,9.51,,,M4\r\n"
      ",0,-90,,,,5,,5800,\r\n";
  test::fuzz(test::bytes_of(file),
             [](std::span<const std::byte> bytes) {
               parse_star_catalogue({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzz.csv");
             },
             1, test::kMutations, {",", "nan", "1e308", "-1", "G9.99", "\n", "ra_deg", "#"});
}

}  // namespace
}  // namespace suite::format_star_catalogue_star_catalogue_test
