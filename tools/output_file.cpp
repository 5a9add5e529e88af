#include "output_file.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_error.hpp"
#include "interrupt.hpp"

namespace fastccd::tools {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string_view what, int error)
{
    throw InputError(path, fmt::format("{}: {}", what, std::generic_category().message(error)));
}

/// The descriptor of this process that a path names. Such a file is open already, perhaps shared with others who
/// write to it and at a place of its own: opened anew or replaced, what they write would be lost.
std::optional<int> open_descriptor(const std::filesystem::path& path)
{
    const std::string name = path;
    if (name == "-" || name == "/dev/stdout") return STDOUT_FILENO;
    if (name == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!name.starts_with(folder)) continue;
        const char* const end = name.data() + name.size();
        int descriptor = 0;
        const auto [rest, error] = std::from_chars(name.data() + folder.size(), end, descriptor);
        if (error == std::errc{} && rest == end && descriptor >= 0) return descriptor;
    }
    return std::nullopt;
}

int open_in_place(const std::filesystem::path& path)
{
    int descriptor = -1;
    // A pipe waits until somebody reads from it, and a signal wakes it up.
    while ((descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC)) < 0 && errno == EINTR) check_interrupt();
    if (descriptor < 0) fail(path, "cannot be opened for writing", errno);
    return descriptor;
}

/// Others who have the same pipe open may have made it one that does not wait.
void wait_until_writable(int descriptor)
{
    pollfd waiting{.fd = descriptor, .events = POLLOUT, .revents = 0};
    if (::poll(&waiting, 1, -1) < 0) check_interrupt();
}

/// What a link leads to, be it there or not: where the link stands, its file is replaced or created, and it stays a link.
std::filesystem::path follow_links(std::filesystem::path path)
{
    constexpr int most_links = 40;  // as many as Linux follows
    std::error_code none;
    for (int i = 0; i < most_links && std::filesystem::is_symlink(path, none); ++i)
        path = path.parent_path() / std::filesystem::read_symlink(path, none);
    return path;
}

/// Whether something is mounted under this very name, as containers do with single files: no other file can take its place.
bool is_mount_point(const std::filesystem::path& path)
{
    struct statx status {};
    return ::statx(AT_FDCWD, path.c_str(), 0, STATX_TYPE, &status) == 0 && (status.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0;
}

/// A name in the same folder for what `target` gets. Long names are cut, so that there is room for the rest.
std::filesystem::path temporary_name(const std::filesystem::path& target, unsigned attempt)
{
    constexpr std::size_t most_kept = 200;  // of 255 bytes
    const std::string name = target.filename().string().substr(0, most_kept);
    return target.parent_path() / fmt::format("{}.{}-{}.tmp", name, ::getpid(), attempt);
}

}  // namespace

void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& name)
{
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
            if (!bytes.empty()) check_interrupt();  // a signal ends a write that waits with what it has written so far
        } else if (errno == EINTR) {
            check_interrupt();
        } else if (errno == EAGAIN) {
            wait_until_writable(descriptor);
        } else if (errno == EPIPE) {
            throw BrokenPipe{};
        } else {
            fail(name, "cannot be written", errno);
        }
    }
}

bool OutputFile::is_standard_output(const std::filesystem::path& target)
{
    return open_descriptor(target) == STDOUT_FILENO;
}

std::filesystem::path OutputFile::place(const std::filesystem::path& target)
{
    std::error_code unknown;
    // Absolute first: of a path that is not there yet, what it is relative to is left out otherwise.
    return std::filesystem::weakly_canonical(follow_links(std::filesystem::absolute(target, unknown)), unknown);
}

OutputFile::OutputFile(const std::filesystem::path& target) : target_{target}
{
    if (const std::optional<int> descriptor = open_descriptor(target)) {
        if (*descriptor == STDOUT_FILENO) target_ = "standard output";
        descriptor_ = ::fcntl(*descriptor, F_DUPFD_CLOEXEC, 0);
        if (descriptor_ < 0) fail(target_, "cannot be opened", errno);
        return;
    }

    struct stat existing {};
    const bool exists = ::stat(target_.c_str(), &existing) == 0;
    // A shorter temporary name could be opened all the same.
    if (!exists && (errno == ELOOP || errno == ENAMETOOLONG)) fail(target_, "cannot be created", errno);
    if (exists && S_ISDIR(existing.st_mode)) throw InputError(target_, "is a directory; name a file to write");
    if (exists && !S_ISREG(existing.st_mode)) {
        descriptor_ = open_in_place(target_);
        return;
    }
    if (exists) {
        // Renaming needs no permission on the file itself, but a write-protected file is meant to stay.
        if (::access(target_.c_str(), W_OK) != 0) fail(target_, "cannot be overwritten", errno);
        if (is_mount_point(target_)) throw InputError(target_, "is a mount point, which no other file can replace; mount its folder instead");
    }
    target_ = follow_links(target_);

    // Process id and counter make the name unique among running writers, O_EXCL skips what a killed
    // process left behind; 0666 lets the umask decide, as for any new file.
    for (unsigned attempt = 0; descriptor_ < 0; ++attempt) {
        temporary_ = temporary_name(target_, attempt);
        descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0 && errno != EEXIST) {
            const int error = errno;
            temporary_.clear();
            fail(target_, "cannot be created", error);
        }
    }
    if (exists) (void)::fchmod(descriptor_, existing.st_mode & 07777);
}

OutputFile::~OutputFile()
{
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::reserve(std::uint64_t bytes) const
{
    if (is_in_place()) return;
    if (bytes > static_cast<std::uint64_t>(std::numeric_limits<off_t>::max())) fail(target_, "cannot be written", EFBIG);
    while (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(bytes)) != 0) {
        if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG) fail(target_, "cannot be written", errno);
        if (errno != EINTR) return;  // no file system that can tell
        check_interrupt();
    }
}

void OutputFile::rewrite(std::size_t offset, std::string_view bytes) const
{
    while (!bytes.empty()) {
        const ssize_t written = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
        if (written >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(written));
            offset += static_cast<std::size_t>(written);
        } else if (errno == EINTR) {
            check_interrupt();
        } else {
            fail(target_, "cannot be written", errno);
        }
    }
}

void OutputFile::close()
{
    if (descriptor_ < 0) return;
    // Delayed allocation and network file systems report a full disk only here. Pipes and devices
    // cannot be synchronised (EINVAL), which is no failure.
    if (!temporary_.empty() && ::fsync(descriptor_) != 0 && errno != EINVAL) fail(target_, "cannot be written", errno);
    const int closed = ::close(descriptor_);
    descriptor_ = -1;
    if (closed != 0) fail(target_, "cannot be written", errno);
}

void OutputFile::commit()
{
    close();
    if (temporary_.empty()) return;
    const std::filesystem::path complete = std::exchange(temporary_, {});
    if (::rename(complete.c_str(), target_.c_str()) == 0) return;
    const std::string why = std::generic_category().message(errno);
    std::error_code unknown;
    const bool is_there = std::filesystem::exists(complete, unknown);
    throw InputError(target_, fmt::format("cannot be created: {}; all that was to be in it {} {}", why,
                                          is_there ? "is in" : "is lost, as somebody removed", complete.string()));
}

}  // namespace fastccd::tools
