#include "lacon/structures/formats/text_file.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/files.hpp"

namespace lacon {

namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const auto refuse = [&] { fail("BASE_2", {{"file", file.string()}, {"reason", std::strerror(errno)}}); };
  if (!stream) refuse();
  std::string text;
  std::array<char, 1 << 16> block;
  do {
    stream.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
  } while (stream);
  if (stream.bad()) refuse();  // a folder, a disk that fails
  return text;
}

std::string first_bytes(const fs::path& mesh_file, std::size_t count) {
  std::error_code error;
  const auto refuse = [&](const std::string& reason) { fail("MED_1", {{"file", mesh_file.string()}, {"reason", reason}}); };
  if (!fs::exists(mesh_file, error)) refuse(part("file_not_there"));
  if (fs::is_directory(mesh_file, error)) refuse(part("file_is_folder"));
  std::ifstream stream(mesh_file, std::ios::binary);
  if (!stream) refuse(std::strerror(errno));
  std::string bytes(count, '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  if (bytes.empty()) refuse(part("file_is_empty"));
  return bytes;
}

TextFiles::~TextFiles() {
  std::error_code error;
  for (const auto& [partial, file] : files_) fs::remove(partial, error);
}

void TextFiles::write(const fs::path& file, std::string_view text) {
  check_replaceable(file);
  const fs::path partial = file.string() + ".partial";
  std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
  if (stream) files_.emplace_back(partial, file);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.flush();
  if (!stream) fail("BASE_3", {{"file", file.string()}, {"reason", std::strerror(errno)}});
}

void TextFiles::commit() {
  for (const auto& [partial, file] : files_) {
    std::error_code error;
    fs::rename(partial, file, error);
    if (error) fail("BASE_3", {{"file", file.string()}, {"reason", error.message()}});
  }
  files_.clear();
}

}  // namespace lacon
