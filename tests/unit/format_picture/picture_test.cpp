#include "formats/picture/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"

namespace suite::format_picture_picture_test {
namespace {

size_t count(const Canvas& c, Rgb color) {
  return static_cast<size_t>(std::count(c.pixels().begin(), c.pixels().end(), color));
}

TEST(Picture, DrawingStaysOnTheCanvas) {
  Canvas c(20, 10);
  c.fill(-5, -5, 100, 8, kBlack);
  EXPECT_EQ(count(c, kBlack), 20u * 3);
  c.line({-1e6, 5}, {1e6, 5}, {255, 0, 0});
  EXPECT_EQ(count(c, {255, 0, 0}), 20u);
  c.line({5, -1e9}, {5, 1e9}, {0, 255, 0});
  EXPECT_EQ(count(c, {0, 255, 0}), 10u);
  c.line({NAN, 0}, {3, 4}, kBlack);
  c.text(15, 5, "outside?\xff", kBlack, 3);
}
TEST(Picture, TextIsLegible) {
  Canvas c(12, 8);
  c.text(0, 0, "I");
  // Three rows wide at top and bottom, a bar between.
  EXPECT_EQ(count(c, kBlack), 11u);
  EXPECT_EQ(c.pixel(2, 3), kBlack);
  EXPECT_EQ(Canvas::text_width("abc", 2), 36);
}
TEST(Picture, Scales) {
  EXPECT_EQ(viridis(0), (Rgb{68, 1, 84}));
  EXPECT_EQ(viridis(2), (Rgb{253, 231, 37}));
  EXPECT_EQ(viridis(NAN), kGrey);
  EXPECT_EQ(diverging(0), kWhite);
  EXPECT_NE(diverging(-1), diverging(1));
  EXPECT_EQ(srgb(0.0), 0);
  EXPECT_EQ(srgb(0.2140411), 127);
  EXPECT_EQ(srgb(7), 255);
  EXPECT_DOUBLE_EQ(log_position(1, 0.01, 100), 0.5);
  EXPECT_EQ(log_position(0, 0.01, 100), 0);
}
TEST(Picture, WritesPngOrNothing) {
  const std::string folder = testing::TempDir() + "/picture_test", file = folder + "/a.png";
  make_folder(folder);
  Canvas c(31, 17, {1, 2, 3});
  draw_log_bar(c, 2, 2, 5, 10, 1, 100, "t");
  write_png(file, c, "made by a test");
  const std::string bytes = read_text(file);
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(static_cast<unsigned char>(bytes[19]), 31);  // width, big-endian in IHDR
  EXPECT_EQ(static_cast<unsigned char>(bytes[23]), 17);
  EXPECT_NE(bytes.find("made by a test"), std::string::npos);
  EXPECT_THROW(write_png(folder + "/none/a.png", c, ""), Error);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
  std::filesystem::remove_all(folder);
}
TEST(Picture, PlotShowsItsLines) {
  Canvas c(300, 200);
  const PlotLine line{"f", {200, 0, 0}, {0, 1, 2}, {1, 10, NAN}};
  draw_plot(c, 0, 0, 300, 200, {"title", "x", "y", 0, 2, 0.1, 100, true}, std::span(&line, 1));
  EXPECT_GT(count(c, {200, 0, 0}), 20u);
}

}  // namespace
}  // namespace suite::format_picture_picture_test
