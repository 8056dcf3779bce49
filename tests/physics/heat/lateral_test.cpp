// Conduction along the surface between elements: fins, a step that spreads, stiff extremes, energy.
#include "heat/lateral.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "support/heated_scene_kit.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::lateral_test {
namespace {

using namespace test;

constexpr double kCopper = 400;  // W/(m K)

TemperatureSpec sheet(double thickness, double conductivity, double film) {
  return heat({{"thickness_m", thickness},
               {"density_kg_m3", 8900},
               {"specific_heat_j_kg_k", 385},
               {"conductivity_w_m_k", conductivity},
               {"still_w_m2_k", film}},
              {{"convection", "constant"}});
}

// A rectangle of squares, each of two triangles, from (0, 0) to (a, b).
Mesh squares(size_t columns, size_t rows, double a, double b, uint32_t material) {
  std::vector<Vec3> corners;
  std::vector<uint32_t> triangles;
  for (size_t j = 0; j <= rows; ++j)
    for (size_t i = 0; i <= columns; ++i)
      corners.push_back({a * static_cast<double>(i) / static_cast<double>(columns),
                         b * static_cast<double>(j) / static_cast<double>(rows), 0});
  for (size_t j = 0; j < rows; ++j)
    for (size_t i = 0; i < columns; ++i) {
      const auto at = [&](size_t di, size_t dj) { return static_cast<uint32_t>((j + dj) * (columns + 1) + i + di); };
      for (const uint32_t v : {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)}) triangles.push_back(v);
    }
  return mesh_of(corners, std::move(triangles), material);
}

// Elements that radiate nothing and are warmed at one end of the x axis, in air of 300 K: what they are in the end.
struct Fin {
  static constexpr double kLength = 0.2, kWidth = 0.01, kThick = 1e-3, kFilm = 12, kPower = 2;  // m, W/(m2 K), W
  HeatKit kit;
  LateralConduction lateral;
  explicit Fin(HeatedScene s, size_t elements) : kit(std::move(s), elements) {
    lateral = lateral_conduction(*kit.elements, kit.optics);
  }
  static double exact(double x) {
    const double m = std::sqrt(kFilm / (kCopper * kThick));
    return 300 + kPower / (kWidth * kCopper * kThick * m) * std::cosh(m * (kLength - x)) / std::sinh(m * kLength);
  }
  // Largest difference, K, of means over columns of `pitch` m: triangles that are halves of a rectangle have nearly one
  // temperature, that of its middle. Every element has what its part of a heater at the end, `heated` m long, gives.
  double worst(double heated, double pitch, bool periodic = true) const {
    const Elements& elements = *kit.elements;
    ExchangeMatrix matrix(kit.faces->size(), 1);
    const ExchangeMatrix::Entry sky{static_cast<uint32_t>(kit.faces->size()), 1};
    for (size_t f = 0; f < kit.faces->size(); ++f) matrix.add_row({&sky, 1});
    const std::vector<double> dark(kit.faces->size(), 0);
    CoupledSurfaces surfaces(surface_groups(elements, *kit.faces, kit.optics, dark), matrix, lateral.neighbours);
    surfaces.start(300);
    SurfaceLoads loads = still_exchange(kit, {black(300)}, {0, 86400}, 24);
    double warm = 0;
    for (size_t e = 0; e < elements.size(); ++e) warm += elements[e].centre.x < heated ? elements[e].area : 0;
    for (size_t e = 0; e < elements.size(); ++e)
      loads.source.push_back(elements[e].centre.x < heated ? kPower / warm : 0);
    SurfaceOptions options;
    options.periodic = periodic;
    const SurfaceHistory h = surfaces.solve(loads, options);
    std::map<int, std::array<double, 2>> columns;
    for (size_t e = 0; e < elements.size(); ++e) {
      auto& [area, sum] = columns[static_cast<int>(elements[e].centre.x / pitch)];
      area += elements[e].area, sum += elements[e].area * h.kelvin_at(e, 24);
    }
    double off = 0;
    for (const auto& [number, column] : columns)
      if (const double x = (number + 0.5) * pitch; x > 2 * heated)
        off = std::fmax(off, std::fabs(column[1] / column[0] - exact(x)));
    return off;
  }
};

// A fin warmed at one end (H. S. Carslaw, J. C. Jaeger, Conduction of heat in solids, 2nd edition, 1959, section 4.5):
// T - air = q cosh(m (L - x)) / (k d m sinh(m L)) with m2 = h / (k d), here 34 K at the warm end and 16 K at the other.
TEST(Lateral, FinHasItsProfile) {
  HeatedScene plane;
  plane.plane(Fin::kLength, Fin::kWidth, plane.heated(0, sheet(Fin::kThick, kCopper, Fin::kFilm)),
              shifted({Fin::kLength / 2, Fin::kWidth / 2, 0}));
  Fin on_plane(std::move(plane), 80);
  HeatedScene mesh;
  const uint32_t metal = mesh.heated(0, sheet(Fin::kThick, kCopper, Fin::kFilm));
  mesh.mesh(squares(80, 4, Fin::kLength, Fin::kWidth, metal));
  const Fin on_mesh(std::move(mesh), 640);
  HeatedScene coarse;
  const uint32_t same = coarse.heated(0, sheet(Fin::kThick, kCopper, Fin::kFilm));
  coarse.mesh(squares(1, 1, Fin::kLength, Fin::kWidth, same));
  const Fin cut(std::move(coarse), 800);
  const double a = on_plane.worst(0.006, 0.005), b = on_mesh.worst(0.003, 0.0025), c = cut.worst(0.01, 0.01);
  std::printf("fin of %.1f to %.1f K: plane %.4f K (%zu elements), mesh %.4f K (%zu), two cut triangles %.3f K (%zu)\n",
              Fin::exact(0), Fin::exact(Fin::kLength), a, on_plane.kit.elements->size(), b,
              on_mesh.kit.elements->size(), c, cut.kit.elements->size());
  EXPECT_LT(a, 0.01);
  EXPECT_LT(b, 0.1);
  EXPECT_LT(c, 0.1);
  EXPECT_NEAR(on_plane.worst(0.006, 0.005, false), a, 1e-3);  // from the state of the first day, and on
  on_plane.lateral = {};
  EXPECT_GT(on_plane.worst(0.006, 0.005), 10);
}

// A linear field on a surface carries what it should in every direction: 1/2 sum of ratio (difference)^2 is the area,
// but for half a cell at the rims.
TEST(Lateral, ContactsCarryLinearFields) {
  HeatedScene s;
  const uint32_t m = s.heated(0.9, sheet(1e-3, kCopper, 10));
  s.mesh(squares(40, 40, 1, 1, m));
  const HeatKit one_each(HeatedScene(s), 3200);
  const HeatKit patches(std::move(s), 200);
  HeatedScene p;
  p.plane(1, 1, p.heated(0.9, sheet(1e-3, kCopper, 10)));
  const HeatKit grid(std::move(p), 1600);
  const auto energy = [](const HeatKit& kit, Vec3 g) {
    double sum = 0;
    for (const ElementContact& c : kit.elements->contacts()) {
      const double d = dot((*kit.elements)[c.a].centre - (*kit.elements)[c.b].centre, g);
      sum += c.ratio * d * d;
    }
    return sum;
  };
  for (const Vec3 g : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) EXPECT_NEAR(energy(grid, g), 1 - 1.0 / 40, 1e-4) << g.x;
  for (const Vec3 g : {normalized(Vec3{1, 1, 0}), normalized(Vec3{1, -1, 0})})
    EXPECT_NEAR(energy(grid, g), 1 - 1.0 / 40, 1e-4) << g.y;
  for (const Vec3 g : {Vec3{1, 0, 0}, Vec3{0, 1, 0}}) EXPECT_NEAR(energy(patches, g), 1, 0.15) << g.x;
  EXPECT_EQ(one_each.elements->contacts().size(), 40u * 40 + 2 * 40 * 39);
}

// Closed bodies go on around seams and edges: every cell has as many sides as a sheet's away from its rim.
TEST(Lateral, FacesGoOnAcrossTheirBorders) {
  HeatedScene s;
  const uint32_t m = s.heated(0.9, sheet(1e-3, kCopper, 10));
  s.exact(PrimitiveKind::box, {0, 0, 0, 1, 1, 1}, m);
  const HeatKit box(std::move(s), 24);  // 2 x 2 a face
  ASSERT_EQ(box.elements->size(), 24u);
  const std::vector<ElementContact> contacts = box.elements->contacts();
  EXPECT_EQ(contacts.size(), 48u);
  for (const ElementContact& c : contacts) EXPECT_NEAR(c.ratio, 1, 1e-9);
  HeatedScene t;
  t.exact(PrimitiveKind::cylinder, {0.5, 1, 1}, t.heated(0.9, sheet(1e-3, kCopper, 10)));
  const HeatKit pipe(std::move(t), 64);
  // All around at one height, none is the first: sums of ratios are the same for all of a row.
  std::vector<double> sums(pipe.elements->size(), 0);
  for (const ElementContact& c : pipe.elements->contacts()) sums[c.a] += c.ratio, sums[c.b] += c.ratio;
  for (size_t e = 0; e < sums.size(); ++e)
    for (size_t f = 0; f < e; ++f)
      if (std::fabs((*pipe.elements)[e].centre.z - (*pipe.elements)[f].centre.z) < 0.05 &&
          std::fabs((*pipe.elements)[e].normal.z) < 0.1 && std::fabs((*pipe.elements)[f].normal.z) < 0.1) {
        EXPECT_NEAR(sums[e], sums[f], 1e-3 * sums[e]);
      }
}

// A row of elements of `size` m.
std::shared_ptr<const SlabNeighbours> row(size_t n, double size, double width) {
  std::vector<SlabNeighbours::Contact> contacts;
  for (uint32_t e = 0; e + 1 < n; ++e) contacts.push_back({e, e + 1, width / size});
  return std::make_shared<const SlabNeighbours>(contacts, std::vector<double>(n, size * width));
}
const BatchLoads kNothing = [](double, double, const SlabBatch&, FaceLines&, FaceLines&) {};

double heat_of(const SlabBatch& batch) {
  double sum = 0;
  for (size_t e = 0; e < batch.elements(); ++e)
    for (size_t i = 0; i < batch.nodes(); ++i) sum += batch.grid().heat[0][i] * batch.kelvin(e, i);
  return sum;
}

// A step of temperature spreads as (T1 + T2) / 2 + (T1 - T2) / 2 erf(x / sqrt(4 a t)), a = k / (rho c).
TEST(Lateral, StepSpreads) {
  constexpr size_t kElements = 200;
  constexpr double kSize = 5e-3, kTime = 60;
  SlabBatch batch({uniform(2e-3, 8900, 385, kCopper)}, kElements, {60, false, row(kElements, kSize, 0.1)});
  batch.start(0, 300);
  for (size_t e = kElements / 2; e < kElements; ++e)
    for (size_t i = 0; i < batch.nodes(); ++i) batch.set_kelvin(e, i, 400);
  const double before = heat_of(batch);
  for (int k = 0; k < 240; ++k) batch.step(kTime / 240, kNothing);
  double worst = 0;
  for (size_t e = 0; e < kElements; ++e) {
    const double x = (static_cast<double>(e) + 0.5 - kElements / 2.0) * kSize;
    const double exact = 350 + 50 * std::erf(x / std::sqrt(4 * kCopper / (8900 * 385) * kTime));
    worst = std::fmax(worst, std::fabs(batch.top(e) - exact));
  }
  std::printf("step: %.4f K of 100, energy %+.1e of itself\n", worst, heat_of(batch) / before - 1);
  EXPECT_LT(worst, 0.05);
  EXPECT_NEAR(heat_of(batch) / before, 1, 1e-9);
}

// Copper of 1 mm in steps of ten minutes, which explicit steps would have to be 40 000 times shorter for: no element
// leaves the range of the begin, energy stays, and the same with properties that depend on temperature.
TEST(Lateral, StiffestStaysWithinItsRange) {
  constexpr size_t kElements = 333;
  for (const bool constant : {true, false}) {
    SlabLayer copper = uniform(1e-3, 8900, 385, kCopper);
    if (!constant) copper.conductivity[1] = -0.06;
    SlabBatch batch({copper}, kElements, {60, false, row(kElements, 1e-3, 1e-3)});
    batch.start(0, 300);
    for (size_t i = 0; i < batch.nodes(); ++i) batch.set_kelvin(7, i, 1000), batch.set_kelvin(200, i, 100);
    const double before = heat_of(batch);
    double low = 1e9, high = 0;
    for (int k = 0; k < 30; ++k) {
      batch.step(600, kNothing);
      if (k < 3) continue;
      for (size_t e = 0; e < kElements; ++e) low = std::fmin(low, batch.top(e)), high = std::fmax(high, batch.top(e));
    }
    std::printf("stiff: %.3f to %.3f K after three steps, energy %+.1e\n", low, high, heat_of(batch) / before - 1);
    EXPECT_GT(low, 295);
    EXPECT_LT(high, 315);
    EXPECT_NEAR(heat_of(batch) / before, 1, 1e-9);
    EXPECT_NEAR(batch.top(0), batch.top(kElements - 1), 0.2);
  }
}

// The day that repeats is that at which many days arrive, where a sunlit half warms a shaded one; to the last bit on
// any number of threads.
TEST(Lateral, RepeatsAsManyDaysDo) {
  constexpr size_t kElements = 40;
  const Day day;
  const BatchLoads loads = [&](double begin, double end, const SlabBatch& batch, FaceLines& top, FaceLines& bottom) {
    day.loads()(begin, end, batch, top, bottom);
    for (size_t e = 0; e < kElements / 2; ++e) {
      top.constant[e] = {7.6 * 288, 7.6 * 288};
      top.linear[e] = {7.6, 7.6}, top.quartic[e] = 0;
    }
  };
  const std::vector<double> steps(144, 600.0);
  const auto made = [&] {
    SlabBatch batch({uniform(3e-3, 2700, 900, 200), uniform(0.1, 30, 1000, 0.04)}, kElements,
                    {60, false, row(kElements, 0.02, 0.5)});
    batch.start(0, 290);
    return batch;
  };
  SlabBatch many = made(), repeats = made(), again = made();
  for (int k = 0; k < 6; ++k)
    for (size_t s = 0; s < steps.size(); ++s) {
      if (s == 0) many.restart(0);
      many.step(steps[s], loads);
    }
  const PeriodicResult found = find_periodic(repeats, 0, steps, loads);
  set_threads(3);
  find_periodic(again, 0, steps, loads);
  set_threads(0);
  double worst = 0, differs = 0;
  for (size_t e = 0; e < kElements; ++e) {
    worst = std::fmax(worst, std::fabs(many.top(e) - repeats.top(e)));
    differs += again.top(e) != repeats.top(e);
  }
  std::printf("repeats: %.5f K off many days, %d periods\n", worst, found.sweeps);
  EXPECT_LT(worst, 2e-3);
  EXPECT_EQ(differs, 0);
}

// What does not conduct is told, and what is left out.
TEST(Lateral, IsTold) {
  HeatedScene s;
  TemperatureSpec thick = sheet(2e-3, kCopper, 10);
  const uint32_t a = s.heated(0.1, sheet(1e-3, kCopper, 10)), b = s.heated(0.9, sheet(1e-3, kCopper, 10)),
                 c = s.heated(0.9, thick);
  Mesh m = squares(6, 2, 0.6, 0.2, a);
  m.parts = {{"a", 0, 8, a}, {"b", 8, 8, b}, {"c", 16, 8, c}};
  s.mesh(m);
  const HeatKit kit(std::move(s), 24);
  const LateralConduction lateral = lateral_conduction(*kit.elements, kit.optics);
  EXPECT_GT(lateral.apart, 0u);
  EXPECT_NE(apart_note(lateral).find("nothing conducts between them"), std::string::npos);
  size_t across = 0;  // other optics, the same layers
  for (const auto& contact : lateral.neighbours.contacts)
    across += (*kit.elements)[contact.a].material != (*kit.elements)[contact.b].material;
  EXPECT_GT(across, 0u);
  HeatSpec spec;
  spec.paths = 16;
  WeatherLoads loads = still_loads({500, 0, black(280), 300, 1}, spec.span = {0, 86400}, 144);
  const auto notes = [&](bool with) {
    spec.lateral = with;
    std::string all;
    const HeatResult result = kit.solve(loads, spec);
    for (const std::string& note : result.notes) all += note + "\n";
    EXPECT_LT(std::fabs(result.balance.residual()), 1e-3 * result.balance.sunlight) << with;
    return all;
  };
  const std::string without = notes(false), with = notes(true);
  EXPECT_NE(without.find("which is left out: about"), std::string::npos) << without;
  EXPECT_EQ(with.find("which is left out: about"), std::string::npos) << with;
  EXPECT_NE(with.find("nothing conducts between them"), std::string::npos) << with;
  EXPECT_NE(message_of([&] {
              SurfaceNeighbours wrong;
              for (uint32_t e = 0; e < kit.elements->size(); ++e) {
                wrong.areas.push_back(1);
                if ((*kit.elements)[e].material == c) wrong.contacts.push_back({0, e, 1});
              }
              surface_parts(surface_groups(*kit.elements, *kit.faces, kit.optics, std::vector<double>(24, 0.9)),
                            kit.faces->size(), wrong);
            }).find("other layers"),
            std::string::npos);
}

}  // namespace
}  // namespace suite::lateral_test
