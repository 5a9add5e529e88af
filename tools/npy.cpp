#include "npy.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "input_error.hpp"
#include "pair_slice.hpp"
#include "shown_text.hpp"

namespace fastccd::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "the data of '<f8' and '<f4' files is used in place");

constexpr std::string_view magic{"\x93NUMPY", 6};

/// The three values of a header, as they stand there.
struct Dictionary {
    std::optional<std::string> dtype;
    std::optional<bool> fortran_order;
    std::optional<std::vector<std::size_t>> shape;
};

/// Reader of the one Python literal a header may be: a dictionary of 'descr' (a string),
/// 'fortran_order' (True or False) and 'shape' (a tuple of integers).
class HeaderParser {
public:
    HeaderParser(std::string_view text, const std::filesystem::path& path) : rest_{text}, all_{text}, path_{path} {}

    Dictionary parse()
    {
        Dictionary result;
        expect('{');
        while (!accept('}')) {
            const std::string key = string();
            expect(':');
            if (key == "descr" && !result.dtype) {
                // A list here describes a record of named fields.
                if (peek() == '[') fail("has named fields; save a plain float64 or float32 array");
                result.dtype = string();
            } else if (key == "fortran_order" && !result.fortran_order) {
                result.fortran_order = boolean();
            } else if (key == "shape" && !result.shape) {
                result.shape = tuple();
            } else {
                fail(fmt::format("has an unknown or repeated key {}", in_quotes(key)));
            }
            if (!accept(',')) {
                expect('}');
                break;
            }
        }
        skip_space();
        if (!rest_.empty()) fail("goes on after the closing brace");
        if (!result.dtype || !result.fortran_order || !result.shape) {
            fail("lacks one of 'descr', 'fortran_order', 'shape'");
        }
        return result;
    }

private:
    [[noreturn]] void fail(std::string_view what) const
    {
        throw InputError(path_, fmt::format("the .npy header {} (character {} of it)", what, all_.size() - rest_.size()));
    }

    void skip_space()
    {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    }

    char peek()
    {
        skip_space();
        return rest_.empty() ? '\0' : rest_.front();
    }

    bool accept(char c)
    {
        if (peek() != c || rest_.empty()) return false;
        rest_.remove_prefix(1);
        return true;
    }

    void expect(char c)
    {
        if (!accept(c)) fail(fmt::format("is malformed: expected '{}'", c));
    }

    std::string string()
    {
        const char quote = peek();
        if (quote != '\'' && quote != '"') fail("is malformed: expected a quoted string");
        const std::size_t end = rest_.find(quote, 1);
        if (end == std::string_view::npos) fail("is malformed: a string does not end");
        std::string text{rest_.substr(1, end - 1)};
        rest_.remove_prefix(end + 1);
        return text;
    }

    bool boolean()
    {
        skip_space();
        for (const bool value : {false, true}) {
            const std::string_view word = value ? "True" : "False";
            if (!rest_.starts_with(word)) continue;
            rest_.remove_prefix(word.size());
            return value;
        }
        fail("is malformed: 'fortran_order' is to be True or False");
    }

    std::vector<std::size_t> tuple()
    {
        std::vector<std::size_t> values;
        expect('(');
        while (!accept(')')) {
            skip_space();
            std::size_t value = 0;
            const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
            if (error == std::errc::result_out_of_range) fail("has a shape beyond all memory");
            if (error != std::errc{}) fail("is malformed: 'shape' is to be a tuple of sizes");
            rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
            values.push_back(value);
            if (!accept(',')) {
                expect(')');
                break;
            }
        }
        return values;
    }

    std::string_view rest_;
    std::string_view all_;
    const std::filesystem::path& path_;
};

/// Where the header's text lies: behind magic, version and its own length.
struct HeaderText {
    std::string_view text;
    std::size_t end;
};

HeaderText header_text(std::string_view bytes, const std::filesystem::path& path)
{
    if (!bytes.starts_with(magic.substr(0, bytes.size())) || bytes.empty()) {
        throw InputError(path, "is not a .npy file: it does not begin with \"\\x93NUMPY\"");
    }
    if (bytes.size() < 10) throw InputError(path, "is truncated within the first 10 bytes of the .npy header");
    const auto byte = [&](std::size_t i) { return std::size_t{static_cast<unsigned char>(bytes[i])}; };
    const std::size_t major = byte(6);
    const std::size_t minor = byte(7);
    if (major < 1 || major > 3 || minor != 0) {
        throw InputError(path, fmt::format("has .npy version {}.{}; 1.0, 2.0 and 3.0 can be read", major, minor));
    }
    const std::size_t start = major == 1 ? 10 : 12;
    if (bytes.size() < start) throw InputError(path, "is truncated within the first 12 bytes of the .npy header");
    std::size_t length = byte(8) | byte(9) << 8;
    if (major > 1) length |= byte(10) << 16 | byte(11) << 24;
    if (bytes.size() - start < length) {
        throw InputError(path, fmt::format("is truncated: its .npy header of {} bytes should end at byte {}, "
                                           "the file at byte {}",
                                           length, start + length, bytes.size()));
    }
    return {bytes.substr(start, length), start + length};
}

}  // namespace

NpyHeader parse_npy_header(std::string_view bytes, const std::filesystem::path& path)
{
    const HeaderText header = header_text(bytes, path);
    const Dictionary dictionary = HeaderParser{header.text, path}.parse();
    const std::string& dtype = *dictionary.dtype;
    const std::vector<std::size_t>& shape = *dictionary.shape;

    if (dtype != "<f8" && dtype != "<f4") {
        throw InputError(path, fmt::format("has dtype {}; convert to little-endian '<f8' (float64) or '<f4' (float32)",
                                           in_quotes(dtype)));
    }
    if (*dictionary.fortran_order) {
        throw InputError(path, "is in Fortran order; save numpy.ascontiguousarray(...) instead");
    }
    const bool records = shape.size() == 3 && shape[1] == 8 && shape[2] == 3;
    const bool blocks = shape.size() == 3 && shape[1] == pair_coordinates && shape[2] == block_pairs;
    if (!records && !blocks) {
        throw InputError(path, fmt::format("has shape ({}{}); pairs are (N, 8, 3), or (B, 24, 8) in blocks of 8 pairs",
                                           fmt::join(shape.begin(), shape.begin() + std::min<std::ptrdiff_t>(
                                                                        8, std::ssize(shape)), ", "),
                                           shape.size() == 1 ? "," : ""));
    }

    const std::size_t scalar_size = dtype == "<f8" ? sizeof(double) : sizeof(float);
    const std::size_t pairs_per_item = records ? 1 : block_pairs;
    const std::size_t item_size = scalar_size * pair_coordinates * pairs_per_item;
    const std::size_t available = bytes.size() - header.end;
    if (shape[0] > std::numeric_limits<std::size_t>::max() / item_size || shape[0] * item_size > available) {
        throw InputError(path, fmt::format("is truncated: shape ({}, {}, {}) of '{}' needs {} x {} bytes after the "
                                           "header, which the file has {} of",
                                           shape[0], shape[1], shape[2], dtype, shape[0], item_size, available));
    }
    if (const std::size_t excess = available - shape[0] * item_size; excess != 0) {
        throw InputError(path, fmt::format("has {} byte{} after the end of its array of shape ({}, {}, {}), at byte {}",
                                           excess, excess == 1 ? "" : "s", shape[0], shape[1], shape[2], bytes.size() - excess));
    }
    if (header.end % scalar_size != 0) {
        throw InputError(path, fmt::format("has its array at byte {}, which is not aligned to its {}-byte numbers; "
                                           "numpy.save pads the header to a multiple of 64",
                                           header.end, scalar_size));
    }
    return {.layout = records ? PairView::Layout::interleaved : PairView::Layout::blocked,
            .scalar = scalar_size == sizeof(double) ? PairView::Scalar::float64 : PairView::Scalar::float32,
            .pairs = shape[0] * pairs_per_item,
            .data_offset = header.end};
}

NpyPairs::NpyPairs(const std::filesystem::path& path) : file_{path}
{
    const NpyHeader header = file_.parsed([&](std::string_view bytes) { return parse_npy_header(bytes, path); });
    data_offset_ = header.data_offset;
    const auto view = [&](const auto* data) {
        return header.layout == PairView::Layout::blocked ? PairView::blocked(data, header.pairs)
                                                          : PairView::interleaved(data, header.pairs);
    };
    const void* const data = file_.bytes().data() + header.data_offset;
    view_ = header.scalar == PairView::Scalar::float64 ? view(static_cast<const double*>(data))
                                                       : view(static_cast<const float*>(data));
}

void NpyPairs::load(std::size_t begin, std::size_t end) const
{
    const std::size_t size = pair_bytes(view_);
    // The coordinates of a pair are spread over its block: whole blocks.
    const std::size_t first = begin / block_pairs * block_pairs;
    const std::size_t last = (end + block_pairs - 1) / block_pairs * block_pairs;
    file_.load(data_offset_ + first * size, (last - first) * size);
}

namespace {

/// The header of float64 pairs. Of records it has the same length, 128 bytes, whatever their number.
std::string npy_header(PairView::Layout layout, std::size_t pairs)
{
    const bool blocked = layout == PairView::Layout::blocked;
    std::string text = blocked ? fmt::format("({}, 24, 8)", pairs / block_pairs) : fmt::format("({}, 8, 3)", pairs);
    text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': {}, }}", text);
    // Magic, version, length, text and newline are padded to 64 bytes, which aligns the array.
    constexpr std::size_t prefix = 10;
    text.resize((prefix + text.size() + 1 + 63) / 64 * 64 - prefix - 1, ' ');
    text += '\n';
    std::string header{magic};
    header += {'\x01', '\x00', static_cast<char>(text.size() & 0xff), static_cast<char>(text.size() >> 8)};
    return header + text;
}

}  // namespace

NpyWriter::NpyWriter(const std::filesystem::path& path, PairView::Layout layout, std::optional<std::size_t> pairs)
    : file_{path}, layout_{layout}, promised_{pairs}
{
    if (layout == PairView::Layout::blocked && pairs.value_or(1) % block_pairs != 0) {
        throw std::logic_error("blocks of a .npy file hold 8 pairs each");
    }
    if (!pairs && file_.is_in_place()) throw InputError(path, "is no regular file, into which the number of pairs can be put in the end");
    const std::string header = npy_header(layout, pairs.value_or(0));
    constexpr std::uint64_t bytes_per_pair = pair_coordinates * sizeof(double);
    if (pairs) {
        constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
        file_.reserve(*pairs > (most - header.size()) / bytes_per_pair ? most : header.size() + *pairs * bytes_per_pair);
    }
    file_.write(header);
}

void NpyWriter::append(const PairView& pairs)
{
    if (promised_ && pairs.size() > *promised_ - appended_) {
        throw std::logic_error("more pairs than the .npy header says");
    }
    if (layout_ == PairView::Layout::blocked && pairs.size() % block_pairs != 0) throw std::logic_error("a part of a block of pairs");
    appended_ += pairs.size();
    const bool as_is = pairs.layout() == layout_ && pairs.scalar() == PairView::Scalar::float64;
    if (as_is) {
        file_.write({static_cast<const char*>(pairs.data()), pairs.size() * pair_bytes(pairs)});
        return;
    }
    constexpr std::size_t piece = 1024;  // pairs converted at a time
    std::vector<double> converted;
    for (std::size_t begin = 0; begin < pairs.size(); begin += piece) {
        const std::size_t end = std::min(begin + piece, pairs.size());
        converted.resize((end - begin) * pair_coordinates);
        for (std::size_t i = begin; i < end; ++i) {
            for (std::size_t c = 0; c < pair_coordinates; ++c) {
                const std::size_t k = i - begin;
                const std::size_t target = layout_ == PairView::Layout::blocked ? blocked_index(k, c) : k * pair_coordinates + c;
                converted[target] = coordinate(pairs, i, c);
            }
        }
        file_.write({reinterpret_cast<const char*>(converted.data()), converted.size() * sizeof(double)});
    }
}

void NpyWriter::close()
{
    if (closed_) return;
    if (promised_ && appended_ != *promised_) throw std::logic_error("fewer pairs than the .npy header says");
    if (!promised_) file_.rewrite(0, npy_header(layout_, appended_));
    file_.close();
    closed_ = true;
}

void NpyWriter::commit()
{
    close();
    file_.commit();
}

}  // namespace fastccd::tools
