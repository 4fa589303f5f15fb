// The fields of one YAML map: each is asked for by name, and whatever was not asked for is an
// error, so that a typing mistake cannot be ignored.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "stereovox/core/parameters.h"
#include "stereovox/io/yaml_file.h"

namespace stereovox {

class YamlFields {
 public:
  // `what` is the thing in messages: "wall 3". Throws Error when the node is no map.
  YamlFields(const YAML::Node& node, std::string source, std::string what);

  bool has(const std::string& key);
  YAML::Node node(const std::string& key);  // throws Error when it is missing
  double number(const std::string& key, Range range);
  double number(const std::string& key, Range range, double otherwise);
  int integer(const std::string& key, Range range, int otherwise);
  std::string text(const std::string& key);
  std::string text(const std::string& key, const std::string& otherwise);
  Eigen::Vector2d point2(const std::string& key);
  Eigen::Vector3d point3(const std::string& key);
  // The nodes of a list; none when it is missing.
  std::vector<YAML::Node> list(const std::string& key);
  // All scalar fields, for a struct with `describe`.
  Settings settings();

  // Throws Error naming the first field that nobody asked for.
  void done() const;

  [[noreturn]] void fail(const std::string& fact) const;  // "<source>:<line>: <what>: <fact>"

 private:
  YAML::Node map_;
  std::string source_, what_;
  std::vector<std::string> known_;
};

}  // namespace stereovox
