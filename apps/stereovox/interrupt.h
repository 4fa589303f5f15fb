// Ctrl-C: the first one asks for a stop after saving, the second one ends the program at once.
#pragma once

namespace stereovox {

void catch_interrupt();  // from now on
bool was_interrupted();

}  // namespace stereovox
