// Which of a scene's objects are of some materials, and which of these stay where they are.
#pragma once
#include <functional>
#include <vector>

#include "trace/tracer.h"

namespace suite {

// The materials, and those that class maps turn into one of them; by index.
std::vector<bool> with_class_maps(const Scene& scene, const std::vector<bool>& materials);

// True of objects that have one of the materials somewhere. Keeps a reference to the scene.
std::function<bool(const TracedObject&)> made_of(const Scene& scene, std::vector<bool> materials);

// Of what hangs on a node: it may only come and go. Looked at at 17 times of the tracer's window.
bool stays_put(const Tracer& tracer, uint32_t object);

}  // namespace suite
