#include "stereovox/stereo/matcher.h"

namespace stereovox {

DisparityImage match(const RectifiedPair& pair, const MatcherParams& params) {
  return std::visit([&](const auto& matcher) { return match(pair, matcher); }, params);
}

}  // namespace stereovox
