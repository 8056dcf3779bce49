// The aligned method: one adaptive tree per side, shared by all views and channels, over directions in which the lobes
// of all views coincide; smooth log-domain reconstruction; transform-coded.
//
// f(out, in) = s(theta) 2^( blend over views of [ value + slope . (position in the leaf) ] ), in the cell coordinates
// of lobe_map.h. s(theta) makes the integral of f |cos| equal to the total that the data had before reduction. Values
// of a leaf are such that the mean of f over its cell is that of the data, those of a node above the averages of its
// children's, for every view and channel; children are coded as differences from the
// plane through their parent, transformed over views and channels (cosine transforms, or the spectra of the data),
// quantised with a step that shrinks with the weight of the cell in the cosine-weighted error (as its values say, or
// finer as the node states), and coded by prefix codes in contexts (block_code.h).
//
// Based on: Goodenough & Brown, section IV-D-4 (the quad-tree, totals before reduction); S. Rusinkiewicz 1998 (half
// vector); Said & Pearlman 1996 (pyramid with prediction); rate-distortion pruning: Chou, Lookabaugh & Gray, IEEE TIT
// 35, 1989.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "sqt/bundle.h"
#include "sqt/lobe_map.h"
#include "sqt/log_scale.h"
#include "sqt/vectors.h"

namespace suite::sqt {

// What the coder needs to know beforehand; stored by the file format beside the payload.
struct AlignedLayout {
  LobeFrame frame = LobeFrame::half;
  bool half_stored = true;  // bilateral: azimuths 0..pi only
  bool upper_only = true;   // cells of the upper half sphere only
  bool cosine_weighted = true;
  int sheets = 1;             // 2: reflected and transmitted side
  std::vector<double> theta;  // view polar angles, rad, ascending
  size_t phi_count = 1;       // view azimuths per polar angle, uniform from 0
  size_t channels = 0;
  double quality = 0;  // base quantisation step, log2 units; the only knob of the coder
  // Nodes may state a finer step: where averages of logarithms do not show the narrow lobe below.
  bool refined = false;
  // Orthonormal rows over the channels that take the place of the cosine transform, [row][channel], in units of
  // 1/kSpectrumUnit; empty: cosines. Fewer rows than channels: nothing lies across them.
  std::vector<int16_t> spectra;
  static constexpr float kSpectrumUnit = 16384;
  // Of a payload ahead of spectra and trees: reference of the steps, offset and fraction bits of the scale.
  static constexpr size_t kHeadBytes = 3;
  size_t views() const { return theta.size() * phi_count; }
  size_t width() const { return views() * channels; }
};

// Decoded leaves of one sheet, the coarsest divided for sampling (leaf_table.h).
struct AlignedSheet {
  static constexpr size_t kStride = 4;
  LogScale scale;
  std::vector<CellId> leaves;
  std::vector<float> inverse_area;  // 1/sr of one leaf, its mirror image counted in
  size_t stored = 0;                // leaves before the coarsest were divided
  // [leaf][channel][view]{value, slope x, slope y, mass}: numbers of the scale, slopes per cell width; the mass as
  // leaf_table.h codes it. Some room behind.
  UnsetVector<int16_t> plane;
  UnsetVector<uint16_t> mass;  // the same masses, [leaf][padded_row(width)], and some room
};

// Totals over view angle and wavelength, and the scale s of each channel, on a finer grid of view angles.
struct AlignedTotals {
  std::vector<double> theta;  // rad, ascending, from 0
  size_t phi_count = 1;
  std::vector<double> magnitude_um;  // ascending
  std::vector<float> magnitudes;     // [theta][phi][magnitude], without the Dirac lobe
  std::vector<float> log2_scale;     // [theta][phi][channel]
  std::vector<float> delta;          // [theta][phi][channel] total of the Dirac lobe, or empty
  Dirac delta_kind = Dirac::none;
  double delta_core = 0;  // half-vector angle within which it stands for a narrow lobe, rad
};

struct AlignedData {
  Function::Info function;
  AlignedLayout layout;
  std::vector<AlignedSheet> sheets;
  AlignedTotals totals;
  std::shared_ptr<const MuellerTable> mueller;  // null: nothing is known of polarisation
};

// Angles of the totals that go with views (rad, ascending, 0 to less than pi/2): six steps between two views; near the
// horizon, which cuts lobes within their width of it, steps of at most 0.15 of the angle that is left.
std::vector<double> total_angles(const std::vector<double>& views);

// Trees from their payload (encode_sheets of libs/sqt_fit). Error: a payload that is not one (runs past its end, more
// than max_leaves leaves). Of layout.spectra the size counts; the numbers are the payload's.
std::vector<AlignedSheet> decode_sheets(const AlignedLayout& layout, std::span<const std::byte> payload,
                                        size_t max_leaves = size_t{1} << 22);
// Fills magnitudes, log2_scale (and delta, when has_delta); theta, phi_count and magnitude_um must be set.
void decode_totals(std::span<const std::byte> bytes, size_t channels, bool has_delta, AlignedTotals& totals);

// Checks every invariant. Error naming the fault.
std::shared_ptr<const Bundle> make_bundle(AlignedData data);

}  // namespace suite::sqt
