#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "oracle/pair.hpp"

namespace fastccd::testing {

/// The folder with scenes/, queries/ and hardcases/: the environment variable FASTCCD_DATA if it is set and not empty, else
/// shared/data beside the repository. Empty if that is no folder. Tests that need it must then say that they are skipped:
/// GTEST_SKIP() << no_data_message.
std::optional<std::filesystem::path> data_directory();

inline constexpr const char* no_data_message =
    "NO DATA: set FASTCCD_DATA to the folder that holds scenes/, queries/ and hardcases/; nothing was checked here";

/// Pairs with known answers.
struct QuerySet {
    std::string name;  ///< file name, with the folders below the data folder
    oracle::Kind kind = oracle::Kind::vertex_face;
    std::vector<oracle::Pair> pairs;
    std::vector<int> truth;  ///< 1 contact in [0, 1], 0 none; as long as `pairs`
    /// The exact first time of contact is in [t_lo, t_hi], equal or neighbouring doubles; +inf without contact.
    /// Empty where the file does not give times.
    std::vector<double> t_lo, t_hi;
};

/// All `hardcases/NAME_{vf,ee}.npy` (float64 (N,8,3)) with `NAME_xx.truth.npy` (float64 (N,3): contact, t_lo, t_hi),
/// in order of names. Throws std::runtime_error for a file that is not what it should be.
std::vector<QuerySet> load_hardcases(const std::filesystem::path& data);

/// All `queries/**/{vertex-face,edge-edge}/*.csv` in order of names: 8 rows a query, columns x numerator,
/// x denominator, y.., z.., truth. Throws std::runtime_error for a malformed file, or a coordinate that is not exactly
/// a double.
std::vector<QuerySet> load_queries(const std::filesystem::path& data);

}  // namespace fastccd::testing
