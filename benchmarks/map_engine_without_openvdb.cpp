#include <stdexcept>

#include "map_engine_openvdb.h"

namespace stereovox::bench {

bool has_openvdb_peer() { return false; }

Result run_openvdb(const Case&, const std::vector<Frame>&, const Truth&) {
  throw std::logic_error("run_openvdb: this build has no OpenVDB");
}

}  // namespace stereovox::bench
