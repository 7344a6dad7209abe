#include "baker/core/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace ft {
namespace {

std::string reason(int error) {
  return std::strerror(error);
}

Error write_fault(const std::filesystem::path& path, const char* what, int error) {
  std::string hint;
  if (error == ENOSPC || error == EDQUOT) hint = "free some space and run again with --resume";
  if (error == EACCES || error == EPERM || error == EROFS) hint = "choose a folder that can be written, with --out";
  return output_error(std::string(what) + ": " + reason(error), path.string(), hint);
}

Status sync_folder(const std::filesystem::path& folder) {
  const int fd = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return write_fault(folder, "cannot open folder", errno);
  const int failed = ::fsync(fd);
  const int error = errno;
  ::close(fd);
  // Some file systems cannot sync a folder; the rename is then as durable as they offer.
  if (failed != 0 && error != EINVAL && error != ENOTSUP) return write_fault(folder, "cannot sync folder", error);
  return {};
}

/// A regular file, from its beginning.
class Input {
 public:
  static Result<Input> open(const std::filesystem::path& path) {
    Input file(::open(path.c_str(), O_RDONLY | O_CLOEXEC), path);
    if (file.descriptor_ < 0) return input_error("cannot read: " + reason(errno), path.string());
    struct stat info {};
    if (::fstat(file.descriptor_, &info) != 0 || !S_ISREG(info.st_mode))
      return input_error("is not a regular file", path.string());
    file.size_ = static_cast<std::uint64_t>(info.st_size);
    return file;
  }
  Input(Input&& other) noexcept
      : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)), size_(other.size_) {}
  Input(const Input&) = delete;
  Input& operator=(const Input&) = delete;
  ~Input() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  std::uint64_t size() const { return size_; }
  /// How much of `data` there was.
  Result<std::size_t> read(std::span<std::byte> data) {
    std::size_t done = 0;
    while (done < data.size()) {
      const ssize_t n = ::read(descriptor_, data.data() + done, data.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) return input_error("cannot read: " + reason(errno), path_.string());
      if (n == 0) break;
      done += static_cast<std::size_t>(n);
    }
    return done;
  }

 private:
  Input(int descriptor, std::filesystem::path path) : descriptor_(descriptor), path_(std::move(path)) {}
  int descriptor_;
  std::filesystem::path path_;
  std::uint64_t size_ = 0;
};

}  // namespace

Result<Bytes> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  auto file = Input::open(path);
  if (!file) return file.error();
  if (file->size() > max_bytes)
    return input_error("is larger than the limit of " + std::to_string(max_bytes) + " bytes", path.string());
  Bytes data(static_cast<std::size_t>(file->size()));
  const auto done = file->read(data);
  if (!done) return done.error();
  data.resize(done.value());
  return data;
}

Result<FileContent> hash_file(const std::filesystem::path& path) {
  auto file = Input::open(path);
  if (!file) return file.error();
  FileContent out;
  Hasher hasher;
  Bytes part(std::size_t{1} << 20);
  for (;;) {
    const auto done = file->read(part);
    if (!done) return done.error();
    hasher.bytes(part.data(), done.value());
    out.bytes += done.value();
    if (done.value() < part.size()) break;
  }
  out.hash = hasher.digest();
  return out;
}

Result<std::string> read_text(const std::filesystem::path& path, std::uint64_t max_bytes) {
  auto data = read_file(path, max_bytes);
  if (!data) return data.error();
  return std::string(reinterpret_cast<const char*>(data->data()), data->size());
}

Status write_file_durably(const std::filesystem::path& path, std::span<const std::byte> data) {
  return write_file_durably(path, std::span(&data, 1));
}

Status write_file_durably(const std::filesystem::path& path, std::span<const std::span<const std::byte>> parts) {
  std::filesystem::path temporary = path;
  temporary += ".tmp";
  auto file = OutputFile::create(temporary);
  if (!file) return file.error();
  Status status;
  std::uint64_t offset = 0;
  for (const auto& part : parts) {
    if (status) status = file->write_at(offset, part);
    offset += part.size();
  }
  if (status) status = file->sync();
  if (status) status = file->close();
  if (!status) {
    ::unlink(temporary.c_str());
    return status;
  }
  if (::rename(temporary.c_str(), path.c_str()) != 0) {
    const int error = errno;
    ::unlink(temporary.c_str());
    return write_fault(path, "cannot rename into place", error);
  }
  return sync_folder(path.parent_path());
}

Status write_text_durably(const std::filesystem::path& path, std::string_view text) {
  return write_file_durably(path, std::as_bytes(std::span(text.data(), text.size())));
}

Status make_folders(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return write_fault(folder, "cannot create folder", error.value());
  return {};
}

Result<OutputFile> OutputFile::create(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) return write_fault(path, "cannot create", errno);
  return OutputFile(fd, path);
}

Result<OutputFile> OutputFile::open_existing(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (fd < 0) return write_fault(path, "cannot open for writing", errno);
  return OutputFile(fd, path);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  if (this != &other) {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = std::exchange(other.descriptor_, -1);
    path_ = std::move(other.path_);
  }
  return *this;
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Status OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> data) {
  std::size_t done = 0;
  while (done < data.size()) {
    const ssize_t n = ::pwrite(descriptor_, data.data() + done, data.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return write_fault(path_, "cannot write", errno);
    done += static_cast<std::size_t>(n);
  }
  return {};
}

Status OutputFile::truncate(std::uint64_t size) {
  if (::ftruncate(descriptor_, static_cast<off_t>(size)) != 0) return write_fault(path_, "cannot truncate", errno);
  return {};
}

Result<std::uint64_t> OutputFile::size() const {
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0) return write_fault(path_, "cannot stat", errno);
  return static_cast<std::uint64_t>(info.st_size);
}

Status OutputFile::sync() {
  if (::fdatasync(descriptor_) != 0) return write_fault(path_, "cannot sync", errno);
  return {};
}

Status OutputFile::close() {
  const int fd = std::exchange(descriptor_, -1);
  if (fd >= 0 && ::close(fd) != 0) return write_fault(path_, "cannot close", errno);
  return {};
}

}  // namespace ft
