// In place of PROJ, where libgeotiff is linked statically (SUITE_PORTABLE). libgeotiff asks PROJ's database for the
// names and units of EPSG codes when it prints keys or makes definitions of them; this folder reads and writes keys by
// number, so none of these is ever called. PROJ would bring curl, SQLite and its database along.
#include "base/error.h"

extern "C" {
void proj_context_create() { SUITE_CHECK(false && "libgeotiff asks for PROJ"); }
void proj_context_destroy() { SUITE_CHECK(false && "libgeotiff asks for PROJ"); }
void proj_create_from_database() { SUITE_CHECK(false && "libgeotiff asks for PROJ"); }
void proj_destroy() { SUITE_CHECK(false && "libgeotiff asks for PROJ"); }
void proj_get_name() { SUITE_CHECK(false && "libgeotiff asks for PROJ"); }
void proj_uom_get_info_from_database() { SUITE_CHECK(false && "libgeotiff asks for PROJ"); }
}
