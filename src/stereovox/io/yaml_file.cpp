#include "stereovox/io/yaml_file.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <cmath>
#include <set>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

constexpr std::uint64_t kMaxYamlBytes = 16ULL << 20;
constexpr std::size_t kMaxDepth = 32;
// 32 aliases can expand a document at most e^(32/e) = 130 000 times; real files hold a few.
constexpr int kMaxAliases = 32;

std::string place(const std::string& source, const YAML::Mark& mark) {
  return mark.is_null() ? source : fmt::format("{}:{}", source, mark.line + 1);
}

// Walks a document without building it, and stops at the limits and at a key that a map has twice:
// one of its values would be ignored.
class Inspector : public YAML::EventHandler {
 public:
  explicit Inspector(const std::string& source) : source_(source) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { meet(mark, nullptr); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string& text) override {
    meet(mark, &text);
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    if (++aliases_ > kMaxAliases)
      throw Error(fmt::format("{}: more than {} aliases", place(source_, mark), kMaxAliases));
    meet(mark, nullptr);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark, false);
  }
  void OnSequenceEnd() override { open_.pop_back(); }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark, true);
  }
  void OnMapEnd() override { open_.pop_back(); }

 private:
  // A map or a list that has not ended.
  struct Open {
    bool is_map, expects_key = true;
    std::set<std::string> keys = {};
  };

  // A key, a value or an entry; its text if it is a scalar.
  void meet(const YAML::Mark& mark, const std::string* text) {
    if (open_.empty() || !open_.back().is_map) return;
    Open& map = open_.back();
    if (map.expects_key && text != nullptr && !map.keys.insert(*text).second)
      throw Error(fmt::format("{}: {} is there twice", place(source_, mark), in_quotes(*text)));
    map.expects_key = !map.expects_key;
  }

  void enter(const YAML::Mark& mark, bool is_map) {
    meet(mark, nullptr);
    open_.push_back({.is_map = is_map});
    if (open_.size() > kMaxDepth)
      throw Error(fmt::format("{}: nested more than {} deep", place(source_, mark), kMaxDepth));
  }

  std::string source_;
  std::vector<Open> open_;
  int aliases_ = 0;
};

void inspect(const std::string& text, const std::string& source) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Inspector inspector(source);
  parser.HandleNextDocument(inspector);
}

std::string shown(const YAML::Node& node) {
  return node.IsScalar() ? in_quotes(node.Scalar())
         : node.IsNull() ? "empty"
                         : "not a single value";
}

[[noreturn]] void fail(const YAML::Node& node, const std::string& key, const std::string& source,
                       const std::string& wanted) {
  throw Error(
      fmt::format("{}: '{}' is {}, not {}", place(source, node.Mark()), key, shown(node), wanted));
}

double finite_number(const YAML::Node& node, const std::string& key, const std::string& source) {
  const std::optional<double> value = node.IsScalar() ? parse_number(node.Scalar()) : std::nullopt;
  if (!value || !std::isfinite(*value)) fail(node, key, source, "a finite number");
  return *value;
}

void append_numbers(const YAML::Node& node, const std::string& key, const std::string& source,
                    std::vector<double>& numbers) {
  for (const YAML::Node& entry : node)
    if (entry.IsSequence())
      append_numbers(entry, key, source, numbers);
    else
      numbers.push_back(finite_number(entry, key, source));
}

}  // namespace

YAML::Node load_yaml(const std::filesystem::path& path) {
  return parse_yaml(read_file(path, kMaxYamlBytes), path.string());
}

YAML::Node parse_yaml(std::string text, const std::string& source) {
  // Not a YAML directive; a comment keeps the line numbers.
  if (text.starts_with("%YAML:")) text[0] = '#';
  try {
    inspect(text, source);
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    throw Error(fmt::format("{}: {}", place(source, error.mark), error.msg));
  }
}

YAML::Node yaml_value(const YAML::Node& map, const std::string& key, const std::string& source) {
  const YAML::Node value = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
  if (!value.IsDefined()) throw Error(fmt::format("{}: '{}' is missing", source, key));
  return value;
}

double yaml_number(const YAML::Node& map, const std::string& key, const std::string& source) {
  return finite_number(yaml_value(map, key, source), key, source);
}

int yaml_integer(const YAML::Node& map, const std::string& key, const std::string& source) {
  const YAML::Node node = yaml_value(map, key, source);
  const double value = finite_number(node, key, source);
  if (value != std::floor(value) || std::abs(value) > INT32_MAX)
    fail(node, key, source, "a whole number");
  return static_cast<int>(value);
}

std::string yaml_text(const YAML::Node& map, const std::string& key, const std::string& source) {
  const YAML::Node node = yaml_value(map, key, source);
  if (!node.IsScalar()) fail(node, key, source, "a text");
  return node.Scalar();
}

std::vector<double> yaml_numbers(const YAML::Node& map, const std::string& key,
                                 const std::string& source) {
  const YAML::Node node = yaml_value(map, key, source);
  if (!node.IsSequence()) fail(node, key, source, "a list of numbers");
  std::vector<double> numbers;
  append_numbers(node, key, source, numbers);
  return numbers;
}

std::vector<double> yaml_numbers(const YAML::Node& map, const std::string& key, std::size_t count,
                                 const std::string& source) {
  std::vector<double> numbers = yaml_numbers(map, key, source);
  if (numbers.size() != count)
    throw Error(fmt::format("{}: '{}' has {} numbers, {} are needed",
                            place(source, yaml_value(map, key, source).Mark()), key, numbers.size(),
                            count));
  return numbers;
}

}  // namespace stereovox
