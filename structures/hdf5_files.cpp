// Whole HDF5 files: opened, written, sealed.
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "lacon/catalog/messages.hpp"
#include "lacon/catalog/wording.hpp"
#include "lacon/structures/files.hpp"
#include "lacon/structures/hdf5.hpp"
#include "lacon/structures/hdf5_detail.hpp"
#include "lacon/structures/seal.hpp"

namespace lacon::hdf5 {
namespace {

/// Comes before any other call. HDF5 does nothing at a program's exit, where it would crash on files that could not be written,
/// nor prints its error stack: our messages say what was wanted. Each open file has half a megabyte of tables, which the next
/// one takes over where the free lists may hold that much: fresh pages cost more than small files.
void prepare() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  constexpr int bytes = 4 << 20;
  H5set_free_list_limits(bytes, bytes, bytes, bytes, bytes, bytes);
}

[[noreturn]] void cannot_write(const std::filesystem::path& file, const std::string& reason) {
  fail("BASE_3", {{"file", file.string()}, {"reason", reason}});
}

class Writer : public Group {
 public:
  Writer(Handle root, const std::filesystem::path& path) : Group(std::move(root), path, true) {}
};

/// Write what goes into an HDF5 file that was just opened as `partial`, and will be `file`.
void fill(const Handle& opened, const std::filesystem::path& partial, const std::filesystem::path& file,
          const std::function<void(const Group&)>& write) {
  if (opened < 0) cannot_write(file, with_system_reason(part("file_not_made", {{"name", partial.string()}})));
  const int before = failed_closes().count;
  {
    const Writer root(Handle(H5Gopen2(opened, "/", H5P_DEFAULT), H5Gclose), file);
    write(root);
  }
  if (failed_closes().count != before) cannot_write(file, failed_closes().reason);
  if (H5Fflush(opened, H5F_SCOPE_LOCAL) < 0) cannot_write(file, with_system_reason(part("file_not_ended")));
}

/// The same, closed.
void fill_and_close(Handle opened, const std::filesystem::path& partial, const std::filesystem::path& file,
                    const std::function<void(const Group&)>& write) {
  fill(opened, partial, file, write);
  const int before = failed_closes().count;
  opened = Handle();
  if (failed_closes().count != before) cannot_write(file, failed_closes().reason);
}

Handle new_file(const std::filesystem::path& path, bool in_memory = false) {
  prepare();
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose), access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  if (in_memory) H5Pset_fapl_core(access, 1 << 16, false);
  return Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose);
}

}  // namespace

Reader::Reader(const std::filesystem::path& file, Origin origin) : Group({}, file, false) {
  prepare();
  if (origin == Origin::base) check_seal(file);
  file_ = Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file_ < 0) {
    std::error_code error;
    if (!std::filesystem::exists(file, error)) refuse(part("file_not_there"));
    if (std::filesystem::is_directory(file, error)) refuse(part("file_is_folder"));
    if (std::FILE* stream = std::fopen(file.c_str(), "rb"))
      std::fclose(stream);
    else
      refuse(std::strerror(errno));
    if (H5Fis_hdf5(file.c_str()) <= 0) refuse(part("file_not_hdf5"));
    refuse(part("file_cut_off"));
  }
  id_ = Handle(H5Gopen2(file_, "/", H5P_DEFAULT), H5Gclose);
}

void write_whole(const std::filesystem::path& file, const std::function<void(const Group&)>& write,
                 const std::filesystem::path& copy_of) {
  write_as_partial(file, [&](const std::filesystem::path& partial) {
    if (copy_of.empty()) return fill_and_close(new_file(partial), partial, file, write);
    std::error_code error;
    std::filesystem::copy_file(copy_of, partial, std::filesystem::copy_options::overwrite_existing, error);
    if (error) cannot_write(file, error.message());
    prepare();
    fill_and_close(Handle(H5Fopen(partial.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose), partial, file, write);
  });
}

void write_sealed(const std::filesystem::path& file, const std::function<void(const Group&)>& write) {
  write_as_partial(file, [&](const std::filesystem::path& partial) {
    fill_and_close(new_file(partial), partial, file, write);
    seal(partial);
  });
}

void write_sealed_at_once(const std::filesystem::path& file, const std::function<void(const Group&)>& write) {
  write_as_partial(file, [&](const std::filesystem::path& partial) {
    const Handle opened = new_file(partial, true);
    fill(opened, partial, file, write);
    std::vector<char> content(static_cast<std::size_t>(std::max<ssize_t>(0, H5Fget_file_image(opened, nullptr, 0))));
    if (H5Fget_file_image(opened, content.data(), content.size()) <= 0) cannot_write(file, part("hdf5_no_content"));
    write_with_seal(partial, content);
  });
}

}  // namespace lacon::hdf5
