#include "mapped_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace fastccd::tools {

/// Those in use are in one list, since a handler knows no more of a fault than its address.
struct MappedFile::Map {
    std::filesystem::path path;
    char* data = nullptr;
    std::size_t size = 0;
    std::atomic<std::size_t> lost_from;  ///< The first byte in whose place there are zeros now, or `size`.
    Map* next = nullptr;

    static std::atomic<Map*> first;

    static void replace_lost_page(int signal, siginfo_t* fault, void*);
};
std::atomic<MappedFile::Map*> MappedFile::Map::first;
static_assert(std::atomic<std::size_t>::is_always_lock_free && std::atomic<void*>::is_always_lock_free);

namespace {

const auto page_size = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));

constexpr const char* lost = "the file was cut short meanwhile, or its disk fails";

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

/// Of SIGBUS, in the thread that reads. mmap is a plain system call on Linux. Whatever else raises this signal ends the process, as before.
void MappedFile::Map::replace_lost_page(int signal, siginfo_t* fault, void*)
{
    const int error = errno;
    const auto address = reinterpret_cast<std::uintptr_t>(fault->si_addr);
    for (Map* map = first.load(); map != nullptr; map = map->next) {
        const auto start = reinterpret_cast<std::uintptr_t>(map->data);
        if (fault->si_code <= 0 || address < start || address - start >= map->size) continue;
        const std::size_t page = (address - start) / page_size * page_size;
        // All that follows, as it is gone, too, if the file was cut short, and no longer asked for in any case.
        if (::mmap(map->data + page, map->size - page, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) == MAP_FAILED) break;
        for (std::size_t known = map->lost_from.load(); page < known && !map->lost_from.compare_exchange_weak(known, page);) {}
        errno = error;
        return;
    }
    (void)std::signal(signal, SIG_DFL);
    (void)std::raise(signal);  // once this returns
}

MappedFile::MappedFile(const std::filesystem::path& path)
{
    // O_NONBLOCK: opening a pipe nobody writes to must not hang before it can be refused.
    const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (file.value < 0) throw InputError(path, "cannot be opened: " + reason(errno));
    struct stat status {};
    if (::fstat(file.value, &status) != 0) throw InputError(path, "cannot be read: " + reason(errno));
    if (S_ISDIR(status.st_mode)) throw InputError(path, "is a directory; name the files in it");
    if (!S_ISREG(status.st_mode)) throw InputError(path, "is not a regular file; what comes through a pipe has to be written to a file first");
    if (status.st_size == 0) return;  // an empty map is an error to the system, an empty file is none to us

    static const bool handled = [] {
        struct sigaction action {};
        action.sa_sigaction = Map::replace_lost_page;
        action.sa_flags = SA_SIGINFO;
        return ::sigaction(SIGBUS, &action, nullptr) == 0;
    }();
    (void)handled;

    const auto size = static_cast<std::size_t>(status.st_size);
    auto map = std::make_unique<Map>();
    map->path = path;
    map->size = size;
    map->lost_from = size;
    void* const data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.value, 0);
    if (data == MAP_FAILED) throw InputError(path, "cannot be mapped into memory: " + reason(errno));
    map->data = static_cast<char*>(data);
    map->next = Map::first;
    Map::first = map.get();
    map_ = std::move(map);
}

MappedFile::~MappedFile()
{
    if (!map_) return;
    Map* before = Map::first;
    if (before == map_.get()) {
        Map::first = map_->next;
    } else {
        while (before->next != map_.get()) before = before->next;
        before->next = map_->next;
    }
    ::munmap(map_->data, map_->size);
}

MappedFile::MappedFile(MappedFile&& other) noexcept = default;

std::string_view MappedFile::bytes() const noexcept
{
    return map_ ? std::string_view{map_->data, map_->size} : std::string_view{};
}

void MappedFile::load(std::size_t offset, std::size_t length) const
{
    if (!map_ || length == 0) return;
    const std::size_t size = map_->size;
    const std::size_t begin = offset / page_size * page_size;
    const std::size_t end = std::min(offset + length, size);
#ifdef MADV_POPULATE_READ
    if (::madvise(map_->data + begin, end - begin, MADV_POPULATE_READ) != 0 && (errno == EFAULT || errno == EHWPOISON))
        throw InputError(map_->path, fmt::format("cannot be read between bytes {} and {}: {}", begin, end, lost));
#endif
    const std::size_t next = std::min(end / page_size * page_size, size);
    (void)::madvise(map_->data + next, std::min(length, size - next), MADV_WILLNEED);
}

void check_mapped_files()
{
    for (const MappedFile::Map* map = MappedFile::Map::first; map != nullptr; map = map->next) {
        const std::size_t from = map->lost_from;
        if (from < map->size) throw InputError(map->path, fmt::format("cannot be read from byte {} on: {}", from, lost));
    }
}

}  // namespace fastccd::tools
