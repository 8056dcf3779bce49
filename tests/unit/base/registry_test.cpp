// The one table of kinds: found, refused with the nearest name, added to, listed.
#include "base/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/message_of.h"

namespace suite::registry_test {
namespace {
using testing::HasSubstr;

struct LensRow : RegistryRow<double(double)> {
  std::vector<Parameter> parameters;
};
using P = Parameter;

Registry<LensRow> lenses() {
  return {"lens",
          "LE101",
          {{{"thin", "a thin lens", "m", [](double f) { return 2 * f; }},
            {{"focal_length", P::Kind::number, "m", "of both sides", 0.1, 10},
             {"glass", P::Kind::text, "", "its name", 0, 0, false}}},
           {{"thick", "a thick lens", "", [](double f) { return 3 * f; }}, {}}}};
}

TEST(Registry, FindsAndMakes) {
  const Registry<LensRow> table = lenses();
  EXPECT_EQ(table.size(), 2u);
  EXPECT_EQ(table.find("thick").make(2), 6);
  EXPECT_EQ(table.look_up("thic"), nullptr);
  EXPECT_THAT(table.names(), testing::ElementsAre("thin", "thick"));
}

TEST(Registry, RefusesAnUnknownNameWithItsPlaceAndTheNearest) {
  const Registry<LensRow> table = lenses();
  EXPECT_EQ(message_of([&] {
              table.find("thikc", {"x.yaml", 12, 9, {}, -1});
            }),
            "x.yaml:12:9: error: unknown lens 'thikc' [LE101]; did you mean 'thick'?");
  EXPECT_THAT(message_of([&] { table.find("prism"); }), HasSubstr("known: thin, thick"));
}

TEST(Registry, TakesARowFromOutsideOnce) {
  Registry<LensRow> table = lenses();
  table.add({{"gradient", "a rod", "", [](double f) { return f; }}, {}});
  EXPECT_EQ(table.find("gradient").make(5), 5);
  EXPECT_THAT(message_of([&] { table.add({{"thin", "", "", {}}, {}}); }), HasSubstr("there is a lens 'thin' already"));
  EXPECT_EQ(table.size(), 3u);
}

TEST(Registry, RefusesATableThatNamesARowTwice) {
  const LensRow row{{"thin", "", "", {}}, {}};
  EXPECT_THROW(Registry<LensRow>("lens", "", {row, row}), Bug);
}

TEST(Registry, ListsRowsAndParameters) {
  EXPECT_EQ(lenses().list(),
            "thin               a thin lens [m]\n"
            "    focal_length           of both sides [m]\n"
            "    glass                  its name, optional\n"
            "thick              a thick lens\n");
}

TEST(Registry, HoldsParametersToTheirRanges) {
  const Parameter f = lenses().find("thin").parameters[0];
  for (const double good : {0.1, 10.0}) EXPECT_NO_THROW(check_range("lens 'thin'", f, good, {}));
  for (const double bad : {0.0999, 10.01, double{NAN}})
    EXPECT_THAT(message_of([&] { check_range("lens 'thin'", f, bad, {}, "LE103"); }),
                HasSubstr("is outside its range [LE103]; give 0.1 to 10 m"))
        << bad;
}

}  // namespace
}  // namespace suite::registry_test
