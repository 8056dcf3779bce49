// What a table of weather does not say, filled in by named models, and what contradicts itself, refused or said.
#pragma once
#include "heat/sky_models.h"
#include "heat/sun_table.h"
#include "heat/weather_table.h"

namespace suite {

// In this order, each with a note in the table that counts the rows:
//  - a value outside its range (weather_info), or light (above 10 W/m2) while all of the row's sun is 6 degrees below
//    the horizon: Error, located;
//  - values that are missing are counted; shortwave below 0 is 0 (the noise of instruments), humidity above 1 is 1, a
//    wind of 0 comes from nowhere;
//  - dew point from humidity and the other way round;
//  - direct and diffuse that differ from global by more than 15 % and 25 W/m2 are said; light whose daily middle is
//  more
//    than half an hour from noon, too, where 200 hours of it are there;
//  - the third of global, direct and diffuse from two; direct and diffuse from global alone (Erbs et al. 1982);
//  - downwelling longwave by `model`, without clouds where no cover is given.
// Of a body without air (WeatherTable::airless) the ranges alone, where pressure and longwave may be 0: neither the
// Earth's sun nor models of its air say anything of it.
void complete_weather(WeatherTable& table, LongwaveModel model, const SunTable& sun);

}  // namespace suite
