#include "bin_choice.h"

#include "base/diagnostics.h"
#include "base/run_app.h"
#include "scheduler/moments.h"

namespace suite {

void choose_bins_of(Sensor& sensor, BinChooser& chooser, BandBiases& biases) {
  const std::vector<BinReport> reports = chooser.choose(sensor);
  add_biases(reports, biases);
  for (const BinReport& r : reports) {
    note(r.text());
    if (r.met()) continue;
    if (r.through_gases) {
      emit({Dr::bins_through_gases,
            strf("sensor '%s': bands may be farther off than %g %%: %s; %s", r.sensor.c_str(), 100 * r.wanted,
                 r.missed_text().c_str(),
                 r.chosen ? "their errors include it"
                          : "their errors include it; leave out spectral_step_um or give a smaller one")});
      continue;
    }
    emit({Dr::bins, strf("sensor '%s': band '%s' may be %.2g %% off (%s), %g %% is wanted; %s", r.sensor.c_str(),
                         r.band.c_str(), 100 * r.reached, r.under.c_str(), 100 * r.wanted,
                         r.chosen ? "more bins are not carried: its spectra have lines that are finer still"
                                  : "leave out 'spectral_error: 0' or give a smaller spectral_step_um")});
  }
}

AskedStates states_of(const Simulation& sim) {
  AskedStates asked;
  for (const auto& sensor : sim.sensors) asked.emplace_back(sensor->states().begin(), sensor->states().end());
  return asked;
}

void follow_heat(Simulation& sim, const Scene& scene, JobOptions& options, const AskedStates& asked) {
  const FoundHeat heat{options.heating.field ? options.heating.field->range()[1] : 0};
  if (!(heat.hottest > kSimulatedBelow)) return;
  note(strf("surfaces are as hot as %.0f K: bins, chosen for at most %g K, are chosen again", heat.hottest,
            kSimulatedBelow));
  const std::vector<SourceSpecs> standing = sources_at_all_times(sim.sources, scene);
  BinChooser chooser(scene, standing, heat);
  for (size_t s = 0; s < sim.sensors.size(); ++s) {
    for (size_t state = 0; state < asked[s].size(); ++state) sim.sensors[s]->take_state(state, asked[s][state]);
    choose_bins_of(*sim.sensors[s], chooser, options.biases);
  }
}

}  // namespace suite
