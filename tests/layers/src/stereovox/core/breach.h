// Breaks two rules on purpose; check_layers.py must find both.
#include "stereovox/io/pfm.h"
#include "error.h"
