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

SavedPairs::SavedPairs(const fs::path& folder, std::size_t steps) : folder_{folder}, steps_{steps}
{
    std::set<std::string> own;
    for (std::size_t step = 0; step < steps; ++step) {
        for (const PairKind kind : {PairKind::vertex_face, PairKind::edge_edge}) own.insert(file_name(step, kind));
    }
    create_folder();
    std::error_code error;
    for (fs::directory_iterator entry{folder_, error}, end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        if (!is_name_of_pairs(name) || own.contains(name)) continue;
        throw InputError(entry->path(), "holds pairs of another scene, which this one's would be mixed up with; "
                                        "name an empty folder");
    }
    if (error) throw InputError(folder_, fmt::format("cannot be read: {}", error.message()));
}

SavedPairs::~SavedPairs()
{
    if (committed_) return;
    files_.clear();  // and with them their temporary files, so that the folders are empty
    std::error_code somebody_else_uses_it;
    for (auto folder = created_.rbegin(); folder != created_.rend(); ++folder) {
        fs::remove(*folder, somebody_else_uses_it);
    }
}

void SavedPairs::create_folder()
{
    std::error_code error;
    std::vector<fs::path> missing;
    for (fs::path path = folder_; !path.empty() && !fs::exists(path, error); path = path.parent_path()) {
        if (path.has_filename()) missing.push_back(path);
    }
    std::reverse(missing.begin(), missing.end());
    for (const fs::path& path : missing) {
        if (fs::create_directory(path, error)) created_.push_back(path);
        if (!error) continue;
        const std::string reason = error.message();
        for (auto made = created_.rbegin(); made != created_.rend(); ++made) fs::remove(*made, error);
        throw InputError(folder_, fmt::format("cannot be created: {}", reason));
    }
    if (!fs::is_directory(folder_, error)) throw InputError(folder_, "is no folder, which the pairs need");
}

std::string SavedPairs::file_name(std::size_t step_number, PairKind kind) const
{
    // As many digits as the last step has: names sort in the order of the steps.
    const std::size_t digits = std::max<std::size_t>(3, std::to_string(steps_ - 1).size());
    return fmt::format("step_{:0{}}_{}.npy", step_number, digits, kind == PairKind::vertex_face ? "vf" : "ee");
}

void SavedPairs::begin(std::size_t step_number, PairKind kind)
{
    if (!files_.empty()) files_.back().close();
    files_.emplace_back(folder_ / file_name(step_number, kind), PairView::Layout::interleaved, std::nullopt);
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
    committed_ = true;
}

}  // namespace fastccd::tools
