// sqt-inspect as a user meets it: every output, and bad input with its exit code and message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/files.h"
#include "base/params.h"
#include "formats/sqt/sqt.h"
#include "formats/sqt/sqt_write.h"
#include "optics/model_function.h"
#include "support/run_command.h"

namespace suite::sqt_inspect_test {
namespace {

const std::string kInspect = std::string(SUITE_BIN_DIR) + "/sqt-inspect ";
const std::string kBrdf = std::string(SUITE_TEST_DATA) + "/brdf/satin_purple_rgb.bsdf";

// A satin and a Ward fit, made once.
class SqtInspect : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TempFolder;
    satin_ = *folder_ / "satin.sqt";
    ward_ = *folder_ / "ward.sqt";
    const std::string fit = std::string(SUITE_BIN_DIR) + "/sqt-fit --quiet ";
    ASSERT_EQ(run_command(fit + kBrdf + " -o " + satin_).code, 0);
    ASSERT_EQ(run_command(fit + "--model ward:specular=0.3,diffuse=0.2,roughness=0.2 -o " + ward_).code, 0);
  }
  static void TearDownTestSuite() { delete folder_; }
  static void contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
  }
  static TempFolder* folder_;
  static std::string satin_, ward_;
};
TempFolder* SqtInspect::folder_ = nullptr;
std::string SqtInspect::satin_, SqtInspect::ward_;

TEST_F(SqtInspect, HeaderInWordsAndJson) {
  const CommandResult text = run_command(kInspect + satin_);
  EXPECT_EQ(text.code, 0);
  contains(text.out, "method     aligned");
  contains(text.out, "channels   3: 0.65 to 0.45 um");
  const CommandResult json = run_command(kInspect + satin_ + " --json");
  EXPECT_EQ(json.code, 0);
  const Params p = Params::parse_text(json.out, "json");
  EXPECT_EQ(p.text("schema"), "suite.sqt-header/1");
  EXPECT_EQ(p.at("bytes").as_number(), static_cast<double>(file_size(satin_)));
  contains(p.at("stored_header").text("command"), "sqt-fit");
  EXPECT_EQ(p.at("stored_header").text("input_sha256"), sha256(read_bytes(kBrdf)));
}

TEST_F(SqtInspect, CheckAcceptsWhatTheFitterMakes) {
  const CommandResult r = run_command(kInspect + satin_ + " --check");
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  contains(r.out, "verdict: accepted");
}

TEST_F(SqtInspect, CheckRejectsExcessEnergy) {
  // A hand-made bundle that returns 1.3 times what it receives.
  class Bright final : public sqt::Function {
   public:
    Bright() { info_.name = "bright", info_.wavelength_um = {0.55}; }
    const Info& info() const override { return info_; }
    void value(Dir, Dir in, std::span<double> f) const override { f[0] = in.z > 0 ? 1.3 / kPi : std::nan(""); }

   private:
    Info info_;
  };
  sqt::PaperOptions options;
  options.views = 3, options.order = 3;
  const std::string file = *folder_ / "bright.sqt";
  sqt::PaperData data = sqt::fit_paper(Bright(), options);
  for (float& m : data.magnitudes) m = 1.3f;  // the fitter clamps
  write_file(file, pack_sqt(data, SqtProvenance{}, {}));
  const CommandResult r = run_command(kInspect + file + " --check");
  EXPECT_EQ(r.code, 1);
  contains(r.out, "[IN103]");
  contains(r.out, "total 1.3");
}

TEST_F(SqtInspect, ComparisonFindsTheFittersErrorByItself) {
  const CommandResult r =
      run_command(kInspect + satin_ + " --compare " + kBrdf + " --json --error-map " + (*folder_ / "e.png"));
  ASSERT_EQ(r.code, 0) << r.err;
  const Params p = Params::parse_text(r.out, "json");
  const Params header = Params::parse_text(run_command(kInspect + satin_ + " --json").out, "json");
  const double mine = p.at("overall").number("l1"),
               theirs = header.at("stored_header").at("errors").at("overall").number("l1");
  EXPECT_NEAR(mine, theirs, 0.1 * theirs);
  EXPECT_GT(file_size(*folder_ / "e.png"), 10000u);
  // Against something else it is far off.
  const CommandResult other =
      run_command(kInspect + ward_ + " --compare-model ward:specular=0.1,diffuse=0.2,roughness=0.2 --json");
  EXPECT_GT(Params::parse_text(other.out, "json").at("overall").number("l1"), 0.3);
}

TEST_F(SqtInspect, ValuesSlicesAndSamples) {
  const CommandResult e = run_command(kInspect + ward_ + " --eval 30,0,50,180,0.55");
  const CommandResult beyond = run_command(kInspect + ward_ + " --eval 30,0,50,180,10");
  EXPECT_EQ(beyond.code, 0) << beyond.err;
  EXPECT_THAT(beyond.err, testing::HasSubstr("at 10 um the value at its nearer end is printed"));
  // Channels of colours descend; at their ends and between them nothing is beyond.
  for (const char* um : {"0.65", "0.55", "0.45"})
    EXPECT_EQ(run_command(kInspect + satin_ + " --eval 30,0,50,180," + um).err, "") << um;
  EXPECT_THAT(run_command(kInspect + satin_ + " --eval 30,0,50,180,0.7").err,
              testing::HasSubstr("the fit stands for 0.45 to 0.65 um"));
  ASSERT_EQ(e.code, 0) << e.err;
  const auto model = model_function("ward:specular=0.3,diffuse=0.2,roughness=0.2");
  double f = 0;
  model->value(dir_from_angles(30 * kDegree, 0), dir_from_angles(50 * kDegree, kPi), {&f, 1});
  EXPECT_NEAR(std::stod(e.out.substr(e.out.find("f_per_sr ") + 9)), f, 0.05 * f);

  // In the plane of incidence values continue across azimuth 180 deg (they used to be 0 exactly there).
  for (const char* views : {"0,0,30", "10,0,60", "0,0,60"}) {
    const CommandResult on = run_command(kInspect + satin_ + " --eval " + views + ",180,0.55"),
                        off = run_command(kInspect + satin_ + " --eval " + views + ",179.999,0.55");
    const double a = std::stod(on.out.substr(9)), b = std::stod(off.out.substr(9));
    EXPECT_NEAR(a, b, 1e-3 * b) << views;
  }
  const std::string csv = *folder_ / "s.csv";
  ASSERT_EQ(
      run_command(kInspect + satin_ + " --slice " + csv + " --plot " + (*folder_ / "p.png") + " --views 0,45").code, 0);
  contains(read_text(csv), "theta_o_deg,theta_in_deg,f_0.65_um,f_0.55_um,f_0.45_um\n0,-89.5,");
  const CommandResult s = run_command(kInspect + satin_ + " --sample 500 --out 40,10 --channel 2");
  EXPECT_GT(std::count(s.out.begin(), s.out.end(), '\n'), 400);
  EXPECT_EQ(s.out, run_command(kInspect + satin_ + " --sample 500 --out 40,10 --channel 2").out);
}

TEST_F(SqtInspect, PicturesArePng) {
  const std::string map = *folder_ / "m.png", ball = *folder_ / "b.png";
  ASSERT_EQ(run_command(kInspect + ward_ + " --map " + map + " --panels 2 --sphere " + ball + " --size 64").code, 0);
  for (const std::string& file : {map, ball}) EXPECT_EQ(read_text(file).substr(1, 3), "PNG");
}

TEST_F(SqtInspect, BadInputAndUsage) {
  const std::string broken = *folder_ / "broken.sqt";
  std::vector<std::byte> bytes = read_bytes(satin_);
  bytes[bytes.size() / 2] ^= std::byte{1};
  write_file(broken, bytes);
  const CommandResult flipped = run_command(kInspect + broken + " --map " + (*folder_ / "no.png"));
  EXPECT_EQ(flipped.code, 1);
  contains(flipped.err, "broken.sqt");
  EXPECT_FALSE(file_exists(*folder_ / "no.png"));
  EXPECT_EQ(run_command(kInspect + (*folder_ / "absent.sqt")).code, 1);
  const CommandResult wrong = run_command(kInspect + satin_ + " --compare " + satin_);
  EXPECT_EQ(wrong.code, 1);
  contains(wrong.err, "it is fitted already");
  const CommandResult channels = run_command(kInspect + ward_ + " --compare " + kBrdf);
  EXPECT_EQ(channels.code, 1);
  contains(channels.err, "the fit has 1 channels and the data 3");
  for (const char* usage : {" --channel 3", " --eval 1,2,3", " --eval a,b,c,d,e", " --panels 0", " --check --sample 5",
                            " --error-map e.png", " --views 95 --plot p.png", " --chek"})
    EXPECT_EQ(run_command(kInspect + satin_ + usage).code, 2) << usage;
  EXPECT_EQ(run_command(kInspect + "--help").code, 0);
}

}  // namespace
}  // namespace suite::sqt_inspect_test
