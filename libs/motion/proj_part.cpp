// The part `proj`: all calls of PROJ. https://proj.org/en/stable/development/reference/functions.html
#include "motion/proj_part.h"

#include <proj.h>

#include <cmath>

#include "base/late_part.h"

namespace suite {

namespace {

struct Opened {
  PJ_CONTEXT* context = nullptr;
  PJ* transform = nullptr;
  ~Opened() {
    if (transform) proj_destroy(transform);
    if (context) proj_context_destroy(context);
  }
};

std::string name_of(const PJ* crs) {
  const char* const name = proj_get_name(crs);
  return name ? name : "";
}

std::string fault_of(PJ_CONTEXT* context) {
  const int code = proj_context_errno(context);
  const char* const text = code ? proj_context_errno_string(context, code) : nullptr;
  return text ? text : "it is not in PROJ's database";
}

bool is_geographic(PJ_TYPE type) { return type == PJ_TYPE_GEOGRAPHIC_2D_CRS || type == PJ_TYPE_GEOGRAPHIC_3D_CRS; }

// The horizontal part of a system; `system` gets what is known of it.
PJ* horizontal_of(PJ_CONTEXT* context, PJ* crs, ProjSystem& system) {
  system.name = name_of(crs);
  PJ* flat = crs;
  if (proj_get_type(crs) == PJ_TYPE_COMPOUND_CRS) {
    flat = proj_crs_get_sub_crs(context, crs, 0);
    if (PJ* const vertical = proj_crs_get_sub_crs(context, crs, 1)) {
      system.heights = name_of(vertical);
      proj_destroy(vertical);
    }
    proj_destroy(crs);
  }
  const PJ_TYPE type = flat ? proj_get_type(flat) : PJ_TYPE_UNKNOWN;
  system.geographic = is_geographic(type), system.ellipsoidal = type == PJ_TYPE_GEOGRAPHIC_3D_CRS;
  if (system.geographic || type == PJ_TYPE_PROJECTED_CRS) return flat;
  if (flat) proj_destroy(flat);
  return nullptr;
}

void* open(int epsg, ProjSystem& system, std::string& fault) {
  auto* const opened = new Opened;
  const auto fail = [&](const std::string& why) -> void* {
    fault = why;
    delete opened;
    return nullptr;
  };
  PJ_CONTEXT* const context = opened->context = proj_context_create();
  if (!context) return fail("PROJ cannot be started");
  proj_log_level(context, PJ_LOG_NONE);
  proj_context_set_enable_network(context, 0);  // the same answer everywhere
  PJ* const crs = proj_create(context, ("EPSG:" + std::to_string(epsg)).c_str());
  if (!crs) return fail(fault_of(context));
  PJ* const flat = horizontal_of(context, crs, system);
  if (!flat) return fail("it is neither projected nor geographic");
  PJ* const earth = proj_create(context, "EPSG:4326");
  PJ* const plain = earth ? proj_create_crs_to_crs_from_pj(context, flat, earth, nullptr, nullptr) : nullptr;
  proj_destroy(flat);
  if (earth) proj_destroy(earth);
  if (!plain) return fail("PROJ knows no way from it to WGS84: " + fault_of(context));
  opened->transform = proj_normalize_for_visualization(context, plain);  // east before north on both sides
  proj_destroy(plain);
  return opened->transform ? opened : fail(fault_of(context));
}

bool to_wgs84(void* opened, double x, double y, double& latitude_deg, double& longitude_deg) {
  PJ* const transform = static_cast<Opened*>(opened)->transform;
  proj_errno_reset(transform);
  const PJ_COORD to = proj_trans(transform, PJ_FWD, proj_coord(x, y, 0, HUGE_VAL));
  longitude_deg = to.xy.x, latitude_deg = to.xy.y;
  return std::isfinite(latitude_deg) && std::isfinite(longitude_deg);
}

void describe(void* opened, std::string& how, double& accuracy_m) {
  auto* const all = static_cast<Opened*>(opened);
  how.clear(), accuracy_m = -1;
#if PROJ_VERSION_MAJOR > 9 || (PROJ_VERSION_MAJOR == 9 && PROJ_VERSION_MINOR >= 1)
  if (PJ* const used = proj_trans_get_last_used_operation(all->transform)) {
    how = name_of(used);
    if (how.empty() || how == "unknown") {
      const char* const description = proj_pj_info(used).description;
      how = description ? description : "";
    }
    accuracy_m = proj_coordoperation_get_accuracy(all->context, used);
    proj_destroy(used);
  }
#endif
}

void close(void* opened) { delete static_cast<Opened*>(opened); }

}  // namespace

SUITE_PART_VERSION;
extern "C" {
extern const ProjCalls suite_proj_calls;
const ProjCalls suite_proj_calls{open, to_wgs84, describe, close};
}

}  // namespace suite
