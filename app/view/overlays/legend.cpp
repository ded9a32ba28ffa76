#include "view/overlays/legend.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cstddef>

#include "view/maps/map_colour.h"
#include "view/number_text.h"
#include "view/overlays/force_marks.h"

namespace thimble::view {
namespace {

ImU32 screen_colour(const Colour& colour) {
  return ImGui::ColorConvertFloat4ToU32({colour[0], colour[1], colour[2], 1});
}

}  // namespace

Legend legend_of(const DrawnScene& scene, const DrawnMoment& moment, const PaintChoice& choice) {
  Legend legend;
  if (choice.fields || choice.trail) legend.strongest = strongest_force(scene, moment);
  if (choice.fields && scene.field.empty()) {  // viscous fields have no force at rest
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      if (!scene.objects[i].field) continue;
      legend.lines.push_back(
          {object_colour(i), scene.objects[i].name + ": no force at rest, so no arrows"});
    }
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const DrawnMap& map = scene.objects[i].map;
    if (map.parts == 0) continue;
    legend.maps.push_back(
        {i, scene.objects[i].name + ": " + map.quantity, fmt::format("{:.4g}", map.min),
         fmt::format("{:.4g}{}{}", map.max, map.unit.empty() ? "" : " ", map.unit)});
  }
  if (choice.marks.contact && moment.tick.in_contact) {
    legend.lines.push_back({kNormalColour, "contact normal"});
    legend.lines.push_back({kFrictionColour, "force along the surface"});
  }
  if (choice.colliders) {
    const bool any =
        std::any_of(scene.objects.begin(), scene.objects.end(),
                    [](const auto& object) { return !object.collider.triangles.empty(); });
    legend.lines.push_back(
        {kColliderColour, any ? "shapes that collide" : "no shapes that collide"});
  }
  if (choice.surfaces) {
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
      const DrawnObject& object = scene.objects[i];
      std::string feel;
      if (!object.texture.empty()) feel = "texture " + object.texture + " (dots)";
      if (!object.friction.empty()) {
        feel += (feel.empty() ? "friction " : ", friction ") + object.friction + " (lines)";
      }
      if (!feel.empty()) legend.lines.push_back({object_colour(i), object.name + ": " + feel});
    }
  }
  return legend;
}

namespace {

constexpr int kScaleSteps = 24;

/// Draws a scale of colours with its ends; returns its height.
template <class ColourAt>
float write_scale(float left, float y, float width, Theme theme, const std::string& min,
                  const std::string& max, ColourAt colour_at) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float size = ImGui::GetFontSize();
  for (int k = 0; k < kScaleSteps; ++k) {
    const auto at = static_cast<float>(k) / kScaleSteps;
    const auto end = static_cast<float>(k + 1) / kScaleSteps;
    list.AddRectFilled({left + at * width, y}, {left + end * width, y + 0.7F * size},
                       screen_colour(colour_at(at + 0.5F / kScaleSteps)));
  }
  write_rimmed({left, y + 0.8F * size}, theme, colours_of(theme).text, min);
  write_rimmed({left + width - ImGui::CalcTextSize(max.c_str()).x, y + 0.8F * size}, theme,
               colours_of(theme).text, max);
  return 2.3F * size;
}

}  // namespace

ScreenPart write_legend(const Legend& legend, Theme theme, const ScreenPart& part) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float size = ImGui::GetFontSize();
  const float left = part.x + 0.7F * size;
  float y = part.y + 0.7F * size;
  const float width = std::min(9 * size, 0.4F * part.width);
  float covered = legend.strongest > 0 || !legend.maps.empty() ? width : 0;
  const auto cover = [&covered](const std::string& text, float indent) {
    covered = std::max(covered, indent + ImGui::CalcTextSize(text.c_str()).x);
  };
  if (legend.strongest > 0) {
    y += write_scale(left, y, width, theme, "0", plain_force(legend.strongest),
                     [](float share) { return force_colour(static_cast<double>(share)); });
  }
  for (const Legend::Scale& map : legend.maps) {
    write_rimmed({left, y}, theme, colours_of(theme).text, map.text);
    cover(map.text, 0);
    y += 1.35F * size;
    const Colour& own = object_colour(map.object);
    y += write_scale(left, y, width, theme, map.min, map.max,
                     [&own](float share) { return map_colour(own, share); });
  }
  for (const Legend::Line& line : legend.lines) {
    list.AddRectFilled({left, y + 0.15F * size}, {left + 0.8F * size, y + 0.95F * size},
                       screen_colour(line.colour));
    write_rimmed({left + 1.2F * size, y}, theme, colours_of(theme).text, line.text);
    cover(line.text, 1.2F * size);
    y += 1.35F * size;
  }
  if (!(covered > 0)) return {part.x, part.y, 0, 0};
  return {part.x, part.y, left - part.x + covered, y - part.y};
}

}  // namespace thimble::view
