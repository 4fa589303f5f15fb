#include "stereovox/occupancy/export_openvdb.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include "stereovox/io/atomic_file.h"

namespace stereovox {
namespace {

constexpr float kUnknown = 0.5F;

// Blocks and OpenVDB's leaves are cubes of the same 8 x 8 x 8 voxels.
void add_block(const MapQueries& queries, const VoxelBlock& block, openvdb::FloatTree& tree) {
  openvdb::FloatTree::LeafNodeType* leaf = nullptr;
  for_each_in(block.voxels.known(), [&](int i) {
    const PackedVoxel& voxel = block.voxels.packed(static_cast<std::size_t>(i));
    if (queries.state_of(voxel) == VoxelState::unknown) return;
    const Eigen::Vector3i index = voxel_at(block.index, i);
    const openvdb::Coord place(index.x(), index.y(), index.z());
    if (leaf == nullptr) leaf = tree.touchLeaf(place);
    leaf->setValueOn(place, voxel.state);
  });
}

openvdb::FloatGrid::Ptr grid_of(const VoxelMap& map, const QueryParams& params) {
  const double size_m = map.voxel_size_m();
  openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(kUnknown);
  grid->setName("occupancy");
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  const auto transform = openvdb::math::Transform::createLinearTransform(size_m);
  // For OpenVDB a voxel's index is its centre, for the map its lower corner.
  transform->postTranslate(openvdb::Vec3d(0.5 * size_m));
  grid->setTransform(transform);
  grid->insertMeta("floor_z_m", openvdb::DoubleMetadata(map.floor_z_m()));
  const MapQueries queries(map, params);
  map.for_each_block([&](const VoxelBlock& block) { add_block(queries, block, grid->tree()); });
  return grid;
}

}  // namespace

bool has_openvdb() { return true; }

void require_openvdb(const std::filesystem::path&) {}

void export_openvdb(const std::filesystem::path& path, const VoxelMap& map,
                    const QueryParams& params) {
  openvdb::initialize();
  const openvdb::GridPtrVec grids = {grid_of(map, params)};
  write_file_atomically(path, [&](std::ostream& out) { openvdb::io::Stream(out).write(grids); });
}

}  // namespace stereovox
