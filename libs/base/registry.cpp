#include "base/registry.h"

namespace suite {

std::vector<std::string> names_of(std::span<const Parameter> parameters) {
  std::vector<std::string> names;
  for (const Parameter& p : parameters) names.push_back(p.name);
  return names;
}

void check_range(const std::string& of, const Parameter& p, double value, const Where& where, const std::string& code) {
  if (value >= p.low && value <= p.high) return;
  throw Error(where, of + strf(": %s = %g is outside its range", p.name.c_str(), value),
              strf("give %g to %g", p.low, p.high) + (p.unit.empty() || p.unit == "1" ? "" : " " + p.unit), code);
}

namespace detail {

void throw_unknown_row(const std::string& kind, const std::string& code, const std::string& name,
                       std::span<const std::string> known, const Where& where) {
  throw Error(where, "unknown " + kind + " '" + name + "'", name_hint(name, known), code);
}

std::string listing(const std::string& name, const std::string& summary, const std::string& unit,
                    std::span<const Parameter> parameters) {
  const auto in_brackets = [](const std::string& text) { return text.empty() ? "" : " [" + text + "]"; };
  std::string text = strf("%-18s ", name.c_str()) + summary + in_brackets(unit) + "\n";
  for (const Parameter& p : parameters)
    text +=
        strf("    %-22s ", p.name.c_str()) + p.summary + in_brackets(p.unit) + (p.required ? "" : ", optional") + "\n";
  return text;
}

}  // namespace detail

}  // namespace suite
