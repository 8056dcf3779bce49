// MIS weights (multiple importance sampling) of a path's contributions, and Russian roulette, which ends paths by
// chance. Each of these decisions is made here only.
// Directions are drawn from the shapes at one of the state's hero wavelengths (knots); every other one could have drawn
// the same path, and the one-sample balance heuristic (Veach & Guibas 1995; Wilkie et al. 2014) divides by the mean of
// all their densities. With P_k the probability of knot k, r_k the density of the path so far under knot k relative to
// the knot that drew it, A = sum P_k r_k, a contribution carries the factor 1 / A. After every event r and the
// throughput are divided by A, so that A = 1 where the next one begins. Explicit samples of a source with density p_s
// and continuations that meet it by chance share the same heuristic:
//   explicit:   1 / (p_s + sum P_k r_k p_k)        by chance:   1 / (A' + p_s / p_h),  A' after the last event.
// Samples of the Sun's and the Moon's disk hardly vary by themselves, while a lobe a few times as wide as the disk
// meets it rarely: what the rare continuation may bring is made small by the power heuristic (exponent 2; Veach &
// Guibas 1995). With b = p_s, a = sum P_k r_k p_k; B = p_s / p_h:
//   explicit:   b / (a^2 + b^2)                      by chance:   A' / (A'^2 + B^2).
// Skies and lamps stay with the balance heuristic, which is the better one for densities that are alike.
//
// Several samples of one light at one node are strata of one choice: each stands for 1 / draws of it, so the density
// p_s above is draws times that of one draw.
#pragma once
#include <algorithm>
#include <cstdint>

namespace suite {

// What a contribution is divided by that a path got in one of two ways, an explicit sample of a source or a
// continuation that met it: own is the density of the way it went, other that of the other one. disk:
// LightNature::disk.
inline double shared_density(double own, double other, bool disk) {
  return disk ? own + other * (other / own) : own + other;
}

// Russian roulette: the probability with which a path survives an event.
// events: scattering events so far, this one included; brightness: throughput, the largest over the knots. Paths that
// still carry a quarter of their light play no roulette: as a rule to end them earlier saves less time than it makes
// noise (work to an error, with a quarter : with all of it: leaves that transmit 0.78 and a cloud 0.56, scenes of
// scripts/compare_peers; a slab of a medium 0.90, plume 1.01, map_gallery, night_street 1.0; a forest of darker disks
// 1.16, scenes of scripts/compare_binaries). Paths that lose nothing (closed boxes of perfect mirrors, deep matter of
// albedo 1) must end, too: from kEndless events on one in n of them does at event n, one in kLast of the later ones.
// So n events are reached by kEndless / n of them, each with n / kEndless of its light. An even chance would leave
// weights that grow exponentially: the same mean, but from paths too rare to occur. In a half space of albedo 1, whose
// paths fall off as n^-1/2, a thousandth at every event took 1.5 % from its reflectance.
inline double survival(double brightness, uint64_t events, int roulette_after) {
  constexpr double kLeast = 0.05, kCarries = 0.25;
  constexpr uint64_t kEndless = 10000, kLast = 1000000;
  if (events <= static_cast<uint64_t>(roulette_after)) return 1;
  const double most = events > kEndless ? 1 - 1.0 / static_cast<double>(std::min(events, kLast)) : 1;
  return std::clamp(brightness / kCarries, kLeast, most);
}

}  // namespace suite
