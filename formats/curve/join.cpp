// Several curves as one, each over its own wavelengths.
#include <algorithm>
#include <cmath>

#include "base/params.h"
#include "formats/curve/curve.h"

namespace suite {

namespace {

// How far apart the rows of a curve lie at one of its ends.
double end_step(const Curve& c, bool upper) {
  const std::vector<double>& x = c.wavelength_um();
  if (x.size() < 2) return 0;
  return upper ? x[x.size() - 1] - x[x.size() - 2] : x[1] - x[0];
}

// Where two neighbours meet: the middle of their overlap, or of a gap no wider than their rows would leave.
double meeting(const Curve& low, const Curve& high, const Where& where) {
  if (!(high.low_um() > low.low_um() && high.high_um() > low.high_um()))
    throw Error(where,
                strf("this curve, %g to %g um, does not go on where the one before it, %g to %g um, ends",
                     high.low_um(), high.high_um(), low.low_um(), low.high_um()),
                "list curves from short to long wavelengths, none inside another");
  const double gap = high.low_um() - low.high_um(), bridged = 2 * std::max(end_step(low, true), end_step(high, false));
  if (gap > bridged * (1 + 1e-9))
    throw Error(where,
                strf("no curve is given between %g and %g um, and the rows beside this gap are %g um apart at most",
                     low.high_um(), high.low_um(), 0.5 * bridged),
                "list a curve for the gap, if need be of two points");
  return 0.5 * (low.high_um() + high.low_um());
}

}  // namespace

Curve join_curves(std::span<const Curve> parts, std::span<const double> at_um, Outside outside,
                  std::span<const Where> where) {
  std::vector<double> x, y;
  double from = 0;
  for (size_t i = 0; i < parts.size(); ++i) {
    const Curve& part = parts[i];
    if (part.is_constant()) throw Error(where[i], "a constant has no wavelengths to be joined at", "give two points");
    if (part.outside() != Outside::error)
      throw Error(where[i], "a curve that is joined to others ends where its rows end",
                  "write 'outside' beside 'join', for the whole");
    double to = INFINITY;
    if (i + 1 < parts.size()) {
      to = meeting(part, parts[i + 1], where[i + 1]);
      if (!at_um.empty()) {
        const double low = std::min(part.high_um(), parts[i + 1].low_um()),
                     high = std::max(part.high_um(), parts[i + 1].low_um());
        if (!(at_um[i] >= low && at_um[i] <= high))
          throw Error(where[i + 1],
                      strf("curves are to be joined at %g um, they meet from %g to %g um", at_um[i], low, high));
        to = at_um[i];
      }
    }
    const size_t before = x.size();
    for (size_t k = 0; k < part.value().size(); ++k)
      if (const double w = part.wavelength_um()[k]; w >= from && w < to) x.push_back(w), y.push_back(part.value()[k]);
    if (x.size() == before)
      throw Error(where[i], strf("nothing is left of this curve between %g and %g um, where it is joined", from, to),
                  "join at wavelengths between its rows");
    from = to;
  }
  return Curve(std::move(x), std::move(y), outside, where[0]);
}

Curve read_joined(const Params& p, const std::function<Curve(const Params&)>& read_one) {
  const bool map = p.kind() == Params::Kind::map;
  const Params list = map ? p.at("join") : p;
  if (list.kind() != Params::Kind::list || list.size() < 2)
    throw list.error("two curves at least are joined", "[VSWIR.txt, TIR.txt]");
  std::vector<Curve> parts;
  std::vector<Where> where;
  for (const Params& item : list.items()) {
    if (item.kind() == Params::Kind::list) throw item.error("a list inside a list of curves");
    parts.push_back(read_one(item));
    where.push_back(item.where());
  }
  std::vector<double> at;
  Outside outside = Outside::error;
  if (map) {
    if (const auto given = p.find("at_um")) at = given->as_numbers();
    if (!at.empty() && at.size() + 1 != parts.size())
      throw p.at("at_um").error(strf("%zu wavelengths for %zu curves", at.size(), parts.size()),
                                "one for each place where two are joined");
    outside = read_outside(p);
  }
  return join_curves(parts, at, outside, where);
}

Outside read_outside(const Params& map) {
  const auto rule = map.find("outside");
  return rule ? static_cast<Outside>(rule->as_choice({"error", "hold", "zero"})) : Outside::error;
}

}  // namespace suite
