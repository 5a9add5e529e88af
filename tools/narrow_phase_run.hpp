// The narrow phase over more pairs than one call takes: totals, contacts to a file, time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fastccd/fastccd.hpp>

#include "common_options.hpp"

namespace fastccd::tools {

class HitsFile;
class Progress;

/// Pairs read or made at a time, and the most that are answered at a time: a multiple of 8, and so many (48 MiB
/// of packed pairs) that threads rarely wait for the last of them.
inline constexpr std::size_t chunk_pairs = std::size_t{1} << 18;

/// How many pairs are answered at a time, so that Ctrl-C and the progress bar hardly ever wait long: a pair takes nanoseconds, with exact
/// verdicts some hundred microseconds, and a second where its coordinates are of extremely different sizes.
class PieceSize {
public:
    /// Multiples of 8. The library divides no fewer than `undivided` pairs among threads.
    static constexpr std::size_t least = 8, undivided = 64, most = chunk_pairs;

    explicit PieceSize(int threads) : threads_{static_cast<std::size_t>(threads)} {}

    [[nodiscard]] std::size_t pairs() const noexcept { return pairs_; }

    /// After a piece of `pairs` pairs. Twice as many are next if these can be expected to leave a fifth of the tenth of a second to spare.
    void took(std::size_t pairs, double seconds) noexcept
    {
        constexpr double longest = 0.1;
        if (seconds > longest) {
            pairs_ = std::max(least, pairs_ / 4);
        } else if (pairs >= pairs_ && pairs_ < most && seconds * 2 * busy(pairs_) / busy(2 * pairs_) < 0.8 * longest) {
            pairs_ *= 2;
        }
    }

private:
    /// Threads that so many pairs keep busy. While there are others, twice the pairs take no longer.
    [[nodiscard]] double busy(std::size_t pairs) const noexcept
    {
        return static_cast<double>(std::min(threads_, (pairs + undivided - 1) / undivided));
    }

    std::size_t threads_, pairs_ = undivided;
};
static_assert(PieceSize::least % 8 == 0 && PieceSize::undivided % PieceSize::least == 0 && PieceSize::most % PieceSize::undivided == 0);

/// What is asked, for the report.
struct Question {
    std::string source;                  ///< The pairs' origin, for people: "10 random pairs, seed 1".
    std::size_t pairs = 0;               ///< How many pairs run_narrow_phase is going to answer.
    std::vector<std::string> files = {};
    std::vector<std::size_t> first_pairs = {};  ///< Of each file, the number of its first pair.
    std::optional<std::uint64_t> seed = {};
    std::optional<PairRange> range = {};  ///< Given when not all pairs of the files were asked for.
};

/// Comparison with known answers, for pairs that have one.
struct TruthTotals {
    std::size_t pairs = 0;
    std::size_t missed = 0;        ///< Contact in truth, not reported.
    std::size_t false_alarms = 0;  ///< Reported, none in truth.
};

struct Totals {
    Summary summary;
    std::optional<TruthTotals> truth;
    std::vector<std::size_t> first_invalid;  ///< The first few invalid pairs.
    double seconds = 0;                      ///< Time inside the narrow phase alone.
    int threads = 1;
};

/// Throws CLI::ValidationError if FASTCCD_ISA or a build without the exact verdict is at fault, std::logic_error for any other error: options
/// are checked when they are parsed, and the program's own arrays fit each other.
void throw_unless_ok(const Status& status);

/// The kernels that run with these options. Throws CLI::ValidationError if FASTCCD_ISA names none.
[[nodiscard]] Isa resolve_isa(const Options& options);

/// Invalid pairs that the report names; --hits has all.
inline constexpr std::size_t most_invalid_named = 10;

/// Answers the pairs of a file, a generator or a scene piece by piece, in pair order.
class NarrowPhaseRun {
public:
    /// `hits`, `progress`: may be null.
    NarrowPhaseRun(const PairOptions& options, HitsFile* hits, Progress* progress);

    /// Answers `pairs`, blocked or interleaved, numbered from `first_pair`. `truth`, when not empty, has the known answer (1:
    /// contact in [0, 1]) of each. Throws Interrupted after a signal, InputError if --hits fails.
    void answer(const PairView& pairs, std::size_t first_pair, std::span<const std::int8_t> truth = {});

    [[nodiscard]] const Totals& totals() const noexcept { return totals_; }

private:
    void answer_piece(const PairView& pairs, std::size_t first_pair, std::span<const std::int8_t> truth);
    void find(const PairView& pairs, Summary& summary);
    void find_with_roots(const PairView& pairs, Summary& summary);
    void compare(std::span<const std::int8_t> truth);

    const PairOptions& options_;
    HitsFile* hits_;
    Progress* progress_;
    Totals totals_;
    PieceSize piece_size_;
    // Of the current piece, numbered from its first pair; kept to reuse their memory.
    std::vector<Contact> contacts_;
    std::vector<std::size_t> invalid_;
    std::vector<double> toi_;
    std::vector<std::uint8_t> roots_;
};

/// Runs `feed`, which calls answer() for all pairs of `question`, on the threads asked for, with
/// progress bar and hits file. Nothing stays behind under the name of the hits file if any of it throws.
[[nodiscard]] Totals run_narrow_phase(const PairOptions& options, const Question& question,
                                      const std::function<void(NarrowPhaseRun&)>& feed);

}  // namespace fastccd::tools
