// Ends a program that the processor cannot run, before any of its code runs: constructors of static objects already use
// what the compiler was allowed to. Compiled for the least processor of its kind (CMakeLists.txt), without the library
// of C++.
#include <unistd.h>

#include <cstring>

#include "cpu_needs.h"

#if defined(__x86_64__) && defined(__linux__)
namespace {

bool has(unsigned need) {
  switch (need) {
    case SUITE_NEEDS_SSE42:
      return __builtin_cpu_supports("sse4.2");
    case SUITE_NEEDS_AVX:
      return __builtin_cpu_supports("avx");
    case SUITE_NEEDS_AVX2:
      return __builtin_cpu_supports("avx2");
    case SUITE_NEEDS_FMA:
      return __builtin_cpu_supports("fma");
    case SUITE_NEEDS_BMI:
      return __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    default:
      return __builtin_cpu_supports("avx512f");
  }
}

void add(char* line, size_t room, const char* text) { strncat(line, text, room - strlen(line) - 1); }

void check(int, char** argv, char**) {
  static const char* const names[] = {"SSE4.2", "AVX", "AVX2", "FMA", "BMI", "AVX-512"};
  __builtin_cpu_init();
  char line[512] = "";
  const char* const slash = argv && argv[0] ? strrchr(argv[0], '/') : nullptr;
  strncat(line, slash ? slash + 1 : argv && argv[0] ? argv[0] : "program", 100);
  const size_t begun = strlen(line);
  for (unsigned i = 0; i < sizeof names / sizeof *names; ++i) {
    if (!(suite_cpu_needs & 1U << i) || has(1U << i)) continue;
    add(line, sizeof line, strlen(line) == begun ? ": error: this processor, or what emulates it, lacks " : ", ");
    add(line, sizeof line, names[i]);
  }
  if (strlen(line) == begun) return;
  add(line, sizeof line,
      ", which this build uses; build the suite from its sources with cmake -DSUITE_ARCH=x86-64, or run it on another "
      "machine (x86-64-v3: Intel since 2013, AMD since 2015)\n");
  if (write(STDERR_FILENO, line, strlen(line)) < 0) _exit(1);
  _exit(1);
}

// Runs before the constructors of the program and of all its libraries.
__attribute__((section(".preinit_array"), used)) void (*const suite_check)(int, char**, char**) = check;

}  // namespace
#endif
