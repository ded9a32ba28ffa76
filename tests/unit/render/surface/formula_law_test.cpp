#include "surface/law/formula_law.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "support/heap_guard.h"

namespace thimble::render {
namespace {

std::string mistake(const std::string& text, const std::vector<LawParameter>& parameters = {}) {
  const auto made = LawFormula::make(text, parameters);
  return made ? std::string() : made.error().message;
}

bool has(const std::string& text, const std::string& word) {
  return text.find(word) != std::string::npos;
}

LawParameter stiffness(double value) {
  return {.name = "k", .value = value, .unit = "N/m"};
}

TEST(UnitNames, AreProductsOfBaseUnits) {
  EXPECT_EQ(unit_named("N s/m"), (Unit{.metres = -1, .seconds = 1, .newtons = 1}));
  EXPECT_EQ(unit_named("kg m/s^2"), (Unit{.newtons = 1}));
  EXPECT_EQ(unit_named("N/m/s"), (Unit{.metres = -1, .seconds = -1, .newtons = 1}));
  EXPECT_EQ(unit_named("Hz"), unit_named("1/s"));
  EXPECT_EQ(unit_named(""), Unit{});
  for (const char* bad : {"lb", "N//m", "N/", "m^", "m^x", "m^99", "N*m"}) {
    EXPECT_FALSE(unit_named(bad)) << bad;
  }
}

TEST(LawFormula, ComputesItsValue) {
  const auto law = LawFormula::make("k * depth + sin(pi / 6) * pressure", {stiffness(300)});
  ASSERT_TRUE(law) << law.error().message;
  EXPECT_NEAR((*law)->at({.depth = 0.002, .pressure = 4}), 2.6, 1e-12);
  (*law)->parameter(0) = 500;
  EXPECT_NEAR((*law)->at({.depth = 0.002}), 1, 1e-12);
}

TEST(LawFormula, NamesTheUnitThatDoesNotFit) {
  EXPECT_TRUE(has(mistake("depth * pressure"), "unit m"));
  EXPECT_TRUE(has(mistake("k * approach", {stiffness(3)}), "unit s"));
  EXPECT_TRUE(has(mistake("300 * depth"), "as a parameter"));
  EXPECT_TRUE(has(mistake("1"), "unit N"));
  EXPECT_EQ(mistake("min(pressure, k * depth)", {stiffness(3)}), "");
}

TEST(LawFormula, NamesThePlaceOfAMistake) {
  EXPECT_TRUE(has(mistake("pressure * foo"), "character 12, \"foo\""));
  EXPECT_TRUE(has(mistake("pressure +"), "cannot be read"));
  EXPECT_TRUE(has(mistake("pressure, pressure"), "several"));
  EXPECT_FALSE(mistake("").empty());
}

TEST(LawFormula, RefusesValuesThatAreNotFinite) {
  EXPECT_TRUE(has(mistake("k * depth * depth / (x - x)", {stiffness(3)}), "is not finite at"));
  EXPECT_TRUE(has(mistake("pressure * log(nx)"), "nx = "));
}

TEST(LawFormula, RefusesParametersThatAreWrong) {
  EXPECT_TRUE(has(mistake("pressure", {stiffness(3)}), "k is not used"));
  EXPECT_TRUE(has(mistake("pressure * k", {{.name = "k", .value = 1, .unit = "lb"}}), "\"lb\""));
  EXPECT_TRUE(has(mistake("pressure * speed", {{.name = "speed", .value = 1}}), "taken"));
  EXPECT_TRUE(has(mistake("pressure", {{.name = "2k", .value = 1}}), "no name"));
}

/// Touches a law once, with the tip pressed against a plane and moving.
Eigen::Vector3d force_of(FormulaLaw& law, const Eigen::Vector3d& v_WT, double pressure) {
  driver::DeviceState state;
  state.dt = 1e-3;
  state.v_WT = v_WT;
  SurfaceResponse response;
  response.contact = {.touching = true, .triangle = 0, .depth = 0.002, .n_W = {0, 0, 1}};
  response.f_T_W = {0, 0, pressure};
  law.touch(state, response);
  return response.f_T_W;
}

FormulaLaw law_of(const std::string& formula, FormulaLaw::Direction direction,
                  const std::vector<LawParameter>& parameters = {}) {
  return FormulaLaw({.formula = formula, .direction = direction, .parameters = parameters}, {});
}

TEST(FormulaLaw, ActsAlongItsDirection) {
  using enum FormulaLaw::Direction;
  FormulaLaw normal = law_of("k * depth", kNormal, {stiffness(500)});
  EXPECT_TRUE(force_of(normal, {0.1, 0, 0}, 2).isApprox(Eigen::Vector3d(0, 0, 3)));
  FormulaLaw sliding = law_of("-pressure / 4", kSliding);
  EXPECT_TRUE(force_of(sliding, {0, 0.2, -0.1}, 2).isApprox(Eigen::Vector3d(0, -0.5, 2)));
  EXPECT_TRUE(force_of(sliding, {0, 0, 0}, 2).isApprox(Eigen::Vector3d(0, 0, 2)));
  FormulaLaw along = law_of("-pressure / 4", kX);
  EXPECT_TRUE(force_of(along, {0, 0.2, 0}, 2).isApprox(Eigen::Vector3d(-0.5, 0, 2)));
}

TEST(FormulaLaw, NeverPullsTheTipIntoTheSurface) {
  for (const auto direction : {FormulaLaw::Direction::kNormal, FormulaLaw::Direction::kZ}) {
    FormulaLaw law = law_of("-9 * pressure", direction);
    EXPECT_EQ(force_of(law, {0.1, 0, 0}, 2).z(), 0);
  }
}

TEST(FormulaLaw, TimeBeginsWithTheContact) {
  FormulaLaw law = law_of("pressure * time / t", FormulaLaw::Direction::kNormal,
                          {{.name = "t", .value = 1, .unit = "s"}});
  EXPECT_EQ(force_of(law, {0, 0, 0}, 1).z(), 1);
  EXPECT_NEAR(force_of(law, {0, 0, 0}, 1).z(), 1.001, 1e-12);
  law.leave();
  EXPECT_EQ(force_of(law, {0, 0, 0}, 1).z(), 1);
}

TEST(FormulaLaw, AValueThatIsNotFiniteGivesNoForce) {
  FormulaLaw law = law_of("pressure * k * depth / f", FormulaLaw::Direction::kNormal,
                          {stiffness(500), {.name = "f", .value = 1, .unit = "N"}});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(force_of(law, {nan, 0, 0}, 2).x(), 0);
  EXPECT_TRUE(std::isnan(force_of(law, {0, 0, 0}, nan).z())) << "only what came in";
}

TEST(FormulaLaw, CountsTheStiffnessThatItAdds) {
  EXPECT_NEAR(
      law_of("k * depth", FormulaLaw::Direction::kNormal, {stiffness(700)}).spring_stiffness(), 700,
      1e-6);
  EXPECT_EQ(law_of("-pressure / 4", FormulaLaw::Direction::kSliding).spring_stiffness(), 0);
}

TEST(FormulaLaw, ParametersWithARangeAreKnobs) {
  FormulaLaw law = law_of("k * depth", FormulaLaw::Direction::kNormal,
                          {{.name = "k", .value = 500, .unit = "N/m", .min = 0, .max = 900}});
  LiveSettings settings(1000, 10);
  settings.set_group("law");
  law.list_settings(settings);
  ASSERT_EQ(settings.list().size(), 1U);
  const LiveSetting& knob = settings.list().front();
  EXPECT_EQ(knob.name, "law k");
  EXPECT_EQ(knob.unit, "N/m");
  EXPECT_EQ(knob.max, 900);
  knob.set(knob.stage, 800);
  EXPECT_NEAR(force_of(law, {0, 0, 0}, 1).z(), 2.6, 1e-12);
}

TEST(FormulaLaw, ATickAllocatesNothing) {
  FormulaLaw law = law_of("k * depth * exp(-speed / v) + min(pressure, k * depth)",
                          FormulaLaw::Direction::kNormal,
                          {stiffness(500), {.name = "v", .value = 1, .unit = "m/s"}});
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int tick = 0; tick < 100; ++tick) force_of(law, {0.1, 0, 0}, 2);
            }),
            0);
}

}  // namespace
}  // namespace thimble::render
