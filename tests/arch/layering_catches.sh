#!/usr/bin/env bash
# Proves that layering.sh can fail: plants one forbidden include of each kind in a copy.
#   tests/arch/layering_catches.sh SOURCE_DIR
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
copy=$(mktemp -d)
saved=$(mktemp)
trap 'rm -rf "$copy" "$saved"' EXIT

plant() {
  cp "$copy/$2" "$saved"
  echo "#include $3" >>"$copy/$2"
  if bash "$here/layering.sh" "$copy" >/dev/null; then
    echo "layering.sh did not notice '#include $3' in $2"
    exit 1
  fi
  cp "$saved" "$copy/$2"
}
bash "$here/layering.sh" "$1"
(cd "$1" && find driver/include driver/src device_sim render app -name '*.h' -o -name '*.cpp' -o -name '*.inc') |
  tar -c -C "$1" -T - | tar -x -C "$copy"
plant "$1" driver/include/thimble/driver/fault.h '<spdlog/spdlog.h>'
plant "$1" driver/include/thimble/driver/fault.h '<libusb-1.0/libusb.h>'
plant "$1" driver/include/thimble/driver/fault.h '<boost/beast.hpp>'
plant "$1" driver/src/fault.cpp '"thimble/render/touch.h"'
plant "$1" device_sim/include/thimble/device_sim/settings.h '"thimble/render/touch.h"'
plant "$1" device_sim/include/thimble/device_sim/settings.h '"thimble/driver/device.h"'
plant "$1" device_sim/src/hand.cpp '"stream_transport.h"'
plant "$1" device_sim/src/hand.cpp '"links/force_box.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/driver/transport.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/driver/arms/hfab/hfab_arm.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/device_sim/settings.h"'
# A header that is not installed, in one that is.
plant "$1" driver/include/thimble/driver/device.h '"little_endian.h"'
plant "$1" device_sim/include/thimble/device_sim/usb/usb_arm.h '"usb/usb_description.h"'
plant "$1" render/include/thimble/render/build_object_touch.h '"touch_of.h"'
plant "$1" render/include/thimble/render/build_object_touch.h '"track/god_object.h"'
plant "$1" app/scene/include/thimble/scene/scene_file.h '"yaml/yaml_reader.h"'
plant "$1" app/scene/include/thimble/scene/arm_file.h '<yaml-cpp/yaml.h>'
plant "$1" app/session/include/thimble/session/session.h '"run_loop.h"'
plant "$1" app/session/include/thimble/session/recording.h '<hdf5.h>'
plant "$1" app/python/module.cpp '"recording/recorder.h"'
plant "$1" app/python/module.cpp '"report/report.h"'
plant "$1" app/faces/core/arm_access.cpp '"thimble/session/session.h"'
plant "$1" app/faces/hd/hd_device.cpp '"faces/server/arm_server.h"'
plant "$1" app/faces/server/arm_server.cpp '"faces/hd/hd_device.h"'
plant "$1" app/session/src/session.cpp '"faces/core/arm_data.h"'
# One forbidden include for each layer of render.
plant "$1" render/include/thimble/render/contact_state.h '"thimble/render/mesh/triangle_mesh.h"'
plant "$1" render/include/thimble/render/contact_state.h '"thimble/render/object_touch.h"'
plant "$1" render/include/thimble/render/effect/live_settings.h '"thimble/render/effect/effect_table.h"'
plant "$1" render/src/mesh/contact_mesh.cpp '"packed/packed_surface.h"'
plant "$1" render/src/packed/packed_surface.cpp '"search/contact_search.h"'
plant "$1" render/src/search/tree_search.cpp '"track/surface_tracker.h"'
plant "$1" render/src/search/segment_lanes.inc '"track/packed_store.h"'
plant "$1" render/src/track/surface_tracker.cpp '"body/motion/rigid_body.h"'
plant "$1" render/src/track/surface_tracker.cpp '"thimble/render/object_touch.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/render/surface/spring_damper.h"'
plant "$1" render/include/thimble/render/effect/stage_list.h '"thimble/render/surface/spring_damper.h"'
plant "$1" render/src/surface/friction/bristle.cpp '"field/viscous.h"'
plant "$1" render/src/field/viscous.cpp '"track/god_object.h"'
plant "$1" render/src/body/motion/rigid_body.cpp '"track/god_object.h"'
plant "$1" render/src/body/motion/rigid_body.cpp '"touch_of.h"'
plant "$1" render/src/page/page_file.cpp '"thimble/render/object_touch.h"'
plant "$1" render/src/multirate/model_slot.cpp '"track/god_object.h"'
plant "$1" render/src/track/packed_contact.h '"page/page_file.h"'
# One forbidden include for each library of app.
plant "$1" app/scene/include/thimble/scene/arm_file.h '"thimble/session/session.h"'
plant "$1" app/scene/src/place_mesh.cpp '"report/figure.h"'
plant "$1" app/session/src/session.cpp '"report/report.h"'
plant "$1" app/session/src/share/live_control.h '"cli/exit_code.h"'
plant "$1" app/session/include/thimble/session/session.h '"setup.h"'
plant "$1" app/session/include/thimble/session/recording.h '<hdf5.h>'
plant "$1" app/session/src/observers/trace.h '"observers/black_box.h"'
plant "$1" app/session/src/share/run_sharing.cpp '"observers/dent_record.h"'
plant "$1" app/report/figure.cpp '"stability/tuning.h"'
plant "$1" app/stability/tuning.h '"studies/study.h"'
plant "$1" app/studies/study.h '"view/window.h"'
plant "$1" app/view/window.h '"report/report.h"'
plant "$1" app/bringup/doctor.h '"thimble/session/session.h"'
plant "$1" app/report/report.h '<epoxy/gl.h>'
plant "$1" app/bringup/doctor.h '<CLI/CLI.hpp>'
# A source that leaves an include to the sources it is joined with.
sed -i.bak '/Eigen.Geometry/d' "$copy/app/stability/rest_warnings.cpp"
if bash "$here/layering.sh" "$copy" >/dev/null; then
  echo "layering.sh did not notice a cross product without its header"
  exit 1
fi
mv "$copy/app/stability/rest_warnings.cpp.bak" "$copy/app/stability/rest_warnings.cpp"
# And a folder that is too full.
bash "$here/layering.sh" "$copy"
for i in $(seq 41); do touch "$copy/render/src/search/one_more_$i.h"; done
if bash "$here/layering.sh" "$copy" >/dev/null; then
  echo "layering.sh did not notice a folder of more than 40 files"
  exit 1
fi
for i in $(seq 41); do rm "$copy/render/src/search/one_more_$i.h"; touch "$copy/app/view/one_more_$i.h"; done
if bash "$here/layering.sh" "$copy" >/dev/null; then
  echo "layering.sh did not notice a folder of app of more than 40 files"
  exit 1
fi
