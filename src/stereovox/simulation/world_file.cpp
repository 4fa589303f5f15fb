#include "stereovox/simulation/world_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stereovox/core/angles.h"
#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/yaml_fields.h"
#include "stereovox/simulation/thing_fields.h"

namespace stereovox {
namespace {

constexpr Range kSide_m{0.001, 500};
constexpr Range kAngle_deg{-3600, 3600};
constexpr std::uint64_t kMaxWorldBytes = 16ULL << 20;

// Reads a world's parts one after the other; knows where it is for messages.
class WorldReader {
 public:
  WorldReader(const YAML::Node& root, std::string source)
      : source_(std::move(source)), root_(root, source_, "world") {}

  World read() {
    world_.name = root_.text("name");
    read_materials();
    read_room();
    read_lights();
    for_each("walls", [this](YamlFields& wall) { add_wall(wall); });
    for_each("things", [this](YamlFields& thing) { add_thing(thing); });
    for_each("people", [this](YamlFields& person) { add_person(person); });
    read_drives();
    root_.done();
    return std::move(world_);
  }

 private:
  template <class Add>
  void for_each(const std::string& key, Add add) {
    int number = 0;
    for (const YAML::Node& node : root_.list(key)) {
      YamlFields fields(node, source_, fmt::format("{} {}", key, ++number));
      add(fields);
      fields.done();
    }
  }

  void read_materials() {
    world_.materials = common_materials();
    for_each("materials", [this](YamlFields& fields) {
      Material material;
      material.name = fields.text("name");
      try {
        apply_settings(fields.settings(), material);
      } catch (const UsageError& error) {
        fields.fail(error.what());
      }
      std::erase_if(world_.materials, [&](const Material& m) { return m.name == material.name; });
      world_.materials.push_back(material);
    });
  }

  int material(YamlFields& fields, const std::string& key, const std::string& otherwise) {
    return material_field(fields, key, otherwise, world_.materials);
  }

  // Floor, ceiling and outer walls; the walls' inner faces are the given rectangle.
  void read_room() {
    YamlFields room(root_.node("room"), source_, "room");
    const Eigen::Vector2d size = room.point2("size_m");
    if (size.minCoeff() < 1 || size.maxCoeff() > kSide_m.max)
      room.fail(fmt::format("'size_m' is [{}, {}], each must be in [1, {}]", size.x(), size.y(),
                            kSide_m.max));
    height_m_ = room.number("height_m", {1, 50}, 2.8);
    const double wall = room.number("wall_thickness_m", kSide_m, 0.2);
    world_.min_m = Eigen::Vector2d::Constant(-wall);
    world_.max_m = size + Eigen::Vector2d::Constant(wall);
    const Placement middle{size / 2, 0.0};
    const Eigen::Vector2d outer = world_.max_m - world_.min_m;
    const auto slab = [&](const char* name, double bottom, int m) {
      add(name, {box_prism(middle, {outer.x(), outer.y(), kSlab_m}, bottom, m)});
    };
    slab("floor", -kSlab_m, material(room, "floor", "carpet"));
    slab("ceiling", height_m_, material(room, "ceiling", "ceiling"));
    const int m = material(room, "wall", "plaster");
    for (const double side : {0.0, 1.0}) {
      const double x = side * (size.x() + wall) - wall / 2, y = side * (size.y() + wall) - wall / 2;
      add("outer wall", {box_prism({{x, size.y() / 2}, 0}, {wall, outer.y(), height_m_}, 0, m),
                         box_prism({{size.x() / 2, y}, 0}, {size.x(), wall, height_m_}, 0, m)});
    }
    room.done();
  }

  // Lamps in a regular pattern below the ceiling, or where a list says.
  void read_lights() {
    YamlFields lights(root_.node("lights"), source_, "lights");
    world_.ambient = lights.number("ambient", {0, 10}, world_.ambient);
    const double power = lights.number("power", {0, 100}, 1.6);
    if (lights.has("spacing_m")) {
      const Eigen::Vector2d spacing = lights.point2("spacing_m");
      const Eigen::Vector2i count =
          (world_.max_m.array() / spacing.array()).floor().cast<int>().max(1);
      for (int i = 0; i < count.x(); ++i)
        for (int j = 0; j < count.y(); ++j)
          add_lamp(
              (Eigen::Array2d(i, j) + 0.5) * world_.max_m.array() / count.array().cast<double>(),
              power);
    }
    for (const YAML::Node& node : lights.list("lamps")) {
      YamlFields lamp(node, source_, "lamp");
      add_lamp(lamp.point2("at"), lamp.number("power", {0, 100}, power));
      lamp.done();
    }
    lights.done();
  }

  void add_lamp(const Eigen::Vector2d& at, double power) {
    constexpr double kLampHeight_m = 0.06, kLampSide_m = 0.5, kBelow_m = 0.02;
    YamlFields none(YAML::Load("{}"), source_, "lamp");
    add("lamp", {box_prism({at, 0}, {kLampSide_m, kLampSide_m, kLampHeight_m},
                           height_m_ - kLampHeight_m, material(none, "material", "lamp"))});
    world_.lamps.push_back({{at.x(), at.y(), height_m_ - kLampHeight_m - kBelow_m}, power});
  }

  struct Opening {
    double from_m, to_m, height_m;
  };

  std::vector<Opening> openings(YamlFields& wall, const Eigen::Vector2d& from,
                                const Eigen::Vector2d& along, double length_m) {
    std::vector<Opening> openings;
    for (const YAML::Node& node : wall.list("doors")) {
      YamlFields door(node, source_, "door");
      const double at = door.number("at_m", {0, length_m}),
                   width = door.number("width_m", {0.1, 20});
      openings.push_back(
          {at - width / 2, at + width / 2, door.number("height_m", {0.5, 50}, 2.05)});
      if (openings.back().from_m < 0 || openings.back().to_m > length_m)
        door.fail(fmt::format("does not fit into a wall of {} m", length_m));
      world_.doorways.push_back(
          {door.text("name", fmt::format("door {}", world_.doorways.size() + 1)),
           from + along * openings.back().from_m, from + along * openings.back().to_m});
      door.done();
    }
    std::ranges::sort(openings, {}, &Opening::from_m);
    return openings;
  }

  // A straight wall; above a door it goes on.
  void add_wall(YamlFields& wall) {
    const Eigen::Vector2d from = wall.point2("from"), to = wall.point2("to");
    const double length = (to - from).norm();
    if (length < kSide_m.min) wall.fail("has no length");
    const Eigen::Vector2d along = (to - from) / length;
    const double thickness = wall.number("thickness_m", kSide_m, 0.12);
    const double height = wall.number("height_m", {0.05, 50}, height_m_);
    const int m = material(wall, "material", "plaster");
    const auto piece = [&](double a, double b, double bottom, double top) {
      if (b - a < kSide_m.min || top - bottom < kSide_m.min) return;
      add("wall", {box_prism({from + along * (a + b) / 2, std::atan2(along.y(), along.x())},
                             {b - a, thickness, top - bottom}, bottom, m)});
    };
    double done = 0.0;
    for (const Opening& opening : openings(wall, from, along, length)) {
      piece(done, opening.from_m, 0, height);
      piece(opening.from_m, opening.to_m, opening.height_m, height);
      done = opening.to_m;
    }
    piece(done, length, 0, height);
  }

  // One thing, or a row of equal ones.
  void add_thing(YamlFields& thing) {
    const std::string kind = thing.text("kind");
    Placement at{thing.point2("at"), thing.number("yaw_deg", kAngle_deg, 0) * kDegree_rad};
    const int count = thing.integer("count", {1, 1000}, 1);
    const Eigen::Vector2d step =
        thing.has("step_m") ? thing.point2("step_m") : Eigen::Vector2d(0, 0);
    for (int i = 0; i < count; ++i, at.at_m += step)
      add(thing.text("name", kind), thing_from(thing, at, i, world_.materials));
  }

  void add(const std::string& name, std::vector<Prism> solids) {
    for (Prism& solid : solids) {
      solid.name = name;
      world_.solids.push_back(std::move(solid));
    }
  }

  void add_person(YamlFields& fields) {
    Person person;
    for (const YAML::Node& point : fields.list("path"))
      person.path_m.push_back(point_of(fields, point));
    if (person.path_m.size() < 2) fields.fail("'path' needs two points or more");
    person.speed_m_s = fields.number("speed_m_s", {0.01, 10}, person.speed_m_s);
    person.height_m = fields.number("height_m", {0.3, 3}, person.height_m);
    world_.people.push_back(std::move(person));
  }

  Eigen::Vector2d point_of(const YamlFields& fields, const YAML::Node& node) {
    if (!node.IsSequence()) fields.fail("a point is [x, y] in metres");
    YAML::Node holder;
    holder["point"] = node;
    const std::vector<double> values = yaml_numbers(holder, "point", 2, source_);
    return {values[0], values[1]};
  }

  void read_drives() {
    const YAML::Node drives = root_.node("drives");
    if (!drives.IsMap() || drives.size() == 0) root_.fail("'drives' is no map of named drives");
    for (const auto& entry : drives) {
      YamlFields fields(entry.second, source_, fmt::format("drive '{}'", entry.first.Scalar()));
      world_.drives[entry.first.Scalar()] = drive(fields);
      fields.done();
    }
  }

  DrivePlan drive(YamlFields& fields) {
    DrivePlan plan;
    plan.speed_m_s = fields.number("speed_m_s", {0.01, 10}, plan.speed_m_s);
    plan.rate_hz = fields.number("rate_hz", {0.1, 1000}, plan.rate_hz);
    for (const YAML::Node& node : fields.list("waypoints")) {
      if (node.IsSequence()) {
        plan.waypoints.push_back({point_of(fields, node)});
        continue;
      }
      YamlFields waypoint(node, source_, "waypoint");
      plan.waypoints.push_back(
          {waypoint.point2("at"), waypoint.number("turn_deg", kAngle_deg, 0.0)});
      waypoint.done();
    }
    if (plan.waypoints.empty()) fields.fail("has no waypoints");
    return plan;
  }

  static constexpr double kSlab_m = 0.1;
  std::string source_;
  YamlFields root_;
  World world_;
  double height_m_ = 0.0;
};

}  // namespace

World parse_world(std::string text, const std::string& source) {
  return WorldReader(parse_yaml(std::move(text), source), source).read();
}

World read_world(const std::filesystem::path& path) {
  return parse_world(read_file(path, kMaxWorldBytes), path.string());
}

}  // namespace stereovox
