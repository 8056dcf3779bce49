// Reflectances by facets: Shell's (ShellTarget, ShellBackground), the NEF's (NEFBeardMaxwell), Priest & Germer's. Their
// parameters stand in blocks FIT_PARAMS of a file (.fit), one a wavelength, or in the entry itself.
// Assumes: slopes as of libs/optics/models/beard_maxwell.cpp, BIAS their factor, SIGMA a tangent, TAU and OMEGA
// degrees. Based on: public readers of such files; J. Shell, "Polarimetric remote sensing in the visible to near
// infrared", RIT 2005, section 3.
#include <algorithm>
#include <cmath>

#include "formats/dirsig/scene_writer.h"
#include "math/vec.h"

namespace suite::dirsig {

struct FacetFit {
  std::vector<double> um, n, k, diffuse, volume;  // of each block, ascending; um is 0 where it is not said
  double sigma = 0.1, bias = 1, tau_deg = 10, omega_deg = 20;
  std::optional<double> dhr;  // of the first block

  // Reflected by the facets and by the volume straight from above, by energy: facets of small slopes reflect as their
  // plane does; the volume 2 rho_v / (1 + cos) over the half sphere.
  double facets(size_t i) const {
    const double k2 = k[i] * k[i];
    return bias * ((n[i] - 1) * (n[i] - 1) + k2) / ((n[i] + 1) * (n[i] + 1) + k2);
  }
  double from_volume(size_t i) const { return 4 * kPi * (1 - std::log(2.0)) * volume[i]; }
};

namespace {

using Names = std::initializer_list<std::string_view>;

// Within what our models take; told where it had to be moved.
double within(const Item& item, double low, double high) {
  const double value = item.number();
  if (value >= low && value <= high) return value;
  const double moved = std::clamp(value, low, high);
  item.mark(Fate::approximated, strf("%g in place of it: %g to %g are known here", moved, low, high));
  return moved;
}

double optional(const Item& block, Names names, double low, double high, double otherwise) {
  const Item* item = block.any(names);
  return item ? within(*item, low, high) : otherwise;
}

bool is_block(const Item& item) { return item.any({"N", "INDEX", "N_REAL"}) && item.has("SIGMA"); }

// Shapes that differ from block to block: the first holds.
void same_shape(const Item& block, Names names, double first) {
  const Item* item = block.any(names);
  if (item && item->number() != first)
    item->mark(Fate::approximated, "the shape of the lobe is that of the first wavelength");
}

void add_block(const Item& block, bool emissivity, FacetFit& fit) {
  block.mark(Fate::exact);
  if (const Item* diffuse = emissivity ? block.any({"RHO_D", "RHOD"}) : nullptr)
    diffuse->mark(Fate::approximated, "the emissivity says what is diffuse");
  const bool first = fit.n.empty();
  fit.um.push_back(optional(block, {"LAMBDA", "WAVELENGTH"}, 1e-3, 1e4, 0));
  fit.n.push_back(optional(block, {"N", "INDEX", "N_REAL"}, 0.05, 20, 1.5));
  fit.k.push_back(optional(block, {"K", "ABSORPTION", "N_IMAG"}, 0, 100, 0));
  fit.diffuse.push_back(kPi * optional(block, {"RHO_D", "RHOD"}, 0, 1 / kPi, 0));
  fit.volume.push_back(optional(block, {"RHO_V", "RHOV"}, 0, 1, 0));
  const Item* dhr = block.find("DHR");
  if (!first) {
    same_shape(block, {"SIGMA"}, fit.sigma), same_shape(block, {"BIAS", "B"}, fit.bias);
    same_shape(block, {"TAU"}, fit.tau_deg), same_shape(block, {"OMEGA"}, fit.omega_deg);
    if (dhr) dhr->mark(Fate::approximated, "that of the first wavelength scales the lobe");
    return;
  }
  fit.sigma = optional(block, {"SIGMA"}, 0.005, 1, 0.1), fit.bias = optional(block, {"BIAS", "B"}, 0, 10, 1);
  fit.tau_deg = optional(block, {"TAU"}, 0.1, 1000, 10), fit.omega_deg = optional(block, {"OMEGA"}, 0.1, 1000, 20);
  if (dhr) fit.dhr = dhr->number_in(0, 2);
}

// By the wavelength; blocks of one wavelength are one.
FacetFit sorted(const FacetFit& fit) {
  std::vector<size_t> order;
  for (size_t i = 0; i < fit.um.size(); ++i) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return fit.um[a] < fit.um[b]; });
  FacetFit made = fit;
  for (auto* list : {&made.um, &made.n, &made.k, &made.diffuse, &made.volume}) list->clear();
  for (const size_t i : order) {
    if (!made.um.empty() && made.um.back() == fit.um[i]) continue;
    made.um.push_back(fit.um[i]), made.n.push_back(fit.n[i]), made.k.push_back(fit.k[i]);
    made.diffuse.push_back(fit.diffuse[i]), made.volume.push_back(fit.volume[i]);
  }
  return made;
}

Tree curve_over(const std::vector<double>& um, const std::vector<double>& value, const Where& where) {
  if (um.size() < 2) return Tree::number(value[0], where);
  Tree made = Tree::map(where);
  made.set("wavelength_um", Tree::numbers(um, where));
  made.set("value", Tree::numbers(value, where));
  made.set("outside", Tree::word("hold", where));
  return made;
}

// The lobe's height by the reflectance that the fit says it has.
void scale_by_dhr(const Item& name, FacetFit& fit) {
  const double own = fit.facets(0), rest = fit.diffuse[0] + fit.from_volume(0);
  if (!fit.dhr || !(own > 0) || !(*fit.dhr > rest)) return;
  const double by = (*fit.dhr - rest) / own;
  if (std::fabs(by - 1) <= 0.02) return;
  fit.bias = std::clamp(fit.bias * by, 0.0, 10.0);
  name.mark(Fate::approximated,
            strf("BIAS times %.4g, so that straight from above the surface reflects its DHR of %g", by, *fit.dhr));
}

}  // namespace

bool is_facets(std::string_view kind) {
  for (const char* known : {"shell", "nef", "beard", "priest", "germer"})
    if (kind.find(known) != kind.npos) return true;
  return false;
}

// The file of parameters, where there is one that can be read; the reason of others stands with its name.
const Item* SceneWriter::facet_file(const Item& section, const Folders& folders) {
  const Item* named =
      section.any({"BRDF_FIT_FILE", "BRDF_FIT_FILENAME", "FIT_FILENAME", "FIT_FILE", "NEF_MAT_FILE", "PARAMETER_FILE",
                   "PARAMETER_FILENAME", "BRDF_FILENAME", "BRDF_FILE", "DATA_FILENAME", "FILENAME"});
  if (!named) return nullptr;
  try {
    return &import_.sections(import_.file_of(*named, folders), "fit of facets", "fit");
  } catch (const Error& e) {
    named->mark(Fate::unsupported,
                "the lobe is lost: " + (e.where().file.empty() ? "" : to_text(e.where()) + ": ") + e.message());
    return nullptr;
  }
}

// What comes from below the facets: all that emissivities leave and the fit's lobe does not reflect.
Tree SceneWriter::body_of(const Item& section, const Folders& folders, const FacetFit& fit, const Where& where) {
  const Item* named = section.any({"EMISSIVITY_FILE", "EMISSIVITY_FILENAME"});
  if (!named) return curve_over(fit.um, fit.diffuse, where);
  const CurveFile& file = curves_of(import_.file_of(*named, folders), "emissivities");
  reaches(file);
  CurveFile mean = mean_reflectance(file, *named);
  named->mark(Fate::approximated,
              "the Lambert part is 1 - emissivity - what facets and volume reflect straight from above");
  for (size_t i = 0; i < mean.value[0].size(); ++i) {
    const double um = mean.wavelength_um[0][i];
    size_t near = 0;
    for (size_t b = 1; b < fit.um.size(); ++b)
      if (std::fabs(fit.um[b] - um) < std::fabs(fit.um[near] - um)) near = b;
    mean.value[0][i] = std::clamp(mean.value[0][i] - fit.facets(near) - fit.from_volume(near), 0.0, 1.0);
  }
  Tree made = curve_over(mean.wavelength_um[0], mean.value[0], named->where);
  if (made.kind == Tree::Kind::map) made.set("outside", Tree::word("error", named->where));
  return made;
}

bool SceneWriter::read_facets(const Item& name, const Item& section, const Folders& folders, Tree& to) {
  const std::string kind = lower_case(name.value);
  const bool germer = kind.find("germer") != kind.npos || kind.find("priest") != kind.npos;
  const bool nef = kind.find("nef") != kind.npos || kind.find("beard") != kind.npos;
  const bool emissivity = section.any({"EMISSIVITY_FILE", "EMISSIVITY_FILENAME"});
  FacetFit fit;
  if (is_block(section)) {
    add_block(section, emissivity, fit);
  } else if (const Item* file = facet_file(section, folders)) {
    for (const Item* block : file->all("FIT_PARAMS")) add_block(*block, emissivity, fit);
    if (fit.n.empty() && is_block(*file)) add_block(*file, emissivity, fit);
    file->mark(Fate::exact);
    if (fit.n.empty()) {
      file->mark_all(Fate::unsupported, "no FIT_PARAMS { N = ..., SIGMA = ... } in it");
      return false;
    }
  } else {
    return false;
  }
  fit = sorted(fit);
  if (!germer && !nef) scale_by_dhr(name, fit);
  const Where& where = name.where;
  to.set("model", Tree::word(germer ? "priest_germer" : nef ? "beard_maxwell" : "shell", where));
  to.set("index", curve_over(fit.um, fit.n, where));
  to.set("absorption", curve_over(fit.um, fit.k, where));
  to.set("sigma", Tree::number(fit.sigma, where));
  to.set("diffuse", body_of(section, folders, fit, where));
  name.mark(Fate::approximated, "the model of the same name, of unpolarised light");
  if (germer) {
    if (const Item* on = section.find("ENABLE_DIFFUSE_CONTRIBUTION"); on && !on->boolean()) {
      to.set("diffuse", Tree::number(0, on->where));
      if (const Item* diffuse = section.any({"RHO_D", "RHOD"})) diffuse->mark(Fate::ignored, "switched off");
    }
    if (const Item* on = section.find("ENABLE_SHADOWING_FUNCTION"); on && !on->boolean())
      on->mark(Fate::approximated, "facets shadow each other here in any case");
    return true;
  }
  to.set("bias", Tree::number(fit.bias, where));
  to.set("tau_deg", Tree::number(fit.tau_deg, where));
  to.set("omega_deg", Tree::number(fit.omega_deg, where));
  to.set("volume", curve_over(fit.um, fit.volume, where));
  return true;
}

}  // namespace suite::dirsig
