#include "fuzz.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace lacon::fuzz {

const Target* find_target(std::string_view name) {
  const auto* const found =
      std::find_if(std::begin(targets), std::end(targets), [&](const Target& t) { return t.name == name; });
  return found == std::end(targets) ? nullptr : found;
}

void broken(const std::string& what) {
  std::fprintf(stderr, "broken: %s\n", what.c_str());
  std::abort();
}

TemporaryFile::TemporaryFile(std::string_view content) {
  const std::filesystem::path memory = "/dev/shm";
  path_ = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
  path_ /= "lacon_fuzz_" + std::to_string(::getpid());
  std::ofstream file(path_, std::ios::binary | std::ios::trunc);
  file.write(content.data(), static_cast<std::streamsize>(content.size()));
  file.close();
  if (!file) broken("the file " + path_.string() + " cannot be written");
}

TemporaryFile::~TemporaryFile() {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

}  // namespace lacon::fuzz
