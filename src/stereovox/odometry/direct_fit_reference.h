// DirectFitter in its plain form, to test it by.
#pragma once

#include "stereovox/odometry/direct_fit.h"

namespace stereovox {

DirectFit direct_fit_reference(const DirectPair& pair, const SE3& T_reference_camera);

}  // namespace stereovox
