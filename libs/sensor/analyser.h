// What stands before detectors that see polarisation: elements in the order in which light meets them, one train for a
// whole array, for each detector of a repeating grid, or for each frame of a wheel.
#pragma once
#include <cstdint>
#include <vector>

#include "base/params.h"
#include "math/mueller.h"
#include "spectral/state.h"

namespace suite {

// An element by its matrix; one with `path_um` is a retarder whose phase is 2 pi path_um / wavelength.
struct OpticalElement {
  Mueller matrix = Mueller::identity();
  double path_um = 0, axis = 0;  // um; rad from the frame's first axis, counter-clockwise as the receiver sees it
  Mueller at(double wavelength_um) const;
};

class AnalyserTrain {
 public:
  explicit AnalyserTrain(std::vector<OpticalElement> elements) : elements_(std::move(elements)) {}
  Mueller at(double wavelength_um) const;
  bool follows_wavelength() const;
  // What a detector counts of I, Q, U and V in a band: the first row, averaged over the response.
  Stokes row(const Band& band) const;

 private:
  std::vector<OpticalElement> elements_;
};

// Keys polarizer_deg (with extinction) and retarder_deg (with axis_deg), which comes first; or elements: a list of
// {polarizer_deg, extinction}, {retarder_deg | retarder_um, axis_deg}, {mueller: [16 numbers, row by row]} and
// {transmission}. Error, located: an element that is none of them or could not exist.
AnalyserTrain read_train(const Params& p);

struct Analysers {
  uint32_t columns = 1, rows = 1;  // of a grid that repeats over the array
  bool wheel = false;              // trains follow one another from frame to frame
  std::vector<AnalyserTrain> trains;
  // Number of the train before a detector in a frame.
  size_t of(uint32_t column, uint32_t row, uint64_t frame) const {
    if (wheel) return frame % trains.size();
    return size_t{row % rows} * columns + column % columns;
  }
};
// Key `analyser`: a train, or {grid: [[...], ...], extinction, tilt_deg} of angles of polarizers in degrees or trains,
// or {wheel: [...], extinction, tilt_deg}. Error, located: rows of a grid that differ in length.
Analysers read_analysers(const Params& p);

}  // namespace suite
