#include "test_data.hpp"

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <system_error>

namespace fastccd::testing {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
    throw std::runtime_error(file.string() + ": " + what);
}

std::string read_bytes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) fail(file, "cannot be opened");
    return {std::istreambuf_iterator<char>(in), {}};
}

// A little-endian float64 array in C order, of any shape whose last dimensions are `tail`; returns the raw values.
// Header: magic "\x93NUMPY", version 1.0, uint16 length, a Python dictionary as text (NumPy Enhancement Proposal 1).
std::vector<double> read_npy(const fs::path& file, const std::string& tail) {
    static_assert(std::endian::native == std::endian::little);
    const std::string bytes = read_bytes(file);
    if (bytes.size() < 10 || bytes.compare(0, 8, std::string("\x93NUMPY\x01\x00", 8)) != 0) fail(file, "not .npy 1.0");
    std::uint16_t header_size = 0;
    std::memcpy(&header_size, bytes.data() + 8, 2);
    const std::size_t begin = 10u + header_size;
    if (bytes.size() < begin) fail(file, "the header is cut off");
    const std::string header = bytes.substr(10, header_size);
    for (const std::string& needed : {std::string("'<f8'"), std::string("'fortran_order': False"), tail}) {
        if (header.find(needed) == std::string::npos) fail(file, "expected " + needed + " in " + header);
    }
    std::vector<double> values((bytes.size() - begin) / sizeof(double));
    std::memcpy(values.data(), bytes.data() + begin, values.size() * sizeof(double));
    const std::size_t shape = header.find("'shape': (");
    if (shape == std::string::npos) fail(file, "no shape");
    std::size_t rows = 0;
    if (std::from_chars(header.data() + shape + 10, header.data() + header.size(), rows).ec != std::errc{}) fail(file, "no number of rows in " + header);
    const std::size_t row_size = tail == ", 8, 3)" ? 24 : 3;
    if (values.size() != rows * row_size) fail(file, "the size does not match the shape");
    return values;
}

// numerator / denominator as the double that it must be.
double exact_double(const fs::path& file, const std::string& numerator, const std::string& denominator) {
    mpq_class value;
    if (value.set_str(numerator + "/" + denominator, 10) != 0 || sgn(value.get_den()) <= 0) {
        fail(file, "not a fraction: " + numerator + "/" + denominator);
    }
    value.canonicalize();
    const double rounded = value.get_d();
    if (mpq_class(rounded) != value) fail(file, "not a double: " + numerator + "/" + denominator);
    return rounded;
}

QuerySet read_query_csv(const fs::path& file) {
    QuerySet set;
    std::ifstream in(file);
    if (!in) fail(file, "cannot be opened");
    std::size_t row = 0;
    const auto fail_in_row = [&](const std::string& what) {
        fail(file, "row " + std::to_string(row + 1) + ": " + what);
    };
    for (std::string line; std::getline(in, line); ++row) {
        std::array<std::string, 7> column;
        std::istringstream fields(line);
        for (std::string& field : column) {
            if (!std::getline(fields, field, ',')) fail_in_row("7 columns expected");
        }
        if (column[6] != "0" && column[6] != "1") fail_in_row("the truth must be 0 or 1");
        const int truth = column[6] == "1" ? 1 : 0;
        if (row % 8 == 0) {
            set.pairs.emplace_back();
            set.truth.push_back(truth);
        } else if (truth != set.truth.back()) {
            fail_in_row("two truths for one query");
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            set.pairs.back()[row % 8][axis] = exact_double(file, column[2 * axis], column[2 * axis + 1]);
        }
    }
    if (row % 8 != 0) fail(file, "the number of rows is no multiple of 8");
    return set;
}

std::vector<fs::path> files_below(const fs::path& folder, const std::string& extension) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == extension) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

}  // namespace

std::optional<fs::path> data_directory() {
    const char* const given = std::getenv("FASTCCD_DATA");
    const fs::path data = given != nullptr && *given != '\0' ? fs::path(given) : fs::path(FASTCCD_SOURCE_DIR) / "../shared/data";
    if (!fs::is_directory(data)) return std::nullopt;
    return data;
}

std::vector<QuerySet> load_hardcases(const fs::path& data) {
    std::vector<QuerySet> sets;
    for (const fs::path& file : files_below(data / "hardcases", ".npy")) {
        const std::string name = file.stem().string();
        if (name.ends_with(".truth")) continue;
        if (!name.ends_with("_vf") && !name.ends_with("_ee")) fail(file, "the name must end with _vf or _ee");
        const std::vector<double> coordinates = read_npy(file, ", 8, 3)");
        const std::vector<double> truth = read_npy(file.parent_path() / (name + ".truth.npy"), ", 3)");
        if (coordinates.size() / 24 != truth.size() / 3) fail(file, "pairs and truths differ in number");

        QuerySet set;
        set.name = "hardcases/" + name;
        set.kind = name.ends_with("_vf") ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
        set.pairs.resize(coordinates.size() / 24);
        std::memcpy(set.pairs.data(), coordinates.data(), coordinates.size() * sizeof(double));
        for (std::size_t i = 0; i < truth.size(); i += 3) {
            set.truth.push_back(truth[i] != 0.0 ? 1 : 0);
            set.t_lo.push_back(truth[i + 1]);
            set.t_hi.push_back(truth[i + 2]);
        }
        sets.push_back(std::move(set));
    }
    return sets;
}

std::vector<QuerySet> load_queries(const fs::path& data) {
    std::vector<QuerySet> sets;
    for (const fs::path& file : files_below(data / "queries", ".csv")) {
        const std::string folder = file.parent_path().filename().string();
        if (folder != "vertex-face" && folder != "edge-edge") fail(file, "neither in vertex-face/ nor in edge-edge/");
        QuerySet set = read_query_csv(file);
        set.name = fs::relative(file, data).string();
        set.kind = folder == "vertex-face" ? oracle::Kind::vertex_face : oracle::Kind::edge_edge;
        sets.push_back(std::move(set));
    }
    return sets;
}

}  // namespace fastccd::testing
