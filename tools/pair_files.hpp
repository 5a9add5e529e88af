// Files of pairs as one long sequence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <fastccd/pair_view.hpp>

#include "common_options.hpp"
#include "rational_csv.hpp"

namespace fastccd::tools {

/// .npy and rational .csv files, whose pairs are numbered on from one to the next. Constructed
/// whole: every file is opened and checked (and CSV read) before any pair is answered.
class PairFiles {
public:
    /// Throws InputError.
    PairFiles(const std::vector<std::string>& paths, Rounding rounding);
    ~PairFiles();

    /// Number of pairs in all files.
    [[nodiscard]] std::size_t size() const noexcept { return size_; }

    /// Of each file, the number of its first pair.
    [[nodiscard]] std::vector<std::size_t> first_pairs() const;

    /// Called with some pairs, the number of the first of them, and their truth or nothing.
    using Visitor = std::function<void(const PairView&, std::size_t, std::span<const std::int8_t>)>;

    /// Calls `visit` for all pairs of `range`, in order, at most `chunk` (a multiple of 8) at a time.
    /// Throws InputError when a file can no longer be read; `visit` is to call check_mapped_files() once it has read the pairs.
    void for_each_chunk(const PairRange& range, std::size_t chunk, const Visitor& visit) const;

private:
    struct File;

    std::vector<File> files_;
    std::size_t size_ = 0;
};

}  // namespace fastccd::tools
