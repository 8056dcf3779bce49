// The instructions that the suite's sources were compiled for, as bits. Seen from code that uses none of them.
#pragma once

extern "C" {
enum : unsigned {
  SUITE_NEEDS_SSE42 = 1,
  SUITE_NEEDS_AVX = 2,
  SUITE_NEEDS_AVX2 = 4,
  SUITE_NEEDS_FMA = 8,
  SUITE_NEEDS_BMI = 16,  // BMI1 and BMI2
  SUITE_NEEDS_AVX512 = 32,
};
extern const unsigned suite_cpu_needs;
}
