#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

namespace thimble::cli {

/// Adds the scene of a command: a file, or a name from `thimble run --list`. `scene` becomes the
/// path of the file. Real-time: never from the servo thread.
CLI::Option* add_scene_option(
    CLI::App& command, std::string& scene, const std::string& name = "SCENE",
    const std::string& about = "Scene: a name from `thimble run --list`, or a YAML file");

/// Adds --arm: an arm file, or a name from `thimble run --list`. `arm_file` becomes the path of the
/// file. Real-time: never from the servo thread.
CLI::Option* add_arm_option(CLI::App& command, std::string& arm_file, const std::string& about);
CLI::Option* add_arm_option(CLI::App& command, std::filesystem::path& arm_file,
                            const std::string& about);

/// Adds --quality: a name of scene::Quality. Real-time: never from the servo thread.
CLI::Option* add_quality_option(CLI::App& command, std::string& quality, const std::string& about);

}  // namespace thimble::cli
