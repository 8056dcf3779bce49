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

struct CaptureShape {
  uint32_t columns = 0, rows = 0;
  size_t bands = 0;
  int scrambles = 4;
  bool operator==(const CaptureShape&) const = default;
  size_t problems() const { return size_t{columns} * rows; }
};
std::vector<CaptureShape> shapes_of(std::span<const std::unique_ptr<Sensor>> sensors, const Budget& budget);

// Makes a new state file, empty. Error when the disk has no room for it.
void create_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::vector<CaptureShape>& shapes);

// The budget of the run that a state belongs to; as it was when the state was made or extended last.
Budget read_state_budget(const std::string& path, const StateIdentity& identity);

// Changes the budget of a state. Captures that need more scrambles than the file has room for make it be written anew.
void extend_state(const std::string& path, const StateIdentity& identity, const Budget& budget,
                  const std::vector<CaptureShape>& shapes);

// Opens a state to continue it. Error: of another scene, simulation, seed, build or engine; damaged; in use by another
// run.
std::unique_ptr<StateStore> open_state(const std::string& path, const StateIdentity& identity,
                                       const std::vector<CaptureShape>& shapes);

}  // namespace suite
