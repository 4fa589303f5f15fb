#include "stereovox/navmap/map_server.h"

#include <vector>

namespace stereovox {

std::span<const std::string> names_of(MapServerMode) {
  static const std::vector<std::string> names = {"trinary", "scale", "raw"};
  return names;
}

}  // namespace stereovox
