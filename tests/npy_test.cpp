// The .npy reader and writer: what is accepted, what is refused and with which words.
#include "npy.hpp"

#include <filesystem>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <fastccd/pair_buffer.hpp>

#include "input_error.hpp"
#include "pair_slice.hpp"

namespace fastccd::tools {
namespace {

using Layout = PairView::Layout;
using Scalar = PairView::Scalar;

/// A file as numpy would write it: version, dictionary, padding to 64 bytes, then `data_bytes` zeros.
std::string npy(const std::string& dictionary, std::size_t data_bytes, int major = 1)
{
    const std::size_t prefix = major == 1 ? 10 : 12;
    std::string text = dictionary;
    text.resize((prefix + text.size() + 1 + 63) / 64 * 64 - prefix - 1, ' ');
    text += '\n';
    std::string file{"\x93NUMPY", 6};
    file += {static_cast<char>(major), '\0'};
    for (std::size_t i = 0; i < (major == 1 ? 2U : 4U); ++i) file += static_cast<char>(text.size() >> (8 * i) & 0xff);
    return file + text + std::string(data_bytes, '\0');
}

std::string dictionary(const std::string& descr, const std::string& shape, const std::string& fortran = "False")
{
    return "{'descr': '" + descr + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
}

class ScratchFile {
public:
    ScratchFile()
        : path_{std::filesystem::temp_directory_path() / ("fastccd_npy_test_" + std::to_string(::getpid()) + ".npy")}
    {
    }
    ~ScratchFile()
    {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

TEST(Npy, AcceptsBothShapesBothPrecisionsAllVersions)
{
    for (const int version : {1, 2, 3}) {
        SCOPED_TRACE(version);
        const NpyHeader records = parse_npy_header(npy(dictionary("<f8", "(5, 8, 3)"), 5 * 192, version), "a.npy");
        EXPECT_EQ(records.layout, Layout::interleaved);
        EXPECT_EQ(records.scalar, Scalar::float64);
        EXPECT_EQ(records.pairs, 5U);
        EXPECT_EQ(records.data_offset % 64, 0U);

        const NpyHeader blocks = parse_npy_header(npy(dictionary("<f4", "(2, 24, 8)"), 2 * 768, version), "a.npy");
        EXPECT_EQ(blocks.layout, Layout::blocked);
        EXPECT_EQ(blocks.scalar, Scalar::float32);
        EXPECT_EQ(blocks.pairs, 16U);
    }
}

TEST(Npy, AcceptsWhatPythonCouldHaveWritten)
{
    for (const std::string text : {R"({"shape":(1,8,3),"descr":"<f8","fortran_order":False})",
                                   "{ 'fortran_order' : False , 'descr' : '<f8' , 'shape' : ( 1 , 8 , 3 , ) , }",
                                   "\n{'descr': '<f8',\n 'fortran_order': False,\n 'shape': (1, 8, 3)}\n"}) {
        SCOPED_TRACE(text);
        EXPECT_EQ(parse_npy_header(npy(text, 192), "a.npy").pairs, 1U);
    }
}

TEST(Npy, ZeroPairsAreFine)
{
    EXPECT_EQ(parse_npy_header(npy(dictionary("<f8", "(0, 8, 3)"), 0), "a.npy").pairs, 0U);
    EXPECT_EQ(parse_npy_header(npy(dictionary("<f4", "(0, 24, 8)"), 0), "a.npy").pairs, 0U);
}

struct Malformed {
    const char* name;
    std::string file;
    const char* message;  ///< A part of what the error has to say.
};

class NpyMalformed : public testing::TestWithParam<Malformed> {};

TEST_P(NpyMalformed, IsRefusedByName)
{
    try {
        (void)parse_npy_header(GetParam().file, "some/pairs.npy");
        FAIL() << "accepted";
    } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_EQ(what.find("some/pairs.npy: "), 0U) << what;
        EXPECT_NE(what.find(GetParam().message), std::string::npos) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        for (const char c : what) EXPECT_TRUE(c >= 0x20 && c < 0x7f) << what;
    }
}

std::vector<Malformed> malformed_files()
{
    const std::string good = npy(dictionary("<f8", "(2, 8, 3)"), 2 * 192);
    const std::string unaligned_text = dictionary("<f8", "(1, 8, 3)");
    std::string unaligned{"\x93NUMPY\x01\x00", 8};
    unaligned += {static_cast<char>(unaligned_text.size() + 1), '\0'};
    unaligned += unaligned_text + '\n' + std::string(192, '\0');
    std::string version4 = good;
    version4[6] = 4;
    std::string long_header = good;
    long_header[9] = 0x7f;
    const auto header = [](const std::string& text) { return npy(text, 192); };
    return {
        {"empty", "", "not a .npy file"},
        {"other_format", "PK\x03\x04 and so on", "not a .npy file"},
        {"magic_only", good.substr(0, 6), "truncated within the first 10 bytes"},
        {"cut_in_version_2_length", npy(dictionary("<f8", "(0, 8, 3)"), 0, 2).substr(0, 11), "truncated within"},
        {"cut_in_header", good.substr(0, 40), "truncated: its .npy header"},
        {"header_longer_than_file", long_header, "truncated: its .npy header"},
        {"unknown_version", version4, ".npy version 4.0"},
        {"cut_in_data", good.substr(0, good.size() - 1), "truncated: shape (2, 8, 3)"},
        {"trailing_byte", good + "x", "has 1 byte after the end"},
        {"trailing_bytes", good + "xy", "has 2 bytes after the end"},
        {"big_endian", npy(dictionary(">f8", "(1, 8, 3)"), 192), "dtype '>f8'"},
        {"integers", npy(dictionary("<i8", "(1, 8, 3)"), 192), "dtype '<i8'"},
        {"half_precision", npy(dictionary("<f2", "(1, 8, 3)"), 48), "dtype '<f2'"},
        {"objects", npy(dictionary("|O", "(1, 8, 3)"), 192), "dtype '|O'"},
        {"control_characters", npy(dictionary("\x01\xff", "(1, 8, 3)"), 192), "dtype '\\x01\\xff'"},
        {"named_fields", header("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1, 8, 3)}"),
         "has named fields"},
        {"fortran_order", npy(dictionary("<f8", "(1, 8, 3)", "True"), 192), "Fortran order"},
        {"flat", npy(dictionary("<f8", "(24,)"), 192), "shape (24,)"},
        {"matrix", npy(dictionary("<f8", "(1, 24)"), 192), "shape (1, 24)"},
        {"scalar", npy(dictionary("<f8", "()"), 8), "shape ()"},
        {"swapped_axes", npy(dictionary("<f8", "(1, 3, 8)"), 192), "shape (1, 3, 8)"},
        {"four_axes", npy(dictionary("<f8", "(1, 2, 4, 3)"), 192), "shape (1, 2, 4, 3)"},
        {"size_overflows", npy(dictionary("<f8", "(768614336404564651, 8, 3)"), 192), "truncated: shape"},
        {"size_beyond_64_bits", npy(dictionary("<f8", "(99999999999999999999, 8, 3)"), 192), "beyond all memory"},
        {"negative_size", npy(dictionary("<f8", "(-1, 8, 3)"), 192), "tuple of sizes"},
        {"fractional_size", npy(dictionary("<f8", "(1.5, 8, 3)"), 192), "malformed"},
        {"no_dictionary", header("[1, 2, 3]"), "expected '{'"},
        {"unclosed", header("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 8, 3)"), "expected '}'"},
        {"unclosed_string", header("{'descr"), "a string does not end"},
        {"missing_shape", header("{'descr': '<f8', 'fortran_order': False}"), "lacks one of"},
        {"repeated_key", header("{'descr': '<f8', 'descr': '<f4', 'fortran_order': False, 'shape': (1, 8, 3)}"),
         "repeated key 'descr'"},
        {"unknown_key", header("{'dtype': '<f8'}"), "unknown or repeated key 'dtype'"},
        {"numeric_order", header("{'descr': '<f8', 'fortran_order': 0, 'shape': (1, 8, 3)}"), "True or False"},
        {"text_behind", header("{'descr': '<f8', 'fortran_order': False, 'shape': (1, 8, 3)} + 1"),
         "after the closing brace"},
        {"unaligned_data", unaligned, "not aligned"},
    };
}

INSTANTIATE_TEST_SUITE_P(Table, NpyMalformed, testing::ValuesIn(malformed_files()),
                         [](const auto& test) { return std::string{test.param.name}; });

TEST(Npy, RandomDamageIsAcceptedOrNamedNeverWorse)
{
    const std::string good = npy(dictionary("<f8", "(2, 8, 3)"), 2 * 192);
    std::mt19937 random{1};
    const auto below = [&random](std::size_t n) { return std::uniform_int_distribution<std::size_t>{0, n - 1}(random); };
    for (int i = 0; i < 20'000; ++i) {
        std::string file = good;
        for (std::size_t k = 0; k <= below(3); ++k) file[below(128)] = static_cast<char>(below(256));
        if (below(4) == 0) file.resize(below(file.size()));
        try {
            const NpyHeader header = parse_npy_header(file, "a.npy");
            EXPECT_LE(header.pairs * 96, file.size());
        } catch (const InputError&) {
        }
    }
}

TEST(Npy, FilesThatCannotBeMappedAreNamed)
{
    const std::filesystem::path directory = std::filesystem::temp_directory_path();
    for (const auto& [path, message] : {std::pair{directory / "no_such_file_of_fastccd.npy", "No such file"},
                                        std::pair{directory, "is a directory"},
                                        std::pair{std::filesystem::path{"/dev/null"}, "not a regular file"}}) {
        try {
            const NpyPairs pairs{path};
            FAIL() << "accepted " << path;
        } catch (const InputError& error) {
            EXPECT_NE(std::string{error.what()}.find(message), std::string::npos) << error.what();
        }
    }
}

PairBuffer numbered_pairs(std::size_t size)
{
    PairBuffer pairs{size};
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t c = 0; c < pair_coordinates; ++c) pairs.at(i, c) = static_cast<double>(100 * i + c);
    }
    return pairs;
}

void expect_same(const PairView& a, const PairView& b)
{
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t c = 0; c < pair_coordinates; ++c) ASSERT_EQ(coordinate(a, i, c), coordinate(b, i, c));
    }
}

TEST(Npy, WhatIsWrittenReadsBack)
{
    const ScratchFile file;
    const PairBuffer pairs = numbered_pairs(4000);
    const PairBuffer tail = numbered_pairs(24);
    for (const Layout written : {Layout::blocked, Layout::interleaved}) {
        NpyWriter writer{file.path(), written, 4024};
        writer.append(pairs.view());
        writer.append(tail.view());
        EXPECT_FALSE(std::filesystem::exists(file.path()));
        writer.commit();
        const NpyPairs read{file.path()};
        EXPECT_EQ(read.view().layout(), written);
        read.load(0, read.view().size());
        expect_same(slice(read.view(), 0, 4000), pairs.view());
        expect_same(slice(read.view(), 4000, 4024), tail.view());

        // From each layout to the other, over the file that is mapped: a new one takes its name.
        const Layout other = written == Layout::blocked ? Layout::interleaved : Layout::blocked;
        NpyWriter converter{file.path(), other, 4024};
        converter.append(read.view());
        converter.commit();
        const NpyPairs converted{file.path()};
        EXPECT_EQ(converted.view().layout(), other);
        expect_same(converted.view(), read.view());
        std::filesystem::remove(file.path());
    }
}

TEST(Npy, CopyStartsWithinABlock)
{
    const PairBuffer pairs = numbered_pairs(20);
    const PairBuffer copy = copy_pairs(pairs.view(), 5, 19);
    ASSERT_EQ(copy.size(), 14U);
    for (std::size_t i = 0; i < copy.size(); ++i) EXPECT_EQ(copy.at(i, 3), pairs.at(i + 5, 3));
}

TEST(Npy, UnfinishedFileLeavesNothing)
{
    const ScratchFile file;
    {
        NpyWriter writer{file.path(), Layout::blocked, 16};
        writer.append(numbered_pairs(8).view());
        EXPECT_THROW(writer.commit(), std::logic_error);
        EXPECT_THROW(writer.append(numbered_pairs(16).view()), std::logic_error);
        EXPECT_THROW(writer.append(slice(numbered_pairs(8).view(), 0, 4)), std::logic_error);
    }
    EXPECT_THROW(NpyWriter(file.path(), Layout::blocked, 9), std::logic_error);
    const std::string name = file.path().filename().string();
    for (const auto& entry : std::filesystem::directory_iterator{file.path().parent_path()}) {
        EXPECT_NE(entry.path().filename().string().find(name), 0U) << entry.path();
    }
}

}  // namespace
}  // namespace fastccd::tools
