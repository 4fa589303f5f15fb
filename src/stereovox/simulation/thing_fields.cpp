#include "stereovox/simulation/thing_fields.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/core/nearest_name.h"
#include "stereovox/simulation/furniture.h"

namespace stereovox {
namespace {

constexpr Range kLength_m{0.001, 500};
constexpr Range kBottom_m{0, 50};
constexpr Range kShare{0, 1};
constexpr Range kSeed{0, 1e9};

// What a row of the table is given.
struct Thing {
  YamlFields& fields;
  const Placement& at;
  int number;
  const std::vector<Material>& materials;

  Eigen::Vector3d size_m() const {
    const Eigen::Vector3d size = fields.point3("size_m");
    if (size.minCoeff() < kLength_m.min || size.maxCoeff() > kLength_m.max)
      fields.fail(fmt::format("'size_m' is [{}, {}, {}], each must be in [{}, {}]", size.x(),
                              size.y(), size.z(), kLength_m.min, kLength_m.max));
    return size;
  }
  int material(const char* key, const char* otherwise) const {
    return material_field(fields, key, otherwise, materials);
  }
  double bottom_m() const { return fields.number("bottom_m", kBottom_m, 0.0); }
  double filled(double otherwise) const { return fields.number("filled", kShare, otherwise); }
  std::uint32_t seed() const {
    return static_cast<std::uint32_t>(fields.integer("seed", kSeed, 1) + number);
  }
};

struct Kind {
  const char* name;
  std::vector<Prism> (*solids)(const Thing& thing);
};

constexpr Kind kKinds[] = {
    {"box",
     [](const Thing& t) -> std::vector<Prism> {
       return {box_prism(t.at, t.size_m(), t.bottom_m(), t.material("material", "wood"))};
     }},
    {"ramp",
     [](const Thing& t) -> std::vector<Prism> {
       return {ramp_prism(t.at, t.size_m(), t.bottom_m(), t.material("material", "wood"))};
     }},
    {"cylinder",
     [](const Thing& t) -> std::vector<Prism> {
       return {post_prism(t.at.at_m, t.fields.number("radius_m", kLength_m),
                          t.fields.number("height_m", kLength_m), t.bottom_m(),
                          t.material("material", "plaster"))};
     }},
    {"table",
     [](const Thing& t) {
       return table(t.at, t.size_m(), t.fields.number("leg_m", kLength_m, 0.05),
                    t.material("material", "wood"));
     }},
    {"chair", [](const Thing& t) { return chair(t.at, t.material("material", "fabric")); }},
    {"bookcase",
     [](const Thing& t) {
       return bookcase(t.at, t.size_m(), t.fields.integer("boards", {1, 50}, 5), t.filled(0.8),
                       t.seed(), t.material("material", "wood"), t.material("content", "books"));
     }},
    {"rack",
     [](const Thing& t) {
       return rack(t.at, t.size_m(), t.fields.integer("levels", {1, 50}, 3),
                   t.fields.integer("bays", {1, 100}, 2), t.filled(0.5), t.seed(),
                   t.material("material", "metal"), t.material("content", "cardboard"));
     }},
    {"monitor",
     [](const Thing& t) {
       return monitor(t.at, t.bottom_m(), t.material("material", "plastic"),
                      t.material("screen", "screen"));
     }},
};

}  // namespace

int material_field(YamlFields& fields, const std::string& key, const std::string& otherwise,
                   const std::vector<Material>& materials) {
  const std::string name = fields.text(key, otherwise);
  std::vector<std::string> names;
  for (const Material& m : materials) names.push_back(m.name);
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    fields.fail(fmt::format("there is no material '{}'{}", name, did_you_mean(name, names)));
  return static_cast<int>(found - names.begin());
}

std::vector<Prism> thing_from(YamlFields& thing, const Placement& at, int number,
                              const std::vector<Material>& materials) {
  const std::string name = thing.text("kind");
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    if (name == kind.name) return kind.solids({thing, at, number, materials});
    names.emplace_back(kind.name);
  }
  thing.fail(fmt::format("there is no kind '{}'{}", name, did_you_mean(name, names)));
}

}  // namespace stereovox
