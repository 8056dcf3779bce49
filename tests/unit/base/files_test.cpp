// Files in and out: what a path is decides before anything is read; outputs are whole or not there.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "base/files.h"
#include "support/message_of.h"
#include "support/temp_folder.h"

namespace suite::files_test {
using testing::HasSubstr;

TEST(Files, WhatIsWrittenIsRead) {
  const TempFolder folder;
  const std::string binary("a\0b\xff\n", 5);
  write_file(folder / "x", std::string_view(binary));
  EXPECT_EQ(read_text(folder / "x"), binary);
  EXPECT_EQ(read_bytes(folder / "x").size(), 5u);
  EXPECT_EQ(file_size(folder / "x"), 5u);
  EXPECT_TRUE(file_exists(folder / "x"));
  write_file(folder / "empty", std::string_view());
  EXPECT_EQ(read_text(folder / "empty"), "");
  // Spreadsheets begin their "CSV UTF-8" with a byte order mark, which is no part of the first column's name.
  write_file(folder / "marked", std::string_view("\xEF\xBB\xBFx,y\n"));
  EXPECT_EQ(read_text(folder / "marked"), "x,y\n");
  EXPECT_EQ(read_bytes(folder / "marked").size(), 7u);
}

TEST(Files, MissingDirectoriesAndPipesAreRefusedAtOnce) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { read_text(folder / "none"); }), HasSubstr("none: error: no such file"));
  EXPECT_THAT(message_of([&] { read_text(folder.path()); }), HasSubstr("error: is a directory; name a file"));
  // A pipe without a writer would block an ordinary open for ever.
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(message_of([&] { read_text(folder / "pipe"); }), HasSubstr("error: is not a regular file"));
  EXPECT_THAT(message_of([&] { read_bytes("/dev/zero"); }), HasSubstr("error: is not a regular file"));
  EXPECT_THAT(message_of([&] { read_text((folder / "none") + "/x"); }), HasSubstr("no such file"));
  write_file(folder / "x", std::string_view("12345"));
  EXPECT_THAT(message_of([&] { read_text((folder / "x") + "/y"); }), HasSubstr("cannot be opened"));
  EXPECT_THAT(message_of([&] { read_text(folder / "x", 4); }), HasSubstr("has 5 bytes, at most 4 are accepted here"));
  EXPECT_FALSE(file_exists(folder.path()));
  EXPECT_FALSE(file_exists(folder / "pipe"));
}

TEST(Files, AHugeSparseFileIsRefusedBeforeAnythingIsAllocated) {
  const TempFolder folder;
  write_file(folder / "sparse", std::string_view("x"));
  if (::truncate((folder / "sparse").c_str(), 1LL << 42) != 0) GTEST_SKIP() << "no sparse files here";
  EXPECT_THAT(message_of([&] { read_bytes(folder / "sparse"); }), HasSubstr("has 4398046511104 bytes"));
}

TEST(Files, UnreadableFilesSaySo) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const TempFolder folder;
  write_file(folder / "x", std::string_view("x"));
  ::chmod((folder / "x").c_str(), 0);
  EXPECT_THAT(message_of([&] { read_text(folder / "x"); }), HasSubstr("cannot be opened: Permission denied"));
}

TEST(RandomAccessFile, ReadsRangesAndRefusesToPassTheEnd) {
  const TempFolder folder;
  write_file(folder / "x", std::string_view("0123456789"));
  const RandomAccessFile file(folder / "x");
  EXPECT_EQ(file.size(), 10u);
  std::byte some[4];
  file.read_at(3, some);
  EXPECT_EQ(static_cast<char>(some[0]), '3');
  EXPECT_EQ(static_cast<char>(some[3]), '6');
  EXPECT_THAT(message_of([&] { file.read_at(8, some); }), HasSubstr("x: byte 10: error: ends 2 bytes too early"));
  EXPECT_THROW(RandomAccessFile(folder.path()), Error);
}

TEST(AtomicFile, IsThereWholeOrNotAtAll) {
  const TempFolder folder;
  write_file(folder / "x", std::string_view("old"));
  {
    AtomicFile file(folder / "x");
    file.write(std::string_view("new content"));
    EXPECT_EQ(read_text(folder / "x"), "old");
    EXPECT_EQ(folder.entries(), 2u);
  }
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(read_text(folder / "x"), "old");
  AtomicFile file(folder / "x");
  file.write(std::string_view("new "));
  file.write(std::string_view("content"));
  file.commit();
  EXPECT_EQ(folder.entries(), 1u);
  EXPECT_EQ(read_text(folder / "x"), "new content");
}

TEST(AtomicFile, WritesAnywhereWithoutMovingTheEnd) {
  const TempFolder folder;
  AtomicFile file(folder / "x");
  const std::string_view tail = "tail";
  file.write_at(6, std::as_bytes(std::span(tail.data(), tail.size())));
  file.write(std::string_view("abc"));
  file.close();
  file.commit();
  EXPECT_EQ(read_text(folder / "x"), std::string("abc\0\0\0tail", 10));
}

TEST(AtomicFile, OtherLibrariesMayWriteTheTemporary) {
  const TempFolder folder;
  AtomicFile file(folder / "x");
  std::ofstream(file.temporary()) << "by somebody else";
  file.commit();
  EXPECT_EQ(read_text(folder / "x"), "by somebody else");
}

TEST(AtomicFile, ImpossiblePlacesAreRefusedBeforeTheWorkStarts) {
  const TempFolder folder;
  EXPECT_THAT(message_of([&] { AtomicFile(folder / "no/such/x"); }), HasSubstr("cannot be written"));
  EXPECT_THAT(message_of([&] { AtomicFile(folder.path()); }), HasSubstr("is a directory; name an output file"));
  write_file(folder / "x", std::string_view("x"));
  EXPECT_THAT(message_of([&] { AtomicFile((folder / "x") + "/y"); }), HasSubstr("cannot be written"));
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFile, AFullDiskIsAnErrorAndLeavesTheOldFile) {
  if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full here";
  const TempFolder folder;
  write_file(folder / "x", std::string_view("old"));
  {
    AtomicFile file(folder / "x");
    // Point the temporary's descriptor at the device that is always full: it is the newest descriptor of the process.
    const int probe = ::dup(0);
    ::close(probe);
    const int full = ::open("/dev/full", O_WRONLY);
    ASSERT_GE(full, 0);
    ASSERT_EQ(::dup2(full, probe - 1), probe - 1);
    ::close(full);
    EXPECT_THAT(message_of([&] { file.write(std::string_view("new")); }),
                HasSubstr("cannot be written: No space left on device"));
  }
  EXPECT_EQ(read_text(folder / "x"), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(Folders, AreMadeWithParentsOrSayWhy) {
  const TempFolder folder;
  make_folder(folder / "a/b/c");
  make_folder(folder / "a/b/c");
  write_file(folder / "a/b/c/x", std::string_view("x"));
  EXPECT_THAT(message_of([&] { make_folder(folder / "a/b/c/x"); }), HasSubstr("folder cannot be made"));
  EXPECT_THAT(message_of([&] { make_folder(folder / "a/b/c/x/y"); }), HasSubstr("folder cannot be made"));
}

TEST(Files, PathsResolveAgainstTheNamingFile) {
  EXPECT_EQ(resolve_path("scenes/a/s.yaml", "x.obj"), "scenes/a/x.obj");
  EXPECT_EQ(resolve_path("s.yaml", "x.obj"), "x.obj");
  EXPECT_EQ(resolve_path("scenes/s.yaml", "/data/x.obj"), "/data/x.obj");
}

TEST(Files, Sha256KnownAnswers) {
  // FIPS 180-2, appendix B.
  EXPECT_EQ(sha256(std::string_view("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string_view("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace suite::files_test
