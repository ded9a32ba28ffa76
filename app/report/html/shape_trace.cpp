#include "report/html/shape_trace.h"

#include <algorithm>
#include <utility>

#include "share/shared_edge_split.h"

namespace thimble::report {

ShapeTrace::ShapeTrace(std::vector<Shaped> shaped)
    : shaped_(std::move(shaped)), frames_(kFramesMax), moves_(kMovesMax) {
  std::size_t vertices = 0, splits = 0;
  for (const Shaped& one : shaped_) {
    first_.push_back(static_cast<std::uint32_t>(vertices));
    vertices_now_.push_back(one.vertices);
    vertices += one.vertices + one.shape->splits_left();
    splits += one.shape->splits_left();
  }
  first_.push_back(static_cast<std::uint32_t>(vertices));
  marked_.resize(vertices);
  waiting_.resize(vertices);
  splits_.resize(splits);
}

void ShapeTrace::mark(std::uint32_t vertex) noexcept {
  if (vertex >= marked_.size() || marked_[vertex] != 0) return;
  marked_[vertex] = 1;
  waiting_[waiting_count_++] = vertex;
}

void ShapeTrace::take(const driver::TickRecord& tick) noexcept {
  newest_ns_ = tick.time_ns;
  for (std::size_t i = 0; i < shaped_.size(); ++i) {
    const render::BodyShape& shape = *shaped_[i].shape;
    for (const render::VertexMove& move : shape.moves()) {
      mark(first_[i] + static_cast<std::uint32_t>(move.vertex));
    }
    for (const render::EdgeSplit& split : shape.splits()) {
      // A tick in which the scene is not computed repeats the splits of the last one.
      if (split.vertex < 0 || static_cast<std::size_t>(split.vertex) != vertices_now_[i]) continue;
      if (split_count_ == splits_.size()) continue;
      ++vertices_now_[i];
      splits_[split_count_++] = {i, split};
      mark(first_[i] + static_cast<std::uint32_t>(split.vertex));
    }
  }
  if (waiting_count_ > 0 && tick.time_ns >= next_ns_) keep(tick.time_ns);
}

std::size_t ShapeTrace::owner(std::uint32_t vertex) const noexcept {
  const auto after = std::upper_bound(first_.begin(), first_.end(), vertex);
  return static_cast<std::size_t>(after - first_.begin()) - 1;
}

void ShapeTrace::keep(std::int64_t time_ns) noexcept {
  const auto full = [this] {
    return frame_count_ == frames_.size() || move_count_ + waiting_count_ > moves_.size();
  };
  // If there is still no room, the moves wait for the next picture.
  if (full()) halve();
  next_ns_ = time_ns + step_ns_;
  if (full()) return;
  for (std::size_t k = 0; k < waiting_count_; ++k) {
    const std::uint32_t vertex = waiting_[k];
    const std::size_t i = owner(vertex);
    const Eigen::Vector3d& p =
        shaped_[i].shape->place(static_cast<std::int32_t>(vertex - first_[i]));
    moves_[move_count_++] = {
        vertex, {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())}};
    marked_[vertex] = 0;
  }
  waiting_count_ = 0;
  frames_[frame_count_++] = {time_ns, move_count_, split_count_};
}

void ShapeTrace::halve() noexcept {
  // Mark 1: waiting. Mark 2: the later picture of a pair has the vertex too.
  std::size_t stays = 0, move = 0, begin = 0;
  for (std::size_t i = 0; i < frame_count_; i += 2) {
    const bool pair = i + 1 < frame_count_;
    const std::size_t middle = frames_[i].moves_end;
    const Frame last = frames_[pair ? i + 1 : i];
    for (std::size_t k = middle; k < last.moves_end; ++k) marked_[moves_[k].vertex] |= 2;
    for (std::size_t k = begin; k < middle; ++k) {
      if ((marked_[moves_[k].vertex] & 2) == 0 || !pair) moves_[move++] = moves_[k];
    }
    for (std::size_t k = middle; k < last.moves_end; ++k) {
      marked_[moves_[k].vertex] &= 1;
      moves_[move++] = moves_[k];
    }
    begin = last.moves_end;
    frames_[stays++] = {last.time_ns, move, last.splits_end};
  }
  frame_count_ = stays;
  move_count_ = move;
  step_ns_ *= 2;
}

std::vector<ShapeStep> ShapeTrace::steps(std::vector<render::TriangleMesh> first,
                                         std::int64_t begin_ns) {
  if (waiting_count_ > 0) keep(newest_ns_);
  std::vector<ShapeStep> steps;
  std::vector<render::TriangleMesh> meshes = std::move(first);
  std::size_t move = 0, split = 0;
  for (std::size_t i = 0; i < frame_count_; ++i) {
    std::vector<render::TriangleMesh> next = meshes;
    for (; split < frames_[i].splits_end; ++split) {
      const render::EdgeSplit& edge = splits_[split].split;
      session::split_edge(next[splits_[split].shaped], static_cast<std::uint32_t>(edge.ends[0]),
                          static_cast<std::uint32_t>(edge.ends[1]),
                          {static_cast<std::uint32_t>(edge.triangles[0]),
                           static_cast<std::uint32_t>(edge.triangles[1])});
    }
    for (; move < frames_[i].moves_end; ++move) {
      const std::size_t which = owner(moves_[move].vertex);
      const std::size_t vertex = moves_[move].vertex - first_[which];
      const auto& place = moves_[move].place;
      if (vertex < next[which].vertices.size()) {
        next[which].vertices[vertex] = {place[0], place[1], place[2]};
      }
    }
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      ShapeStep step = shape_step(meshes[k], next[k]);
      step.t = 1e-9 * static_cast<double>(frames_[i].time_ns - begin_ns);
      step.object = shaped_[k].object;
      if (!step.empty()) steps.push_back(std::move(step));
    }
    meshes = std::move(next);
  }
  return steps;
}

}  // namespace thimble::report
