// Rows of text, such as CSV, that are complete or absent.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iterator>

#include <fmt/compile.h>

#include "output_file.hpp"

namespace fastccd::tools {

/// Collects rows into large pieces for an OutputFile, whose meaning of "-" it has.
class RowFile {
public:
    /// Throws InputError.
    explicit RowFile(const std::filesystem::path& path) : file_{path} {}

    /// A row, by a format of FMT_COMPILE. Throws as OutputFile::write.
    template <class Format, class... Values>
    void append(const Format& format, const Values&... values)
    {
        fmt::format_to(std::back_inserter(text_), format, values...);
        if (text_.size() >= piece_size) flush();
    }

    /// Throws as OutputFile::write and OutputFile::commit.
    void commit()
    {
        flush();
        file_.commit();
    }

private:
    static constexpr std::size_t piece_size = std::size_t{1} << 20;

    OutputFile file_;
    fmt::memory_buffer text_;

    void flush()
    {
        file_.write({text_.data(), text_.size()});
        text_.clear();
    }
};

}  // namespace fastccd::tools
