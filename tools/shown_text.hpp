// Text of a file, and names of files, as messages show them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace fastccd::tools {

/// Control characters and bytes outside ASCII made visible, long text cut.
[[nodiscard]] inline std::string shown(std::string_view text)
{
    constexpr std::size_t longest = 40;
    std::string shown;
    for (const char c : text.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(c);
        shown += byte >= 0x20 && byte < 0x7f ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
    }
    return text.size() > longest ? shown + "..." : shown;
}

[[nodiscard]] inline std::string in_quotes(std::string_view text) { return fmt::format("'{}'", shown(text)); }

/// One line of text, whatever a file's name holds: line breaks, and what would drive a terminal, are spelled out. Besides the control
/// characters of ASCII those are U+0080 to U+009F, in UTF-8 C2 80 to C2 9F.
[[nodiscard]] inline std::string on_one_line(std::string_view text)
{
    std::string line;
    unsigned char before = 0;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f || (before == 0xc2 && byte < 0xa0))
            line += fmt::format("\\x{:02x}", byte);
        else
            line += c;
        before = byte;
    }
    return line;
}

}  // namespace fastccd::tools
