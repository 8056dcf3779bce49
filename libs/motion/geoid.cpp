#include "motion/geoid.h"

#include <GeographicLib/Geoid.hpp>
#include <filesystem>

#include "base/error.h"

namespace suite {

struct Geoid::Grid {
  // Read as a whole, so that it may be asked from many threads. The library compares the size of the file with the
  // header first.
  Grid(const std::string& name, const std::string& folder) : grid(name, folder, true, true) {}
  GeographicLib::Geoid grid;
};

Geoid::Geoid(const std::string& path) {
  namespace fs = std::filesystem;
  const Where where{path, 0, 0, {}, -1};
  std::error_code fault;
  if (!fs::is_regular_file(path, fault))
    throw Error(
        where, "there is no such grid of geoid heights",
        "egm96-5.pgm (19 MB) and others are had from https://geographiclib.sourceforge.io/C++/doc/geoid.html, or "
        "by 'geographiclib-get-geoids egm96-5' of Debian's geographiclib-tools");
  if (fs::path(path).extension() != ".pgm")
    throw Error(where, "is no grid of geoid heights by its name", "one of GeographicLib's .pgm files is expected");
  const fs::path folder = fs::path(path).parent_path();
  try {
    grid_ = std::make_shared<const Grid>(fs::path(path).stem().string(), folder.empty() ? "." : folder.string());
    description_ = grid_->grid.Description();
  } catch (const std::exception& e) {  // the library's own, or no memory for what a header says
    throw Error(where, std::string("cannot be read as a grid of geoid heights: ") + printable(e.what()),
                "one of GeographicLib's .pgm files is expected");
  }
}

double Geoid::height_m(double latitude_deg, double longitude_deg) const {
  return grid_->grid(latitude_deg, longitude_deg);
}

}  // namespace suite
