#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "body/spring/spring_motion.h"
#include "body/spring/spring_network.h"
#include "thimble/driver/result.h"

namespace thimble::studies {

/// A body that is poked at one node and let go, and how it truly moves: all numbers of all nodes
/// at the end of each frame of 1 ms.
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
  double frame_us = 0;    ///< of work; the least of several runs
  double error = 0;       ///< largest of all nodes and frames, as a share of the largest motion
  bool diverged = false;  ///< then error stands for nothing
};

inline constexpr double kFrame = 1e-3;  // s

/// Makes the poked body ready to run by `options` (whose step is a frame).
template <int kDof>
driver::Result<render::SpringMotion<kDof>> motion_of(const PokedBody<kDof>& body,
                                                     render::SpringScheme scheme, int substeps);

/// Runs it and compares it with the truth, then runs it again for time. Real-time: never from the
/// servo thread.
template <int kDof>
driver::Result<WorkPoint> measure(const PokedBody<kDof>& body, render::SpringScheme scheme,
                                  int substeps);

/// Does the same by modes; the error says why the body has none that can be used.
template <int kDof>
driver::Result<WorkPoint> measure_modal(const PokedBody<kDof>& body);

}  // namespace thimble::studies
