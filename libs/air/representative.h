// Absorption at representative wavelengths: bands of which each is a weighted sum over a few wavelengths, with cross
// sections of all gases there; so the gases of a band are correlated as they are in nature. Based on: J. Gasteiger et
// al., "Representative wavelengths absorption parameterization applied to satellite channels and spectral bands", J.
// Quant. Spectrosc. Radiat. Transfer 148, 2014 (REPTRAN).
#pragma once
#include <string>
#include <vector>

#include "air/gases.h"

namespace suite {

struct RepresentativeGas {
  Gas gas = Gas::h2o;
  std::vector<double> pressure;     // Pa, ascending
  std::vector<double> temperature;  // K, of each pressure
  std::vector<double> offset;       // K from that, ascending
  std::vector<double> share;        // of the gas, ascending; one value when it does not matter
  std::vector<long> place;  // of each representative wavelength in `cross_section`, -1: it does not absorb there
  std::vector<float> cross_section;  // m2: [offset][share][place][pressure]
};

struct RepresentativeTable {
  std::string source;  // a sentence
  struct Member {
    size_t wavelength;  // index of a representative wavelength
    double weight;
  };
  struct Band {
    double low_cm, high_cm;
    std::vector<Member> members;  // weights sum to 1
  };
  std::vector<Band> bands;  // ascending, without gaps
  std::vector<RepresentativeGas> gases;
};

// Error: bands with gaps or weights that do not sum to 1, sizes that do not fit, at `where`.
void check_representative(const RepresentativeTable& table, const Where& where = {});
std::unique_ptr<GasProvider> representative_gases(RepresentativeTable table);

}  // namespace suite
