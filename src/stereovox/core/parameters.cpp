#include "stereovox/core/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "stereovox/core/error.h"
#include "stereovox/core/nearest_name.h"

namespace stereovox {
namespace {

double parse_number(const std::string& path, const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end)
    throw UsageError(fmt::format("{}: '{}' is not a number", path, text));
  return value;
}

double parse_in_range(const std::string& path, const std::string& text, Range range) {
  const double value = parse_number(path, text);
  if (!(value >= range.min && value <= range.max))  // also catches nan
    throw UsageError(fmt::format("{}: {} is outside [{}, {}]", path, text, range.min, range.max));
  return value;
}

std::vector<std::string> paths_of(std::span<const Parameter> parameters) {
  std::vector<std::string> paths;
  for (const Parameter& p : parameters) paths.push_back(p.path);
  return paths;
}

}  // namespace

void ParameterList::operator()(const std::string& name, double& value, Range range,
                               const std::string& sentence) {
  const std::string path = prefix_ + name;
  parameters_.push_back({path, fmt::format("[{}, {}]", range.min, range.max), sentence, false,
                         [&value] { return fmt::format("{}", value); },
                         [&value, path, range](const std::string& text) {
                           value = parse_in_range(path, text, range);
                         }});
}

void ParameterList::operator()(const std::string& name, int& value, Range range,
                               const std::string& sentence) {
  const std::string path = prefix_ + name;
  parameters_.push_back({path, fmt::format("whole number in [{}, {}]", range.min, range.max),
                         sentence, false, [&value] { return fmt::format("{}", value); },
                         [&value, path, range](const std::string& text) {
                           const double number = parse_in_range(path, text, range);
                           if (number != std::floor(number))
                             throw UsageError(
                                 fmt::format("{}: {} is not a whole number", path, text));
                           value = static_cast<int>(number);
                         }});
}

void ParameterList::operator()(const std::string& name, bool& value, const std::string& sentence) {
  static const std::vector<std::string> names = {"false", "true"};
  add_choice(
      name, names, sentence, false, [&value] { return value ? 1U : 0U; },
      [&value](std::size_t i) { value = i == 1; });
}

void ParameterList::add_choice(const std::string& name, std::span<const std::string> names,
                               const std::string& sentence, bool selects,
                               const std::function<std::size_t()>& get,
                               const std::function<void(std::size_t)>& set) {
  const std::string path = prefix_ + name;
  const std::string choices = fmt::format("{}", fmt::join(names, " | "));
  parameters_.push_back({path, choices, sentence, selects, [names, get] { return names[get()]; },
                         [names, set, path, choices](const std::string& text) {
                           const auto found = std::ranges::find(names, text);
                           if (found == names.end())
                             throw UsageError(fmt::format("{}: '{}' is none of {}{}", path, text,
                                                          choices, did_you_mean(text, names)));
                           set(static_cast<std::size_t>(found - names.begin()));
                         }});
}

void ParameterList::set(const std::string& path, const std::string& text) const {
  const auto found = std::ranges::find(parameters_, path, &Parameter::path);
  if (found == parameters_.end())
    throw UsageError(
        fmt::format("unknown parameter '{}'{}", path, did_you_mean(path, paths_of(parameters_))));
  found->set(text);
}

std::vector<bool> parameters_detail::which_select(const ParameterList& list,
                                                  const Settings& settings) {
  std::vector<bool> selects;
  for (const auto& [path, text] : settings)
    selects.push_back(std::ranges::any_of(list.parameters(), [&path = path](const Parameter& p) {
      return p.selects && p.path == path;
    }));
  return selects;
}

}  // namespace stereovox
