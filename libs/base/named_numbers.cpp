#include "base/named_numbers.h"

#include <algorithm>
#include <cmath>

namespace suite {

void check_numbers(const std::string& of, std::span<const Parameter> parameters, std::map<std::string, double>& numbers,
                   const Where& where) {
  const std::vector<std::string> known = names_of(parameters);
  for (const auto& [name, value] : numbers)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(where, of + " has no parameter '" + name + "'", name_hint(name, known));
  for (const Parameter& p : parameters) {
    const auto given = numbers.find(p.name);
    if (given == numbers.end()) {
      if (p.required) throw Error(where, of + " needs '" + p.name + "'", p.summary);
      if (!std::isnan(p.otherwise)) numbers[p.name] = p.otherwise;
    } else {
      check_range(of, p, given->second, where);
    }
  }
}

}  // namespace suite
