// Read-only memory map of a whole file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace fastccd::tools {

class MappedFile {
public:
    /// Maps the file. Throws InputError if it is missing, unreadable or not a regular file.
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();

    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&&) = delete;

    [[nodiscard]] std::string_view bytes() const noexcept { return {data_, size_}; }

    /// Reads [offset, offset + length) into memory now, and asks the system to start on what follows
    /// in the background. Throws InputError if the file has been cut short or its disk fails, either
    /// of which would otherwise end the process with SIGBUS on access. (Where the system is too old
    /// to do this, pages are read on access.)
    void load(std::size_t offset, std::size_t length) const;

private:
    std::filesystem::path path_;
    const char* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace fastccd::tools
