// Sizes of objects in global heaps that the HDF5 library would follow without end.
#include "formats/hdf5/global_heap.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace suite::format_hdf5_global_heap_test {
namespace {

// A heap of 64 bytes after 16 others: one object of 5 bytes, then what is free.
std::vector<std::byte> heap(uint64_t size, uint64_t length, uint64_t free) {
  std::vector<std::byte> bytes(80);
  const auto put = [&](size_t at, auto value) { std::memcpy(&bytes[at], &value, sizeof value); };
  std::memcpy(&bytes[16], "GCOL\1", 5);
  put(24, size), put(32, uint16_t{1}), put(40, length);
  put(56, uint16_t{0}), put(64, free);
  return bytes;
}

TEST(GlobalHeap, WholeOnesPass) {
  EXPECT_FALSE(h5::broken_global_heap(heap(64, 5, 24)));
  EXPECT_FALSE(h5::broken_global_heap(std::vector<std::byte>(7)));
}

TEST(GlobalHeap, SizesThatLeadNowhereAreFound) {
  EXPECT_EQ(h5::broken_global_heap(heap(64, 5, 0)), 56u);
  EXPECT_EQ(h5::broken_global_heap(heap(64, 5, 25)), 56u);
  EXPECT_EQ(h5::broken_global_heap(heap(64, UINT64_MAX - 3, 24)), 32u);
  EXPECT_EQ(h5::broken_global_heap(heap(65, 5, 24)), 16u);
  EXPECT_EQ(h5::broken_global_heap(heap(0, 5, 24)), 16u);
}

}  // namespace
}  // namespace suite::format_hdf5_global_heap_test
