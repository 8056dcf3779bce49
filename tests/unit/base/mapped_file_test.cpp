// Files as memory, and the array that is either a vector's or a file's.
#include "base/mapped_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>

#include "base/files.h"
#include "base/shared_array.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::mapped_file_test {
namespace {

using ::testing::HasSubstr;

std::span<const std::byte> bytes_of(const char* text) { return std::as_bytes(std::span(text, std::strlen(text))); }

TEST(SharedArray, CopiesShareAndCompareByValue) {
  const SharedArray<int> a = {1, 2, 3}, b = a, c = std::vector<int>{1, 2, 3}, d = {1, 2}, none;
  EXPECT_EQ(a.data(), b.data());
  EXPECT_NE(a.data(), c.data());
  EXPECT_TRUE(a == c);
  EXPECT_FALSE(a == d);
  EXPECT_TRUE(none.empty() && none.begin() == none.end());
  EXPECT_EQ(c[2], 3);
}

TEST(SharedArray, KeepsWhatItIsAPartOf) {
  TempFolder folder;
  write_file(folder / "a", std::string_view("abcdefgh"));
  SharedArray<char> middle;
  {
    const auto file = std::make_shared<const MappedFile>(folder / "a");
    middle = {reinterpret_cast<const char*>(file->data()) + 2, 3, file};
  }
  EXPECT_EQ(std::string(middle.begin(), middle.end()), "cde");
}

TEST(MappedFile, ReadsAndLetsGo) {
  TempFolder folder;
  std::string text(100000, 'x');
  text[70000] = 'y';
  write_file(folder / "a", std::string_view(text));
  const MappedFile file(folder / "a");
  EXPECT_EQ(file.size(), text.size());
  EXPECT_EQ(file.readable() % static_cast<size_t>(::sysconf(_SC_PAGESIZE)), 0u);
  EXPECT_EQ(file.data()[file.readable() - 1], std::byte{0}) << "beyond the end there are zeros";
  let_go(file.data() + 10, file.size() - 10);
  EXPECT_EQ(file.data()[70000], std::byte{'y'}) << "pages come back";
  write_file(folder / "none", std::string_view(""));
  EXPECT_EQ(MappedFile(folder / "none").readable(), 0u);
  EXPECT_THAT(message_of([&] { MappedFile(folder / "missing"); }), HasSubstr("no such file"));
}

TEST(SpillFile, IsSharedAndHasNoName) {
  TempFolder folder;
  SpillFile file(folder.path());
  EXPECT_EQ(folder.entries(), 0u);
  const size_t first = file.reserve(10), second = file.reserve(5000);
  const auto other = SpillFile::open(file.address());
  ASSERT_TRUE(other);
  EXPECT_EQ(other->reserve(10), first);
  EXPECT_EQ(other->reserve(5000), second);
  const auto here = file.map(second, 5000);
  EXPECT_EQ(here.get()[7], std::byte{0});
  other->write_at(second + 7, bytes_of("seven"));
  EXPECT_EQ(std::memcmp(here.get() + 7, "seven", 5), 0);
  other->map_writable(first, 10).get()[3] = std::byte{9};
  EXPECT_EQ(file.map(first, 10).get()[3], std::byte{9});
}

TEST(SpillFile, SaysWhereThereIsNoRoom) {
  TempFolder folder;
  SpillFile file(folder.path());
  EXPECT_THAT(message_of([&] { file.reserve(size_t{1} << 60); }), HasSubstr("are needed there"));
  EXPECT_THAT(message_of([&] { SpillFile(folder / "missing"); }), HasSubstr("no file can be made there"));
  EXPECT_FALSE(SpillFile::open("nothing"));
  EXPECT_FALSE(SpillFile::open("0.0 /proc/1/fd/999999"));
  // Another file under that number is not taken for it.
  std::string address = file.address();
  address.insert(0, "1");
  EXPECT_FALSE(SpillFile::open(address));
}

}  // namespace
}  // namespace suite::mapped_file_test
