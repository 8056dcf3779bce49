#include "formats/heat_hdf/cut_hdf.h"

#include <cmath>

namespace suite {

namespace {

constexpr size_t kMostRests = 1000;
constexpr double kMostMoments = 1000, kMostElements = 1e8, kMostBeam = 1e6;

}  // namespace

namespace {

std::vector<RestInterval> take_rests(h5::Reader& r) {
  const std::vector<double> v = r.get<double>("/cut/rests", "s", 4);
  std::vector<RestInterval> out;
  for (size_t k = 0; k < v.size(); k += 4) {
    const RestInterval rest{{v[k], v[k + 1]}, {v[k + 2], v[k + 3]}};
    const bool follows = out.empty() || rest.span.begin == out.back().span.end;
    if (!(follows && rest.span.begin <= rest.still.begin && rest.still.begin <= rest.still.end &&
          rest.still.end <= rest.span.end && std::isfinite(rest.span.begin) && std::isfinite(rest.span.end)))
      r.fail("has intervals of rest that cannot be");
    out.push_back(rest);
  }
  if (out.size() < 2 || out.size() > kMostRests) r.fail(strf("has %zu intervals of rest", out.size()));
  return out;
}

}  // namespace

void put_cut(h5::Writer& w, const HeatCut& cut) {
  w.attribute("elements_by", cut.by_sun ? "sun" : "area");
  const double numbers[2] = {static_cast<double>(cut.elements), static_cast<double>(cut.sun.size())};
  w.attribute("elements_asked_and_moments_of_the_sun", numbers);
  if (!cut.kept.empty()) w.put("/cut/kept", cut.kept, "1");
  if (!cut.splits.empty()) {
    std::vector<uint32_t> splits;
    for (const CellSplit& s : cut.splits) splits.insert(splits.end(), {s.unit, s.cell});
    w.put("/cut/splits", splits, "1", 2);
  }
  if (!cut.rests.empty()) {
    std::vector<double> rests;
    for (const RestInterval& r : cut.rests)
      rests.insert(rests.end(), {r.span.begin, r.span.end, r.still.begin, r.still.end});
    w.put("/cut/rests", rests, "s", 4);
  }
  if (cut.sun.empty()) return;
  std::vector<double> time, direct, towards;
  for (const SunMoment& m : cut.sun) {
    time.push_back(m.time), direct.push_back(m.direct);
    for (int k = 0; k < 3; ++k) towards.push_back(m.towards[k]);
  }
  w.put("/cut/time", time, "s");
  w.put("/cut/beam", direct, "W/m2");
  w.put("/cut/sun", towards, "1", 3);
}

HeatCut take_cut(h5::Reader& r) {
  const std::string by = r.text("elements_by");
  if (by != "sun" && by != "area") r.fail("has elements cut by '" + by + "', sun or area are known");
  const std::vector<double> v = r.numbers("elements_asked_and_moments_of_the_sun", 2);
  if (!(v[0] >= 1 && v[0] <= kMostElements)) r.fail(strf("was made for %g elements", v[0]));
  if (!(v[1] >= 0 && v[1] <= kMostMoments)) r.fail(strf("has elements cut by %g places of the sun", v[1]));
  HeatCut cut{static_cast<size_t>(v[0]), by == "sun", {}, {}, {}};
  if (r.has("/cut/rests")) cut.rests = take_rests(r);
  if (r.has("/cut/kept")) cut.kept = r.get<uint32_t>("/cut/kept", "1");
  if (r.has("/cut/splits")) {
    const std::vector<uint32_t> splits = r.get<uint32_t>("/cut/splits", "1", 2);
    for (size_t k = 0; k < splits.size(); k += 2) cut.splits.push_back({splits[k], splits[k + 1]});
  }
  const auto n = static_cast<long long>(v[1]);
  if (n == 0) return cut;
  const std::vector<double> time = r.get<double>("/cut/time", "s", 1, n),
                            direct = r.get<double>("/cut/beam", "W/m2", 1, n),
                            towards = r.get<double>("/cut/sun", "1", 3, n);
  for (size_t k = 0; k < time.size(); ++k) {
    const Dir d{towards[3 * k], towards[3 * k + 1], towards[3 * k + 2]};
    if (!std::isfinite(time[k]) || !(direct[k] >= 0 && direct[k] <= kMostBeam) || !(std::fabs(length(d) - 1) < 1e-6))
      r.fail("has elements cut by a sun that cannot be");
    cut.sun.push_back({time[k], direct[k], d});
  }
  return cut;
}

}  // namespace suite
