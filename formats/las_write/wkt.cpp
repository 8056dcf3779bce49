// Based on: OGC 01-009, "Coordinate Transformation Services", 2001, section 7; parameters of EPSG 16001-16060 and
// 16101-16160 (UTM zones), 6326 (WGS 84) and 6258 (ETRS89).
#include "formats/las_write/las_write.h"
#include "motion/map_system.h"

namespace suite {

namespace {

std::string geographic(bool etrs) {
  return etrs
             ? "GEOGCS[\"ETRS89\",DATUM[\"European_Terrestrial_Reference_System_1989\",SPHEROID[\"GRS 1980\",6378137,"
               "298.257222101,AUTHORITY[\"EPSG\",\"7019\"]],AUTHORITY[\"EPSG\",\"6258\"]],PRIMEM[\"Greenwich\",0],UNIT["
               "\"degree\",0.0174532925199433],AUTHORITY[\"EPSG\",\"4258\"]]"
             : "GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS 84\",6378137,298.257223563,AUTHORITY[\"EPSG\","
               "\"7030\"]],AUTHORITY[\"EPSG\",\"6326\"]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433],"
               "AUTHORITY[\"EPSG\",\"4326\"]]";
}

}  // namespace

std::string wkt_of_epsg(int epsg) {
  if (epsg == 4326) return geographic(false);
  if (epsg == 4258) return geographic(true);
  const std::optional<UtmZone> zone = utm_zone_of_epsg(epsg);
  if (!zone) return {};
  const bool etrs = epsg >= 25828 && epsg <= 25838;
  return strf("PROJCS[\"%s / UTM zone %d%c\",", etrs ? "ETRS89" : "WGS 84", zone->zone, zone->north ? 'N' : 'S') +
         geographic(etrs) +
         strf(
             ",PROJECTION[\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_meridian\",%"
             "d],"
             "PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_northing\",%d],"
             "UNIT[\"metre\",1,AUTHORITY[\"EPSG\",\"9001\"]],AXIS[\"Easting\",EAST],AXIS[\"Northing\",NORTH],"
             "AUTHORITY[\"EPSG\",\"%d\"]]",
             6 * zone->zone - 183, zone->north ? 0 : 10000000, epsg);
}

std::string wkt_of_local_scene() {
  return "LOCAL_CS[\"scene ENU\",LOCAL_DATUM[\"scene\",0],UNIT[\"metre\",1],AXIS[\"East\",EAST],AXIS[\"North\",NORTH],"
         "AXIS[\"Up\",UP]]";
}

}  // namespace suite
