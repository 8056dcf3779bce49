#include "optics/model_function.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "optics/models.h"
#include "optics/phase_function.h"

namespace suite {

namespace {

class ModelFunction final : public sqt::Function {
 public:
  ModelFunction(const ModelSpec& spec, const SpectralState& state, std::string text) : model_(bake(spec, state)) {
    info_.name = spec.model;
    info_.source = "model " + std::move(text) + ", evaluated where asked";
    info_.wavelength_um = {state.reference_um};
    info_.domain = model_->opaque() ? sqt::Domain::hemisphere : sqt::Domain::sphere;
    info_.isotropic = info_.bilateral = rotation_does_not_matter();
    if (model_->has_delta()) find_dirac();
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    if (!(out.z > 0) || in.z == 0 || (in.z < 0 && info_.domain == sqt::Domain::hemisphere)) {
      f[0] = std::nan("");
      return;
    }
    float w = 0;
    model_->eval(out, in, {&w, 1});
    f[0] = w / std::fabs(in.z);
  }
  sqt::Dirac dirac() const override { return dirac_; }
  void dirac_total(Dir out, std::span<double> W) const override {
    const auto drawn = draw_dirac(out);
    float w = 0;
    if (drawn) model_->delta_weight(out, drawn->lobe, 0, {&w, 1});
    W[0] = w;
  }

 private:
  // One draw of the model's Dirac lobe, if it makes any.
  std::optional<ScatterModel::Sample> draw_dirac(Dir out) const {
    for (int k = 0; k < 64; ++k) {
      const auto s = model_->sample(out, {0.5, 0.5}, (k + 0.5) / 64, 0);
      if (s && s->delta) return s;
    }
    return std::nullopt;
  }
  // Which way the lobe points; a fitted file holds one, of three directions.
  void find_dirac() {
    for (const double theta : {0.3, 0.8, 1.3}) {
      const Dir out = dir_from_angles(theta, 0.4);
      for (int k = 0; k < 64; ++k) {
        const auto s = model_->sample(out, {0.5, 0.5}, (k + 0.5) / 64, 0);
        if (!s || !s->delta) continue;
        const sqt::Dirac kind = length(s->in - Dir{-out.x, -out.y, out.z}) < 1e-6 ? sqt::Dirac::mirror
                                : length(s->in - out) < 1e-6                      ? sqt::Dirac::retro
                                : length(s->in + out) < 1e-6                      ? sqt::Dirac::through
                                                                                  : sqt::Dirac::none;
        if (kind == sqt::Dirac::none || (dirac_ != sqt::Dirac::none && kind != dirac_))
          throw Error(
              "model '" + info_.name + "' has Dirac lobes that a fitted file cannot hold",
              "one lobe is possible: in the mirror direction, back to the viewer, or straight on; use the model "
              "itself in the scene");
        dirac_ = kind;
      }
    }
  }
  bool rotation_does_not_matter() const {
    auto w = [&](Dir out, Dir in) {
      float v = 0;
      model_->eval(out, in, {&v, 1});
      return static_cast<double>(v);
    };
    for (int k = 0; k < 60; ++k) {
      const double a = 0.1 + 0.023 * k, b = 1.4 - 0.021 * k, phi = 0.37 * k, turn = 1.1 * k;
      const double plain = w(dir_from_angles(a, 0), dir_from_angles(b, phi));
      if (std::fabs(w(dir_from_angles(a, turn), dir_from_angles(b, phi + turn)) - plain) > 1e-4 * plain + 1e-7)
        return false;
    }
    return true;
  }

  std::unique_ptr<const ScatterModel> model_;
  Info info_;
  sqt::Dirac dirac_ = sqt::Dirac::none;
};

class PhaseModelFunction final : public sqt::Function {
 public:
  PhaseModelFunction(const ModelSpec& spec, const SpectralState& state, std::string text)
      : phase_(bake_phase(spec, state)) {
    info_.name = spec.model;
    info_.source = "phase function " + std::move(text) + ", evaluated where asked; straight on is in = -out";
    info_.wavelength_um = {state.reference_um};
    info_.domain = sqt::Domain::sphere;
    info_.quantity = sqt::Quantity::phase;
  }
  const Info& info() const override { return info_; }
  void value(Dir out, Dir in, std::span<double> f) const override {
    float p = 0;
    phase_->eval(std::clamp(scattering_cosine(out, in), -1.0, 1.0), {&p, 1});
    f[0] = p;
  }

 private:
  std::unique_ptr<const PhaseFunction> phase_;
  Info info_;
};

// A model, or else a phase function.
bool is_phase(const std::string& name, const Where& where) {
  if (name == "sqt") throw Error(where, "'sqt' is what a fit makes", "sqt-inspect looks into .sqt files");
  if (phases().look_up(name)) return true;
  if (models().look_up(name)) return false;
  std::vector<std::string> known;
  for (const ModelRow& row : models())
    if (row.name != "sqt") known.push_back(row.name);
  for (const PhaseRow& row : phases())
    if (row.name != "sqt") known.push_back(row.name);
  throw Error(where, "unknown model '" + name + "'", name_hint(name, known), "OP101");
}

// "param=number,param=number"; or "table=text", the text up to the end.
void read_parameters(const std::string& text, const Where& where, ModelSpec& spec) {
  if (text.starts_with("table=")) {
    spec.texts["table"] = text.substr(6);
    return;
  }
  for (size_t at = 0; at <= text.size();) {
    const size_t next = std::min(text.find(',', at), text.size());
    const std::string item = text.substr(at, next - at);
    const size_t equals = item.find('=');
    char* end = nullptr;
    const double value = equals == std::string::npos ? 0 : std::strtod(item.c_str() + equals + 1, &end);
    if (equals == std::string::npos || equals == 0 || end == item.c_str() + equals + 1 || *end || !std::isfinite(value))
      throw Error(where, "'" + item + "' is not PARAM=NUMBER");
    if (!spec.numbers.emplace(item.substr(0, equals), value).second)
      throw Error(where, "'" + item.substr(0, equals) + "' is given twice");
    at = next + 1;
  }
}

}  // namespace

std::shared_ptr<const sqt::Function> model_function(const std::string& text) {
  ModelSpec spec;
  const size_t colon = text.find(':');
  spec.model = text.substr(0, colon);
  // Tables are long: messages and provenance show how they begin.
  const std::string shown = text.size() > 120 ? text.substr(0, 120) + "..." : text;
  const Where where{"--model " + shown, 0, 0, {}, -1};
  const bool phase = is_phase(spec.model, where);
  if (colon != std::string::npos) read_parameters(text.substr(colon + 1), where, spec);
  phase ? check_phase(spec, where) : check_model(spec, where);
  SpectralState state;
  state.low_um = 0.5495, state.high_um = 0.5505, state.reference_um = 0.55;
  state.bins = {{0.5495, 0.5505}};
  state.knots = {0};
  try {
    if (phase) return std::make_shared<PhaseModelFunction>(spec, state, shown);
    return std::make_shared<ModelFunction>(spec, state, shown);
  } catch (const Error& e) {  // models know nothing of command lines
    if (!e.where().file.empty()) throw;
    throw Error(where, e.message(), e.hint(), e.code());
  }
}

}  // namespace suite
