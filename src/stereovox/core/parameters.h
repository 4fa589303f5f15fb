// One list of parameters per stage. A params struct is plain fields with defaults; its `describe`
// names each field once, with its range and a sentence:
//
//   struct SpeckleParams {
//     int max_size_px = 100;
//     void describe(ParameterList& list) {
//       list("max_size_px", max_size_px, {0, 10000}, "smaller islands of disparity are removed");
//     }
//   };
//
// From that list come YAML in and out, --set section.field=value, help, range checks, the generated
// docs/parameters.md and the configuration echoed beside every result. Unknown names and values out
// of range throw UsageError.
//
// An enum is a parameter when a function `std::span<const std::string> names_of(E)` found by
// argument-dependent lookup gives the names of its values 0, 1, 2, ...
// A std::variant of params structs is a choice: parameter `<name>.type` selects the alternative by
// its `static constexpr const char* kName`, and the fields of that alternative follow.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stereovox {

struct Range {
  double min, max;  // both allowed
};

struct Parameter {
  std::string path;      // "occupancy.voxel_size_m"
  std::string range;     // for people: "[0.01, 1]" or "a | b"
  std::string sentence;  // what it does
  bool selects = false;  // changes which parameters exist or what their defaults are: set first
  std::function<std::string()> get;
  std::function<void(const std::string&)> set;  // throws UsageError "path: ..."
};

class ParameterList {
 public:
  void operator()(const std::string& name, double& value, Range range, const std::string& sentence);
  void operator()(const std::string& name, int& value, Range range, const std::string& sentence);
  void operator()(const std::string& name, bool& value, const std::string& sentence);

  template <class Enum>
  requires std::is_enum_v<Enum>
  void operator()(const std::string& name, Enum& value, const std::string& sentence) {
    add_choice(
        name, names_of(Enum{}), sentence, false,
        [&value] { return static_cast<std::size_t>(value); },
        [&value](std::size_t i) { value = static_cast<Enum>(i); });
  }

  // Like an enum, but choosing a value calls `apply`, which may change other fields.
  template <class Enum, class Apply>
  void preset(const std::string& name, Enum& value, const std::string& sentence, Apply apply) {
    add_choice(
        name, names_of(Enum{}), sentence, true,
        [&value] { return static_cast<std::size_t>(value); },
        [apply](std::size_t i) { apply(static_cast<Enum>(i)); });
  }

  template <class Params>
  void section(const std::string& name, Params& params) {
    const std::size_t length = prefix_.size();
    prefix_ += name + ".";
    params.describe(*this);
    prefix_.resize(length);
  }

  template <class... Alternatives>
  void one_of(const std::string& name, std::variant<Alternatives...>& value,
              const std::string& sentence) {
    static const std::vector<std::string> names = {Alternatives::kName...};
    add_choice(
        name + ".type", names, sentence, true, [&value] { return value.index(); },
        [&value](std::size_t i) { emplace_alternative(value, i); });
    std::visit([&](auto& alternative) { section(name, alternative); }, value);
  }

  std::span<const Parameter> parameters() const& { return parameters_; }
  std::span<const Parameter> parameters() && = delete;  // would refer to what is gone
  void set(const std::string& path, const std::string& text) const;

 private:
  void add_choice(const std::string& name, std::span<const std::string> names,
                  const std::string& sentence, bool selects,
                  const std::function<std::size_t()>& get,
                  const std::function<void(std::size_t)>& set);

  template <class... Alternatives>
  static void emplace_alternative(std::variant<Alternatives...>& value, std::size_t index) {
    if (index == value.index()) return;
    std::size_t i = 0;
    ((i++ == index ? void(value.template emplace<Alternatives>()) : void()), ...);
  }

  std::string prefix_;
  std::vector<Parameter> parameters_;
};

using Settings = std::vector<std::pair<std::string, std::string>>;  // (path, value)

// The parameters as they stand, in the order of description. They refer to `params`.
template <class Params>
ParameterList parameters_of(Params& params) {
  ParameterList list;
  params.describe(list);
  return list;
}

namespace parameters_detail {
std::vector<bool> which_select(const ParameterList& list, const Settings& settings);
}

// Applies settings by name: first those that select others (`type`, `preset`), whose effect the
// rest then refines, each group in the given order.
template <class Params>
void apply_settings(const Settings& settings, Params& params) {
  const std::vector<bool> selects =
      parameters_detail::which_select(parameters_of(params), settings);
  for (const bool selecting : {true, false})
    for (std::size_t i = 0; i < settings.size(); ++i)
      if (selects[i] == selecting) parameters_of(params).set(settings[i].first, settings[i].second);
}

}  // namespace stereovox
