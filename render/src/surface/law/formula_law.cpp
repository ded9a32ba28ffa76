#include "surface/law/formula_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace thimble::render {
namespace {

constexpr std::size_t kParametersMax = 8;  // [chosen: more are hard to survey; each may be a knob]
constexpr double kValueMax = 1e9;          // catches misplaced decimal points
constexpr std::array<std::string_view, 5> kDirections{"normal", "sliding", "x", "y", "z"};

void read_parameter(SettingsReader& reader, LawParameter& parameter) {
  constexpr NumberLimits kAny{.unit = "", .min = -kValueMax, .max = kValueMax};
  reader.text("name", parameter.name);
  if (parameter.name.empty()) reader.reject("name", "is missing; it is a word of the formula");
  reader.number("value", parameter.value,
                {.unit = "", .min = -kValueMax, .max = kValueMax, .required = true});
  reader.text("unit", parameter.unit);
  if (!reader.has("min") && !reader.has("max")) return;
  reader.number("min", parameter.min, kAny);
  reader.number("max", parameter.max, kAny);
  if (!(parameter.min <= parameter.value && parameter.value <= parameter.max)) {
    reader.reject("value", "must be between min and max");
  }
}

}  // namespace

void FormulaLaw::Settings::read(SettingsReader& reader, const EffectContext&) {
  reader.text("law", formula);
  std::size_t chosen = 0;
  reader.choice("direction", chosen, {kDirections.begin(), kDirections.end()});
  direction = static_cast<Direction>(chosen);
  if (reader.has("parameters")) {
    reader.list("parameters", [this](SettingsReader& entry) {
      parameters.emplace_back();
      read_parameter(entry, parameters.back());
    });
  }
  if (parameters.size() > kParametersMax) {
    reader.reject("parameters",
                  "expected at most 8 parameters, found " + std::to_string(parameters.size()));
    return;
  }
  const auto made = LawFormula::make(formula, parameters);
  if (!made) reader.reject("law", made.error().message);
}

FormulaLaw::FormulaLaw(const Settings& settings, const EffectContext& context)
    : formula_(LawFormula::make(settings.formula, settings.parameters).value()),
      parameters_(settings.parameters),
      direction_(settings.direction),
      R_WO_(context.R_WO),
      p_WO_(context.p_WO),
      stiffness_(direction_ == Direction::kNormal ? stiffness_at_rest() : 0) {}

double FormulaLaw::stiffness_at_rest() const {
  constexpr double kStep = 1e-4, kDeepest = 0.01;  // m [chosen: the depth of a firm press]
  LawInputs inputs{.n_O = {0, 0, 1}};
  double stiffness = 0, before = formula_->at(inputs);
  for (double depth = kStep; depth <= kDeepest; depth += kStep) {
    inputs.depth = depth;
    const double force = formula_->at(inputs);
    stiffness = std::max(stiffness, (force - before) / kStep);
    before = force;
  }
  return stiffness;
}

void FormulaLaw::touch(const driver::DeviceState& state, SurfaceResponse& response) noexcept {
  const Eigen::Vector3d& n_W = response.contact.n_W;
  const double approach = -state.v_WT.dot(n_W);
  const Eigen::Vector3d slide_W = state.v_WT + approach * n_W;
  const double speed = slide_W.norm();
  const double pressure = response.f_T_W.dot(n_W);
  const double force = formula_->at({.depth = response.contact.depth,
                                     .approach = approach,
                                     .speed = speed,
                                     .pressure = pressure,
                                     .time = time_,
                                     .p_OT = R_WO_.transpose() * (state.p_WT - p_WO_),
                                     .n_O = R_WO_.transpose() * n_W});
  time_ += state.dt;
  // Written so that NaN gives no force.
  if (!(std::abs(force) < HUGE_VAL)) return;
  switch (direction_) {
    case Direction::kNormal:
      response.f_T_W += force * n_W;
      break;
    case Direction::kSliding:
      if (speed > 0) response.f_T_W += force / speed * slide_W;
      return;
    default:
      response.f_T_W +=
          force * R_WO_.col(static_cast<int>(direction_) - static_cast<int>(Direction::kX));
  }
  const double pull = std::min(response.f_T_W.dot(n_W), 0.0) - std::min(pressure, 0.0);
  if (pull < 0) response.f_T_W -= pull * n_W;
}

namespace {

/// Adds the parameter of a place to the settings, if it has a range.
template <std::size_t... Place, class Add>
void for_each_place(std::index_sequence<Place...>, std::size_t count, Add add) {
  ((Place < count ? add.template operator()<Place>() : void()), ...);
}

}  // namespace

void FormulaLaw::list_settings(LiveSettings& settings) {
  for_each_place(std::make_index_sequence<kParametersMax>(), parameters_.size(),
                 [&]<std::size_t place>() {
                   const LawParameter& one = parameters_[place];
                   if (!(one.min < one.max)) return;
                   settings.add<[](FormulaLaw& law, double value) noexcept {
                     law.formula_->parameter(place) = value;
                   }>(*this, {.name = one.name,
                              .unit = one.unit,
                              .min = one.min,
                              .max = one.max,
                              .value = one.value,
                              .sensitivity = {.always = formula_->sensitivity(place)}});
                 });
}

}  // namespace thimble::render
