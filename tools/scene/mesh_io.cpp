#include "mesh_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <memory>
#include <new>
#include <numeric>
#include <string>
#include <system_error>

#include "../interrupt.hpp"
#include "mesh_formats.hpp"

namespace fastccd::tools {
namespace {

/// Of a mark and a line with a few blanks.
constexpr std::size_t longest_beginning = 64;

/// Editors put this in front of UTF-8; left there it would hide what the file is, and OBJ's first vertex, as unknown statements are skipped.
std::string_view without_mark(std::string_view content)
{
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (content.starts_with(byte_order_mark)) content.remove_prefix(byte_order_mark.size());
    return content;
}

bool begins_as_ply(std::string_view content)
{
    content = content.substr(0, longest_beginning);
    const std::size_t end = content.find_first_not_of(" \t\r", 3);
    return content.starts_with("ply") && end != std::string_view::npos && content[end] == '\n';
}

std::string extension_in_small_letters(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

enum class Format { ply, obj };

/// By the first bytes and the name. Throws InputError.
Format format_of(std::string_view content, const std::filesystem::path& path)
{
    if (begins_as_ply(without_mark(content))) return Format::ply;
    if (extension_in_small_letters(path) == ".obj") return Format::obj;
    throw InputError(
        path,
        content.empty()
            ? "the file is empty; a PLY or OBJ mesh is needed"
            : "not a mesh that is read here: PLY begins with the line 'ply', OBJ is read from files whose "
              "names end in '.obj', not through pipes");
}

// Into memory rather than mapped: a mesh may come through a pipe.
std::string read_bytes(const std::filesystem::path& path)
{
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    const auto reason = [](int error) { return std::generic_category().message(error); };
    // A pipe waits, to be opened and to be read, and a signal wakes it up.
    std::unique_ptr<std::FILE, Close> file(std::fopen(path.c_str(), "rb"));
    while (!file && errno == EINTR) {
        check_interrupt();
        file.reset(std::fopen(path.c_str(), "rb"));
    }
    if (!file) throw InputError(path, fmt::format("cannot be opened: {}", reason(errno)));

    constexpr std::size_t first_size = std::size_t{1} << 20;
    std::string bytes;
    std::size_t size = 0;
    bool is_known = false;
    do {
        if (size == bytes.size()) bytes.resize(std::max(2 * size, first_size));
        const std::size_t got = std::fread(bytes.data() + size, 1, bytes.size() - size, file.get());
        size += got;
        if (!is_known && size >= 2 * longest_beginning) {
            (void)format_of({bytes.data(), size}, path);  // what is no mesh may be of any length, or endless
            is_known = true;
        }
        if (std::ferror(file.get()) == 0) continue;
        if (errno != EINTR) throw InputError(path, fmt::format("cannot be read: {}", reason(errno)));
        check_interrupt();
        std::clearerr(file.get());
    } while (std::feof(file.get()) == 0);
    bytes.resize(size);
    return bytes;
}

void append_little_endian(std::string& bytes, std::uint64_t bits, int size)
{
    for (int i = 0; i < size; ++i)
        bytes += static_cast<char>(static_cast<unsigned char>(bits >> (8 * i)));
}

/// Sorts keys below 2^bits, least significant digit first: in less than half the time of std::sort
/// on the edges of a million faces.
void radix_sort(std::vector<std::uint64_t>& keys, int bits)
{
    constexpr int digit_bits = 11;  // 2048 counters stay in the first-level cache
    constexpr std::uint64_t mask = (1U << digit_bits) - 1;
    std::vector<std::uint64_t> sorted(keys.size());
    for (int shift = 0; shift < bits; shift += digit_bits) {
        std::array<std::size_t, mask + 1> place{};
        for (const std::uint64_t key : keys) ++place[(key >> shift) & mask];
        std::exclusive_scan(place.begin(), place.end(), place.begin(), std::size_t{0});
        for (const std::uint64_t key : keys) sorted[place[(key >> shift) & mask]++] = key;
        keys.swap(sorted);
    }
}

}  // namespace

Mesh parse_mesh(std::string_view content, const std::filesystem::path& path)
{
    const Format format = format_of(content, path);
    content = without_mark(content);
    try {
        return format == Format::ply ? detail::parse_ply(content) : detail::parse_obj(content);
    } catch (const detail::MeshError& error) {
        throw InputError(path, error.what());
    }
}

Mesh read_mesh(const std::filesystem::path& path)
{
    try {
        return parse_mesh(read_bytes(path), path);
    } catch (const std::bad_alloc&) {
        throw InputError(path, "there is not enough memory for this mesh");
    }
}

void write_ply(const OutputFile& file, const Mesh& mesh)
{
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\n"
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
        "element face {}\nproperty list uchar int vertex_indices\n",
        mesh.positions.size() / 3, mesh.faces.size() / 3);
    if (!mesh.lines.empty()) bytes += fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", mesh.lines.size());
    bytes += "end_header\n";
    bytes.reserve(bytes.size() + 8 * mesh.positions.size() + 13 * (mesh.faces.size() / 3) + 8 * mesh.lines.size());
    for (const double coordinate : mesh.positions)
        append_little_endian(bytes, std::bit_cast<std::uint64_t>(coordinate), 8);
    for (std::size_t corner = 0; corner < mesh.faces.size(); ++corner) {
        if (corner % 3 == 0) bytes += '\3';
        append_little_endian(bytes, static_cast<std::uint32_t>(mesh.faces[corner]), 4);
    }
    for (const Edge& line : mesh.lines)
        for (const std::int32_t end : line) append_little_endian(bytes, static_cast<std::uint32_t>(end), 4);
    file.write(bytes);
}

bool named_as_mesh(const std::filesystem::path& path)
{
    const std::string extension = extension_in_small_letters(path);
    return extension == ".ply" || extension == ".obj";
}

std::vector<Edge> unique_edges(const std::vector<std::int32_t>& faces, const std::vector<Edge>& lines)
{
    std::int32_t largest = 0;
    for (const std::int32_t vertex : faces) largest = std::max(largest, vertex);
    for (const Edge& line : lines) largest = std::max({largest, line[0], line[1]});
    const auto index_bits = static_cast<int>(std::bit_width(static_cast<std::uint32_t>(largest)));
    std::vector<std::uint64_t> keys;  // low vertex above high vertex
    keys.reserve(faces.size() + lines.size());
    const auto add = [&](std::int32_t a, std::int32_t b) {
        const auto [low, high] = std::minmax(a, b);
        if (low != high)
            keys.push_back(static_cast<std::uint64_t>(low) << index_bits |
                           static_cast<std::uint64_t>(high));
    };
    for (std::size_t corner = 0; corner < faces.size(); ++corner)
        add(faces[corner], faces[corner % 3 == 2 ? corner - 2 : corner + 1]);
    for (const Edge& line : lines) add(line[0], line[1]);
    radix_sort(keys, 2 * index_bits);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());

    std::vector<Edge> edges;
    edges.reserve(keys.size());
    const std::uint64_t high_mask = (std::uint64_t{1} << index_bits) - 1;
    for (const std::uint64_t key : keys) {
        edges.push_back({static_cast<std::int32_t>(key >> index_bits),
                         static_cast<std::int32_t>(key & high_mask)});
    }
    return edges;
}

}  // namespace fastccd::tools
