// The state of a run in an HDF5 file (FORMAT.md): pilots, sums per scramble, counts and truth of every problem, so that
// a run can be continued with the same bits as one that never stopped.
//
// The file is made whole, with all its columns at their final size, and its values are overwritten in place from then
// on: the structure of the file never changes while a run writes, so a run may be killed at any moment.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scheduler/scheduler.h"

namespace suite {

// What a state belongs to: "scene", "simulation", "seed", "build", "engine", ... A state is continued only when all are
// equal; the first that differs is named in the Error.
using StateIdentity = std::map<std::string, std::string>;

enum class StateUse {
  start,   // a new state, which replaces one that stands there
  resume,  // finish a run as it was begun
  extend,  // continue with another budget
};

// The budget of the run that a state belongs to, as it was when the state was made or extended last. Error: of another
// scene, simulation, seed, build or engine; damaged.
Budget read_state_budget(const std::string& path, const StateIdentity& identity);

// A state for a run. The file is made, checked or widened when the run tells its shapes. Errors then: no room on the
// disk; a state of another run; damaged; in use by another run.
std::unique_ptr<StateStore> make_state(const std::string& path, StateUse use, const StateIdentity& identity,
                                       const Budget& budget);

}  // namespace suite
