#include "stereovox/experiment/run_experiment.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "stereovox/core/parallel.h"
#include "stereovox/experiment/map_drive.h"
#include "stereovox/experiment/write_report.h"
#include "stereovox/simulation/world_file.h"

namespace stereovox {
namespace {

namespace fs = std::filesystem;

struct Drive {
  ExperimentWorld world;
  int seed = 0;
};

std::vector<Drive> drives_of(const ExperimentConfig& config) {
  std::vector<Drive> drives;
  for (const int seed : config.seeds())
    for (const ExperimentWorld& world : config.worlds) drives.push_back({world, seed});
  return drives;
}

RecordingRequest request_of(const ExperimentConfig& config, const Drive& drive,
                            const std::string& build = {}) {
  RecordingRequest request{.name = fmt::format("{}_s{}", drive.world.name, drive.seed),
                           .world = drive.world.path,
                           .drive = drive.world.drive,
                           .simulation = config.simulation,
                           .pipeline = config.pipeline,
                           .build = build};
  request.simulation.seed = drive.seed;
  return request;
}

// Worlds that cannot be read and drives that hit something are refused before hours of work.
void check_drives(const ExperimentConfig& config, std::span<const Drive> drives) {
  for (const Drive& drive : drives) {
    const RecordingRequest request = request_of(config, drive);
    Simulation(read_world(request.world), request.drive, request.simulation, request.world.string(),
               1);
  }
}

// The rows of one drive: those of an earlier run, or new ones.
std::optional<std::vector<ResultRow>> rows_of(const ExperimentConfig& config, const Drive& drive,
                                              const fs::path& output, const fs::path& cache,
                                              const std::string& build,
                                              const RecordingProgress& progress) {
  const std::optional<RecordedDrive> recorded =
      record_drive(cache, request_of(config, drive, build), 1, progress);
  if (!recorded) return std::nullopt;
  const std::string key = content_name(build + config.source_text + recorded->key);
  const fs::path file = output / "runs" / fmt::format("{}_s{}.json", drive.world.name, drive.seed);
  if (std::optional<std::vector<ResultRow>> rows = read_rows(file, key)) {
    progress.say("found the results of an earlier run");
    return rows;
  }
  const auto rows =
      map_drive(config, *recorded, {drive.world.name, drive.seed}, output / "maps", progress);
  if (rows) write_rows(file, key, *rows);
  return rows;
}

}  // namespace

ExperimentResult run_experiment(const ExperimentConfig& config, const fs::path& output,
                                const fs::path& cache, const std::string& build, int threads,
                                const ExperimentProgress& progress) {
  for (const char* name : {"runs", "maps", "figures"}) fs::create_directories(output / name);
  const std::vector<Drive> drives = drives_of(config);
  check_drives(config, drives);
  std::vector<std::optional<std::vector<ResultRow>>> rows(drives.size());
  std::atomic<std::size_t> next{0};
  // Drives take very different times, so each thread takes the next one when it is free.
  parallel_for(0, threads, threads, [&](int) {
    for (std::size_t i = next++; i < drives.size(); i = next++) {
      const auto say = [&](const std::string& text) {
        progress.say(fmt::format("[{}/{}] {}, seed {}: {}", i + 1, drives.size(),
                                 drives[i].world.name, drives[i].seed, text));
      };
      rows[i] = rows_of(config, drives[i], output, cache, build, {say, progress.should_stop});
    }
  });
  ExperimentResult result;
  for (auto& part : rows) {
    result.was_stopped |= !part;
    if (part) result.rows.insert(result.rows.end(), part->begin(), part->end());
  }
  write_report(config, result.rows, output);
  return result;
}

}  // namespace stereovox
