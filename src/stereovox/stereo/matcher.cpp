#include "stereovox/stereo/matcher.h"

namespace stereovox {

DisparityImage match(const RectifiedPair& pair, const MatcherParams& params, int threads) {
  return std::visit([&](const auto& matcher) { return match(pair, matcher, threads); }, params);
}

}  // namespace stereovox
