// Shares of exchange between black surfaces against the catalogue of tests/data/thermal/view_factors.csv: 1e5 paths,
// within 0.3 % of the factor or 3 standard deviations of a binomial of so many, whichever is more.
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <regex>
#include <sstream>

#include "support/heated_scene_kit.h"

namespace suite::view_factors_test {
namespace {

using namespace test;
using Numbers = std::map<std::string, double>;

constexpr uint32_t kPaths = 100000;
constexpr double kLong = 1000;  // for "infinitely long", beside a piece of length 1 in the middle

struct Row {
  std::string geometry, parameters;
  Numbers number;
  double factor = 0;
};

// Cells of a line; quotes keep commas.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

std::vector<Row> rows() {
  std::vector<Row> out;
  std::ifstream in(SUITE_TEST_DATA "/thermal/view_factors.csv");
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#' || line.starts_with("geometry")) continue;
    const std::vector<std::string> cells = cells_of(line);
    Row row{cells.at(0), cells.at(2), {}, std::stod(cells.at(3))};
    static const std::regex pair("([A-Za-z0-9]+)=([0-9.]+)");
    for (std::sregex_iterator m(row.parameters.begin(), row.parameters.end(), pair), end; m != end; ++m)
      row.number[(*m)[1]] = std::stod((*m)[2]);
    out.push_back(std::move(row));
  }
  return out;
}

// What a geometry is made of. The face in question is the front of the one element of `from`, or its back.
struct Built {
  HeatedScene scene;
  uint32_t from = 0, to = 0;
  bool back = false;
  Built() : from(scene.heated(1, heat({}, {{"back", "open"}}))), to(scene.given(1, 300)) {}

  // A rectangle from `corner` along two edges; its front is where their product points.
  void rectangle(uint32_t material, Vec3 corner, Vec3 a, Vec3 b) {
    scene.mesh(mesh_of({corner, corner + a, corner + a + b, corner + b}, {0, 1, 2, 0, 2, 3}, material));
  }
  void parallel(double a, double b, double c, Vec3 shift, double a2, double b2) {
    rectangle(from, {}, {a, 0, 0}, {0, b, 0});
    rectangle(to, Vec3{0, 0, c} + shift, {0, b2, 0}, {a2, 0, 0});
  }
  // From the floor, e to e + w from the edge, to the wall, r to r + h above it.
  void corner(double w, double h, double length, double e, double r, double length2, double angle = kPi / 2) {
    rectangle(from, {e, -length / 2, 0}, {w, 0, 0}, {0, length, 0});
    const Vec3 up{std::cos(angle), 0, std::sin(angle)};
    rectangle(to, up * r + Vec3{0, -length2 / 2, 0}, {0, length2, 0}, up * h);
  }
};

using Builder = std::function<void(Built&, Numbers&)>;

void cylinders(Built& b, Numbers& n, bool from_outer) {
  b.scene.exact(PrimitiveKind::cylinder, {n["ro"], n["l"], 0}, from_outer ? b.from : b.to);
  b.scene.exact(PrimitiveKind::cylinder, {n["ri"], n["l"], 0}, from_outer ? b.to : b.from);
  b.back = from_outer;
}
void spheres(Built& b, Numbers& n, bool from_outer) {
  b.scene.exact(PrimitiveKind::sphere, {n["r2"]}, from_outer ? b.from : b.to);
  b.scene.exact(PrimitiveKind::sphere, {n["r1"]}, from_outer ? b.to : b.from);
  b.back = from_outer;
}
void disks(Built& b, double r1, double r2, double h) {
  b.scene.exact(PrimitiveKind::disk, {r1, 0}, b.from);
  b.scene.exact(PrimitiveKind::disk, {r2, 0}, b.to, upside_down({0, 0, h}));
}
constexpr double kSmall = 1e-3;  // of a side: an "element"
void small(Built& b) { b.rectangle(b.from, {-kSmall / 2, -kSmall / 2, 0}, {kSmall, 0, 0}, {0, kSmall, 0}); }

// By how the geometry begins; the first that fits.
const std::vector<std::pair<std::string, Builder>>& builders() {
  static const std::vector<std::pair<std::string, Builder>> table{
      {"parallel identical rectangles",
       [](Built& b, Numbers& n) { b.parallel(n["a"], n["b"], n["c"], {}, n["a"], n["b"]); }},
      {"perpendicular rectangles with a common edge",
       [](Built& b, Numbers& n) { b.corner(n["w"], n["h"], n["l"], 0, 0, n["l"]); }},
      {"perpendicular rectangles, no common edge",
       [](Built& b, Numbers& n) { b.corner(n["Y"], n["Z"], n["X"], n["e"], n["r"], n["X"]); }},
      {"parallel coaxial discs of equal radius", [](Built& b, Numbers& n) { disks(b, n["r"], n["r"], n["h"]); }},
      {"parallel coaxial discs, from r1", [](Built& b, Numbers& n) { disks(b, n["r1"], n["r2"], n["h"]); }},
      {"inside of a cylinder (open ends) to itself",
       [](Built& b, Numbers& n) {
         b.scene.exact(PrimitiveKind::cylinder, {n["r"], n["h"], 0}, b.from);
         b.back = true;
         b.to = b.from;
       }},
      {"inside of the outer of two concentric cylinders of length l to itself",
       [](Built& b, Numbers& n) {
         cylinders(b, n, true);
         b.to = b.from;
       }},
      {"inside of the outer of two concentric cylinders", [](Built& b, Numbers& n) { cylinders(b, n, true); }},
      {"outside of the inner of two concentric cylinders", [](Built& b, Numbers& n) { cylinders(b, n, false); }},
      {"infinitely long parallel plates",
       [](Built& b, Numbers& n) {
         b.parallel(n["w"], 1, n["h"], {0, -kLong / 2, 0}, n["w"], kLong);
       }},
      {"infinitely long perpendicular plates", [](Built& b, Numbers& n) { b.corner(n["w"], n["h"], 1, 0, 0, kLong); }},
      {"infinitely long plates of equal width",
       [](Built& b, Numbers& n) { b.corner(1, 1, 1, 0, 0, kLong, n["alpha"] * kDegree); }},
      {"outer of two concentric spheres to itself",
       [](Built& b, Numbers& n) {
         spheres(b, n, true);
         b.to = b.from;
       }},
      {"outer of two concentric spheres", [](Built& b, Numbers& n) { spheres(b, n, true); }},
      {"inner of two concentric spheres", [](Built& b, Numbers& n) { spheres(b, n, false); }},
      {"element to a parallel disc",
       [](Built& b, Numbers& n) {
         small(b);
         b.scene.exact(PrimitiveKind::disk, {n["r"], 0}, b.to, upside_down({0, 0, n["h"]}));
       }},
      {"element to a parallel rectangle", [](Built& b, Numbers& n) {
         small(b);
         b.rectangle(b.to, {0, 0, n["c"]}, {0, n["b"], 0}, {n["a"], 0, 0});
       }}};
  return table;
}

double share_of(const Row& row, uint64_t seed, bool wrong_side = false) {
  for (const auto& [begins, build] : builders()) {
    if (!row.geometry.starts_with(begins)) continue;
    Built b;
    Numbers numbers = row.number;
    build(b, numbers);
    const bool itself = b.to == b.from;
    const uint32_t to = b.to;
    const bool back = b.back != wrong_side;
    const HeatKit kit(std::move(b.scene), 1);
    EXPECT_EQ(kit.elements->size(), 1u) << row.geometry;
    const ExchangePaths paths = kit.exchange({8, kPaths / 8, seed});
    const uint32_t face = back ? 1 : 0, end = itself ? face : kit.faces->outside_material(to);
    size_t hits = 0;
    for (uint32_t k = face * kPaths; k < (face + 1) * kPaths; ++k) hits += paths.ends[k] == end;
    return static_cast<double>(hits) / kPaths;
  }
  ADD_FAILURE() << "no builder for " << row.geometry;
  return NAN;
}

double allowed(double factor) { return std::fmax(0.003 * factor, 3 * std::sqrt(factor * (1 - factor) / kPaths)); }

TEST(ViewFactors, OfTheCatalogue) {
  double worst = 0, worst_relative = 0;
  int within = 0;
  const std::vector<Row> all = rows();
  for (const Row& row : all) {
    const double share = share_of(row, 1), off = std::fabs(share - row.factor);
    EXPECT_LE(off, allowed(row.factor) + 1e-12)
        << row.geometry << ", " << row.parameters << ": " << share << " of " << row.factor;
    worst = std::fmax(worst, off);
    worst_relative = std::fmax(worst_relative, off / row.factor);
    within += off <= 0.003 * row.factor;
  }
  std::printf("view factors: %zu rows, largest error %.5f, relative %.2f %%, %d within 0.3 %% of the factor\n",
              all.size(), worst, 100 * worst_relative, within);
  EXPECT_GE(all.size(), 57u);
  // Negative control: the other side of a cylinder sees nothing of itself.
  for (const Row& row : all) {
    if (!row.geometry.starts_with("inside of a cylinder")) continue;
    EXPECT_GT(row.factor - share_of(row, 1, true), allowed(row.factor)) << row.parameters;
  }
}

}  // namespace
}  // namespace suite::view_factors_test
