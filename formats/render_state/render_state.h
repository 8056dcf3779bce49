// The state of a run in an HDF5 file (FORMAT.md): pilots, sums per scramble, counts and truth of every problem, so that
// a run can be continued with the same bits as one that never stopped, and parts of it can be joined to the whole.
//
// The file is made whole, with all its columns at their final size, and its values are overwritten in place from then
// on: the structure of the file never changes while a run writes, so a run may be killed at any moment.
#pragma once
#include <map>
#include <memory>
#include <optional>
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

// Whose share of a run a state holds.
struct StatePart {
  Share share;
  bool planned = false;   // it began with a plan, from a state of the whole
  bool finished = false;  // all that the share was to run is there
};

struct StateHead {
  Budget budget;                  // as it was when the state was made or extended last
  std::optional<StatePart> part;  // nothing = of the whole run
  uint32_t cap = 0;               // maximum of paths that a time budget was turned into; 0 = none
};

// What stands at the head of a state. Error: of another scene, simulation, seed, build or engine; damaged.
StateHead read_state_head(const std::string& path, const StateIdentity& identity);

// The one budget of states that are to be joined. Error, naming the state: of another run, not of a part, not finished,
// of another round than the first; a part that is missing or there twice.
Budget check_parts(const std::vector<std::string>& paths, const StateIdentity& identity);

struct StateSetup {
  StateUse use = StateUse::start;
  Budget budget = {};
  // Of a new state: whose share it will hold, and the states whose work it begins with (a part: with that of its share,
  // and with all plans).
  std::optional<StatePart> part = {};
  std::vector<std::string> from = {};
};

// A state for a run. The file is made, checked or widened when the run tells its shapes. Errors then: no room on the
// disk; a state of another run; damaged; in use by another run.
std::unique_ptr<StateStore> make_state(const std::string& path, const StateIdentity& identity, StateSetup setup);

}  // namespace suite
