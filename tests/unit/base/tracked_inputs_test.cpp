// What something was made from is found, hashed once and held against what is there now.
#include "base/tracked_inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "base/files.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::tracked_inputs_test {
namespace {

class TrackedInputsOf : public testing::Test {
 protected:
  void SetUp() override {
    make_folder(folder_ / "more");
    write_file(text_, "scene");
    write_file(folder_ / "a.vox", "a");
    write_file(folder_ / "more/b.obj", "b");
  }
  bool unchanged(const TrackedInputs& inputs) const { return inputs_unchanged(text_, search_, inputs.all()); }
  TempFolder folder_;
  std::string text_ = folder_ / "s.yaml";
  std::vector<std::string> search_{folder_ / "more"};
};

TEST_F(TrackedInputsOf, FilesAreFoundBesideAndInTheSearchFoldersAndHashedOnce) {
  TrackedInputs inputs(text_, search_);
  EXPECT_EQ(inputs.add("a.vox").path, folder_ / "a.vox");
  EXPECT_TRUE(inputs.add("b.obj").first);
  EXPECT_FALSE(inputs.add("b.obj").first);
  ASSERT_EQ(inputs.all().size(), 3u);
  EXPECT_EQ(inputs.all()[0].name, "");
  EXPECT_EQ(inputs.all()[2].sha256, sha256(std::string_view("b")));
  EXPECT_THAT(message_of([&] { inputs.add("c.obj"); }), testing::HasSubstr("no such file"));
}

TEST_F(TrackedInputsOf, EveryChangeIsSeen) {
  TrackedInputs inputs(text_, search_);
  inputs.add("a.vox");
  inputs.add("b.obj");
  inputs.add_companion("a.vox", "raw");
  inputs.add_companion("a.vox", "raw");
  ASSERT_EQ(inputs.all().size(), 4u);
  EXPECT_EQ(inputs.all()[3].name, "a.vox -> raw");
  EXPECT_EQ(inputs.all()[3].sha256, "");
  EXPECT_TRUE(unchanged(inputs));
  write_file(folder_ / "raw", "now it is there");
  EXPECT_FALSE(unchanged(inputs));
  std::filesystem::remove(folder_ / "raw");
  EXPECT_TRUE(unchanged(inputs));
  write_file(folder_ / "b.obj", "found before the other");
  EXPECT_FALSE(unchanged(inputs));
  std::filesystem::remove(folder_ / "b.obj");
  write_file(text_, "another scene");
  EXPECT_FALSE(unchanged(inputs));
  EXPECT_FALSE(inputs_unchanged(text_, search_, {}));
}

TEST_F(TrackedInputsOf, TheHashOfAllDoesNotDependOnTheOrder) {
  TrackedInputs one(text_, search_), other(text_, search_);
  one.add("a.vox"), one.add("b.obj");
  other.add("b.obj"), other.add("a.vox");
  EXPECT_EQ(input_hash(one.all()), input_hash(other.all()));
  other.add_companion("a.vox", "raw");
  EXPECT_NE(input_hash(one.all()), input_hash(other.all()));
}

}  // namespace
}  // namespace suite::tracked_inputs_test
