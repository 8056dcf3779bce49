// sqt-fit as a user meets it: what it writes, what it refuses, and that a refusal leaves nothing behind.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/params.h"
#include "formats/sqt/sqt.h"
#include "support/run_command.h"

namespace suite::sqt_fit_test {
namespace {

const std::string kFit = std::string(SUITE_BIN_DIR) + "/sqt-fit ";
const std::string kSatin = std::string(SUITE_TEST_DATA) + "/brdf/satin_purple_rgb.bsdf ";
const std::string kWard = "--model ward:diffuse=0.2,specular=0.1,roughness=0.2 --views 9 --order 7 ";
const std::string kRough = "--model oren_nayar:reflectance=0.3,sigma=0.3 --views 3 --order 3 ";

TEST(SqtFitCli, WritesAFileThatKeepsItsPromise) {
  const TempFolder folder;
  const std::string out = folder / "w.sqt", report = folder / "r.json";
  const CommandResult r = run_command(kFit + kWard + "-q --max-error 0.03 -o " + out + " --report " + report);
  ASSERT_EQ(r.code, 0) << r.err;
  const Params p = Params::parse_file(report);
  EXPECT_LE(p.at("overall").number("l1"), 0.03 * 1.0001);
  EXPECT_EQ(p.integer("bytes", 0, 1 << 30), static_cast<long long>(file_size(out)));
  for (const char* key : {"cos_rmse", "rmse", "peak_ratio_20", "peak_ratio_45", "peak_ratio_70", "total_error",
                          "reciprocity_error", "max_weight"})
    EXPECT_TRUE(p.at("overall").has(key)) << key;
  EXPECT_EQ(read_sqt(out).bundle->info().method, "aligned");
}

TEST(SqtFitCli, KeepsASize) {
  const TempFolder folder;
  const std::string out = folder / "s.sqt";
  const CommandResult r = run_command(kFit + kWard + "-q --min-peak 0 --max-bytes 4000 -o " + out);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_LE(file_size(out), 4000u);
  EXPECT_GT(file_size(out), 3000u);
}

TEST(SqtFitCli, DrawsErrorAgainstSizeAndSeconds) {
  const TempFolder folder;
  const CommandResult r = run_command(kFit + kRough + "-q --curve " + (folder / "c.csv"));
  ASSERT_EQ(r.code, 0) << r.err;
  const std::string csv = read_text(folder / "c.csv"), page = read_text(folder / "c.html");
  EXPECT_EQ(csv.rfind("method,knob,bytes,leaves,seconds,l1,cos_rmse,rmse\n", 0), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 10);
  for (const char* part : {"l1 against bytes", "l1 against seconds", "rmse against seconds", "aligned</text>"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(run_command(kFit + kRough + "--curve c.html").code, 2);
}

TEST(SqtFitCli, SwapIsForFilesAndIsRemembered) {
  const TempFolder folder;
  const std::string out = folder / "s.sqt";
  const CommandResult r = run_command(kFit + kSatin + "-q --swap --views 5 --order 5 --min-peak 0 -o " + out);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_NE(read_sqt(out).bundle->info().function.source.find("directions exchanged"), std::string::npos);
  EXPECT_EQ(run_command(kFit + kRough + "--swap -o " + (folder / "x.sqt")).code, 2);
}

TEST(SqtFitCli, SameBytesForAnyThreadCount) {
  const TempFolder folder;
  std::vector<std::byte> first;
  for (const char* threads : {"1", "2", "5"}) {
    const CommandResult r = run_command("cd " + folder.path() + " && " + kFit + kWard + "-q -o x.sqt -j " + threads);
    ASSERT_EQ(r.code, 0) << r.err;
    // The command line is part of the header; what was fitted must be the same.
    const auto bytes = read_bytes(folder / "x.sqt");
    uint32_t header = 0;
    std::memcpy(&header, &bytes[12], sizeof header);
    const std::vector<std::byte> payload(bytes.begin() + 48 + header, bytes.end());
    if (first.empty()) first = payload;
    EXPECT_EQ(payload, first);
  }
}

TEST(SqtFitCli, PromisesThatCannotBeKept) {
  const TempFolder folder;
  const std::string out = folder / "x.sqt";
  const CommandResult lax = run_command(kFit + kRough + "-q --max-bytes 100 -o " + out);
  EXPECT_EQ(lax.code, 0);
  EXPECT_NE(lax.err.find("100 bytes cannot be kept"), std::string::npos) << lax.err;
  std::filesystem::remove(out);
  const CommandResult strict = run_command(kFit + kRough + "-q --strict --max-bytes 100 -o " + out);
  EXPECT_EQ(strict.code, 1);
  EXPECT_FALSE(file_exists(out));
}

TEST(SqtFitCli, LowLobesAreToldWithTheirNumbers) {
  // Regression: cells too coarse for a lobe clipped it without a word.
  const TempFolder folder;
  const std::string clipped = kFit + "--model ward:diffuse=0.2,specular=0.1,roughness=0.02 --views 9 --order 6 -q -o " +
                              (folder / "w.sqt") + " --report " + (folder / "r.json");
  const CommandResult r = run_command(clipped);
  EXPECT_EQ(r.code, 0);
  EXPECT_NE(r.err.find("lobes at view angles of 20/45/70 deg reach 0."), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("0.9 is asked for (--min-peak)"), std::string::npos) << r.err;
  const Params p = Params::parse_file(folder / "r.json");
  EXPECT_FALSE(p.at("peak_met").as_bool());
  EXPECT_LT(p.at("overall").number("peak_ratio_45"), 0.9);
  const CommandResult low = run_command(clipped + " --min-peak 0.1 --strict");
  EXPECT_EQ(low.code, 0);
  EXPECT_EQ(low.err.find("lobes"), std::string::npos);
  EXPECT_EQ(run_command(clipped + " --strict").code, 0) << "nobody asked for it";
  EXPECT_EQ(run_command(clipped + " --min-peak 0.9 --strict").code, 1);
  EXPECT_EQ(run_command(clipped + " --min-peak 1.5").code, 2);
  EXPECT_EQ(run_command(kFit + kRough + "--method paper --min-peak 0.5 -o " + (folder / "p.sqt")).code, 2);
}

TEST(SqtFitCli, RefusesBadInput) {
  const TempFolder folder;
  const std::string out = " -o " + (folder / "x.sqt");
  std::ofstream(folder / "short.bsdf") << "tensor_file";
  std::ofstream(folder / "odd.xyz") << "hello";
  const struct {
    std::string arguments, message;
    int code;
  } cases[] = {
      {"nowhere.bsdf", "no such file", 1},
      {folder.path(), "of a folder of files give -o TABLE.csv", 2},
      {folder / "short.bsdf", "short.bsdf", 1},
      {folder / "odd.xyz", "odd.xyz", 1},
      {"--model wrad:diffuse=0.2", "did you mean 'ward'", 1},
      {"--model ward:diffuse=x", "is not PARAM=NUMBER", 1},
      {"", "one input file, a folder of them, or --model", 2},
      {kWard + " --method best", "'aligned' or 'paper'", 2},
      {kWard + " --method paper --max-error 0.1", "need --method aligned", 2},
      {"--model ward:diffuse=0.2,specular=0.1,roughness=0.2 --order 99", "out of range", 2},
      {kWard + " --max-eror 0.1", "did you mean '--max-error'", 2},
  };
  for (const auto& c : cases) {
    const CommandResult r = run_command(kFit + c.arguments + out);
    EXPECT_EQ(r.code, c.code) << c.arguments << "\n" << r.err;
    EXPECT_NE(r.err.find(c.message), std::string::npos) << c.arguments << "\n" << r.err;
    EXPECT_FALSE(file_exists(folder / "x.sqt")) << c.arguments;
  }
  EXPECT_EQ(run_command(kFit + kWard + "-q -o /proc/nowhere/x.sqt").code, 1);
}

// A table as users have them: what is harmless is taken, what is odd is said, and a fault is shown where it is.
TEST(SqtFitCli, TablesAsUsersHaveThem) {
  const TempFolder folder;
  const std::string head = "theta_o_deg,phi_o_deg,theta_i_deg,phi_i_deg,wavelength_um,value\n";
  const std::string rows = "0,0,30,0,0.55,0.2\n40,0,20,90,0.55,0.21\n40,0,60,180,0.55,0.22\n";
  const struct {
    std::string text, message;
    int code;
  } cases[] = {
      {head + rows, "", 0},
      {"\xEF\xBB\xBF" + head + rows, "", 0},
      {R"("theta_o_deg","phi_o_deg","theta_i_deg","phi_i_deg","wavelength_um","value")"
       "\n" +
           rows,
       "", 0},
      {head + "0,0,30,0,0.55,0.2\n", "", 0},  // one sample is a surface, too
      {head + rows + "10,0,10,0,0.55,nan\n", "1 of 4 pairs of directions lack a value", 0},
      {head + "0,0,30,0,550,0.2\n", "are they in nm?", 0},
      {head + "0,0,30,0,0.55,inf\n", "t.csv: error: no pair of directions has a value", 1},
      {"theta_o_deg;phi_o_deg\n0;0\n", "t.csv:1:1: error: ';' between the columns", 1},
      {head + rows + "10,0,10,0,0.55,\n", "t.csv:5:1: error: the line has 5 values, 6 are wanted", 1},
      {head + "0,0,200,0,0.55,0.2\n", "t.csv:2:5: error: the angle is 3.49066 rad", 1},
      {head + "90,0,20,0,0.55,0.2\n", "t.csv:2:1: error: the outgoing direction lies on or below the horizon", 1},
      {head, "holds no samples", 1},
  };
  for (const auto& c : cases) {
    write_file(folder / "t.csv", c.text);
    const std::string out = folder / "t.sqt";
    const CommandResult r = run_command(kFit + (folder / "t.csv") + " -q --views 3 --order 3 -o " + out);
    EXPECT_EQ(r.code, c.code) << c.text << r.err;
    EXPECT_NE(r.err.find(c.message), std::string::npos) << c.text << r.err;
    EXPECT_EQ(r.err.empty(), c.message.empty()) << c.text << r.err;
    EXPECT_EQ(file_exists(out), c.code == 0) << c.text;
    std::filesystem::remove(out);
  }
}

// Samples that leave directions out say how far they reach; the errors of the fit are those where the function is
// known.
TEST(SqtFitCli, SamplesSayHowFarTheyReach) {
  const TempFolder folder;
  const std::string head = "theta_o_deg,phi_o_deg,theta_i_deg,phi_i_deg,wavelength_um,value\n0,0,0,0,0.55,0.1\n";
  for (const auto& [row, told] : {std::pair{"20,0,80,90,0.55,0.1\n", true}, {"80,0,80,90,0.55,0.1\n", false}}) {
    write_file(folder / "t.csv", head + row);
    const CommandResult r = run_command(kFit + (folder / "t.csv") + " --views 3 --order 3 -o " + (folder / "t.sqt"));
    EXPECT_EQ(r.code, 0) << r.err;
    const std::string words = "t.csv: samples reach 20 degrees from the normal in the outgoing and 80 in the incident";
    EXPECT_EQ(r.err.find(words) != std::string::npos, told) << r.err;
    EXPECT_EQ(r.err.find("samples reach") != std::string::npos, told) << r.err;
  }
}

TEST(SqtFitCli, ModelsAndTheirFaults) {
  const TempFolder folder;
  const std::string out = " -q --views 3 --order 4 -o " + (folder / "m.sqt");
  write_file(folder / "mie.txt", "0 9.1\n10 3\n90 0.2\n180 0.5\n");
  // A white Lambert surface returns all it gets and no more: its total used to be measured as 1.21.
  for (const char* good : {"lambert:reflectance=1", "oren_nayar:reflectance=0.9,sigma=0", "ggx:roughness=0.3,f0=1"}) {
    const CommandResult r = run_command(kFit + "--strict --min-peak 0.6 --model " + good + out);  // order 4 is coarse
    EXPECT_EQ(r.code, 0) << good << r.err;
  }
  EXPECT_EQ(run_command(kFit + "--model tabulated:table=@" + (folder / "mie.txt") + out).code, 0);
  EXPECT_EQ(run_command(kFit + "--model 'tabulated:table=0 9.1, 10 3, 180 0.5'" + out).code, 0);
  std::filesystem::remove(folder / "m.sqt");
  const std::pair<const char*, const char*> faults[] = {
      {"ward:specular=.1,specular=.2", "'specular' is given twice"},
      {"ward:diffuse=0.5,specular=0.9,roughness=0.2", "--model ward:diffuse=0.5,specular=0.9,roughness=0.2: error"},
      {"hg:g=nan", "'g=nan' is not PARAM=NUMBER"},
      {"hg:g=2", "give -0.9999 to 0.9999"},
      {"lambert", "needs 'reflectance' [OP104]; hemispherical reflectance of both sides\n"},
      {"sqt", "is what a fit makes"},
      {"tabulated:table=@nowhere.txt", "no such file"},
      {"tabulated:table=5", "a value expected at character 2"},
  };
  for (const auto& [model, message] : faults) {
    const CommandResult r = run_command(kFit + "--model " + model + out);
    EXPECT_EQ(r.code, 1) << model;
    EXPECT_NE(r.err.find(message), std::string::npos) << model << r.err;
    EXPECT_FALSE(file_exists(folder / "m.sqt"));
  }
}

// Nothing is computed for outputs that cannot be written, and no input is replaced by its own fit.
TEST(SqtFitCli, OutputsAreCheckedFirst) {
  const TempFolder folder;
  const std::string csv = folder / "t.csv", text = "0,0,0.5,0,0.55,0.2\n";
  write_file(csv, text);
  for (const std::string& twice :
       {csv + " -o " + csv, csv + " -o " + (folder / "./t.csv"), csv + " -o a.sqt --report a.sqt"})
    EXPECT_EQ(run_command("cd " + folder.path() + " && " + kFit + twice).code, 2) << twice;
  EXPECT_EQ(read_text(csv), text);
  for (const char* option : {"--report", "--curve"}) {
    const CommandResult r =
        run_command(kFit + csv + " -o " + (folder / "o.sqt") + " " + option + " /proc/nowhere/x.csv");
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(r.err.find("/proc/nowhere/x.csv: error: cannot be written"), std::string::npos) << r.err;
    EXPECT_FALSE(file_exists(folder / "o.sqt"));
  }
}

TEST(SqtFitCli, LinksThatLeadNowhereAreRefused) {
  const TempFolder folder;
  std::filesystem::create_symlink("loop.bsdf", folder / "loop.bsdf");
  std::filesystem::create_symlink("nowhere.bsdf", folder / "gone.bsdf");
  for (const char* name : {"loop.bsdf", "gone.bsdf"}) {
    const CommandResult r = run_command(kFit + (folder / name) + " -o " + (folder / "x.sqt"));
    EXPECT_EQ(r.code, 1) << r.err;
    EXPECT_NE(r.err.find(std::string(name) + ": error: "), std::string::npos) << r.err;
  }
}

TEST(SqtFitCli, HelpStatesConventions) {
  const CommandResult r = run_command(kFit + "--help");
  EXPECT_EQ(r.code, 0);
  for (const char* word : {"1/sr", "cosine", "centre", "horizon", "MERL"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace suite::sqt_fit_test
