#include "formats/scene_hdf/needs.h"

#include <algorithm>

#include "base/error.h"
#include "base/progress.h"

namespace suite {

namespace {
struct Feature {
  const char *name, *text;
};
constexpr Feature kFeatures[] = {
    {"geometry",
     "Vertices, triangles, normals and exact surfaces. dirsig-render reads 64 MiB of them and less at once; of larger "
     "scenes the arrays of a mesh are read when a ray first comes to the tile where it stands (or at the start, when "
     "the "
     "mesh is a lamp), from the prepared scene, which is mapped and must not be cut until the end. Packed datasets are "
     "unpacked at once, of larger scenes into a file without a name."},
    {"tracks",
     "Motions: keyframes, spins, orbits and what they are composed of. All are read whenever something moves: the pose "
     "at one time may depend on keys far from it, and every window has to be covered. What is at rest has none."},
    {"texture coordinates",
     "Two floats a vertex. Needed by maps placed by UV (class, property and opacity maps) and by models that prefer a "
     "direction along the "
     "surface (ward or ggx with roughness_y, an anisotropic SQT). A mesh whose materials have none of these is read "
     "without; when a placement "
     "overrides materials by such a one, all meshes are read with them."},
    {"temperatures",
     "Constant temperatures, tables over time and temperature maps. Left out when a blackbody at the hottest of them "
     "stays below 1e-9 W/(m2 sr um) "
     "at the long end of every spectral window: a thousandth of a millionth of what any sensor here is asked to see."},
    {"layers",
     "Thermodynamic properties: conductivity, density, specific heat, layers. Needed by temperature models that "
     "conduct heat (slab) only."},
    {"cube channels",
     "Channels of reflectance cubes. Only those between the last channel below each spectral window and the first "
     "above it decide what a "
     "sensor sees; the others are left out, exactly, because spectra are linear between channels."},
    {"curves", "Points of spectral curves. Those beyond the spectral windows are dropped, but for one on either side."},
};
}  // namespace

uint64_t LoadReport::left_out() const {
  uint64_t sum = 0;
  for (const LoadRow& r : rows)
    if (!later || r.feature != "geometry") sum += r.stored - std::min(r.stored, r.read);
  return sum;
}

std::string LoadReport::text() const {
  std::string out;
  for (const LoadRow& r : rows) {
    if (r.stored == 0) continue;
    const char* verdict = later && r.feature == "geometry" ? "later"
                          : r.read == 0                    ? "left out"
                          : r.read < r.stored              ? "in part"
                                                           : "read";
    out += strf("%-20s %-9s %10s of %10s  %s\n", r.feature.c_str(), verdict,
                human_bytes(static_cast<double>(r.read)).c_str(), human_bytes(static_cast<double>(r.stored)).c_str(),
                r.why.c_str());
  }
  return out + strf("left out in all      %s\n", human_bytes(static_cast<double>(left_out())).c_str());
}

std::string LaterReads::text() const {
  return strf("geometry: %zu of %zu meshes were read (%s of %s)", meshes_read.load(), meshes,
              human_bytes(static_cast<double>(read.load())).c_str(), human_bytes(static_cast<double>(stored)).c_str());
}

std::string explain_feature(const std::string& feature) {
  std::vector<std::string> known;
  for (const Feature& f : kFeatures) {
    if (feature == f.name) return std::string(f.name) + ": " + f.text + "\n";
    known.push_back(f.name);
  }
  throw Error("unknown feature '" + feature + "'", name_hint(feature, known));
}

}  // namespace suite
