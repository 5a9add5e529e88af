#include "ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <unordered_set>
#include <utility>

#include "../shown_text.hpp"
#include "mesh_formats.hpp"

namespace fastccd::tools::detail {
namespace {

// Both families of names are in use: those of the original format and those with sizes.
constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names{{
    {"char", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"int", PlyType::int32},
    {"uint", PlyType::uint32},
    {"float", PlyType::float32},
    {"double", PlyType::float64},
    {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},
    {"int16", PlyType::int16},
    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},
    {"uint32", PlyType::uint32},
    {"float32", PlyType::float32},
    {"float64", PlyType::float64},
}};

class HeaderParser {
public:
    explicit HeaderParser(LineCursor& lines) : lines_(lines) {}

    PlyHeader parse()
    {
        lines_.next();  // the line 'ply', by which parse_mesh tells the format
        while (lines_.next()) {
            std::string_view line = lines_.line();
            const std::string_view keyword = take_word(line);
            if (keyword == "end_header") {
                if (!format_)
                    fail("the header names no format; add a line such as 'format ascii 1.0'");
                return {*format_, std::move(elements_)};
            }
            if (keyword == "comment" || keyword == "obj_info") continue;
            if (keyword == "format") {
                add_format(line);
            } else if (keyword == "element") {
                add_element(line);
            } else if (keyword == "property") {
                add_property(line);
            } else {
                fail(fmt::format("{} is not a PLY header line", in_quotes(lines_.line())));
            }
        }
        throw MeshError(fmt::format("line {}: the file ends within the header, before 'end_header'",
                                    lines_.number()));
    }

private:
    [[noreturn]] void fail(const std::string& what) const
    {
        throw MeshError(fmt::format("line {}: {}", lines_.number(), what));
    }

    void expect_end(std::string_view rest) const
    {
        if (const std::string_view word = take_word(rest); !word.empty()) {
            fail(fmt::format("{} is more than this header line holds", in_quotes(word)));
        }
    }

    void add_format(std::string_view rest)
    {
        const std::string_view name = take_word(rest);
        const std::string_view version = take_word(rest);
        if (format_) fail("the format is named twice");
        if (name == "ascii") {
            format_ = PlyFormat::ascii;
        } else if (name == "binary_little_endian") {
            format_ = PlyFormat::little_endian;
        } else if (name == "binary_big_endian") {
            format_ = PlyFormat::big_endian;
        } else {
            fail(fmt::format("format {} is not ascii, binary_little_endian or binary_big_endian",
                             in_quotes(name)));
        }
        if (version != "1.0") fail(fmt::format("PLY version {} is not 1.0", in_quotes(version)));
        expect_end(rest);
    }

    void add_element(std::string_view rest)
    {
        const std::string_view name = take_word(rest);
        const std::string_view count_word = take_word(rest);
        std::uint64_t count = 0;
        if (name.empty()) fail("the element has no name");
        if (!parse_number(count_word, count)) {
            fail(fmt::format("{} is not a number of {} elements", in_quotes(count_word),
                             in_quotes(name)));
        }
        if (!names_.insert(std::string(name)).second) fail(fmt::format("element {} is declared twice", in_quotes(name)));
        expect_end(rest);
        elements_.push_back({std::string(name), count, {}});
    }

    void add_property(std::string_view rest)
    {
        if (elements_.empty()) fail("a property stands before the first element");
        std::vector<PlyProperty>& properties = elements_.back().properties;
        std::string_view type_word = take_word(rest);
        std::optional<PlyType> count_type;
        if (type_word == "list") {
            count_type = parse_type(take_word(rest));
            if (is_floating(*count_type)) fail("the length of a list must have an integer type");
            type_word = take_word(rest);
        }
        const PlyType type = parse_type(type_word);
        const std::string_view name = take_word(rest);
        if (name.empty()) fail("the property has no name");
        expect_end(rest);
        properties.push_back({std::string(name), type, count_type});
    }

    PlyType parse_type(std::string_view word) const
    {
        const auto* const found =
            std::find_if(type_names.begin(), type_names.end(),
                         [word](const auto& entry) { return entry.first == word; });
        if (found == type_names.end()) fail(fmt::format("{} is not a PLY type", in_quotes(word)));
        return found->second;
    }

    LineCursor& lines_;
    std::optional<PlyFormat> format_;
    std::vector<PlyElement> elements_;
    std::unordered_set<std::string> names_;  // of elements_: a header may be of nothing but these
};

}  // namespace

std::size_t size_of(PlyType type)
{
    switch (type) {
        case PlyType::int8:
        case PlyType::uint8:
            return 1;
        case PlyType::int16:
        case PlyType::uint16:
            return 2;
        case PlyType::int32:
        case PlyType::uint32:
        case PlyType::float32:
            return 4;
        case PlyType::float64:
            break;
    }
    return 8;
}

bool is_floating(PlyType type)
{
    return type == PlyType::float32 || type == PlyType::float64;
}

const PlyElement* PlyHeader::find(std::string_view element) const
{
    const auto found =
        std::find_if(elements.begin(), elements.end(),
                     [element](const PlyElement& candidate) { return candidate.name == element; });
    return found == elements.end() ? nullptr : &*found;
}

PlyHeader parse_ply_header(LineCursor& lines)
{
    return HeaderParser(lines).parse();
}

}  // namespace fastccd::tools::detail
