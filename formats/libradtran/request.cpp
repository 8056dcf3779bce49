#include "formats/libradtran/request.h"

#include <algorithm>

#include "base/text_lines.h"

namespace suite {

namespace {

class Parser {
 public:
  Parser(std::string_view input, const std::string& name) : lines_(input, name) {}

  LibradtranRequest parse() {
    while (lines_.next()) option(std::string(lines_.word(0)));
    if (!per_) r_.per = r_.thermal ? LibradtranRequest::Per::wavenumber : LibradtranRequest::Per::nanometre;
    if (r_.columns.empty()) default_columns();
    return std::move(r_);
  }

 private:
  std::string word(size_t i) const {
    if (i >= lines_.words()) throw lines_.error(i, "'" + std::string(lines_.word(0)) + "' without its value");
    return std::string(lines_.word(i));
  }
  std::vector<double> numbers(double low, double high) const {
    std::vector<double> values;
    for (size_t i = 1; i < lines_.words(); ++i) values.push_back(lines_.number_in(i, "an angle", low, high));
    if (values.empty()) word(1);
    return values;
  }

  void option(const std::string& name) {
    if (name == "include") throw lines_.error(1, "the input includes another file", "one file with all options");
    if (name == "output_format" && word(1) != "ascii")
      throw lines_.error(1, "output in format '" + word(1) + "' is not read", "ascii");
    if (name == "output_user")
      for (size_t i = 1; i < lines_.words(); ++i) r_.columns.push_back(word(i));
    if (name == "output_quantity") quantity(word(1));
    if (name == "output_process") process(word(1));
    if (name == "source") source();
    if (name == "mol_abs_param") molecules(word(1));
    if (name == "rte_solver") solver_ = word(1);
    if (name == "umu") r_.umu = numbers(-1, 1);
    if (name == "phi") r_.phi = numbers(-360, 720);
    if (name == "phi0") r_.phi0 = lines_.number_in(1, "the Sun's azimuth", -360, 720);
    if (name == "sza") r_.solar_zenith = lines_.number_in(1, "the solar zenith angle", 0, 180);
    if (name == "zout" || name == "zout_sea") levels();
  }
  void quantity(const std::string& q) {
    using Quantity = LibradtranRequest::Quantity;
    if (q == "transmittance")
      r_.quantity = Quantity::transmittance;
    else if (q == "reflectivity")
      r_.quantity = Quantity::reflectivity;
    else if (q == "brightness")
      r_.quantity = Quantity::brightness;
    else
      throw lines_.error(1, "unknown output_quantity '" + q + "'", "transmittance, reflectivity or brightness");
  }
  void process(const std::string& p) {
    if (p == "none") return;
    if (p == "per_nm")
      r_.per = LibradtranRequest::Per::nanometre;
    else if (p == "per_cm-1")
      r_.per = LibradtranRequest::Per::wavenumber;
    else
      throw lines_.error(1, "'output_process " + p + "' makes no spectrum", "per_nm or per_cm-1");
    per_ = true;
  }
  void source() {
    r_.thermal = word(1) == "thermal";
    if (!r_.thermal && word(1) != "solar")
      throw lines_.error(1, "unknown source '" + word(1) + "'", "solar or thermal");
    if (per_) return;
    for (size_t i = 2; i < lines_.words(); ++i)
      if (word(i).starts_with("per_")) {
        process(word(i));
        per_ = true;
      }
  }
  void molecules(const std::string& m) {
    for (const char* band : {"kato", "fu", "avhrr"})
      if (m.starts_with(band))
        throw lines_.error(1, "'mol_abs_param " + m + "' gives sums over bands, no spectrum",
                           "reptran, lowtran or crs");
  }
  void levels() {
    const std::string first = word(1);
    for (const char* many : {"atm_levels", "all_levels", "model_levels", "model_layers", "model_levels_and_layers"})
      if (first == many) return;
    r_.levels = lines_.words() - 1;
  }
  void default_columns() {
    if (solver_ == "polradtran" || solver_ == "null" || solver_ == "sslidar")
      throw lines_.error_at_end("the default output of rte_solver " + solver_ + " is not read", "output_user");
    if (solver_ == "twostr")
      r_.columns = {"lambda", "edir", "edn", "eup", "uavg"};
    else
      r_.columns = {"lambda", "edir", "edn", "eup", "uavgdir", "uavgdn", "uavgup"};
    r_.radiance_lines = !r_.umu.empty() && solver_ != "twostr";
  }

  TextLines lines_;
  LibradtranRequest r_;
  std::string solver_ = "disort";
  bool per_ = false;
};

}  // namespace

LibradtranRequest parse_libradtran_request(std::string_view input, const std::string& name) {
  return Parser(input, name).parse();
}

}  // namespace suite
