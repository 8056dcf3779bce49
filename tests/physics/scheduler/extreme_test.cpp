// Every extreme case holds; and each deliberate fault is noticed by at least one of them.
#include <gtest/gtest.h>

#include <bitset>

#include "extreme/case.h"

namespace suite::extreme::extreme_test {
namespace {

using Functions = std::bitset<6>;  // of Numerics, in their order

Functions called;

// The suite's own, which note that they are called.
Numerics noted() {
  static const Numerics own = production();
  return {[](double value, uint64_t n) { return called.set(0), own.mean_of_equal(value, n); },
          [](double angle) { return called.set(1), own.one_minus_cos(angle); },
          [](double wavelength_um, double kelvin) { return called.set(2), own.planck(wavelength_um, kelvin); },
          [](Dir a, Dir b) { return called.set(3), own.angle(a, b); },
          [](const Ray& ray, const Hit& hit) { return called.set(4), own.hit_point(ray, hit); },
          [](const SlabSpec& spec, std::span<const double> kelvin, double dt, double report, double t_end) {
            return called.set(5), own.slab(spec, kelvin, dt, report, t_end);
          }};
}
Functions replaced(const Numerics& by) {
  const Numerics own = production();
  Functions f;
  f[0] = by.mean_of_equal != own.mean_of_equal, f[1] = by.one_minus_cos != own.one_minus_cos;
  f[2] = by.planck != own.planck, f[3] = by.angle != own.angle;
  f[4] = by.hit_point != own.hit_point, f[5] = by.slab != own.slab;
  return f;
}

struct Measured {
  Case c;
  Outcome outcome;
  Functions calls;
};
// All cases with the suite's own numerics, measured once.
const std::vector<Measured>& measured() {
  static const std::vector<Measured> all = [] {
    std::vector<Measured> rows;
    for (Case& c : all_cases()) {
      Measured m{std::move(c), {}, {}};
      called.reset();
      if (m.c.open.empty()) m.outcome = measure(m.c, noted());
      m.calls = called;
      rows.push_back(std::move(m));
    }
    return rows;
  }();
  return all;
}

TEST(Extreme, EveryCaseHolds) {
  for (const auto& [c, o, calls] : measured()) {
    if (!c.open.empty()) continue;
    EXPECT_TRUE(o.held) << c.group << ", " << c.name << ": error " << o.error << " " << c.unit << ", bound " << c.bound;
  }
  EXPECT_GE(measured().size(), 60u);
}

// A case that does not call what a fault replaces cannot notice it, and is not measured again.
TEST(Extreme, EveryFaultIsNoticed) {
  for (const Fault& fault : faults()) {
    const Functions by = replaced(fault.numerics);
    EXPECT_EQ(by.count(), 1u) << fault.name;
    std::string noticed;
    for (const Measured& m : measured()) {
      if (!m.c.open.empty() || (m.calls & by).none()) continue;
      if (!measure(m.c, fault.numerics).held) {
        noticed = m.c.group + ", " + m.c.name;
        break;
      }
    }
    EXPECT_FALSE(noticed.empty()) << fault.name << " went unnoticed";
    std::printf("%-36s noticed by: %s\n", fault.name.c_str(), noticed.c_str());
  }
}

}  // namespace
}  // namespace suite::extreme::extreme_test
