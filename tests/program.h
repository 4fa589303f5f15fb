// The built program, run as a user runs it, and small data sets to run it on.
#pragma once

#include <filesystem>
#include <string>

namespace stereovox {

struct ProgramResult {
  int exit_code = -1;
  std::string output;  // standard output and standard error
};

// Runs `stereovox <arguments>` through the shell; single-quote what needs it.
ProgramResult run_program(const std::string& arguments);

// The same after a command of the shell that sets limits.
ProgramResult run_under(const std::string& setup, const std::string& arguments);

// For the shell.
inline std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

// A new empty folder of this name.
std::filesystem::path empty_folder(const std::string& name);

// A new folder of this name with the first pairs of data/office_demo in the plain layout.
std::filesystem::path office_extract(const std::string& name, int pairs);

std::string text_of(const std::filesystem::path& path);
void replace_in(const std::filesystem::path& path, const std::string& from, const std::string& to);
void cut_off(const std::filesystem::path& path);  // to half its size

}  // namespace stereovox
