#include "stereovox/experiment/experiment_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "stereovox/core/error.h"
#include "stereovox/core/nearest_name.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/yaml_fields.h"
#include "stereovox/simulation/world_file.h"

namespace stereovox {
namespace {

constexpr std::uint64_t kMaxBytes = 1ULL << 20;

// The settings below a node, applied to a struct with `describe`; mistakes name the place.
template <class Params>
void apply_node(YamlFields& fields, const std::string& key, Params& params) {
  if (!fields.has(key)) return;
  try {
    apply_settings(settings_of(fields.node(key), key), params);
  } catch (const UsageError& error) {
    fields.fail(error.what());
  }
}

template <class Params>
std::string text_of(Params params) {
  std::string text;
  const ParameterList list = parameters_of(params);
  for (const Parameter& p : list.parameters()) text += fmt::format("{}={}\n", p.path, p.get());
  return text;
}

template <class... Methods>
MappingMethod method_named(const std::string& kind, YamlFields& fields,
                           std::variant<Methods...>* /*all*/) {
  static const std::vector<std::string> kinds = {Methods::kName...};
  MappingMethod method;
  if (!((kind == Methods::kName ? (method = Methods{}, true) : false) || ...))
    fields.fail(fmt::format("there is no kind '{}'{}", kind, did_you_mean(kind, kinds)));
  return method;
}

NamedMethod read_method(YamlFields& fields) {
  NamedMethod named;
  named.name = fields.text("name");
  named.method = method_named(fields.text("kind"), fields, static_cast<MappingMethod*>(nullptr));
  std::visit(
      [&](auto& params) {
        apply_node(fields, "settings", params);
        named.settings = fmt::format("kind={}\n{}", params.kName, text_of(params));
      },
      named.method);
  return named;
}

std::vector<double> numbers(YamlFields& fields, const std::string& key, Range range) {
  std::vector<double> values;
  for (const YAML::Node& node : fields.list(key)) {
    YAML::Node holder;
    holder[key] = node;
    values.push_back(YamlFields(holder, "", key).number(key, range));
  }
  if (values.empty()) fields.fail(fmt::format("'{}' is empty", key));
  return values;
}

PoseSource pose_source(YamlFields& fields, const std::string& name) {
  const auto names = names_of(PoseSource{});
  const auto found = std::ranges::find(names, name);
  if (found == names.end())
    fields.fail(fmt::format("'poses' are truth or estimated, not '{}'", name));
  return static_cast<PoseSource>(found - names.begin());
}

MethodGroup read_group(YamlFields& fields, const std::string& source) {
  MethodGroup group;
  group.title = fields.text("title");
  group.cell_sizes_m = numbers(fields, "cell_sizes_m", {0.01, 5});
  for (const double seed : numbers(fields, "seeds", {0, 1e9}))
    group.seeds.push_back(static_cast<int>(seed));
  for (const YAML::Node& node : fields.list("poses"))
    group.pose_sources.push_back(pose_source(fields, node.Scalar()));
  std::set<std::string> names;
  for (const YAML::Node& node : fields.list("methods")) {
    YamlFields method(node, source, "method");
    group.methods.push_back(read_method(method));
    if (!names.insert(group.methods.back().name).second)
      method.fail(fmt::format("two methods are named '{}'", group.methods.back().name));
    method.done();
  }
  if (group.methods.empty() || group.pose_sources.empty())
    fields.fail("'methods' or 'poses' is empty");
  return group;
}

ExperimentWorld read_world_entry(YamlFields& fields, const std::filesystem::path& folder) {
  ExperimentWorld world;
  world.path = folder / fields.text("file");
  world.drive = fields.text("drive", "main");
  world.name = fields.text("name", world.path.stem().string());
  drive_of(read_world(world.path), world.drive, world.path.string());  // exists
  return world;
}

void check_names(const ExperimentConfig& config, const YamlFields& root) {
  std::set<std::string> worlds, titles;
  for (const ExperimentWorld& world : config.worlds)
    if (!worlds.insert(world.name).second)
      root.fail(fmt::format("two worlds are named '{}'", world.name));
  for (const MethodGroup& group : config.groups)
    if (!titles.insert(group.title).second)
      root.fail(fmt::format("two groups are titled '{}'", group.title));
  if (worlds.empty() || titles.empty()) root.fail("'worlds' or 'groups' is empty");
}

}  // namespace

std::span<const std::string> names_of(PoseSource) {
  static const std::vector<std::string> names = {"truth", "estimated"};
  return names;
}

std::vector<int> ExperimentConfig::seeds() const {
  std::set<int> all;
  for (const MethodGroup& group : groups) all.insert(group.seeds.begin(), group.seeds.end());
  return {all.begin(), all.end()};
}

ExperimentConfig read_experiment(const std::filesystem::path& path) {
  const std::string source = path.string();
  ExperimentConfig config;
  config.source_text = read_file(path, kMaxBytes);
  YamlFields root(parse_yaml(config.source_text, source), source, "experiment");
  config.name = root.text("name");
  config.development_world = root.text("development_world", "");
  config.visible_range_m = root.number("visible_range_m", {0.1, 1000}, config.visible_range_m);
  apply_node(root, "simulation", config.simulation);
  apply_node(root, "pipeline", config.pipeline);
  apply_node(root, "scan", config.scan);
  apply_node(root, "score", config.score);
  for (const YAML::Node& node : root.list("worlds")) {
    YamlFields fields(node, source, "world");
    config.worlds.push_back(read_world_entry(fields, path.parent_path()));
    fields.done();
  }
  for (const YAML::Node& node : root.list("groups")) {
    YamlFields fields(node, source, "group");
    config.groups.push_back(read_group(fields, source));
    fields.done();
  }
  check_names(config, root);
  root.done();
  return config;
}

}  // namespace stereovox
