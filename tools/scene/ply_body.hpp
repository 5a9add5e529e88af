// The values in the body of a PLY file, one after another, and where in the file they are. The two
// classes have the same members, so that what gives the values their meaning is written once.
#pragma once

#include <fmt/format.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "../shown_text.hpp"
#include "mesh_formats.hpp"
#include "mesh_text.hpp"
#include "ply_header.hpp"

namespace fastccd::tools::detail {

// Name and number of an element's item, for messages; the number counts from 0, as indices do.
struct Item {
    std::string_view name;
    std::uint64_t number = 0;
};

// One line per item, values separated by blanks; empty lines are ignored.
class AsciiBody {
public:
    explicit AsciiBody(const LineCursor& lines) : lines_(lines) {}

    // Every value takes a character and what separates it from the next; the last has no next.
    [[nodiscard]] std::uint64_t most_values() const { return (lines_.rest().size() + 1) / 2; }
    static std::size_t least_size(PlyType) { return 1; }

    void begin(Item item)
    {
        item_ = item;
        do {
            if (!lines_.next())
                fail("the file ends before it; it is truncated, or the header's counts are wrong");
            rest_ = lines_.line();
        } while (is_blank(rest_));
    }

    void end()
    {
        if (!is_blank(rest_))
            fail(fmt::format("{} is more than the header says it holds",
                             in_quotes(take_word(rest_))));
    }

    void end_of_file()
    {
        while (lines_.next()) {
            if (!is_blank(lines_.line())) {
                throw MeshError(fmt::format(
                    "line {}: the file goes on after the last element; the header's counts "
                    "do not match it",
                    lines_.number()));
            }
        }
    }

    double read_real(PlyType type)
    {
        const std::string_view word = take();
        if (type == PlyType::float32) return parse<float>(word, "a number that float can hold");
        if (type == PlyType::float64) return parse<double>(word, "a number that double can hold");
        return static_cast<double>(parse<std::int64_t>(word, "an integer"));
    }

    std::int64_t read_integer(PlyType) { return parse<std::int64_t>(take(), "an integer"); }

    void skip(PlyType, std::uint64_t count)
    {
        for (std::uint64_t i = 0; i < count; ++i) take();
    }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw MeshError(
            fmt::format("line {}: {} {}: {}", lines_.number(), item_.name, item_.number, what));
    }

private:
    static bool is_blank(std::string_view line) { return take_word(line).empty(); }

    std::string_view take()
    {
        const std::string_view word = take_word(rest_);
        if (word.empty()) fail("the line ends before its last value");
        return word;
    }

    template <class T>
    T parse(std::string_view word, std::string_view expected) const
    {
        T value{};
        if (!parse_number(word, value))
            fail(fmt::format("{} is not {}", in_quotes(word), expected));
        return value;
    }

    LineCursor lines_;
    std::string_view rest_;
    Item item_;
};

class BinaryBody {
public:
    BinaryBody(std::string_view content, std::size_t offset, PlyFormat format)
        : content_(content), offset_(offset), big_endian_(format == PlyFormat::big_endian)
    {
    }

    [[nodiscard]] std::uint64_t most_values() const { return content_.size() - offset_; }
    static std::size_t least_size(PlyType type) { return size_of(type); }

    void begin(Item item) { item_ = item; }
    void end() {}

    void end_of_file() const
    {
        // Some writers end the file with a line break.
        if (content_.find_first_not_of("\r\n", offset_) != std::string_view::npos) {
            throw MeshError(fmt::format(
                "byte {}: the file goes on for {} bytes after the last element; the header's "
                "counts or types do not match it",
                offset_, content_.size() - offset_));
        }
    }

    double read_real(PlyType type)
    {
        if (type == PlyType::float32)
            return std::bit_cast<float>(static_cast<std::uint32_t>(take(4)));
        if (type == PlyType::float64) return std::bit_cast<double>(take(8));
        return static_cast<double>(read_integer(type));
    }

    std::int64_t read_integer(PlyType type)
    {
        const std::uint64_t bits = take(size_of(type));
        switch (type) {
            case PlyType::int8:
                return static_cast<std::int8_t>(bits);
            case PlyType::int16:
                return static_cast<std::int16_t>(bits);
            case PlyType::int32:
                return static_cast<std::int32_t>(bits);
            default:
                return static_cast<std::int64_t>(bits);  // unsigned: at most 32 bits
        }
    }

    void skip(PlyType type, std::uint64_t count)
    {
        if (count > (content_.size() - offset_) / size_of(type)) fail_truncated();
        offset_ += static_cast<std::size_t>(count) * size_of(type);
    }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw MeshError(fmt::format("byte {}: {} {}: {}", offset_, item_.name, item_.number, what));
    }

private:
    [[noreturn]] void fail_truncated() const
    {
        fail(
            fmt::format("the file ends within it, at byte {}; it is truncated, or the header's "
                        "counts or types are "
                        "wrong",
                        content_.size()));
    }

    std::uint64_t take(std::size_t size)
    {
        if (size > content_.size() - offset_) fail_truncated();
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i) {
            const auto byte = static_cast<unsigned char>(content_[offset_ + i]);
            bits |= std::uint64_t{byte} << (8 * (big_endian_ ? size - 1 - i : i));
        }
        offset_ += size;
        return bits;
    }

    std::string_view content_;
    std::size_t offset_;
    bool big_endian_;
    Item item_;
};

}  // namespace fastccd::tools::detail
