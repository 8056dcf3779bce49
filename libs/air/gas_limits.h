// Where gases are known less surely than their provider says in general (GasProvider::note).
#pragma once
#include <string>
#include <vector>

#include "air/gases.h"

namespace suite {

struct WeakGases {
  double low_um = 0, high_um = 0;
  std::string size;  // of the error, a clause
};
// Of the builtin gases, vertical paths through the U.S. Standard Atmosphere (tests/physics/air/gas_absorption_test.cpp,
// lines; tests/physics/light/air_bands_test.cpp, kelvin). None of others, of which nothing is known.
std::vector<WeakGases> weak_gases(const GasProvider& provider);

}  // namespace suite
