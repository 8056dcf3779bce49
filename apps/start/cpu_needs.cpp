// Compiled as all sources are, so that the compiler says what it was allowed to use. It holds a number and no code.
#include "cpu_needs.h"

const unsigned suite_cpu_needs = 0
#ifdef __SSE4_2__
                                 | SUITE_NEEDS_SSE42
#endif
#ifdef __AVX__
                                 | SUITE_NEEDS_AVX
#endif
#ifdef __AVX2__
                                 | SUITE_NEEDS_AVX2
#endif
#ifdef __FMA__
                                 | SUITE_NEEDS_FMA
#endif
#if defined(__BMI__) || defined(__BMI2__)
                                 | SUITE_NEEDS_BMI
#endif
#ifdef __AVX512F__
                                 | SUITE_NEEDS_AVX512
#endif
    ;
