#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh_edges.h"
#include "mesh/repair/orient_mesh.h"

namespace thimble::render {
namespace {

// A link over an edge: the triangle behind it, and whether both have the edge in the same
// direction, so that one of them must be turned.
struct Link {
  std::int32_t triangle = -1;
  bool against = false;
};

std::vector<std::array<Link, 3>> links_of(const TriangleMesh& mesh) {
  std::vector<std::array<Link, 3>> links(mesh.triangles.size());
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  const auto link = [&links](const EdgeUse& use) -> Link& {
    return links[static_cast<std::size_t>(use.triangle)][static_cast<std::size_t>(use.corner)];
  };
  for (std::size_t begin = 0; begin < uses.size();) {
    const std::size_t end = end_of_edge(uses, begin);
    if (end - begin == 2) {
      const EdgeUse& first = uses[begin];
      const EdgeUse& second = uses[begin + 1];
      link(first) = {second.triangle, first.upward == second.upward};
      link(second) = {first.triangle, first.upward == second.upward};
    }
    begin = end;
  }
  return links;
}

// Spreads winding over one patch from `seed`: afterwards `turn` is set for each of its triangles
// that is wound against the seed. Returns the patch's triangles, and whether it has two sides.
std::pair<std::vector<std::int32_t>, bool> spread(const std::vector<std::array<Link, 3>>& links,
                                                  std::int32_t seed, std::vector<bool>& seen,
                                                  std::vector<bool>& turn) {
  std::vector<std::int32_t> patch{seed};
  bool two_sided = true;
  seen[static_cast<std::size_t>(seed)] = true;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    const auto t = static_cast<std::size_t>(patch[i]);
    for (const Link& link : links[t]) {
      if (link.triangle < 0) continue;
      const auto other = static_cast<std::size_t>(link.triangle);
      const bool wanted = turn[t] != link.against;
      if (!seen[other]) {
        seen[other] = true;
        turn[other] = wanted;
        patch.push_back(link.triangle);
      } else if (turn[other] != wanted) {
        two_sided = false;
      }
    }
  }
  return {std::move(patch), two_sided};
}

std::string plural(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

OrientReport orient_mesh(TriangleMesh& mesh) {
  const auto original = mesh.triangles;
  const auto links = links_of(mesh);
  std::vector<bool> seen(mesh.triangles.size(), false);
  std::vector<bool> turn(mesh.triangles.size(), false);
  std::vector<std::int32_t> one_sided;
  for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
    if (seen[seed]) continue;
    const auto [patch, two_sided] = spread(links, static_cast<std::int32_t>(seed), seen, turn);
    const auto against =
        static_cast<std::size_t>(std::count_if(patch.begin(), patch.end(), [&turn](std::int32_t t) {
          return turn[static_cast<std::size_t>(t)];
        }));
    const bool invert = 2 * against > patch.size();
    for (const std::int32_t t : patch) {
      const auto place = static_cast<std::size_t>(t);
      turn[place] = two_sided && turn[place] != invert;
      if (turn[place]) std::swap(mesh.triangles[place][1], mesh.triangles[place][2]);
    }
    if (!two_sided) one_sided.push_back(patch.front());
  }

  const MeshComponents parts = find_components(mesh, sorted_edge_uses(mesh));
  const auto part_of = [&parts](std::size_t t) {
    return static_cast<std::size_t>(parts.component_of[t]);
  };
  std::vector<bool> was_mixed(parts.count, false);
  for (std::size_t t = 0; t < turn.size(); ++t) {
    if (turn[t]) was_mixed[part_of(t)] = true;
  }
  std::vector<bool> is_one_sided(parts.count, false);
  for (const std::int32_t t : one_sided) is_one_sided[part_of(static_cast<std::size_t>(t))] = true;

  OrientReport report;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (parts.inside_out[part_of(t)]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    // Two swaps give the original order back; one never does, because the corners differ.
    if (mesh.triangles[t] == original[t]) continue;
    if (report.turned_triangles++ == 0) report.first_turned = static_cast<std::int32_t>(t);
  }
  for (std::size_t part = 0; part < parts.count; ++part) {
    report.repaired_components += was_mixed[part];
    report.turned_components += parts.inside_out[part] && !was_mixed[part];
    report.one_sided_components += is_one_sided[part];
  }
  return report;
}

std::string describe(const OrientReport& report) {
  std::string text;
  if (report.turned_triangles > 0) {
    text = plural(report.turned_triangles, "triangle was", "triangles were") +
           " reversed (the first: triangle " + std::to_string(report.first_turned) +
           "): " + plural(report.repaired_components, "component was", "components were") +
           " inconsistently oriented, " + std::to_string(report.turned_components) + " inside out.";
  }
  if (report.one_sided_components > 0) {
    if (!text.empty()) text += ' ';
    text += plural(report.one_sided_components, "component has", "components have") +
            " only one side, like a Moebius strip, so no orientation is consistent; use it as a "
            "sheet.";
  }
  return text;
}

}  // namespace thimble::render
