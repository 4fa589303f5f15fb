// The folder of a run's results. New ones are made in a folder inside it and moved to their places
// when all are there, so that a full disk or a kill leaves the earlier results as they were.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stereovox {

// As long as it lives no other process has a lock on the folder. A killed process leaves none, and
// where folders cannot be locked there is none.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder);  // throws ResourceError
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_;  // open
};

class OutputFolder {
 public:
  // Makes sure before the work that its results can be written: makes the folder, and keeps other
  // processes out of it as long as the object lives. Throws ResourceError when it cannot be made or
  // written to or another process is at work there, UsageError when it holds results already and
  // `overwrite` is false.
  OutputFolder(std::filesystem::path folder, bool overwrite);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  const std::filesystem::path& path() const { return folder_; }
  bool holds_results() const;
  std::vector<std::string> results() const;  // the names of those that are there

  // Where new results are to be written, under the names of outputs.h.
  const std::filesystem::path& staging() const { return staging_; }
  // Puts them in the place of all earlier ones. Throws ResourceError.
  void publish();

 private:
  const std::filesystem::path folder_, staging_;
  const FolderLock lock_;
};

}  // namespace stereovox
