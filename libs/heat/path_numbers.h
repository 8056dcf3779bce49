// Which random numbers a path of a face has, so that few paths tell much, and how far off they are.
//
// Method: blocks of a face's paths are strata: equal parts of what a path starts with (its direction, or the point that
// looks at the sun). In each there are two halves of paths that know nothing of each other. What the halves of a
// stratum differ by tells the variance of their mean without bias, and the strata add up (two units a stratum, e.g.
// W. G. Cochran, Sampling techniques, 3rd edition, 1977, chapter 5). All other numbers of a path are those of one
// scrambled net over all strata (math/sampling.h), one for each half: they are spread more evenly than the error knows.
#pragma once
#include "heat/elements.h"
#include "heat/exchange_paths.h"
#include "heat/heat_walk.h"
#include "heat/strata.h"
#include "math/sampling.h"

namespace suite {

class PathNumbers {
 public:
  // within: number of the path among those of its face, [block][half][path]. face: hashed.
  PathNumbers(const PathOptions& options, uint64_t purpose, uint64_t face, uint32_t within)
      : options_(options),
        block_(within / options.paths),
        half_(within % options.paths / options.half()),
        number_(within % options.half()),
        net_(options.seed, purpose, face, half_),
        own_(options.seed, purpose, face, 2 + half_ * options.blocks + block_) {}

  uint32_t block() const { return block_; }
  uint32_t half() const { return half_; }
  // Of the paths of its half in all strata.
  const SampleStream& net() const { return net_; }
  uint32_t sample() const { return number_ * options_.blocks + block_; }
  // Where on the unit square it starts: on all of it for the strata together.
  Vec2 first_direction() const {
    static constexpr uint8_t kBoth[] = {0, 1};
    std::array<double, 4> u = own_.draw(number_, 0);
    put_in_stratum(u, kBoth, block_, options_.blocks);
    return {u[0], u[1]};
  }
  // Which point of its element it starts from: of all of it for the strata together. Not to be kept longer than this.
  PointDraw first_point(uint32_t interval = kNone) const {
    return {own_, number_, kPointBlock, block_, options_.blocks, interval};
  }

 private:
  const PathOptions& options_;
  uint32_t block_, half_, number_;
  SampleStream net_, own_;  // of its half in all strata, of that in its own
};

}  // namespace suite
