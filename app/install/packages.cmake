# `cpack -G DEB` in the build folder: Debian packages.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME thimble)
set(CPACK_PACKAGE_VENDOR "Thimble")
# Who builds a package answers for it, by the same two variables that Debian's own tools read. The
# fallback says that nobody can be written to, in an address that will never exist (RFC 2606).
set(CPACK_PACKAGE_CONTACT "Thimble developers <thimble@unreachable.invalid>")
if(DEFINED ENV{DEBEMAIL})
  set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has a first line of its own
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program udev dev)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_PROGRAM_GROUP program)
set(CPACK_COMPONENT_UDEV_GROUP program)
set(CPACK_COMPONENT_DEV_GROUP dev)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME thimble)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libthimble-dev)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Not needed to touch: scans that scenes name (unpacked on first use), OpenGL for shots and the window, which
# is opened at run time, plots, and what a page in the browser is made of.
string(CONCAT CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "libcgal-demo, "
    "libegl1, libegl-mesa0, libgl1, libgl1-mesa-dri, gnuplot-nox, fonts-dejavu-core, libjs-three, libjs-dygraphs")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "valgrind")
string(CONCAT CPACK_DEBIAN_DEV_PACKAGE_DEPENDS
    "thimble (= ${PROJECT_VERSION}), libeigen3-dev, libusb-1.0-0-dev, libhidapi-dev, libassimp-dev, zlib1g-dev, libpng-dev, "
    "libfmt-dev, libyaml-cpp-dev, libhdf5-dev, libsqlite3-dev, libspdlog-dev, pkg-config")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"touch virtual objects by a force-feedback arm, real or simulated
Thimble drives 3-DOF force-feedback arms on USB, simulates them where there is
none, and renders triangle meshes, shapes and fields to the hand at 1 kHz and
more, with textures, friction and bodies that dent, move and snap.")
set(CPACK_COMPONENT_DEV_DESCRIPTION
"libraries and headers to build on Thimble
The driver of 3-DOF force-feedback arms, the simulated arm, the haptic
rendering, the scenes and the runs of Thimble as static libraries, with a
CMake package, a pkg-config file and small numbered examples.")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "${CPACK_COMPONENT_PROGRAM_DESCRIPTION}")
set(CPACK_DEBIAN_DEV_DESCRIPTION "${CPACK_COMPONENT_DEV_DESCRIPTION}")

# Python's module, where it was built: for the Python that it was built with, and no other.
set(packages thimble libthimble-dev)
if(THIMBLE_HAS_PYTHON)
  list(APPEND packages python3-thimble)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_COMPONENT_PYTHON_GROUP python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-thimble)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  math(EXPR python_next "${Python_VERSION_MINOR} + 1")
  string(CONCAT CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "thimble (= ${PROJECT_VERSION}), python3-numpy, "
         "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${python_next})")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-numba, jupyter-notebook")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION
"touch virtual objects from Python
The scenes, simulated arms, recordings and studies of Thimble as numpy arrays:
whole runs in virtual time, tick by tick, or watched in real time.")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "${CPACK_COMPONENT_PYTHON_DESCRIPTION}")
endif()

# Topics of ROS 2, where there was a Cyclone DDS to build the module with.
if(TARGET thimble_ros2)
  list(APPEND packages thimble-ros2)
  list(APPEND CPACK_COMPONENTS_ALL ros2)
  set(CPACK_COMPONENT_ROS2_GROUP ros2)
  set(CPACK_DEBIAN_ROS2_PACKAGE_NAME thimble-ros2)
  set(CPACK_DEBIAN_ROS2_PACKAGE_SECTION science)
  set(CPACK_DEBIAN_ROS2_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_ROS2_PACKAGE_DEPENDS "thimble (= ${PROJECT_VERSION})")
  set(CPACK_COMPONENT_ROS2_DESCRIPTION
"runs of Thimble as topics of ROS 2
What `thimble run --ros2` loads: it publishes joints, pose, velocity, force and
buttons of a force-feedback arm by DDS and takes forces, without ROS installed.")
  set(CPACK_DEBIAN_ROS2_DESCRIPTION "${CPACK_COMPONENT_ROS2_DESCRIPTION}")
endif()

# What Debian wants of every package: its licence and its changes, and rules that udev reads anew.
foreach(package ${packages})
  set(folder "${CMAKE_CURRENT_BINARY_DIR}/${package}")
  file(MAKE_DIRECTORY "${folder}")
  configure_file("${PROJECT_SOURCE_DIR}/LICENSE" "${folder}/copyright" COPYONLY)
  string(TIMESTAMP today "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(WRITE "${folder}/changelog" "thimble (${PROJECT_VERSION}) unstable; urgency=low

  * See CHANGELOG.md.

 -- ${CPACK_PACKAGE_CONTACT}  ${today}
")
  execute_process(COMMAND gzip -9nf "${folder}/changelog")
  if(package STREQUAL thimble)
    set(component program)
  elseif(package STREQUAL python3-thimble)
    set(component python)
  elseif(package STREQUAL thimble-ros2)
    set(component ros2)
  else()
    set(component dev)
  endif()
  install(FILES "${folder}/copyright" "${folder}/changelog.gz"
          DESTINATION "share/doc/${package}" COMPONENT ${component})
endforeach()
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_SOURCE_DIR}/postinst")
include(CPack)
