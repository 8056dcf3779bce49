// What the computation did: counts of paths and nodes, visibility of the sun, the spectral state.
#include "transport/truth/truth.h"

namespace suite {

namespace {
template <size_t slots>
std::unique_ptr<const TruthCollector> one(const TruthContext& c, const char* column, SimpleCollector::Add add,
                                          SimpleCollector::Finish finish) {
  return std::make_unique<SimpleCollector>(c, slots, std::vector<std::string>{column}, add, finish);
}
void nothing(const TruthContext&, const TruthSample&, double*) {}
}  // namespace

void add_account_rows(std::vector<TruthRow>& table) {
  table.push_back({"paths", "number of sample paths", "", [](const TruthContext& c) {
                     return one<0>(
                         c, "paths", nothing,
                         [](const TruthContext&, const double*, const TruthCounts& n, double* v) { v[0] = n.paths; });
                   }});
  table.push_back({"hits", "number of samples that met something", "", [](const TruthContext& c) {
                     return one<0>(
                         c, "nodes hit", nothing,
                         [](const TruthContext&, const double*, const TruthCounts& n, double* v) { v[0] = n.hits; });
                   }});
  table.push_back(
      {"nodes", "mean number of scattering events a path", "", [](const TruthContext& c) {
         return one<1>(
             c, "mean nodes", [](const TruthContext&, const TruthSample& s, double* sum) { sum[0] += s.path.size; },
             [](const TruthContext&, const double* sum, const TruthCounts& n, double* v) { v[0] = sum[0] / n.paths; });
       }});
  table.push_back({"sun_visibility", "share of the first hits that the sun reaches", "", [](const TruthContext& c) {
                     return one<1>(
                         c, "sun visibility",
                         [](const TruthContext&, const TruthSample& s, double* sum) {
                           if (s.first && s.first->sunlit) ++sum[0];
                         },
                         [](const TruthContext& x, const double* sum, const TruthCounts& n, double* v) {
                           if (n.hits > 0 && x.environment.towards_sun()) v[0] = sum[0] / n.hits;
                         });
                   }});
  // Whoever puts far points into the picture fills it in (scheduler/points_in_view.h).
  table.push_back({"star",
                   "row in the table of stars of the one that gives most light to the pixel, of those that put 1 % of "
                   "their light into it; 0 where there is none",
                   "", [](const TruthContext& c) {
                     return one<0>(c, "star", nothing,
                                   [](const TruthContext&, const double*, const TruthCounts&, double* v) { v[0] = 0; });
                   }});
  table.push_back({"state", "number of the spectral state", "", [](const TruthContext& c) {
                     return one<0>(c, "spectral state", nothing,
                                   [](const TruthContext& x, const double*, const TruthCounts&, double* v) {
                                     v[0] = static_cast<double>(x.state_index);
                                   });
                   }});
}

}  // namespace suite
