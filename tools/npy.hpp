// Pairs in numpy's .npy files (format: numpy.lib.format, versions 1.0, 2.0 and 3.0).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fastccd/pair_view.hpp>

#include "mapped_file.hpp"
#include "output_file.hpp"

namespace fastccd::tools {

/// What the header of a .npy file of pairs says.
struct NpyHeader {
    PairView::Layout layout;  ///< interleaved for shape (N,8,3), blocked for (B,24,8).
    PairView::Scalar scalar;  ///< float64 for '<f8', float32 for '<f4'.
    std::size_t pairs;        ///< N, or 8 B.
    std::size_t data_offset;  ///< Bytes before the array.
};

/// Reads and checks the header of the file whose contents are `bytes`: C order, little-endian
/// float64 or float32, shape (N,8,3) or (B,24,8), and exactly the bytes of that array after it.
/// Throws InputError naming `path` otherwise. Safe on any input.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view bytes, const std::filesystem::path& path);

/// A memory-mapped .npy file of pairs.
///
/// Shape (N,8,3): record i is pair i, points x0..x3 at t = 0, then at t = 1. Shape (B,24,8): blocks
/// of fastccd::PairBuffer; the file cannot say how many lanes of the last block are padding, so it
/// holds 8 B pairs.
class NpyPairs {
public:
    /// Throws InputError, as parse_npy_header and MappedFile.
    explicit NpyPairs(const std::filesystem::path& path);

    /// The pairs; valid as long as this object.
    [[nodiscard]] const PairView& view() const noexcept { return view_; }

    /// Gets pairs [begin, end) off the disk: see MappedFile::load.
    void load(std::size_t begin, std::size_t end) const;

private:
    MappedFile file_;
    std::size_t data_offset_ = 0;
    PairView view_;
};

/// Writes float64 pairs to a .npy file that appears on commit() (see OutputFile).
class NpyWriter {
public:
    /// `layout`: interleaved for shape (N,8,3); blocked for (B,24,8), where `pairs` is to be a
    /// multiple of 8. No `pairs`: as many as will be appended, interleaved, to a regular file. Throws
    /// InputError.
    NpyWriter(const std::filesystem::path& path, PairView::Layout layout, std::optional<std::size_t> pairs);

    /// Appends pairs, of any layout; for the blocked one a multiple of 8 at a time, or std::logic_error. Throws InputError.
    void append(const PairView& pairs);

    /// Nothing more is appended: see OutputFile::close. Throws InputError; std::logic_error if not
    /// exactly the promised number of pairs was appended.
    void close();

    /// Closes, and makes the file appear. Throws as close().
    void commit();

private:
    OutputFile file_;
    PairView::Layout layout_;
    std::optional<std::size_t> promised_;
    std::size_t appended_ = 0;
    bool closed_ = false;
};

}  // namespace fastccd::tools
