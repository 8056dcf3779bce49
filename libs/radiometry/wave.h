// The working memory of one pass through the pipeline: the paths of a block of problems, their nodes, and the spectra
// that belong to the nodes. Allocated once per thread and block list, never inside the loop.
#pragma once
#include <cstdlib>
#include <memory>
#include <span>
#include <vector>

#include "radiometry/path.h"

namespace suite {

class Wave {
 public:
  // width: paths that run together; bins: of the spectral state.
  // media: paths travel through media; segments then carry spectra. missed: light may be lost (lost_light.h); nodes and
  // segments then carry what is known of it.
  Wave(size_t width, int max_nodes, size_t bins, bool media = false, bool missed = false);

  size_t width() const { return paths_.size(); }
  size_t bins() const { return bins_; }
  Path& path(size_t p) { return paths_[p]; }
  // Nodes of one depth stand side by side, as the stages of a pass visit them.
  Node& node(size_t p, int n) { return nodes_[place(p, n)]; }
  // w of the continuation at a node, where the model does not keep it; aligned to 32 bytes, padded to whole vectors.
  std::span<float> bounce(size_t p, int n) { return {at(2 * place(p, n)), bins_}; }
  // Radiance that explicit sources send along the path from this node.
  std::span<float> direct(size_t p, int n) { return {at(2 * place(p, n) + 1), bins_}; }
  // With media, segment n is all that lies between node n - 1 (the sensor for 0) and node n (or the end of the path),
  // however often the path was scattered there: what arrives from its far end is multiplied by `through`, then
  // `gathered` is added, light that was emitted and scattered into the path on the way.
  bool has_media() const { return !segments_.empty(); }
  std::span<float> through(size_t p, int n) { return {&segments_[2 * segment(p, n) * stride_], bins_}; }
  std::span<float> gathered(size_t p, int n) { return {&segments_[(2 * segment(p, n) + 1) * stride_], bins_}; }
  // Light that should have come from a node, or have been gathered on a segment, but did not arrive.
  bool has_missed() const { return !missed_.empty(); }
  std::span<float> missed(size_t p, int n) { return {&missed_[place(p, n) * stride_], bins_}; }
  std::span<float> missed_on_way(size_t p, int n) { return {&missed_on_way_[segment(p, n) * stride_], bins_}; }
  std::span<float> scratch() { return {at(2 * paths_.size() * static_cast<size_t>(max_nodes_)), bins_}; }
  std::span<float> scratch2() { return {at(2 * paths_.size() * static_cast<size_t>(max_nodes_) + 1), bins_}; }
  std::span<float> scratch3() { return {at(2 * paths_.size() * static_cast<size_t>(max_nodes_) + 2), bins_}; }

  // Rays of the current stage and what they belong to.
  std::vector<Ray> rays;
  std::vector<Hit> hits;
  std::vector<double> distance;
  std::vector<uint8_t> blocked;
  std::vector<uint32_t> owner;   // path of rays[i]
  std::vector<uint8_t> light;    // which ExplicitLight of its node
  std::vector<uint32_t> active;  // paths that go on

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  size_t place(size_t p, int n) const { return static_cast<size_t>(n) * paths_.size() + p; }
  size_t segment(size_t p, int n) const { return p * static_cast<size_t>(max_nodes_ + 1) + static_cast<size_t>(n); }
  float* at(size_t i) { return spectra_.get() + i * stride_; }
  size_t bins_, stride_;
  int max_nodes_;
  std::vector<Path> paths_;
  std::vector<Node> nodes_;
  std::unique_ptr<float[], Free> spectra_;
  std::vector<float> segments_, missed_, missed_on_way_;
};

}  // namespace suite
