// YAML from outside, read so that no file can harm: at most 16 MiB, 32 levels deep, 32 aliases, no
// key twice in a map.
// Accessors name the file, the line and the key: "calib.yaml: 'fx' is missing",
// "calib.yaml:3: 'fx' is 'abc', not a finite number".
#pragma once

#include <yaml-cpp/yaml.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace stereovox {

// Throws Error for an unreadable file, wrong syntax and whatever exceeds the limits. OpenCV's first
// line "%YAML:1.0" is accepted. An empty file gives a null node.
YAML::Node load_yaml(const std::filesystem::path& path);

// The same from text; `source` is named in errors.
YAML::Node parse_yaml(std::string text, const std::string& source);

// Values of a key of `map`; a missing key or a value of another kind throws Error.
YAML::Node yaml_value(const YAML::Node& map, const std::string& key, const std::string& source);
double yaml_number(const YAML::Node& map, const std::string& key, const std::string& source);
int yaml_integer(const YAML::Node& map, const std::string& key, const std::string& source);
std::string yaml_text(const YAML::Node& map, const std::string& key, const std::string& source);

// A sequence of finite numbers; sequences inside are joined, so a 4x4 matrix may be nested or flat.
std::vector<double> yaml_numbers(const YAML::Node& map, const std::string& key,
                                 const std::string& source);
std::vector<double> yaml_numbers(const YAML::Node& map, const std::string& key, std::size_t count,
                                 const std::string& source);

}  // namespace stereovox
