#!/usr/bin/env bash
# Tests layering.sh: plants forbidden includes of each kind in a copy, all at once, and checks
# that each is reported.
#   tests/arch/layering_catches.sh SOURCE_DIR
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
source=$1
copy=$(mktemp -d)
said=$(mktemp)
planted=$(mktemp)
trap 'rm -rf "$copy" "$said" "$planted"' EXIT

make_copy() {
  rm -rf "${copy:?}"/*
  (cd "$source" && find driver/include driver/src device_sim render app tests -name '*.h' -o -name '*.cpp' -o -name '*.inc') |
    tar -c -C "$source" -T - | tar -x -C "$copy"
}
plant() {  # plant FILE INCLUDE
  echo "#include $2" >>"$copy/$1"
  printf '%s\t%s\t%s\n' "$1" "$(wc -l <"$copy/$1")" "$2" >>"$planted"
}

bash "$here/layering.sh" "$1"
make_copy
bash "$here/layering.sh" "$copy"
plant driver/include/thimble/driver/fault.h '<spdlog/spdlog.h>'
plant driver/include/thimble/driver/fault.h '<libusb-1.0/libusb.h>'
plant driver/include/thimble/driver/fault.h '<boost/beast.hpp>'
plant driver/src/fault.cpp '"thimble/render/touch.h"'
plant device_sim/include/thimble/device_sim/settings.h '"thimble/render/touch.h"'
plant device_sim/include/thimble/device_sim/settings.h '"thimble/driver/device.h"'
plant device_sim/src/hand/hand.cpp '"transports/stream_transport.h"'
plant device_sim/src/hand/hand.cpp '"vendors/force_box.h"'
plant render/include/thimble/render/touch.h '"thimble/driver/transport.h"'
plant render/include/thimble/render/touch.h '"thimble/driver/arms/hfab/hfab_arm.h"'
plant render/include/thimble/render/touch.h '"thimble/device_sim/settings.h"'
# A private header in an installed one.
plant driver/include/thimble/driver/device.h '"little_endian.h"'
plant device_sim/include/thimble/device_sim/usb/usb_arm.h '"usb/usb_description.h"'
plant render/include/thimble/render/build_object_touch.h '"build_surface_touch.h"'
plant render/include/thimble/render/build_object_touch.h '"track/god_object.h"'
plant app/scene/include/thimble/scene/scene_file.h '"yaml/yaml_reader.h"'
plant app/scene/include/thimble/scene/arm_file.h '<yaml-cpp/yaml.h>'
plant app/session/include/thimble/session/session.h '"run_loop.h"'
plant app/session/include/thimble/session/recording.h '<hdf5.h>'
plant app/python/module.cpp '"recording/recorder.h"'
plant app/python/module.cpp '"report/report.h"'
plant app/compat/core/arm_access.cpp '"thimble/session/session.h"'
plant app/compat/hd/hd_device.cpp '"compat/server/arm_server.h"'
plant app/compat/server/arm_server.cpp '"compat/hd/hd_device.h"'
plant app/session/src/session.cpp '"compat/core/arm_data.h"'
# One forbidden include for each layer of render.
plant render/include/thimble/render/contact_state.h '"thimble/render/mesh/triangle_mesh.h"'
plant render/include/thimble/render/contact_state.h '"thimble/render/object_touch.h"'
plant render/include/thimble/render/effect/live_settings.h '"thimble/render/effect/effect_table.h"'
plant render/src/mesh/contact_mesh.cpp '"compact_mesh/packed_surface.h"'
plant render/src/compact_mesh/packed_surface.cpp '"search/contact_search.h"'
plant render/src/search/tree_search.cpp '"track/surface_tracker.h"'
plant render/src/search/segment_lanes.inc '"track/packed_store.h"'
plant render/src/track/surface_tracker.cpp '"body/motion/rigid_body.h"'
plant render/src/track/surface_tracker.cpp '"thimble/render/object_touch.h"'
plant render/include/thimble/render/touch.h '"thimble/render/surface/spring_damper.h"'
plant render/include/thimble/render/effect/stage_list.h '"thimble/render/surface/spring_damper.h"'
plant render/src/surface/friction/bristle.cpp '"field/viscous.h"'
plant render/src/field/viscous.cpp '"track/god_object.h"'
plant render/src/body/motion/rigid_body.cpp '"track/god_object.h"'
plant render/src/body/motion/rigid_body.cpp '"build_surface_touch.h"'
plant render/src/disk_paging/page_file.cpp '"thimble/render/object_touch.h"'
plant render/src/multirate/model_slot.cpp '"track/god_object.h"'
plant render/src/track/packed_contact.h '"disk_paging/page_file.h"'
# One forbidden include for each library of app.
plant app/scene/include/thimble/scene/arm_file.h '"thimble/session/session.h"'
plant app/scene/src/meshes/object_mesh.cpp '"report/figure_output.h"'
plant app/session/src/session.cpp '"report/report.h"'
plant app/session/src/share/live_control.h '"cli/exit_code.h"'
plant app/session/include/thimble/session/session.h '"setup.h"'
plant app/session/include/thimble/session/recording.h '<hdf5.h>'
plant app/session/src/observers/trace.h '"observers/black_box.h"'
plant app/session/src/share/run_sharing.cpp '"observers/dent_record.h"'
plant app/report/figure_output.cpp '"stability/tuning.h"'
plant app/stability/tuning.h '"studies/study.h"'
plant app/studies/study.h '"view/window.h"'
plant app/view/window.h '"report/report.h"'
plant app/bringup/doctor.h '"thimble/session/session.h"'
plant app/report/report.h '<epoxy/gl.h>'
plant app/bringup/doctor.h '<CLI/CLI.hpp>'
# Each must be reported with its file.
if bash "$here/layering.sh" "$copy" >"$said"; then
  echo "layering.sh did not report any planted include"
  exit 1
fi
missed=0
while IFS=$'\t' read -r file line header; do
  grep -qF -- "$file:$line:#include $header" "$said" && continue
  grep -F -- "  $file: " "$said" | grep -qF -- "(${header//\"/})" && continue # a layer of render
  echo "layering.sh did not report #include $header in $file"
  missed=1
done <"$planted"
[ $missed = 0 ]
echo "$(wc -l <"$planted") forbidden includes, each reported"

# A source that relies on the includes of joined sources, and folders with too many sources.
make_copy
sed -i '/Eigen.Geometry/d' "$copy/app/stability/rest_warnings.cpp" "$copy/tests/unit/render/search/parallel_build_test.cpp"
sed -i '/Eigen.LU/d' "$copy/app/twin/drive_train_twin.cpp"
echo '// std::ofstream(file) << text;' >>"$copy/app/report/figure_output.cpp"
for folder in driver/src device_sim/src/plant render/src/search app/view tests/support; do
  for i in $(seq 41); do touch "$copy/$folder/one_more_$i.h"; done
done
bash "$here/layering.sh" "$copy" >"$said" || true
for line in '  app/report/figure_output.cpp:' 'app/stability/rest_warnings.cpp calls cross()' 'app/twin/drive_train_twin.cpp calls inverse()' \
  'tests/unit/render/search/parallel_build_test.cpp calls cross()' \
  'driver/src: ' 'device_sim/src/plant: ' 'render/search: ' 'app/view: ' 'tests/support: '; do
  grep -qF -- "$line" "$said" || {
    echo "layering.sh did not report: $line"
    exit 1
  }
done
