// The list of contacts as CSV.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include <fastccd/options.hpp>

#include "row_file.hpp"

namespace fastccd::tools {

/// Columns `pair,toi`: pairs in contact with their time of impact in 17 significant digits (which
/// read back to the same double), invalid pairs with `nan`, in pair order. Appears on commit(): see
/// OutputFile, also for the meaning of "-". With `proof` a third column, `proven`: 1 or 0; empty for invalid pairs.
class HitsFile {
public:
    /// Throws InputError.
    HitsFile(const std::filesystem::path& path, bool proof);

    /// Appends one piece of the pairs: contacts and invalid pairs, each in ascending order, numbered
    /// from `first_pair`. Throws as OutputFile::write.
    void append(std::span<const Contact> contacts, std::span<const std::size_t> invalid, std::size_t first_pair);

    /// Throws as OutputFile::write and OutputFile::commit.
    void commit() { rows_.commit(); }

private:
    RowFile rows_;
    bool proof_;
};

}  // namespace fastccd::tools
