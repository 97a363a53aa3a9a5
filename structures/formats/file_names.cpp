#include "lacon/structures/formats/file_names.hpp"

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/text.hpp"

namespace lacon {

std::string FileNames::read(std::string name) {
  if (is_utf8(name)) return name;
  return *converted_.insert(as_utf8(name)).first;
}

void FileNames::tell(const std::filesystem::path& file) const {
  if (converted_.empty()) return;
  std::string list;
  for (const std::string& name : converted_) list += (list.empty() ? "'" : ", '") + name + "'";
  inform("FORMAT_1", {{"file", file.string()}, {"names", list}});
}

}  // namespace lacon
