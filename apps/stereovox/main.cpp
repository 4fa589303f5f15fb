// stereovox: stereo images in, navigation maps out.
#include <iostream>
#include <new>
#include <opencv2/core.hpp>

#include "command.h"
#include "interrupt.h"
#include "stereovox/core/error.h"
#include "stereovox/core/nearest_name.h"
#include "stereovox/core/version.h"

namespace stereovox {
namespace {

// In the order in which data passes through them.
constexpr void (*kCommands[])(CLI::App&, Action&) = {
    add_run,   add_disparity, add_odometry, add_navmap,     add_export, add_merge,
    add_score, add_check,     add_simulate, add_experiment, add_info,
};

constexpr const char* kFooter =
    "Exit codes: 0 ok, 1 internal error, 2 usage, 3 bad input, 4 finished below the quality gate,\n"
    "            5 disk, memory or permission, 130 stopped by Ctrl-C after saving";

ExitCode fail(ExitCode code, const std::string& text) {
  std::cerr << "stereovox: error: " << text << "\n";
  return code;
}

const CLI::App& innermost(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : innermost(*chosen.front());
}

std::vector<std::string> words_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
  for (const CLI::App* sub : command.get_subcommands([](const CLI::App*) { return true; }))
    words.push_back(sub->get_name());
  return words;
}

// CLI11's own text does not say what might have been meant.
std::string explain(const CLI::ParseError& error, const CLI::App& program) {
  const CLI::App& command = innermost(program);
  const std::vector<std::string> unexpected = program.remaining(true);
  if (!unexpected.empty()) {
    const std::string word = unexpected.front().substr(0, unexpected.front().find('='));
    return "unexpected '" + word + "'" + did_you_mean(word, words_of(command)) +
           "; see stereovox " + (&command == &program ? "" : command.get_name() + " ") + "--help";
  }
  return error.what();
}

ExitCode parse_and_run(CLI::App& program, const Action& action, int argc, char** argv) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& wish) {
    return static_cast<ExitCode>(program.exit(wish));
  } catch (const CLI::ParseError& error) {
    return fail(ExitCode::usage, explain(error, program));
  }
  try {
    return action();
  } catch (const UsageError& error) {
    return fail(ExitCode::usage, error.what());
  } catch (const ResourceError& error) {
    return fail(ExitCode::resource, error.what());
  } catch (const Error& error) {
    return fail(ExitCode::bad_input, error.what());
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::resource, "out of memory");
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) return fail(ExitCode::resource, "out of memory");
    return fail(ExitCode::internal, "internal: " + error.err);
  } catch (const std::exception& error) {
    return fail(ExitCode::internal, std::string("internal: ") + error.what());
  }
}

ExitCode run_program(int argc, char** argv) {
  CLI::App program{"stereovox: stereo images in, navigation maps out"};
  program.set_version_flag("--version", std::string(version()));
  program.footer(kFooter);
  program.require_subcommand(1);
  Action action;
  for (const auto add : kCommands) add(program, action);
  return parse_and_run(program, action, argc, argv);
}

}  // namespace
}  // namespace stereovox

int main(int argc, char** argv) {
  stereovox::report_failed_writes();
  try {
    return static_cast<int>(stereovox::run_program(argc, argv));
  } catch (...) {  // no memory even for a message
    return static_cast<int>(stereovox::ExitCode::internal);
  }
}
