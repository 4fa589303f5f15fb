#include "stereovox/core/parallel.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace stereovox {
namespace {

#ifdef __SANITIZE_THREAD__
constexpr bool kIsThreadSanitized = true;
#else
constexpr bool kIsThreadSanitized = false;
#endif

// The thread sanitizer cannot see how oneTBB waits and takes all for races; plain threads it knows.
void for_each_on_plain_threads(int begin, int end, int threads,
                               const std::function<void(int)>& body) {
  std::atomic<int> next = begin;
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto work = [&] {
    try {
      for (int i = next++; i < end; i = next++) body(i);
    } catch (...) {
      const std::lock_guard lock(error_mutex);
      error = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> workers;
    workers.reserve(threads);
    for (int i = 0; i < threads; ++i) workers.emplace_back(work);
  }
  if (error) std::rethrow_exception(error);
}

// Each thread that starts loops keeps its arenas: the workers would first have to leave the last
// one for a new one, which takes them longer than many a loop.
tbb::task_arena& arena_of(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  return arenas.try_emplace(threads, threads).first->second;
}

}  // namespace

void parallel_for(int begin, int end, int threads, const std::function<void(int)>& body) {
  if (threads <= 1 || end - begin <= 1) {
    for (int i = begin; i < end; ++i) body(i);
    return;
  }
  if (kIsThreadSanitized) return for_each_on_plain_threads(begin, end, threads, body);
  // More than there are cores would make oneTBB print a warning.
  tbb::task_arena& arena = arena_of(std::min(threads, tbb::info::default_concurrency()));
  arena.execute([&] { tbb::parallel_for(begin, end, body); });
}

}  // namespace stereovox
