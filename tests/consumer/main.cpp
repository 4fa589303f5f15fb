// What a program of one's own looks like: a data set in, a map out.
#include <cstdio>

#include "stereovox/dataset/open_sequence.h"
#include "stereovox/pipeline/build_maps.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  stereovox::PipelineConfig config;
  stereovox::apply_settings({{"dataset.max_frames", "6"}, {"occupancy.voxel_size_m", "0.1"}},
                            config);
  const auto sequence = stereovox::open_sequence(argv[1], config.dataset, std::nullopt);
  const stereovox::BuildResult result =
      stereovox::build_maps(*sequence, config, std::nullopt, stereovox::ProgressSink{});
  std::printf("%d frames, %zu voxels\n", result.frames,
              result.segments.front().map.known_voxel_count());
  return result.tracked == 6 ? 0 : 1;
}
