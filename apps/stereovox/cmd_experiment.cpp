// stereovox experiment EXPERIMENT.yaml -o OUT: the paper's Table 1.
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <memory>
#include <mutex>

#include "command.h"
#include "interrupt.h"
#include "stereovox/experiment/run_experiment.h"
#include "stereovox/io/file_bytes.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct ExperimentOptions {
  std::string experiment, output, cache;
  int threads = 0;
  bool quiet = false;
};

// Tells one build of this program from another.
std::string build_name() {
  constexpr std::uint64_t kMaxProgramBytes = 1ULL << 30;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? "unknown" : content_name(read_file(program, kMaxProgramBytes));
}

void print_tables(const ExperimentConfig& config, const std::vector<ResultRow>& rows) {
  for (const MethodGroup& group : config.groups)
    for (const double cell_size_m : group.cell_sizes_m)
      for (const PoseSource poses : group.pose_sources)
        std::cout << fmt::format("\n{}, cells of {:g} m, {} poses, all worlds\n{}", group.title,
                                 cell_size_m, names_of(poses)[static_cast<std::size_t>(poses)],
                                 to_markdown(rows, group, cell_size_m, poses, ""));
}

ExitCode run(const ExperimentOptions& options) {
  const ExperimentConfig config = read_experiment(options.experiment);
  const fs::path cache =
      options.cache.empty() ? fs::path(options.output) / "cache" : fs::path(options.cache);
  PipelineConfig threads;
  threads.threads = options.threads;
  catch_interrupt();
  std::mutex mutex;
  const auto start = std::chrono::steady_clock::now();
  const auto say = [&](const std::string& text) {
    const std::lock_guard lock(mutex);
    const auto seconds =
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::steady_clock::now() - start);
    if (!options.quiet)
      std::cout << fmt::format("{:6d} s  {}\n", seconds.count(), text) << std::flush;
  };
  const ExperimentResult result = run_experiment(config, options.output, cache, build_name(),
                                                 threads.thread_count(), {say, was_interrupted});
  print_tables(config, result.rows);
  std::cout << fmt::format("\n{}: {} maps scored; see report.md\n", options.output,
                           result.rows.size());
  return result.was_stopped ? ExitCode::interrupted : ExitCode::ok;
}

}  // namespace

void add_experiment(CLI::App& program, Action& action) {
  auto options = std::make_shared<ExperimentOptions>();
  CLI::App* command = program.add_subcommand(
      "experiment", "map simulated drives by every method and score the maps");
  command->add_option("EXPERIMENT", options->experiment, "YAML file; see docs/experiment.md")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "folder for the results; an unfinished experiment there goes on")
      ->required();
  command->add_option("--cache", options->cache, "folder for rendered drives, default OUT/cache")
      ->type_name("FOLDER");
  command->add_option("--threads", options->threads, "0 = one for each core")->type_name("N");
  command->add_flag("-q,--quiet", options->quiet, "print results, warnings and errors only");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace stereovox
