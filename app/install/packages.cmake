# Debian packages: `cpack -G DEB` in the build folder makes one of each installed component (CMakeLists.txt here).
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME thimble)
set(CPACK_PACKAGE_VENDOR "Thimble")
# The maintainer is named by the two variables that Debian's tools read. The default is an address
# that will never exist (RFC 2606).
set(CPACK_PACKAGE_CONTACT "Thimble developers <thimble@unreachable.invalid>")
if(DEFINED ENV{DEBEMAIL})
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own first line
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

# thimble_package(PACKAGE COMPONENT name [DEPENDS text] [RECOMMENDS text] [SUGGESTS text] [SECTION name] [LIBRARIES]
#                 DESCRIPTION text): adds a package. With LIBRARIES it also depends on the libraries that its files are linked
# with. Each package contains its licence and its changelog, as required by Debian.
macro(thimble_package package)
  cmake_parse_arguments(ARG "LIBRARIES" "COMPONENT;DEPENDS;RECOMMENDS;SUGGESTS;SECTION;DESCRIPTION" "" ${ARGN})
  string(TOUPPER ${ARG_COMPONENT} name)
  list(APPEND CPACK_COMPONENTS_ALL ${ARG_COMPONENT})
  set(CPACK_COMPONENT_${name}_GROUP ${ARG_COMPONENT})
  set(CPACK_DEBIAN_${name}_PACKAGE_NAME ${package})
  set(CPACK_DEBIAN_${name}_PACKAGE_SECTION science)
  if(ARG_SECTION)
    set(CPACK_DEBIAN_${name}_PACKAGE_SECTION ${ARG_SECTION})
  endif()
  if(ARG_LIBRARIES)
    set(CPACK_DEBIAN_${name}_PACKAGE_SHLIBDEPS ON)
  endif()
  foreach(relation DEPENDS RECOMMENDS SUGGESTS)
    if(ARG_${relation})
      set(CPACK_DEBIAN_${name}_PACKAGE_${relation} "${ARG_${relation}}")
    endif()
  endforeach()
  set(CPACK_COMPONENT_${name}_DESCRIPTION "${ARG_DESCRIPTION}")
  set(CPACK_DEBIAN_${name}_DESCRIPTION "${ARG_DESCRIPTION}")
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${package}")
  file(MAKE_DIRECTORY "${folder}")
  configure_file("${PROJECT_SOURCE_DIR}/LICENSE" "${folder}/copyright" COPYONLY)
  string(TIMESTAMP today "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE "${folder}/changelog" "thimble (${PROJECT_VERSION}) unstable; urgency=low

  * See CHANGELOG.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${today}
")
  execute_process(COMMAND gzip -9nf "${folder}/changelog")
  install(FILES "${folder}/copyright" "${folder}/changelog.gz"
          DESTINATION "share/doc/${package}" COMPONENT ${ARG_COMPONENT})
endmacro()
set(same_version "thimble (= ${PROJECT_VERSION})")

# Below 40 MB with all dependencies (tests/program/package_test.sh). Only recommended: scans that scenes name (unpacked on
# first use), plots, the libraries of report pages, and the other packages.
thimble_package(thimble COMPONENT program LIBRARIES
  RECOMMENDS "libcgal-demo, gnuplot-nox, fonts-dejavu-core, libjs-three, libjs-dygraphs, thimble-viewer, thimble-mesh-formats, thimble-bodies"
  SUGGESTS "thimble-studies, thimble-compat, thimble-ros2, python3-thimble"
  DESCRIPTION
"feel virtual objects through a force-feedback arm, real or simulated
Thimble drives 3-DOF force-feedback arms on USB, simulates them if none is
plugged in, and renders triangle meshes, shapes and fields at 1 kHz and more,
with textures, friction and bodies that dent, move and snap.")
list(APPEND CPACK_COMPONENTS_ALL udev)
set(CPACK_COMPONENT_UDEV_GROUP program)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_SOURCE_DIR}/postinst")  # udev reads the rules again

string(CONCAT development "${same_version}, libeigen3-dev, libusb-1.0-0-dev, libhidapi-dev, libassimp-dev, zlib1g-dev, libpng-dev, "
    "libfmt-dev, libyaml-cpp-dev, libhdf5-dev, libsqlite3-dev, libbullet-dev, libmuparser-dev, libspdlog-dev, pkg-config")
thimble_package(libthimble-dev COMPONENT dev SECTION libdevel DEPENDS "${development}" DESCRIPTION
"libraries and headers to build on Thimble
The driver of 3-DOF force-feedback arms, the simulated arm, the haptic
rendering, the scenes and the runs of Thimble as static libraries, with a
CMake package, a pkg-config file and small numbered examples.")

# OpenGL is opened at run time.
if(TARGET thimble_viewer_program)
  thimble_package(thimble-viewer COMPONENT viewer LIBRARIES DEPENDS "${same_version}"
    RECOMMENDS "libegl1, libegl-mesa0, libgl1, libgl1-mesa-dri" SUGGESTS "ffmpeg, zenity" DESCRIPTION
"window and pictures of runs of Thimble
The start window of scenes and the window of `thimble view`, which shows a run
or a recording, plays its sound and moves the simulated hand; and the pictures and animations of
`thimble shot`.")
endif()

if(TARGET thimble_studies_program)
  thimble_package(thimble-studies COMPONENT studies LIBRARIES DEPENDS "${same_version}" RECOMMENDS gnuplot-nox SUGGESTS valgrind
    DESCRIPTION
"measurements of accuracy, cost and stability of Thimble
The commands `thimble study`, `thimble bench` and `thimble mesh generate`.")
endif()

if(TARGET thimble_mesh_formats)
  thimble_package(thimble-mesh-formats COMPONENT mesh_formats LIBRARIES DEPENDS "${same_version}" DESCRIPTION
"more mesh formats for Thimble
Readers for meshes in COLLADA (DAE), AMF, 3DS and glTF 1.")
endif()

if(TARGET thimble_bodies)
  thimble_package(thimble-bodies COMPONENT bodies LIBRARIES DEPENDS "${same_version}" DESCRIPTION
"bodies that meet in scenes of Thimble
Collisions of the objects of a scene that move, and joints between them, by
the Bullet library.")
endif()

if(TARGET thimble_compat_libraries)
  thimble_package(thimble-compat COMPONENT compat LIBRARIES DEPENDS "${same_version}" DESCRIPTION
"programs written for other force-feedback arms, on Thimble
The libraries that `thimble exec` loads instead of those of other makers, with
the interfaces HDAPI, DHD and DRD, and hdPhantom of CHAI3D.")
  # Until 0.2 its files were in the package thimble.
  set(CPACK_DEBIAN_COMPAT_PACKAGE_BREAKS "thimble (<< 0.3.0)")
  set(CPACK_DEBIAN_COMPAT_PACKAGE_REPLACES "thimble (<< 0.3.0)")
endif()

# The Python module works only with the Python version for which it was built.
if(THIMBLE_HAS_PYTHON)
  math(EXPR python_next "${Python_VERSION_MINOR} + 1")
  string(CONCAT python_needs "${same_version}, python3-numpy, "
         "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${python_next})")
  thimble_package(python3-thimble COMPONENT python SECTION python LIBRARIES DEPENDS "${python_needs}"
    SUGGESTS "thimble-viewer, thimble-studies, python3-matplotlib, python3-numba, python3-tk, jupyter-notebook" DESCRIPTION
"feel virtual objects from Python
The scenes, simulated arms, recordings and studies of Thimble as numpy arrays:
whole runs in virtual time, tick by tick, or watched in real time.")
endif()

# Topics of ROS 2, if Cyclone DDS was found.
if(TARGET thimble_ros2)
  thimble_package(thimble-ros2 COMPONENT ros2 LIBRARIES DEPENDS "${same_version}" DESCRIPTION
"runs of Thimble as topics of ROS 2
The module of `thimble run --ros2`. It publishes joints, pose, velocity, force
and buttons of a force-feedback arm by DDS and receives forces. ROS need not be
installed.")
endif()
include(CPack)
