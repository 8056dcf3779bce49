// sqt-fit as a user meets it: what it writes, what it refuses, and that a refusal leaves nothing behind.
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "base/params.h"
#include "formats/sqt/sqt.h"
#include "support/run_command.h"

namespace suite {
namespace {

const std::string kFit = std::string(SUITE_BIN_DIR) + "/sqt-fit ";
const std::string kSatin = std::string(SUITE_TEST_DATA) + "/brdf/satin_purple_rgb.bsdf ";
const std::string kWard = "--model ward:diffuse=0.2,specular=0.1,roughness=0.2 --views 9 --order 7 ";

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
  const CommandResult r = run_command(kFit + kSatin + "-q --views 9 --order 8 --max-bytes 8000 -o " + out);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_LE(file_size(out), 8000u);
  EXPECT_GT(file_size(out), 6000u);
}

TEST(SqtFitCli, DrawsErrorAgainstSizeAndSeconds) {
  const TempFolder folder;
  const CommandResult r = run_command(kFit + kWard + "-q --curve " + (folder / "c.csv"));
  ASSERT_EQ(r.code, 0) << r.err;
  const std::string csv = read_text(folder / "c.csv"), page = read_text(folder / "c.html");
  EXPECT_EQ(csv.rfind("method,knob,bytes,leaves,seconds,l1,cos_rmse,rmse\n", 0), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 10);
  for (const char* part : {"l1 against bytes", "l1 against seconds", "rmse against seconds", "aligned</text>"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(run_command(kFit + kWard + "--curve c.html").code, 2);
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
  const CommandResult lax = run_command(kFit + kWard + "-q --max-bytes 100 -o " + out);
  EXPECT_EQ(lax.code, 0);
  EXPECT_NE(lax.err.find("100 bytes cannot be kept"), std::string::npos) << lax.err;
  std::filesystem::remove(out);
  const CommandResult strict = run_command(kFit + kWard + "-q --strict --max-bytes 100 -o " + out);
  EXPECT_EQ(strict.code, 1);
  EXPECT_FALSE(file_exists(out));
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
      {folder.path(), "is a directory", 1},
      {folder / "short.bsdf", "short.bsdf", 1},
      {folder / "odd.xyz", "odd.xyz", 1},
      {"--model wrad:diffuse=0.2", "did you mean 'ward'", 1},
      {"--model ward:diffuse=x", "is not PARAM=NUMBER", 1},
      {"", "one input file or --model", 2},
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
  EXPECT_EQ(run_command(kFit + kWard + "-q -o /nowhere/x.sqt").code, 1);
}

TEST(SqtFitCli, HelpStatesConventions) {
  const CommandResult r = run_command(kFit + "--help");
  EXPECT_EQ(r.code, 0);
  for (const char* word : {"1/sr", "cosine", "centre", "horizon", "MERL"})
    EXPECT_NE(r.out.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace suite
