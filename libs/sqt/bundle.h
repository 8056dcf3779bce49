// The runtime of the spherical quad-tree: trees over view direction and wavelength plus a finer table of totals,
// decoded and ready to be asked. Immutable, shared by threads.
//
// "Channels" are the wavelengths at which the shape is stored (info().wavelength_um). Weights w are f |cos in| for
// Quantity::bsdf and f itself for phase functions and intensities. All four verbs agree: pdf is the density of what
// sample does (a draw may fail; densities then integrate to less than 1), and E[w / pdf] = total.
//
// Based on: Goodenough & Brown, section IV-D; method "aligned" is described in aligned.h.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sqt/cell.h"
#include "sqt/function.h"
#include "sqt/mueller_table.h"

namespace suite::sqt {

class Bundle {
 public:
  struct View {
    double theta = 0, phi = 0;  // rad, outgoing direction of the slice
  };
  struct Info {
    Function::Info function;           // what was fitted; wavelength_um are the shape channels
    std::string method;                // "paper" or "aligned"
    std::string frame;                 // what the cells divide: "incident", "half", "retro", "forward" (FORMAT.md)
    std::vector<double> magnitude_um;  // wavelengths of the finer table of totals, ascending; at least the channels
    std::vector<View> views;           // one slice each
    int max_order = 0;                 // of the finest leaf
    size_t leaves = 0;                 // over all trees
    Dirac delta = Dirac::none;         // a Dirac lobe beside the cells
    double delta_core = 0;             // half-vector angle within which it stands for a narrow lobe, rad
    std::shared_ptr<const MuellerTable> mueller;  // matrices over m11; null: nothing is known of polarisation
    bool has_delta() const { return delta != Dirac::none; }
  };
  // One leaf of one slice.
  struct Cell {
    CellId id;
    int sheet = 0;     // 0 the first tree of the slice, 1 the second (transmitted side), ...
    double value = 0;  // f at the centre of the cell, 1/sr
    double mass = 0;   // probability that a draw from this slice lands in it
  };
  // A Dirac lobe: all of `total` goes to one direction.
  struct DeltaLobe {
    Dir in;
    double total = 0;  // part of W, dimensionless
  };

  virtual ~Bundle() = default;
  const Info& info() const { return info_; }
  size_t channels() const { return info_.function.wavelength_um.size(); }

  // f(out, in), 1/sr, without cosine, one value per channel. Finite and >= 0 for all unit vectors; 0 below the horizon
  // of hemisphere data and for out.z <= 0 of surfaces seen from a side that has no data.
  virtual void value(Dir out, Dir in, std::span<double> f) const = 0;
  virtual double value(Dir out, Dir in, size_t channel) const = 0;
  // w of one channel, 1/sr.
  double eval(Dir out, Dir in, size_t channel) const {
    const double f = value(out, in, channel);
    return cosine_weighted() ? f * std::fabs(in.z) : f;
  }
  // W: integral of w over `in`, Dirac lobe included (here and in magnitude).
  virtual double total(Dir out, size_t channel) const = 0;
  // W at info().magnitude_um.
  virtual void magnitude(Dir out, std::span<double> W) const = 0;
  // u in [0,1)^2 places the direction in its cell, lobe_u in [0,1) chooses the cell. Never draws the Dirac lobe.
  virtual std::optional<Dir> sample(Dir out, Vec2 u, double lobe_u, size_t channel) const = 0;
  virtual double pdf(Dir out, Dir in, size_t channel) const = 0;
  // The same for every channel at once.
  virtual void pdf(Dir out, Dir in, std::span<double> p) const = 0;
  // The Dirac lobe of a channel, when info().has_delta().
  virtual std::optional<DeltaLobe> delta(Dir out, size_t channel) const = 0;

  bool cosine_weighted() const { return info_.function.quantity == Quantity::bsdf; }

  // For inspection. cells: the leaves of slice `view` and `channel`. incident: the direction of a point (u in [0,1]^2)
  // of a leaf of that slice; it may lie below the horizon, where the leaf is cut.
  virtual std::vector<Cell> cells(size_t view, size_t channel) const = 0;
  virtual Dir incident(size_t view, const Cell& cell, Vec2 u) const = 0;

 protected:
  explicit Bundle(Info info) : info_(std::move(info)) {}
  Info info_;
};

}  // namespace suite::sqt
