#include "stereovox/io/yaml_fields.h"

#include <fmt/format.h>

#include <algorithm>

#include "stereovox/core/error.h"
#include "stereovox/core/nearest_name.h"

namespace stereovox {

YamlFields::YamlFields(const YAML::Node& node, std::string source, std::string what)
    : map_(node), source_(std::move(source)), what_(std::move(what)) {
  if (!map_.IsMap()) fail("is not a map of fields");
}

bool YamlFields::has(const std::string& key) {
  known_.push_back(key);
  return map_[key].IsDefined();
}

YAML::Node YamlFields::node(const std::string& key) {
  if (!has(key)) fail(fmt::format("'{}' is missing", key));
  return map_[key];
}

double YamlFields::number(const std::string& key, Range range) {
  node(key);
  const double value = yaml_number(map_, key, source_);
  if (value < range.min || value > range.max)
    fail(fmt::format("'{}' is {}, outside [{}, {}]", key, value, range.min, range.max));
  return value;
}

double YamlFields::number(const std::string& key, Range range, double otherwise) {
  return has(key) ? number(key, range) : otherwise;
}

int YamlFields::integer(const std::string& key, Range range, int otherwise) {
  if (!has(key)) return otherwise;
  number(key, range);
  return yaml_integer(map_, key, source_);
}

std::string YamlFields::text(const std::string& key) {
  node(key);
  return yaml_text(map_, key, source_);
}

std::string YamlFields::text(const std::string& key, const std::string& otherwise) {
  return has(key) ? text(key) : otherwise;
}

Eigen::Vector2d YamlFields::point2(const std::string& key) {
  node(key);
  const std::vector<double> values = yaml_numbers(map_, key, 2, source_);
  return {values[0], values[1]};
}

Eigen::Vector3d YamlFields::point3(const std::string& key) {
  node(key);
  const std::vector<double> values = yaml_numbers(map_, key, 3, source_);
  return {values[0], values[1], values[2]};
}

std::vector<YAML::Node> YamlFields::list(const std::string& key) {
  if (!has(key)) return {};
  if (!map_[key].IsSequence()) fail(fmt::format("'{}' is not a list", key));
  return {map_[key].begin(), map_[key].end()};
}

Settings YamlFields::settings() {
  Settings settings;
  for (const auto& entry : map_)
    if (entry.second.IsScalar() && std::ranges::find(known_, entry.first.Scalar()) == known_.end())
      settings.emplace_back(entry.first.Scalar(), entry.second.Scalar());
  for (const auto& [key, value] : settings) known_.push_back(key);
  return settings;
}

void YamlFields::done() const {
  for (const auto& entry : map_) {
    const std::string& key = entry.first.Scalar();
    if (std::ranges::find(known_, key) == known_.end())
      fail(fmt::format("unknown field '{}'{}", key, did_you_mean(key, known_)));
  }
}

void YamlFields::fail(const std::string& fact) const {
  const YAML::Mark mark = map_.Mark();
  const std::string line = mark.is_null() ? "" : fmt::format(":{}", mark.line + 1);
  throw Error(fmt::format("{}{}: {}: {}", source_, line, what_, fact));
}

}  // namespace stereovox
