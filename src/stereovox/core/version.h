#pragma once

#include <string_view>

namespace stereovox {

std::string_view version();  // "major.minor.patch"

}  // namespace stereovox
