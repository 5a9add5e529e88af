// The candidates of a scene with their coordinates, for `fastccd run`.
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <fastccd/options.hpp>

#include "../new_folder.hpp"
#include "../npy.hpp"
#include "broad_phase.hpp"

namespace fastccd::tools {

/// A folder of .npy files of pairs, two a step: step_000_vf.npy, step_000_ee.npy, step_001_vf.npy and so
/// on, in the order of the candidates. They appear together on commit(); before, and if that never
/// comes, nothing does, not even the folder if it is new.
class SavedPairs {
public:
    /// Creates the folder if need be. Throws InputError when that fails, or when the folder holds pairs of
    /// steps that this scene does not have: both would be taken for one scene.
    SavedPairs(const std::filesystem::path& folder, std::size_t steps);

    /// Of a scene of so many steps, in the order in which they are begun.
    [[nodiscard]] static std::vector<std::string> file_names(std::size_t steps);

    /// Whether a file of this name may be one of pairs, of this scene or another.
    [[nodiscard]] static bool is_name_of_pairs(const std::string& name);

    /// Closes the file before, begins the next: steps in order, vertex-face before edge-edge. Throws as NpyWriter.
    void begin(std::size_t step_number, PairKind kind);

    /// Appends to the file begun last. Throws InputError.
    void append(const Step& step, std::span<const VertexFace> pairs) { append_pairs(step, pairs); }
    void append(const Step& step, std::span<const EdgeEdge> pairs) { append_pairs(step, pairs); }

    /// Puts everything on the disk, so that little can go wrong in commit(). Throws as NpyWriter::close.
    void close();

    /// Makes the files appear. Throws InputError.
    void commit();

private:
    template <class Pair>
    void append_pairs(const Step& step, std::span<const Pair> pairs);

    std::filesystem::path folder_;
    std::vector<std::string> names_;
    NewFolder new_folder_;         // outlives the temporary files in it
    std::deque<NpyWriter> files_;  // closed but for the last
    std::vector<double> records_;
};

}  // namespace fastccd::tools
