#include "export.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
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
};
constexpr Kind kKinds[] = {{".csv", 2, 180, 18}, {".raw", 2, 180, 18}, {".bsdf", 8, 512, 64}, {".xml", 2, 7, 0}};

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

// How the file differs from the fit; both are asked at the same 1e5 pairs of directions.
void tell_errors(const std::string& path, const sqt::Bundle& bundle, const sqt::Function& file, size_t channel) {
  const bool one = file.info().wavelength_um.size() < bundle.channels();
  const Comparison c = one ? compare(bundle, OneChannel(bundle, file, channel), 100000) : compare(bundle, file, 100000);
  const Comparison::Figures& f = one ? c.channels.at(channel) : c.overall;
  auto height = [](double ratio) { return ratio > 0 ? 1 / ratio : 0; };  // of the file's lobes over the fit's
  note(
      strf("%s against the fit: l1 %.3g %%, cos_rmse %.3g %%, rmse %.3g /sr, energy %+.3g %%, peaks at 20/45/70 deg "
           "%.3f %.3f %.3f",
           path.c_str(), 100 * f.l1, 100 * f.cos_rmse, f.rmse, -100 * f.bias, height(f.peak_ratio_20),
           height(f.peak_ratio_45), height(f.peak_ratio_70)));
}

// The part of the total that no table of values holds.
void tell_dirac(const sqt::Bundle& bundle, const std::string& path) {
  if (!bundle.info().has_delta()) return;
  double most = 0;
  for (int theta = 0; theta < 90; theta += 5)
    for (size_t c = 0; c < bundle.channels(); ++c)
      if (const auto lobe = bundle.delta(dir_from_angles(theta * kDegree, 0), c)) most = std::max(most, lobe->total);
  warn(strf("%s: the Dirac lobe beside the values, up to %.3g of the total, is not in it", path.c_str(), most));
}

void export_bsdf(const InspectOptions& o, const sqt::Bundle& bundle, size_t side) {
  RglSize size;
  size.side = side;
  const Fitted fitted(bundle);
  const std::vector<std::byte> file =
      rgl_of(fitted, "made by: " + command_line() + "\ntheta_i, phi_i: of the viewer", size);
  write_file(o.export_to, file);
  tell_errors(o.export_to, bundle, *sqt::swapped(parse_rgl(file, o.export_to)), 0);
}

void export_tree(const InspectOptions& o, const sqt::Bundle& bundle, long long levels) {
  const bool isotropic = bundle.info().function.isotropic;
  if (!levels) levels = isotropic ? 6 : 4;
  if (!isotropic && levels > 5) throw UsageError("--export-size of an anisotropic tensor tree is 2 to 5");
  const size_t channel = static_cast<size_t>(o.channel);
  const TensorTree tree(Fitted(bundle), channel, static_cast<int>(levels), 0.02);
  write_file(o.export_to, tree.xml(command_line()));
  note(strf("%s: channel %lld (%g um) as Visible, %zu leaves", o.export_to.c_str(), o.channel,
            bundle.info().function.wavelength_um[channel], tree.leaves()));
  tell_errors(o.export_to, bundle, tree, channel);
}

}  // namespace

void check_export(const InspectOptions& o) {
  if (o.export_to.empty()) {
    if (o.export_size) throw UsageError("--export-size goes with --export");
    return;
  }
  const Kind& kind = kind_of(o.export_to);
  if (o.export_size && (o.export_size < kind.least || o.export_size > kind.most))
    throw UsageError(strf("--export-size of %s is %lld to %lld", kind.extension, kind.least, kind.most));
}

void export_bundle(const InspectOptions& o, const sqt::Bundle& bundle) {
  const Kind& kind = kind_of(o.export_to);
  const long long size = o.export_size ? o.export_size : kind.otherwise;
  const std::string extension = kind.extension;
  if (extension == ".bsdf") export_bsdf(o, bundle, static_cast<size_t>(size));
  if (extension == ".xml") export_tree(o, bundle, size);
  if (extension == ".csv") write_file(o.export_to, csv_of(bundle, static_cast<size_t>(size)));
  if (extension == ".raw") write_file(o.export_to, raw_of(bundle, static_cast<size_t>(size)));
  tell_dirac(bundle, o.export_to);
  note("wrote " + o.export_to);
}

}  // namespace suite
