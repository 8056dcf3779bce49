// What a laser radar is, for whoever traces its pulses: the laser, the receiver, the gate, and when each pulse leaves.
//
// Frames: the poses of a pulse (ResponsePulse) take the body's frame (x right, y ahead, z up, looks along -z) to scene
// ENU. A deflector is part of the pose, so beam and field of view are about -z of the frame of emission and reception.
// Units: m, s, J, rad, um. Beams and pulses are normalised to 1; energy is apart.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/params.h"
#include "detection/pulse_shape.h"
#include "detection/response.h"
#include "math/vec.h"

namespace suite {

// How the energy of a pulse is spread over directions, far from the laser. Rotationally symmetric but for images.
struct BeamProfile {
  enum class Kind { top_hat, gaussian, image } kind = Kind::gaussian;
  double half_angle = 0;       // rad, edge of a top hat, 0..1.5; 0 = collimated
  double full_angle_1_e2 = 0;  // rad, of a Gaussian, at 1/e^2 of the energy density; 0 = collimated
  double waist = 0;            // m, radius at 1/e^2 at the laser; widens the beam nearby
  std::vector<double> image;   // energy of cells, row by row from above left, any sum > 0
  uint32_t columns = 0, rows = 0;
  double cell = 0;  // rad, edge of a cell of the image
};

// An ideal analyser before the detector: its channel has half of the photons of all light, and the half of what the
// Stokes vector says. Angles of linear ones go from the receiver's x towards its y, looking at it; plus: V > 0, which
// turns counter-clockwise as the receiver sees it.
enum class Analyser : uint8_t { linear_0, linear_45, linear_90, linear_135, circular_plus, circular_minus };
inline constexpr std::array kAnalyserNames{"linear_0",   "linear_45",     "linear_90",
                                           "linear_135", "circular_plus", "circular_minus"};

struct LaserSpec {
  double wavelength_um = 1.064;
  double width_um = 1e-4;  // of the line
  BeamProfile beam;
  Pose offset;  // from the laser's frame to the body's: baseline and boresight error
  // I, Q, U, V about the laser's x axis (math/mueller.h): +Q along it, +U half-way from it to -y, for light leaves
  // along -z.
  std::array<double, 4> stokes{1, 0, 0, 0};
};

struct LidarReceiver {
  double aperture = 0.1;            // m, diameter, > 0
  double obscuration = 0;           // share of the aperture's area that is covered, 0..1
  double throughput = 1;            // of the optics, 0..1
  double filter_um = 1e-3;          // full width of the filter about the laser's line, for passive light
  Pose offset;                      // from the receiver's frame to the body's
  std::vector<Analyser> analysers;  // each a channel
  // One detector behind a field stop: the full angle. With an array (columns > 0): pixels of `pitch` behind `focal`.
  double field_of_view = 1e-3;  // rad, above 0, at most 2
  uint32_t columns = 0, rows = 0;
  double pitch = 0, focal = 0;  // m
};

// What is traced of each pulse.
struct RangeGate {
  double start = 0, stop = 0;  // s after the emission
  double bin = 1e-10;          // s
};

enum class StartFrom { automatic, laser, receiver };

// The pulses of an instrument in the order of their emission. Const, callable from many threads.
class PulseTrain {
 public:
  virtual ~PulseTrain() = default;
  virtual uint64_t size() const = 0;
  // Time, energy, wavelength and the pose of emission; the pose of reception where light comes back after
  // `round_trip` s. `start` is the instrument's gate, or the pulse's own. Nothing: no beam leaves (a facet's edge).
  virtual std::optional<ResponsePulse> pulse(uint64_t i, double round_trip = 0) const = 0;
};

struct LidarInstrument {
  std::string name;
  LaserSpec laser;
  LidarReceiver receiver;
  RangeGate gate;
  std::shared_ptr<const PulseTrain> pulses;
  uint32_t paths = 64;  // a pulse and pixel, >= 2
  uint32_t orders = 8;  // scattering events at most; 1 = single scattering
  StartFrom start_from = StartFrom::automatic;
  std::vector<std::string> tags;  // of materials with a channel of their own
  std::optional<Utc> epoch;
  // The map of the text, of which detection reads the rest; nothing: there is none.
  std::optional<Params> detection;
};

// Whether paths carry polarisation.
inline bool polarised(const LidarInstrument& i) {
  return !i.receiver.analysers.empty() || i.laser.stokes != std::array<double, 4>{1, 0, 0, 0};
}

// What is wrong, as the end of a sentence; empty when nothing is.
std::string fault_of(const LidarInstrument& instrument);

}  // namespace suite
