// The older paradigms that the paper compares with (its Table 1): pseudo-scans in, 2D map out.
//
// To add one, write <name>.{h,cpp} with a params struct and an overload of `build_map`, and name
// the struct in Paradigm. Every build_map is a pure function of its arguments.
#pragma once

#include <variant>

#include "stereovox/baselines/konolige_1997.h"
#include "stereovox/baselines/matthies_elfes_1988.h"
#include "stereovox/baselines/moravec_elfes_1985.h"
#include "stereovox/baselines/thrun_1993.h"
#include "stereovox/baselines/thrun_2001.h"

namespace stereovox {

using Paradigm = std::variant<MoravecElfes1985Params, MatthiesElfes1988Params, Thrun1993Params,
                              Konolige1997Params, Thrun2001Params>;

// A cell is occupied when its state is above one half, free when it is below, and unknown when no
// beam said anything about it or it is exactly one half.
inline OccupancyGrid2D build_map(std::span<const PseudoScan> scans, const GridGeometry& geometry,
                                 const Paradigm& paradigm) {
  return std::visit([&](const auto& params) { return build_map(scans, geometry, params); },
                    paradigm);
}

}  // namespace stereovox
