// The kinds of `stereovox score` that compare maps.
#pragma once

#include "command.h"

namespace stereovox {

void add_score_map(CLI::App& score_command, Action& action);
void add_score_voxels(CLI::App& score_command, Action& action);

}  // namespace stereovox
