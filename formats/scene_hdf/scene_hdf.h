// The prepared scene as one HDF5 file. See FORMAT.md.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "formats/scene_hdf/needs.h"
#include "scene/draft.h"
#include "scene/scene.h"

namespace suite {

// What made a scene: no times and no paths, so that equal inputs give equal bytes.
struct Provenance {
  std::string generator;          // tool and version
  std::string arguments;          // canonical: file names without folders
  std::string input_sha256;       // over all inputs
  std::vector<InputFile> inputs;  // every file it was made from, the text itself without a name
};

// How hard datasets are packed: 0 not at all (loads at the speed of memory), deflate 1 (fast) to 9.
struct Compression {
  int level = 0;
  std::map<std::string, int> of;  // of a dataset, or of all below a group, e.g. "/geometry"; the longest name wins
  int of_dataset(const std::string& name) const;
  // Takes over "none", "deflate", "deflate:N" (6 without N) or one of these behind "DATASET="; Error for anything else.
  void add(const std::string& text);
  void check_names(const std::vector<std::string>& datasets) const;  // Error: `of` names none of these
};

// Written whole or not at all. Error when the place is not writable, or when a compression names no dataset.
void write_scene(const Scene& scene, const Provenance& provenance, const std::string& path,
                 const Compression& compression = {});

// Turns the bytes of an embedded SQT into its bundle; called once a file. name: for messages.
using BundleReader =
    std::function<std::shared_ptr<const sqt::Bundle>(std::span<const std::byte> bytes, const std::string& name)>;

// Reads and checks (sizes before allocating, every index) what the needs ask for; what they do not is left out of the
// scene as if it had never been there, and told in the report. Materials whose `file` names an embedded file get their
// `bundle` from decode; without decode it stays null. Error: no scene, another version, damaged.
Scene read_scene(const std::string& path, const BundleReader& decode = {}, const SceneNeeds& needs = {},
                 LoadReport* report = nullptr);
// Where second 0 and the zero of the frame are; reads attributes only.
struct SceneOrigin {
  GeodeticOrigin origin;
  std::string epoch;  // UTC, or empty
};
SceneOrigin read_scene_origin(const std::string& path);
// The attributes only; cheap.
Provenance read_provenance(const std::string& path);

}  // namespace suite
