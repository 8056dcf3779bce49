// What tests of weather say all the time.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "heat/weather.h"
#include "support/message_of.h"

namespace suite {

using Q = WeatherQuantity;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

}  // namespace suite
