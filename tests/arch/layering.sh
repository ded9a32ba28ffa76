#!/usr/bin/env bash
# Fails if a module includes a header that it must not use (the table in app/guide/pages/concepts.md), if a layer of render
# includes a layer above it (the table in render/README.md), if a library of app includes a library above it
# (app/CMakeLists.txt), if a folder has too many sources, or if a source relies on an include of another one.
#   tests/arch/layering.sh [SOURCE_DIR]
set -euo pipefail
cd "${1:-$(dirname "$0")/../..}"
bad=0

# forbid FOLDER PATTERN WHY: no include in FOLDER may match PATTERN (an extended regular expression).
forbid() {
  local found
  if found=$(grep -rnE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($2)" "$1"); then
    echo "$1 must not include $3:"
    echo "$found" | sed 's/^/  /'
    bad=1
  fi
}

graphics='GL/|GLFW|imgui|EGL/|epoxy/'
forbid driver "thimble/(device_sim|render|app)/|$graphics|spdlog/|yaml-cpp/|CLI/" \
  "other modules, graphics, logging or files"
forbid driver/include 'libusb|hidapi|termios|boost/|nlohmann/|dlfcn' "a library in a public header"
forbid device_sim "thimble/(render|app)/|$graphics|spdlog/|yaml-cpp/|CLI/" \
  "render, app, graphics, logging or files"
forbid device_sim 'thimble/driver/(device|safety_gate|servo_loop|velocity_estimator|real_time)\.h' \
  "the host side of the driver: both meet at the wire only"
forbid device_sim 'gate/|transports/(stream_transport|node_lock|ftdi_line)\.h"|vendors/' \
  "the host side of the driver: both meet at the wire only"
beside=$(find driver/src device_sim/src -mindepth 1 -maxdepth 1 -type d -printf '%f|')
for module in driver device_sim; do
  forbid $module/include "[a-z_]*\.h\"|(${beside%|})/" "a private header, which is not installed"
done
forbid render "thimble/(device_sim|app)/|$graphics|spdlog/|yaml-cpp/|CLI/" \
  "device_sim, app, graphics, logging or scene files"
forbid render 'thimble/driver/(transport|device|arm|clock|servo_loop|real_time)\.h|(thimble/driver/)?arms/' \
  "the wire or the arm: a force law uses only state and force"
forbid render/include '(ball|mesh|compact_mesh|search|track|body|disk_paging|multirate|field|surface|effect)/|[a-z_]*\.h"' \
  "a private header, which is not installed"

# The layers of render: LAYER: the layers that it may include. Some headers do not belong to the layer of their folder:
# types that all layers pass on (state), settings of effects (settings), the law of a scene (touch),
# and the code that builds it from all layers (build).
layers='
  state:
  settings:
  mesh:
  compact_mesh: mesh
  search: mesh compact_mesh
  track: state mesh compact_mesh search
  touch: state settings
  effect: state settings
  surface: state settings effect
  field: state settings touch mesh
  body: state settings touch mesh
  disk_paging: state mesh compact_mesh search track
  multirate: touch
  world: state settings touch mesh compact_mesh search track field
  ball: state settings touch mesh search track field world
  collision: state settings touch mesh field body build
'
upward=$(grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' render | awk -v layers="$layers" '
  function layer(path) {
    sub(/^render\/include\//, "", path)
    sub(/^(render\/src|thimble\/render)\//, "", path)
    sub(/\.(h|inc)$/, "", path)
    sub(/^page\//, "disk_paging/", path)
    if (path ~ /^(contact_state|body_patch|body_pose|surface\/surface_response)$/) return "state"
    if (path ~ /^effect\/(effect_context|live_settings|map_settings|settings_reader)$/) return "settings"
    if (path ~ /^(touch|object_touch|scene_touch|world_solid|solid_over)$/) return "touch"
    if (path !~ /\// || path == "effect/effect_table.cpp") return "build"
    sub(/\/.*/, "", path)
    return path
  }
  BEGIN {
    count = split(layers, lines, "\n")
    for (i = 1; i <= count; ++i) {
      words = split(lines[i], word, /[: ]+/)
      for (k = 3; k <= words; ++k) may[word[2], word[k]] = 1
    }
  }
  {
    file = $0; sub(/:.*/, "", file)
    header = $0; sub(/^[^"]*"/, "", header); sub(/".*/, "", header)
    if (header ~ /^thimble\// && header !~ /^thimble\/render\//) next
    if (header ~ /^(math|system)\//) next  # below all layers
    from = layer(file); to = layer(header)
    if (from != to && from != "build" && !((from, to) in may)) print file ": " from " must not include " to " (" header ")"
  }')
if [ -n "$upward" ]; then
  echo "A source of render includes a layer above or next to its own:"
  echo "$upward" | sed 's/^/  /'
  bad=1
fi

# The installed headers of app include no private headers, and no library that users do not need.
forbid app/scene/include '(yaml|arm_policy)/|[a-z_]*\.h"|yaml-cpp/' "a private header, or yaml-cpp"
forbid app/session/include '(recording|share|observers)/|[a-z_]*\.h"|hdf5|H5' "a private header, or HDF5"
# Python binds the same headers as C++ programs; in addition it uses the warnings only.
forbid app/python '(yaml|arm_policy|recording|share|observers|report|studies|view|bringup|hil|cli)/|stability/(draw|rest|stability|wall)' \
  "headers that a C++ program with thimble::session cannot use"

# The libraries of app, the lowest first: FOLDER PATTERN: the includes that it must not have.
forbid_app() {
  forbid "app/$1" "$2" "a library above it or at its level"
}
forbid_app bag 'thimble/(device_sim|render|scene|session)/|(yaml|files|hand|recording|share|events|report|stability|studies|view|bringup|compat|ros2|hil|web|cli)/'
# Code that writes files does not depend on their content.
forbid app/scene/src/output '(log|yaml|files|arm_policy|hand|meshes|quality|arm)/|thimble/(device_sim|render|scene)/' \
  "the rest of the scene library"
forbid_app scene 'thimble/session/|(recording|share|events|report|stability|studies|view|bringup|compat|ros2|hil|web|cli)/'
forbid_app session '(report|stability|studies|view|bringup|compat|ros2|hil|web|cli)/'
# Headers for users' programs need no private headers. Observers of a run's ticks do not include each
# other; only the code that registers them includes them all (run_records.h).
forbid app/session/include '(observers|recording|share)/|[a-z_0-9]*\.h"|hdf5|yaml-cpp|fmt/' \
  "a private header, or a library that only sources use"
for observer in observers/black_box observers/dent_record observers/latest_tick observers/virtual_time_pager \
    observers/pose_record observers/trace recording/recording_switch share/live_control share/run_sharing; do
  found=$(grep -nE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"(observers/|recording/recording_switch|share/(live_control|run_sharing))' \
    app/session/src/"$observer".h app/session/src/"$observer".cpp 2>/dev/null |
    grep -v "\"$observer\.h\"" || true)
  if [ -n "$found" ]; then
    echo "An observer must not include another:"
    echo "$found" | sed 's/^/  /'
    bad=1
  fi
done
forbid_app report '(stability|studies|view|bringup|compat|ros2|hil|web|cli)/'
forbid_app stability '(studies|view|bringup|compat|ros2|hil|web|cli)/'
forbid_app studies '(view|bringup|compat|ros2|hil|web|cli)/'
forbid_app view '(report|stability|studies|bringup|compat|ros2|hil|web|cli)/'
forbid_app web '(stability|studies|view|bringup|hil|twin|compat|ros2|cli)/'
forbid_app bringup 'thimble/session/|(recording|share|events|report|stability|studies|view|compat|ros2|hil|web|cli)/'
forbid_app identified '(session|recording|share|events|stability|studies|view|compat|ros2|hil|twin|web|cli)/'
forbid_app hil '(identified|share|events|view|compat|ros2|web|cli)/'
forbid_app twin '(share|events|studies|view|bringup|hil|compat|ros2|web|cli)/'
forbid_app compat '(report|stability|studies|view|bringup|hil|web|cli)/'
forbid_app ros2 '(report|stability|studies|view|bringup|hil|compat|web|cli)/'
# Libraries of the compatibility layer link no other library of Thimble, and use only its core.
for part in core haply hd hl hdphantom dhd; do
  [ -d "app/compat/$part" ] || continue
  forbid "app/compat/$part" 'compat/server/|thimble/(session|scene|render|device_sim)/|fmt/|spdlog/|yaml-cpp|hdf5' \
    "a library that must not be in the process of thimble exec"
done
for part in core server; do
  forbid "app/compat/$part" 'compat/(haply|hd|hl|hdphantom|dhd)/|(HD|HDU|HL)/|d[hr]dc\.h' "one API"
done
for folder in bag scene session report web stability studies bringup identified hil twin compat ros2 cli python; do
  forbid "app/$folder" "$graphics" "graphics, which only app/view uses"
done
for folder in bag scene session report web stability studies bringup identified hil twin view compat ros2 python; do
  forbid "app/$folder" 'CLI/' "the parser of arguments, which only app/cli uses"
done

# Eigen declares the cross product and the inverse in one header and defines them in another. A source that relies on a joined
# source or a precompiled header for the second does not link in builds without these (presets dev, mutants).
needs() {  # needs CALL HEADERS: a source with CALL, or its own header, includes one of HEADERS
  local source own
  for source in $(grep -rlF ".$1" driver device_sim render app tests --include='*.h' --include='*.cpp'); do
    own=$(basename "${source%.*}").h
    if ! grep -qE "<Eigen/($2)>" "$source" $(find driver device_sim render app tests -name "$own"); then
      echo "$source calls ${1%%(*}() and does not include <Eigen/${2%%|*}>, nor does its own header"
      bad=1
    fi
  done
}
needs 'cross(' 'Geometry'
needs 'inverse()' 'LU|Geometry|Eigenvalues|Dense'

# One rule for all outputs: files that a user names are written through app/scene/src/output. Other writers write the program's
# own state, drafts that they rename, and files in a folder that they have just created.
own_writers='app/(examples/|bag/write_bag|scene/src/(output/|arm/calibration|heat_keeper|files/kept_scene|arm_policy/feel_check_record)|session/src/share/steer/save_knobs|compat/server/free_scene)|render/src/mesh/file/save_mesh'
written=$(grep -rnE 'std::ofstream|fopen\([^)]*"[wa]' app render driver device_sim --include='*.h' --include='*.cpp' |
  grep -vE "^($own_writers)" || true)
if [ -n "$written" ]; then
  echo "A file is written without app/scene/src/output:"
  echo "$written" | sed 's/^/  /'
  bad=1
fi

# A reader searches a folder as a whole: headers and sources of a layer of render are counted together.
full=$(find driver device_sim render app tests -name '*.h' -o -name '*.cpp' -o -name '*.inc' |
  sed -E 's#^render/(include/thimble/render|src)/#render/#; s#/[^/]*$##' |
  sort | uniq -c | awk '$1 > 40 {print $2 ": " $1 " files, more than 40"}')
if [ -n "$full" ]; then
  echo "$full"
  bad=1
fi

exit $bad
