// Photon guiding for caustics of glossy surfaces: a density of directions for every place, made from photons
// (gloss_photons.h), by which paths draw a share of their continuations.
//
// Photons are told apart by where they land (a k-d tree); those of a cell stand for all of its places. Each is
// remembered by where it comes from, not by its direction, so that a place in the cell looks at the surface that
// throws the light. What a place draws is one of them, by their flux, and a direction about it by a lobe with a wide
// tail, whose width follows from how close to each other the cell's photons come from. The share of continuations that
// are drawn so follows from how much of the light there is.
//
// Densities are exact for whatever the photons are, so estimates that divide by them are unbiased.
// Based on: H. W. Jensen, "Importance driven path tracing using the photon map", Rendering Techniques 1995; places in
// place of directions after L. Ruppert, S. Herholz, H. P. A. Lensch, "Robust fitting of parallax-aware mixtures for
// path guiding", ACM Trans. Graph. 39(4), 2020; the lobe is the slope distribution of Trowbridge & Reitz (1975).
#pragma once
#include <array>
#include <vector>

#include "transport/gloss_photons.h"

namespace suite {

class GlossGuide {
 public:
  // Photons of one cell, and what they say to its places.
  class Cell {
   public:
    // The part of continuations to be drawn by draw(): 0..kMostShare.
    double share() const { return share_; }
    // From a place to the middle of where photons come from; any length.
    Vec3 middle(Vec3 place) const { return centre_ + middle_ - place; }
    // Density (1/sr) of draw() at a place (m, ENU) of the cell. in: unit.
    float density(Vec3 place, Dir in) const;
    // u: two numbers in [0, 1).
    Dir draw(Vec3 place, Vec2 u) const;

   private:
    friend class GlossGuide;
    void set_lobe(size_t i, Vec3 from, Dir normal, double width, double part);
    static constexpr size_t kMost = 32;
    size_t count_ = 0;
    double share_ = 0;
    Vec3 centre_;  // m, ENU
    Vec3 middle_;  // from there
    Box3 box_;     // of places that it serves
    // Of a photon: where it comes from, from the centre, m; the normal of a plane through there that faces the centre;
    // two axes in it over the widths of the lobe, 1/m; part of the flux, over the area of the lobe (1/m2); and of all
    // flux up to this one.
    struct Triple {
      std::array<float, kMost> x{}, y{}, z{};
      void set(size_t i, Vec3 v) {
        x[i] = static_cast<float>(v.x), y[i] = static_cast<float>(v.y), z[i] = static_cast<float>(v.z);
      }
      Vec3 operator[](size_t i) const { return {double{x[i]}, double{y[i]}, double{z[i]}}; }
    };
    Triple from_, facing_, along_, across_;
    std::array<float, kMost> height_{}, sum_{};
  };
  static constexpr double kMostShare = 0.5;

  explicit GlossGuide(std::vector<GlossPhoton> photons);
  // Null where no photons are near.
  const Cell* at(Vec3 place) const;

 private:
  struct Node {
    int axis = -1;      // -1: a leaf
    double split = 0;   // m, ENU
    uint32_t next = 0;  // the node above the split; the one below stands behind this one. Of leaves the cell
  };
  void build(std::span<GlossPhoton> photons);
  void add_cell(std::span<const GlossPhoton> photons, size_t landed);
  std::vector<Node> nodes_;
  std::vector<Cell> cells_;
};

// What a place makes of the guide.
struct GlossShare {
  const GlossGuide::Cell* cell = nullptr;  // null: no such light is there
  double share = 0;                        // of continuations that are drawn towards it
};

}  // namespace suite
