// What materials say of their heat, and what is wrong with it.
#include "heat/heated_material.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/heat_kit.h"
#include "support/message_of.h"
#include "support/slab_kit.h"

namespace suite::heated_material_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Texts = std::map<std::string, std::string>;
using Numbers = std::map<std::string, double>;

TemperatureSpec spec(Numbers numbers, Texts texts = {}, std::vector<SlabLayer> layers = {}) {
  TemperatureSpec s;
  s.model = "heat";
  s.numbers = std::move(numbers), s.texts = std::move(texts), s.layers = std::move(layers);
  return s;
}
const Numbers kLayer{
    {"thickness_m", 0.1}, {"density_kg_m3", 2000}, {"specific_heat_j_kg_k", 900}, {"conductivity_w_m_k", 1.5}};
Numbers with(Numbers more) {
  more.insert(kLayer.begin(), kLayer.end());
  return more;
}

TEST(HeatedMaterial, Defaults) {
  const HeatedMaterial m = heated_material(spec({}));
  EXPECT_TRUE(m.layers.empty());
  EXPECT_FALSE(m.back_open);
  EXPECT_EQ(m.behind.kind, BackCondition::Kind::flux);
  EXPECT_EQ(m.behind.value, 0);
  ASSERT_TRUE(m.front.convection);
  EXPECT_NEAR(m.front.convection->coefficient({300, 300, 0}), 5.62, 0.01) << "McAdams, smooth";
  EXPECT_FALSE(m.absorptance || m.emissivity);
}

TEST(HeatedMaterial, WhatIsSaidIsThere) {
  HeatedMaterial m = heated_material(spec(with({{"wetness", 0}, {"source_w_m2", 30}, {"absorptance", 0.7}}),
                                          {{"convection", "none"}, {"back", "open"}}));
  ASSERT_EQ(m.layers.size(), 1u);
  EXPECT_EQ(m.layers[0].density, 2000);
  EXPECT_TRUE(m.back_open);
  EXPECT_FALSE(m.front.convection || m.back.convection);
  EXPECT_EQ(m.source, 30);
  EXPECT_EQ(m.absorptance, 0.7);
  m = heated_material(spec(with({{"back_k", 294}, {"back_film_w_m2_k", 8}}), {{"back", "air"}}));
  EXPECT_EQ(m.behind.kind, BackCondition::Kind::air);
  EXPECT_EQ(m.behind.film, 8);
  m = heated_material(spec(with({{"back_k", 285}}), {{"back", "ground"}}));
  EXPECT_EQ(m.behind.kind, BackCondition::Kind::held);
  m = heated_material(spec(with({{"back_flux_w_m2", -5}}), {{"back", "flux"}}));
  EXPECT_EQ(m.behind.value, -5);
  m = heated_material(spec({{"still_w_m2_k", 4}, {"wind_j_m3_k", 2}}, {{"convection", "constant"}}));
  EXPECT_EQ(m.front.convection->coefficient({300, 300, 3}), 10);
  EXPECT_EQ(heated_material(spec({{"wetness", 0.4}})).front.wetness, 0.4);
  m = heated_material(spec({}, {{"convection", "tarp"}, {"roughness", "very_smooth"}}));
  EXPECT_TRUE(m.front.convection->asks_surface());
}

TEST(HeatedMaterial, Messages) {
  const Where where{"s.yaml", 7, 3, {}, -1};
  const auto told = [&](const TemperatureSpec& s) { return message_of([&] { heated_material(s, where); }); };
  const std::vector<std::pair<TemperatureSpec, std::string>> table{
      {spec({{"thickness_m", 0.1}}), "the one layer needs 'density_kg_m3'"},
      {spec(kLayer, {}, {test::uniform(1, 1000, 1000, 1)}), "there are layers and the numbers of one layer"},
      {spec({}, {{"back", "opne"}}), "did you mean 'open'?"},
      {spec(kLayer, {{"back", "ground"}}), "'back: ground' needs 'back_k'"},
      {spec(with({{"back_k", 290}}), {{"back", "air"}}), "needs 'back_film_w_m2_k'"},
      {spec(kLayer, {{"back", "air"}}), "needs 'back_k' and 'back_film_w_m2_k'"},
      {spec(with({{"back_k", 290}})), "'back_k' says nothing of a back that is 'adiabatic'"},
      {spec({{"back_k", 290}}, {{"back", "ground"}}), "a surface without heat capacity has 'ground' behind it"},
      {spec({}, {{"convection", "mcadam"}}), "did you mean 'mcadams'?"},
      {spec({{"length_m", 2}}), "takes no 'length_m'"},
      {spec({}, {{"convection", "constant"}}), "still_w_m2_k"},
      {spec({}, {{"roughness", "hairy"}}), "knows no roughness 'hairy'"},
      {spec({}, {{"convection", "mowitt"}, {"roughness", "rough"}}), "takes no roughness"},
      {spec({}, {}, {test::uniform(1, 1000, 1000, -1)}), "conductivity"},
      {spec({}, {}, {test::uniform(0, 1000, 1000, 1)}), "thickness"}};
  for (const auto& [s, text] : table) EXPECT_THAT(told(s), AllOf(HasSubstr("s.yaml:7:3"), HasSubstr(text)));
  // What needs air has none.
  EXPECT_THAT(told(spec({{"still_w_m2_k", 4}}, {{"convection", "none"}})), HasSubstr("still_w_m2_k"));
  EXPECT_THAT(told(spec({{"wetness", 0.5}}, {{"convection", "none"}})), HasSubstr("'wetness' asks for air"));
}

}  // namespace
}  // namespace suite::heated_material_test
