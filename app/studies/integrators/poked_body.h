#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "body/spring/spring_motion.h"
#include "body/spring/spring_network.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// A body that is pushed at one node and released, and its true motion: the values of all nodes at
/// the end of each frame of 1 ms.
template <int kDof>
struct PokedBody {
  using Vector = typename render::SpringNetwork<kDof>::Vector;

  render::SpringNetwork<kDof> network;
  std::int32_t poked = 0;
  Vector force = Vector::Zero();  ///< N
  int poke_frames = 50;
  std::vector<std::vector<Vector>> truth;  ///< m, per frame and node
};

/// One point of a work-precision diagram.
struct WorkPoint {
  std::string integrator;
  int substeps = 1;       ///< per frame
  double frame_us = 0;    ///< computing time per frame; the minimum of several runs
  double error = 0;       ///< largest of all nodes and frames, as a fraction of the largest motion
  bool diverged = false;  ///< if true, `error` is undefined
};

inline constexpr double kFrame = 1e-3;  // s

/// Prepares the body to run with `options` (whose step is a frame).
template <int kDof>
driver::Result<render::SpringMotion<kDof>> motion_of(const PokedBody<kDof>& body,
                                                     render::SpringScheme scheme, int substeps);

/// Runs it and compares it with the truth, then runs it again for timing. Real-time: never from the
/// servo thread.
template <int kDof>
driver::Result<WorkPoint> measure(const PokedBody<kDof>& body, render::SpringScheme scheme,
                                  int substeps);

/// Does the same by modes; the error says why the body has no usable modes.
template <int kDof>
driver::Result<WorkPoint> measure_modal(const PokedBody<kDof>& body);

}  // namespace thimble::studies
