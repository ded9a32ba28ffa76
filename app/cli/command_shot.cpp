#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/file_options.h"
#include "cli/options/old_names.h"
#include "cli/options/theme_option.h"
#include "cli/report_error.h"
#include "cli/usage/help_text.h"
#include "files/scene_inputs.h"
#include "log/printed_text.h"
#include "output/output_plan.h"
#include "print.h"
#include "text/counted.h"
#include "thimble/scene/scene_file.h"
#include "view/gl/animated_picture_file.h"
#include "view/gl/animation_file.h"
#include "view/gl/offscreen_context.h"
#include "view/gl/picture_file.h"
#include "view/shot.h"

namespace thimble::cli {
namespace {

struct ShotOptions {
  std::string scene;
  std::string out;
  std::string animate;
  std::string arm_file;
  std::optional<double> at;
  double until = -1;
  double pace = 25;
  std::string size = "960x640";
  std::vector<double> camera;
  std::string shading = "phong";
  std::string edges = "auto";
  bool edge_planes = false;
  bool plots = false;
  bool fields = false;
  bool contact = false;
  bool trail = false;
  bool surfaces = false;
  bool collision = false;
  std::string theme = "light";
  bool no_arm = false;
  bool no_caption = false;
  bool all_colours = false;
};

/// Reads WIDTHxHEIGHT; false if the text is no size or the size is no picture's.
bool read_size(const std::string& text, int& width, int& height) {
  int used = 0;
  return std::sscanf(text.c_str(), "%dx%d%n", &width, &height, &used) == 2 &&
         used == static_cast<int>(text.size()) && width >= 64 && height >= 64 && width <= 8192 &&
         height <= 8192;
}

constexpr double kDegree = 0.017453292519943295;  // rad

/// Turns the framed camera by the user's yaw and pitch, and changes its distance.
void turn(view::Camera& camera, const std::vector<double>& wanted) {
  camera.yaw = wanted[0] * kDegree;
  camera.pitch = 0;
  camera.orbit(0, wanted[1] * kDegree);
  if (wanted.size() > 2) camera.zoom(wanted[2]);
}

bool is_png(const std::filesystem::path& file) {
  return file.extension() == ".png" || file.extension() == ".PNG";
}

/// Returns what is wrong with the names of the pictures, or with an animation's pace; empty if
/// nothing is.
std::string output_error(const ShotOptions& options) {
  if (!options.out.empty() && !is_png(options.out)) {
    return "--output: expected a file name that ends in .png, found " + options.out + ".";
  }
  if (!options.animate.empty() && !is_png(options.animate) &&
      !view::is_animation(options.animate)) {
    return "--animate: expected a file name that ends in .mp4, .gif or .png, found " +
           options.animate + ".";
  }
  if (options.pace > 50 && view::is_gif(options.animate)) {
    return fmt::format(
        "--pace {:g}: a GIF has at most 50 pictures per second. Use --pace 50, or a file name that "
        "ends in .mp4 or .png.",
        options.pace);
  }
  return {};
}

/// Returns what is wrong with the camera; empty if nothing is.
std::string camera_error(const ShotOptions& options) {
  constexpr double kZoomMin = 0.01, kZoomMax = 100;  // outside of them nothing is seen [chosen]
  if (options.camera.size() < 3) return {};
  const double zoom = options.camera[2];
  if (zoom >= kZoomMin && zoom <= kZoomMax) return {};
  return fmt::format("--camera: expected a ZOOM from {:g} to {:g}, found {:g}.", kZoomMin, kZoomMax,
                     zoom);
}

/// Returns an error if the animation ends before it begins at `at`, s; empty if not.
std::string span_error(const ShotOptions& options, double at) {
  if (options.until < 0 || options.until > at) return {};
  return fmt::format("--until {:g}: expected a time after the first picture at {:g} s ({}).",
                     options.until, at, options.at ? "--at" : "largest force; choose with --at");
}

/// Writes the pictures in the format given by the file's ending, and prints what was written.
int write_animation(const std::vector<view::Picture>& pictures, const ShotOptions& options) {
  const double frame_time = 1 / options.pace;
  const bool by_ffmpeg = view::is_animation(options.animate);
  const auto written = by_ffmpeg ? view::write_animation(pictures, frame_time, options.animate)
                                 : view::write_animated_png(pictures, frame_time, options.animate);
  if (!written) return report_error(written.error(), kExitTrouble);
  std::error_code unknown;
  const std::uintmax_t bytes = std::filesystem::file_size(options.animate, unknown);
  session::print(scene::text_stream(), "Animation: {} ({}, {} of {} x {}, {:.3g} s{})\n",
                 options.animate, by_ffmpeg ? "by ffmpeg" : "animated PNG",
                 scene::counted(pictures.size(), "picture"), pictures.front().width,
                 pictures.front().height, frame_time * static_cast<double>(pictures.size()),
                 unknown ? std::string() : fmt::format(", {} kB", (bytes + 999) / 1000));
  return kExitDone;
}

/// Returns an error if the times to be drawn are outside of the scene's duration; empty if not.
std::string time_error(const ShotOptions& options) {
  const auto scene = scene::load_scene(options.scene, {.arm = options.arm_file});
  if (!scene) return {};  // the caller that plays the scene reports the error
  for (const auto& [option, time] :
       {std::pair{"--at", options.at.value_or(0)}, {"--until", options.until}}) {
    if (time <= scene->duration) continue;
    return fmt::format("{} {:g}: the scene {} ends at {:g} s.", option, time, scene->name,
                       scene->duration);
  }
  return {};
}

int take_shot(const ShotOptions& options) {
  view::ShotChoice choice;
  if (!read_size(options.size, choice.width, choice.height)) {
    return report_error(
        {"--size: expected WIDTHxHEIGHT of 64 to 8192 pixels, found " + options.size + "."},
        kExitBadInput);
  }
  if (options.out.empty() && options.animate.empty()) {
    return report_error(
        {"--output FILE.png or --animate FILE (.mp4, .gif or .png) is missing. Add one of them."},
        kExitBadInput);
  }
  const std::string span = options.at ? span_error(options, *options.at) : std::string();
  for (const std::string& wrong :
       {output_error(options), camera_error(options), span, time_error(options)}) {
    if (!wrong.empty()) return report_error({wrong}, kExitBadInput);
  }
  if (view::is_animation(options.animate)) {
    if (const auto found = view::find_ffmpeg(); !found) {
      return report_error(found.error(), kExitTrouble);
    }
  }
  output::OutputPlan plan;
  plan.read(options.arm_file);
  for (const auto& file : scene::scene_inputs(options.scene)) plan.read(file);
  plan.write("--output", options.out, output::kPng);
  plan.write("--animate", options.animate,
             view::is_animation(options.animate) ? output::kAnimation : output::kPng);
  if (auto begun = plan.begin(); !begun) return report_error(begun.error(), kExitBadInput);
  choice.paint.shading =
      options.shading == "gouraud" ? view::Shading::kGouraud : view::Shading::kPhong;
  choice.paint.edges = options.edges == "on"    ? view::Edges::kOn
                       : options.edges == "off" ? view::Edges::kOff
                                                : view::Edges::kAuto;
  choice.paint.marks.edge_planes = options.edge_planes;
  choice.paint.marks.arm = !options.no_arm;
  choice.paint.marks.contact = options.contact;
  choice.paint.fields = options.fields;
  choice.paint.trail = options.trail;
  choice.paint.surfaces = options.surfaces;
  choice.paint.colliders = options.collision;
  choice.paint.theme = options.theme == "dark" ? view::Theme::kDark : view::Theme::kLight;
  choice.plots = options.plots;
  choice.caption = !options.no_caption;

  session::SessionOptions session;
  session.several_arms = true;
  session.arm_file = options.arm_file;
  double at = 0;
  if (options.at) {
    at = *options.at;
  } else {
    const auto found = view::strongest_moment(options.scene, session);
    if (!found) return report_error(found.error(), kExitBadInput);
    at = *found;
    if (const std::string wrong = span_error(options, at); !wrong.empty()) {
      return report_error({wrong}, kExitBadInput);
    }
  }
  const bool animated = !options.animate.empty();
  std::vector<double> times = {at};
  // Rounding must not add a picture at the end.
  const double pictures_wanted = (options.until - at) * options.pace - 1e-6;
  for (int i = 1; animated && i < pictures_wanted; ++i) times.push_back(at + i / options.pace);
  session.duration = times.back() + 0.1;
  auto played = view::PlayedScene::open(options.scene, session);
  if (!played) return report_error(played.error(), kExitBadInput);
  const auto context = view::OffscreenContext::open();
  if (!context) return report_error(context.error(), kExitTrouble);
  auto programs = view::ScenePrograms::make();
  if (!programs) return report_error(programs.error(), kExitTrouble);
  view::ShotPainter painter((*played)->drawn(), choice, std::move(programs).value());
  std::vector<view::Picture> pictures;
  (*played)->play(times, [&](view::DrawnMoment& moment, const view::Plots& plots) {
    if (pictures.empty()) {
      painter.frame_at(moment);
      if (!options.camera.empty()) turn(*painter.choice().camera, options.camera);
    }
    pictures.push_back(painter.paint(moment, plots));
  });
  if (!options.out.empty()) {
    const auto written =
        view::write_png(pictures.front(), options.out,
                        options.all_colours ? view::PngColours::kAll : view::PngColours::k256);
    if (!written) return report_error(written.error(), kExitTrouble);
    scene::print_format("Picture: %s\n", options.out.c_str());
  }
  return animated ? write_animation(pictures, options) : kExitDone;
}

}  // namespace

void add_shot_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("shot", "Draw a picture or animation of a scene");
  auto options = std::make_shared<ShotOptions>();
  add_scene_option(*command, options->scene)->required();
  add_arm_option(*command, options->arm_file, "Arm file to use instead of the scene's");
  constexpr const char* kOutput = "Output";
  CLI::Option* output = command->add_option("--output", options->out, "Picture to write")
                            ->option_text("FILE.png")
                            ->group(kOutput);
  add_old_name(*command, "--out", output, options->out);
  CLI::Option* animate =
      command->add_option("--animate", options->animate, "Animation to write: .mp4, .gif or .png")
          ->option_text("FILE")
          ->group(kOutput);
  command->add_option("--at", options->at, "Time of the picture, s (default: largest force)")
      ->check(CLI::Range(0.0, 86400.0))
      ->group(kOutput);
  command->add_option("--until", options->until, "Time at which the animation ends, s")
      ->needs(animate)
      ->check(CLI::Range(0.0, 86400.0))
      ->group(kOutput);
  command->add_option("--pace", options->pace, "Frames per second of the animation")
      ->needs(animate)
      ->check(CLI::Range(1.0, 60.0))
      ->capture_default_str()
      ->group(kOutput);
  command->add_option("--size", options->size, "Size of the picture in pixels")
      ->option_text("WIDTHxHEIGHT")
      ->capture_default_str()
      ->group(kOutput);
  command
      ->add_flag("--all-colours", options->all_colours, "Keep all colours instead of the best 256")
      ->group(kOutput);
  constexpr const char* kLook = "Look";
  command->add_option("--camera", options->camera, "Direction and zoom of the camera")
      ->option_text("YAW PITCH [ZOOM]")
      ->expected(2, 3)
      ->group(kLook);
  add_theme_option(*command, options->theme, "Colour theme")->capture_default_str()->group(kLook);
  command->add_option("--shading", options->shading, "Shading per pixel, or per vertex")
      ->check(CLI::IsMember({"phong", "gouraud"}))
      ->capture_default_str()
      ->group(kLook);
  command
      ->add_option("--edges", options->edges, "Draw outlines of polygons; auto: if there are few")
      ->check(CLI::IsMember({"auto", "on", "off"}))
      ->capture_default_str()
      ->group(kLook);
  command->add_flag("--no-arm", options->no_arm, "Do not draw the arm")->group(kLook);
  command->add_flag("--no-caption", options->no_caption, "Do not draw the caption")->group(kLook);
  constexpr const char* kShow = "Overlays";
  command
      ->add_flag("--edge-planes", options->edge_planes,
                 "Show the active triangle and its bounding planes")
      ->group(kShow);
  command
      ->add_flag("--contact", options->contact, "Show the contact normal and the tangential force")
      ->group(kShow);
  command->add_flag("--fields", options->fields, "Show the forces of fields as arrows")
      ->group(kShow);
  command
      ->add_flag("--trail", options->trail,
                 "Show the last 4 s of the tip's path, coloured by force")
      ->group(kShow);
  command->add_flag("--surfaces", options->surfaces, "Mark surfaces with texture or friction")
      ->group(kShow);
  command->add_flag("--collision", options->collision, "Show the shapes that collide")
      ->group(kShow);
  command->add_flag("--plots", options->plots, "Plot force and depth over time below the picture")
      ->group(kShow);
  add_example(*command, "thimble shot elephant --at 2 --out elephant.png",
              "--animate  From --at to --until. MP4 and GIF require ffmpeg; PNG is animated.\n"
              "--camera   YAW: degrees about z, from the user's side. PITCH: degrees above the\n"
              "           horizon. ZOOM: a factor from 0.01 to 100. By default the camera\n"
              "           frames the scene.");
  command->callback([options, &exit_code] { exit_code = take_shot(*options); });
}

}  // namespace thimble::cli
