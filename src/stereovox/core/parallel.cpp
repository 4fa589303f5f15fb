#include "stereovox/core/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace stereovox {

void parallel_for(int begin, int end, int threads, const std::function<void(int)>& body) {
  if (threads <= 1 || end - begin <= 1) {
    for (int i = begin; i < end; ++i) body(i);
    return;
  }
  // More than there are cores would make oneTBB print a warning.
  tbb::task_arena arena(std::min(threads, tbb::info::default_concurrency()));
  arena.execute([&] { tbb::parallel_for(begin, end, body); });
}

}  // namespace stereovox
