// Read-only memory map of a whole file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

#include "input_error.hpp"

namespace fastccd::tools {

/// A page that is read after its file was cut short, or whose disk fails, would end the process with SIGBUS. A handler of that signal puts
/// zeros in its place instead, and check_mapped_files() tells of it. Files are not mapped or unmapped while another thread reads one.
class MappedFile {
public:
    /// Maps the file. Throws InputError if it is missing, unreadable or not a regular file.
    explicit MappedFile(const std::filesystem::path& path);
    ~MappedFile();

    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&&) = delete;

    [[nodiscard]] std::string_view bytes() const noexcept;

    /// Reads [offset, offset + length) into memory now, and asks the system to start on what follows in the background. Throws InputError if
    /// the file has been cut short or its disk fails. (Where the system is too old to do this, pages are read on access.)
    void load(std::size_t offset, std::size_t length) const;

    /// What `parse` makes of bytes(). If zeros were read in their place, throws InputError that says so, not what is wrong with these.
    template <class Parse>
    auto parsed(Parse parse) const;

private:
    struct Map;
    std::unique_ptr<Map> map_;

    friend void check_mapped_files();
};

/// To be called when bytes of mapped files have been read, and before anything is made of them: throws InputError, naming the file, if zeros
/// were read in their place.
void check_mapped_files();

template <class Parse>
auto MappedFile::parsed(Parse parse) const
{
    try {
        auto result = parse(bytes());
        check_mapped_files();
        return result;
    } catch (const InputError&) {
        check_mapped_files();
        throw;
    }
}

}  // namespace fastccd::tools
