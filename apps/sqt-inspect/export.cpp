#include "export.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/params.h"
#include "base/progress.h"
#include "compare.h"
#include "formats/brdf_csv/brdf_csv.h"
#include "formats/rgl/rgl.h"
#include "formats/samples/samples.h"
#include "formats/tensor_tree/tensor_tree.h"
#include "math/vec.h"
#include "sqt_fit/swapped.h"

namespace suite {

namespace {

constexpr size_t kMostPairs = 20000000;

// A bundle as something to be tabulated; one channel of it, or all.
class Fitted final : public sqt::Function {
 public:
  explicit Fitted(const sqt::Bundle& bundle) : bundle_(bundle) {}
  const Info& info() const override { return bundle_.info().function; }
  void value(Dir out, Dir in, std::span<double> f) const override { bundle_.value(out, in, f); }

 private:
  const sqt::Bundle& bundle_;
};

struct Kind {
  const char* extension;
  long long least, most, otherwise;  // of --export-size
  bool own_table;                    // with an error of its own
};
constexpr Kind kKinds[] = {{".csv", 2, 180, 18, false},
                           {".raw", 2, 180, 18, false},
                           {".bsdf", 8, 512, 0, true},
                           {".xml", 1, static_cast<long long>(TensorTree::kMostLeaves / 1000), 0, true}};

const Kind& kind_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  for (const Kind& kind : kKinds)
    if (extension == kind.extension) return kind;
  throw UsageError("--export '" + file + "': give a name that ends in .csv, .raw, .bsdf or .xml");
}

// n steps of polar angle from the pole to the horizon, which hemispheres leave out; to the other pole for spheres.
std::vector<double> polar_deg(size_t n, bool sphere, bool horizon) {
  std::vector<double> list;
  for (size_t i = 0; i <= (sphere ? 2 * n : n); ++i)
    if (i != n || horizon) list.push_back(90.0 * static_cast<double>(i) / static_cast<double>(n));
  return list;
}
std::vector<double> azimuths_deg(size_t n, bool half) {
  std::vector<double> list;
  for (size_t i = 0; i < 4 * n; ++i) list.push_back(90.0 * static_cast<double>(i) / static_cast<double>(n));
  if (half) list.resize(2 * n + 1);
  return list;
}

std::string csv_of(const sqt::Bundle& bundle, size_t n) {
  const sqt::Function::Info& info = bundle.info().function;
  const bool sphere = info.domain == sqt::Domain::sphere, surface = info.quantity == sqt::Quantity::bsdf;
  AngleGrid grid;
  grid.theta_o = info.quantity == sqt::Quantity::bsdf ? polar_deg(n, false, false) : std::vector<double>{0};
  grid.phi_o = info.isotropic ? std::vector<double>{0} : azimuths_deg(n, false);
  grid.theta_i = polar_deg(n, sphere, !surface);
  grid.phi_i = azimuths_deg(n, info.isotropic && info.bilateral);
  if (grid.pairs() > kMostPairs)
    throw UsageError(
        strf("--export-size %zu makes %zu pairs of directions, more than %zu", n, grid.pairs(), kMostPairs));
  return brdf_csv_of(Fitted(bundle), grid, command_line());
}

std::string raw_of(const sqt::Bundle& bundle, size_t n) {
  const sqt::Function::Info& info = bundle.info().function;
  std::vector<double> zenith = polar_deg(n, false, false);
  for (double& z : zenith) z *= kDegree;
  std::vector<Dir> in;
  for (const double theta : polar_deg(n, info.domain == sqt::Domain::sphere, false))
    for (const double phi : azimuths_deg(n, info.bilateral)) {
      // Normalised twice: what a reader normalises again stays as it is.
      in.push_back(normalized(normalized(dir_from_angles(theta * kDegree, phi * kDegree))));
      if (theta == 0 || theta == 180) break;
    }
  return samples_text(Fitted(bundle), zenith, in);
}

// A file's only channel among the fit's own others.
class OneChannel final : public sqt::Function {
 public:
  OneChannel(const sqt::Bundle& bundle, const sqt::Function& file, size_t channel)
      : bundle_(bundle), file_(file), channel_(channel) {}
  const Info& info() const override { return bundle_.info().function; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    bundle_.value(out, in, f);
    file_.value(out, in, f.subspan(channel_, 1));
  }

 private:
  const sqt::Bundle& bundle_;
  const sqt::Function& file_;
  size_t channel_;
};

// How a table differs from the fit; both are asked at the same 1e5 pairs of directions.
Comparison::Figures difference(const sqt::Bundle& bundle, const sqt::Function& table, size_t channel) {
  const bool one = table.info().wavelength_um.size() < bundle.channels();
  const Comparison c =
      one ? compare(bundle, OneChannel(bundle, table, channel), 100000) : compare(bundle, table, 100000);
  return one ? c.channels.at(channel) : c.overall;
}

std::string figures_text(const Comparison::Figures& f) {
  auto height = [](double ratio) { return ratio > 0 ? 1 / ratio : 0; };  // of the file's lobes over the fit's
  return strf("l1 %.3g %%, cos_rmse %.3g %%, rmse %.3g /sr, energy %+.3g %%, peaks at 20/45/70 deg %.3f %.3f %.3f",
              100 * f.l1, 100 * f.cos_rmse, f.rmse, -100 * f.bias, height(f.peak_ratio_20), height(f.peak_ratio_45),
              height(f.peak_ratio_70));
}

// What is asked of a table: what --export-error says, else the error that the fit states of itself (of all channels, or
// of one), at least kFinest; kFinest for fits that state none.
constexpr double kFinest = 1e-3;
double aim_of(const InspectOptions& o, const SqtFile& file, std::optional<size_t> channel) {
  if (o.export_error > 0) return o.export_error;
  const Params header = Params::parse_text(file.header, o.file);
  std::optional<Params> figures = header.find("errors");
  if (figures) figures = figures->find(channel ? "channels" : "overall");
  if (figures && channel) figures = *channel < figures->size() ? std::optional((*figures)[*channel]) : std::nullopt;
  return std::max(kFinest, figures ? figures->number("l1", 0) : 0);
}

void report_difference(const InspectOptions& o, const Comparison::Figures& f, double aim, const std::string& larger) {
  note(o.export_to + " against the fit: " + figures_text(f));
  if (f.l1 > aim)
    warn(strf("%s: l1 of %.3g %% is more than the %.3g %% that were to be kept%s", o.export_to.c_str(), 100 * f.l1,
              100 * aim, larger.c_str()));
}

// The part of the total that no table of values holds.
void report_dirac(const sqt::Bundle& bundle, const std::string& path) {
  if (!bundle.info().has_delta()) return;
  double most = 0;
  for (int theta = 0; theta < 90; theta += 5)
    for (size_t c = 0; c < bundle.channels(); ++c)
      if (const auto lobe = bundle.delta(dir_from_angles(theta * kDegree, 0), c)) most = std::max(most, lobe->total);
  warn(strf("%s: the Dirac lobe beside the values, up to %.3g of the total, is not in it", path.c_str(), most));
}

// Tables twice as fine until one keeps the error, when none is asked for.
void export_bsdf(const InspectOptions& o, const SqtFile& file) {
  const Fitted fitted(*file.bundle);
  const double aim = aim_of(o, file, std::nullopt);
  RglSize size;
  for (size.side = static_cast<size_t>(o.export_size ? o.export_size : 64);; size.side *= 2) {
    const std::string about = "made by: " + command_line() + "\ntheta_i, phi_i: of the viewer";
    const std::vector<std::byte> table = rgl_of(fitted, about, size);
    const Comparison::Figures f = difference(*file.bundle, *sqt::swapped(parse_rgl(table, o.export_to)), 0);
    if (!o.export_size && f.l1 > aim && size.side < 512) continue;
    write_file(o.export_to, rgl_of(fitted, about + "\nagainst the fit: " + figures_text(f), size));
    note(strf("%s: tables of %zu x %zu", o.export_to.c_str(), size.side, size.side));
    return report_difference(o, f, aim, size.side < 512 ? ": --export-size makes it finer" : "");
  }
}

void export_tree(const InspectOptions& o, const SqtFile& file) {
  const sqt::Bundle& bundle = *file.bundle;
  const Fitted fitted(bundle);
  const size_t channel = static_cast<size_t>(o.channel);
  TensorTree::Aim aim;
  aim.error = aim_of(o, file, channel);
  aim.leaves = o.export_size ? 1000 * static_cast<size_t>(o.export_size) : TensorTree::kMostLeaves;
  aim.measure = [&](const sqt::Function& tree) { return difference(bundle, tree, channel).l1; };
  const TensorTree tree(fitted, channel, aim);
  const Comparison::Figures f = difference(bundle, tree, channel);
  write_file(o.export_to, tree.xml(command_line() + "\nagainst the fit: " + figures_text(f)));
  note(strf("%s: channel %lld (%g um) as Visible, %zu leaves, the smallest 2^-%d wide", o.export_to.c_str(), o.channel,
            bundle.info().function.wavelength_um[channel], tree.leaves(), tree.levels()));
  report_difference(o, f, aim.error, aim.leaves < TensorTree::kMostLeaves ? ": --export-size allows more leaves" : "");
}

}  // namespace

void check_export(const InspectOptions& o) {
  if (o.export_to.empty()) {
    if (o.export_size || o.export_error != 0) throw UsageError("--export-size and --export-error go with --export");
    return;
  }
  const Kind& kind = kind_of(o.export_to);
  if (o.export_size && (o.export_size < kind.least || o.export_size > kind.most))
    throw UsageError(strf("--export-size of %s is %lld to %lld", kind.extension, kind.least, kind.most));
  if (o.export_error != 0 && !kind.own_table)
    throw UsageError(strf("--export-error goes with .bsdf and .xml: a %s has the fit's own values", kind.extension));
  if (o.export_error != 0 && !(o.export_error >= 1e-4 && o.export_error <= 1))
    throw UsageError("--export-error is 0.0001 to 1");
}

void export_bundle(const InspectOptions& o, const SqtFile& file) {
  const Kind& kind = kind_of(o.export_to);
  const auto size = static_cast<size_t>(o.export_size ? o.export_size : kind.otherwise);
  const std::string extension = kind.extension;
  if (extension == ".bsdf") export_bsdf(o, file);
  if (extension == ".xml") export_tree(o, file);
  if (extension == ".csv") write_file(o.export_to, csv_of(*file.bundle, size));
  if (extension == ".raw") write_file(o.export_to, raw_of(*file.bundle, size));
  report_dirac(*file.bundle, o.export_to);
  if (file.bundle->info().mueller)
    warn(o.export_to + ": holds m11 alone; the Mueller matrices of the fit are left out");
  note("wrote " + o.export_to);
}

}  // namespace suite
