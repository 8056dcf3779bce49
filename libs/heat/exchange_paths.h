// The exchange of thermal infrared by paths: from every face, reflected by the true optics until they are absorbed or
// have left, however often that takes.
//
// Method: a path starts at a point of its face in a direction drawn as a Lambert surface emits, in one of the bins of
// the infrared drawn as the face emits in that direction; where it meets a surface it is absorbed with that surface's
// emissivity there, else goes on as the surface reflects; one number a path, stratified over those of a face, says when
// it is absorbed, so that in cavities that reflect much the shares hardly scatter. So ends what the face emits, and by
// reciprocity what it absorbs comes from there (exchange.h). Every end weighs the emissivity of its beginning.
//
// Assumes: shares of the bins in what is emitted are those of 300 K; media are passed by.
#pragma once
#include "heat/exchange.h"
#include "heat/heat_faces.h"
#include "heat/path_rows.h"
#include "surface/surface.h"

namespace suite {

struct PathOptions {
  uint32_t blocks = 8;  // strata of two halves each, for errors (path_numbers.h)
  uint32_t paths = 8;   // of a face in each; even
  uint64_t seed = 1;
  uint32_t half() const { return paths / 2; }
};

// Rows of paths [begin, end): of faces, or of those after them (path_rows.h).
struct FaceRange {
  size_t begin = 0, end = 0;
  size_t size() const { return end - begin; }
  bool operator==(const FaceRange&) const = default;
};

// What tracing took, as whole numbers: sums of pieces are the same in any order.
struct PathCount {
  uint64_t rays = 0;
  uint64_t unfinished = 0;  // millionths of the weight of a path, still reflected after kMostReflections
  PathCount operator-(const PathCount& o) const { return {rays - o.rays, unfinished - o.unfinished}; }
  PathCount& operator+=(const PathCount& o) { return rays += o.rays, unfinished += o.unfinished, *this; }
};

struct ExchangePaths {
  static constexpr size_t kTogether = 128;  // faces that are traced together
  uint32_t blocks = 0, paths = 0;
  PathRows rows;
  std::vector<uint32_t> ends;      // [row][block][path]: HeatFaces::end_at()
  std::vector<float> weights;      // the same; of a row they do not sum to anything in particular
  std::vector<double> emissivity;  // by face, hemispheric
  std::vector<double> area;        // m2, by face
  // By interval and face, for how much of it the face is there and rests, or empty (Elements::presence()): it emits as
  // if it always were, others see it for that.
  std::vector<std::vector<float>> presence;
  bool always_there(size_t face) const {  // of one interval
    return presence.empty() || presence.front().empty() || presence.front()[face] == 1;
  }
  PathCount count;
  double rays() const { return static_cast<double>(count.rays); }
  double unfinished() const;  // share of the weight that was absorbed where it was after kMostReflections

  // Those of an interval of rest alone.
  ExchangePaths in_interval(size_t interval) const;
  // Room for what faces that see changes have in later intervals, when it is known which these are.
  void make_more();
  // Without intervals of rest, as the next: of all paths, from both ends of what two faces exchange, so that what one
  // gives the other takes and rows still sum to 1 (where faces see so few others that both cannot be had, the latter).
  // exchange_reciprocity.cpp has the method.
  ExchangeMatrix matrix(size_t outsides) const;
  // What each face receives by the halves of its blocks, less one another and over 2, W/m2: the sum of the squares over
  // that of the blocks' number is the variance. To first order: shares of a row are taken for known but for their sum.
  // emitted: W/m2 by all ends, [end][part]; received: [face][part]; put(face, [block][part]), in parallel.
  // exchange_errors.cpp.
  void halves(std::span<const float> emitted, std::span<const float> received, size_t parts,
              const std::function<void(size_t face, std::span<const float> of_blocks)>& put) const;
  size_t faces() const { return emissivity.size(); }
};

// Rows of faces alone, of which it is to be found which see changes.
inline PathRows rows_of_faces(const Elements& elements, size_t faces) {
  PathRows rows;
  rows.faces = faces, rows.intervals = std::max<size_t>(1, elements.rests().size());
  if (elements.changing()) rows.changing.assign(faces, 0);
  return rows;
}

// Room for the paths of all faces, of which none is traced.
ExchangePaths untraced_exchange(const Elements& elements, const HeatFaces& faces, const PathOptions& options);
// Traces those of some rows; the range begins at a multiple of kTogether, and ends at one or with the faces; of rows
// after the faces', counted from these. In parallel, the same on any number of threads and in ranges of any size.
// progress: is told faces that are done; may be empty.
void trace_exchange(const Tracer& tracer, const Elements& elements, const HeatFaces& faces, const HeatOptics& optics,
                    const PathOptions& options, FaceRange range, ExchangePaths& out,
                    const std::function<void(size_t)>& progress = {});
// Of all rows.
ExchangePaths trace_exchange(const Tracer& tracer, const Elements& elements, const HeatFaces& faces,
                             const HeatOptics& optics, const PathOptions& options,
                             const std::function<void(size_t)>& progress = {});

}  // namespace suite
