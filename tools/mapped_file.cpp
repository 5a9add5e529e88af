#include "mapped_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "input_error.hpp"

namespace fastccd::tools {
namespace {

std::string reason(int error)
{
    return std::generic_category().message(error);
}

/// Closes a descriptor at the end of a scope; a map outlives it.
struct Descriptor {
    int value;
    ~Descriptor()
    {
        if (value >= 0) ::close(value);
    }
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) : path_{path}
{
    // O_NONBLOCK: opening a pipe nobody writes to must not hang before it can be refused.
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.value < 0) throw InputError(path, "cannot be opened: " + reason(errno));
    struct stat status {};
    if (::fstat(file.value, &status) != 0) throw InputError(path, "cannot be read: " + reason(errno));
    if (S_ISDIR(status.st_mode)) throw InputError(path, "is a directory; name the files in it");
    if (!S_ISREG(status.st_mode)) throw InputError(path, "is not a regular file; what comes through a pipe has to be written to a file first");
    size_ = static_cast<std::size_t>(status.st_size);
    if (size_ == 0) return;  // an empty map is an error to the system, an empty file is none to us
    void* const map = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file.value, 0);
    if (map == MAP_FAILED) throw InputError(path, "cannot be mapped into memory: " + reason(errno));
    data_ = static_cast<const char*>(map);
}

MappedFile::~MappedFile()
{
    if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : path_{std::move(other.path_)}, data_{std::exchange(other.data_, nullptr)}, size_{std::exchange(other.size_, 0)}
{
}

void MappedFile::load(std::size_t offset, std::size_t length) const
{
    if (data_ == nullptr || length == 0) return;
    static const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    const std::size_t begin = offset / page * page;
    const std::size_t end = std::min(offset + length, size_);
    char* const start = const_cast<char*>(data_) + begin;
#ifdef MADV_POPULATE_READ
    if (::madvise(start, end - begin, MADV_POPULATE_READ) != 0 && (errno == EFAULT || errno == EHWPOISON)) {
        throw InputError(path_, fmt::format("cannot be read between bytes {} and {}: "
                                            "the file was cut short meanwhile, or its disk fails",
                                            begin, end));
    }
#endif
    const std::size_t next = std::min(end / page * page, size_);
    (void)::madvise(const_cast<char*>(data_) + next, std::min(length, size_ - next), MADV_WILLNEED);
}

}  // namespace fastccd::tools
