#include "program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace stereovox {

namespace fs = std::filesystem;

ProgramResult run_program(const std::string& arguments) { return run_under(":", arguments); }

ProgramResult run_under(const std::string& setup, const std::string& arguments) {
  const std::string command = setup + "; '" + STEREOVOX_PROGRAM + "' " + arguments + " 2>&1";
  ProgramResult result;
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return result;
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    result.output.append(buffer.data(), n);
  const int status = pclose(pipe);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

fs::path empty_folder(const std::string& name) {
  // Tests run in parallel processes: each has its own corner.
  const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(testing::TempDir()) / "stereovox_program_test" /
                          (std::string(test->test_suite_name()) + "." + test->name()) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

fs::path office_extract(const std::string& name, int pairs) {
  const fs::path source = fs::path(STEREOVOX_SOURCE_DIR) / "data" / "office_demo";
  const fs::path folder = empty_folder(name);
  for (const char* file : {"calib.yaml", "poses.txt"}) fs::copy_file(source / file, folder / file);
  std::ifstream all_times(source / "times.txt");
  std::ofstream times(folder / "times.txt");
  for (const char* side : {"left", "right"}) fs::create_directory(folder / side);
  for (int i = 0; i < pairs; ++i) {
    std::string time;
    std::getline(all_times, time);
    times << time << "\n";
    std::array<char, 16> image;
    std::snprintf(image.data(), image.size(), "%06d.png", i);
    for (const char* side : {"left", "right"})
      fs::copy_file(source / side / image.data(), folder / side / image.data());
  }
  return folder;
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void replace_in(const fs::path& path, const std::string& from, const std::string& to) {
  std::string text = text_of(path);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << path << " has no '" << from << "'";
  text.replace(at, from.size(), to);
  std::ofstream(path, std::ios::binary) << text;
}

void cut_off(const fs::path& path) { fs::resize_file(path, fs::file_size(path) / 2); }

}  // namespace stereovox
