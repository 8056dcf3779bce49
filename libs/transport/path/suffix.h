// What a path has met since the last node that claimed light (claims.h): the suffix of its word of events.
//
// Claims know of three events: scattered in a medium (S), passed on (T) and reflected (R) by a smooth interface. All
// claims cover words of the form S^n T {T, R}^m, so that counts say which word it is. Any other event ends claims.
#pragma once
#include <algorithm>
#include <cstdint>

namespace suite {

struct Suffix {
  static constexpr uint8_t kCountless = 0xff;  // counts go no further
  uint8_t scatterings = 0;                     // before the first interface
  uint8_t interfaces = 0;                      // smooth ones, since the last scattering
  bool mirrored = false;                       // the first of them reflected
  double longest_m = 0;                        // of the flights that scatterings have ended
  double flown_m = 0;                          // of the flight under way, up to the last boundary that bends nothing

  // A flight of m metres ends in a scattering;
  void scatter(double m) {
    count(scatterings);
    longest_m = std::max(longest_m, flown_m + m);
    flown_m = 0;
  }
  // a stretch of m metres ends at a boundary that the flight goes straight through;
  void pass_boundary(double m) { flown_m += m; }
  // a smooth interface passes the path on, or reflects it.
  void meet_interface(bool reflects) {
    if (interfaces == 0) mirrored = reflects;
    count(interfaces);
    flown_m = 0;
  }

 private:
  static void count(uint8_t& n) { n = n < kCountless ? static_cast<uint8_t>(n + 1) : n; }
};

}  // namespace suite
