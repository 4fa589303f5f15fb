#include "stereovox/core/error.h"

namespace stereovox {

Error::~Error() = default;
UsageError::~UsageError() = default;
ResourceError::~ResourceError() = default;

}  // namespace stereovox
