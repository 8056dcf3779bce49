// What all lamps of a scene are together: their shapes, spectra and tree. For the files of lamps.h alone.
#pragma once
#include <unordered_map>

#include "light/kinds/lamp_carriers.h"
#include "light/kinds/lamp_images.h"
#include "light/kinds/lamp_shapes.h"
#include "light/kinds/lamps.h"

namespace suite {

struct Lamps::Core {
  std::vector<LampSpec> specs;
  std::vector<Frame> frames;                               // of the specs
  std::vector<std::vector<float>> spectra;                 // of the specs
  std::vector<std::unique_ptr<const PlacedLampMap>> maps;  // of the specs; null = none
  bool has_maps = false;
  std::vector<LampShape> shapes;  // as numbered in the tree
  std::unique_ptr<LightTree> tree;
  // Per object: the shapes of its triangles, kNone = does not glow or is not in the tree; one entry for exact surfaces.
  std::unordered_map<uint32_t, std::vector<uint32_t>> shape_of_triangle;
  std::vector<const float*> front, back;  // per material
  std::vector<uint32_t> spec_of_material;
  // Of a scene that repeats itself. Copies of an object at the sides of the cell are images of the first one.
  std::optional<Periodic> cell;
  std::unique_ptr<LampImages> images;
  std::unordered_map<uint32_t, std::pair<uint32_t, Vec3>> copy_of;  // per object: the first one, and the way to it
  LampCarriers carriers;                                            // of lamps that ride
  std::optional<TimeSpan> window;  // of the tracer: what is dark all through it is in no tree

  // While the lamps are gathered.
  std::vector<LightBounds> bounds;
  std::vector<LightProfile> profiles;

  explicit Core(const Tracer& tracer) : carriers(tracer.scene()), window(tracer.window()) {}
  void add_points(uint32_t spec, const Tracer& tracer);
  void add_riding(uint32_t spec, LampShape shape, const LightBounds& still, const Tracer& tracer);
  void add_material(uint32_t spec, const Scene& scene);
  void add_surfaces(const Tracer& tracer);
  uint32_t add(const LampShape& shape, LightBounds b);
  uint32_t shape_at(const Hit& hit) const;
  void add_map(const LampSpec& spec, const Scene& scene);
  // Of the light of a spec at a place; 0 = it is dark there and then.
  double brightness(uint32_t spec, Vec3 place, double time) const;
  // Names of sources (LightSample::source): the spec, or where it rides, behind all specs, the shape.
  uint32_t source_of(const LampShape& shape) const {
    if (!specs[shape.spec].stokes) return kUnpolarised;
    if (shape.carrier == kNone) return shape.spec;
    return static_cast<uint32_t>(specs.size() + static_cast<size_t>(&shape - shapes.data()));
  }
  uint32_t add_surface(std::optional<LampShape> shape, uint32_t spec, const Hit& middle, const Tracer& tracer);
};

}  // namespace suite
