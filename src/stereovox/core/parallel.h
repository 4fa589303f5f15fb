// Loops over independent items on a given number of threads. Each item must write only what it
// alone owns; then the result does not depend on the number of threads.
#pragma once

#include <functional>

namespace stereovox {

// Calls body(i) for each i in [begin, end), on at most `threads` threads (1 = in the caller's).
void parallel_for(int begin, int end, int threads, const std::function<void(int)>& body);

}  // namespace stereovox
