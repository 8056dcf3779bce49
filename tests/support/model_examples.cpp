#include "support/model_examples.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "sqt_fit/aligned_fit.h"
#include "sqt_fit/mueller_fit.h"
#include "support/polished_metal.h"

namespace suite::test {

namespace {

// A glossy lobe over a diffuse floor whose colour changes.
class Glossy final : public sqt::Function {
 public:
  explicit Glossy(double dirac = 0) : dirac_(dirac) {
    info_.name = "glossy";
    info_.wavelength_um = {0.65, 0.55, 0.45};
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    if (!(out.z > 0) || !(in.z > 0)) {
      std::fill(f.begin(), f.end(), std::nan(""));
      return;
    }
    const Dir h = normalized(out + in);
    const double lobe = std::exp(-(1 - h.z * h.z) / (h.z * h.z * 0.01)) / std::max(0.1, in.z + out.z);
    f[0] = 0.15 + 0.3 * lobe, f[1] = 0.06 + 0.8 * lobe, f[2] = 0.01 + 1.2 * lobe;
  }

  sqt::Dirac dirac() const override { return dirac_ > 0 ? sqt::Dirac::mirror : sqt::Dirac::none; }
  void dirac_total(Dir out, std::span<double> W) const override {
    for (size_t c = 0; c < 3; ++c) W[c] = dirac_ * (1 + static_cast<double>(c)) * (1 - 0.5 * out.z);
  }

 private:
  Info info_;
  double dirac_;
};

// Two colours of haze.
class Haze final : public sqt::Function {
 public:
  Haze() {
    info_.name = "haze";
    info_.wavelength_um = {0.45, 0.65};
    info_.domain = sqt::Domain::sphere;
    info_.quantity = sqt::Quantity::phase;
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    const double c = scattering_cosine(out, in);
    f[0] = std::exp(3 * (c - 1)) + 0.02;
    f[1] = std::exp(1.5 * (c - 1)) + 0.05;
  }

 private:
  Info info_;
};

using BundlePtr = std::shared_ptr<const sqt::Bundle>;

BundlePtr fitted(const sqt::Function& function, size_t views, int base_order, int max_order, double quality) {
  sqt::AlignedSource::Options options;
  options.views = views;
  options.base_order = base_order;
  options.max_order = max_order;
  return sqt::make_bundle(sqt::encode_aligned(sqt::AlignedSource(function, options), quality).data);
}

// What was measured with its matrices.
BundlePtr measured_metal() {
  const auto metal = polished_metal();
  sqt::AlignedSource::Options options;
  options.views = 9;
  options.base_order = 5;
  options.max_order = 7;
  sqt::AlignedData data = sqt::encode_aligned(sqt::AlignedSource(*metal, options), 0.1).data;
  data.mueller = sqt::fit_mueller(*metal, 0.01).table;
  return sqt::make_bundle(std::move(data));
}

// By the names that the rows give them.
BundlePtr bundle_named(const std::string& file) {
  static const std::map<std::string, BundlePtr> all{{"glossy.sqt", fitted(Glossy(0), 9, 5, 7, 0.1)},
                                                    {"lacquer.sqt", fitted(Glossy(0.08), 9, 5, 7, 0.1)},
                                                    {"metal.sqt", measured_metal()},
                                                    {"haze.sqt", fitted(Haze(), 2, 4, 6, 0.05)}};
  return all.at(file);
}

std::vector<ModelSpec> with_bundles(std::vector<ModelSpec> specs) {
  for (ModelSpec& spec : specs)
    if (spec.model == "sqt") spec.bundle = bundle_named(spec.texts.at("file"));
  return specs;
}

}  // namespace

std::vector<ModelSpec> examples_of(const ModelRow& row) { return with_bundles(row.examples()); }
std::vector<ModelSpec> examples_of(const PhaseRow& row) { return with_bundles(row.examples()); }

}  // namespace suite::test
