#include "surface/law/law_formula.h"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "math/elementary.h"

namespace thimble::render {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A variable of the language: its name, its unit, and the range in which it is tried [chosen: what
/// a hand at an arm reaches].
struct Variable {
  std::string_view name;
  Unit unit;
  double min, max;
};

constexpr std::size_t kVariables = 11;
constexpr std::array<Variable, kVariables> kLanguage{{
    {"depth", {.metres = 1}, 0, 0.02},
    {"approach", {.metres = 1, .seconds = -1}, -0.5, 0.5},
    {"speed", {.metres = 1, .seconds = -1}, 0, 0.5},
    {"pressure", {.newtons = 1}, 0, 10},
    {"time", {.seconds = 1}, 0, 10},
    {"x", {.metres = 1}, -0.3, 0.3},
    {"y", {.metres = 1}, -0.3, 0.3},
    {"z", {.metres = 1}, -0.3, 0.3},
    {"nx", {}, -1, 1},
    {"ny", {}, -1, 1},
    {"nz", {}, -1, 1},
}};

double power(double base, int exponent) {
  double result = 1;
  for (int i = 0; i < std::abs(exponent); ++i) result *= base;
  return exponent < 0 ? 1 / result : result;
}

/// Factors of the base units, as if lengths, times and forces were measured in other units.
struct Scale {
  double metres = 1, seconds = 1, newtons = 1;

  double of(const Unit& unit) const {
    return power(metres, unit.metres) * power(seconds, unit.seconds) * power(newtons, unit.newtons);
  }
};

// muParser accepts only functions of its type.
double sine(double x) {
  return math::sin(x);
}
double cosine(double x) {
  return math::cos(x);
}
double exponential(double x) {
  return math::exp(x);
}
double logarithm(double x) {
  return math::log(x);
}
double hyperbolic_tangent(double x) {
  return math::tanh(x);
}
double arc_tangent(double y, double x) {
  return math::atan2(y, x);
}
double root(double x) {
  return std::sqrt(x);
}
double magnitude(double x) {
  return std::abs(x);
}
double sign_of(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}
double smallest(const double* values, int count) {
  return *std::min_element(values, values + count);
}
double largest(const double* values, int count) {
  return *std::max_element(values, values + count);
}

class ParsedFormula final : public LawFormula {
 public:
  explicit ParsedFormula(std::size_t parameters) : parameters_(parameters) {
    parser_.ClearFun();
    parser_.ClearConst();
    parser_.DefineConst("pi", std::numbers::pi);
    parser_.DefineFun("sin", sine);
    parser_.DefineFun("cos", cosine);
    parser_.DefineFun("exp", exponential);
    parser_.DefineFun("log", logarithm);
    parser_.DefineFun("tanh", hyperbolic_tangent);
    parser_.DefineFun("atan2", arc_tangent);
    parser_.DefineFun("sqrt", root);
    parser_.DefineFun("abs", magnitude);
    parser_.DefineFun("sign", sign_of);
    parser_.DefineFun("min", smallest);
    parser_.DefineFun("max", largest);
    for (std::size_t i = 0; i < kVariables; ++i) {
      parser_.DefineVar(std::string(kLanguage[i].name), &inputs_[i]);
    }
  }

  double at(const LawInputs& inputs) noexcept override {
    inputs_ = {inputs.depth,   inputs.approach, inputs.speed,    inputs.pressure,
               inputs.time,    inputs.p_OT.x(), inputs.p_OT.y(), inputs.p_OT.z(),
               inputs.n_O.x(), inputs.n_O.y(),  inputs.n_O.z()};
    return value();
  }
  double& parameter(std::size_t place) noexcept override { return parameters_[place]; }

  /// Parses the text. muParser throws for a mistake.
  driver::Result<void> parse(const std::string& text, const std::vector<LawParameter>& given) {
    for (std::size_t i = 0; i < given.size(); ++i) {
      try {
        parser_.DefineVar(given[i].name, &parameters_[i]);
      } catch (const mu::Parser::exception_type&) {
        return driver::Error{"\"" + given[i].name + "\" is no name of a parameter. Use letters, " +
                             "digits and _, beginning with a letter"};
      }
      parameters_[i] = given[i].value;
    }
    try {
      parser_.SetExpr(text);
      inputs_ = middle();
      parser_.Eval();
    } catch (const mu::Parser::exception_type& mistake) {
      const std::string token = mistake.GetToken();
      return driver::Error{"cannot be read at character " + std::to_string(mistake.GetPos() + 1) +
                           (token.empty() ? "" : ", \"" + token + "\"") + ": " + mistake.GetMsg()};
    }
    if (parser_.GetNumResults() != 1) {
      return driver::Error{"must be one formula; found several, separated by commas"};
    }
    return {};
  }

  /// Fails at the first inputs in their ranges for which the force is not finite.
  driver::Result<void> check_finite(const std::vector<LawParameter>& given) {
    for (int which = 0; which < kTries; ++which) {
      try_inputs(which);
      for (const bool at_max : {false, true}) {
        use_parameters(given, which == 0 ? std::nullopt : std::optional<bool>(at_max));
        if (std::isfinite(value())) continue;
        std::string where;
        for (std::size_t i = 0; i < kVariables; ++i) {
          if (!uses(std::string(kLanguage[i].name))) continue;
          where += (where.empty() ? "" : ", ") + std::string(kLanguage[i].name) + " = " +
                   std::to_string(inputs_[i]);
        }
        return driver::Error{"is not finite" + (where.empty() ? "" : " at " + where)};
      }
    }
    use_parameters(given, {});
    return {};
  }

  /// Fails if the force depends on the units in which lengths, times and forces are measured: then
  /// its terms have different units.
  driver::Result<void> check_units(const std::vector<LawParameter>& given,
                                   const std::vector<Unit>& units) {
    constexpr double kFactor = 1.7;  // [chosen: its powers are no round numbers]
    const std::array<std::pair<Scale, const char*>, 3> scales{{
        {{.metres = kFactor}, "m"},
        {{.seconds = kFactor}, "s"},
        {{.newtons = kFactor}, "N"},
    }};
    for (int which = 0; which < kTries; ++which) {
      for (const auto& [scale, unit] : scales) {
        try_inputs(which);
        use_parameters(given, {});
        const double before = value();
        for (std::size_t i = 0; i < kVariables; ++i) inputs_[i] *= scale.of(kLanguage[i].unit);
        for (std::size_t i = 0; i < given.size(); ++i) parameters_[i] *= scale.of(units[i]);
        const double after = value(), expected = scale.of({.newtons = 1}) * before;
        constexpr double kRounding = 1e-9;
        if (std::abs(after - expected) <= kRounding * (std::abs(after) + std::abs(expected)))
          continue;
        return driver::Error{
            std::string("does not give newtons: its value changes with the unit ") + unit +
            ". Give each number that has a unit as a parameter"};
      }
    }
    use_parameters(given, {});
    return {};
  }

  double sensitivity(std::size_t place) override {
    const double kept = parameters_[place];
    const double step = 1e-3 * std::max(std::abs(kept), 1.0);
    double most = 0;
    for (int which = 0; which < kTries; ++which) {
      try_inputs(which);
      parameters_[place] = kept + step;
      const double above = value();
      parameters_[place] = kept - step;
      most = std::max(most, std::abs(above - value()) / (2 * step));
    }
    parameters_[place] = kept;
    return most;
  }

  bool uses(const std::string& name) const { return parser_.GetUsedVar().contains(name); }

 private:
  static constexpr int kTries = 200;

  double value() noexcept {
    try {
      return parser_.Eval();
    } catch (...) {
      return kNaN;  // muParser throws only while it parses
    }
  }
  static std::array<double, kVariables> middle() {
    std::array<double, kVariables> values{};
    for (std::size_t i = 0; i < kVariables; ++i) {
      values[i] = 0.4 * kLanguage[i].min + 0.6 * kLanguage[i].max;
    }
    return values;
  }
  /// Sets inputs within their ranges: first zeros, the smallest and the largest, then points that
  /// fill the ranges evenly (multiples of irrational numbers).
  void try_inputs(int which) {
    constexpr std::array<double, kVariables> kStrides{
        0.41421356237309503, 0.73205080756887719, 0.23606797749978981, 0.64575131106459072,
        0.31662479035539980, 0.60555127546398912, 0.12310562561766059, 0.35889894354067398,
        0.79583152331271938, 0.38516480713450374, 0.56776436283002194};  // of square roots of
                                                                         // primes
    for (std::size_t i = 0; i < kVariables; ++i) {
      const Variable& one = kLanguage[i];
      inputs_[i] = which == 0   ? 0
                   : which == 1 ? one.min
                   : which == 2
                       ? one.max
                       : one.min + (one.max - one.min) * std::fmod(which * kStrides[i], 1.0);
    }
  }
  /// Sets the parameters to their values, or all to an end of their ranges.
  void use_parameters(const std::vector<LawParameter>& given, std::optional<bool> at_max) {
    for (std::size_t i = 0; i < given.size(); ++i) {
      const bool ranges = at_max && given[i].min < given[i].max;
      parameters_[i] = !ranges ? given[i].value : *at_max ? given[i].max : given[i].min;
    }
  }

  mu::Parser parser_;
  std::array<double, kVariables> inputs_{};
  std::vector<double> parameters_;
};

}  // namespace

driver::Result<std::unique_ptr<LawFormula>> LawFormula::make(
    const std::string& text, const std::vector<LawParameter>& parameters) {
  std::vector<Unit> units;
  for (const LawParameter& one : parameters) {
    const auto unit = unit_named(one.unit);
    if (!unit) {
      return driver::Error{"the parameter " + one.name + " has the unit \"" + one.unit +
                           "\"; expected products of m, s, N, kg, Hz, J, W, Pa and rad, such as "
                           "\"N s/m\""};
    }
    units.push_back(*unit);
    const bool taken =
        std::any_of(kLanguage.begin(), kLanguage.end(),
                    [&one](const Variable& variable) { return variable.name == one.name; });
    if (taken || one.name == "pi" ||
        std::count_if(parameters.begin(), parameters.end(),
                      [&one](const LawParameter& other) { return other.name == one.name; }) > 1) {
      return driver::Error{"the name " + one.name + " of a parameter is taken; choose another one"};
    }
  }
  auto formula = std::make_unique<ParsedFormula>(parameters.size());
  if (auto parsed = formula->parse(text, parameters); !parsed) return parsed.error();
  for (const LawParameter& one : parameters) {
    if (!formula->uses(one.name)) {
      return driver::Error{"the parameter " + one.name + " is not used; remove it"};
    }
  }
  if (auto finite = formula->check_finite(parameters); !finite) return finite.error();
  if (auto fits = formula->check_units(parameters, units); !fits) return fits.error();
  return std::unique_ptr<LawFormula>(std::move(formula));
}

}  // namespace thimble::render
