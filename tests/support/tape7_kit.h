// tape7 files of our own making: cards as MODTRAN writes them, and columns that a function gives.
#pragma once
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"

namespace suite::test {

// Of one wavenumber. Radiances in W/(cm2 sr cm-1), irradiances in W/(cm2 cm-1).
struct MadeRow {
  double transmittance = 1, thermal = 0, scattered = 0, two_way = 1, sun = 2e-6;
};

struct MadeRun {
  int type = 2, mode = 2;  // ITYPE, IEMSCT
  double h1_km = 3, h2_km = 0, zenith_deg = 180, range_km = 3;
  double solar_zenith_deg = 40, azimuth_deg = 0;
  double first = 16000, last = 20600, step = 50;  // 1/cm
  std::function<MadeRow(double wavenumber)> row = [](double) { return MadeRow{}; };
};

// Radiance of a blackbody in W/(cm2 sr cm-1): c1 nu^3 / (exp(c2 nu / T) - 1), with c1 = 2 h c^2 and c2 = h c / k of
// CODATA 2018 in W cm2 and cm K.
inline double blackbody_per_wavenumber(double wavenumber, double kelvin) {
  return 1.191042972397188e-12 * std::pow(wavenumber, 3) / std::expm1(1.438776877503933 * wavenumber / kelvin);
}

inline std::string cards_of(const MadeRun& r) {
  return strf("T F 6%5d%5d    1    6    6    6    6    6    6    1    0    0 300.000   0.00\n", r.type, r.mode) +
         "    0    1    1    0    0    0  23.00000   0.00000   0.00000   0.00000   0.00000\n    6U S STANDARD\n" +
         (r.mode == 3 ? strf("%10.5f%10.5f%10.5f    1\n", r.h1_km, r.h2_km, r.zenith_deg)
                      : strf("%10.5f%10.5f%10.5f%10.5f\n", r.h1_km, r.h2_km, r.zenith_deg, r.range_km)) +
         (r.mode == 2 ? strf("    2    2    1    0\n%10.5f%10.5f\n", r.azimuth_deg, r.solar_zenith_deg) : "") +
         strf("%10.1f%10.1f%10.1f%10.1fNW\n", r.first, r.last, r.step, r.step);
}

inline std::string run_text(const MadeRun& r) {
  const bool transmittance = r.mode == 0, sun = r.mode == 3;
  std::string text = cards_of(r);
  const auto head = [&](std::initializer_list<const char*> names) {
    text += "    FREQ";
    for (const char* name : names) text += strf("%14s", name);
    text += "\n";
  };
  if (transmittance) {
    head({"COMBIN", "H2O"});
    text += strf("    CM-1%14s%14s\n", "TRANS", "TRANS");
  } else if (sun) {
    head({"TRANS", "SOL_TR", "SOLAR"});
  } else {
    head({"TOT_TRANS", "PTH_THRML", "THRML_SCT", "SURF_EMIS", "SOL_SCAT", "SING_SCAT", "GRND_RFLT", "DRCT_RFLT",
          "TOTAL_RAD", "REF_SOL", "SOL@OBS", "DEPTH", "DIR_EM", "TOA_SUN"});
  }
  for (double nu = r.first; nu <= r.last + 1e-6; nu += r.step) {
    const MadeRow v = r.row(nu);
    text += strf("%8.1f", nu);
    const auto add = [&](double value) { text += strf("%14.6E", value); };
    if (transmittance) {
      add(v.transmittance), add(1);
    } else if (sun) {
      add(v.transmittance), add(v.transmittance * v.sun), add(v.sun);
      text += strf("%9.3f", -std::log(v.transmittance));
    } else {
      const bool lit = r.mode == 2;
      const std::string blank(14, ' ');
      add(v.transmittance), add(v.thermal), add(0), add(0);
      for (const double part : {v.scattered, 0.0, 0.0, 0.0})
        if (lit)
          add(part);
        else
          text += blank;
      add(v.thermal + (lit ? v.scattered : 0));
      for (const double part : {v.two_way * v.sun, v.sun})
        if (lit)
          add(part);
        else
          text += blank;
      add(-std::log(v.transmittance)), add(1);
      if (lit) add(v.sun);
    }
    text += "\n";
  }
  return text + "   -9999.\n";
}

inline std::string tape7_text(const std::vector<MadeRun>& runs) {
  std::string text;
  for (const MadeRun& r : runs) text += run_text(r);
  return text;
}

}  // namespace suite::test
