// How much a report does, and how far it is.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <fastccd/options.hpp>

#include "../progress.hpp"

namespace fastccd::tools::report {

inline constexpr std::array<double, 8> tolerances{1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13};
inline constexpr std::array<PairKind, 2> kinds{PairKind::vertex_face, PairKind::edge_edge};
/// Of the random pairs everywhere in the report, and of the hard pairs.
inline constexpr std::uint64_t seed = 1;

struct Plan {
    bool quick = false;
    std::size_t pairs = 0;                      ///< Random pairs of Table 1; at most so many wherever pairs are sampled.
    std::optional<std::filesystem::path> data;  ///< Folder with hardcases/, queries/ and scenes/, as far as they are there.

    [[nodiscard]] std::size_t repeats() const { return quick ? 3 : 7; }
    /// Random pairs that are timed with every instruction set and E_tol.
    [[nodiscard]] std::size_t speed_pairs() const { return at_most(quick ? 262'144 : 1'048'576); }
    /// Of these, the first so many have exact truth.
    [[nodiscard]] std::size_t truth_pairs() const { return at_most(quick ? 65'536 : 262'144); }
    [[nodiscard]] std::size_t hard_pairs() const { return at_most(quick ? 400 : 2'000); }
    [[nodiscard]] int cloth_size() const { return pairs < 100'000 ? 40 : quick ? 150 : 300; }
    [[nodiscard]] int cloth_frames() const { return quick ? 4 : 12; }
    /// Random pairs of the scaling over threads.
    [[nodiscard]] std::size_t thread_pairs() const { return at_most(quick ? 1'000'000 : 4'000'000); }
    /// Where the scaling over pairs ends.
    [[nodiscard]] std::size_t most_pairs() const { return 10 * pairs; }

private:
    [[nodiscard]] std::size_t at_most(std::size_t usual) const { return pairs < usual ? pairs : usual; }
};

/// The bar over all parts. Where it is no terminal, a line for each part.
class ReportProgress {
public:
    explicit ReportProgress(bool enabled) : enabled_{enabled}, bar_{units, enabled} {}

    /// The next part, which takes about the given share of the whole.
    void begin(const std::string& name, double share);

    /// So much of the part is done. Throws Interrupted after a signal.
    void move(std::size_t done, std::size_t total);

private:
    static constexpr std::size_t units = 10'000;

    void move_to(double share);

    bool enabled_;
    Progress bar_;
    double part_begin_ = 0, part_end_ = 0;
    std::size_t done_ = 0;
};

}  // namespace fastccd::tools::report
