// The page on polarisation says of every light what it is.
#include <gtest/gtest.h>

#include "light/light_rows.h"
#include "support/polarisation_page.h"

namespace suite::polarisation_page_test {
namespace {

TEST(PolarisationPage, SaysOfEveryLightWhatItIs) {
  EXPECT_EQ(test::names_on_page("Lights"), test::row_names(light_rows()));
}

}  // namespace
}  // namespace suite::polarisation_page_test
