// sqt-inspect --export: what other people's formats hold is what the fit says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "base/files.h"
#include "base/params.h"
#include "formats/brdf_csv/brdf_csv.h"
#include "formats/rgl/rgl.h"
#include "formats/samples/samples.h"
#include "formats/sqt/sqt.h"
#include "support/run_command.h"

namespace suite::export_test {
namespace {

using testing::HasSubstr;

class Export : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TempFolder>();
    sqt_ = *folder_ / "w.sqt";
    const CommandResult r = run_command(SUITE_BIN_DIR
                                        "/sqt-fit -q --model ward:diffuse=0.2,specular=0.1,roughness=0.2 --views 9 "
                                        "--order 7 --max-error 0.03 --min-peak 0 -o " +
                                        sqt_);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  CommandResult inspect(const std::string& options) {
    return run_command(SUITE_BIN_DIR "/sqt-inspect " + sqt_ + " " + options);
  }
  // Every value of a table is the fit's own, to the last bit.
  void expect_exact(const sqt::Samples& samples) {
    const auto bundle = read_sqt(sqt_).bundle;
    ASSERT_GT(samples.in.size(), 1000u);
    size_t off = 0;
    for (size_t i = 0; i < samples.in.size(); ++i)
      off += bundle->value(samples.out[i], samples.in[i], 0) != samples.value[i];
    EXPECT_EQ(off, 0u) << "of " << samples.in.size();
  }
  // What the fit states of itself, relative l1 of its one channel.
  double stated() { return Params::parse_text(read_sqt(sqt_).header, "w").at("errors").at("overall").number("l1"); }
  // What an export tells of itself, in percent.
  static double told(const std::string& err) {
    const size_t at = err.find("against the fit: l1 ");
    return at == std::string::npos ? NAN : std::stod(err.substr(at + 20));
  }
  static void TearDownTestSuite() { folder_.reset(); }
  static inline std::unique_ptr<TempFolder> folder_;
  static inline std::string sqt_;  // of Ward's model
};

TEST_F(Export, CsvAndRawAreExact) {
  const std::string csv = *folder_ / "t/w.csv", raw = *folder_ / "t/w.raw";
  ASSERT_EQ(inspect("--export " + csv).code, 0);
  EXPECT_THAT(read_text(csv), HasSubstr("value in 1/sr without cosine, weight = value x |cos theta_i|"));
  const sqt::Samples table = read_brdf_csv(csv);
  EXPECT_TRUE(table.info.isotropic && table.info.bilateral);
  expect_exact(table);
  ASSERT_EQ(inspect("--export-size 9 --export " + raw).code, 0);
  expect_exact(read_samples(raw));
}

// Colours run from red to blue in fits, and from short to long waves in raw sample text.
TEST_F(Export, ColoursKeepTheirWavelengths) {
  const std::string satin = *folder_ / "c.sqt", raw = *folder_ / "c.raw", csv = *folder_ / "c.csv";
  ASSERT_EQ(run_command(SUITE_BIN_DIR "/sqt-fit -q " SUITE_TEST_DATA
                                      "/brdf/satin_purple_rgb.bsdf --views 3 --order 3 --min-peak 0 -o " +
                        satin)
                .code,
            0);
  const auto bundle = read_sqt(satin).bundle;
  for (const std::string& file : {raw, csv}) {
    const CommandResult r = run_command(SUITE_BIN_DIR "/sqt-inspect " + satin + " --export-size 4 --export " + file);
    ASSERT_EQ(r.code, 0) << r.err;
    const sqt::Samples s = file == raw ? read_samples(file) : read_brdf_csv(file);
    ASSERT_EQ(s.info.wavelength_um, (std::vector<double>{0.45, 0.55, 0.65}));
    for (size_t i = 0; i < s.in.size(); ++i)
      for (size_t c = 0; c < 3; ++c)
        ASSERT_EQ(s.value[3 * i + c], bundle->value(s.out[i], s.in[i], 2 - c)) << file << ' ' << i;
  }
}

TEST_F(Export, TablesOfTheirOwnTellTheirError) {
  const std::string bsdf = *folder_ / "w.bsdf", xml = *folder_ / "w.xml";
  const CommandResult a = inspect("--export " + bsdf), b = inspect("--export " + xml);
  ASSERT_EQ(a.code, 0) << a.err;
  ASSERT_EQ(b.code, 0) << b.err;
  EXPECT_THAT(a.err, HasSubstr("w.bsdf against the fit: l1 "));
  EXPECT_THAT(b.err, HasSubstr("w.xml against the fit: l1 "));
  EXPECT_THAT(b.err, HasSubstr("channel 0 (0.55 um) as Visible"));
  EXPECT_EQ(read_rgl(bsdf)->info().wavelength_um.size(), 1u);
  // Read back and compared by the program itself; Ward's model is reciprocal, so no exchange is needed.
  const CommandResult c = inspect("--json --pairs 20000 --compare " + bsdf);
  ASSERT_EQ(c.code, 0) << c.err;
  const size_t at = c.out.find("\"l1\": ");
  ASSERT_NE(at, std::string::npos) << c.out;
  EXPECT_LT(std::stod(c.out.substr(at + 6)), 1.2 * stated());
  EXPECT_LE(told(a.err), 100 * stated());
  EXPECT_LE(told(b.err), 100 * stated());
  // What is told stands in the files.
  const auto figures = [](const std::string& text) {
    const size_t from = text.find("against the fit: ");
    return text.substr(from, text.find(" %", from) - from);
  };
  EXPECT_EQ(figures(read_text(xml)), figures(b.err));
  EXPECT_EQ(figures(read_rgl(bsdf)->description()), figures(a.err));
}

TEST_F(Export, ErrorsAreKeptOrToldToBeMissed) {
  const std::string xml = *folder_ / "w.xml", bsdf = *folder_ / "w.bsdf";
  const CommandResult coarse = inspect("--export-error 0.05 --export " + xml);
  EXPECT_LE(told(coarse.err), 5);
  EXPECT_GT(told(coarse.err), 2);
  EXPECT_EQ(coarse.err.find("warning"), std::string::npos) << coarse.err;
  const CommandResult small = inspect("--export-size 20 --export " + xml);
  EXPECT_EQ(small.code, 0);
  EXPECT_THAT(small.err, HasSubstr("that were to be kept: --export-size allows more leaves"));
  EXPECT_GT(told(small.err), 100 * stated());
  const CommandResult rough = inspect("--export-size 8 --export " + bsdf);
  EXPECT_EQ(rough.code, 0);
  EXPECT_THAT(rough.err, HasSubstr("that were to be kept: --export-size makes it finer"));
}

TEST_F(Export, WrongUseIsRefused) {
  EXPECT_EQ(inspect("--export x.txt").code, 2);
  EXPECT_EQ(inspect("--export x.xml --export-size 60001").code, 2);
  EXPECT_EQ(inspect("--export x.xml --export-error 2").code, 2);
  EXPECT_EQ(inspect("--export x.csv --export-error 0.1").code, 2);
  EXPECT_EQ(inspect("--export-error 0.1").code, 2);
  EXPECT_EQ(inspect("--export-size 9").code, 2);
  EXPECT_EQ(inspect("--export " + sqt_).code, 2);
  const std::string haze = *folder_ / "h.sqt";
  ASSERT_EQ(run_command(SUITE_BIN_DIR "/sqt-fit -q --model hg:g=0.5 --views 2 --order 4 --min-peak 0 -o " + haze).code,
            0);
  const CommandResult r = run_command(SUITE_BIN_DIR "/sqt-inspect " + haze + " --export " + (*folder_ / "h.bsdf"));
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("is no BRDF over the hemisphere"));
  EXPECT_FALSE(file_exists(*folder_ / "h.bsdf"));
  EXPECT_EQ(run_command(SUITE_BIN_DIR "/sqt-inspect " + haze + " --export " + (*folder_ / "h.csv")).code, 0);
}

}  // namespace
}  // namespace suite::export_test
