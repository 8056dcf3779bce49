#include "air/lowtran_limits.h"

namespace suite {

namespace {

const GasLimit kFoot{
    14.0,
    18.7,
    {0, 0},
    0,
    {3.4, 7},
    {0, 0},
    "carbon dioxide, water; measured without water: 1.7 K rms, 3 K at most; the rest is an allowance for "
    "water, not measured, nor are slanted paths"};

}  // namespace

std::vector<GasLimit> limits_of_builtin(WaterOf continuum) {
  const char* glow = "weak lines of water; the air glows 1.4 times too brightly on paths of 100 m";
  if (continuum == WaterOf::mt_ckd)
    return {{1.1, 1.35, {0.025, 0.11}, 0.007, {}, {}, "water, oxygen"},
            {2.0, 2.4, {0.024, 0.11}, -0.017, {}, {}, "methane, water"},
            {2.9, 3.4, {0.032, 0.095}, 0.02, {1.1, 2.7}, {1.5, 5.0}, "water"},
            {3.4, 4.15, {0.059, 0.17}, -0.03, {1.5, 3.3}, {3.5, 10.5}, glow},
            {4.15, 4.6, {0.026, 0.098}, -0.005, {2.3, 7.9}, {1.9, 7.9}, "carbon dioxide"},
            {4.6, 5.3, {0.032, 0.095}, -0.018, {1.5, 3.3}, {2.1, 6.4}, "water, ozone"},
            {5.3, 7.2, {0.014, 0.095}, -0.002, {2.3, 5.4}, {1.9, 5.4}, "water"},
            {7.2, 8.2, {0.031, 0.12}, -0.009, {1.8, 4.5}, {3.5, 11.5}, "water, methane"},
            {8.2, 9.3, {0.019, 0.054}, 0.014, {1.2, 2.9}, {2.6, 7.9}, "water, aerosol"},
            {9.3, 10.15, {0.034, 0.098}, 0.022, {1.8, 5.1}, {2.8, 9.2}, "ozone"},
            {10.15, 12.4, {0.025, 0.06}, 0.019, {1.2, 2.7}, {2.2, 8.8}, "water's continuum, aerosol"},
            {12.4, 14.0, {0.019, 0.05}, 0.014, {0.95, 3.2}, {1.7, 4.4}, "carbon dioxide, water's continuum"},
            kFoot};
  return {{1.1, 1.35, {0.025, 0.11}, 0.007, {}, {}, "water, oxygen"},
          {2.0, 2.4, {0.024, 0.11}, -0.017, {}, {}, "methane, water"},
          {2.9, 3.4, {0.032, 0.083}, 0.023, {1.1, 2.6}, {1.5, 4.9}, "water"},
          {3.4, 4.15, {0.056, 0.16}, -0.029, {1.5, 3.3}, {3.5, 10.5}, glow},
          {4.15, 4.6, {0.026, 0.098}, -0.005, {2.3, 7.9}, {1.9, 7.9}, "carbon dioxide"},
          {4.6, 5.3, {0.028, 0.098}, -0.013, {1.5, 3.5}, {2.0, 6.4}, "water, ozone"},
          {5.3, 7.2, {0.014, 0.098}, -0.002, {2.3, 5.6}, {1.8, 5.6}, "water"},
          {7.2, 8.2, {0.029, 0.12}, -0.007, {1.8, 4.4}, {3.5, 11.7}, "water, methane"},
          {8.2, 9.3, {0.017, 0.046}, -0.01, {1.3, 3.1}, {2.6, 7.5}, "water, aerosol"},
          {9.3, 10.15, {0.031, 0.092}, -0.009, {1.9, 4.9}, {2.8, 8.8}, "ozone"},
          {10.15, 12.4, {0.012, 0.036}, 0.004, {1.3, 2.8}, {2.2, 8.4}, "water, aerosol"},
          {12.4, 14.0, {0.015, 0.046}, 0.009, {0.95, 3.1}, {1.7, 4.3}, "carbon dioxide"},
          kFoot};
}

std::vector<GasLimit> limits_of_lowtran() {
  return {{1.1, 1.35, {0.025, 0.089}, 0, {}, {}, "water, oxygen"},
          {2.0, 2.4, {0.046, 0.13}, -0.038, {}, {}, "water's continuum of 1988 is too strong, methane"},
          {2.9, 3.4, {0.012, 0.069}, 0, {0.82, 2.0}, {1.2, 4.8}, "water"},
          {3.4,
           4.15,
           {0.067, 0.18},
           -0.056,
           {1.8, 3.4},
           {3.8, 9.7},
           "water's continuum of 1988 is too strong, `gases: builtin` has 0.056 rms; the air glows up to 3.7 times too "
           "brightly on short paths"},
          {4.15, 4.6, {0.028, 0.1}, -0.007, {2.3, 7.9}, {2.0, 7.9}, "carbon dioxide"},
          {4.6,
           5.3,
           {0.046, 0.15},
           -0.032,
           {1.8, 4.5},
           {2.5, 6.2},
           "water's continuum of 1988 is too strong, `gases: builtin` has 0.028 rms"},
          {5.3, 7.2, {0.027, 0.18}, -0.008, {2.2, 5.1}, {1.9, 5.1}, "water"},
          {7.2, 8.2, {0.043, 0.11}, -0.025, {2.1, 4.7}, {3.2, 8.7}, "water, methane"},
          {8.2, 9.3, {0.025, 0.046}, -0.02, {1.4, 3.2}, {2.8, 7.6}, "water"},
          {9.3, 10.15, {0.032, 0.085}, 0.007, {1.9, 4.7}, {2.8, 8.9}, "ozone"},
          {10.15, 12.4, {0.027, 0.067}, 0.022, {1.3, 3.0}, {2.4, 8.6}, "water's continuum, aerosol"},
          {12.4, 14.0, {0.02, 0.062}, 0.006, {2.2, 6.0}, {4.1, 11.7}, "carbon dioxide"},
          kFoot};
}

}  // namespace suite
