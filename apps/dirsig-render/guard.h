// What keeps a run from doing harm or being lost: no input is replaced, there is room for the results, and a run that
// is cut short says what it left behind.
#pragma once
#include <optional>
#include <string>

#include "base/run_lock.h"
#include "formats/sim_text/sim_text.h"
#include "options.h"

namespace suite {

// As soon as the inputs are read: makes the folder of the results (of the study) and locks it for this run. Error:
// another run has it. UsageError: results would replace an input; a page or an account has an input's or a result's
// name.
RunLock lock_place(const RenderOptions& options, const Simulation& simulation);

// Refuses, before anything is rendered, a folder that has no room for the images, and sensors whose files would have
// the same names. pictures: there will be some (a part of a run has none).
void check_folder(const std::string& folder, const Simulation& simulation, bool pictures);

// Bytes that the images take; products of the sensors come on top.
double image_bytes(const Simulation& simulation);

// One sentence: how many of the captures are whole in the folder, and how the run goes on.
std::string what_is_left(const std::string& folder, size_t finished, size_t captures, const JobOptions& options);

// A fault without a place, as the simulation's: at the sensor one of whose bands reaches beyond a curve of the material
// or medium that the fault is about; at `periodic` where that is refused; at the sensor at which it was found, with its
// bands; else of the text as a whole.
Error located(const Error& fault, const Scene& scene, const Simulation& simulation,
              std::optional<size_t> sensor = std::nullopt);

// For --dry-run: refuses what lock_place() and check_folder() would, and writes nothing. Error: a folder that cannot be
// made or written to.
void check_place(const RenderOptions& options, const Simulation& simulation, bool pictures);

// A capture that could never be held, at its sensor.
void check_memory(const Simulation& simulation, const JobOptions& options);

}  // namespace suite
