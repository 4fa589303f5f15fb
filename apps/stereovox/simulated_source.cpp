#include "simulated_source.h"

#include <vector>

#include "stereovox/core/error.h"
#include "stereovox/io/text_file.h"
#include "stereovox/simulation/world_file.h"

namespace stereovox {
namespace {

constexpr std::string_view kPrefix = "sim:";

struct SimulatedSource {
  std::string world, drive;
  SimulationParams params;
};

SimulatedSource parse(std::string text) {
  text.erase(0, kPrefix.size());
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  parts.resize(3);
  SimulatedSource source{parts[0], parts[1], {}};
  if (!parts[2].empty()) apply_settings({{"seed", parts[2]}}, source.params);
  return source;
}

}  // namespace

bool is_simulated_source(const std::string& source) { return source.starts_with(kPrefix); }

std::string default_drive(const World& world) {
  return world.drives.size() == 1 ? world.drives.begin()->first : "main";
}

std::unique_ptr<StereoSequence> open_simulated_source(const std::string& text,
                                                      const SequenceParams& params, int threads) {
  const SimulatedSource source = parse(text);
  World world = read_world(source.world);
  const std::string drive = source.drive.empty() ? default_drive(world) : source.drive;
  const auto simulation = std::make_shared<const Simulation>(std::move(world), drive, source.params,
                                                             source.world, threads);
  return simulated_sequence(simulation, params, source.world);
}

}  // namespace stereovox
