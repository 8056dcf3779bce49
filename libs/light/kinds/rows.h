// The rows of the kinds that come with the suite, each made in its kind's own file. Internal to light_rows.
#pragma once
#include "light/light_rows.h"

namespace suite {

LightRow sun_row();
LightRow moon_row();
LightRow sky_table_row();
LightRow sky_clear_row();
LightRow sky_image_row();
LightRow sky_thermal_row();
LightRow night_sky_row();
LightRow lamp_point_row();
LightRow lamp_spot_row();
LightRow lamp_surface_row();

}  // namespace suite
