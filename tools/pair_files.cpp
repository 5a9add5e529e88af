#include "pair_files.hpp"

#include <algorithm>
#include <cctype>
#include <utility>
#include <variant>

#include <fastccd/pair_buffer.hpp>

#include "input_error.hpp"
#include "mapped_file.hpp"
#include "npy.hpp"
#include "pair_slice.hpp"

namespace fastccd::tools {
namespace {

std::variant<NpyPairs, RationalCsv> open(const std::filesystem::path& path, Rounding rounding)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".npy") return NpyPairs{path};
    if (extension == ".csv") return read_rational_csv(path, rounding);
    const MappedFile readable{path};  // says that a file is missing, or a directory
    throw InputError(path, "is of an unknown kind; pairs are read from files whose names end in .npy or .csv, not through pipes");
}

}  // namespace

struct PairFiles::File {
    std::variant<NpyPairs, RationalCsv> contents;
    std::size_t first_pair;

    [[nodiscard]] PairView view() const
    {
        const NpyPairs* const npy = std::get_if<NpyPairs>(&contents);
        return npy != nullptr ? npy->view() : std::get<RationalCsv>(contents).pairs.view();
    }

    [[nodiscard]] std::span<const std::int8_t> truth(std::size_t begin, std::size_t end) const
    {
        const RationalCsv* const csv = std::get_if<RationalCsv>(&contents);
        if (csv == nullptr || csv->truth.empty()) return {};
        return std::span{csv->truth}.subspan(begin, end - begin);
    }

    /// Visits pairs [begin, end) of this file, which fit one chunk.
    void visit(std::size_t begin, std::size_t end, const Visitor& visitor) const
    {
        if (const NpyPairs* const npy = std::get_if<NpyPairs>(&contents)) npy->load(begin, end);
        const bool within_block = view().layout() == PairView::Layout::blocked && begin % block_pairs != 0;
        if (within_block) {
            const PairBuffer copy = copy_pairs(view(), begin, end);
            visitor(copy.view(), first_pair + begin, truth(begin, end));
        } else {
            visitor(slice(view(), begin, end), first_pair + begin, truth(begin, end));
        }
    }
};

PairFiles::PairFiles(const std::vector<std::string>& paths, Rounding rounding)
{
    files_.reserve(paths.size());
    for (const std::string& path : paths) {
        files_.push_back({.contents = open(path, rounding), .first_pair = size_});
        size_ += files_.back().view().size();
    }
}

PairFiles::~PairFiles() = default;

std::vector<std::size_t> PairFiles::first_pairs() const
{
    std::vector<std::size_t> numbers;
    for (const File& file : files_) numbers.push_back(file.first_pair);
    return numbers;
}

void PairFiles::for_each_chunk(const PairRange& range, std::size_t chunk, const Visitor& visit) const
{
    for (const File& file : files_) {
        const std::size_t file_end = file.first_pair + file.view().size();
        std::size_t begin = std::clamp(range.begin, file.first_pair, file_end) - file.first_pair;
        const std::size_t end = std::clamp(range.end, file.first_pair, file_end) - file.first_pair;
        while (begin < end) {
            // A start within a block: the rest of it alone, so that all that follows needs no copy.
            const std::size_t next = begin % block_pairs != 0 ? (begin / block_pairs + 1) * block_pairs : begin + chunk;
            file.visit(begin, std::min(next, end), visit);
            begin = std::min(next, end);
        }
    }
}

}  // namespace fastccd::tools
