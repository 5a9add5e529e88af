// Text of a file as messages show it.
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

}  // namespace fastccd::tools
