#include <maximin/models/files/output_file.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <cerrno>
#include <cstring>
#include <string>

#include <maximin/theory/error.hpp>

namespace maximin {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* expected) {
  throw InputError(fmt::format("{}: {}, expected {}", path.string(), std::strerror(errno), expected));
}

/// The temporary file; removed unless it was given its final name.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : name_(target.string() + ".XXXXXX" + partial_suffix) {
    fd_ = mkstemps(name_.data(), static_cast<int>(std::strlen(partial_suffix)));
    if (fd_ < 0) fail(target, "a file name in a folder that can be written");
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (fd_ >= 0) close(fd_);
    unlink(name_.c_str());
  }

  int fd() const { return fd_; }
  const char* name() const { return name_.c_str(); }

 private:
  std::string name_;
  int fd_ = -1;
};

bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

/// Who may read the new file: those who could read the old one, else what the umask leaves.
mode_t permissions(const fs::path& path) {
  struct stat old {};
  if (stat(path.c_str(), &old) == 0) return old.st_mode & 07777U;
  const mode_t mask = umask(0);
  umask(mask);
  return 0666U & ~mask;
}

/// A pipe or a device has no name to take over: it is written to as it is.
void write_in_place(const fs::path& path, std::string_view content) {
  const int fd = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (fd < 0) fail(path, "something that can be written");
  const bool written = write_all(fd, content);
  if (close(fd) != 0 || !written) fail(path, "something that can be written");
}

}  // namespace

void write_file(const fs::path& path, std::string_view content, Overwrite overwrite) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) throw InputError(path.string() + ": is a folder, expected a file name");
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(path, content);
  if (fs::exists(status) && overwrite == Overwrite::refuse)
    throw InputError(path.string() + ": exists, expected a new file name, or --force to replace it");
  const fs::path target = fs::exists(status) ? fs::canonical(path) : path;
  const TemporaryFile temporary(target);
  if (!write_all(temporary.fd(), content) || fchmod(temporary.fd(), permissions(target)) != 0 ||
      fsync(temporary.fd()) != 0) {
    fail(path, "room and permission to write it");
  }
  if (overwrite == Overwrite::refuse && link(temporary.name(), target.c_str()) == 0) return;
  if (overwrite == Overwrite::refuse && errno == EEXIST)
    throw InputError(path.string() + ": exists, expected a new file name, or --force to replace it");
  if (rename(temporary.name(), target.c_str()) != 0) fail(path, "a file name that can be written");
}

void make_folder(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (fs::is_directory(path)) return;
  throw InputError(fmt::format("{}: {}, expected a folder or room for one", path.string(),
                               error ? error.message() : "is no folder"));
}

}  // namespace maximin
