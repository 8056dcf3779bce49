// Temperatures of elements in a file: there and back, and what does not fit.
#include "formats/heat_hdf/heat_hdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "base/files.h"
#include "heat/heat_field.h"
#include "support/heated_file_kit.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::format_heat_hdf_heat_hdf_test {
namespace {

using namespace test;
using testing::AllOf;
using testing::HasSubstr;

TEST(HeatHdf, ThereAndBack) {
  const TempFolder folder;
  const HeatedFile file;
  file.write(folder / "heat.h5");
  const HeatCut cut = heat_cut(folder / "heat.h5");
  EXPECT_EQ(cut, file.cut);
  const HeatResult a = file.result, b = read_heat(folder / "heat.h5", *file.kit.elements, *file.kit.faces);
  EXPECT_EQ(a.kelvin, b.kelvin);
  EXPECT_EQ(a.path_error, b.path_error);
  EXPECT_EQ(a.size_error, b.size_error);
  EXPECT_EQ(a.step_error, b.step_error);
  EXPECT_EQ(a.absorbed, b.absorbed);
  EXPECT_EQ(a.received, b.received);
  EXPECT_EQ(a.emissivity, b.emissivity);
  EXPECT_EQ(a.absorptance, b.absorptance);
  EXPECT_EQ(a.sun_hours, b.sun_hours);
  EXPECT_EQ(a.air_kelvin, b.air_kelvin);
  EXPECT_EQ(a.span, b.span);
  EXPECT_EQ(a.periodic, b.periodic);
  EXPECT_EQ(a.moments, b.moments);
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.sweeps, b.sweeps);
  EXPECT_EQ(a.sweep_error, b.sweep_error);
  EXPECT_EQ(a.past_error, b.past_error);
  EXPECT_EQ(a.balance.residual(), b.balance.residual());
  EXPECT_EQ(a.kelvin_at(1, 12345), b.kelvin_at(1, 12345));
}

TEST(HeatHdf, FluxesAreReadWhereTheyAreAsked) {
  const TempFolder folder;
  const HeatedFile file;
  file.write(folder / "heat.h5");
  const HeatResult r = read_heat(folder / "heat.h5", *file.kit.elements, *file.kit.faces, false);
  EXPECT_EQ(r.kelvin, file.result.kelvin);
  EXPECT_TRUE(r.absorbed.empty() && r.received.empty());
  const HeatResult travelled = unpacked_field(packed_field(r));
  EXPECT_EQ(travelled.kelvin, r.kelvin);
  EXPECT_TRUE(travelled.absorbed.empty());
}

TEST(HeatHdf, WhatIsLeftAndWhatPointsNeed) {
  const TempFolder folder;
  HeatedFile file;
  EXPECT_TRUE(heat_cut((file.write(folder / "all.h5"), folder / "all.h5")).kept.empty());
  EXPECT_TRUE(read_heat(folder / "all.h5", *file.kit.elements, *file.kit.faces).straight.empty());
  file.result.straight = file.result.absorbed;
  file.cut.kept = {1, 4};
  file.write(folder / "some.h5");
  EXPECT_EQ(heat_cut(folder / "some.h5").kept, (std::vector<uint32_t>{1, 4}));
  EXPECT_EQ(read_heat(folder / "some.h5", *file.kit.elements, *file.kit.faces).straight, file.result.straight);
}

TEST(HeatHdf, SameResultSameBytes) {
  const TempFolder folder;
  const HeatedFile file, again;
  file.write(folder / "a.h5");
  again.write(folder / "b.h5");
  EXPECT_EQ(read_bytes(folder / "a.h5"), read_bytes(folder / "b.h5"));
}

TEST(HeatHdf, Messages) {
  const TempFolder folder;
  const HeatedFile file, other(7);
  const auto told = [&](const std::string& path, const HeatedFile& of) {
    return message_of([&] { read_heat(path, *of.kit.elements, *of.kit.faces); });
  };
  file.write(folder / "heat.h5");
  EXPECT_THAT(told(folder / "heat.h5", other), AllOf(HasSubstr("heat.h5"), HasSubstr("of another scene")));
  EXPECT_THAT(told(folder / "none.h5", file), HasSubstr("none.h5"));
  write_file(folder / "text.h5", std::string_view("no file of this kind"));
  EXPECT_THAT(told(folder / "text.h5", file), HasSubstr("text.h5"));
  HeatedFile cold;
  cold.result.kelvin[3] = 0;
  cold.write(folder / "cold.h5");
  EXPECT_THAT(told(folder / "cold.h5", cold), AllOf(HasSubstr("/faces/temperature"), HasSubstr("1 to 10000")));
  HeatedFile back;
  back.result.span = {5, 5};
  back.write(folder / "back.h5");
  EXPECT_THAT(told(folder / "back.h5", back), HasSubstr("ends before it begins"));
}

}  // namespace
}  // namespace suite::format_heat_hdf_heat_hdf_test
