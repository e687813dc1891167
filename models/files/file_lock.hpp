#pragma once

#include <filesystem>

namespace maximin {

/// Held while one run makes a file, so that no other does. A file NAME.lock beside it, which goes with the lock: the
/// file itself is replaced at each writing. A run that is killed leaves NAME.lock behind, unlocked.
class FileLock {
 public:
  /// Throws InputError when another run, or this one, holds it, or when the system refuses.
  explicit FileLock(const std::filesystem::path& file);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;  ///< -1: moved from
};

}  // namespace maximin
