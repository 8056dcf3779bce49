// What runs paths, whatever the kernel that was made for a state (kernel.h): rays in, contributions out, rays to be
// traced asked for on the way.
#pragma once
#include <memory>

#include "light/environment.h"
#include "math/stokes_parts.h"
#include "sensor/sensor.h"
#include "transport/contribution.h"
#include "transport/lane.h"
#include "transport/options.h"
#include "transport/throughput.h"
#include "transport/trace_request.h"

namespace suite {

class FlatMirrors;
class GlossGuide;
class StokesThroughputs;

class PathTracing {
 public:
  virtual ~PathTracing() = default;
  // Starts path p (< width) with a sensor ray. sample: index within the stream of its problem and scramble.
  virtual void start(uint32_t p, const SensorRay& ray, const SampleStream& stream, uint32_t sample) = 0;
  // Takes all started paths on to the next rays to be traced; the request is to be served before the next call. False
  // when all of them have ended.
  virtual bool next(TraceRequest& request) = 0;
  virtual const PathRecord& record(uint32_t p) = 0;
  virtual const FirstMeeting& first(uint32_t p) const = 0;  // where keep_first was asked for
  // Nodes since the last call, and short rays that were traced to find out about touching bodies.
  virtual uint64_t take_nodes() = 0;
  virtual TraceStatistics take_statistics() = 0;
};

// What a kernel is made from. Everything referred to must outlive it.
struct KernelContext {
  const Surface& surface;
  const Optics& optics;
  const Environment& environment;
  const PipelineOptions& options;
  bool keep_first = false;  // truth wants to know the first surfaces
  bool receivers = false;   // rays may start at receivers
  bool branches = true;     // paths may go on in more than one way (techniques/splitting.h): their light is one sum
  bool waters = false;      // contributions are to tell what they have to do with water
  const GlossGuide* gloss = nullptr;        // null: no continuation is drawn towards light that glossy surfaces throw
  bool stokes = false;                      // paths carry polarisation: only by techniques that tell their matrices
  const FlatMirrors* mirrors = nullptr;     // null: far points are left to sensors straight ahead alone
  StokesParts parts = StokesParts::linear;  // of polarised paths, that the light of the air is to have
  size_t end = kNoLight;                    // the light that is an end of a laser radar
};

// Whether light may be lost (lost_light.h): a light that continuations hardly find, and surfaces that bend it.
bool may_lose(const KernelContext& context);
// Whether light is asked for through smooth interfaces (refracted/sight.h): there are both.
bool refracts(const KernelContext& context);
// Of a light: whether it is one that is.
inline bool is_refracted(const LightNature& light) { return light.placed || (light.far && light.drawn && !light.wide); }

// The kernel that serves a state best: "matte" or "general", and what fills space: "", "air", "lit air" (that knows the
// scene), "media", "media and lit air".
struct KernelChoice {
  bool matte = false;
  enum class Space : uint8_t { nothing, air, lit_air, field, lit_field } space = Space::nothing;
  bool in_media() const { return space == Space::field || space == Space::lit_field; }
  // Paths go back to places in the air (techniques/air_residual.h).
  bool goes_back() const { return space == Space::lit_air || space == Space::lit_field; }
  const char* name() const;
};
KernelChoice choose_kernel(const KernelContext& context);
std::unique_ptr<PathTracing> make_kernel(const KernelChoice& choice, const KernelContext& context, size_t width,
                                         SpectralThroughputs& throughputs, Sink<SpectralThroughputs>& sink);
// For Space::lit_field (kernels_lit_field.cpp).
std::unique_ptr<PathTracing> make_lit_field_kernel(const KernelContext& context, size_t width,
                                                   SpectralThroughputs& throughputs, Sink<SpectralThroughputs>& sink);
// For contexts with `stokes` (kernels_stokes.cpp).
std::unique_ptr<PathTracing> make_stokes_kernel(const KernelChoice& choice, const KernelContext& context, size_t width,
                                                StokesThroughputs& throughputs, Sink<StokesThroughputs>& sink);

}  // namespace suite
