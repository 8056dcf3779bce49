// The page on polarisation says of every technique what it does in Stokes runs.
#include <gtest/gtest.h>

#include "support/polarisation_page.h"
#include "transport/technique_switches.h"

namespace suite::polarisation_page_test {
namespace {

TEST(PolarisationPage, SaysOfEveryTechniqueWhatItDoes) {
  EXPECT_EQ(test::names_on_page("Techniques"), test::row_names(named_techniques()));
}

}  // namespace
}  // namespace suite::polarisation_page_test
