// How far the temperatures of elements are from those of places, told by random walks that know no elements.
//
// Method: a probe is a place and a time; a walk goes back in time from there through the balance linearised about the
// temperatures found (Feynman-Kac; C. Coustet et al., Stardis; J. M. Tregan et al., PLoS ONE 18, 2023): within
// the slab from node to node of its own grid, at a face by one path of infrared, reflected by the true optics, to the
// face where it is absorbed, or it ends in air, sky or what lies behind; on its way it gathers what is absorbed of
// sunlight at its place. Waits are exponential, rates that vary are thinned (P. A. W. Lewis, G. S. Shedler, Nav. Res.
// Logist. Q. 26, 1979), T^4 is linearised with its value, so that a second order in the bias is left out. Two walks a
// probe: the mean of the product of what they differ by is the mean square of the elements' error there, noise apart.
// Every walk counts twice: all that it gathers, which is the temperature; and what its sunlight and paths bring beyond
// what the elements' balances had there, which is what the place has more than its element, with less noise,
// but takes that the balances were solved.
//
// Assumes: as heat_balance.h; conduction straight inward; properties of layers at the mean temperature of their
// elements; sunlight by mirrors as its elements absorb it.
#pragma once
#include "heat/audit_result.h"
#include "heat/path_errors.h"

namespace suite {

struct AuditedScene {
  const Tracer& tracer;
  const Elements& elements;
  const HeatFaces& faces;
  const HeatOptics& optics;
  bool periodic;
  uint64_t seed;
};

// probes > 0. wanted: by face, which are looked at; empty = all. In parallel over probes, the same on any number of
// threads.
HeatAudit audit_heat(const AuditedScene& scene, const SolvedSurfaces& solved, size_t probes,
                     const std::vector<bool>& wanted = {}, const std::function<void(size_t)>& progress = {});

}  // namespace suite
