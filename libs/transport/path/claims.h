// Who brings which light: the claims of techniques, and the one function that reads them.
//
// A technique at a node of a path brings all light of some lights that comes to the node along ways of a certain form;
// with that it claims the light. What continuations of the node find of it by chance is left out. Nodes make the same
// claim that their technique is bound by: it draws nothing beyond it. So owner() gives every light one owner. What it
// leaves to chance is shared with the light samples of the last node by multiple importance sampling (shares.h).
//
//   technique      lights                          form since the node (suffix.h)
//   manifold       small ones and places on lamps  T {T, R}^m, m < RefractedWay::kMostEvents; every scattering and
//   every
//                                                  surface but smooth interfaces claims it anew
//   volume chains  one far small one               S^n T {T, R}^m, 1 <= n <= kMostLinks, flights of `reach` m at most
//                  the sky of the air              S^n T, 0 <= n, likewise, along one of the ways through the interface
// A scattering that such chains cover asks for nothing that they bring, and makes none of its own.
#pragma once
#include <cstddef>
#include <limits>
#include <span>

#include "math/vec.h"
#include "transport/path/suffix.h"

namespace suite {

enum class Technique : uint8_t {
  chance,         // continuations meet the light
  manifold,       // techniques/manifold.h
  volume_chains,  // techniques/volume_chains.h
};

// A light, as far as claims tell lights apart.
struct ClaimedLight {
  enum class Kind : uint8_t {
    small,  // asked for through smooth interfaces (is_refracted())
    sky     // what the air sends along a way out of it
  } kind = Kind::small;
  uint16_t index = 0;  // of Environment::lights
  static constexpr ClaimedLight sky() { return {Kind::sky, 0}; }
};

struct CountRange {
  uint8_t least = 0, most = 0;
  bool has(uint8_t n) const { return least <= n && n <= most; }
};

struct Claim {
  static constexpr uint16_t kAnyLight = 0xffff;
  Technique technique = Technique::chance;
  ClaimedLight::Kind lights = ClaimedLight::Kind::small;
  uint16_t light = kAnyLight;  // only the one of this index
  uint32_t heroes = ~0u;       // a bit for each hero wavelength whose ways are looked for
  CountRange scatterings, interfaces;
  double reach = std::numeric_limits<double>::infinity();  // m, of a flight that a scattering ends

  static constexpr Claim manifold(uint8_t most_interfaces) {
    return {
        .technique = Technique::manifold, .scatterings = {0, Suffix::kCountless}, .interfaces = {1, most_interfaces}};
  }
  static constexpr Claim chains(uint16_t light, uint8_t most_links, uint8_t most_interfaces) {
    return {.technique = Technique::volume_chains,
            .light = light,
            .heroes = 0,
            .scatterings = {1, most_links},
            .interfaces = {1, most_interfaces}};
  }
  static constexpr Claim chains_of_sky(uint8_t most_links) {
    return {.technique = Technique::volume_chains,
            .lights = ClaimedLight::Kind::sky,
            .scatterings = {0, most_links},
            .interfaces = {1, 1}};
  }

  bool is_of(ClaimedLight what) const {
    return lights == what.kind && (light == kAnyLight || light == what.index || what.kind == ClaimedLight::Kind::sky);
  }
  // Whether a way that goes on from there may still be covered.
  bool stands(const Suffix& s) const {
    return s.scatterings <= scatterings.most && s.interfaces <= interfaces.most && !s.mirrored && s.longest_m <= reach;
  }
  bool covers(const Suffix& s) const {
    return stands(s) && s.scatterings >= scatterings.least && s.interfaces >= interfaces.least;
  }
  bool covers(const Suffix& s, ClaimedLight what, size_t hero) const {
    return is_of(what) && (heroes >> hero & 1) != 0 && covers(s);
  }
};

// Directions that a scattering makes its claims for: those nearer to where chains come from than to where the path is
// going anyway. The others are left to its continuations.
struct ClaimCone {
  bool whole = true;  // all directions
  Dir along;          // the path's
  Dir toward;         // the chains', seen from the node
  bool has(Dir in) const { return whole || !(dot(in, along) > dot(in, toward)); }
};

// What chains of a node claim.
class NodeClaims {
 public:
  bool empty() const { return size_ == 0; }
  std::span<const Claim> all() const { return {of_, size_}; }
  std::span<Claim> all() { return {of_, size_}; }
  // The claim on light of this kind; null: none.
  const Claim* of(ClaimedLight::Kind kind) const {
    for (const Claim& c : all())
      if (c.lights == kind) return &c;
    return nullptr;
  }
  // Makes one. The first one's cone and reach are those of all.
  Claim& add(const Claim& claim, const ClaimCone& cone, double reach) {
    if (empty()) cone_ = cone, reach_ = reach;
    Claim& made = of_[size_++] = claim;
    made.reach = reach_;
    return made;
  }
  void add_hero(ClaimedLight::Kind kind, size_t hero) {
    for (Claim& c : std::span(of_, size_))
      if (c.lights == kind) c.heroes |= 1u << hero;
  }
  double reach() const { return reach_; }  // m
  const ClaimCone& cone() const { return cone_; }
  // Whether they are for light that comes to the node from a direction.
  bool are_for(Dir in) const { return cone_.has(in); }

 private:
  static constexpr size_t kMost = 2;  // a light's, the sky's
  Claim of_[kMost];
  size_t size_ = 0;
  ClaimCone cone_;
  double reach_ = 0;
};

// The claims that stand on a path's light, and what it has met since.
class PathClaims {
 public:
  void clear() { size_ = 0, suffix_ = {}; }
  bool empty() const { return size_ == 0; }
  std::span<const Claim> all() const { return {of_, size_}; }
  const Suffix& suffix() const { return suffix_; }
  // What would be its suffix behind a smooth interface.
  Suffix behind_interface(bool reflects) const {
    Suffix s = suffix_;
    s.meet_interface(reflects);
    return s;
  }
  // Whether scatterings that follow are a technique's.
  bool stands(Technique technique) const {
    for (const Claim& c : all())
      if (c.technique == technique && c.stands(suffix_)) return true;
    return false;
  }

  // Flights.
  void scatter(double m) {
    if (suffix_.interfaces > 0) return clear();
    suffix_.scatter(m);
  }
  void pass_boundary(double m) { suffix_.pass_boundary(m); }
  void meet_interface(bool reflects) { suffix_.meet_interface(reflects); }
  // Leaves a surface, or a scattering, towards `in`; made: by its chains, if it asks through interfaces at all.
  void leave_surface(const NodeClaims* made, const Claim& manifold, Dir in) {
    clear();
    claim(made, manifold, in);
  }
  void leave_scattering(const NodeClaims* made, const Claim& manifold, Dir in) {
    if (made && !made->empty()) clear();
    claim(made, manifold, in);
  }
  // The way that the path has taken is none of those that chains of the sky look for.
  void give_up_sky() {
    size_t n = 0;
    for (size_t i = 0; i < size_; ++i)
      if (of_[i].lights != ClaimedLight::Kind::sky) of_[n++] = of_[i];
    size_ = n;
  }

 private:
  static constexpr size_t kMost = 3;  // a light's chains, the sky's, the manifold's
  // Older claims come first in owner().
  void claim(const NodeClaims* made, const Claim& manifold, Dir in) {
    if (size_ > 0 && of_[size_ - 1].technique == Technique::manifold) --size_;
    if (made && made->are_for(in))
      for (const Claim& c : made->all()) of_[size_++] = c;
    of_[size_++] = manifold;
  }

  Claim of_[kMost];
  size_t size_ = 0;
  Suffix suffix_;
};

// Who brings a light that a path meets at the end of a suffix, drawn for a hero wavelength. One owner: the oldest
// claim.
inline Technique owner(std::span<const Claim> claims, const Suffix& suffix, ClaimedLight light, size_t hero) {
  for (const Claim& c : claims)
    if (c.covers(suffix, light, hero)) return c.technique;
  return Technique::chance;
}
inline Technique owner(const PathClaims& path, ClaimedLight light, size_t hero) {
  return owner(path.all(), path.suffix(), light, hero);
}

}  // namespace suite
