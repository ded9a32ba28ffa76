#include "studies/cost/cost_subjects.h"

#include <string_view>
#include <utility>

#include <memory>
#include <vector>

#include "object_sections.h"
#include "surface/texture/height_map.h"
#include "thimble/render/build_object_touch.h"
#include "yaml/yaml_reader.h"

namespace thimble::studies {
namespace {

using Built = driver::Result<std::unique_ptr<render::ObjectTouch>>;

// Settings of effects without defaults; every other effect uses its own.
struct Sample {
  std::string_view name;  // or group
  std::string_view settings;
};
constexpr Sample kSamples[] = {
    {"friction", "coefficient: 0.5"},
    {"formula",
     "direction: sliding, parameters: [{name: b, value: 2, unit: N s/m}, {name: v, value: 0.1, "
     "unit: "
     "m/s}]"},
    {"sines", "waves: [{amplitude: 0.0001, wavelength: 0.002, direction: [1, 0, 0]}]"},
};

constexpr std::string_view kFormula = "\"-b * speed * tanh(speed / v)\"";

std::string joined(std::string_view a, char between, std::string_view b) {
  std::string name(a);
  name += between;
  name += b;
  return name;
}

render::ContactChoice choice_of(render::TrackerChoice tracker) {
  render::ContactChoice choice;
  choice.tracker = tracker;
  return choice;
}

/// Returns a height map without a file: stripes of two pixels, 1 mm apart.
std::unique_ptr<render::AnyStage> striped_map() {
  render::HeightMap::Settings settings;
  settings.image =
      std::make_shared<const render::HeightImage>(4, 1, std::vector<float>{0, 0, 1, 1});
  settings.width = 0.002;
  settings.height = 0.0002;
  return std::make_unique<render::AnyStageOf<render::HeightMap>>(
      render::HeightMap(settings, render::EffectContext()));
}

Built build_effect(const render::EffectKind& kind) {
  if (kind.name == render::HeightMap::kName) {
    return render::build_object_touch(kCostRing.mesh(kCostAround, kCostAcross),
                                      choice_of(render::TrackerChoice::kOffset),
                                      {.spring = kCostSpring, .effects = {{&kind, striped_map}}});
  }
  std::string settings;
  for (const Sample& sample : kSamples) {
    if (sample.name == kind.name || sample.name == kind.group)
      settings.append(", ").append(sample.settings);
  }
  std::string text = "effects:\n  - {";
  text.append(kind.group).append(": ").append(kind.free_text ? kFormula : kind.name);
  text.append(settings).append("}\n");
  auto yaml = scene::YamlFile::parse(text, std::string(kind.name));
  if (!yaml) return yaml.error();
  render::SurfaceChoice surface{.spring = kCostSpring, .effects = {}};
  // The PHANTOM-like arm of [PHYSICS 0].
  const render::EffectContext context{.tick = 0.001,
                                      .delay = 0.001,
                                      .encoder_step = 0.03e-3,
                                      .force_max = 8.5,
                                      .tip_mass = 0.075,
                                      .tip_damping = 0.005,
                                      .surface_stiffness = kCostSpring.stiffness,
                                      .surface_damping = kCostSpring.damping};
  surface.effects = scene::read_effects(yaml->root(), {}, context);
  if (auto right = yaml->finish(); !right) return right.error();
  return render::build_object_touch(kCostRing.mesh(kCostAround, kCostAcross),
                                    choice_of(render::TrackerChoice::kOffset), surface);
}

}  // namespace

std::vector<CostSubject> cost_subjects() {
  std::vector<CostSubject> subjects;
  const auto add = [&](std::string name, const render::ContactChoice& choice) {
    subjects.push_back({std::move(name), CostSubject::Kind::kContact, [choice]() -> Built {
                          return render::build_object_touch(
                              kCostRing.mesh(kCostAround, kCostAcross), choice,
                              {.spring = kCostSpring, .effects = {}});
                        }});
  };
  using enum render::TrackerChoice;
  for (std::size_t i = 0; i < render::kTrackerNames.size(); ++i) {
    const auto tracker = static_cast<render::TrackerChoice>(i);
    // These two have a single feel.
    render::ContactChoice choice = choice_of(tracker);
    if (tracker == kGodObject || tracker == kPacked) {
      add(std::string(render::kTrackerNames[i]), choice);
      continue;
    }
    choice.curved_depth = false;
    for (std::size_t j = 0; j < render::kBlendingNames.size(); ++j) {
      choice.blending = static_cast<render::BlendingChoice>(j);
      add(joined(render::kTrackerNames[i], '+', render::kBlendingNames[j]), choice);
    }
    choice.curved_depth = true;
    add(joined(render::kTrackerNames[i], '+', "phong+curved_depth"), choice);
  }
  add(kBareSubject, choice_of(kOffset));
  for (const render::EffectKind& kind : render::effect_table()) {
    subjects.push_back({joined(kind.group, ':', kind.name), CostSubject::Kind::kEffect,
                        [&kind] { return build_effect(kind); }});
  }
  return subjects;
}

}  // namespace thimble::studies
