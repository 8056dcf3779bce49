// --study: repeated runs against a reference.
#pragma once
#include "formats/sim_text/sim_text.h"
#include "options.h"
#include "study/compare.h"

namespace suite {

// Runs the study that the options ask for. collect: what the sensors of `sim` deliver their captures into; the study
// points it at an image of its own for every run. Writes study.csv, study.json, study.html and the reference.
int run_study_command(const RenderOptions& o, const std::shared_ptr<const Scene>& scene, const Simulation& sim,
                      const JobOptions& options, StudyImage*& collect);

}  // namespace suite
