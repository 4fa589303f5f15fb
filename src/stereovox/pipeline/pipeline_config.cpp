#include "stereovox/pipeline/pipeline_config.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <thread>

#include "stereovox/core/error.h"
#include "stereovox/io/yaml_file.h"

namespace stereovox {
namespace {

void collect(const YAML::Node& node, const std::string& path, const std::string& file,
             Settings& settings) {
  if (node.IsScalar()) {
    settings.emplace_back(path, node.Scalar());
  } else if (node.IsMap()) {
    for (const auto& entry : node) {
      const auto name = entry.first.as<std::string>();
      collect(entry.second, path.empty() ? name : fmt::format("{}.{}", path, name), file, settings);
    }
  } else {
    throw Error(fmt::format("{}: '{}' is neither a value nor a section", file, path));
  }
}

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> words;
  std::size_t begin = 0;
  for (std::size_t dot = path.find('.'); dot != std::string::npos; dot = path.find('.', begin)) {
    words.push_back(path.substr(begin, dot - begin));
    begin = dot + 1;
  }
  words.push_back(path.substr(begin));
  return words;
}

// The opening lines of the sections that `words` is in and `previous` was not.
std::string section_lines(const std::vector<std::string>& words,
                          const std::vector<std::string>& previous) {
  const auto [differs, ignored] =
      std::mismatch(words.begin(), words.end() - 1, previous.begin(), previous.end());
  std::string lines;
  for (auto word = differs; word != words.end() - 1; ++word)
    lines += fmt::format("{:{}}{}:\n", "", 2 * (word - words.begin()), *word);
  return lines;
}

std::string table_row(const Parameter& p) {
  std::string range = p.range;
  for (std::size_t bar = range.find('|'); bar != std::string::npos; bar = range.find('|', bar + 2))
    range.insert(bar, "\\");
  return fmt::format("| `{}` | {} | {} | {} |\n", p.path, p.get(), range, p.sentence);
}

std::vector<std::string> split_choices(const std::string& range) {
  std::vector<std::string> names;
  std::istringstream words(range);
  for (std::string word; words >> word;)
    if (word != "|") names.push_back(word);
  return names;
}

// The configurations that between them show every parameter: each alternative of each choice once.
std::vector<PipelineConfig> every_alternative() {
  std::vector<PipelineConfig> configs(1);
  const ParameterList list = parameters_of(configs.front());
  for (const Parameter& p : list.parameters()) {
    if (!p.path.ends_with(".type")) continue;
    for (const std::string& name : split_choices(p.range)) {
      PipelineConfig config;
      apply_settings({{p.path, name}}, config);
      configs.push_back(config);
    }
  }
  return configs;
}

}  // namespace

PipelineConfig::PipelineConfig() { apply_settings(preset_settings("tuned"), *this); }

Settings preset_settings(const std::string& name) {
  return {{"occupancy.preset", name}, {"navmap.preset", name}};
}

int PipelineConfig::thread_count() const {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Settings read_settings(const std::filesystem::path& path) {
  return settings_of(load_yaml(path), path.string());
}

Settings settings_of(const std::string& yaml, const std::string& source) {
  return settings_of(parse_yaml(yaml, source), source);
}

Settings settings_of(const YAML::Node& node, const std::string& source) {
  Settings settings;
  if (node.IsNull()) return settings;
  if (!node.IsMap()) throw Error(source + ": is not a map of parameters");
  collect(node, "", source, settings);
  return settings;
}

Settings parse_settings(const std::vector<std::string>& assignments) {
  Settings settings;
  for (const std::string& assignment : assignments) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
      throw UsageError("--set takes section.field=value, not '" + assignment + "'");
    settings.emplace_back(assignment.substr(0, equals), assignment.substr(equals + 1));
  }
  return settings;
}

std::string to_yaml(PipelineConfig config) {
  std::string yaml = "# every parameter of this run; see docs/parameters.md\n";
  std::vector<std::string> previous = {""};
  const ParameterList list = parameters_of(config);
  for (const Parameter& p : list.parameters()) {
    const std::vector<std::string> words = split(p.path);
    previous.pop_back();
    yaml += section_lines(words, previous);
    yaml += fmt::format("{:{}}{}: {}  # {}; {}\n", "", 2 * (words.size() - 1), words.back(),
                        p.get(), p.range, p.sentence);
    previous = words;
  }
  return yaml;
}

std::string parameters_page() {
  std::string page =
      "# Parameters\n\n"
      "Set them in a YAML file (`--config run.yaml`) or one by one (`--set section.field=value`).\n"
      "A parameter that ends in `.type` chooses an alternative, whose own parameters then "
      "exist.\n\n"
      "| parameter | default | range | what it does |\n|---|---|---|---|\n";
  std::set<std::string> listed;
  for (PipelineConfig& config : every_alternative()) {
    const ParameterList list = parameters_of(config);
    for (const Parameter& p : list.parameters())
      if (listed.insert(p.path).second) page += table_row(p);
  }
  return page;
}

}  // namespace stereovox
