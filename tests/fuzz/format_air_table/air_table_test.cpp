// Damaged tables of gas absorption: read, and then within their own bounds, or one Error.
#include "formats/air_table/air_table.h"

#include "base/files.h"
#include "support/fuzz.h"
#include "support/temp_folder.h"

namespace suite::format_air_table_air_table_test {

TEST(FuzzAirTable, File) {
  const TempFolder folder;
  const std::string path = folder / "t.h5";
  GasTable t;
  t.source = "made by a test";
  t.edges_cm = {1000, 1010, 1030};
  t.pressure = {100, 100000};
  t.temperature = {200, 300};
  t.weight = {0.75, 0.25};
  t.gases = {Gas::h2o};
  t.cross_section.assign(16, 1e-25f);
  t.water_self.assign(4, 1e-29f);
  write_air_table(path, t);
  test::fuzz(read_bytes(path), [&](std::span<const std::byte> mutated) {
    test::put_file(path, mutated);
    check_gas_table(read_air_table(path));
  });
}

}  // namespace suite::format_air_table_air_table_test
