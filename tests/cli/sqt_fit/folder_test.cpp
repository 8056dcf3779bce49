// A folder of measured files as a table: every file in it, what was finished kept, what is bad told.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "base/files.h"
#include "support/run_command.h"

namespace suite::folder_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class Folder : public testing::Test {
 protected:
  Folder() {
    std::filesystem::create_directories(folder_ / "in/deep");
    write_chalk("in/chalk.csv", 0.3);
    write_chalk("in/deep/soot, old.csv", 0.05);
    write_file(folder_ / "in/README.txt", std::string_view("not a measurement"));
  }
  void write_chalk(const std::string& name, double albedo) {
    std::string csv = "theta_o_deg, phi_o_deg, theta_i_deg, phi_i_deg, wavelength_um, value\n";
    for (int o = 0; o < 90; o += 20)
      for (int i = 5; i < 90; i += 20)
        for (int p = 0; p <= 180; p += 30)
          csv += std::to_string(o) + ",0," + std::to_string(i) + "," + std::to_string(p) + ",0.55," +
                 std::to_string(albedo / 3.14159265) + "\n";
    write_file(folder_ / name, std::string_view(csv));
  }
  CommandResult fit(const std::string& more = "") {
    return run_command("cd '" + folder_.path() +
                       "' && " SUITE_BIN_DIR "/sqt-fit in -o t/table.csv --views 3 --order 3 --fits fits " + more);
  }
  std::string table() { return read_text(folder_ / "t/table.csv"); }
  TempFolder folder_;
};

// Fits of links went to where these point, outside of the folder for fits.
TEST_F(Folder, LinksStayInTheFolder) {
  std::filesystem::create_directories(folder_ / "elsewhere/data");
  std::filesystem::rename(folder_ / "in/chalk.csv", folder_ / "elsewhere/data/chalk.csv");
  std::filesystem::create_symlink(folder_ / "elsewhere/data/chalk.csv", folder_ / "in/chalk.csv");
  const CommandResult r = fit();
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(file_exists(folder_ / "fits/chalk.csv.sqt"));
  EXPECT_FALSE(file_exists(folder_ / "elsewhere/data/chalk.csv.sqt"));
  EXPECT_THAT(table(), HasSubstr("\nchalk.csv,1,"));
}

TEST_F(Folder, IsATableAndAPageAndFits) {
  const CommandResult r = fit();
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.err, HasSubstr("1 files are of no format that is fitted"));
  std::istringstream in(table());
  std::vector<std::string> rows;
  for (std::string line; std::getline(in, line);)
    if (line[0] != '#') rows.push_back(line);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_THAT(rows[0], testing::StartsWith("file,channels,bytes,sqt_bytes,ratio,"));
  EXPECT_THAT(rows[1], testing::StartsWith("chalk.csv,1,"));
  EXPECT_THAT(rows[2], testing::StartsWith("\"deep/soot, old.csv\",1,"));
  EXPECT_TRUE(file_exists(folder_ / "fits/chalk.csv.sqt"));
  EXPECT_TRUE(file_exists(folder_ / "fits/deep/soot, old.csv.sqt"));
  const std::string page = read_text(folder_ / "t/table.html");
  for (const char* part : {"Errors, in ascending order", "Error against size", "deep/soot, old.csv"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(Folder, GoesOnWhereItWasByContent) {
  ASSERT_EQ(fit().code, 0);
  const std::string before = table();
  const CommandResult again = fit();
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("2 files, 2 of them kept from before"));
  EXPECT_EQ(table(), before);
  write_chalk("in/chalk.csv", 0.4);
  EXPECT_THAT(fit().err, HasSubstr("2 files, 1 of them kept from before"));
  std::filesystem::remove(folder_ / "fits/chalk.csv.sqt");
  EXPECT_THAT(fit().err, HasSubstr("2 files, 1 of them kept from before"));
  EXPECT_THAT(fit("--threshold 0.2").err, HasSubstr("of other settings"));
}

TEST_F(Folder, TellsBadFilesAndFitsTheRest) {
  write_file(folder_ / "in/broken.binary", std::string_view("short"));
  const CommandResult r = fit();
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("in/broken.binary"));
  EXPECT_THAT(r.err, HasSubstr("3 files, 0 of them kept from before, 1 that cannot be fitted"));
  EXPECT_THAT(table(), HasSubstr("broken.binary,,,"));
  EXPECT_THAT(table(), HasSubstr("chalk.csv,1,"));
}

TEST_F(Folder, ReplacesNothingThatIsNoTableOfItsOwn) {
  write_file(folder_ / "t.csv", std::string_view("a,b\n1,2\n"));
  const std::string run = "cd '" + folder_.path() + "' && " SUITE_BIN_DIR "/sqt-fit in ";
  const CommandResult r = run_command(run + "-o t.csv");
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.err, HasSubstr("is no table of sqt-fit"));
  EXPECT_EQ(read_text(folder_ / "t.csv"), "a,b\n1,2\n");
  EXPECT_EQ(run_command(run + "-o t.sqt").code, 2);
  EXPECT_EQ(run_command(run + "-o u.csv --curve c.csv").code, 2);
  std::filesystem::create_directories(folder_ / "empty");
  const CommandResult none = run_command(SUITE_BIN_DIR "/sqt-fit '" + (folder_ / "empty") + "' -o u.csv");
  EXPECT_EQ(none.code, 1);
  EXPECT_THAT(none.err, HasSubstr("holds no measured file"));
}

}  // namespace
}  // namespace suite::folder_test
