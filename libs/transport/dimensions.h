// Which numbers of a sample stream (math/sampling.h) a path uses for what: one table, so that no two decisions of a
// path ever share a number.
//
// Stratified blocks of four numbers are spent on the first nodes of a path; later nodes, and choices that must not take
// stratification away from others (roulette, the knot), use hashed numbers.
#pragma once
#include <array>
#include <cstdint>

#include "math/sampling.h"

namespace suite::dimensions {

// Ranges of stratified blocks.
struct Blocks {
  uint32_t first, count;
  constexpr uint32_t end() const { return first + count; }
};
inline constexpr uint32_t kNodes = 64;         // nodes of a path with stratified numbers
inline constexpr uint32_t kFlights = 16;       // flights through media with such
inline constexpr uint32_t kOwnLights = 8;      // lights with blocks of their own
inline constexpr uint32_t kPerFlight = 5;      // a flight's own block, two of its scattering, two of lights
inline constexpr Blocks kSensor{0, 1};         // the ray
inline constexpr Blocks kScatter{1, kNodes};   // continuation (two numbers), first light (two)
inline constexpr Blocks kSecond{128, kNodes};  // lobe (the first), second light (the last two)
inline constexpr Blocks kSensorMore{250, 1};   // sensors that need more than four numbers
inline constexpr Blocks kLight{512, kNodes* kOwnLights};
inline constexpr Blocks kFlight{1024, kPerFlight* kFlights};
inline constexpr Blocks kPlace{1120, kFlights};           // places in the air that paths go back to
inline constexpr Blocks kGuided{1136, kNodes};            // guided continuations beside the first ones
inline constexpr uint32_t kPerSide = 2;                   // whether and where to, and the flight with a light
inline constexpr Blocks kSide{1200, kPerSide* kFlights};  // side flights (techniques/side_vertex.h)

inline constexpr uint32_t kPerChain = 3;                      // of one to the sun and one to the sky
inline constexpr Blocks kChain{1232, 2 * kPerChain* kNodes};  // chains of scatterings before a surface

inline constexpr uint32_t kPerBeside = 2;                     // where, and a light
inline constexpr Blocks kBeside{1616, kPerBeside* kFlights};  // scatterings near lamps (techniques/equiangular.h)

constexpr bool disjoint() {
  constexpr Blocks all[] = {kSensor, kScatter, kSecond, kSensorMore, kLight, kFlight,
                            kPlace,  kGuided,  kSide,   kChain,      kBeside};
  for (const Blocks& a : all)
    for (const Blocks& b : all)
      if (&a != &b && a.first < b.end() && b.first < a.end()) return false;
  return true;
}
static_assert(disjoint(), "two uses of the sample stream share blocks");

// Purposes of hashed numbers: kind * kStride + what the kind counts.
inline constexpr uint32_t kStride = 1u << 22;
enum class Hashed : uint32_t {
  choices,
  scatter,
  second,
  light,
  flight = light + 256,
  place = flight + kPerFlight,
  guided,
  side,
  chain = side + kPerSide,
  beside,
  end = beside + kPerBeside
};
static_assert(static_cast<uint32_t>(Hashed::end) < (1u << 10), "kinds of hashed numbers do not fit into 32 bits");
// Of Hashed::choices.
inline constexpr uint32_t kKnot = 1;
constexpr uint32_t roulette(uint32_t event) { return 2 + 16 * (event % (kStride / 16)); }
// Whether the event asks a light, and whether it tries a side flight.
constexpr uint32_t roulette_of_light(uint32_t event) { return roulette(event) + 1; }
constexpr uint32_t roulette_of_side(uint32_t event) { return roulette(event) + 2; }
// Three of the light that a warm surface is asked for, where its emission is polarised.
constexpr uint32_t of_emission(uint32_t event, uint32_t i) { return roulette(event) + 8 + i; }
static_assert(roulette(0) != kKnot && roulette(1) - roulette(0) == 16 && roulette(kStride / 16 - 1) < kStride);

inline std::array<double, 4> hashed(const SampleStream& stream, uint32_t sample, Hashed kind, uint32_t more,
                                    uint32_t n) {
  const uint32_t from = (static_cast<uint32_t>(kind) + more) * kStride + 4 * (n % (kStride / 4));
  return {stream.hashed(sample, from), stream.hashed(sample, from + 1), stream.hashed(sample, from + 2),
          stream.hashed(sample, from + 3)};
}

// Whether a path survives an event. Numbers of events that are kSpan apart differ: who has survived the first would
// survive the second for certain.
inline double of_roulette(const SampleStream& stream, uint32_t sample, uint32_t event) {
  constexpr uint32_t kSpan = kStride / 16;
  if (event < kSpan) return stream.hashed(sample, roulette(event));
  return SampleStream(hash_of(stream.key(), 0x726f756c65747465ull, event / kSpan), 0).hashed(sample, roulette(event));
}

// What a node needs numbers for. own(i): of the i-th light that has a block of its own.
struct Use {
  uint32_t which;
};
inline constexpr Use kOfScatter{0}, kOfSecond{1};
constexpr Use own_light(uint32_t i) { return {2 + i}; }

// The stratified block of the n-th surface of a path; kHashed where it has none.
inline constexpr uint32_t kHashed = UINT32_MAX;
constexpr uint32_t block_at_surface(uint32_t n, Use use) {
  const uint32_t own = use.which - 2;
  if (n >= kNodes || (use.which >= 2 && own >= kOwnLights)) return kHashed;
  return n + (use.which == 0 ? kScatter.first : use.which == 1 ? kSecond.first : kLight.first + own * kNodes);
}
// The same of the scattering that ends the n-th flight.
constexpr uint32_t block_at_scattering(uint32_t n, Use use) {
  return n < kFlights && use.which + 1 < kPerFlight ? kFlight.first + kPerFlight * n + 1 + use.which : kHashed;
}

// Numbers of the n-th surface of a path.
inline std::array<double, 4> at_surface(const SampleStream& stream, uint32_t sample, uint32_t n, Use use) {
  if (const uint32_t block = block_at_surface(n, use); block != kHashed) return stream.draw(sample, block);
  const uint32_t own = use.which - 2;
  if (use.which < 2) return hashed(stream, sample, use.which == 0 ? Hashed::scatter : Hashed::second, 0, n);
  return hashed(stream, sample, Hashed::light, own % 128, n);  // the other half is that of scatterings
}

// Numbers of the n-th flight, and of the scattering that ends it.
inline std::array<double, 4> of_flight(const SampleStream& stream, uint32_t sample, uint32_t n) {
  if (n < kFlights) return stream.draw(sample, kFlight.first + kPerFlight * n);
  return hashed(stream, sample, Hashed::flight, 0, n);
}
// Numbers for going back to a place on the n-th flight: whether it is that flight, where on it, and whether at all.
inline std::array<double, 4> of_place(const SampleStream& stream, uint32_t sample, uint32_t n) {
  if (n < kFlights) return stream.draw(sample, kPlace.first + n);
  return hashed(stream, sample, Hashed::place, 0, n);
}
// Whether it is that flight, when the path has been back before, so many times.
inline double of_place_again(const SampleStream& stream, uint32_t sample, uint32_t n, uint32_t times) {
  return SampleStream(hash_of(stream.key(), 0x616761696eull, times), 0).hashed(sample, n);
}
// Numbers of the guided continuation from the n-th surface of a path: where to, and by which scatterer.
inline std::array<double, 4> of_guided(const SampleStream& stream, uint32_t sample, uint32_t n) {
  if (n < kNodes) return stream.draw(sample, kGuided.first + n);
  return hashed(stream, sample, Hashed::guided, 0, n);
}
// Numbers of the chain to the sun or the sky before the n-th surface of a path, of which the first sets are stratified.
inline constexpr uint32_t kMostPerChain = 64;
// Its sets: where the link comes from before which k others stand on the light's side, with the number of links in the
// first; at what share of its way link i stands, seen from the surface; and whence the sky's light comes. most: links.
inline constexpr uint32_t kOfChainsSky = 2;
constexpr uint32_t of_link(size_t k, bool sky) { return k == 0 ? 0 : static_cast<uint32_t>(k) + (sky ? 2 : 1); }
constexpr uint32_t of_link_place(size_t i, size_t most, bool sky) {
  return i == 0 ? 1 : static_cast<uint32_t>(most + i) + (sky ? 1 : 0);
}
inline std::array<double, 4> of_chain(const SampleStream& stream, uint32_t sample, uint32_t n, bool sky,
                                      uint32_t which) {
  const uint32_t chain = 2 * n + (sky ? 1 : 0);
  if (n < kNodes && which < kPerChain) return stream.draw(sample, kChain.first + kPerChain * chain + which);
  return hashed(stream, sample, Hashed::chain, 0, chain * kMostPerChain + which);
}
// Numbers of the side flight from the scattering that ends the n-th flight. First: where to (two), by which scatterer,
// whether at all; second: the flight (two), a light's direction (two).
inline std::array<double, 4> of_side(const SampleStream& stream, uint32_t sample, uint32_t n, uint32_t second) {
  if (n < kFlights) return stream.draw(sample, kSide.first + kPerSide * n + second);
  return hashed(stream, sample, Hashed::side, second, n);
}
// Numbers of the scattering near a lamp on the n-th flight. First: which lamp, where; second: a light's.
inline std::array<double, 4> of_beside(const SampleStream& stream, uint32_t sample, uint32_t n, uint32_t second) {
  if (n < kFlights) return stream.draw(sample, kBeside.first + kPerBeside * n + second);
  return hashed(stream, sample, Hashed::beside, second, n);
}
inline std::array<double, 4> at_scattering(const SampleStream& stream, uint32_t sample, uint32_t n, Use use) {
  if (const uint32_t block = block_at_scattering(n, use); block != kHashed) return stream.draw(sample, block);
  if (use.which + 1 >= kPerFlight)  // apart from those of surfaces
    return hashed(stream, sample, Hashed::light, 128 + use.which % 128, n);
  return hashed(stream, sample, Hashed::flight, 1 + use.which, n);
}

}  // namespace suite::dimensions
