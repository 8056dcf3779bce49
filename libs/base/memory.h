// Memory: how much there is, and large arrays that are written once from end to end.
#pragma once
#include <cstddef>
#include <vector>

namespace suite {

// Bytes that this process may still use without harm: what the system has available, within the process's own limits.
double available_memory();

// Bytes that the program has allocated and not given back; 0 where the allocator does not tell (sanitizers).
double heap_in_use();

// Gives pages of what was freed among other things back to the system, where the allocator can.
void give_back_freed();

// Asks the system to back `bytes` bytes from `data` on, not yet touched, with large pages where it can: clearing and
// mapping 4 kB at a time costs more than writing results does. Does nothing for less than 4 MiB.
void expect_large(void* data, size_t bytes);

// Gives back what a vector holds; `v = {}` keeps its memory.
template <class T>
void give_up(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

// v.resize(n) of an empty vector, its memory announced by expect_large.
template <class T>
void resize_large(std::vector<T>& v, size_t n) {
  v.reserve(n);
  expect_large(v.data(), n * sizeof(T));
  v.resize(n);
}

}  // namespace suite
