// Atmospheric conditions (.atm) and the atmospheres of plugins.
#include "formats/dirsig/simulation_writer.h"
#include "math/vec.h"

namespace suite::dirsig {

namespace {

// W/(cm2 um) in W/(m2 um).
constexpr double kPerSquareCm = 1e4;

struct Named {
  const char *theirs, *ours;
};
constexpr Named kProfiles[] = {{"tropical", "tropical"},
                               {"midlatitudesummer", "midlatitude_summer"},
                               {"midlatitudewinter", "midlatitude_winter"},
                               {"subarcticsummer", "subarctic_summer"},
                               {"subarcticwinter", "subarctic_winter"},
                               {"usstandard1976", "us_standard"},
                               {"usstandard", "us_standard"}};

}  // namespace

void SimulationWriter::read_atmosphere(const Item& atm) {
  if (atm.name != "atmosphericconditions")
    throw atm.error("the root is <" + atm.name + ">", "<atmosphericconditions> is expected");
  if (const Item* metadata = atm.find("metadata")) metadata->mark_all(Fate::ignored, "for people");
  for (const char* weather : {"uniformweather", "weather"})
    if (const Item* w = atm.find(weather)) read_weather(*w);
  if (const Item* uniform = atm.find("uniformradiativetransfer")) return read_uniform(*uniform);
  if (const Item* simple = atm.find("simpleradiativetransfer")) {
    simple->mark(Fate::approximated,
                 "U.S. standard air with rural haze of 23 km: DIRSIG's has no light from the sky in the visible, and "
                 "formulas of its own for transmission and path radiance");
    if (const Item* kelvin = simple->find("apparentskytemperature"))
      kelvin->mark(Fate::approximated, "the sky is as warm as the air of the profile makes it");
    return set_air({"us_standard", "rural", 23}, simple->where);
  }
  if (const Item* classic = atm.find("classicradiativetransfer")) {
    classic->mark(Fate::approximated, "the air that the deck asks for, computed here in place of MODTRAN");
    if (const Item* deck = classic->any({"tape5filename", "tape5file", "tape5"})) {
      const Item* inner = deck->find("filename");
      read_deck(inner ? *inner : *deck);
    } else {
      set_air({"us_standard", "rural", 23}, classic->where);
      classic->mark(Fate::unsupported, "no deck (tape5) is named: U.S. standard air with rural haze of 23 km");
    }
    for (const char* base : {"adbfilename", "adbfile", "adb", "databasefilename"})
      if (const Item* adb = classic->find(base))
        adb->mark_all(Fate::ignored, "the air is computed, not read from the database");
    return;
  }
  throw atm.error("no radiative transfer that is known here",
                  "uniformradiativetransfer, simpleradiativetransfer or classicradiativetransfer");
}

void SimulationWriter::read_uniform(const Item& uniform) {
  const Item &irradiance = uniform.at("hemisphereirradiance"), *share = uniform.find("skyfraction");
  const double all =
      kPerSquareCm * irradiance.number_in(0, 1e12, Fate::converted, "W/(cm2 um) on a plane facing the sun");
  const double sky = share ? share->number_in(0, 1) : 0;
  sun_.set("irradiance", Tree::number(all * (1 - sky), irradiance.where));
  sun_.set("collimated", Tree::flag(true, irradiance.where));
  if (all * (1 - sky) == 0) no_sun_ = true;
  if (sky > 0) {
    Tree uniform_sky = Tree::map(share->where);
    uniform_sky.set("radiance", Tree::number(all * sky / kPi, share->where));
    root_.set("sky", std::move(uniform_sky));
  }
}

void SimulationWriter::set_air(const DeckAir& air, const Where& where) {
  Tree made = Tree::map(where);
  made.set("profile", Tree::word(air.profile, where));
  if (!air.aerosol.empty()) {
    Tree& aerosol = made.set("aerosol", Tree::map(where));
    aerosol.set("model", Tree::word(air.aerosol, where));
    if (air.visibility_km) aerosol.set("visibility_km", Tree::number(*air.visibility_km, where));
  }
  root_.set("atmosphere", std::move(made));
}

void SimulationWriter::read_deck(const Item& named) {
  const std::string path = import_.file_of(named, folders_);
  set_air(help_.deck(path), named.where);
  Item account;
  account.name = "tape5";
  account.where = {path, 1, 1, {}, -1};
  Item& cards = account.children.emplace_back();
  cards.name = "cards", cards.where = account.where;
  cards.mark(Fate::approximated,
             "profile, aerosol and visibility of the first run; heights and angles are the scene's");
  if (!import_.known(path)) import_.keep(path, "deck of MODTRAN", std::move(account));
}

void SimulationWriter::read_new_atmosphere(const Item& inputs) {
  DeckAir air{"us_standard", "rural", 23};
  for (const char* key : {"info", "hdf_filename"})
    if (const Item* item = inputs.find(key))
      item->mark_all(Fate::ignored, "the air is computed, not read from a database");
  const Item* backend = inputs.find("backend");
  const Item* cards = backend ? backend->find("tape5_parameters") : nullptr;
  inputs.mark(Fate::approximated, "the air that is asked for, computed here in place of the backend");
  if (backend)
    for (const char* key : {"name", "modtran_profile", "extract_profile"})
      if (const Item* item = backend->find(key)) item->mark_all(Fate::ignored, "of the backend, which is not run");
  if (cards) {
    if (const Item* model = cards->find("atmospheric_model")) {
      const std::string low = lower_case(model->text(Fate::converted, "the AFGL profile of that name"));
      bool known = false;
      for (const Named& n : kProfiles)
        if (low == n.theirs) air.profile = n.ours, known = true;
      if (!known) model->mark(Fate::unsupported, "this profile is not known here: U.S. standard");
    }
    if (const Item* haze = cards->find("boundary_aerosol_model")) {
      const Item& type = haze->at("type");
      const std::string low = lower_case(type.text(Fate::converted));
      air.aerosol = low.starts_with("none")                                  ? ""
                    : low.starts_with("maritime") || low.starts_with("navy") ? "maritime"
                    : low.starts_with("urban")                               ? "urban"
                    : low.starts_with("desert")                              ? "desert"
                                                                             : "rural";
      const size_t vis = low.find("vis");
      const auto km = vis == low.npos ? std::nullopt
                                      : number_in_text(std::string_view(low).substr(vis + 3, low.find("km") - vis - 3));
      if (km) air.visibility_km = *km;
      if (const Item* parameters = haze->find("parameters"))
        parameters->mark_all(parameters->children.empty() ? Fate::exact : Fate::unsupported, "of the aerosol model");
    }
    if (const Item* scattering = cards->find("multiple_scattering"))
      scattering->mark_all(Fate::approximated, "the diffuse field is solved by discrete ordinates");
  }
  set_air(air, inputs.where);
}

}  // namespace suite::dirsig
