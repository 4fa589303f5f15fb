// Ctrl-C: the first one asks for a stop after saving, the second one ends the program at once.
#pragma once

namespace stereovox {

// A reader of the output that goes away, or a limit on the size of files, is no reason to lose the
// work: writing then fails instead of ending the program.
void report_failed_writes();

void catch_interrupt();  // from now on
bool was_interrupted();

}  // namespace stereovox
