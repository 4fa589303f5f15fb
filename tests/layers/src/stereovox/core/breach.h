// Breaks two rules on purpose; check_layers.py must find both.
#include "error.h"
#include "stereovox/io/pfm.h"
