// Elements that do not matter to what the sensors see: left out of the search for temperatures (`heat:
// {influence_cutoff_k}`).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "heat/influence.h"
#include "heat_report.h"

namespace suite {

class LeftOut {
 public:
  // Traces the exchange of all elements, and leaves in `prepared` those that matter by more than the limit, K. air:
  // coldest and warmest, K. Nothing is left out where surfaces mirror infrared (told).
  LeftOut(PreparedHeat& prepared, const Simulation& simulation, std::array<double, 2> air,
          const HeatProgress& progress);
  // The exchange of what is left. Once.
  ExchangePaths take_exchange() { return std::move(left_); }
  // By how much less is found, and the bound (K), from the temperatures that were found.
  std::string sentence(const HeatResult& result) const;
  double bound(const HeatResult& result) const;

 private:
  std::unique_ptr<const HeatFaces> faces_;  // of all
  ExchangePaths exchange_, left_;           // of all
  std::unique_ptr<const Influence> influence_;
  std::vector<bool> seen_, kept_;  // by element of all
  std::array<double, 2> air_;
};

// Elements that the sensors may see.
std::vector<bool> elements_in_view(const Elements& elements, const Simulation& simulation);
// Error: elements of all that the sensors may see and that are not among those that were kept.
void check_kept(const Elements& all, const Simulation& simulation, const std::vector<uint32_t>& kept);
// Leaves those of a file. Error: numbers that are none of the elements.
void keep_elements(PreparedHeat& prepared, const std::vector<uint32_t>& kept);

}  // namespace suite
