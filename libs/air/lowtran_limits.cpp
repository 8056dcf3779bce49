#include "air/lowtran_limits.h"

namespace suite {

std::vector<GasLimit> limits_of_lowtran(WaterOf continuum) {
  const GasLimit foot{
      14.0,
      18.7,
      {0, 0},
      0,
      {3.4, 7},
      {0, 0},
      "carbon dioxide, water; measured without water: 1.7 K rms, 3 K at most; the rest is an allowance for "
      "water, not measured, nor are slanted paths"};
  if (continuum == WaterOf::mt_ckd)
    return {{1.1, 1.35, {0.023, 0.092}, 0.005, {}, {}, "water, oxygen"},
            {2.0, 2.4, {0.034, 0.12}, -0.025, {}, {}, "water, methane"},
            {2.9, 3.4, {0.032, 0.095}, 0.01, {1.1, 2.7}, {1.5, 5.0}, "water"},
            {3.4,
             4.15,
             {0.048, 0.13},
             -0.023,
             {1.6, 3.2},
             {3.7, 10.3},
             "too opaque; the air glows up to 3.5 times too brightly on short paths"},
            {4.15, 4.6, {0.027, 0.096}, -0.005, {2.3, 7.9}, {2.0, 7.9}, "carbon dioxide"},
            {4.6, 5.3, {0.024, 0.088}, -0.008, {1.3, 2.9}, {1.8, 6.4}, "water"},
            {5.3, 7.2, {0.025, 0.18}, -0.007, {2.2, 5.2}, {1.9, 5.2}, "water"},
            {7.2, 8.2, {0.029, 0.11}, -0.007, {1.8, 4.9}, {2.5, 6.9}, "water, methane"},
            {8.2, 9.3, {0.037, 0.085}, 0.03, {1.1, 2.8}, {2.5, 8.1}, "water"},
            {9.3, 10.15, {0.043, 0.11}, 0.031, {1.8, 4.9}, {2.8, 9.2}, "ozone"},
            {10.15, 12.4, {0.032, 0.068}, 0.026, {1.3, 2.8}, {2.4, 8.8}, "water's continuum, aerosol"},
            {12.4, 14.0, {0.024, 0.069}, 0.011, {2.2, 5.9}, {4.2, 11.7}, "carbon dioxide"},
            foot};
  return {{1.1, 1.35, {0.025, 0.089}, 0, {}, {}, "water, oxygen"},
          {2.0, 2.4, {0.046, 0.13}, -0.038, {}, {}, "water's continuum of 1988 is too strong, methane"},
          {2.9, 3.4, {0.012, 0.069}, 0, {0.82, 2.0}, {1.2, 4.8}, "water"},
          {3.4,
           4.15,
           {0.067, 0.18},
           -0.056,
           {1.8, 3.4},
           {3.8, 9.7},
           "water's continuum of 1988 is too strong, `water_continuum: FILE` of MT_CKD has 0.042 rms; the air glows up "
           "to 3.7 times too brightly on short paths"},
          {4.15, 4.6, {0.028, 0.1}, -0.007, {2.3, 7.9}, {2.0, 7.9}, "carbon dioxide"},
          {4.6,
           5.3,
           {0.046, 0.15},
           -0.032,
           {1.8, 4.5},
           {2.5, 6.2},
           "water's continuum of 1988 is too strong, `water_continuum: FILE` of MT_CKD has 0.024 rms"},
          {5.3, 7.2, {0.027, 0.18}, -0.008, {2.2, 5.1}, {1.9, 5.1}, "water"},
          {7.2, 8.2, {0.043, 0.11}, -0.025, {2.1, 4.7}, {3.2, 8.7}, "water, methane"},
          {8.2, 9.3, {0.025, 0.046}, -0.02, {1.4, 3.2}, {2.8, 7.6}, "water"},
          {9.3, 10.15, {0.032, 0.085}, 0.007, {1.9, 4.7}, {2.8, 8.9}, "ozone"},
          {10.15, 12.4, {0.027, 0.067}, 0.022, {1.3, 3.0}, {2.4, 8.6}, "water's continuum, aerosol"},
          {12.4, 14.0, {0.02, 0.062}, 0.006, {2.2, 6.0}, {4.1, 11.7}, "carbon dioxide"},
          foot};
}

}  // namespace suite
