// The files of a run: radiance, its standard error, quality, truth, the sensors' own products, previews; cut into files
// as asked.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "formats/sim_text/sim_text.h"

namespace suite {

// What headers say about the scene.
struct SceneNotes {
  std::vector<std::string> materials, tags;
  GeodeticOrigin origin;
  std::string engine;  // the ray tracer
};

class OutputWriter {
 public:
  OutputWriter(std::string folder, OutputSpec spec, SceneNotes notes);
  ~OutputWriter();
  // Takes a finished capture; images whose rows are complete are written. Error: not writable, an unknown preview band.
  void take(const Delivery& delivery);
  void write_text(const TextFile& text);

 private:
  struct Image;
  Image& image_of(const Delivery& delivery, const std::string& stem);
  void write_whole(Image& image, const std::string& base);
  std::string folder_;
  OutputSpec spec_;
  SceneNotes notes_;
  std::map<std::string, std::unique_ptr<Image>> open_;  // images of which rows are still to come
};

}  // namespace suite
