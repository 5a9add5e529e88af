// Output that is complete or absent.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace fastccd::tools {

/// Writes all of `bytes` to `descriptor`. Throws InputError naming `name` when that fails,
/// BrokenPipe when the reader is gone, Interrupted on a signal.
void write_all(int descriptor, std::string_view bytes, const std::filesystem::path& name);

/// A file that appears under its name complete or not at all: bytes go to a temporary file in the
/// same directory, renamed over the target by commit() and removed by the destructor otherwise.
///
/// "-" is standard output. It and other descriptors of this process ("/dev/stdout", "/dev/fd/3") are written where
/// they stand; other devices and pipes are written directly, since nothing can be renamed over them.
class OutputFile {
public:
    /// Opens the output. Throws InputError when it cannot be created, is a directory, or is an
    /// existing file without write permission or one that cannot be replaced.
    explicit OutputFile(const std::filesystem::path& target);
    ~OutputFile();

    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// True if `target` names standard output.
    [[nodiscard]] static bool is_standard_output(const std::filesystem::path& target);

    /// Where a file of this name comes to lie, links followed, be it there yet or not: two targets of one place are one file.
    [[nodiscard]] static std::filesystem::path place(const std::filesystem::path& target);

    /// So many bytes are going to be written. Throws InputError if it is certain that there is no room for them.
    void reserve(std::uint64_t bytes) const;

    /// Appends, unbuffered: pass large pieces. Throws as write_all.
    void write(std::string_view bytes) const { write_all(descriptor_, bytes, target_); }

    /// Whether bytes go to a pipe, a device or a descriptor, where what is written stays.
    [[nodiscard]] bool is_in_place() const { return temporary_.empty(); }

    /// Replaces bytes written before, of a file that is not written in place. Throws InputError.
    void rewrite(std::size_t offset, std::string_view bytes) const;

    /// Nothing more is to be written: all of it is put on the disk, the file not yet under its name. Of many
    /// files that are to appear together, this frees the descriptors. Throws InputError.
    void close();

    /// Makes the file appear under its name. Throws InputError; if all is written and only the name cannot be given, the
    /// temporary file stays, and the error names it.
    void commit();

private:
    std::filesystem::path target_;
    std::filesystem::path temporary_;  // empty: written in place, or committed
    int descriptor_ = -1;
};

}  // namespace fastccd::tools
