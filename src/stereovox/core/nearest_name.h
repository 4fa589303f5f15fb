// "did you mean": the known word nearest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace stereovox {

// The candidate with the smallest edit distance, or "" when none is near enough to be meant.
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

// ", did you mean 'name'?" or "".
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

}  // namespace stereovox
