#include <algorithm>
#include <cmath>

#include "air/phase_grid.h"
#include "base/files.h"
#include "base/text_lines.h"
#include "formats/particles/particles.h"
#include "math/mueller.h"
#include "math/vec.h"

namespace suite {

namespace {

constexpr size_t kMostWavelengths = 10000, kMostRows = 2'000'000;
constexpr double kAllowed = 0.01, kReported = 1e-5;  // off from 1
constexpr double kClosest = 1e-4;                    // degrees between angles

bool names_columns(const TextLines& lines) {
  const char c = lines.word(0)[0];
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// A block's columns by name, and its rows.
struct Block {
  std::vector<std::string> columns;
  Where where;
  std::vector<double> values;  // row by row
  std::vector<int> lines;      // of the rows

  size_t rows() const { return lines.size(); }
  Where place(size_t row) const { return {where.file, lines[row], 1, {}, -1}; }
  std::optional<size_t> column(std::string_view name) const {
    const auto at = std::find(columns.begin(), columns.end(), name);
    if (at == columns.end()) return std::nullopt;
    return static_cast<size_t>(at - columns.begin());
  }
  double value(size_t row, std::string_view name) const { return values[row * columns.size() + *column(name)]; }
  bool has(std::string_view name) const { return column(name).has_value(); }
};

// The numbers that a column may hold.
struct ColumnKind {
  const char* name;
  double least, most;
};
constexpr ColumnKind kColumns[] = {{"wavelength_um", 0.1, 1000},
                                   {"extinction_relative", 0, 1e6},
                                   {"extinction_m2_g", 0, 1e6},
                                   {"albedo", 0, 1},
                                   {"asymmetry", -0.99, 0.99},
                                   {"asymmetry_2", -0.99, 0.99},
                                   {"share_2", 0, 1},
                                   {"angle_deg", 0, 180},
                                   {"phase_per_sr", 0, 1e12},
                                   {"phase_relative", 0, 1e12},
                                   {"order", 0, 1e5},
                                   {"moment", -1.1, 1.1},
                                   {"p12", -1, 1},
                                   {"p22", -1, 1},
                                   {"p33", -1, 1},
                                   {"p34", -1, 1},
                                   {"p44", -1, 1}};
// Of the matrix over P11, in the order of these columns.
constexpr const char* kElements[] = {"p12", "p22", "p33", "p34", "p44"};
constexpr double PlaneBlocks::*kPlaces[] = {&PlaneBlocks::b, &PlaneBlocks::a2, &PlaneBlocks::c, &PlaneBlocks::d,
                                            &PlaneBlocks::c2};

const ColumnKind& kind_of(std::string_view name) {
  return *std::find_if(std::begin(kColumns), std::end(kColumns), [&](const ColumnKind& k) { return name == k.name; });
}

Block block_of(const TextLines& lines) {
  Block block;
  block.where = lines.where();
  for (size_t i = 0; i < lines.words(); ++i) {
    const std::string name(lines.word(i));
    if (std::none_of(std::begin(kColumns), std::end(kColumns), [&](const ColumnKind& k) { return name == k.name; })) {
      std::vector<std::string> known;
      for (const ColumnKind& k : kColumns) known.emplace_back(k.name);
      throw lines.error(i, "unknown column '" + name + "'", name_hint(name, known));
    }
    if (block.has(name)) throw lines.error(i, "a second column '" + name + "'");
    block.columns.push_back(name);
  }
  return block;
}

std::vector<Block> blocks_of(std::string_view text, const std::string& file) {
  TextLines lines(text, file, true);
  std::vector<Block> blocks;
  while (lines.next()) {
    if (names_columns(lines)) {
      if (blocks.size() == 2) throw lines.error(0, "a third block", "one of extinction, and one of phase functions");
      blocks.push_back(block_of(lines));
      continue;
    }
    if (blocks.empty()) throw lines.error(0, "a row before any names of columns", "wavelength_um, ...");
    Block& block = blocks.back();
    if (lines.words() != block.columns.size())
      throw lines.error(0,
                        strf("a row of %zu numbers, the block has %zu columns", lines.words(), block.columns.size()));
    if (block.rows() == kMostRows) throw lines.error(0, strf("more than %zu rows", kMostRows));
    for (size_t i = 0; i < lines.words(); ++i) {
      const ColumnKind& kind = kind_of(block.columns[i]);
      block.values.push_back(lines.number_in(i, kind.name, kind.least, kind.most));
    }
    block.lines.push_back(lines.where().line);
  }
  if (blocks.empty()) throw lines.error_at_end("holds no particles", "wavelength_um, extinction_relative, albedo, ...");
  return blocks;
}

// What should be 1: refused, or put right and told, the worst of them once.
class Ones {
 public:
  Ones(const char* what, const char* hint) : what_(what), hint_(hint) {}
  void take(double value, double wavelength_um, const Where& where) {
    if (!(std::fabs(value - 1) <= kAllowed))
      throw Error(where, strf("%s at %g um is %g, not 1", what_, wavelength_um, value), hint_);
    if (std::fabs(value - 1) > std::fabs(worst_ - 1)) worst_ = value, at_ = wavelength_um;
  }
  void add_notes(std::vector<std::string>& notes) const {
    if (std::fabs(worst_ - 1) > kReported)
      notes.push_back(strf("%s was made 1; it was %.5f at %g um", what_, worst_, at_));
  }

 private:
  const char *what_, *hint_;
  double worst_ = 1, at_ = 0;
};

void read_bulk(const Block& block, ReadParticles& out) {
  ParticleData& data = out.data;
  const bool relative = block.has("extinction_relative");
  if (!block.has("wavelength_um") || !block.has("albedo") || relative == block.has("extinction_m2_g"))
    throw Error(block.where, "the first block is not of extinction and albedo",
                "wavelength_um, extinction_relative (or extinction_m2_g), albedo");
  for (const char* name :
       {"angle_deg", "phase_per_sr", "phase_relative", "order", "moment", "p12", "p22", "p33", "p34", "p44"})
    if (block.has(name))
      throw Error(block.where, strf("'%s' stands in the first block", name), "it begins a second one");
  if (!block.has("asymmetry") && (block.has("asymmetry_2") || block.has("share_2")))
    throw Error(block.where, "a second asymmetry without a first", "asymmetry, asymmetry_2, share_2");
  if (block.rows() < 2 || block.rows() > kMostWavelengths)
    throw Error(block.where, strf("%zu wavelengths", block.rows()), strf("2 to %zu", kMostWavelengths));
  data.relative = relative;
  for (size_t r = 0; r < block.rows(); ++r) {
    const double w = block.value(r, "wavelength_um");
    if (r > 0 && !(w > data.wavelengths_um.back())) throw Error(block.place(r), strf("%g um is not ascending", w));
    data.wavelengths_um.push_back(w);
    data.extinction.push_back(relative ? block.value(r, "extinction_relative")
                                       : 1000 * block.value(r, "extinction_m2_g"));
    data.albedo.push_back(block.value(r, "albedo"));
  }
  if (!relative || !data.reaches_green()) return;
  constexpr double green = 0.55;
  const double there = data.extinction_at(green);
  Ones ones("extinction_relative", "it is over the extinction at 0.55 um; extinction_m2_g has a scale of its own");
  ones.take(there, green, block.where);
  ones.add_notes(out.notes);
  for (double& e : data.extinction) e /= there;
}

// A phase function on the grid, of integral 1 there. Peaks between its angles are lost or grow; that is told.
void keep(ReadParticles& out, double wavelength_um, std::vector<double> gridded, const Where& where) {
  const double whole = phase_integral(gridded);
  if (!(whole > 0))
    throw Error(where, strf("nothing is left of the phase function at %g um", wavelength_um),
                "its peaks are narrower than the angles that it is kept on");
  if (std::fabs(whole - 1) > kAllowed)
    out.notes.push_back(
        strf("the phase function at %g um has peaks narrower than the angles that it is kept on: its "
             "integral was %g there and is made 1",
             wavelength_um, whole));
  for (double& p : gridded) p /= whole;
  out.data.phase_um.push_back(wavelength_um);
  out.data.phase.push_back(std::move(gridded));
}

void read_asymmetries(const Block& block, ReadParticles& out) {
  const bool second = block.has("asymmetry_2");
  if (second != block.has("share_2"))
    throw Error(block.where, "one of asymmetry_2 and share_2", "a second function has both");
  for (size_t r = 0; r < block.rows(); ++r) {
    std::vector<double> gridded = gridded_hg(block.value(r, "asymmetry"));
    if (second) {
      const double share = block.value(r, "share_2");
      const std::vector<double> other = gridded_hg(block.value(r, "asymmetry_2"));
      for (size_t i = 0; i < other.size(); ++i) gridded[i] = (1 - share) * gridded[i] + share * other[i];
    }
    keep(out, out.data.wavelengths_um[r], std::move(gridded), block.place(r));
  }
}

// Runs of rows of one wavelength: use(wavelength, first row, one beyond the last).
template <class Use>
void each_wavelength(const Block& block, ReadParticles& out, const Use& use) {
  const std::vector<double>& read = out.data.phase_um;
  for (size_t from = 0, to; from < block.rows(); from = to) {
    const double w = block.value(from, "wavelength_um");
    for (to = from; to < block.rows() && block.value(to, "wavelength_um") == w;) ++to;
    if (!read.empty() && !(w > read.back()))
      throw Error(block.place(from), strf("%g um follow %g um", w, read.back()), "wavelengths ascend");
    if (read.size() == kMostWavelengths)
      throw Error(block.place(from), strf("more than %zu wavelengths", kMostWavelengths));
    keep(out, w, use(w, from, to), block.place(from));
  }
}

PlaneBlocks matrix_of(const Block& block, size_t row) {
  constexpr double kLeast = -1e-3;  // of a coherency's eigenvalue, which printed digits may cost
  PlaneBlocks m;
  for (size_t e = 0; e < std::size(kElements); ++e) m.*kPlaces[e] = block.value(row, kElements[e]);
  if (least_coherency(m.matrix()) < kLeast)
    throw Error(block.place(row), "the matrix is none of a scatterer",
                "elements are over P11; where they are, a sign is wrong: nothing polarises more than all light");
  return m;
}

void read_angles(const Block& block, ReadParticles& out) {
  const bool polarises = block.has("p12");
  const bool any_scale = block.has("phase_relative");
  Ones ones("the integral of the phase function", "phase_relative may have any scale; closer angles integrate better");
  each_wavelength(block, out, [&](double w, size_t from, size_t to) {
    std::vector<double> angles, values;
    std::vector<PlaneBlocks> matrices;
    double integral = 0;
    for (size_t r = from; r < to; ++r) {
      const double degrees = block.value(r, "angle_deg");
      if (r == from ? degrees != 0 : !(degrees - block.value(r - 1, "angle_deg") >= kClosest))
        throw Error(block.place(r), strf("an angle of %g degrees", degrees),
                    "from 0 to 180, ascending by 1e-4 at least");
      angles.push_back(degrees == 180 ? kPi : degrees * kDegree);
      values.push_back(block.value(r, any_scale ? "phase_relative" : "phase_per_sr"));
      if (polarises) matrices.push_back(matrix_of(block, r));
      const size_t i = angles.size() - 1;
      if (i > 0) integral += kPi * (values[i - 1] + values[i]) * (std::cos(angles[i - 1]) - std::cos(angles[i]));
    }
    if (block.value(to - 1, "angle_deg") != 180) throw Error(block.place(to - 1), "the last angle is not 180 degrees");
    if (!(integral > 0)) throw Error(block.place(from), "a phase function that is all zero");
    if (!any_scale) ones.take(integral, w, block.place(from));
    if (polarises) out.data.matrices.push_back(gridded_matrices(angles, matrices));
    return gridded_phase(angles, values);
  });
  ones.add_notes(out.notes);
}

// A series on the grid, without what of it is negative.
std::vector<double> series(std::vector<double> moments, double wavelength_um, const Where& where) {
  for (size_t l = moments.size(); l-- > 0;) moments[l] /= moments[0];
  std::vector<double> gridded = gridded_moments(moments), lost;
  for (double& p : gridded) {
    lost.push_back(std::max(0.0, -p));
    p = std::max(0.0, p);
  }
  if (const double negative = phase_integral(lost); !(negative <= kAllowed))
    throw Error(where,
                strf("%g of the series of %zu moments at %g um is negative", negative, moments.size(), wavelength_um),
                "more moments, or a table over the angle");
  return gridded;
}

void read_moments(const Block& block, ReadParticles& out) {
  Ones ones("the moment of order 0", "moments are means of Legendre's polynomials");
  each_wavelength(block, out, [&](double w, size_t from, size_t to) {
    std::vector<double> moments;
    for (size_t r = from; r < to; ++r) {
      if (block.value(r, "order") != static_cast<double>(r - from))
        throw Error(block.place(r), strf("order %g", block.value(r, "order")), strf("%zu is next", r - from));
      moments.push_back(block.value(r, "moment"));
    }
    ones.take(moments[0], w, block.place(from));
    return series(std::move(moments), w, block.place(from));
  });
  ones.add_notes(out.notes);
}

void read_phases(const Block& block, ReadParticles& out) {
  const bool angles = block.has("angle_deg") && block.has("phase_per_sr") != block.has("phase_relative"),
             moments = block.has("order") && block.has("moment");
  const auto elements = static_cast<size_t>(
      std::count_if(std::begin(kElements), std::end(kElements), [&](auto e) { return block.has(e); }));
  if (!block.has("wavelength_um") || angles == moments || block.columns.size() != 3 + elements ||
      (moments && elements > 0))
    throw Error(block.where, "the second block is not of phase functions",
                "wavelength_um, angle_deg, phase_per_sr (or phase_relative); or wavelength_um, order, moment");
  if (elements > 0 && elements < std::size(kElements))
    throw Error(block.where, strf("%zu of the five elements of a scattering matrix", elements),
                "p12, p22, p33, p34, p44, over P11");
  if (block.rows() == 0) throw Error(block.where, "a block without rows");
  angles ? read_angles(block, out) : read_moments(block, out);
}

}  // namespace

ReadParticles parse_particles(std::string_view text, const std::string& file) {
  const std::vector<Block> blocks = blocks_of(text, file);
  ReadParticles out;
  out.data.name = file;
  read_bulk(blocks[0], out);
  const bool asymmetry = blocks[0].has("asymmetry");
  if (asymmetry == (blocks.size() == 2))
    throw Error(blocks.back().where,
                asymmetry ? "both asymmetries and a block of phase functions" : "no phase function",
                "a column `asymmetry`, or a second block");
  if (asymmetry)
    read_asymmetries(blocks[0], out);
  else
    read_phases(blocks[1], out);
  return out;
}

ReadParticles read_particles(const std::string& path) {
  return parse_particles(read_text(path, size_t{256} << 20), path);
}

}  // namespace suite
