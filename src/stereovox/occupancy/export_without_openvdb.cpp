// Takes the place of export_openvdb.cpp in builds without OpenVDB.
#include "stereovox/core/error.h"
#include "stereovox/occupancy/export_openvdb.h"

namespace stereovox {

bool has_openvdb() { return false; }

void require_openvdb(const std::filesystem::path& path) {
  throw UsageError(path.string() +
                   ": this build has no OpenVDB (Debian: libopenvdb-dev, libboost-dev)");
}

void export_openvdb(const std::filesystem::path& path, const VoxelMap&, const QueryParams&) {
  require_openvdb(path);
}

}  // namespace stereovox
