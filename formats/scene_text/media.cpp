#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/files.h"
#include "base/required.h"
#include "formats/scene_text/reader.h"
#include "formats/scene_text/transform.h"
#include "scene/voxel_mesh.h"

namespace suite::scene_text {

namespace {

// A curve of two others where both have or have had a point; exact there, piecewise linear between.
template <class Combine>
Curve combined(const Curve& a, const Curve& b, const Combine& combine) {
  if (a.is_constant() && b.is_constant()) return Curve::constant(combine(a.value().front(), b.value().front()));
  std::vector<double> x, y;
  for (const Curve* c : {&a, &b})
    if (!c->is_constant()) x.insert(x.end(), c->wavelength_um().begin(), c->wavelength_um().end());
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
  x.erase(std::remove_if(x.begin(), x.end(), [&](double w) { return !a.covers(w, w) || !b.covers(w, w); }), x.end());
  if (x.empty()) throw Error("the curves have no wavelength in common");
  for (const double w : x) y.push_back(combine(a.at(w), b.at(w)));
  const Outside rule = a.is_constant()                                 ? b.outside()
                       : b.is_constant() || a.outside() == b.outside() ? a.outside()
                                                                       : Outside::error;
  return Curve(std::move(x), std::move(y), rule);
}

void check_sum(const Params& p, const Curve& whole, const Curve& a, const Curve& b) {
  for (const Curve* c : {&whole, &a, &b})
    for (const double w : c->is_constant() ? std::vector<double>{1.0} : c->wavelength_um()) {
      if (!whole.covers(w, w) || !a.covers(w, w) || !b.covers(w, w)) continue;
      const double sum = a.at(w) + b.at(w);
      if (std::fabs(whole.at(w) - sum) > 1e-4 * std::max(whole.at(w), sum))
        throw p.error(
            strf("extinction %g is not absorption %g + scattering %g at %g um", whole.at(w), a.at(w), b.at(w), w),
            "give two of the three", "SP605");
    }
}

}  // namespace

void Reader::read_phase(const Params& p, ModelSpec& spec) {
  const Params model = required(p, "model", phases().names());
  spec.model = model.as_text();
  for (const Parameter& parameter : phases().find(spec.model, model.where()).parameters) {
    const auto value = p.find(parameter.name);
    if (!value) continue;
    if (parameter.kind == Parameter::Kind::number)
      spec.numbers[parameter.name] = value->as_number();
    else if (parameter.kind == Parameter::Kind::curve)
      spec.curves[parameter.name] = read_curve_value(*value);
    else if (parameter.name == "file")
      read_stored(*value, spec);
    else if (parameter.name == "outside")
      spec.texts[parameter.name] = value->as_choice({"error", "hold"}) == 0 ? "error" : "hold";
    else
      spec.texts[parameter.name] = value->as_text();
  }
  check_phase(spec, model.where());
}

void Reader::read_medium(const std::string& id, const Params& p) {
  // The name is known from here on, so that one wrong value does not bring a second error per use of it.
  const size_t slot = draft_.media.size();
  draft_.media.push_back({p.where(), {}});
  draft_.media[slot].medium.id = id;
  Medium m;
  m.id = id;
  m.description = p.text("description", "");
  if (const auto water = p.find("water")) {
    for (const char* name : {"absorption", "scattering", "extinction", "albedo", "phase", "index"})
      if (p.has(name)) throw p.at(name).error(strf("'%s' and 'water' cannot be combined", name), "water gives it");
    read_water(*water, m);
  } else if (const auto leaves = p.find("leaves")) {
    for (const char* name : {"absorption", "scattering", "extinction", "albedo", "phase"})
      if (p.has(name)) throw p.at(name).error(strf("'%s' and 'leaves' cannot be combined", name), "leaves give it");
    read_leaves(*leaves, m);
  } else {
    read_coefficients(p, m);
    if (const auto phase = p.find("phase")) read_phase(*phase, m.phase);
    if (p.has("index")) m.index = read_curve_value(p.at("index"));
  }
  if (p.has("temperature_k")) m.temperature_k = p.number_in("temperature_k", 1, 1e5, "K");
  m.priority = static_cast<int>(p.integer("priority", -1000, 1000, 0));
  check_medium(m, p.where());
  draft_.media[slot].medium = std::move(m);
}

// Turbid leaves: a density of 1 is one square metre of leaves, counted on one side, in a cubic metre.
void Reader::read_leaves(const Params& p, Medium& m) {
  const Curve r = read_curve_value(p.at("reflectance")), t = read_curve_value(p.at("transmittance"));
  const double g = p.number_in("projection", 0.01, 1, "m2 of shadow of a m2 of leaves", 0.5);
  for (const Curve* c : {&r, &t})
    if (!(c->min() >= 0 && c->max() <= 1)) throw p.error("a leaf's reflectance or transmittance outside of 0 to 1");
  m.scattering = combined(r, t, [&](double a, double b) { return g * (a + b); });
  if (m.scattering.max() > g * (1 + 1e-9))
    throw p.error(strf("leaves that reflect and transmit %g in all", m.scattering.max() / g), "at most 1", "SP105");
  m.absorption = combined(r, t, [&](double a, double b) { return std::max(0.0, g * (1 - a - b)); });
  m.phase.model = "leaves";
  m.phase.curves.insert_or_assign("transmitted",
                                  combined(r, t, [](double a, double b) { return a + b > 0 ? b / (a + b) : 0.5; }));
  check_phase(m.phase, p.where());
}

// Absorption and scattering from the two coefficients that are given.
void Reader::read_coefficients(const Params& p, Medium& m) {
  const auto curve = [&](const char* name) {
    return p.has(name) ? std::optional(read_curve_value(p.at(name))) : std::nullopt;
  };
  const auto absorption = curve("absorption"), scattering = curve("scattering"), extinction = curve("extinction"),
             albedo = curve("albedo");
  const int given = absorption.has_value() + scattering.has_value() + extinction.has_value() + albedo.has_value();
  if (albedo && !(albedo->min() >= 0 && albedo->max() <= 1))
    throw p.at("albedo").error(strf("an albedo from %g to %g", albedo->min(), albedo->max()), "0 to 1");
  if (absorption && scattering && extinction && !albedo) {
    check_sum(p, *extinction, *absorption, *scattering);
    m.absorption = *absorption, m.scattering = *scattering;
  } else if (given != 2 && !(given == 1 && (absorption || scattering))) {
    throw p.error(strf("medium '%s' is given by %d coefficients", m.id.c_str(), given),
                  "two of absorption, scattering, extinction, albedo; or one of the first two, the other being 0");
  } else if (!extinction && !albedo) {
    if (absorption) m.absorption = *absorption;
    if (scattering) m.scattering = *scattering;
  } else if (extinction && albedo) {
    m.scattering = combined(*extinction, *albedo, [](double e, double w) { return e * w; });
    m.absorption = combined(*extinction, *albedo, [](double e, double w) { return e * (1 - w); });
  } else if (extinction) {
    const auto rest = [](double e, double part) { return std::fabs(e - part) <= 1e-12 * e ? 0 : e - part; };
    m.absorption = absorption ? *absorption : combined(*extinction, *scattering, rest);
    m.scattering = scattering ? *scattering : combined(*extinction, *absorption, rest);
  } else {
    if (albedo->min() <= 0 || (absorption && albedo->max() >= 1))
      throw p.at("albedo").error("this albedo leaves the other coefficient open", "give extinction");
    m.scattering =
        scattering ? *scattering : combined(*absorption, *albedo, [](double a, double w) { return a * w / (1 - w); });
    m.absorption =
        absorption ? *absorption : combined(*scattering, *albedo, [](double s, double w) { return s * (1 - w) / w; });
  }
}

// Index of refraction behind a surface over that in front of it, from the media it bounds; a missing one counts as 1.
std::optional<Curve> Reader::relative_index(const Params& p) {
  const auto index_of = [&](const char* side) -> std::optional<Curve> {
    if (!p.has(side)) return std::nullopt;
    for (const DraftMedium& m : draft_.media)
      if (m.medium.id == p.at(side).as_text()) return m.medium.index;
    return std::nullopt;
  };
  const auto inside = index_of("inside"), outside = index_of("outside");
  if (!inside) return std::nullopt;
  return combined(*inside, outside ? *outside : Curve::constant(1), [](double a, double b) { return a / b; });
}

VoxelData Reader::read_voxel_input(const Params& p) {
  VoxelData data = read_voxels(input(p));
  for (const std::string& raw : data.raw_files) inputs_.add_companion(p.as_text(), raw);
  return data;
}

// The grids of an OpenVDB file, or voxels as text.
VoxelData Reader::read_any_voxels(const Params& p, const Params& file) {
  const std::string name = file.as_text();
  if (name.size() > 4 && (name.ends_with(".las") || name.ends_with(".LAS") || name.ends_with(".laz")))
    return read_point_voxels(p, file);
  if (is_amapvox(input(file))) return read_amapvox(input(file), p.text("column", ""), report_);
  if (name.size() < 4 || name.compare(name.size() - 4, 4, ".vdb") != 0) return read_voxel_input(file);
  return read_vdb(input(file), p.text("density_grid", "density"), p.text("temperature_grid", ""));
}

void Reader::read_grid(const std::string& name, const Params& p) {
  const size_t slot = draft_.grids.size();
  draft_.grids.push_back({p.where(), {}, {}, {}});
  DraftGrid d{p.where(), {}, {}, {}};
  d.grid.name = name;
  draft_.grids[slot].grid.name = name;
  if (const auto medium = p.find("medium")) {
    if (p.has("media")) throw p.error("'medium' and 'media' cannot be combined");
    d.media.push_back(reference(*medium));
  } else {
    for (const Params& m : p.at("media").items()) d.media.push_back(reference(m));
  }
  if (d.media.empty() || d.media.size() > 256) throw p.error("a grid needs 1 to 256 media");
  const Params file = p.at("voxels");
  VoxelData data = read_any_voxels(p, file);
  if (!data.material.empty()) throw file.error("these voxels have materials", "cells of materials are an object");
  d.grid.cells = data.cells;
  d.grid.to_local = data.to_local;
  d.grid.density = data.density.empty() ? std::vector<float>(data.size(), 1.0f) : std::move(data.density);
  d.grid.temperature = std::move(data.temperature);
  for (const uint16_t m : data.medium) {
    if (m >= d.media.size())
      throw file.error(strf("a voxel is of medium %u, %zu media are listed", m, d.media.size()), "numbers start at 0");
    d.grid.kind.push_back(static_cast<uint8_t>(m));
  }
  if (!data.shares.empty() && data.shares.size() != d.media.size())
    throw file.error(strf("the voxels have shares of %zu media, %zu are listed", data.shares.size(), d.media.size()));
  d.shares = std::move(data.shares);
  if (const double scale = p.number_in("density_scale", 0, 1e30, "", 1); scale != 1)
    for (float& v : d.grid.density) v = std::min(static_cast<float>(v * scale), 3e38f);
  draft_.grids[slot] = std::move(d);
}

void Reader::read_volume(const Params& p) {
  DraftVolume v{p.where(), reference(p.at("place")), find_transform(p).value_or(Affine3{}), nullptr, {}};
  if (const auto motion = p.find("motion"))
    v.motion = track_from(*motion, motion_context(true)), v.motion_where = motion->where();
  draft_.volumes.push_back(std::move(v));
}

void Reader::read_voxel_geometry(const Params& p, DraftGeometry& g) {
  g.kind = DraftGeometry::Kind::voxels;
  g.normals = NormalRule::facet;
  const Params materials = p.at("materials"), file = p.at("voxels");
  std::set<uint16_t> solid;
  for (const std::string& key : materials.keys()) {
    if (key.empty() || key.size() > 5 || key.find_first_not_of("0123456789") != std::string::npos ||
        std::stol(key) > 65535)
      throw materials.error("material '" + key + "' is not a number from 0 to 65535");
    const auto value = static_cast<uint16_t>(std::stol(key));
    if (!solid.insert(value).second) throw materials.error(strf("material %u is listed twice", value));
    g.materials[std::to_string(value)] = reference(materials.at(key));
  }
  const VoxelData data = read_voxel_input(file);
  if (data.material.empty()) throw file.error("these voxels have no materials", "media go into 'grids' and 'volumes'");
  g.mesh = voxel_faces(data.cells, data.to_local, data.material, solid);
  g.mesh.file = file.as_text();
  if (g.mesh.indices.empty()) throw file.error("no voxel has one of the materials");
}

}  // namespace suite::scene_text
