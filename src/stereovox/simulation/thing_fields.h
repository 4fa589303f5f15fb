// Things of a world file as prisms. To add a kind, write a row of the table in thing_fields.cpp.
#pragma once

#include <vector>

#include "stereovox/io/yaml_fields.h"
#include "stereovox/simulation/material.h"
#include "stereovox/simulation/prism.h"

namespace stereovox {

// Position of the material that field `key` names, or of `otherwise`. Throws Error when there is
// none of that name.
int material_field(YamlFields& fields, const std::string& key, const std::string& otherwise,
                   const std::vector<Material>& materials);

// The solids of the thing that the fields describe, placed; `number` counts the things of a row, so
// that chance fills each differently. Throws Error for unknown kinds and impossible values.
std::vector<Prism> thing_from(YamlFields& thing, const Placement& at, int number,
                              const std::vector<Material>& materials);

}  // namespace stereovox
