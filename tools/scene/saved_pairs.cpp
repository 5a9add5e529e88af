#include "saved_pairs.hpp"

#include <algorithm>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "../input_error.hpp"
#include "pair_vertices.hpp"

namespace fastccd::tools {
namespace fs = std::filesystem;

bool SavedPairs::is_name_of_pairs(const std::string& name)
{
    return name.starts_with("step_") && (name.ends_with("_vf.npy") || name.ends_with("_ee.npy"));
}

std::vector<std::string> SavedPairs::file_names(std::size_t steps)
{
    // As many digits as the last step has: names sort in the order of the steps.
    const std::size_t digits = std::max<std::size_t>(3, std::to_string(steps - 1).size());
    std::vector<std::string> names;
    for (std::size_t step = 0; step < steps; ++step)
        for (const char* const kind : {"vf", "ee"}) names.push_back(fmt::format("step_{:0{}}_{}.npy", step, digits, kind));
    return names;
}

SavedPairs::SavedPairs(const fs::path& folder, std::size_t steps) : folder_{folder}, names_{file_names(steps)}, new_folder_{folder}
{
    const std::set<std::string> own(names_.begin(), names_.end());
    std::error_code error;
    for (fs::directory_iterator entry{folder_, error}, end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!is_name_of_pairs(name) || own.contains(name)) continue;
        throw InputError(entry->path(), "holds pairs of another scene, which this one's would be mixed up with; "
                                        "name an empty folder");
    }
    if (error) throw InputError(folder_, fmt::format("cannot be read: {}", error.message()));
}

void SavedPairs::begin(std::size_t step_number, PairKind kind)
{
    if (!files_.empty()) files_.back().close();
    const std::string& name = names_[2 * step_number + (kind == PairKind::vertex_face ? 0 : 1)];
    files_.emplace_back(folder_ / name, PairView::Layout::interleaved, std::nullopt);
}

template <class Pair>
void SavedPairs::append_pairs(const Step& step, std::span<const Pair> pairs)
{
    constexpr std::size_t most_pairs = 4096;  // written at a time: 768 KiB
    while (!pairs.empty()) {
        const std::span<const Pair> piece = pairs.first(std::min(most_pairs, pairs.size()));
        pairs = pairs.subspan(piece.size());
        records_.resize(piece.size() * pair_coordinates);
        double* out = records_.data();
        for (const Pair& pair : piece) {
            for (const std::span<const double> positions : {step.positions0, step.positions1}) {
                for (const std::int32_t vertex : pair_vertices(step, pair)) {
                    out = std::copy_n(&positions[3 * static_cast<std::size_t>(vertex)], 3, out);
                }
            }
        }
        files_.back().append(PairView::interleaved(records_.data(), piece.size()));
    }
}

template void SavedPairs::append_pairs(const Step& step, std::span<const VertexFace> pairs);
template void SavedPairs::append_pairs(const Step& step, std::span<const EdgeEdge> pairs);

void SavedPairs::close()
{
    if (!files_.empty()) files_.back().close();
}

void SavedPairs::commit()
{
    for (NpyWriter& file : files_) file.commit();
}

}  // namespace fastccd::tools
