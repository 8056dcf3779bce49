// The files of a run: radiance, its standard error, quality, truth, the sensors' own products, previews; cut into files
// as asked.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "facts.h"
#include "headers.h"

namespace suite {

class OutputWriter {
 public:
  // facts must outlive it.
  // biases: of the bands by their bins, for the headers.
  OutputWriter(std::string folder, OutputSpec spec, SceneNotes notes, const Facts& facts, BandBiases biases);
  ~OutputWriter();
  // Takes a finished capture; images whose rows are complete are written. Error: not writable, an unknown preview band.
  void take(const Delivery& delivery);
  void write_text(const TextFile& text);

 private:
  struct Image;
  OutputSpec::Files files_of(const ImageRows& rows) const;
  Image& image_of(const Delivery& delivery, const std::string& stem);
  EnviHeader common_header(const Image& image, const Delivery& delivery) const;
  void add_bias(const Image& image, const Delivery& delivery, EnviHeader& header) const;
  std::unique_ptr<EnviWriter> open(Image& image, const std::string& base, EnviHeader header) const;
  void open_radiance(Image& image, const Delivery& delivery, const std::string& base, const std::string& about) const;
  void open_truth(Image& image, const Delivery& delivery, const std::string& base, const EnviHeader& header,
                  const std::string& about) const;
  void append(Image& image, const Delivery& delivery) const;
  void add_acquisition_time(Image& image) const;
  void write_whole(Image& image, const std::string& base) const;
  void finish(Image& image, const std::string& base, std::span<const Band> bands);
  std::string folder_;
  OutputSpec spec_;
  SceneNotes notes_;
  const Facts& facts_;
  const BandBiases biases_;
  std::map<std::string, std::unique_ptr<Image>> open_;  // images of which rows are still to come
};

}  // namespace suite
