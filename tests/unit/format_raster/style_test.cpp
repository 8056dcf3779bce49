// Styles of QGIS: what is shown how, as an XML reader finds it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/files.h"
#include "formats/raster/raster_style.h"
#include "support/message_of.h"
#include "support/run_command.h"

namespace suite::format_raster_style_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class RasterStyleTest : public testing::Test {
 protected:
  // The attributes and texts of the style that Python's XML reader finds, a line an element.
  std::string elements(const RasterStyle& style) {
    write_qgis_style(folder_ / "x.qml", style);
    const CommandResult r = run_command(
        "python3 -c \"import sys, xml.etree.ElementTree as E\n"
        "for e in E.parse(sys.argv[1]).iter(): print(e.tag, sorted(e.attrib.items()), (e.text or '').strip())\" '" +
        (folder_ / "x.qml") + "'");
    EXPECT_EQ(r.code, 0) << r.err;
    return r.out;
  }
  TempFolder folder_;
};

TEST_F(RasterStyleTest, ThreeBandsShareTheirEnds) {
  const std::string text = elements({{3, 1, 0}, {0.25, 80}, 2.2, {}, {}});
  for (const char* part : {"('blueBand', '1')", "('greenBand', '2')", "('redBand', '4')", "('type', 'multibandcolor')",
                           "redContrastEnhancement", "greenContrastEnhancement", "blueContrastEnhancement",
                           "minValue [] 0.25\nmaxValue [] 80\n", "('gamma', '2.2')"})
    EXPECT_THAT(text, HasSubstr(part));
}

TEST_F(RasterStyleTest, OneBandIsGreyOrHasColours) {
  RasterStyle style{{1}, {280, 310}, 1, {}, {}};
  const std::string grey = elements(style);
  EXPECT_THAT(grey, HasSubstr("('grayBand', '2')"));
  EXPECT_THAT(grey, HasSubstr("minValue [] 280\nmaxValue [] 310\n"));
  style.ramp = {{280, "cold", {0, 0, 4}}, {310, "warm", {252, 255, 164}}};
  const std::string ramp = elements(style);
  EXPECT_THAT(ramp, HasSubstr("('type', 'singlebandpseudocolor')"));
  EXPECT_THAT(ramp, HasSubstr("item [('alpha', '255'), ('color', '#000004'), ('label', 'cold'), ('value', '280')]"));
  EXPECT_THAT(ramp, HasSubstr("('colorRampType', 'INTERPOLATED')"));
  EXPECT_THAT(ramp, Not(HasSubstr("contrastEnhancement")));
}

TEST_F(RasterStyleTest, ClassesHaveNamesWhateverIsInThem) {
  const std::string text =
      elements({{0}, {}, 1, {}, {{0, "nothing", {}, false}, {1, "grass & \"<wet>\"", {255, 128, 0}}}});
  EXPECT_THAT(text, HasSubstr("('type', 'paletted')"));
  EXPECT_THAT(text, HasSubstr("paletteEntry [('alpha', '0'), ('color', '#000000'), ('label', 'nothing')"));
  EXPECT_THAT(text, HasSubstr("('color', '#ff8000'), ('label', 'grass & \"<wet>\"'), ('value', '1')]"));
}

TEST_F(RasterStyleTest, TwoBandsAreNoPicture) {
  EXPECT_THAT(message_of([&] {
                write_qgis_style(folder_ / "x.qml", {{0, 1}, {}, 1, {}, {}});
              }),
              HasSubstr("one or three bands, not 2"));
  EXPECT_EQ(folder_.entries(), 0u);
}

}  // namespace
}  // namespace suite::format_raster_style_test
