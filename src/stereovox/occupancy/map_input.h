// The bytes of a map file as its readers take them: bounded, with the file's name in every error.
#pragma once

#include <istream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "stereovox/core/error.h"

namespace stereovox {

class MapInput {
 public:
  MapInput(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  const std::string& name() const { return name_; }
  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }

  // Throws Error when there are fewer. Memory grows with the bytes that really come, so that a
  // wrong size cannot ask for much.
  std::string take(std::size_t size);
  bool is_at_end() { return in_.peek() == std::istream::traits_type::eof(); }
  void seek(std::uint64_t offset) {
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(offset));
  }
  // Of the whole file; what is read next is then anywhere.
  std::uint64_t size();

  // Turns complaints about the content of a part into an Error that names the file and the part.
  template <class Body>
  auto decode(const std::string& part, Body body) const {
    try {
      return body();
    } catch (const Error&) {
      throw;
    } catch (const std::runtime_error& error) {
      fail(part + error.what());
    } catch (const std::out_of_range& error) {
      fail(part + error.what());
    }
  }

 private:
  std::istream& in_;
  std::string name_;
};

// A section of attachments, and in versions 1 and 2 of blocks: their number, two sizes, compressed
// content and a checksum.
struct MapSection {
  std::uint32_t blocks = 0;
  std::string content;
};

std::string encode_section(const MapSection& section);

// Throws Error "<name>: <part> ..." when the section is cut off, damaged, or claims more than
// `max_bytes` of content.
MapSection take_section(MapInput& in, const std::string& part, std::size_t max_bytes);

}  // namespace stereovox
