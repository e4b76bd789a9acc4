#include "core/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "core/errors.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

constexpr mode_t file_mode = 0666;  // minus the umask

std::string reason(int error) { return std::generic_category().message(error); }

[[noreturn]] void throw_unwritten(const fs::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

int open_file(const fs::path& path, int flags) {
  int descriptor = -1;
  do descriptor = ::open(path.c_str(), flags | O_CLOEXEC, file_mode);
  while (descriptor < 0 && errno == EINTR);
  return descriptor;
}

/// Write everything; after a short write the rest is written, which reveals the error. Returns 0 or the error.
int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      return errno;
    }
    if (written == 0) return EIO;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return 0;
}

/// Call fsync. Returns 0 or the error; unsupported for pipes, devices and some folders, which is not an error.
int sync_descriptor(int descriptor) {
  while (::fsync(descriptor) != 0) {
    if (errno == EINTR) continue;
    return errno == EINVAL || errno == ENOTSUP || errno == EROFS ? 0 : errno;
  }
  return 0;
}

/// Write, sync and close; a full disk may show in any of the three. Returns 0 or the first error.
int write_and_close(int descriptor, std::string_view content, Sync sync = Sync::now) {
  int error = write_all(descriptor, content);
  if (error == 0 && sync == Sync::now) error = sync_descriptor(descriptor);
  if (::close(descriptor) != 0 && error == 0 && errno != EINTR) error = errno;
  return error;
}

/// Open, sync and close a file or folder. Returns 0 or the error.
int sync_path(const fs::path& path, int flags) {
  const int descriptor = open_file(path, O_RDONLY | flags);
  if (descriptor < 0) return errno;
  return write_and_close(descriptor, {});
}

[[noreturn]] void remove_and_throw(const fs::path& temporary, const fs::path& path, int error) {
  ::unlink(temporary.c_str());
  throw_unwritten(path, reason(error));
}

/// Resolve links, so that a link stays a link.
fs::path link_target(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_symlink(path, ignored)) return path;
  const fs::path target = fs::canonical(path, ignored);
  return target.empty() ? path : target;
}

bool exists_and_is_no_regular_file(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status);
}

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  // Process and counter, so that two writers of one file have different temporary files.
  fs::path temporary = path;
  temporary += fmt::format(".{}-{}.part", ::getpid(), count++);
  return temporary;
}

}  // namespace

void rename_file(const fs::path& temporary, const fs::path& path, Sync sync) {
  if (::rename(temporary.c_str(), path.c_str()) != 0) remove_and_throw(temporary, path, errno);
  if (sync == Sync::later) return;
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  // A folder with write but no read permission cannot be opened; the file exists nevertheless.
  const int error = sync_path(folder, O_DIRECTORY);
  if (error != 0 && error != EACCES) throw_unwritten(path, reason(error));
}

fs::path write_beside(const fs::path& path, std::string_view content, Sync sync) {
  fs::path temporary = temporary_beside(path);
  const int descriptor = open_file(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW);
  if (descriptor < 0) throw_unwritten(path, reason(errno));
  const int error = write_and_close(descriptor, content, sync);
  if (error != 0) remove_and_throw(temporary, path, error);
  return temporary;
}

void throw_unread(const fs::path& path, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be read: {}", path.string(), why));
}

std::string read_file(const fs::path& path, std::uintmax_t most_bytes) {
  const int descriptor = open_file(path, O_RDONLY);
  if (descriptor < 0) throw_unread(path, reason(errno));
  std::string content, why;
  struct stat status {};
  if (::fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0 &&
      static_cast<std::uintmax_t>(status.st_size) <= most_bytes)
    content.reserve(static_cast<std::size_t>(status.st_size));
  // Limit the bytes read rather than the reported size: a device has none.
  std::string block(1 << 16, '\0');
  while (why.empty()) {
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count == 0) break;
    if (count < 0) {
      if (errno != EINTR) why = reason(errno);
      continue;
    }
    content.append(block, 0, static_cast<std::size_t>(count));
    if (content.size() > most_bytes) why = fmt::format("it is larger than {} MiB", most_bytes >> 20);
  }
  ::close(descriptor);
  if (!why.empty()) throw_unread(path, why);
  return content;
}

bool is_there(const fs::path& path) {
  std::error_code unknown;
  return fs::exists(path, unknown);
}

void make_directory(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) throw FileError(fmt::format("{}: cannot be created: {}", path.string(), error.message()));
}

std::uintmax_t bytes_in(const fs::path& directory) {
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::recursive_directory_iterator(directory, error))
    if (entry.is_regular_file(error)) bytes += entry.file_size(error);
  return bytes;
}

void write_file(const fs::path& path, std::string_view content) {
  if (exists_and_is_no_regular_file(path)) {
    const int descriptor = open_file(path, O_WRONLY);
    const int error = descriptor < 0 ? errno : write_and_close(descriptor, content);
    if (error != 0) throw_unwritten(path, reason(error));
    return;
  }
  const fs::path target = link_target(path);
  rename_file(write_beside(target, content, Sync::now), target, Sync::now);
}

RowFile::RowFile(fs::path path, std::uint64_t keep_bytes) : path_(std::move(path)), size_bytes_(keep_bytes) {
  descriptor_ = open_file(path_, O_RDWR | O_CREAT | O_APPEND);
  if (descriptor_ < 0) throw_unwritten(path_, reason(errno));
  std::string why;
  struct stat status {};
  char last = '\n';
  if (::fstat(descriptor_, &status) != 0)
    why = reason(errno);
  else if (static_cast<std::uint64_t>(status.st_size) < keep_bytes)
    why = fmt::format("it has {} bytes, fewer than the {} to continue from", status.st_size, keep_bytes);
  else if (keep_bytes > 0 && (::pread(descriptor_, &last, 1, static_cast<off_t>(keep_bytes) - 1) != 1 || last != '\n'))
    why = fmt::format("its first {} bytes do not end with a complete row", keep_bytes);
  else if (S_ISREG(status.st_mode) && ::ftruncate(descriptor_, static_cast<off_t>(keep_bytes)) != 0)
    why = reason(errno);
  if (why.empty()) return;
  ::close(descriptor_);
  throw_unwritten(path_, why);
}

RowFile::~RowFile() { ::close(descriptor_); }

void RowFile::append(std::string_view row) {
  std::string line;
  line.reserve(row.size() + 1);
  line.append(row).push_back('\n');
  const int error = write_all(descriptor_, line);
  if (error != 0) {
    // Cut off a partial row. If that fails too, report the first error.
    if (::ftruncate(descriptor_, static_cast<off_t>(size_bytes_)) != 0) errno = 0;
    throw_unwritten(path_, reason(error));
  }
  size_bytes_ += line.size();
}

void RowFile::sync() {
  const int error = sync_descriptor(descriptor_);
  if (error != 0) throw_unwritten(path_, reason(error));
}

DirectoryLock::DirectoryLock(const fs::path& directory) : descriptor_(open_file(directory, O_RDONLY | O_DIRECTORY)) {
  if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw FileError(directory.string() + ": another process of plica is writing into it; wait until it ends");
}

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace plica
