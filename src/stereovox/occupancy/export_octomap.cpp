#include "stereovox/occupancy/export_octomap.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "stereovox/core/error.h"
#include "stereovox/io/atomic_file.h"
#include "stereovox/occupancy/byte_buffer.h"

namespace stereovox {
namespace {

constexpr int kDepth = 16, kKeyOfZero = 1 << (kDepth - 1);
constexpr int kChildBits = 3, kChildren = 1 << kChildBits;

struct Leaf {
  std::uint64_t place;  // the child numbers from the root down, three bits each
  float value;          // log-odds
};

// Three bits for each level: x lowest, the level of the root highest.
std::uint64_t place_of(const Eigen::Vector3i& voxel) {
  std::uint64_t place = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int key = voxel[axis] + kKeyOfZero;
    if (key < 0 || key >= 2 * kKeyOfZero)
      throw Error(fmt::format("voxel ({}, {}, {}) lies outside what OctoMap can hold", voxel.x(),
                              voxel.y(), voxel.z()));
    for (int bit = 0; bit < kDepth; ++bit)
      place |= std::uint64_t{static_cast<unsigned>(key >> bit & 1)} << (kChildBits * bit + axis);
  }
  return place;
}

float log_odds(float state, bool is_occupied) {
  constexpr double kLeast = 0.001;
  const double p = std::clamp(static_cast<double>(state), kLeast, 1.0 - kLeast);
  const auto value = static_cast<float>(std::log(p / (1.0 - p)));
  // OctoMap takes 0 for occupied.
  return is_occupied ? std::max(value, 0.0F) : std::min(value, std::nextafter(0.0F, -1.0F));
}

std::vector<Leaf> leaves_of(const VoxelMap& map, const QueryParams& params, OctomapForm form) {
  const MapQueries queries(map, params);
  std::vector<Leaf> leaves;
  map.for_each_block([&](const VoxelBlock& block) {
    for_each_in(block.voxels.known(), [&](int i) {
      const Voxel voxel = block.voxels[static_cast<std::size_t>(i)];
      const VoxelState state = queries.state_of(voxel);
      if (state == VoxelState::unknown) return;
      const bool is_occupied = state == VoxelState::occupied;
      const float value = form == OctomapForm::full ? log_odds(voxel.state, is_occupied)
                          : is_occupied             ? 1.0F
                                                    : -1.0F;
      leaves.push_back({place_of(voxel_at(block.index, i)), value});
    });
  });
  std::ranges::sort(leaves, {}, &Leaf::place);
  return leaves;
}

struct Node {
  bool exists = false, is_leaf = false;
  float value = 0.0F;  // of an inner node the largest below it
};
using Children = std::array<Node, kChildren>;

bool can_be_pruned(const Children& children) {
  return std::ranges::all_of(children, [&](const Node& child) {
    return child.exists && child.is_leaf && child.value == children.front().value;
  });
}

// Writes nodes before their children: leaves room for a node and fills it when all below is known.
class TreeWriter {
 public:
  explicit TreeWriter(OctomapForm form) : form_(form) {}

  // The leaves are those below one node, `level` levels above voxels.
  Node write(std::span<const Leaf> leaves, int level) {
    ++nodes_;
    if (level == 0) {
      if (form_ == OctomapForm::full) put_full(reserve(), leaves.front().value, 0);
      return {true, true, leaves.front().value};
    }
    const std::size_t place = reserve(), nodes_before = nodes_;
    const Children children = write_children(leaves, level - 1);
    if (!can_be_pruned(children)) return finish(place, children);
    bytes_.resize(form_ == OctomapForm::full ? place + kFullBytes : place);
    nodes_ = nodes_before;
    if (form_ == OctomapForm::full) put_full(place, children.front().value, 0);
    return {true, true, children.front().value};
  }

  const std::string& bytes() const { return bytes_; }
  std::size_t nodes() const { return nodes_; }

 private:
  static constexpr std::size_t kFullBytes = 5, kBinaryBytes = 2;

  std::size_t reserve() {
    const std::size_t place = bytes_.size();
    bytes_.resize(place + (form_ == OctomapForm::full ? kFullBytes : kBinaryBytes));
    return place;
  }

  Children write_children(std::span<const Leaf> leaves, int level) {
    Children children;
    while (!leaves.empty()) {
      const std::uint64_t subtree = leaves.front().place >> kChildBits * level;
      const auto end = std::ranges::partition_point(
          leaves, [&](const Leaf& leaf) { return leaf.place >> kChildBits * level == subtree; });
      const auto count = static_cast<std::size_t>(end - leaves.begin());
      children[subtree % kChildren] = write(leaves.first(count), level);
      leaves = leaves.subspan(count);
    }
    return children;
  }

  Node finish(std::size_t place, const Children& children) {
    Node node{true, false, -std::numeric_limits<float>::infinity()};
    std::uint16_t mask = 0, states = 0;
    for (int i = 0; i < kChildren; ++i) {
      const Node& child = children[static_cast<std::size_t>(i)];
      if (!child.exists) continue;
      node.value = std::max(node.value, child.value);
      mask = static_cast<std::uint16_t>(mask | 1U << i);
      const unsigned state = !child.is_leaf ? 3U : child.value < 0.0F ? 1U : 2U;
      states = static_cast<std::uint16_t>(states | state << 2 * i);
    }
    if (form_ == OctomapForm::full)
      put_full(place, node.value, static_cast<std::uint8_t>(mask));
    else
      put(place, states);
    return node;
  }

  void put_full(std::size_t place, float value, std::uint8_t mask) {
    put(place, value);
    put(place + sizeof value, mask);
  }
  template <class Number>
  void put(std::size_t place, Number number) {
    std::string text;
    append_number(text, number);
    bytes_.replace(place, text.size(), text);
  }

  OctomapForm form_;
  std::string bytes_;
  std::size_t nodes_ = 0;
};

}  // namespace

void export_octomap(std::ostream& out, OctomapForm form, const VoxelMap& map,
                    const QueryParams& params) {
  const std::vector<Leaf> leaves = leaves_of(map, params, form);
  TreeWriter tree(form);
  if (!leaves.empty()) tree.write(leaves, kDepth);
  out << (form == OctomapForm::full ? "# Octomap OcTree file\n" : "# Octomap OcTree binary file\n")
      << fmt::format("id OcTree\nsize {}\nres {}\ndata\n", tree.nodes(), map.voxel_size_m())
      << tree.bytes();
}

void export_octomap(const std::filesystem::path& path, const VoxelMap& map,
                    const QueryParams& params) {
  const std::string form = path.extension();
  if (form != ".bt" && form != ".ot")
    throw Error(path.string() + ": an octree file ends in .bt or .ot");
  write_file_atomically(path, [&](std::ostream& out) {
    export_octomap(out, form == ".bt" ? OctomapForm::binary : OctomapForm::full, map, params);
  });
}

}  // namespace stereovox
