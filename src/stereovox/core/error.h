// What the library throws. The text is for the user: it names the file, the fact and the numbers.
#pragma once

#include <stdexcept>
#include <string>

namespace stereovox {

// Bad input from outside: a file, a calibration, a data set (program exit code 3).
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

// A wrong option, parameter name or parameter value (exit code 2).
class UsageError : public Error {
 public:
  using Error::Error;
  ~UsageError() override;
};

// A disk, memory or permission limit (exit code 5).
class ResourceError : public Error {
 public:
  using Error::Error;
  ~ResourceError() override;
};

}  // namespace stereovox
