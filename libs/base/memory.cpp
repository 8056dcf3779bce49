#include "base/memory.h"

#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string>

namespace suite {

double available_memory() {
  double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  std::ifstream info("/proc/meminfo");
  for (std::string word; info >> word;)
    if (double kilobytes = 0; word == "MemAvailable:" && info >> kilobytes) bytes = std::min(bytes, 1024 * kilobytes);
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    double pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const double used = pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
    bytes = std::min(bytes, std::max(0.0, static_cast<double>(limit.rlim_cur) - used));
  }
  return bytes;
}

double heap_in_use() {
  const struct mallinfo2 m = mallinfo2();
  return static_cast<double>(m.uordblks) + static_cast<double>(m.hblkhd);
}

void give_back_freed() { malloc_trim(0); }

void expect_large(void* data, size_t bytes) {
  if (bytes < (size_t{4} << 20)) return;
  const auto page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  const uintptr_t begin = (reinterpret_cast<uintptr_t>(data) + page - 1) / page * page,
                  end = (reinterpret_cast<uintptr_t>(data) + bytes) / page * page;
  // Advice: a kernel that knows no large pages may refuse it.
  if (end > begin) (void)madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

}  // namespace suite
