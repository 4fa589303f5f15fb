#include "stereovox/io/yaml_file.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <cmath>
#include <sstream>

#include "stereovox/core/error.h"
#include "stereovox/io/file_bytes.h"
#include "stereovox/io/text_file.h"

namespace stereovox {
namespace {

constexpr std::uint64_t kMaxYamlBytes = 16ULL << 20;
constexpr int kMaxDepth = 32;
// 32 aliases can expand a document at most e^(32/e) = 130 000 times; real files hold a few.
constexpr int kMaxAliases = 32;

std::string place(const std::string& source, const YAML::Mark& mark) {
  return mark.is_null() ? source : fmt::format("{}:{}", source, mark.line + 1);
}

// Walks a document without building it, and stops at the limits.
class LimitChecker : public YAML::EventHandler {
 public:
  explicit LimitChecker(const std::string& source) : source_(source) {}

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
    if (++aliases_ > kMaxAliases)
      throw Error(fmt::format("{}: more than {} aliases", place(source_, mark), kMaxAliases));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnSequenceEnd() override { --depth_; }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    enter(mark);
  }
  void OnMapEnd() override { --depth_; }

 private:
  void enter(const YAML::Mark& mark) {
    if (++depth_ > kMaxDepth)
      throw Error(fmt::format("{}: nested more than {} deep", place(source_, mark), kMaxDepth));
  }

  std::string source_;
  int depth_ = 0, aliases_ = 0;
};

void check_limits(const std::string& text, const std::string& source) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  LimitChecker checker(source);
  parser.HandleNextDocument(checker);
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
    check_limits(text, source);
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
  const std::vector<double> numbers = yaml_numbers(map, key, source);
  if (numbers.size() != count)
    throw Error(fmt::format("{}: '{}' has {} numbers, {} are needed",
                            place(source, yaml_value(map, key, source).Mark()), key, numbers.size(),
                            count));
  return numbers;
}

}  // namespace stereovox
