#include "stereovox/core/version.h"

namespace stereovox {

std::string_view version() { return STEREOVOX_VERSION; }

}  // namespace stereovox
